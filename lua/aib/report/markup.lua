-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- HTML, SVG and JSON inside them, put together so that no text can break out of its place.
local json = require "aib.json"
local suggest = require "aib.suggest"

local M = {}

local entities <const> = { ["&"] = "&amp;", ["<"] = "&lt;", [">"] = "&gt;", ['"'] = "&quot;", ["'"] = "&#39;" }

--- Text as content or as the value of an attribute.
function M.escaped(text) return (tostring(text):gsub("[&<>\"']", entities)) end

--- An element. `content` is markup already; attributes that are false or nil are left out, true ones stand alone.
---   element("a", { href = "#x" }, escaped(title))
function M.element(name, attributes, content)
  local parts = { "<" .. name }
  for _, key in ipairs(suggest.keys(attributes or {})) do
    local value = attributes[key]
    if value == true then parts[#parts + 1] = " " .. key end
    if value and value ~= true then parts[#parts + 1] = (' %s="%s"'):format(key, M.escaped(value)) end
  end
  parts[#parts + 1] = content and (">%s</%s>"):format(content, name) or "/>"
  return table.concat(parts)
end

--- An element whose content is a text.
function M.text(name, attributes, text) return M.element(name, attributes, M.escaped(text)) end

local script_escapes <const> = {
  ["<"] = "\\u003c", [">"] = "\\u003e", ["&"] = "\\u0026", ["\u{2028}"] = "\\u2028", ["\u{2029}"] = "\\u2029",
}

--- A value as JSON that can stand inside of a script element.
function M.json(value)
  local text = json.encode(value):gsub("[<>&]", script_escapes)
  return (text:gsub("\u{2028}", script_escapes):gsub("\u{2029}", script_escapes))
end

return M
