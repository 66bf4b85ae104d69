-- Lua code is tested by the tool itself: a script that returns an aib.test runs its cases.
local aib = require "aib"

local function grade(error)
  return error < 0.01 and "good" or "poor"
end

return aib.test {
  ["a small error is good"] = function(t)
    t:equal(grade(0.001), "good")
  end,
  ["a large one is not"] = function(t)
    t:equal(grade(0.1), "poor")
  end,
}
