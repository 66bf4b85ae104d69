-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The TUM RGB-D benchmark: absolute trajectory error after a rigid alignment, relative error over a second.
---
---   aib-lua tum_rgbd --estimate orb.txt,dso.txt --reference groundtruth.txt
local aib = require "aib"
local drawings = require "aib.evaluation.drawings"
local trajectories = require "aib.trajectories"

return aib.protocol {
  name = "tum_rgbd",
  title = "TUM RGB-D benchmark",
  cite = "Sturm et al., A benchmark for the evaluation of RGB-D SLAM systems, IROS 2012",
  help = "ATE (rmse) after a rigid alignment; drift in translation and rotation over a fixed number of frames.",
  inputs = trajectories.inputs {
    max_gap = { kind = "number", unit = "s", default = 0.02, min = 0, help = "largest difference of paired stamps" },
    delta = { kind = "integer", default = 30, min = 1, help = "frames that the drift is over; 30 are a second" },
  },
  run = function(input, report)
    for estimate in trajectories.each(input, report) do
      local cell, ref = estimate.cell, estimate.ref
      local drift = { delta = input.delta, all_pairs = true }
      local turn = { delta = input.delta, all_pairs = true, relation = "angle_deg" }
      cell:add("tum.ate_rmse", function()
        local fit = aib.align.trajectory(estimate.est, ref, { mode = "se3" })
        local est = fit.transform * estimate.est
        drawings.trajectory(cell, est, ref)
        return aib.pose.ape(est, ref).rmse
      end, { unit = "m", better = "lower", n = #ref, options = { align = "se3" } })
      cell:add("tum.rpe_translation_rmse", function() return aib.pose.rpe(estimate.est, ref, drift).rmse end,
        { unit = "m", better = "lower", options = { delta = input.delta } })
      cell:add("tum.rpe_rotation_rmse", function() return aib.pose.rpe(estimate.est, ref, turn).rmse end,
        { unit = "deg", better = "lower", options = { delta = input.delta } })
    end
  end,
}
