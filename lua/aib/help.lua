-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- help(x): what the stubs say about a function, a module, an object or a name.
local shell = require "aib.shell"
local stubs = require "aib.stubs"
local suggest = require "aib.suggest"
local text = require "aib.report.text"

local M = {}

--- Name of a value: of a bound function, a module, an object's type; a text is a name already.
local function name_of(value)
  if type(value) == "string" then return value end
  if type(value) == "userdata" then return require("aib").type(value) end
  if type(value) == "function" and shell.name_of(value) then return shell.name_of(value) end
  if value == require "aib" then return "aib" end
  for module_name, module in pairs(package.loaded) do
    if module_name:find("^aib") and value == module then return module_name end
    if module_name:find("^aib") and type(module) == "table" then
      for key, member in next, module do
        if member == value then return module_name .. "." .. tostring(key) end
      end
    end
  end
end

local function add_list(out, title, list)
  if #list == 0 then return end
  out[#out + 1] = title .. ":"
  for _, item in ipairs(list) do
    local label = item.name .. (item.name ~= "" and (item.optional and "?  " or "  ") or "") .. item.type
    out[#out + 1] = ("  %-34s %s"):format(label, item.text):gsub("%s+$", "")
  end
end

--- The text about one entry.
local function page(entry)
  local call = entry.arguments and "(" .. entry.arguments .. ")" or ""
  local out = { entry.name .. call }
  for _, line in ipairs(entry.text) do out[#out + 1] = "  " .. line end
  add_list(out, "arguments", entry.params)
  add_list(out, "options", stubs.options(entry))
  add_list(out, "returns", entry.returns)
  return table.concat(out, "\n")
end

--- The names below a module or type, with their first lines.
local function contents(name)
  local lines = {}
  for _, member in ipairs(suggest.keys(stubs.all())) do
    local entry = stubs.all()[member]
    local below = member:sub(1, #name + 1)
    if below == name .. "." or below == name .. ":" then
      local left = entry.name .. (entry.arguments and "(" .. entry.arguments .. ")" or "")
      lines[#lines + 1] = ("  %s %s"):format(text.left(left, 44), entry.text[1] or ""):gsub("%s+$", "")
    end
  end
  return lines
end

--- The text that help prints.
function M.text(value)
  if value == nil then
    return "help(aib.pose.auc), help(aib.pose), help(an_object), help \"aib\": what they are.\n"
      .. "Tab completes names, methods and options; _ is the last value; Ctrl-D ends."
  end
  local name = name_of(value)
  local entry = name and stubs.all()[name]
  if not entry then return name and "no help on " .. name or "no help on this " .. type(value) end
  local out = { page(entry) }
  for _, line in ipairs(entry.kind == "class" and contents(name) or {}) do out[#out + 1] = line end
  return table.concat(out, "\n")
end

return setmetatable(M, {
  __call = function(_, value) print(M.text(value)) end,
  __tostring = function() return "help(name): what a function, module or object is" end,
})
