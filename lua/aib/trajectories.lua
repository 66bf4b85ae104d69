-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Where every protocol of trajectories begins: reads estimates and a reference, pairs their poses, aligns.
---
---   for estimate in trajectories.each(input, report) do
---     local est, ref = estimate.est, estimate.ref
---     estimate.cell:add("ape", function() return aib.pose.ape(est, ref).rmse end, { unit = "m" })
---   end
local aib = require "aib"
local failure = require "aib.failure"
local suggest = require "aib.suggest"

local M = {}

local function stored(whose, what, choices)
  return { kind = "choice", choices = { "stored", table.unpack(choices) }, default = "stored",
    help = ("%s of the %s's poses; stored: as the format has it"):format(what, whose) }
end

--- How the files of the estimates or of the reference are read.
local function add_reading(inputs, whose)
  inputs[whose .. "_convention"] = stored(whose, "direction", { "world_from_camera", "camera_from_world" })
  inputs[whose .. "_axes"] = stored(whose, "camera axes", { "opencv", "opengl" })
  inputs[whose .. "_key"] = { kind = "text", default = "", help = ("array of the %s's NPZ file"):format(whose) }
end

--- The inputs of reading and pairing, and those of the protocol.
function M.inputs(own)
  local inputs = {
    estimate = { kind = "list", of = "path", help = "trajectories to score, any format" },
    reference = { kind = "path", help = "the true trajectory, any format" },
    by = { kind = "choice", choices = { "auto", "stamp", "name", "index" }, default = "auto",
      help = "what pairs poses; auto: stamps where both have them, else names, else places" },
    max_gap = { kind = "number", unit = "s", default = 0.01, min = 0, help = "largest difference of paired stamps" },
    offset = { kind = "number", unit = "s", default = 0, help = "added to the stamps of the estimates" },
    names = { kind = "choice", choices = { "auto", "exact", "file", "stem" }, default = "auto",
      help = "how names are compared; file: without folders; stem: nor extension or case; auto: the first that pairs" },
    association = { kind = "choice", choices = { "one_to_one", "evo" }, default = "one_to_one",
      help = "evo: a pose of the longer trajectory may be paired again" },
  }
  add_reading(inputs, "estimate")
  add_reading(inputs, "reference")
  return suggest.with(inputs, own)
end

--- The input of an alignment.
M.align = { kind = "choice", choices = { "none", "sim3", "se3", "yaw", "yaw_scale", "scale", "first" },
  default = "none", help = "what of an estimate is fitted to the reference before it is scored" }

local function read(path, input, whose)
  local options = {}
  for _, name in ipairs { "convention", "axes", "key" } do
    local value = input[whose .. "_" .. name]
    if value ~= "stored" and value ~= "" then options[name] = value end
  end
  local ok, found = pcall(aib.io.read_trajectory, path, options)
  if ok then return found end
  if failure.kind(found) == "argument" then failure.usage(("%s: %s"):format(whose, failure.message(found))) end
  error(found, 0)
end

local list_of <const> = { stamp = "stamps", name = "names" }

--- Raises a format error where poses lack what is to pair them.
local function check_pairing(trajectory, path, by)
  local list = list_of[by]
  if list and #trajectory[list] == 0 then
    failure.raise("format", ("%s: --by %s: %s expected, found poses without"):format(path, by, list))
  end
end

local function way_of_pairing(est, ref, by)
  if by ~= "auto" then return by end
  if #est.stamps > 0 and #ref.stamps > 0 then return "stamp" end
  if #est.names > 0 and #ref.names > 0 then return "name" end
  return "index"
end

local rules_of_names <const> = {
  exact = {},
  file = { ignore_folder = true },
  stem = { ignore_folder = true, ignore_extension = true, ignore_case = true },
}
local from_strict_to_loose <const> = { "exact", "file", "stem" }

--- The rule of names that is asked for, or the strictest that pairs any; the strictest where none does.
local function names_rule(est, ref, asked)
  if asked ~= "auto" then return asked end
  for _, rule in ipairs(from_strict_to_loose) do
    if aib.pose.registration_rate(est, ref, rules_of_names[rule]).n_registered > 0 then return rule end
  end
  return "exact"
end

--- The pairs of a trajectory and the reference, noted in the report's cell; nil where there is none.
local function associated(trajectory, path, reference, input, cell)
  check_pairing(trajectory, path, input.by)
  check_pairing(reference, input.reference, input.by)
  local by = way_of_pairing(trajectory, reference, input.by)
  local rule = by == "name" and names_rule(trajectory, reference, input.names)
  local options = suggest.with({ by = by, max_gap = input.max_gap, offset = input.offset,
    convention = input.association }, rules_of_names[rule])
  local est, ref, info
  cell:attempt(function() est, ref, info = aib.pose.associate(trajectory, reference, options) end, "pairing")
  cell:add("n_matched", info and info.n_matched or 0, { n = #trajectory, options = { by = by, names = rule or nil } })
  if not rule then return est, ref end
  local registered = aib.pose.registration_rate(trajectory, reference, rules_of_names[rule])
  cell:add("registration_rate", registered.rate, { better = "higher", n = registered.n_total })
  if rule ~= "exact" and input.names == "auto" then
    cell:note(("names are compared as --names %s does: none is the same as it stands"):format(rule))
  end
  return est, ref
end

--- As much of each path's end as tells it from the others.
local function labels_of(paths)
  local labels, count = {}, {}
  for i, path in ipairs(paths) do
    local name = path:match("([^/]+)/*$") or path
    labels[i] = name
    count[name] = (count[name] or 0) + 1
  end
  local seen = {}
  for i, path in ipairs(paths) do
    if count[labels[i]] > 1 then labels[i] = path:match("([^/]+/+[^/]+)/*$") or labels[i] end
    seen[labels[i]] = (seen[labels[i]] or 0) + 1
    if seen[labels[i]] > 1 then labels[i] = ("%s #%d"):format(labels[i], seen[labels[i]]) end
  end
  return labels
end

--- Iterates over the estimates: { est =, ref =, cell =, trajectory =, reference = }, associated, with the report's cell
--- of each, and the whole trajectories. One that pairs with nothing is noted and passed over.
function M.each(input, report)
  local reference = read(input.reference, input, "reference")
  local labels = labels_of(input.estimate)
  local i = 0
  return function()
    while input.estimate[i + 1] do
      i = i + 1
      local trajectory = read(input.estimate[i], input, "estimate")
      local cell = report:within { method = labels[i] }
      local est, ref = associated(trajectory, input.estimate[i], reference, input, cell)
      if est then return { est = est, ref = ref, cell = cell, trajectory = trajectory, reference = reference } end
    end
  end
end

--- The estimate as the mode moves it, with what the fit says in the report; nil where the fit is undefined. `options`
--- are others of aib.align.trajectory.
function M.aligned(estimate, mode, options)
  if mode == "none" then return estimate.est end
  local cell = estimate.cell
  local how = suggest.with({ mode = mode }, options)
  local fit = cell:attempt(function() return aib.align.trajectory(estimate.est, estimate.ref, how) end, "alignment")
  if not fit then return nil end
  cell:add("align.scale", fit.transform.scale, { n = fit.n_inliers, options = how })
  cell:add("align.rmse", fit.rmse, { unit = "m", n = fit.n_inliers, options = how })
  for _, warning in ipairs(fit.warnings) do cell:note("alignment: " .. warning) end
  return fit.transform * estimate.est
end

return M
