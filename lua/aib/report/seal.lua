-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The hash of a result (as a table) with a shard, but for the field of the shard that holds it.
local json = require "aib.json"
local suggest = require "aib.suggest"
local system = require("aib").system

return function(result)
  local shard = suggest.with(result.shard)
  shard.sha256 = nil
  return system.sha256(json.encode(suggest.with(result, { shard = shard })))
end
