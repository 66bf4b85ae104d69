-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What must hold of depth maps whatever they show: definitions written out anew, and how numbers change where maps are
--- scaled, mirrored, swapped, masked or divided.
local aib = require "aib"
local p = require "properties"

local near, coarse, list, random, mean = p.near, p.coarse, p.list, p.random, p.mean
local depth_rows, changed = p.depth_rows, p.changed

--- Pairs of the depths that are valid in both, in the precision that maps have.
local function valid_pairs(est, ref)
  local pairs = {}
  p.each_pixel(est, function(x, y, e)
    local r = ref:at(x, y)
    if e > 0 and r > 0 then pairs[#pairs + 1] = { e, r } end
  end)
  return pairs
end

local function made_up_labels(width, height, most)
  return list(height, function() return list(width, function() return math.random(0, most) end) end)
end

--- A camera, and its sight lines (x, y, 1) of each pixel.
local function camera_of(width, height)
  local fx, fy, cx, cy = random(5, 9), random(5, 9), random(2, 5), random(2, 5)
  local camera = aib.math.camera { model = "PINHOLE", width = width, height = height, parameters = { fx, fy, cx, cy } }
  return camera, function(x, y) return { (x - 0.5 - cx) / fx, (y - 0.5 - cy) / fy, 1 } end, (fx + fy) / 2
end

--- A smooth surface: neighbours are of one.
local function smooth_rows(width, height)
  local a, b = random(-0.02, 0.02), random(-0.02, 0.02)
  return list(height, function(y)
    return list(width, function(x) return 3 + a * x + b * y + random(0, 0.05) end)
  end)
end

--- Normals of a map, from the pixels left, right, above and below; nil where one is missing or on another surface.
local function normals_of(map, ray)
  local function point(x, y) return p.scaled(ray(x, y), map:at(x, y)) end
  return function(x, y)
    if x == 1 or y == 1 or x == map.width or y == map.height or map:at(x, y) <= 0 then return nil end
    for _, at in ipairs { { x - 1, y }, { x + 1, y }, { x, y - 1 }, { x, y + 1 } } do
      local here, there = map:at(x, y), map:at(at[1], at[2])
      if there <= 0 or math.max(here, there) > 1.05 * math.min(here, there) then return nil end
    end
    local n = p.cross(p.minus(point(x, y + 1), point(x, y - 1)), p.minus(point(x + 1, y), point(x - 1, y)))
    return p.unit(n)
  end
end

return p.suite {
  ["depth: errors are their definitions"] = { 1500, function(t)
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
  end },

  ["depth: what is aligned does not care for the scale, srmse never does"] = { 400, function(t)
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
  end },

  ["depth: frames add up, in any order and in parts"] = { 200, function(t)
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
  end },

  ["depth: the same map has no error of any kind"] = { 200, function(t)
    local camera = aib.math.camera { model = "PINHOLE", width = 8, height = 6, parameters = { 8, 8, 4, 3 } }
    local rows = list(6, function(y)
      return list(8, function(x) return 3 + 0.02 * x + 0.03 * y + random(0, 0.02) end)
    end)
    local map = aib.depth.map(rows)
    t:equal(aib.depth.surface_errors(map, map, camera).distance.max, 0)
    t:near(aib.depth.normal_errors(map, map, camera).mean_deg, 0, 1e-4)
    t:equal(aib.depth.errors(map, map).rmse, 0)
    local plane = aib.raster.labels(list(6, function() return list(8, function() return 1 end) end))
    local of_plane = aib.depth.plane_errors(map, map, camera, plane)[1]
    near(t, of_plane.flatness, of_plane.reference_flatness)
    t:near(of_plane.orientation_deg, 0, 1e-4)
    local est = aib.depth.map(changed(rows, function(d) return d * random(0.8, 1.2) end))
    local curve = aib.depth.risk_coverage(est, map, map)
    for i, risk in ipairs(curve.risk) do t:check(curve.oracle[i] <= risk + 1e-12, "the oracle's order is best") end
    t:check(curve.ause >= -1e-12, "ause")
    local off = aib.depth.surface_errors(est, map, camera, { tau = { 1, 2 } })
    t:check(off.within[1] <= off.within[2], "rises")
  end },

  ["raster: nearest neighbours make nothing up, masks count their labels"] = { 300, function(t)
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
  end },

  ["depth: limits, masks and clamps leave out what they say, ends exclusive"] = { 500, function(t)
    local width, height = math.random(2, 6), math.random(2, 6)
    local whole = function(d) return d > 0 and 0.25 * (4 * d // 1) or 0 end  -- values meet the limits exactly
    local est = aib.depth.map(changed(depth_rows(width, height), whole))
    local ref = aib.depth.map(changed(depth_rows(width, height), whole))
    local rows = made_up_labels(width, height, 2)
    local mask, low, high = aib.raster.labels(rows), random(0, 8) // 1, random(9, 20) // 1
    local clamp_min, clamp_max = random(0, 3) // 1 + 0.5, random(10, 19) // 1
    local pairs, n_ref = {}, 0
    p.each_pixel(ref, function(x, y, r)
      if rows[y][x] == 0 or r <= low or r >= high then return end
      n_ref = n_ref + 1
      local e = est:at(x, y)
      if e > 0 then pairs[#pairs + 1] = { math.max(clamp_min, math.min(clamp_max, e)), r } end
    end)
    if #pairs == 0 then return end
    local options = { mask = mask, min = low, max = high, clamp_min = clamp_min, clamp_max = clamp_max }
    local e = aib.depth.errors(est, ref, options)
    t:equal({ e.n_valid, e.n_reference }, { #pairs, n_ref })
    near(t, e.coverage, #pairs / n_ref)
    near(t, e.mae, mean(list(#pairs, function(i) return math.abs(pairs[i][1] - pairs[i][2]) end)))
    near(t, e.delta1, mean(list(#pairs, function(i)
      local a, b = pairs[i][1], pairs[i][2]
      return math.max(a, b) < 1.25 * math.min(a, b) and 1 or 0
    end)))
  end },

  ["depth: labels divide a frame, each as its mask alone"] = { 300, function(t)
    local width, height = math.random(2, 7), math.random(2, 6)
    local est, ref = aib.depth.map(depth_rows(width, height)), aib.depth.map(depth_rows(width, height))
    local labels = aib.raster.labels(made_up_labels(width, height, 3))
    if #valid_pairs(est, ref) == 0 then return end
    local e = aib.depth.errors(est, ref, { labels = labels })
    local n, sum = 0, 0
    for label, part in pairs(e.by_label) do
      n, sum = n + part.n_valid, sum + (part.mae or 0) * part.n_valid
      if part.n_valid > 0 then
        local alone = aib.depth.errors(est, ref, { mask = labels:mask(label) })
        near(t, part.srmse, alone.srmse)
        near(t, part.coverage, alone.coverage)
      end
    end
    t:equal(n, e.n_valid)
    near(t, sum / n, e.mae)
    local frames = aib.depth.accumulate():add(est, ref, { labels = labels, name = "a" })
    for _, label in ipairs(frames:labels()) do
      local part = e.by_label[label]
      if part.n_valid > 0 then near(t, frames:of_label(label):result().mae, part.mae) end
    end
  end },

  ["depth: a fit over many frames is that of all their pixels, and nothing near is better"] = { 300, function(t)
    local frames, e, r = {}, {}, {}
    for i = 1, math.random(1, 4) do
      frames[i] = { aib.depth.map(depth_rows(4, 3)), aib.depth.map(depth_rows(4, 3)) }
      for _, pair in ipairs(valid_pairs(frames[i][1], frames[i][2])) do
        e[#e + 1], r[#r + 1] = pair[1], pair[2]
      end
    end
    local function fitted(align)
      local all, rest = aib.depth.fit { align = align }, aib.depth.fit { align = align }
      for i, frame in ipairs(frames) do
        local part = i % 2 == 0 and rest or all
        part:add(frame[1], frame[2])
      end
      t:equal(all:merge(rest).n_valid, #e)
      return all:result()
    end
    local function cost(scale, shift, power)
      return mean(list(#e, function(i) return math.abs(scale * e[i] + shift - r[i]) ^ power end))
    end
    near(t, fitted("median").scale, p.median(r) / p.median(e))
    near(t, fitted("log").scale, math.exp(mean(list(#e, function(i) return math.log(r[i] / e[i]) end))))
    local s, a, l1 = fitted "scale", fitted "scale_shift", fitted "scale_l1"
    for _, off in ipairs { -0.01, 0.01 } do
      t:check(cost(s.scale, 0, 2) <= cost(s.scale + off, 0, 2) + 1e-9, "scale")
      t:check(cost(a.scale, a.shift, 2) <= cost(a.scale + off, a.shift, 2) + 1e-9, "scale of both")
      t:check(cost(a.scale, a.shift, 2) <= cost(a.scale, a.shift + off, 2) + 1e-9, "shift")
    end
    t:check(cost(l1.scale, 0, 1) <= 1.1 * cost(s.scale, 0, 1), "ten steps come near the least absolute differences")
  end },

  ["depth: intervals and worst frames are those of the frames' numbers"] = { 60, function(t)
    local frames = aib.depth.accumulate()
    local function map() return aib.depth.map(depth_rows(3, 3)) end
    for i = 1, 8 do frames:add(map(), map(), { name = "f" .. i }) end
    local values, options = {}, { block = 2, resamples = 50, seed = 3 }
    for i, frame in ipairs(frames:frames()) do values[i] = frame.mae end
    local interval = aib.stats.bootstrap(values, options)
    options.field = "mae"
    t:equal(frames:interval(options), interval)
    local worst = frames:frames { field = "mae" }
    for i = 2, #worst do t:check(worst[i].mae <= worst[i - 1].mae, "the worst first") end
  end },

  ["depth: distances at the surface are those along the ray, or from its plane"] = { 200, function(t)
    local width, height = math.random(3, 7), math.random(3, 6)
    local camera, ray, focal = camera_of(width, height)
    local ref = aib.depth.map(smooth_rows(width, height))
    local function holed(d) return math.random() < 0.1 and 0 or d end
    local est = aib.depth.map(changed(smooth_rows(width, height), holed))
    local normal, ways = normals_of(ref, ray), { ray = {}, normal = {} }
    local gsd, n_without, multiples = {}, 0, {}
    p.each_pixel(est, function(x, y, e)
      if e <= 0 then return end
      local off, direction, n = math.abs(e - ref:at(x, y)), ray(x, y), normal(x, y)
      n_without = n_without + (n and 0 or 1)
      gsd[#gsd + 1] = ref:at(x, y) / focal
      table.insert(ways.ray, off * p.norm(direction))
      table.insert(ways.normal, off * (n and math.abs(p.dot(n, direction)) or p.norm(direction)))
      multiples[#multiples + 1] = ways.normal[#gsd] / gsd[#gsd]
    end)
    if #gsd == 0 then return end
    local found = aib.depth.surface_errors(est, ref, camera, { tau = { 0.2, 0.5 } })
    coarse(t, found.distance.mean, mean(ways.normal))
    coarse(t, found.distance.median, p.median(ways.normal))
    coarse(t, found.gsd.max, math.max(table.unpack(multiples)))
    coarse(t, found.mean_gsd, mean(gsd))
    t:equal({ found.n_valid, found.n_without_normal }, { #gsd, n_without })
    near(t, found.within_total[0.5], found.within[0.5] * #gsd / (width * height))
    t:check(found.within[0.2] <= found.within[0.5], "rises")
    coarse(t, aib.depth.surface_errors(est, ref, camera, { distance = "ray" }).distance.max,
      math.max(table.unpack(ways.ray)))
    local grown = aib.depth.surface_errors(est:scaled(4), ref:scaled(4), camera, { tau = { 0.5 } })
    coarse(t, grown.distance.rmse, 4 * found.distance.rmse)
    t:near(grown.within[0.5], found.within[0.5], 1 / #gsd + 1e-9)
  end },

  ["depth: normals differ by the angles of cross products, whatever the scale"] = { 200, function(t)
    local width, height = math.random(3, 7), math.random(3, 6)
    local camera, ray = camera_of(width, height)
    local est, ref = aib.depth.map(smooth_rows(width, height)), aib.depth.map(smooth_rows(width, height))
    local of_est, of_ref, angles = normals_of(est, ray), normals_of(ref, ray), {}
    p.each_pixel(ref, function(x, y)
      if of_est(x, y) and of_ref(x, y) then angles[#angles + 1] = p.angle_deg(of_est(x, y), of_ref(x, y)) end
    end)
    local found = aib.depth.normal_errors(est, ref, camera, { tau = { 1, 5 } })
    t:near(found.mean_deg, mean(angles), 1e-3)
    t:near(found.median_deg, p.median(angles), 1e-3)
    t:check(found.below[1] <= found.below[5], "rises")
    t:equal(found.n_valid, #angles)
    t:near(aib.depth.normal_errors(est:scaled(2), ref, camera).rmse_deg, found.rmse_deg, 1e-3)
    t:near(aib.depth.normal_errors(ref, est, camera).mean_deg, found.mean_deg, 1e-3)
  end },

  ["depth: planes have no flatness, and lie as far apart as they do"] = { 200, function(t)
    local camera, ray = camera_of(7, 6)
    local function plane(normal, distance)
      return list(6, function(y) return list(7, function(x) return distance / p.dot(normal, ray(x, y)) end) end)
    end
    local n = p.unit { random(-0.2, 0.2), random(-0.2, 0.2), 1 }
    local m = p.unit { n[1] + random(-0.1, 0.1), n[2] + random(-0.1, 0.1), 1 }
    local ref, far = plane(n, 4), random(3.5, 5)
    local labels = aib.raster.labels(list(6, function() return list(7, function() return 3 end) end))
    local turned = aib.depth.plane_errors(aib.depth.map(plane(m, 4)), aib.depth.map(ref), camera, labels)[3]
    t:near(turned.orientation_deg, p.angle_deg(n, m), 1e-3)
    t:near(turned.flatness, 0, 1e-5)
    local moved = aib.depth.plane_errors(aib.depth.map(plane(n, far)), aib.depth.map(ref), camera, labels)[3]
    t:near(moved.offset, far - 4, 1e-4)
    t:near(moved.orientation_deg, 0, 1e-3)
    local tele = aib.math.camera { model = "PINHOLE", width = 40, height = 1, parameters = { 4000, 4000, 20, 0.5 } }
    local row = { list(40, function(x) return 10 / (1 + n[1] * (x - 20.5) / 4000) end) }
    local label = aib.raster.labels { list(40, function() return 1 end) }
    t:equal(aib.depth.plane_errors(aib.depth.map(row):scaled(1.1), aib.depth.map(row), tele, label), {}, "a row")
  end },

  ["depth: risk and coverage follow the order of the confidences alone"] = { 300, function(t)
    local width, height = math.random(2, 6), math.random(2, 6)
    local est, ref = aib.depth.map(depth_rows(width, height)), aib.depth.map(depth_rows(width, height))
    local order = p.shuffled(list(width * height, function(i) return i end))
    local sure = list(height, function(y) return list(width, function(x) return order[(y - 1) * width + x] end) end)
    local pixels = {}
    p.each_pixel(est, function(x, y, e)
      local r = ref:at(x, y)
      if e > 0 and r > 0 then pixels[#pixels + 1] = { sure = sure[y][x], error = math.abs(e - r) / r } end
    end)
    if #pixels == 0 then return end
    local function risks(before)
      table.sort(pixels, before)
      return list(5, function(k)
        local kept = math.max(1, k * #pixels // 5)
        return mean(list(kept, function(i) return pixels[i].error end))
      end)
    end
    local risk = risks(function(a, b) return a.sure > b.sure end)
    local oracle = risks(function(a, b) return a.error < b.error end)
    local curve = aib.depth.risk_coverage(est, ref, aib.depth.map(sure), { steps = 5 })
    for k = 1, 5 do
      near(t, curve.risk[k], risk[k])
      near(t, curve.oracle[k], oracle[k])
    end
    near(t, curve.aurc, mean(risk))
    near(t, curve.ause, (mean(risk) - mean(oracle)) / risk[5])
    local bent = aib.depth.map(changed(sure, function(s) return math.exp(s / 9) end))
    t:equal(aib.depth.risk_coverage(est, ref, bent, { steps = 5 }).risk, curve.risk)
    local errors = changed(p.rows_of(est), function(e, x, y)
      local r = ref:at(x, y)
      return e > 0 and r > 0 and -math.abs(e - r) / r or 0
    end)
    coarse(t, aib.depth.risk_coverage(est, ref, aib.depth.map(errors)).ause, 0)
  end },

  ["depth: strata are those of the mirror image and of the transpose"] = { 300, function(t)
    local width, height = math.random(1, 14), math.random(1, 14)
    local rows = changed(depth_rows(width, height, 3), function(d) return d > 10 and 12 or d > 5 and 4 or d end)
    local map = aib.depth.map(rows)
    local strata = aib.depth.strata(map)
    local mirrored, transposed = aib.depth.strata(aib.depth.map(p.mirrored(rows))),
      aib.depth.strata(aib.depth.map(p.transposed(rows)))
    local doubled, wider = aib.depth.strata(map:scaled(2)), aib.depth.strata(map, { edge_width = 4 })
    local n_edge, n_wider = 0, 0
    p.each_pixel(map, function(x, y, d)
      local s = strata:at(x, y)
      t:equal(s == 0, d <= 0)
      t:equal({ mirrored:at(width + 1 - x, y), transposed:at(y, x), doubled:at(x, y) }, { s, s, s })
      n_edge, n_wider = n_edge + (s > 1 and 1 or 0), n_wider + (wider:at(x, y) > 1 and 1 or 0)
    end)
    t:check(n_edge <= n_wider, "wider edges")
  end },

  ["depth: boundary F1 counts pairs of neighbours, either way round, at any scale"] = { 200, function(t)
    local width, height = math.random(1, 7), math.random(1, 6)
    local est, ref = aib.depth.map(depth_rows(width, height)), aib.depth.map(depth_rows(width, height))
    local function inverse(map, x, y) return 1 / math.max(map:at(x, y), 1e-6) end
    local total, weights = 0, 0
    for k = 0, 2 do
      local tau = 1.1 + 0.1 * k
      local recall, precision = 0, 0
      for _, way in ipairs { { 1, 0 }, { -1, 0 }, { 0, 1 }, { 0, -1 } } do
        local n_est, n_ref, both = 0, 0, 0
        p.each_pixel(ref, function(x, y)
          local u, v = x + way[1], y + way[2]
          if u < 1 or v < 1 or u > width or v > height then return end
          local e = inverse(est, x, y) / inverse(est, u, v) > tau
          local r = inverse(ref, x, y) / inverse(ref, u, v) > tau
          n_est, n_ref, both = n_est + (e and 1 or 0), n_ref + (r and 1 or 0), both + (e and r and 1 or 0)
        end)
        recall, precision = recall + both / math.max(n_ref, 1) / 4, precision + both / math.max(n_est, 1) / 4
      end
      total = total + tau * (recall + precision > 0 and 2 * recall * precision / (recall + precision) or 0)
      weights = weights + tau
    end
    local options = { t_min = 1.1, t_max = 1.3, n = 3 }
    local f1 = aib.depth.boundary_f1(est, ref, options)
    near(t, f1, total / weights)
    near(t, aib.depth.boundary_f1(ref, est, options), f1)
    near(t, aib.depth.boundary_f1(est:scaled(2), ref, options), f1)
  end },

  ["depth: boundary errors are distances of edges, cut at ten pixels"] = { 60, function(t)
    local function map()
      local at, near_side = math.random(6, 18), random(1, 3)
      return aib.depth.map(list(16, function(y)
        return list(24, function(x) return x + (y > 8 and 1 or 0) < at and near_side or 6 end)
      end))
    end
    local est, ref = map(), map()
    local found, edges = aib.depth.edges(est), aib.depth.edges(ref)
    local function places(image)
      local out = {}
      p.each_pixel(image, function(x, y, label) out[#out + 1] = label ~= 0 and { x, y, 0 } or nil end)
      return out
    end
    local a, b = places(found), places(edges)
    if #a == 0 or #b == 0 then return end
    local function cut(from, to)
      return list(#from, function(i) return math.min(10, (p.nearest(from[i], to))) end)
    end
    local of_est, of_ref, close = cut(a, b), cut(b, a), {}
    for _, d in ipairs(of_est) do close[#close + 1] = d < 10 and d or nil end
    local e = aib.depth.boundary_errors(est, edges)
    t:equal({ e.n_estimate, e.n_reference }, { #a, #b })
    near(t, e.accuracy, #close > 0 and mean(close) or 10)
    near(t, e.completeness, #close > 0 and (mean(of_est) * #a + mean(of_ref) * #b) / (#a + #b) or 10)
    near(t, aib.depth.boundary_errors(ref, edges).completeness, 0)
    near(t, aib.depth.boundary_errors(est:scaled(2), edges).accuracy, e.accuracy)
  end },

  ["raster: the nearest neighbour is the pixel that the rule tells"] = { 300, function(t)
    local width, height, w, h = math.random(1, 9), math.random(1, 9), math.random(1, 9), math.random(1, 9)
    local map = aib.depth.map(depth_rows(width, height))
    local centre = aib.depth.downsample(map, w, h)
    local floor = aib.depth.downsample(map, w, h, { rule = "floor" })
    p.each_pixel(centre, function(x, y, d)
      t:equal(d, map:at((2 * x - 1) * width // (2 * w) + 1, (2 * y - 1) * height // (2 * h) + 1))
      t:equal(floor:at(x, y), map:at((x - 1) * width // w + 1, (y - 1) * height // h + 1))
    end)
  end },
}
