-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- COLMAP's and GLOMAP's sub-models: a folder with models 0, 1, ..., or a model itself.
local aib = require "aib"
local failure = require "aib.failure"

local M = {}

local function is_model(folder)
  return aib.system.is_file(folder .. "/images.bin") or aib.system.is_file(folder .. "/images.txt")
end

local function read(folder, name)
  local model = aib.io.read_colmap(folder)
  return { name = name, trajectory = model.trajectory, cameras = model.cameras, points = model.points }
end

--- The models in a folder, { name =, trajectory =, cameras =, points = }, by number; the folder itself where it is one.
--- Raises an io error where there is none.
function M.read(folder)
  if is_model(folder) then return { read(folder, "0") } end
  local numbers = {}
  for _, name in ipairs(aib.system.names_in(folder)) do
    if name:find("^%d+$") and is_model(folder .. "/" .. name) then numbers[#numbers + 1] = math.tointeger(name) end
  end
  if #numbers == 0 then
    failure.raise("io", folder .. ": no COLMAP model (images.bin or images.txt) in it or its folders")
  end
  table.sort(numbers)
  local models = {}
  for i, number in ipairs(numbers) do models[i] = read(folder .. "/" .. number, tostring(number)) end
  return models
end

--- The model with most images; then that with more points, then the lower number. Never chosen by its score.
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
