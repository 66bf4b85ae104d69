-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What exporters of DA3, VGGT, pi3, CUT3R and MonST3R left, batch by batch, gives the numbers that numpy, scipy and
--- evo gave: transforms, position errors, AUC, focal lengths, depth and clouds.
local aib = require "aib"
local support = require "support"

local shared <const> = support.shared .. "/scenes"
local sets <const> = {
  "da3/crane", "da3/office", "da3/office_native", "da3_gtposes/crane", "vggt/crane", "vggt/office",
  "vggt/office_native", "pi3/crane", "pi3/office", "pi3/office_native", "cut3r/office", "monst3r/office",
}

local reference, truths = nil, {}

local function expected_of(set)
  local path = shared .. "/batched/reference_e2e.json"
  reference = reference or aib.json.decode(aib.system.read_text(path), path)
  local method, scene = set:match "([^/]+)/(.+)"
  return reference[method][scene]
end

local function truth_of(scene)
  if not truths[scene] then
    local folder = ("%s/gt/%s"):format(shared, scene)
    local path = folder .. "/transforms.json"
    truths[scene] = {
      trajectory = aib.io.read_trajectory(path), cameras = {}, depth = {}, folder = folder,
      points = aib.io.read_cloud(folder .. "/gt_points.ply"),
    }
    for name, camera in pairs(aib.io.read_cameras(path)) do truths[scene].cameras[name:match "[^/]*$"] = camera end
  end
  return truths[scene]
end

local fits = {}

--- The method, the truth and the alignment of a set, kept.
local function open(set)
  if fits[set] then return fits[set] end
  local expected = expected_of(set)
  local method = aib.method.open(("%s/batched/methods/%s"):format(shared, set))
  local truth = truth_of(expected.scene)
  fits[set] = {
    name = set, method = method, truth = truth, expected = expected,
    fit = aib.batches.align(method.batches, truth.trajectory, {
      outlier_factor = 3, given = set:find "gtposes" ~= nil, names = { ignore_folder = true },
    }),
  }
  return fits[set]
end

--- Runs a case for every set.
local function each(t, f)
  if not aib.system.is_file(shared .. "/batched/reference_e2e.json") then
    t:skip "the shared folder is not here"
  end
  for _, set in ipairs(sets) do f(open(set), set) end
end

local function is_given(value) return value ~= nil and value ~= aib.json.null end

local function near(t, found, expected, relative, what)
  t:near(found, expected, relative * math.abs(expected), what)
end

--- Two pairs may cross one threshold.
local function near_auc(t, found, expected, what)
  t:near(found.auc, expected.auc30_paper_min_signed, 2 / (30 * expected.n_pairs) + 1e-12, what)
  t:equal(found.n_pairs, expected.n_pairs, what .. " pairs")
  for tau, share in pairs(found.rra and expected.rra or {}) do
    local slack = 2 / expected.n_pairs + 1e-12
    t:near(found.rra[tonumber(tau)], share, slack, what .. " rra " .. tau)
    t:near(found.rta[tonumber(tau)], expected.rta_signed[tau], slack, what .. " rta " .. tau)
  end
end

--- Compares a transform. The nearer the positions are to a line, the more the rounding of the files turns it.
local function near_pose(t, found, expected, what)
  local tolerance = math.max(1e-6, 1e-7 / expected.cov_ratio[1])
  for i = 1, 3 do
    for k = 1, 3 do t:near(found.rotation[i][k], expected.sim3_est_to_gt.R[i][k], tolerance, what .. " rotation") end
    t:near(found.translation[i], expected.sim3_est_to_gt.t[i], 20 * tolerance, what .. " translation")
  end
end

--- The frames of a fit as they stand in the files: the recorded pairs i < j are of that order, ours of the truth's.
local function in_file_order(case, frames)
  local place, n, order = {}, 0, {}
  for _, batch in ipairs(case.method.batches) do
    for _, name in ipairs(batch.names) do
      n = n + 1
      place[name] = n
    end
  end
  for i = 1, #frames.est do order[i] = i end
  local function place_of(i) return place[frames.ref.names[i]:match "[^/]*$"] end
  table.sort(order, function(a, b) return place_of(a) < place_of(b) end)
  local batch = {}
  for i, k in ipairs(order) do batch[i] = frames.batch[k] end
  return { est = frames.est:select(order), ref = frames.ref:select(order), batch = batch, kept = {} }
end

local cuts <const> = {
  ["0.1"] = { min_confidence = 0.1 }, ["0.75"] = { min_confidence = 0.75 }, ["1.5"] = { min_confidence = 1.5 },
  percentile40_per_batch = { min_confidence = 0.4, rule = "percentile" },
}

--- Compares the cloud of a confidence rule; one rule a set is enough to go through everything, all take too long.
local function compare_cloud(t, case, rule, expected, offset)
  local cut = cuts[rule]
  local what = ("%s %s"):format(case.name, rule)
  t:check(cut, what .. " is not known")
  local points, info = aib.batches.cloud(case.fit, {
    min_confidence = cut.min_confidence, rule = cut.rule, stride = 2, pixel_offset = offset,
  })
  t:equal(#points, expected.n_points, what .. " points")
  t:equal(info.n_valid - info.n_unsure, #points, what .. " counts")
  local c = aib.cloud.compare(points, case.truth.points, { tau = { 0.05, 0.1 } })
  near(t, c.accuracy, expected.accuracy, 1e-5, what .. " accuracy")
  near(t, c.completeness, expected.completeness, 1e-5, what .. " completeness")
  near(t, c.chamfer, expected.chamfer_sum, 1e-5, what .. " chamfer")
  near(t, c.f1_distance, expected.f1_distance, 1e-5, what .. " f1_distance")
  near(t, c.accuracy_median, expected.accuracy_median, 1e-4, what .. " accuracy_median")
  near(t, c.completeness_median, expected.completeness_median, 1e-4, what .. " completeness_median")
  if not expected.thresholds then return end
  for tau, shares in pairs(expected.thresholds) do
    -- A point or two may lie on either side of the threshold after rounding to floats.
    t:near(c.precision[tonumber(tau)], shares.precision, 3 / expected.n_points, what .. " precision " .. tau)
    t:near(c.recall[tonumber(tau)], shares.recall, 3 / 60000, what .. " recall " .. tau)
  end
end

--- A benchmark over what exporters left, beside links to it; its records by "scene/method/batch/metric".
local function protocol_records()
  local folder <close> = support.scratch_folder()
  support.link(shared .. "/gt", folder.path .. "/gt")
  support.link(shared .. "/batched/methods", folder.path .. "/methods")
  local scenes, methods = {}, {}
  for _, scene in ipairs { "crane", "office" } do
    local poses = aib.json.decode(aib.system.read_text(("%s/gt/%s/transforms.json"):format(shared, scene)))
    for _, frame in ipairs(poses.frames) do frame.file_path = frame.file_path:match "[^/]*$" end
    aib.system.write_text(("%s/%s.json"):format(folder.path, scene), aib.json.encode(poses))
    scenes[#scenes + 1] = ([[{ name = "%s", poses = "%s.json", depth = "gt/%s/depth/{stem}.exr",
      points = "gt/%s/gt_points.ply" }]]):format(scene, scene, scene, scene)
  end
  for _, method in ipairs { "da3", "da3_gtposes", "vggt", "pi3", "cut3r" } do
    local results = {}
    for _, scene in ipairs { "crane", "office" } do
      if aib.system.is_folder(("%s/batched/methods/%s/%s"):format(shared, method, scene)) then
        results[#results + 1] = ([[{ scene = "%s", output = "methods/%s/%s" }]]):format(scene, method, scene)
      end
    end
    methods[#methods + 1] = ([[{ name = "%s", parameters = "estimated", results = { %s } }]]):format(method,
      table.concat(results, ", "))
  end
  methods[#methods + 1] = [[{ name = "da3 percentile", parameters = "estimated", results = {
    { scene = "crane", output = "methods/da3/crane", confidence = 0.4, confidence_rule = "percentile" } } }]]
  aib.system.write_text(folder.path .. "/benchmark.lua", ("return { scenes = { %s }, methods = { %s } }"):format(
    table.concat(scenes, ", "), table.concat(methods, ", ")))
  local found = {}
  local report = support.protocol("asset_inspection"):run { benchmark = folder.path, tau = { 0.05, 0.1 } }
  for _, r in ipairs(report:records()) do
    found[table.concat({ r.group.scene, r.group.method, r.group.batch or "", r.name }, "/")] = r
  end
  return found, table.concat(report:note_lines(), "\n")
end

return aib.test {
  ["the protocol gives the recorded numbers of whole methods"] = function(t)
    if not aib.system.is_file(shared .. "/batched/reference_e2e.json") then t:skip "the shared folder is not here" end
    local found, notes = protocol_records()
    local function value(set, name)
      local method, scene = set:match "([^/]+)/(.+)"
      local record = found[("%s/%s//%s"):format(scene, method, name)]
      return record and record.value
    end
    for _, set in ipairs { "da3/crane", "da3/office", "vggt/office", "pi3/crane", "pi3/office", "cut3r/office" } do
      local expected = expected_of(set)
      near(t, value(set, "depth.srmse"), expected.depth.centre.mean_sq, 1e-6, set)
      near(t, value(set, "depth.coverage"), expected.depth.centre.mean_coverage, 1e-9, set)
      near(t, value(set, "cloud.chamfer"), expected.cloud["0.75"].chamfer_sum, 1e-5, set)
      near(t, value(set, "cloud.f1_distance"), expected.cloud["0.75"].f1_distance, 1e-5, set)
      near(t, value(set, "pose.ape_rmse"), expected.ate_pooled.rmse_all, 2e-6, set)
      near_auc(t, { auc = value(set, "pose.auc30"), n_pairs = expected.pose_all_pairs.n_pairs },
        expected.pose_all_pairs, set)
    end
    local percentile = expected_of("da3/crane").cloud.percentile40_per_batch
    near(t, value("da3 percentile/crane", "cloud.chamfer"), percentile.chamfer_sum, 1e-5)
    t:equal(found["crane/da3 percentile//cloud.accuracy"].n, percentile.n_points)
    t:equal(value("da3_gtposes/crane", "pose.auc30"), nil)
    t:contains(notes, "its poses are the true ones, though the parameters are called estimated")
    near(t, value("da3_gtposes/crane", "depth.srmse"), expected_of("da3_gtposes/crane").depth.centre.mean_sq, 1e-6)
    t:contains(notes, "office / pi3 / batch_000: no alignment to the truth")
    t:contains(notes, "office / pi3 / batch_005: no alignment to the truth")
    near(t, found["crane/da3/batch_001/align.scale"].value,
      expected_of("da3/crane").batches[2].sim3_est_to_gt.scale, 1e-6)
  end,

  ["methods are told from what they left"] = function(t)
    local kinds = { da3 = "da3", da3_gtposes = "da3", vggt = "vggt", pi3 = "pi3", cut3r = "cut3r", monst3r = "dust3r" }
    each(t, function(case, set) t:equal(case.method.kind, kinds[set:match "[^/]+"], set) end)
  end,

  ["batches have the recorded transforms, outliers and degenerate ones"] = function(t)
    each(t, function(case, set)
      t:equal(#case.fit.parts, #case.expected.batches, set)
      for i, expected in ipairs(case.expected.batches) do
        local part, what = case.fit.parts[i], set .. " " .. expected.batch
        t:equal(#part.est, expected.n, what)
        t:equal(part.alignment ~= nil, expected.aligned ~= false, what .. " aligned")
        if not expected.aligned then
          if not part.alignment then t:check(#part.degenerate > 20, what .. " says why") end
        elseif not part.alignment.is_given then
          local removed = {}
          for k, place in ipairs(part.alignment.outliers) do removed[k] = case.fit.est.names[place]:match "[^/]*$" end
          table.sort(removed)
          t:equal(table.concat(removed, " "), table.concat(expected.removed, " "), what .. " removed")
          near(t, part.alignment.transform.scale, expected.sim3_est_to_gt.scale, 1e-6, what .. " scale")
          near_pose(t, part.alignment.transform, expected, what)
          near(t, part.alignment.rmse, expected.ate.rmse_kept, 1e-5, what .. " rmse")
        end
      end
    end)
  end,

  ["the nearly straight batches say so"] = function(t)
    each(t, function(case, set)
      for i, expected in ipairs(case.expected.batches) do
        local part = case.fit.parts[i]
        if part.alignment and not part.alignment.is_given and expected.cov_ratio[1] < 1e-4 then
          t:check(#part.alignment.warnings > 0, ("%s %s warns"):format(set, expected.batch))
        end
      end
    end)
  end,

  ["position errors are the recorded ones"] = function(t)
    each(t, function(case, set)
      local expected, found = case.expected.ate_pooled, aib.batches.ape(case.fit)
      t:equal(found ~= nil, is_given(expected), set)
      if not found then return end
      t:near(found.all.rmse, expected.rmse_all, 1e-6 * expected.rmse_all + 2e-6, set .. " all")
      t:equal(found.all.count, expected.n_all, set)
      t:near(found.kept.rmse, expected.rmse_kept, 1e-6 * expected.rmse_kept + 2e-6, set .. " kept")
    end)
  end,

  ["AUC within batches, across them and over all pairs are the recorded ones"] = function(t)
    each(t, function(case, set)
      local expected, fit = case.expected, in_file_order(case, case.fit)
      fit.moved = in_file_order(case, case.fit.moved)
      local found = aib.batches.auc(fit)
      if is_given(expected.pose_intra_pooled) then
        near_auc(t, found.intra, expected.pose_intra_pooled, set .. " intra")
      end
      for k, of_batch in ipairs(expected.batches) do
        local places = {}
        for i, place in ipairs(fit.batch) do
          if place == k then places[#places + 1] = i end
        end
        if #places > 1 then
          near_auc(t, aib.pose.auc(fit.est:select(places), fit.ref:select(places)), of_batch.pose_intra,
            ("%s %s"):format(set, of_batch.batch))
        end
      end
      if is_given(expected.pose_cross_pooled) then
        near_auc(t, found.cross, expected.pose_cross_pooled, set .. " cross")
      end
      if is_given(expected.pose_all_pairs) then
        near_auc(t, found.all, expected.pose_all_pairs, set .. " all")
      end
    end)
  end,

  ["registration and focal lengths are the recorded ones"] = function(t)
    each(t, function(case, set)
      t:equal(#case.fit.est, case.expected.registration.registered, set)
      local cameras = aib.batches.cameras(case.method.batches)
      local expected = case.expected.focal_mre_mean_fx_fy
      t:equal(cameras ~= nil, is_given(expected), set)
      for k, batch in ipairs(case.method.batches) do
        local of_batch = case.expected.batches[k].focal_mre_mean_fx_fy
        if batch.cameras and is_given(of_batch) then
          near(t, aib.pose.focal_error(batch.cameras, case.truth.cameras).mre, of_batch, 1e-6, set .. " " .. batch.name)
        end
      end
      if cameras then
        near(t, aib.pose.focal_error(cameras, case.truth.cameras, { over = "views" }).mre, expected, 1e-6, set)
      end
    end)
  end,

  ["depth errors are the recorded ones, frame by frame, for both rules"] = function(t)
    each(t, function(case, set)
      for _, rule in ipairs { "centre", "floor" } do
        local sum, n = 0, 0
        for k, batch in ipairs(case.method.batches) do
          local before = sum
          for i, name in ipairs(batch.names) do
            local est <close> = batch.depth(i)
            local stem = name:match "^(.*)%."
            local ref <close> = aib.io.read_depth(("%s/depth/%s.exr"):format(case.truth.folder, stem),
              { width = est.width, height = est.height, rule = rule })
            local found, expected = aib.depth.errors(est, ref), case.expected.depth_per_frame[name][rule]
            local what = ("%s %s %s"):format(set, name, rule)
            near(t, found.srmse, expected[1], 1e-6, what)
            t:equal(found.n_valid, expected[4], what)
            t:equal(found.n_reference, expected[5], what)
            sum, n = sum + found.srmse, n + 1
          end
          near(t, (sum - before) / #batch.names, case.expected.batches[k].depth[rule].mean_sq, 1e-6, set)
        end
        near(t, sum / n, case.expected.depth[rule].mean_sq, 1e-6, set)
      end
    end)
  end,

  ["clouds are the recorded ones for every rule of confidence"] = function(t)
    each(t, function(case)
      for rule, expected in pairs(case.expected.cloud or {}) do compare_cloud(t, case, rule, expected, 0.5) end
      for rule, expected in pairs(case.expected.cloud_pixel_offset_0 or {}) do
        compare_cloud(t, case, rule, expected, 0)
      end
    end)
  end,

  ["poses that were given are told from estimated ones"] = function(t)
    each(t, function(case, set)
      local est = case.method.batches[1].trajectory
      local poses = {}
      for i = 1, #est do poses[i] = est[i] end
      local names = {}
      for i, name in ipairs(est.names) do names[i] = "images/" .. name end
      est = aib.pose.trajectory(poses, { names = names })
      t:equal(aib.method.poses_are_given(est, case.truth.trajectory), set:find "gtposes" ~= nil, set)
    end)
  end,

  ["batches of COLMAP models with missing frames and outliers are the recorded ones"] = function(t)
    local golden = support.shared .. "/golden/e2e/"
    if not aib.system.is_file(golden .. "expected_batches.json") then t:skip "the shared folder is not here" end
    local expected = aib.json.decode(aib.system.read_text(golden .. "expected_batches.json")).expected
    local batches = {}
    for i = 1, #expected.batches do
      batches[i] = aib.method.open(("%sbatches_est_%d"):format(golden, i - 1)).batches[1]
    end
    local truth = aib.io.read_trajectory(golden .. "batches_gt")
    local fit = aib.batches.align(batches, truth, { outlier_factor = 3 })
    for i, of_batch in ipairs(expected.batches) do
      local part, what = fit.parts[i], "batch " .. i
      t:equal(#part.est, of_batch.registered, what)
      t:equal(part.alignment.n_inliers, of_batch.registered - #of_batch.removed, what)
      near(t, part.alignment.transform.scale, of_batch.sim3_after_removal.s, 1e-8, what)
      near(t, part.alignment.rmse, of_batch.ate_rmse_kept, 1e-7, what)
      local auc = aib.pose.auc(part.est, part.ref)
      t:near(auc.auc, of_batch.auc_within_batch_all_registered.PAPER_AUC30_mean, 1e-12, what)
    end
    local kept = fit.moved
    t:equal(#kept.kept, expected.overall.kept_after_outlier_removal)
    local auc = aib.pose.auc(kept.est:select(kept.kept), kept.ref:select(kept.kept))
    t:near(auc.auc, expected.overall.auc_all_batches_aligned_kept.PAPER_AUC30_mean, 1e-12)
    t:equal(auc.n_pairs, expected.overall.auc_all_batches_aligned_kept.pairs)
    local registration = aib.pose.registration_rate(fit.est, truth)
    near(t, registration.rate, expected.overall.registration_rate, 1e-15)
  end,
}
