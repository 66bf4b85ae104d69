-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Typed inputs of a protocol: how each kind is read from a command line, checked, and shown in --help.
---
--- An input is
---   kind      "text" | "path" | "file" | "folder" | "number" | "integer" | "choice" | "list" | "flag"
---   default   value where none is given; an input without one has to be given (a flag is false)
---   unit      of a number: one of another unit of that kind is converted ("5cm" where the unit is "m")
---   min, max  bounds of a number, both allowed
---   choices   names of a choice
---   of        kind of a list's elements (default "path")
---   position  1, 2, ...: also given by place; inputs that have to be given are, by name, where none says so
---   help      sentence
local failure = require "aib.failure"
local suggest = require "aib.suggest"
local system = require("aib").system

local M = {}

local fields <const> = {
  kind = true, default = true, unit = true, min = true, max = true, choices = true, of = true, position = true,
  help = true,
}

local units <const> = {
  m = { m = 1, mm = 1e-3, cm = 1e-2, km = 1e3 },
  deg = { deg = 1, rad = 180 / math.pi },
  s = { s = 1, ms = 1e-3, min = 60, h = 3600 },
  B = { B = 1, kB = 1e3, MB = 1e6, GB = 1e9, KiB = 2 ^ 10, MiB = 2 ^ 20, GiB = 2 ^ 30 },
}

--- Factor from a unit to another of its kind, nil where there is none.
local function factor(from, to)
  if from == to then return 1 end
  for _, family in pairs(units) do
    if family[from] and family[to] then return family[from] / family[to] end
  end
end

local function found(text) return ("found '%s'"):format(tostring(text)) end

--- Readers of text. Each gives the value, or nil and what was expected.
local read = {}

function read.number(text, input)
  local digits, unit = text:match("^%s*([+-]?[%d.]+[eE]?[+-]?%d*)%s*(%a*)%s*$")
  local x = digits and tonumber(digits)
  if not x then return nil, "a number" .. (input.unit and " in " .. input.unit or "") .. " expected" end
  if unit == "" then return x end
  local scale = input.unit and factor(unit, input.unit)
  if not scale then
    return nil, input.unit and ("a number in %s expected"):format(input.unit) or "a number without unit expected"
  end
  return x * scale
end

function read.integer(text)
  local x = text:match("^%s*[+-]?%d+%s*$") and math.tointeger(tonumber(text))
  if not x then return nil, "an integer expected" end
  return x
end

function read.path(text)
  if text == "" then return nil, "a path expected" end
  return text
end
read.file, read.folder = read.path, read.path

function read.text(text) return text end

function read.choice(text) return text end

function read.flag(text)
  if text == "true" then return true end
  if text == "false" then return false end
  return nil, "true or false expected"
end

--- Types of values that a script or a default gives.
local lua_types <const> = {
  number = "number", integer = "number", path = "string", file = "string", folder = "string", choice = "string",
  flag = "boolean", list = "table", text = "string",
}

--- Checks of a value, whether it came as text or from Lua. Each gives nothing, or what was expected. A file that is
--- not there is an error of its own kind: the input is bad, not the call.
local check = {}

function check.number(x, input)
  if input.min and x < input.min then return ("at least %s expected"):format(input.min) end
  if input.max and x > input.max then return ("at most %s expected"):format(input.max) end
end

function check.integer(x, input)
  if not math.tointeger(x) then return "an integer expected" end
  return check.number(x, input)
end

function check.choice(name, input)
  for _, choice in ipairs(input.choices) do
    if name == choice then return end
  end
  return ("one of %s expected"):format(table.concat(input.choices, ", ")), suggest.hint(name, input.choices)
end

function check.path(path)
  if path:find("\0", 1, true) then return "a path expected" end
end

function check.file(path)
  local wrong = check.path(path)
  if wrong then return wrong end
  if system.is_folder(path) then failure.raise("io", path .. ": a file expected, found a folder") end
  if not system.is_file(path) then failure.raise("io", path .. ": no such file") end
end

function check.folder(path)
  local wrong = check.path(path)
  if wrong then return wrong end
  if system.is_file(path) then failure.raise("io", path .. ": a folder expected, found a file") end
  if not system.is_folder(path) then failure.raise("io", path .. ": no such folder") end
end

local function elements(input) return { kind = input.of or "path", unit = input.unit, min = input.min, max = input.max,
  choices = input.choices } end

--- The value after the checks of its kind. Calls `wrong(sentence)` where it is not one.
local function checked(value, input, wrong)
  if type(value) ~= lua_types[input.kind] then
    wrong(("%s %s expected, found %s"):format(input.kind:find("^[aeiou]") and "an" or "a", input.kind, type(value)))
  end
  if input.kind == "list" then
    local list = {}
    for i, element in ipairs(value) do list[i] = checked(element, elements(input), wrong) end
    return list
  end
  local expected = check[input.kind] and check[input.kind](value, input)
  if expected then wrong(("%s, %s"):format(expected, found(value))) end
  return input.kind == "integer" and math.tointeger(value) or value
end

--- The value of a text. Calls `wrong(sentence)` where it is not one.
local function parsed(text, input, wrong)
  if input.kind ~= "list" then
    local value, expected = read[input.kind](text, input)
    if value == nil then wrong(("%s, %s"):format(expected, found(text))) end
    return value
  end
  local list = {}
  for part in (text .. ","):gmatch("([^,]*),") do list[#list + 1] = parsed(part, elements(input), wrong) end
  return list
end

local field_types <const> = {
  kind = "string", unit = "string", min = "number", max = "number", choices = "table", of = "string",
  position = "number", help = "string",
}

local function mistake_in_kind(kind)
  if lua_types[kind] then return end
  return ("unknown kind '%s'%s"):format(tostring(kind), suggest.hint(tostring(kind), suggest.keys(lua_types)))
end

local function mistake_in_choices(choices)
  if type(choices) ~= "table" or #choices == 0 then return "choices: a list of names expected" end
  for _, name in ipairs(choices) do
    if type(name) ~= "string" then return "choices: names expected, found " .. type(name) end
  end
end

--- What is wrong with the fields of a declaration, nil where nothing is.
local function mistake_in(input)
  local mistake = suggest.unknown_key(input, fields) or mistake_in_kind(input.kind)
  if mistake then return mistake end
  for _, name in ipairs(suggest.keys(field_types)) do
    local found_type = type(input[name])
    if found_type ~= "nil" and found_type ~= field_types[name] then
      return ("%s: a %s expected, found %s"):format(name, field_types[name], found_type)
    end
  end
  if input.of == "list" then return "of: a kind of one value expected, found 'list'" end
  if input.of ~= nil and mistake_in_kind(input.of) then return mistake_in_kind(input.of) end
  if input.kind == "choice" or input.of == "choice" then return mistake_in_choices(input.choices) end
end

--- Throws an error at `level` where a declaration is wrong; returns it with every field in its full form.
function M.declare(key, input, level)
  local function wrong(sentence) error(("aib.protocol: input '%s': %s"):format(key, sentence), level + 2) end
  if type(key) ~= "string" or not key:find("^%a[%w_]*$") then wrong("a name of letters, digits and _ expected") end
  if type(input) ~= "table" then wrong("a table expected, found " .. type(input)) end
  local mistake = mistake_in(input)
  if mistake then wrong(mistake) end
  local copy = { key = key }
  for name, value in pairs(input) do copy[name] = value end
  if copy.kind == "flag" and copy.default == nil then copy.default = false end
  if copy.default ~= nil and copy.kind ~= "file" and copy.kind ~= "folder" then checked(copy.default, copy, wrong) end
  return copy
end

--- The values of a run from Lua values by name; defaults where there is none. `wrong(sentence)` raises.
function M.complete(inputs, values, wrong)
  local known = {}
  for _, input in ipairs(inputs) do known[input.key] = true end
  local mistake = suggest.unknown_key(values, known)
  if mistake then wrong((mistake:gsub("^unknown field", "unknown input"))) end
  local out = {}
  for _, input in ipairs(inputs) do
    local value = values[input.key]
    if value == nil then value = input.default end
    if value == nil then
      wrong(("%s is missing%s"):format(M.label(input), input.help and " (" .. input.help .. ")" or ""))
    end
    out[input.key] = checked(value, input, function(sentence) wrong(M.label(input) .. ": " .. sentence) end)
  end
  return out
end

--- What a command line calls an input: "--outlier-factor", or "BENCHMARK" where it has a place.
function M.label(input)
  if input.place then return (input.key:upper():gsub("_", "-")) end
  return "--" .. input.key:gsub("_", "-")
end

--- The value of a command line's text, checked. `wrong(sentence)` raises.
function M.value(input, text, wrong)
  local function say(sentence) wrong(M.label(input) .. ": " .. sentence) end
  return checked(parsed(text, input, say), input, say)
end

--- The value of a command line's text, to be checked by `complete`. `wrong(sentence)` raises.
function M.parse(input, text, wrong)
  return parsed(text, input, function(sentence) wrong(M.label(input) .. ": " .. sentence) end)
end

return M
