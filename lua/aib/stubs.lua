-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The stubs that editors read (lua/meta), as data: what `help()` prints, the prompt completes, and the pages say.
---
--- An entry is { name =, kind = "function" | "method" | "field" | "class", text = {lines}, params =, returns =,
--- fields =, arguments = }. Methods are named "cloud:bounds", fields "cloud.size", functions "aib.cloud.compare".
--- Params, returns and fields are lists of { name =, type =, optional =, text = }.
---
--- A stub's @meta is the module's name, its last line returns the module's variable; `aib.DepthMap` is the class of the
--- type depth_map.
local shell = require "aib.shell"

local M = {}

--- "aib.DepthMap" is the type "depth_map".
local function type_name(class)
  local name = class:match("^aib%.(%u%w*)$")
  return name and name:gsub("(%l)(%u)", "%1_%2"):lower() or class
end

--- A type ends at the first space outside of brackets and of texts in quotes.
local function split_type(text)
  local depth, quote = 0, nil
  for i = 1, #text do
    local c = text:sub(i, i)
    if quote then
      if c == quote then quote = nil end
    elseif c == '"' or c == "'" then
      quote = c
    elseif c:find("[%[({<]") then
      depth = depth + 1
    elseif c:find("[%])}>]") then
      depth = depth - 1
    elseif c == " " and depth == 0 and not text:sub(1, i):find("[:|,]%s*$") and not text:sub(i):find("^%s*|") then
      return text:sub(1, i - 1), text:sub(i + 1)
    end
  end
  return text, ""
end

local function described(rest) return rest:match("#%s*(.*)$") or rest:match("^%s*(.*)$") end

--- "name? type  # text"
local function named_value(text)
  local name, optional, rest = text:match("^([%w_%.]+)(%??)%s+(.*)$")
  if not name then return { name = text, type = "any", text = "" } end
  local type, tail = split_type(rest)
  return { name = name, type = type, optional = optional == "?", text = described(tail) }
end

--- "type name  # text"
local function result(text)
  local type, tail = split_type(text)
  local name, rest = tail:match("^([%a_][%w_%?]*)%s*(.*)$")
  return { name = name or "", type = type, text = described(name and rest or tail) }
end

local function new_block() return { text = {}, params = {}, returns = {}, fields = {} } end

local reader = {}
reader.__index = reader

function reader:add(name, kind, block)
  block.name, block.kind = name, kind
  self.entries[name] = block
  return block
end

--- The lines of an annotation.
function reader:comment(line)
  local tag, rest = line:match("^%-%-%-@(%a+)%s*(.*)$")
  if not tag then
    self.block.text[#self.block.text + 1] = line:match("^%-%-%-%s?(.*)$")
  elseif tag == "param" then
    self.block.params[#self.block.params + 1] = named_value(rest)
  elseif tag == "return" then
    self.block.returns[#self.block.returns + 1] = result(rest)
  elseif tag == "field" then
    self.block.fields[#self.block.fields + 1] = named_value(rest)
  elseif tag == "class" then
    self.block.class = type_name(rest:match("^([%w_%.]+)"))
  end
end

function reader:close_class()
  local block = self.block
  if not block.class then return end
  self:add(block.class, "class", block)
  for _, field in ipairs(block.fields) do
    self:add(block.class .. "." .. field.name, "field", { text = { field.text }, params = {}, fields = {},
      returns = { { name = "", type = field.type, text = "" } } })
  end
end

function reader:code(line)
  local variable = line:match("^local ([%a_][%w_]*) = {}")
  local owner, separator, name, arguments = line:match("^function ([%a_][%w_]*)([.:])([%a_][%w_]*)%((.-)%) end")
  if variable and variable == self.module_variable then self.block.class = self.module end
  self:close_class()
  if variable then self.variables[variable] = self.block.class end
  if owner and self.variables[owner] then
    self.block.arguments = arguments
    local kind = separator == ":" and "method" or "function"
    self:add(self.variables[owner] .. separator .. name, kind, self.block)
  end
  self.block = new_block()
end

--- Entries of a stub's text, by name.
function M.parse(text, entries)
  local self = setmetatable({
    entries = entries or {}, variables = {}, block = new_block(),
    module = text:match("^%-%-%-@meta ([%w_.]+)"), module_variable = text:match("\nreturn ([%w_]+)"),
  }, reader)
  for line in (text .. "\n"):gmatch("(.-)\n") do
    if line:find("^%-%-%-") then self:comment(line) else self:code(line) end
  end
  return self.entries
end

local all

--- Entries of all stubs in the binary, by name.
function M.all()
  if not all then
    all = {}
    for _, path in ipairs(shell.paths()) do
      if path:find("^meta/") then M.parse(shell.text(path), all) end
    end
  end
  return all
end

--- The parts of a text between separators that stand outside of brackets.
local function split(text, separator)
  local parts, depth, from = {}, 0, 1
  for i = 1, #text do
    local c = text:sub(i, i)
    depth = depth + (c:find("[%[({<]") and 1 or c:find("[%])}>]") and -1 or 0)
    if c == separator and depth == 0 then
      parts[#parts + 1] = text:sub(from, i - 1)
      from = i + 1
    end
  end
  parts[#parts + 1] = text:sub(from)
  return parts
end

--- The fields of "aib.Options|{ name?: type, ... }".
local function fields_of(type_text)
  local fields = {}
  for _, part in ipairs(split(type_text, "|")) do
    local class, inline = M.all()[type_name(part)], part:match("^%s*{(.*)}%s*$")
    for _, field in ipairs(class and class.fields or {}) do fields[#fields + 1] = field end
    for _, field in ipairs(inline and split(inline, ",") or {}) do
      local name, optional, type = field:match("^%s*([%w_]+)(%??)%s*:%s*(.-)%s*$")
      if name then fields[#fields + 1] = { name = name, optional = optional == "?", type = type, text = "" } end
    end
  end
  return fields
end

--- The fields of the option table that a function takes; none where it takes none.
function M.options(entry)
  for _, param in ipairs(entry.params) do
    if param.name:find("^opt") then return fields_of(param.type) end
  end
  return {}
end

return M
