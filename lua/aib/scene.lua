-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The ground truth of a scene as a table of patterns:
---
---   poses    trajectory with image names (transforms.json, a COLMAP model, ...)
---   cameras  cameras file, or { width =, height =, focal = pixels }; default: what the poses' source says
---   names    list of the images expected (default: those of the poses)
---   depth    pattern of depth maps, {stem} and {name} stand for the image
---   mesh     triangle mesh          points   point cloud        labels   pattern of label images
---   crop     { min = {x, y, z}, max = {x, y, z} }: the part of space that is scored, in mesh samples, points and
---            what methods made
---
---   local scene = aib.scene.open { folder = "office", poses = "transforms.json", depth = "depth/{stem}.exr" }
---   for _, name in ipairs(scene.names) do local depth = scene.depth(name) end
local aib = require "aib"
local clouds = require "aib.evaluation.clouds"
local failure = require "aib.failure"
local suggest = require "aib.suggest"

local M = {}

local fields <const> = {
  folder = true, name = true, conditions = true, poses = true, cameras = true, names = true, depth = true, mesh = true,
  points = true, labels = true, crop = true, samples = true,
}

--- Reads a point cloud that has points. Raises a format error where it has none.
function M.read_cloud(files, name) return clouds.read(files:file(name)) end

--- What a scene reads when it is first asked for.
local readers = {}

function readers.trajectory(scene)
  return scene.spec.poses and aib.io.read_trajectory(scene.files:any(scene.spec.poses))
end

function readers.names(scene)
  if scene.spec.names then return scene.spec.names end
  local trajectory = scene.trajectory
  if not trajectory or #trajectory.names == 0 then
    failure.raise("format", ("%s: image names expected, found poses without"):format(
      scene.files:path(scene.spec.poses or "poses")))
  end
  return trajectory.names
end

function readers.cameras(scene)
  local source = scene.spec.cameras or scene.spec.poses
  if type(source) ~= "string" then return source end
  return aib.io.read_cameras(scene.files:any(source))
end

function readers.mesh(scene) return scene.spec.mesh and aib.io.read_mesh(scene.files:file(scene.spec.mesh)) end

function readers.points(scene)
  if not scene.spec.points then return nil end
  return M.cropped(scene, M.read_cloud(scene.files, scene.spec.points))
end

--- Names of the images that have a depth map.
function readers.depth_names(scene)
  return scene.spec.depth and scene.files:present(scene.spec.depth, scene.names) or {}
end

--- The part of a cloud, in the scene's frame, inside the crop box.
function M.cropped(scene, cloud)
  local box = scene.spec.crop
  return box and aib.cloud.crop(cloud, box) or cloud
end

--- Opens a scene: names, trajectory, cameras, mesh, points, depth_names are read at their first use; depth(name) reads
--- one depth map. `files` (aib.files) remembers what was read; depth(name, files) remembers it there instead.
function M.open(spec, files)
  if type(spec) == "string" then spec = { folder = spec, poses = "transforms.json", depth = "depth/{stem}.exr" } end
  suggest.check_keys("aib.scene.open", spec, fields, 2)
  local scene = { spec = spec, files = files or aib.files.new(spec.folder or ".") }
  function scene.depth(name, to) return aib.io.read_depth((to or scene.files):frame(spec.depth, name)) end
  return setmetatable(scene, { __index = function(self, key)
    local reader = readers[key]
    if not reader then return nil end
    local value = reader(self)
    rawset(self, key, value)
    return value
  end })
end

return M
