-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What must hold of meshes and of points made from meshes, clouds and depth maps.
local aib = require "aib"
local p = require "properties"

local near, coarse, list, random, vector = p.near, p.coarse, p.list, p.random, p.vector
local from_points <const> = aib.cloud.from_points

--- A distance of whole multiples, now and then: corners meet, triangles have no area, points lie on edges.
local function corners(n)
  local rounded = math.random() < 0.4
  return list(n, function()
    local v = vector(2)
    return rounded and { v[1] // 1, v[2] // 1, v[3] // 1 } or v
  end)
end

--- Three different places of 1 .. n.
local function face(n)
  local places = p.shuffled(list(n, function(i) return i end))
  return { places[1], places[2], places[3] }
end

--- The tetrahedron of four corners, closed, its faces turned outwards.
local function tetrahedron(c)
  local edges = list(3, function(i) return p.minus(c[i + 1], c[1]) end)
  local inwards = p.dot(p.cross(edges[1], edges[2]), edges[3]) > 0
  return p.mesh(c, list(4, function(i)
    local f = ({ { 1, 3, 2 }, { 1, 2, 4 }, { 1, 4, 3 }, { 2, 3, 4 } })[i]
    return inwards and f or { f[1], f[3], f[2] }
  end))
end

--- Distance to a segment.
local function to_segment(q, a, b)
  local along = p.minus(b, a)
  local share = p.dot(along, along) > 0 and p.dot(p.minus(q, a), along) / p.dot(along, along) or 0
  share = math.max(0, math.min(1, share))
  return p.distance(q, list(3, function(i) return a[i] + share * along[i] end))
end

--- Distance to a triangle: to its plane where the foot lies inside, else to its sides.
local function to_triangle(q, a, b, c)
  local normal = p.cross(p.minus(b, a), p.minus(c, a))
  local sides = math.min(to_segment(q, a, b), to_segment(q, b, c), to_segment(q, c, a))
  if p.norm(normal) < 1e-12 then return sides end
  local function inside(u, v) return p.dot(p.cross(p.minus(v, u), p.minus(q, u)), normal) >= 0 end
  if not (inside(a, b) and inside(b, c) and inside(c, a)) then return sides end
  return math.abs(p.dot(p.minus(q, a), normal)) / p.norm(normal)
end

return p.suite {
  ["mesh: a distance is the size of the offset, and stays when both move"] = { 300, function(t)
    local mesh = tetrahedron(p.points(4, 2))
    local points = aib.cloud.from_points(list(10, function() return vector(3) end))
    local d, o = aib.mesh.distances(points, mesh), aib.mesh.offsets(points, mesh)
    for i = 1, #d do t:near(math.abs(o[i]), d[i], 1e-5) end
    local move = p.rigid()
    coarse(t, aib.mesh.distances(move * points, move * mesh):mean(), d:mean())
    local samples = aib.sample.mesh(mesh, { n = 50 })
    t:near(aib.mesh.distances(samples, mesh):max(), 0, 1e-5)
    t:check(aib.cloud.distances(points, samples):mean() >= d:mean() - 1e-6, "samples are part of the surface")
    coarse(t, (aib.math.sim3 { scale = 3 } * mesh):area(), 9 * mesh:area())
  end },

  ["sample: voxels hold all points, thinned ones keep their distance"] = { 300, function(t)
    local points = aib.cloud.from_points(list(math.random(1, 60), function() return vector(1) end))
    local size = random(0.1, 1)
    local voxels = aib.sample.voxel(points, { size = size })
    t:check(#voxels <= #points and #voxels >= 1, "voxels")
    t:check(aib.cloud.distances(points, voxels):max() <= size * math.sqrt(3) + 1e-5, "within a voxel")
    local kept = aib.sample.thin(points, { spacing = size })
    t:check(aib.cloud.distances(points, kept):max() <= size + 1e-5, "nothing is far")
    for i = 1, #kept do
      for j = i + 1, #kept do t:check(p.distance(kept[i], kept[j]) >= size - 1e-5, "spacing") end
    end
  end },

  ["sample: unprojected depths project back to their pixels"] = { 300, function(t)
    local width, height = math.random(2, 8), math.random(2, 6)
    local camera = aib.math.camera {
      model = "PINHOLE", width = width, height = height,
      parameters = { random(3, 9), random(3, 9), width / 2, height / 2 },
    }
    local pose = aib.math.pose { rotation = p.rotation(), centre = vector(5) }
    local map = aib.depth.map(p.depth_rows(width, height))
    local points = aib.sample.unproject(map, camera, pose)
    local n = 0
    local world_to_camera = aib.math.sim3 { rotation = pose.rotation, translation = pose.centre }:inverse()
    for y = 1, height do
      for x = 1, width do
        if map:at(x, y) > 0 then
          n = n + 1
          local pixel = aib.math.project(camera, world_to_camera * points[n])
          coarse(t, pixel[1], x - 0.5)
          coarse(t, pixel[2], y - 0.5)
        end
      end
    end
    t:equal(#points, n)
  end },

  ["mesh: distances are those to every triangle, without area too"] = { 300, function(t)
    local c = corners(math.random(3, 7))
    local faces = list(math.random(1, 8), function() return face(#c) end)
    local points = math.random() < 0.5 and corners(8) or p.points(8, 3)
    local d = aib.mesh.distances(from_points(points), p.mesh(c, faces))
    for i, q in ipairs(points) do
      local least = math.huge
      for _, f in ipairs(faces) do least = math.min(least, to_triangle(q, c[f[1]], c[f[2]], c[f[3]])) end
      t:near(d[i], least, 2e-6)
    end
  end },

  ["mesh: offsets are negative inside of a closed mesh, and turn round with it"] = { 300, function(t)
    local c = p.points(4, 2)
    local solid = tetrahedron(c)
    local points = list(10, function(i)
      if i > 5 then return vector(2) end
      local w = list(4, function() return random(0.01, 1) end)
      local sum = w[1] + w[2] + w[3] + w[4]
      return list(3, function(k)
        return (w[1] * c[1][k] + w[2] * c[2][k] + w[3] * c[3][k] + w[4] * c[4][k]) / sum
      end)
    end)
    local o, d = aib.mesh.offsets(from_points(points), solid), aib.mesh.distances(from_points(points), solid)
    for i = 1, #points do
      t:near(math.abs(o[i]), d[i], 1e-5)
      if i <= 5 and d[i] > 1e-5 then t:check(o[i] < 0, "inside") end
    end
    local values = list(#points, function(i) return o[i] end)
    near(t, o:mean(), p.mean(values))
    near(t, o:median(), p.median(values))
    near(t, o:mean_absolute(), p.mean(list(#points, function(i) return math.abs(values[i]) end)))
    local move = p.rigid()
    t:near(aib.mesh.offsets(move * from_points(points), move * solid):mean(), o:mean(), 1e-4)
  end },

  ["mesh: a comparison is exact one way, by samples the other, and divides by labels and faces"] = { 150, function(t)
    local solid = tetrahedron(p.points(4, 2))
    local points = from_points(p.points(math.random(2, 30), 2))
    local samples, tau = aib.sample.mesh(solid, { n = math.random(5, 60) }), random(0.1, 1)
    local c = aib.mesh.compare(points, solid, { samples = samples, tau = tau })
    local exact, sampled = aib.mesh.distances(points, solid), aib.cloud.distances(samples, points)
    t:equal({ c.accuracy, c.precision[tau] }, { exact:mean(), exact:share_below(tau) })
    t:equal({ c.completeness, c.recall[tau] }, { sampled:mean(), sampled:share_below(tau) })
    local f = aib.mesh.face_scores(points, solid, { samples = samples, tau = tau })
    local n_est, n_ref, accuracy, completeness, recall = 0, 0, 0, 0, 0
    for i = 1, 4 do
      n_est, n_ref = n_est + f.n_estimate[i], n_ref + f.n_samples[i]
      if f.n_estimate[i] > 0 then accuracy = accuracy + f.accuracy[i] * f.n_estimate[i] end
      if f.n_samples[i] > 0 then
        completeness, recall = completeness + f.completeness[i] * f.n_samples[i], recall + f.recall[i] * f.n_samples[i]
      end
    end
    t:equal({ n_est, n_ref }, { #points, #samples })
    t:near(accuracy / n_est, c.accuracy, 1e-6)
    t:near(completeness / n_ref, c.completeness, 1e-6)
    t:near(recall / n_ref, c.recall[tau], 1e-6)
  end },

  ["sample: voxels are means of their points, in one go or in parts, in any order"] = { 300, function(t)
    local points = p.points(math.random(1, 40))
    local size, cells, n = random(0.2, 1), {}, 0
    for _, q in ipairs(points) do
      local key = table.concat(list(3, function(k) return q[k] // size end), " ")
      if not cells[key] then cells[key], n = {}, n + 1 end
      table.insert(cells[key], q)
    end
    local means = {}
    for _, members in pairs(cells) do
      means[#means + 1] = list(3, function(k) return p.mean(list(#members, function(i) return members[i][k] end)) end)
    end
    local voxels = aib.sample.voxel(from_points(points), { size = size })
    t:equal(#voxels, n)
    t:near(aib.cloud.compare(voxels, from_points(means)).hausdorff, 0, 1e-6)
    local other = aib.sample.voxel(from_points(p.shuffled(points)), { size = size })
    t:near(aib.cloud.compare(voxels, other).hausdorff, 0, 1e-6)
    local grid, half = aib.sample.voxel_grid { size = size }, #points // 2
    grid:add(from_points(table.move(points, 1, half, 1, {})))
    grid:add(from_points(table.move(points, half + 1, #points, 1, {})))
    t:equal({ #grid, grid.n_points }, { n, #points })
    t:near(aib.cloud.compare(grid:cloud(), voxels).hausdorff, 0, 1e-6)
    local picked = aib.sample.voxel(from_points(points), { size = size, pick = "nearest" })
    t:equal({ #picked, aib.cloud.distances(picked, from_points(points)):max() }, { n, 0 })
    local open3d = aib.sample.voxel(from_points(points), { size = size, anchor = "open3d" })
    local far = aib.math.sim3 { translation = vector(50) }
    t:near(#aib.sample.voxel(far * from_points(points), { size = size, anchor = "open3d" }), #open3d, 1)
  end },

  ["sample: points on a mesh are as many as asked for, by area, and the same of a seed"] = { 60, function(t)
    local c = p.points(4, 2)
    local mesh = p.mesh(c, { { 1, 2, 3 }, { 1, 2, 4 } })
    local n = math.random(2000, 4000)
    local points, info = aib.sample.mesh(mesh, { n = n, seed = math.random(99) })
    t:equal(#points, n)
    t:near(aib.mesh.distances(points, mesh):max(), 0, 1e-5)
    near(t, info.density * mesh:area(), n)
    near(t, info.area, mesh:area())
    local one = p.mesh(c, { { 1, 2, 3 } })
    local on_it = aib.mesh.distances(points, one):share_below(1e-5)
    t:near(on_it, one:area() / mesh:area(), 4.5 * 0.5 / math.sqrt(n) + 0.02)
    local again = aib.sample.mesh(mesh, { n = 50, seed = 5 })
    t:equal(aib.cloud.compare(again, (aib.sample.mesh(mesh, { n = 50, seed = 5 }))).hausdorff, 0)
    local spacing = math.sqrt(mesh:area() / 80)
    local even = aib.sample.mesh(mesh, { spacing = spacing, method = "poisson" })
    for i = 1, #even, 7 do
      for j = i + 1, #even do t:check(p.distance(even[i], even[j]) >= spacing - 1e-5, "Poisson disk") end
    end
  end },

  ["sample: what is not confident, or between strides, is left out"] = { 200, function(t)
    local width, height = math.random(2, 7), math.random(2, 6)
    local camera = aib.math.camera { model = "PINHOLE", width = width, height = height, parameters = { 5, 5, 3, 3 } }
    local pose = aib.math.pose { rotation = p.rotation(), centre = vector(5) }
    local map = aib.depth.map(p.depth_rows(width, height))
    local confidence = aib.depth.map(p.depth_rows(width, height, 0))
    local least, stride = random(1, 19), math.random(1, 3)
    local n, n_on_grid = 0, 0
    p.each_pixel(map, function(x, y, d)
      if d > 0 and confidence:at(x, y) > least then n = n + 1 end
      if d > 0 and (x - 1) % stride == 0 and (y - 1) % stride == 0 then n_on_grid = n_on_grid + 1 end
    end)
    local kept, info = aib.sample.unproject(map, camera, pose, { confidence = confidence, min_confidence = least })
    t:equal({ #kept, info.n_valid - info.n_unsure }, { n, n })
    t:equal(#aib.sample.unproject(map, camera, pose, { stride = stride }), n_on_grid)
    if n == 0 then return end
    local all = aib.sample.unproject(map, camera, pose)
    t:equal(aib.cloud.distances(kept, all):max(), 0)
    local move = p.similarity()
    local at_twice = aib.sample.unproject(map:scaled(move.scale), camera, move * pose)
    coarse(t, aib.cloud.compare(at_twice, move * all).hausdorff, 0)
  end },

  ["render: depth is where rays meet the mesh, ranges and labels are of the same surface"] = { 150, function(t)
    local c = corners(5)
    local faces = list(3, function() return face(5) end)
    local mesh = p.mesh(c, faces)
    if mesh:area() < 1e-3 then return end
    local camera = aib.math.camera { model = "PINHOLE", width = 12, height = 9, parameters = { 6, 7, 6, 4.5 } }
    local pose = aib.math.pose { rotation = p.rotation(), centre = vector(4) }
    local frame = aib.render.frame(mesh, camera, pose)
    local n_hit = 0
    p.each_pixel(frame.depth, function(x, y, depth)
      local towards = aib.math.unproject(camera, { x - 0.5, y - 0.5 })
      n_hit = n_hit + (depth > 0 and 1 or 0)
      coarse(t, frame.range:at(x, y), depth / towards[3])
      if depth > 1e-3 then t:check((frame.labels:at(x, y) ~= 65535), "a label") end
    end)
    t:equal(n_hit, frame.n_hit)
    if n_hit == 0 then return end
    local seen = aib.sample.unproject(frame.depth, camera, pose)
    t:near(aib.mesh.distances(seen, mesh):max(), 0, 1e-4)
    local poses = aib.pose.trajectory({ pose }, { names = { "a" } })
    local n_views = aib.render.visible(mesh, seen, poses, camera, { tolerance = 0.01 })
    for _, n in ipairs(n_views) do t:equal(n, 1, "visible") end
    local closer = aib.sample.unproject(frame.depth:scaled(0.5), camera, pose)
    local free = aib.render.free_space(mesh, closer, poses, camera, { tolerance = 1e-3 })
    t:equal(free.n_surface + free.n_free + free.n_hidden, #closer)
    t:equal(#free.free, free.n_free)
    t:check(free.n_hidden == 0, "what is nearer than the surface is not hidden")
    local move = p.rigid()
    local moved = aib.render.depth(move * mesh, camera, move * pose)
    local differ = 0
    p.each_pixel(moved, function(x, y, depth)
      differ = differ + (math.abs(depth - frame.depth:at(x, y)) > 1e-3 and 1 or 0)
    end)
    t:check(differ <= 3, "moved together, but for pixels at edges")
  end },
}
