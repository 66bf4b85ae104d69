-- An aligner returns a transform, `transform * thing` applies it, a metric measures: three steps.
local aib = require "aib"

local model = aib.io.read_trajectory "examples/data/methods/glomap/crane/sparse"
local truth = aib.io.read_trajectory "examples/data/gt/crane/poses"
local est, ref = aib.pose.associate(model, truth, { by = "name" })

local plain = aib.align.trajectory(est, ref)
local robust = aib.align.trajectory(est, ref, { robust = true })
for _, fit in ipairs { plain, robust } do
  local error = aib.pose.ape(fit.transform * est, ref)
  print(("scale %.3f from %d cameras: median error %.3f m, rmse %.3f m")
    :format(fit.transform.scale, fit.n_inliers, error.median, error.rmse))
end
print(plain.warnings[1])
