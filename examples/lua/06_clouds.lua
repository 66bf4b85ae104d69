-- A fused cloud against points of the true surface, inside the box of the truth.
local aib = require "aib"

local estimate = aib.io.read_cloud "examples/data/methods/sgbm_gtposes/office_high/fused.ply"
local truth = aib.sample.mesh(aib.io.read_mesh "examples/data/gt/office/mesh.ply", { n = 20000 })

local result = aib.cloud.compare(estimate, truth, { tau = { 0.05, 0.2 } })
print(("accuracy %.3f m, completeness %.3f m, chamfer %.3f m")
  :format(result.accuracy, result.completeness, result.chamfer))
print(("F-score at 20 cm: %.3f"):format(result.f_score[0.2]))

local distances = aib.cloud.distances(estimate, truth)
print(("median %.3f m, 95 %% below %.3f m, %.1f %% below 5 cm")
  :format(distances:median(), distances:quantile(0.95), 100 * distances:share_below(0.05)))
