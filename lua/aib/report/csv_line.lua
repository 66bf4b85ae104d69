-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A line of a CSV file (RFC 4180): every number in its shortest exact form.
local json = require "aib.json"

local function field(value)
  if type(value) == "number" then return json.number(value) end
  local text = tostring(value)
  return text:find('[",\r\n]') and '"' .. text:gsub('"', '""') .. '"' or text
end

--- Numbers and texts, without gaps.
return function(values)
  local fields = {}
  for i, value in ipairs(values) do fields[i] = field(value) end
  return table.concat(fields, ",") .. "\n"
end
