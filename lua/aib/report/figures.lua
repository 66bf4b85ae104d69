-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Figures from views and records: lines of one title whose groups differ in the method alone are one figure, and every
--- record with bounds beside it ("x", "x_low", "x_high") is an interval.
---
--- A figure is
---   id, kind = "curve" | "timeline" | "interval", title, where = what the groups have in common, text
---   group    what the groups have in common, as a table
---   x, y     { label =, unit =, scale = "linear" | "log" }
---   frames   of a timeline: the names along x
---   lines    of curves and timelines: { label =, group =, x = numbers, y = numbers, place = number }; NaN is a gap;
---            the place tells its colour: a method has the same one in every figure
---   rows     of intervals: { label =, value =, low =, high = }
local definitions = require "aib.report.definitions"
local report_module = require "aib.report"
local suggest = require "aib.suggest"

local M = {}

local apart <const> = { method = true, batch = true, model = true, file = true }

local function common_part(group)
  local common = {}
  for key, value in pairs(group) do
    if not apart[key] then common[key] = value end
  end
  return common
end

local function texts_of(group, wanted)
  local parts = {}
  for _, key in ipairs(report_module.ordered_keys { group }) do
    if wanted(key) then parts[#parts + 1] = group[key] end
  end
  return table.concat(parts, " / ")
end

local function place_of(group) return texts_of(group, function(key) return not apart[key] end) end
local function own_name(group) return texts_of(group, function(key) return apart[key] end) end

local function line_label(view)
  local name = own_name(view.group)
  if view.label and name ~= "" then return ("%s, %s"):format(name, view.label) end
  return view.label or name
end

--- A list that makes each figure where its first part comes.
local function collector()
  local list, index = {}, {}
  return list, function(kind, title, group, make)
    local id = table.concat({ kind, title, kind == "interval" and "" or place_of(group) }, "\0")
    if not index[id] then
      local figure = make()
      figure.kind, figure.title, figure.id = kind, title, ("figure-%d"):format(#list + 1)
      if kind ~= "interval" then figure.group, figure.where = common_part(group), place_of(group) end
      list[#list + 1], index[id] = figure, figure
    end
    return index[id]
  end
end

local function add_curve(figure_of, view)
  local figure = figure_of("curve", view.title, view.group, function()
    return { x = view.x, y = view.y, text = view.text, steps = view.steps, equal = view.equal, lines = {} }
  end)
  table.insert(figure.lines, { label = line_label(view), group = view.group, x = view.at, y = view.values })
end

--- Timelines are gathered first: their frames are those of any line, in the order of their names.
local function add_timeline(figure_of, view)
  local figure = figure_of("timeline", view.title, view.group, function()
    return { x = { label = "frame" }, y = view.y, text = view.text, lines = {}, parts = {} }
  end)
  table.insert(figure.parts, view)
end

local function finish_timeline(figure)
  local seen = {}
  for _, part in ipairs(figure.parts) do
    for _, name in ipairs(part.frames) do seen[name] = true end
  end
  figure.frames = suggest.keys(seen)
  for _, part in ipairs(figure.parts) do
    local by_name, x, y = {}, {}, {}
    for i, name in ipairs(part.frames) do by_name[name] = part.values[i] end
    for i, name in ipairs(figure.frames) do x[i], y[i] = i, by_name[name] or 0 / 0 end
    table.insert(figure.lines, { label = line_label(part), group = part.group, x = x, y = y })
  end
  figure.parts = nil
end

local function add_interval(figure_of, view)
  local figure = figure_of("interval", view.title, view.group, function()
    return { x = { label = view.title, unit = view.unit }, rows = {}, text = view.text }
  end)
  local name = texts_of(view.group, function() return true end)
  if view.label then name = name == "" and view.label or name .. ", " .. view.label end
  table.insert(figure.rows, { label = name, value = view.value, low = view.low, high = view.high })
end

local bounds <const> = { { "_low", "_high" }, { ", low", ", high" } }
local centres <const> = { ["_low"] = "", [", low"] = ", difference" }

local function interval_text(name)
  local definition = definitions.of(name)
  local is_change = name:find("_change$") or name:find("_slope$") or name:find(", difference$")
  return (definition and definition .. " " or "") .. "The bar is the interval of 95 %"
    .. (is_change and "; where it leaves out 0, the change is more than chance." or ".")
end

--- Records that have bounds, as intervals.
local function add_records(figure_of, records)
  local by_place = {}
  for _, r in ipairs(records) do by_place[r.name .. "\0" .. r.group_id] = r end
  for _, low in ipairs(records) do
    for _, suffix in ipairs(bounds) do
      local name = low.name:sub(-#suffix[1]) == suffix[1] and low.name:sub(1, -#suffix[1] - 1)
      local high = name and by_place[name .. suffix[2] .. "\0" .. low.group_id]
      local centre = name and by_place[name .. centres[suffix[1]] .. "\0" .. low.group_id]
      if high and centre and centre.value and low.value and high.value then
        add_interval(figure_of, { title = centre.name, unit = centre.unit, group = low.group, value = centre.value,
          low = low.value, high = high.value, text = interval_text(centre.name) })
      end
    end
  end
end

--- Numbers what tells lines apart: in the order of the records, then of the lines.
local function place_lines(figures, records)
  local names, places, n = {}, {}, 0
  for _, figure in ipairs(figures) do
    for _, line in ipairs(figure.lines or {}) do
      local name = own_name(line.group)
      names[line] = name ~= "" and name or line.label
      places[names[line]] = 0
    end
  end
  local function give_place(name)
    if places[name] == 0 then n, places[name] = n + 1, n + 1 end
  end
  for _, record in ipairs(records) do give_place(own_name(record.group)) end
  for _, figure in ipairs(figures) do
    for _, line in ipairs(figure.lines or {}) do
      give_place(names[line])
      line.place = places[names[line]]
    end
  end
end

--- The figures of a report, in the order of its views, intervals of records last.
function M.of(report)
  local list, figure_of = collector()
  for _, view in ipairs(report.store.views or {}) do
    if view.kind == "curve" then add_curve(figure_of, view) end
    if view.kind == "timeline" then add_timeline(figure_of, view) end
    if view.kind == "interval" then add_interval(figure_of, view) end
  end
  add_records(figure_of, report:records())
  for _, figure in ipairs(list) do
    if figure.parts then finish_timeline(figure) end
  end
  place_lines(list, report:records())
  return list
end

return M
