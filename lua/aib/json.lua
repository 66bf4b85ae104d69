-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- JSON text of values and values of JSON text: keys sorted, numbers in their shortest exact form, so that the
--- same values are the same bytes.
local failure = require "aib.failure"

local M = {}

--- Stands for null, which a Lua table cannot hold.
M.null = setmetatable({}, { __tostring = function() return "null" end })

local list_type = {}

--- A table that is written as an array even where it is empty.
function M.list(t) return setmetatable(t or {}, list_type) end

local formats = {}
for digits = 1, 17 do formats[digits] = ("%%.%dg"):format(digits) end

--- The shortest decimal text that reads back as the same number.
function M.number(x)
  if math.type(x) == "integer" then return ("%d"):format(x) end
  if x ~= x or x == math.huge or x == -math.huge then error("json: a number that is not finite", 2) end
  if x == 0 then return "0" end  -- of either sign
  local text = ("%.15g"):format(x)
  local first, last = 1, 15
  if tonumber(text) + 0.0 ~= x then first, last = 16, 17 end
  for digits = first, last do
    text = formats[digits]:format(x)
    if tonumber(text) + 0.0 == x then return text end
  end
end

local escapes = {
  ['"'] = '\\"', ["\\"] = "\\\\", ["\b"] = "\\b", ["\f"] = "\\f", ["\n"] = "\\n", ["\r"] = "\\r", ["\t"] = "\\t",
}

--- The text, in which bytes that are no UTF-8 (of names in files) are replaced.
local function valid(text)
  local parts, at = {}, 1
  while true do
    local _, stop = utf8.len(text, at)
    if not stop then return table.concat(parts) .. text:sub(at) end
    parts[#parts + 1] = text:sub(at, stop - 1) .. "\u{FFFD}"
    at = stop + 1
  end
end

local function quoted(text)
  if not utf8.len(text) then text = valid(text) end
  local safe = text:gsub('[%c"\\\127]', function(c) return escapes[c] or ("\\u%04x"):format(c:byte()) end)
  return '"' .. safe .. '"'
end

local function is_list(t)
  if getmetatable(t) == list_type then return true end
  local n = #t
  if n == 0 then return false end
  local count = 0
  for _ in pairs(t) do count = count + 1 end
  return count == n
end

local encode

local function enclosed(open, parts, close, indent)
  if #parts == 0 then return open .. close end
  local inner = indent .. "  "
  local flat = open .. table.concat(parts, ", ") .. close
  if #flat + #indent <= 100 and not flat:find("\n", 1, true) then return flat end
  return open .. "\n" .. inner .. table.concat(parts, ",\n" .. inner) .. "\n" .. indent .. close
end

local function encode_list(t, indent)
  local parts = {}
  for i, value in ipairs(t) do parts[i] = encode(value, indent .. "  ") end
  return enclosed("[", parts, "]", indent)
end

local function encode_object(t, indent)
  local values = {}
  for key, value in pairs(t) do
    local name = math.type(key) and M.number(key) or key
    if type(name) ~= "string" then error("json: a key of type " .. type(key), 0) end
    values[name] = value
  end
  local names = {}
  for name in pairs(values) do names[#names + 1] = name end
  table.sort(names)
  local parts = {}
  for i, name in ipairs(names) do parts[i] = quoted(name) .. ": " .. encode(values[name], indent .. "  ") end
  return enclosed("{", parts, "}", indent)
end

encode = function(value, indent)
  local kind = type(value)
  if value == M.null then return "null" end
  if kind == "number" then return M.number(value) end
  if kind == "string" then return quoted(value) end
  if kind == "boolean" then return tostring(value) end
  if kind ~= "table" then error("json: a value of type " .. kind, 0) end
  return is_list(value) and encode_list(value, indent) or encode_object(value, indent)
end

--- The text of a value: tables with 1..n are arrays, others objects; an empty table is an object unless made by `list`.
function M.encode(value) return encode(value, "") end

local unescapes = { b = "\b", f = "\f", n = "\n", r = "\r", t = "\t", ['"'] = '"', ["\\"] = "\\", ["/"] = "/" }

local reader = {}
reader.__index = reader

--- What stands where the reader is, in words.
function reader:here()
  local c = self.text:sub(self.at, self.at)
  if c == "" then return "the end" end
  return c:find "[%c\128-\255]" and ("byte 0x%02x"):format(c:byte()) or "'" .. c .. "'"
end

function reader:fail(expected, found)
  local _, line = self.text:sub(1, self.at - 1):gsub("\n", "")
  failure.raise("format", ("%s:%d: %s expected, found %s"):format(self.name, line + 1, expected, found or self:here()))
end

--- Skips blanks, then takes what matches `pattern`, or returns nil.
function reader:take(pattern)
  self.at = self.text:find("[^ \t\r\n]", self.at) or #self.text + 1
  local first, last, capture = self.text:find("^" .. pattern, self.at)
  if not first then return nil end
  self.at = last + 1
  return capture or self.text:sub(first, last)
end

function reader:string()
  local plain, after = self.text:match('^([^"\\%c]*)"()', self.at)
  if plain then
    self.at = after
    return plain
  end
  local parts = {}
  while true do
    local stop = self.text:find('["\\%c]', self.at) or #self.text + 1
    parts[#parts + 1] = self.text:sub(self.at, stop - 1)
    self.at = stop
    local c = self.text:sub(stop, stop)
    if c == '"' then
      self.at = stop + 1
      return table.concat(parts)
    elseif c ~= "\\" then
      self:fail("the end of a string")
    end
    parts[#parts + 1] = self:escape()
  end
end

function reader:escape()
  local hex = self.text:match("^\\u(%x%x%x%x)", self.at)
  if not hex then
    local c = unescapes[self.text:sub(self.at + 1, self.at + 1)]
    if not c then self:fail("an escape sequence") end
    self.at = self.at + 2
    return c
  end
  local code = tonumber(hex, 16)
  self.at = self.at + 6
  local low = code >= 0xD800 and code < 0xDC00 and self.text:match("^\\u([dD][c-fC-F]%x%x)", self.at)
  if low then
    code = 0x10000 + ((code - 0xD800) << 10) + (tonumber(low, 16) - 0xDC00)
    self.at = self.at + 6
  end
  return utf8.char(code)
end

local depth_limit <const> = 200

function reader:list(depth)
  local t = M.list()
  if self:take("%]") then return t end
  repeat t[#t + 1] = self:value(depth) until not self:take(",")
  if not self:take("%]") then self:fail("',' or ']'") end
  return t
end

function reader:object(depth)
  local t = {}
  if self:take("}") then return t end
  repeat
    if not self:take('"') then self:fail("a name in quotes") end
    local key = self:string()
    if not self:take(":") then self:fail("':'") end
    t[key] = self:value(depth)
  until not self:take(",")
  if not self:take("}") then self:fail("',' or '}'") end
  return t
end

function reader:value(depth)
  if depth > depth_limit then self:fail("at most " .. depth_limit .. " levels") end
  if self:take("{") then return self:object(depth + 1) end
  if self:take("%[") then return self:list(depth + 1) end
  if self:take('"') then return self:string() end
  local word = self:take("%a+")
  if word == "true" then return true end
  if word == "false" then return false end
  if word == "null" then return M.null end
  if word then
    self.at = self.at - #word
    self:fail("a value")
  end
  local number = self:take("%-?%d+%.?%d*[eE]?[+-]?%d*")
  local x = number and not number:find("^%-?0%d") and tonumber(number)
  if not x then self:fail("a value") end
  if math.abs(x) == math.huge then self:fail("a number below 1.8e308", number) end
  return x
end

--- The value of a JSON text. Raises a format error that begins with `name` (a path) where it is none.
function M.decode(text, name)
  local r = setmetatable({ text = text, at = 1, name = name or "json" }, reader)
  local _, stop = utf8.len(text)
  if stop then
    r.at = stop
    r:fail "UTF-8"
  end
  local value = r:value(0)
  if r:take(".") then
    r.at = r.at - 1
    r:fail("the end")
  end
  return value
end

return M
