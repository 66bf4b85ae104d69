-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The generated scenes: what they are made of, closed and outward solids, no two faces in one place.
local aib = require "aib"

package.path = (arg[0]:match("^(.*)/[^/]*$") or ".") .. "/../../examples/dataset/?.lua;" .. package.path
local checks = require "checks"
local solids = require "solids"
local vector = require "vector"

--- Solids, triangles, labels; square metres; SHA-256 of the PLY file.
local goldens <const> = {
  bridge = { counts = { 997, 62512, 29 }, area = 95407.212192,
    areas = { arch = 2467.66, cable = 80.009, road = 2646.96 },
    sha256 = "f6488b808224f37f54d9ad7e0fd1dd1bd3de83fb421d2f39c7dfaf9226d3ff57" },
  crane = { counts = { 1901, 50740, 40 }, area = 72928.597039,
    areas = { truss = 284.422, cable = 25.4664, concrete = 4729.28 },
    sha256 = "9ba910c16e65d17ebb4b7c26eb8cc9d6e063fabf83720e93b7a5c529b58e57b3" },
  office = { counts = { 2177, 60056, 41 }, area = 89520.750188,
    areas = { glass = 2191.89, frame = 974.75, solar = 111.992 },
    sha256 = "0f44aac0a76e705e4ecd67db72f8364250c5758c1195193ce60650c32ce4bff2" },
}

--- Area by label, and of all.
local function areas(scene)
  local by_label, sum = {}, 0
  for t, label in ipairs(scene.labels) do
    local p = {}
    for k = 1, 3 do
      local v = 3 * scene.triangles[3 * t - 3 + k]
      p[k] = { scene.vertices[v + 1], scene.vertices[v + 2], scene.vertices[v + 3] }
    end
    local area = vector.length(vector.cross(vector.sub(p[2], p[1]), vector.sub(p[3], p[1]))) / 2
    local name = scene.names[label + 1]
    by_label[name], sum = (by_label[name] or 0) + area, sum + area
  end
  return by_label, sum
end

local function check_scene(name, facts)
  return function(t)
    local scene = require("scenes." .. name).build()
    local by_label, all = areas(scene)
    t:equal({ #scene.starts, #scene.labels, #scene.names }, facts.counts, "solids, triangles, labels")
    t:near(all, facts.area, 1e-6, "area")
    for label, area in pairs(facts.areas) do t:near(by_label[label], area, 1e-5 * area, label) end
    t:equal(checks.solids(scene), {})
    t:equal(checks.overlaps(scene), {})
    t:equal(aib.system.sha256(scene:ply()), facts.sha256)
  end
end

local function read_back(t)
  local scene, path = solids.new(), os.tmpname()
  scene:box("wall", { 0, 0, 0 }, { 1, 2, 3 })
  scene:rod("pipe", { 0, 0, 5 }, { 1, 1, 6 }, 0.1, 8)
  scene:save(path)
  local mesh = aib.io.read_mesh(path)
  os.remove(path)
  t:equal({ mesh.n_triangles, mesh.n_open_edges, mesh.label_names }, { 12 + 28, 0, { "wall", "pipe" } })
end

local cases = {
  ["a scene is read back with its labels, watertight"] = read_back,

  ["solids that touch with their faces are found"] = function(t)
    local scene = solids.new()
    scene:box("wall", { 0, 0, 0 }, { 1, 1, 1 })
    scene:box("roof", { 0.5, 0.5, 1 }, { 2, 2, 2 })
    local found = checks.overlaps(scene)
    t:equal({ #found, found[1].a, found[1].b }, { 1, "wall", "roof" })
  end,

  ["a box whose top lies in another's side, a corner touching, is no overlap"] = function(t)
    local scene = solids.new()
    scene:box("wall", { 0, 0, 0 }, { 1, 1, 1 })
    scene:box("roof", { 1, 1, 0 }, { 2, 2, 2 })
    t:equal(checks.overlaps(scene), {})
  end,

  ["an open solid is found"] = function(t)
    local scene = solids.new()
    scene:add("wall", { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, { { 1, 3, 2 }, { 1, 2, 4 }, { 1, 4, 3 } })
    t:equal(#checks.solids(scene), 2)  -- neither closed nor with a volume
  end,

  ["solids face outwards whichever way their corners go round"] = function(t)
    local scene = solids.new()
    scene:prism("wall", { { 0, 0 }, { 0, 1 }, { 1, 1 } }, 0, 1)
    scene:prism("wall", { { 0, 0 }, { 1, 1 }, { 0, 1 } }, 3, 2)
    t:equal(checks.solids(scene), {})
  end,

  ["random numbers depend on the seed alone"] = function(t)
    local a, b = solids.random(7), solids.random(7)
    for _ = 1, 5 do t:equal(a(0, 1), b(0, 1)) end
    t:check(solids.random(8)(0, 1) ~= solids.random(7)(0, 1))
  end,
}
for name, facts in pairs(goldens) do cases["the " .. name .. " is as it was, closed, without double faces"] =
  check_scene(name, facts) end

return aib.test(cases)
