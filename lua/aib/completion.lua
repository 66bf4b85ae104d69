-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What the Tab key offers at the prompt: globals, members of modules and tables, methods of objects, options of the
--- call that is being written.
local shell = require "aib.shell"
local stubs = require "aib.stubs"

local M = {}

local keywords <const> = {
  "and", "break", "do", "else", "elseif", "end", "false", "for", "function", "goto", "if", "in", "local", "nil", "not",
  "or", "repeat", "return", "then", "true", "until", "while",
}

local getmetatable = debug.getmetatable

local function add_keys(names, t)
  for key in next, t or {} do
    if type(key) == "string" and key:find("^%a[%w_]*$") then names[key] = true end
  end
end

--- Names that may follow `value` and the separator.
local function members(value, separator)
  local names, meta = {}, getmetatable(value) or {}
  if type(value) == "table" then
    add_keys(names, value)
    add_keys(names, meta.__lazy)
  elseif type(value) == "userdata" then
    add_keys(names, separator == ":" and meta.__methods or meta.__fields)
  end
  if type(meta.__index) == "table" then add_keys(names, meta.__index) end
  return names
end

--- The value of "a.b.c" without running any code of the user; nil where it has none.
local function value_of(chain)
  local value = _G
  for name in chain:gmatch("[^.:]+") do
    if type(value) ~= "table" then return nil end
    local lazy = (getmetatable(value) or {}).__lazy
    local known = rawget(value, name)
    if known == nil and lazy and lazy[name] then known = value[name] end
    value = known
  end
  return value
end

--- Name of the function whose option table is open at the end of the text, nil where none is.
local function open_call(before)
  local depth = 0
  for i = #before, 1, -1 do
    local c = before:sub(i, i)
    if c:find("[)}%]]") then
      depth = depth + 1
    elseif c:find("[({%[]") then
      depth = depth - 1
      if depth == -1 and c ~= "{" then return nil end
      local name = depth < 0 and before:sub(1, i - 1):match("([%a_][%w_.:]*)%s*$")
      if name then return name end
    end
  end
end

local function option_names(before)
  local name = open_call(before)
  local entry = name and stubs.all()[shell.name_of(value_of(name)) or name]
  local names = {}
  for _, option in ipairs(entry and stubs.options(entry) or {}) do names[option.name .. " = "] = true end
  return names
end

local function sorted_matches(names, prefix, before)
  local list = {}
  for name in pairs(names) do
    if name:sub(1, #prefix) == prefix then list[#list + 1] = before .. name end
  end
  table.sort(list)
  return list
end

--- What may replace the last word of the text, sorted.
function M.complete(before)
  local word = before:match("[%a_][%w_.:]*$") or ""
  local chain, separator, prefix = word:match("^(.*)([.:])([%w_]*)$")
  if chain then
    local value = value_of(chain)
    return sorted_matches(members(value, separator), prefix, chain .. separator)
  end
  if before:sub(1, #before - #word):find("[{,]%s*$") then
    local options = sorted_matches(option_names(before:sub(1, #before - #word)), word, "")
    if #options > 0 then return options end
  end
  if word == "" then return {} end
  local names = members(_G, ".")
  for _, keyword in ipairs(keywords) do names[keyword] = true end
  return sorted_matches(names, word, "")
end

return M
