---@meta aib.io
error("Cannot require a meta file")

---Readers and writers. The format is told from the content, then from the extension; options
---override. Errors name the file, the place and what was expected.
---@class aib.io
local io = {}

---Intrinsics of a camera, in pixels; pixel (0.5, 0.5) is the centre of the top left pixel. Made by
---`aib.math.camera`.
---@class aib.Camera
---@field model string  # COLMAP's name: "PINHOLE", "OPENCV", ...
---@field width integer  # 0 where the source does not say it
---@field height integer  # 0 where the source does not say it
---@field parameters number[]  # in COLMAP's order
---@field fx number|nil  # nil for a model without focal length
---@field fy number|nil
---@field cx number|nil
---@field cy number|nil

---Numbers of any shape, as NumPy saves them. `#a` is their number, `a[i]` the i-th in C order.
---@class aib.Array
---@field shape integer[]  # {} for a single number
---@field dtype string  # NumPy's name: "f4", "u1", "b1", ...
local array = {}

---What it is in a few numbers, of the finite ones.
---@return { shape: integer[], dtype: string, n: integer, n_finite: integer, mean: number|nil, std: number|nil, min: number|nil, max: number|nil } summary
function array:summary() end

---The sub-array at an index (from 1) of the first axis.
---@param index integer
---@return aib.Array
function array:at(index) end

---How poses are read. What is left out is told from the file or is the format's own.
---@class aib.io.TrajectoryOptions
---@field format? "tum"|"kitti"|"euroc"|"log"|"da3"|"colmap"|"transforms"|"opensfm"|"metashape"|"reality_capture"|"npy"|"npz"
---@field convention? "world_from_camera"|"camera_from_world"  # needed for NPY and unknown NPZ arrays
---@field axes? "opencv"|"opengl"
---@field quaternion? "xyzw"|"wxyz"  # TUM only; MonST3R and CUT3R write w first
---@field key? string  # NPZ only: the array of the poses
---@field names? string[]  # one a pose, for files that do not name their images
---@field width? integer  # pixels, for intrinsics of files that do not say it
---@field height? integer

---The poses of a file or folder, world_from_camera with OpenCV axes: TUM, KITTI, EuRoC csv (world
---from body), Tanks and Temples .log, Depth Anything 3's camera_poses.txt, COLMAP models (the
---largest of several), transforms.json, OpenSfM reconstruction.json (the largest component),
---Metashape XML, RealityCapture csv, NPY and NPZ stacks of 4 x 4 or 3 x 4 matrices.
---
---Rotations are projected to the nearest one, and refused further than 0.01 from it. A pose that is
---not finite stays in its place, not registered.
---@param path string
---@param options? aib.io.TrajectoryOptions
---@return aib.Trajectory
function io.read_trajectory(path, options) end

---Image name -> camera, of every format that has intrinsics. Images without a name are called by
---their index: "0", "1", ...
---@param path string
---@param options? aib.io.TrajectoryOptions
---@return table<string, aib.Camera>
function io.read_cameras(path, options) end

---A COLMAP or GLOMAP model, text or binary, of every version to 4.2.
---@class aib.io.ColmapModel
---@field path string  # folder that it was read from
---@field trajectory aib.Trajectory  # the registered images, sorted by name
---@field cameras table<string, aib.Camera>  # by image name
---@field points aib.Cloud  # with colors
---@field point_errors number[]  # px, one a point, below 0 where not known
---@field track_lengths integer[]  # one a point

---The largest of the models at a path: most images, then most points, then the lowest number. The
---path is a model's folder, or has numbered models, or has them in `sparse`. Where rigs and frames
---are there, their poses win over those in images, as in COLMAP.
---@param path string
---@return aib.io.ColmapModel
function io.read_colmap(path) end

---All models at a path, in the order of their numbers.
---@param path string
---@return aib.io.ColmapModel[]
function io.read_colmap_models(path) end

---The components of an OpenSfM or OpenDroneMap reconstruction, in the order of the file.
---@param path string  # reconstruction.json or its folder
---@return { trajectory: aib.Trajectory, cameras: table<string, aib.Camera> }[]
function io.read_opensfm_components(path) end

---Writes poses. Without a format: .txt and .tum are tum, .kitti kitti, .json transforms, .npy npy
---(N x 4 x 4); a path without an extension is the folder of a COLMAP model, which needs cameras.
---Poses that are not registered are left out; KITTI and NPY cannot do that and say so.
---@param path string
---@param trajectory aib.Trajectory
---@param options? { format?: "tum"|"kitti"|"colmap"|"transforms"|"npy", cameras?: table<string, aib.Camera>, encoding?: "binary"|"text", convention?: "world_from_camera"|"camera_from_world", axes?: "opencv"|"opengl" }
function io.write_trajectory(path, trajectory, options) end

---Writes the poses as waypoints of a drone: .csv (a line each), .kml (a line on a map) or .plan (QGroundControl: gimbal,
---waypoint and picture for each pose, heights from the origin). Poses are x east, y north, z up.
---@param path string
---@param trajectory aib.Trajectory
---@param options { origin: number[], speed?: number }  # {latitude, longitude, altitude} of 0, 0, 0; 2 m/s
function io.write_waypoints(path, trajectory, options) end

---An array of an NPY file, or of an NPZ file by its key (not needed where there is one alone).
---Pickled objects are never loaded. An array that inflates more than max_ratio (100) times is refused
---where it needs more than max_bytes (2^30).
---@param path string
---@param options? { key?: string, max_ratio?: number, max_bytes?: integer }
---@return aib.Array
function io.read_array(path, options) end

---Names of the arrays in an NPZ file; of an NPY file there are none.
---@param path string
---@return string[]
function io.array_names(path) end

---The numbers of a value, as NumPy holds them: of distances (N), of a cloud (N x 3, with its origin),
---of a depth map (height x width), of a trajectory (N x 4 x 4, world from camera), of a list of
---numbers or of lists of one size.
---@param value aib.Array|aib.Distances|aib.Cloud|aib.DepthMap|aib.Trajectory|table
---@return aib.Array
function io.array(value) end

---Writes an NPY file, for numpy.load.
---@param path string
---@param value aib.Array|aib.Distances|aib.Cloud|aib.DepthMap|aib.Trajectory|table  # as aib.io.array takes it
function io.write_array(path, value) end

---@class aib.io.CloudOptions
---@field up? "z"|"y"  # axis that points up in the file; "y" turns (x, y, z) to (x, -z, y)
---@field splats? "refuse"|"centres"  # PLY files of 3D Gaussian splats
---@field key? string  # NPZ only: the array
---@field max_points? integer  # a file of more is refused
---@field max_ratio? number  # NPZ, GLB: what comes to more, 100 times, is refused ...
---@field max_bytes? integer  # ... where it needs more than this, 2^30

---The points of a PLY, PCD, XYZ, CSV, PTS, LAS, NPY, NPZ (N x 3) or GLB file; of a mesh file (PLY,
---OBJ, GLB) its vertices. Points that are not finite stay, `warnings` counts them. LAZ and E57 are
---refused with advice how to convert them.
---@param path string
---@param options? aib.io.CloudOptions
---@return aib.Cloud
function io.read_cloud(path, options) end

---Writes a cloud as binary PLY, with double coordinates where it lies far from zero.
---@param path string
---@param cloud aib.Cloud
---@param options? { scalars?: table<string, aib.Distances|number[]>, colors?: integer[][], comments?: string[] }  # one value, one {red, green, blue} a point
function io.write_cloud(path, cloud, options) end

---A cloud that is written piece by piece: memory does not grow with it. `#writer` is the number of points so far.
---Without `commit` the old file stays.
---@class aib.CloudWriter
local cloud_writer = {}

---Adds points; every piece has the columns (normals, colours, labels) of the first.
---@param cloud aib.Cloud
---@return aib.CloudWriter self
function cloud_writer:add(cloud) end

---Makes it the file; nothing can be added afterwards.
function cloud_writer:commit() end

---Starts a binary PLY file with double coordinates.
---@param path string
---@return aib.CloudWriter writer
function io.cloud_writer(path) end

---The triangles of a PLY, OBJ, STL or GLB file; polygons become fans. Face labels of PLY and the
---nodes of GLB become labels. A file of more than max_points vertices or triangles is refused, and a
---GLB whose nodes repeat its meshes to more than max_bytes (2^30) and max_ratio (100) times its size.
---@param path string
---@param options? { up?: "z"|"y", max_points?: integer, max_ratio?: number, max_bytes?: integer }
---@return aib.Mesh
function io.read_mesh(path, options) end

---Writes a mesh as binary PLY.
---@param path string
---@param mesh aib.Mesh
---@param options? { vertex_colors?: integer[][], face_colors?: integer[][], face_scalars?: table<string, aib.Distances|number[]>, comments?: string[] }
function io.write_mesh(path, mesh, options) end

---@class aib.io.DepthOptions
---@field channel? string  # EXR: the channel; else *.Depth.Z, Z, *.V, Y, or R where R, G and B are equal
---@field key? string  # NPZ: the array; else depth, depths, local_points or the only one
---@field index? integer  # NPY, NPZ of several frames: which one, from 1
---@field scale? number  # stored value of one unit: PNG 1000 (TUM 5000, KITTI 256), others 1
---@field max_depth? number  # this and beyond becomes 0
---@field width? integer  # size of the result, by nearest neighbour
---@field height? integer
---@field rule? "centre"|"floor"  # of the nearest neighbour; "floor" is OpenCV's
---@field raw_width? integer  # files without header (ETH3D): their size
---@field raw_height? integer
---@field range_camera? aib.Camera  # the file holds distances along this camera's rays
---@field max_pixels? integer  # a larger map is refused; 2^27
---@field max_ratio? number  # EXR: a display window so many times its data is refused; NPZ: an array that inflates more, 100 times, is ...
---@field max_bytes? integer  # ... where it needs more than this, 2^30

---Planar depth of an EXR, PFM, NPY, NPZ, 16-bit PNG, COLMAP .bin or OpenMVS .dmap file. Background
---(Blender's 1e10, 65504 in half channels) becomes 0; `warnings` says what was removed or assumed.
---@param path string
---@param options? aib.io.DepthOptions
---@return aib.DepthMap
function io.read_depth(path, options) end

---All frames of an NPY or NPZ array; of any other file the one that it has.
---@param path string
---@param options? aib.io.DepthOptions
---@return aib.DepthMap[]
function io.read_stack(path, options) end

---The frames of one array of an NPY or NPZ file, read one at a time: `#s` frames, `s[i]` is a depth
---map (of a point map its z). Frames of a compressed file are cheap in their order.
---@class aib.FrameStack
---@field width integer
---@field height integer
local frame_stack = {}

---A frame as it is stored: H x W, or H x W x 3 of a point map.
---@param index integer
---@return aib.Array
function frame_stack:array(index) end

---A quantile of all finite numbers of all frames.
---@param q number  # 0..1
---@return number
function frame_stack:quantile(q) end

---Opens the frames of an array of N x H x W numbers; memory holds one of them.
---@param path string
---@param options? { key?: string }  # NPZ: the array; else depth, depths, local_points or the only one
---@return aib.FrameStack
function io.open_stack(path, options) end

---Writes depth as .exr (float, ZIP), .pfm, .npy or .png (16 bits).
---@param path string
---@param depth aib.DepthMap
---@param options? { scale?: number }  # PNG: stored value of one unit, 1000
function io.write_depth(path, depth, options) end

---Names of the channels of an EXR file.
---@param path string
---@return string[]
function io.exr_channels(path) end

---A PNG or JPEG: labels where it is gray (a number a pixel, as stored), else colours. One of more than
---max_pixels (2^27) is refused.
---@param path string
---@param options? { as?: "labels"|"color", max_pixels?: integer }  # "labels" also takes the indices of a palette
---@return aib.Image|aib.LabelImage
function io.read_image(path, options) end

---Writes colours (8 bits) or labels (16 bits) as PNG.
---@param path string
---@param image aib.Image|aib.LabelImage
function io.write_image(path, image) end

return io
