-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Scores a folder of depth maps against a folder of true ones, frame by frame, with an interval of the mean.
---
---   aib-lua depth da3/depth gt/depth --estimate-pattern "*.npy" --align median --per-frame worst.csv --sheet worst.png
local aib = require "aib"
local depth_frames = require "aib.depth_frames"
local failure = require "aib.failure"

local metrics <const> = { "srmse", "si_log_rmse", "silog", "abs_rel", "sq_rel", "rmse", "mae", "rmse_log", "log10",
  "irmse", "imae", "delta1", "delta2", "delta3", "coverage" }

--- "7=glass" as 7 and "glass".
local function label_names(list)
  local names = {}
  for _, text in ipairs(list) do
    local number, name = text:match("^(%d+)=(.+)$")
    if not number then failure.usage(("--label-names: NUMBER=NAME expected, found '%s'"):format(text)) end
    names[math.tointeger(tonumber(number))] = name
  end
  return names
end

local function add_interval(errors, input, report, how)
  local interval = report:attempt(function()
    return errors:interval { field = input.interval, block = input.block, seed = input.seed }
  end)
  if not interval then return end
  local options = { block = input.block, seed = input.seed, level = 0.95 }
  for _, limit in ipairs { "low", "high" } do
    report:add(("depth.%s_%s"):format(input.interval, limit), interval[limit], {
      n = how.n, convention = "95 % interval of the mean over frames", options = options })
  end
end

--- Means over frames, or over all pixels.
local function add_errors(errors, input, report)
  local result = report:attempt(function() return errors:result { pooled = input.pooled } end, "depth")
  local how = { metrics = metrics, n = result and result.n_defined,
    convention = input.pooled and "all pixels" or "mean over frames",
    options = { align = input.align, align_over = input.align_over, rule = input.rule } }
  depth_frames.report(result, report, how)
  if result and not input.pooled then add_interval(errors, input, report, how) end
  return result
end

return aib.protocol {
  name = "depth",
  title = "Depth maps",
  cite = "Eigen, Puhrsch, Fergus, NeurIPS 2014; Gray et al., A 3D Reconstruction Benchmark for Asset Inspection",
  help = "Errors of depth maps, folder against folder. Truth is brought to the size of the estimate by nearest "
    .. "neighbour; nothing is aligned unless --align is given.",
  inputs = depth_frames.inputs {
    align = { kind = "choice", default = "none", help = "what is fitted to the truth before a frame is scored",
      choices = { "none", "median", "median_lower", "scale", "scale_l1", "scale_shift", "log" } },
    align_over = { kind = "choice", choices = { "frame", "sequence" }, default = "frame", help = "what a fit is over" },
    min_depth = { kind = "number", unit = "m", default = 0, min = 0, help = "truth at it or nearer is left out" },
    max_depth = { kind = "number", unit = "m", default = 0, min = 0, help = "truth at it or beyond is; 0: none is" },
    pooled = { kind = "flag", help = "all pixels as one frame instead of the mean over frames" },
    labels = { kind = "path", default = "", help = "folder of label images, gray PNGs: errors of each label too" },
    label_names = { kind = "list", of = "path", default = {}, help = "what labels are called: 1=glass,2=frame" },
    interval = { kind = "choice", choices = depth_frames.fields, default = "srmse",
      help = "error whose mean gets a 95 % bootstrap interval" },
    block = { kind = "integer", default = 10, min = 1, help = "neighbouring frames that are drawn together" },
    seed = { kind = "integer", default = 1, min = 0, help = "of the interval" },
  },
  run = function(input, report)
    local names = label_names(input.label_names)
    local frames = depth_frames.pair(input)
    local options = depth_frames.reading(input, { align = input.align, align_over = input.align_over,
      min = input.min_depth, max = input.max_depth > 0 and input.max_depth or nil })
    local errors = depth_frames.evaluate(frames, options)
    local result = add_errors(errors, input, report)
    depth_frames.report_frames(frames, result, report)
    for _, label in ipairs(errors:labels()) do
      add_errors(errors:of_label(label), input, report:within { label = names[label] or ("%d"):format(label) })
    end
    depth_frames.draw(errors, frames, options, report)
    depth_frames.write(errors, frames, options, input)
  end,
}
