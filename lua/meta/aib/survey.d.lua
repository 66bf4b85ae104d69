---@meta aib.survey

---Flights round assets: planned, measured by casting rays, and what goes wrong with their images and poses. The world is
---x east, y north, z up, in metres; angles are degrees, shares 0..1.
---@class aib.survey
local survey = {}

---A pinhole camera by its lens; the defaults are the paper's: 50 mm, a sensor 36 mm wide, 1920 x 1080.
---@param options? { focal_mm?: number, sensor_mm?: number, width?: integer, height?: integer }
---@return aib.Camera camera
function survey.camera(options) end

---Where a camera flies and looks, before frames are placed on it.
---@class aib.FlightPath
---@field length number
---@field stand_off number  # planned distance to the surface
---@field camera aib.Camera
---@field overlap_across number  # of neighbouring rows as planned; 1 where there is one row
---@field n_rows integer
local flight_path = {}

---The pose at a share of the length.
---@param share number
---@return aib.Pose pose
function flight_path:at(share) end

---The path flown from its end.
---@return aib.FlightPath reversed
function flight_path:reversed() end

---What all paths are planned with: stand_off or gsd_mm.
---@class aib.FlightPathOptions
---@field camera? aib.Camera  # survey.camera() by default
---@field stand_off? number  # distance to the surface
---@field gsd_mm? number  # millimetres a pixel at the surface: stand_off = gsd_mm / 1000 * fx
---@field overlap_across? number  # of neighbouring rows, at least; 0.8

---@class aib.FacadeOptions : aib.FlightPathOptions
---@field pitch? number  # positive looks down, and flies as much higher; 0
---@field mesh? aib.Mesh  # the convex hull of its ground plan is flown round, over its heights
---@field labels? string[]  # of the faces with these labels alone
---@field footprint? number[][]  # or corners {x, y} of a polygon that does not cross itself; then low and high are needed
---@field low? number  # heights that the frames cover
---@field high? number
---@field sides? integer[]  # {first, last} of the edges, anticlockwise, edge 1 from corner 1; all round by default

---Rows round a building, flown to and fro from the lowest up, in arcs round the corners, looking along the inward normal;
---into an inner corner the camera turns on its way. No wall is nearer than the stand-off: an opening narrower than twice
---of it is passed by.
---@param options aib.FacadeOptions
---@return aib.FlightPath path
function survey.facade(options) end

---@class aib.OrbitOptions : aib.FlightPathOptions
---@field centre? number[]  # {x, y} of the axis; {0, 0}
---@field radius number  # of the circle; also the stand_off that counts for rows and frames, where none is given
---@field low? number  # height of the lowest circle, 0
---@field high? number  # of the highest; one circle by default
---@field look_at? number  # height on the axis that is looked at
---@field pitch? number  # or an angle, positive looks down; 0
---@field start? number  # azimuth of the first frame, 0 = +x, anticlockwise
---@field sweep? number  # 360

---Circles about a vertical axis, flown to and fro, looking at it.
---@param options aib.OrbitOptions
---@return aib.FlightPath path
function survey.orbit(options) end

---@class aib.LinearOptions : aib.FlightPathOptions
---@field from number[]  # {x, y, z}: the axis of a truss, deck, cable or mast
---@field to number[]
---@field views number[][]  # directions of sight {x, y, z}, in turn; their part across the axis counts
---@field pitch? number  # positive looks down in the image, and flies as much higher; 0
---@field width? number  # of the surface across the axis, as it is seen: flown in lanes; 0
---@field radius? number  # from the axis to the surface; 0

---Passes along an axis, for each view in turn, to and fro; between two views an arc about the axis.
---@param options aib.LinearOptions
---@return aib.FlightPath path
function survey.linear(options) end

---@class aib.AlongOptions : aib.FlightPathOptions
---@field points number[][]  # {x, y, z}, where the camera flies
---@field views number[][]  # direction of sight at each

---A path of one's own through points, straight between them, the view turned evenly.
---@param options aib.AlongOptions
---@return aib.FlightPath path
function survey.along(options) end

---Paths one after another, joined by straight legs on which the view turns evenly.
---@param paths aib.FlightPath[]
---@return aib.FlightPath path
function survey.join(paths) end

---@class aib.FlyOptions
---@field overlap? number  # of frames along the path, at least; 0.8
---@field frames? integer  # instead: exactly as many, and the overlap is reported
---@field mesh? aib.Mesh|aib.RenderScene  # to keep away from and to aim at
---@field min_distance? number  # to the mesh; 0: nobody looks
---@field clearance? "push"|"refuse"  # what happens to frames that are nearer: moved away (default), or an error says where
---@field aim? "path"|"normal"  # look as the path says (default), or along the normal of the surface that is seen
---@field speed? number  # m/s, gives the stamps; 2
---@field gimbal_rate? number  # degrees a second, largest turn of the view; 60
---@field gimbal? "slow"|"lag"  # where the view would turn faster: the flight slows down (default), or the view lags behind
---@field name? string  # of the images, counted from 0: "%06d.png"

---@class aib.FlightPlan
---@field trajectory aib.Trajectory  # with names and stamps
---@field camera aib.Camera
---@field cameras table<string, aib.Camera>  # by image name, as aib.io.write_trajectory takes them
---@field n_frames integer
---@field step number  # mean distance between frames along the path
---@field overlap number  # of neighbouring frames, on a wall at the stand-off; below 0 there are gaps
---@field overlap_across number  # of neighbouring rows, likewise
---@field length number
---@field duration number  # seconds
---@field gsd_mm number  # at the stand-off
---@field n_pushed integer
---@field largest_push number
---@field min_distance? number  # of the frames and the way between them to the mesh
---@field min_distance_frame? string  # at or behind which that is
---@field n_gimbal_limited integer  # frames on whose way the gimbal is the limit
---@field gimbal_delay number  # seconds that slowing down for it takes
---@field view_lags number[]  # of each frame, degrees from the view as planned; 0 but for gimbal = "lag"
---@field largest_view_lag number

---Places frames on a path, evenly by what the image moves: exactly `frames`, or as few as keep the overlap.
---@param path aib.FlightPath
---@param options? aib.FlyOptions
---@return aib.FlightPlan plan
function survey.fly(path, options) end

---@class aib.MeasureOptions
---@field labels? string[]  # faces with these alone count; others hide what is behind them
---@field samples? integer  # points on the surface, 20000
---@field columns? integer  # rays of a frame, 32 x 18
---@field rows? integer
---@field max_incidence? number  # a flatter view sees nothing; 75
---@field max_distance? number
---@field tolerance? number  # what is nearer by a smaller share of the distance does not hide; 0.001
---@field seed? integer  # of the samples

---What a flight sees.
---@class aib.FlightReport
---@field overlap { mean: number, median: number, min: number, p10: number, n_pairs: integer, n_blind: integer }  # share of the surface in a frame that the next one sees; blind frames see none
---@field overlaps number[]  # of each frame but the last; NaN where it is blind
---@field gsd_mm { mean: number, median: number, p05: number, p95: number, max: number }  # depth / focal length of the rays
---@field hit_share number  # of the rays that hit faces that count
---@field off_normal { mean: number, median: number, p95: number, max: number }  # degrees from a view to the one that faces the surface in its middle
---@field off_normals number[]  # of each frame; NaN where it sees none there
---@field coverage table<integer, number>  # share of the area that at least 1, 2, 3, 5, 10 views see
---@field incidence table<integer, number>  # share of the area that a view sees within 15, 30, 45, 60, 75 degrees of the normal
---@field n_views_mean number  # views that see a point
---@field area number
---@field unseen_area number
---@field unseen aib.Cloud  # samples that no view sees

---Casts rays to find what a flight sees of a mesh.
---@param trajectory aib.Trajectory  # in the order of flight
---@param camera aib.Camera|table<string, aib.Camera>
---@param mesh aib.Mesh|aib.RenderScene
---@param options? aib.MeasureOptions
---@return aib.FlightReport report
function survey.measure(trajectory, camera, mesh, options) end

---Of light x (1 is the full scale) the noise has the variance a x + b.
---@class aib.SensorNoiseOptions
---@field a? number  # shot noise: the full scale is 1 / a electrons; 2e-4
---@field b? number  # variance of the reading; 2e-6
---@field seed? integer  # 1
---@field frame? integer  # frames differ by it, whatever their order; 0
---@field transfer? "srgb"|"linear"  # how numbers stand for light

---The image with the clipped Poisson-Gaussian noise of a sensor, added to light.
---@param image aib.Image
---@param options? aib.SensorNoiseOptions
---@return aib.Image noisy
function survey.sensor_noise(image, options) end

---The same from file to file; a PNG of 16 bits stays one.
---@param from string
---@param to string  # .png
---@param options? aib.SensorNoiseOptions
function survey.sensor_noise_file(from, to, options) end

---What telemetry gets wrong; nothing by default. Each kind has random numbers of its own.
---@class aib.PerturbOptions
---@field seed? integer  # 1
---@field position_noise? number|number[]  # white, standard deviation {x, y, z}, or one for all
---@field position_walk? number  # standard deviation of a coordinate after a second (without stamps: a frame)
---@field position_bias? number[]  # {x, y, z}
---@field yaw_bias? number  # degrees about z of the world
---@field yaw_noise? number  # white, standard deviation
---@field gimbal_bias? number[]  # degrees {pitch, yaw, roll} about the camera's x (right), y (down), z (forward)
---@field gimbal_noise? number|number[]  # white, standard deviations
---@field lever_arm? number[]  # of the antenna in the camera: right, down, forward
---@field time_offset? number  # seconds (without stamps: frames): the pose of that much later is told
---@field dropout? number  # share of the poses that are missing: not registered
---@field dropout_length? number  # mean number of frames of a gap; 1

---A trajectory as telemetry would tell it.
---@param trajectory aib.Trajectory
---@param options? aib.PerturbOptions
---@return aib.Trajectory prior
function survey.perturb(trajectory, options) end

---@class aib.IntrinsicsDrift
---@field seed? integer  # 1
---@field focal_bias? number  # share of the focal length, of all frames
---@field focal_noise? number  # white, standard deviation, share
---@field focal_walk? number  # standard deviation after a frame, share
---@field centre_noise? number  # pixels
---@field centre_walk? number  # pixels, after a frame

---Cameras whose intrinsics drift, one a frame.
---@param camera aib.Camera
---@param names string[]  # of the images, in their order
---@param options? aib.IntrinsicsDrift
---@return table<string, aib.Camera> cameras
function survey.perturb_cameras(camera, names, options) end

return survey
