-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Reads all that the output of a method holds.
local aib = require "aib"

local method = aib.method.open(arg[1])
for _, batch in ipairs(method.batches) do
  for i in ipairs(batch.names) do
    if batch.depth then batch.depth(i) end
    if batch.confidence then batch.confidence(i) end
  end
end
print(method.kind, #method.batches)
