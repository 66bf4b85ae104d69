-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Numbers as people read them in tables: the same decimals down a table, and no false zero.
local M = {}

local least_decimals <const> = 3
local most_decimals <const> = 6

--- Decimals that show at least two digits of the smallest of `values` that is not 0, from 3 to 6.
function M.decimals(values)
  local decimals = least_decimals
  for _, x in ipairs(values) do
    local size = math.abs(x)
    while decimals < most_decimals and size > 0 and size < 10 ^ (1 - decimals) do decimals = decimals + 1 end
  end
  return decimals
end

--- `x` with that many decimals; in powers of ten where they would show nothing of it, or it is huge.
function M.fixed(x, decimals)
  if x == math.huge or x == -math.huge or x ~= x then return tostring(x) end
  local size = math.abs(x)
  if size > 0 and size < 0.5 * 10 ^ -decimals or size >= 1e9 then return ("%.1e"):format(x) end
  if math.type(x) == "integer" then return ("%d"):format(x) end
  return ("%." .. decimals .. "f"):format(x)
end

--- A share of 0..1 in percent: two digits where it is small, and never 100 for less, 0 for more.
function M.percent(share)
  local percent = 100 * share
  local text = ("%.1f"):format(percent)
  if text == "100.0" and share < 1 then return "99.9" end
  if text == "0.0" and share > 0 then return ("%.2g"):format(percent) end
  return text
end

--- A short number on its own: five significant digits.
function M.short(x)
  if math.type(x) == "integer" then return ("%d"):format(x) end
  return ("%.5g"):format(x)
end

--- A count with its noun: 1 frame, 2 frames.
function M.count(n, noun)
  if n == 1 then return "1 " .. noun end
  return ("%d %s"):format(n, noun:find("[sx]$") and noun .. "es" or noun:gsub("y$", "ie") .. "s")
end

return M
