-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Prints what every metric that uses threads gives for seeded data, to the last bit, and numbers read from and written
--- to text. tests/hostile/variants.py runs it with several numbers of threads and under a locale with decimal commas.
---   aib-lua numbers.lua FOLDER [LOCALE]
local aib = require "aib"

local folder <const>, locale <const> = arg[1], arg[2]
if locale then assert(os.setlocale(locale), "no locale " .. locale) end
math.randomseed(11)

local function normal() return math.sqrt(-2 * math.log(1 - math.random())) * math.cos(2 * math.pi * math.random()) end

--- Prints every number in a result, by its path.
local function show(name, value)
  if math.type(value) == "float" then
    print(("%s %a"):format(name, value))
  elseif type(value) == "table" then
    local keys = {}
    for key in pairs(value) do keys[#keys + 1] = key end
    table.sort(keys, function(a, b) return tostring(a) < tostring(b) end)
    for _, key in ipairs(keys) do show(name .. "." .. tostring(key), value[key]) end
  else
    print(name, value)
  end
end

local function sheet(n, noise, z)
  local points = {}
  for i = 1, n do
    local x, y = 10 * math.random(), 10 * math.random()
    points[i] = { x, y, (z or 0) + math.sin(x) + noise * normal() }
  end
  return aib.cloud.from_points(points)
end

local function turned(angle)
  local c, s = math.cos(angle), math.sin(angle)
  return { { c, -s, 0 }, { s, c, 0 }, { 0, 0, 1 } }
end

local function walk(n, noise)
  local poses = {}
  for i = 1, n do
    local a = i / 17 + noise * normal()
    poses[i] = aib.math.pose {
      rotation = turned(a), centre = { 5 * math.cos(a), 5 * math.sin(a) + noise * normal(), i / 40 + noise * normal() },
    }
  end
  return aib.pose.trajectory(poses)
end

local function map(noise)
  local rows = {}
  for y = 1, 120 do
    rows[y] = {}
    for x = 1, 160 do rows[y][x] = (x * y) % 31 == 0 and 0 or 3 + math.sin(x / 20) + y / 80 + noise * math.random() end
  end
  return aib.depth.map(rows)
end

-- Clouds and meshes
local est, ref = sheet(30000, 0.02), sheet(25000, 0)
show("compare", aib.cloud.compare(est, ref, { tau = { 0.01, 0.05 }, max_distance = 0.2 }))
local with_normals = aib.cloud.with_normals(ref, { neighbours = 12 })
show("normals", aib.cloud.normal_consistency(aib.cloud.with_normals(est, { neighbours = 12 }), with_normals))
show("offsets", aib.cloud.offsets(est, with_normals):summary())
show("kept", #aib.cloud.without_statistical_outliers(est, { neighbours = 8 }))
show("near", #aib.cloud.without_radius_outliers(est, { radius = 0.1, neighbours = 3 }))
show("eth3d", aib.cloud.eth3d(est, { { points = ref, scanner = { 5, 5, 30 } } }, { tolerances = { 0.02, 0.1 } }))
show("icp", aib.align.icp(est, ref, { max_distance = 0.3, max_iterations = 5 }).transform:matrix())
show("voxels", aib.sample.voxel(est, { size = 0.3 }):summary())
show("thin", aib.sample.thin(est, { spacing = 0.2 }):summary())
local tetrahedron <const> = "v 0 0 0\nv 1.5 0 0\nv 0 1.25 0\nv 0 0 1e0\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
aib.system.write_text(folder .. "/m.obj", tetrahedron)
local mesh = aib.io.read_mesh(folder .. "/m.obj")
local samples = aib.sample.mesh(mesh, { n = 20000, seed = 3 })
show("samples", samples:summary())
show("mesh", aib.mesh.compare(est, mesh, { samples = samples, tau = 0.5 }))
show("mesh offsets", aib.mesh.offsets(est, mesh):summary())
show("faces", aib.mesh.face_scores(est, mesh, { samples = samples, tau = 0.5 }))
aib.system.write_text(folder .. "/l.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
  .. "property float y\nproperty float z\nelement face 2\nproperty list uchar int vertex_indices\n"
  .. "property int label\nend_header\n"
  .. "0 0 0\n10 0 0\n10 10 0\n0 10 0\n3 0 1 2 4\n3 0 2 3 7\n")
local wall = aib.io.read_mesh(folder .. "/l.ply")
local on_wall = aib.sample.mesh(wall, { n = 9000 })
show("labels of a mesh", aib.mesh.compare_by_label(est, wall, { samples = on_wall, tau = 0.5 }))
show("labels of a cloud", aib.cloud.compare_by_label(est, on_wall, { tau = 0.5 }))
show("labelled", aib.mesh.with_labels(est, wall):summary())
show("grid", aib.sample.voxel_grid({ size = 0.4 }):add(est):add(ref):cloud():summary())
show("both ways", aib.cloud.curve(select(1, aib.cloud.distances_both_ways(est, ref)), aib.cloud.distances(ref, est), {
  max = 0.5, steps = 20,
}))
show("even", aib.sample.mesh(mesh, { n = 300, method = "poisson" }):summary())
local est_path, ref_path = folder .. "/e.ply", folder .. "/r.ply"
aib.io.write_cloud(est_path, est)
aib.io.write_cloud(ref_path, ref)
show("stream", aib.stream.compare_clouds(est_path, ref_path, { tau = 0.05, memory = "20MB" }))

-- Poses
local e, r = walk(150, 0.01), walk(150, 0)
for _, convention in ipairs { "paper", "vggt", "posediffusion", "posediffusion_torch", "da3", "colmap", "exact" } do
  show("auc " .. convention, aib.pose.auc(e, r, { convention = convention, position_accuracy = 0.01 }))
end
show("angles", aib.pose.relative_angles(e, r, { tau = { 0.5, 5 } }))
show("pairs", aib.pose.pair_histogram(e, r, { rotation = { 1, 5 }, translation = { 1, 5 } }).counts)
show("gaps", aib.pose.auc_by_gap(e, r, { { 1, 10 }, { 11, 100 } }))
show("worst", aib.pose.worst_pairs(e, r, { n = 40 }))
local halves = {}
for i = 1, #r do halves[i] = i <= 75 and 1 or 2 end
show("batches", aib.pose.auc_by_batch(e, r, halves))
show("ape", aib.pose.ape(aib.align.trajectory(e, r, { robust = true }).transform * e, r).rmse)
show("rpe", aib.pose.rpe(e, r).rmse)
show("bootstrap", aib.stats.bootstrap(aib.pose.ape(e, r).errors, { resamples = 200 }))

-- Depth
local estimate, truth = map(0.1), map(0)
local camera = aib.math.camera {
  model = "SIMPLE_RADIAL", width = 160, height = 120, parameters = { 100.5, 80, 60, 0.01 },
}
for _, align in ipairs { "none", "median", "scale", "scale_l1", "scale_shift", "log" } do
  show("depth " .. align, aib.depth.errors(estimate, truth, { align = align }))
end
show("surface", aib.depth.surface_errors(estimate, truth, camera))
show("normal errors", aib.depth.normal_errors(estimate, truth, camera))
show("boundary", aib.depth.boundary_f1(estimate, truth))
show("strata", aib.depth.strata(truth):summary())
show("risk", aib.depth.risk_coverage(estimate, truth, truth).aurc)
show("points", aib.sample.unproject(estimate, camera, e[7]):summary())

-- Rays
local views, names = {}, {}
for i = 1, 4 do
  local down <const> = { { 1, 0, 0 }, { 0, -1, 0 }, { 0, 0, -1 } }
  views[i], names[i] = aib.math.pose { rotation = down, centre = { 2 * i, 5, 6 } }, ("v%d.png"):format(i)
end
local flight = aib.pose.trajectory(views, { names = names })
local scene = aib.render.scene(wall)
local seen = aib.render.frame(scene, camera, views[2])
show("rendered", { seen.depth:summary(), seen.range:summary(), seen.labels:summary(), seen.n_hit })
show("files", aib.render.frames(scene, flight, camera, { folder = folder, maps = { "depth", "labels" } }).n_frames)
show("read again", aib.io.read_depth(folder .. "/depth/v3.exr"):summary())
local n_views = 0
for _, n in ipairs(aib.render.visible(scene, est, flight, camera)) do n_views = n_views + n end
show("visible", n_views)
local free = aib.render.free_space(scene, est, flight, camera)
show("free", { free.n_surface, free.n_free, free.n_hidden })
local measured = aib.survey.measure(flight, camera, scene, { samples = 3000 })
show("measured", { measured.overlap, measured.gsd_mm, measured.coverage, measured.incidence, measured.hit_share })
show("noise", aib.survey.sensor_noise(aib.depth.error_image(estimate, truth), { seed = 5 }):summary())

local frames = {}
for i = 1, 12 do
  local name = ("%s/%02d."):format(folder, i)
  frames[i] = { name = "f" .. i, estimate = name .. "pfm", reference = name .. "exr" }
  aib.io.write_depth(frames[i].estimate, map(i / 10))
  aib.io.write_depth(frames[i].reference, truth)
end
local frame_errors = aib.depth.evaluate(frames, { align = "median", align_over = "sequence" })
show("frames", frame_errors:result())
show("pooled", frame_errors:result { pooled = true })

-- Numbers as text
local function text(name, content)
  aib.system.write_text(folder .. "/" .. name, content)
  return folder .. "/" .. name
end
local line <const> = "1.5 0.25 -1e-3 2.5 0 0 0.6 0.8\n"
show("tum", aib.io.read_trajectory(text("a.txt", line), { format = "tum" })[1]:matrix())
show("xyz", aib.io.read_cloud(text("a.xyz", "1.5 2.25 3.125\n4 5e-1 6\n")):summary())
show("ply", aib.io.read_cloud(text("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
  .. "property float y\nproperty float z\nend_header\n1.5 2.5 3.5\n"))[1])
show("json", aib.json.decode "[1.5, 2e-3]")
aib.io.write_trajectory(folder .. "/out.txt", e)
show("written", aib.system.sha256(aib.system.read_text(folder .. "/out.txt")))
show("encoded", aib.json.encode { 1.5, 1e-7, 0.1 })
show("printed", ("%s %.3f %g %s"):format(tostring(0.5), 1.25, 1e-5, tostring(aib.math.sim3 { scale = 1.5 })))
show("parsed", tonumber "1.5")

-- Reports
local report = require("aib.report").new { name = "r", title = "R", version = aib.version }
report:add("rmse", 1234.5678, { unit = "m", better = "lower", n = 10, group = { scene = "a" } })
report:add("share", 0.875, { better = "higher", group = { scene = "a" } })
for _, format in ipairs { "json", "csv", "markdown", "latex", "html" } do
  print(require("aib.report." .. format)(report))
end
