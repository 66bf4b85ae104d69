-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Typed inputs of a protocol: how each kind is read from a command line, checked, and shown in --help.
---
--- An input is
---   kind      "text" | "path" | "file" | "folder" | "output" | "number" | "integer" | "choice" | "list" | "flag"
---   default   value where none is given; an input without one has to be given (a flag is false)
---   unit      of a number: one of another unit of that kind is converted ("5cm" where the unit is "m")
---   min, max  bounds of a number, both allowed
---   above     a bound that is not: 0 of lengths that have to be there
---   ending    of an output: ".png"
---   choices   names of a choice
---   of        kind of a list's elements (default "path")
---   position  1, 2, ...: also given by place; inputs that have to be given are, by name, where none says so
---   help      sentence
local failure = require "aib.failure"
local suggest = require "aib.suggest"
local system = require("aib").system

local M = {}

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
  if not x or math.abs(x) == math.huge then
    return nil, "a number" .. (input.unit and " in " .. input.unit or "") .. " expected"
  end
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
read.file, read.folder, read.output = read.path, read.path, read.path

function read.text(text) return text end

function read.choice(text) return text end

function read.flag(text)
  if text == "true" then return true end
  if text == "false" then return false end
  return nil, "true or false expected"
end

--- Types of values that a script or a default gives.
local lua_types <const> = {
  number = "number", integer = "number", path = "string", file = "string", folder = "string", output = "string",
  choice = "string", flag = "boolean", list = "table", text = "string",
}

--- Checks of a value, whether it came as text or from Lua. Each gives nothing, or what was expected and found. A file
--- that is not there is an error of its own kind: the input is bad, not the call.
local check = {}

local function refusal(expected, value) return ("%s expected, %s"):format(expected, found(value)) end

function check.number(x, input)
  if x ~= x then return refusal("a number", x) end
  if input.min and x < input.min then return refusal(("at least %s"):format(input.min), x) end
  if input.above and x <= input.above then return refusal(("more than %s"):format(input.above), x) end
  if input.max and x > input.max then return refusal(("at most %s"):format(input.max), x) end
end

function check.integer(x, input)
  if not math.tointeger(x) then return refusal("an integer", x) end
  return check.number(x, input)
end

function check.choice(name, input)
  for _, choice in ipairs(input.choices) do
    if name == choice then return end
  end
  return refusal("one of " .. table.concat(input.choices, ", "), name) .. suggest.nearest(name, input.choices)
end

function check.path(path)
  if path:find("\0", 1, true) then return refusal("a path", path) end
end

function check.file(path)
  local mistake = check.path(path)
  if mistake then return mistake end
  if system.is_folder(path) then failure.raise("io", path .. ": a file expected, found a folder") end
  if not system.is_file(path) then failure.raise("io", path .. ": no such file") end
end

function check.folder(path)
  local mistake = check.path(path)
  if mistake then return mistake end
  if system.is_file(path) then failure.raise("io", path .. ": a folder expected, found a file") end
  if not system.is_folder(path) then failure.raise("io", path .. ": no such folder") end
end

--- A file that can be written when the work is done; "" is none.
function check.output(path, input)
  local mistake = check.path(path)
  if mistake or path == "" then return mistake end
  local folder = path:match("^(.*)/[^/]*$")
  if folder == "" then folder = "/" end
  if folder and not system.is_folder(folder) then return folder .. ": no such folder" end
  if system.is_folder(path) then return path .. ": a file expected, found a folder" end
  local ending = input.ending or ""
  if path:sub(#path - #ending + 1):lower() ~= ending then return refusal("a name that ends in " .. ending, path) end
end

local function elements(input)
  return { kind = input.of or "path", unit = input.unit, min = input.min, max = input.max, above = input.above,
    choices = input.choices, ending = input.ending }
end

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
  local mistake = check[input.kind] and check[input.kind](value, input)
  if mistake then wrong(mistake) end
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

local fields <const> = {
  kind = "any", default = "any", unit = "string", min = "number", max = "number", above = "number",
  choices = "table", of = "string", ending = "string", position = "number", help = "string",
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
    or suggest.wrong_type(input, fields)
  if mistake then return mistake end
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

--- Those with a place in the order of their places, then the others: what is missing is told in the order of --help.
local function as_told(inputs)
  local list = table.move(inputs, 1, #inputs, 1, {})
  table.sort(list, function(a, b)
    if a.place and b.place then return a.place < b.place end
    if a.place or b.place then return a.place ~= nil end
    return a.key < b.key
  end)
  return list
end

--- The values of a run from Lua values by name; defaults where there is none. `wrong(sentence)` raises.
function M.complete(inputs, values, wrong)
  local known = {}
  for _, input in ipairs(inputs) do known[input.key] = true end
  local mistake = suggest.unknown_key(values, known)
  if mistake then wrong((mistake:gsub("^unknown field", "unknown input"))) end
  local out = {}
  for _, input in ipairs(as_told(inputs)) do
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
