---@meta aib.packed

---Data as the page of a report carries it: numbers in steps of their range, deflated, in base64.
---@class aib.packed
local packed = {}

---Numbers in 65535 steps from `low` to `high`, 16 bits little-endian; 65535 is NaN.
---@class aib.PackedValues
---@field low number
---@field high number
---@field data string

---Positions in 65535 steps of the box on each axis.
---@class aib.PackedPoints
---@field n integer  # points that are kept
---@field n_given integer
---@field voxel number  # edge of the voxels of which each keeps a point; 0: all are kept
---@field box aib.Box
---@field positions string
---@field values aib.PackedValues|nil

---At most so many points of a cloud, the first in each voxel, with the values of those.
---@param cloud aib.Cloud
---@param options? { limit: integer, values: aib.Distances|aib.Offsets|number[] }  # 100 000 points
---@return aib.PackedPoints packed
function packed.points(cloud, options) end

---Vertices as positions, triangles as 32-bit indices.
---@param mesh aib.Mesh
---@return { n_vertices: integer, n_triangles: integer, box: aib.Box, positions: string, triangles: string } packed
function packed.mesh(mesh) end

---Numbers alone.
---@param values aib.Distances|aib.Offsets|number[]
---@return aib.PackedValues packed
function packed.values(values) end

---A frame's depths and relative errors, a byte each: 0..254, 255 for nothing. Depths are in steps of their logarithm
---from `near` to `far`, errors from -`largest` to `largest`.
---@param est aib.DepthMap
---@param ref aib.DepthMap
---@param options? { width: integer, transform: aib.Affine }  # at most 240 columns
---@return { width: integer, height: integer, near: number, far: number, largest: number, estimate: string, reference: string, error: string } frame
function packed.depth(est, ref, options) end

return packed
