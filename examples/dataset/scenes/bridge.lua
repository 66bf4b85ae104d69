-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A tied-arch bridge over a river: span of 64 m, two arches with hangers, road, footpaths, lamps, traffic.
local solids = require "solids"
local surroundings = require "scenes.surroundings"

local deck <const> = 8       -- height of the road
local span <const> = 64      -- between the springings of the arches
local rise <const> = 11
local arch_y <const> = 4.7
local hangers <const> = 20   -- spaces between the ends

local function arch_z(x) return deck + 0.6 + rise * (1 - (2 * x / span) ^ 2) end
local function station(k) return -span / 2 + span * k / hangers end

local function arches(scene)
  for _, side in ipairs { -1, 1 } do
    local y, path = side * arch_y, {}
    for k = 0, 40 do
      local x = -span / 2 + span * k / 40
      path[#path + 1] = { x, y, arch_z(x) }
    end
    scene:sweep("arch", path, 0.72, 0.95, { 0, 1, 0 })
    scene:beam("arch", { -span / 2 - 0.9, y, deck - 0.05 }, { span / 2 + 0.9, y, deck - 0.05 }, 0.86, 1.2)
    for _, x in ipairs { -span / 2, span / 2 } do
      scene:box("arch", { x - 1.15, y - 0.48, deck - 1.1 }, { x + 1.15, y + 0.48, deck + 0.85 })
    end
    for k = 1, hangers - 1 do
      local x = station(k)
      scene:rod("cable", { x, y, deck + 0.4 }, { x, y, arch_z(x) - 0.3 }, 0.045, 8)
      scene:lathe("steel", { x, y, deck + 0.5 }, { { 0.11, 0 }, { 0.11, 0.35 }, { 0.06, 0.62 } }, 10)
      scene:slice("steel", { { x - 0.16, arch_z(x) - 0.35 }, { x + 0.16, arch_z(x) - 0.35 }, { x + 0.06,
        arch_z(x) - 0.86 }, { x - 0.06, arch_z(x) - 0.86 } }, y - 0.025, y + 0.025)
    end
  end
end

--- Struts and crosses between the arches, where lorries fit under them.
local function bracing(scene)
  local struts = { 5, 7, 9, 11, 13, 15 }
  for i, k in ipairs(struts) do
    local x = station(k)
    scene:beam("arch", { x, -arch_y, arch_z(x) }, { x, arch_y, arch_z(x) }, 0.42, 0.5)
    local next_k = struts[i + 1]
    if next_k then
      local x2 = station(next_k)
      for _, s in ipairs { -1, 1 } do
        scene:rod("arch", { x, s * arch_y, arch_z(x) + 0.02 * s }, { x2, -s * arch_y, arch_z(x2) + 0.02 * s }, 0.11, 9)
      end
    end
  end
end

local function railing(scene, y, from, to, height, posts)
  for k = 0, posts do
    local x = from + (to - from) * k / posts
    scene:box("rail", { x - 0.03, y - 0.04, deck - 0.12 }, { x + 0.03, y + 0.04, deck + height - 0.02 })
  end
  for r, z in ipairs { 0.22, 0.48, 0.74 } do
    scene:rod("rail", { from - 0.04, y + 0.002 * r, deck + z }, { to + 0.04, y + 0.002 * r, deck + z }, 0.017, 6)
  end
  scene:box("rail", { from - 0.09, y - 0.055, deck + height - 0.055 }, { to + 0.09, y + 0.055, deck + height })
end

--- Panes against the wind in the middle of the span, one between each two posts.
local function wind_screen(scene, y)
  for k = -9, 8 do
    local x = 66.6 / 42 * k
    scene:box("glass", { x + 0.06, y - 0.009, deck + 0.13 }, { x + 66.6 / 42 - 0.06, y + 0.009, deck + 1.32 })
    for _, z in ipairs { 0.3, 1.0 } do
      scene:box("steel", { x - 0.045, y - 0.03, deck + z }, { x + 0.1, y + 0.05, deck + z + 0.07 })
    end
  end
end

local function floor(scene)
  scene:box("concrete", { -33.6, -4.2, deck - 0.42 }, { 33.6, 4.2, deck - 0.08 })
  scene:box("road", { -33.62, -3.5, deck - 0.2 }, { 33.62, 3.5, deck })
  for _, side in ipairs { -1, 1 } do
    scene:box("kerb", { -33.58, side * 3.62 - 0.17, deck - 0.23 }, { 33.58, side * 3.62 + 0.17, deck + 0.14 })
    scene:box("marking", { -33.6, side * 3.2 - 0.06, deck - 0.03 }, { 33.6, side * 3.2 + 0.06, deck + 0.006 })
    local inner, outer = side * 5.05, side * 7.4
    scene:box("footpath", { -33.64, math.min(inner, outer), deck - 0.3 }, { 33.64, math.max(inner, outer), deck + 0.1 })
    scene:box("panel", { -33.55, side * 7.38 - 0.11, deck - 0.62 }, { 33.55, side * 7.38 + 0.11, deck + 0.16 })
    railing(scene, side * 7.32, -33.3, 33.3, 1.15, 42)
    wind_screen(scene, side * 7.24)
    railing(scene, side * 4.0, -31.2, 31.2, 0.78, 26)
    for k = 0, 4 do
      surroundings.street_lamp(scene, { -26 + 13 * k, side * 6.95, deck + 0.1 }, side * -90, 5.2)
    end
  end
  for k = 0, 9 do
    scene:box("marking", { -32 + 6.7 * k, -0.07, deck - 0.03 }, { -29 + 6.7 * k, 0.07, deck + 0.006 })
  end
  for k = 0, hangers do
    local x = station(k)
    scene:box("arch", { x - 0.16, -7.2, deck - 0.34 }, { x + 0.16, 7.2, deck - 0.26 })
    scene:box("arch", { x - 0.035, -5.0, deck - 1.115 }, { x + 0.035, 5.0, deck - 0.3 })
    scene:box("arch", { x - 0.2, -4.95, deck - 1.16 }, { x + 0.2, 4.95, deck - 1.07 })
    for _, side in ipairs { -1, 1 } do
      local y = { side * 4.9, side * 7.15 }
      scene:loft("arch", {
        { { x - 0.03, y[1], deck - 1.03 }, { x + 0.03, y[1], deck - 1.03 }, { x + 0.03, y[1], deck - 0.31 },
          { x - 0.03, y[1], deck - 0.31 } },
        { { x - 0.03, y[2], deck - 0.5 }, { x + 0.03, y[2], deck - 0.5 }, { x + 0.03, y[2], deck - 0.31 },
          { x - 0.03, y[2], deck - 0.31 } },
      })
    end
  end
  for _, y in ipairs { -2.6, 0, 2.6 } do
    scene:box("arch", { -33.3, y - 0.12, deck - 0.85 }, { 33.3, y + 0.12, deck - 0.38 })
  end
  for k, y in ipairs { -1.3, 1.3 } do
    scene:rod("pipe", { -33.4, y, deck - 0.78 + 0.02 * k }, { 33.4, y, deck - 0.78 + 0.02 * k }, 0.12, 12)
  end
end

--- Bank, abutment and wing walls on one side; the other is the same, turned by 180 degrees.
local function bank(scene)
  local ground = deck - 0.25
  scene:slice("grass", { { -90, -4 }, { -27, -4 }, { -29.5, 0.3 }, { -33.5, 2.6 }, { -47, ground }, { -90, ground } },
    -80, 80)
  scene:box("stone", { -37.5, -8.4, -1.5 }, { -30.9, 8.4, deck - 1.75 })
  scene:box("concrete", { -37.3, -8.1, deck - 2.0 }, { -33.7, 8.1, deck - 0.28 })
  for _, side in ipairs { -1, 1 } do
    scene:box("stone", { -56, math.min(side * 7.6, side * 8.35), -1.2 }, { -33.2, math.max(side * 7.6, side * 8.35),
      deck + 0.32 })
    scene:box("coping", { -56.1, side * 7.97 - 0.47, deck + 0.28 }, { -33.1, side * 7.97 + 0.47, deck + 0.46 })
    scene:box("steel", { -32.45, side * arch_y - 0.31, deck - 1.9 }, { -31.55, side * arch_y + 0.31, deck - 1.05 })
    surroundings.street_lamp(scene, { -46, side * 6.9, deck }, side * -90, 5.2)
    scene:box("footpath", { -89.85, math.min(side * 3.75, side * 7.62), deck - 0.5 }, { -33.72,
      math.max(side * 3.75, side * 7.62), deck + 0.09 })
    railing(scene, side * 8.0, -55.5, -34, 1.45, 12)
  end
  scene:box("concrete", { -56.4, -7.8, 1.3 }, { -33.9, 7.8, deck - 0.43 })
  scene:box("steel", { -33.74, -3.56, deck - 0.06 }, { -33.57, 3.56, deck + 0.003 })
  surroundings.road(scene, { y = 0, z = deck, width = 7, from = -89.9, to = -33.66 })
end

local function boulders(scene, random)
  for k = 1, 46 do
    local x, y = random(-31.5, -27.6), -44 + 2 * k + random(-0.7, 0.7)
    if math.abs(y) > 9.5 then
      local r = random(0.35, 0.95)
      scene:blob("stone", { x, y, 0.12 * r }, { r, r * random(0.7, 1.2), 0.7 * r }, random, 0.17)
    end
  end
end

local function site(scene)
  local random = solids.random(9)
  scene:box("water", { -30.2, -79.9, -3 }, { 30.2, 79.9, 0 })
  for _, yaw in ipairs { 0, 180 } do
    scene:at({ 0, 0, 0 }, yaw, function()
      bank(scene)
      boulders(scene, random)
    end)
  end
  for k, p in ipairs { { -41, 15 }, { -45, -17 }, { -38, 29 }, { -39, -33 }, { 42, 16 }, { 40, -19 }, { 46, 30 },
    { 39, -38 }, { -58, 22 }, { 60, -22 } } do
    local x = math.abs(p[1])
    local z = x > 47 and deck - 0.25 or 2.6 + (x - 33.5) * (deck - 0.25 - 2.6) / 13.5
    surroundings.tree(scene, { p[1], p[2], z - 0.15 }, 6.5 + (k * 41 % 9) / 2, 200 + k)
  end
  surroundings.car(scene, { -14, -1.75, deck + 0.006 }, 0, "saloon", "car_silver")
  surroundings.car(scene, { 9, 1.7, deck + 0.006 }, 181, "van", "car_white")
  surroundings.car(scene, { 22, -1.7, deck + 0.006 }, 1, "saloon", "car_red")
  surroundings.brick_buildings(scene, { seed = 7, count = 22, near = 70, far = 78, low = 8, high = 18, turn = 4,
    z = function() return deck - 0.25 end,
    skip = function(x, y) return math.abs(x) < 56 or math.abs(y) < 20 end,
  })
end

return {
  name = "bridge",
  asset = { low = { -33, -7.5, 6 }, high = { 33, 7.5, deck + 0.6 + rise } },
  --- Faces that are of the asset alone.
  labels = { "arch", "cable", "panel", "glass", "road", "rail", "kerb", "footpath" },
  deck = deck, span = span, rise = rise, arch_y = arch_y, arch_z = arch_z,
  crop = { min = { -36, -9, 2 }, max = { 36, 9, 22 } },
  build = function()
    local scene = solids.new()
    site(scene)
    floor(scene)
    arches(scene)
    bracing(scene)
    return scene
  end,
}
