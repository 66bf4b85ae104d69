-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Depth maps in the units of an inspection: millimetres at the surface, multiples of the ground sampling distance,
--- orientation, and errors inside of surfaces, at depth edges and in thin structures.
---
---   aib-lua depth_surface method/depth gt/depth --cameras gt/poses        # or --focal 2666.7 (pixels of the photo)
local aib = require "aib"
local depth_frames = require "aib.depth_frames"
local failure = require "aib.failure"

local strata <const> = { "inside", "edge", "thin" }

--- Means of numbers by name, over the frames that have them.
local function new_means() return setmetatable({ sums = {}, counts = {} }, { __index = {
  add = function(self, name, value)
    if not value then return end
    self.sums[name] = (self.sums[name] or 0) + value
    self.counts[name] = (self.counts[name] or 0) + 1
  end,
  report = function(self, report, name, options)
    options.n = self.counts[name] or 0
    options.convention = "mean over frames"
    report:add("surface." .. name, self.sums[name] and self.sums[name] / options.n, options)
  end,
} }) end

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
    by_stem[image:match("[^/]*$"):gsub("%.[^.]*$", "")] = camera
    only, count = camera, count + 1
  end
  return function(name)
    local camera = by_stem[name] or count == 1 and only
    if not camera then failure.raise("format", ("%s: no camera of an image '%s'"):format(input.cameras, name)) end
    return camera
  end
end

--- Adds what one frame says.
local function add_frame(means, est, ref, camera, input, report)
  local surface = aib.depth.surface_errors(est, ref, camera, { tau = input.tau })
  means:add("mean_gsd", 1000 * surface.mean_gsd)
  for _, field in ipairs { "median", "p95", "rmse" } do
    means:add("distance_" .. field, 1000 * surface.distance[field])
    means:add("gsd_" .. field, surface.gsd[field])
  end
  for _, tau in ipairs(input.tau) do
    means:add(("within_%g_gsd"):format(tau), surface.within[tau])
    means:add(("within_total_%g_gsd"):format(tau), surface.within_total[tau])
  end
  local normals = report:attempt(function() return aib.depth.normal_errors(est, ref, camera) end)
  means:add("normal_mean", normals and normals.mean_deg)
  means:add("boundary_f1", aib.depth.boundary_f1(est, ref))
  local errors = aib.depth.errors(est, ref, { labels = aib.depth.strata(ref) })
  for label, stratum in ipairs(strata) do
    local of_stratum = errors.by_label[label] or {}
    means:add("abs_rel_" .. stratum, of_stratum.abs_rel)
    means:add("coverage_" .. stratum, of_stratum.coverage)
  end
end

local function report_means(means, report, input)
  means:report(report, "mean_gsd", { unit = "mm" })
  for _, field in ipairs { "median", "p95", "rmse" } do
    means:report(report, "distance_" .. field, { unit = "mm", better = "lower" })
  end
  for _, field in ipairs { "median", "p95", "rmse" } do
    means:report(report, "gsd_" .. field, { unit = "GSD", better = "lower" })
  end
  for _, tau in ipairs(input.tau) do
    means:report(report, ("within_%g_gsd"):format(tau), { better = "higher" })
    means:report(report, ("within_total_%g_gsd"):format(tau), { better = "higher" })
  end
  means:report(report, "normal_mean", { unit = "deg", better = "lower" })
  means:report(report, "boundary_f1", { better = "higher" })
  for _, stratum in ipairs(strata) do
    means:report(report, "abs_rel_" .. stratum, { better = "lower" })
    means:report(report, "coverage_" .. stratum, { better = "higher" })
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
    width = { kind = "number", default = 0, min = 0, help = "with --focal: width of the photos; 0: of the maps" },
    align = { kind = "choice", choices = { "none", "median", "log", "scale" }, default = "none",
      help = "scale that is fitted to each frame" },
    tau = { kind = "list", of = "number", default = { 1, 2, 5 }, help = "multiples of the ground sampling distance" },
  },
  run = function(input, report)
    local frames, means, undefined = depth_frames.pair(input), new_means(), {}
    local camera_of = camera_finder(input)
    local progress <close> = aib.progress(#frames, "frames")
    for _, frame in ipairs(frames) do
      progress:step(frame.name)
      local raw <close> = aib.io.read_depth(frame.estimate, { scale = input.estimate_scale })
      local ref <close> = aib.io.read_depth(frame.reference, { scale = input.reference_scale, width = raw.width,
        height = raw.height, rule = input.rule })
      local scored = report:attempt(function()
        local fit = input.align ~= "none" and aib.depth.fit({ align = input.align }):add(raw, ref):result()
        add_frame(means, fit and raw:scaled(fit.scale) or raw, ref, camera_of(frame.name, raw), input, report)
        return true
      end)
      if not scored then undefined[#undefined + 1] = frame.name end
    end
    report_means(means, report, input)
    depth_frames.report_frames(frames, { undefined = undefined }, report)
  end,
}
