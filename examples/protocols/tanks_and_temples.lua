-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The evaluation of Tanks and Temples: trajectory alignment, three ICP rounds with scale, crop, voxels of tau / 2,
--- then precision, recall and F-score at tau, and their curves up to 5 tau.
---
---   aib-lua tanks_and_temples truck.ply Truck.ply --scene truck --crop Truck.json --trajectory truck.log \
---     --reference_trajectory Truck_COLMAP_SfM.log --reference_transform Truck_trans.txt --errors_to out
---
--- The official RANSAC is not seeded; this one is (--seed). Where precision and recall are 0 the official script
--- divides by zero; here the F-score is 0.
local aib = require "aib"
local clouds = require "aib.evaluation.clouds"
local drawings = require "aib.evaluation.drawings"
local failure = require "aib.failure"
local suggest = require "aib.suggest"

--- Thresholds of the scenes, metres.
local scenes <const> = {
  barn = 0.01, caterpillar = 0.005, church = 0.025, courthouse = 0.025, ignatius = 0.003, meetingroom = 0.01,
  truck = 0.005,
}

--- The similarity of a file of four rows.
local function read_transform(path)
  local m = {}
  for number in aib.system.read_text(path):gmatch("%S+") do m[#m + 1] = tonumber(number) end
  if #m ~= 16 then failure.raise("format", ("%s: 16 numbers expected, found %d"):format(path, #m)) end
  local scale = (m[1] ^ 2 + m[5] ^ 2 + m[9] ^ 2) ^ 0.5
  local function row(i) return { m[i] / scale, m[i + 1] / scale, m[i + 2] / scale } end
  return aib.math.sim3 { scale = scale, rotation = { row(1), row(5), row(9) }, translation = { m[4], m[8], m[12] } }
end

--- ref_from_est of the trajectories; nothing is moved where there are none.
local function from_trajectories(input, report)
  if input.trajectory == "" then return aib.math.sim3() end
  if input.reference_trajectory == "" then failure.usage("--reference-trajectory expected beside --trajectory") end
  local est = aib.io.read_trajectory(input.trajectory)
  local ref = aib.io.read_trajectory(input.reference_trajectory)
  if input.reference_transform ~= "" then ref = read_transform(input.reference_transform) * ref end
  local paired, reference = aib.pose.associate(est, ref, { by = "index" })
  local fit = aib.align.trajectory(paired, reference, {
    robust = true, robust_distance = input.robust_distance, seed = input.seed,
  })
  report:add("align.trajectory_rmse", fit.rmse, { unit = "m", better = "lower", n = fit.n_inliers })
  return fit.transform
end

--- At most n points, every k-th.
local function thinned(cloud, n)
  return #cloud <= n and cloud or aib.cloud.random_subset(cloud, n)
end

--- The three rounds: voxels of tau, of tau / 2, then all points (at most `max_points`), ever nearer pairs.
local function refined(estimate, reference, transform, tau, crop, input, report)
  local rounds = {
    { voxel = tau, distance = 80 * tau }, { voxel = tau / 2, distance = 20 * tau }, { distance = 2 * tau },
  }
  for i, round in ipairs(rounds) do
    local function prepared(cloud)
      cloud = crop(cloud)
      if round.voxel then return aib.sample.voxel(cloud, { size = round.voxel, anchor = "open3d" }) end
      return thinned(cloud, input.max_points)
    end
    local icp = aib.align.icp(prepared(transform * estimate), prepared(reference), {
      max_distance = round.distance, with_scale = true, max_iterations = 20, relative_change = 1e-6,
    })
    transform = icp.transform * transform
    report:add(("align.icp%d_fitness"):format(i), icp.fitness, { better = "higher", n = icp.n_pairs })
    report:add(("align.icp%d_rmse"):format(i), icp.rmse, { unit = "m", better = "lower", n = icp.n_pairs })
  end
  return transform
end

local function write_errors(folder, estimate, reference, to_reference, to_estimate, tau)
  aib.system.make_folder(folder)
  clouds.write_colored(folder .. "/precision.ply", estimate, to_reference, 3 * tau)
  clouds.write_colored(folder .. "/recall.ply", reference, to_estimate, 3 * tau)
  clouds.write_curve(folder .. "/curve.csv", to_reference, to_estimate, 5 * tau, 500)
end

--- The crop volume of a JSON file; nil without one.
local function read_volume(path)
  if path == "" then return nil end
  local volume = aib.json.decode(aib.system.read_text(path), path)
  local ok, mistake = pcall(aib.cloud.crop, aib.cloud.from_points {}, volume)
  if not ok then failure.raise("format", ("%s: %s"):format(path, failure.message(mistake))) end
  return volume
end

local names <const> = suggest.keys(scenes)
names[#names + 1] = "other"
table.sort(names)

return aib.protocol {
  name = "tanks_and_temples",
  title = "Tanks and Temples",
  cite = "Knapitsch et al., Tanks and Temples, SIGGRAPH 2017",
  inputs = {
    estimate = { kind = "file", position = 1, help = "reconstructed cloud" },
    reference = { kind = "file", position = 2, help = "cloud of the truth" },
    scene = { kind = "choice", choices = names, default = "other", help = "sets tau" },
    tau = { kind = "number", unit = "m", default = 0, min = 0, help = "threshold; 0: the scene's" },
    crop = { kind = "path", default = "", help = "crop volume (.json); without, nothing is cropped" },
    trajectory = { kind = "path", default = "", help = "of the reconstruction (.log); without, it is aligned already" },
    reference_trajectory = { kind = "path", default = "", help = "(.log)" },
    reference_transform = { kind = "path", default = "", help = "from it to the truth (.txt, four rows)" },
    robust_distance = { kind = "number", unit = "m", default = 0.2, min = 0, help = "of cameras that agree" },
    icp = { kind = "choice", choices = { "official", "none" }, default = "official", help = "three rounds, or none" },
    voxel = { kind = "number", unit = "m", default = -1, help = "thins both clouds; 0: not, below 0: tau / 2" },
    max_points = { kind = "integer", default = 4000000, min = 1, help = "of the last round" },
    seed = { kind = "integer", default = 1, min = 0, help = "of the alignment" },
    errors_to = { kind = "path", default = "", help = "writes coloured clouds and the curves there" },
  },
  run = function(input, report)
    local tau = input.tau > 0 and input.tau or scenes[input.scene]
    if not tau then failure.usage("--scene or --tau expected") end
    local volume = read_volume(input.crop)
    local function crop(cloud) return volume and aib.cloud.crop(cloud, volume) or cloud end
    local estimate, reference = clouds.read(input.estimate), clouds.read(input.reference)
    local transform = from_trajectories(input, report)
    if input.icp == "official" then
      transform = refined(estimate, reference, transform, tau, crop, input, report)
    end
    local voxel = input.voxel < 0 and tau / 2 or input.voxel
    local function prepared(cloud)
      cloud = crop(cloud)
      return voxel > 0 and aib.sample.voxel(cloud, { size = voxel, anchor = "open3d" }) or cloud
    end
    estimate, reference = prepared(transform * estimate), prepared(reference)
    local to_reference, to_estimate = aib.cloud.distances_both_ways(estimate, reference)
    local c = aib.cloud.score(to_reference, to_estimate, { tau = tau })
    drawings.points(report, estimate, { reference = reference }, to_reference, to_estimate, { tau })
    local options = { tau = tau, voxel = voxel, icp = input.icp }
    for _, name in ipairs { "precision", "recall", "f_score" } do
      report:add("tnt." .. name, c[name][tau], { better = "higher", n = c.n_estimate, options = options })
    end
    if input.errors_to ~= "" then
      write_errors(input.errors_to, estimate, reference, to_reference, to_estimate, tau)
    end
  end,
}
