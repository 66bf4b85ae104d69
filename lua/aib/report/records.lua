-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Records and notes of a report as tables for JSON, and back.
local json = require "aib.json"

local M = {}

function M.encode_one(r)
  return {
    name = r.name, value = r.value == nil and json.null or r.value, unit = r.unit, better = r.better, n = r.n,
    group = next(r.group) and r.group or nil, convention = r.convention, options = r.options, note = r.note,
  }
end

--- The record that encode_one made a table of.
function M.decode(t)
  local record = {}
  for key, value in pairs(t) do record[key] = value end
  if record.value == json.null then record.value = nil end
  record.group = record.group or {}
  return record
end

function M.encode(report)
  local list = json.list()
  for i, r in ipairs(report:records()) do list[i] = M.encode_one(r) end
  return list
end

function M.notes(report)
  local list = json.list()
  for i, note in ipairs(report:notes()) do list[i] = { key = note.key, text = note.text } end
  return list
end

return M
