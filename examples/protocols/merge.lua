-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Puts the shards of an evaluation together: the same bytes as one run would have given.
---
---   aib-lua asset_inspection BENCHMARK --shard 1/2 --json a.json
---   aib-lua asset_inspection BENCHMARK --shard 2/2 --json b.json
---   aib-lua merge a.json b.json --json all.json
local aib = require "aib"
local failure = require "aib.failure"

--- Folder of this script; a sandbox does not tell it, but there a script is called by its path.
local here <const> = (debug.getinfo and debug.getinfo(1, "S").source:sub(2) or arg[0]):match "^(.*)/[^/]*$" or "."

--- The protocol that made a shard, from beside this one.
local function protocol_of(result, path)
  local name = result.protocol.name
  local load_it = name:find "^[%w_]+$" and loadfile(("%s/%s.lua"):format(here, name))
  local protocol = load_it and load_it()
  if not protocol or not protocol.finish then
    failure.raise("format", ("%s: no protocol '%s' whose shards can be merged"):format(path, name))
  end
  return protocol
end

return aib.protocol {
  name = "merge",
  title = "Merged shards",
  help = "Puts the shards of one evaluation together, in any order.",
  inputs = {
    shards = { kind = "list", of = "path", position = 1, help = "what --shard INDEX/COUNT --json FILE wrote" },
  },
  run = function(input, report)
    local shards = {}
    for i, path in ipairs(input.shards) do shards[i] = { path = path, result = aib.results.read(path) } end
    local parts, first = aib.units.joined(shards), shards[1].result
    local protocol = protocol_of(first, shards[1].path)
    report.name, report.title, report.cite = protocol.name, protocol.title, protocol.cite
    report.store.inputs = first.inputs
    protocol.finish(first.inputs, report, parts, aib.files.new ".")
  end,
}
