-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Ground truth of a planned scene by ray casting:
---
---   aib-lua examples/dataset/truth.lua FOLDER [POINTS]
---
--- FOLDER (of plan.lua) gets depth/*.exr, labels/*.png and points.ply: of POINTS (default 2000000) samples of the mesh
--- those that lie in the crop and that two frames see. What no frame sees cannot be reconstructed and is not counted.
local aib = require "aib"

local min_views <const> = 2

local folder, n = arg[1], math.tointeger(tonumber(arg[2] or 2000000))
if not folder or not n then
  io.stderr:write "usage: truth.lua FOLDER [POINTS]\n"
  os.exit(2)
end

local mesh = aib.io.read_mesh(folder .. "/mesh.ply")
local trajectory = aib.io.read_trajectory(folder .. "/transforms.json")
local cameras = aib.io.read_cameras(folder .. "/transforms.json")
local facts = aib.json.decode(aib.system.read_text(folder .. "/plan.json"), folder .. "/plan.json")
local scene = aib.render.scene(mesh)

local written = aib.render.frames(scene, trajectory, cameras, { folder = folder, maps = { "depth", "labels" },
  existing = "keep" })
local samples = aib.cloud.crop(aib.sample.mesh(mesh, { n = n }), facts.crop)
local seen = {}
for k, views in ipairs(aib.render.visible(scene, samples, trajectory, cameras)) do
  if views >= min_views then seen[#seen + 1] = samples[k] end
end
aib.io.write_cloud(folder .. "/points.ply", aib.mesh.with_labels(aib.cloud.from_points(seen), mesh))
print(("%s: %d frames, %d of %d points in %d views or more"):format(folder, written.n_frames + written.n_kept, #seen,
  #samples, min_views))
