-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Run once when the shell starts: the Lua modules become members of `aib`, loaded at their first use.
local aib = require "aib"

local modules <const> = {
  "benchmark", "consistency", "files", "json", "progress", "protocol", "scene", "submodels",
}

local names = {}
for _, name in ipairs(modules) do names[name] = true end

local meta = getmetatable(aib)
local unknown_member = meta.__index

--- Loads a module; where the name is none of them, loads all, so that the suggestion knows them.
function meta.__index(self, name)
  if names[name] then
    local module = require("aib." .. name)
    rawset(self, name, module)
    return module
  end
  for _, other in ipairs(modules) do rawset(self, other, require("aib." .. other)) end
  return unknown_member(self, name)
end

return aib
