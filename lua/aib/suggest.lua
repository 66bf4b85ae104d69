-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Tables with known names: sorted keys, and errors for unknown ones that say what was meant.
local system = require("aib").system

local M = {}

--- The keys of a table, sorted as text.
function M.keys(t)
  local keys = {}
  for key in pairs(t) do keys[#keys + 1] = key end
  table.sort(keys, function(a, b) return tostring(a) < tostring(b) end)
  return keys
end

--- What to add to "unknown X 'name'": the nearest of the names (a list), or all of them.
function M.hint(name, names) return system.suggestion(tostring(name), names) end

--- ", did you mean 'X'?" where one of the names is near: what to add to a sentence that lists them.
function M.nearest(name, names) return M.hint(name, names):match("^, did you mean.*") or "" end

--- The sentence for the first key of `t` that `known` (a table by name) has not; nil where it has all.
function M.unknown_key(t, known)
  for _, key in ipairs(M.keys(t)) do
    if known[key] == nil then
      return ("unknown field '%s'%s"):format(tostring(key), M.hint(key, M.keys(known)))
    end
  end
end

--- An error at `level` (as `error` counts) where `t` has a key that `known` has not.
function M.check_keys(what, t, known, level)
  local mistake = M.unknown_key(t, known)
  if mistake then error(("%s: %s"):format(what, mistake), (level or 1) + 1) end
end

return M
