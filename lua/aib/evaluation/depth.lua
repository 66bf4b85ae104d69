-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Depth maps of a method, for the protocol asset_inspection: rows of single images, which any machine can make, and
--- the numbers that follow from all of them.
---
--- A source says where maps are and how they are scaled: { n_expected =, pattern = of files | nil, series =, maps = }.
--- Each series is scored with scales of its own: { method = name where it is not the unit's, how = options of what is
--- of a length }. Each map is { name =, place = number of its image, read = function(files),
--- confidence = function()|nil, scales = { by series; false where it is not known } }.
local aib = require "aib"
local drawings = require "aib.evaluation.drawings"
local suggest = require "aib.suggest"

local M = {}

--- What is told of the frames; what is of a length needs the scale of the alignment.
local metrics <const> = {
  { name = "srmse", better = "lower" }, { name = "si_log_rmse", better = "lower" },
  { name = "coverage", better = "higher" }, { name = "abs_rel", better = "lower", of_length = true },
  { name = "delta1", better = "higher", of_length = true }, { name = "delta2", better = "higher", of_length = true },
  { name = "delta3", better = "higher", of_length = true },
}

local gsd_taus <const> = { 1, 2, 5 }
local strata <const> = { "inside", "edge", "thin" }

--- Places of the scene's images that have a true depth map.
local function places_of(truth)
  local has_truth, places = suggest.set(truth.depth_names), {}
  for i, name in ipairs(truth.names) do places[name] = has_truth[name] and i or nil end
  return places
end

--- The source of files that a pattern names, all of one scale; nil where that is not known.
function M.of_files(pattern, truth, files, scale, how)
  local places, maps = places_of(truth), {}
  for _, name in ipairs(files:present(pattern, truth.depth_names)) do
    maps[#maps + 1] = { name = name, place = places[name], scales = { scale or false },
      read = function(own_files) return aib.io.read_depth(own_files:frame(pattern, name)) end }
  end
  return { maps = maps, series = { { how = how } }, pattern = pattern, n_expected = #truth.depth_names }
end

--- The source of the depth maps of batches (aib.batches.align), each at the scale of its alignment.
function M.of_batches(fit, truth, how)
  local places, maps = places_of(truth), {}
  for _, part in ipairs(fit.parts) do
    local scale = part.alignment and part.alignment.transform.scale or false
    for i, name in ipairs(part.batch.names) do
      if places[name] then
        maps[#maps + 1] = { name = name, place = places[name], scales = { scale },
          read = function() return part.batch.depth(i) end,
          confidence = part.batch.confidence and function() return part.batch.confidence(i) end or nil }
      end
    end
  end
  return { maps = maps, series = { { how = how } }, n_expected = #truth.depth_names }
end

--- Scores the maps of a source in batches as well: a series with the scales of `fit`.
function M.add_series(source, method, fit, how)
  local scales, k = {}, #source.series + 1
  for _, part in ipairs(fit.parts) do
    for _, name in ipairs(part.batch.names) do
      scales[name] = part.alignment and part.alignment.transform.scale or false
    end
  end
  source.series[k] = { method = method, how = how }
  for _, map in ipairs(source.maps) do map.scales[k] = scales[map.name] or false end
end

local function numbers_of(frame)
  local numbers = { n_reference = frame.n_reference }
  for _, metric in ipairs(metrics) do numbers[metric.name] = frame[metric.name] end
  return numbers
end

--- Shares of the truth's pixels within some ground sampling distances; nil where they are undefined.
local function shares_of_gsd(est, ref, camera, scale)
  local ok, surface = pcall(aib.depth.surface_errors, est, ref, camera, {
    tau = gsd_taus, transform = { scale = scale, shift = 0 },
  })
  if not ok and aib.error_kind(surface) ~= "undefined" then error(surface, 0) end
  if not ok then return nil end
  local shares = aib.json.list()
  for i, tau in ipairs(gsd_taus) do shares[i] = surface.within_total[tau] end
  return shares
end

--- The numbers of an image: those of all its pixels, by stratum where `labels` tell it, and by ground sampling
--- distances where there is a camera.
local function row_of(name, est, ref, scale, labels, camera)
  local errors = aib.depth.accumulate { transform = { scale = scale or 1 } }
  errors:add(est, ref, { name = name, labels = labels })
  local row = numbers_of(errors:frames()[1])
  row.name, row.is_scaled = name, scale ~= false
  if not labels then return row end
  row.strata = {}
  for label, stratum in ipairs(strata) do
    local of_stratum = errors:of_label(label)
    if #of_stratum > 0 then row.strata[stratum] = numbers_of(of_stratum:frames()[1]) end
  end
  row.within_gsd = scale and camera and shares_of_gsd(est, ref, camera, scale) or nil
  return row
end

--- The truth at the method's size, never the other way.
local function read_reference(map, est, truth, input, files)
  local full <close> = truth.depth(map.name, files)
  return aib.depth.downsample(full, est.width, est.height, { rule = input.rule })
end

--- Adds a map's row to the list of each series.
local function add_rows(lists, map, truth, input, files)
  local est <close> = map.read(files)
  if not est then return end
  local ref <close> = read_reference(map, est, truth, input, files)
  local labels = input.details and aib.depth.strata(ref) or nil
  local camera = input.details and (truth.cameras or {})[map.name] or nil
  for k, list in ipairs(lists) do
    table.insert(list.rows, row_of(map.name, est, ref, map.scales[k], labels, camera))
  end
end

--- Remembers the maps that a range lacks, so that those that come later are seen.
local function miss_files(source, range, truth, files)
  for place = range.first, range.last do
    for _, pattern in ipairs { truth.spec.depth, source.pattern } do files:miss(pattern, truth.names[place]) end
  end
end

--- The rows of a range of images, in the order of the scene: a list of { method =, how =, n_expected =, rows = }, one
--- for each series.
function M.rows(source, range, truth, input, files)
  miss_files(source, range, truth, files)
  local lists, maps = aib.json.list(), {}
  for k, series in ipairs(source.series) do
    lists[k] = { method = series.method, how = series.how, n_expected = source.n_expected, rows = aib.json.list() }
  end
  for _, map in ipairs(source.maps) do
    if map.place >= range.first and map.place <= range.last then maps[#maps + 1] = map end
  end
  local place_of = {}
  for i, map in ipairs(maps) do  -- as the files have them, which need not be the order of the scene
    local before = #lists[1].rows
    add_rows(lists, map, truth, input, files)
    for _, list in ipairs(lists) do
      if list.rows[before + 1] then place_of[list.rows[before + 1]] = { map.place, i } end
    end
  end
  for _, list in ipairs(lists) do
    table.sort(list.rows, function(a, b)
      local p, q = place_of[a], place_of[b]
      return p[1] < q[1] or p[1] == q[1] and p[2] < q[2]
    end)
  end
  return lists
end

--- Frames that the page of `cell` shows, and what the confidence of those that have one is worth.
function M.draw(source, truth, input, cell, files)
  if not cell:draws() then return end
  local chosen, risks = drawings.chosen(truth.depth_names), {}
  for _, map in ipairs(source.maps) do
    local est <close> = chosen[map.name] and map.read(files) or nil
    if est then
      local ref <close> = read_reference(map, est, truth, input, files)
      local confidence <close> = map.confidence and map.confidence() or nil
      local transform = { scale = map.scales[1] or 1, shift = 0 }
      drawings.frame(cell, chosen, map.name, est, ref, transform)
      drawings.add_risk(cell, risks, est, ref, confidence, transform)
    end
  end
  drawings.risk(cell, risks)
end

--- Means over the frames that have a valid pixel; coverage over those that have a reference. `n_defined`: how many.
local function mean_of(rows)
  local mean, n_reference = { n_defined = 0 }, 0
  for _, row in ipairs(rows) do
    if row.n_reference > 0 then n_reference = n_reference + 1 end
    if row.srmse then
      mean.n_defined = mean.n_defined + 1
      for _, metric in ipairs(metrics) do mean[metric.name] = (mean[metric.name] or 0) + row[metric.name] end
    end
  end
  for _, metric in ipairs(metrics) do
    local n = metric.name == "coverage" and n_reference or mean.n_defined
    mean[metric.name] = mean[metric.name] and mean[metric.name] / n
  end
  return mean
end

local function add_strata(rows, how, cell)
  for _, stratum in ipairs(strata) do
    local of_stratum = {}
    for _, row in ipairs(rows) do of_stratum[#of_stratum + 1] = row.strata[stratum] end
    local mean = mean_of(of_stratum)
    for _, name in ipairs { "srmse", "coverage" } do
      cell:within({ stratum = stratum }):add("depth." .. name, mean[name], {
        better = name == "srmse" and "lower" or "higher", n = mean[name] and mean.n_defined,
        convention = "mean over frames", options = how,
      })
    end
  end
end

local function add_gsd(rows, how, cell)
  for i, tau in ipairs(gsd_taus) do
    local shares = aib.stats.moments()
    for _, row in ipairs(rows) do
      if row.within_gsd then shares:add(row.within_gsd[i]) end
    end
    local n = #shares > 0 and #shares or nil
    cell:add(("depth.within_%dgsd"):format(tau), n and shares.mean, {
      better = "higher", n = n, convention = "share of the truth's pixels, mean over frames", options = how,
    })
  end
end

--- Numbers of frames by metric: { ["depth.srmse"] = { names =, values = }, ... }, where they are defined; those of a
--- length where the scale is known.
local function frames_of(rows)
  local frames = {}
  for _, metric in ipairs(metrics) do
    local names, values = aib.json.list(), aib.json.list()
    for _, row in ipairs(rows) do
      if row[metric.name] and (row.is_scaled or not metric.of_length) then
        names[#names + 1], values[#values + 1] = row.name, row[metric.name]
      end
    end
    if #names > 0 then frames["depth." .. metric.name] = { names = names, values = values } end
  end
  return frames
end

--- Adds what the rows of all images of a series tell, and returns the numbers of frames by metric.
function M.add(series, input, cell)
  local rows, scaled = series.rows, {}
  for _, row in ipairs(rows) do scaled[#scaled + 1] = row.is_scaled and row or nil end
  local mean, of_length = mean_of(rows), mean_of(scaled)
  if mean.n_defined == 0 then
    cell:note(("depth: none of %d frames has a pixel that is valid in both maps"):format(#rows))
  end
  local how = { rule = input.rule, frames_expected = series.n_expected }
  local how_scaled = suggest.with(series.how, how)
  for _, metric in ipairs(metrics) do
    local from = metric.of_length and of_length or mean
    cell:add("depth." .. metric.name, from[metric.name], {
      better = metric.better, n = #scaled > 0 and from.n_defined or mean.n_defined, convention = "mean over frames",
      options = metric.of_length and how_scaled or how,
    })
  end
  local empty = #rows - mean.n_defined
  if empty > 0 then cell:note(("depth: %d of %d frames have no valid pixel"):format(empty, #rows)) end
  local frames = frames_of(rows)
  drawings.depth_series(cell, rows)
  if input.details then
    add_strata(rows, how_scaled, cell)
    add_gsd(rows, how_scaled, cell)
  end
  return frames
end

return M
