-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The numbers of asset_inspection over the full scenes are those that other programs gave (numpy, scipy, Open3D).
local aib = require "aib"
local support = require "support"

local root <const>, shared <const> = support.root, support.shared

local references = {}

--- The expected numbers of "crane" and "office" by method, from both reference files.
local function reference(scene, method)
  for _, file in ipairs { "reference.json", "reference_glomap.json" } do
    local path = shared .. "/scenes/" .. file
    references[file] = references[file] or aib.json.decode(aib.system.read_text(path), path)
    local of_scene = references[file][scene == "office" and "office_high" or scene]
    if of_scene[method] then return of_scene[method] end
  end
end

--- Moves a camera's centre c to R R' c. The matrices were floats once, so R R' is the identity to 1e-7 only, and the
--- expected numbers were computed from -R (-R' c).
local function reference_centre(m)
  local c, turned = { m[1][4], m[2][4], m[3][4] }, {}
  for k = 1, 3 do turned[k] = m[1][k] * c[1] + m[2][k] * c[2] + m[3][k] * c[3] end
  for i = 1, 3 do m[i][4] = m[i][1] * turned[1] + m[i][2] * turned[2] + m[i][3] * turned[3] end
end

local reports = {}

--- Records of a run over the full scenes, by "scene/method/model/metric"; runs are kept.
local function run(options)
  local key = aib.json.encode(options)
  if reports[key] then return reports[key] end
  local folder <close> = support.scratch_folder()
  support.link(shared .. "/scenes/gt", folder.path .. "/gt")
  support.link(shared .. "/scenes/methods", folder.path .. "/methods")
  for _, scene in ipairs { "crane", "office" } do
    local poses = aib.json.decode(aib.system.read_text(("%s/scenes/gt/%s/transforms.json"):format(shared, scene)))
    for _, frame in ipairs(poses.frames) do
      frame.file_path = frame.file_path:match("[^/]*$")
      reference_centre(frame.transform_matrix)
    end
    aib.system.write_text(("%s/%s_transforms.json"):format(folder.path, scene), aib.json.encode(poses))
  end
  aib.system.write_text(folder.path .. "/benchmark.lua", aib.system.read_text(root .. "/tests/golden/benchmark.lua"))
  options.benchmark = folder.path
  local by_name = {}
  for _, r in ipairs(support.protocol("asset_inspection"):run(options):records()) do
    by_name[table.concat({ r.group.scene, r.group.method, r.group.model or "", r.name }, "/")] = r
  end
  reports[key] = by_name
  return by_name
end

--- Compares one number, relative to the expected one.
local function compare(t, records, name, expected, relative)
  local record = records[name]
  t:check(record, name .. " is missing")
  t:near(record.value, expected, relative * math.abs(expected), name)
end

--- Calls f(scene, method, model name, expected numbers of the model, name in records) for every sub-model.
local function each_model(f)
  for _, scene in ipairs { "crane", "office" } do
    for _, method in ipairs { "colmap", "colmap_wrongfocal", "glomap", "glomap_vgc", "colmap42" } do
      local models = reference(scene, method)
      if models and not (scene == "office" and method == "glomap_vgc") then
        local count = 0
        for _ in pairs(models) do count = count + 1 end
        for name, expected in pairs(models) do
          f(expected, ("%s/%s/%s/"):format(scene, method, count > 1 and name or ""), method)
        end
      end
    end
  end
end

local function skip_without(t)
  if not support.has_shared() then t:skip("the shared folder is not here") end
end

local function compare_cloud(t, records, place, expected, relative)
  local fields = {
    accuracy = "acc_mean", completeness = "comp_mean", chamfer = "chamfer_sum", chamfer_mean = "chamfer_half",
    f1_distance = "f1_paper_harmonic_of_distances", accuracy_median = "acc_median", completeness_median = "comp_median",
  }
  for ours, theirs in pairs(fields) do
    compare(t, records, place .. "cloud." .. ours, expected[theirs], relative)
  end
  for tau, at in pairs(expected.threshold or {}) do
    local suffix = ("@%gm"):format(tonumber(tau))
    -- A point that lies at the threshold within a float may fall on either side.
    t:near(records[place .. "cloud.precision" .. suffix].value, at.precision, 2e-4, place .. "precision" .. suffix)
    t:near(records[place .. "cloud.recall" .. suffix].value, at.recall, 2e-5, place .. "recall" .. suffix)
  end
end

return aib.test {
  ["registration, focal lengths and angles of every sub-model"] = function(t)
    skip_without(t)
    local records = run { alignment = "umeyama" }
    local n = 0
    each_model(function(expected, place)
      n = n + 1
      compare(t, records, place .. "pose.registration_rate", expected.registration_rate, 0)
      compare(t, records, place .. "pose.n_points", expected.n_points, 0)
      compare(t, records, place .. "camera.focal_mre", expected.focal_MRE_per_image, 1e-9)
      compare(t, records, place .. "pose.auc30", expected.pose.AUC30_paper_mean, 1e-9)
      for _, tau in ipairs { 5, 15, 30 } do
        compare(t, records, place .. "pose.rra" .. tau, expected.pose.RRA[tau], 1e-9)
        compare(t, records, place .. "pose.rta" .. tau, expected.pose.RTA[tau], 1e-9)
      end
    end)
    t:check(n >= 15, ("%d sub-models compared"):format(n))
  end,

  ["AUC by VGGT's convention"] = function(t)
    skip_without(t)
    local records = run { alignment = "umeyama", auc = "vggt" }
    each_model(function(expected, place)
      compare(t, records, place .. "pose.auc30", expected.pose.AUC30_vggt_pairmax_sign_agnostic, 1e-9)
      compare(t, records, place .. "pose.auc30_signed", expected.pose.AUC30_vggt_pairmax_signed, 1e-9)
    end)
  end,

  ["plain Umeyama of every sub-model that determines one"] = function(t)
    skip_without(t)
    local records = run { alignment = "umeyama" }
    each_model(function(expected, place)
      if expected.umeyama.well_conditioned == false then return end
      compare(t, records, place .. "align.scale", expected.umeyama.scale, 1e-9)
      compare(t, records, place .. "pose.ape_rmse", expected.umeyama.rmse, 1e-9)
    end)
  end,

  ["alignment after outliers are removed"] = function(t)
    skip_without(t)
    local records = run { alignment = "trimmed" }
    each_model(function(expected, place)
      if expected.umeyama.well_conditioned == false then return end
      local trimmed = expected.umeyama.outlier3xmedian
      compare(t, records, place .. "align.scale", trimmed.scale, 1e-9)
      compare(t, records, place .. "align.rmse", trimmed.rmse_kept, 1e-9)
      t:equal(records[place .. "align.scale"].n, trimmed.kept, place)
    end)
  end,

  ["depth by both rules of downsampling"] = function(t)
    skip_without(t)
    for rule, theirs in pairs { centre = "centre", floor = "corner" } do
      local records = run { alignment = "umeyama", rule = rule }
      for _, scene in ipairs { "crane", "office" } do
        for method, source in pairs { colmap = "sgbm_colmap", sgbm_gtposes = "sgbm_gtposes" } do
          local expected, place = reference(scene, source).depth, ("%s/%s//"):format(scene, method)
          compare(t, records, place .. "depth.srmse", expected["mean_sq_" .. theirs], 1e-9)
          compare(t, records, place .. "depth.si_log_rmse", expected["mean_sqrt_" .. theirs], 1e-9)
          t:equal(records[place .. "depth.srmse"].n, expected.frames, place)
        end
      end
    end
  end,

  ["fused clouds in the frame of the truth and in that of their model"] = function(t)
    skip_without(t)
    local records = run { alignment = "umeyama" }
    for _, scene in ipairs { "crane", "office" } do
      compare_cloud(t, records, scene .. "/sgbm_gtposes//", reference(scene, "sgbm_gtposes").fused_raw_frame, 1e-7)
      compare_cloud(t, records, scene .. "/colmap//", reference(scene, "sgbm_colmap").fused_aligned_umeyama_all, 1e-5)
    end
  end,

  ["sparse points of sub-models in the frame of each"] = function(t)
    skip_without(t)
    local records = run { alignment = "umeyama" }
    for _, case in ipairs { { "colmap", "0" }, { "colmap", "1" }, { "glomap", "0" }, { "colmap42", "1" } } do
      local method, model = case[1], case[2]
      local expected = reference("crane", method)[model].sparse_cloud_aligned
      compare_cloud(t, records, ("crane/%s points %s//"):format(method, model), expected, 1e-5)
    end
  end,
}
