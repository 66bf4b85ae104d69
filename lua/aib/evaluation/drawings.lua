-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What the pages of protocols show beside their tables. Nothing here is computed unless a page was asked for.
local aib = require "aib"

local M = {}

--- Sub-models are told in numbers alone.
local function is_drawn(cell) return cell:draws() and not cell.group.model end

local share_axis <const> = { label = "share of pairs", low = 0, high = 1 }

local recall_texts <const> = {
  rotation = "Frame pairs whose relative rotation is off by less.",
  direction = "Frame pairs whose direction of translation is off by less.",
  both = "Frame pairs of which neither is off by more.",
}

--- Recall of relative rotations, directions and both against the angle.
function M.pose_recall(cell, auc, est, ref)
  if not is_drawn(cell) then return end
  local edges = {}
  for tau = 1, auc.max_deg do edges[tau] = tau end
  local counts = aib.pose.pair_histogram(est, ref, { rotation = edges, translation = edges })
  local angles, recall = { 0 }, { rotation = { 0 }, direction = { 0 }, both = { 0 } }
  local below = 0
  for tau = 1, auc.max_deg do
    for k = 1, tau do
      below = below + counts.counts[tau][k]
      if k < tau then below = below + counts.counts[k][tau] end
    end
    angles[tau + 1] = tau
    recall.rotation[tau + 1], recall.direction[tau + 1] = auc.rra[tau], auc.rta[tau]
    recall.both[tau + 1] = below / counts.n_pairs
  end
  for _, part in ipairs { "rotation", "direction", "both" } do
    cell:curve { title = ("Relative poses, recall of %s"):format(part),
      x = { label = "threshold", unit = "deg", low = 0, high = auc.max_deg }, y = share_axis, at = angles,
      values = recall[part], text = recall_texts[part] }
  end
end

--- Positions of poses in space and their errors along the way; names are those of the frames, or their places. The
--- estimate is aligned to the reference and paired with it.
function M.trajectory(cell, est, ref)
  if not cell:draws() then return end
  local names, errors = {}, {}
  local ape = aib.pose.ape(est, ref)
  for i, place in ipairs(ape.index) do
    names[i] = ref.names[place] or ("%06d"):format(place)
    errors[names[i]] = ape.errors[i]
  end
  cell:timeline { title = "Position, error along the way", y = { label = "APE", unit = "m" }, frames = names,
    values = ape.errors }
  cell:cameras { estimate = est, reference = ref, errors = errors }
end

--- The two axes along which positions spread the most, in their order.
local function widest_axes(positions)
  local spread = {}
  for k = 1, 3 do
    local low, high = math.huge, -math.huge
    for _, p in ipairs(positions) do low, high = math.min(low, p[k]), math.max(high, p[k]) end
    spread[k] = high - low
  end
  if spread[1] <= math.min(spread[2], spread[3]) then return 2, 3 end
  return 1, spread[2] <= spread[3] and 3 or 2
end

--- A path as a line over the two axes along which the reference spreads the most. `cell` is that of the method, or of
--- all for the reference itself.
function M.path(cell, trajectory, reference, label)
  if not cell:draws() then return end
  local a, b = widest_axes(reference:positions())
  local at, values = {}, {}
  for i, p in ipairs(trajectory:positions()) do at[i], values[i] = p[a], p[b] end
  local names = { "x", "y", "z" }
  cell:curve { title = "Paths", label = label, x = { label = names[a], unit = "m" },
    y = { label = names[b], unit = "m" }, at = at, values = values, equal = true }
end

--- Position errors along the flight, { names =, values = }.
function M.pose_series(cell, ape)
  if not ape or not cell:draws() then return end
  cell:timeline { title = "Camera position, error along the flight", y = { label = "APE", unit = "m" },
    frames = ape.names, values = ape.values }
end

--- Cameras in space, in the colours of their errors.
function M.cameras(cell, model, truth, registration)
  if not is_drawn(cell) or not model.alignment then return end
  local transform = model.alignment.transform
  local ape = aib.pose.ape(transform * model.est, model.ref)
  local errors = {}
  for i, place in ipairs(ape.index) do errors[model.ref.names[place]] = ape.errors[i] end
  cell:cameras { estimate = transform * model.trajectory, reference = truth.trajectory,
    missing = registration.missing, errors = errors }
  if truth.mesh then cell:mesh { mesh = truth.mesh } end
end

local most_frames <const> = 60

--- The names whose frames a page has: all, or so many, evenly spread.
function M.chosen(names)
  local set, stride = {}, math.max(1, #names / most_frames)
  for k = 0, math.min(#names, most_frames) - 1 do set[names[math.floor(k * stride) + 1]] = true end
  return set
end

--- A frame's panels, where `chosen` has its name.
function M.frame(cell, chosen, name, est, ref, transform)
  if not cell or not cell:draws() or not chosen[name] then return end
  cell:attempt(function() cell:frame { name = name, estimate = est, reference = ref, transform = transform } end)
end

--- A field of frames along the flight, of those that have it; `label` where others are in the same figure.
function M.series(cell, title, y, frames, field, label)
  if not cell:draws() then return end
  local names, values = {}, {}
  for _, frame in ipairs(frames) do
    if frame[field] then names[#names + 1], values[#values + 1] = frame.name, frame[field] end
  end
  if #names > 0 then cell:timeline { title = title, label = label, y = y, frames = names, values = values } end
end

--- Errors and coverage of depth along the flight.
function M.depth_series(cell, frames)
  M.series(cell, "Depth, sRMSE along the flight", { label = "sRMSE" }, frames, "srmse")
  M.series(cell, "Depth, coverage along the flight", { label = "coverage", low = 0, high = 1 }, frames, "coverage")
end

--- Adds how a frame's confidence foretells its errors to `curves`.
function M.add_risk(cell, curves, est, ref, confidence, transform)
  if not confidence or not cell:draws() then return end
  local curve = cell:attempt(function()
    return aib.depth.risk_coverage(est, ref, confidence, { transform = transform })
  end)
  curves[#curves + 1] = curve
end

local function mean_of(curves, field)
  local mean = {}
  for i = 1, #curves[1][field] do
    local sum = 0
    for _, curve in ipairs(curves) do sum = sum + curve[field][i] end
    mean[i] = sum / #curves
  end
  return mean
end

--- Mean error of the most confident pixels against their share, over frames.
function M.risk(cell, curves)
  if #curves == 0 then return end
  for _, part in ipairs { { "risk", "by confidence" }, { "oracle", "by error" } } do
    cell:curve { title = "Depth, risk against coverage", label = part[2], at = curves[1].coverage,
      x = { label = "share of pixels kept", low = 0, high = 1 }, y = { label = "mean relative error" },
      values = mean_of(curves, part[1]), text = "The nearer to the order by error, the better the confidence." }
  end
end

local n_taus <const> = 40

--- Thresholds in equal ratios.
local function taus_between(low, high)
  local taus = {}
  for i = 1, n_taus do taus[i] = low * (high / low) ^ ((i - 1) / (n_taus - 1)) end
  return taus
end

local function shares(distances, taus)
  local list = {}
  for i, tau in ipairs(taus) do list[i] = distances:share_below(tau) end
  return list
end

local function harmonic(a, b)
  local list = {}
  for i, x in ipairs(a) do list[i] = x + b[i] > 0 and 2 * x * b[i] / (x + b[i]) or 0 end
  return list
end

local n_bins <const> = 50

--- Densities of distances up to a bound, at the right ends of their bins.
local function histogram(cell, title, distances, high, unit)
  local h = distances:histogram { max = high, bins = n_bins }
  local at, values = { 0 }, { 0 }
  for i, count in ipairs(h.counts) do at[i + 1], values[i + 1] = i * h.width, count / #distances end
  cell:curve { title = title, x = { label = "distance", unit = unit }, y = { label = "share of points" }, at = at,
    values = values, steps = true, text = ("%d bins up to %g %s."):format(n_bins, high, unit) }
end

--- Shares of points against a threshold, a figure each; `curves` = { { "Precision", shares }, ... }.
function M.against_threshold(cell, at, curves, unit)
  if not cell:draws() then return end
  for _, curve in ipairs(curves) do
    cell:curve { title = curve[1] .. " against the threshold",
      x = { label = "threshold", unit = unit or "m", scale = "log" },
      y = { label = curve[1]:lower(), low = 0, high = 1 }, at = at, values = curve[2] }
  end
end

--- Histograms of the distances up to a bound, and both clouds in their colours.
function M.errors_of_points(cell, cloud, reference, to_reference, to_estimate, high, unit)
  if not cell:draws() then return end
  unit = unit or "m"
  histogram(cell, "Accuracy, histogram", to_reference, high, unit)
  histogram(cell, "Completeness, histogram", to_estimate, high, unit)
  cell:cloud { role = "estimate", cloud = cloud, values = to_reference, label = "distance to the truth", unit = unit }
  cell:cloud { role = "reference", cloud = reference, values = to_estimate, label = "distance to the estimate",
    unit = unit, limit = 30000 }
end

--- Enough to colour faces by; the numbers of the tables are of all samples.
local n_face_samples <const> = 10000

local function draw_mesh(cell, cloud, truth)
  local faces = {}
  if not truth.points then
    local samples = aib.cloud.random_subset(truth.reference, n_face_samples)
    local scores = aib.mesh.face_scores(cloud, truth.mesh, { samples = samples })
    faces = { { label = "completeness", unit = "m", values = scores.completeness },
      { label = "accuracy", unit = "m", values = scores.accuracy } }
  end
  cell:mesh { mesh = truth.mesh, faces = faces }
end

--- Precision, recall and F-score against the threshold, histograms, and the geometry in the colours of its errors.
--- `taus` are the protocol's thresholds; `unit` is that of the clouds, metres where none is told.
function M.points(cell, cloud, truth, to_reference, to_estimate, taus, unit)
  if not cell:draws() then return end
  local middle = math.max(taus[#taus // 2 + 1] or 0.05, 1e-9)
  local at = taus_between(middle / 20, middle * 20)
  local precision, recall = shares(to_reference, at), shares(to_estimate, at)
  M.against_threshold(cell, at, { { "Precision", precision }, { "Recall", recall },
    { "F-score", harmonic(precision, recall) } }, unit)
  M.errors_of_points(cell, cloud, truth.reference, to_reference, to_estimate, 10 * middle, unit)
  if truth.mesh then draw_mesh(cell, cloud, truth) end
end

return M
