-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Tests of Lua code. A script returns its cases and aib-lua runs them: dots, then what failed and where.
---
---   local aib = require "aib"
---
---   return aib.test {
---     ["the mean of 1, 2, 3 is 2"] = function(t)
---       t:near(aib.stats.summary({ 1, 2, 3 }).mean, 2, 1e-15)
---     end,
---   }
local suggest = require "aib.suggest"

local line_width <const> = 72

--- Text of a value that tells 1 from "1".
local function shown(value)
  if type(value) == "string" then return (("%q"):format(value):gsub("\\\n", "\\n")) end
  if math.type(value) == "float" then return ("%.17g"):format(value) end
  if type(value) ~= "table" or getmetatable(value) then return tostring(value) end
  local parts = {}
  for _, key in ipairs(suggest.keys(value)) do
    local name = type(key) == "string" and key or "[" .. tostring(key) .. "]"
    parts[#parts + 1] = name .. " = " .. shown(value[key])
  end
  return "{" .. table.concat(parts, ", ") .. "}"
end

local function same(a, b)
  if a == b then return true end
  if type(a) ~= "table" or type(b) ~= "table" then return false end
  for key, value in pairs(a) do
    if not same(value, b[key]) then return false end
  end
  for key in pairs(b) do
    if a[key] == nil then return false end
  end
  return true
end

--- What a case is given: checks that raise an error at the line that calls them. `what` is said with the failure.
local checks = {}
checks.__index = checks

local skipped = {}

local function fail(what, sentence) error((what and what .. ": " or "") .. sentence, 3) end

--- The condition holds (is neither nil nor false).
function checks:check(condition, what) --luacheck: ignore 212
  if not condition then fail(what, "expected to hold, found " .. tostring(condition)) end
end

--- Equal values; tables by their content.
function checks:equal(found, expected, what) --luacheck: ignore 212
  if not same(found, expected) then fail(what, ("expected %s, found %s"):format(shown(expected), shown(found))) end
end

--- Numbers that differ by `tolerance` at most. NaN is near nothing.
function checks:near(found, expected, tolerance, what) --luacheck: ignore 212
  if type(found) ~= "number" then fail(what, "expected a number, found " .. shown(found)) end
  local near = math.abs(found - expected) <= tolerance
  if not near then
    fail(what, ("expected %.17g within %g, found %.17g"):format(expected, tolerance, found))
  end
end

--- A text that contains another, letter by letter.
function checks:contains(text, part, what) --luacheck: ignore 212
  if not tostring(text):find(part, 1, true) then
    fail(what, ("expected a text with %s, found %s"):format(shown(part), shown(tostring(text))))
  end
end

--- A call of `f` that raises an error whose message contains `part`. Returns the message.
function checks:raises(part, f, ...) --luacheck: ignore 212
  local ok, e = pcall(f, ...)
  if ok then fail(nil, ("expected an error with %s, found none"):format(shown(part))) end
  if not tostring(e):find(part, 1, true) then
    fail(nil, ("expected an error with %s, found %s"):format(shown(part), shown(tostring(e))))
  end
  return tostring(e)
end

--- Ends the case, which counts as skipped; the summary says why.
function checks:skip(reason) --luacheck: ignore 212
  error(setmetatable({ reason = reason }, skipped), 0)
end

local suite = {}
suite.__index = suite
suite.__name = "aib.test"
suite.__tostring = function(self) return ("test(%d cases)"):format(#suggest.keys(self.cases)) end

--- Runs a case: "passed", "failed" with the message, or "skipped" with the reason.
local function outcome(case)
  local ok, e = xpcall(case, function(e)
    return getmetatable(e) == skipped and e or debug.traceback(tostring(e), 2)
  end, setmetatable({}, checks))
  if ok then return "passed" end
  if getmetatable(e) == skipped then return "skipped", e.reason end
  local at_check = e:find("^[^\n]*: expected ")
  return "failed", at_check and e:gsub("\nstack traceback:.*", "") or e
end

--- Runs the cases whose names contain `filter` (all without it), in the order of their names, and prints how they
--- went. Returns how many passed, failed and were skipped.
function suite:run(filter)
  local counts, dots, lines = { passed = 0, failed = 0, skipped = 0 }, 0, {}
  local signs = { passed = ".", failed = "F", skipped = "s" }
  for _, name in ipairs(suggest.keys(self.cases)) do
    if not filter or name:find(filter, 1, true) then
      local how, why = outcome(self.cases[name])
      counts[how] = counts[how] + 1
      dots = dots + 1
      io.stdout:write(signs[how], dots % line_width == 0 and "\n" or ""):flush()
      if how == "failed" then lines[#lines + 1] = ("\nFAILED  %s\n  %s"):format(name, why) end
      if how == "skipped" then lines[#lines + 1] = ("SKIPPED: %s: %s"):format(name, why) end
    end
  end
  io.stdout:write("\n", table.concat(lines, "\n"), #lines > 0 and "\n" or "")
  print(("%d passed, %d failed, %d skipped"):format(counts.passed, counts.failed, counts.skipped))
  return counts
end

--- Runs as a program: `aib-lua test_x.lua [FILTER]`. Returns the exit code: 1 where a case failed or none was run.
function suite:main(arguments)
  local counts = self:run(arguments[1])
  return counts.failed == 0 and counts.passed + counts.skipped > 0 and 0 or 1
end

--- A suite of cases: functions by the sentence that they check.
return function(cases)
  if type(cases) ~= "table" then error("aib.test: a table of cases expected, found " .. type(cases), 2) end
  for name, case in pairs(cases) do
    if type(name) ~= "string" or type(case) ~= "function" then
      error(("aib.test: functions by name expected, found %s = %s"):format(tostring(name), type(case)), 2)
    end
  end
  return setmetatable({ cases = cases }, suite)
end
