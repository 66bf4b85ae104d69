-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The protocols of clouds: the numbers of the official tools on the same files, and small cases with known answers.
local aib = require "aib"
local support = require "support"

local golden <const> = support.shared .. "/golden/cloud/"

--- Value of each record by name.
local function values(name, inputs)
  local found = {}
  for _, r in ipairs(support.protocol(name):run(inputs):records()) do found[r.name] = r.value end
  return found
end

--- Calls check(case, estimate, reference, expected) for each golden case.
local function each_case(t, check)
  if not support.has_shared() then return t:skip("the shared folder is not here") end
  local n = 0
  for _, file in ipairs(aib.system.names_in(golden)) do
    local case = file:match("^expected_(.*)%.json$")
    if case then
      local content = aib.json.decode(aib.system.read_text(golden .. file), file)
      local inputs = content.inputs
      local folder = support.shared .. "/golden/"
      check(case, folder .. inputs.est, folder .. inputs.gt, content.expected)
      n = n + 1
    end
  end
  t:check(n >= 8, "cases are missing")
end

local function near(t, found, expected, what) t:near(found, expected, 1e-5 * math.abs(expected) + 1e-9, what) end

--- A file with some points on a line.
local function write_line(folder, name, ...)
  local points = {}
  for i, x in ipairs { ... } do points[i] = { x, 0, 0 } end
  aib.io.write_cloud(folder .. "/" .. name, aib.cloud.from_points(points))
  return folder .. "/" .. name
end

return aib.test {
  ["reconstruction: CUT3R's accuracy and completion, Open3D's Chamfer distance"] = function(t)
    each_case(t, function(case, estimate, reference, expected)
      local found = values("reconstruction", { estimate = estimate, reference = reference })
      near(t, found["cloud.accuracy"], expected.cut3r.acc_mean, case)
      near(t, found["cloud.accuracy_median"], expected.cut3r.acc_median, case)
      near(t, found["cloud.completeness"], expected.cut3r.comp_mean, case)
      near(t, found["cloud.completeness_median"], expected.cut3r.comp_median, case)
      near(t, found["cloud.chamfer"], expected.chamfer_paper_sum, case)
      near(t, found["cloud.hausdorff"], expected.hausdorff, case)
    end)
  end,

  ["reconstruction: against a mesh, with an ICP and normals"] = function(t)
    if not support.has_shared() then return t:skip("the shared folder is not here") end
    local mesh = support.shared .. "/golden/mesh/knot.ply"
    local scratch <close> = support.scratch_folder()
    local points = aib.sample.mesh(aib.io.read_mesh(mesh), { n = 5000, seed = 3 })
    local moved = aib.math.sim3 { translation = { 0.5, 0, 0 } } * points
    aib.io.write_cloud(scratch.path .. "/moved.ply", moved)
    local found = values("reconstruction", { estimate = scratch.path .. "/moved.ply", reference = mesh, icp = 5,
      normals = true, samples = 20000, tau = { 0.5 } })
    t:check(found["align.fitness"] == 1, "the whole estimate has pairs")
    t:check(found["cloud.accuracy"] < 0.2, "the ICP brings it back")
    t:check(found["cloud.normal_consistency_estimate_mean"] > 0.98, "normals agree")
    t:check(found["cloud.recall@0.5m"] < found["cloud.precision@0.5m"], "recall has the floor of the samples")
  end,

  ["reconstruction: on disk as in memory; errors are drawn, labels scored"] = function(t)
    local scratch <close> = support.scratch_folder()
    local mesh = scratch.path .. "/mesh.ply"
    aib.system.write_text(mesh, [[
ply
format ascii 1.0
comment labels: 1=left 2=right
element vertex 6
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
property uint label
end_header
0 0 0
1 0 0
0 1 0
5 0 0
6 0 0
5 1 0
3 0 1 2 1
3 3 4 5 2
]])
    local points = aib.sample.mesh(aib.io.read_mesh(mesh), { n = 500 })
    local est, ref = scratch.path .. "/est.ply", scratch.path .. "/ref.ply"
    aib.io.write_cloud(ref, points)
    aib.io.write_cloud(est, aib.math.sim3 { translation = { 0, 0, 0.25 } } * points)
    local memory = values("reconstruction", { estimate = est, reference = ref, tau = { 0.3 } })
    t:equal(values("reconstruction", { estimate = est, reference = ref, tau = { 0.3 }, memory = "20MB" }), memory)
    local found = {}
    local report = support.protocol("reconstruction"):run {
      estimate = est, reference = mesh, tau = { 0.3 }, samples = 900, labels = true, errors_to = scratch.path .. "/out",
    }
    for _, r in ipairs(report:records()) do found[(r.group and r.group.label or "all") .. " " .. r.name] = r.value end
    t:equal(found["all cloud.accuracy"], 0.25)
    t:equal(found["left cloud.accuracy"], 0.25)
    t:equal(found["right cloud.precision@0.3m"], 1)
    for _, name in ipairs { "accuracy", "completeness" } do
      t:check(aib.io.read_cloud(("%s/out/%s.ply"):format(scratch.path, name)).has_colors, name)
    end
    t:equal(aib.io.read_mesh(scratch.path .. "/out/faces.ply").n_triangles, 2)
    local curve = aib.system.read_text(scratch.path .. "/out/curve.csv")
    t:check(curve:find("\n0.9,1,1,1\n", 1, true), "the curve ends at 1")
  end,

  ["da3_bench: its own scores, thinned and not"] = function(t)
    each_case(t, function(case, estimate, reference, expected)
      local function check(scores, inputs)
        inputs.estimate, inputs.reference = estimate, reference
        local found = values("da3_bench", inputs)
        -- A point on a voxel's border or at the threshold falls to either side: means are floats here.
        local flips = inputs.voxel == 0 and 0 or case:find("utm") and 1e-2 or 1e-3
        for name, key in pairs { accuracy = "acc", completeness = "comp", overall = "overall", precision = "precision",
          recall = "recall", f_score = "fscore" } do
          local is_share = key ~= "acc" and key ~= "comp" and key ~= "overall"
          local relative = is_share and 1e-9 or math.max(flips, 1e-5)
          t:near(found["da3." .. name], scores[key], (is_share and flips or 0) + relative * scores[key] + 1e-9,
            case .. " " .. name)
        end
      end
      for tau, at in pairs(expected.at_tau) do
        if type(at.da3) == "table" then check(at.da3, { threshold = tonumber(tau), voxel = 0 }) end
      end
      for voxel, at in pairs(expected.voxel_down_sample_open3d) do
        check(at.da3, { threshold = at.da3_threshold, voxel = tonumber(voxel) })
      end
    end)
  end,

  ["tanks_and_temples: precision, recall and F-score are its script's"] = function(t)
    each_case(t, function(case, estimate, reference, expected)
      for tau, at in pairs(expected.at_tau) do
        local found = values("tanks_and_temples", { estimate = estimate, reference = reference, tau = tonumber(tau),
          voxel = 0, icp = "none" })
        local scores = type(at.tanks_and_temples) == "table" and at.tanks_and_temples
          or { precision = 0, recall = 0, fscore = 0 }  -- the script divides by zero
        t:equal(found["tnt.precision"], scores.precision, case)
        t:equal(found["tnt.recall"], scores.recall, case)
        near(t, found["tnt.f_score"], scores.fscore, case)
      end
    end)
  end,

  ["tanks_and_temples: trajectories and three rounds find a moved and scaled cloud, errors are written"] = function(t)
    if not support.has_shared() then return t:skip("the shared folder is not here") end
    local scratch <close> = support.scratch_folder()
    local truth = aib.io.read_cloud(golden .. "bunny_moved_gt.ply")
    local est_from_ref = aib.math.sim3 { scale = 2, rotation = { { 0, -1, 0 }, { 1, 0, 0 }, { 0, 0, 1 } },
      translation = { 3, 2, 1 } }
    aib.io.write_cloud(scratch.path .. "/est.ply", est_from_ref * truth)
    local function write_log(name, transform, noise)
      local lines = {}
      for i = 0, 9 do
        local p = transform * { math.sin(i), math.cos(2 * i), 0.1 * i }
        local r = transform.rotation
        lines[#lines + 1] = ("%d %d 0"):format(i, i)
        for k = 1, 3 do
          local at = p[k] + noise * math.cos(7 * i + k)
          lines[#lines + 1] = ("%.9g %.9g %.9g %.9g"):format(r[k][1], r[k][2], r[k][3], at)
        end
        lines[#lines + 1] = "0 0 0 1"
      end
      aib.system.write_text(scratch.path .. "/" .. name, table.concat(lines, "\n") .. "\n")
    end
    write_log("est.log", est_from_ref, 0.004)
    write_log("ref.log", aib.math.sim3(), 0)
    aib.system.write_text(scratch.path .. "/trans.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
    aib.system.write_text(scratch.path .. "/crop.json", [==[{ "axis_max": 1, "axis_min": -1, "orthogonal_axis": "Z",
      "bounding_polygon": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]] }]==])
    local found = values("tanks_and_temples", {
      estimate = scratch.path .. "/est.ply", reference = golden .. "bunny_moved_gt.ply", tau = 0.001,
      crop = scratch.path .. "/crop.json", trajectory = scratch.path .. "/est.log",
      reference_trajectory = scratch.path .. "/ref.log", reference_transform = scratch.path .. "/trans.txt",
      errors_to = scratch.path .. "/out",
    })
    t:check(found["tnt.f_score"] > 0.99, "the rounds bring it back")
    t:check(found["align.icp3_rmse"] < 1e-4, "the last round is exact")
    t:check(aib.io.read_cloud(scratch.path .. "/out/precision.ply").has_colors, "errors are coloured")
    local curve = aib.system.read_text(scratch.path .. "/out/curve.csv")
    t:check(curve:find("\n0.005,1,1,1\n", 1, true), "the curve ends at 1")
  end,

  ["eth3d: completeness, accuracy and F-score are its tool's"] = function(t)
    each_case(t, function(case, estimate, reference, expected)
      local e = expected.eth3d
      if not e then return end
      local found = values("eth3d", { estimate = estimate, reference = reference, tolerances = e.Tolerances,
        voxel = e.voxel_size })
      for i, tolerance in ipairs(e.Tolerances) do
        for name, key in pairs { completeness = "Completenesses", accuracy = "Accuracies", f_score = "F1-scores" } do
          t:near(found[("eth3d.%s@%gm"):format(name, tolerance)], e[key][i], 1e-6, case .. " " .. name)
        end
      end
    end)
  end,

  ["eth3d: scans of a MeshLab project stand in the world"] = function(t)
    local scratch <close> = support.scratch_folder()
    write_line(scratch.path, "scan.ply", 4, 5)
    local estimate = write_line(scratch.path, "est.ply", 14, 12)
    local project = scratch.path .. "/scans.mlp"
    aib.system.write_text(project, [[<!DOCTYPE MeshLabDocument>
<MeshLabProject><MeshGroup><MLMesh label="scan" filename="scan.ply">
<MLMatrix44>
1 0 0 10
0 1 0 0
0 0 1 0
0 0 0 1
</MLMatrix44></MLMesh></MeshGroup></MeshLabProject>
]])
    local found = values("eth3d", { estimate = estimate, reference = project, tolerances = { 0.1 } })
    t:equal(found["eth3d.completeness@0.1m"], 0.5)
    t:equal(found["eth3d.accuracy@0.1m"], 0.5)
  end,

  ["dtu: the mask tells what was observed, the plane where the scan counts"] = function(t)
    local scratch <close> = support.scratch_folder()
    local function write_npz(name, arrays)
      local files = {}
      for key, value in pairs(arrays) do
        files[#files + 1] = support.quoted(("%s/%s.npy"):format(scratch.path, key))
        aib.io.write_array(("%s/%s.npy"):format(scratch.path, key), value)
      end
      local path = scratch.path .. "/" .. name
      assert(os.execute(("python3 -m zipfile -c %s %s"):format(support.quoted(path), table.concat(files, " "))))
      return path
    end
    local mask = write_npz("mask.npz", {
      ObsMask = { { { 1 } }, { { 1 } }, { { 0 } } }, BB = { { 0, 0, 0 }, { 2, 0, 0 } }, Res = { { 1 } },
    })
    local plane = write_npz("plane.npz", { P = { { 1 }, { 0 }, { 0 }, { -0.5 } } })
    local found = values("dtu", {
      estimate = write_line(scratch.path, "est.ply", 0.25, 1, 2, 5, 500), density = 0,
      reference = write_line(scratch.path, "ref.ply", 0, 1, 6), mask = mask, plane = plane,
    })
    t:near(found["dtu.accuracy"], 0.125, 1e-6)  -- 0.25 and 1 were observed
    t:near(found["dtu.completeness"], 0.5, 1e-6)  -- 1 and 6 lie above, 5 is in the box, 500 is not
  end,

  ["dtu: thins, drops from 20 mm on, and sees what the mask saw"] = function(t)
    local scratch <close> = support.scratch_folder()
    local estimate = write_line(scratch.path, "est.ply", 0, 0.1, 1, 30)
    local reference = write_line(scratch.path, "ref.ply", 0, 2, 70)
    local found = values("dtu", { estimate = estimate, reference = reference, density = 0 })
    t:near(found["dtu.accuracy"], (0 + 0.1 + 1) / 3, 1e-6)
    t:near(found["dtu.completeness"], 0.5, 1e-6)
    t:near(found["dtu.overall"], ((0 + 0.1 + 1) / 3 + 0.5) / 2, 1e-6)
    t:equal(found["dtu.accuracy_beyond"], 0.25)
    t:near(found["dtu.completeness_beyond"], 1 / 3, 1e-12)
    local thinned = values("dtu", { estimate = estimate, reference = reference })
    t:check(thinned["dtu.accuracy"] >= 0.5, "one of the two near points is gone")
  end,
}
