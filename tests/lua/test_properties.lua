-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What must hold of every metric whatever the data, over thousands of seeded cases: definitions written out anew, and
--- how a number changes where the data is moved, scaled, swapped or put in another order.
local aib = require "aib"

local function random(low, high) return low + (high - low) * math.random() end
local function vector(size) return { random(-size, size), random(-size, size), random(-size, size) } end

local function list(n, make)
  local t = {}
  for i = 1, n do t[i] = make(i) end
  return t
end

--- Runs `case` n times. Every case begins from its own seed, which a failure names.
local function cases(t, n, case)
  for seed = 1, n do
    math.randomseed(seed)
    local ok, e = pcall(case, t)
    if not ok then error(("seed %d: %s"):format(seed, tostring(e)), 0) end
  end
end

local function near(t, found, expected, what) t:near(found, expected, 1e-9 + 1e-7 * math.abs(expected), what) end
local function coarse(t, found, expected, what) t:near(found, expected, 1e-4 + 1e-4 * math.abs(expected), what) end

local function shuffled(values)
  local out = table.move(values, 1, #values, 1, {})
  for i = #out, 2, -1 do
    local j = math.random(i)
    out[i], out[j] = out[j], out[i]
  end
  return out
end

local function mean(values)
  local sum = 0
  for _, v in ipairs(values) do sum = sum + v end
  return sum / #values
end

--- A rotation of random axis and angle, three rows (Rodrigues).
local function rotation(angle)
  local x, y, z = table.unpack(vector(1))
  local length = math.sqrt(x * x + y * y + z * z)
  x, y, z = x / length, y / length, z / length
  local a = angle or random(-3, 3)
  local c, s, d = math.cos(a), math.sin(a), 1 - math.cos(a)
  return {
    { c + x * x * d, x * y * d - z * s, x * z * d + y * s },
    { y * x * d + z * s, c + y * y * d, y * z * d - x * s },
    { z * x * d - y * s, z * y * d + x * s, c + z * z * d },
  }
end

local function rigid() return aib.math.sim3 { rotation = rotation(), translation = vector(3) } end
local function similarity()
  return aib.math.sim3 { scale = random(0.3, 3), rotation = rotation(), translation = vector(3) }
end

local function distance(a, b)
  local x, y, z = a[1] - b[1], a[2] - b[2], a[3] - b[3]
  return math.sqrt(x * x + y * y + z * z)
end

local function walk(n)
  return aib.pose.trajectory(list(n, function() return aib.math.pose { rotation = rotation(), centre = vector(2) } end))
end

--- The trajectory with each pose a little off.
local function disturbed(trajectory, size)
  return aib.pose.trajectory(list(#trajectory, function(i)
    local offset = aib.math.sim3 { rotation = rotation(random(0, size)), translation = vector(size) }
    return offset * trajectory[i]
  end))
end

local function depth_rows(width, height, n_holes)
  local rows = list(height, function() return list(width, function() return random(0.5, 20) end) end)
  for _ = 1, n_holes or 2 do rows[math.random(height)][math.random(width)] = 0 end
  return rows
end

local function changed(rows, change)
  return list(#rows, function(y) return list(#rows[y], function(x) return change(rows[y][x], x, y) end) end)
end

--- Pairs of the depths that are valid in both, in the precision that maps have.
local function valid_pairs(est, ref)
  local pairs = {}
  for y = 1, est.height do
    for x = 1, est.width do
      local e, r = est:at(x, y), ref:at(x, y)
      if e > 0 and r > 0 then pairs[#pairs + 1] = { e, r } end
    end
  end
  return pairs
end

local function median(values)
  table.sort(values)
  local n = #values
  return n % 2 == 1 and values[n // 2 + 1] or (values[n // 2] + values[n // 2 + 1]) / 2
end

return aib.test {
  ["stats: a summary is its definition, in any order"] = function(t)
    cases(t, 2000, function()
      local values = list(math.random(1, 30), function() return random(-5, 5) end)
      local s, m = aib.stats.summary(values), mean(values)
      near(t, s.mean, m)
      near(t, s.sse, mean(list(#values, function(i) return values[i] ^ 2 end)) * #values)
      near(t, s.rmse ^ 2, s.sse / #values)
      near(t, s.std ^ 2, mean(list(#values, function(i) return (values[i] - m) ^ 2 end)))
      near(t, aib.stats.summary(shuffled(values)).rmse, s.rmse)
      near(t, s.median, median(table.move(values, 1, #values, 1, {})))
      near(t, aib.stats.quantile(values, 0.5), s.median)
      local q = math.random()
      t:check(aib.stats.quantile(values, q) <= aib.stats.quantile(values, math.min(1, q + 0.1)), "rises")
    end)
  end,

  ["stats: merged moments are those of all, a bootstrap interval moves with its values"] = function(t)
    cases(t, 300, function()
      local a, b = aib.stats.moments(), aib.stats.moments()
      local values = list(math.random(2, 20), function() return random(-1, 1) end)
      for i, v in ipairs(values) do (i % 2 == 0 and a or b):add(v) end
      near(t, a:merge(b).mean, mean(values))
      local how = { block = 2, resamples = 50 }
      local plain, moved = aib.stats.bootstrap(values, how), aib.stats.bootstrap(list(#values, function(i)
        return values[i] + 4
      end), how)
      near(t, moved.low, plain.low + 4)
      near(t, moved.high, plain.high + 4)
      t:check(plain.low <= plain.high, "ordered")
    end)
  end,

  ["cloud: distances are those of every pair"] = function(t)
    cases(t, 1000, function()
      local size = math.random() < 0.3 and 0 or 1
      local from = list(math.random(1, 12), function() return vector(1 + size) end)
      local to = list(math.random(1, 12), function() return vector(1) end)
      local d = aib.cloud.distances(aib.cloud.from_points(from), aib.cloud.from_points(to))
      for i, p in ipairs(from) do
        local least = math.huge
        for _, q in ipairs(to) do least = math.min(least, distance(p, q)) end
        t:near(d[i], least, 1e-6)
      end
    end)
  end,

  ["cloud: a comparison swaps with its clouds, scales with them and stays when they move"] = function(t)
    cases(t, 600, function()
      local points = list(math.random(2, 40), function() return vector(1) end)
      local est = aib.cloud.from_points(points)
      local ref = aib.cloud.from_points(list(math.random(2, 40), function() return vector(1) end))
      local c = aib.cloud.compare(est, ref, { tau = 0.3 })
      local swapped = aib.cloud.compare(ref, est, { tau = 0.3 })
      t:equal({ c.accuracy, c.hausdorff, c.precision[0.3], c.f_score[0.3], c.chamfer },
        { swapped.completeness, swapped.hausdorff, swapped.recall[0.3], swapped.f_score[0.3], swapped.chamfer })
      local move, grow = rigid(), aib.math.sim3 { scale = 2 }
      coarse(t, aib.cloud.compare(move * est, move * ref).chamfer, c.chamfer)
      near(t, aib.cloud.compare(grow * est, grow * ref, { tau = 0.6 }).accuracy_rmse, 2 * c.accuracy_rmse)
      t:equal(aib.cloud.compare(grow * est, grow * ref, { tau = 0.6 }).f_score[0.6], c.f_score[0.3])
      coarse(t, aib.cloud.compare(aib.cloud.from_points(shuffled(points)), ref).accuracy, c.accuracy)
      local twice = aib.cloud.joined { est, est }
      near(t, aib.cloud.compare(twice, ref).accuracy, c.accuracy)
      near(t, c.chamfer_mean, (c.accuracy + c.completeness) / 2)
      near(t, c.f1_distance, 2 * c.accuracy * c.completeness / (c.accuracy + c.completeness))
      t:check(c.accuracy <= c.accuracy_rmse + 1e-12 and c.accuracy_rmse <= c.hausdorff + 1e-12, "mean, rms, maximum")
    end)
  end,

  ["cloud: precision rises with the threshold, more points raise recall"] = function(t)
    cases(t, 400, function()
      local est = aib.cloud.from_points(list(20, function() return vector(1) end))
      local ref = aib.cloud.from_points(list(20, function() return vector(1) end))
      local more = aib.cloud.joined { est, aib.cloud.from_points(list(5, function() return vector(1) end)) }
      local c = aib.cloud.compare(est, ref, { tau = { 0.1, 0.3, 0.5 } })
      t:check(c.precision[0.1] <= c.precision[0.3] and c.precision[0.3] <= c.precision[0.5], "rises")
      t:check(aib.cloud.compare(more, ref, { tau = 0.3 }).recall[0.3] >= c.recall[0.3], "recall")
      t:check(aib.cloud.compare(more, ref).completeness <= c.completeness + 1e-12, "completeness")
    end)
  end,

  ["cloud: eth3d is complete where both are the same, crop and joined keep points"] = function(t)
    cases(t, 200, function()
      local points = aib.cloud.from_points(list(30, function() return vector(1) end))
      local scan = { points = points, scanner = { 0, 0, 9 } }
      local scores = aib.cloud.eth3d(points, { scan }, { tolerances = { 0.05, 0.2 } })
      t:equal(scores.completeness[0.05], 1)
      t:check(scores.completeness[0.05] <= scores.completeness[0.2], "rises")
      local middle = { min = { -0.5, -1, -1 }, max = { 0.5, 1, 1 } }
      local left, right = { plane = { -1, 0, 0, 0 } }, { plane = { 1, 0, 0, 0 } }
      t:equal(#aib.cloud.crop(points, left) + #aib.cloud.crop(points, right), #points)
      t:equal(#aib.cloud.crop(aib.cloud.crop(points, middle), middle), #aib.cloud.crop(points, middle))
    end)
  end,

  ["mesh: a distance is the size of the offset, and stays when both move"] = function(t)
    local path = os.tmpname()
    cases(t, 300, function()
      local corners = list(4, function() return vector(2) end)
      local text = list(4, function(i) return ("v %.17g %.17g %.17g\n"):format(table.unpack(corners[i])) end)
      os.remove(path)
      aib.system.write_text(path .. ".obj", table.concat(text) .. "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
      local mesh = aib.io.read_mesh(path .. ".obj")
      local points = aib.cloud.from_points(list(10, function() return vector(3) end))
      local d, o = aib.mesh.distances(points, mesh), aib.mesh.offsets(points, mesh)
      for i = 1, #d do t:near(math.abs(o[i]), d[i], 1e-5) end
      local move = rigid()
      coarse(t, aib.mesh.distances(move * points, move * mesh):mean(), d:mean())
      local samples = aib.sample.mesh(mesh, { n = 50 })
      t:near(aib.mesh.distances(samples, mesh):max(), 0, 1e-5)
      t:check(aib.cloud.distances(points, samples):mean() >= d:mean() - 1e-6, "samples are part of the surface")
      coarse(t, (aib.math.sim3 { scale = 3 } * mesh):area(), 9 * mesh:area())
    end)
    os.remove(path .. ".obj")
  end,

  ["sample: voxels hold all points, thinned ones keep their distance"] = function(t)
    cases(t, 300, function()
      local points = aib.cloud.from_points(list(math.random(1, 60), function() return vector(1) end))
      local size = random(0.1, 1)
      local voxels = aib.sample.voxel(points, { size = size })
      t:check(#voxels <= #points and #voxels >= 1, "voxels")
      t:check(aib.cloud.distances(points, voxels):max() <= size * math.sqrt(3) + 1e-5, "within a voxel")
      local moved = aib.math.sim3 { translation = { 3 * size, 0, -2 * size } } * points
      t:check(math.abs(#aib.sample.voxel(moved, { size = size }) - #voxels) <= #points, "moved by voxels")
      local kept = aib.sample.thin(points, { spacing = size })
      t:check(aib.cloud.distances(points, kept):max() <= size + 1e-5, "nothing is far")
      for i = 1, #kept do
        for j = i + 1, #kept do t:check(distance(kept[i], kept[j]) >= size - 1e-5, "spacing") end
      end
    end)
  end,

  ["sample: unprojected depths project back to their pixels"] = function(t)
    cases(t, 300, function()
      local width, height = math.random(2, 8), math.random(2, 6)
      local camera = aib.math.camera {
        model = "PINHOLE", width = width, height = height,
        parameters = { random(3, 9), random(3, 9), width / 2, height / 2 },
      }
      local pose = aib.math.pose { rotation = rotation(), centre = vector(5) }
      local map = aib.depth.map(depth_rows(width, height))
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
    end)
  end,

  ["depth: errors are their definitions"] = function(t)
    cases(t, 1500, function()
      local width, height = math.random(2, 6), math.random(2, 6)
      local est, ref = aib.depth.map(depth_rows(width, height)), aib.depth.map(depth_rows(width, height))
      local pairs = valid_pairs(est, ref)
      if #pairs == 0 then return end
      local function over(f) return mean(list(#pairs, function(i) return f(pairs[i][1], pairs[i][2]) end)) end
      local e = aib.depth.errors(est, ref)
      local d = over(function(a, b) return math.log(b / a) end)
      near(t, e.srmse, over(function(a, b) return (math.log(b / a) - d) ^ 2 end), "srmse")
      near(t, e.si_log_rmse ^ 2, e.srmse)
      near(t, e.abs_rel, over(function(a, b) return math.abs(a - b) / b end), "abs_rel")
      near(t, e.sq_rel, over(function(a, b) return (a - b) ^ 2 / b end), "sq_rel")
      near(t, e.rmse ^ 2, over(function(a, b) return (a - b) ^ 2 end), "rmse")
      near(t, e.mae, over(function(a, b) return math.abs(a - b) end), "mae")
      near(t, e.rmse_log ^ 2, over(function(a, b) return math.log(a / b) ^ 2 end), "rmse_log")
      near(t, e.log10, over(function(a, b) return math.abs(math.log(a / b)) / math.log(10) end), "log10")
      near(t, e.irmse ^ 2, over(function(a, b) return (1 / a - 1 / b) ^ 2 end), "irmse")
      near(t, e.imae, over(function(a, b) return math.abs(1 / a - 1 / b) end), "imae")
      for k, name in ipairs { "delta1", "delta2", "delta3" } do
        near(t, e[name], over(function(a, b) return math.max(a / b, b / a) < 1.25 ^ k and 1 or 0 end), name)
      end
      t:equal(e.n_valid, #pairs)
      near(t, e.coverage, #pairs / e.n_reference)
      near(t, aib.depth.srmse(est, ref), e.srmse)
    end)
  end,

  ["depth: what is aligned does not care for the scale, srmse never does"] = function(t)
    cases(t, 400, function()
      local rows = depth_rows(5, 4)
      local est, ref = aib.depth.map(rows), aib.depth.map(depth_rows(5, 4))
      local factor = random(0.2, 5)
      local scaled = est:scaled(factor)
      coarse(t, aib.depth.srmse(scaled, ref), aib.depth.srmse(est, ref))
      coarse(t, aib.depth.srmse(est, ref), aib.depth.srmse(ref, est), "srmse is symmetric")
      for _, align in ipairs { "median", "median_lower", "scale", "log" } do
        local a, b = aib.depth.errors(est, ref, { align = align }), aib.depth.errors(scaled, ref, { align = align })
        coarse(t, b.abs_rel, a.abs_rel, align)
        coarse(t, b.scale * factor, a.scale, align)
      end
      local least = aib.depth.errors(est, ref, { align = "scale" }).rmse
      t:check(least <= aib.depth.errors(est, ref).rmse + 1e-5, "least squares")
      t:check(aib.depth.errors(est, ref, { align = "scale_shift" }).rmse <= least + 1e-4, "with a shift as well")
      local mirrored = aib.depth.map(changed(rows, function(_, x, y) return rows[y][6 - x] end))
      near(t, mirrored:summary().mean, est:summary().mean)
    end)
  end,

  ["depth: frames add up, in any order and in parts"] = function(t)
    cases(t, 200, function()
      local frames = list(5, function() return { aib.depth.map(depth_rows(4, 3)), aib.depth.map(depth_rows(4, 3)) } end)
      local all, odd, even = aib.depth.accumulate(), aib.depth.accumulate(), aib.depth.accumulate()
      for i, frame in ipairs(frames) do
        all:add(frame[1], frame[2], { name = "f" .. i })
        local part = i % 2 == 0 and even or odd
        part:add(frame[1], frame[2], { name = "f" .. i })
      end
      odd:merge(even)
      near(t, odd:result().abs_rel, all:result().abs_rel)
      near(t, odd:result({ pooled = true }).rmse, all:result({ pooled = true }).rmse)
      near(t, all:result().mae, mean(list(5, function(i)
        return aib.depth.errors(frames[i][1], frames[i][2]).mae
      end)))
    end)
  end,

  ["depth: the same map has no error of any kind"] = function(t)
    cases(t, 200, function()
      local camera = aib.math.camera { model = "PINHOLE", width = 8, height = 6, parameters = { 8, 8, 4, 3 } }
      local rows = list(6, function(y)
        return list(8, function(x) return 3 + 0.02 * x + 0.03 * y + random(0, 0.02) end)
      end)
      local map = aib.depth.map(rows)
      t:equal(aib.depth.surface_errors(map, map, camera).distance.max, 0)
      t:near(aib.depth.normal_errors(map, map, camera).mean_deg, 0, 1e-4)
      t:equal(aib.depth.errors(map, map).rmse, 0)
      local plane = aib.raster.labels(list(6, function() return list(8, function() return 1 end) end))
      local p = aib.depth.plane_errors(map, map, camera, plane)[1]
      near(t, p.flatness, p.reference_flatness)
      t:near(p.orientation_deg, 0, 1e-4)
      local est = aib.depth.map(changed(rows, function(d) return d * random(0.8, 1.2) end))
      local curve = aib.depth.risk_coverage(est, map, map)
      for i, risk in ipairs(curve.risk) do t:check(curve.oracle[i] <= risk + 1e-12, "the oracle's order is best") end
      t:check(curve.ause >= -1e-12, "ause")
      local off = aib.depth.surface_errors(est, map, camera, { tau = { 1, 2 } })
      t:check(off.within[1] <= off.within[2], "rises")
    end)
  end,

  ["raster: nearest neighbours make nothing up, masks count their labels"] = function(t)
    cases(t, 300, function()
      local rows = depth_rows(math.random(1, 9), math.random(1, 9))
      local map = aib.depth.map(rows)
      local seen = {}
      for y = 1, map.height do
        for x = 1, map.width do seen[map:at(x, y)] = true end
      end
      for _, rule in ipairs { "centre", "floor" } do
        local small = aib.depth.downsample(map, math.random(1, 9), math.random(1, 9), { rule = rule })
        for y = 1, small.height do
          for x = 1, small.width do t:check(seen[small:at(x, y)], "a value of the map") end
        end
      end
      local labels = aib.raster.labels(list(3, function() return list(4, function() return math.random(0, 3) end) end))
      local counts, total = labels:summary().counts, 0
      for label, n in pairs(counts) do
        total = total + n
        t:equal(labels:mask(label):summary().counts[1], n)
      end
      t:equal(total, 12)
    end)
  end,

  ["pose: ape is the distance of centres, stays under a common motion, swaps with its sides"] = function(t)
    cases(t, 600, function()
      local ref = walk(math.random(2, 12))
      local est = disturbed(ref, 0.5)
      local a = aib.pose.ape(est, ref)
      near(t, a.mean, mean(list(#ref, function(i) return distance(est[i].centre, ref[i].centre) end)))
      local move = rigid()
      for _, relation in ipairs { "translation", "rotation_part", "angle_deg", "point_distance" } do
        local how = { relation = relation }
        near(t, aib.pose.ape(move * est, move * ref, how).rmse, aib.pose.ape(est, ref, how).rmse, relation)
        near(t, aib.pose.ape(ref, est, how).rmse, aib.pose.ape(est, ref, how).rmse, relation)
      end
      near(t, aib.pose.ape(ref, ref, { relation = "full" }).max, 0)
    end)
  end,

  ["pose: rpe stays when either side moves"] = function(t)
    cases(t, 500, function()
      local ref = walk(math.random(3, 12))
      local est = disturbed(ref, 0.3)
      for _, relation in ipairs { "translation", "angle_deg", "full" } do
        local how = { relation = relation, delta = math.random(1, 2), all_pairs = true }
        local plain = aib.pose.rpe(est, ref, how)
        near(t, aib.pose.rpe(rigid() * est, rigid() * ref, how).rmse, plain.rmse, relation)
        t:equal(#plain.errors, #ref - how.delta)
      end
    end)
  end,

  ["pose: auc and its angles stay under similarities, rise with the angle, hold every order"] = function(t)
    cases(t, 400, function()
      local ref = walk(math.random(3, 9))
      local est = disturbed(ref, 0.4)
      for _, convention in ipairs { "paper", "vggt", "posediffusion", "da3", "exact" } do
        local how = { max_deg = 30, convention = convention }
        local a, b = aib.pose.auc(est, ref, how), aib.pose.auc(similarity() * est, similarity() * ref, how)
        t:near(b.auc, a.auc, 1e-6, convention)
        t:check(a.auc >= 0 and a.auc <= 1 and a.auc_signed <= a.auc + 1e-12, convention)
        t:check(aib.pose.auc(ref, ref, how).auc > 0.9, convention)
      end
      local order = shuffled(list(#ref, function(i) return i end))
      local angles = aib.pose.relative_angles(est, ref, { tau = { 5, 15, 30 } })
      local again = aib.pose.relative_angles(est:select(order), ref:select(order), { tau = { 5, 15, 30 } })
      t:equal(again.rra, angles.rra)
      t:check(angles.rra[5] <= angles.rra[15] and angles.rta[15] <= angles.rta[30], "rises")
      local histogram = aib.pose.pair_histogram(est, ref, { rotation = { 5, 15, 30 }, translation = { 5, 15, 30 } })
      local below = 0
      for _, n in ipairs(histogram.counts[1]) do below = below + n end
      below = below + histogram.without_direction[1]
      near(t, below / histogram.n_pairs, angles.rra[5], "the first row of the histogram")
    end)
  end,

  ["pose: rotations of pairs are their definition"] = function(t)
    cases(t, 300, function()
      local ref = walk(math.random(2, 6))
      local est = disturbed(ref, 0.4)
      local tau, hits, n = random(5, 40), 0, 0
      local function relative(poses, i, j)  -- trace of R_i' R_j
        local a, b, m = poses[i].rotation, poses[j].rotation, {}
        for r = 1, 3 do
          m[r] = {}
          for c = 1, 3 do m[r][c] = a[1][r] * b[1][c] + a[2][r] * b[2][c] + a[3][r] * b[3][c] end
        end
        return m
      end
      for i = 1, #ref do
        for j = i + 1, #ref do
          local a, b, trace = relative(est, i, j), relative(ref, i, j), 0
          for r = 1, 3 do
            for c = 1, 3 do trace = trace + a[r][c] * b[r][c] end
          end
          n = n + 1
          local angle = math.deg(math.acos(math.max(-1, math.min(1, (trace - 1) / 2))))
          if angle < tau then hits = hits + 1 end
        end
      end
      near(t, aib.pose.relative_angles(est, ref, { tau = { tau } }).rra[tau], hits / n)
    end)
  end,

  ["pose: kitti_odometry and sub-trajectories stay when either side moves"] = function(t)
    cases(t, 60, function()
      local ref = aib.pose.trajectory(list(60, function(i)
        return aib.math.pose { rotation = rotation(0.01 * i), centre = { 5 * i, random(-0.1, 0.1), 0 } }
      end))
      local est = disturbed(ref, 0.1)
      local how = { lengths = { 50, 100 }, step = 5 }
      local a, b = aib.pose.kitti_odometry(est, ref, how), aib.pose.kitti_odometry(rigid() * est, rigid() * ref, how)
      near(t, b.translation_percent, a.translation_percent)
      near(t, b.rotation_deg_per_m, a.rotation_deg_per_m)
      local c = aib.pose.sub_trajectories(est, ref, { lengths = { 50 } })[1]
      local d = aib.pose.sub_trajectories(rigid() * est, ref, { lengths = { 50 } })[1]
      near(t, d.translation.rmse, c.translation.rmse)
    end)
  end,

  ["pose: names, missing frames and focal lengths are counted"] = function(t)
    cases(t, 500, function()
      local n = math.random(2, 10)
      local names = list(n, function(i) return ("image%02d.png"):format(i) end)
      local poses = list(n, function() return aib.math.pose { centre = vector(1) } end)
      local ref = aib.pose.trajectory(poses, { names = names })
      local kept = {}
      for i = 1, n do
        if math.random() < 0.6 then kept[#kept + 1] = i end
      end
      if #kept == 0 then kept = { 1 } end
      local est = ref:select(shuffled(kept))
      near(t, aib.pose.registration_rate(est, ref).rate, #kept / n)
      local est2, ref2, info = aib.pose.associate(est, ref)
      t:equal({ info.n_matched, #est2, #ref2, info.n_reference_only }, { #kept, #kept, #kept, n - #kept })
      t:equal(aib.pose.ape(est2, ref2).max, 0)
      local cameras, sum = {}, 0
      for _, name in ipairs(names) do
        local f = random(50, 150)
        cameras[name] = aib.math.camera {
          model = "SIMPLE_PINHOLE", width = 100, height = 80, parameters = { f, 50, 40 },
        }
        sum = sum + math.abs(f - 100) / 100
      end
      near(t, aib.pose.focal_error(cameras, 100).mre, sum / n)
      near(t, aib.pose.intrinsics_error(cameras, cameras).reprojection_px, 0)
    end)
  end,

  ["align: what was moved is moved back"] = function(t)
    cases(t, 600, function()
      local ref = walk(math.random(4, 12))
      local moved = similarity()
      local est = moved * ref
      local found = aib.align.umeyama(est, ref)
      near(t, found.scale * moved.scale, 1)
      t:near(aib.pose.ape(found * est, ref).max, 0, 1e-6)
      t:near(aib.pose.ape(aib.align.trajectory(est, ref).transform * est, ref).max, 0, 1e-6)
      local noisy = disturbed(est, 0.1)
      local best = aib.align.umeyama(noisy, ref)
      local rmse = aib.pose.ape(best * noisy, ref).rmse
      local other = aib.math.sim3 { scale = random(0.95, 1.05), rotation = rotation(0.05), translation = vector(0.05) }
      t:check(rmse <= aib.pose.ape((other * best) * noisy, ref).rmse + 1e-9, "nothing near is better")
      near(t, aib.align.umeyama(noisy, ref, { scale = false }).scale, 1)
    end)
  end,

  ["align: batches find each its own, icp leaves what fits"] = function(t)
    cases(t, 100, function()
      local ref = walk(12)
      local first, second = similarity(), similarity()
      local poses = list(12, function(i) return (i <= 6 and first or second) * ref[i] end)
      local _, moved = aib.align.batches(aib.pose.trajectory(poses), ref, { size = 6 })
      t:near(aib.pose.ape(moved, ref).max, 0, 1e-6)
      local cloud = aib.cloud.from_points(list(30, function() return vector(1) end))
      local fit = aib.align.icp(cloud, cloud, { max_distance = 1 })
      t:near(fit.rmse, 0, 1e-6)
      t:near(fit.transform.angle_deg, 0, 1e-4)
    end)
  end,

  ["math: transforms undo themselves and compose"] = function(t)
    cases(t, 1000, function()
      local a, b, p = similarity(), similarity(), vector(3)
      local back = a:inverse() * (a * p)
      local both, one = (a * b) * p, a * (b * p)
      for i = 1, 3 do
        near(t, back[i], p[i])
        near(t, both[i], one[i])
      end
      near(t, (a * b).scale, a.scale * b.scale)
    end)
  end,
}
