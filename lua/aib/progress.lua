-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Progress of long work on stderr: one line that is redrawn on a terminal, a plain line now and then otherwise.
---
---   local progress <close> = aib.progress(#units, "units")
---   for _, unit in ipairs(units) do
---     progress:step(unit.name)   -- what begins now
---     ...
---   end
local system = require("aib").system

local seconds_between_lines <const> = 10

local progress = {}
progress.__index = progress

--- "1 h 5 min", "12 s"
local function duration(seconds)
  if seconds >= 3600 then return ("%d h %d min"):format(seconds // 3600, seconds % 3600 // 60) end
  if seconds >= 60 then return ("%d min %d s"):format(seconds // 60, seconds % 60) end
  return ("%d s"):format(seconds)
end

--- The line that says where the work is; the rest of the time is guessed from what is done.
local function line_of(self, now)
  local done = self.begun - 1
  local parts = { ("%d/%d %s"):format(self.begun, self.total, self.noun) }
  if self.what then parts[#parts + 1] = self.what end
  local spent = now - self.started
  if done > 0 and spent >= 2 then
    parts[#parts + 1] = "about " .. duration(math.ceil(spent * (self.total - done) / done)) .. " left"
  end
  return table.concat(parts, "  ")
end

--- Says that the next of the steps begins.
function progress:step(what)
  self.begun, self.what = self.begun + 1, what
  if self.silent then return end
  local now = self.clock()
  if self.redraws then
    self.write("\r\27[K" .. line_of(self, now))
  elseif now - self.written >= seconds_between_lines then
    self.written = now
    self.write(line_of(self, now) .. "\n")
  end
end

--- Ends it; the terminal's line is cleared.
function progress:close()
  if self.redraws and not self.silent and self.begun > 0 then self.write("\r\27[K") end
  self.silent = true
end
progress.__close = progress.close

--- Says a sentence that stays.
function progress:say(text)
  if self.silent then return end
  self.write((self.redraws and "\r\27[K" or "") .. text .. "\n")
end

local M = {
  --- Whether nothing is to be shown (--quiet).
  quiet = false,
}

--- Shows nothing from now on, neither this nor how far a long call of the library is.
function M.silence()
  M.quiet = true
  system.silence()
end

--- Progress over `total` steps, called `noun`. `sink` replaces stderr and the clock, for tests:
--- { write = function, clock = function, redraws = boolean }
function M.new(total, noun, sink)
  sink = sink or {
    write = function(text) io.stderr:write(text) end, clock = os.time, redraws = system.is_terminal("stderr"),
  }
  local now = sink.clock()
  return setmetatable({
    total = total, noun = noun or "steps", begun = 0, started = now, written = now, write = sink.write,
    clock = sink.clock, redraws = sink.redraws, silent = M.quiet,
  }, progress)
end

return setmetatable(M, { __call = function(_, ...) return M.new(...) end })
