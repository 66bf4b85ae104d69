-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- COLMAP, GLOMAP and exports in their format (VGGT, DA3): a model, or numbered ones of which the largest is taken,
--- with stereo/depth_maps and fused.ply of the dense step where they are there.
---
---   maps   "geometric" | "photometric": which depth maps; default: geometric ones where there are any
local aib = require "aib"
local kit = require "aib.methods.kit"

local function has_model(folder)
  return (kit.first_of(folder, { "cameras.bin", "cameras.txt" }) and
    kit.first_of(folder, { "images.bin", "images.txt" })) ~= nil
end

--- The folder of a model or of numbered models, relative to `folder`.
local function place_of(folder)
  for _, part in ipairs { "", "/sparse", "/dense/sparse", "/dense/0/sparse" } do
    if has_model(folder .. part) then return part end
    for _, number in ipairs(kit.numbered(folder .. part, "^(%d+)$")) do
      if has_model(("%s%s/%s"):format(folder, part, number)) then return part end
    end
  end
end

--- The folder of the dense step.
local function dense_folder(folder)
  for _, part in ipairs { "", "/dense", "/dense/0" } do
    if aib.system.is_folder(folder .. part .. "/stereo/depth_maps") or kit.exists(folder .. part, "fused.ply") then
      return folder .. part
    end
  end
end

--- Files of depth maps by image name.
local function maps_of(dense, names, options)
  local rules = options.maps and { options.maps } or { "geometric", "photometric" }
  for _, rule in ipairs(rules) do
    local files, count = {}, 0
    for _, name in ipairs(names) do
      local path = ("%s/stereo/depth_maps/%s.%s.bin"):format(dense, name, rule)
      if aib.system.is_file(path) then files[name], count = path, count + 1 end
    end
    if count > 0 then return files end
  end
end

return {
  kind = "colmap",
  options = { maps = true },
  find = function(folder)
    local part = place_of(folder)
    if part then return "a COLMAP model in " .. (part == "" and "the folder" or part:sub(2)) end
  end,
  open = function(folder, options)
    local models = aib.submodels.read(folder .. place_of(folder))
    local model = aib.submodels.largest(models)
    local names, dense = model.trajectory.names, dense_folder(folder)
    local maps = dense and maps_of(dense, names, options)
    local batch = {
      names = names, named = true, trajectory = model.trajectory, cameras = model.cameras, model = model.name,
      points = function() return model.points end, warnings = {},
      depth = maps and function(i) return maps[names[i]] and aib.io.read_depth(maps[names[i]]) end or nil,
    }
    if dense and kit.exists(dense, "fused.ply") then batch.points = kit.cloud(dense .. "/fused.ply") end
    if #models > 1 then
      batch.warnings[1] = ("the largest of %d sub-models is taken, number %s"):format(#models, model.name)
    end
    if kit.exists(folder, "sparse/points.ply") then
      batch.warnings[#batch.warnings + 1] = "sparse/points.ply, as VGGT exports: its principal points are the centres"
    end
    return batch
  end,
}
