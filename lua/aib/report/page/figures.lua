-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The figures of a page: a drawing that needs no script, and its numbers as a table.
local axes = require "aib.report.axes"
local json = require "aib.json"
local markup = require "aib.report.markup"
local number = require "aib.report.number"
local svg = require "aib.report.svg"
local tables = require "aib.report.page.tables"

local element, text = markup.element, markup.text

local M = {}

local most_rows <const> = 60

local function shown(x) return x ~= nil and x == x and number.short(x) or "" end

--- x and the value of every line there; of long figures every k-th.
local function numbers_of(figure)
  local heads, rows = { axes.label(figure.x) }, {}
  if figure.kind == "interval" then
    for i, r in ipairs(figure.rows) do rows[i] = { r.label, shown(r.value), shown(r.low), shown(r.high) } end
    return { figure.title, "value", "low", "high" }, rows
  end
  local xs, place = {}, {}
  for l, line in ipairs(figure.lines) do
    heads[l + 1] = line.label
    for _, x in ipairs(line.x) do
      if not place[x] then xs[#xs + 1], place[x] = x, true end
    end
  end
  table.sort(xs)
  local stride = math.max(1, (#xs + most_rows - 1) // most_rows)
  local values = {}
  for l, line in ipairs(figure.lines) do
    values[l] = {}
    for i, x in ipairs(line.x) do values[l][x] = line.y[i] end
  end
  for i = 1, #xs, stride do
    local row = { figure.frames and figure.frames[i] or number.short(xs[i]) }
    for l = 1, #figure.lines do row[l + 1] = shown(values[l][xs[i]]) end
    rows[#rows + 1] = row
  end
  return heads, rows, stride
end

--- Between its place in a large window and on paper, so that letters have about the size of the page's.
local sizes <const> = { timeline = { 900, 220 }, curve = { 400, 260 }, interval = { 640 } }

local size_of_map <const> = { 400, 340 }

local function drawing(figure)
  local size = figure.equal and size_of_map or sizes[figure.kind]
  local chart = setmetatable({ width = size[1], height = size[2] }, { __index = figure })
  return figure.kind == "interval" and svg.intervals(chart) or svg.lines(chart)
end

function M.figure(figure)
  local heads, rows, stride = numbers_of(figure)
  local told = (stride or 1) > 1 and text("p", { class = "note" }, ("Every %d-th."):format(stride)) or ""
  local caption = text("strong", {}, figure.title)
  if figure.text then caption = caption .. text("span", { class = "note" }, figure.text) end
  return element("figure", { id = figure.id, class = "figure " .. figure.kind,
      ["data-group"] = figure.group and json.encode(figure.group) },
    element("figcaption", {}, caption) .. element("div", { class = "drawing" }, drawing(figure))
    .. element("details", {}, text("summary", {}, "Numbers") .. tables.plain("plain", heads, rows) .. told))
end

return M
