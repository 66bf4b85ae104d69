-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Reading back what reports wrote as JSON.
local aib = require "aib"
local failure = require "aib.failure"
local schema = require "aib.schema"
local seal_of = require "aib.report.seal"
local shell = require "aib.shell"
local suggest = require "aib.suggest"

local M = {}

local format_version <const> = 1
local rules <const> = aib.json.decode(shell.text "aib/results.schema.json", "results.schema.json")

local function text_of(value)
  if value == nil or value == aib.json.null then return "none" end
  if type(value) == "table" then return aib.json.encode(value) end
  return tostring(value)
end

--- A result file, each of its records with `place` = metric and group as one text. Raises a format error where the file
--- breaks results.schema.json.
function M.read(path)
  local result = aib.json.decode(aib.system.read_text(path), path)
  local function wrong(sentence) failure.raise("format", path .. ": " .. sentence) end
  if type(result) ~= "table" or type(result.aib) ~= "table" or type(result.records) ~= "table" then
    wrong("results of aib expected (an object with aib and records)")
  end
  if result.aib.format ~= format_version then
    wrong(("results of format %d expected, found %s"):format(format_version, text_of(result.aib.format)))
  end
  local mistake = schema.mistake(result, rules)
  if mistake then wrong(mistake) end
  if result.shard and result.shard.sha256 ~= seal_of(result) then
    wrong "the shard was changed since it was written"
  end
  for i, frames in ipairs(result.frames or {}) do
    if #frames.names ~= #frames.values then
      wrong(("frames[%d]: as many values as names expected, found %d and %d"):format(i, #frames.values, #frames.names))
    end
  end
  for _, record in ipairs(result.records) do
    if record.value == aib.json.null then record.value = nil end
    record.group = record.group or {}
    local parts = { record.name }
    for _, key in ipairs(suggest.keys(record.group)) do parts[#parts + 1] = key .. "=" .. record.group[key] end
    record.place = table.concat(parts, "\0")
  end
  return result
end

--- What two records of one place were computed by differently, as a sentence; nil where they can be compared.
function M.difference(a, b)
  if a.convention ~= b.convention then
    return ("%s: other conventions: %s and %s"):format(a.name, text_of(a.convention), text_of(b.convention))
  end
  local options_a, options_b = a.options or {}, b.options or {}
  for _, options in ipairs { options_a, options_b } do
    for _, name in ipairs(suggest.keys(options)) do
      local x, y = text_of(options_a[name]), text_of(options_b[name])
      if x ~= y then return ("%s: other options: %s = %s and %s"):format(a.name, name, x, y) end
    end
  end
  if a.unit ~= b.unit then return ("%s: other units: %s and %s"):format(a.name, text_of(a.unit), text_of(b.unit)) end
end

return M
