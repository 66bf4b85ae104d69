-- Read what a method left on disk. The format is told from the content; every object prints itself.
local aib = require "aib"

local model = aib.io.read_colmap "examples/data/methods/colmap/office_high/sparse"
print(model.trajectory)
print(model.trajectory.names[1], model.cameras[model.trajectory.names[1]])

print(aib.io.read_depth "examples/data/gt/office/depth/000000.exr")
print(aib.io.read_cloud "examples/data/methods/sgbm_colmap/office_high/fused.ply")
print(aib.io.read_mesh "examples/data/gt/office/mesh.ply")
