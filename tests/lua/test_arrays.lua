-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

local aib = require "aib"
local io_ = aib.io

local function written_and_read(value)
  local path = os.tmpname()
  io_.write_array(path, value)
  local array = io_.read_array(path)
  os.remove(path)
  return array
end

return aib.test {
  ["lists of numbers become arrays"] = function(t)
    t:equal(tostring(io_.array { 1, 2, 3 }), "array(f8 (3,))")
    t:equal(io_.array({ { 1, 2 }, { 3, 4 }, { 5, 6 } }).shape, { 3, 2 })
    t:equal(io_.array({ { 1, 2 }, { 3, 4 } }):to_table(), { 1, 2, 3, 4 })
    t:equal(io_.array({}).shape, { 0 })
  end,

  ["lists of different sizes are refused"] = function(t)
    local what = "aib.io.array: numbers, or lists of numbers of one size, expected"
    t:raises(what, io_.array, { { 1, 2 }, { 3 } })
    t:raises(what, io_.array, { 1, { 2 } })
    t:raises(what, io_.array, { { 1, 2 }, { { 1 }, { 2 } } })
    t:raises("distances, cloud, depth_map, trajectory or list of numbers expected", io_.array, "1 2 3")
  end,

  ["the library's objects are handed over as arrays"] = function(t)
    local cloud = aib.cloud.from_points { { 1, 2, 3 }, { 500000.25, 5, 6 } }
    local points = written_and_read(cloud)
    t:equal(points.shape, { 2, 3 })
    t:equal(points.dtype, "f8")
    t:equal(points:to_table(), { 1, 2, 3, 500000.25, 5, 6 })

    local distances = written_and_read(aib.cloud.distances(cloud, cloud))
    t:equal(distances:to_table(), { 0, 0 })
    t:equal(distances.dtype, "f4")
  end,

  ["a part of anything that has elements is a table"] = function(t)
    local array = io_.array { 1, 2, 3, 4, 5 }
    t:equal(array:to_table(2), { 2, 3, 4, 5 })
    t:equal(array:to_table(2, 3), { 2, 3 })
    t:equal(array:to_table(-2), { 4, 5 })
    t:equal(array:to_table(1, -4), { 1, 2 })
    t:equal(array:to_table(4, 2), {})
    t:equal(array:to_table(-9, 9), { 1, 2, 3, 4, 5 })
    t:raises("number", array.to_table, array, "two")
  end,
}
