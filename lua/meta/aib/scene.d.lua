---@meta aib.scene
error("Cannot require a meta file")

---The ground truth of a scene, from a table of patterns.
---@class aib.scene
local scene = {}

---@class aib.Scene
---@field names string[]  # images expected
---@field trajectory aib.Trajectory
---@field cameras table<string, aib.Camera>
---@field depth fun(name: string, files?: aib.Files): aib.DepthMap  # files: remembers the file instead of the scene's
---@field depth_names string[]  # images that have a depth map
---@field mesh aib.Mesh|nil
---@field points aib.Cloud|nil  # cropped

---Opens a scene: a folder with transforms.json and depth/*.exr, or a table with folder, poses, cameras, names, depth,
---mesh, points, crop. Everything is read at its first use.
---@param source string|table
---@param files? table  # of aib.files: remembers what was read
---@return aib.Scene
function scene.open(source, files) end

---The part of a cloud, in the scene's frame, inside the scene's crop box.
---@param of aib.Scene
---@param cloud aib.Cloud
---@return aib.Cloud
function scene.cropped(of, cloud) end

---Reads a point cloud that has points; one without is a format error.
---@param files table
---@param name string
---@return aib.Cloud
function scene.read_cloud(files, name) end

return scene
