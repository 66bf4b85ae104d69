-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The whole protocol over all scenes and methods of the shared folder, as long jobs have it: killed, resumed, cut into
--- shards, with files that were touched. Always the same bytes, and only what changed is made again.
local aib = require "aib"
local support = require "support"

local root <const>, shared <const> = support.root, support.shared
local script <const> = root .. "/examples/protocols/asset_inspection.lua"
local merge <const> = root .. "/examples/protocols/merge.lua"

--- What the exporters of batched methods left, beside the methods of tests/golden/benchmark.lua.
local exported <const> = { "da3", "da3_gtposes", "vggt", "pi3", "cut3r", "monst3r" }

local function write_benchmark(folder)
  local lines = { "local b = (function()", aib.system.read_text(root .. "/tests/golden/benchmark.lua"), "end)()" }
  for _, method in ipairs(exported) do
    local results = {}
    for scene, condition in pairs { crane = "", office = ', condition = "high"' } do
      if aib.system.is_folder(("%s/scenes/batched/methods/%s/%s"):format(shared, method, scene)) then
        results[#results + 1] = ('{ scene = "%s"%s, output = "batched/%s/%s" }'):format(scene, condition, method, scene)
      end
    end
    table.sort(results)
    local line = 'b.methods[#b.methods + 1] = { name = "%s", parameters = "estimated", results = { %s } }'
    lines[#lines + 1] = line:format(method, table.concat(results, ", "))
  end
  lines[#lines + 1] = "return b"
  aib.system.write_text(folder .. "/benchmark.lua", table.concat(lines, "\n"))
end

--- A benchmark folder of links; the methods of `copied` are copies, which a test may touch.
local function whole_benchmark(folder, copied)
  aib.system.make_folder(folder .. "/methods")
  support.link(shared .. "/scenes/gt", folder .. "/gt")
  support.link(shared .. "/scenes/batched/methods", folder .. "/batched")
  for _, method in ipairs(aib.system.names_in(shared .. "/scenes/methods")) do
    local from, to = shared .. "/scenes/methods/" .. method, folder .. "/methods/" .. method
    if copied[method] then support.copy_folder(from, to) else support.link(from, to) end
  end
  for _, scene in ipairs { "crane", "office" } do
    local poses = aib.json.decode(aib.system.read_text(("%s/scenes/gt/%s/transforms.json"):format(shared, scene)))
    for _, frame in ipairs(poses.frames) do frame.file_path = frame.file_path:match "[^/]*$" end
    aib.system.write_text(("%s/%s_transforms.json"):format(folder, scene), aib.json.encode(poses))
  end
  write_benchmark(folder)
end

--- Runs a protocol with --json; returns the bytes and what it said.
local function json_of(t, protocol, out, ...)
  local words = { protocol, ... }
  table.move({ "--json", out }, 1, 2, #words + 1, words)
  local _, said, code = support.aib_lua(table.unpack(words))
  t:equal(code, 0, said)
  return aib.system.read_text(out), said
end

--- Of what a run said, the parts that it made.
local function made_of(said) return said:match "made: ([^\n]*)" end

return aib.test {
  ["killed, resumed, in shards, touched: the same bytes, and only what changed is made"] = function(t)
    if not support.has_shared() then t:skip "the shared folder is not here" end
    local scratch <close> = support.scratch_folder()
    local data, kept, out = scratch.path .. "/data", scratch.path .. "/kept", scratch.path .. "/out.json"
    whole_benchmark(data, { glomap = true, sgbm_colmap = true })
    local whole = json_of(t, script, out, data)

    local function shards(n)
      local paths = {}
      for i = 1, n do
        paths[i] = ("%s/%d_of_%d.json"):format(scratch.path, i, n)
        json_of(t, script, paths[i], data, "--results", kept, "--shard", ("%d/%d"):format(i, n))
      end
      return (json_of(t, merge, out, table.unpack(paths)))
    end
    os.execute(("timeout -s KILL 1 %s %s %s --results %s --shard 1/3 >/dev/null 2>&1"):format(
      support.quoted(support.program()), support.quoted(script), support.quoted(data), support.quoted(kept)))
    t:check(shards(3) == whole, "three shards, of which one was killed")

    local again, said = json_of(t, script, out, data, "--results", kept)
    t:check(again == whole, "all parts reused")
    local n = tonumber(said:match "(%d+) of %d+ parts are reused\n")
    t:check(n and n > 50, said)
    t:check(shards(2) == whole and shards(16) == whole, "other shards of the same parts")

    local touched = data .. "/methods/glomap/crane/sparse/0/points3D.bin"
    assert(os.execute("touch -d '2001-02-03' " .. support.quoted(touched)))
    again, said = json_of(t, script, out, data, "--results", kept)
    t:equal(made_of(said), "crane / glomap; crane / glomap points 0", "of which the time of change is another")
    t:check(again == whole, "the content is the same")

    local depth = data .. "/methods/sgbm_colmap/office_high/depth/"
    local names = aib.system.names_in(depth)
    aib.system.write_text(depth .. names[1], aib.system.read_text(depth .. names[2]))
    again, said = json_of(t, script, out, data, "--results", kept)
    t:equal(made_of(said), "office / high / colmap, images 1 to 32", "of which the content is another")
    t:check(again ~= whole, "the numbers are others")
  end,
}
