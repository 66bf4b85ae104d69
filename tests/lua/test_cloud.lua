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
    t:raises("a box with min at or below max expected", aib.cloud.crop, on_x(0),
      { min = { 1, 0, 0 }, max = { 0, 1, 1 } })
    t:raises("list of lists of 3 numbers expected, found table", aib.cloud.from_points, { { 1, 2 } })
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

  ["histograms, curves and scores come from the same distances"] = function(t)
    local to_reference, to_estimate = aib.cloud.distances_both_ways(on_x(0, 1, 2, 5), on_x(0))
    t:equal(to_reference:histogram { max = 4, bins = 4 }, { counts = { 1, 1, 1, 0 }, above = 1, width = 1 })
    t:equal(aib.cloud.score(to_reference, to_estimate, { tau = 1.5 }).precision[1.5], 0.5)
    local curve = aib.cloud.curve(to_reference, to_estimate, { max = 6, steps = 3 })
    t:equal(curve.tau, { 2, 4, 6 })
    t:equal(curve.precision, { 0.5, 0.75, 1 })
    t:equal(curve.recall, { 1, 1, 1 })
    t:raises("a number > 0 expected", aib.cloud.curve, to_reference, to_estimate, {})
  end,

  ["errors are written as a scalar and a colour"] = function(t)
    local path = os.tmpname() .. ".ply"
    local c = on_x(0, 1, 2)
    local d = aib.cloud.distances(c, on_x(0))
    aib.io.write_cloud(path, aib.cloud.colored(c, d, { max = 2 }), { scalars = { error = d } })
    t:equal(aib.system.read_text(path):find("property float error", 1, true) ~= nil, true)
    t:equal(aib.io.read_cloud(path).has_colors, true)
    os.remove(path)
    local colors = aib.cloud.colors_of({ 0 / 0, 0 }, { max = 1, scale = "diverging" })
    t:equal(colors, { { 128, 128, 128 }, { 238, 238, 238 } })
    t:raises("a value for each of 3 points expected, found 1", aib.cloud.colored, c, { 1 }, { max = 1 })
  end,

  ["offsets have a sign"] = function(t)
    local mesh = square()
    local wall = aib.sample.mesh(mesh, { n = 100 })
    local o = aib.cloud.offsets(aib.cloud.from_points { { 1, 1, 2 }, { 1, 1, -1 } }, wall)
    t:equal({ #o, o[1], o[2], o:mean() }, { 2, 2, -1, 0.5 })
    t:equal(o:mean_absolute(), 1.5)
    t:equal(tostring(o), "offsets(2 values, mean 0.5, deviation 1.5)")
    t:equal(mesh.n_open_edges, 4)
    t:raises("a watertight mesh expected, found 4 open edges", aib.mesh.offsets, wall, mesh)
  end,

  ["faces and labels have scores of their own"] = function(t)
    local mesh = square()
    local samples = aib.sample.mesh(mesh, { n = 200 })
    local s = aib.mesh.face_scores(aib.cloud.from_points { { 3, 1, 0.5 } }, mesh, { samples = samples, tau = 9 })
    t:equal(#s.accuracy, 2)
    t:equal(s.n_estimate[1] + s.n_estimate[2], 1)
    t:equal(s.recall, { 1, 1 })
    t:raises("a mesh with labels expected", aib.mesh.with_labels, samples, mesh)
    t:raises("a reference with labels expected", aib.cloud.compare_by_label, on_x(0), on_x(1))
  end,

  ["beams see what is free"] = function(t)
    local wall = aib.cloud.from_points { { 4, 0, 0 }, { 4, 1, 0 } }
    local est = aib.cloud.from_points { { 4, 0, 0 }, { 2, 0.5, 0 }, { 8, 0, 0 } }
    local s = aib.cloud.eth3d(est, { { points = wall, scanner = { 0, 0, 0 } } }, { tolerances = { 0.1 }, voxel = 0.1 })
    t:equal(s.completeness[0.1], 0.5)
    t:equal(s.accuracy[0.1], 0.5)
    t:equal(s.n_unobserved[0.1], 1)
    t:raises("scan 1: { points = cloud, scanner = {x, y, z} } expected", aib.cloud.eth3d, est, { wall },
      { tolerances = 1 })
  end,

  ["planes crop"] = function(t)
    t:equal(#aib.cloud.crop(on_x(0, 1, 2), { plane = { 1, 0, 0, -0.5 } }), 2)
  end,

  ["points are thinned by distance, meshes sampled evenly"] = function(t)
    t:equal(#aib.sample.thin(on_x(0, 0.1, 5), { spacing = 1 }), 2)
    local even, info = aib.sample.mesh(square(), { n = 100, method = "poisson" })
    t:equal(#even, 100)
    t:equal(info.floor < 0.2, true)
  end,

  ["readers take limits"] = function(t)
    local path = os.tmpname()
    aib.system.write_text(path .. ".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    aib.io.write_depth(path .. ".pfm", aib.depth.map { { 1, 2 }, { 3, 4 } })
    aib.io.write_image(path .. ".png", aib.raster.labels { { 1, 2 }, { 3, 4 } })
    local function says(sentence, reader, extension, options)
      t:raises(path .. extension .. ": " .. sentence, aib.io[reader], path .. extension, options)
    end
    says("3 points, at most 2 are allowed (max_points)", "read_cloud", ".obj", { max_points = 2 })
    says("3 vertices, at most 2 are allowed (max_points)", "read_mesh", ".obj", { max_points = 2 })
    says("depth: 2x2 pixels, at most 3 are allowed (max_pixels)", "read_depth", ".pfm", { max_pixels = 3 })
    says("png: 2x2 pixels, at most 3 are allowed (max_pixels)", "read_image", ".png", { max_pixels = 3 })
    t:equal(#aib.io.read_cloud(path .. ".obj", { max_points = 3, max_ratio = 10, max_bytes = 100 }), 3)
    for _, extension in ipairs { "", ".obj", ".pfm", ".png" } do os.remove(path .. extension) end
  end,

  ["a cloud is written piece by piece, and once"] = function(t)
    local path = os.tmpname() .. ".ply"
    local writer = aib.io.cloud_writer(path):add(on_x(0, 1)):add(on_x(2))
    writer:commit()
    t:equal(#aib.io.read_cloud(path), 3)
    t:raises("an open stream expected, this is closed", writer.commit, writer)
    t:raises("an open stream expected, this is closed", writer.add, writer, on_x(3))
    t:equal(#aib.io.read_cloud(path), 3)
    os.remove(path)
  end,

  ["a threshold that is no number is refused"] = function(t)
    t:raises("a threshold is not a number (NaN)", aib.cloud.compare, on_x(0), on_x(1), { tau = 0 / 0 })
  end,

  ["voxels thin a cloud"] = function(t)
    t:equal(#aib.sample.voxel(on_x(0.1, 0.2, 1.5), { size = 1 }), 2)
  end,
}
