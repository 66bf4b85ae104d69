-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What must hold of clouds whatever the points: distances of every pair, and how numbers change where points are
--- moved, scaled, swapped, doubled or put in another order.
local aib = require "aib"
local p = require "properties"

local near, coarse, list, random, vector = p.near, p.coarse, p.list, p.random, p.vector
local from_points <const> = aib.cloud.from_points

--- Whole numbers as coordinates: distances repeat, and some are exactly a threshold.
local function lattice(n) return list(n, function() return list(3, function() return math.random(0, 3) end) end) end

--- Distances of `from` to the nearest of `to`, by the rule beyond `most`.
local function distances_of(from, to, most, rule)
  local counted, beyond = {}, 0
  for _, point in ipairs(from) do
    local d = p.nearest(point, to)
    if most and d >= most then
      beyond = beyond + 1
      d = rule == "clamp" and most or nil
    end
    counted[#counted + 1] = d
  end
  return counted, beyond
end

local function harmonic(a, b) return a + b > 0 and 2 * a * b / (a + b) or 0 end

local function rms(values) return math.sqrt(p.mean(list(#values, function(i) return values[i] ^ 2 end))) end

return p.suite {
  ["cloud: distances are those of every pair"] = { 1000, function(t)
    local size = math.random() < 0.3 and 0 or 1
    local from = list(math.random(1, 12), function() return vector(1 + size) end)
    local to = list(math.random(1, 12), function() return vector(1) end)
    local d = aib.cloud.distances(aib.cloud.from_points(from), aib.cloud.from_points(to))
    for i, point in ipairs(from) do t:near(d[i], (p.nearest(point, to)), 1e-6) end
  end },

  ["cloud: a comparison swaps with its clouds, scales with them and stays when they move"] = { 600, function(t)
    local points = list(math.random(2, 40), function() return vector(1) end)
    local est = aib.cloud.from_points(points)
    local ref = aib.cloud.from_points(list(math.random(2, 40), function() return vector(1) end))
    local c = aib.cloud.compare(est, ref, { tau = 0.3 })
    local swapped = aib.cloud.compare(ref, est, { tau = 0.3 })
    t:equal({ c.accuracy, c.hausdorff, c.precision[0.3], c.f_score[0.3], c.chamfer },
      { swapped.completeness, swapped.hausdorff, swapped.recall[0.3], swapped.f_score[0.3], swapped.chamfer })
    local move, grow = p.rigid(), aib.math.sim3 { scale = 2 }
    coarse(t, aib.cloud.compare(move * est, move * ref).chamfer, c.chamfer)
    near(t, aib.cloud.compare(grow * est, grow * ref, { tau = 0.6 }).accuracy_rmse, 2 * c.accuracy_rmse)
    t:equal(aib.cloud.compare(grow * est, grow * ref, { tau = 0.6 }).f_score[0.6], c.f_score[0.3])
    coarse(t, aib.cloud.compare(aib.cloud.from_points(p.shuffled(points)), ref).accuracy, c.accuracy)
    local twice = aib.cloud.joined { est, est }
    near(t, aib.cloud.compare(twice, ref).accuracy, c.accuracy)
    near(t, c.chamfer_mean, (c.accuracy + c.completeness) / 2)
    near(t, c.f1_distance, 2 * c.accuracy * c.completeness / (c.accuracy + c.completeness))
    t:check(c.accuracy <= c.accuracy_rmse + 1e-12 and c.accuracy_rmse <= c.hausdorff + 1e-12, "mean, rms, maximum")
  end },

  ["cloud: precision rises with the threshold, more points raise recall"] = { 400, function(t)
    local est = aib.cloud.from_points(list(20, function() return vector(1) end))
    local ref = aib.cloud.from_points(list(20, function() return vector(1) end))
    local more = aib.cloud.joined { est, aib.cloud.from_points(list(5, function() return vector(1) end)) }
    local c = aib.cloud.compare(est, ref, { tau = { 0.1, 0.3, 0.5 } })
    t:check(c.precision[0.1] <= c.precision[0.3] and c.precision[0.3] <= c.precision[0.5], "rises")
    t:check(aib.cloud.compare(more, ref, { tau = 0.3 }).recall[0.3] >= c.recall[0.3], "recall")
    t:check(aib.cloud.compare(more, ref).completeness <= c.completeness + 1e-12, "completeness")
  end },

  ["cloud: eth3d is complete where both are the same, crop and joined keep points"] = { 200, function(t)
    local points = aib.cloud.from_points(list(30, function() return vector(1) end))
    local scan = { points = points, scanner = { 0, 0, 9 } }
    local scores = aib.cloud.eth3d(points, { scan }, { tolerances = { 0.05, 0.2 } })
    t:equal(scores.completeness[0.05], 1)
    t:check(scores.completeness[0.05] <= scores.completeness[0.2], "rises")
    local middle = { min = { -0.5, -1, -1 }, max = { 0.5, 1, 1 } }
    local left, right = { plane = { -1, 0, 0, 0 } }, { plane = { 1, 0, 0, 0 } }
    t:equal(#aib.cloud.crop(points, left) + #aib.cloud.crop(points, right), #points)
    t:equal(#aib.cloud.crop(aib.cloud.crop(points, middle), middle), #aib.cloud.crop(points, middle))
  end },

  ["cloud: a comparison is its definition, thresholds exactly met and invalid points included"] = { 500, function(t)
    local est, ref = lattice(math.random(1, 15)), lattice(math.random(1, 15))
    local rule = ({ "drop", "clamp" })[math.random(2)]
    local most = math.random() < 0.6 and 3 or nil
    local to_ref, est_beyond = distances_of(est, ref, most, rule)
    local to_est, ref_beyond = distances_of(ref, est, most, rule)
    if #to_ref == 0 or #to_est == 0 then return end
    local with_holes = table.move(est, 1, #est, 1, {})
    table.insert(with_holes, math.random(#est), { 1, 0 / 0, 2 })
    table.insert(with_holes, { math.huge, 0, 0 })
    local options = { tau = { 1, 2, 3 }, max_distance = most, rule = rule }
    local c = aib.cloud.compare(from_points(with_holes), from_points(ref), options)
    t:equal({ c.n_estimate, c.n_reference, c.n_dropped }, { #est, #ref, 2 })
    near(t, c.estimate_beyond, est_beyond / #est)
    near(t, c.reference_beyond, ref_beyond / #ref)
    near(t, c.accuracy, p.mean(to_ref))
    near(t, c.completeness, p.mean(to_est))
    near(t, c.accuracy_median, p.median(to_ref))
    near(t, c.completeness_rmse, rms(to_est))
    near(t, c.hausdorff, math.max(math.max(table.unpack(to_ref)), math.max(table.unpack(to_est))))
    near(t, c.f1_distance, harmonic(p.mean(to_ref), p.mean(to_est)))
    for _, threshold in ipairs { 1, 2, 3 } do
      local precision = p.share_below(to_ref, threshold) * #to_ref / #est
      local recall = p.share_below(to_est, threshold) * #to_est / #ref
      near(t, c.precision[threshold], precision)
      near(t, c.recall[threshold], recall)
      near(t, c.f_score[threshold], harmonic(precision, recall))
    end
  end },

  ["cloud: distances both ways, their scores and curves are those of a comparison"] = { 300, function(t)
    local est, ref = p.cloud(math.random(1, 30)), p.cloud(math.random(1, 30))
    local to_ref, to_est = aib.cloud.distances_both_ways(est, ref)
    local c = aib.cloud.compare(est, ref, { tau = { 0.25, 0.5 } })
    t:equal(aib.cloud.score(to_ref, to_est, { tau = { 0.25, 0.5 } }), c)
    local curve = aib.cloud.curve(to_ref, to_est, { max = 0.5, steps = 2 })
    t:equal({ curve.tau[1], curve.tau[2] }, { 0.25, 0.5 })
    t:equal({ curve.precision[1], curve.recall[2] }, { c.precision[0.25], c.recall[0.5] })
    t:equal(curve.f_score[2], c.f_score[0.5])
    local values = list(#to_ref, function(i) return to_ref[i] end)
    t:equal(to_ref:share_below(0.5), p.share_below(values, 0.5))
    t:equal({ to_ref:max(), to_ref:quantile(0) }, { math.max(table.unpack(values)), math.min(table.unpack(values)) })
    near(t, to_ref:quantile(0.5), p.median(values))
    local histogram, n = to_ref:histogram { max = 0.5, bins = 2 }, #values
    t:equal(histogram.counts[1], math.tointeger(n * p.share_below(values, 0.25) + 0.5 // 1))
    t:equal(histogram.counts[1] + histogram.counts[2] + histogram.above, n)
  end },

  ["cloud: what lies in map coordinates, beside a stray, is measured as at the origin"] = { 300, function(t)
    local est, ref = p.points(math.random(3, 20)), p.points(math.random(3, 20))
    local function placed(points, stray)
      local corner = { -458000, -5429000, -90 }
      local out = list(#points, function(i) return p.minus(points[i], corner) end)
      if stray then table.insert(out, math.random(#out + 1), { 10 ^ random(4, 15), 0, 0 }) end
      return from_points(out)
    end
    local here = aib.cloud.compare(from_points(est), from_points(ref), { tau = 0.4 })
    local there = aib.cloud.compare(placed(est), placed(ref), { tau = 0.4 })
    t:near(there.chamfer, here.chamfer, 2e-6)
    t:near(there.hausdorff, here.hausdorff, 2e-6)
    local beside = aib.cloud.compare(placed(est, true), placed(ref), { tau = 0.4, max_distance = 100 })
    t:near(beside.accuracy, here.accuracy, 1e-5)
    t:near(beside.estimate_beyond, 1 / (#est + 1), 1e-12)
    t:near(beside.completeness, here.completeness, 1e-5)
  end },

  ["cloud: labels divide a comparison, each point to the label of its nearest"] = { 300, function(t)
    local est, ref = p.points(math.random(1, 25)), p.points(math.random(2, 25))
    local labels = list(#ref, function() return math.random(0, 2) end)
    local labelled, tau = p.cloud_with(ref, { labels = labels }), 0.4
    local parts = aib.cloud.compare_by_label(from_points(est), labelled, { tau = tau })
    local whole = aib.cloud.compare(from_points(est), labelled, { tau = tau })
    local expected = {}
    for _, point in ipairs(est) do
      local _, at = p.nearest(point, ref)
      expected[labels[at]] = (expected[labels[at]] or 0) + 1
    end
    local n_est, n_ref, accuracy, near_ref, complete = 0, 0, 0, 0, true
    for _, part in ipairs(parts) do
      t:equal(part.n_estimate, expected[part.label] or 0)
      n_est, n_ref = n_est + part.n_estimate, n_ref + part.n_reference
      complete = complete and part.accuracy ~= nil
      accuracy = accuracy + (part.accuracy or 0) * part.n_estimate
      near_ref = near_ref + (part.recall and part.recall[tau] or 0) * part.n_reference
    end
    t:equal({ n_est, n_ref }, { #est, #ref })
    if not complete then return end
    near(t, accuracy / n_est, whole.accuracy)
    near(t, near_ref / n_ref, whole.recall[tau])
  end },

  ["cloud: offsets are distances along normals, and turn round with them"] = { 300, function(t)
    local from, ref = p.points(math.random(1, 20)), p.points(math.random(1, 20))
    local normals = list(#ref, function() return p.unit(vector(1)) end)
    local opposite = list(#ref, function(i) return p.scaled(normals[i], -1) end)
    local surface = p.cloud_with(ref, { normals = normals })
    local o = aib.cloud.offsets(from_points(from), surface)
    local back = aib.cloud.offsets(from_points(from), p.cloud_with(ref, { normals = opposite }))
    for i, point in ipairs(from) do
      local least, at = p.nearest(point, ref)
      t:near(o[i], p.dot(p.minus(point, ref[at]), normals[at]), 1e-5)
      t:near(back[i], -o[i], 1e-6)
      t:check(math.abs(o[i]) <= least + 1e-5, "no longer than the distance")
    end
    local move = p.rigid()
    coarse(t, aib.cloud.offsets(move * from_points(from), move * surface):mean(), o:mean())
    local grow = aib.math.sim3 { scale = 2 }
    near(t, aib.cloud.offsets(grow * from_points(from), grow * surface):median(), 2 * o:median())
  end },

  ["cloud: normal consistency is the mean |cosine| of nearest points"] = { 300, function(t)
    local function made_up()
      local points = p.points(math.random(1, 20))
      return points, list(#points, function() return p.unit(vector(1)) end)
    end
    local est, est_normals = made_up()
    local ref, ref_normals = made_up()
    local a, b = p.cloud_with(est, { normals = est_normals }), p.cloud_with(ref, { normals = ref_normals })
    local cosines = list(#est, function(i)
      local _, at = p.nearest(est[i], ref)
      return math.abs(p.dot(est_normals[i], ref_normals[at]))
    end)
    local c, swapped = aib.cloud.normal_consistency(a, b), aib.cloud.normal_consistency(b, a)
    t:near(c.estimate_mean, p.mean(cosines), 1e-6)
    t:near(c.estimate_median, p.median(cosines), 1e-6)
    t:equal({ c.estimate_mean, c.reference_median }, { swapped.reference_mean, swapped.estimate_median })
    local move = p.rigid()
    coarse(t, aib.cloud.normal_consistency(move * a, move * b).reference_mean, c.reference_mean)
    t:near(aib.cloud.normal_consistency(a, a).estimate_mean, 1, 1e-6)
    local turned = list(#est, function(i) return p.scaled(est_normals[i], i % 2 * 2 - 1) end)
    local either_way = aib.cloud.normal_consistency(p.cloud_with(est, { normals = turned }), b)
    t:near(either_way.estimate_mean, c.estimate_mean, 1e-6)
  end },

  ["cloud: outliers go by their neighbours, crops by their volume, subsets by chance"] = { 300, function(t)
    local points = p.points(math.random(2, 25))
    local cloud, k, radius = from_points(points), math.random(2, 6), random(0.2, 1)
    local near_count, spreads = 0, {}
    for i, a in ipairs(points) do
      local others = p.sorted(list(#points, function(j) return p.distance(a, points[j]) end))
      near_count = near_count + (p.share_below(others, radius) * #points > 2.5 and 1 or 0)
      spreads[i] = p.mean(table.move(others, 1, math.min(k, #points), 1, {}))
    end
    t:equal(#aib.cloud.without_radius_outliers(cloud, { radius = radius }), near_count)
    local m, sum = p.mean(spreads), 0
    for _, s in ipairs(spreads) do sum = sum + (s - m) ^ 2 end
    local limit, kept = m + 1.5 * math.sqrt(sum / (#points - 1)), 0
    for _, s in ipairs(spreads) do
      if math.abs(s - limit) < 1e-6 then return end  -- a tie, which rounding decides
      kept = kept + (s < limit and 1 or 0)
    end
    t:equal(#aib.cloud.without_statistical_outliers(cloud, { neighbours = k, ratio = 1.5 }), kept)

    local box = { min = { -0.4, -0.6, -0.5 }, max = { 0.7, 0.3, 0.9 } }
    local inside = 0
    for _, a in ipairs(points) do
      local within = true
      for i = 1, 3 do within = within and a[i] >= box.min[i] and a[i] <= box.max[i] end
      inside = inside + (within and 1 or 0)
    end
    t:equal(#aib.cloud.crop(cloud, box), inside)
    local centre, turn = list(3, function(i) return (box.min[i] + box.max[i]) / 2 end), p.rotation()
    local move = aib.math.sim3 { rotation = turn }
    local oriented = { centre = move * centre, size = p.minus(box.max, box.min), rotation = turn }
    t:equal(#aib.cloud.crop(move * cloud, oriented), inside)
    local n = math.random(0, #points + 3)
    local subset = aib.cloud.random_subset(cloud, n, { seed = 7 })
    t:equal(#subset, math.min(n, #points))
    if #subset > 0 then t:equal(aib.cloud.distances(subset, cloud):max(), 0) end
  end },

  ["cloud: eth3d's completeness is a mean over the voxels of two lattices"] = { 200, function(t)
    local scanned, est = p.points(math.random(2, 30)), p.points(math.random(2, 30))
    local voxel, tau = random(0.2, 0.9), random(0.2, 0.6)
    local shares = {}
    for _, shift in ipairs { 0, 0.5 } do
      local cells = {}
      for _, point in ipairs(scanned) do
        local key = table.concat(list(3, function(i) return math.floor(point[i] / voxel + shift) end), " ")
        local cell = cells[key] or { n = 0, good = 0 }
        cell.n, cell.good = cell.n + 1, cell.good + (p.nearest(point, est) < tau and 1 or 0)
        cells[key] = cell
      end
      for _, cell in pairs(cells) do shares[#shares + 1] = cell.good / cell.n end
    end
    local scan = { points = from_points(scanned), scanner = { 0, 0, 9 } }
    local e = aib.cloud.eth3d(from_points(est), { scan }, { tolerances = { tau, 2 * tau }, voxel = voxel })
    near(t, e.completeness[tau], p.mean(shares))
    t:check(not e.accuracy[tau] or e.accuracy[tau] >= 0 and e.accuracy[tau] <= e.accuracy[2 * tau] + 1e-12 or
      e.n_unobserved[2 * tau] < e.n_unobserved[tau], "accuracy rises where as much is observed")
    t:equal({ e.n_estimate, e.n_reference }, { #est, #scanned })
  end },

  ["stream: what is compared from files is what is compared in memory, bit for bit"] = { 40, function(t)
    local stray = math.random() < 0.5
    local function file(points)
      if stray then points[#points + 1] = { 10 ^ random(4, 9), 1, 2 } end
      local text = "ply\nformat binary_little_endian 1.0\nelement vertex " .. #points
        .. "\nproperty double x\nproperty double y\nproperty double z\nend_header\n"
      local path = os.tmpname()
      aib.system.write_text(path, text .. table.concat(list(#points, function(i)
        return string.pack("<ddd", table.unpack(points[i]))
      end)))
      return path
    end
    local size = 10 ^ random(0, 6)  -- the larger ones are counted from an origin
    local est, ref = p.points(math.random(1, 60), size), p.points(math.random(1, 60), size)
    est[#est + 1] = { 0 / 0, 0, 0 }
    local est_path, ref_path = file(est), file(ref)
    local options = { tau = { size / 9, size / 5 }, max_distance = math.random() < 0.5 and 20 * size or nil }
    local in_memory = aib.cloud.compare(aib.io.read_cloud(est_path), aib.io.read_cloud(ref_path), options)
    t:equal(aib.stream.compare_clouds(est_path, ref_path, options), in_memory)
    os.remove(est_path)
    os.remove(ref_path)
  end },
}
