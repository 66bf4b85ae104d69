-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Tests of Lua code. A script returns its suite and aib-lua runs it: dots, then what failed and where.
---
---   local aib = require "aib"
---   local test = aib.test "stats"
---
---   test("the mean of 1, 2, 3 is 2", function(t)
---     t.near(aib.stats.summary({ 1, 2, 3 }).mean, 2, 1e-15)
---   end)
---
---   return test
local suggest = require "aib.suggest"

local suite = {}
suite.__index = suite
suite.__name = "aib.test"
suite.__tostring = function(self) return ("test(%s, %d cases)"):format(self.name, #self.cases) end

local line_width <const> = 72

--- Text of a value that tells 1 from "1".
local function shown(value)
  if type(value) == "string" then return ("%q"):format(value):gsub("\\\n", "\\n") end
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

--- Checks. Each raises at the line that calls it; `what` is said with the failure.
local t = {}

local function fail(what, sentence) error((what and what .. ": " or "") .. sentence, 3) end

--- The condition holds (is neither nil nor false).
function t.ok(condition, what)
  if not condition then fail(what, "expected to hold, found " .. tostring(condition)) end
end

--- Equal values; tables by their content.
function t.equal(found, expected, what)
  if not same(found, expected) then fail(what, ("expected %s, found %s"):format(shown(expected), shown(found))) end
end

--- Numbers that differ by `tolerance` at most. NaN is near nothing.
function t.near(found, expected, tolerance, what)
  if type(found) ~= "number" then fail(what, "expected a number, found " .. shown(found)) end
  if not (math.abs(found - expected) <= tolerance) then
    fail(what, ("expected %.17g within %g, found %.17g"):format(expected, tolerance, found))
  end
end

--- A text that contains another, letter by letter.
function t.contains(text, part, what)
  if not tostring(text):find(part, 1, true) then
    fail(what, ("expected a text with %s, found %s"):format(shown(part), shown(tostring(text))))
  end
end

--- A call that raises an error whose message contains `part`. Returns the message.
function t.raises(part, f, ...)
  local ok, e = pcall(f, ...)
  if ok then fail(nil, ("expected an error with %s, found none"):format(shown(part))) end
  if not tostring(e):find(part, 1, true) then
    fail(nil, ("expected an error with %s, found %s"):format(shown(part), shown(tostring(e))))
  end
  return tostring(e)
end

--- Ends the case; the summary lists it with the reason.
function t.skip(reason) error(setmetatable({ reason = reason }, t), 0) end

--- Adds a case: a sentence that says what holds, and the function that checks it.
function suite:__call(name, body)
  if self.names[name] then error(("aib.test: two cases are called '%s'"):format(name), 2) end
  self.names[name] = true
  self.cases[#self.cases + 1] = { name = name, body = body }
end

local function trace(e) return getmetatable(e) == t and e or debug.traceback(tostring(e), 2) end

--- The lines of a trace that concern the script.
local function shortened(text)
  return (text:gsub("\nstack traceback:\n.*", ""))
end

--- Runs the cases whose names contain `filter` (all without it) and prints how they went. Returns the number that
--- failed.
function suite:run(filter)
  local counts, failures, skips = { run = 0 }, {}, {}
  for _, case in ipairs(self.cases) do
    if not filter or case.name:find(filter, 1, true) then
      local ok, e = xpcall(case.body, trace, t)
      counts.run = counts.run + 1
      local skipped = not ok and getmetatable(e) == t
      if skipped then skips[#skips + 1] = ("SKIPPED: %s: %s"):format(case.name, e.reason) end
      if not ok and not skipped then failures[#failures + 1] = { case.name, shortened(e) } end
      io.stdout:write(ok and "." or skipped and "s" or "F", counts.run % line_width == 0 and "\n" or "")
    end
  end
  print()
  for _, failure in ipairs(failures) do print(("\nFAILED  %s\n  %s"):format(failure[1], failure[2])) end
  for _, skip in ipairs(skips) do print(skip) end
  print(("%s: %d passed, %d failed, %d skipped"):format(self.name, counts.run - #failures - #skips, #failures, #skips))
  return #failures
end

--- Runs as a program: `aib-lua test_x.lua [FILTER]`. Returns the exit code.
function suite:main(arguments) return self:run(arguments[1]) == 0 and 0 or 1 end

--- A new suite.
return function(name) return setmetatable({ name = name, cases = {}, names = {} }, suite) end
