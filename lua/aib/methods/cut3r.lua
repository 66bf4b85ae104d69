-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- CUT3R: depth/%06d.npy, conf/%06d.npy and camera/%06d.npz with pose (world_from_camera) and intrinsics.
local aib = require "aib"
local kit = require "aib.methods.kit"

local function frames(folder) return kit.numbered(folder .. "/depth", "^(%d+)%.npy$") end

return {
  kind = "cut3r",
  find = function(folder)
    if #frames(folder) > 0 and #kit.numbered(folder .. "/camera", "^(%d+)%.npz$") > 0 then
      return "depth/<i>.npy and camera/<i>.npz"
    end
  end,
  open = function(folder, options)
    local files = frames(folder)
    local function map(part)
      return function(i) return aib.io.read_depth(("%s/%s/%s"):format(folder, part, files[i])) end
    end
    return kit.frame_batch(folder, #files, {
      depth = map "depth", confidence = aib.system.is_folder(folder .. "/conf") and map "conf" or nil,
      poses = folder .. "/camera", cameras = folder .. "/camera",
    }, options)
  end,
}
