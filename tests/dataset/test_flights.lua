-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The flights: as many frames as the paper has, at its lens and size, near and around the asset.
local aib = require "aib"

package.path = (arg[0]:match("^(.*)/[^/]*$") or ".") .. "/../../examples/dataset/?.lua;" .. package.path
local flights = require "flights"

local paper_frames <const> = { office = 4763, crane = 642, bridge = 1074 }

--- Rays of a frame; the office has few because it has many frames, which fly along its rows.
local rays <const> = { office = { 32, 6 }, crane = { 48, 27 }, bridge = { 48, 27 } }

local cases = {}
for name, n in pairs(paper_frames) do
  cases[name .. ": frames of all scales"] = function(t)
    local scene = require("scenes." .. name)
    local paper = flights.plan(scene, "paper")
    t:equal({ paper.n_frames, #paper.trajectory, paper.camera.width, paper.camera.height }, { n, n, 1920, 1080 })
    t:near(paper.camera.fx, 50 / 36 * 1920, 1e-9)
    t:check(paper.overlap > 0.6 and paper.overlap < 0.95, "overlap " .. paper.overlap)
    local path = os.tmpname()
    scene.build():save(path)
    local mesh = aib.render.scene(aib.io.read_mesh(path))
    os.remove(path)
    local seen = aib.survey.measure(paper.trajectory, paper.camera, mesh, { labels = scene.labels, samples = 1,
      columns = rays[name][1], rows = rays[name][2] })
    t:near(seen.overlap.median, paper.overlap, 0.03)
    local tiny, small = flights.plan(scene, "tiny", mesh), flights.plan(scene, "small", mesh)
    t:equal({ tiny.n_frames, tiny.camera.width }, { 24, 320 })
    t:check(small.n_frames >= 140 and small.camera.width == 960)
    for _, plan in ipairs { tiny, small } do t:check(plan.min_distance > 1, plan.min_distance) end
    t:equal({ tiny.trajectory.names[1], tiny.trajectory.names[24] }, { "000000.png", "000023.png" })
  end
end

return aib.test(cases)
