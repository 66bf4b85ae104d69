-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- OpenMVS: depth<i>.dmap, whose headers name the image and hold its pose and intrinsics, and its dense cloud.
local aib = require "aib"
local failure = require "aib.failure"
local kit = require "aib.methods.kit"

local clouds <const> = { "scene_dense.ply", "scene_dense_filtered.ply", "model_dense.ply" }

local function frames(folder) return kit.numbered(folder, "^depth(%d+)%.dmap$") end

--- What stands before the pixels: name, pose and camera (of the size of the image).
local function header_of(path)
  local file <close> = assert(io.open(path, "rb"))
  local bytes = file:read(65536) or ""
  local ok, header = pcall(function()
    local magic, _, _, width, height = ("<c2BBI4I4"):unpack(bytes)
    local at = magic == "D2" and 33 or 29
    local name, ids
    name, ids, at = ("<s2I4"):unpack(bytes, at)
    local n = { ("<" .. ("d"):rep(21)):unpack(bytes, at + 4 * ids) }
    local r, c = table.move(n, 10, 18, 1, {}), table.move(n, 19, 21, 1, {})
    return {
      name = name:match "[^/\\]*$", camera = kit.pinhole(n, width, height),
      pose = aib.math.pose { centre = c,
        rotation = { { r[1], r[4], r[7] }, { r[2], r[5], r[8] }, { r[3], r[6], r[9] } } },
    }
  end)
  if not ok then failure.raise("format", path .. ": dmap: the header is cut off or damaged") end
  return header
end

return {
  kind = "openmvs",
  find = function(folder)
    if #frames(folder) > 0 then return "depth<i>.dmap" end
  end,
  open = function(folder)
    local files, names, poses, cameras = frames(folder), {}, {}, {}
    for i, name in ipairs(files) do
      local header = header_of(folder .. "/" .. name)
      names[i], poses[i], cameras[header.name] = header.name, header.pose, header.camera
    end
    local cloud = kit.first_of(folder, clouds)
    return {
      names = names, named = true, trajectory = aib.pose.trajectory(poses, { names = names }), cameras = cameras,
      depth = function(i) return aib.io.read_depth(folder .. "/" .. files[i]) end,
      points = cloud and kit.cloud(folder .. "/" .. cloud) or nil,
    }
  end,
}
