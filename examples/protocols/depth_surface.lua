-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Depth maps in the units of an inspection: millimetres at the surface, multiples of the ground sampling distance,
--- orientation, and errors inside of surfaces, at depth edges and in thin structures.
---
---   aib-lua depth_surface method/depth gt/depth --cameras gt/poses        # or --focal 2666.7 (pixels of the photo)
local aib = require "aib"
local depth_frames = require "aib.depth_frames"
local drawings = require "aib.evaluation.drawings"
local failure = require "aib.failure"

local strata <const> = { "inside", "edge", "thin" }

--- Adds the mean of a number over the frames that have it.
local function add_mean(frames, report, name, options)
  local sum, n = 0, 0
  for _, numbers in ipairs(frames) do
    if numbers[name] then sum, n = sum + numbers[name], n + 1 end
  end
  options.n, options.convention = n, "mean over frames"
  report:add("surface." .. name, n > 0 and sum / n or nil, options)
end

--- The camera of a frame: that of its image, the only one of all, or one of the focal length.
local function camera_finder(input)
  if input.focal > 0 then
    return function(_, map)
      local width = input.width > 0 and input.width or map.width
      local height = width * map.height / map.width
      return aib.math.camera { width = width, height = math.floor(height + 0.5),
        parameters = { input.focal, input.focal, width / 2, height / 2 } }
    end
  end
  if input.cameras == "" then failure.usage("--cameras or --focal expected") end
  local cameras = aib.io.read_cameras(input.cameras)
  local by_stem, only, count = {}, nil, 0
  for image, camera in pairs(cameras) do
    by_stem[depth_frames.stem(image)] = camera
    only, count = camera, count + 1
  end
  return function(name)
    local camera = by_stem[name] or count == 1 and only
    if not camera then failure.raise("format", ("%s: no camera of an image '%s'"):format(input.cameras, name)) end
    return camera
  end
end

--- What one frame says, by name.
local function numbers_of(est, ref, camera, input, report)
  local surface = aib.depth.surface_errors(est, ref, camera, { tau = input.tau })
  local numbers = { mean_gsd = 1000 * surface.mean_gsd }
  for _, field in ipairs { "median", "p95", "rmse" } do
    numbers["distance_" .. field] = 1000 * surface.distance[field]
    numbers["gsd_" .. field] = surface.gsd[field]
  end
  for _, tau in ipairs(input.tau) do
    numbers[("within_%g_gsd"):format(tau)] = surface.within[tau]
    numbers[("within_total_%g_gsd"):format(tau)] = surface.within_total[tau]
  end
  local normals = report:attempt(function() return aib.depth.normal_errors(est, ref, camera) end)
  numbers.normal_mean = normals and normals.mean_deg
  numbers.boundary_f1 = aib.depth.boundary_f1(est, ref)
  local errors = aib.depth.errors(est, ref, { labels = aib.depth.strata(ref) })
  for label, stratum in ipairs(strata) do
    local of_stratum = errors.by_label[label] or {}
    numbers["abs_rel_" .. stratum] = of_stratum.abs_rel
    numbers["coverage_" .. stratum] = of_stratum.coverage
  end
  return numbers
end

local function report_means(frames, report, input)
  add_mean(frames, report, "mean_gsd", { unit = "mm" })
  for _, field in ipairs { "median", "p95", "rmse" } do
    add_mean(frames, report, "distance_" .. field, { unit = "mm", better = "lower" })
  end
  for _, field in ipairs { "median", "p95", "rmse" } do
    add_mean(frames, report, "gsd_" .. field, { unit = "GSD", better = "lower" })
  end
  for _, tau in ipairs(input.tau) do
    add_mean(frames, report, ("within_%g_gsd"):format(tau), { better = "higher" })
    add_mean(frames, report, ("within_total_%g_gsd"):format(tau), { better = "higher" })
  end
  add_mean(frames, report, "normal_mean", { unit = "deg", better = "lower" })
  add_mean(frames, report, "boundary_f1", { better = "higher" })
  for _, stratum in ipairs(strata) do
    add_mean(frames, report, "abs_rel_" .. stratum, { better = "lower" })
    add_mean(frames, report, "coverage_" .. stratum, { better = "higher" })
  end
end

--- Distances and what is near enough along the flight.
local function draw(report, frames, input)
  for _, part in ipairs { { "median", "median" }, { "p95", "95 %" } } do
    drawings.series(report, "Distance along the flight", { label = "distance", unit = "mm" }, frames,
      "distance_" .. part[1], part[2])
  end
  for _, tau in ipairs(input.tau) do
    drawings.series(report, "Near enough along the flight", { label = "share of the truth", low = 0, high = 1 }, frames,
      ("within_total_%g_gsd"):format(tau), ("within %g GSD"):format(tau))
  end
end

--- The inputs of the others that have a meaning here.
local function inputs(own)
  local all = depth_frames.inputs(own)
  for _, key in ipairs { "masks", "per_frame", "sheet", "worst", "worst_by" } do all[key] = nil end
  return all
end

return aib.protocol {
  name = "depth_surface",
  title = "Depth at the surface",
  help = "Distances of the estimated surface from the true one, in millimetres and in ground sampling distances (depth "
    .. "/ focal length of the photo); within_total counts a hole as a miss. Maps are in metres; estimates are taken as "
    .. "they are unless --align is given.",
  inputs = inputs {
    cameras = { kind = "path", default = "", help = "cameras of the photos, any format of poses; or --focal" },
    focal = { kind = "number", default = 0, min = 0, help = "focal length of the photos in their pixels" },
    width = { kind = "integer", default = 0, min = 0, help = "with --focal: width of the photos; 0: of the maps" },
    align = { kind = "choice", choices = { "none", "median", "log", "scale" }, default = "none",
      help = "scale that is fitted to each frame" },
    tau = { kind = "list", of = "number", default = { 1, 2, 5 }, above = 0,
      help = "multiples of the ground sampling distance" },
  },
  run = function(input, report)
    local frames, scored, undefined, names = depth_frames.pair(input), {}, {}, {}
    for i, frame in ipairs(frames) do names[i] = frame.name end
    local camera_of, chosen = camera_finder(input), drawings.chosen(names)
    local progress <close> = aib.progress(#frames, "frames")
    for _, frame in ipairs(frames) do
      progress:step(frame.name)
      local raw <close> = aib.io.read_depth(frame.estimate, { scale = input.estimate_scale })
      local ref <close> = aib.io.read_depth(frame.reference, { scale = input.reference_scale, width = raw.width,
        height = raw.height, rule = input.rule })
      local numbers = report:attempt(function()
        local fit = input.align ~= "none" and aib.depth.fit({ align = input.align }):add(raw, ref):result()
        local est = fit and raw:scaled(fit.scale) or raw
        drawings.frame(report, chosen, frame.name, est, ref)
        return numbers_of(est, ref, camera_of(frame.name, raw), input, report)
      end)
      if numbers then
        numbers.name = frame.name
        scored[#scored + 1] = numbers
      else
        undefined[#undefined + 1] = frame.name
      end
    end
    report_means(scored, report, input)
    depth_frames.report_frames(frames, { undefined = undefined }, report)
    draw(report, scored, input)
  end,
}
