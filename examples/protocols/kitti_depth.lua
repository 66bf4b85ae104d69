-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- KITTI depth prediction and completion: 16-bit PNGs of 256 steps a metre (other formats: metres).
---
---   aib-lua kitti_depth results val_selection_cropped/groundtruth_depth
local aib = require "aib"
local depth_frames = require "aib.depth_frames"

--- The tool's units: percent, millimetres, 1 / km.
local metrics <const> = { "silog", "sq_rel", "abs_rel", "irmse", "imae", "rmse", "mae", "coverage" }
local factors <const> = { sq_rel = { 100, "%" }, abs_rel = { 100, "%" }, irmse = { 1000, "1/km" },
  imae = { 1000, "1/km" }, rmse = { 1000, "mm" }, mae = { 1000, "mm" } }

--- Steps a metre of a folder's maps: KITTI's of PNGs.
local function steps(frames, key, given)
  if given > 0 then return given end
  return frames[1][key]:lower():match("%.png$") and 256 or 1
end

return aib.protocol {
  name = "kitti_depth",
  title = "KITTI depth",
  cite = "Uhrig et al., Sparsity invariant CNNs, 3DV 2017; KITTI depth development kit",
  help = "SILog, squared and absolute relative error, iRMSE (prediction); RMSE, MAE, iMAE (completion); means over "
    .. "frames. The development kit fills holes of an estimate from its neighbours: here they lower the coverage.",
  inputs = depth_frames.inputs {},
  run = function(input, report)
    local frames = depth_frames.pair(input)
    input.estimate_scale = steps(frames, "estimate", input.estimate_scale)
    input.reference_scale = steps(frames, "reference", input.reference_scale)
    local options = depth_frames.reading(input, { preset = "kitti" })
    local errors = depth_frames.evaluate(frames, options)
    local result = report:attempt(function() return errors:result() end, "depth")
    depth_frames.report(result, report, { metrics = metrics, factors = factors, n = result and result.n_defined,
      convention = "KITTI, mean over frames" })
    depth_frames.report_frames(frames, result, report)
    depth_frames.write(errors, frames, options, input)
  end,
}
