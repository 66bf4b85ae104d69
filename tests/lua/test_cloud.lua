-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

local aib = require "aib"

local function on_x(...)
  local points = {}
  for i, x in ipairs { ... } do points[i] = { x, 0, 0 } end
  return aib.cloud.from_points(points)
end

--- The square 0..4 x 0..4 in the plane z = 0, as a file and back.
local function square()
  local path = os.tmpname()
  aib.system.write_text(path, [[
ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
4 0 0
4 4 0
0 4 0
4 0 1 2 3
]])
  local mesh = aib.io.read_mesh(path)
  os.remove(path)
  return mesh
end

return aib.test {
  ["a cloud prints itself, knows its points and its box"] = function(t)
    local c = on_x(0, 1, 12)
    t:equal(tostring(c), "cloud(3 points, bbox 12.0 x 0.0 x 0.0 m)")
    t:equal(#c, 3)
    t:equal(c[2], { 1, 0, 0 })
    t:equal(c:bounds(), { min = { 0, 0, 0 }, max = { 12, 0, 0 } })
    t:equal(tostring(aib.cloud.from_points {}), "cloud(0 points)")
  end,

  ["distances have an element for each point and statistics"] = function(t)
    local d = aib.cloud.distances(on_x(0, 1, 2, 5), on_x(0))
    t:equal(#d, 4)
    t:equal(d[4], 5)
    t:equal(d:mean(), 2)
    t:equal(d:median(), 1.5)
    t:equal(d:max(), 5)
    t:equal(d:share_below(2), 0.5)
    local near = aib.cloud.distances(on_x(0, 1, 2, 5), on_x(0), { max_distance = 2 })
    t:equal(near:mean(), 0.5)
    t:equal(near:share_beyond(), 0.5)
    t:equal(aib.cloud.distances(on_x(0, 9), on_x(0), { max_distance = 2, rule = "clamp" }):mean(), 1)
  end,

  ["a comparison has every metric, by tau where there is one"] = function(t)
    local c = aib.cloud.compare(on_x(0), on_x(1, 5), { tau = { 1, 1.5 } })
    t:equal(c.accuracy, 1)
    t:equal(c.completeness, 3)
    t:equal(c.chamfer, 4)
    t:equal(c.chamfer_mean, 2)
    t:equal(c.f1_distance, 1.5)
    t:equal(c.hausdorff, 5)
    t:equal(c.precision, { [1] = 0, [1.5] = 1 })
    t:equal(c.recall[1.5], 0.5)
    t:equal(c.f_score[1], 0)
    t:equal(c.n_reference, 2)
  end,

  ["what is wrong is said on the caller's line"] = function(t)
    t:raises("unknown option 'taus', did you mean 'tau'?", aib.cloud.compare, on_x(0), on_x(1), { taus = 1 })
    t:raises("argument 2 (ref): cloud expected, found nil", aib.cloud.compare, on_x(0))
    t:raises("no finite point in the estimated cloud", aib.cloud.compare, on_x(), on_x(1))
    t:raises("'min' is missing", aib.cloud.crop, on_x(0), { max = { 1, 1, 1 } })
  end,

  ["a volume keeps what is in it"] = function(t)
    local c = on_x(0, 1, 2, 3)
    t:equal(#aib.cloud.crop(c, { min = { 1, -1, -1 }, max = { 2, 1, 1 } }), 2)
    t:equal(#aib.cloud.crop(c, {
      centre = { 2, 0, 0 }, size = { 2.5, 1, 1 }, rotation = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
    }), 3)
    t:equal(#aib.cloud.crop(c, {
      orthogonal_axis = "Z", axis_min = -1, axis_max = 1,
      bounding_polygon = { { 0.5, -1, 0 }, { 2.5, -1, 0 }, { 2.5, 1, 0 }, { 0.5, 1, 0 } },
    }), 2)
  end,

  ["a mesh is sampled, and distances to it are exact"] = function(t)
    local mesh = square()
    t:equal(mesh:area(), 16)
    local points, info = aib.sample.mesh(mesh, { n = 400 })
    t:equal(#points, 400)
    t:equal(info.density, 25)
    t:equal(info.floor, 0.1)
    t:equal(aib.mesh.distances(aib.cloud.from_points { { 1, 1, 3 }, { -3, -4, 0 } }, mesh):mean(), 4)
    local c = aib.mesh.compare(points, mesh, { samples = points, tau = 0.1 })
    t:equal(c.accuracy < 1e-12, true)
    t:equal(c.f_score[0.1], 1)
    t:raises("points on the mesh (aib.sample.mesh) expected", aib.mesh.compare, points, mesh, {})
  end,

  ["voxels thin a cloud"] = function(t)
    t:equal(#aib.sample.voxel(on_x(0.1, 0.2, 1.5), { size = 1 }), 2)
  end,
}
