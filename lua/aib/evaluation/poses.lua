-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Poses and intrinsics of a method's models, for the protocol asset_inspection.
local aib = require "aib"
local drawings = require "aib.evaluation.drawings"

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

local function score_model(model, truth, input, cell)
  local registration = aib.pose.registration_rate(model.trajectory, truth.trajectory)
  cell:add("pose.registration_rate", registration.rate, { better = "higher", n = registration.n_total })
  cell:add("pose.n_registered", registration.n_registered, { better = "higher" })
  cell:add("pose.n_points", #model.points)
  score_angles(model, truth, input, cell)
  score_alignment(model, cell)
  drawings.cameras(cell, model, truth, registration)
  if not model.cameras then return end
  cell:add("camera.focal_mre", function()
    return aib.pose.focal_error(model.cameras, truth.cameras, { over = "views" }).mre
  end, { better = "lower", convention = "mean over views" })
end

--- Scores every model. The largest stands for the method, whatever its score; the others are groups of their own.
function M.score_models(models, truth, input, cell)
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


return M
