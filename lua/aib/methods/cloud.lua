-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A folder with one cloud and nothing else that is known: pi3's example leaves a PLY, the demos of DUSt3R, MASt3R and
--- VGGT a GLB. Its frame is the method's own and without poses nothing brings it into another.
local aib = require "aib"
local kit = require "aib.methods.kit"

local function clouds(folder)
  local found = {}
  for _, name in ipairs(aib.system.names_in(folder)) do
    if name:find "%.ply$" or name:find "%.glb$" then found[#found + 1] = name end
  end
  return found
end

return {
  kind = "cloud",
  find = function(folder)
    local found = clouds(folder)
    if #found == 1 then return found[1] .. " alone" end
  end,
  open = function(folder)
    local name = clouds(folder)[1]
    local warnings = {}
    if name:find "%.glb$" then
      warnings[1] = name .. ": demos turn and centre what they write as GLB; it has no scale and no known frame"
    end
    return { names = {}, named = false, points = kit.cloud(folder .. "/" .. name), warnings = warnings }
  end,
}
