-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Results held against each other by aib-lua compare.
local aib = require "aib"
local support = require "support"

local function record(method, name, value, more)
  local r = { name = name, value = value, better = "lower", group = { scene = "s", method = method } }
  for key, field in pairs(more or {}) do r[key] = field end
  return r
end

local function frames(method, values)
  local names = {}
  for i = 1, #values do names[i] = ("%06d.png"):format(i) end
  return { metric = "depth.srmse", group = { scene = "s", method = method }, names = names, values = values }
end

local function result_of(records, more)
  local result = { aib = { format = 1, version = aib.version }, protocol = { name = "p" }, records = records }
  for key, field in pairs(more or {}) do result[key] = field end
  return result
end

--- Writes results as a.json, b.json, ... and compares them: report and notes.
local function compare(results, options)
  local folder <close> = support.scratch_folder()
  local input = options or {}
  input.results = {}
  for i, result in ipairs(results) do
    input.results[i] = ("%s/%s.json"):format(folder.path, ("abc"):sub(i, i))
    aib.system.write_text(input.results[i], aib.json.encode(result))
  end
  local report = support.protocol("compare"):run(input)
  return report, table.concat(report:note_lines(), "\n")
end

local function value_of(report, name, file, method)
  for _, r in ipairs(report:records()) do
    if r.name == name and r.group.file == file and (not method or r.group.method == method) then return r.value end
  end
end

--- Not of any publication: written for this test, with cells that cannot be.
local made_up <const> = [[
# a made-up table
metric,scene,condition,method,value,convention
cloud.chamfer,Hall,"wet, dark",A,0.537,sum
cloud.f1_distance,Hall,"wet, dark",A,0.617,harmonic
pose.auc30,Hall,dry,B,0.810,paper
pose.auc30_joint,Hall,dry,B,0.820,"of ""both"" errors"
depth.coverage,Hall,dry,B,97.4 %,
depth.srmse,Hall,dry,B,-,
pose.registration_rate,Hall,dry,C,1.200,
cloud.accuracy,Hall,dry,D,0.020,
cloud.sampling_floor,Hall,dry,D,0.050,
cloud.completeness,Hall,dry,D,0.100,
cloud.chamfer,Hall,dry,D,0.120,
cloud.f1_distance,Hall,dry,D,0.033,
]]

--- What `published` says of a text: output, complaints, exit code; table.json is written.
local function published(folder, text)
  aib.system.write_text(folder.path .. "/table.csv", text)
  return support.aib_lua(support.root .. "/examples/protocols/published.lua", folder.path .. "/table.csv", "--cite",
    "nobody, a made-up table", "--json", folder.path .. "/table.json")
end

--- A series with noise of its own that begins at `from`.
local function series(from)
  local values = {}
  for i = 1, 40 do values[i] = from + 0.01 * math.sin(i * i) end
  return values
end

return aib.test {
  ["numbers that differ stand beside each other with the difference"] = function(t)
    local report, notes = compare {
      result_of { record("m", "x", 1), record("m", "y", 5) }, result_of { record("m", "x", 1.5), record("m", "y", 5) },
    }
    t:equal({ value_of(report, "x", "a"), value_of(report, "x", "b") }, { 1, 1.5 })
    t:equal(value_of(report, "x", "difference"), 0.5)
    t:equal(value_of(report, "y", "a"), nil)
    t:contains(notes, "1 of 2 numbers are equal")
  end,

  ["numbers of other conventions, options or units are refused, and it is said which"] = function(t)
    local function refused(a, b, sentence)
      local report, notes = compare {
        result_of({ record("m", "depth.srmse", 0.1, a) }, { frames = { frames("m", series(1)) } }),
        result_of({ record("m", "depth.srmse", 0.2, b) }, { frames = { frames("m", series(2)) } }),
      }
      t:equal(#report:records(), 0)
      t:contains(notes, sentence)
    end
    refused({ convention = "paper" }, { convention = "vggt" }, "other conventions: paper and vggt")
    refused({ options = { rule = "floor" } }, { options = { rule = "centre" } }, "rule = floor and centre")
    refused({ unit = "m" }, {}, "other units: m and none")
  end,

  ["differences of frames have an interval; chance is told"] = function(t)
    local function compared(values)
      return compare {
        result_of({ record("m", "depth.srmse", 1) }, { frames = { frames("m", series(1)) } }),
        result_of({ record("m", "depth.srmse", 1.1) }, { frames = { frames("m", values) } }),
      }
    end
    local report, notes = compared(series(1.1))
    t:near(value_of(report, "depth.srmse, difference", "b"), 0.1, 1e-12)
    t:near(value_of(report, "depth.srmse, low", "b"), 0.1, 1e-12)
    t:check(not notes:find("chance", 1, true), notes)
    local reversed = {}
    for i, value in ipairs(series(1)) do reversed[41 - i] = value end
    report, notes = compared(reversed)
    t:check(value_of(report, "depth.srmse, low", "b") < 0 and value_of(report, "depth.srmse, high", "b") > 0)
    t:contains(notes, "no more than chance tells it from a")
    t:equal(value_of(compared(series(1)), "depth.srmse, difference", "b"), nil)  -- equal frames have nothing to tell
  end,

  ["methods are ranked; equal ones share their places"] = function(t)
    local report = compare({ result_of {
      record("m1", "depth.srmse", 0.1), record("m2", "depth.srmse", 0.3), record("m3", "depth.srmse", 0.1),
      record("m1", "pose.auc30", 0.9, { better = "higher" }), record("m2", "pose.auc30", 0.8, { better = "higher" }),
    } }, { ranks = true })
    t:equal(value_of(report, "rank of depth.srmse", "a", "m1"), 1.5)
    t:equal(value_of(report, "rank of depth.srmse", "a", "m2"), 3)
    t:equal(value_of(report, "rank of depth.srmse", "a", "m3"), 1.5)
    t:equal(value_of(report, "rank of pose.auc30", "a", "m2"), 2)
  end,

  ["impossible cells of a printed table are counted, its rounding allowed for"] = function(t)
    local records = {
      record("m1", "cloud.chamfer", 0.100), record("m1", "cloud.f1_distance", 0.0504),  -- rounding alone
      record("m2", "cloud.chamfer", 0.537), record("m2", "cloud.f1_distance", 0.617),
      record("m3", "cloud.chamfer", 0.537), record("m3", "cloud.f1_distance", 0.300),
    }
    local _, notes = compare { result_of(records, { rounding = 0.0005 }) }
    t:contains(notes, "a: 2 groups have impossible numbers")
    t:contains(notes, "0.617 is above half of cloud.chamfer = 0.537")
    _, notes = compare { result_of(records) }
    t:contains(notes, "a: 3 groups have impossible numbers")
  end,

  ["a printed table becomes results: impossible cells are named one by one"] = function(t)
    local folder <close> = support.scratch_folder()
    local json, output, complaints, code = folder.path .. "/table.json", published(folder, made_up)
    t:equal({ complaints, code }, { "", 0 })
    t:contains(output, "3 groups have impossible numbers")
    local result = aib.results.read(json)
    t:equal({ result.rounding, result.protocol.cite, #result.records }, { 0.0005, "nobody, a made-up table", 12 })
    t:equal(result.records[1].group, { scene = "Hall", condition = "wet, dark", method = "A" })
    t:equal({ result.records[1].value, result.records[1].unit, result.records[1].better }, { 0.537, "m", "lower" })
    t:equal({ result.records[5].value, result.records[6].value }, { 0.974, nil })
    local report = support.protocol("compare"):run { results = { json } }
    local text = table.concat(report:note_lines(), "\n")
    for _, cell in ipairs {
      "Hall / wet, dark / A: impossible: cloud.f1_distance = 0.617 is above half of cloud.chamfer = 0.537",
      "Hall / dry / B: impossible: pose.auc30_joint = 0.82, of both errors at once, is above pose.auc30 = 0.81",
      "Hall / dry / C: impossible: pose.registration_rate = 1.2 is not a share of 0 to 1",
      "cloud.accuracy = 0.02 lies below cloud.sampling_floor = 0.05, what a perfect cloud gets",
      "3 groups have impossible numbers",
    } do
      t:contains(text, cell)
    end
  end,

  ["a table that is none is told by its line"] = function(t)
    local folder <close> = support.scratch_folder()
    for text, sentence in pairs {
      ["scene,value\n"] = "table.csv:1: columns metric and value expected in the first line",
      ["metric,value\ncloud.chamfer\n"] = "table.csv:2: 2 fields expected, found 1",
      ["metric,value\n# as printed\ncloud.chamfer,0.5 m\n"] = "table.csv:3: value: a number expected, found '0.5 m'",
    } do
      local _, complaints, code = published(folder, text)
      t:equal(code, 3)
      t:contains(complaints, sentence)
    end
  end,
}
