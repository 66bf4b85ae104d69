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

---Writes poses. Without a format: .txt and .tum are tum, .kitti kitti, .json transforms, .npy npy
---(N x 4 x 4); a path without an extension is the folder of a COLMAP model, which needs cameras.
---Poses that are not registered are left out; KITTI and NPY cannot do that and say so.
---@param path string
---@param trajectory aib.Trajectory
---@param options? { format?: "tum"|"kitti"|"colmap"|"transforms"|"npy", cameras?: table<string, aib.Camera>, encoding?: "binary"|"text", convention?: "world_from_camera"|"camera_from_world", axes?: "opencv"|"opengl" }
function io.write_trajectory(path, trajectory, options) end

---An array of an NPY file, or of an NPZ file by its key (not needed where there is one alone).
---Pickled objects are never loaded.
---@param path string
---@param options? { key?: string }
---@return aib.Array
function io.read_array(path, options) end

---Names of the arrays in an NPZ file; of an NPY file there are none.
---@param path string
---@return string[]
function io.array_names(path) end

---Writes an NPY file.
---@param path string
---@param array aib.Array
function io.write_array(path, array) end

return io
