-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Long evaluations: finished parts are reused, what was touched is made again, and an interrupted run, shards and one
--- run give the same bytes.
local aib = require "aib"
local support = require "support"

local script <const> = support.root .. "/examples/protocols/asset_inspection.lua"
local merge <const> = support.root .. "/examples/protocols/merge.lua"
local fast <const> = { "--samples", "2000" }

--- Runs a protocol with --json; returns the bytes.
local function json_of(t, protocol, out, ...)
  local words = { protocol, ... }
  table.move({ "--quiet", "--json", out }, 1, 3, #words + 1, words)
  if protocol == script then table.move(fast, 1, #fast, #words + 1, words) end
  local _, complaints, code = support.aib_lua(table.unpack(words))
  t:equal({ complaints, code }, { "", 0 })
  return aib.system.read_text(out)
end

--- The last line of what a run said; before it a slow one says how far it is.
local function last_line(said) return said:match "([^\n]*)\n$" end

--- Names of the kept parts by what tells whether they were written again.
local function states(folder)
  local out = {}
  for _, name in ipairs(aib.system.names_in(folder)) do out[name] = aib.system.status(folder .. "/" .. name) end
  return out
end

local function copied_benchmark(scratch)
  local data = scratch.path .. "/data"
  support.copy_folder(support.root .. "/examples/data", data)
  return data, scratch.path .. "/kept", scratch.path .. "/out.json"
end

return aib.test {
  ["a second run reuses every part, gives the same bytes and says so"] = function(t)
    local scratch <close> = support.scratch_folder()
    local data, kept, out = copied_benchmark(scratch)
    local plain = json_of(t, script, out, data)
    local first = json_of(t, script, out, data, "--results", kept)
    local before = states(kept)
    local second = json_of(t, script, out, data, "--results", kept)
    t:check(plain == first and first == second, "the bytes are the same")
    t:equal(#aib.system.names_in(kept), 21)  -- nine units, and 32 of 81 or 61 images each where there are depth maps
    t:equal(states(kept), before)
    local _, said = support.aib_lua(script, data, "--results", kept, fast[1], fast[2])
    t:equal(last_line(said), "21 of 21 parts are reused")
  end,

  ["a second page reuses every part and is the same bytes; a first one makes those with views"] = function(t)
    local scratch <close> = support.scratch_folder()
    local data, kept, out = copied_benchmark(scratch)
    local function page(...)
      local file = scratch.path .. "/page.html"
      local _, said, code = support.aib_lua(script, data, "--html", file, fast[1], fast[2], ...)
      t:equal(code, 0, said)
      return aib.system.read_text(file), said
    end
    local plain = page()
    json_of(t, script, out, data, "--results", kept)
    local first, said = page("--results", kept)
    t:contains(said, "12 of 21 parts are reused")
    local before = states(kept)
    local second, said_again = page("--results", kept)
    t:equal(last_line(said_again), "21 of 21 parts are reused")
    t:equal(states(kept), before)
    t:check(plain == first and first == second, "the bytes are the same")
  end,

  ["a file that was touched makes exactly its parts again"] = function(t)
    local scratch <close> = support.scratch_folder()
    local data, kept, out = copied_benchmark(scratch)
    local first = json_of(t, script, out, data, "--results", kept)
    local before = states(kept)
    local touched = data .. "/methods/glomap/crane/sparse/0/points3D.bin"
    assert(os.execute("touch -d '2001-02-03' " .. support.quoted(touched)))
    local second = json_of(t, script, out, data, "--results", kept)
    local again = {}
    for name, state in pairs(states(kept)) do
      if state ~= before[name] then again[#again + 1] = name:match "^(.*)_%x+%.part$" end
    end
    t:equal(again, { "crane_GLOMAP" })
    t:check(first == second, "the bytes are the same")
  end,

  ["a file of other content makes its part again: what a run without kept parts gives"] = function(t)
    local scratch <close> = support.scratch_folder()
    local data, kept, out = copied_benchmark(scratch)
    local before = json_of(t, script, out, data, "--results", kept)
    local depth = data .. "/methods/sgbm_gtposes/crane/depth/"
    local names = aib.system.names_in(depth)
    aib.system.write_text(depth .. names[1], aib.system.read_text(depth .. names[2]))
    local _, said = support.aib_lua(script, data, "--results", kept, fast[1], fast[2])
    t:equal(last_line(said), "20 of 21 parts are reused; made: crane / SGBM, true poses, images 1 to 32")
    local added = depth .. names[1]:gsub("%d+", function(digits) return ("%06d"):format(tonumber(digits) + 1) end)
    t:check(not aib.system.is_file(added), "a map that is new")
    aib.system.write_text(added, aib.system.read_text(depth .. names[2]))
    _, said = support.aib_lua(script, data, "--results", kept, fast[1], fast[2])
    t:equal(last_line(said), "20 of 21 parts are reused; made: crane / SGBM, true poses, images 1 to 32")
    os.remove(added)
    json_of(t, script, out, data, "--results", kept)
    local after = json_of(t, script, out, data, "--results", kept)
    t:check(after ~= before and after == json_of(t, script, out, data), "the numbers follow the content")
  end,

  ["other options make all units again"] = function(t)
    local scratch <close> = support.scratch_folder()
    local data, kept, out = copied_benchmark(scratch)
    json_of(t, script, out, data, "--results", kept)
    local before = states(kept)
    json_of(t, script, out, data, "--results", kept, "--rule", "floor")
    for name, state in pairs(states(kept)) do t:check(state ~= before[name], name) end
  end,

  ["a kept unit that is damaged is made again"] = function(t)
    local scratch <close> = support.scratch_folder()
    local data, kept, out = copied_benchmark(scratch)
    local first = json_of(t, script, out, data, "--results", kept)
    for i, damage in ipairs {
      function(text) return text:sub(1, 100) end,
      function(text) return (text:gsub('"bytes": ', '"bytes": 1', 1)) end,
      function() return "" end,
    } do
      local path = kept .. "/" .. aib.system.names_in(kept)[i]
      local text = aib.system.read_text(path)
      t:check(damage(text) ~= text, path)
      aib.system.write_text(path, damage(text))
    end
    t:check(json_of(t, script, out, data, "--results", kept) == first, "the bytes are the same")
  end,

  ["a run that was killed goes on, to the same bytes"] = function(t)
    local scratch <close> = support.scratch_folder()
    local data, kept, out = copied_benchmark(scratch)
    local whole = json_of(t, script, out, data)
    for _, seconds in ipairs { "0.05", "0.1", "0.2" } do
      os.execute(("timeout -s KILL %s %s %s %s --quiet --json %s --results %s --samples 2000 >/dev/null 2>&1"):format(
        seconds, support.quoted(support.program()), support.quoted(script), support.quoted(data),
        support.quoted(out .. ".killed"), support.quoted(kept)))
    end
    t:check(json_of(t, script, out, data, "--results", kept) == whole, "the bytes are the same")
  end,

  ["shards in any order and number merge to the bytes of one run"] = function(t)
    local scratch <close> = support.scratch_folder()
    local data, kept, out = copied_benchmark(scratch)
    local whole = json_of(t, script, out, data, "--per-frame")
    local shards = {}
    for i = 1, 4 do
      shards[i] = ("%s/%d.json"):format(scratch.path, i)
      json_of(t, script, shards[i], data, "--per-frame", "--shard", i .. "/4")
    end
    t:contains(aib.system.read_text(shards[3]), "a part of a run: depth")
    t:contains(aib.system.read_text(shards[3]), '"name": "crane / COLMAP + SGBM, images 33 to 64"')
    t:check(json_of(t, merge, out, shards[3], shards[1], shards[4], shards[2]) == whole, "the bytes are the same")
    for _, n in ipairs { 2, 3, 16 } do
      local of_n = {}
      for i = 1, n do
        of_n[i] = ("%s/%d_of_%d.json"):format(scratch.path, i, n)
        json_of(t, script, of_n[i], data, "--per-frame", "--results", kept, "--shard", ("%d/%d"):format(i, n))
      end
      t:check(json_of(t, merge, out, table.unpack(of_n)) == whole, ("%d shards, the bytes are the same"):format(n))
    end
    local _, complaints, code = support.aib_lua(merge, shards[1], shards[2], shards[4])
    t:equal(code, 3)
    t:contains(complaints, "shard 3/4 is missing")
    _, complaints, code = support.aib_lua(merge, shards[1], shards[1], shards[2], shards[3], shards[4])
    t:equal(code, 3)
    t:contains(complaints, "comes twice")
    _, complaints = support.aib_lua(merge, out)
    t:contains(complaints, "a shard expected, made by --shard INDEX/COUNT")
    local changed = aib.system.read_text(shards[2]):gsub('"min_coverage": 0.5', '"min_coverage": 0.6')
    aib.system.write_text(shards[2], changed)
    _, complaints, code = support.aib_lua(merge, table.unpack(shards))
    t:equal({ complaints, code }, { ("merge: %s: the shard was changed since it was written\n"):format(shards[2]), 3 })
    for _, words in ipairs { { "--shard", "5/4" }, { "--batch", "COLMAP" }, { "--batch", "COLMAP=0" } } do
      _, complaints, code = support.aib_lua(script, data, table.unpack(words))
      t:equal(code, 2)
      t:contains(complaints, words[1] .. ": ")
      t:contains(complaints, ("found '%s' (see --help)"):format(words[2]))
    end
  end,

  ["the workflow for a cluster, with parts that are killed once, gives the bytes of one run"] = function(t)
    if not os.execute "snakemake --version >/dev/null 2>&1" then t:skip "Snakemake is not installed" end
    local scratch <close> = support.scratch_folder()
    local data, _, out = copied_benchmark(scratch)
    local whole = json_of(t, script, out, data)
    local wrapper = scratch.path .. "/aib-lua"  -- kills the first part that it is asked for
    aib.system.write_text(wrapper, ([[#!/bin/sh
case "$*" in *--shard*) mkdir %s/once 2>/dev/null && exec timeout -s KILL 0.1 %s "$@";; esac
exec %s "$@"
]]):format(scratch.path, support.absolute(support.program()), support.absolute(support.program())))
    assert(os.execute("chmod +x " .. wrapper))
    local ok = os.execute(("snakemake -s %s --directory %s --cores 2 --quiet --config benchmark=%s shards=2" ..
      " out=%s/out aib_lua=%s options='--samples 2000' >/dev/null 2>&1"):format(
      support.quoted(support.absolute(support.root .. "/examples/cluster/Snakefile")), scratch.path, data, scratch.path,
      wrapper))
    t:check(ok, "the workflow ends well")
    t:check(aib.system.read_text(scratch.path .. "/out/all.json") == whole, "the bytes are the same")
  end,

  ["an unbatched method is cut into batches where that is asked for"] = function(t)
    local report = support.protocol("asset_inspection"):run {
      benchmark = support.root .. "/examples/data", samples = 2000, batch = { "COLMAP + SGBM=10" },
    }
    local found, whole, n_batches = {}, {}, 0
    for _, r in ipairs(report:records()) do
      if r.group.scene == "crane" and r.group.method == "COLMAP + SGBM" and not r.group.model then
        whole[r.name] = r.value
      end
      if r.group.scene == "crane" and r.group.method == "COLMAP + SGBM, batches of 10" then
        if not r.group.batch then found[r.name] = r.value end
        if r.group.batch and r.name == "align.scale" then n_batches = n_batches + 1 end
      end
    end
    t:check(n_batches >= 3)
    t:check(found["pose.auc30_intra"] > 0.9 and found["pose.auc30_cross"] > 0.9)
    t:equal(found["depth.srmse"], whole["depth.srmse"])  -- of a logarithm, less its mean: no scale is in it
    t:near(found["depth.abs_rel"], whole["depth.abs_rel"], 0.01)
    t:check(found["depth.abs_rel"] ~= whole["depth.abs_rel"])
    t:check(found["cloud.chamfer"] > 0 and found["cloud.f1_distance"] <= found["cloud.chamfer"] / 2)
  end,

  ["soiling: paired differences say how sensitive a method is"] = function(t)
    local report = support.protocol("asset_inspection"):run {
      benchmark = support.root .. "/examples/data", samples = 2000,
    }
    local found, of_glomap = {}, {}
    for _, r in ipairs(report:records()) do
      if r.group.contrast and r.group.method == "SGBM, true poses" then found[r.name] = r end
      if r.group.contrast and r.group.method == "GLOMAP" then of_glomap[r.name] = r end
    end
    t:equal(found["sensitivity.srmse_change"].n, 16)
    t:check(found["sensitivity.srmse_change_low"].value < found["sensitivity.srmse_change"].value)
    t:near(found["sensitivity.srmse_slope"].value, found["sensitivity.srmse_change"].value, 1e-15)  -- two levels
    t:near(found["sensitivity.srmse_within"].value, -found["sensitivity.srmse_change_low"].value, 1e-15)
    for _, metric in ipairs { "coverage", "abs_rel", "delta1" } do
      t:equal(found[("sensitivity.%s_slope"):format(metric)].n, 16)
    end
    t:equal(of_glomap["sensitivity.registration_rate_change"].n, 61)
    t:near(of_glomap["sensitivity.registration_rate_change"].value, 1 / 61, 1e-12)  -- 60 of 61 images, then all
    t:equal({ of_glomap["sensitivity.ape_within"].unit, of_glomap["sensitivity.ape_within"].n }, { "m", 60 })
    t:equal(of_glomap["sensitivity.focal_mre_change"], nil)  -- of one camera: nothing of single images
  end,
}
