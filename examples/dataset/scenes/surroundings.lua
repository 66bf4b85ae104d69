-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What stands round an asset: brick buildings, trees, cars, lamps, roads.
local solids = require "solids"

local M = {}

local bricks <const> = { "brick_red", "brick_yellow", "brick_white" }

--- A windowless brick building with a plinth, a band and a flat roof.
local function brick_building(scene, label, width, depth, height)
  local x, y = width / 2, depth / 2
  scene:box(label, { -x, -y, -0.45 }, { x, y, height })
  scene:box("concrete", { -x - 0.08, -y - 0.08, -0.25 }, { x + 0.08, y + 0.08, 0.55 })
  scene:ring("concrete", { -x - 0.06, -y - 0.06, 0.66 * height }, { x + 0.06, y + 0.06, 0.66 * height + 0.3 }, 0.4)
  scene:ring("coping", { -x - 0.1, -y - 0.1, height - 0.4 }, { x + 0.1, y + 0.1, height + 0.25 }, 0.5)
end

--- `count` brick buildings on a ring: no two are alike.
function M.brick_buildings(scene, options)
  local random, share = solids.random(options.seed), 2 * math.pi * options.near / options.count
  for k = 1, options.count do
    local angle = (k + random(-0.08, 0.08)) * 360 / options.count + (options.turn or 0)
    local radius = random(options.near, options.far)
    local x, y = radius * math.cos(math.rad(angle)), radius * math.sin(math.rad(angle))
    local width, depth, height = random(7, 12), random(0.5, 0.72) * share, random(options.low, options.high)
    local turn = angle + random(-8, 8)
    if not options.skip or not options.skip(x, y) then
      scene:at({ x, y, options.z and options.z(x, y) or 0 }, turn, function()
        brick_building(scene, bricks[k % 3 + 1], width, depth, height)
      end)
    end
  end
end

--- A tree: trunk, branches and a crown of overlapping lumps; `size` is its height.
function M.tree(scene, place, size, seed)
  local random = solids.random(seed)
  scene:at(place, random(0, 360), function()
    local fork = { 0.02 * size, 0, 0.38 * size }
    scene:rod("bark", { 0, 0, -0.3 }, fork, 0.035 * size, 9, 0.022 * size)
    for k = 1, 6 do
      local angle, reach = math.rad(60 * k + random(-20, 20)), random(0.12, 0.24) * size
      local tip = { reach * math.cos(angle), reach * math.sin(angle), random(0.52, 0.8) * size }
      scene:rod("bark", { 0.01 * size, 0, 0.33 * size + 0.002 * k }, tip, 0.014 * size, 5, 0.006 * size)
      local r = random(0.13, 0.19) * size
      scene:blob("foliage", tip, { r, r * random(0.9, 1.1), r * random(0.7, 0.9) }, random, 0.16)
    end
    local r = 0.18 * size
    scene:blob("foliage", { 0, 0, 0.83 * size }, { r, r, 0.85 * r }, random, 0.16)
  end)
end

--- Ring of a car's body: half width `w` between the heights `bottom` and `top`, edges cut.
local function body_section(x, w, bottom, top)
  local c = 0.12
  return { { x, -w, bottom + c }, { x, -w + c, bottom }, { x, w - c, bottom }, { x, w, bottom + c }, { x, w, top - c },
    { x, w - c, top }, { x, -w + c, top }, { x, -w, top - c } }
end

local function roof_section(from, to, w, z)
  return { { from, -w, z }, { to, -w, z }, { to, w, z }, { from, w, z } }
end

local function wheel(scene, x, side)
  scene:rod("tyre", { x, side * 0.58, 0.32 }, { x, side * 0.875, 0.32 }, 0.32, 18)
  scene:rod("metal", { x, side * 0.7, 0.32 }, { x, side * 0.885, 0.32 }, 0.19, 14)
end

--- A car of 4.4 m; `kind` is "saloon" or "van", `paint` the label of its body.
function M.car(scene, place, yaw_deg, kind, paint)
  local top = kind == "van" and 1.95 or 1.46
  scene:at(place, yaw_deg, function()
    scene:loft(paint, {
      body_section(-2.2, 0.74, 0.42, 0.78), body_section(-2.1, 0.84, 0.26, 0.92), body_section(-1.2, 0.88, 0.22, 0.97),
      body_section(0.6, 0.88, 0.22, 0.95), body_section(1.7, 0.86, 0.23, 0.82), body_section(2.1, 0.8, 0.27, 0.72),
      body_section(2.2, 0.66, 0.36, 0.62),
    })
    local back, front = kind == "van" and -2.02 or -1.62, kind == "van" and 1.0 or 0.2
    local rear = kind == "van" and -1.98 or -1.05
    scene:loft("car_glass", { roof_section(back - 0.06, 1.12, 0.8, 0.86), roof_section(rear, front, 0.63, top) })
    scene:loft(paint, { roof_section(rear - 0.05, front + 0.05, 0.66, top - 0.03),
      roof_section(rear + 0.12, front - 0.12, 0.56, top + 0.05) })
    for _, side in ipairs { -1, 1 } do
      wheel(scene, -1.32, side)
      wheel(scene, 1.35, side)
      scene:box("light", { 2.05, side * 0.55 - 0.15, 0.52 }, { 2.195, side * 0.55 + 0.15, 0.61 })
      scene:box("sign_red", { -2.215, side * 0.58 - 0.12, 0.6 }, { -2.1, side * 0.58 + 0.12, 0.72 })
      scene:box(paint, { 0.42, side * 0.93 - 0.09, 0.98 }, { 0.56, side * 0.93 + 0.09, 1.1 })
    end
  end)
end

--- A street lamp with an arm towards its yaw direction.
function M.street_lamp(scene, place, yaw_deg, height)
  scene:at(place, yaw_deg, function()
    scene:lathe("metal", { 0, 0, 0 }, { { 0.13, -0.2 }, { 0.13, 0.7 }, { 0.075, 0.8 }, { 0.045, height } }, 10)
    scene:rod("metal", { -0.03, 0, height - 0.08 }, { 1.35, 0, height + 0.18 }, 0.032, 6)
    scene:loft("metal", {
      { { 1.1, -0.09, height + 0.13 }, { 1.1, 0.09, height + 0.13 }, { 1.1, 0.07, height + 0.22 },
        { 1.1, -0.07, height + 0.22 } },
      { { 1.75, -0.13, height + 0.22 }, { 1.75, 0.13, height + 0.22 }, { 1.75, 0.1, height + 0.3 },
        { 1.75, -0.1, height + 0.3 } },
    })
    scene:box("light", { 1.3, -0.08, height + 0.12 }, { 1.7, 0.08, height + 0.205 })
  end)
end

--- A straight road along x: kerbs, dashes in the middle, lines at the sides. `z` is the height of its surface.
function M.road(scene, options)
  local y, z, half, from, to = options.y, options.z, options.width / 2, options.from, options.to
  scene:box("road", { from, y - half, z - 0.4 }, { to, y + half, z })
  for _, side in ipairs { -1, 1 } do
    local edge = y + side * half
    scene:box("kerb", { from + 0.01, edge - 0.11, z - 0.37 }, { to - 0.01, edge + 0.13, z + 0.12 })
    local line = edge - side * 0.45
    scene:box("marking", { from + 0.02, line - 0.06, z - 0.03 }, { to - 0.02, line + 0.06, z + 0.006 })
  end
  local x = from + 1.5
  while x + 3 < to do
    scene:box("marking", { x, y - 0.07, z - 0.03 }, { x + 3, y + 0.07, z + 0.006 })
    x = x + 7
  end
end

--- A bench of slats on two feet.
function M.bench(scene, place, yaw_deg)
  scene:at(place, yaw_deg, function()
    for _, x in ipairs { -0.7, 0.7 } do scene:box("concrete", { x - 0.09, -0.22, -0.1 }, { x + 0.09, 0.22, 0.42 }) end
    for k = -2, 2 do scene:box("timber", { -1, 0.1 * k - 0.04, 0.405 }, { 1, 0.1 * k + 0.04, 0.455 }) end
  end)
end

return M
