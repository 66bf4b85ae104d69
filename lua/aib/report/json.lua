-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A report as JSON: every number exactly, nothing of the machine (no date, host or path), so that equal results are
--- equal bytes. The schema is aib/results.schema.json.
---
---   aib          { version =, format = 1 }
---   protocol     { name =, title =, cite = }
---   inputs       options of the run
---   conventions  name -> sentence
---   sources      file, relative to the benchmark -> { bytes =, sha256 = }
---   rounding     where the numbers are from print: half a unit of the last digit
---   records      { name =, value = number|null, unit =, better =, n =, group =, convention =, options =, note = }
---   notes        { key =, text = }
---   frames       where asked for: { metric =, group =, names =, values = }
---   shard        of a part of a run: { index =, count =, n_parts =, parts =, sha256 = }, for aib-lua merge
local json = require "aib.json"
local records = require "aib.report.records"
local seal_of = require "aib.report.seal"

local format_version <const> = 1

return function(report)
  local store = report.store
  local result = {
    aib = { version = report.version, format = format_version },
    protocol = { name = report.name, title = report.title, cite = report.cite },
    inputs = store.inputs, conventions = store.conventions, sources = store.sources, rounding = store.rounding,
    records = records.encode(report), notes = records.notes(report), frames = store.frames, shard = store.shard,
  }
  if result.shard then result.shard.sha256 = seal_of(result) end
  return json.encode(result) .. "\n"
end
