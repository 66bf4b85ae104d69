---@meta aib.sample

---Making points.
---@class aib.sample
local sample = {}

---Exactly one of n, spacing and per_area.
---@class aib.MeshSampleOptions
---@field n? integer  # this many points
---@field spacing? number  # one a square of this side, in the unit of the mesh
---@field per_area? number  # this many a square unit
---@field method? "uniform"|"poisson"  # at random, or evenly (Poisson disk: spacing is then the least distance)
---@field seed? integer  # default 1

---@class aib.MeshSampleInfo
---@field area number  # of the mesh, square units
---@field density number  # points a square unit
---@field floor number  # an accuracy against these samples says nothing below it: 0.5 / sqrt(density), or measured

---Points on a mesh, spread by area, with normals and, where the mesh has them, labels.
---@param surface aib.Mesh
---@param options aib.MeshSampleOptions
---@return aib.Cloud points
---@return aib.MeshSampleInfo info
function sample.mesh(surface, options) end

---Points in random order that have none taken before within the spacing, as DTU thins them.
---@param points aib.Cloud
---@param options { spacing: number, seed?: integer }
---@return aib.Cloud kept
function sample.thin(points, options) end

---@class aib.VoxelOptions
---@field size number  # edge of a voxel
---@field anchor? "world"|"open3d"  # where the lattice begins: world 0 (default), or as Open3D's
---@field pick? "mean"|"centre"|"nearest"  # what stands for a voxel; nearest: its point nearest to the mean

---One point for each voxel that has any.
---@param points aib.Cloud
---@param options aib.VoxelOptions
---@return aib.Cloud points
function sample.voxel(points, options) end

---Voxels that clouds are added to, one after another: memory grows with the voxels, not with the points. `#grid` is
---their number.
---@class aib.VoxelGrid
---@field n_points integer  # added so far, finite ones
local voxel_grid = {}

---Adds the points of a cloud.
---@param cloud aib.Cloud
---@return aib.VoxelGrid self
function voxel_grid:add(cloud) end

---One point for each voxel: mean position and mean colour of its points.
---@return aib.Cloud cloud
function voxel_grid:cloud() end

---Starts a grid of voxels on the lattice of the world.
---@param options { size: number }
---@return aib.VoxelGrid grid
function sample.voxel_grid(options) end

---@class aib.UnprojectOptions
---@field confidence? aib.DepthMap
---@field min_confidence? number
---@field rule? "raw"|"sigmoid"|"percentile"  # what a confidence is
---@field stride? integer
---@field pixel_offset? number  # where in its pixel a depth lies, default 0.5
---@field depth? "planar"|"range"  # what a depth means
---@field image? aib.Image  # colours of the points

---The points of a depth map, in the world.
---@param depth aib.DepthMap
---@param camera aib.Camera
---@param pose aib.Pose  # world from camera
---@param options? aib.UnprojectOptions
---@return aib.Cloud points
---@return table info  # n_valid, n_unsure, n_unseen
function sample.unproject(depth, camera, pose, options) end

---The points of a point map (pi3, DUSt3R) in the world; confidence, min_confidence, rule and stride as of a depth map.
---@param points aib.Array  # H x W x 3, in the frame of the camera
---@param pose aib.Pose  # world from camera
---@param options? aib.UnprojectOptions
---@return aib.Cloud points
---@return table info  # n_valid, n_unsure, n_unseen
function sample.point_map(points, pose, options) end

return sample
