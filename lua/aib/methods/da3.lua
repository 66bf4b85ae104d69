-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Depth Anything 3: exports/mini_npz/results.npz or exports/npz/results.npz. The poses are camera_from_world; either
--- spelling of the keys (extrinsics, exts). Confidences are 1 + exp(x), never below 1. Intrinsics of the original image
--- size beside smaller depth maps (a race of its exporters) are scaled by the reader, with a warning.
local kit = require "aib.methods.kit"

local places <const> = {
  "exports/mini_npz/results.npz", "exports/npz/results.npz", "mini_npz/results.npz", "npz/results.npz", "results.npz",
}

local function find(folder)
  local name = kit.first_of(folder, places)
  if not name then return nil end
  local has = kit.arrays(folder .. "/" .. name)
  if has.depth and not has.depth_conf then return name .. " with depth", name end
end

return {
  kind = "da3",
  find = find,
  open = function(folder, options)
    local _, name = find(folder)
    return kit.stack_batch(folder, folder .. "/" .. name, { depth = "depth", confidence = "conf" }, options)
  end,
}
