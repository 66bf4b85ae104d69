-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Holds results against each other: what differs, by how much, and what cannot be compared.
---
---   aib-lua compare before.json after.json
local aib = require "aib"

--- What the files are called in the tables: their names, with as much of the folder as tells them apart.
local function labels_of(paths)
  local labels, seen = {}, {}
  for i, path in ipairs(paths) do
    local label = path:match("([^/]*)%.json$") or path:match("[^/]*$")
    if seen[label] then label = path end
    labels[i], seen[label] = label, true
  end
  return labels
end

--- Places of records in the order of their first appearance, and the records there by file number.
local function by_place(results)
  local places, records = {}, {}
  for i, result in ipairs(results) do
    for _, record in ipairs(result.records) do
      if not records[record.place] then
        places[#places + 1] = record.place
        records[record.place] = {}
      end
      records[record.place][i] = record
    end
  end
  return places, records
end

--- Why the records of a place cannot be compared; nil where they can.
local function obstacle(records, n_files)
  local first
  for i = 1, n_files do
    first = first or records[i]
    local difference = records[i] and aib.results.difference(first, records[i])
    if difference then return difference end
  end
end

local function are_equal(records, n_files)
  for i = 1, n_files do
    if not records[i] or not records[1] or records[i].value ~= records[1].value then return false end
  end
  return true
end

local function add_place(report, records, labels)
  local any
  for i = 1, #labels do any = any or records[i] end
  for i, label in ipairs(labels) do
    local record = records[i] or {}
    report:within(any.group):add(any.name, record.value, {
      unit = any.unit, better = any.better, n = record.n, convention = any.convention, group = { file = label },
    })
  end
  local a, b = records[1] and records[1].value, records[2] and records[2].value
  if #labels == 2 then
    report:within(any.group):add(any.name, a and b and b - a, { unit = any.unit, group = { file = "difference" } })
  end
end

--- Sources of the same name and other content, named up to a few.
local function note_sources(report, results, labels)
  local first = results[1].sources or {}
  for i = 2, #results do
    local changed = {}
    for name, print in pairs(results[i].sources or {}) do
      if first[name] and first[name].sha256 ~= print.sha256 then changed[#changed + 1] = name end
    end
    table.sort(changed)
    if #changed > 0 then
      report:note(("%s and %s: other content of %s%s"):format(labels[1], labels[i], table.concat(changed, ", ", 1,
        math.min(3, #changed)), #changed > 3 and (" and %d more"):format(#changed - 3) or ""))
    end
  end
end

--- Impossible numbers within each file.
local function check_files(report, results, labels)
  for i, result in ipairs(results) do
    local one = aib.report.new { name = labels[i], version = aib.version }
    for _, record in ipairs(result.records) do one:within(record.group):add(record.name, record.value) end
    aib.consistency.check_report(one)
    for _, sentence in ipairs(one:note_lines()) do report:note(labels[i], sentence) end
  end
end

return aib.protocol {
  name = "compare",
  title = "Results compared",
  help = "Compares results that protocols wrote with --json. Numbers of other conventions or options are refused.",
  inputs = {
    results = { kind = "list", of = "file", position = 1, help = "result files, the first is the one to compare with" },
    all = { kind = "flag", help = "show equal numbers too" },
  },
  run = function(input, report)
    local results, labels = {}, labels_of(input.results)
    for i, path in ipairs(input.results) do results[i] = aib.results.read(path) end
    local places, records = by_place(results)
    local compared, equal, metrics, seen = 0, 0, {}, {}
    for _, place in ipairs(places) do
      local here = records[place]
      local reason = obstacle(here, #results)
      if reason then
        report:note(reason)
      else
        compared = compared + 1
        local same = are_equal(here, #results)
        if same then equal = equal + 1 end
        if not same or input.all then
          add_place(report, here, labels)
          local name = place:match("^[^%z]*")
          if not seen[name] then metrics[#metrics + 1], seen[name] = name, true end
        end
      end
    end
    if #metrics > 0 then
      report:table {
        title = input.all and "Numbers" or "Numbers that differ", metrics = metrics,
        down = { "scene", "condition", "method", "model", "metric" }, across = { "file" },
      }
    end
    report:note(("%d of %d numbers are equal"):format(equal, compared))
    note_sources(report, results, labels)
    check_files(report, results, labels)
  end,
}
