-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- KITTI odometry: translational and rotational error over segments of 100 to 800 m.
---
---   aib-lua kitti_odometry --estimate orb/00.txt,dso/00.txt --reference poses/00.txt
local aib = require "aib"
local drawings = require "aib.evaluation.drawings"
local trajectories = require "aib.trajectories"

--- Errors against the length of the segments, and the paths.
local function draw(estimate, by_length)
  local cell = estimate.cell
  if not cell:draws() then return end
  for _, part in ipairs {
    { "Translation", "translation_percent", "%" }, { "Rotation", "rotation_deg_per_m", "deg/m" },
  } do
    local at, values = {}, {}
    for i, segment in ipairs(by_length) do at[i], values[i] = segment.length, segment[part[2]] end
    cell:curve { title = part[1] .. " error against the length", x = { label = "length of the segments", unit = "m" },
      y = { label = "error", unit = part[3] }, at = at, values = values }
  end
  drawings.path(cell, estimate.est, estimate.ref)
  drawings.trajectory(cell, estimate.est, estimate.ref)
end

return aib.protocol {
  name = "kitti_odometry",
  title = "KITTI odometry",
  cite = "Geiger, Lenz, Urtasun, Are we ready for autonomous driving?, CVPR 2012",
  help = "Mean errors over the segments of the reference's path that begin every step-th frame; nothing is aligned.",
  inputs = trajectories.inputs {
    lengths = { kind = "list", of = "number", unit = "m", above = 0, help = "lengths of the segments",
      default = { 100, 200, 300, 400, 500, 600, 700, 800 } },
    step = { kind = "integer", default = 10, min = 1, help = "frames from one start to the next" },
  },
  run = function(input, report)
    local has_reference = false
    for estimate in trajectories.each(input, report) do
      local cell = estimate.cell
      local errors, reason = cell:attempt(function()
        return aib.pose.kitti_odometry(estimate.est, estimate.ref, { lengths = input.lengths, step = input.step })
      end)
      local function add(name, field, unit)
        local how = { unit = unit, better = "lower", note = reason }
        how.n = errors and errors.n
        cell:add(name, errors and errors[field], how)
        for _, part in ipairs(errors and errors.by_length or {}) do
          cell:add(("%s_%g"):format(name, part.length), part[field], { unit = unit, better = "lower", n = part.n })
        end
      end
      add("kitti.translation", "translation_percent", "%")
      add("kitti.rotation", "rotation_deg_per_m", "deg/m")
      if not has_reference then drawings.path(report, estimate.reference, estimate.ref, "reference") end
      has_reference = true
      draw(estimate, errors and errors.by_length or {})
    end
    report:table { title = "Translation", metrics = { "kitti.translation" }, beside = { { field = "n" } } }
    report:table { title = "Rotation", metrics = { "kitti.rotation" }, beside = { { field = "n" } } }
  end,
}
