-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- How much error of a drone's telemetry a result stands. The true poses are perturbed as telemetry would be, ever
--- more; at every level the estimate is held against the truth beside the telemetry itself.
---
---   aib-lua telemetry truth/transforms.json --estimate sparse/0
---
--- lays one reconstruction upon each telemetry (a Sim(3) of positions) and scores where it comes to lie. For methods
--- that take telemetry as input, first write it, run the method once for each, then score what it left:
---
---   aib-lua telemetry truth/transforms.json --write priors
---   aib-lua telemetry truth/transforms.json --runs 'results/{run}/sparse/0'
local aib = require "aib"
local failure = require "aib.failure"
local suggest = require "aib.suggest"

--- What can be swept: options of aib.survey.perturb for a value, and its unit (of poses without stamps: per frame).
local kinds <const> = {
  position_noise = { unit = "m", of = function(x) return { position_noise = x } end },
  position_walk = { unit = "m/s^0.5", per_frame = "m/frame^0.5", of = function(x) return { position_walk = x } end },
  position_bias = { unit = "m", of = function(x) return { position_bias = { x, 0, 0 } } end },
  yaw_bias = { unit = "deg", of = function(x) return { yaw_bias = x } end },
  yaw_noise = { unit = "deg", of = function(x) return { yaw_noise = x } end },
  gimbal_bias = { unit = "deg", of = function(x) return { gimbal_bias = { x, 0, 0 } } end },
  gimbal_noise = { unit = "deg", of = function(x) return { gimbal_noise = { x, x, x } } end },
  lever_arm = { unit = "m", of = function(x) return { lever_arm = { 0, -x, 0 } } end },
  time_offset = { unit = "s", per_frame = "frames", of = function(x) return { time_offset = x } end },
  dropout = { unit = "share", of = function(x) return { dropout = x } end },
}

--- Errors of poses that break: name, relation of aib.pose.ape, unit, input that limits it.
local metrics <const> = {
  { name = "position", relation = "translation", unit = "m", limit = "limit" },
  { name = "angle", relation = "angle_deg", unit = "deg", limit = "limit_deg" },
}

local rounding <const> = 1e-9  -- errors below are none

local function sweep_of(text, truth)
  local function wrong(sentence) failure.usage("--sweep: " .. sentence) end
  local kind, values = text:match "^([%w_]+)=(.+)$"
  if not kind then wrong(("KIND=VALUE:VALUE... expected, found '%s'"):format(text)) end
  if not kinds[kind] then wrong(("unknown kind '%s'%s"):format(kind, suggest.hint(kind, suggest.keys(kinds)))) end
  local levels = {}
  for word in (values .. ":"):gmatch "([^:]*):" do
    levels[#levels + 1] = tonumber(word) or wrong(("a number expected, found '%s' in %s"):format(word, text))
  end
  table.sort(levels)
  return { kind = kind, levels = levels, unit = #truth.stamps == 0 and kinds[kind].per_frame or kinds[kind].unit }
end

--- The poses that both have, paired.
local function paired(est, ref)
  est, ref = aib.pose.associate(est, ref, { by = #ref.names > 0 and "name" or "stamp" })
  local both = {}
  for i = 1, #est do
    if est[i].is_registered and ref[i].is_registered then both[#both + 1] = i end
  end
  return est:select(both), ref:select(both)
end

--- { position =, angle = }: rms errors of poses that lie in the frame of the truth.
local function errors_of(est, truth)
  local mine, true_ones = paired(est, truth)
  local errors = {}
  for _, metric in ipairs(metrics) do
    errors[metric.name] = aib.pose.ape(mine, true_ones, { relation = metric.relation }).rmse
  end
  return errors
end

local function run_name(kind, level, seed) return ("%s_%g_%d"):format(kind, level, seed) end

--- The estimate for one telemetry, in the frame of that; nil where there is none.
local function estimate_for(input, estimate, prior, run)
  if input.runs ~= "" then
    local path = input.runs:gsub("{run}", run)
    if not (aib.system.is_file(path) or aib.system.is_folder(path)) then return nil end
    return aib.io.read_trajectory(path)
  end
  if not estimate then return nil end
  local mine, of_prior = paired(estimate, prior)
  local fit = aib.align.trajectory(mine, of_prior, { mode = "sim3", outlier_factor = input.outlier_factor,
    rotation_weight = input.rotation_weight > 0 and input.rotation_weight or nil })
  return fit.transform * estimate
end

local function mean(values)
  local sum = 0
  for _, value in ipairs(values) do sum = sum + value end
  return #values > 0 and sum / #values or nil
end

--- Mean errors over the seeds at one level: { prior = { position =, angle = }, estimate = { ... }, n = }.
local function level_errors(input, truth, estimate, kind, level, cell)
  local sums = { prior = {}, estimate = {} }
  for _, metric in ipairs(metrics) do sums.prior[metric.name], sums.estimate[metric.name] = {}, {} end
  local function collect(who, est)
    local errors = est and cell:attempt(function() return errors_of(est, truth) end, who)
    for name, value in pairs(errors or {}) do table.insert(sums[who][name], value) end
  end
  for seed = input.seed, input.seed + input.repeats - 1 do
    local options = kinds[kind].of(level)
    options.seed = seed
    local prior, run = aib.survey.perturb(truth, options), run_name(kind, level, seed)
    if input.write ~= "" then
      aib.system.make_folder(input.write .. "/" .. run)
      aib.io.write_trajectory(("%s/%s/prior.json"):format(input.write, run), prior, { format = "transforms" })
    end
    collect("prior", prior)
    collect("estimate", cell:attempt(function() return estimate_for(input, estimate, prior, run) end, "estimate"))
  end
  local means = { prior = {}, estimate = {}, n = #sums.estimate.position }
  for _, metric in ipairs(metrics) do
    for who in pairs(sums) do means[who][metric.name] = mean(sums[who][metric.name]) end
  end
  return means
end

--- The level at which values first pass a limit, by straight lines between levels; nil where none does.
local function break_point(levels, values, limit)
  for k = 1, #levels do
    local value = values[k]
    if value and value > limit then
      local before = values[k - 1]
      if not before then return levels[k] end
      return levels[k - 1] + (levels[k] - levels[k - 1]) * (limit - before) / (value - before)
    end
  end
  return nil
end

local function add_level(cell, means)
  for _, metric in ipairs(metrics) do
    local prior, estimate = means.prior[metric.name], means.estimate[metric.name]
    local how = { unit = metric.unit, better = "lower", n = means.n }
    cell:add("telemetry." .. metric.name, prior, how)
    cell:add("estimate." .. metric.name, estimate, how)
    -- 1: no error is left of the telemetry's; below 0: the telemetry alone was better. None where it has no error.
    local skill = estimate and prior and prior > rounding and 1 - estimate / prior or nil
    cell:add("skill." .. metric.name, skill, { better = "higher", n = means.n })
  end
end

local function add_break_points(input, cell, sweep, by_level)
  local unit = sweep.unit
  for _, metric in ipairs(metrics) do
    for _, who in ipairs { "prior", "estimate" } do
      local values, n = {}, 0
      for k, means in ipairs(by_level) do
        values[k] = means[who][metric.name]
        n = n + (values[k] and 1 or 0)
      end
      local limit = input[metric.limit]
      local found = break_point(sweep.levels, values, limit)
      local name = (who == "prior" and "telemetry" or "estimate") .. "." .. metric.name .. "_break"
      local reason = n == 0 and "there is no estimate" or not found and ("below %g %s up to %g %s"):format(
        limit, metric.unit, sweep.levels[#sweep.levels], unit) or nil
      cell:add(name, found, { better = "higher", n = n, options = { limit = limit, unit = unit }, note = reason })
    end
  end
end

local function draw(cell, sweep, by_level)
  for _, metric in ipairs(metrics) do
    for _, who in ipairs { "prior", "estimate" } do
      local at, values = {}, {}
      for k, means in ipairs(by_level) do
        if means[who][metric.name] then at[#at + 1], values[#values + 1] = sweep.levels[k], means[who][metric.name] end
      end
      if #at > 1 then
        cell:within({ method = who == "prior" and "telemetry" or "estimate" }):curve { at = at, values = values,
          title = ("%s error over %s"):format(metric.name, sweep.kind),
          x = { label = sweep.kind, unit = sweep.unit }, y = { label = "rmse", unit = metric.unit } }
      end
    end
  end
end

local function sweep_all(input, report)
  local truth = aib.io.read_trajectory(input.truth)
  local estimate = input.estimate ~= "" and aib.io.read_trajectory(input.estimate) or nil
  local sweeps = {}
  for i, text in ipairs(input.sweep) do sweeps[i] = sweep_of(text, truth) end
  for _, sweep in ipairs(sweeps) do
    local by_level = {}
    for k, level in ipairs(sweep.levels) do
      local name = ("%g %s"):format(level, sweep.unit)
      local cell = report:within { sweep = sweep.kind, level = name }
      by_level[k] = level_errors(input, truth, estimate, sweep.kind, level, cell)
      add_level(cell, by_level[k])
    end
    local cell = report:within { sweep = sweep.kind }
    add_break_points(input, cell, sweep, by_level)
    if report:draws() then draw(cell, sweep, by_level) end
  end
end

return aib.protocol {
  name = "telemetry",
  title = "Robustness to errors of telemetry",
  help = "Errors of an estimate beside those of the telemetry that places it, over levels of telemetry error.",
  inputs = {
    truth = { kind = "path", position = 1, help = "true poses: transforms.json, COLMAP model, TUM, ..." },
    estimate = { kind = "path", default = "", help = "poses of a reconstruction, laid upon each telemetry" },
    runs = { kind = "path", default = "",
      help = "instead: poses of a run with each telemetry, {run} stands for its name" },
    write = { kind = "path", default = "", help = "folder that gets each telemetry as RUN/prior.json" },
    sweep = { kind = "list", of = "text", help = "KIND=VALUE:VALUE:...; kinds are the options of aib.survey.perturb",
      default = { "position_noise=0:0.1:0.2:0.5:1:2:5", "position_walk=0:0.01:0.03:0.1:0.3:1",
        "yaw_bias=0:1:2:5:10:20", "time_offset=0:0.1:0.2:0.5:1:2", "dropout=0:0.2:0.5:0.8:0.95" } },
    limit = { kind = "number", unit = "m", default = 0.1, min = 0,
      help = "position error above which a result is broken" },
    limit_deg = { kind = "number", unit = "deg", default = 1, min = 0, help = "the same of angles" },
    repeats = { kind = "integer", default = 5, min = 1, help = "telemetries at each level" },
    seed = { kind = "integer", default = 1, min = 0, help = "of the first of them" },
    rotation_weight = { kind = "number", unit = "m", default = 0, min = 0,
      help = "orientations of the telemetry count in the fit, a radian as this length" },
    outlier_factor = { kind = "number", default = 3, min = 0,
      help = "poses farther than this times the median distance from the median position do not count in the fit" },
  },
  run = function(input, report)
    sweep_all(input, report)
    for _, metric in ipairs(metrics) do
      report:table { title = ("Error of the %s (%s)"):format(metric.name, metric.unit), down = { "sweep", "level" },
        across = { "metric" }, metrics = { { "telemetry." .. metric.name, label = "telemetry" },
          { "estimate." .. metric.name, label = "estimate" }, { "skill." .. metric.name, label = "skill" } } }
      report:table { title = ("Level at which the %s is off by more than %g %s"):format(metric.name,
        input[metric.limit], metric.unit), down = { "sweep" }, across = { "metric" },
        metrics = { { "telemetry." .. metric.name .. "_break", label = "telemetry" },
          { "estimate." .. metric.name .. "_break", label = "estimate" } } }
    end
    report:convention("skill", "1 - error of the estimate / error of the telemetry; means over the repeats")
    report:convention("break", "by straight lines between levels")
  end,
}
