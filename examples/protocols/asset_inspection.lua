-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The evaluation of "A 3D Reconstruction Benchmark for Asset Inspection" (Gray et al.), over a folder whose
--- benchmark.lua names scenes, ground truth and what each method left on disk (see aib.benchmark).
---
---   aib-lua asset_inspection examples/data --json results.json
local aib = require "aib"
local batches = require "aib.evaluation.batches"
local depth = require "aib.evaluation.depth"
local points = require "aib.evaluation.points"
local poses = require "aib.evaluation.poses"

--- How a method's depth and points come into the frame of the truth: { transform =, scale =, model = }; without scale
--- where that is not known.
local function frame_of(unit, models, scored)
  local model = scored
  for _, other in ipairs(models) do
    if other.name == unit.result.model then model = other end
  end
  local own = unit.method.parameters == "estimated"
  if (unit.result.frame or own and "method" or "reference") == "reference" then return { scale = 1, model = model } end
  local alignment = model and model.alignment
  if not alignment then return { model = model } end
  return { transform = alignment.transform, scale = alignment.transform.scale, model = model, how = model.how }
end

local function evaluate(unit, truth, files, input, cell, frames)
  if unit.result.output then
    return batches.evaluate_output(unit, truth, files, input, cell, frames)
  end
  local models = poses.models_of(unit.result, files)
  local scored = aib.submodels.largest(models)
  if unit.method.parameters == "ground truth" then
    cell:add("pose.auc30", nil, { better = "higher", note = "the poses are given" })
  elseif scored then
    poses.score_models(models, truth, input, cell)
    batches.score_in_batches(scored.trajectory, unit.method.name, truth, input, cell)
  end
  local frame = frame_of(unit, models, scored)
  if unit.result.depth then depth.score_depth(unit, truth, files, frame, input, cell, frames) end
  if unit.result.cloud and points.has_surface(truth, cell) then
    points.score_cloud(unit, truth, files, frame, input, cell)
  end
end

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

--- Changes of depth errors over the conditions of each scene, for each method that has frames in several.
local function add_sensitivity(report, parts, rule)
  local order, levels = {}, {}
  for _, part in ipairs(parts) do
    local frames, group = part.frames["depth.srmse"], part.group
    if frames and group.condition then
      local id = group.scene .. "\0" .. group.method
      if not levels[id] then order[#order + 1], levels[id] = id, {} end
      table.insert(levels[id], { condition = group.condition, names = frames.names, values = frames.values })
    end
  end
  for _, id in ipairs(order) do
    local scene, method = id:match "^(.*)%z(.*)$"
    local list = levels[id]
    local contrast = ("%s to %s"):format(list[1].condition, list[#list].condition)
    aib.sensitivity.add(report:within { scene = scene, method = method, contrast = contrast }, "srmse", list,
      { rule = rule })
  end
end

--- Numbers of frames, for JSON.
local function frame_lists(parts)
  local lists = aib.json.list()
  for _, part in ipairs(parts) do
    for metric, frames in pairs(part.frames) do
      lists[#lists + 1] = { metric = metric, group = part.group, names = frames.names, values = frames.values }
    end
  end
  return lists
end

--- Shards bring numbers of frames and no pictures: those are drawn then.
local function draw_merged(report, parts)
  if not report:draws() or #report.store.views > 0 then return end
  for _, part in ipairs(parts) do
    for metric, frames in pairs(part.frames) do
      report:within(part.group):timeline { title = metric .. " along the flight", y = { label = metric },
        frames = frames.names, values = frames.values }
    end
  end
end

--- What follows from all units together, in this run or in merged shards.
local function finish(input, report, parts, files)
  add_tables(report, input)
  state_conventions(report, input)
  add_sensitivity(report, parts, input.rule)
  draw_merged(report, parts)
  if input.per_frame then report.store.frames = frame_lists(parts) end
  for label, print in pairs(files:sources()) do report:source(label, print) end
  aib.consistency.check_report(report)
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
    results = { kind = "path", default = "", help = "folder that keeps finished units, which are reused" },
    shard = { kind = "path", default = "", help = "INDEX/COUNT: evaluate a part of the units, for aib-lua merge" },
    details = { kind = "flag",
      help = "also shares within 1, 2, 5 ground sampling distances, depth by strata, points by label" },
    per_frame = { kind = "flag", help = "keep the numbers of frames in the JSON, for paired comparisons" },
    tau = { kind = "list", of = "number", unit = "m", default = { 0.02, 0.05, 0.1 },
      help = "thresholds of precision, recall and F-score" },
    min_coverage = { kind = "number", default = 0.5, min = 0, max = 1,
      help = "coverage from which a depth error can be the best" },
  },
  run = function(input, report)
    local benchmark = aib.benchmark.open(input.benchmark)
    batches.check_batches(input, benchmark)
    local truth
    local parts = aib.units.run {
      report = report, files = benchmark.files, units = benchmark.units,
      results = input.results ~= "" and input.results or nil, shard = input.shard,
      name = function(unit) return report:within(unit.group):group_name() end,
      group = function(unit) return unit.group end,
      describe = function(unit)
        return { scene = unit.scene, condition = unit.condition, result = unit.result, batch = input.batch,
          method = { name = unit.method.name, parameters = unit.method.parameters } }
      end,
      evaluate = function(unit, part)
        if not truth or truth.spec ~= unit.scene then
          truth = aib.scene.open(unit.scene, aib.files.new(input.benchmark))
          truth.reference, truth.floor = points.reference_points(truth, input)
        end
        local files = aib.files.new(input.benchmark)
        if unit.result then
          evaluate(unit, truth, files, input, part.report:within(unit.group), part.frames)
        end
        return { truth.files, files }
      end,
    }
    finish(input, report, parts, benchmark.files)
  end,
}
