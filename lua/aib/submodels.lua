-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- COLMAP's and GLOMAP's sub-models of one scene.
local aib = require "aib"

local M = {}

--- The models in a folder, as aib.io.read_colmap_models gives them, each with its `name`: that of its folder.
function M.read(folder)
  local models = aib.io.read_colmap_models(folder)
  for _, model in ipairs(models) do model.name = model.path:match("[^/]*$") end
  return models
end

--- The model with most images; then that with more points, then the first. Never chosen by its score. Nil for none.
function M.largest(models)
  local best
  for _, model in ipairs(models) do
    local more = not best or #model.trajectory > #best.trajectory
    local equal = best and #model.trajectory == #best.trajectory
    if more or equal and #(model.points or {}) > #(best.points or {}) then best = model end
  end
  return best
end

--- How many frames of a truth the models register: { largest =, each =, merged = }, each as
--- aib.pose.registration_rate tells it. `models` have a `trajectory` each; `options` are rules of names.
function M.registration(models, truth, options)
  local largest, each, all = M.largest(models), {}, {}
  local of_largest
  for i, model in ipairs(models) do
    all[i] = model.trajectory
    each[i] = aib.pose.registration_rate(model.trajectory, truth, options)
    if model == largest then of_largest = each[i] end
  end
  return { largest = of_largest, each = each, merged = aib.pose.registration_rate(all, truth, options) }
end

return M
