-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The depth protocols give the numbers of NumPy, CUT3R, pi3 and monodepth2 on the same files. Maps are read as floats:
--- five digits.
local aib = require "aib"
local support = require "support"

local folder <const> = support.shared .. "/golden/depth/"

local function skip_without(t)
  if not aib.system.is_file(folder .. "expected_dmax_3m.json") then t:skip("the shared folder is not here") end
end

--- A case: inputs and expected numbers.
local function case(name)
  local path = folder .. "expected_" .. name .. ".json"
  local golden = aib.json.decode(aib.system.read_text(path), path)
  return golden
end

--- Runs a protocol over folders of one frame, `f`, that link to the case's files. Values by name of the record.
local function run(protocol, golden, own)
  local scratch <close> = support.scratch_folder()
  local inputs = { estimate = scratch.path .. "/est", reference = scratch.path .. "/gt" }
  for key, name in pairs { est = golden.inputs.est, gt = golden.inputs.gt } do
    os.execute("mkdir " .. support.quoted(scratch.path .. "/" .. key))
    support.link(support.shared .. "/golden/" .. name, ("%s/%s/f%s"):format(scratch.path, key, name:match("%.%w+$")))
  end
  for key, value in pairs(own) do inputs[key] = value end
  for _, key in ipairs { "per_frame", "sheet" } do inputs[key] = own[key] and scratch.path .. "/" .. own[key] end
  local values = {}
  for _, record in ipairs(support.protocol(protocol):run(inputs):records()) do values[record.name] = record.value end
  local csv = own.per_frame and aib.system.read_text(inputs.per_frame)
  return values, csv, own.sheet and aib.io.read_image(inputs.sheet)
end

local function near(t, values, name, expected, relative)
  t:near(values["depth." .. name], expected, (relative or 1e-5) * math.abs(expected), name)
end

local names_of_direct <const> = { abs_rel = "abs_rel", sq_rel = "sq_rel", rmse = "rmse", mae = "mae", log10 = "log10",
  rmse_log = "rmse_log" }
local names_of_video <const> = { abs_rel = "Abs Rel", sq_rel = "Sq Rel", rmse = "RMSE", rmse_log = "Log RMSE",
  delta1 = "δ < 1.25", delta2 = "δ < 1.25^2", delta3 = "δ < 1.25^3" }

local cases <const> = { "livingroom00_png_npy", "livingroom_10_vs_20_png", "sensor_pfm_exr", "dmax_3m" }

local function max_depth(golden) return golden.inputs.dmax ~= aib.json.null and golden.inputs.dmax or nil end

return aib.test {
  ["depth: NumPy's numbers, as they are and after a fit"] = function(t)
    skip_without(t)
    for _, name in ipairs(cases) do
      local golden = case(name)
      local direct = golden.expected.direct
      for align, theirs in pairs { none = "no_alignment", median = "median_scaled", scale = "lsq_scaled" } do
        local values = run("depth", golden, { align = align, max_depth = max_depth(golden) })
        for ours, field in pairs(names_of_direct) do near(t, values, ours, direct[theirs][field]) end
        near(t, values, "irmse", direct[theirs]["irmse_1/km"] / 1000)
        near(t, values, "imae", direct[theirs]["imae_1/km"] / 1000)
        near(t, values, "srmse", direct.sRMSE_paper_formula_no_root)
        near(t, values, "coverage", direct.valid_both / direct.valid_gt, 0)
      end
    end
  end,

  ["depth: both index rules of a smaller estimate"] = function(t)
    skip_without(t)
    local golden = case("sensor_lowres_nearest")
    for rule, theirs in pairs { floor = "nearest_floor_index", centre = "nearest_pixel_centre" } do
      local values = run("depth", golden, { rule = rule })
      near(t, values, "srmse", golden.expected[theirs].result.sRMSE_paper_formula_no_root)
      near(t, values, "abs_rel", golden.expected[theirs].result.no_alignment.abs_rel)
    end
  end,

  ["depth: a table of the frames and a picture of the worst"] = function(t)
    skip_without(t)
    local values, csv, sheet = run("depth", case("sensor_pfm_exr"), { per_frame = "frames.csv", sheet = "worst.png" })
    t:equal(csv:match("^[^\n]*"):sub(1, 22), "name,srmse,si_log_rmse")
    t:equal(csv:match("\nf,([^,]*),"), aib.json.number(values["depth.srmse"]))
    t:check(sheet.width >= 900 and sheet.height > 100)
  end,

  ["kitti_depth: the tool's units"] = function(t)
    skip_without(t)
    local golden = case("livingroom_10_vs_20_png")
    local direct = golden.expected.direct
    local values = run("kitti_depth", golden, { estimate_scale = 1000, reference_scale = 1000 })
    near(t, values, "silog", direct.kitti_SILog_x100_sqrt)
    near(t, values, "irmse", direct.no_alignment["irmse_1/km"])
    near(t, values, "imae", direct.no_alignment["imae_1/km"])
    near(t, values, "abs_rel", 100 * direct.no_alignment.abs_rel)
    near(t, values, "sq_rel", 100 * direct.no_alignment.sq_rel)
    near(t, values, "mae", 1000 * direct.no_alignment.mae)
    local in_steps = run("kitti_depth", golden, {})  -- 256 a metre: all lengths are 1000 / 256 times as large
    near(t, in_steps, "rmse", 1000 * direct.no_alignment.rmse * 1000 / 256)
  end,

  ["video_depth: the numbers of CUT3R and pi3"] = function(t)
    skip_without(t)
    for _, name in ipairs(cases) do
      local golden = case(name)
      for _, peer in ipairs { "cut3r", "pi3" } do
        for align, theirs in pairs { metric = "metric", median = "median", scale_shift = "lstsq_scale_shift" } do
          local values = run("video_depth", golden, { align = align, max_depth = max_depth(golden) })
          for ours, field in pairs(names_of_video) do
            near(t, values, ours, golden.expected.peers[peer][theirs][field])
          end
        end
      end
    end
  end,

  ["video_depth: sequences are weighted by their pixels, and a scale is one of each"] = function(t)
    local scratch <close> = support.scratch_folder()
    local function write(path, value, width)
      local row = {}
      for x = 1, width do row[x] = value end
      aib.io.write_depth(scratch.path .. "/" .. path, aib.depth.map { row })
    end
    for _, folder_name in ipairs { "est", "gt", "est/a", "gt/a", "est/b", "gt/b" } do
      os.execute("mkdir " .. support.quoted(scratch.path .. "/" .. folder_name))
    end
    write("gt/a/1.pfm", 2, 4)
    write("est/a/1.pfm", 1, 4)
    write("gt/a/2.pfm", 4, 2)
    write("est/a/2.pfm", 3, 2)
    write("gt/b/1.pfm", 5, 2)
    write("est/b/1.pfm", 1, 2)
    local report = support.protocol("video_depth"):run { estimate = scratch.path .. "/est",
      reference = scratch.path .. "/gt" }
    local values = {}
    for _, r in ipairs(report:records()) do values[(r.group.sequence or "") .. "/" .. r.name] = r.value end
    t:near(values["a/depth.scale"], 2, 1e-12)
    t:near(values["b/depth.scale"], 5, 1e-12)
    t:near(values["a/depth.abs_rel"], 2 / 6 * 0.5, 1e-12)
    t:near(values["all/depth.abs_rel"], (6 * 2 / 6 * 0.5 + 0) / 8, 1e-12)
  end,

  ["frames are paired by pattern; what is missing or empty is named; labels are groups"] = function(t)
    local scratch <close> = support.scratch_folder()
    for _, name in ipairs { "est", "gt", "labels" } do
      os.execute("mkdir " .. support.quoted(scratch.path .. "/" .. name))
    end
    local function write(path, map) aib.io.write_depth(scratch.path .. "/" .. path, aib.depth.map(map)) end
    write("gt/depth_1.npy", { { 1, 2 } })
    write("gt/depth_2.npy", { { 1, 2 } })
    write("gt/depth_3.npy", { { 1, 2 } })
    write("est/1_pred.pfm", { { 2, 2 } })
    write("est/3_pred.pfm", { { 0, 0 } })
    for _, name in ipairs { "1", "3" } do
      aib.io.write_image(("%s/labels/%s.png"):format(scratch.path, name), aib.raster.labels { { 0, 7 } })
    end
    local report = support.protocol("depth"):run { estimate = scratch.path .. "/est", reference = scratch.path .. "/gt",
      estimate_pattern = "*_pred.pfm", reference_pattern = "depth_*.npy", labels = scratch.path .. "/labels",
      label_names = { "7=glass" } }
    local values = {}
    for _, r in ipairs(report:records()) do values[(r.group.label or "") .. "/" .. r.name] = r.value end
    t:equal({ values["/depth.frames_missing"], values["/depth.frames_without_a_valid_pixel"] }, { 1, 1 })
    t:near(values["/depth.mae"], 0.5, 1e-12)
    t:near(values["/depth.coverage"], 0.5, 1e-12)
    t:near(values["glass/depth.mae"], 0, 1e-12)
    t:near(values["0/depth.mae"], 1, 1e-12)
    local notes = table.concat(report:note_lines(), "\n")
    t:check(notes:find("1 of 3 missing: 2", 1, true), notes)
    t:check(notes:find("1 of 3 without a valid pixel: 3", 1, true), notes)
    t:raises("no depth maps of one name", function()
      support.protocol("depth"):run { estimate = scratch.path .. "/est", reference = scratch.path .. "/gt" }
    end)
  end,

  ["depth_surface: a wall that stands too far, in millimetres and GSD"] = function(t)
    local scratch <close> = support.scratch_folder()
    for _, name in ipairs { "est", "gt" } do os.execute("mkdir " .. support.quoted(scratch.path .. "/" .. name)) end
    local function write(path, depth)
      local rows = {}
      for y = 1, 12 do
        rows[y] = {}
        for x = 1, 16 do rows[y][x] = depth end
      end
      aib.io.write_depth(scratch.path .. "/" .. path, aib.depth.map(rows))
    end
    write("gt/a.pfm", 10)
    write("est/a.pfm", 10.015625)
    write("gt/b.pfm", 10)
    write("est/b.pfm", 0)
    local function run_surface(own)
      local inputs = { estimate = scratch.path .. "/est", reference = scratch.path .. "/gt", focal = 1000, width = 160 }
      for key, value in pairs(own) do inputs[key] = value end
      local values = {}
      for _, r in ipairs(support.protocol("depth_surface"):run(inputs):records()) do values[r.name] = r.value end
      return values
    end
    local values = run_surface {}
    t:near(values["surface.mean_gsd"], 10, 1e-9)
    t:near(values["surface.distance_median"], 15.625, 1e-6)
    t:near(values["surface.gsd_median"], 1.5625, 1e-6)
    t:equal({ values["surface.within_1_gsd"], values["surface.within_2_gsd"] }, { 0.0, 1.0 })
    t:equal(values["depth.frames_without_a_valid_pixel"], 1)
    t:near(values["surface.normal_mean"], 0, 1e-3)
    t:near(values["surface.abs_rel_inside"], 0.0015625, 1e-9)
    t:near(run_surface({ align = "median" })["surface.distance_median"], 0, 1e-3)
    t:raises("no camera of an image", function()
      run_surface { focal = 0, cameras = support.root .. "/examples/data/gt/office/poses" }
    end)
  end,

  ["fuse_depth: the truth's depth maps are the truth's surface; confidence leaves out its share"] = function(t)
    local scratch <close> = support.scratch_folder()
    local office = support.root .. "/examples/data/gt/office"
    local cloud_path = scratch.path .. "/cloud.ply"
    local function fuse(own)
      local inputs = { depth = office .. "/depth", poses = office .. "/poses", out = cloud_path, voxel = 0.25 }
      inputs.stride = 4
      for key, value in pairs(own) do inputs[key] = value end
      local values = {}
      for _, r in ipairs(support.protocol("fuse_depth"):run(inputs):records()) do values[r.name] = r.value end
      return values, aib.io.read_cloud(cloud_path)
    end
    local values, cloud = fuse {}
    t:equal(values["fuse.frames"], 16)
    t:equal(values["fuse.kept_share"], 1.0)
    t:equal(values["fuse.points"], #cloud)
    local distances = aib.mesh.distances(cloud, aib.io.read_mesh(office .. "/mesh.ply"))
    t:check(distances:median() < 0.02, "median distance " .. distances:median())
    local whole, points = fuse { voxel = 0 }
    t:equal(whole["fuse.points"], #points)
    t:check(#points > 4 * #cloud)
    t:check(aib.mesh.distances(points, aib.io.read_mesh(office .. "/mesh.ply")):median() < 1e-3)
    local surest = fuse { confidence = office .. "/depth", min = 0.5, rule = "percentile" }
    local share = surest["fuse.kept_share"]  -- at most half: a facade has many pixels of one depth
    t:check(share > 0.1 and share <= 0.5, "kept " .. share)
    t:check(surest["fuse.points"] < values["fuse.points"])
  end,

  ["batches of frames merge to the bits of one run"] = function(t)
    local depth_frames = require "aib.depth_frames"
    local data = support.root .. "/examples/data/"
    local frames = depth_frames.pair { estimate = data .. "methods/sgbm_gtposes/office_high/depth",
      reference = data .. "gt/office/depth" }
    for i = 1, 32 do frames[#frames + 1] = frames[i] end
    local options = { align = "median" }
    local batches, one = depth_frames.evaluate(frames, options), aib.depth.evaluate(frames, options)
    t:equal(#batches, 48)
    t:equal(batches:result(), one:result())
    t:equal(batches:result { pooled = true }, one:result { pooled = true })
    t:equal(batches:frames()[48].name, one:frames()[48].name)
  end,
}
