-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The records of a report as CSV, a line each.
local line = require "aib.report.csv_line"

local columns <const> = { "value", "unit", "better", "n", "convention", "note" }

return function(report)
  local keys = report:group_keys()
  local heads = table.move(keys, 1, #keys, 1, {})
  table.move({ "metric", table.unpack(columns) }, 1, 1 + #columns, #heads + 1, heads)
  local lines = { line(heads) }
  for _, r in ipairs(report:records()) do
    local fields = {}
    for i, key in ipairs(keys) do fields[i] = r.group[key] or "" end
    fields[#fields + 1] = r.name
    for _, column in ipairs(columns) do fields[#fields + 1] = r[column] or "" end
    lines[#lines + 1] = line(fields)
  end
  return table.concat(lines)
end
