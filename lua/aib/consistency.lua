-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Finds numbers that cannot stand together: a harmonic mean above the arithmetic one, a share above 1, a joint
--- recall above its marginals. Every table that aib prints goes through it.
local number = require "aib.report.number"

local M = {}

local function at_most(a, b, slack) return a <= b + slack + 1e-9 * math.abs(b) end

--- Each rule needs some metrics and holds for them within `slack`, else it says what is impossible.
local rules <const> = {
  { "cloud.f1_distance", "cloud.chamfer",
    holds = function(f1, chamfer, slack) return at_most(f1, chamfer / 2, 1.5 * slack) end,
    says = "%s is above half of %s: a harmonic mean never exceeds the arithmetic mean" },
  { "cloud.f1_distance", "cloud.chamfer_mean",
    holds = function(f1, mean, slack) return at_most(f1, mean, 2 * slack) end,
    says = "%s is above %s: a harmonic mean never exceeds the arithmetic mean" },
  { "cloud.chamfer", "cloud.accuracy", "cloud.completeness",
    holds = function(chamfer, a, c, slack) return at_most(math.abs(chamfer - a - c), 0, 3 * slack + 1e-9 * chamfer) end,
    says = "%s is not the sum of %s and %s" },
  { "depth.delta1", "depth.delta2",
    holds = at_most, says = "%s is above %s, which counts the same pixels and more" },
  { "depth.delta2", "depth.delta3",
    holds = at_most, says = "%s is above %s, which counts the same pixels and more" },
  { "depth.si_log_rmse", "depth.srmse",
    holds = function(root, square, slack) return at_most(root * root, square, slack * (2 * root + 1)) end,
    says = "%s squared is above %s: the mean of roots never exceeds the root of the mean" },
  { "depth.mae", "depth.rmse",
    holds = at_most, says = "%s is above %s: a mean never exceeds the quadratic mean" },
  { "pose.auc30_joint", "pose.auc30",
    holds = at_most, says = "%s, of both errors at once, is above %s, of each on its own" },
  { "pose.rra5", "pose.rra15", holds = at_most, says = "%s is above %s at a wider threshold" },
  { "pose.rra15", "pose.rra30", holds = at_most, says = "%s is above %s at a wider threshold" },
  { "pose.rta5", "pose.rta15", holds = at_most, says = "%s is above %s at a wider threshold" },
  { "pose.rta15", "pose.rta30", holds = at_most, says = "%s is above %s at a wider threshold" },
}

local shares <const> = {
  "depth.coverage", "depth.delta1", "depth.delta2", "depth.delta3", "pose.auc30", "pose.auc30_joint",
  "pose.registration_rate",
}

local function named(name, value) return ("%s = %s"):format(name, number.short(value)) end

local function check_rule(rule, values, slack)
  local present, names = {}, {}
  for i, name in ipairs(rule) do
    if not values[name] then return nil end
    present[i], names[i] = values[name], named(name, values[name])
  end
  present[#present + 1] = slack
  if rule.holds(table.unpack(present)) then return nil end
  return rule.says:format(table.unpack(names))
end

--- Sentences about what is impossible among the numbers of one group: value by metric name. The second list is of
--- what is no contradiction but tells nothing: an accuracy below that of a perfect cloud against the samples.
---
--- rounding   half a unit of the last digit where the numbers were read from a printed table (0.0005 for three digits)
function M.check(values, rounding)
  local slack, found, empty = rounding or 0, {}, {}
  for _, rule in ipairs(rules) do found[#found + 1] = check_rule(rule, values, slack) end
  for _, name in ipairs(shares) do
    local value = values[name]
    if value and not (at_most(0, value, slack) and at_most(value, 1, slack)) then
      found[#found + 1] = named(name, value) .. " is not a share of 0 to 1"
    end
  end
  local accuracy, floor = values["cloud.accuracy"], values["cloud.sampling_floor"]
  if accuracy and floor and accuracy < floor then
    empty[1] = ("%s lies below %s, what a perfect cloud gets against these samples: see the exact distance"):format(
      named("cloud.accuracy", accuracy), named("cloud.sampling_floor", floor))
  end
  return found, empty
end

--- Checks every group of a report and notes what is impossible; `rounding` as of check. Returns how many sentences
--- there were, and in how many groups.
function M.check_report(report, rounding)
  local groups, order = {}, {}
  for _, record in ipairs(report:records()) do
    local group = groups[record.group_id]
    if not group then
      group = { values = {}, name = report:within(record.group):group_name() }
      groups[record.group_id] = group
      order[#order + 1] = group
    end
    group.values[record.name] = record.value
  end
  local count, n_groups = 0, 0
  for _, group in ipairs(order) do
    local found, empty = M.check(group.values, rounding)
    for _, sentence in ipairs(found) do report:note(group.name, "impossible: " .. sentence) end
    for _, sentence in ipairs(empty) do report:note(group.name, sentence) end
    count = count + #found
    if #found > 0 then n_groups = n_groups + 1 end
  end
  return count, n_groups
end

return M
