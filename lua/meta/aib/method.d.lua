---@meta aib.method
error("Cannot require a meta file")

---What a method left in a folder, told from the content: COLMAP, GLOMAP and exports in their format, VGGT, Depth
---Anything 3 (also streaming), pi3, DUSt3R, MASt3R, MonST3R, CUT3R, MegaSaM, OpenMVS, OpenSfM and OpenDroneMap, a lone
---cloud, or anything by a table of patterns.
---@class aib.method
local method = {}

---Frames in one frame of reference. What the method did not leave is nil.
---@class aib.Batch
---@field name string  # of its folder; "0" where there is one alone
---@field names string[]  # of the images; indices from 0 where nothing tells them
---@field named boolean  # whether the names were told
---@field trajectory aib.Trajectory|nil  # in the order of names
---@field cameras table<string, aib.Camera>|nil  # of the size of the depth maps
---@field depth (fun(i: integer): aib.DepthMap|nil)|nil
---@field confidence (fun(i: integer): aib.DepthMap)|nil  # as stored
---@field rule "raw"|"sigmoid"|"percentile"  # what a confidence is
---@field point_map (fun(i: integer): aib.Array)|nil  # H x W x 3 in the camera's frame
---@field points aib.Cloud|nil  # a cloud that the method wrote, read at its first use
---@field warnings string[]

---@class aib.Method
---@field kind string  # "da3", "vggt", ...
---@field why string  # by what it was told
---@field batches aib.Batch[]

---Where things lie in a folder of any other method; see `aib.methods.layout`.
---@class aib.method.Layout
---@field poses? string  # file or folder
---@field format? string  # of the poses
---@field convention? "world_from_camera"|"camera_from_world"
---@field axes? "opencv"|"opengl"
---@field key? string
---@field quaternion? "xyzw"|"wxyz"
---@field cameras? string
---@field names? string[]|string  # or a text file with one a line
---@field depth? string|{ file: string, key: string }  # {stem}, {name}, {index}, {index:6} stand for the image
---@field confidence? string|{ file: string, key: string }
---@field rule? "raw"|"sigmoid"|"percentile"
---@field points? string

---Opens what a method left; folders batch_<i> are batches. Files without image names take a list, or names.txt beside
---them.
---@param folder string
---@param options? { kind?: string, names?: string[]|string, confidence?: "raw"|"sigmoid"|"percentile", layout?: aib.method.Layout, batches?: string, maps?: "geometric"|"photometric" }
---@return aib.Method
function method.open(folder, options) end

---Adds a method of your own, asked before the others: find(folder) says why the folder is one of it, open(folder,
---options) gives the batch.
---@param adapter { kind: string, find: (fun(folder: string): string|nil), open: fun(folder: string, options: table): aib.Batch }
function method.add(adapter) end

---Names of the methods that are known, in the order in which they are asked.
---@return string[] kinds
function method.kinds() end

---Whether an estimate is the truth itself, as it is where a method was given the poses.
---@param est aib.Trajectory
---@param ref aib.Trajectory
---@return boolean
function method.poses_are_given(est, ref) end

return method
