-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- VGGT: the predictions.npz of its demo. Poses are camera_from_world, confidences 1 + exp(x). Its COLMAP export is
--- read as COLMAP.
local kit = require "aib.methods.kit"

return {
  kind = "vggt",
  find = function(folder)
    local has = kit.arrays(folder .. "/predictions.npz")
    if has.depth and has.depth_conf and has.extrinsic then
      return "predictions.npz with depth, depth_conf and extrinsic"
    end
  end,
  open = function(folder, options)
    return kit.stack_batch(folder, folder .. "/predictions.npz", { depth = "depth", confidence = "depth_conf" },
      options)
  end,
}
