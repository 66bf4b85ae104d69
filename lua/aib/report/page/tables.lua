-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The tables of a report as HTML. A cell names its record and a heading its group, which the page's script reads to
--- sort, to explain a number and to show one method or scene alone.
local json = require "aib.json"
local markup = require "aib.report.markup"

local element, text = markup.element, markup.text

local M = {}

local function group_attribute(group) return group and next(group) and json.encode(group) or nil end

--- Title of a cell where no script explains it.
local function told(record)
  if not record then return nil end
  local parts = { record.name, record.convention, record.n and ("n = %s"):format(json.number(record.n)), record.note }
  local list = {}
  for i = 1, 4 do list[#list + 1] = parts[i] end
  return table.concat(list, "; ")
end

local function cell_html(cell, places)
  local value = markup.escaped(cell.text)
  if cell.best then value = element("b", {}, value) end
  if cell.second then value = element("u", {}, value) end
  if cell.aside then value = value .. " " .. text("small", {}, cell.aside) end
  local record = cell.record
  return element("td", {
    ["data-record"] = record and places[record], ["data-value"] = record and record.value and json.number(record.value),
    tabindex = record and 0, title = told(record),
  }, value)
end

local function head_row(level, is_last)
  local cells = { element("th", { class = is_last and "corner" or nil }, "") }
  for _, head in ipairs(level) do
    local is_wide = head.span > 1
    cells[#cells + 1] = text("th", { colspan = is_wide and head.span, scope = is_wide and "colgroup" or "col",
      ["data-group"] = group_attribute(head.group) }, head.text)
  end
  return element("tr", {}, table.concat(cells))
end

local function head(grid)
  local rows = {}
  for i, level in ipairs(grid.header) do rows[i] = head_row(level, i == #grid.header) end
  return element("thead", {}, table.concat(rows, "\n"))
end

local function body(grid, places)
  local rows = {}
  for i, row in ipairs(grid.rows) do
    local cells = { text("th", { scope = "row", ["data-group"] = group_attribute(row.group) }, row.label) }
    for c, cell in ipairs(row) do cells[c + 1] = cell_html(cell, places) end
    rows[i] = element("tr", {}, table.concat(cells))
  end
  return element("tbody", {}, table.concat(rows, "\n"))
end

--- A grid (aib.report.grid); `places` has the number of each record.
function M.table(grid, places)
  local notes = {}
  for i, note in ipairs(grid.notes) do notes[i] = text("p", { class = "note" }, note) end
  local caption = text("caption", {}, grid.title)
  local whole = element("table", { class = "grid" }, caption .. head(grid) .. body(grid, places))
  return element("div", { class = "one" }, element("div", { class = "scroll", tabindex = 0, role = "region",
    ["aria-label"] = grid.title }, whole) .. table.concat(notes))
end

--- A plain table: heads and rows of texts, a row's cells { text =, number = true|nil } or texts.
function M.plain(class, heads, rows, attributes)
  local out, head_cells = {}, {}
  for i, h in ipairs(heads) do head_cells[i] = text("th", { scope = "col" }, h) end
  for i, row in ipairs(rows) do
    local cells = {}
    for c, words in ipairs(row) do
      cells[c] = text("td", { class = tonumber(words) and "number" or nil }, words)
    end
    out[i] = element("tr", attributes and attributes(i) or {}, table.concat(cells))
  end
  return element("div", { class = "scroll", tabindex = 0 }, element("table", { class = class },
    element("thead", {}, element("tr", {}, table.concat(head_cells))) .. element("tbody", {}, table.concat(out, "\n"))))
end

return M
