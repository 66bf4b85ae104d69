-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Tables with known names: sorted keys, both of two in one, and errors for unknown ones that say what was meant.
local system = require("aib").system

local M = {}

--- The keys of a table, sorted as text.
function M.keys(t)
  local keys = {}
  for key in pairs(t) do keys[#keys + 1] = key end
  table.sort(keys, function(a, b) return tostring(a) < tostring(b) end)
  return keys
end

--- Both tables in one, the second over the first; either may be nil.
function M.with(a, b)
  local merged = {}
  for key, value in pairs(a or {}) do merged[key] = value end
  for key, value in pairs(b or {}) do merged[key] = value end
  return merged
end

--- The elements of a list as keys.
function M.set(list)
  local set = {}
  for _, element in ipairs(list) do set[element] = true end
  return set
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

--- The sentence for the first field of `t` that is not of its type in `types` (a table by name, "any" for all); nil
--- where all are.
function M.wrong_type(t, types)
  for _, key in ipairs(M.keys(types)) do
    local found = type(t[key])
    if found ~= "nil" and types[key] ~= "any" and found ~= types[key] then
      return ("%s: a %s expected, found %s"):format(key, types[key], found)
    end
  end
end

--- An error at `level` where a field of `t` is not known or of another type.
function M.check_types(what, t, types, level)
  local mistake = M.unknown_key(t, types) or M.wrong_type(t, types)
  if mistake then error(("%s: %s"):format(what, mistake), (level or 1) + 1) end
end

--- An error at `level` (as `error` counts) where `t` has a key that `known` has not.
function M.check_keys(what, t, known, level)
  local mistake = M.unknown_key(t, known)
  if mistake then error(("%s: %s"):format(what, mistake), (level or 1) + 1) end
end

return M
