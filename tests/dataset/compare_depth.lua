-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Blender's depth against the ray caster's: compare_depth.lua FOLDER DEPTH. FOLDER has mesh.ply and transforms.json.
--- Exit code 1 where depths differ by more than 1e-4 or a pixel is sky in one of them alone. Blender's rays
--- are floats: at an edge, and on faces that are seen edge-on, its depth has to be one that the ray caster finds within
--- 1/100 of a pixel.
local aib = require "aib"

local tolerance <const>, slack <const> = 1e-4, 1 / 100

local function shifted(camera, dx, dy)
  local p = table.move(camera.parameters, 1, #camera.parameters, 1, {})
  p[3], p[4] = p[3] + dx, p[4] + dy
  return aib.math.camera { model = camera.model, width = camera.width, height = camera.height, parameters = p }
end

--- Depths of a frame: at the pixel centres, then a little to each side.
local function depths(scene, camera, pose, size)
  local maps = {}
  for k, d in ipairs { { 0, 0 }, { slack, 0 }, { -slack, 0 }, { 0, slack }, { 0, -slack } } do
    maps[k] = aib.io.array(aib.render.depth(scene, shifted(camera, d[1], d[2]), pose, size))
  end
  return maps
end

local function differs(found, expected) return math.abs(found - expected) > tolerance * expected end

--- Whether a depth is one of those near the pixel's centre or between them; sky only where one of them is sky.
local function is_near(found, maps, i)
  local low, high, has_sky = math.huge, 0, false
  for _, map in ipairs(maps) do
    has_sky = has_sky or map[i] == 0
    if map[i] > 0 then low, high = math.min(low, map[i]), math.max(high, map[i]) end
  end
  if found == 0 then return has_sky end
  return found >= low * (1 - 10 * tolerance) and found <= high * (1 + 10 * tolerance)
end

local folder, depth = arg[1], arg[2]
local scene = aib.render.scene(aib.io.read_mesh(folder .. "/mesh.ply"))
local trajectory = aib.io.read_trajectory(folder .. "/transforms.json")
local cameras = aib.io.read_cameras(folder .. "/transforms.json")

local is_wrong = false
for k, name in ipairs(trajectory.names) do
  local stem = name:match "([^/]+)%.%w+$"
  local theirs = aib.io.read_depth(("%s/%s.exr"):format(depth, stem))
  local maps = depths(scene, cameras[name], trajectory[k], { width = theirs.width, height = theirs.height })
  local found, n_edge, n_wrong = aib.io.array(theirs), 0, 0
  for i = 1, #found do
    if differs(found[i], maps[1][i]) then
      local at_edge = is_near(found[i], maps, i)
      n_edge, n_wrong = n_edge + (at_edge and 1 or 0), n_wrong + (at_edge and 0 or 1)
    end
  end
  print(("%s: %d pixels, %d on edges, %d differ"):format(stem, #found, n_edge, n_wrong))
  is_wrong = is_wrong or n_wrong > 0 or n_edge > #found // 500
end
os.exit(is_wrong and 1 or 0)
