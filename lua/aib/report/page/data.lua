-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What the page's script reads: one JSON document, and packed data (base64 of zlib streams) beside it, named by it.
local definitions = require "aib.report.definitions"
local json = require "aib.json"
local markup = require "aib.report.markup"
local records = require "aib.report.records"
local suggest = require "aib.suggest"

local M = {}

local packed_fields <const> = {
  positions = true, triangles = true, data = true, estimate = true, reference = true, error = true,
}

--- A copy of a value in which packed data is replaced by its number in `blobs`; the same data is there once. Lists hold
--- numbers and further tables.
local function without_data(value, blobs)
  if type(value) ~= "table" or value == json.null then return value end
  if getmetatable(value) == getmetatable(json.list()) then
    local list = json.list()
    for i, element in ipairs(value) do list[i] = without_data(element, blobs) end
    return list
  end
  local copy = {}
  for _, key in ipairs(suggest.keys(value)) do
    local element = value[key]
    if packed_fields[key] and type(element) == "string" then
      if not blobs.place[element] then
        blobs[#blobs + 1] = element
        blobs.place[element] = #blobs
      end
      copy[key] = blobs.place[element]
    else
      copy[key] = without_data(element, blobs)
    end
  end
  return copy
end

--- Six digits of each number, which is more than a chart shows; null where there is none.
local function for_chart(list)
  local out = json.list()
  for i, x in ipairs(list) do
    local is_finite = x == x and math.abs(x) < math.huge
    out[i] = is_finite and tonumber(("%.6g"):format(x)) or json.null
  end
  return out
end

local function figure_data(figure)
  local copy = {}
  for key, value in pairs(figure) do copy[key] = value end
  if not figure.lines then return copy end
  copy.lines = json.list()
  for i, line in ipairs(figure.lines) do
    copy.lines[i] = { label = line.label, group = line.group, place = line.place - 1, x = for_chart(line.x),
      y = for_chart(line.y) }
  end
  return copy
end

local drawn <const> = { frame = true, cloud = true, mesh = true, cameras = true }

--- The script elements of a report with its figures, for a page that has a script to read them.
function M.elements(report, figures)
  local blobs = { place = {} }
  local document = { records = records.encode(report), figures = json.list(), views = json.list(), definitions = {},
    keys = json.list(report:group_keys()) }
  for _, record in ipairs(report:records()) do
    document.definitions[record.name] = definitions.of(record.name)
  end
  for i, figure in ipairs(figures) do document.figures[i] = figure_data(figure) end
  for _, view in ipairs(report.store.views or {}) do
    if drawn[view.kind] then table.insert(document.views, without_data(view, blobs)) end
  end
  local out = { markup.element("script", { type = "application/json", id = "report" }, markup.json(document)) }
  for i, blob in ipairs(blobs) do
    out[i + 1] = markup.element("script", { type = "application/octet-stream", id = "data-" .. i }, blob)
  end
  return table.concat(out, "\n")
end

return M
