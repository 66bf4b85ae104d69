-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

local aib = require "aib"

--- Progress that writes to a list, at a time that the test sets.
local function recorded(total, redraws)
  local written, now = {}, { seconds = 100 }
  local quiet = aib.progress.quiet
  aib.progress.quiet = false
  local progress = aib.progress.new(total, "units", {
    write = function(text) written[#written + 1] = text end, clock = function() return now.seconds end,
    redraws = redraws,
  })
  aib.progress.quiet = quiet
  return progress, written, now
end

return aib.test {
  ["a terminal's line is redrawn, with the time that is left, and cleared at the end"] = function(t)
    local progress, written, now = recorded(4, true)
    progress:step("a")
    now.seconds = 110
    progress:step("b")
    now.seconds = 300
    progress:step("c")
    progress:close()
    progress:close()
    t:equal(written, {
      "\r\27[K1/4 units  a", "\r\27[K2/4 units  b  about 30 s left", "\r\27[K3/4 units  c  about 3 min 20 s left",
      "\r\27[K",
    })
  end,

  ["elsewhere a line comes now and then"] = function(t)
    local progress, written, now = recorded(1000, false)
    for i = 1, 40 do
      now.seconds = 100 + i
      progress:step("unit " .. i)
    end
    progress:close()
    t:equal(written, {
      "10/1000 units  unit 10  about 18 min 22 s left\n", "20/1000 units  unit 20  about 17 min 13 s left\n",
      "30/1000 units  unit 30  about 16 min 45 s left\n", "40/1000 units  unit 40  about 16 min 26 s left\n",
    })
  end,

  ["silence is for what follows, and for the library"] = function(t)
    local before = aib.progress.quiet
    aib.progress.silence()
    t:equal(aib.progress.quiet, true)
    aib.progress.quiet = before
  end,

  ["quiet is silent"] = function(t)
    local before = aib.progress.quiet
    aib.progress.quiet = true
    local written = {}
    local progress = aib.progress.new(2, "units", {
      write = function(text) written[#written + 1] = text end, clock = os.time, redraws = true,
    })
    aib.progress.quiet = before
    progress:step("a")
    progress:close()
    t:equal(written, {})
  end,
}
