-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What --json writes is what results.schema.json says.
local aib = require "aib"
local schema = require "aib.schema"
local support = require "support"

local path <const> = support.root .. "/lua/aib/results.schema.json"
local rules <const> = aib.json.decode(aib.system.read_text(path), path)

local function results_of(...)
  local report = support.protocol("asset_inspection"):run(...)
  return aib.json.decode(require "aib.report.json"(report))
end

return aib.test {
  ["results, with numbers of frames and details, follow the schema"] = function(t)
    local result = results_of { benchmark = support.root .. "/examples/data", samples = 2000, per_frame = true,
      details = true }
    t:equal(schema.mistake(result, rules), nil)
    t:check(#result.records > 300)
    local metrics = {}
    for _, frames in ipairs(result.frames) do metrics[frames.metric] = (metrics[frames.metric] or 0) + 1 end
    t:equal({ metrics["depth.srmse"], metrics["pose.ape_rmse"], metrics["pose.registration_rate"] }, { 5, 6, 6 })
  end,

  ["a shard follows the schema"] = function(t)
    local result = results_of { benchmark = support.root .. "/examples/data", samples = 2000, shard = "2/4" }
    t:equal(schema.mistake(result, rules), nil)
    t:equal(result.shard.n_parts, 21)
  end,

  ["the schema refuses what is none"] = function(t)
    local result = { aib = { format = 1, version = "1" }, protocol = { name = "p" }, records = {} }
    t:equal(schema.mistake(result, rules), nil)
    result.records[1] = { name = "x", value = "1" }
    t:equal(schema.mistake(result, rules), "records[1].value: number or null expected, found '1'")
    result.records[1] = { name = "x", value = 1, extra = 1 }
    t:contains(schema.mistake(result, rules), "records[1]: unknown field 'extra'")
    result.records[1], result.aib.format = nil, 2
    t:equal(schema.mistake(result, rules), "aib.format: 1 expected, found 2")
    result.aib = nil
    t:equal(schema.mistake(result, rules), "aib is missing")
  end,
}
