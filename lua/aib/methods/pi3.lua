-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- pi3: the dictionary of its network (local_points, conf as logits, camera_poses world_from_camera) or what its demo
--- saves (points in the world, conf after the sigmoid). There are no intrinsics.
local aib = require "aib"
local kit = require "aib.methods.kit"

local function find(folder)
  local demo
  for _, name in ipairs(aib.system.names_in(folder)) do
    local has = name:find "%.npz$" and kit.arrays(folder .. "/" .. name) or {}
    if has.camera_poses and has.local_points then return name .. " with camera_poses and local_points", name, true end
    if has.camera_poses and has.points then demo = name end
  end
  if demo then return demo .. " with camera_poses and points", demo, false end
end

--- Logits go below 0 or above 1 somewhere.
local function rule_of(map)
  for row = 1, map.height do
    for column = 1, map.width do
      local value = map:at(column, row)
      if value < 0 or value > 1 then return "sigmoid" end
    end
  end
  return "raw"
end

--- Planar depth of points in the world.
local function depth_of(points, pose)
  local m, height, width = pose:inverse():matrix()[3], points.shape[1], points.shape[2]
  local rows = {}
  for y = 1, height do
    local row = {}
    for x = 1, width do
      local at = 3 * ((y - 1) * width + x - 1)
      local z = m[1] * points[at + 1] + m[2] * points[at + 2] + m[3] * points[at + 3] + m[4]
      row[x] = z == z and z or 0
    end
    rows[y] = row
  end
  return aib.depth.map(rows)
end

return {
  kind = "pi3",
  find = find,
  open = function(folder, options)
    local _, name, is_local = find(folder)
    local path = folder .. "/" .. name
    local batch = kit.stack_batch(folder, path, {
      depth = is_local and "local_points" or "points", confidence = "conf",
    }, options)
    if batch.confidence then batch.rule = rule_of(batch.confidence(1)) end
    if not is_local then
      local stack = aib.io.open_stack(path, { key = "points" })
      batch.depth = function(i) return depth_of(stack:array(i), batch.trajectory[i]) end
    end
    return batch
  end,
}
