-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What a scene of solids must hold: every solid is closed and faces outwards, no two triangles of a plane overlap.
local vector = require "vector"

local sub, cross, dot = vector.sub, vector.cross, vector.dot

local M = {}

local function corner(scene, triangle, k)
  local v = 3 * scene.triangles[3 * triangle - 3 + k]
  return { scene.vertices[v + 1], scene.vertices[v + 2], scene.vertices[v + 3] }
end

local function corners(scene, triangle)
  return corner(scene, triangle, 1), corner(scene, triangle, 2), corner(scene, triangle, 3)
end

local function label_of(scene, triangle) return scene.names[scene.labels[triangle] + 1] end

--- What is wrong with the solids, a sentence each: an edge without its partner, a volume that is not positive.
function M.solids(scene)
  local wrong = {}
  for s, first in ipairs(scene.starts) do
    local last, edges, volume = (scene.starts[s + 1] or #scene.labels + 1) - 1, {}, 0
    for t = first, last do
      local a, b, c = corners(scene, t)
      volume = volume + dot(a, cross(b, c)) / 6
      for k = 1, 3 do
        local from, to = scene.triangles[3 * t - 3 + k], scene.triangles[3 * t - 3 + k % 3 + 1]
        edges[from << 32 | to] = (edges[from << 32 | to] or 0) + 1
      end
    end
    for edge, n in pairs(edges) do
      if n ~= 1 or edges[(edge & 0xffffffff) << 32 | edge >> 32] ~= 1 then
        wrong[#wrong + 1] = ("solid %d (%s) is not closed"):format(s, label_of(scene, first))
        break
      end
    end
    if volume <= 0 then
      wrong[#wrong + 1] = ("solid %d (%s) has the volume %g"):format(s, label_of(scene, first), volume)
    end
  end
  return wrong
end

--- The part of a convex polygon of { x, y } left of the line from p to q.
local function clipped(polygon, p, q)
  local kept, n = {}, #polygon
  local function side(r) return (q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1]) end
  for k, a in ipairs(polygon) do
    local b = polygon[k % n + 1]
    local at_a, at_b = side(a), side(b)
    if at_a >= 0 then kept[#kept + 1] = a end
    if (at_a > 0 and at_b < 0) or (at_a < 0 and at_b > 0) then
      local s = at_a / (at_a - at_b)
      kept[#kept + 1] = { a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2]) }
    end
  end
  return kept
end

local function area(polygon)
  local sum = 0
  for k, a in ipairs(polygon) do
    local b = polygon[k % #polygon + 1]
    sum = sum + a[1] * b[2] - a[2] * b[1]
  end
  return sum / 2
end

local function shared_area(a, b)
  local polygon = a
  for k = 1, 3 do
    polygon = clipped(polygon, b[k], b[k % 3 + 1])
    if #polygon < 3 then return 0 end
  end
  return area(polygon)
end

--- Unit normal with its first significant number positive, and the distance of the plane from the origin.
local function plane_of(a, b, c)
  local n = cross(sub(b, a), sub(c, a))
  local length = vector.length(n)
  if length < 1e-9 then return nil end
  n = vector.mul(n, 1 / length)
  for axis = 1, 3 do
    if math.abs(n[axis]) > 1e-6 then
      if n[axis] < 0 then n = vector.mul(n, -1) end
      break
    end
  end
  return n, dot(n, a)
end

--- Triangle in its plane, counter-clockwise, with its bounds.
local function flattened(a, b, c, normal)
  local u = math.abs(normal[3]) > 0.9 and { 1, 0, 0 } or { 0, 0, 1 }
  local x = vector.unit(cross(u, normal))
  local y = cross(normal, x)
  local flat = {}
  for k, p in ipairs { a, b, c } do flat[k] = { dot(x, p), dot(y, p) } end
  if area(flat) < 0 then flat[2], flat[3] = flat[3], flat[2] end
  flat.low = math.min(flat[1][1], flat[2][1], flat[3][1])
  flat.high = math.max(flat[1][1], flat[2][1], flat[3][1])
  flat.bottom = math.min(flat[1][2], flat[2][2], flat[3][2])
  flat.top = math.max(flat[1][2], flat[2][2], flat[3][2])
  return flat
end

--- Triangles by their plane; a plane within `tolerance` of the border of its cell is in both cells.
local function by_plane(scene, tolerance)
  local planes = {}
  for t = 1, #scene.labels do
    local a, b, c = corners(scene, t)
    local normal, offset = plane_of(a, b, c)
    if normal then
      local flat = flattened(a, b, c, normal)
      flat.triangle, flat.offset = t, offset
      local direction = ("%.4f %.4f %.4f"):format(normal[1] + 0.0, normal[2] + 0.0, normal[3] + 0.0):gsub("%-0%.0000",
        "0.0000")
      local cell = 10 * tolerance
      local first, last = math.floor((offset - tolerance) / cell), math.floor((offset + tolerance) / cell)
      for k = first, last do
        local key = direction .. " " .. k
        planes[key] = planes[key] or {}
        table.insert(planes[key], flat)
      end
    end
  end
  return planes
end

--- Pairs of triangles that lie in one plane (within `tolerance`, metres) and share area: { a =, b =, area =, where = }
--- with the labels of both, one for each pair of solids.
function M.overlaps(scene, tolerance)
  tolerance = tolerance or 2e-4
  local solid_of, solid = {}, 0
  for t = 1, #scene.labels do
    if scene.starts[solid + 1] == t then solid = solid + 1 end
    solid_of[t] = solid
  end
  local found, seen = {}, {}
  for _, plane in pairs(by_plane(scene, tolerance)) do
    table.sort(plane, function(a, b) return a.low < b.low or (a.low == b.low and a.triangle < b.triangle) end)
    for i, a in ipairs(plane) do
      for j = i + 1, #plane do
        local b = plane[j]
        if b.low >= a.high then break end
        local first, second = math.min(a.triangle, b.triangle), math.max(a.triangle, b.triangle)
        local pair = solid_of[first] << 32 | solid_of[second]
        if not seen[pair] and b.bottom < a.top and a.bottom < b.top and math.abs(a.offset - b.offset) < tolerance then
          local shared = shared_area(a, b)
          if shared > 1e-6 then
            seen[pair] = true
            found[#found + 1] = {
              a = label_of(scene, first), b = label_of(scene, second), area = shared,
              where = corner(scene, second, 1), triangle = first,
            }
          end
        end
      end
    end
  end
  table.sort(found, function(a, b) return a.triangle < b.triangle end)
  return found
end

return M
