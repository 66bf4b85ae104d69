-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A tower crane on a building site: lattice mast of 30 m, jib of 32 m, counter jib, cabin, ropes, ballast.
local solids = require "solids"
local surroundings = require "scenes.surroundings"
local vector = require "vector"

local between = vector.between
local mast <const>, section <const>, sections <const> = 0.8, 2.5, 12  -- half width, length, number
local foot <const> = 1.0
local head <const> = foot + section * sections  -- of the mast

local corners <const> = { { -mast, -mast }, { mast, -mast }, { mast, mast }, { -mast, mast } }

local function lattice_mast(scene)
  for _, p in ipairs(corners) do
    scene:beam("truss", { p[1], p[2], foot - 0.4 }, { p[1], p[2], head + 0.05 }, 0.16, 0.16, { 1, 0, 0 })
    for k = 1, sections - 1 do
      local z = foot + k * section
      scene:box("steel", { p[1] - 0.11, p[2] - 0.11, z - 0.09 }, { p[1] + 0.11, p[2] + 0.11, z + 0.09 })
    end
  end
  for k = 0, sections do
    for i = 1, 4 do
      local a, b = corners[i], corners[i % 4 + 1]
      local z = foot + k * section + (k == 0 and 0.12 or 0)
      scene:rod("truss", { a[1], a[2], z }, { b[1], b[2], z }, 0.045, 7)
      if k < sections then
        local middle, over = z + (foot + (k + 1) * section - z) / 2, foot + (k + 1) * section
        local from, to = a, b
        if (k + i) % 2 == 0 then from, to = b, a end
        scene:rod("truss", { from[1], from[2], z + 0.02 }, { to[1], to[2], middle }, 0.038, 7)
        scene:rod("truss", { to[1], to[2], middle + 0.015 }, { from[1], from[2], over - 0.02 }, 0.038, 7)
      end
    end
  end
end

local function ladder(scene)
  for k = 0, 2 * sections - 3 do
    local z, x = foot + 0.1 + k * section / 2, k % 2 == 0 and -0.32 or 0.14
    local top = z + section / 2 + 0.16 + 0.01 * (k % 2)
    for _, dx in ipairs { 0, 0.34 } do scene:rod("steel", { x + dx, -0.35, z }, { x + dx, -0.35, top }, 0.022, 6) end
    for r = 1, 4 do
      local rung = z + 0.26 * r
      scene:rod("steel", { x - 0.01, -0.35, rung }, { x + 0.35, -0.35, rung }, 0.013, 5)
    end
  end
  for k = 1, 5 do
    local z = foot + 2 * k * section - 0.07
    scene:box("steel", { -0.74, -0.12, z }, { 0.74, 0.7, z + 0.035 })
  end
end

local function base(scene)
  scene:box("concrete", { -2.9, -2.9, -0.5 }, { 2.9, 2.9, 0.5 })
  for k, p in ipairs(corners) do
    scene:box("steel", { p[1] - 0.28, p[2] - 0.28, 0.4 }, { p[1] + 0.28, p[2] + 0.28, 0.66 })
    local q = corners[k % 4 + 1]
    scene:at({ 1.75 * (p[1] + q[1]), 1.75 * (p[2] + q[2]), 0.5 }, 90 * k, function()
      for s = 0, 1 do
        scene:box("concrete_light", { -0.42 + 0.02 * s, -1.05 + 0.03 * s, 0.61 * s - 0.06 },
          { 0.42 - 0.02 * s, 1.05 - 0.03 * s, 0.61 * s + 0.52 })
        for _, y in ipairs { -0.6, 0.6 } do
          scene:box("steel", { -0.06, y - 0.1, 0.61 * s + 0.5 }, { 0.06, y + 0.1, 0.61 * s + 0.56 })
        end
      end
    end)
  end
end

--- A walkway with a rail on both sides along x.
local function walkway(scene, from, to, half, z)
  scene:box("grating", { from, -half, z }, { to, half, z + 0.05 })
  local n = math.ceil((to - from) / 1.6)
  for side = -1, 1, 2 do
    for k = 0, n do
      local x = from + 0.04 + (to - from - 0.08) * k / n
      scene:rod("steel", { x, side * (half - 0.03), z - 0.02 }, { x, side * (half - 0.03), z + 1.08 }, 0.022, 6)
    end
    for r, height in ipairs { 0.55, 1.05 } do
      scene:rod("steel", { from + 0.01 * r, side * (half - 0.03), z + height },
        { to - 0.01 * r, side * (half - 0.03), z + height }, 0.019, 7)
    end
  end
end

--- The turning part up to the ridge where the pendants hang.
local function slewing_unit(scene)
  scene:lathe("steel", { 0, 0, head }, { { 1.05, -0.05 }, { 1.05, 0.2 }, { 0.95, 0.26 }, { 0.95, 0.5 } }, 24)
  scene:box("truss", { -0.95, -0.92, head + 0.42 }, { 0.95, 0.92, head + 1.28 })
  local apex = { -0.55, 0, head + 7.6 }
  for _, p in ipairs { { -0.75, -0.62 }, { 0.75, -0.62 }, { 0.75, 0.62 }, { -0.75, 0.62 } } do
    scene:beam("truss", { p[1], p[2], head + 1.1 }, { apex[1] + 0.15 * p[1], 0.2 * p[2], apex[3] }, 0.13, 0.13)
  end
  for k = 1, 5 do
    local t = k / 6
    local function at(x, y)
      return { x + (apex[1] + 0.15 * x - x) * t, y + (0.2 * y - y) * t, head + 1.1 + (apex[3] - head - 1.1) * t }
    end
    for _, s in ipairs { -1, 1 } do
      scene:rod("truss", at(-0.75, s * 0.62), at(0.75, s * 0.62), 0.035, 7)
      scene:rod("truss", at(s * 0.75, -0.62), at(s * 0.75, 0.62), 0.035, 7)
    end
  end
  scene:box("steel", { apex[1] - 0.28, -0.22, apex[3] - 0.12 }, { apex[1] + 0.28, 0.22, apex[3] + 0.16 })
  scene:lathe("sign_red", { apex[1], 0, apex[3] + 0.1 }, { { 0.09, 0 }, { 0.09, 0.2 }, { 0.04, 0.26 } }, 12)
  return apex
end

local function cabin(scene)
  scene:at({ 1.75, -1.55, head + 0.55 }, 0, function()
    scene:box("cabin", { -1.0, -0.62, -0.05 }, { 0.9, 0.62, 0.16 })
    scene:box("cabin", { -1.02, -0.64, 1.95 }, { 0.86, 0.64, 2.1 })
    scene:box("cabin", { -0.99, -0.61, 0.1 }, { -0.3, 0.61, 2.0 })
    for _, y in ipairs { -0.57, 0.57 } do
      scene:beam("frame", { 0.84, y, 0.1 }, { 0.8, y, 2.0 }, 0.07)
      scene:box("glass", { -0.32, y - 0.012, 0.12 }, { 0.83, y + 0.012, 1.97 })
      scene:box("frame", { -0.31, y - 0.03, 0.88 }, { 0.82, y + 0.03, 0.94 })
    end
    scene:slice("glass", { { 0.85, 0.12 }, { 0.873, 0.12 }, { 0.833, 1.97 }, { 0.81, 1.97 } }, -0.55, 0.55)
    scene:box("interior", { -0.1, -0.24, 0.14 }, { 0.35, 0.24, 0.62 })
    scene:box("interior", { -0.2, -0.22, 0.5 }, { -0.02, 0.22, 1.3 })
  end)
  scene:box("steel", { 0.2, -1.7, head + 0.44 }, { 2.2, -0.7, head + 0.57 })
end

--- A triangular lattice along x between two stations, chord below at +-`half`, one chord above.
local function jib_lattice(scene, from, to, panels, half, z, rise, label)
  local function x_at(k) return from + (to - from) * k / panels end
  for _, y in ipairs { -half, half } do
    scene:beam(label, { from, y, z }, { to, y, z }, 0.12, 0.13)
  end
  scene:beam(label, { x_at(0.5), 0, z + rise }, { x_at(panels - 0.5), 0, z + rise }, 0.13, 0.12)
  for k = 0, panels do
    scene:rod(label, { x_at(k), -half, z }, { x_at(k), half, z }, 0.033, 7)
    if k < panels then
      local top = { x_at(k + 0.5), 0, z + rise }
      for _, y in ipairs { -half, half } do
        scene:rod(label, { x_at(k), y, z }, top, 0.03, 7)
        scene:rod(label, top, { x_at(k + 1) - 0.012, y, z }, 0.03, 7)
      end
      local s = k % 2 == 0 and 1 or -1
      scene:rod(label, { x_at(k) + 0.02, -s * half, z }, { x_at(k + 1) - 0.02, s * half, z }, 0.024, 7)
    end
  end
end

local function pendant(scene, from, to, spread)
  for _, y in ipairs { -spread, spread } do
    local end_y = to[2] == 0 and 0.4 * y or to[2] * y / spread
    scene:rod("cable", { from[1], y, from[3] }, { to[1], end_y, to[3] }, 0.028, 6)
  end
end

local function jib(scene, apex)
  local z, half, rise, tip = head + 0.95, 0.6, 1.25, 33
  jib_lattice(scene, 0.8, tip, 20, half, z, rise, "truss")
  pendant(scene, apex, { 12, 0, z + rise }, 0.12)
  pendant(scene, apex, { 24.5, 0, z + rise }, 0.15)
  scene:box("grating", { 1.2, -0.2, z - 0.03 }, { 30, 0.2, z + 0.01 })
  scene:box("steel", { tip - 0.05, -0.7, z - 0.12 }, { tip + 0.16, 0.7, z + 0.15 })
  scene:box("sign", { 3.9, -0.66, z + 0.14 }, { 8.4, -0.615, z + 1.02 })
  -- trolley, ropes and hook
  local x = 19
  scene:box("steel", { x - 0.8, -0.72, z - 0.34 }, { x + 0.8, 0.72, z - 0.19 })
  for _, dx in ipairs { -0.6, 0.6 } do
    for _, y in ipairs { -half, half } do
      scene:rod("tyre", { x + dx, y - 0.05, z - 0.17 }, { x + dx, y + 0.05, z - 0.17 }, 0.11, 12)
    end
    for _, y in ipairs { -0.09, 0.09 } do
      scene:rod("cable", { x + 0.4 * dx, y, 9.1 }, { x + dx, y, z - 0.25 }, 0.016, 5)
    end
  end
  scene:box("hook", { x - 0.32, -0.15, 8.4 }, { x + 0.32, 0.15, 9.2 })
  scene:rod("hook", { x, 0, 7.7 }, { x, 0, 8.5 }, 0.06, 8)
  scene:sweep("hook", { { x, 0, 7.8 }, { x + 0.2, 0, 7.55 }, { x + 0.16, 0, 7.25 }, { x - 0.1, 0, 7.15 },
    { x - 0.24, 0, 7.32 } }, 0.1, 0.1, { 0, 1, 0 })
end

local function counter_jib(scene, apex)
  local z = head + 0.9
  for _, y in ipairs { -0.62, 0.62 } do
    scene:beam("truss", { -11.4, y, z - 0.05 }, { -0.8, y, z - 0.05 }, 0.14, 0.3)
  end
  for k = 0, 8 do
    local x = -11 + 1.25 * k
    scene:rod("truss", { x, -0.62, z }, { x, 0.62, z }, 0.045, 7)
    if k < 8 then
      local s = k % 2 == 0 and 1 or -1
      scene:rod("truss", { x + 0.02, -0.62 * s, z - 0.06 }, { x + 1.23, 0.62 * s, z - 0.06 }, 0.03, 7)
    end
  end
  walkway(scene, -11.2, -1.05, 1.0, z + 0.12)
  for k = 0, 4 do
    scene:box("concrete_light", { -11.1 + 0.46 * k, -0.52 + 0.012 * k, z - 1.75 }, { -10.69 + 0.46 * k,
      0.52 - 0.012 * k, z + 0.7 + 0.014 * k })
  end
  scene:box("cabinet", { -7.6, -0.6, z + 0.15 }, { -6.1, 0.6, z + 1.35 })
  scene:rod("steel", { -5.2, -0.5, z + 0.62 }, { -5.2, 0.5, z + 0.62 }, 0.36, 20)
  scene:box("steel", { -5.5, -0.46, z + 0.14 }, { -4.9, 0.46, z + 0.34 })
  pendant(scene, apex, { -9.4, 0.62, z }, 0.12)
end

local function container(scene, place, yaw, label)
  scene:at(place, yaw, function()
    scene:box(label, { -3.03, -1.22, 0.02 }, { 3.03, 1.22, 2.55 })
    for k = 0, 29 do
      local x = -2.94 + 0.2 * k
      for _, y in ipairs { -1.215, 1.215 } do
        scene:box(label, { x, y - 0.03, 0.16 }, { x + 0.1, y + 0.03, 2.42 })
      end
    end
    scene:ring("steel", { -3.06, -1.25, -0.05 }, { 3.06, 1.25, 0.14 }, 0.2)
    scene:ring("steel", { -3.065, -1.255, 2.45 }, { 3.065, 1.255, 2.58 }, 0.14)
    scene:box("door", { 3.0, -1.0, 0.2 }, { 3.075, 1.0, 2.36 })
  end)
end

local function pallet(scene, place, yaw, label, random)
  scene:at(place, yaw, function()
    for k = -1, 1 do scene:box("timber", { -0.6, 0.42 * k - 0.06, -0.03 }, { 0.6, 0.42 * k + 0.06, 0.11 }) end
    for k = 0, 3 do
      local d = random(-0.025, 0.025)
      scene:box(label, { -0.55 + d, -0.47 - d, 0.1 + 0.24 * k }, { 0.55 + d, 0.47 - d, 0.345 + 0.24 * k })
    end
  end)
end

--- The shell of a house that is being built: walls with openings, a slab, columns with starter bars.
local function shell(scene)
  scene:box("concrete", { -5.06, -4.06, -0.35 }, { 5.06, 4.06, 0.16 })
  local walls = {
    { { -5, -4 }, { -1.2, -3.64 }, 2.8 }, { { 0.6, -4 }, { 5, -3.64 }, 2.5 }, { { -4.98, -3.7 }, { -4.62, 3.9 }, 3.0 },
    { { 4.6, -3.7 }, { 4.96, 0.8 }, 2.2 }, { { -4.7, 3.55 }, { 2.4, 3.91 }, 1.7 },
  }
  for k, w in ipairs(walls) do
    local low, high = w[1], w[2]
    scene:box("brick_red", { low[1], low[2], 0.06 - 0.011 * k }, { high[1], high[2], w[3] })
  end
  for _, p in ipairs { { -2.4, 0 }, { 1.4, 0.2 }, { 3.9, 3.1 } } do
    scene:box("concrete_light", { p[1] - 0.2, p[2] - 0.2, 0.02 }, { p[1] + 0.2, p[2] + 0.2, 3.1 })
    for _, q in ipairs { { -0.12, -0.12 }, { 0.12, -0.12 }, { 0.12, 0.12 }, { -0.12, 0.12 } } do
      scene:rod("rust", { p[1] + q[1], p[2] + q[2], 2.9 }, { p[1] + q[1], p[2] + q[2], 3.8 }, 0.016, 5)
    end
  end
end

local function fence(scene, low, high)
  local function panel(from, to)
    for r, z in ipairs { 0.2, 1.1, 1.95 } do
      scene:rod("steel", { from[1], from[2], z + 0.002 * r }, { to[1], to[2], z + 0.002 * r }, 0.02, 5)
    end
    for k = 1, 7 do
      local p = between({ from[1], from[2], 0.2 }, { to[1], to[2], 0.2 }, k / 8)
      scene:rod("steel", p, { p[1], p[2], 1.95 }, 0.008, 5)
    end
  end
  local function side(a, b, n)
    for k = 0, n - 1 do
      local from, to = between(a, b, k / n), between(a, b, (k + 0.985) / n)
      panel(from, to)
      scene:rod("steel", { from[1], from[2], -0.1 }, { from[1], from[2], 2.05 }, 0.026, 6)
      scene:at({ from[1], from[2], 0 }, 20 * k, function()
        scene:box("concrete", { -0.35, -0.12, -0.04 }, { 0.35, 0.12, 0.15 })
      end)
    end
  end
  side({ low[1], low[2], 0 }, { high[1], low[2], 0 }, 16)
  side({ high[1], low[2], 0 }, { high[1], high[2], 0 }, 12)
  side({ high[1], high[2], 0 }, { low[1], high[2], 0 }, 16)
  side({ low[1], high[2], 0 }, { low[1], low[2], 0 }, 12)
end

local function site(scene)
  local random = solids.random(8)
  scene:box("soil", { -75, -75, -1.5 }, { 75, 75, 0 })
  scene:box("gravel", { -14, -11.5, -0.4 }, { 28, 11, 0.05 })
  scene:at({ 15, -17, 0 }, 8, function() shell(scene) end)
  container(scene, { -12, 13.5, 0.02 }, 4, "container_blue")
  container(scene, { -4.5, 14.6, 0.02 }, 2, "container_green")
  container(scene, { -5.1, 14.4, 2.6 }, 3, "container_orange")
  container(scene, { -17.5, -3, 0.02 }, 86, "container_orange")
  for k = 0, 8 do
    local place = { 6 + 1.9 * (k % 5) + random(-0.2, 0.2), 12.4 + 2 * (k // 5) + random(-0.2, 0.2), 0.02 }
    pallet(scene, place, random(-12, 12), k % 3 == 1 and "brick_white" or "brick_red", random)
  end
  for k = 0, 11 do
    local row = k < 5 and { k, 0 } or k < 9 and { k - 4.5, 1 } or { k - 8, 2 }
    scene:rod("pipe", { -12, -15 + 0.43 * row[1], 0.2 + 0.37 * row[2] }, { -6 + 0.07 * k, -15 + 0.43 * row[1],
      0.2 + 0.37 * row[2] }, 0.205, 14)
  end
  for k = 0, 6 do
    local z = 0.06 + 0.09 * k
    scene:box("timber", { 20 + random(-0.1, 0.1), 13 + random(-0.1, 0.1), z }, { 24.5 + random(-0.2, 0.2),
      14.4 + random(-0.1, 0.1), z + 0.08 })
  end
  for k = 1, 4 do
    scene:blob("soil", { -20 + 2.2 * k, -17 - k % 2, 0.1 }, { 2.3 + 0.2 * k, 1.9, 0.9 + 0.2 * k }, random, 0.1)
  end
  surroundings.car(scene, { 25, 3, 0.055 }, 100, "van", "car_white")
  surroundings.car(scene, { -9, -19.5, 0.004 }, 12, "van", "car_blue")
  fence(scene, { -27, -25 }, { 34, 24 })
  surroundings.road(scene, { y = -32, z = 0.04, width = 7.5, from = -74.9, to = 74.9 })
  surroundings.car(scene, { 6, -30.2, 0.047 }, 0, "saloon", "car_red")
  surroundings.car(scene, { -22, -33.7, 0.047 }, 180, "saloon", "car_silver")
  for k = 0, 4 do surroundings.street_lamp(scene, { -36 + 18 * k, -37, 0 }, 90, 6.5) end
  for k, p in ipairs { { -33, 20 }, { -36, 4 }, { -34, -12 }, { 40, 18 }, { 41, -8 }, { 4, 30 }, { -16, 31 } } do
    surroundings.tree(scene, { p[1], p[2], 0 }, 6.5 + (k * 29 % 7) / 2, 300 + k)
  end
  surroundings.brick_buildings(scene, { seed = 5, count = 18, near = 52, far = 62, low = 9, high = 24,
    skip = function(_, y) return math.abs(y + 32) < 13 end })
end

return {
  name = "crane",
  asset = { low = { -mast, -mast, 0 }, high = { mast, mast, head } },
  --- Faces that are of the asset alone.
  labels = { "truss", "cabin", "frame", "cable", "grating", "sign", "hook", "cabinet" },
  jib = { from = { 0.8, 0, head + 1.5 }, to = { 33, 0, head + 1.5 } },
  crop = { min = { -13, -4, -0.5 }, max = { 35, 4, 42 } },
  build = function()
    local scene = solids.new()
    site(scene)
    base(scene)
    lattice_mast(scene)
    ladder(scene)
    local apex = slewing_unit(scene)
    cabin(scene)
    jib(scene, apex)
    counter_jib(scene, apex)
    return scene
  end,
}
