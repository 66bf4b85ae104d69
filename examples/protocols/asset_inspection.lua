-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The evaluation of "A 3D Reconstruction Benchmark for Asset Inspection" (Gray et al.), over a folder whose
--- benchmark.lua names scenes, ground truth and what each method left on disk (see aib.benchmark).
---
---   aib-lua asset_inspection examples/data --json results.json
local aib = require "aib"

-- Poses ---------------------------------------------------------------------------------------------------------------

--- The models that a method made of a scene: those of COLMAP or GLOMAP, or the one of a trajectory file.
local function models_of(result, files)
  if result.models then return aib.submodels.read(files:whole_folder(result.models)) end
  if not result.poses then return {} end
  local cameras = result.cameras
  if type(cameras) == "string" then cameras = aib.io.read_cameras(files:file(cameras)) end
  local trajectory = aib.io.read_trajectory(files:file(result.poses))
  return { { name = "0", trajectory = trajectory, cameras = cameras, points = {} } }
end

--- Pairs a model's poses with the truth and aligns them: a Sim(3) of the camera positions.
local function align(model, truth, input, cell)
  model.est, model.ref = aib.pose.associate(model.trajectory, truth.trajectory, { by = "name" })
  local trimmed = input.alignment == "trimmed"
  model.how = { alignment = input.alignment, outlier_factor = trimmed and input.outlier_factor or nil }
  model.alignment = cell:attempt(function()
    return aib.align.trajectory(model.est, model.ref, { mode = "sim3", outlier_factor = model.how.outlier_factor })
  end, "no alignment to the truth")
end

local function score_alignment(model, cell)
  local alignment, how = model.alignment, model.how
  if not alignment then return end
  local ape = aib.pose.ape(alignment.transform * model.est, model.ref)
  cell:add("pose.ape_rmse", ape.rmse, { unit = "m", better = "lower", n = #model.est, options = how })
  cell:add("align.rmse", alignment.rmse, { unit = "m", better = "lower", n = alignment.n_inliers, options = how })
  cell:add("align.scale", alignment.transform.scale, { n = alignment.n_inliers, options = how })
  cell:add("align.condition", alignment.condition, { n = alignment.n_inliers, options = how })
  for _, warning in ipairs(alignment.warnings) do cell:note("alignment: " .. warning) end
end

local function score_angles(model, truth, input, cell)
  local est, ref = model.est, model.ref
  if input.auc == "colmap" then est, ref = model.trajectory, truth.trajectory end  -- missing images count there
  local auc = cell:attempt(function() return aib.pose.auc(est, ref, { convention = input.auc }) end, "pose.auc30")
  if auc then
    local how = { better = "higher", n = auc.n_pairs, convention = input.auc }
    cell:add("pose.auc30", auc.auc, how)
    cell:add("pose.auc30_signed", auc.auc_signed, how)
    cell:add("pose.n_zero_baseline", auc.n_zero_baseline, { n = auc.n_pairs })
    if input.auc == "paper" then  -- of both errors at once: at most what the paper counts of each
      local joint = aib.pose.auc(est, ref, { convention = "exact" })
      cell:add("pose.auc30_joint", joint.auc, { better = "higher", n = joint.n_pairs, convention = "exact" })
    end
  else
    cell:add("pose.auc30", nil, { better = "higher" })
  end
  local taus = { 5, 15, 30 }
  local angles = cell:attempt(function() return aib.pose.relative_angles(model.est, model.ref, { tau = taus }) end)
  for _, tau in ipairs(angles and taus or {}) do
    local how = { better = "higher", n = angles.n_pairs, options = { tau_deg = tau } }
    cell:add("pose.rra" .. tau, angles.rra[tau], how)
    cell:add("pose.rta" .. tau, angles.rta[tau], how)
  end
end

local function score_model(model, truth, input, cell)
  local registration = aib.pose.registration_rate(model.trajectory, truth.trajectory)
  cell:add("pose.registration_rate", registration.rate, { better = "higher", n = registration.n_total })
  cell:add("pose.n_registered", registration.n_registered, { better = "higher" })
  cell:add("pose.n_points", #model.points)
  score_angles(model, truth, input, cell)
  score_alignment(model, cell)
  if not model.cameras then return end
  cell:add("camera.focal_mre", function()
    return aib.pose.focal_error(model.cameras, truth.cameras, { over = "views" }).mre
  end, { better = "lower", convention = "mean over views" })
end

--- Scores every model. The largest stands for the method, whatever its score; the others are groups of their own.
local function score_models(models, truth, input, cell)
  local scored = aib.submodels.largest(models)
  for _, model in ipairs(models) do
    local sub = #models > 1 and cell:within { model = model.name } or cell
    align(model, truth, input, model == scored and cell or sub)
    if model == scored then score_model(model, truth, input, cell) end
    if #models > 1 then score_model(model, truth, input, sub) end
  end
  if #models > 1 then
    cell:note(("the largest of %d sub-models is scored, number %s"):format(#models, scored.name))
  end
  return scored
end

--- Both tables in one.
local function with(a, b)
  local merged = {}
  for _, options in ipairs { a or {}, b } do
    for key, value in pairs(options) do merged[key] = value end
  end
  return merged
end

-- Depth ---------------------------------------------------------------------------------------------------------------

--- What is told of the frames; what is of a length needs the scale of the alignment.
local depth_metrics <const> = {
  { name = "srmse", better = "lower" }, { name = "si_log_rmse", better = "lower" },
  { name = "coverage", better = "higher" }, { name = "abs_rel", better = "lower", of_length = true },
  { name = "delta1", better = "higher", of_length = true }, { name = "delta2", better = "higher", of_length = true },
  { name = "delta3", better = "higher", of_length = true },
}

--- Adds a frame's errors; the truth is brought to the method's size, never the other way.
local function add_frame(errors, name, unit, truth, files, input)
  local est <close> = aib.io.read_depth(files:frame(unit.result.depth, name))
  local full <close> = truth.depth(name)
  local ref <close> = aib.depth.downsample(full, est.width, est.height, { rule = input.rule })
  errors:add(est, ref, { name = name })
end

local function score_depth(unit, truth, files, frame, input, cell)
  local errors = aib.depth.accumulate { transform = { scale = frame.scale or 1 } }
  for _, name in ipairs(files:present(unit.result.depth, truth.depth_names)) do
    add_frame(errors, name, unit, truth, files, input)
  end
  local mean = cell:attempt(function() return errors:result() end, "depth") or { n_defined = 0 }
  local how = { rule = input.rule, frames_expected = #truth.depth_names }
  for _, metric in ipairs(depth_metrics) do
    local known = frame.scale or not metric.of_length
    cell:add("depth." .. metric.name, known and mean[metric.name] or nil, {
      better = metric.better, n = mean.n_defined, convention = "mean over frames",
      options = metric.of_length and with(frame.how, how) or how,
    })
  end
  local empty = #errors - mean.n_defined
  if empty > 0 then cell:note(("depth: %d of %d frames have no valid pixel"):format(empty, #errors)) end
end

-- Points --------------------------------------------------------------------------------------------------------------

--- Points that stand for the true surface: given ones, or samples of the mesh. Records how fine they are.
local function reference_points(truth, input)
  if truth.points or not truth.mesh then return truth.points end
  return aib.scene.cropped(truth, aib.sample.mesh(truth.mesh, { n = input.samples, seed = input.seed }))
end

local distance_metrics <const> = {
  "accuracy", "completeness", "chamfer", "chamfer_mean", "f1_distance", "accuracy_median", "completeness_median",
}

local function score_cloud(unit, truth, files, frame, input, cell)
  local result = unit.result
  local all = result.cloud == "model" and frame.model.points or aib.scene.read_cloud(files, result.cloud)
  if not frame.scale then
    cell:note("points: they cannot be brought into the frame of the truth")
    return
  end
  if frame.transform then all = frame.transform * all end
  local cloud = aib.scene.cropped(truth, all)
  local compared = cell:attempt(function()
    return aib.cloud.compare(cloud, truth.reference, { tau = input.tau })
  end, "points") or { precision = {}, recall = {}, f_score = {} }
  local sampled = not truth.points
  local how = with(frame.how, { samples = sampled and input.samples or nil, seed = sampled and input.seed or nil })
  for _, name in ipairs(distance_metrics) do
    cell:add("cloud." .. name, compared[name], { unit = "m", better = "lower", n = #cloud, options = how })
  end
  for _, tau in ipairs(input.tau) do
    for _, name in ipairs { "precision", "recall", "f_score" } do
      cell:add(("cloud.%s@%gm"):format(name, tau), compared[name][tau], {
        better = "higher", n = #cloud, options = how,
      })
    end
  end
  cell:add("cloud.n_outside", #all - #cloud, { n = #all })
end

-- All -----------------------------------------------------------------------------------------------------------------

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

local function evaluate(unit, truth, files, input, cell)
  local models = models_of(unit.result, files)
  local scored = aib.submodels.largest(models)
  if unit.method.parameters == "ground truth" then
    cell:add("pose.auc30", nil, { better = "higher", note = "the poses are given" })
  elseif scored then
    score_models(models, truth, input, cell)
  end
  local frame = frame_of(unit, models, scored)
  if unit.result.depth then score_depth(unit, truth, files, frame, input, cell) end
  if unit.result.cloud then score_cloud(unit, truth, files, frame, input, cell) end
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

return aib.protocol {
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
    tau = { kind = "list", of = "number", unit = "m", default = { 0.02, 0.05, 0.1 },
      help = "thresholds of precision, recall and F-score" },
    min_coverage = { kind = "number", default = 0.5, min = 0, max = 1,
      help = "coverage from which a depth error can be the best" },
  },
  run = function(input, report)
    local benchmark = aib.benchmark.open(input.benchmark)
    local files = benchmark.files
    add_tables(report, input)
    state_conventions(report, input)
    local progress <close> = aib.progress(#benchmark.units, "units")
    local truth
    for _, unit in ipairs(benchmark.units) do
      local cell = report:within(unit.group)
      progress:step(cell:group_name())
      if not truth or truth.spec ~= unit.scene then
        truth = aib.scene.open(unit.scene, files)
        truth.reference = reference_points(truth, input)
      end
      if unit.result then evaluate(unit, truth, files, input, cell) end
    end
    for label, print in pairs(files:sources()) do report:source(label, print) end
    aib.consistency.check_report(report)
  end,
}
