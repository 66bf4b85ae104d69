-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Tables over records: which metric, what goes down, what goes across.
---
--- A table is asked for by
---   title      text; unit and arrow are added
---   metrics    list of { "name", label = "AUC30", percent = true } or of names
---   down       list of group keys, "metric" among them (default { "method" })
---   across     the same (default { "scene", "condition" })
---   beside     list of { metric = "name", percent = true } or { field = "n" }: stands beside every value
---   bold_from  { metric = "depth.coverage", at_least = 0.5 }: below it no value is the best
---   notes      list of sentences
---
--- A grid, which every format writes in its own way, is
---   title, notes, columns = count
---   header   levels from the top, each a list of { text =, span = }
---   rows     each { label = text, group = table, cells ... }; a cell is { text =, best = true|nil, second = true|nil,
---            aside = text|nil, record = record|nil }
--- A head of a level has a group, too: what all records below it have in common.
local number = require "aib.report.number"
local suggest = require "aib.suggest"

local M = {}

local dash <const> = "–"
local arrows <const> = { lower = " ↓", higher = " ↑" }
local fields <const> = {
  title = true, metrics = true, down = true, across = true, beside = true, bold_from = true, notes = true,
}

--- Throws an error at `level` where a spec is not one.
function M.check(spec, level)
  suggest.check_keys("report:table", spec, fields, level + 1)
  if type(spec.title) ~= "string" then error("report:table: title: a string expected", level + 1) end
  if type(spec.metrics) ~= "table" then error("report:table: metrics: a list of names expected", level + 1) end
end

--- The spec with every field in its full form.
local function completed(spec)
  local metrics = {}
  for i, m in ipairs(spec.metrics) do
    if type(m) ~= "table" then m = { m } end
    metrics[i] = { name = m[1], label = m.label or m[1], percent = m.percent }
    metrics[m[1]] = metrics[i]
  end
  return {
    title = spec.title, metrics = metrics, down = spec.down or { "method" },
    across = spec.across or { "scene", "condition" }, beside = spec.beside or {}, bold_from = spec.bold_from,
    notes = spec.notes or {},
  }
end

--- A list of tuples of texts, each once.
local function tuples()
  local list, index = {}, {}
  return list, function(tuple)
    local id = table.concat(tuple, "\0")
    if not index[id] then
      list[#list + 1] = tuple
      index[id] = #list
    end
    return index[id]
  end
end

local function tuple_of(keys, record)
  local tuple = {}
  for i, key in ipairs(keys) do tuple[i] = key == "metric" and record.name or record.group[key] or "" end
  return tuple
end

--- Whether the table has a place for every key of the record's group, and the record a value for one.
local function belongs(record, keys)
  local placed = false
  for key in pairs(record.group) do
    if not keys[key] then return false end
    placed = true
  end
  return placed or keys.metric
end

--- Records by row and column. Without "metric" among the keys, records of other metrics make their rows and columns
--- too: a method that lacks the metric is a row of dashes.
local function placed(spec, records)
  local keys, cells = {}, {}
  for _, key in ipairs(spec.down) do keys[key] = true end
  for _, key in ipairs(spec.across) do keys[key] = true end
  local rows, add_row = tuples()
  local columns, add_column = tuples()
  for _, record in ipairs(records) do
    local wanted = spec.metrics[record.name]
    if belongs(record, keys) and (wanted or not keys.metric) then
      local r, c = add_row(tuple_of(spec.down, record)), add_column(tuple_of(spec.across, record))
      cells[r] = cells[r] or {}
      if wanted then cells[r][c] = record end
    end
  end
  return rows, columns, cells
end

--- Decimals for each metric, one count down the whole table.
local function decimals_of(cells)
  local values, decimals = {}, {}
  for _, row in pairs(cells) do
    for _, record in pairs(row) do
      local list = values[record.name] or {}
      values[record.name] = list
      list[#list + 1] = record.value
    end
  end
  for name, list in pairs(values) do decimals[name] = number.decimals(list) end
  return decimals
end

local function has_value(record) return record ~= nil and record.value ~= nil end

--- What a table is drawn from: its spec, the decimals, and every record by metric and group.
local function drawing(spec, records, cells)
  local index = {}
  for _, record in ipairs(records) do index[record.name .. "\0" .. record.group_id] = record end
  local self = { spec = spec, decimals = decimals_of(cells) }

  --- The record of another metric in the same group.
  function self.beside(record, name) return index[name .. "\0" .. record.group_id] end

  function self.value(record)
    if not has_value(record) then return dash end
    if spec.metrics[record.name].percent then return number.percent(record.value) end
    return number.fixed(record.value, self.decimals[record.name])
  end

  function self.aside(record)
    if not has_value(record) or #spec.beside == 0 then return nil end
    local parts = {}
    for i, b in ipairs(spec.beside) do
      local value = b.field and record[b.field]
      if b.metric then value = (self.beside(record, b.metric) or {}).value end
      parts[i] = value == nil and dash or b.percent and number.percent(value) .. " %" or number.short(value)
    end
    return table.concat(parts, ", ")
  end

  --- Whether a value may be the best.
  function self.competes(record)
    if not has_value(record) or not record.better then return false end
    if not spec.bold_from then return true end
    local other = self.beside(record, spec.bold_from.metric)
    return has_value(other) and other.value >= spec.bold_from.at_least
  end

  return self
end

--- The text of the best of the records that compete and do not read as `but`; nil where there is none.
local function best_text(records, draw, but)
  local best
  for _, record in pairs(records) do
    if draw.competes(record) and draw.value(record) ~= but then
      local sign = record.better == "lower" and 1 or -1
      if not best or sign * record.value < sign * best.value then best = record end
    end
  end
  return best and draw.value(best)
end

--- Marks the best of some records, those that read the same, and the second best; one alone is not the best of
--- anything.
local function mark_best(records, cells, draw)
  local count = 0
  for _, record in pairs(records) do
    if has_value(record) then count = count + 1 end
  end
  local best = count > 1 and best_text(records, draw)
  if not best then return end
  local second = count > 2 and best_text(records, draw, best)
  for i, record in pairs(records) do
    cells[i].best = draw.competes(record) and cells[i].text == best or nil
    cells[i].second = draw.competes(record) and cells[i].text == second or nil
  end
end

--- Values of one metric are compared down the methods, or across where the metrics go down.
local function mark_all(spec, rows, cells, grid_rows, draw)
  if spec.down[#spec.down] == "metric" then
    for r = 1, #rows do mark_best(cells[r], grid_rows[r], draw) end
    return
  end
  for c = 1, #grid_rows[1] do
    local column, column_cells = {}, {}
    for r = 1, #rows do column[r], column_cells[r] = cells[r][c], grid_rows[r][c] end
    mark_best(column, column_cells, draw)
  end
end

--- A metric's unit and direction as its records state them.
local function manner(records, name)
  for _, record in ipairs(records) do
    if record.name == name and (record.unit or record.better) then return record.unit, record.better end
  end
end

--- "AUC30 (%) ↑"
local function heading(text, metric, records)
  local unit, better = manner(records, metric.name)
  if metric.percent then unit = "%" end
  return text .. (unit and (" (%s)"):format(unit) or "") .. (arrows[better] or "")
end

local function label_of(keys, tuple, spec, records)
  local parts = {}
  for i, key in ipairs(keys) do
    local text = tuple[i]
    if key == "metric" then text = heading(spec.metrics[text].label, spec.metrics[text], records) end
    if text ~= "" then parts[#parts + 1] = text end
  end
  return table.concat(parts, " / ")
end

--- The group that the first `n` of a tuple's texts say.
local function group_of(keys, tuple, n)
  local group = {}
  for i = 1, n do
    if keys[i] ~= "metric" and tuple[i] ~= "" then group[keys[i]] = tuple[i] end
  end
  return group
end

--- Levels of the header, columns with the same text above them joined; levels without text are left out.
local function header_of(spec, columns, records)
  local levels = {}
  for depth, key in ipairs(spec.across) do
    local level, texts, above = {}, 0, nil
    for _, tuple in ipairs(columns) do
      local text = label_of({ key }, { tuple[depth] }, spec, records)
      local path = table.concat(tuple, "\0", 1, depth)
      if path == above then
        level[#level].span = level[#level].span + 1
      else
        level[#level + 1] = { text = text, span = 1, group = group_of(spec.across, tuple, depth) }
      end
      if text ~= "" then texts = texts + 1 end
      above = path
    end
    if texts > 0 then levels[#levels + 1] = level end
  end
  return levels
end

local function uses_metric(keys)
  for _, key in ipairs(keys) do
    if key == "metric" then return true end
  end
  return false
end

--- The grid of a table over the records of a report.
function M.build(spec, report)
  spec = completed(spec)
  local records = report:records()
  local rows, columns, cells = placed(spec, records)
  local draw = drawing(spec, records, cells)
  local grid = { title = spec.title, rows = {}, columns = #columns, notes = {} }
  for r, tuple in ipairs(rows) do
    local row = { label = label_of(spec.down, tuple, spec, records), group = group_of(spec.down, tuple, #tuple) }
    for c = 1, #columns do
      local record = cells[r][c]
      row[c] = { text = draw.value(record), aside = draw.aside(record), record = record }
    end
    grid.rows[r] = row
  end
  if #rows > 0 then mark_all(spec, rows, cells, grid.rows, draw) end
  if not uses_metric(spec.down) and not uses_metric(spec.across) and spec.metrics[1] then
    grid.title = heading(spec.title, spec.metrics[1], records)
  end
  grid.header = header_of(spec, columns, records)
  table.move(spec.notes, 1, #spec.notes, 1, grid.notes)
  return grid
end

--- One table of all records: metrics down and groups across, or the other way round where there are more groups.
function M.default(report)
  local metrics, groups = {}, {}
  local metric_count, group_count = 0, 0
  for _, record in ipairs(report:records()) do
    if not metrics[record.name] then
      metric_count = metric_count + 1
      metrics[metric_count], metrics[record.name] = record.name, true
    end
    if not groups[record.group_id] then group_count, groups[record.group_id] = group_count + 1, true end
  end
  if metric_count == 0 then return {} end
  local names, keys = table.move(metrics, 1, metric_count, 1, {}), report:group_keys()
  if group_count <= metric_count or group_count <= 4 then
    return { { title = report.title, metrics = names, down = { "metric" }, across = keys } }
  end
  return { { title = report.title, metrics = names, down = keys, across = { "metric" } } }
end

return M
