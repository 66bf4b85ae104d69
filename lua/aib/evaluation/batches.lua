-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Methods that reconstruct in batches, for the protocol asset_inspection.
local aib = require "aib"
local depth = require "aib.evaluation.depth"
local failure = require "aib.failure"
local points = require "aib.evaluation.points"
local poses = require "aib.evaluation.poses"
local suggest = require "aib.suggest"

local M = {}

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
local function score_batch_poses(fit, given, truth, how, input, cell, frames)
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
    if frames then poses.add_ape(frames, ape.all, fit.moved.ref) end
    cell:add("pose.ape_rmse", ape.all.rmse, { unit = "m", better = "lower", n = ape.all.count, options = how })
    if ape.kept then
      cell:add("pose.ape_rmse_kept", ape.kept.rmse, { unit = "m", better = "lower", n = ape.kept.count, options = how })
    end
  end
end

--- Points of all batches, from their depth maps.
local function score_cloud_of_maps(unit, fit, truth, how, input, cell)
  local cut = { min_confidence = unit.result.confidence or input.confidence, stride = input.stride }
  local cloud, info = aib.batches.cloud(fit, cut)
  if #cloud == 0 then return end
  cell:add("cloud.share_kept", (info.n_valid - info.n_unsure) / info.n_valid, { n = info.n_valid })
  local rules = {}
  for _, p in ipairs(fit.parts) do rules[p.batch.confidence and p.batch.rule or "none"] = true end
  points.add_cloud(cloud, truth, suggest.with(how, {
    confidence = cut.min_confidence, confidence_rule = next(rules), stride = cut.stride,
  }), input, cell)
end

--- Points of all batches: from their depth maps, or the method's own cloud where it has one frame of reference.
local function score_batch_cloud(unit, fit, truth, files, how, input, cell)
  local part = fit.parts[1]
  if not unit.result.cloud or #fit.parts > 1 or not part.alignment then
    return score_cloud_of_maps(unit, fit, truth, how, input, cell)
  end
  local cloud = aib.scene.read_cloud(files, unit.result.cloud)
  points.add_cloud(part.alignment.transform * cloud, truth, how, input, cell)
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
function M.check_batches(input, benchmark)
  local known = {}
  for _, method in ipairs(benchmark.methods) do known[#known + 1] = method.name end
  for name in pairs(batch_sizes(input)) do
    local hint, found = suggest.hint(name, known), false
    for _, method in ipairs(known) do found = found or method == name end
    if not found then failure.usage(("--batch: unknown method '%s'%s"):format(name, hint)) end
  end
end

--- What an alignment depends on.
local function alignment_of(input)
  return { alignment = input.alignment, outlier_factor = input.alignment == "trimmed" and input.outlier_factor or nil }
end

--- A batch cut into batches of each size that is asked for, each aligned: list of { method =, fit =, how = }.
function M.in_batches(batch, method, truth, input)
  local list = {}
  for _, size in ipairs(batch and batch_sizes(input)[method] or {}) do
    local how = suggest.with(alignment_of(input), { batch = size })
    local fit = aib.batches.align(aib.batches.split(batch, truth.names, size), truth.trajectory,
      { outlier_factor = how.outlier_factor })
    if #fit.parts > 0 then
      list[#list + 1] = { method = ("%s, batches of %d"):format(method, size), fit = fit, how = how }
    end
  end
  return list
end

--- What each size of batches would score: poses, and points of the depth maps where there are any. The depth maps
--- themselves are scored with the others, as series of their own.
function M.score_in_batches(unit, opened, truth, input, cell)
  for _, cut in ipairs(opened.in_batches) do
    local sub = cell:within { method = cut.method }
    score_batch_poses(cut.fit, false, truth, cut.how, input, sub)
    report_batches(cut.fit, cut.how, sub)
    local batch = cut.fit.parts[1].batch
    if batch.cameras and batch.depth and points.has_surface(truth, sub) then
      score_cloud_of_maps(unit, cut.fit, truth, cut.how, input, sub)
    end
  end
end

--- What a method left, aligned to the truth, and where its depth maps are: { method =, fit =, given =, how =, names =
--- rules of names, in_batches =, depth = source | nil }.
function M.open(unit, truth, files, input, cell)
  local method = open_method(unit, truth, files, cell)
  local given = unit.method.parameters == "ground truth"
  for _, batch in ipairs(method.batches) do
    if not given and batch.trajectory and aib.method.poses_are_given(batch.trajectory, truth.trajectory) then
      given = true
      cell:note("its poses are the true ones, though the parameters are called estimated")
    end
  end
  local how = given and { alignment = "none" } or alignment_of(input)
  local names = name_rules(method.batches, truth)
  local fit = aib.batches.align(method.batches, truth.trajectory, {
    outlier_factor = how.outlier_factor, given = given, names = names,
  })
  local opened = { method = method, fit = fit, given = given, how = how, names = names, in_batches = {} }
  if #fit.parts == 0 then return opened end
  if #fit.parts == 1 and not given then
    opened.in_batches = M.in_batches(fit.parts[1].batch, unit.method.name, truth, input)
  end
  if method.batches[1].depth then opened.depth = depth.of_batches(fit, truth, how) end
  return opened
end

--- What needs all images of what a method left: poses, focal lengths, points.
function M.score(unit, opened, truth, files, input, cell, frames)
  local fit, how = opened.fit, opened.how
  if #fit.parts == 0 then
    cell:note("no pose of it is of an image of the scene")
    return
  end
  score_batch_poses(fit, opened.given, truth, how, input, cell, frames)
  if not opened.given then
    report_batches(fit, how, cell)
    poses.add_registered(frames, fit.est, truth, opened.names)
  end
  local cameras = aib.batches.cameras(opened.method.batches)
  if cameras and not opened.given then poses.add_focal(cameras, truth, cell, frames) end
  if points.has_surface(truth, cell) then score_batch_cloud(unit, fit, truth, files, how, input, cell) end
  M.score_in_batches(unit, opened, truth, input, cell)
end

return M
