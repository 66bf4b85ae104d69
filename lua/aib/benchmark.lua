-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A benchmark folder: its benchmark.lua is a data file, run without globals, that returns
---
---   name, cite, licence   texts
---   scenes    list of { name =, conditions = list of names|nil, poses =, cameras =, depth =, mesh =, points =,
---             crop = }, see aib.scene
---   methods   list of { name =, parameters = "estimated" | "ground truth", results = list }; a result is
---     scene, condition   which of them it is of
---     models      folder of COLMAP or GLOMAP models (0, 1, ...), or
---     poses       trajectory with image names, any format that aib.io.read_trajectory reads
---     cameras     cameras file or folder, where the poses bring none
---     depth       pattern of depth maps, {stem} and {name} stand for the image
---     output      instead of models and poses: folder of what a method left, see aib.method; kind, names, layout
---                 where the content does not tell; confidence (points of depth maps are kept above it) and
---                 confidence_rule ("raw", "sigmoid", "percentile": that share of a batch is left out)
---     cloud       point cloud; "model": the sparse points of the scored model
---     frame       "method" | "reference": the frame of cloud and depth (default: that of the parameters)
---     model       name of the sub-model whose frame it is (default: the scored one)
---
--- Every path is relative to the folder. What a result does not name, the method does not have; what it names has to be
--- there.
local aib = require "aib"
local failure = require "aib.failure"
local suggest = require "aib.suggest"

local M = {}

local benchmark_fields <const> = {
  name = "string", cite = "string", licence = "string", scenes = "table", methods = "table",
}
local scene_fields <const> = {
  name = "string", conditions = "table", poses = "string", cameras = "any", depth = "string", mesh = "string",
  points = "string", crop = "table", labels = "string", names = "any", samples = "number",
}
local method_fields <const> = { name = "string", parameters = "string", results = "table", cite = "string" }
local result_fields <const> = {
  scene = "string", condition = "string", models = "string", poses = "string", cameras = "any", depth = "string",
  cloud = "string", frame = "string", model = "string", output = "string", kind = "string", names = "any",
  layout = "table", confidence = "number", confidence_rule = "string",
}
local parameters <const> = { estimated = true, ["ground truth"] = true }
local rules <const> = { raw = true, sigmoid = true, percentile = true }
local frames <const> = { method = true, reference = true }

--- Runs a Lua data file without globals. Raises a format error where it is not one.
local function data_file(path)
  local function globals(_, name)
    error(("a benchmark is data: the global '%s' is not available"):format(tostring(name)), 2)
  end
  local chunk, mistake = load(aib.system.read_text(path), "@" .. path, "t", setmetatable({}, { __index = globals }))
  if not chunk then failure.raise("format", mistake) end
  local ok, result = pcall(chunk)
  if not ok then failure.raise("format", tostring(result)) end
  if type(result) ~= "table" then failure.raise("format", path .. ": a table expected, found " .. type(result)) end
  return result
end

--- Checks of one table against its fields; `fail(sentence)` names the place.
local function check_fields(t, fields, required, fail)
  if type(t) ~= "table" then fail("a table expected, found " .. type(t)) end
  local mistake = suggest.unknown_key(t, fields) or suggest.wrong_type(t, fields)
  if mistake then fail(mistake) end
  for _, field in ipairs(required) do
    if t[field] == nil then fail(field .. " is missing") end
  end
end

local function check_name(name, known, what, fail)
  if known[name] then return end
  fail(("%s: unknown '%s'%s"):format(what, tostring(name), suggest.hint(name, suggest.keys(known))))
end

local function check_result(result, scenes, fail)
  check_fields(result, result_fields, { "scene" }, fail)
  check_name(result.scene, scenes, "scene", fail)
  local conditions = scenes[result.scene].conditions
  if conditions then
    check_name(result.condition, suggest.set(conditions), "condition", fail)
  elseif result.condition then
    fail(("condition: scene '%s' has none"):format(result.scene))
  end
  if result.confidence_rule then check_name(result.confidence_rule, rules, "confidence_rule", fail) end
  if result.frame then check_name(result.frame, frames, "frame", fail) end
  if result.models and result.poses then fail("models or poses expected, found both") end
  if result.output and (result.models or result.poses) then fail("output or models and poses expected, found both") end
end

--- Names are those of groups in a report: two things of one name would be one.
local function check_unique(list, what, fail)
  local seen = {}
  for _, name in ipairs(list) do
    if seen[name] then fail(("two %s '%s'"):format(what, name)) end
    seen[name] = true
  end
end

local function check(benchmark, path)
  local function at(place)
    return function(sentence) failure.raise("format", ("%s: %s%s"):format(path, place, sentence)) end
  end
  check_fields(benchmark, benchmark_fields, { "scenes", "methods" }, at(""))
  local scenes = {}
  for i, scene in ipairs(benchmark.scenes) do
    check_fields(scene, scene_fields, { "name", "poses" }, at(("scene %d: "):format(i)))
    if scenes[scene.name] then at("")(("two scenes are called '%s'"):format(scene.name)) end
    check_unique(scene.conditions or {}, "conditions are called", at(("scene %s: "):format(scene.name)))
    scenes[scene.name] = scene
  end
  local names = {}
  for i, method in ipairs(benchmark.methods) do
    local place = at(("method %s: "):format(type(method) == "table" and method.name or i))
    check_fields(method, method_fields, { "name", "parameters", "results" }, place)
    check_name(method.parameters, parameters, "parameters", place)
    names[i] = method.name
    local places = {}
    for k, result in ipairs(method.results) do
      check_result(result, scenes, at(("method %s: result %d: "):format(method.name, k)))
      places[k] = result.scene .. (result.condition and " / " .. result.condition or "")
    end
    check_unique(places, "results are of", place)
  end
  check_unique(names, "methods are called", at(""))
end

local function result_of(method, scene, condition)
  for _, result in ipairs(method.results) do
    if result.scene == scene.name and result.condition == condition then return result end
  end
end

--- Every scene x condition x method, in the order of the file. A unit is { scene = table, condition = name|nil,
--- method = table, result = table|nil, group = { scene =, condition =, method = } }.
local function units_of(benchmark)
  local units = {}
  for _, scene in ipairs(benchmark.scenes) do
    for _, condition in ipairs(scene.conditions or { false }) do
      condition = condition or nil
      for _, method in ipairs(benchmark.methods) do
        units[#units + 1] = {
          scene = scene, condition = condition, method = method, result = result_of(method, scene, condition),
          group = { scene = scene.name, condition = condition, method = method.name },
        }
      end
    end
  end
  return units
end

--- Opens a benchmark folder: { name =, scenes =, methods =, units =, files = }. Raises an io or format error, a
--- sentence with the place, where it is not one.
function M.open(folder)
  local files = aib.files.new(folder)
  local path = files:path("benchmark.lua")
  local benchmark = data_file(path)
  check(benchmark, path)
  return {
    name = benchmark.name or "benchmark", cite = benchmark.cite, scenes = benchmark.scenes,
    methods = benchmark.methods, units = units_of(benchmark), files = files,
  }
end

return M
