-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Depth Anything 3, streaming: camera_poses.txt (world_from_camera), intrinsic.txt and results_output/frame_<i>.npz.
local aib = require "aib"
local kit = require "aib.methods.kit"

local function frames(folder) return kit.numbered(folder .. "/results_output", "^frame_(%d+)%.npz$") end

return {
  kind = "da3_streaming",
  find = function(folder)
    if kit.exists(folder, "camera_poses.txt") and #frames(folder) > 0 then
      return "camera_poses.txt and results_output/frame_<i>.npz"
    end
  end,
  open = function(folder, options)
    local files, combined = frames(folder), folder .. "/pcd/combined_pcd.ply"
    local function map(key)
      return function(i) return aib.io.read_depth(folder .. "/results_output/" .. files[i], { key = key }) end
    end
    local batch = kit.frame_batch(folder, #files, {
      depth = map "depth", confidence = map "conf", poses = folder,
      cameras = kit.exists(folder, "intrinsic.txt") and folder or nil,
    }, options)
    batch.points = aib.system.is_file(combined) and kit.cloud(combined) or nil
    return batch
  end,
}
