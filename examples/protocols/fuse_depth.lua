-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Makes one cloud of a folder of depth maps and their poses, frame by frame: a point for each voxel, or all of them.
--- Memory grows with the voxels, not with the frames.
---
---   aib-lua fuse_depth method/depth method/sparse --out cloud.ply --voxel 0.02 --confidence method/conf --min 0.75
local aib = require "aib"
local depth_frames = require "aib.depth_frames"
local failure = require "aib.failure"
local suggest = require "aib.suggest"

--- Pose and camera of every registered image, under the stem of its name.
local function by_stem(trajectory, cameras)
  local lost, poses = suggest.set(aib.pose.registration_rate(trajectory, trajectory).missing), {}
  for i, name in ipairs(trajectory.names) do
    if not lost[name] and cameras[name] then
      poses[depth_frames.stem(name)] = { pose = trajectory[i], camera = cameras[name] }
    end
  end
  return poses
end

--- Options of aib.sample.unproject for a frame.
local function unproject_options(input, confidences, name)
  local options = { stride = input.stride, pixel_offset = input.pixel_offset, depth = input.meaning }
  if not confidences then return options end
  if not confidences[name] then failure.raise("io", ("%s: nothing of frame '%s'"):format(input.confidence, name)) end
  options.confidence = aib.io.read_depth(confidences[name])
  options.min_confidence, options.rule = input.min, input.rule
  return options
end

--- Where the points of the frames go: voxels of this size, or at 0 all to the file.
local function sink(path, voxel)
  if voxel == 0 then
    local writer = aib.io.cloud_writer(path)
    local finish = function() writer:commit() end
    return { add = function(points) writer:add(points) end, size = function() return #writer end, finish = finish }
  end
  local grid = aib.sample.voxel_grid { size = voxel }
  local finish = function() aib.io.write_cloud(path, grid:cloud()) end
  return { add = function(points) grid:add(points) end, size = function() return #grid end, finish = finish }
end

return aib.protocol {
  name = "fuse_depth",
  title = "One cloud of many depth maps",
  help = "Unprojects every depth map that has a registered pose and thins the points to one a voxel, the mean of those "
    .. "in it; without --voxel all points are written as they come. With --confidence points at most --min sure are "
    .. "left out; the kept share is told.",
  inputs = {
    depth = { kind = "folder", position = 1, help = "folder of depth maps" },
    poses = { kind = "path", position = 2, help = "poses and cameras with image names, any format" },
    out = { kind = "output", help = "PLY file to write" },
    voxel = { kind = "number", unit = "m", default = 0, min = 0, help = "edge of a voxel; 0: every point" },
    pattern = { kind = "path", default = "*", help = 'names of the depth maps, * is the image\'s stem; "*" is any' },
    scale = { kind = "number", default = 0, min = 0, help = "stored value of a metre; 0: the format's own" },
    max_depth = { kind = "number", unit = "m", default = 0, min = 0, help = "it and farther is left out; 0: nothing" },
    stride = { kind = "integer", default = 1, min = 1, help = "every stride-th row and column" },
    pixel_offset = { kind = "number", default = 0.5, help = "where in its pixel a depth lies" },
    meaning = { kind = "choice", choices = { "planar", "range" }, default = "planar", help = "what a depth is" },
    confidence = { kind = "path", default = "", help = "folder of confidence maps of the same names" },
    min = { kind = "number", default = 0, help = "confidence that a point exceeds" },
    rule = { kind = "choice", choices = { "raw", "sigmoid", "percentile" }, default = "raw",
      help = "what a confidence is" },
  },
  run = function(input, report)
    local paths, names = depth_frames.files_in(input.depth, input.pattern)
    local confidences = input.confidence ~= "" and depth_frames.files_in(input.confidence, input.pattern)
    local frames = by_stem(aib.io.read_trajectory(input.poses), aib.io.read_cameras(input.poses))
    local out = sink(input.out, input.voxel)
    local n_frames, n_points, n_valid, n_unsure = 0, 0, 0, 0
    local progress <close> = aib.progress(#names, "frames")
    for _, name in ipairs(names) do
      progress:step(name)
      local frame = frames[name]
      if frame then
        local map <close> = aib.io.read_depth(paths[name], { scale = input.scale,
          max_depth = input.max_depth > 0 and input.max_depth or nil })
        local options = unproject_options(input, confidences, name)
        local points, info = aib.sample.unproject(map, frame.camera, frame.pose, options)
        out.add(points)
        n_points = n_points + #points
        n_frames, n_valid, n_unsure = n_frames + 1, n_valid + info.n_valid, n_unsure + info.n_unsure
      end
    end
    if n_frames == 0 then failure.raise("format", input.poses .. ": no registered pose of any of the depth maps") end
    report:add("fuse.frames", n_frames, { n = #names })
    report:add("fuse.kept_share", n_valid > 0 and 1 - n_unsure / n_valid or nil, { n = n_valid,
      options = { min = input.min, rule = input.rule } })
    report:add("fuse.points", out.size(), { n = n_points, options = { voxel = input.voxel } })
    out.finish()
  end,
}
