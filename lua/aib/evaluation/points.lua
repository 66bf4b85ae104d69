-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Points of a method against the true surface, for the protocol asset_inspection.
local aib = require "aib"
local drawings = require "aib.evaluation.drawings"
local suggest = require "aib.suggest"

local M = {}

--- Points that stand for the true surface: given ones, or samples of the mesh, and the accuracy that a perfect cloud
--- gets against those.
function M.reference_points(truth, input)
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
function M.has_surface(truth, cell)
  if truth.reference then return true end
  cell:note("points: the scene has neither mesh nor points")
  return false
end

--- Adds the distances between a cloud in the frame of the truth and the true surface.
function M.add_cloud(all, truth, frame_how, input, cell)
  local cloud = aib.scene.cropped(truth, all)
  local compared = cell:attempt(function()
    local to_reference, to_estimate = aib.cloud.distances_both_ways(cloud, truth.reference)
    drawings.points(cell, cloud, truth, to_reference, to_estimate, input.tau)
    return aib.cloud.score(to_reference, to_estimate, { tau = input.tau })
  end, "points") or { precision = {}, recall = {}, f_score = {} }
  local sampled = not truth.points
  local how = suggest.with(frame_how, sampled and { samples = input.samples, seed = input.seed })
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

function M.score_cloud(unit, truth, files, frame, input, cell)
  local result = unit.result
  local all = result.cloud == "model" and frame.model.points or aib.scene.read_cloud(files, result.cloud)
  if not frame.scale then
    cell:note("points: they cannot be brought into the frame of the truth")
    return
  end
  M.add_cloud(frame.transform and frame.transform * all or all, truth, frame.how, input, cell)
end


return M
