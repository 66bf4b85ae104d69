-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- From a plan to a benchmark folder without pictures: plan.lua, truth.lua, noise.lua and pack.lua as programs.
local aib = require "aib"

local root = (arg[0]:match("^(.*)/[^/]*$") or ".") .. "/../.."

--- The program that runs this test stands before its options.
local shell
do
  local k = 0
  while arg[k - 1] do k = k - 1 end
  shell = arg[k]
end

local function scratch()
  local path = os.tmpname()
  os.remove(path)
  aib.system.make_folder(path)
  return setmetatable({ path = path }, { __close = function() os.execute("rm -rf '" .. path .. "'") end })
end

local function run(script, ...)
  local words = { shell, root .. "/examples/dataset/" .. script, ... }
  for k, word in ipairs(words) do words[k] = "'" .. word .. "'" end
  return os.execute(table.concat(words, " ") .. " >/dev/null 2>&1")
end

local function sum_of(path) return aib.system.fingerprint(path).sha256 end

return aib.test {
  ["a planned scene with truth and a result is a benchmark"] = function(t)
    local folder <close> = scratch()
    local gt = folder.path .. "/gt/crane"
    t:check(run("plan.lua", "crane", "tiny", gt))
    t:check(run("truth.lua", gt, "20000"))
    for _, condition in ipairs { "high", "low" } do
      aib.system.make_folder(folder.path .. "/images/crane-" .. condition)
    end
    local place = folder.path .. "/methods/colmap/crane-low"
    aib.system.make_folder(place .. "/sparse")
    aib.io.write_trajectory(place .. "/sparse/0", aib.io.read_trajectory(gt .. "/poses"),
      { cameras = aib.io.read_cameras(gt .. "/poses") })
    aib.system.write_text(place .. "/run.json", [[{ "method": "COLMAP 3.8" }]])
    t:check(run("pack.lua", folder.path))

    local benchmark = aib.benchmark.open(folder.path)
    t:equal({ #benchmark.scenes, #benchmark.methods, #benchmark.units }, { 1, 1, 2 })
    t:equal(benchmark.scenes[1].conditions, { "low", "high" })
    t:equal({ benchmark.units[1].result.models, benchmark.units[2].result },
      { "methods/colmap/crane-low/sparse", nil })
    local truth = aib.scene.open(benchmark.units[1].scene, benchmark.files)
    t:equal({ #truth.names, #truth.depth_names }, { 24, 24 })
    t:check(#truth.points > 100 and truth.depth(truth.names[1]).width == 320)
    local listed = aib.system.read_text(folder.path .. "/SHA256SUMS")
    t:contains(listed, sum_of(gt .. "/mesh.ply") .. "  gt/crane/mesh.ply\n")
  end,

  ["noise is that of a frame, and what is there is kept"] = function(t)
    local folder <close> = scratch()
    local from, to, alone = folder.path .. "/from", folder.path .. "/to", folder.path .. "/alone"
    local picture = aib.io.read_image(root .. "/examples/guides/worst_frame.png")
    for _, path in ipairs { from, alone } do aib.system.make_folder(path) end
    for k = 0, 1 do aib.io.write_image(("%s/%06d.png"):format(from, k), picture) end
    aib.io.write_image(alone .. "/000001.png", picture)
    t:check(run("noise.lua", from, to))
    t:check(run("noise.lua", alone, alone .. "/to"))
    t:equal(aib.system.names_in(to), { "000000.png", "000001.png" })
    t:check(sum_of(to .. "/000000.png") ~= sum_of(to .. "/000001.png"))
    t:equal(sum_of(alone .. "/to/000001.png"), sum_of(to .. "/000001.png"))
    aib.system.write_text(to .. "/000000.png", "mine")
    t:check(run("noise.lua", from, to))
    t:equal(aib.system.read_text(to .. "/000000.png"), "mine")
  end,

  ["a wrong word is exit code 2"] = function(t)
    for _, script in ipairs { "plan.lua", "truth.lua", "noise.lua", "pack.lua" } do
      local _, _, code = run(script)
      t:equal(code, 2, script)
    end
  end,
}
