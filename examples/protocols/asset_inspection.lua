-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The evaluation of "A 3D Reconstruction Benchmark for Asset Inspection" (Gray et al.), over a folder whose
--- benchmark.lua names scenes, ground truth and what each method left on disk (see aib.benchmark).
---
---   aib-lua asset_inspection examples/data --json results.json
local aib = require "aib"
local failure = require "aib.failure"
local suggest = require "aib.suggest"

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

local gsd_taus <const> = { 1, 2, 5 }
local strata <const> = { "inside", "edge", "thin" }

--- Adds a frame's errors to an accumulator; the truth is brought to the method's size, never the other way. Shares
--- within some ground sampling distances go to `gsd`, by tau, where the scale is known.
local function add_frame(errors, gsd, name, est, scale, truth, input)
  local full <close> = truth.depth(name)
  local ref <close> = aib.depth.downsample(full, est.width, est.height, { rule = input.rule })
  errors:add(est, ref, { name = name, labels = input.details and aib.depth.strata(ref) or nil })
  local camera = input.details and scale and (truth.cameras or {})[name]
  if not camera then return end
  local ok, surface = pcall(aib.depth.surface_errors, est, ref, camera, {
    tau = gsd_taus, transform = { scale = scale, shift = 0 },
  })
  if not ok and aib.error_kind(surface) ~= "undefined" then error(surface, 0) end
  for _, tau in ipairs(ok and gsd_taus or {}) do
    gsd[tau] = gsd[tau] or aib.stats.moments()
    gsd[tau]:add(surface.within_total[tau])
  end
end

--- Errors inside of surfaces, at depth edges and in thin structures, and shares of the truth's pixels within some
--- ground sampling distances.
local function add_depth_details(errors, gsd, how, cell)
  for label, stratum in ipairs(strata) do
    local of_stratum = errors:of_label(label)
    local mean = #of_stratum > 0 and cell:attempt(function() return of_stratum:result() end) or {}
    for _, name in ipairs { "srmse", "coverage" } do
      cell:within({ stratum = stratum }):add("depth." .. name, mean[name], {
        better = name == "srmse" and "lower" or "higher", n = mean.n_defined, convention = "mean over frames",
        options = how,
      })
    end
  end
  for _, tau in ipairs(gsd_taus) do
    cell:add(("depth.within_%dgsd"):format(tau), gsd[tau] and gsd[tau].mean, {
      better = "higher", n = gsd[tau] and #gsd[tau], convention = "share of the truth's pixels, mean over frames",
      options = how,
    })
  end
end

--- Adds what an accumulator of frames found. Metrics of a length are those of `scaled`: frames whose scale is known,
--- nil where there is none.
local function add_depth(errors, scaled, gsd, truth, how_scaled, input, cell, frames)
  local mean = cell:attempt(function() return errors:result() end, "depth") or { n_defined = 0 }
  local of_length = scaled == errors and mean
    or scaled and cell:attempt(function() return scaled:result() end) or { n_defined = 0 }
  local how = { rule = input.rule, frames_expected = #truth.depth_names }
  for _, metric in ipairs(depth_metrics) do
    local from = metric.of_length and of_length or mean
    cell:add("depth." .. metric.name, from[metric.name], {
      better = metric.better, n = scaled and from.n_defined or mean.n_defined, convention = "mean over frames",
      options = metric.of_length and with(how_scaled, how) or how,
    })
  end
  local empty = #errors - mean.n_defined
  if empty > 0 then cell:note(("depth: %d of %d frames have no valid pixel"):format(empty, #errors)) end
  local kept = { names = aib.json.list(), values = aib.json.list() }
  for _, frame in ipairs(errors:frames()) do
    if frame.srmse then
      kept.names[#kept.names + 1], kept.values[#kept.values + 1] = frame.name, frame.srmse
    end
  end
  frames["depth.srmse"] = kept
  if input.details then add_depth_details(errors, gsd, with(how_scaled, how), cell) end
end

local function score_depth(unit, truth, files, frame, input, cell, frames)
  local errors = aib.depth.accumulate { transform = { scale = frame.scale or 1 } }
  local gsd = {}
  for _, name in ipairs(files:present(unit.result.depth, truth.depth_names)) do
    local est <close> = aib.io.read_depth(files:frame(unit.result.depth, name))
    add_frame(errors, gsd, name, est, frame.scale, truth, input)
  end
  add_depth(errors, frame.scale and errors, gsd, truth, frame.how, input, cell, frames)
end

-- Points --------------------------------------------------------------------------------------------------------------

--- Points that stand for the true surface: given ones, or samples of the mesh, and the accuracy that a perfect cloud
--- gets against those.
local function reference_points(truth, input)
  if truth.points or not truth.mesh then return truth.points end
  local samples, info = aib.sample.mesh(truth.mesh, { n = input.samples, seed = input.seed })
  return aib.scene.cropped(truth, samples), info.floor
end

local distance_metrics <const> = {
  "accuracy", "completeness", "chamfer", "chamfer_mean", "f1_distance", "accuracy_median", "completeness_median",
}

--- The same by label of the surface: glass, frame, truss, ...
local function add_labels(cloud, truth, how, input, cell)
  for _, of_label in ipairs(aib.cloud.compare_by_label(cloud, truth.reference, { tau = input.tau })) do
    local sub = cell:within { label = truth.mesh and truth.mesh.label_names[of_label.label + 1] or of_label.label }
    for _, name in ipairs { "accuracy", "completeness", "chamfer" } do
      sub:add("cloud." .. name, of_label[name], {
        unit = "m", better = "lower", n = of_label.n_estimate, options = how,
      })
    end
  end
end

--- Whether the scene has a surface that points can be held against; says so where it has none.
local function has_surface(truth, cell)
  if truth.reference then return true end
  cell:note("points: the scene has neither mesh nor points")
  return false
end

--- Adds the distances between a cloud in the frame of the truth and the true surface.
local function add_cloud(all, truth, frame_how, input, cell)
  local cloud = aib.scene.cropped(truth, all)
  local compared = cell:attempt(function()
    return aib.cloud.compare(cloud, truth.reference, { tau = input.tau })
  end, "points") or { precision = {}, recall = {}, f_score = {} }
  local sampled = not truth.points
  local how = with(frame_how, { samples = sampled and input.samples or nil, seed = sampled and input.seed or nil })
  for _, name in ipairs(distance_metrics) do
    cell:add("cloud." .. name, compared[name], { unit = "m", better = "lower", n = #cloud, options = how })
  end
  if truth.floor and compared.accuracy then
    cell:add("cloud.sampling_floor", truth.floor, { unit = "m", n = input.samples })
    cell:add("cloud.accuracy_exact", aib.mesh.distances(cloud, truth.mesh):mean(), {
      unit = "m", better = "lower", n = #cloud, options = frame_how, convention = "point to triangle",
    })
  end
  for _, tau in ipairs(input.tau) do
    for _, name in ipairs { "precision", "recall", "f_score" } do
      cell:add(("cloud.%s@%gm"):format(name, tau), compared[name][tau], {
        better = "higher", n = #cloud, options = how,
      })
    end
  end
  cell:add("cloud.n_outside", #all - #cloud, { n = #all })
  if input.details and truth.reference.has_labels then add_labels(cloud, truth, how, input, cell) end
end

local function score_cloud(unit, truth, files, frame, input, cell)
  local result = unit.result
  local all = result.cloud == "model" and frame.model.points or aib.scene.read_cloud(files, result.cloud)
  if not frame.scale then
    cell:note("points: they cannot be brought into the frame of the truth")
    return
  end
  add_cloud(frame.transform and frame.transform * all or all, truth, frame.how, input, cell)
end

-- Batches -------------------------------------------------------------------------------------------------------------

--- Frames without names are those of the scene, in its order, where there are as many.
local function name_frames(method, truth, cell)
  local n, named = 0, true
  for _, batch in ipairs(method.batches) do n, named = n + #batch.names, named and batch.named end
  if named or n ~= #truth.names then return end
  cell:note(("%d frames without names: they are taken for the scene's images in their order"):format(n))
  return truth.names
end

--- What the method left, with names.
local function open_method(unit, truth, files, cell)
  local result = unit.result
  local how = { kind = result.kind, layout = result.layout, names = result.names,
    confidence = result.confidence_rule }
  local folder = files:whole_folder(result.output)
  local method = aib.method.open(folder, how)
  local names = not how.names and name_frames(method, truth, cell)
  if names then
    how.names = names
    method = aib.method.open(folder, how)
  end
  cell:note(("%s: %s"):format(method.kind, method.why))
  for _, batch in ipairs(method.batches) do
    for _, warning in ipairs(batch.warnings) do cell:note(("batch %s: %s"):format(batch.name, warning)) end
  end
  return method
end

--- How each batch lies: scale, residual, what is left of it on the half that was not fitted, the seam.
local function report_batches(fit, how, cell)
  for _, part in ipairs(fit.parts) do
    local sub = #fit.parts > 1 and cell:within { batch = part.name } or cell
    local a = part.alignment
    if a then
      local function add(name, value, unit) sub:add("align." .. name, value, { unit = unit, n = a.n_inliers,
        options = how, better = unit and "lower" or nil }) end
      add("rmse", a.rmse, "m")
      add("scale", a.transform.scale)
      add("condition", a.condition)
      add("n_outliers", #a.outliers)
      if part.half_rmse then add("half_rmse", part.half_rmse, "m") end
      if part.seam then add("seam", part.seam, "m") end
      for _, warning in ipairs(a.warnings) do sub:note("alignment: " .. warning) end
    else
      sub:note("no alignment to the truth: " .. part.degenerate)
    end
  end
end

local function add_auc(cell, name, auc, input)
  if not auc or not auc.auc then return end
  local how = { better = "higher", n = auc.n_pairs, convention = input.auc }
  cell:add(name, auc.auc, how)
  cell:add(name .. "_signed", auc.auc_signed, how)
end

--- Poses of all batches; `given`: they are the true ones, of which no error means anything.
local function score_batch_poses(fit, given, truth, how, input, cell)
  cell:add("pose.registration_rate", #fit.est / #truth.names, { better = "higher", n = #truth.names })
  cell:add("pose.n_registered", #fit.est, { better = "higher" })
  if given then
    cell:add("pose.auc30", nil, { better = "higher", note = "the poses are given" })
    return
  end
  local auc = cell:attempt(function() return aib.batches.auc(fit, { convention = input.auc }) end, "pose.auc30") or {}
  add_auc(cell, "pose.auc30", auc.all, input)
  if #fit.parts > 1 or not auc.all then
    add_auc(cell, "pose.auc30_intra", auc.intra, input)
    add_auc(cell, "pose.auc30_cross", auc.cross, input)
  end
  local ape = aib.batches.ape(fit)
  if ape then
    cell:add("pose.ape_rmse", ape.all.rmse, { unit = "m", better = "lower", n = ape.all.count, options = how })
    if ape.kept then
      cell:add("pose.ape_rmse_kept", ape.kept.rmse, { unit = "m", better = "lower", n = ape.kept.count, options = how })
    end
  end
end

--- Depth of all batches, each at the scale of its alignment; where there is none, what needs no scale.
local function score_batch_depth(fit, truth, how, input, cell, frames)
  local has_truth = {}
  for _, name in ipairs(truth.depth_names) do has_truth[name] = true end
  local all, scaled, gsd = aib.depth.accumulate(), aib.depth.accumulate(), {}
  for _, part in ipairs(fit.parts) do
    local scale = part.alignment and part.alignment.transform.scale
    local own = aib.depth.accumulate { transform = { scale = scale or 1 } }
    for i, name in ipairs(part.batch.names) do
      local est <close> = has_truth[name] and part.batch.depth(i) or nil
      if est then add_frame(own, gsd, name, est, scale, truth, input) end
    end
    all:merge(own)
    if scale then scaled:merge(own) end
  end
  if #all > 0 then add_depth(all, #scaled > 0 and scaled or nil, gsd, truth, how, input, cell, frames) end
end

--- Points of all batches: from their depth maps, or the method's own cloud where it has one frame of reference.
local function score_batch_cloud(unit, fit, truth, files, how, input, cell)
  local part = fit.parts[1]
  if unit.result.cloud and #fit.parts == 1 and part.alignment then
    local cloud = aib.scene.read_cloud(files, unit.result.cloud)
    return add_cloud(part.alignment.transform * cloud, truth, how, input, cell)
  end
  local cut = { min_confidence = unit.result.confidence or input.confidence, stride = input.stride }
  local cloud, info = aib.batches.cloud(fit, cut)
  if #cloud == 0 then return end
  cell:add("cloud.share_kept", (info.n_valid - info.n_unsure) / info.n_valid, { n = info.n_valid })
  local rules = {}
  for _, p in ipairs(fit.parts) do rules[p.batch.confidence and p.batch.rule or "none"] = true end
  add_cloud(cloud, truth, with(how, {
    confidence = cut.min_confidence, confidence_rule = next(rules), stride = cut.stride,
  }), input, cell)
end

--- Names that match with their folders, or without them where none does.
local function name_rules(batches, truth)
  for _, batch in ipairs(batches) do
    if batch.trajectory and aib.pose.registration_rate(batch.trajectory, truth.trajectory).n_registered > 0 then
      return nil
    end
  end
  return { ignore_folder = true }
end

--- Sizes by method of --batch NAME=SIZE.
local function batch_sizes(input)
  local sizes = {}
  for _, text in ipairs(input.batch) do
    local name, size = text:match "^(.+)=(%d+)$"
    if not name or tonumber(size) < 1 then
      failure.usage(("--batch: METHOD=SIZE expected, found '%s'"):format(text))
    end
    sizes[name] = sizes[name] or {}
    table.insert(sizes[name], math.tointeger(tonumber(size)))
  end
  return sizes
end

--- Raises an error of usage where --batch names no method.
local function check_batches(input, benchmark)
  local known = {}
  for _, method in ipairs(benchmark.methods) do known[#known + 1] = method.name end
  for name in pairs(batch_sizes(input)) do
    local hint, found = suggest.hint(name, known), false
    for _, method in ipairs(known) do found = found or method == name end
    if not found then failure.usage(("--batch: unknown method '%s'%s"):format(name, hint)) end
  end
end

--- An unbatched method cut into batches as a batched one has them: what its poses would score then, for each size that
--- is asked for.
local function score_in_batches(trajectory, method, truth, input, cell)
  local batch = { names = trajectory.names, trajectory = trajectory, rule = "raw" }
  for _, size in ipairs(batch_sizes(input)[method] or {}) do
    local sub = cell:within { method = ("%s, batches of %d"):format(method, size) }
    local how = { alignment = input.alignment, batch = size }
    how.outlier_factor = how.alignment == "trimmed" and input.outlier_factor or nil
    local fit = aib.batches.align(aib.batches.split(batch, truth.names, size), truth.trajectory,
      { outlier_factor = how.outlier_factor })
    if #fit.parts > 0 then
      score_batch_poses(fit, false, truth, how, input, sub)
      report_batches(fit, how, sub)
    end
  end
end

local function evaluate_output(unit, truth, files, input, cell, frames)
  local method = open_method(unit, truth, files, cell)
  local given = unit.method.parameters == "ground truth"
  for _, batch in ipairs(method.batches) do
    if not given and batch.trajectory and aib.method.poses_are_given(batch.trajectory, truth.trajectory) then
      given = true
      cell:note("its poses are the true ones, though the parameters are called estimated")
    end
  end
  local how = { alignment = given and "none" or input.alignment }
  how.outlier_factor = how.alignment == "trimmed" and input.outlier_factor or nil
  local fit = aib.batches.align(method.batches, truth.trajectory, {
    outlier_factor = how.outlier_factor, given = given, names = name_rules(method.batches, truth),
  })
  if #fit.parts == 0 then
    cell:note("no pose of it is of an image of the scene")
    return
  end
  score_batch_poses(fit, given, truth, how, input, cell)
  if not given then report_batches(fit, how, cell) end
  local cameras = aib.batches.cameras(method.batches)
  if cameras and not given then
    cell:add("camera.focal_mre", function()
      return aib.pose.focal_error(cameras, truth.cameras, { over = "views" }).mre
    end, { better = "lower", convention = "mean over views" })
  end
  if method.batches[1].depth then score_batch_depth(fit, truth, how, input, cell, frames) end
  if has_surface(truth, cell) then score_batch_cloud(unit, fit, truth, files, how, input, cell) end
  if #fit.parts == 1 and not given then
    score_in_batches(fit.parts[1].batch.trajectory, unit.method.name, truth, input, cell)
  end
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

local function evaluate(unit, truth, files, input, cell, frames)
  if unit.result.output then return evaluate_output(unit, truth, files, input, cell, frames) end
  local models = models_of(unit.result, files)
  local scored = aib.submodels.largest(models)
  if unit.method.parameters == "ground truth" then
    cell:add("pose.auc30", nil, { better = "higher", note = "the poses are given" })
  elseif scored then
    score_models(models, truth, input, cell)
    score_in_batches(scored.trajectory, unit.method.name, truth, input, cell)
  end
  local frame = frame_of(unit, models, scored)
  if unit.result.depth then score_depth(unit, truth, files, frame, input, cell, frames) end
  if unit.result.cloud and has_surface(truth, cell) then score_cloud(unit, truth, files, frame, input, cell) end
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

--- What follows from all units together, in this run or in merged shards.
local function finish(input, report, parts, files)
  add_tables(report, input)
  state_conventions(report, input)
  add_sensitivity(report, parts, input.rule)
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
    check_batches(input, benchmark)
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
          truth.reference, truth.floor = reference_points(truth, input)
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
