-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Where every protocol of trajectories begins: reads estimates and a reference, pairs their poses, aligns.
---
---   for estimate in trajectories.each(input, report) do
---     local est, ref = estimate.est, estimate.ref
---     estimate.cell:add("ape", function() return aib.pose.ape(est, ref).rmse end, { unit = "m" })
---   end
local aib = require "aib"

local M = {}

--- The inputs of reading and pairing, and those of the protocol.
function M.inputs(own)
  local inputs = {
    estimate = { kind = "list", of = "path", help = "trajectories to score, any format" },
    reference = { kind = "path", help = "the true trajectory, any format" },
    by = { kind = "choice", choices = { "auto", "stamp", "name", "index" }, default = "auto",
      help = "what pairs poses; auto: stamps where both have them, else names, else places" },
    max_gap = { kind = "number", unit = "s", default = 0.01, min = 0, help = "largest difference of paired stamps" },
    association = { kind = "choice", choices = { "one_to_one", "evo" }, default = "one_to_one",
      help = "evo: a pose of the longer trajectory may be paired again" },
  }
  for key, input in pairs(own) do inputs[key] = input end
  return inputs
end

--- The input of an alignment.
M.align = { kind = "choice", choices = { "none", "sim3", "se3", "yaw", "yaw_scale", "scale", "first" },
  default = "none",
  help = "what of an estimate is fitted to the reference before it is scored" }

local function way_of_pairing(est, ref, by)
  if by ~= "auto" then return by end
  if #est.stamps > 0 and #ref.stamps > 0 then return "stamp" end
  if #est.names > 0 and #ref.names > 0 then return "name" end
  return "index"
end

--- The name of a file, with a number where it stood before.
local function labels_of(paths)
  local labels, count = {}, {}
  for i, path in ipairs(paths) do
    local name = path:match("([^/]+)/*$") or path
    count[name] = (count[name] or 0) + 1
    labels[i] = count[name] == 1 and name or ("%s #%d"):format(name, count[name])
  end
  return labels
end

--- Iterates over the estimates: { est =, ref =, cell =, by = }, associated, with the report's cell of each.
function M.each(input, report)
  local reference = aib.io.read_trajectory(input.reference)
  local labels = labels_of(input.estimate)
  local i = 0
  return function()
    i = i + 1
    if not input.estimate[i] then return nil end
    local trajectory = aib.io.read_trajectory(input.estimate[i])
    local cell = report:within { method = labels[i] }
    local by = way_of_pairing(trajectory, reference, input.by)
    local est, ref, info = aib.pose.associate(trajectory, reference,
      { by = by, max_gap = input.max_gap, convention = input.association })
    cell:add("n_matched", info.n_matched, { n = #trajectory, options = { by = by } })
    return { est = est, ref = ref, cell = cell, trajectory = trajectory, reference = reference }
  end
end

--- The estimate as the mode moves it, with what the fit says in the report; nil where the fit is undefined.
function M.aligned(estimate, mode)
  if mode == "none" then return estimate.est end
  local cell = estimate.cell
  local fit = cell:attempt(function()
    return aib.align.trajectory(estimate.est, estimate.ref, { mode = mode })
  end, "alignment")
  if not fit then return nil end
  cell:add("align.scale", fit.transform.scale, { n = fit.n_inliers, options = { mode = mode } })
  for _, warning in ipairs(fit.warnings) do cell:note("alignment: " .. warning) end
  return fit.transform * estimate.est
end

return M
