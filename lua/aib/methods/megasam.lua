-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- MegaSaM: one NPZ file with depths, cam_c2w and intrinsic.
local aib = require "aib"
local kit = require "aib.methods.kit"

local function find(folder)
  for _, name in ipairs(aib.system.names_in(folder)) do
    local has = name:find "%.npz$" and kit.arrays(folder .. "/" .. name) or {}
    if has.cam_c2w and has.depths then return name .. " with cam_c2w and depths", name end
  end
end

return {
  kind = "megasam",
  find = find,
  open = function(folder, options)
    local _, name = find(folder)
    return kit.stack_batch(folder, folder .. "/" .. name, { depth = "depths" }, options)
  end,
}
