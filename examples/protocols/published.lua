-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A published table as results, so that it can be compared with others and checked for impossible cells. The table is
--- a CSV file with a line for each cell: metric, value, and what else --csv writes (unit, better, n, convention, note);
--- every other column says where the cell is (scene, condition, method, ...).
---
---   aib-lua published table.csv --cite "Authors, title, year, table 2" --json table.json
---   aib-lua compare table.json results.json
local aib = require "aib"
local failure = require "aib.failure"
local suggest = require "aib.suggest"

--- The fields of a CSV line (RFC 4180; a field lies within one line).
local function fields_of(line)
  local fields, at = {}, 1
  while at <= #line + 1 do
    local stop, text = line:find(",", at, true) or #line + 1, nil
    if line:sub(at, at) == '"' then
      local last = at + 1
      while line:find('^[^"]', last) or line:find('^""', last) do last = last + (line:find('^"', last) and 2 or 1) end
      text, stop = line:sub(at + 1, last - 1):gsub('""', '"'), last + 1
    end
    fields[#fields + 1] = text or line:sub(at, stop - 1):match "^%s*(.-)%s*$"
    at = stop + 1
  end
  return fields
end

local better <const> = {
  ["depth.srmse"] = "lower", ["pose.auc30"] = "higher", ["pose.registration_rate"] = "higher",
  ["camera.focal_mre"] = "lower", ["cloud.accuracy"] = "lower", ["cloud.completeness"] = "lower",
  ["cloud.chamfer"] = "lower", ["cloud.chamfer_mean"] = "lower", ["cloud.f1_distance"] = "lower",
}
local own_columns <const> = { metric = true, value = true, unit = true, better = true, n = true, convention = true,
  note = true }
local no_number <const> = { [""] = true, ["-"] = true, ["–"] = true }

--- The number of a cell and half a unit of its last digit; nil of one without. "97.4 %" is 0.974.
local function number_of(text, wrong)
  if no_number[text] then return nil end
  local digits, percent = text:match "^([+-]?%d*%.?%d*)%s*(%%?)$"
  local exponent = percent == "%" and -2 or 0
  local value = digits and tonumber(("%se%d"):format(digits, exponent))
  if not value then wrong(("value: a number expected, found '%s'"):format(text)) end
  local decimals = digits:match "%.(%d*)$" or ""
  return value, 0.5 * 10.0 ^ (exponent - #decimals)
end

--- The cells of a table, a table by column each.
local function cells_of(path)
  local cells, heads, n = {}, nil, 0
  for line in (aib.system.read_text(path):gsub("\r", "") .. "\n"):gmatch "(.-)\n" do
    n = n + 1
    local here = ("%s:%d: "):format(path, n)
    local function wrong(sentence) failure.raise("format", here .. sentence) end
    local is_comment = line:find "^#" or not line:find "%S"
    if not is_comment and not heads then
      heads = fields_of(line)
      local has = suggest.set(heads)
      if not (has.metric and has.value) then wrong "columns metric and value expected in the first line" end
    elseif not is_comment then
      local fields = fields_of(line)
      if #fields ~= #heads then wrong(("%d fields expected, found %d"):format(#heads, #fields)) end
      local cell = { wrong = wrong }
      for i, head in ipairs(heads) do cell[head] = fields[i] end
      cells[#cells + 1] = cell
    end
  end
  if #cells == 0 then failure.raise("format", path .. ": cells expected, found none") end
  return cells
end

local function group_of(cell)
  local group = {}
  for column, text in pairs(cell) do
    if not own_columns[column] and column ~= "wrong" and text ~= "" then group[column] = text end
  end
  return group
end

local function text_of(cell, column) return cell[column] and cell[column] ~= "" and cell[column] or nil end

return aib.protocol {
  name = "published",
  title = "Published table",
  help = "Reads a published table from CSV as results, notes its impossible cells, and writes it for aib-lua compare.",
  inputs = {
    table = { kind = "file", position = 1, help = "CSV file: columns metric, value, and where the cell is" },
    cite = { kind = "text", help = "where it was published" },
    title = { kind = "text", default = "", help = "of the table" },
  },
  run = function(input, report)
    report.cite = input.cite
    if input.title ~= "" then report.title = input.title end
    local rounding = 0
    for _, cell in ipairs(cells_of(input.table)) do
      local value, half = number_of(cell.value, cell.wrong)
      rounding = math.max(rounding, half or 0)
      report:within(group_of(cell)):add(cell.metric, value, {
        unit = text_of(cell, "unit") or cell.metric:find "^cloud%." and "m" or nil,
        better = text_of(cell, "better") or better[cell.metric],
        n = tonumber(text_of(cell, "n")), convention = text_of(cell, "convention"), note = text_of(cell, "note"),
      })
    end
    report.store.rounding = rounding
    report:convention("table", "as published, to the digits that are printed; nothing here was computed")
    local _, groups = aib.consistency.check_report(report, rounding)
    report:note(("%d groups have impossible numbers"):format(groups))
  end,
}
