-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What --json writes is what examples/results.schema.json says.
local aib = require "aib"
local support = require "support"

local path <const> = support.root .. "/examples/results.schema.json"
local schema <const> = aib.json.decode(aib.system.read_text(path), path)

local is = {}
function is.string(v) return type(v) == "string" end
function is.number(v) return type(v) == "number" end
function is.integer(v) return math.type(v) == "integer" end
function is.null(v) return v == aib.json.null end
function is.array(v) return type(v) == "table" and v ~= aib.json.null and (#v > 0 or next(v) == nil) end
function is.object(v) return type(v) == "table" and v ~= aib.json.null and #v == 0 end

local function has_type(value, types)
  for _, name in ipairs(type(types) == "table" and types or { types }) do
    if is[name](value) then return true end
  end
  return false
end

local function contains(list, value)
  for _, each in ipairs(list) do
    if each == value then return true end
  end
  return false
end

local check

local function check_object(value, rule, at, wrong)
  for _, name in ipairs(rule.required or {}) do
    if value[name] == nil then wrong(at, name .. " is missing") end
  end
  for name, field in pairs(value) do
    local own = rule.properties and rule.properties[name] or rule.additionalProperties
    if own == false then wrong(at, "unknown field " .. tostring(name)) end
    if type(own) == "table" then check(field, own, at .. "." .. tostring(name), wrong) end
  end
end

--- Calls wrong(place, sentence) for everything in which a value breaks a rule; knows what the schema uses.
function check(value, rule, at, wrong)
  if rule["$ref"] then return check(value, schema["$defs"][rule["$ref"]:match "[^/]*$"], at, wrong) end
  if rule.type and not has_type(value, rule.type) then return wrong(at, "another type") end
  if rule.const ~= nil and value ~= rule.const then wrong(at, "another value") end
  if rule.enum and not contains(rule.enum, value) then wrong(at, "none of the names") end
  if rule.minimum and value < rule.minimum then wrong(at, "too small") end
  if rule.pattern == "^[0-9a-f]{64}$" and not (#value == 64 and value:find "^[0-9a-f]+$") then wrong(at, "no hash") end
  if is.array(value) and rule.items then
    for i, element in ipairs(value) do check(element, rule.items, ("%s[%d]"):format(at, i), wrong) end
  end
  if is.object(value) then check_object(value, rule, at, wrong) end
end

local function mistakes_of(result)
  local list = {}
  check(result, schema, "results", function(at, sentence) list[#list + 1] = at .. ": " .. sentence end)
  return list
end

local function results_of(...)
  local report = support.protocol("asset_inspection"):run(...)
  return aib.json.decode(require "aib.report.json"(report))
end

return aib.test {
  ["results, with numbers of frames and details, follow the schema"] = function(t)
    local result = results_of { benchmark = support.root .. "/examples/data", samples = 2000, per_frame = true,
      details = true }
    t:equal(mistakes_of(result), {})
    t:check(#result.records > 300)
    local metrics = {}
    for _, frames in ipairs(result.frames) do metrics[frames.metric] = (metrics[frames.metric] or 0) + 1 end
    t:equal({ metrics["depth.srmse"], metrics["pose.ape_rmse"], metrics["pose.registration_rate"] }, { 5, 6, 6 })
  end,

  ["a shard follows the schema"] = function(t)
    local result = results_of { benchmark = support.root .. "/examples/data", samples = 2000, shard = "2/4" }
    t:equal(mistakes_of(result), {})
    t:equal(result.shard.n_parts, 21)
  end,

  ["the schema refuses what is none"] = function(t)
    local result = { aib = { format = 1, version = "1" }, protocol = { name = "p" }, records = {} }
    t:equal(mistakes_of(result), {})
    result.records[1] = { name = "x", value = "1" }
    t:equal(mistakes_of(result), { "results.records[1].value: another type" })
    result.records[1] = { name = "x", value = 1, extra = 1 }
    t:equal(mistakes_of(result), { "results.records[1]: unknown field extra" })
    result.records[1], result.aib.format = nil, 2
    t:equal(mistakes_of(result), { "results.aib.format: another value" })
  end,
}
