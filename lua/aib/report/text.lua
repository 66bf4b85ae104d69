-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Text measured and broken as a terminal shows it.
local M = {}

--- Columns that a text takes.
function M.width(text) return utf8.len(text) or #text end

function M.left(text, n) return text .. (" "):rep(n - M.width(text)) end
function M.right(text, n) return (" "):rep(n - M.width(text)) .. text end

--- Columns of the widest of `texts`.
function M.widest(texts)
  local most = 0
  for _, text in ipairs(texts) do most = math.max(most, M.width(text)) end
  return most
end

--- The lines of a text, broken between words where they would be longer than `columns`; `indent` begins all but the
--- first.
function M.wrapped(text, columns, indent)
  local lines, line = {}, nil
  for word in text:gmatch("%S+") do
    if line and M.width(line) + 1 + M.width(word) > columns then
      lines[#lines + 1] = line
      line = (indent or "") .. word
    else
      line = line and line .. " " .. word or word
    end
  end
  lines[#lines + 1] = line
  return lines
end

return M
