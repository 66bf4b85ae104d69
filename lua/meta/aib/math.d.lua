---@meta aib.math

---Transforms, poses and cameras.
---@class aib.math
local math = {}

---A similarity: `t * p` is scale * rotation * p + translation, for a point {x, y, z}, a pose, a trajectory, a cloud, a
---mesh or another transform.
---@class aib.Sim3
---@field scale number
---@field rotation number[][]  # three rows
---@field translation number[]
---@field angle_deg number  # of the rotation
local sim3 = {}

---What it is in a few numbers: the turn, and how far the origin moves.
---@return { scale: number, angle_deg: number, translation: number[], shift: number } summary
function sim3:summary() end

---The transform that undoes it.
---@return aib.Sim3 inverse
function sim3:inverse() end

---Its four rows.
---@return number[][] matrix
function sim3:matrix() end

---Where a camera stood and looked: world_from_camera, x right, y down, z forward.
---@class aib.Pose
---@field rotation number[][]  # three rows
---@field centre number[]
---@field is_registered boolean  # whether it is finite
local pose = {}

---The pose the other way round, camera_from_world.
---@return aib.Pose inverse
function pose:inverse() end

---Its four rows.
---@return number[][] matrix
function pose:matrix() end

---@class aib.CameraOptions
---@field model string  # COLMAP's name
---@field width? integer
---@field height? integer
---@field parameters number[]  # in COLMAP's order

---A camera of any of COLMAP's models.
---@param options aib.CameraOptions
---@return aib.Camera camera
function math.camera(options) end

---A similarity; what is left out changes nothing.
---@param options? { scale?: number, rotation?: number[][], translation?: number[] }
---@return aib.Sim3 transform
function math.sim3(options) end

---A pose; what is left out is the identity.
---@param options? { rotation?: number[][], centre?: number[] }
---@return aib.Pose pose
function math.pose(options) end

---Pixel of a point; nil where the camera does not see it.
---@param camera aib.Camera
---@param point number[]  # in the camera: right, down, forward
---@return number[]|nil pixel  # x, y
function math.project(camera, point) end

---Direction of the points that project to a pixel; nil where there is none.
---@param camera aib.Camera
---@param pixel number[]  # x, y; (0.5, 0.5) is the centre of the top left pixel
---@return number[]|nil direction  # in the camera, of length 1
function math.unproject(camera, pixel) end
