-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Batches of a method (aib.method.open), each in a frame and scale of its own, against the truth.
---
---   local fit = aib.batches.align(method.batches, truth.trajectory, { outlier_factor = 3 })
---   for _, part in ipairs(fit.parts) do print(part.name, part.alignment and part.alignment.transform.scale) end
---   print(aib.batches.auc(fit).cross.auc)
local aib = require "aib"
local suggest = require "aib.suggest"

local M = {}

local align_fields <const> = {
  outlier_factor = true, outlier_distance = true, robust = true, rotation_weight = true, convention = true, seed = true,
  given = true, names = true,
}

--- Appends the poses and names of a trajectory to lists.
local function append(poses, names, trajectory)
  for i, name in ipairs(trajectory.names) do
    poses[#poses + 1], names[#names + 1] = trajectory[i], name
  end
end

--- The frames of all batches in one trajectory each for estimate and truth, with the batch of every frame.
local function collected(batches, truth, rules)
  local fit = { parts = {}, batch = {} }
  local est, ref, est_names, ref_names = {}, {}, {}, {}
  for _, batch in ipairs(batches) do
    if batch.trajectory then
      local e, r = aib.pose.associate(batch.trajectory, truth, rules)
      if #e > 0 then
        fit.parts[#fit.parts + 1] = { name = batch.name, batch = batch, est = e, ref = r, first = #est + 1 }
        append(est, est_names, e)
        append(ref, ref_names, r)
        fit.parts[#fit.parts].last = #est
        for _ = 1, #e do fit.batch[#fit.batch + 1] = #fit.parts end
      end
    end
  end
  fit.est = aib.pose.trajectory(est, { names = est_names })
  fit.ref = aib.pose.trajectory(ref, { names = ref_names })
  return fit
end

--- Marks every batch as aligned by nothing: its poses are in the frame of the truth already.
local function leave(fit)
  for _, part in ipairs(fit.parts) do
    part.alignment = {
      transform = aib.math.sim3(), n_inliers = #part.est, outliers = {}, warnings = {}, is_given = true,
      rmse = aib.pose.ape(part.est, part.ref).rmse,
    }
  end
end

local function fit_parts(fit, options)
  local sizes = {}
  for i, part in ipairs(fit.parts) do sizes[i] = #part.est end
  local how = { mode = "sim3", sizes = sizes }
  for _, key in ipairs { "outlier_factor", "outlier_distance", "robust", "rotation_weight", "convention", "seed" } do
    how[key] = options[key]
  end
  for i, alignment in ipairs(aib.align.batches(fit.est, fit.ref, how)) do
    local part = fit.parts[i]
    part.seam, part.half_rmse, part.degenerate = alignment.seam, alignment.half_rmse, alignment.degenerate
    if not alignment.degenerate then part.alignment = alignment end
  end
end

--- Frames of batches with an alignment, moved by it, and the truth's; `batch` is that of each.
local function moved(fit)
  local est, ref, names, ref_names, batch, kept = {}, {}, {}, {}, {}, {}
  for k, part in ipairs(fit.parts) do
    if part.alignment then
      local outlier = suggest.set(part.alignment.outliers)
      append(est, names, part.alignment.transform * part.est)
      append(ref, ref_names, part.ref)
      for i = part.first, part.last do
        batch[#batch + 1] = k
        if not outlier[i] then kept[#kept + 1] = #batch end
      end
    end
  end
  return {
    est = aib.pose.trajectory(est, { names = names }), ref = aib.pose.trajectory(ref, { names = ref_names }),
    batch = batch, kept = kept,
  }
end

--- Aligns every batch to the truth by a Sim(3) of camera positions of its own, after outliers are removed.
---
---   outlier_factor, outlier_distance, robust, rotation_weight, convention, seed   as aib.align.trajectory
---   given   the poses are in the frame of the truth: nothing is fitted
---   names   rules of names: { ignore_folder =, ignore_extension =, ignore_case = }
---
--- Returns
---   parts   { name =, batch =, est =, ref =, first =, last =, alignment = | degenerate = why, half_rmse =, seam = }
---   est, ref, batch   all frames as they are, with the place of each one's part
---   moved   { est =, ref =, batch =, kept = }: frames of aligned batches in the truth's frame; kept: no outliers
function M.align(batches, truth, options)
  options = options or {}
  suggest.check_keys("aib.batches.align", options, align_fields, 2)
  local fit = collected(batches, truth, suggest.with({ by = "name" }, options.names))
  if options.given then leave(fit) else fit_parts(fit, options) end
  fit.moved = moved(fit)
  return fit
end

--- AUC over the pairs within batches (of all batches: no alignment has a part in it), across them, and over all pairs
--- of aligned batches. What has no pair is nil.
function M.auc(fit, options)
  local how = { convention = options and options.convention, max_deg = options and options.max_deg }
  local out = {}
  if #fit.est > 1 then out.intra = aib.pose.auc_by_batch(fit.est, fit.ref, fit.batch, how).intra end
  local m = fit.moved
  if #m.est > 1 then
    local cross = aib.pose.auc_by_batch(m.est, m.ref, m.batch, how).cross
    if cross.n_pairs > 0 then out.cross = cross end
    out.all = aib.pose.auc(m.est, m.ref, how)
  end
  return out
end

--- Position errors of the frames of aligned batches: { all = summary, kept = summary without outliers }; nil of none.
function M.ape(fit)
  local m = fit.moved
  if #m.est == 0 then return nil end
  local kept = #m.kept > 0 and aib.pose.ape(m.est:select(m.kept), m.ref:select(m.kept)) or nil
  return { all = aib.pose.ape(m.est, m.ref), kept = kept }
end

--- The cut of a confidence: the number that one must exceed, and the rule. A percentile is of the whole batch where its
--- confidences lie in one array, else of each map.
local function cut_of(batch, options)
  local rule = options.rule or batch.rule
  if rule ~= "percentile" or not batch.confidence_quantile then return options.min_confidence, rule end
  local at = batch.confidence_quantile(options.min_confidence)
  return at - 5e-8 * math.abs(at), "raw"  -- less than half a step of a float: the quantile itself is kept
end

--- The points of a batch in its own frame, from its depth maps (or point maps), and { n_valid =, n_unsure = }.
---
---   min_confidence   points are kept strictly above it; of a percentile from it on; default: all
---   rule             instead of the method's: "raw" | "sigmoid" | "percentile"
---   stride           every stride-th row and column
---   pixel_offset     where in its pixel a depth lies, 0.5
function M.points(batch, options)
  options = options or {}
  local cut, rule = options.min_confidence, nil
  if cut and batch.confidence then cut, rule = cut_of(batch, options) else cut = nil end
  local clouds, info = {}, { n_valid = 0, n_unsure = 0 }
  for i, name in ipairs(batch.names) do
    local pose = batch.trajectory[i]
    local how = { confidence = cut and batch.confidence(i), min_confidence = cut, rule = rule, stride = options.stride }
    local points, counts
    if pose.is_registered and batch.point_map then
      points, counts = aib.sample.point_map(batch.point_map(i), pose, how)
    elseif pose.is_registered and batch.depth and batch.cameras then
      how.pixel_offset = options.pixel_offset
      local depth <close> = batch.depth(i)
      if depth then points, counts = aib.sample.unproject(depth, batch.cameras[name], pose, how) end
    end
    if points then
      clouds[#clouds + 1] = points
      info.n_valid, info.n_unsure = info.n_valid + counts.n_valid, info.n_unsure + counts.n_unsure
    end
  end
  return aib.cloud.joined(clouds), info
end

--- The points of all aligned batches in the frame of the truth, as M.points makes them, and their counts.
function M.cloud(fit, options)
  local clouds, info = {}, { n_valid = 0, n_unsure = 0, n_batches = 0 }
  for _, part in ipairs(fit.parts) do
    if part.alignment then
      local points, counts = M.points(part.batch, options)
      clouds[#clouds + 1] = part.alignment.transform * points
      info.n_valid, info.n_unsure = info.n_valid + counts.n_valid, info.n_unsure + counts.n_unsure
      info.n_batches = info.n_batches + 1
    end
  end
  return aib.cloud.joined(clouds), info
end

--- Cameras of all batches by image name; nil where there are none.
function M.cameras(batches)
  local all
  for _, batch in ipairs(batches) do
    for name, camera in pairs(batch.cameras or {}) do
      all = all or {}
      all[name] = camera
    end
  end
  return all
end

--- Part of a batch: the frames of some places.
local function part_of(batch, places, name)
  local names = {}
  for i, place in ipairs(places) do names[i] = batch.names[place] end
  local function at(f) return f and function(i) return f(places[i]) end end
  return {
    name = name, names = names, named = batch.named, cameras = batch.cameras, rule = batch.rule,
    trajectory = batch.trajectory:select(places), depth = at(batch.depth), confidence = at(batch.confidence),
    point_map = at(batch.point_map), warnings = {},
  }
end

--- Cuts one batch into batches of `size` consecutive images of the scene (`names`, in their order): how a method that
--- has one frame of reference would fare if it were treated as a batched one is.
function M.split(batch, names, size)
  if math.type(size) ~= "integer" or size < 1 then error("aib.batches.split: size: an integer above 0 expected", 2) end
  local place, parts, order = {}, {}, {}
  for i, name in ipairs(batch.names) do place[name] = i end
  for i, name in ipairs(names) do
    local k = (i - 1) // size
    if place[name] then
      if not parts[k] then parts[k], order[#order + 1] = {}, k end
      table.insert(parts[k], place[name])
    end
  end
  local out = {}
  for i, k in ipairs(order) do out[i] = part_of(batch, parts[k], ("%d"):format(k)) end
  return out
end

return M
