-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Holds JSON values against a JSON Schema, of which it knows: type, const, enum, minimum, required, properties,
--- additionalProperties, items, a pattern that is a Lua pattern too, and $ref to $defs.
local json = require "aib.json"
local suggest = require "aib.suggest"

local M = {}

local is = {}
function is.string(v) return type(v) == "string" end
function is.number(v) return type(v) == "number" end
function is.integer(v) return math.type(v) == "integer" end
function is.null(v) return v == json.null end
function is.array(v) return type(v) == "table" and v ~= json.null and (#v > 0 or next(v) == nil) end
function is.object(v) return type(v) == "table" and v ~= json.null and #v == 0 end

local function list_of(x) return type(x) == "table" and x or { x } end

local function has_type(value, types)
  for _, name in ipairs(list_of(types)) do
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

--- A value in few words.
local function shown(value)
  if value == json.null then return "null" end
  if is.array(value) then return "an array" end
  if type(value) == "table" then return "an object" end
  local text = type(value) == "string" and ("'%s'"):format(value) or tostring(value)
  return #text <= 40 and text or text:sub(1, 37) .. "..."
end

local function at_place(at, sentence) return at == "" and sentence or at .. ": " .. sentence end

local function broken(at, expected, value)
  return at_place(at, ("%s expected, found %s"):format(expected, shown(value)))
end

local check

local function check_object(value, rule, at, schema)
  for _, name in ipairs(rule.required or {}) do
    if value[name] == nil then return at_place(at, name .. " is missing") end
  end
  local known, others = rule.properties or {}, rule.additionalProperties
  for _, name in ipairs(suggest.keys(value)) do
    local own = known[name] or others
    if own == false then return at_place(at, suggest.unknown_key(value, known)) end
    local mistake = type(own) == "table" and check(value[name], own, at == "" and name or at .. "." .. name, schema)
    if mistake then return mistake end
  end
end

function check(value, rule, at, schema)
  if rule["$ref"] then rule = schema["$defs"][rule["$ref"]:match "[^/]*$"] end
  if rule.type and not has_type(value, rule.type) then
    return broken(at, table.concat(list_of(rule.type), " or "), value)
  end
  if rule.const ~= nil and value ~= rule.const then return broken(at, shown(rule.const), value) end
  if rule.enum and not contains(rule.enum, value) then return broken(at, table.concat(rule.enum, " or "), value) end
  if rule.minimum and value < rule.minimum then return broken(at, rule.minimum .. " or more", value) end
  if rule.pattern and not value:find(rule.pattern) then return broken(at, rule.description, value) end
  if rule.items and is.array(value) then
    for i, element in ipairs(value) do
      local mistake = check(element, rule.items, ("%s[%d]"):format(at, i), schema)
      if mistake then return mistake end
    end
  end
  if is.object(value) then return check_object(value, rule, at, schema) end
end

--- Where and how a value first breaks the schema, as "records[3].value: number or null expected, found 'x'"; nil where
--- it does not.
function M.mistake(value, schema) return check(value, schema, "", schema) end

return M
