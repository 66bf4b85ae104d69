-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Flights and renderings as scripts ask for them.
local aib = require "aib"

--- A wall of 40 x 10 at y = 0, seen from -y.
local function wall()
  local path = os.tmpname() .. ".obj"
  local file <close> = assert(io.open(path, "w"))
  file:write("v -20 0 0\nv 20 0 0\nv 20 0 10\nv -20 0 10\nf 1 2 3\nf 1 3 4\n")
  file:close()
  local mesh = aib.io.read_mesh(path)
  os.remove(path)
  return mesh
end

local camera = aib.survey.camera { width = 96, height = 54 }

local function pass(options)
  options.camera, options.from, options.to, options.views = camera, { -10, 0, 5 }, { 10, 0, 5 }, { { 0, 1, 0 } }
  return aib.survey.linear(options)
end

return aib.test {
  ["a stand-off is told in metres or by the size of a pixel"] = function(t)
    local fx = camera.fx
    t:equal(camera.width, 96)
    t:near(fx, 96 * 50 / 36, 1e-9)
    t:near(pass { gsd_mm = 30 }.stand_off, 0.03 * fx, 1e-9)
    t:raises("stand_off is given", function() pass { gsd_mm = 30, stand_off = 4 } end)
  end,

  ["frames or overlap, not both"] = function(t)
    local path = pass { stand_off = 5 }
    t:equal(#aib.survey.fly(path, { frames = 642, name = "img_%04d.jpg" }).trajectory, 642)
    t:equal(aib.survey.fly(path, { frames = 3, name = "img_%04d.jpg" }).trajectory.names[3], "img_0002.jpg")
    t:raises("one of the two", function() aib.survey.fly(path, { frames = 3, overlap = 0.8 }) end)
    t:raises("one %06d", function() aib.survey.fly(path, { name = "%s" }) end)
  end,

  ["the report of a flight along a wall is what was planned"] = function(t)
    local plan = aib.survey.fly(pass { stand_off = 5 }, { overlap = 0.7 })
    local report = aib.survey.measure(plan.trajectory, plan.cameras, wall(), { samples = 500 })
    t:near(report.overlap.mean, plan.overlap, 0.03)
    t:near(report.gsd_mm.median, plan.gsd_mm, 1e-3)
    t:near(report.area, 400, 1e-9)
    t:near(report.unseen_area, 400 * (1 - report.coverage[1]), 1e-9)
    t:equal(report.hit_share, 1.0)
    t:equal(#report.off_normals, plan.n_frames)
    t:near(report.off_normal.max, 0, 1e-9)
  end,

  ["a view that turns too fast for the gimbal waits for it, or lags behind"] = function(t)
    local path = aib.survey.along { camera = camera, stand_off = 5, points = { { 0, 0, 0 }, { 2, 0, 0 } },
      views = { { 0, 1, 0 }, { 1, 0, 0 } } }
    local slow = aib.survey.fly(path, { frames = 10, gimbal_rate = 30 })
    t:equal({ slow.n_gimbal_limited, slow.largest_view_lag }, { 9, 0.0 })
    t:near(slow.duration, 3, 1e-6)
    t:near(slow.gimbal_delay, 2, 1e-6)
    local lag = aib.survey.fly(path, { frames = 10, gimbal_rate = 30, gimbal = "lag" })
    t:near(lag.duration, 1, 1e-6)
    t:near(lag.view_lags[10], 60, 1e-6)
  end,

  ["a footprint may turn inwards, but not cross itself"] = function(t)
    local l_shape = { { 0, 0 }, { 20, 0 }, { 20, 10 }, { 10, 10 }, { 10, 20 }, { 0, 20 } }
    local path = aib.survey.facade { camera = camera, footprint = l_shape, low = 0, high = 1, stand_off = 3 }
    t:near(path.length, 80 - 6 + 5 * 3 * math.pi / 2, 1e-9)
    l_shape[2], l_shape[4] = l_shape[4], l_shape[2]
    t:raises("meets another one", function()
      aib.survey.facade { camera = camera, footprint = l_shape, low = 0, high = 1, stand_off = 3 }
    end)
  end,

  ["a frame of a wall is its distance, normal and label"] = function(t)
    local scene = aib.render.scene(wall())
    local pose = pass { stand_off = 5 }:at(0.5)
    local frame = aib.render.frame(scene, camera, pose, { background = 7 })
    t:near(frame.depth:at(40, 20), 5, 1e-6)
    t:equal(frame.n_hit, 96 * 54)
    t:equal(frame.labels:at(1, 1), 0)
    t:equal(frame.normals.shape, { 54, 96, 3 })
    t:near(aib.render.depth(scene, camera, pose, { kind = "range" }):at(1, 1), frame.range:at(1, 1), 0)
    t:equal(aib.render.depth(scene, camera, pose, { width = 48, height = 27 }).width, 48)
    local behind = aib.math.pose { rotation = pose.rotation, centre = { 0, 5, 5 } }
    t:equal(aib.render.frame(scene, camera, behind, { background = 7 }).labels:at(1, 1), 7)
    t:raises("a mesh or a render scene expected", function() aib.render.depth(camera, camera, pose) end)
  end,

  ["frames go into a folder, and a stopped run is taken up"] = function(t)
    local folder = os.tmpname()
    os.remove(folder)
    local plan = aib.survey.fly(pass { stand_off = 5 }, { frames = 3, name = "a/%03d.png" })
    local function render(options)
      options.folder = folder
      return aib.render.frames(wall(), plan.trajectory, camera, options)
    end
    local all = { "depth", "range", "normals", "labels" }
    local first = render { maps = all, frames = { 1, 3 } }
    t:equal({ first.n_frames, first.n_kept, #first.files }, { 2, 0, 8 })
    t:equal(first.files[2], folder .. "/range/a/000.exr")
    local second = render { maps = all, existing = "keep" }
    t:equal({ second.n_frames, second.n_kept }, { 1, 2 })
    t:near(aib.io.read_depth(folder .. "/depth/a/001.exr"):at(40, 20), 5, 1e-6)
    t:equal(aib.io.read_image(folder .. "/labels/a/002.png"):at(1, 1), 0)
    t:equal(aib.io.read_array(folder .. "/normals/a/000.npy").shape, { 54, 96, 3 })
    plan.trajectory = aib.survey.fly(pass { stand_off = 5 }, { frames = 2, name = "../%d.png" }).trajectory
    t:raises("is no name of an image", function() render {} end)
    t:raises("'folder'", function() aib.render.frames(wall(), plan.trajectory, camera, {}) end)
    os.execute("rm -r " .. folder)
  end,

  ["telemetry is wrong by what is asked for"] = function(t)
    local plan = aib.survey.fly(pass { stand_off = 5 }, { frames = 20 })
    local prior = aib.survey.perturb(plan.trajectory, { position_bias = { 0, 0, 2 }, dropout = 0.5 })
    local n = 0
    for i = 1, 20 do
      if prior[i].is_registered then
        n = n + 1
        t:near(prior[i].centre[3], plan.trajectory[i].centre[3] + 2, 1e-9)
      end
    end
    t:equal(n > 2 and n < 18, true)
    local drifted = aib.survey.perturb_cameras(camera, prior.names, { focal_bias = 0.1 })
    t:near(drifted["000003.png"].fx, 1.1 * camera.fx, 1e-9)
  end,
}
