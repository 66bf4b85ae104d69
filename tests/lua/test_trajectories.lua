-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- aib.pose and aib.align from scripts, and the protocols upon them, on a ring of cameras whose errors are known.
local aib = require "aib"

local here = arg[0]:match("^(.*)/[^/]*$") or "."
local scratch = os.tmpname()

--- Cameras on a ring, one a second; `move(i, {x, y, z})` changes their centres.
local function ring(n, move)
  local poses, names, stamps = {}, {}, {}
  for i = 1, n do
    local a = 2 * math.pi * i / n
    local centre = { 100 * math.cos(a), 100 * math.sin(a), math.sin(3 * a) }
    if move then centre = move(i, centre) end
    local c, s = math.cos(a), math.sin(a)
    poses[i] = aib.math.pose { centre = centre, rotation = { { c, -s, 0 }, { s, c, 0 }, { 0, 0, 1 } } }
    names[i], stamps[i] = ("%03d.png"):format(i), i
  end
  return aib.pose.trajectory(poses, { names = names, stamps = stamps })
end

local function shifted(_, p) return { p[1] + 3, p[2] + 4, p[3] } end

--- The records of a protocol, by name.
local function run(name, inputs)
  local protocol = dofile(("%s/../../examples/protocols/%s.lua"):format(here, name))
  local reference, estimate = scratch .. ".ref.txt", scratch .. ".est.txt"
  aib.io.write_trajectory(reference, ring(60), { format = "tum" })
  aib.io.write_trajectory(estimate, ring(60, shifted), { format = "tum" })
  inputs.estimate, inputs.reference = { estimate, estimate }, reference
  local report = protocol:run(inputs)
  os.remove(reference)
  os.remove(estimate)
  local values = {}
  for _, record in ipairs(report:records()) do values[record.name] = record.value end
  return values, report
end

return aib.test {
  ["a trajectory is paired, aligned and scored"] = function(t)
    local transform = aib.math.sim3 { scale = 2, translation = { 1, 2, 3 } }
    local ref = ring(30)
    local est, ref2, info = aib.pose.associate(transform:inverse() * ref, ref)
    t:equal(info.n_matched, 30)
    local fit = aib.align.trajectory(est, ref2)
    t:near(fit.transform.scale, 2, 1e-12)
    t:near(aib.pose.ape(fit.transform * est, ref2).rmse, 0, 1e-10)
    t:near(aib.align.umeyama(est, ref2).scale, 2, 1e-12)
    t:near((transform * { 1, 1, 1 })[3], 5, 1e-12)
    t:near((transform * transform:inverse()).scale, 1, 1e-15)
    local auc = aib.pose.auc(est, ref2, { convention = "vggt" })
    t:equal({ auc.auc, auc.auc_signed, auc.n_pairs, auc.convention }, { 1.0, 1.0, 435, "vggt" })
    t:equal(aib.pose.relative_angles(est, ref2, { tau = { 5 } }).rra[5], 1.0)
    t:near(aib.pose.rpe(est, ref2, { relation = "angle_deg" }).max, 0, 1e-6)
  end,

  ["frames that are missing are named"] = function(t)
    local r = aib.pose.registration_rate(ring(4):select { 1, 3 }, ring(4))
    t:equal({ r.rate, r.missing }, { 0.5, { "002.png", "004.png" } })
  end,

  ["sub-models: the largest, each, and all together"] = function(t)
    local submodels = require "aib.submodels"
    local truth = ring(6)
    local models = { { trajectory = truth:select { 1, 2 } }, { trajectory = truth:select { 2, 3, 4 } } }
    local r = submodels.registration(models, truth)
    t:equal({ r.largest.rate, r.each[1].n_registered, r.merged.n_registered }, { 0.5, 2, 4 })
    t:equal(r.merged.missing, { "005.png", "006.png" })
  end,

  ["the joint histogram holds every pair"] = function(t)
    local ref = ring(10)
    local h = aib.pose.pair_histogram(ref, ref, { rotation = { 5, 10 }, translation = { 1 } })
    t:equal(h.counts, { { 45, 0 }, { 0, 0 }, { 0, 0 } })
    t:equal({ h.n_pairs, h.without_direction }, { 45, { 0, 0, 0 } })
  end,

  ["batches are fitted one by one"] = function(t)
    local ref = ring(30)
    local batches, moved = aib.align.batches(ring(30, shifted), ref, { size = 10, mode = "se3" })
    t:equal(#batches, 3)
    t:equal({ batches[3].first, batches[3].last }, { 21, 30 })
    t:near(aib.pose.ape(moved, ref).rmse, 0, 1e-10)
    t:near(batches[2].seam, 0, 1e-10)
    t:near(batches[2].half_rmse, 0, 1e-10)
  end,

  ["batches are lists of frames or of names"] = function(t)
    local ref, est = ring(30), ring(30, shifted)
    local frames = { { 20, 21, 22, 23 }, { 1, 5, 9, 13 } }
    local batches, moved = aib.align.batches(est, ref, { frames = frames, mode = "se3" })
    t:equal({ batches[1].first, batches[2].last, batches[2].frames }, { 20, 13, { 1, 5, 9, 13 } })
    t:near(aib.pose.ape(moved, ref).rmse, 0, 1e-10)
    t:equal(aib.pose.ape(moved, ref).count, 8)
    local named = aib.align.batches(est, ref, { names = { { "001.png", "007.png", "013.png", "x.png" } } })
    t:equal({ named[1].frames, named[1].missing }, { { 1, 7, 13 }, { "x.png" } })
    t:raises("comes twice", aib.align.batches, est, ref, { frames = { { 1, 2 }, { 2 } } })
    t:raises("from 1 on", aib.align.batches, est, ref, { frames = { { 0 } } })
  end,

  ["a turn about the vertical with scale"] = function(t)
    local ref = ring(30)
    local c, s = math.cos(0.4), math.sin(0.4)
    local turn = aib.math.sim3 { scale = 2, rotation = { { c, -s, 0 }, { s, c, 0 }, { 0, 0, 1 } } }
    local fit = aib.align.trajectory(turn:inverse() * ref, ref, { mode = "yaw_scale" })
    t:near(fit.transform.scale, 2, 1e-12)
    t:near(fit.half_rmse, 0, 1e-10)
  end,

  ["the AUC is broken down by batch and by gap, the worst pairs are named"] = function(t)
    local ref, batch = ring(10), { 1, 1, 1, 1, 1, 2, 2, 2, 2, 2 }
    local parts = aib.pose.auc_by_batch(ref, ref, batch)
    t:equal({ parts.intra.n_pairs, parts.cross.n_pairs, parts.cross.auc }, { 20, 25, 1.0 })
    local gaps = aib.pose.auc_by_gap(ref, ref, { { 1, 1 }, { 2, 9 } })
    t:equal({ gaps[1].n_pairs, gaps[2].n_pairs }, { 9, 36 })
    t:equal(#aib.pose.worst_pairs(ref, ref, { n = 4 }), 4)
  end,

  ["intrinsics are compared"] = function(t)
    local function camera(f)
      return aib.math.camera { model = "PINHOLE", width = 640, height = 480, parameters = { f, f, 320, 240 } }
    end
    local est, ref = { a = camera(505) }, { a = camera(500) }
    t:near(aib.pose.focal_error(est, ref).mre, 0.01, 1e-12)
    t:near(aib.pose.focal_error(est, 500).mre, 0.01, 1e-12)
    t:near(aib.pose.focal_error(est, ref).each.a, 0.01, 1e-12)
    t:near(aib.pose.intrinsics_error(est, ref).principal_point_px, 0, 1e-12)
    local pixel = aib.math.project(ref.a, aib.math.unproject(ref.a, { 12.5, 34.5 }))
    t:near(pixel[1], 12.5, 1e-9)
  end,

  ["what is wrong is said"] = function(t)
    t:raises("associate them first", aib.pose.auc, ring(3), ring(4))
    t:raises("did you mean 'max_deg'", aib.pose.auc, ring(3), ring(3), { maxdeg = 3 })
    local line = { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } }
    t:raises("on a line", aib.align.umeyama, line, line)
  end,

  ["trajectory: absolute and relative errors of several estimates"] = function(t)
    local values, report = run("trajectory", {})
    t:near(values["ape.rmse"], 5, 1e-9)
    t:near(values["rpe.max"], 0, 1e-9)
    t:equal(#report:grids(), 3)
    t:near(run("trajectory", { align = "se3" })["ape.max"], 0, 1e-9)
  end,

  ["trajectory: estimates whose names have no folder, one that fits nothing, axes of another kind"] = function(t)
    local protocol = dofile(here .. "/../../examples/protocols/trajectory.lua")
    local camera = aib.math.camera { width = 64, height = 48, parameters = { 50, 50, 32, 24 } }
    local function model(trajectory)
      local folder, cameras = os.tmpname(), {}
      os.remove(folder)
      for _, name in ipairs(trajectory.names) do cameras[name] = camera end
      aib.io.write_trajectory(folder, trajectory, { cameras = cameras })
      return folder
    end
    local function renamed(trajectory, change)
      local poses, names = {}, {}
      for i, name in ipairs(trajectory.names) do poses[i], names[i] = trajectory[i], change(name) end
      return aib.pose.trajectory(poses, { names = names })
    end
    local estimate = model(ring(20, shifted))
    local other = model(renamed(ring(20), function(name) return "x" .. name end))
    local reference = model(renamed(ring(20), function(name) return "images/" .. name end))
    local report = protocol:run { estimate = { estimate, other }, reference = reference, by = "name" }
    local values = {}
    for _, record in ipairs(report:records()) do
      values[record.name] = values[record.name] or {}
      table.insert(values[record.name], record.value)
    end
    t:near(values["ape.rmse"][1], 5, 1e-9)
    t:equal(#values["ape.rmse"], 1)
    t:equal({ values.n_matched, values.registration_rate }, { { 20, 0 }, { 1.0, 0.0 } })
    for _, folder in ipairs { estimate, other, reference } do os.execute("rm -r '" .. folder .. "'") end
  end,

  ["pose_auc: missing frames count in colmap's convention"] = function(t)
    local protocol = dofile(here .. "/../../examples/protocols/pose_auc.lua")
    local estimate, reference = scratch .. ".e.json", scratch .. ".r.json"
    local camera = aib.math.camera { width = 64, height = 48, parameters = { 50, 50, 32, 24 } }
    local cameras = {}
    for _, name in ipairs(ring(10).names) do cameras[name] = camera end
    aib.io.write_trajectory(estimate, ring(10):select { 1, 2, 3, 4, 5, 6 }, { cameras = cameras })
    aib.io.write_trajectory(reference, ring(10), { cameras = cameras })
    local report = protocol:run { estimate = { estimate }, reference = reference, convention = { "colmap", "paper" } }
    for _, record in ipairs(report:records()) do
      if record.name == "auc.colmap" then t:near(record.value, 30 / 90, 1e-6) end
      if record.name == "auc.paper" then t:equal(record.value, 1.0) end
      if record.name == "registration_rate" then t:equal(record.value, 0.6) end
    end
    os.remove(estimate)
    os.remove(reference)
  end,

  ["tum_rgbd: rigid alignment first"] = function(t)
    local values = run("tum_rgbd", { delta = 10 })
    t:near(values["tum.ate_rmse"], 0, 1e-9)
    t:near(values["tum.rpe_rotation_rmse"], 0, 1e-5)
  end,

  ["kitti_odometry: segments by their length"] = function(t)
    local values = run("kitti_odometry", {})
    t:near(values["kitti.translation"], 0, 1e-9)
    t:near(values["kitti.rotation_100"], 0, 1e-9)
  end,

  ["pose_auc: a number for each convention"] = function(t)
    local values = run("pose_auc", { convention = { "paper", "colmap", "exact" } })
    t:equal({ values["auc.paper"], values["rra.5"] }, { 1.0, 1.0 })
    t:near(values["auc.colmap"], 1, 1e-6)
    t:near(values["auc.exact"], 1, 1e-6)
  end,
}
