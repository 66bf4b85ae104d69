-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The evaluation of the DTU benchmark: the reconstruction thinned to a density, within the observability mask;
--- distances of 20 mm and more dropped; accuracy, completeness and their mean ("overall").
---
---   aib-lua dtu scan1.ply stl001_total.ply --mask ObsMask1_10.npz --plane Plane1.npz
---
--- Masks and planes are MATLAB files; Python makes NPZ files of them:
---   m = scipy.io.loadmat("ObsMask1_10.mat")
---   numpy.savez("ObsMask1_10.npz", ObsMask=m["ObsMask"], BB=m["BB"], Res=m["Res"])
---   numpy.savez("Plane1.npz", P=scipy.io.loadmat("Plane1.mat")["P"])
--- Which points thinning keeps depends on its order, which the official script does not seed; here --seed does.
local aib = require "aib"
local clouds = require "aib.evaluation.clouds"
local drawings = require "aib.evaluation.drawings"

local function numbers_of(array)
  local numbers = {}
  for i = 1, #array do numbers[i] = array[i] end
  return numbers
end

--- The mask as volumes: the box, wider than it by one patch below and two above, and the grid of what was observed.
local function read_mask(path, patch)
  local bb = numbers_of(aib.io.read_array(path, { key = "BB" }))
  local resolution = aib.io.read_array(path, { key = "Res" })[1]
  local low, high = { bb[1], bb[2], bb[3] }, { bb[4], bb[5], bb[6] }
  local box = { min = {}, max = {} }
  for k = 1, 3 do box.min[k], box.max[k] = low[k] - patch, high[k] + 2 * patch end
  return box, { grid = aib.io.read_array(path, { key = "ObsMask" }), min = low, resolution = resolution }
end

return aib.protocol {
  name = "dtu",
  title = "DTU multi-view stereo evaluation",
  cite = "Aanæs et al., Large-scale data for multiple-view stereopsis, IJCV 2016",
  inputs = {
    estimate = { kind = "file", position = 1, help = "reconstructed cloud" },
    reference = { kind = "file", position = 2, help = "structured light scan" },
    mask = { kind = "path", default = "", help = "ObsMask, BB and Res (.npz); without, all counts" },
    plane = { kind = "path", default = "", help = "P of the table (.npz); without, all of the scan counts" },
    density = { kind = "number", unit = "mm", default = 0.2, min = 0, help = "no two points nearer; 0: not thinned" },
    patch = { kind = "number", unit = "mm", default = 60, min = 0, help = "margin of the mask's box" },
    max_distance = { kind = "number", unit = "mm", default = 20, above = 0,
      help = "distances from here on are dropped" },
    seed = { kind = "integer", default = 1, min = 0, help = "of the thinning" },
  },
  run = function(input, report)
    local estimate, reference = clouds.read(input.estimate), clouds.read(input.reference)
    if input.density > 0 then
      estimate = aib.sample.thin(estimate, { spacing = input.density, seed = input.seed })
    end
    local observed, above = estimate, reference
    if input.mask ~= "" then
      local box, grid = read_mask(input.mask, input.patch)
      estimate = aib.cloud.crop(estimate, box)
      observed = aib.cloud.crop(estimate, grid)
    end
    if input.plane ~= "" then
      above = aib.cloud.crop(reference, { plane = numbers_of(aib.io.read_array(input.plane, { key = "P" })) })
    end
    local cut = { max_distance = input.max_distance }
    local to_reference = aib.cloud.distances(observed, reference, cut)
    local to_estimate = aib.cloud.distances(above, estimate, cut)
    local function add(name, value, n)
      report:add("dtu." .. name, value, { unit = "mm", better = "lower", n = n,
        options = { density = input.density, max_distance = input.max_distance } })
    end
    add("accuracy", to_reference:mean(), #to_reference)
    add("completeness", to_estimate:mean(), #to_estimate)
    add("overall", (to_reference:mean() + to_estimate:mean()) / 2, #to_reference)
    drawings.points(report, observed, { reference = above }, to_reference, to_estimate, { 1 }, "mm")
    report:add("dtu.accuracy_beyond", to_reference:share_beyond(), { better = "lower", n = #to_reference })
    report:add("dtu.completeness_beyond", to_estimate:share_beyond(), { better = "lower", n = #to_estimate })
  end,
}
