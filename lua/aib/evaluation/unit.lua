-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- One scene x condition x method of the protocol asset_inspection: what its parts share is opened once, then what
--- needs all images is scored, or a range of them, image by image.
local aib = require "aib"
local batches = require "aib.evaluation.batches"
local depth = require "aib.evaluation.depth"
local points = require "aib.evaluation.points"
local poses = require "aib.evaluation.poses"

local M = {}

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

--- A model as a batch, with the method's depth maps where they are in its frame. They are remembered by opened.files.
local function batch_of(unit, opened)
  local model, pattern = opened.scored, unit.result.depth
  local batch = { names = model.trajectory.names, trajectory = model.trajectory, cameras = model.cameras, rule = "raw" }
  if not pattern or not opened.frame.transform or opened.frame.model ~= model then return batch end
  function batch.depth(i)
    local path = opened.files:path(aib.files.expand(pattern, batch.names[i]))
    return aib.system.is_file(path) and aib.io.read_depth(opened.files:frame(pattern, batch.names[i])) or nil
  end
  return batch
end

--- What the models of COLMAP, GLOMAP or of a trajectory file are, aligned to the truth, and where the depth maps are.
local function open_models(unit, truth, files, input)
  local opened = { models = poses.models_of(unit.result, files), in_batches = {} }
  poses.align(opened.models, truth, input)
  opened.scored = aib.submodels.largest(opened.models)
  opened.frame = frame_of(unit, opened.models, opened.scored)
  if opened.scored and unit.method.parameters == "estimated" then
    opened.in_batches = batches.in_batches(batch_of(unit, opened), unit.method.name, truth, input)
  end
  if unit.result.depth then
    opened.depth = depth.of_files(unit.result.depth, truth, files, opened.frame.scale, opened.frame.how)
  end
  return opened
end

--- Opens a unit against its scene; `files` remembers what was read. Notes that belong to it are kept in `notes`.
function M.open(unit, truth, files, input)
  local log = aib.report.new { name = "opened" }
  local opened = unit.result.output and batches.open(unit, truth, files, input, log)
    or open_models(unit, truth, files, input)
  opened.notes = log:notes()
  for _, cut in ipairs(opened.depth and opened.in_batches or {}) do
    depth.add_series(opened.depth, cut.method, cut.fit, cut.how)
  end
  return opened
end

local function score_models(unit, opened, truth, files, input, cell, frames)
  if unit.method.parameters == "ground truth" then
    cell:add("pose.auc30", nil, { better = "higher", note = "the poses are given" })
  elseif opened.scored then
    poses.score_models(opened.models, truth, input, cell, frames)
    batches.score_in_batches(unit, opened, truth, input, cell)
  end
  if unit.result.cloud and points.has_surface(truth, cell) then
    points.score_cloud(unit, truth, files, opened.frame, input, cell)
  end
end

--- Scores what needs all images; `files` remembers what it reads, `frames` takes numbers of single images.
function M.score(unit, opened, truth, files, input, cell, frames)
  opened.files = files
  for _, note in ipairs(opened.notes) do cell:note(note.text) end
  local score = unit.result.output and batches.score or score_models
  score(unit, opened, truth, files, input, cell, frames)
  if opened.depth then depth.draw(opened.depth, truth, input, cell, files) end
end

--- The numbers of a range of images.
function M.rows(opened, range, truth, input, files)
  return opened.depth and depth.rows(opened.depth, range, truth, input, files) or aib.json.list()
end

return M
