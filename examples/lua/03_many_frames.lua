-- Many frames: the mean of the frames' errors, and the error of all pixels together.
local aib = require "aib"

local errors = aib.depth.accumulate()
for frame = 4, 12, 4 do
  local name = ("%06d.exr"):format(frame)
  local estimate = aib.io.read_depth("examples/data/methods/sgbm_colmap/office_high/depth/" .. name)
  local truth = aib.io.read_depth("examples/data/gt/office/depth/" .. name)
  errors:add(estimate, aib.depth.downsample(truth, estimate.width, estimate.height))
end

print(("mean of frames: sRMSE %.4f"):format(errors:result().srmse))
print(("all pixels:     sRMSE %.4f"):format(errors:result { pooled = true }.srmse))
