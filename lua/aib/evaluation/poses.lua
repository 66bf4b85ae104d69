-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Poses and intrinsics of a method's models, for the protocol asset_inspection.
local aib = require "aib"
local drawings = require "aib.evaluation.drawings"
local suggest = require "aib.suggest"

local M = {}

--- The models that a method made of a scene: those of COLMAP or GLOMAP, or the one of a trajectory file.
function M.models_of(result, files)
  if result.models then return aib.submodels.read(files:whole_folder(result.models)) end
  if not result.poses then return {} end
  local cameras = result.cameras
  if type(cameras) == "string" then cameras = aib.io.read_cameras(files:file(cameras)) end
  local trajectory = aib.io.read_trajectory(files:file(result.poses))
  return { { name = "0", trajectory = trajectory, cameras = cameras, points = {} } }
end

--- Pairs each model's poses with the truth and aligns them: a Sim(3) of the camera positions. A model without
--- `alignment` says in `obstacle` why.
function M.align(models, truth, input)
  local trimmed = input.alignment == "trimmed"
  for _, model in ipairs(models) do
    model.est, model.ref = aib.pose.associate(model.trajectory, truth.trajectory, { by = "name" })
    model.how = { alignment = input.alignment, outlier_factor = trimmed and input.outlier_factor or nil }
    model.alignment, model.obstacle = aib.report:attempt(function()
      return aib.align.trajectory(model.est, model.ref, { mode = "sim3", outlier_factor = model.how.outlier_factor })
    end)
  end
end

local function score_alignment(model, cell)
  local alignment, how = model.alignment, model.how
  if not alignment then
    cell:note("no alignment to the truth: " .. model.obstacle)
    return
  end
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
    drawings.pose_recall(cell, auc, model.est, model.ref)
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

--- Position errors of aligned frames by name, for `frames` of a part: under the name of the record that they give.
function M.add_ape(frames, ape, ref)
  local names = aib.json.list()
  for i, place in ipairs(ape.index) do names[i] = ref.names[place] end
  frames["pose.ape_rmse"] = { names = names, values = aib.json.list(table.move(ape.errors, 1, #ape.errors, 1, {})) }
end

--- For each image of the scene whether it is registered, 1 or 0.
function M.add_registered(frames, trajectory, truth, rules)
  local names, values = aib.json.list(), aib.json.list()
  local is_missing = suggest.set(aib.pose.registration_rate(trajectory, truth.trajectory, rules).missing)
  for i, name in ipairs(truth.names) do names[i], values[i] = name, is_missing[name] and 0 or 1 end
  frames["pose.registration_rate"] = { names = names, values = values }
end

local function are_equal(values)
  for _, value in ipairs(values) do
    if value ~= values[1] then return false end
  end
  return true
end

--- Mean relative error of the focal lengths, over views; that of each goes to `frames`, unless they share one.
function M.add_focal(cameras, truth, cell, frames)
  local found
  cell:add("camera.focal_mre", function()
    found = aib.pose.focal_error(cameras, truth.cameras, { over = "views" })
    return found.mre
  end, { better = "lower", convention = "mean over views" })
  if not found or not frames then return end
  local names, values = aib.json.list(suggest.keys(found.each)), aib.json.list()
  for i, name in ipairs(names) do values[i] = found.each[name] end
  if not are_equal(values) then frames["camera.focal_mre"] = { names = names, values = values } end
end

local function score_model(model, truth, input, cell, frames)
  local registration = aib.pose.registration_rate(model.trajectory, truth.trajectory)
  cell:add("pose.registration_rate", registration.rate, { better = "higher", n = registration.n_total })
  cell:add("pose.n_registered", registration.n_registered, { better = "higher" })
  cell:add("pose.n_points", #model.points)
  score_angles(model, truth, input, cell)
  score_alignment(model, cell)
  drawings.cameras(cell, model, truth, registration)
  if model.cameras then M.add_focal(model.cameras, truth, cell, frames) end
end

--- Scores every model. The largest stands for the method, whatever its score; the others are groups of their own.
function M.score_models(models, truth, input, cell, frames)
  local scored = aib.submodels.largest(models)
  for _, model in ipairs(models) do
    local sub = #models > 1 and cell:within { model = model.name } or cell
    if model == scored then
      score_model(model, truth, input, cell, frames)
      M.add_registered(frames, model.trajectory, truth)
      if model.alignment then
        M.add_ape(frames, aib.pose.ape(model.alignment.transform * model.est, model.ref), model.ref)
      end
    end
    if #models > 1 then score_model(model, truth, input, sub) end
  end
  if #models > 1 then
    cell:note(("the largest of %d sub-models is scored, number %s"):format(#models, scored.name))
  end
end

return M
