-- One depth map against the truth. Metrics never align: say how, or the numbers are as they are.
local aib = require "aib"

local estimate = aib.io.read_depth "examples/data/methods/sgbm_colmap/office_high/depth/000004.exr"
local truth = aib.io.read_depth "examples/data/gt/office/depth/000004.exr"
truth = aib.depth.downsample(truth, estimate.width, estimate.height)

local as_it_is = aib.depth.errors(estimate, truth)
local scaled = aib.depth.errors(estimate, truth, { align = "median" })
print(("as it is: abs_rel %.4f, delta1 %.3f, sRMSE %.4f"):format(as_it_is.abs_rel, as_it_is.delta1, as_it_is.srmse))
print(("median:   abs_rel %.4f, delta1 %.3f, sRMSE %.4f (scale %.4f)")
  :format(scaled.abs_rel, scaled.delta1, scaled.srmse, scaled.scale))
print(("%.1f %% of the truth is covered"):format(100 * as_it_is.coverage))
