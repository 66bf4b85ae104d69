-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The evaluation of "A 3D Reconstruction Benchmark for Asset Inspection" (Gray et al.), over a folder whose
--- benchmark.lua names scenes, ground truth and what each method left on disk (see aib.benchmark).
---
---   aib-lua asset_inspection examples/data --json results.json
local aib = require "aib"
local batches = require "aib.evaluation.batches"
local depth = require "aib.evaluation.depth"
local drawings = require "aib.evaluation.drawings"
local points = require "aib.evaluation.points"
local suggest = require "aib.suggest"
local unit_of = require "aib.evaluation.unit"

local function has_record(report, name)
  for _, record in ipairs(report:records()) do
    if record.name == name then return true end
  end
  return false
end

local function add_tables(report, input)
  report:table {
    title = "Depth, sRMSE", metrics = { "depth.srmse" },
    beside = { { metric = "depth.coverage", percent = true }, { field = "n" } },
    bold_from = { metric = "depth.coverage", at_least = input.min_coverage },
    notes = {
      ("Beside it: covered share of the truth's valid pixels, frames. Best from %g %% coverage on."):format(
        100 * input.min_coverage),
    },
  }
  report:table { title = ("Poses, AUC30 (%s)"):format(input.auc), metrics = { "pose.auc30" } }
  report:table {
    title = "Registered images", metrics = { { "pose.registration_rate", percent = true } },
    beside = { { field = "n" } }, notes = { "Beside it: images expected." },
  }
  report:table { title = "Focal length, mean relative error", metrics = { { "camera.focal_mre", percent = true } } }
  if has_record(report, "pose.auc30_intra") then
    report:table { title = "Poses, AUC30 within and across batches", down = { "method" },
      across = { "scene", "condition", "metric" }, metrics = {
        { "pose.auc30_intra", label = "within" }, { "pose.auc30_cross", label = "across" } } }
  end
  if has_record(report, "depth.within_1gsd") then
    report:table { title = "Depth, share of the truth within ground sampling distances", down = { "method" },
      across = { "scene", "condition", "metric" }, metrics = { { "depth.within_1gsd", label = "1", percent = true },
        { "depth.within_2gsd", label = "2", percent = true }, { "depth.within_5gsd", label = "5", percent = true } } }
    report:table { title = "Depth, sRMSE by stratum", metrics = { "depth.srmse" }, down = { "method", "stratum" } }
    report:table { title = "Points, completeness by label", metrics = { "cloud.completeness" },
      down = { "method", "label" } }
  end
  report:table { title = "Points, chamfer distance", metrics = { "cloud.chamfer" } }
  report:table { title = "Points, F1 of accuracy and completeness", metrics = { "cloud.f1_distance" } }
end

local function state_conventions(report, input)
  report:convention("depth", "per frame over common valid pixels, then the mean over frames; truth downsampled by "
    .. "nearest neighbour, rule " .. input.rule)
  report:convention("pose.auc30", input.auc .. "; largest sub-model, registered images only")
  report:convention("cloud.chamfer", "accuracy + completeness")
  report:convention("cloud.f1_distance", "harmonic mean of accuracy and completeness, a distance")
end

--- What changes with the conditions of a scene, where it is told of single images: the same image under each is a pair.
--- AUC is of pairs of images, chamfer distance and F1 are of points, so that nothing in them is paired.
local paired <const> = {
  { "srmse", "depth.srmse" }, { "coverage", "depth.coverage" }, { "abs_rel", "depth.abs_rel" },
  { "delta1", "depth.delta1" }, { "ape", "pose.ape_rmse", unit = "m" },
  { "registration_rate", "pose.registration_rate" }, { "focal_mre", "camera.focal_mre" },
}

--- Changes of every metric that is paired over the conditions of one scene for one method.
local function add_changes(cell, levels, rule)
  local told = {}  -- by contrast: a metric may be there under some conditions alone
  for _, metric in ipairs(paired) do
    local list = {}
    for _, level in ipairs(levels) do
      local frames = level.frames[metric[2]]
      list[#list + 1] = frames and { condition = level.condition, names = frames.names, values = frames.values }
    end
    if #list > 1 then
      local contrast = ("%s to %s"):format(list[1].condition, list[#list].condition)
      local sentence = aib.sensitivity.add(cell:within { contrast = contrast }, metric[1], list,
        { rule = metric[2]:find "^depth" and rule or nil }, metric.unit)
      if sentence then
        told[contrast] = told[contrast] or {}
        table.insert(told[contrast], sentence)
      end
    end
  end
  for _, contrast in ipairs(suggest.keys(told)) do
    cell:within({ contrast = contrast }):note(table.concat(told[contrast], "; "))
  end
end

--- Changes over the conditions of each scene, for each method that has images in several.
local function add_sensitivity(report, series, rule)
  local order, levels = {}, {}
  for _, one in ipairs(series) do
    local group = one.group
    if group.condition then
      local id = group.scene .. "\0" .. group.method
      if not levels[id] then order[#order + 1], levels[id] = id, {} end
      table.insert(levels[id], { condition = group.condition, frames = one.frames })
    end
  end
  for _, id in ipairs(order) do
    local scene, method = id:match "^(.*)%z(.*)$"
    add_changes(report:within { scene = scene, method = method }, levels[id], rule)
  end
end

--- Numbers of frames, for JSON.
local function frame_lists(series)
  local lists = aib.json.list()
  for _, one in ipairs(series) do
    for _, metric in ipairs(suggest.keys(one.frames)) do
      local frames = one.frames[metric]
      lists[#lists + 1] = { metric = metric, group = one.group, names = frames.names, values = frames.values }
    end
  end
  return lists
end

--- The rows of all parts of a unit, by series: their lists follow each other.
local function joined_rows(unit)
  local series = {}
  for _, part in ipairs(unit) do
    for k, list in ipairs(part.rows) do
      series[k] = series[k] or { method = list.method, how = list.how, n_expected = list.n_expected, rows = {} }
      table.move(list.rows, 1, #list.rows, #series[k].rows + 1, series[k].rows)
    end
  end
  return series
end

--- Adds what all parts of a unit tell together. Returns its numbers of frames: a list of { group =, frames = }, first
--- those of the method, then those of it in batches.
local function add_unit(unit, input, report, files)
  local found = { { group = unit[1].group, frames = {} } }
  for _, part in ipairs(unit) do
    aib.units.absorb(report, files, part)
    for metric, frames in pairs(part.frames) do found[1].frames[metric] = frames end
  end
  if report.store.shard then return found end  -- it may not have all parts of the unit
  drawings.pose_series(report:within(unit[1].group), found[1].frames["pose.ape_rmse"])
  for _, series in ipairs(joined_rows(unit)) do
    local cell = report:within(unit[1].group):within { method = series.method }
    if #series.rows > 0 then
      local one = found[1]
      if series.method then
        one = { group = cell.group, frames = {} }
        found[#found + 1] = one
      end
      for metric, frames in pairs(depth.add(series, input, cell)) do one.frames[metric] = frames end
    end
  end
  return found
end

--- What follows from all units together, in this run or in merged shards.
local function finish(input, report, parts, files)
  local series = {}
  for _, unit in ipairs(aib.units.grouped(parts)) do
    local found = add_unit(unit, input, report, files)
    table.move(found, 1, #found, #series + 1, series)
  end
  add_tables(report, input)
  state_conventions(report, input)
  if report.store.shard then
    report:note("", "a part of a run: depth, and changes over conditions, follow from all parts (aib-lua merge)")
  else
    add_sensitivity(report, series, input.rule)
  end
  if input.per_frame then report.store.frames = frame_lists(series) end
  for label, print in pairs(files:sources()) do report:source(label, print) end
  aib.consistency.check_report(report)
end

--- The scenes of a run, the last one kept: `views` has the images, whose files every part depends on, `surface` the
--- mesh or the points as well.
local function scene_reader(input)
  local spec, views, surface
  local function open(scene) return aib.scene.open(scene, aib.files.new(input.benchmark)) end
  return function(scene, needs_surface)
    if spec ~= scene then
      spec, views, surface = scene, open(scene), nil
      assert(views.trajectory)  -- is among its files from now on
    end
    if needs_surface and not surface then
      surface = open(scene)
      surface.reference, surface.floor = points.reference_points(surface, input)
    end
    return views, surface
  end
end

--- What a unit's parts share, the last one kept.
local function unit_reader(input)
  local last, opened, files
  return function(unit, views)
    if last ~= unit then
      last, opened, files = unit, nil, aib.files.new(input.benchmark)
      opened = unit_of.open(unit, views, files, input)
    end
    return opened, files
  end
end

return aib.protocol {
  finish = finish,
  name = "asset_inspection",
  title = "Asset inspection benchmark",
  cite = "Gray et al., A 3D Reconstruction Benchmark for Asset Inspection",
  help = "Scores depth, poses, focal lengths and points of every method on every scene and condition of a benchmark.",
  inputs = {
    benchmark = { kind = "folder", position = 1, help = "folder that holds benchmark.lua" },
    alignment = { kind = "choice", choices = { "trimmed", "umeyama" }, default = "trimmed",
      help = "Sim(3) of camera positions to the truth: after outliers are removed, or of all" },
    outlier_factor = { kind = "number", default = 3, min = 0,
      help = "an outlier lies further from the median position than this many median distances" },
    auc = { kind = "choice", default = "paper", help = "convention of AUC30",
      choices = { "paper", "vggt", "posediffusion", "posediffusion_torch", "da3", "colmap", "exact" } },
    rule = { kind = "choice", choices = { "centre", "floor" }, default = "centre",
      help = "pixel of the true depth that stands for one of a smaller map" },
    samples = { kind = "integer", default = 100000, min = 1, help = "points sampled on a mesh of the truth" },
    seed = { kind = "integer", default = 1, min = 0, help = "of the sampling" },
    batch = { kind = "list", of = "text", default = {},
      help = "METHOD=SIZE: also score an unbatched method in batches of so many images" },
    confidence = { kind = "number", default = 0.75,
      help = "points of depth maps are kept above it, by the method's rule" },
    stride = { kind = "integer", default = 2, min = 1,
      help = "every so many rows and columns of depth maps give points" },
    results = { kind = "path", default = "", help = "folder that keeps finished parts, which are reused" },
    shard = { kind = "path", default = "",
      help = "INDEX/COUNT: evaluate a part of the units and images, for aib-lua merge" },
    details = { kind = "flag",
      help = "also shares within 1, 2, 5 ground sampling distances, depth by strata, points by label" },
    per_frame = { kind = "flag", help = "keep the numbers of frames in the JSON, for paired comparisons" },
    tau = { kind = "list", of = "number", unit = "m", above = 0, default = { 0.02, 0.05, 0.1 },
      help = "thresholds of precision, recall and F-score" },
    min_coverage = { kind = "number", default = 0.5, min = 0, max = 1,
      help = "coverage from which a depth error can be the best" },
  },
  run = function(input, report)
    local benchmark = aib.benchmark.open(input.benchmark)
    batches.check_batches(input, benchmark)
    local scene_of, opened_of = scene_reader(input), unit_reader(input)
    local parts = aib.units.run {
      report = report, files = benchmark.files, units = benchmark.units,
      results = input.results ~= "" and input.results or nil, shard = input.shard,
      name = function(unit) return report:within(unit.group):group_name() end,
      group = function(unit) return unit.group end,
      describe = function(unit)
        return { scene = unit.scene, condition = unit.condition, result = unit.result, batch = input.batch,
          method = { name = unit.method.name, parameters = unit.method.parameters } }
      end,
      n_images = function(unit)
        local has_maps = unit.result and (unit.result.depth or unit.result.output)
        return has_maps and #scene_of(unit.scene).names or 0
      end,
      evaluate = function(unit, part, range)
        if not unit.result then return {} end
        local own = aib.files.new(input.benchmark)
        local views, surface = scene_of(unit.scene, not range)
        local opened, files = opened_of(unit, views)
        if range then
          part.rows = unit_of.rows(opened, range, views, input, own)
          return { views.files, files, own }
        end
        unit_of.score(unit, opened, surface, own, input, part.report:within(unit.group), part.frames)
        return { views.files, surface.files, files, own }
      end,
    }
    finish(input, report, parts, benchmark.files)
  end,
}
