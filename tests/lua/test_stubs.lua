-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Every bound function has a stub, and every stub a function: one text serves editors, help() and the pages.
local aib = require "aib"
local shell = require "aib.shell"
local stubs = require "aib.stubs"

--- Modules that serve the others are no interface.
local function is_inner(name)
  return name:find("__", 1, true) or name:find("^aib%.system") or name:find("^aib%.shell")
end

--- Methods that every type has.
local common <const> = { close = true, to_table = true }

local function bound()
  local names, types = {}, {}
  for _, name in ipairs(shell.bound_names()) do
    if not is_inner(name) then
      names[name] = true
      if not name:find("^aib%.") then types[name:match("^[^.:]+")] = true end
    end
  end
  return names, types
end

--- Whether "aib.protocol" or "aib.scene.open" is something.
local function exists(name)
  local ok, value = pcall(function()
    local value = aib
    for part in name:gsub("^aib%.?", ""):gmatch("[^.]+") do value = value[part] end
    return value
  end)
  return ok and value ~= nil
end

local function sorted(list)
  table.sort(list)
  return table.concat(list, "\n  ")
end

local sample <const> = [[
---@meta aib.sample

---A module.
---@class aib.Sample
local sample = {}

---@class aib.SampleOptions
---@field tau? number|number[]  # in metres
---@field rule? "a b"|"c"  # which

---A bundle of things.
---@class aib.BundleOfThings
---@field size integer  # how many
local bundle = {}

---Adds one.
---@param thing fun(x: number): string  # to add
---@return aib.BundleOfThings self  # the same
function bundle:add(thing) end

---Makes one.
---
---On two lines.
---@param n? integer  # of things
---@param options? aib.SampleOptions|{ more: number, less?: "x"|"y" }
---@return aib.BundleOfThings bundle
---@return number share  # 0..1
function sample.make(n, options) end

return sample
]]

return aib.test {
  ["every bound function has a stub"] = function(t)
    local missing = {}
    for name in pairs(bound()) do
      if not stubs.all()[name] then missing[#missing + 1] = name end
    end
    t:equal(sorted(missing), "")
  end,

  ["every stub has a function"] = function(t)
    local names, types = bound()
    local surplus = {}
    for name, entry in pairs(stubs.all()) do
      local type, member = name:match("^([^.:]+)[.:](.+)$")
      local known = names[name] or exists(name) or common[member] or entry.kind == "class"
        or entry.kind ~= "function" and not types[type]  -- a type that is made in Lua
      if not known then surplus[#surplus + 1] = name end
    end
    t:equal(sorted(surplus), "")
  end,

  ["every stub says in a sentence what it is"] = function(t)
    local silent = {}
    for name, entry in pairs(stubs.all()) do
      local plain = entry.kind == "field" or entry.kind == "class"
      if not plain and not entry.text[1] then silent[#silent + 1] = name end
    end
    t:equal(sorted(silent), "")
  end,

  ["a stub is read with its types, options and results"] = function(t)
    local entries = stubs.parse(sample)
    t:equal(entries["aib.sample"].text, { "A module." })
    local add, make = entries["bundle_of_things:add"], entries["aib.sample.make"]
    t:equal(add.params, { { name = "thing", type = "fun(x: number): string", optional = false, text = "to add" } })
    t:equal(add.returns, { { name = "self", type = "aib.BundleOfThings", text = "the same" } })
    t:equal(entries["bundle_of_things.size"].text, { "how many" })
    t:equal(make.text, { "Makes one.", "", "On two lines." })
    t:equal(make.arguments, "n, options")
    t:equal(make.params[1], { name = "n", type = "integer", optional = true, text = "of things" })
    t:equal(make.returns[2], { name = "share", type = "number", text = "0..1" })
    local options = entries["sample_options"].fields
    t:equal(options[2], { name = "rule", type = '"a b"|"c"', optional = true, text = "which" })
    t:equal(stubs.options(make)[1], { name = "more", type = "number", optional = false, text = "" })
    t:equal(stubs.options(make)[2], { name = "less", type = '"x"|"y"', optional = true, text = "" })
  end,

  ["help prints signature, sentence, options and results"] = function(t)
    local help = require "aib.help"
    local text = help.text(aib.stats.quantile)
    t:contains(text, "aib.stats.quantile(values, q, options)\n")
    t:contains(text, "options:\n  rule?  \"linear\"|\"lower\"|\"midpoint\"")
    t:contains(text, "returns:\n  quantile  number")
    t:contains(help.text(aib.stats), "aib.stats.summary(values)")
    t:contains(help.text(aib.stats.moments()), "moments:add(value)")
    t:contains(help.text "moments:add", "Adds a value")
    t:contains(help.text "aib", "aib.error_kind")
    t:equal(help.text "nonsense", "no help on nonsense")
    t:equal(help.text(print), "no help on this function")
    t:contains(help.text(nil), "help(aib.pose.auc)")
  end,

  ["help knows every bound function, by its value"] = function(t)
    local help, n = require "aib.help", 0
    for name in pairs(bound()) do
      local value = name:find "^aib%.[%w_.]+$" and exists(name) and aib
      for part in value and name:sub(5):gmatch "[^.]+" or function() end do value = value[part] end
      if type(value) == "function" then
        t:equal(help.text(value):match "^[%w_.]+%(", name .. "(")
        n = n + 1
      end
    end
    t:check(n > 100, n .. " functions")
  end,

  ["the Tab key offers members, methods, options and words"] = function(t)
    local complete = require("aib.completion").complete
    rawset(_G, "aib", aib)  -- as at the prompt
    t:equal(complete "x = aib.sta", { "aib.stats" })
    t:equal(complete "aib.stats.q", { "aib.stats.quantile" })
    t:equal(complete "aib.stats.quantile(v, 0.5, { ru", { "rule = " })
    t:equal(complete "aib.stats.quantile(v, 0.5, { rule = 'lower', ", { "rule = " })
    t:equal(complete "aib.stats.quantile(v, 0.5, ", {})
    t:equal(complete "string.fo", { "string.format" })
    t:equal(complete "whi", { "while" })
    t:equal(complete "print(tosr", {})
    t:equal(complete "aib.nonsense.x", {})
  end,
}
