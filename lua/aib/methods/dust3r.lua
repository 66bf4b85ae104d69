-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The optimisers of DUSt3R's family (DUSt3R, MASt3R, MonST3R): frame_%04d.npy, conf_%d.npy, pred_traj.txt with lines
--- t x y z qw qx qy qz (world_from_camera, w first, unlike TUM) and pred_intrinsics.txt with nine numbers a line.
local aib = require "aib"
local failure = require "aib.failure"
local kit = require "aib.methods.kit"

local function frames(folder) return kit.numbered(folder, "^frame_(%d+)%.npy$") end

local function cameras_of(path, names, map)
  local matrices, cameras = kit.number_lines(path, 9), {}
  if #matrices ~= #names then
    failure.raise("format", ("%s: a line a frame expected, found %d of %d"):format(path, #matrices, #names))
  end
  for i, k in ipairs(matrices) do cameras[names[i]] = kit.pinhole(k, map.width, map.height) end
  return cameras
end

return {
  kind = "dust3r",
  find = function(folder)
    if kit.exists(folder, "pred_traj.txt") and #frames(folder) > 0 then return "pred_traj.txt and frame_<i>.npy" end
  end,
  open = function(folder, options)
    local files, sure = frames(folder), kit.numbered(folder, "^conf_(%d+)%.npy$")
    local function map(list) return function(i) return aib.io.read_depth(folder .. "/" .. list[i]) end end
    local batch = kit.frame_batch(folder, #files, {
      depth = map(files), confidence = #sure == #files and map(sure) or nil,
      poses = folder .. "/pred_traj.txt", how = { format = "tum", quaternion = "wxyz" },
    }, options)
    if kit.exists(folder, "pred_intrinsics.txt") then
      batch.cameras = cameras_of(folder .. "/pred_intrinsics.txt", batch.names, batch.depth(1))
    end
    return batch
  end,
}
