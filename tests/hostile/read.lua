-- Reads one file with every reader that takes its format, and prints what it holds.
--   aib-lua read.lua FORMAT PATH
local aib = require "aib"

local function arrays(path)
  local read = {}
  for _, name in ipairs(aib.io.array_names(path)) do
    local ok, array = pcall(aib.io.read_array, path, { key = name })
    if ok then read[#read + 1] = name .. " " .. tostring(array) end
  end
  if #read == 0 then return aib.io.read_array(path) end
  return table.concat(read, ", ")
end

-- An image with colours is no depth: its first channel is read instead.
local function depth(path)
  local ok, read = pcall(aib.io.read_depth, path)
  if ok then return read end
  local channel = tostring(read):match "name one of ([^,]+)"
  if not channel then error(read, 0) end
  return aib.io.read_depth(path, { channel = channel })
end

local function poses(format)
  return function(path) return aib.io.read_trajectory(path, { format = format }) end
end

local readers = {
  ply = aib.io.read_cloud,
  obj = aib.io.read_mesh,
  stl = aib.io.read_mesh,
  exr = depth,
  pfm = aib.io.read_depth,
  png = aib.io.read_depth,
  npy = aib.io.read_array,
  npz = arrays,
  tum = poses "tum",
  kitti = poses "kitti",
  ["transforms.json"] = aib.io.read_trajectory,
  colmap_model_dir = function(path) return aib.io.read_colmap(path).trajectory end,
}

local format, path = ...
print(readers[format](path))
