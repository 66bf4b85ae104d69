-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The hash of a result (as a table) with a shard, but for the field of the shard that holds it.
local json = require "aib.json"
local system = require("aib").system

return function(result)
  local sealed = { shard = {} }
  for key, value in pairs(result) do sealed[key] = sealed[key] or value end
  for key, value in pairs(result.shard) do sealed.shard[key] = key ~= "sha256" and value or nil end
  return system.sha256(json.encode(sealed))
end
