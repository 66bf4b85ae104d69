-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

local aib = require "aib"

local function maps()
  return aib.depth.map { { 2, 2 }, { 1, 0 } }, aib.depth.map { { 1, 4 }, { 1, 1 } }
end

return aib.test {
  ["errors of a frame have the names of the C++ fields"] = function(t)
    local errors = aib.depth.errors(maps())
    t:near(errors.abs_rel, 0.5, 1e-15)
    t:near(errors.coverage, 0.75, 0)
    t:equal(errors.n_reference, 4)
    t:near(errors.silog, 100 * errors.si_log_rmse, 1e-12)
  end,

  ["align, bounds and mask are options"] = function(t)
    local estimate, reference = maps()
    t:near(aib.depth.errors(estimate, reference:scaled(3), { align = "log" }).scale, 3, 1e-12)
    t:equal(aib.depth.errors(estimate, reference, { max = 4 }).n_valid, 2)
    t:equal(aib.depth.errors(estimate, reference, { mask = aib.raster.labels { { 7, 0 }, { 0, 0 } } }).n_valid, 1)
    t:raises("did you mean 'align'", aib.depth.errors, estimate, reference, { aling = "log" })
  end,

  ["maps of two sizes are refused with both named"] = function(t)
    local estimate = maps()
    t:raises("the estimate is 2x2, the reference 1x1", aib.depth.errors, estimate, aib.depth.map { { 1 } })
  end,

  ["downsample takes the pixel under the centre, or OpenCV's"] = function(t)
    local map = aib.depth.map { { 1, 2, 3, 4 } }
    t:near(aib.depth.downsample(map, 2, 1):at(1, 1), 2, 0)
    t:near(aib.depth.downsample(map, 2, 1, { rule = "floor" }):at(1, 1), 1, 0)
    t:raises("depth_map:at: column 1..4", map.at, map, 5, 1)
    t:raises("one of 'centre', 'floor' expected, found 'center', did you mean 'centre'?",
      aib.depth.downsample, map, 2, 1, { rule = "center" })
  end,

  ["an accumulator gives means, pooled errors, frames and an interval"] = function(t)
    local estimate, reference = maps()
    local frames = aib.depth.accumulate()
    frames:add(estimate, reference, { name = "a" }):add(reference, reference, { name = "b" })
    frames:add(aib.depth.map { { 0 } }, aib.depth.map { { 1 } }, { name = "lost" })
    local mean, pooled = frames:result(), frames:result { pooled = true }
    t:equal(#frames, 3)
    t:equal(mean.undefined, { "lost" })
    t:near(mean.abs_rel, 0.25, 1e-15)
    t:near(pooled.abs_rel, 1.5 / 7, 1e-15)
    t:equal(frames:frames { field = "mae" }[1].name, "a")
    t:equal(frames:frames()[3].n_valid, 0)
    local interval = frames:interval { field = "abs_rel", block = 1 }
    t:check(interval.low <= mean.abs_rel and mean.abs_rel <= interval.high)
    t:raises("one of srmse", frames.frames, frames, { field = "srms" })
  end,

  ["a fit over a sequence is a transform of its frames"] = function(t)
    local estimate, reference = maps()
    local fit = aib.depth.fit { align = "scale" }
    fit:add(estimate, reference):add(estimate:scaled(2), reference:scaled(2))
    local whole = fit:result()
    t:near(whole.scale, 11 / 9, 1e-12)
    t:near(aib.depth.errors(estimate, reference, { transform = whole }).scale, whole.scale, 0)
    t:raises("table with `scale`", aib.depth.errors, estimate, reference, { transform = { 1 } })
  end,

  ["presets are options of other scripts"] = function(t)
    local estimate, reference = maps()
    t:equal(aib.depth.errors(estimate, reference, { preset = "cut3r", max = 4 }).n_valid, 2)
    t:near(aib.depth.errors(estimate, reference, { preset = "cut3r" }).scale, 0.5, 0)
    t:raises("fits a whole sequence", aib.depth.accumulate, { preset = "pi3" })
    local fit = aib.depth.fit({ align = "median_lower" }):add(estimate, reference):result()
    local frames = aib.depth.accumulate { preset = "pi3", transform = fit }
    t:near(frames:add(estimate, reference):result().scale, 0.5, 0)
  end,

  ["an error image is three panels, a contact sheet many pictures"] = function(t)
    local estimate, reference = maps()
    local picture = aib.depth.error_image(estimate, reference, { near = 1, far = 4 })
    t:equal(picture.width, 3 * 2 + 4 * 6)
    t:equal(#picture:at(1, 1), 3)
    t:raises("image:at: column 1..", picture.at, picture, 0, 1)
    t:raises("label_image:at: column 1..2 and row 1..1 expected, found 3 and 1",
      function() return aib.raster.labels({ { 1, 2 } }):at(3, 1) end)
    t:raises("aib.raster.labels: rows of one length", aib.raster.labels, { { 1, 2 }, { 3 } })
    t:raises("aib.depth.map: rows of one length", aib.depth.map, { { 1, 2 }, { 3 } })
    local sheet = aib.raster.contact_sheet({ picture, picture }, { columns = 2, width = 30 })
    t:equal(sheet.width, 2 * 36 + 6)
  end,
  ["errors by label, for strata and any label image"] = function(t)
    local estimate, reference = maps()
    local labels = aib.raster.labels { { 0, 4 }, { 4, 0 } }
    local errors = aib.depth.errors(estimate, reference, { labels = labels })
    t:near(errors.by_label[0].mae, 1, 0)
    t:near(errors.by_label[4].mae, 1, 0)
    t:equal(errors.by_label[0].n_reference, 2)
    local frames = aib.depth.accumulate():add(estimate, reference, { labels = labels })
    t:equal(frames:labels(), { 0, 4 })
    t:equal(frames:of_label(4):result().n_valid, 2)
    t:near(aib.depth.srmse(estimate, reference), errors.srmse, 0)
    t:equal(aib.depth.strata(aib.depth.map { { 9, 1, 9 } }):at(2, 1), 3)
    t:raises("label image", aib.depth.errors, estimate, reference, { labels = aib.raster.labels { { 1 } } })
  end,

  ["errors at the surface, of normals, planes and contours"] = function(t)
    local rows, far = {}, {}
    for y = 1, 8 do
      rows[y], far[y] = {}, {}
      for x = 1, 8 do rows[y][x], far[y][x] = 10, 10.1 end
    end
    local reference, estimate = aib.depth.map(rows), aib.depth.map(far)
    local camera = aib.math.camera { width = 80, height = 80, parameters = { 100, 100, 40, 40 } }
    local surface = aib.depth.surface_errors(estimate, reference, camera, { tau = { 0.5, 2 } })
    t:near(surface.distance.median, 0.1, 1e-5)
    t:near(surface.mean_gsd, 0.1, 1e-12)
    t:equal({ surface.within[0.5], surface.within[2] }, { 0.0, 1.0 })
    local normals = aib.depth.normal_errors(estimate, reference, camera)
    t:near(normals.mean_deg, 0, 1e-3)
    t:equal(normals.below[11.25], 1.0)
    local wall = {}
    for y = 1, 8 do wall[y] = { 1, 1, 1, 1, 1, 1, 1, 1 } end
    local planes = aib.depth.plane_errors(estimate, reference, camera, aib.raster.labels(wall))
    t:near(planes[1].offset, 0.1, 1e-5)
    t:equal(aib.depth.boundary_f1(estimate, reference), 0.0)
  end,

  ["options inside options are checked as all are"] = function(t)
    t:raises("aib.depth.evaluate: unknown option 'chanel', did you mean 'channel'?",
      aib.depth.evaluate, {}, { estimate = { chanel = "Z" } })
    local loop = {}
    loop[1] = loop
    t:raises("lists of numbers of one size, expected", aib.io.array, loop)
  end,

  ["risk falls where a confidence knows"] = function(t)
    local estimate, reference = aib.depth.map { { 1, 2, 4 } }, aib.depth.map { { 1, 1, 1 } }
    local curve = aib.depth.risk_coverage(estimate, reference, aib.depth.map { { 9, 5, 1 } }, { steps = 3 })
    t:equal(curve.risk, { 0.0, 0.5, 4 / 3 })
    t:equal(curve.ause, 0.0)
    t:raises("confidence map", aib.depth.risk_coverage, estimate, reference, aib.depth.map { { 1 } })
  end,
}
