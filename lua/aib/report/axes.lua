-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Axes of a plot: where the ticks are, what stands at them, where a number lies.
local M = {}

--- Lowest and highest of the finite numbers of lists; nil where there is none.
function M.range_of(lists)
  local low, high
  for _, list in ipairs(lists) do
    for _, x in ipairs(list) do
      if x == x and math.abs(x) < math.huge then low, high = math.min(low or x, x), math.max(high or x, x) end
    end
  end
  return low, high
end

--- 1, 2 or 5 times a power of ten, about `span / count`.
local function step_of(span, count)
  local rough = span / count
  local power = 10.0 ^ math.floor(math.log(rough, 10))
  for _, factor in ipairs { 1, 2, 5 } do
    if rough <= factor * power * 1.0000001 then return factor * power end
  end
  return 10 * power
end

local function linear_ticks(low, high, count)
  local ticks, step = {}, step_of(high - low, count)
  for i = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) do ticks[#ticks + 1] = i * step end
  return ticks
end

local function log_ticks(low, high)
  local ticks = {}
  local factors = high / low > 1000 and { 1 } or { 1, 2, 5 }
  for exponent = math.floor(math.log(low, 10)), math.ceil(math.log(high, 10)) do
    for _, factor in ipairs(factors) do
      local tick = factor * 10.0 ^ exponent
      if tick >= low * 0.999 and tick <= high * 1.001 then ticks[#ticks + 1] = tick end
    end
  end
  return ticks
end

--- "0.25", "1000", "1e-05".
local function tick_text(x)
  if x == 0 then return "0" end
  local text = ("%.6g"):format(x)
  return (text:gsub("^%-", "−"))
end

--- An axis over [low, high], rounded to ticks where `exact` is not asked for:
---   { low =, high =, ticks = list, text = function(tick), place = function(x) -> 0..1, nil off a log axis }
--- options = { scale = "linear" | "log", ticks = about how many, exact = true|nil }
function M.axis(low, high, options)
  local count = options.ticks or 5
  if options.scale == "log" then
    if high <= low then low, high = low / 2, high * 2 end
    local a, span = math.log(low), math.log(high / low)
    local function place(x) return x > 0 and (math.log(x) - a) / span or nil end
    return { low = low, high = high, ticks = log_ticks(low, high), text = tick_text, place = place }
  end
  if high <= low then low, high = low - 0.5, high + 0.5 end
  if not options.exact then
    local step = step_of(high - low, count)
    low, high = step * math.floor(low / step + 1e-9), step * math.ceil(high / step - 1e-9)
  end
  local function place(x) return (x - low) / (high - low) end
  return { low = low, high = high, ticks = linear_ticks(low, high, count), text = tick_text, place = place }
end

--- "error (m)"
function M.label(axis)
  return (axis.label or "") .. (axis.unit and (" (%s)"):format(axis.unit) or "")
end

return M
