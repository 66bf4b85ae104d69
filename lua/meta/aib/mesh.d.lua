---@meta aib.mesh

---Triangle meshes and exact distances to them.
---@class aib.mesh
local mesh = {}

---Triangles over shared vertices; `transform * m` is the moved mesh.
---@class aib.Mesh
---@field n_triangles integer
---@field n_vertices integer
---@field label_names string[]
---@field n_open_edges integer  # 0 for a watertight mesh
---@field warnings string[]  # what the reader removed or doubts
local triangle_mesh = {}

---Box of the finite vertices.
---@return aib.Box box
function triangle_mesh:bounds() end

---What it is in a few numbers.
---@return { n_triangles: integer, n_vertices: integer, n_open_edges: integer, area: number, min: number[]|nil, max: number[]|nil } summary
function triangle_mesh:summary() end

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

---Signed distance from each point to a watertight mesh: positive outside, exact.
---@param points aib.Cloud
---@param surface aib.Mesh
---@return aib.Offsets offsets
function mesh.offsets(points, surface) end

---The cloud with the labels of the faces nearest to its points.
---@param points aib.Cloud
---@param surface aib.Mesh  # with labels
---@return aib.Cloud labelled
function mesh.with_labels(points, surface) end

---As `aib.cloud.compare_by_label`; an estimated point has the label of its nearest face.
---@param est aib.Cloud
---@param ref aib.Mesh  # with labels
---@param options aib.MeshCompareOptions
---@return aib.LabelComparison[] comparisons
function mesh.compare_by_label(est, ref, options) end

---One value a face, NaN where a face has no point.
---@class aib.FaceScores
---@field accuracy number[]  # mean distance of the estimated points nearest to the face
---@field completeness number[]  # mean distance from samples of the face to the estimate
---@field recall number[]  # share of these samples strictly below tau
---@field n_estimate integer[]
---@field n_samples integer[]

---@class aib.FaceScoreOptions: aib.DistanceOptions
---@field samples aib.Cloud  # points on the mesh, from aib.sample.mesh
---@field tau? number  # threshold of recall

---What a reconstruction got right, face by face: for `face_scalars` and `face_colors` of `aib.io.write_mesh`.
---@param est aib.Cloud
---@param ref aib.Mesh
---@param options aib.FaceScoreOptions
---@return aib.FaceScores scores
function mesh.face_scores(est, ref, options) end

return mesh
