-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What adapters of methods share: files of a folder by their numbers, lists of names, one NPZ file as a batch.
local aib = require "aib"
local failure = require "aib.failure"
local suggest = require "aib.suggest"

local M = {}

function M.exists(folder, name) return aib.system.is_file(folder .. "/" .. name) end

--- The first of some names that is a file in the folder, nil where none is.
function M.first_of(folder, names)
  for _, name in ipairs(names) do
    if M.exists(folder, name) then return name end
  end
end

--- Names of the files of a folder that match a Lua pattern with one number in it, by that number; {} where the folder
--- is none. frame_2 stands before frame_10.
function M.numbered(folder, pattern)
  if not aib.system.is_folder(folder) then return {} end
  local found = {}
  for _, name in ipairs(aib.system.names_in(folder)) do
    local number = tonumber((name:match(pattern)))
    if number then found[#found + 1] = { number = number, name = name } end
  end
  table.sort(found, function(a, b) return a.number < b.number or a.number == b.number and a.name < b.name end)
  for i, entry in ipairs(found) do found[i] = entry.name end
  return found
end

--- The lines of a list of names that are not blank.
function M.read_names(path)
  local names = {}
  for line in aib.system.read_text(path):gmatch "[^\r\n]+" do
    if line:find "%S" then names[#names + 1] = line:match "^%s*(.-)%s*$" end
  end
  return names
end

--- The names of n frames: those that are given, else of names.txt in the folder, else the indices from 0. The second
--- value says whether they were told.
function M.names(folder, n, options)
  local names = options.names
  if not names and M.exists(folder, "names.txt") then names = M.read_names(folder .. "/names.txt") end
  if names then
    if #names ~= n then failure.raise("format", ("%s: %d frames, but %d names"):format(folder, n, #names)) end
    return names, true
  end
  names = {}
  for i = 1, n do names[i] = tostring(i - 1) end
  return names, false
end

--- The set of the arrays in an NPZ file; empty where there is no such file.
function M.arrays(path)
  if not aib.system.is_file(path) then return {} end
  return suggest.set(aib.io.array_names(path))
end

local function any_of(set, names)
  for _, name in ipairs(names) do
    if set[name] then return name end
  end
end

local pose_keys <const> = { "extrinsics", "exts", "extrinsic", "camera_poses", "cam_c2w", "pose", "c2w", "w2c" }
local camera_keys <const> = { "intrinsics", "ixts", "intrinsic", "K" }

--- A function of the frame's number that opens the file when it is first called.
local function lazily(path, key)
  local stack
  return function(i)
    stack = stack or aib.io.open_stack(path, { key = key })
    return stack[i]
  end
end

--- Cameras of the frames by name, where poses are missing and thus no reader knows their number.
local function cameras_of(path, names, has)
  if not any_of(has, camera_keys) or not any_of(has, pose_keys) then return nil end
  return aib.io.read_cameras(path, { names = names })
end

--- The batch of an NPZ file with one array for all depth maps (or point maps) and one for all poses.
---
---   depth, confidence   names of the arrays          rule   "raw" | "sigmoid": what a confidence is
function M.stack_batch(folder, path, keys, options)
  local has = M.arrays(path)
  local frames = aib.io.open_stack(path, { key = keys.depth })
  local names, told = M.names(folder, #frames, options)
  local batch = {
    names = names, named = told, depth = lazily(path, keys.depth), cameras = cameras_of(path, names, has),
    confidence = has[keys.confidence] and lazily(path, keys.confidence) or nil, rule = keys.rule or "raw",
    confidence_quantile = has[keys.confidence] and function(q)
      return aib.io.open_stack(path, { key = keys.confidence }):quantile(q)
    end or nil,
  }
  if any_of(has, pose_keys) then batch.trajectory = aib.io.read_trajectory(path, { names = names }) end
  if keys.depth == "local_points" then batch.point_map = function(i) return frames:array(i) end end
  return batch
end

--- The batch of a folder with a file for every depth map.
---
---   depth, confidence   functions of the frame's number; confidences are raw
---   poses, how          what aib.io.read_trajectory reads, and its options
---   cameras             file or folder of aib.io.read_cameras, nil where there is none
function M.frame_batch(folder, n, source, options)
  local names, told = M.names(folder, n, options)
  local batch = { names = names, named = told, rule = "raw", depth = source.depth, confidence = source.confidence,
    trajectory = aib.io.read_trajectory(source.poses, suggest.with({ names = names }, source.how)) }
  if source.cameras then
    local first <close> = source.depth(1)
    batch.cameras = M.sized(aib.io.read_cameras(source.cameras, { names = names }), first)
  end
  return batch
end

--- A cloud that is read at its first use.
function M.cloud(path)
  local cloud
  return function()
    cloud = cloud or aib.io.read_cloud(path)
    return cloud
  end
end

--- A camera of a 3 x 3 matrix, row by row, in pixels.
function M.pinhole(k, width, height)
  return aib.math.camera { model = "PINHOLE", width = width, height = height,
    parameters = { k[1], k[5], k[3], k[6] } }
end

--- Cameras whose source does not say their size: that of a depth map.
function M.sized(cameras, map)
  local sized = {}
  for name, c in pairs(cameras) do
    sized[name] = aib.math.camera { model = c.model, width = map.width, height = map.height,
      parameters = c.parameters }
  end
  return sized
end

local function finite(word)
  local x = tonumber(word)
  return x and math.abs(x) < math.huge and x or nil
end

--- The lines of a text that are not empty, as rows of n numbers.
function M.number_lines(path, n)
  local rows, number = {}, 0
  for line in aib.system.read_text(path):gmatch "([^\n]*)\n?" do
    local row, n_words = {}, 0
    number = number + 1
    for word in line:gmatch "%S+" do
      n_words, row[#row + 1] = n_words + 1, finite(word)
    end
    if n_words > 0 then
      if n_words ~= n or #row ~= n then
        failure.raise("format", ("%s:%d: %d numbers expected, found '%s'"):format(path, number, n, line))
      end
      rows[#rows + 1] = row
    end
  end
  return rows
end

return M
