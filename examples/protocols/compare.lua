-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Holds results against each other: what differs, by how much, whether by chance, who is better, what cannot be
--- compared, and what is impossible. Results with --per-frame are compared frame by frame.
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

--- Impossible numbers within each file, and how many of its groups have some.
local function check_files(report, results, labels)
  for i, result in ipairs(results) do
    local one = aib.report.new { name = labels[i], version = aib.version }
    for _, record in ipairs(result.records) do one:within(record.group):add(record.name, record.value) end
    local _, groups = aib.consistency.check_report(one, result.rounding)
    for _, sentence in ipairs(one:note_lines()) do report:note(labels[i], sentence) end
    if groups > 0 then report:note(labels[i], ("%d groups have impossible numbers"):format(groups)) end
  end
end

local function place_of(metric, group) return metric .. "\0" .. aib.json.encode(group) end

--- Numbers of frames by metric and group.
local function frames_of(result)
  local found = {}
  for _, frames in ipairs(result.frames or {}) do
    found[place_of(frames.metric, frames.group)] = frames
  end
  return found
end

--- Differences of the frames that both have, in the order of the first; none where all are equal.
local function paired_differences(a, b)
  local of_b, differences, any = {}, {}, false
  for i, name in ipairs(b.names) do of_b[name] = b.values[i] end
  for i, name in ipairs(a.names) do
    if of_b[name] then
      differences[#differences + 1] = of_b[name] - a.values[i]
      any = any or of_b[name] ~= a.values[i]
    end
  end
  return any and differences or {}
end

local significance <const> = { "difference", "low", "high" }

--- Whether the frames of each file differ from those of the first by more than chance. Returns the metrics.
local function add_significance(report, results, labels, refused, input)
  local metrics, seen = {}, {}
  for i = 2, #results do
    local others = frames_of(results[i])
    for _, frames in ipairs(results[1].frames or {}) do
      local place = place_of(frames.metric, frames.group)
      local differences = others[place] and not refused[place] and paired_differences(frames, others[place]) or {}
      if #differences > 0 then
        local d = aib.sensitivity.interval(differences, { block = input.block, seed = input.seed })
        local cell = report:within(frames.group):within { file = labels[i] }
        local values = { difference = d.mean, low = d.low, high = d.high }
        for _, what in ipairs(significance) do
          cell:add(("%s, %s"):format(frames.metric, what), values[what], {
            n = #differences, convention = "paired frames, block bootstrap, 95 %",
          })
        end
        if d.low <= 0 and d.high >= 0 then
          cell:note(("%s: no more than chance tells it from %s"):format(frames.metric, labels[1]))
        end
        if not seen[frames.metric] then metrics[#metrics + 1], seen[frames.metric] = frames.metric, true end
      end
    end
  end
  return metrics
end

--- The frames of all files along the flight.
local function draw_frames(report, results, labels, refused)
  for i, result in ipairs(results) do
    for _, frames in ipairs(result.frames or {}) do
      if not refused[place_of(frames.metric, frames.group)] then
        report:within(frames.group):within({ file = labels[i] }):timeline { title = frames.metric,
          y = { label = frames.metric }, frames = frames.names, values = frames.values }
      end
    end
  end
end

local function significance_tables(report, metrics)
  for _, metric in ipairs(metrics) do
    local columns = {}
    for i, what in ipairs(significance) do columns[i] = { ("%s, %s"):format(metric, what), label = what } end
    report:table {
      title = ("Differences of frames from the first file, %s"):format(metric), metrics = columns,
      down = { "scene", "condition", "method", "file" }, across = { "metric" },
      notes = { "Interval of 95 %; neighbouring frames are drawn together." },
    }
  end
end

--- Ranks of values, the best first; equal ones share the mean of their places.
local function ranks_of(list, better)
  table.sort(list, function(a, b)
    if a.value ~= b.value then return (a.value < b.value) == (better == "lower") end
    return a.method < b.method
  end)
  local i = 1
  while i <= #list do
    local last = i
    while list[last + 1] and list[last + 1].value == list[i].value do last = last + 1 end
    for k = i, last do list[k].rank = (i + last) / 2 end
    i = last + 1
  end
  return list
end

--- Numbers of methods that compete: by metric and place, of methods alone (no sub-models, no batches).
local function contests_of(result)
  local contests, order = {}, {}
  for _, record in ipairs(result.records) do
    local g = record.group
    if record.better and record.value and g.method and not (g.model or g.batch) then
      local id = table.concat({ record.name, g.scene or "", g.condition or "" }, "\0")
      if not contests[id] then
        contests[id] = { name = record.name, better = record.better }
        order[#order + 1] = contests[id]
      end
      table.insert(contests[id], { method = g.method, value = record.value })
    end
  end
  return order
end

--- Mean rank of each method over scenes and conditions, for every metric in which two or more compete.
local function add_ranks(report, result, label)
  local sums, order = {}, {}
  for _, contest in ipairs(contests_of(result)) do
    for _, entry in ipairs(#contest > 1 and ranks_of(contest, contest.better) or {}) do
      local id = contest.name .. "\0" .. entry.method
      if not sums[id] then
        sums[id] = { name = contest.name, method = entry.method, sum = 0, n = 0 }
        order[#order + 1] = sums[id]
      end
      sums[id].sum, sums[id].n = sums[id].sum + entry.rank, sums[id].n + 1
    end
  end
  for _, s in ipairs(order) do
    report:add("rank of " .. s.name, s.sum / s.n, {
      better = "lower", n = s.n, group = { method = s.method, file = label },
    })
  end
end

local ranked <const> = {
  "depth.srmse", "pose.auc30", "pose.registration_rate", "camera.focal_mre", "cloud.chamfer", "cloud.f1_distance",
}

local function rank_table(report)
  local metrics = {}
  for i, name in ipairs(ranked) do metrics[i] = { "rank of " .. name, label = name } end
  report:table { title = "Mean rank of methods", metrics = metrics, down = { "method" }, across = { "metric", "file" } }
end

return aib.protocol {
  name = "compare",
  title = "Results compared",
  help = "Compares results that protocols wrote with --json. Numbers of other conventions or options are refused.",
  inputs = {
    results = { kind = "list", of = "file", position = 1, help = "result files, the first is the one to compare with" },
    all = { kind = "flag", help = "show equal numbers too" },
    ranks = { kind = "flag", help = "rank the methods of each file" },
    block = { kind = "integer", default = 10, min = 1, help = "neighbouring frames that are drawn together" },
    seed = { kind = "integer", default = 1, min = 0, help = "of the drawing" },
  },
  run = function(input, report)
    local results, labels = {}, labels_of(input.results)
    for i, path in ipairs(input.results) do results[i] = aib.results.read(path) end
    local places, records = by_place(results)
    local compared, equal, metrics, seen, refused = 0, 0, {}, {}, {}
    for _, place in ipairs(places) do
      local here = records[place]
      local reason = obstacle(here, #results)
      if reason then
        report:note(reason)
        for _, record in pairs(here) do refused[place_of(record.name, record.group)] = true end
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
        down = { "scene", "condition", "contrast", "method", "model", "batch", "metric" }, across = { "file" },
      }
    end
    report:note(("%d of %d numbers are equal"):format(equal, compared))
    significance_tables(report, add_significance(report, results, labels, refused, input))
    draw_frames(report, results, labels, refused)
    if input.ranks then
      for i, result in ipairs(results) do add_ranks(report, result, labels[i]) end
      rank_table(report)
    end
    note_sources(report, results, labels)
    check_files(report, results, labels)
  end,
}
