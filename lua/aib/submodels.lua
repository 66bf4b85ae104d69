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
    if more or equal and #model.points > #best.points then best = model end
  end
  return best
end

return M
