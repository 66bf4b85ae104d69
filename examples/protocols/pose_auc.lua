-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- AUC of relative poses over all frame pairs, RRA and RTA, in every convention that one asks for.
---
---   aib-lua pose_auc --estimate vggt.npz,colmap/sparse/0 --reference transforms.json --convention paper,vggt
local aib = require "aib"
local drawings = require "aib.evaluation.drawings"
local trajectories = require "aib.trajectories"

--- The estimate against the whole reference where frames have names: missing frames count in colmap's convention.
local function pair_of(estimate, convention)
  local whole = convention == "colmap" and #estimate.ref.names > 0
  return estimate.est, whole and estimate.reference or estimate.ref
end

local function score(estimate, input)
  local cell, est, ref = estimate.cell, estimate.est, estimate.ref
  for _, convention in ipairs(input.convention) do
    local auc, reason = cell:attempt(function()
      local e, r = pair_of(estimate, convention)
      return aib.pose.auc(e, r, { convention = convention, max_deg = input.max_deg })
    end)
    local how = { better = "higher", n = auc and auc.n_pairs, convention = convention, note = reason,
      options = { max_deg = input.max_deg } }
    cell:add("auc." .. convention, auc and auc.auc, how)
    cell:add("auc_signed." .. convention, auc and auc.auc_signed, how)
  end
  if cell:draws() then
    cell:attempt(function()
      drawings.pose_recall(cell, aib.pose.auc(est, ref, { max_deg = input.max_deg }), est, ref)
    end)
  end
  local angles, reason = cell:attempt(function() return aib.pose.relative_angles(est, ref, { tau = input.tau }) end)
  for _, tau in ipairs(input.tau) do
    local how = { better = "higher", n = angles and angles.n_pairs, note = reason, options = { tau_deg = tau } }
    cell:add(("rra.%g"):format(tau), angles and angles.rra[tau], how)
    cell:add(("rta.%g"):format(tau), angles and angles.rta[tau], how)
  end
  if #est.names == 0 then return end
  for _, pair in ipairs(aib.pose.worst_pairs(est, ref, { n = input.worst })) do
    cell:note(("worst pair %s, %s: rotation %.1f deg, direction %s"):format(pair.first, pair.second,
      pair.rotation_deg, pair.translation_deg and ("%.1f deg"):format(pair.translation_deg) or "none"))
  end
end

local function named(prefix, list, format)
  local metrics = {}
  for i, item in ipairs(list) do metrics[i] = { (prefix .. format):format(item) } end
  return metrics
end

return aib.protocol {
  name = "pose_auc",
  title = "Relative pose AUC",
  cite = "Jin et al., Image matching across wide baselines, IJCV 2021; the conventions' own code",
  help = "Area under the recall curve of relative pose errors over all frame pairs; nothing has to be aligned.",
  inputs = trajectories.inputs {
    convention = { kind = "list", of = "choice", default = { "paper", "vggt" },
      choices = { "paper", "vggt", "posediffusion", "posediffusion_torch", "da3", "colmap", "exact" },
      help = "whose area it is: the convention is part of the number" },
    max_deg = { kind = "integer", default = 30, min = 1, max = 180, help = "end of the recall curve, degrees" },
    tau = { kind = "list", of = "number", unit = "deg", default = { 5, 15, 30 }, above = 0, max = 180,
      help = "thresholds of RRA and RTA" },
    worst = { kind = "integer", default = 3, min = 0, help = "worst pairs that are named" },
  },
  run = function(input, report)
    for estimate in trajectories.each(input, report) do score(estimate, input) end
    local areas = named("auc.", input.convention, "%s")
    areas[#areas + 1] = { "registration_rate", label = "registered" }
    report:table { title = ("AUC%d"):format(input.max_deg), metrics = areas, across = { "metric" } }
    report:table { title = "Relative rotations", metrics = named("rra.", input.tau, "%g"), across = { "metric" } }
    report:table { title = "Relative directions", metrics = named("rta.", input.tau, "%g"), across = { "metric" } }
  end,
}
