-- The distance to the surface itself, not to points that were drawn from it.
local aib = require "aib"

local mesh = aib.io.read_mesh "examples/data/gt/office/mesh.ply"
local cloud = aib.io.read_cloud "examples/data/methods/sgbm_gtposes/office_high/fused.ply"

local exact = aib.mesh.distances(cloud, mesh)
print(("to the surface:  mean %.4f m"):format(exact:mean()))
for _, n in ipairs { 2000, 20000, 200000 } do
  local points = aib.sample.mesh(mesh, { n = n })
  print(("to %6d points: mean %.4f m"):format(n, aib.cloud.distances(cloud, points):mean()))
end
