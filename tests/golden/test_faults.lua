-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A benchmark with a fault in it: one sentence with the place, exit code 3, no result file.
local aib = require "aib"
local support = require "support"

local root <const> = support.root
local script <const> = root .. "/examples/protocols/asset_inspection.lua"

--- Evaluates a copy of the bundled benchmark in which `spoil(folder)` has broken something. Checks that this is told in
--- one sentence with every one of `parts`, and that no result is left.
local function expect_fault(t, spoil, parts)
  local scratch <close> = support.scratch_folder()
  local folder = scratch.path .. "/data"
  support.copy_folder(root .. "/examples/data", folder)
  spoil(folder)
  local out = scratch.path .. "/out.json"
  local output, complaints, code = support.aib_lua(script, folder, "--json", out, "--samples", "1000")
  t:equal(output, "")
  t:equal(code, 3, complaints)
  t:equal(select(2, complaints:gsub("\n", "")), 1, "lines of\n" .. complaints)
  for _, part in ipairs(parts) do t:contains(complaints, part) end
  t:equal(aib.system.names_in(scratch.path), { "data" })
end

--- Spoils a file by a function of its content.
local function changed(name, change)
  return function(folder)
    local path = folder .. "/" .. name
    aib.system.write_text(path, change(aib.system.read_text(path)))
  end
end

local function half(content) return content:sub(1, #content // 2) end
local function nothing() return "" end

local function replaced(old, new)
  return changed("benchmark.lua", function(content)
    local at = assert(content:find(old, 1, true), old)
    return content:sub(1, at - 1) .. new .. content:sub(at + #old)
  end)
end

local function removed(name)
  return function(folder) assert(os.execute("rm -r " .. support.quoted(folder .. "/" .. name))) end
end

--- What a protocol says of one depth map or of a small cloud, and the like: { code, sentence, words of the call }.
local function mistakes(folder)
  local poses, cloud, maps = root .. "/examples/data/gt/crane/poses", folder .. "/cloud.ply", folder .. "/maps"
  local none, text, words = folder .. "/none", folder .. "/text", folder .. "/words.txt"
  return {
    { 2, "--threshold or --dataset expected", "da3_bench", cloud, cloud },
    { 2, "did you mean 'eth3d'?", "da3_bench", cloud, cloud, "--dataset", "etd3d" },
    { 2, "--scene or --tau expected", "tanks_and_temples", cloud, cloud },
    { 2, "--reference-trajectory expected", "tanks_and_temples", cloud, cloud, "--tau", "1", "--trajectory", poses },
    { 3, "text: aib.cloud.crop: a box (min, max)", "tanks_and_temples", cloud, cloud, "--tau", "1", "--crop", text },
    { 3, "words.txt: points expected, found none", "reconstruction", words, cloud },
    { 2, "--tau: more than 0 expected, found '-1'", "reconstruction", cloud, cloud, "--tau", "-1" },
    { 2, "--memory: a size as 2GB or 500MB expected", "reconstruction", cloud, cloud, "--memory", "2G" },
    { 2, "--memory: --errors-to needs", "reconstruction", cloud, cloud, "--memory", "2GB", "--errors-to", none },
    { 3, "cloud.ply: --labels: labels expected, found none", "reconstruction", cloud, cloud, "--labels" },
    { 2, "--tau: at most --max-distance", "reconstruction", cloud, cloud, "--tau", "3", "--max-distance", "1" },
    { 2, "--scanner: X,Y,Z expected, found 1,2", "eth3d", cloud, cloud, "--scanner", "1,2" },
    { 2, "--tolerances: more than 0 expected", "eth3d", cloud, cloud, "--tolerances", "0" },
    { 2, "--max-distance: more than 0 expected", "dtu", cloud, cloud, "--max-distance", "0" },
    { 3, "none: no depth map (bin, dmap, exr,", "depth", maps, none },
    { 3, "maps: no depth map (x_*.exr)", "depth", maps, maps, "--estimate-pattern", "x_*.exr" },
    { 2, "--sheet: a name that ends in .png expected", "depth", maps, maps, "--sheet", "x.jpg" },
    { 2, "--per-frame: /no/such: no such folder", "depth", maps, maps, "--per-frame", "/no/such/x.csv" },
    { 2, "did you mean 'srmse'?", "depth", maps, maps, "--worst-by", "srsme" },
    { 2, "--width: an integer expected", "depth_surface", maps, maps, "--focal", "9", "--width", "0.5" },
    { 2, "--out is missing", "fuse_depth", maps, poses },
    { 2, "TABLE is missing", "published" },
    { 3, "none.csv: cells expected, found none", "published", folder .. "/none.csv", "--cite", "x" },
    { 2, "--delta: a whole number of frames", "trajectory", poses, poses, "--delta", "1.5" },
    { 3, "poses: --by stamp: stamps expected, found poses without", "trajectory", poses, poses, "--by", "stamp" },
    { 2, "the option axes does not fit", "trajectory", poses, poses, "--estimate-axes", "opengl" },
    { 2, "--lengths: more than 0 expected", "kitti_odometry", poses, poses, "--lengths", "0" },
    { 2, "--tau: at most 180 expected", "pose_auc", poses, poses, "--tau", "200" },
    { 2, "unknown kind 'yaw_bais', did you mean 'yaw_bias'?", "telemetry", poses, "--sweep", "yaw_bais=1:2" },
    { 2, "a number expected, found 'x' in yaw_bias=1:x", "telemetry", poses, "--sweep", "yaw_bias=1:x" },
  }
end

return aib.test {
  ["what protocols are asked wrongly is told in a sentence, and whose fault it is"] = function(t)
    local scratch <close> = support.scratch_folder()
    for _, name in ipairs { "maps", "none" } do aib.system.make_folder(scratch.path .. "/" .. name) end
    support.link(root .. "/examples/data/gt/crane/depth/000000.exr", scratch.path .. "/maps/000000.exr")
    for name, content in pairs { text = "[]", ["words.txt"] = "hello\n", ["none.csv"] = "metric,value\n" } do
      aib.system.write_text(scratch.path .. "/" .. name, content)
    end
    aib.io.write_cloud(scratch.path .. "/cloud.ply", aib.cloud.from_points { { 0, 0, 0 }, { 1, 0, 0 } })
    for _, mistake in ipairs(mistakes(scratch.path)) do
      local protocol, words = mistake[3], table.move(mistake, 4, #mistake, 1, {})
      local _, complaints, code = support.aib_lua(("%s/examples/protocols/%s.lua"):format(root, protocol),
        table.unpack(words))
      t:equal({ code, select(2, complaints:gsub("\n", "")) }, { mistake[1], 1 }, complaints)
      t:contains(complaints, mistake[2])
    end
  end,

  ["a folder that is not there"] = function(t)
    local _, complaints, code = support.aib_lua(script, "/no/such/folder")
    t:equal(code, 3)
    t:equal(complaints, "asset_inspection: /no/such/folder: no such folder\n")
  end,

  ["a folder without a benchmark"] = function(t)
    expect_fault(t, removed "benchmark.lua", { "data/benchmark.lua: cannot open: No such file or directory" })
  end,

  ["a scene whose files are not there"] = function(t)
    expect_fault(t, removed "gt/crane", { "data/gt/crane/" })
    expect_fault(t, removed "gt/crane/mesh.ply", { "data/gt/crane/mesh.ply: cannot open: No such file or directory" })
    expect_fault(t, removed "gt/office/depth", { "data/gt/office/depth/{stem}.exr: no file for any of 61 images" })
  end,

  ["results that are named but not there"] = function(t)
    expect_fault(t, removed "methods/colmap/crane/sparse", { "data/methods/colmap/crane/sparse" })
    expect_fault(t, removed "methods/sgbm_colmap/crane/fused.ply", { "data/methods/sgbm_colmap/crane/fused.ply" })
  end,

  ["an EXR that is cut"] = function(t)
    expect_fault(t, changed("gt/crane/depth/000036.exr", half), { "data/gt/crane/depth/000036.exr" })
    expect_fault(t, changed("methods/sgbm_gtposes/crane/depth/000000.exr", half),
      { "data/methods/sgbm_gtposes/crane/depth/000000.exr" })
    expect_fault(t, changed("methods/sgbm_gtposes/crane/depth/000000.exr", nothing),
      { "data/methods/sgbm_gtposes/crane/depth/000000.exr" })
  end,

  ["a COLMAP model that is cut"] = function(t)
    for _, name in ipairs { "images.bin", "cameras.bin", "points3D.bin" } do
      expect_fault(t, changed("methods/colmap/crane/sparse/1/" .. name, half),
        { "data/methods/colmap/crane/sparse/1/" .. name })
    end
  end,

  ["a PLY that is cut or empty"] = function(t)
    expect_fault(t, changed("methods/sgbm_gtposes/crane/fused.ply", half), { "sgbm_gtposes/crane/fused.ply" })
    expect_fault(t, changed("methods/sgbm_gtposes/crane/fused.ply", nothing), { "sgbm_gtposes/crane/fused.ply" })
    expect_fault(t, changed("methods/sgbm_gtposes/crane/fused.ply", function()
      return "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
        .. "end_header\n"
    end), { "sgbm_gtposes/crane/fused.ply: points expected, found none" })
    expect_fault(t, changed("gt/crane/mesh.ply", half), { "gt/crane/mesh.ply" })
  end,

  ["a benchmark.lua that is no data"] = function(t)
    expect_fault(t, changed("benchmark.lua", half), { "data/benchmark.lua:" })
    expect_fault(t, changed("benchmark.lua", nothing), { "data/benchmark.lua: a table expected, found nil" })
    expect_fault(t, changed("benchmark.lua", function() return "os.exit(0)" end),
      { "data/benchmark.lua:1: a benchmark is data: the global 'os' is not available" })
  end,

  ["a benchmark.lua with a name that is not known"] = function(t)
    expect_fault(t, replaced('parameters = "estimated"', 'parameters = "estimate"'),
      { "method COLMAP + SGBM: parameters: unknown 'estimate', did you mean 'estimated'?" })
    expect_fault(t, replaced('scene = "crane"', 'scene = "crame"'),
      { "method COLMAP + SGBM: result 1: scene: unknown 'crame', did you mean 'crane'?" })
    expect_fault(t, replaced('"very low"', '"very_low"'),
      { "condition: unknown 'very low', did you mean 'very_low'?" })
    expect_fault(t, replaced("crop = crop", "corp = crop"), { "scene 1: unknown field 'corp', did you mean 'crop'?" })
  end,
}
