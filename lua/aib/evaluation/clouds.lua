-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Clouds that protocols compare: how they are read, and what is written of their distances.
local aib = require "aib"
local failure = require "aib.failure"

local M = {}

--- Reads a point cloud that has points. Raises a format error where it has none.
function M.read(path)
  local cloud = aib.io.read_cloud(path)
  if #cloud == 0 then failure.raise("format", path .. ": points expected, found none") end
  return cloud
end

--- Writes a cloud as PLY in the colours of its errors, from 0 to `high`, and with them.
function M.write_colored(path, cloud, errors, high)
  aib.io.write_cloud(path, aib.cloud.colored(cloud, errors, { max = high }), { scalars = { error = errors } })
end

--- Writes precision, recall and F-score at `steps` thresholds up to `high` as CSV.
function M.write_curve(path, to_reference, to_estimate, high, steps)
  local curve = aib.cloud.curve(to_reference, to_estimate, { max = high, steps = steps })
  local lines = { "tau,precision,recall,f_score" }
  for i, tau in ipairs(curve.tau) do
    lines[i + 1] = ("%.9g,%.9g,%.9g,%.9g"):format(tau, curve.precision[i], curve.recall[i], curve.f_score[i])
  end
  aib.system.write_text(path, table.concat(lines, "\n") .. "\n")
end

return M
