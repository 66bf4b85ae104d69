-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Compares a reconstructed cloud with a cloud or a mesh: the everyday command, and with --icp and --normals the
--- evaluation of CUT3R and pi3 (accuracy, completion and normal consistency, mean and median).
---
---   aib-lua reconstruction estimate.ply reference.ply --tau 0.02,0.05
local aib = require "aib"
local clouds = require "aib.evaluation.clouds"
local drawings = require "aib.evaluation.drawings"
local failure = require "aib.failure"

--- A mesh where the file holds one, else nil and the cloud.
local function read_reference(path)
  local ok, mesh = pcall(aib.io.read_mesh, path)
  if ok then return mesh, nil end
  if aib.error_kind(mesh) ~= "format" then error(mesh, 0) end
  return nil, clouds.read(path)
end

--- The estimate on the reference, where an ICP is asked for.
local function aligned(estimate, points, input, report)
  if input.icp == 0 then return estimate end
  local icp = aib.align.icp(estimate, points, { max_distance = input.icp })
  report:add("align.fitness", icp.fitness, { better = "higher", n = icp.n_pairs })
  report:add("align.rmse", icp.rmse, { unit = "m", better = "lower", n = icp.n_pairs })
  if not icp.converged then report:note("alignment", "the ICP has not converged") end
  return icp.transform * estimate
end

local lengths <const> = {
  "accuracy", "accuracy_median", "completeness", "completeness_median", "chamfer", "chamfer_mean", "f1_distance",
  "hausdorff",
}

local function add_comparison(compared, input, report)
  local how = { unit = "m", better = "lower", n = compared.n_estimate, options = {
    voxel = input.voxel, max_distance = input.max_distance, rule = input.rule, icp = input.icp } }
  for _, name in ipairs(lengths) do report:add("cloud." .. name, compared[name], how) end
  for _, tau in ipairs(input.tau) do
    for _, name in ipairs { "precision", "recall", "f_score" } do
      local metric = ("cloud.%s@%gm"):format(name, tau)
      report:add(metric, compared[name] and compared[name][tau], { better = "higher", n = compared.n_estimate })
    end
  end
  if input.max_distance > 0 then
    report:add("cloud.estimate_beyond", compared.estimate_beyond, { n = compared.n_estimate })
    report:add("cloud.reference_beyond", compared.reference_beyond, { n = compared.n_reference })
  end
end

--- The same for each label of the mesh or of the reference's points.
local function add_labels(estimate, mesh, points, options, input, report)
  local list = mesh and aib.mesh.compare_by_label(estimate, mesh, options)
    or aib.cloud.compare_by_label(estimate, points, options)
  for _, compared in ipairs(list) do
    local group = report:within { label = compared.name or tostring(compared.label) }
    add_comparison(compared, input, group)
    if not compared.accuracy then
      group:note(("%d points of the estimate, %d of the reference"):format(compared.n_estimate, compared.n_reference))
    end
  end
end

--- Clouds in the colours of their errors, the faces of a mesh in those of its completeness, curves.
local function write_errors(estimate, mesh, points, input)
  local to_reference = mesh and aib.mesh.distances(estimate, mesh) or aib.cloud.distances(estimate, points)
  local to_estimate = aib.cloud.distances(points, estimate)
  local high = math.max(1e-9, to_reference:quantile(0.95), to_estimate:quantile(0.95))
  if #input.tau > 0 then high = 3 * math.max(table.unpack(input.tau)) end
  aib.system.make_folder(input.errors_to)
  clouds.write_colored(input.errors_to .. "/accuracy.ply", estimate, to_reference, high)
  clouds.write_colored(input.errors_to .. "/completeness.ply", points, to_estimate, high)
  clouds.write_curve(input.errors_to .. "/curve.csv", to_reference, to_estimate, high, 100)
  if not mesh then return end
  local faces = aib.mesh.face_scores(estimate, mesh, { samples = points, tau = high / 3 })
  aib.io.write_mesh(input.errors_to .. "/faces.ply", mesh, {
    face_scalars = { accuracy = faces.accuracy, completeness = faces.completeness },
    face_colors = aib.cloud.colors_of(faces.completeness, { max = high }),
  })
end

--- Curves and geometry for the page.
local function draw(estimate, mesh, points, input, report)
  if not report:draws() then return end
  local to_reference = mesh and aib.mesh.distances(estimate, mesh) or aib.cloud.distances(estimate, points)
  drawings.points(report, estimate, { reference = points, mesh = mesh }, to_reference,
    aib.cloud.distances(points, estimate), #input.tau > 0 and input.tau or { 2 * to_reference:median() })
end

local function add_normals(estimate, points, report)
  local function with_normals(cloud) return cloud.has_normals and cloud or aib.cloud.with_normals(cloud) end
  local n = aib.cloud.normal_consistency(with_normals(estimate), with_normals(points))
  for _, name in ipairs { "estimate_mean", "estimate_median", "reference_mean", "reference_median" } do
    report:add("cloud.normal_consistency_" .. name, n[name], { better = "higher" })
  end
end

local function search_options(input)
  local options = { tau = input.tau, rule = input.rule }
  if input.max_distance == 0 then return options end
  for _, tau in ipairs(input.tau) do
    if tau > input.max_distance then failure.usage(("--tau: at most --max-distance expected, found %g"):format(tau)) end
  end
  options.max_distance = input.max_distance
  return options
end

--- What the comparison on disk cannot do, and how it is when it is not asked for.
local unused_on_disk <const> = { voxel = 0, icp = 0, normals = false, labels = false, errors_to = "" }

local units_of_memory <const> = { [""] = true, B = true, KB = true, MB = true, GB = true }

local function check_memory(text)
  local number, unit = text:match "^(%d+%.?%d*) *(%a*)$"
  if number and tonumber(number) > 0 and units_of_memory[unit:upper()] then return end
  failure.usage(("--memory: a size as 2GB or 500MB expected, found '%s'"):format(text))
end

--- The comparison of files that are larger than memory.
local function compared_on_disk(input)
  check_memory(input.memory)
  for name, unused in pairs(unused_on_disk) do
    if input[name] ~= unused then
      failure.usage(("--memory: --%s needs the clouds in memory"):format(name:gsub("_", "-")))
    end
  end
  local progress <close> = aib.progress(100, "%")
  local options, told = search_options(input), 0
  options.memory = input.memory
  options.progress = function(share)
    while told < math.floor(100 * share) do
      told = told + 1
      progress:step()
    end
  end
  return aib.stream.compare_clouds(input.estimate, input.reference, options)
end

return aib.protocol {
  name = "reconstruction",
  title = "Reconstruction against a cloud or a mesh",
  help = "Accuracy, completeness and what follows from them. Nothing is aligned unless --icp is given.",
  inputs = {
    estimate = { kind = "file", position = 1, help = "reconstructed cloud" },
    reference = { kind = "file", position = 2, help = "cloud or mesh of the truth" },
    tau = { kind = "list", of = "number", unit = "m", default = {}, above = 0,
      help = "thresholds of precision, recall, F-score" },
    max_distance = { kind = "number", unit = "m", default = 0, min = 0, help = "cuts distances from here on; 0: none" },
    rule = { kind = "choice", choices = { "drop", "clamp" }, default = "drop", help = "what becomes of them" },
    voxel = { kind = "number", unit = "m", default = 0, min = 0, help = "thins both clouds to a point each; 0: not" },
    icp = { kind = "number", unit = "m", default = 0, min = 0, help = "aligns first, by pairs so near; 0: not" },
    normals = { kind = "flag", help = "normal consistency, over 30 neighbours where there are no normals" },
    samples = { kind = "integer", default = 1000000, min = 1, help = "points sampled on a mesh" },
    seed = { kind = "integer", default = 1, min = 0, help = "of the sampling" },
    labels = { kind = "flag", help = "every metric by label of the reference too" },
    errors_to = { kind = "path", default = "", help = "writes coloured clouds, faces and curves there" },
    memory = { kind = "path", default = "", help = "two large PLY files within so much, e.g. 2GB" },
  },
  run = function(input, report)
    if input.memory ~= "" then return add_comparison(compared_on_disk(input), input, report) end
    local estimate = clouds.read(input.estimate)
    local mesh, points = read_reference(input.reference)
    if mesh then
      local info
      points, info = aib.sample.mesh(mesh, { n = input.samples, seed = input.seed })
      report:note("samples", ("completeness by %d samples of the mesh, %.3g m apart"):format(#points, 2 * info.floor))
    end
    if input.voxel > 0 then
      estimate = aib.sample.voxel(estimate, { size = input.voxel })
      points = aib.sample.voxel(points, { size = input.voxel })
    end
    estimate = aligned(estimate, points, input, report)
    if input.labels and not points.has_labels then
      failure.raise("format", input.reference .. ": --labels: labels expected, found none")
    end
    local options = search_options(input)
    if mesh then options.samples = points end
    local compared = mesh and aib.mesh.compare(estimate, mesh, options) or aib.cloud.compare(estimate, points, options)
    add_comparison(compared, input, report)
    if input.labels then add_labels(estimate, mesh, points, options, input, report) end
    draw(estimate, mesh, points, input, report)
    if input.errors_to ~= "" then write_errors(estimate, mesh, points, input) end
    if input.normals then add_normals(estimate, points, report) end
  end,
}
