-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- How numbers of frames change over conditions of one scene (soiling levels): the frames are the same views, so that
--- differences are taken frame by frame, and neighbours are drawn together, since they overlap.
local aib = require "aib"
local suggest = require "aib.suggest"

local M = {}

--- Frames that every condition has, in the order of the first: list of { values by condition }.
local function paired(levels)
  local by_name = {}
  for k, level in ipairs(levels) do
    for i, name in ipairs(level.names) do
      by_name[name] = by_name[name] or {}
      by_name[name][k] = level.values[i]
    end
  end
  local frames = {}
  for _, name in ipairs(levels[1].names) do
    local values, complete = by_name[name], true
    for k = 1, #levels do complete = complete and values[k] ~= nil end
    if complete then frames[#frames + 1] = values end
  end
  return frames
end

--- Least-squares slope of values at 1, 2, ... n.
local function slope_of(values, n)
  local mean, sum, square = (n + 1) / 2, 0, 0
  for k = 1, n do
    sum, square = sum + (k - mean) * values[k], square + (k - mean) ^ 2
  end
  return sum / square
end

--- The mean of a series of frames and its bootstrap interval. Blocks (10 neighbours by default) are at most a quarter
--- of the series: longer ones would be the series itself and the interval a point.
function M.interval(values, options)
  local how = suggest.with({ block = 10 }, options)
  how.block = math.max(1, math.min(how.block, #values // 4))
  return aib.stats.bootstrap(values, how)
end

--- What the levels, each { condition =, names =, values = }, in order, tell of one metric:
---   change   from the first level to the last: { mean =, low =, high =, deviation = }, of paired differences
---   slope    per level, the same
---   within   the change is smaller than this at the interval's level, whatever its sign
---   n        frames in all levels
--- Nil where there are less than two levels or no frame in all of them.
function M.of(levels, options)
  if #levels < 2 then return nil end
  local frames = paired(levels)
  if #frames == 0 then return nil end
  local changes, slopes = {}, {}
  for i, values in ipairs(frames) do
    changes[i], slopes[i] = values[#levels] - values[1], slope_of(values, #levels)
  end
  local change, slope = M.interval(changes, options), M.interval(slopes, options)
  return {
    change = change, slope = slope, within = math.max(math.abs(change.low), math.abs(change.high)), n = #frames,
  }
end

--- Adds the records of one metric to a report and returns what they say; nil where nothing is paired. `depends` is what
--- the records depend on, as their options; `unit` that of the metric.
function M.add(report, metric, levels, depends, unit)
  local found = M.of(levels)
  if not found then return nil end
  local how = suggest.with({ from = levels[1].condition, to = levels[#levels].condition, level = 0.95 }, depends)
  local function add(name, value) report:add(("sensitivity.%s_%s"):format(metric, name), value, {
    unit = unit, n = found.n, options = how, convention = "paired frames, block bootstrap",
  }) end
  for _, what in ipairs { "change", "slope" } do
    add(what, found[what].mean)
    add(what .. "_low", found[what].low)
    add(what .. "_high", found[what].high)
  end
  add("within", found.within)
  local sure = found.change.low > 0 and "rises" or found.change.high < 0 and "falls" or "shows no sure change"
  return ("%s %s: %.3g (%.3g to %.3g), insensitive within %.3g"):format(metric, sure, found.change.mean,
    found.change.low, found.change.high, found.within)
end

return M
