-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The optimisers of DUSt3R's family (DUSt3R, MASt3R, MonST3R): frame_%04d.npy, conf_%d.npy, pred_traj.txt with lines
--- t x y z qw qx qy qz (world_from_camera, w first, unlike TUM) and pred_intrinsics.txt with nine numbers a line.
local aib = require "aib"
local kit = require "aib.methods.kit"

local function frames(folder) return kit.numbered(folder, "^frame_(%d+)%.npy$") end

local function cameras_of(folder, names, map)
  local cameras = {}
  for i, k in ipairs(kit.number_lines(folder .. "/pred_intrinsics.txt")) do
    cameras[names[i] or ""] = kit.pinhole(k, map.width, map.height)
  end
  cameras[""] = nil
  return cameras
end

return {
  kind = "dust3r",
  find = function(folder)
    if kit.exists(folder, "pred_traj.txt") and #frames(folder) > 0 then return "pred_traj.txt and frame_<i>.npy" end
  end,
  open = function(folder, options)
    local files, sure = frames(folder), kit.numbered(folder, "^conf_(%d+)%.npy$")
    local names, told = kit.names(folder, #files, options)
    local function depth(i) return aib.io.read_depth(folder .. "/" .. files[i]) end
    return {
      names = names, named = told, rule = "raw", depth = depth,
      confidence = #sure == #files and function(i) return aib.io.read_depth(folder .. "/" .. sure[i]) end or nil,
      trajectory = aib.io.read_trajectory(folder .. "/pred_traj.txt",
        { names = names, format = "tum", quaternion = "wxyz" }),
      cameras = kit.exists(folder, "pred_intrinsics.txt") and cameras_of(folder, names, depth(1)) or nil,
    }
  end,
}
