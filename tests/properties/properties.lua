-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What the properties share: seeded cases, made-up points, poses and maps, and the definitions' own arithmetic.
local aib = require "aib"

local M = {}

--- A suite of properties { n, case }: each is held against n cases. Every case begins from its own seed, which a
--- failure names.
function M.suite(properties)
  local cases, total = {}, 0
  for name, property in pairs(properties) do
    local n <const>, case <const> = property[1], property[2]
    total = total + n
    cases[name] = function(t)
      for seed = 1, n do
        math.randomseed(seed)
        local ok, e = pcall(case, t)
        if not ok then error(("seed %d: %s"):format(seed, tostring(e)), 0) end
      end
    end
  end
  print(total .. " seeded cases")
  return aib.test(cases)
end

function M.near(t, found, expected, what) t:near(found, expected, 1e-9 + 1e-7 * math.abs(expected), what) end

--- For what has gone through floats.
function M.coarse(t, found, expected, what) t:near(found, expected, 1e-4 + 1e-4 * math.abs(expected), what) end

-- Lists and numbers --------------------------------------------------------------------------------------------------

function M.random(low, high) return low + (high - low) * math.random() end

function M.list(n, make)
  local t = {}
  for i = 1, n do t[i] = make(i) end
  return t
end

function M.shuffled(values)
  local out = table.move(values, 1, #values, 1, {})
  for i = #out, 2, -1 do
    local j = math.random(i)
    out[i], out[j] = out[j], out[i]
  end
  return out
end

function M.sorted(values)
  local out = table.move(values, 1, #values, 1, {})
  table.sort(out)
  return out
end

function M.mean(values)
  local sum = 0
  for _, v in ipairs(values) do sum = sum + v end
  return sum / #values
end

function M.median(values)
  local s, n = M.sorted(values), #values
  return n % 2 == 1 and s[n // 2 + 1] or (s[n // 2] + s[n // 2 + 1]) / 2
end

--- Share of the values strictly below a threshold.
function M.share_below(values, tau)
  local n = 0
  for _, v in ipairs(values) do n = v < tau and n + 1 or n end
  return n / #values
end

-- Vectors and rotations ----------------------------------------------------------------------------------------------

function M.vector(size) return { M.random(-size, size), M.random(-size, size), M.random(-size, size) } end
function M.minus(a, b) return { a[1] - b[1], a[2] - b[2], a[3] - b[3] } end
function M.dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end
function M.cross(a, b) return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] } end
function M.norm(a) return math.sqrt(M.dot(a, a)) end
function M.distance(a, b) return M.norm(M.minus(a, b)) end
function M.scaled(a, factor) return { a[1] * factor, a[2] * factor, a[3] * factor } end
function M.unit(a) return M.scaled(a, 1 / M.norm(a)) end

--- Angle between two vectors in degrees, exact near 0 and 180 too.
function M.angle_deg(a, b) return math.deg(math.atan(M.norm(M.cross(a, b)), M.dot(a, b))) end

--- R' v of a matrix of three rows.
function M.turned_back(rows, v)
  return M.list(3, function(c) return rows[1][c] * v[1] + rows[2][c] * v[2] + rows[3][c] * v[3] end)
end

--- A' B of two matrices.
function M.from_to(a, b)
  return M.list(3, function(r)
    return M.list(3, function(c) return a[1][r] * b[1][c] + a[2][r] * b[2][c] + a[3][r] * b[3][c] end)
  end)
end

--- Angle of a rotation in degrees.
function M.rotation_deg(m)
  local axis = { m[3][2] - m[2][3], m[1][3] - m[3][1], m[2][1] - m[1][2] }
  return math.deg(math.atan(M.norm(axis), m[1][1] + m[2][2] + m[3][3] - 1))
end

--- A rotation of random axis, by a random angle or this one, three rows (Rodrigues).
function M.rotation(angle)
  local x, y, z = table.unpack(M.unit(M.vector(1)))
  local a = angle or M.random(-3, 3)
  local c, s, d = math.cos(a), math.sin(a), 1 - math.cos(a)
  return {
    { c + x * x * d, x * y * d - z * s, x * z * d + y * s },
    { y * x * d + z * s, c + y * y * d, y * z * d - x * s },
    { z * x * d - y * s, z * y * d + x * s, c + z * z * d },
  }
end

function M.rigid() return aib.math.sim3 { rotation = M.rotation(), translation = M.vector(3) } end
function M.similarity()
  return aib.math.sim3 { scale = M.random(0.3, 3), rotation = M.rotation(), translation = M.vector(3) }
end

-- Poses --------------------------------------------------------------------------------------------------------------

function M.walk(n)
  return aib.pose.trajectory(M.list(n, function()
    return aib.math.pose { rotation = M.rotation(), centre = M.vector(2) }
  end))
end

--- The trajectory with each pose a little off.
function M.disturbed(trajectory, size)
  return aib.pose.trajectory(M.list(#trajectory, function(i)
    local offset = aib.math.sim3 { rotation = M.rotation(M.random(0, size)), translation = M.vector(size) }
    return offset * trajectory[i]
  end))
end

-- Points -------------------------------------------------------------------------------------------------------------

function M.points(n, size) return M.list(n, function() return M.vector(size or 1) end) end
function M.cloud(n, size) return aib.cloud.from_points(M.points(n, size)) end

--- Distance from a point to the nearest of others, and its place among them.
function M.nearest(p, others)
  local least, at = math.huge, nil
  for i, q in ipairs(others) do
    local d = M.distance(p, q)
    if d < least then least, at = d, i end
  end
  return least, at
end

--- A cloud with normals, labels or both, which scripts get from files alone.
function M.cloud_with(points, fields)
  local names, lines = { "x", "y", "z" }, {}
  if fields.normals then table.move({ "nx", "ny", "nz" }, 1, 3, 4, names) end
  local text = "ply\nformat ascii 1.0\nelement vertex " .. #points .. "\n"
  for _, name in ipairs(names) do text = text .. "property double " .. name .. "\n" end
  if fields.labels then text = text .. "property uint label\n" end
  for i, p in ipairs(points) do
    local row = { ("%.17g %.17g %.17g"):format(table.unpack(p)) }
    if fields.normals then row[2] = ("%.17g %.17g %.17g"):format(table.unpack(fields.normals[i])) end
    if fields.labels then row[#row + 1] = fields.labels[i] end
    lines[i] = table.concat(row, " ")
  end
  return M.through_file(".ply", text .. "end_header\n" .. table.concat(lines, "\n") .. "\n", aib.io.read_cloud)
end

--- What a reader makes of a text.
function M.through_file(extension, text, read)
  local path = os.tmpname()
  os.remove(path)
  path = path .. extension
  aib.system.write_text(path, text)
  local value = read(path)
  os.remove(path)
  return value
end

--- The mesh of corners and faces { a, b, c } (places from 1).
function M.mesh(corners, faces)
  local lines = {}
  for _, c in ipairs(corners) do lines[#lines + 1] = ("v %.17g %.17g %.17g"):format(table.unpack(c)) end
  for _, f in ipairs(faces) do lines[#lines + 1] = ("f %d %d %d"):format(table.unpack(f)) end
  return M.through_file(".obj", table.concat(lines, "\n") .. "\n", aib.io.read_mesh)
end

-- Depth maps ---------------------------------------------------------------------------------------------------------

function M.depth_rows(width, height, n_holes)
  local rows = M.list(height, function() return M.list(width, function() return M.random(0.5, 20) end) end)
  for _ = 1, n_holes or 2 do rows[math.random(height)][math.random(width)] = 0 end
  return rows
end

--- Rows of what `of(value, x, y)` makes of each value.
function M.changed(rows, of)
  return M.list(#rows, function(y) return M.list(#rows[y], function(x) return of(rows[y][x], x, y) end) end)
end

function M.mirrored(rows) return M.changed(rows, function(_, x, y) return rows[y][#rows[y] + 1 - x] end) end

function M.transposed(rows)
  return M.list(#rows[1], function(x) return M.list(#rows, function(y) return rows[y][x] end) end)
end

--- Calls visit(x, y, value) for each pixel of a map.
function M.each_pixel(map, visit)
  for y = 1, map.height do
    for x = 1, map.width do visit(x, y, map:at(x, y)) end
  end
end

--- The rows of a map, as it has them: floats.
function M.rows_of(map)
  return M.list(map.height, function(y) return M.list(map.width, function(x) return map:at(x, y) end) end)
end

return M
