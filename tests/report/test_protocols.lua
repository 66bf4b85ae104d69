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

  ["of many frames some are chosen, evenly"] = function(t)
    local names, n = {}, 0
    for i = 1, 1000 do names[i] = tostring(i) end
    local chosen = require("aib.evaluation.drawings").chosen(names)
    for _ in pairs(chosen) do n = n + 1 end
    t:equal(n, 60)
    t:check(chosen["1"] and chosen["984"])
  end,
}
