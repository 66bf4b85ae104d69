-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Makes a scene and its flight:
---
---   aib-lua examples/dataset/plan.lua SCENE SCALE FOLDER
---
--- FOLDER gets mesh.ply (a label each triangle), transforms.json, poses/ (COLMAP), poses.tum, waypoints for a drone and
--- plan.json: what was planned and what ray casting at the mesh says of it.
local aib = require "aib"
local flights = require "flights"

local waypoint_origin <const> = { 0, 0, 0 }  -- the scenes lie nowhere

local function usage()
  io.stderr:write "usage: plan.lua office|crane|bridge tiny|small|paper FOLDER\n"
  os.exit(2)
end

--- Shares by number, as JSON has them: by text.
local function by_text(shares)
  local list = {}
  for number, share in pairs(shares) do list[tostring(number)] = share end
  return list
end

--- What the flight sees of the asset; behind it the ground goes on.
local function measured(plan, mesh, labels)
  local report = aib.survey.measure(plan.trajectory, plan.camera, mesh, { labels = labels })
  return { overlap = report.overlap, gsd_mm = report.gsd_mm, hit_share = report.hit_share,
    off_normal = report.off_normal, coverage = by_text(report.coverage), incidence = by_text(report.incidence),
    area = report.area, unseen_area = report.unseen_area }
end

local function planned(plan)
  local kept = {}
  for _, name in ipairs { "n_frames", "step", "overlap", "overlap_across", "length", "duration", "gsd_mm", "n_pushed",
    "largest_push", "min_distance", "n_gimbal_limited", "gimbal_delay" } do kept[name] = plan[name] end
  return kept
end

local name, scale, folder = table.unpack(arg)
local known = { office = true, crane = true, bridge = true }
if not (folder and known[name] and flights.sizes[scale]) then usage() end

local scene = require("scenes." .. name)
aib.system.make_folder(folder)
scene.build():save(folder .. "/mesh.ply")
local mesh = aib.io.read_mesh(folder .. "/mesh.ply")
local plan = flights.plan(scene, scale, mesh)
local trajectory = plan.trajectory
aib.io.write_trajectory(folder .. "/transforms.json", trajectory, { cameras = plan.cameras })
aib.io.write_trajectory(folder .. "/poses", trajectory, { cameras = plan.cameras, encoding = "text" })
aib.io.write_trajectory(folder .. "/poses.tum", trajectory)
for _, kind in ipairs { "csv", "kml", "plan" } do
  aib.io.write_waypoints(folder .. "/waypoints." .. kind, trajectory, { origin = waypoint_origin })
end
local facts = { scene = name, scale = scale, crop = scene.crop, planned = planned(plan),
  measured = measured(plan, mesh, scene.labels) }
aib.system.write_text(folder .. "/plan.json", aib.json.encode(facts) .. "\n")
print(("%s, %s: %d frames of %d x %d, %.1f m, overlap %.1f %% planned, %.1f %% measured (median)"):format(name, scale,
  plan.n_frames, plan.camera.width, plan.camera.height, plan.length, 100 * plan.overlap,
  100 * facts.measured.overlap.median))
