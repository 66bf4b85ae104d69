---@meta aib.mesh

---Triangle meshes and exact distances to them.
---@class aib.mesh
local mesh = {}

---Triangles over shared vertices; `transform * m` is the moved mesh.
---@class aib.Mesh
---@field n_triangles integer
---@field n_vertices integer
---@field label_names string[]
---@field warnings string[]  # what the reader removed or doubts
local triangle_mesh = {}

---Box of the finite vertices.
---@return aib.Box box
function triangle_mesh:bounds() end

---Area of all triangles, square units.
---@return number area
function triangle_mesh:area() end

---The mesh in another frame, as `transform * mesh`.
---@param transform aib.Sim3
---@return aib.Mesh moved
function triangle_mesh:transformed(transform) end

---Distance from each point to the surface: exact point-to-triangle distances, no floor by sampling.
---@param points aib.Cloud
---@param surface aib.Mesh
---@param options? aib.DistanceOptions
---@return aib.Distances distances
function mesh.distances(points, surface, options) end

---@class aib.MeshCompareOptions: aib.CompareOptions
---@field samples aib.Cloud  # points on the mesh, from aib.sample.mesh

---As `aib.cloud.compare`: accuracy and precision to the surface itself, completeness and recall by the samples.
---@param est aib.Cloud
---@param ref aib.Mesh
---@param options aib.MeshCompareOptions
---@return aib.Comparison comparison
function mesh.compare(est, ref, options) end

return mesh
