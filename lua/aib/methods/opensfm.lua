-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- OpenSfM and OpenDroneMap: reconstruction.json (the largest component), in the folder or in opensfm/. Depth maps that
--- OpenMVS made in opensfm/undistorted/openmvs are of undistorted images, with poses and cameras of their own: that
--- folder is one of OpenMVS.
local aib = require "aib"
local kit = require "aib.methods.kit"

local places <const> = { "reconstruction.json", "opensfm/reconstruction.json" }
local clouds <const> = {
  "odm_filterpoints/point_cloud.ply", "undistorted/depthmaps/merged.ply", "opensfm/undistorted/depthmaps/merged.ply",
}

return {
  kind = "opensfm",
  find = function(folder) return kit.first_of(folder, places) end,
  open = function(folder)
    local place = kit.first_of(folder, places)
    local path = folder .. "/" .. place
    local trajectory, cloud = aib.io.read_trajectory(path), kit.first_of(folder, clouds)
    local names = trajectory.names
    local maps = folder .. "/" .. place:gsub("reconstruction%.json$", "undistorted/depthmaps")
    local openmvs = place:gsub("reconstruction%.json$", "undistorted/openmvs")
    local has_openmvs = #kit.numbered(folder .. "/" .. openmvs, "^depth(%d+)%.dmap$") > 0
    local function map_of(name) return ("%s/%s.clean.npz"):format(maps, name) end
    return {
      names = names, named = true, trajectory = trajectory, cameras = aib.io.read_cameras(path),
      points = cloud and kit.cloud(folder .. "/" .. cloud) or nil,
      warnings = has_openmvs and { openmvs .. ": depth maps of OpenMVS; open that folder to have them" } or nil,
      depth = aib.system.is_folder(maps) and function(i)
        local map = map_of(names[i])
        return aib.system.is_file(map) and aib.io.read_depth(map, { key = "depth" }) or nil
      end or nil,
    }
  end,
}
