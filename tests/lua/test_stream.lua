-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

local aib = require "aib"

--- A file with points on a line.
local function line(n, step)
  local points, path = {}, os.tmpname()
  for i = 1, n do points[i] = { i * step, 0, 0 } end
  aib.io.write_cloud(path .. ".ply", aib.cloud.from_points(points))
  os.remove(path)
  return path .. ".ply"
end

return aib.test {
  ["files compare as clouds in memory do, and progress is told"] = function(t)
    local est, ref = line(3000, 0.1), line(2000, 0.15)
    local share = 0
    local found = aib.stream.compare_clouds(est, ref, {
      memory = "20 MB", tau = 0.06, progress = function(s) share = s end,
    })
    t:equal(found, aib.cloud.compare(aib.io.read_cloud(est), aib.io.read_cloud(ref), { tau = 0.06 }))
    t:equal(share, 1)
    t:raises("memory", aib.stream.compare_clouds, est, ref, { memory = "much" })
    t:raises("or more expected", aib.stream.compare_clouds, est, ref, { memory = "1KB" })
    os.remove(est)
    os.remove(ref)
  end,
}
