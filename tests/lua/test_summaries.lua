-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What objects say of themselves in a few numbers.
local aib = require "aib"

local nan <const> = 0 / 0

--- The plain table behind a record, with those fields alone that are given.
local function holds(t, summary, expected)
  for name, value in pairs(expected) do t:equal(summary[name], value, name) end
end

return aib.test {
  ["clouds, distances and offsets"] = function(t)
    local cloud = aib.cloud.from_points { { 0, 0, 0 }, { 1, 2, 3 }, { nan, 0, 0 } }
    holds(t, cloud:summary(), { n = 3, n_finite = 2, min = { 0, 0, 0 }, max = { 1, 2, 3 }, has_normals = false })
    holds(t, aib.cloud.from_points({}):summary(), { n = 0, n_finite = 0 })
    t:equal(rawget(aib.cloud.from_points({}):summary(), "min"), nil)
    local d = aib.cloud.distances(cloud, aib.cloud.from_points { { 0, 0, 4 } }, { max_distance = 3 })
    holds(t, d:summary(), { n = 3, n_dropped = 1, n_beyond = 1 })
    t:near(d:summary().mean, math.sqrt(6), 1e-6)
  end,

  ["depth maps, images and labels"] = function(t)
    holds(t, aib.depth.map({ { 1, 3 }, { 0, nan } }):summary(),
      { width = 2, height = 2, n_valid = 2, mean = 2, min = 1, max = 3, std = 1 })
    t:equal(rawget(aib.depth.map({ { 0 } }):summary(), "mean"), nil)
    local labels = aib.raster.labels { { 1, 1 }, { 0, 7 } }
    holds(t, labels:summary(), { width = 2, height = 2, counts = { [0] = 1, [1] = 2, [7] = 1 } })
    local picture = aib.depth.error_image(aib.depth.map { { 1, 2 } }, aib.depth.map { { 1, 3 } })
    t:equal(#picture:summary().mean, 3)
  end,

  ["trajectories and transforms"] = function(t)
    local poses = { aib.math.pose { centre = { 0, 0, 0 } }, aib.math.pose { centre = { 3, 4, 0 } } }
    local trajectory = aib.pose.trajectory(poses, { stamps = { 10, 12 } })
    holds(t, trajectory:summary(), {
      n = 2, n_registered = 2, path_length = 5, min = { 0, 0, 0 }, max = { 3, 4, 0 }, first_stamp = 10, last_stamp = 12,
    })
    holds(t, aib.math.sim3({ scale = 2, translation = { 0, 3, 4 } }):summary(), { scale = 2, angle_deg = 0, shift = 5 })
  end,

  ["arrays and moments"] = function(t)
    holds(t, aib.io.array({ 1, 3, nan }):summary(), { shape = { 3 }, dtype = "f8", n = 3, n_finite = 2, mean = 2 })
    holds(t, aib.stats.moments():add(1):add(3):summary(), { count = 2, mean = 2, std = 1 })
  end,

  ["meshes"] = function(t)
    local path = os.tmpname()
    aib.system.write_text(path .. ".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    local mesh = aib.io.read_mesh(path .. ".obj")
    os.remove(path)
    os.remove(path .. ".obj")
    holds(t, mesh:summary(), { n_triangles = 1, n_vertices = 3, n_open_edges = 3, area = 0.5, max = { 1, 1, 0 } })
  end,
}
