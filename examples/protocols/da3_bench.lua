-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The reconstruction scores of Depth Anything 3's benchmark: both clouds thinned on Open3D's lattices, accuracy,
--- completeness, their mean ("overall"), precision, recall and F-score at one threshold.
---
---   aib-lua da3_bench estimate.ply reference.ply --dataset eth3d
---
--- The benchmark fuses depth to a mesh and samples it at random, which cannot be repeated; this begins with a cloud.
local aib = require "aib"
local clouds = require "aib.evaluation.clouds"
local drawings = require "aib.evaluation.drawings"
local failure = require "aib.failure"

--- Threshold and voxel of each data set, metres.
local datasets <const> = {
  eth3d = { threshold = 0.25, voxel = 5 * 4 / 512 },
  ["7scenes"] = { threshold = 0.05, voxel = 4 / 512 },
  hiroom = { threshold = 0.05, voxel = 4 / 512 },
  scannetpp = { threshold = 0.05, voxel = 0.02 },
}

--- What is given, else what the data set has.
local function setting(input, name)
  if input[name] >= 0 then return input[name] end
  local dataset = datasets[input.dataset]
  if not dataset then failure.usage(("--%s or --dataset expected"):format(name)) end
  return dataset[name]
end

return aib.protocol {
  name = "da3_bench",
  title = "Reconstruction as Depth Anything 3's benchmark scores it",
  cite = "Lin et al., Depth Anything 3, 2025",
  inputs = {
    estimate = { kind = "file", position = 1, help = "reconstructed cloud, aligned" },
    reference = { kind = "file", position = 2, help = "cloud of the truth" },
    dataset = { kind = "choice", choices = { "none", "eth3d", "7scenes", "hiroom", "scannetpp" }, default = "none",
      help = "sets threshold and voxel" },
    threshold = { kind = "number", unit = "m", default = -1, help = "of precision, recall; below 0: the data set's" },
    voxel = { kind = "number", unit = "m", default = -1, help = "0: no thinning; below 0: the data set's" },
  },
  run = function(input, report)
    local threshold, voxel = setting(input, "threshold"), setting(input, "voxel")
    local estimate, reference = clouds.read(input.estimate), clouds.read(input.reference)
    if voxel > 0 then
      estimate = aib.sample.voxel(estimate, { size = voxel, anchor = "open3d" })
      reference = aib.sample.voxel(reference, { size = voxel, anchor = "open3d" })
    end
    local to_reference, to_estimate = aib.cloud.distances_both_ways(estimate, reference)
    local c = aib.cloud.score(to_reference, to_estimate, { tau = threshold })
    drawings.points(report, estimate, { reference = reference }, to_reference, to_estimate, { threshold })
    local options = { voxel = voxel, threshold = threshold }
    local function add(name, value, unit, better)
      report:add("da3." .. name, value, { unit = unit, better = better, n = c.n_estimate, options = options })
    end
    add("accuracy", c.accuracy, "m", "lower")
    add("completeness", c.completeness, "m", "lower")
    add("overall", c.chamfer_mean, "m", "lower")
    add("precision", c.precision[threshold], nil, "higher")
    add("recall", c.recall[threshold], nil, "higher")
    add("f_score", c.f_score[threshold], nil, "higher")
  end,
}
