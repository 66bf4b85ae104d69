-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Any other method, by a table that says where things lie in the folder:
---
---   poses       file or folder, any format that aib.io.read_trajectory reads; format, convention, axes, key and
---               quaternion are its options
---   cameras     file or folder with intrinsics (default: none)
---   names       list, or a text file with one a line
---   depth       pattern of files, {stem}, {name} and {index} (from 0; {index:6} with zeros) stand for the image; or
---               { file =, key = }: one NPY or NPZ array for all
---   confidence  the same          rule   "raw" | "sigmoid" | "percentile": what a confidence is
---   points      point cloud
local aib = require "aib"
local failure = require "aib.failure"
local kit = require "aib.methods.kit"
local suggest = require "aib.suggest"

local fields <const> = {
  poses = true, format = true, convention = true, axes = true, key = true, quaternion = true, cameras = true,
  names = true, depth = true, confidence = true, rule = true, points = true,
}

--- The path that a pattern gives frame i.
local function expanded(pattern, name, i)
  local path = pattern:gsub("{index:?(%d*)}", function(width)
    return width == "" and tostring(i - 1) or ("%0" .. width .. "d"):format(i - 1)
  end)
  return aib.files.expand(path, name)
end

--- A function that reads frame i, and how many frames there are where the source tells it.
local function maps(folder, source, names)
  if not source then return nil end
  if type(source) == "table" then
    local stack = aib.io.open_stack(folder .. "/" .. source.file, { key = source.key or "" })
    return function(i) return stack[i] end, #stack
  end
  return function(i)
    local path = folder .. "/" .. expanded(source, names()[i], i)
    return aib.system.is_file(path) and aib.io.read_depth(path) or nil
  end
end

local function trajectory_of(folder, layout, names)
  if not layout.poses then return nil end
  return aib.io.read_trajectory(folder .. "/" .. layout.poses, {
    format = layout.format, convention = layout.convention, axes = layout.axes, key = layout.key,
    quaternion = layout.quaternion, names = names,
  })
end

local M = { kind = "layout" }

function M.open(folder, options)
  local layout = options.layout
  suggest.check_keys("aib.method.open: layout", layout, fields, 3)
  local batch = { rule = layout.rule or "raw" }
  local names = options.names or layout.names
  if type(names) == "string" then names = kit.read_names(folder .. "/" .. names) end
  local function names_of() return batch.names end
  local n, n_confidence
  batch.depth, n = maps(folder, layout.depth, names_of)
  batch.confidence, n_confidence = maps(folder, layout.confidence, names_of)
  if n and n_confidence and n ~= n_confidence then
    failure.raise("format", ("%s: %d depth maps, but %d confidences"):format(folder, n, n_confidence))
  end
  batch.trajectory = trajectory_of(folder, layout, names)
  if batch.trajectory and #batch.trajectory.names > 0 then names = names or batch.trajectory.names end
  n = n or batch.trajectory and #batch.trajectory or names and #names
  if not n then failure.raise("argument", "aib.method.open: layout: poses, names or a depth array expected") end
  batch.names, batch.named = kit.names(folder, n, { names = names })
  if batch.trajectory and #batch.trajectory.names == 0 then
    batch.trajectory = trajectory_of(folder, layout, batch.names)
  end
  if layout.cameras then
    batch.cameras = aib.io.read_cameras(folder .. "/" .. layout.cameras, { names = batch.names })
  end
  if layout.points then batch.points = kit.cloud(folder .. "/" .. layout.points) end
  return batch
end

return M
