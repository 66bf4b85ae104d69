-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The protocol telemetry: what noise does to telemetry, and to a reconstruction that is laid upon it.
local aib = require "aib"

local root = (arg[0]:match("^(.*)/[^/]*$") or ".") .. "/../.."
local protocol = assert(loadfile(root .. "/examples/protocols/telemetry.lua"))()
local truth <const> = root .. "/examples/data/gt/office/poses"
local model <const> = root .. "/examples/data/methods/colmap/office_high/sparse"

--- Values of a run by record, sweep and level: values["skill.position"]["position_noise"]["1 m"].
local function run(options)
  local values = {}
  for _, record in ipairs(protocol:run(options):records()) do
    local group = record.group or {}
    local of_name = values[record.name] or {}
    values[record.name] = of_name
    of_name[group.sweep] = of_name[group.sweep] or {}
    of_name[group.sweep][group.level or "all"] = record.value
  end
  return values
end

local function scratch()
  local path = os.tmpname()
  os.remove(path)
  aib.system.make_folder(path)
  return setmetatable({ path = path }, { __close = function() os.execute("rm -rf '" .. path .. "'") end })
end

return aib.test {
  ["white noise of 1 m is an error of sqrt(3) m, which averages out in a fit"] = function(t)
    local values = run { truth = truth, estimate = model, sweep = { "position_noise=0:1" }, repeats = 20 }
    local telemetry, estimate = values["telemetry.position"].position_noise, values["estimate.position"].position_noise
    t:near(telemetry["0 m"], 0, 1e-12)
    t:near(telemetry["1 m"], math.sqrt(3), 0.1)
    t:check(estimate["0 m"] < 0.02 and estimate["1 m"] > estimate["0 m"] and estimate["1 m"] < telemetry["1 m"])
    t:near(values["skill.position"].position_noise["1 m"], 1 - estimate["1 m"] / telemetry["1 m"], 1e-12)
  end,

  ["the break point lies between levels, where the line crosses the limit"] = function(t)
    local values = run { truth = truth, sweep = { "position_bias=0:0.5:4" }, limit = 1, repeats = 1 }
    t:near(values["telemetry.position_break"].position_bias.all, 1, 1e-9)
    t:equal(values["estimate.position_break"].position_bias.all, nil)
  end,

  ["what stays below its limit has no break point"] = function(t)
    local values = run { truth = truth, estimate = model, sweep = { "yaw_bias=0:5" }, repeats = 1 }
    t:near(values["telemetry.angle_break"].yaw_bias.all, 1, 1e-9)
    t:equal(values["estimate.angle_break"].yaw_bias.all, nil)
  end,

  ["telemetry is written, and runs with it are scored as they are"] = function(t)
    local folder <close> = scratch()
    local sweep = { "position_noise=0.3" }
    run { truth = truth, sweep = sweep, write = folder.path, repeats = 2 }
    local values = run { truth = truth, sweep = sweep, runs = folder.path .. "/{run}/prior.json", repeats = 2 }
    t:check(values["telemetry.position"].position_noise["0.3 m"] > 0.3)
    t:near(values["skill.position"].position_noise["0.3 m"], 0, 1e-9)
  end,

  ["a sweep of an unknown kind is refused with a suggestion"] = function(t)
    t:raises("position_noise", function() run { truth = truth, sweep = { "position_nose=1" } } end)
    t:raises("a number expected", function() run { truth = truth, sweep = { "dropout=much" } } end)
  end,
}
