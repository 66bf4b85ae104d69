-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Long evaluations in parts: of each unit of work one part for what needs all of its images, and one for every 32
--- images, whose numbers are of each image alone. Finished parts are kept in a folder and reused while inputs, options
--- and version are unchanged; every sixteenth can be made by another machine; what they found is put together in their
--- order, so that one run, an interrupted one and merged shards give the same bytes.
---
---   local parts = aib.units.run {
---     report = report, files = files, units = units, results = input.results, shard = input.shard,
---     name = function(unit) return ... end,           -- for people
---     group = function(unit) return table end,        -- of its records
---     describe = function(unit) return table end,     -- what it depends on besides files, as JSON
---     n_images = function(unit) return number end,    -- that are evaluated one by one, 0 of none
---     evaluate = function(unit, part, range) ... return list of aib.files that it read end,
---   }
---   for _, unit in ipairs(aib.units.grouped(parts)) do
---     for _, part in ipairs(unit) do aib.units.absorb(report, files, part) end
---   end
---
--- `range` = { first =, last = } is that of the images, nil for what needs all of them. part.report takes records and
--- notes; part.frames.KEY = { names = {...}, values = {...} } keeps numbers of frames, part.rows a list of anything
--- that is JSON.
local aib = require "aib"
local failure = require "aib.failure"
local records_json = require "aib.report.records"
local suggest = require "aib.suggest"

local M = {}

local format_version <const> = 2
local images_of_part <const> = 32

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

--- All parts in the order of one run.
local function places_of(job)
  local list = {}
  for i, unit in ipairs(job.units) do
    local name, n = job.name(unit), job.n_images(unit)
    list[#list + 1] = { unit = unit, index = i, name = name }
    for first = 1, n, images_of_part do
      local range = { first = first, last = math.min(first + images_of_part - 1, n) }
      list[#list + 1] = { unit = unit, index = i, range = range,
        name = ("%s, images %d to %d"):format(name, range.first, range.last) }
    end
  end
  return list
end

--- What decides whether a kept part is that of this run.
local function key_of(job, place)
  return aib.system.sha256(aib.json.encode {
    format = format_version, version = aib.version, protocol = job.report.name, inputs = job.report.store.inputs,
    unit = job.describe(place.unit), name = place.name,
  })
end

local function path_of(job, place)
  local readable = place.name:gsub("[^%w]+", "_"):sub(1, 60)
  return ("%s/%s_%s"):format(job.results, readable, aib.system.sha256(place.name):sub(1, 8))
end

--- The files that a part read, with what tells whether they were touched.
local function list_files(of)
  local list, seen = aib.json.list(), {}
  for _, files in ipairs(of) do
    for _, label in ipairs(suggest.keys(files.used)) do
      for _, name in ipairs(suggest.keys(files.used[label])) do
        local id = label .. "\0" .. name
        if not seen[id] then
          seen[id] = true
          local print = files.used[label][name]
          list[#list + 1] = { label = label, name = name, files = print.files, bytes = print.bytes,
            sha256 = print.sha256, status = print.status }
        end
      end
    end
  end
  return list
end

--- Writes a text with its hash behind it.
local function write_sealed(path, text) aib.system.write_text(path, text .. aib.system.sha256(text) .. "\n") end

--- What `write_sealed` wrote, and its hash; nil where there is nothing, or it was changed.
local function read_sealed(path)
  if not aib.system.is_file(path) then return nil end
  local text, seal = aib.system.read_text(path):match "^(.*\n)(%x+)\n$"
  if text and aib.system.sha256(text) == seal then return aib.json.decode(text), seal end
end

--- Whether no file of a part was touched; `statuses` are those that were looked at in this run.
local function is_untouched(job, part, statuses)
  for _, file in ipairs(part.files) do
    local path = job.files:path(file.name)
    statuses[path] = statuses[path] or aib.files.status(path) or "none"
    if statuses[path] ~= file.status then return false end
  end
  return true
end

--- Whether a page shows something of a part; a range of images has numbers alone.
local function is_drawn(job, place) return job.report:draws() and not place.range end

--- The kept part of a place, nil where there is none, it is of another run, or a file of it was touched. Where a page
--- is to be drawn, with its views, which lie beside it.
local function kept(job, place, key, statuses)
  if not job.results then return nil end
  local path = path_of(job, place)
  local part, seal = read_sealed(path .. ".part")
  if not part or part.key ~= key or not is_untouched(job, part, statuses) then return nil end
  if is_drawn(job, place) then
    local page = read_sealed(path .. ".views")
    if not page or page.part ~= seal then return nil end
    part.views = page.views
  end
  return part
end

--- Evaluates a part. What it gives has gone through its text, as a kept one has: they are the same to the last bit.
local function made(job, place, key)
  local part = { frames = {}, rows = aib.json.list() }
  part.report = aib.report.new { name = job.report.name, version = job.report.version }
  if is_drawn(job, place) then part.report:draw() end
  local read = job.evaluate(place.unit, part, place.range)
  local text = aib.json.encode {
    format = format_version, key = key, name = place.name, group = job.group(place.unit), files = list_files(read),
    frames = part.frames, rows = part.rows, records = records_json.encode(part.report),
    notes = records_json.notes(part.report),
  } .. "\n"
  local views = part.report:draws() and aib.json.encode {
    part = aib.system.sha256(text), views = aib.json.list(part.report.store.views),
  } .. "\n"
  if job.results then
    local path = path_of(job, place)
    if views then write_sealed(path .. ".views", views) end
    write_sealed(path .. ".part", text)
  end
  local done = aib.json.decode(text)
  done.views = views and aib.json.decode(views).views
  return done
end

--- Adds what a part found to the report. Its files are remembered as sources.
function M.absorb(report, files, part)
  for _, record in ipairs(part.records) do report:insert(records_json.decode(record)) end
  for _, note in ipairs(part.notes) do report:note(note.key, note.text) end
  if part.views and report:draws() then
    table.move(part.views, 1, #part.views, #report.store.views + 1, report.store.views)
  end
  for _, file in ipairs(part.files) do
    local of_label = files.used[file.label] or {}
    files.used[file.label] = of_label
    of_label[file.name] = { files = file.files, bytes = file.bytes, sha256 = file.sha256 }
  end
end

--- What a shard hands over: parts without what a page shows.
local function shard_of(index, count, n_parts, parts)
  local without = aib.json.list()
  for i, part in ipairs(parts) do
    without[i] = {}
    for key, value in pairs(part) do without[i][key] = key ~= "views" and value or nil end
  end
  return { index = index, count = count, n_parts = n_parts, parts = without }
end

--- "16 of 18 parts are reused; made: crane / GLOMAP, ..."
local function told(made_names, n)
  if #made_names == 0 then return ("%d of %d parts are reused"):format(n, n) end
  local most = 8
  local names = table.concat(made_names, "; ", 1, math.min(most, #made_names))
  return ("%d of %d parts are reused; made: %s%s"):format(n - #made_names, n, names,
    #made_names > most and (" and %d more"):format(#made_names - most) or "")
end

--- Evaluates the parts of this shard, or reads them back. Returns them in their order, each { name =, unit = number of
--- its unit, place =, group =, records =, notes =, frames =, rows =, files =, views = }, and how many were reused.
function M.run(job)
  local index, count = M.shard_of(job.shard)
  if job.results then aib.system.make_folder(job.results) end
  local places, own = places_of(job), {}
  for i = index, #places, count do own[#own + 1] = i end
  local progress <close> = aib.progress(#own, "parts")
  local parts, statuses, made_names = {}, {}, {}
  for k, i in ipairs(own) do
    local place = places[i]
    progress:step(place.name)
    local key = key_of(job, place)
    local part = kept(job, place, key, statuses)
    if not part then
      made_names[#made_names + 1] = place.name
      part = made(job, place, key)
    end
    part.place, part.unit = i, place.index
    parts[k] = part
  end
  if job.results then progress:say(told(made_names, #own)) end
  if count > 1 then job.report.store.shard = shard_of(index, count, #places, parts) end
  return parts, #own - #made_names
end

--- The parts by unit: a list of lists.
function M.grouped(parts)
  local units = {}
  for i, part in ipairs(parts) do
    if i == 1 or part.unit ~= parts[i - 1].unit then units[#units + 1] = {} end
    table.insert(units[#units], part)
  end
  return units
end

--- The parts of several shards, each { result = decoded JSON, path = }, in the order of one run. Raises a format error
--- where they are not all shards of one.
function M.joined(shards)
  local parts, first = {}, shards[1].result
  for _, shard in ipairs(shards) do
    local function wrong(sentence) failure.raise("format", shard.path .. ": " .. sentence) end
    local own = shard.result.shard
    if not own then wrong "a shard expected, made by --shard INDEX/COUNT" end
    if own.count ~= first.shard.count or own.n_parts ~= first.shard.n_parts or
      aib.json.encode(shard.result.inputs) ~= aib.json.encode(first.inputs) or
      shard.result.aib.version ~= first.aib.version or shard.result.protocol.name ~= first.protocol.name then
      wrong(("a shard of the same run as %s expected"):format(shards[1].path))
    end
    for _, part in ipairs(own.parts) do
      if parts[part.place] then wrong(("part %d, %s, comes twice"):format(part.place, part.name)) end
      parts[part.place] = part
    end
  end
  for i = 1, first.shard.n_parts do
    if not parts[i] then
      failure.raise("format", ("shard %d/%d is missing"):format((i - 1) % first.shard.count + 1, first.shard.count))
    end
  end
  return parts
end

return M
