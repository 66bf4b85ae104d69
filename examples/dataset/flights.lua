-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The flights round the three assets, as paths of aib.survey, at three scales:
---
---   paper   1920 x 1080, exactly the paper's 4763, 642 and 1074 frames
---   small   960 x 540, some hundred frames from further away
---   tiny    320 x 180, 24 frames of an arc from which the whole asset is seen
local aib = require "aib"

local M = {}

M.sizes = { paper = { 1920, 1080 }, small = { 960, 540 }, tiny = { 320, 180 } }

function M.camera(scale) return aib.survey.camera { width = M.sizes[scale][1], height = M.sizes[scale][2] } end

local function corners(box)
  local low, high = box.low, box.high
  return { { low[1], low[2] }, { high[1], low[2] }, { high[1], high[2] }, { low[1], high[2] } }
end

--- Horizontal direction of sight of a camera at an azimuth as seen from the asset.
local function towards(azimuth_deg) return { -math.cos(math.rad(azimuth_deg)), -math.sin(math.rad(azimuth_deg)), 0 } end

local office = { name = "office" }

--- Rows round all facades, then lanes over the roof, above the antenna.
function office.paper(asset, camera)
  local facade = aib.survey.facade { camera = camera, footprint = corners(asset), low = 0.3, high = asset.high[3],
    stand_off = 6.5 }
  local roof = aib.survey.linear { camera = camera, from = { -13, 0, 14 }, to = { 13, 0, 14 },
    views = { { 0, 0, -1 } }, width = 19, stand_off = 8.5 }
  return aib.survey.join { facade, roof }, { frames = 4763, min_distance = 2 }
end

function office.small(asset, camera)
  local facade = aib.survey.facade { camera = camera, footprint = corners(asset), low = 0, high = asset.high[3],
    stand_off = 13, overlap_across = 0.6, sides = { 1, 2 }, pitch = 5 }
  return facade, { frames = 250, min_distance = 2 }
end

function office.tiny(_, camera)
  return aib.survey.orbit { camera = camera, centre = { 0, 0 }, radius = 31, low = 19, look_at = 7.5,
    start = -125, sweep = 100 }, { frames = 24, min_distance = 2 }
end

local crane = { name = "crane" }

--- Up and down the mast from some of eight directions, none of them that of a jib.
local function mast_of(asset, n_views, options)
  options.views, options.radius = {}, asset.high[1]
  for k = 1, n_views do options.views[k] = towards(22.5 + 45 * (k - 1)) end
  return aib.survey.linear(options)
end

--- All round the mast, then along both sides of the jib.
function crane.paper(asset, camera, scene)
  local mast = mast_of(asset, 8, { camera = camera, from = { 0, 0, 1 }, to = { 0, 0, asset.high[3] - 1 },
    stand_off = 6 })
  local jib = aib.survey.linear { camera = camera, from = scene.jib.to, to = scene.jib.from, radius = 0.6,
    stand_off = 6, views = { { 0, 1, -0.4 }, { 0, -1, -0.4 } } }
  return aib.survey.join { mast, jib }, { frames = 642, min_distance = 1.5 }
end

function crane.small(asset, camera)
  local mast = mast_of(asset, 4, { camera = camera, from = { 0, 0, 3 }, to = { 0, 0, asset.high[3] }, stand_off = 9,
    pitch = 10 })
  return mast, { frames = 200, min_distance = 1.5 }
end

function crane.tiny(_, camera)
  return aib.survey.orbit { camera = camera, centre = { 4, 0 }, radius = 34, low = 39, look_at = 15,
    start = -130, sweep = 100 }, { frames = 24, min_distance = 2 }
end

local bridge = { name = "bridge" }

--- Lanes along one side from the crown of the arch down to the deck, below the deck, up the other side, over the road.
function bridge.paper(asset, camera, scene)
  local low, high = asset.low, asset.high
  local function side(y, from, to)
    local middle = (low[3] + high[3]) / 2
    return aib.survey.linear { camera = camera, from = { from, 0, middle }, to = { to, 0, middle },
      views = { { 0, y, 0 } }, width = high[3] - low[3], radius = high[2], stand_off = 7.5, overlap_across = 0.5 }
  end
  local girders = scene.deck - 1.2
  local below = aib.survey.linear { camera = camera, from = { -21, 0, girders }, to = { 21, 0, girders },
    views = { { 0, 0.35, 1 } }, stand_off = 5.2 }
  local above = aib.survey.linear { camera = camera, from = { high[1], 0, scene.deck }, to = { low[1], 0, scene.deck },
    views = { { 0, 0, -1 } }, stand_off = 15 }
  local path = aib.survey.join { side(1, low[1], high[1]):reversed(), below, side(-1, high[1], low[1]), above }
  return path, { frames = 1074, min_distance = 1.5 }
end

function bridge.small(asset, camera, scene)
  local side = aib.survey.linear { camera = camera, from = { asset.low[1], 0, scene.deck + 4 },
    to = { asset.high[1], 0, scene.deck + 4 }, views = { { 0, 1, -0.3 } }, width = 12, radius = asset.high[2],
    stand_off = 14, overlap_across = 0.5 }
  return side, { frames = 140, min_distance = 1.5 }
end

function bridge.tiny(_, camera, scene)
  return aib.survey.orbit { camera = camera, centre = { 0, 0 }, radius = 44, low = scene.deck + 17,
    look_at = scene.deck + 1, start = -135, sweep = 80 }, { frames = 24, min_distance = 2 }
end

local flights <const> = { office = office, crane = crane, bridge = bridge }

--- Plans the flight of a scene (see scenes/) at a scale: a plan of aib.survey. `mesh` is kept away from, where given.
function M.plan(scene, scale, mesh)
  local path, options = flights[scene.name][scale](scene.asset, M.camera(scale), scene)
  options.mesh = mesh
  if not mesh then options.min_distance = nil end
  return aib.survey.fly(path, options)
end

return M
