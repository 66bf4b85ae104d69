-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The records of a report as CSV (RFC 4180): a line each, every number in its shortest exact form.
local json = require "aib.json"

local function quoted(text)
  return text:find('[",\r\n]') and '"' .. text:gsub('"', '""') .. '"' or text
end

local function field(value)
  if value == nil then return "" end
  if type(value) == "number" then return json.number(value) end
  return quoted(tostring(value))
end

return function(report)
  local keys = report:group_keys()
  local heads = table.move(keys, 1, #keys, 1, {})
  table.move({ "metric", "value", "unit", "better", "n", "convention", "note" }, 1, 7, #heads + 1, heads)
  local lines = { table.concat(heads, ",") }
  for _, r in ipairs(report:records()) do
    local fields = {}
    for i, key in ipairs(keys) do fields[i] = field(r.group[key]) end
    for _, key in ipairs { "name", "value", "unit", "better", "n", "convention", "note" } do
      fields[#fields + 1] = field(r[key])
    end
    lines[#lines + 1] = table.concat(fields, ",")
  end
  return table.concat(lines, "\n") .. "\n"
end
