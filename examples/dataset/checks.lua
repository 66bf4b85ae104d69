-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What a scene of solids must hold: every solid is closed and faces outwards, no two triangles of a plane overlap.
local vector = require "vector"

local cross, dot = vector.cross, vector.dot

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

--- Unit normal of a triangle with its first significant number positive, and the distance of its plane from the origin;
--- nil without an area.
local function plane_of(scene, triangle)
  local t, v = scene.triangles, scene.vertices
  local i, j, k = 3 * t[3 * triangle - 2], 3 * t[3 * triangle - 1], 3 * t[3 * triangle]
  local ax, ay, az = v[i + 1], v[i + 2], v[i + 3]
  local bx, by, bz = v[j + 1] - ax, v[j + 2] - ay, v[j + 3] - az
  local cx, cy, cz = v[k + 1] - ax, v[k + 2] - ay, v[k + 3] - az
  local x, y, z = by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx
  local length = math.sqrt(x * x + y * y + z * z)
  if length < 1e-9 then return nil end
  local first = math.abs(x) > 1e-6 * length and x or math.abs(y) > 1e-6 * length and y or z
  if first < 0 then length = -length end
  x, y, z = x / length, y / length, z / length
  return { x, y, z }, x * ax + y * ay + z * az
end

--- Two directions in a plane, square to each other.
local function axes_in(normal)
  local x = vector.unit(cross(math.abs(normal[3]) > 0.9 and { 1, 0, 0 } or { 0, 0, 1 }, normal))
  return { x, cross(normal, x) }
end

--- Triangle in the axes of its plane, counter-clockwise, with its bounds.
local function flattened(scene, triangle, axes)
  local x, y = axes[1], axes[2]
  local flat = {}
  for k = 1, 3 do
    local p = corner(scene, triangle, k)
    flat[k] = { dot(x, p), dot(y, p) }
  end
  if area(flat) < 0 then flat[2], flat[3] = flat[3], flat[2] end
  local a, b, c = flat[1], flat[2], flat[3]
  flat.low, flat.high = math.min(a[1], b[1], c[1]), math.max(a[1], b[1], c[1])
  flat.bottom, flat.top = math.min(a[2], b[2], c[2]), math.max(a[2], b[2], c[2])
  return flat
end

--- A number for a direction, equal for those that agree to four decimals.
local function direction_key(normal)
  local key = 0
  for axis = 1, 3 do key = key << 15 | math.floor(10000 * normal[axis] + 10000.5) end
  return key
end

--- Triangles by their plane; a plane within `tolerance` of the border of its cell is in both cells.
local function by_plane(scene, tolerance)
  local planes, axes = {}, {}
  for t = 1, #scene.labels do
    local normal, offset = plane_of(scene, t)
    if normal then
      local direction = direction_key(normal)
      axes[direction] = axes[direction] or axes_in(normal)
      local flat = flattened(scene, t, axes[direction])
      flat.triangle, flat.offset = t, offset
      local cell = 10 * tolerance
      local first, last = math.floor((offset - tolerance) / cell), math.floor((offset + tolerance) / cell)
      for k = first, last do
        local key = direction << 19 | k & 0x7ffff
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
        if b.bottom < a.top and a.bottom < b.top and math.abs(a.offset - b.offset) < tolerance then
          local first, second = math.min(a.triangle, b.triangle), math.max(a.triangle, b.triangle)
          local pair = solid_of[first] << 32 | solid_of[second]
          local shared = seen[pair] and 0 or shared_area(a, b)
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
