-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Scenes out of closed solids with a label each: what the generators in scenes/ are written with.
---
---   local solids = require "solids"
---   local scene = solids.new()
---   scene:box("wall", { 0, 0, 0 }, { 4, 0.2, 3 })
---   scene:save "scene.ply"
---
--- Metres, z up. Every call adds one watertight solid whose faces point outwards. Solids may reach into each other, and
--- neighbours should (a post stands 5 cm deep in its slab): faces that lie in one plane and overlap are black in a
--- render and have two labels in the truth. `checks.lua` finds them.
local vector = require "vector"

local add, sub, mul, cross, unit = vector.add, vector.sub, vector.mul, vector.cross, vector.unit

local M = {}
M.__index = M

--- A scene without solids. Its numbers are flat: `vertices` has x, y, z, ...; `triangles` indices from 0; `labels` one
--- number a triangle, for `names` from 0; `starts` the first triangle of each solid.
function M.new()
  return setmetatable({ vertices = {}, triangles = {}, labels = {}, names = {}, starts = {}, frames = {} }, M)
end

local function label_number(scene, name)
  for k, known in ipairs(scene.names) do
    if known == name then return k - 1 end
  end
  scene.names[#scene.names + 1] = name
  return #scene.names - 1
end

--- Six times the volume inside of triangles that face outwards.
local function volume(points, triangles)
  local sum = 0
  for _, t in ipairs(triangles) do sum = sum + vector.dot(points[t[1]], cross(points[t[2]], points[t[3]])) end
  return sum
end

local function fans(faces)
  local triangles = {}
  for _, face in ipairs(faces) do
    for k = 2, #face - 1 do triangles[#triangles + 1] = { face[1], face[k], face[k + 1] } end
  end
  return triangles
end

--- Adds a closed solid from its corners and its convex faces, lists of corners (from 1) with one sense of rotation.
function M:add(label, points, faces)
  local triangles, number = fans(faces), label_number(self, label)
  local flip = volume(points, triangles) < 0
  local first = #self.vertices // 3 - 1
  self.starts[#self.starts + 1] = #self.labels + 1
  for _, p in ipairs(points) do
    for k = #self.frames, 1, -1 do p = self.frames[k](p) end
    for axis = 1, 3 do self.vertices[#self.vertices + 1] = p[axis] end
  end
  for _, t in ipairs(triangles) do
    local a, b, c = t[1], t[2], t[3]
    if flip then b, c = c, b end
    local n = #self.triangles
    self.triangles[n + 1], self.triangles[n + 2], self.triangles[n + 3] = first + a, first + b, first + c
    self.labels[#self.labels + 1] = number
  end
end

--- What `build` adds stands at `place`, turned about the vertical.
function M:at(place, yaw_deg, build)
  local c, s = math.cos(math.rad(yaw_deg)), math.sin(math.rad(yaw_deg))
  self.frames[#self.frames + 1] = function(p)
    return { place[1] + c * p[1] - s * p[2], place[2] + s * p[1] + c * p[2], place[3] + p[3] }
  end
  build()
  self.frames[#self.frames] = nil
end

--- A solid between rings of equally many points: `rings[1]` and the last are its (convex) ends.
function M:loft(label, rings)
  local points, faces, n = {}, {}, #rings[1]
  for _, ring in ipairs(rings) do table.move(ring, 1, n, #points + 1, points) end
  local front, back = {}, {}
  for k = 1, n do front[k], back[k] = n + 1 - k, (#rings - 1) * n + k end
  faces[1], faces[2] = front, back
  for r = 0, #rings - 2 do
    for k = 1, n do
      local a, b = r * n + k, r * n + k % n + 1
      faces[#faces + 1] = { a, b, b + n, a + n }
    end
  end
  self:add(label, points, faces)
end

function M:box(label, low, high)
  local function ring(z)
    return { { low[1], low[2], z }, { high[1], low[2], z }, { high[1], high[2], z }, { low[1], high[2], z } }
  end
  self:loft(label, { ring(low[3]), ring(high[3]) })
end

--- A convex polygon of { x, y } between two heights.
function M:prism(label, polygon, bottom, top)
  local rings = { {}, {} }
  for k, p in ipairs(polygon) do rings[1][k], rings[2][k] = { p[1], p[2], bottom }, { p[1], p[2], top } end
  self:loft(label, rings)
end

--- A convex polygon of { x, z } between two y.
function M:slice(label, polygon, from, to)
  local rings = { {}, {} }
  for k, p in ipairs(polygon) do rings[1][k], rings[2][k] = { p[1], from, p[2] }, { p[1], to, p[2] } end
  self:loft(label, rings)
end

--- Two directions that are square to `along` and to each other; the second is `up` where that can be.
local function across(along, up)
  up = up or (math.abs(along[3]) > 0.95 and { 1, 0, 0 } or { 0, 0, 1 })
  local side = unit(cross(along, up))
  return side, cross(side, along)
end

local function section_at(centre, side, up, outline)
  local ring = {}
  for k, p in ipairs(outline) do ring[k] = add(centre, add(mul(side, p[1]), mul(up, p[2]))) end
  return ring
end

local function rectangle(width, height)
  local a, b = width / 2, height / 2
  return { { -a, -b }, { a, -b }, { a, b }, { -a, b } }
end

--- Turned a little: flat sides of two rods in one plane would overlap where they meet.
local function circle(radius, sides)
  local outline = {}
  for k = 1, sides do
    local angle = 2 * math.pi * k / sides + 0.2
    outline[k] = { radius * math.cos(angle), radius * math.sin(angle) }
  end
  return outline
end

--- A bar of rectangular section from p to q.
function M:beam(label, p, q, width, height, up_hint)
  local side, up = across(unit(sub(q, p)), up_hint)
  local outline = rectangle(width, height or width)
  self:loft(label, { section_at(p, side, up, outline), section_at(q, side, up, outline) })
end

--- A round bar from p to q; `end_radius` makes it taper.
function M:rod(label, p, q, radius, sides, end_radius)
  local side, up = across(unit(sub(q, p)))
  self:loft(label, {
    section_at(p, side, up, circle(radius, sides or 6)),
    section_at(q, side, up, circle(end_radius or radius, sides or 6)),
  })
end

--- A rectangular section along a path in a vertical plane whose sideways direction is `side`.
function M:sweep(label, path, width, height, side)
  local rings, outline = {}, rectangle(width, height)
  for k, p in ipairs(path) do
    local along = unit(sub(path[math.min(k + 1, #path)], path[math.max(k - 1, 1)]))
    rings[k] = section_at(p, side, cross(side, along), outline)
  end
  self:loft(label, rings)
end

--- A solid of revolution about the vertical through `centre`, from { radius, z } pairs, both ends closed.
function M:lathe(label, centre, profile, sides)
  local rings = {}
  for k, p in ipairs(profile) do
    rings[k] = {}
    for i, q in ipairs(circle(p[1], sides or 16)) do rings[k][i] = add(centre, { q[1], q[2], p[2] }) end
  end
  self:loft(label, rings)
end

--- A wall of `thickness` that goes round inside of the rectangle from `low` to `high`.
function M:ring(label, low, high, thickness)
  local points = {}
  for _, z in ipairs { low[3], high[3] } do
    for _, t in ipairs { 0, thickness } do
      for _, p in ipairs { { low[1] + t, low[2] + t }, { high[1] - t, low[2] + t }, { high[1] - t, high[2] - t },
        { low[1] + t, high[2] - t } } do points[#points + 1] = { p[1], p[2], z } end
    end
  end
  local faces = {}
  for k = 1, 4 do
    local n = k % 4 + 1
    faces[#faces + 1] = { k, n, n + 8, k + 8 }              -- outside
    faces[#faces + 1] = { n + 4, k + 4, k + 12, n + 12 }    -- inside
    faces[#faces + 1] = { k + 8, n + 8, n + 12, k + 12 }    -- top
    faces[#faces + 1] = { n, k, k + 4, n + 4 }              -- bottom
  end
  self:add(label, points, faces)
end

local function icosahedron()
  local g = (1 + math.sqrt(5)) / 2
  local points = {}
  for _, p in ipairs { { -1, g, 0 }, { 1, g, 0 }, { -1, -g, 0 }, { 1, -g, 0 }, { 0, -1, g }, { 0, 1, g },
    { 0, -1, -g }, { 0, 1, -g }, { g, 0, -1 }, { g, 0, 1 }, { -g, 0, -1 }, { -g, 0, 1 } } do
    points[#points + 1] = unit(p)
  end
  return points, { { 1, 12, 6 }, { 1, 6, 2 }, { 1, 2, 8 }, { 1, 8, 11 }, { 1, 11, 12 }, { 2, 6, 10 }, { 6, 12, 5 },
    { 12, 11, 3 }, { 11, 8, 7 }, { 8, 2, 9 }, { 4, 10, 5 }, { 4, 5, 3 }, { 4, 3, 7 }, { 4, 7, 9 }, { 4, 9, 10 },
    { 5, 10, 6 }, { 3, 5, 12 }, { 7, 3, 11 }, { 9, 7, 8 }, { 10, 9, 2 } }
end

--- Each triangle in four, corners on the unit sphere.
local function subdivided(points, faces)
  local middles, finer = {}, {}
  local function middle(a, b)
    local key = math.min(a, b) * 65536 + math.max(a, b)
    if not middles[key] then
      points[#points + 1] = unit(add(points[a], points[b]))
      middles[key] = #points
    end
    return middles[key]
  end
  for _, f in ipairs(faces) do
    local ab, bc, ca = middle(f[1], f[2]), middle(f[2], f[3]), middle(f[3], f[1])
    for _, t in ipairs { { f[1], ab, ca }, { f[2], bc, ab }, { f[3], ca, bc }, { ab, bc, ca } } do
      finer[#finer + 1] = t
    end
  end
  return points, finer
end

--- A lumpy ball, as crowns of trees and boulders are: radii { x, y, z } changed by up to `roughness`.
function M:blob(label, centre, radii, random, roughness)
  local points, faces = icosahedron()
  points, faces = subdivided(points, faces)
  points, faces = subdivided(points, faces)
  for k, p in ipairs(points) do
    local r = 1 + roughness * random(-1, 1)
    points[k] = add(centre, { r * radii[1] * p[1], r * radii[2] * p[2], r * radii[3] * p[3] })
  end
  self:add(label, points, faces)
end

--- Numbers in [low, high) that depend on the seed alone (SplitMix64).
function M.random(seed)
  local state = seed
  return function(low, high)
    state = state + 0x9e3779b97f4a7c15
    local z = state
    z = (z ~ (z >> 30)) * 0xbf58476d1ce4e5b9
    z = (z ~ (z >> 27)) * 0x94d049bb133111eb
    return low + (high - low) * (((z ~ (z >> 31)) >> 11) * 0x1p-53)
  end
end

--- Binary PLY: float vertices, triangles, `label` of each, names in a comment, as aib.io.read_mesh takes it.
function M:ply()
  local names = {}
  for k, name in ipairs(self.names) do names[k] = ("%d=%s"):format(k - 1, name) end
  local parts = { table.concat({
    "ply", "format binary_little_endian 1.0", "comment labels: " .. table.concat(names, " "),
    ("element vertex %d"):format(#self.vertices // 3), "property float x", "property float y", "property float z",
    ("element face %d"):format(#self.labels), "property list uchar int vertex_indices", "property int label",
    "end_header\n",
  }, "\n") }
  for k = 1, #self.vertices, 3 do
    parts[#parts + 1] = ("<fff"):pack(self.vertices[k], self.vertices[k + 1], self.vertices[k + 2])
  end
  for k, label in ipairs(self.labels) do
    parts[#parts + 1] = ("<Bi4i4i4i4"):pack(3, self.triangles[3 * k - 2], self.triangles[3 * k - 1],
      self.triangles[3 * k], label)
  end
  return table.concat(parts)
end

function M:save(path)
  local aib = require "aib"
  aib.system.write_text(path, self:ply())
end

return M
