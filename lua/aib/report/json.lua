-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A report as JSON: every number exactly, nothing of the machine (no date, host or path), so that equal results are
--- equal bytes.
---
---   aib          { version =, format = 1 }
---   protocol     { name =, title =, cite = }
---   inputs       options of the run
---   conventions  name -> sentence
---   sources      file, relative to the benchmark -> { bytes =, sha256 = }
---   records      { name =, value = number|null, unit =, better =, n =, group =, convention =, options =, note = }
---   notes        { key =, text = }
local json = require "aib.json"

local format_version <const> = 1

local function record_of(r)
  return {
    name = r.name, value = r.value == nil and json.null or r.value, unit = r.unit, better = r.better, n = r.n,
    group = next(r.group) and r.group or nil, convention = r.convention, options = r.options, note = r.note,
  }
end

return function(report)
  local records, notes = json.list(), json.list()
  for i, r in ipairs(report:records()) do records[i] = record_of(r) end
  for i, note in ipairs(report:notes()) do notes[i] = { key = note.key, text = note.text } end
  local store = report.store
  return json.encode {
    aib = { version = report.version, format = format_version },
    protocol = { name = report.name, title = report.title, cite = report.cite },
    inputs = store.inputs, conventions = store.conventions, sources = store.sources, records = records, notes = notes,
  } .. "\n"
end
