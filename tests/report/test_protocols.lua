-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What protocols draw where a page is asked for, and that their numbers are the same without one.
local aib = require "aib"

local here <const> = arg[0]:match("^(.*)/[^/]*$") or "."
local data <const> = here .. "/../../examples/data/"

local function protocol(name) return dofile(here .. "/../../examples/protocols/" .. name .. ".lua") end

--- How many views of each kind a run has.
local function drawn(name, inputs)
  local report, counts = protocol(name):run(inputs, { draw = true }), {}
  for _, view in ipairs(report.store.views) do counts[view.kind] = (counts[view.kind] or 0) + 1 end
  return counts, report
end

local crane <const> = data .. "methods/sgbm_gtposes/crane"

return aib.test {
  ["asset_inspection draws curves, timelines, frames and the geometry of each result"] = function(t)
    local counts, report = drawn("asset_inspection", { benchmark = data })
    t:equal(counts.cloud, 10)
    t:equal(counts.cameras, 6)
    t:check(counts.frame > 50 and counts.curve > 20 and counts.timeline > 10)
    local plain = protocol("asset_inspection"):run { benchmark = data }
    t:equal(plain.store.views, nil)
    local json = require "aib.report.json"
    t:check(json(report) == json(plain))
    local page = require("aib.report.html")(report)
    t:check(#page < 12e6)
    t:contains(page, "sensitivity.srmse_change")
  end,

  ["reconstruction draws both clouds, the mesh and its curves"] = function(t)
    local counts = drawn("reconstruction", { estimate = crane .. "/fused.ply", reference = data .. "gt/crane/mesh.ply",
      samples = 20000 })
    t:equal(counts, { cloud = 2, mesh = 1, curve = 5 })
  end,

  ["trajectory draws paths, pose_auc recall"] = function(t)
    local inputs = { estimate = { data .. "methods/glomap/crane/sparse/0" }, reference = data .. "gt/crane/poses" }
    t:equal((drawn("pose_auc", inputs)), { curve = 3 })
    inputs.align = "sim3"
    t:equal((drawn("trajectory", inputs)), { timeline = 1, cameras = 1 })
  end,

  ["depth draws its frames"] = function(t)
    local counts = drawn("depth", { estimate = crane .. "/depth", reference = data .. "gt/crane/depth" })
    t:equal(counts, { timeline = 2, frame = 14 })
  end,

  ["kitti_odometry draws errors by length, paths over the widest axes, and the reference once"] = function(t)
    local sparse = data .. "methods/glomap/crane/sparse/0"
    local counts, report = drawn("kitti_odometry", { estimate = { sparse, sparse }, lengths = { 1, 2, 4 }, step = 1,
      reference = data .. "gt/crane/poses" })
    t:equal(counts, { curve = 7, timeline = 2, cameras = 2 })
    local paths = {}
    for _, figure in ipairs(require("aib.report.figures").of(report)) do
      if figure.equal then paths[#paths + 1] = figure end
    end
    t:equal({ #paths, #paths[1].lines, paths[1].lines[1].label }, { 1, 3, "reference" })
    t:equal({ paths[1].x.label, paths[1].y.label }, { "x", "y" })  -- the crane is flown round
  end,

  ["benchmarks of clouds draw curves, histograms and both clouds"] = function(t)
    local reference = os.tmpname() .. ".ply"
    local points = aib.sample.mesh(aib.io.read_mesh(data .. "gt/crane/mesh.ply"), { n = 5000 })
    aib.io.write_cloud(reference, points)
    local function with(own)
      own.estimate, own.reference = crane .. "/fused.ply", reference
      return own
    end
    local expected = { cloud = 2, curve = 5 }
    t:equal((drawn("dtu", with { density = 0 })), expected)
    t:equal((drawn("eth3d", with { tolerances = { 0.05, 0.2 } })), expected)
    t:equal((drawn("da3_bench", with { dataset = "hiroom" })), expected)
    os.remove(reference)
  end,

  ["video_depth and depth_surface draw their frames and timelines"] = function(t)
    local folders = { estimate = crane .. "/depth", reference = data .. "gt/crane/depth" }
    t:equal((drawn("video_depth", folders)), { timeline = 2, frame = 14 })
    folders.cameras, folders.tau = data .. "gt/crane/poses", { 2, 5 }
    t:equal((drawn("depth_surface", folders)), { timeline = 4, frame = 14 })
  end,

  ["of many frames some are chosen, evenly"] = function(t)
    local names, n = {}, 0
    for i = 1, 1000 do names[i] = tostring(i) end
    local chosen = require("aib.evaluation.drawings").chosen(names)
    for _ in pairs(chosen) do n = n + 1 end
    t:equal(n, 60)
    t:check(chosen["1"] and chosen["984"])
  end,
}
