-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What must hold of poses, intrinsics and alignments whatever the trajectory: definitions written out anew, and how
--- numbers change where trajectories are moved, scaled, swapped, reversed or put in another order.
local aib = require "aib"
local p = require "properties"

local near, list, random, vector, mean = p.near, p.list, p.random, p.vector, p.mean
local walk, disturbed = p.walk, p.disturbed

--- Errors of all pairs of frames: { rotation, direction } in degrees, of camera-from-world poses E_i E_j^-1 or
--- E_j E_i^-1.
local function pair_errors(est, ref, reversed)
  local errors = {}
  local function motion(t, i, j)
    local a, b = t[i], t[j]
    return p.from_to(a.rotation, b.rotation), p.turned_back(a.rotation, p.minus(b.centre, a.centre))
  end
  for i = 1, #ref do
    for j = i + 1, #ref do
      local from, to = i, j
      if reversed then from, to = j, i end
      local est_turn, est_way = motion(est, from, to)
      local ref_turn, ref_way = motion(ref, from, to)
      errors[#errors + 1] = { p.rotation_deg(p.from_to(est_turn, ref_turn)), p.angle_deg(est_way, ref_way) }
    end
  end
  return errors
end

--- Mean of the cumulative shares of a histogram of `bins` bins on [0, 30], the last closed.
local function area_of_histogram(errors, bins)
  local area, width = 0, 30 / bins
  for k = 1, bins do
    local n = 0
    for _, e in ipairs(errors) do n = n + ((e < k * width or k == bins and e <= 30) and 1 or 0) end
    area = area + n / #errors / bins
  end
  return area
end

--- E = est^-1 ref as angle in degrees and translation.
local function difference(est, ref)
  return p.from_to(est.rotation, ref.rotation), p.turned_back(est.rotation, p.minus(ref.centre, est.centre))
end

local function from_identity(m)
  local sum = 0
  for r = 1, 3 do
    for c = 1, 3 do sum = sum + (m[r][c] - (r == c and 1 or 0)) ^ 2 end
  end
  return math.sqrt(sum)
end

local function backwards(t) return t:select(list(#t, function(i) return #t + 1 - i end)) end

--- Trajectory with each rotation kept and centres `factor` times as far from the origin.
local function grown(t, factor)
  return aib.pose.trajectory(list(#t, function(i)
    return aib.math.pose { rotation = t[i].rotation, centre = p.scaled(t[i].centre, factor) }
  end))
end

--- A flight of which sub-trajectories and segments are cut.
local function drive(n)
  return aib.pose.trajectory(list(n, function(i)
    return aib.math.pose { rotation = p.rotation(0.01 * i), centre = { 5 * i, random(-0.1, 0.1), 0 } }
  end))
end

return p.suite {
  ["pose: ape is the distance of centres, stays under a common motion, swaps with its sides"] = { 600, function(t)
    local ref = walk(math.random(2, 12))
    local est = disturbed(ref, 0.5)
    local a = aib.pose.ape(est, ref)
    near(t, a.mean, mean(list(#ref, function(i) return p.distance(est[i].centre, ref[i].centre) end)))
    local move = p.rigid()
    for _, relation in ipairs { "translation", "rotation_part", "angle_deg", "point_distance" } do
      local how = { relation = relation }
      near(t, aib.pose.ape(move * est, move * ref, how).rmse, aib.pose.ape(est, ref, how).rmse, relation)
      near(t, aib.pose.ape(ref, est, how).rmse, aib.pose.ape(est, ref, how).rmse, relation)
    end
    near(t, aib.pose.ape(ref, ref, { relation = "full" }).max, 0)
  end },

  ["pose: rpe stays when either side moves"] = { 500, function(t)
    local ref = walk(math.random(3, 12))
    local est = disturbed(ref, 0.3)
    for _, relation in ipairs { "translation", "angle_deg", "full" } do
      local how = { relation = relation, delta = math.random(1, 2), all_pairs = true }
      local plain = aib.pose.rpe(est, ref, how)
      near(t, aib.pose.rpe(p.rigid() * est, p.rigid() * ref, how).rmse, plain.rmse, relation)
      t:equal(#plain.errors, #ref - how.delta)
    end
  end },

  ["pose: auc and its angles stay under similarities, rise with the angle, hold every order"] = { 200, function(t)
    local ref = walk(math.random(3, 9))
    local est = disturbed(ref, 0.4)
    for _, convention in ipairs { "paper", "vggt", "posediffusion", "da3", "exact" } do
      local how = { max_deg = 30, convention = convention }
      local a, b = aib.pose.auc(est, ref, how), aib.pose.auc(p.similarity() * est, p.similarity() * ref, how)
      t:near(b.auc, a.auc, 1e-6, convention)
      t:check(a.auc >= 0 and a.auc <= 1 and a.auc_signed <= a.auc + 1e-12, convention)
      t:check(aib.pose.auc(ref, ref, how).auc > 0.9, convention)
    end
    local order = p.shuffled(list(#ref, function(i) return i end))
    local angles = aib.pose.relative_angles(est, ref, { tau = { 5, 15, 30 } })
    local again = aib.pose.relative_angles(est:select(order), ref:select(order), { tau = { 5, 15, 30 } })
    t:equal(again.rra, angles.rra)
    t:check(angles.rra[5] <= angles.rra[15] and angles.rta[15] <= angles.rta[30], "rises")
    local histogram = aib.pose.pair_histogram(est, ref, { rotation = { 5, 15, 30 }, translation = { 5, 15, 30 } })
    local below = 0
    for _, n in ipairs(histogram.counts[1]) do below = below + n end
    below = below + histogram.without_direction[1]
    near(t, below / histogram.n_pairs, angles.rra[5], "the first row of the histogram")
  end },

  ["pose: rotations of pairs are their definition"] = { 300, function(t)
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
  end },

  ["pose: kitti_odometry and sub-trajectories stay when either side moves"] = { 60, function(t)
    local ref = aib.pose.trajectory(list(60, function(i)
      return aib.math.pose { rotation = p.rotation(0.01 * i), centre = { 5 * i, random(-0.1, 0.1), 0 } }
    end))
    local est = disturbed(ref, 0.1)
    local how = { lengths = { 50, 100 }, step = 5 }
    local a, b = aib.pose.kitti_odometry(est, ref, how), aib.pose.kitti_odometry(p.rigid() * est, p.rigid() * ref, how)
    near(t, b.translation_percent, a.translation_percent)
    near(t, b.rotation_deg_per_m, a.rotation_deg_per_m)
    local c = aib.pose.sub_trajectories(est, ref, { lengths = { 50 } })[1]
    local d = aib.pose.sub_trajectories(p.rigid() * est, ref, { lengths = { 50 } })[1]
    near(t, d.translation.rmse, c.translation.rmse)
  end },

  ["pose: names, missing frames and focal lengths are counted"] = { 500, function(t)
    local n = math.random(2, 10)
    local names = list(n, function(i) return ("image%02d.png"):format(i) end)
    local poses = list(n, function() return aib.math.pose { centre = vector(1) } end)
    local ref = aib.pose.trajectory(poses, { names = names })
    local kept = {}
    for i = 1, n do
      if math.random() < 0.6 then kept[#kept + 1] = i end
    end
    if #kept == 0 then kept = { 1 } end
    local est = ref:select(p.shuffled(kept))
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
  end },

  ["align: what was moved is moved back"] = { 600, function(t)
    local ref = walk(math.random(4, 12))
    local moved = p.similarity()
    local est = moved * ref
    local found = aib.align.umeyama(est, ref)
    near(t, found.scale * moved.scale, 1)
    t:near(aib.pose.ape(found * est, ref).max, 0, 1e-6)
    t:near(aib.pose.ape(aib.align.trajectory(est, ref).transform * est, ref).max, 0, 1e-6)
    local noisy = disturbed(est, 0.1)
    local best = aib.align.umeyama(noisy, ref)
    local rmse = aib.pose.ape(best * noisy, ref).rmse
    local other = aib.math.sim3 { scale = random(0.95, 1.05), rotation = p.rotation(0.05), translation = vector(0.05) }
    t:check(rmse <= aib.pose.ape((other * best) * noisy, ref).rmse + 1e-9, "nothing near is better")
    near(t, aib.align.umeyama(noisy, ref, { scale = false }).scale, 1)
  end },

  ["align: batches find each its own, icp leaves what fits"] = { 100, function(t)
    local ref = walk(12)
    local first, second = p.similarity(), p.similarity()
    local poses = list(12, function(i) return (i <= 6 and first or second) * ref[i] end)
    local _, moved = aib.align.batches(aib.pose.trajectory(poses), ref, { size = 6 })
    t:near(aib.pose.ape(moved, ref).max, 0, 1e-6)
    local cloud = aib.cloud.from_points(list(30, function() return vector(1) end))
    local fit = aib.align.icp(cloud, cloud, { max_distance = 1 })
    t:near(fit.rmse, 0, 1e-6)
    t:near(fit.transform.angle_deg, 0, 1e-4)
  end },

  ["math: transforms undo themselves and compose"] = { 1000, function(t)
    local a, b, point = p.similarity(), p.similarity(), vector(3)
    local back = a:inverse() * (a * point)
    local both, one = (a * b) * point, a * (b * point)
    for i = 1, 3 do
      near(t, back[i], point[i])
      near(t, both[i], one[i])
    end
    near(t, (a * b).scale, a.scale * b.scale)
  end },

  ["pose: auc is the area of its convention's recall"] = { 200, function(t)
    local ref = walk(math.random(2, 8))
    local est = disturbed(ref, ({ 0.05, 0.3, 1 })[math.random(3)])
    local errors = pair_errors(est, ref)
    local rotations = list(#errors, function(i) return errors[i][1] end)
    local directions = list(#errors, function(i) return errors[i][2] end)
    local paper = mean(list(30, function(tau)
      return math.min(p.share_below(rotations, tau), p.share_below(directions, tau))
    end))
    local exact = mean(list(#errors, function(i)
      return math.max(0, 30 - math.max(errors[i][1], errors[i][2])) / 30
    end))
    local function folded(of)
      return list(#of, function(i) return math.max(of[i][1], math.min(of[i][2], 180 - of[i][2])) end)
    end
    local other = folded(pair_errors(est, ref, true))
    for convention, expected in pairs {
      paper = paper, exact = exact, vggt = area_of_histogram(folded(errors), 30),
      posediffusion = area_of_histogram(other, 30), posediffusion_torch = area_of_histogram(other, 31),
    } do
      t:near(aib.pose.auc(est, ref, { convention = convention }).auc, expected, 1e-6, convention)
    end
    local tau = random(1, 179)
    local angles = aib.pose.relative_angles(est, ref, { tau = { tau } })
    near(t, angles.rra[tau], p.share_below(rotations, tau))
    near(t, angles.rta[tau], p.share_below(directions, tau))
    local back = aib.pose.relative_angles(backwards(est), backwards(ref), { tau = { tau } })
    near(t, back.rra[tau], angles.rra[tau])
    local worst = aib.pose.worst_pairs(est, ref, { n = math.maxinteger })
    t:equal(#worst, #errors)
    local sizes = p.sorted(list(#errors, function(i) return math.max(errors[i][1], errors[i][2]) end))
    for i, pair in ipairs(worst) do
      t:near(math.max(pair.rotation_deg, pair.translation_deg), sizes[#sizes + 1 - i], 1e-6)
    end
  end },

  ["pose: batches and gaps divide the pairs"] = { 200, function(t)
    local ref = walk(math.random(4, 9))
    local est = disturbed(ref, 0.3)
    local whole = aib.pose.auc(est, ref)
    local function sums(parts)
      local n, rra = 0, 0
      for _, part in ipairs(parts) do
        n = n + part.n_pairs
        rra = rra + (part.rra and part.rra[5] or 0) * part.n_pairs
      end
      return n, rra / n
    end
    local batch = list(#ref, function(i) return i <= #ref // 2 and 1 or 2 end)
    local by_batch = aib.pose.auc_by_batch(est, ref, batch)
    local n, rra = sums { by_batch.intra, by_batch.cross }
    t:equal({ n, by_batch.cross.n_pairs }, { whole.n_pairs, (#ref // 2) * (#ref - #ref // 2) })
    near(t, rra, whole.rra[5])
    local gaps = aib.pose.auc_by_gap(est, ref, { { 1, 1 }, { 2, #ref - 1 } })
    n, rra = sums(gaps)
    t:equal({ n, gaps[1].n_pairs }, { whole.n_pairs, #ref - 1 })
    near(t, rra, whole.rra[5])
    near(t, aib.pose.auc_by_gap(est, ref, { { 1, #ref } })[1].auc, whole.auc)
  end },

  ["pose: absolute and relative errors are their relations"] = { 150, function(t)
    local ref = walk(math.random(3, 9))
    local est = disturbed(ref, 0.5)
    local delta = math.random(1, 2)
    local function check(found, motions, what)
      t:equal(#found.errors, #motions)
      for i, e in ipairs(found.errors) do near(t, e, motions[i], what) end
    end
    local absolute, relative = {}, {}
    for i = 1, #ref do absolute[i] = { difference(est[i], ref[i]) } end
    for i = 1, #ref - delta do
      local est_turn, est_way = difference(est[i], est[i + delta])
      local ref_turn, ref_way = difference(ref[i], ref[i + delta])
      relative[i] = { p.from_to(ref_turn, est_turn), p.turned_back(ref_turn, p.minus(est_way, ref_way)),
        math.abs(p.norm(ref_way) - p.norm(est_way)), p.norm(ref_way) }
    end
    local sizes = {
      translation = function(m) return p.norm(m[2]) end,
      rotation_part = function(m) return from_identity(m[1]) end,
      full = function(m) return math.sqrt(from_identity(m[1]) ^ 2 + p.dot(m[2], m[2])) end,
      angle_deg = function(m) return p.rotation_deg(m[1]) end,
      angle_rad = function(m) return math.rad(p.rotation_deg(m[1])) end,
    }
    for relation, size in pairs(sizes) do
      local each = list(#absolute, function(i) return size(absolute[i]) end)
      check(aib.pose.ape(est, ref, { relation = relation }), each, relation)
      local found = aib.pose.rpe(est, ref, { relation = relation, delta = delta, all_pairs = true })
      check(found, list(#relative, function(i) return size(relative[i]) end), relation)
    end
    local how = { delta = delta, all_pairs = true }
    for relation, size in pairs {
      point_distance = function(m) return m[3] end,
      point_distance_ratio = function(m) return 100 * m[3] / m[4] end,
    } do
      how.relation = relation
      check(aib.pose.rpe(est, ref, how), list(#relative, function(i) return size(relative[i]) end), relation)
    end
    for _, relation in ipairs { "angle_deg", "point_distance" } do
      how.relation = relation
      near(t, aib.pose.rpe(backwards(est), backwards(ref), how).mean, aib.pose.rpe(est, ref, how).mean, "backwards")
    end
    near(t, aib.pose.ape(grown(est, 3), grown(ref, 3)).rmse, 3 * aib.pose.ape(est, ref).rmse)
  end },

  ["pose: segments by length are scored as KITTI's, and their shares do not see the scale"] = { 60, function(t)
    local ref = drive(40)
    local est = disturbed(ref, 0.1)
    local path = { 0 }
    for i = 2, #ref do path[i] = path[i - 1] + p.distance(ref[i].centre, ref[i - 1].centre) end
    local translation, rotation, n = 0, 0, 0
    for _, length in ipairs { 30, 70 } do
      for i = 1, #ref, 3 do
        local j = i
        while path[j] and path[j] <= path[i] + length do j = j + 1 end
        if not path[j] then break end
        local est_turn, est_way = difference(est[i], est[j])
        local ref_turn, ref_way = difference(ref[i], ref[j])
        translation = translation + 100 * p.distance(est_way, ref_way) / length
        rotation = rotation + p.rotation_deg(p.from_to(est_turn, ref_turn)) / length
        n = n + 1
      end
    end
    local found = aib.pose.kitti_odometry(est, ref, { lengths = { 30, 70 }, step = 3 })
    t:equal(found.n, n)
    near(t, found.translation_percent, translation / n)
    near(t, found.rotation_deg_per_m, rotation / n)
    local twice = aib.pose.kitti_odometry(grown(est, 2), grown(ref, 2), { lengths = { 60, 140 }, step = 3 })
    near(t, twice.translation_percent, found.translation_percent)
    near(t, twice.rotation_deg_per_m, found.rotation_deg_per_m / 2)
    local a = aib.pose.sub_trajectories(est, ref, { lengths = { 50 } })[1]
    local b = aib.pose.sub_trajectories(grown(est, 2), grown(ref, 2), { lengths = { 100 } })[1]
    near(t, b.translation_percent.mean, a.translation_percent.mean)
    near(t, b.translation.max, 2 * a.translation.max)
    near(t, b.rotation_deg.mean, a.rotation_deg.mean)
    near(t, aib.pose.sub_trajectories(ref, ref)[1].translation.max, 0)
  end },

  ["pose: stamps are paired one to one, the closest first"] = { 300, function(t)
    local function stamped(n)
      local stamps, at = {}, 0
      for i = 1, n do
        at = at + random(0.001, 0.02)
        stamps[i] = at
      end
      local poses = list(n, function() return aib.math.pose { centre = vector(1) } end)
      return aib.pose.trajectory(poses, { stamps = stamps })
    end
    local est, ref = stamped(math.random(1, 12)), stamped(math.random(1, 12))
    local offset, candidates, used_est, used_ref, n = random(-0.02, 0.02), {}, {}, {}, 0
    for i, e in ipairs(est.stamps) do
      for j, r in ipairs(ref.stamps) do
        local gap = math.abs(e + offset - r)
        if gap <= 0.01 then candidates[#candidates + 1] = { gap, i, j } end
      end
    end
    table.sort(candidates, function(a, b) return a[1] < b[1] end)
    for _, c in ipairs(candidates) do
      if not used_est[c[2]] and not used_ref[c[3]] then
        used_est[c[2]], used_ref[c[3]], n = c[3], c[2], n + 1
      end
    end
    local options = { by = "stamp", max_gap = 0.01, offset = offset }
    if n == 0 then return t:raises("none of", aib.pose.associate, est, ref, options) end
    local a, b, info = aib.pose.associate(est, ref, options)
    t:equal({ info.n_matched, #a, #b, info.n_estimate_only, info.n_reference_only }, { n, n, n, #est - n, #ref - n })
    for k, i in ipairs(info.estimate_index) do t:equal(info.reference_index[k], used_est[i]) end
  end },

  ["pose: intrinsics differ by what their pixels do"] = { 200, function(t)
    local f, cx, cy = random(50, 150), random(40, 60), random(30, 50)
    local function camera(scale, more)
      return aib.math.camera {
        model = "PINHOLE", width = math.tointeger(100 * scale), height = math.tointeger(80 * scale),
        parameters = { f * scale * (1 + more), f * scale * (1 + more), cx * scale, cy * scale },
      }
    end
    local ref, share = camera(1, 0), random(-0.2, 0.2)
    local function error_of(est) return aib.pose.intrinsics_error({ a = est }, { a = ref }) end
    t:near(error_of(camera(2, 0)).reprojection_max_px, 0, 1e-9)
    local longer = error_of(camera(1, share))
    near(t, longer.focal_mre, math.abs(share))
    near(t, error_of(camera(2, share)).reprojection_px, longer.reprojection_px)
    local dx, dy = random(-3, 3), random(-3, 3)
    local beside = aib.math.camera {
      model = "PINHOLE", width = 100, height = 80, parameters = { f, f, cx + dx, cy + dy },
    }
    local d = aib.pose.reprojection_difference(beside, ref)
    near(t, d.mean, math.sqrt(dx * dx + dy * dy))
    near(t, d.max, d.mean)
    near(t, error_of(beside).principal_point_px, d.mean)
  end },

  ["pose: of several estimates any registers a frame"] = { 200, function(t)
    local n = math.random(2, 10)
    local names = list(n, function(i) return ("d/Image%02d.PNG"):format(i) end)
    local ref = aib.pose.trajectory(list(n, function() return aib.math.pose {} end), { names = names })
    local function some()
      local kept, has = {}, {}
      for i = 1, n do
        if math.random() < 0.4 then kept[#kept + 1], has[i] = i, true end
      end
      return kept, has
    end
    local first, has_first = some()
    local second, has_second = some()
    local either = 0
    for i = 1, n do either = either + ((has_first[i] or has_second[i]) and 1 or 0) end
    local found = aib.pose.registration_rate({ ref:select(first), ref:select(second) }, ref)
    t:equal({ found.n_registered, found.n_total, #found.missing }, { either, n, n - either })
    local other = aib.pose.trajectory(list(#first, function() return aib.math.pose {} end), {
      names = list(#first, function(k) return names[first[k]]:lower():gsub("^d/", ""):gsub("png$", "jpg") .. "" end),
    })
    local rules = { ignore_case = true, ignore_extension = true, ignore_folder = true }
    t:equal(aib.pose.registration_rate(other, ref, rules).n_registered, #first)
    t:equal(aib.pose.registration_rate(other, ref).n_registered, 0)
  end },

  ["align: each mode moves what it may, and follows a change of either frame"] = { 300, function(t)
    local ref = walk(math.random(4, 10))
    local est = disturbed(p.similarity() * ref, 0.1)
    local function fit(mode, more)
      local options = more or {}
      options.mode = mode
      return aib.align.trajectory(est, ref, options)
    end
    near(t, fit("se3").transform.scale, 1)
    local yaw = fit("yaw").transform
    near(t, yaw.scale, 1)
    near(t, yaw.rotation[3][3], 1)
    near(t, fit("scale").transform.angle_deg, 0)
    local first = fit("first").transform * est
    t:near(p.distance(first[1].centre, ref[1].centre), 0, 1e-9)
    t:near(p.rotation_deg((difference(first[1], ref[1]))), 0, 1e-6)
    local a = random(-3, 3)
    local level = aib.math.sim3 {
      scale = random(0.3, 3), translation = vector(3),
      rotation = { { math.cos(a), -math.sin(a), 0 }, { math.sin(a), math.cos(a), 0 }, { 0, 0, 1 } },
    }
    local turned = aib.align.trajectory(level * ref, ref, { mode = "yaw_scale" }).transform
    near(t, turned.scale * level.scale, 1)
    near(t, turned.rotation[3][3], 1)
    near(t, aib.pose.ape(turned * (level * ref), ref).max, 0)
    local sim3 = fit "sim3"
    near(t, sim3.rmse, aib.pose.ape(sim3.transform * est, ref).rmse)
    local se3 = fit("se3").rmse
    t:check(sim3.rmse <= se3 + 1e-9 and se3 <= aib.pose.ape(yaw * est, ref).rmse + 1e-9, "freer is nearer")
    local there, here = p.similarity(), p.similarity()
    local again = aib.align.umeyama(there * est, here * ref)
    local expected = here * sim3.transform * there:inverse()
    near(t, again.scale, expected.scale)
    for i = 1, 3 do near(t, (again * { 1, 2, 3 })[i], (expected * { 1, 2, 3 })[i]) end
  end },

  ["align: what lies far from the rest is left out, and what agrees is found"] = { 100, function(t)
    local ref = walk(12)
    local moved = p.similarity()
    local poses = list(12, function(i) return moved * ref[i] end)
    local lost = math.random(12)
    poses[lost] = aib.math.pose { rotation = p.rotation(), centre = { 1000, random(-9, 9), 0 } }
    local est = aib.pose.trajectory(poses)
    for _, options in ipairs { { outlier_factor = 20 }, { robust = true, robust_distance = 0.01 } } do
      local fit = aib.align.trajectory(est, ref, options)
      t:equal(fit.outliers, { lost })
      t:near(fit.rmse, 0, 1e-6)
      near(t, fit.transform.scale * moved.scale, 1)
    end
  end },

  ["align: icp brings back a cloud that was moved a little, by points and by planes"] = { 40, function(t)
    local points = list(400, function()
      local v = p.unit(vector(1))
      return { 3 * v[1], 2 * v[2], v[3] }
    end)
    local ref = aib.cloud.from_points(points)
    local moved = aib.math.sim3 { rotation = p.rotation(0.02), translation = vector(0.02) }
    local found = aib.align.icp(moved * ref, ref, { max_distance = 0.5 })
    t:near(aib.cloud.distances(found.transform * (moved * ref), ref):max(), 0, 1e-3)
    t:check(found.fitness > 0.99 and found.n_pairs == 400, "all pairs")
    local by_planes = aib.align.icp(moved * ref, aib.cloud.with_normals(ref, { neighbours = 8 }),
      { max_distance = 0.5, metric = "plane" })
    t:near(aib.cloud.distances(by_planes.transform * (moved * ref), ref):mean(), 0, 5e-3)
  end },
}
