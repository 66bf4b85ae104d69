-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Errors with a kind, as the library raises them: "argument", "format", "io", "output", "undefined", "stopped",
--- "internal", or "script" for errors of Lua code.
local aib = require "aib"

local M = {}

--- Texts that were raised here, which begin with no script position, though they may look so (benchmark.lua:3: ...).
local plain = {}

--- Raises an error of the kind. Its text carries no script position: it is meant for the one who runs the script.
function M.raise(kind, text)
  aib.system.remember(kind, text)
  plain[text] = true
  error(text, 0)
end

--- The kind of an error value that was caught.
function M.kind(caught) return aib.error_kind(tostring(caught)) end

--- Whether an error value says that there was no memory left.
function M.is_memory(caught) return tostring(caught):find("not enough memory$") ~= nil end

local positions <const> = { "^([^\n:]+%.lua:%d+): (.*)", '^(%[string "[^"\n]*"%]:%d+): (.*)' }

--- The text of an error value without the script position in front of it, and that, nil where there is none.
function M.message(caught)
  local text = tostring(caught)
  for _, pattern in ipairs(plain[text] and {} or positions) do
    local position, message = text:match(pattern)
    if message then return message, position end
  end
  return text
end

local latest = {}

--- The trace of an error value from where it began, though it was caught and raised again since. To be called in the
--- message handlers of all who do that.
function M.trace(caught)
  if latest.value ~= caught then latest = { value = caught, trace = debug.traceback(tostring(caught), 3) } end
  return latest.trace
end

--- Raises an error of the command line, which ends a protocol with exit code 2.
function M.usage(text) error(setmetatable({ usage = text }, { __tostring = function() return text end }), 0) end

return M
