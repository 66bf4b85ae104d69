-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- evo's evo_ape, evo_rpe and evo_traj in one: absolute and relative errors of trajectories, in one table.
---
---   aib-lua trajectory --estimate orb.txt,dso.txt --reference truth.txt --align sim3
local aib = require "aib"
local drawings = require "aib.evaluation.drawings"
local failure = require "aib.failure"
local trajectories = require "aib.trajectories"

local statistics <const> = { "rmse", "mean", "median", "std", "min", "max" }
local relations <const> = { "translation", "rotation_part", "full", "angle_deg", "angle_rad", "point_distance" }
local unit_of <const> = { translation = "m", angle_deg = "deg", angle_rad = "rad", point_distance = "m" }

local function add_errors(cell, name, compute, relation, options)
  local errors, reason = cell:attempt(compute)
  for _, statistic in ipairs(statistics) do
    cell:add(name .. "." .. statistic, errors and errors[statistic], {
      unit = unit_of[relation], better = "lower", n = errors and errors.count, options = options, note = reason,
    })
  end
end

local function score(estimate, input)
  local cell, ref = estimate.cell, estimate.ref
  cell:add("path_length", estimate.est:path_length(), { unit = "m", n = #estimate.est })
  local stamps = estimate.est.stamps
  if #stamps > 0 then cell:add("duration", stamps[#stamps] - stamps[1], { unit = "s", n = #stamps }) end
  local est = trajectories.aligned(estimate, input.align, {
    n = input.align_n, robust = input.robust, rotation_weight = input.rotation_weight, stand_off = input.stand_off,
    outlier_factor = input.outlier_factor > 0 and input.outlier_factor or nil,
  })
  if not est then return end
  drawings.trajectory(cell, est, ref)
  add_errors(cell, "ape", function() return aib.pose.ape(est, ref, { relation = input.relation }) end,
    input.relation, { align = input.align, relation = input.relation })
  local pairs_of_frames = { relation = input.relation, delta = input.delta, unit = input.unit,
    all_pairs = input.all_pairs, tolerance = input.tolerance, pairs_from = input.pairs_from }
  add_errors(cell, "rpe", function() return aib.pose.rpe(est, ref, pairs_of_frames) end, input.relation,
    { align = input.align, relation = input.relation, delta = input.delta, unit = input.unit,
      all_pairs = input.all_pairs })
end

local function metrics_of(name)
  local list = {}
  for i, statistic in ipairs(statistics) do list[i] = { name .. "." .. statistic, label = statistic } end
  return list
end

return aib.protocol {
  name = "trajectory",
  title = "Trajectory errors",
  cite = "Sturm et al., A benchmark for the evaluation of RGB-D SLAM systems, IROS 2012; evo",
  help = "Absolute and relative pose errors of one or more estimates against a reference, as evo defines them.",
  inputs = trajectories.inputs {
    align = trajectories.align,
    align_n = { kind = "integer", default = 0, min = 0, help = "align: fit to the first poses, so many; 0: all" },
    robust = { kind = "flag", help = "align: find the poses that agree, then fit to them" },
    outlier_factor = { kind = "number", default = 0, min = 0,
      help = "align: leave out poses farther than this times the median distance from the median position; 0: none" },
    rotation_weight = { kind = "number", unit = "m", default = 0, min = 0,
      help = "align: orientations count, a radian as this length" },
    stand_off = { kind = "number", unit = "m", default = 10, min = 0,
      help = "align: distance at which the error of a turn is foretold" },
    relation = { kind = "choice", choices = relations, default = "translation", help = "what of a motion counts" },
    delta = { kind = "number", default = 1, above = 0, help = "how far apart the poses of a relative error are" },
    unit = { kind = "choice", choices = { "frames", "m", "deg", "rad" }, default = "frames", help = "of delta" },
    all_pairs = { kind = "flag", help = "relative errors from every pose, not one pair after another" },
    pairs_from = { kind = "choice", choices = { "estimate", "reference" }, default = "estimate",
      help = "whose path tells which poses are a delta apart" },
    tolerance = { kind = "number", default = 0.1, min = 0, help = "all pairs: share of delta that a pair may miss" },
  },
  run = function(input, report)
    if input.unit == "frames" and not math.tointeger(input.delta) then
      failure.usage(("--delta: a whole number of frames expected, found %s"):format(input.delta))
    end
    for estimate in trajectories.each(input, report) do score(estimate, input) end
    local aligned = input.align == "none" and "not aligned" or input.align .. " aligned"
    local whole = { { "n_matched", label = "pairs" }, { "path_length", label = "path" }, "duration",
      { "align.scale", label = "scale" } }
    report:table { title = "Trajectories", metrics = whole, across = { "metric" } }
    report:table { title = ("APE, %s, %s"):format(input.relation, aligned), metrics = metrics_of "ape",
      across = { "metric" } }
    report:table { title = ("RPE, %s, delta %g %s"):format(input.relation, input.delta, input.unit),
      metrics = metrics_of "rpe", across = { "metric" } }
    report:convention("ape", "est^-1 ref of each paired pose")
    report:convention("rpe", "(ref_i^-1 ref_j)^-1 (est_i^-1 est_j)")
  end,
}
