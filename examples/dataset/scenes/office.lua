-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- An office of four storeys behind glass: 30 x 20 x 15 m, roof plant, antenna, solar panels, a street with cars.
local solids = require "solids"
local surroundings = require "scenes.surroundings"

local storey <const>, storeys <const> = 3.5, 4
local top <const> = storey * storeys  -- of the roof slab
local half_x <const>, half_y <const> = 15, 10

--- The four facades, each seen as one along x from 0 to `length`, its outer face at y = 0 and the house behind it.
local facades <const> = {
  { place = { -half_x, -half_y, 0 }, yaw = 0, length = 2 * half_x, bays = 20 },
  { place = { half_x, -half_y, 0 }, yaw = 90, length = 2 * half_y, bays = 13 },
  { place = { half_x, half_y, 0 }, yaw = 180, length = 2 * half_x, bays = 20, core = { 12, 15 } },
  { place = { -half_x, half_y, 0 }, yaw = 270, length = 2 * half_y, bays = 13 },
}

--- One bay of one storey: pane, joint of the spandrel below it, what is seen behind the glass.
local function bay(scene, random, x0, x1, floor)
  local sill, head = floor + 0.17, floor + storey - 0.47
  scene:box("glass", { x0 + 0.012, 0.150, sill - 0.03 }, { x1 - 0.012, 0.174, head + 0.03 })
  scene:box("panel", { x0 + 0.006, 0.105, floor - 0.5 }, { x1 - 0.006, 0.30, floor + 0.185 })
  local drop = random(0, 1) < 0.55 and random(0.15, 0.9) * (head - sill) or 0
  if drop > 0 then
    scene:box("blind", { x0 + 0.07, 0.262, head - drop }, { x1 - 0.07, 0.271, head + 0.06 })
    scene:box("frame", { x0 + 0.06, 0.256, head - drop - 0.03 }, { x1 - 0.06, 0.277, head - drop + 0.012 })
  end
end

local function facade(scene, side, random)
  local width = (side.length - 1.5) / side.bays
  local function edge(k) return 0.75 + width * k end
  local function is_open(k) return not side.core or k < side.core[1] or k >= side.core[2] end
  for k = 0, side.bays do
    if is_open(k) or is_open(k - 1) then
      scene:box("frame", { edge(k) - 0.032, 0.03, 0.04 }, { edge(k) + 0.032, 0.24, top + 0.1 })
    end
  end
  for k = 0, side.bays - 1 do
    for s = 0, storeys - 1 do
      if is_open(k) then bay(scene, random, edge(k), edge(k + 1), s * storey) end
    end
  end
  local runs = side.core and { { 0, side.core[1] }, { side.core[2], side.bays } } or { { 0, side.bays } }
  for s = 0, storeys - 1 do
    for _, run in ipairs(runs) do
      for k, z in ipairs { 0.16, 1.02, storey - 0.512 } do
        local out = 0.075 + 0.004 * k
        scene:box("frame", { edge(run[1]) - 0.02, out, s * storey + z }, { edge(run[2]) + 0.02, 0.21 + 0.004 * k,
          s * storey + z + 0.055 })
      end
    end
  end
  scene:box("wall", { -0.06, -0.06, -0.35 }, { 0.78, 0.78, top + 0.25 })
end

--- Brick bays with small windows on the back, where the stairs are.
local function stair_bays(scene)
  local side = facades[3]
  local width = (side.length - 1.5) / side.bays
  local from, to = 0.75 + width * side.core[1], 0.75 + width * side.core[2]
  scene:box("brick_red", { from - 0.1, -0.28, -0.33 }, { to + 0.1, 0.9, top + 1.9 })
  scene:ring("coping", { from - 0.16, -0.34, top + 1.75 }, { to + 0.16, 0.96, top + 2.0 }, 0.3)
  for s = 0, storeys - 1 do
    local x, z = (from + to) / 2, s * storey + 2.0
    scene:box("interior", { x - 0.7, -0.292, z - 0.55 }, { x + 0.7, 0.1, z + 0.55 })
    scene:at({ x, -0.35, z }, 0, function()
      scene:box("glass", { -0.69, 0.02, -0.54 }, { 0.69, 0.038, 0.54 })
      for _, k in ipairs { -1, 0, 1 } do
        scene:box("frame", { 0.69 * k - 0.04, 0, -0.585 }, { 0.69 * k + 0.04, 0.09, 0.585 })
      end
      for _, k in ipairs { -1, 1 } do
        scene:box("frame", { -0.726, 0.005, 0.55 * k - 0.04 }, { 0.726, 0.087, 0.55 * k + 0.04 })
      end
    end)
  end
end

--- Desks, screens, cabinets and lamps on a floor, between the facade and the core.
local function furniture(scene, random, floor)
  for k = 0, 15 do
    local along = k < 8 and { -12.2 + 3.4 * (k % 8), -7.2 } or { -12.2 + 3.4 * (k % 8), 7.0 }
    local place = { along[1] + random(-0.5, 0.5), along[2] + random(-0.4, 0.4), floor }
    scene:at(place, random(-8, 8), function()
      scene:box("timber", { -0.8, -0.4, 0.71 }, { 0.8, 0.4, 0.74 })
      for _, x in ipairs { -0.72, 0.72 } do scene:box("metal", { x - 0.03, -0.35, -0.05 }, { x + 0.03, 0.35, 0.72 }) end
      scene:box("screen", { -0.32, 0.05, 0.82 }, { 0.3, 0.09, 1.2 })
      scene:rod("metal", { 0, 0.1, 0.72 }, { 0, 0.075, 0.95 }, 0.03, 6)
      if random(0, 1) < 0.5 then scene:box("cabinet", { 1.0, -0.5, -0.04 }, { 1.5, 0.5, random(0.9, 1.9) }) end
    end)
  end
  for k = 0, 7 do
    for _, y in ipairs { -7.4, 7.2 } do
      local x = -12.4 + 3.5 * k
      scene:box("light", { x - 0.6, y - 0.15, floor + storey - 0.46 }, { x + 0.6, y + 0.15, floor + storey - 0.28 })
    end
  end
end

local function house(scene, random)
  scene:box("concrete", { -14.86, -9.86, -0.4 }, { 14.86, 9.86, 0.03 })
  for s = 1, storeys do
    scene:box("concrete", { -14.72, -9.72, s * storey - 0.3 }, { 14.72, 9.72, s * storey })
  end
  scene:box("interior", { -8.5, -4.4, -0.1 }, { 8.5, 4.2, top - 0.1 })
  for s = 0, storeys - 1 do
    local floor = s == 0 and 0.03 or s * storey
    for k = 0, 4 do
      local x = -10.5 + 5.25 * k
      for _, y in ipairs { -8.6, 8.4 } do
        scene:rod("concrete", { x, y, floor - 0.1 }, { x, y, (s + 1) * storey - 0.2 }, 0.24, 14)
      end
    end
    furniture(scene, random, floor)
    for _, x in ipairs { -9.2, 3.1, 10.4 } do
      local y = x < 0 and { 4.1, 9.2 } or { -9.3, -4.3 }
      scene:box("partition", { x - 0.06, y[1], floor - 0.06 }, { x + 0.06, y[2], (s + 1) * storey - 0.27 })
    end
  end
  for _, side in ipairs(facades) do
    scene:at(side.place, side.yaw, function() facade(scene, side, random) end)
  end
  scene:at(facades[3].place, 180, function() stair_bays(scene) end)
end

local function entrance(scene)
  scene:box("wall", { -3.6, -13.0, 2.95 }, { 3.6, -9.8, 3.2 })
  scene:ring("metal", { -3.68, -13.08, 2.9 }, { 3.68, -9.75, 3.27 }, 0.16)
  for _, x in ipairs { -3.1, 3.1 } do scene:rod("metal", { x, -12.5, -0.25 }, { x, -12.5, 3.05 }, 0.09, 12) end
  for k = 0, 4 do
    scene:box("frame", { -2.05 + k - 0.035, -11.62, -0.1 }, { -2.05 + k + 0.035, -11.5, 3.0 })
    if k < 4 then scene:box("glass", { -2.04 + k, -11.572, 0.05 }, { -1.06 + k, -11.55, 2.97 }) end
  end
  for _, x in ipairs { -2.05, 1.95 } do
    scene:box("glass", { x - 0.011, -11.54, 0.05 }, { x + 0.011, -9.83, 2.96 })
    scene:box("metal", { x + 0.5 - 0.02, -11.66, 0.9 }, { x + 0.5 + 0.02, -11.63, 1.7 })
  end
  scene:box("paving_dark", { -4, -14.2, -0.2 }, { 4, -9.64, 0.075 })
end

local function air_unit(scene, place, yaw)
  scene:at(place, yaw, function()
    scene:box("metal", { -1.3, -0.75, 0.25 }, { 1.3, 0.75, 1.55 })
    for _, x in ipairs { -1.1, 1.1 } do scene:box("steel", { x - 0.08, -0.85, -0.13 }, { x + 0.08, 0.85, 0.3 }) end
    for _, x in ipairs { -0.62, 0.62 } do
      scene:lathe("metal", { x, 0, 1.5 }, { { 0.56, 0 }, { 0.56, 0.22 }, { 0.5, 0.26 } }, 20)
      scene:lathe("steel", { x, 0, 1.6 }, { { 0.44, 0 }, { 0.44, 0.175 }, { 0.12, 0.22 } }, 20)
      for k = 0, 3 do
        local c, s, z = 0.5 * math.cos(math.pi * k / 4), 0.5 * math.sin(math.pi * k / 4), 1.79 + 0.004 * k
        scene:beam("steel", { x - c, -s, z }, { x + c, s, z }, 0.02, 0.013)
      end
    end
    for k = 0, 7 do
      scene:box("steel", { -1.18, -0.79, 0.4 + 0.135 * k }, { 1.18, -0.7, 0.47 + 0.135 * k })
    end
  end)
end

local function solar_row(scene, y, n)
  local rise = math.tan(math.rad(22))
  for k = 0, n - 1 do
    local x = -13 + 1.12 * k
    local function across(u, lift) return { x, y + u, top + 0.55 + u * rise + lift } end
    local function panel(label, half, low, high, from, to)
      local ring = {}
      for i, p in ipairs { { from, low }, { to, low }, { to, high }, { from, high } } do
        ring[i] = across(p[1], p[2])
      end
      local other = {}
      for i, p in ipairs(ring) do ring[i], other[i] = { p[1] - half, p[2], p[3] }, { p[1] + half, p[2], p[3] } end
      scene:loft(label, { ring, other })
    end
    panel("metal", 0.53, 0, 0.04, -0.85, 0.85)
    panel("solar", 0.505, 0.02, 0.046, -0.825, 0.825)
    scene:beam("steel", { x, y - 0.7, top - 0.12 }, { x, y - 0.7, top + 0.29 }, 0.05)
    scene:beam("steel", { x, y + 0.7, top - 0.12 }, { x, y + 0.7, top + 0.85 }, 0.05)
  end
end

local function antenna(scene, x, y)
  scene:lathe("steel", { x, y, top }, { { 0.22, -0.2 }, { 0.22, 0.35 }, { 0.075, 0.4 }, { 0.07, 3.4 }, { 0.045, 3.45 },
    { 0.04, 6.2 } }, 10)
  for k = 0, 2 do
    local a = math.rad(120 * k + 15)
    local c, s = math.cos(a), math.sin(a)
    scene:rod("cable", { x + 2.6 * c, y + 2.6 * s, top - 0.1 }, { x + 0.03 * c, y + 0.03 * s, top + 4.6 }, 0.014, 5)
    scene:at({ x, y, top + 2.2 }, 120 * k + 45, function()
      scene:box("panel", { 0.28, -0.14, -0.5 }, { 0.4, 0.14, 0.6 })
      scene:rod("steel", { 0, 0, 0.02 }, { 0.33, 0, 0.02 }, 0.03, 6)
    end)
  end
  for k = 0, 5 do
    local z = top + 5 + 0.17 * k
    scene:rod("steel", { x - 0.6 + 0.06 * k, y, z }, { x + 0.6 - 0.06 * k, y, z }, 0.014, 5)
  end
  scene:at({ x, y, top + 1.3 }, -70, function()
    local rings = {}
    for _, p in ipairs { { 0.55, 0.42 }, { 0.6, 0.42 }, { 0.4, 0.24 }, { 0.1, 0.12 } } do
      local ring = {}
      for i = 1, 18 do
        local angle = 2 * math.pi * i / 18
        ring[i] = { p[2], p[1] * math.cos(angle), p[1] * math.sin(angle) }
      end
      rings[#rings + 1] = ring
    end
    scene:loft("panel", rings)
    scene:rod("steel", { 0, 0, 0 }, { 0.7, 0, 0.01 }, 0.025, 6)
  end)
end

local function duct(scene, path, size)
  for k = 1, #path - 1 do
    scene:beam("metal", path[k], path[k + 1], size + 0.004 * k, size - 0.003 * k)
  end
  for k = 2, #path - 1 do
    local p, r = path[k], size / 2 + 0.03
    scene:box("metal", { p[1] - r, p[2] - r, p[3] - r }, { p[1] + r, p[2] + r, p[3] + r })
  end
end

local function roof(scene)
  scene:box("gravel", { -14.55, -9.55, top - 0.05 }, { 14.55, 9.55, top + 0.06 })
  scene:ring("panel", { -14.92, -9.92, top - 0.42 }, { 14.92, 9.92, top + 0.8 }, 0.42)
  scene:ring("coping", { -15.02, -10.02, top + 0.74 }, { 15.02, 10.02, top + 0.88 }, 0.6)
  -- the penthouse with its louvres and door
  scene:box("cladding", { 2.2, -2.6, top - 0.15 }, { 9.4, 3.4, top + 2.5 })
  scene:box("coping", { 2.05, -2.75, top + 2.42 }, { 9.55, 3.55, top + 2.6 })
  for k = 0, 10 do
    scene:box("steel", { 5.2, -2.69, top + 0.7 + 0.14 * k }, { 8.9, -2.5, top + 0.77 + 0.14 * k })
  end
  scene:box("door", { 2.9, -2.66, top - 0.02 }, { 3.9, -2.4, top + 2.05 })
  for k, x in ipairs { -1.5, 4.2, 8.2 } do air_unit(scene, { x, k == 1 and 1.5 or 6.6, top + 0.1 }, 4 * k) end
  air_unit(scene, { 12.2, 0.5, top + 0.1 }, 91)
  duct(scene, { { 9.0, 1.6, top + 0.9 }, { 10.6, 1.6, top + 0.9 }, { 10.6, 6.4, top + 0.9 }, { 12.8, 6.4, top + 0.9 } },
    0.55)
  duct(scene, { { 2.6, 0.6, top + 0.6 }, { 0.4, 0.6, top + 0.6 }, { 0.4, -1.8, top + 0.6 } }, 0.4)
  for k = 0, 3 do
    local y = -6.4 + 0.16 * k
    scene:rod("pipe", { 1.6, y, top + 0.28 + 0.01 * k }, { 13.9, y, top + 0.28 + 0.01 * k }, 0.05, 8)
  end
  for k = 0, 6 do scene:box("steel", { 2 + 1.9 * k, -6.55, top - 0.03 }, { 2.1 + 1.9 * k, -5.8, top + 0.24 }) end
  scene:lathe("tank", { 12.4, -3.6, top }, { { 1.05, -0.1 }, { 1.05, 1.7 }, { 0.9, 1.9 }, { 0.2, 2.05 } }, 24)
  for _, x in ipairs { -11.8, -8.2, -4.6 } do
    scene:box("wall", { x - 1, 6.1, top - 0.08 }, { x + 1, 8.1, top + 0.34 })
    scene:loft("glass", {
      { { x - 0.93, 6.17, top + 0.3 }, { x + 0.93, 6.17, top + 0.3 }, { x + 0.93, 8.03, top + 0.3 },
        { x - 0.93, 8.03, top + 0.3 } },
      { { x - 0.1, 7.0, top + 0.85 }, { x + 0.1, 7.0, top + 0.85 }, { x + 0.1, 7.2, top + 0.85 },
        { x - 0.1, 7.2, top + 0.85 } },
    })
  end
  for k = 0, 2 do solar_row(scene, -7.4 + 3.5 * k, k == 0 and 12 or 9) end
  antenna(scene, 6.0, 0.6)
  scene:at({ -1.0, 5.0, 0 }, 0, function() antenna(scene, 0, 0) end)
end

local function site(scene)
  scene:box("paving", { -75, -75, -1.2 }, { 75, 75, 0 })
  scene:box("grass", { -42, 17.5, -0.22 }, { 42, 40, 0.07 })
  scene:ring("kerb", { -42.12, 17.38, -0.28 }, { 42.12, 40.12, 0.13 }, 0.24)
  surroundings.road(scene, { y = -27, z = 0.035, width = 8, from = -74.9, to = 74.9 })
  for k = 0, 8 do
    local x = -24 + 5.4 * k
    scene:box("marking", { x - 0.06, -22.3, -0.05 }, { x + 0.06, -17.4, 0.008 })
  end
  local paints = { "car_red", "car_white", "car_blue", "car_silver", "car_red", "car_black" }
  for k, kind in ipairs { "saloon", "van", "saloon", "saloon", "van", "saloon" } do
    surroundings.car(scene, { -21.4 + 5.4 * (k + (k > 3 and 1 or 0)), -19.9, 0.008 }, k % 2 == 0 and 91 or 268, kind,
      paints[k])
  end
  surroundings.car(scene, { -9, -25.2, 0.042 }, 0, "saloon", "car_silver")
  surroundings.car(scene, { 16, -28.8, 0.042 }, 180, "van", "car_blue")
  for k = 0, 5 do surroundings.street_lamp(scene, { -40 + 16 * k, -32.4, 0 }, 90, 6.5) end
  for k, place in ipairs { { -31, 9 }, { -34, -3 }, { 31, 12 }, { 35, 1 }, { -25, 24 }, { -12, 27 }, { 1, 23.5 },
    { 14, 28 }, { 26, 24 }, { 37, -12 }, { -38, -14 } } do
    surroundings.tree(scene, { place[1], place[2], 0 }, 6.2 + (k * 37 % 11) / 4, 100 + k)
  end
  for k = 0, 3 do surroundings.bench(scene, { -9 + 6 * k, 16.4, 0 }, 0) end
  surroundings.brick_buildings(scene, { seed = 3, count = 21, near = 50, far = 62, low = 9, high = 21,
    skip = function(_, y) return math.abs(y + 27) < 13 end })
end

return {
  name = "office",
  --- What the drone flies round: the building without its site.
  asset = { low = { -15.1, -10.4, 0 }, high = { 15.1, 10.4, 16 } },
  --- Faces that are of the asset alone.
  labels = { "glass", "frame", "wall" },
  crop = { min = { -18, -15.5, -0.5 }, max = { 18, 14, 22 } },
  build = function()
    local scene = solids.new()
    site(scene)
    house(scene, solids.random(1))
    entrance(scene)
    roof(scene)
    return scene
  end,
}
