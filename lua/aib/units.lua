-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Long evaluations in units of work: finished ones are kept in a folder and reused while inputs, options and version
--- are unchanged; every sixteenth can be made by another machine; what they found is put together in their order, so
--- that one run, an interrupted one and merged shards give the same bytes.
---
---   local parts = aib.units.run {
---     report = report, files = files, units = units, results = input.results, shard = input.shard,
---     name = function(unit) return ... end,           -- for people
---     group = function(unit) return table end,        -- of its records
---     describe = function(unit) return table end,     -- what it depends on besides files, as JSON
---     evaluate = function(unit, part) ... return list of aib.files that it read end,
---   }
---
--- part.report takes records and notes; part.frames.KEY = { names = {...}, values = {...} } keeps numbers of frames.
local aib = require "aib"
local failure = require "aib.failure"
local records_json = require "aib.report.records"
local suggest = require "aib.suggest"

local M = {}

local format_version <const> = 1

--- The place of a shard: "3/16" -> 3, 16; 1, 1 without. Raises an error of usage.
function M.shard_of(text)
  if not text or text == "" then return 1, 1 end
  local index, count = text:match "^(%d+)/(%d+)$"
  index, count = tonumber(index), tonumber(count)
  if not index or index < 1 or index > count then
    failure.usage(("--shard: INDEX/COUNT expected, as 3/16, found '%s'"):format(text))
  end
  return index, count
end

--- What decides whether a kept unit is that of this run.
local function key_of(job, unit)
  return aib.system.sha256(aib.json.encode {
    format = format_version, version = aib.version, protocol = job.report.name, inputs = job.report.store.inputs,
    unit = job.describe(unit), name = job.name(unit),
  })
end

local function path_of(job, unit)
  local name = job.name(unit)
  local readable = name:gsub("[^%w]+", "_"):sub(1, 60)
  return ("%s/%s_%s.json"):format(job.results, readable, aib.system.sha256(name):sub(1, 8))
end

--- The files that a unit read, with what tells whether they were touched.
local function list_files(of)
  local list, seen = aib.json.list(), {}
  for _, files in ipairs(of) do
    for _, label in ipairs(suggest.keys(files.used)) do
      for _, name in ipairs(suggest.keys(files.used[label])) do
        local id = label .. "\0" .. name
        if not seen[id] then
          seen[id] = true
          local print = files.used[label][name]
          list[#list + 1] = {
            label = label, name = name, bytes = print.bytes, sha256 = print.sha256,
            status = aib.system.status(files:path(name)),
          }
        end
      end
    end
  end
  return list
end

local function is_untouched(job, file)
  local path = job.files:path(file.name)
  return aib.system.is_file(path) and aib.system.status(path) == file.status
end

--- The kept part of a unit, nil where there is none, it is of another run, or a file of it was touched; or where a page
--- is to be drawn, whose geometry and pictures are not kept.
local function kept(job, unit, key)
  if not job.results or job.report:draws() then return nil end
  local path = path_of(job, unit)
  if not aib.system.is_file(path) then return nil end
  local ok, part = pcall(function() return aib.json.decode(aib.system.read_text(path), path) end)
  if not ok or type(part) ~= "table" or part.key ~= key then return nil end
  for _, file in ipairs(part.files) do
    if not is_untouched(job, file) then return nil end
  end
  return part
end

local function new_part(job, unit, key)
  local part = {
    frames = {}, report = aib.report.new { name = job.report.name, version = job.report.version },
  }
  part.report.store.views = job.report.store.views
  local read = job.evaluate(unit, part)
  return {
    format = format_version, key = key, name = job.name(unit), group = job.group(unit), files = list_files(read),
    frames = part.frames,
    records = records_json.encode(part.report), notes = records_json.notes(part.report),
  }
end

--- Adds what a unit found to the report. Its files are remembered as sources.
function M.absorb(report, files, part)
  for _, record in ipairs(part.records) do report:insert(records_json.decode(record)) end
  for _, note in ipairs(part.notes) do report:note(note.key, note.text) end
  for _, file in ipairs(part.files) do
    local of_label = files.used[file.label] or {}
    files.used[file.label] = of_label
    of_label[file.name] = { bytes = file.bytes, sha256 = file.sha256 }
  end
end

--- Evaluates the units of this shard, or reads them back, and adds them to the report in their order. Returns the
--- parts, each { name =, group =, records =, notes =, frames =, files = }, and how many were reused.
function M.run(job)
  local index, count = M.shard_of(job.shard)
  if job.results then aib.system.make_folder(job.results) end
  local places = {}
  for i = index, #job.units, count do places[#places + 1] = i end
  local progress <close> = aib.progress(#places, "units")
  local parts, reused = {}, 0
  for k, i in ipairs(places) do
    local unit = job.units[i]
    progress:step(job.name(unit))
    local key = key_of(job, unit)
    local part = kept(job, unit, key)
    if part then reused = reused + 1 end
    if not part then
      part = new_part(job, unit, key)
      local text = aib.json.encode(part)
      if job.results then aib.system.write_text(path_of(job, unit), text .. "\n") end
      part = aib.json.decode(text)  -- a fresh part is what a kept one is, to the last bit
    end
    part.place = i
    parts[k] = part
    M.absorb(job.report, job.files, part)
  end
  if count > 1 then
    job.report.store.shard = { index = index, count = count, n_units = #job.units, parts = parts }
  end
  return parts, reused
end

--- The parts of several shards, each { result = decoded JSON, path = }, in the order of one run. Raises a format error
--- where they are not all shards of one.
function M.joined(shards)
  local parts, first = {}, shards[1].result
  for _, shard in ipairs(shards) do
    local function wrong(sentence) failure.raise("format", shard.path .. ": " .. sentence) end
    local own = shard.result.shard
    if type(own) ~= "table" then wrong "a shard expected, made by --shard INDEX/COUNT" end
    if own.count ~= first.shard.count or own.n_units ~= first.shard.n_units or
      aib.json.encode(shard.result.inputs) ~= aib.json.encode(first.inputs) or
      shard.result.aib.version ~= first.aib.version or shard.result.protocol.name ~= first.protocol.name then
      wrong(("a shard of the same run as %s expected"):format(shards[1].path))
    end
    for _, part in ipairs(own.parts) do
      if parts[part.place] then wrong(("unit %d, %s, comes twice"):format(part.place, part.name)) end
      parts[part.place] = part
    end
  end
  for i = 1, first.shard.n_units do
    if not parts[i] then
      failure.raise("format", ("shard %d/%d is missing"):format((i - 1) % first.shard.count + 1, first.shard.count))
    end
  end
  return parts
end

return M
