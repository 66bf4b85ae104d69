-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Video depth as CUT3R, MonST3R and pi3 report it: one scale a sequence, means weighted by valid pixels.
---
---   aib-lua video_depth results/bonn bonn/depth     # folders of sequences, or one sequence each
local aib = require "aib"
local depth_frames = require "aib.depth_frames"
local suggest = require "aib.suggest"

local metrics <const> = { "abs_rel", "sq_rel", "rmse", "rmse_log", "delta1", "delta2", "delta3" }
local fits <const> = { median = "median_lower", scale = "scale_l1", scale_shift = "scale_shift", metric = "none" }

--- Names of the folders in a folder.
local function folders_in(folder)
  local list = {}
  for _, name in ipairs(aib.system.names_in(folder)) do
    if aib.system.is_folder(folder .. "/" .. name) then list[#list + 1] = name end
  end
  return list
end

--- The folders of each sequence, or those of the only one.
local function sequences(input)
  local list = {}
  for _, name in ipairs(folders_in(input.reference)) do
    local folders = suggest.with(input, { name = name, estimate = input.estimate .. "/" .. name,
      reference = input.reference .. "/" .. name })
    if aib.system.is_folder(folders.estimate) then list[#list + 1] = folders end
  end
  return #list > 0 and list or { input }
end

--- Errors of one sequence over all its pixels, nil where it has no valid one.
local function score(folders, input, report)
  local cell = folders.name and report:within { sequence = folders.name } or report
  local frames = depth_frames.pair(folders)
  local options = depth_frames.reading(input, { preset = "cut3r", align = fits[input.align], max = input.max_depth })
  local errors = cell:attempt(function() return depth_frames.evaluate(frames, options) end, "depth")
  local result = errors and cell:attempt(function() return errors:result { pooled = true } end, "depth")
  local how = { metrics = metrics, n = result and result.n_valid, convention = "CUT3R, all pixels of a sequence",
    options = { align = input.align, max_depth = input.max_depth } }
  depth_frames.report(result, cell, how)
  cell:add("depth.scale", result and result.scale, { n = result and result.n_valid })
  depth_frames.report_frames(frames, result, cell)
  if not errors then return nil end
  depth_frames.draw(errors, frames, options, cell)
  depth_frames.write(errors, frames, options, input)
  return result
end

--- Means over the sequences, weighted by their valid pixels, as the scripts print them.
local function add_mean(results, report)
  local mean, n = {}, 0
  for _, result in ipairs(results) do
    n = n + result.n_valid
    for _, name in ipairs(metrics) do mean[name] = (mean[name] or 0) + result[name] * result.n_valid end
  end
  for _, name in ipairs(metrics) do mean[name] = n > 0 and mean[name] / n or nil end
  depth_frames.report(mean, report:within { sequence = "all" }, { metrics = metrics, n = n,
    convention = "CUT3R, weighted by valid pixels" })
end

return aib.protocol {
  name = "video_depth",
  title = "Video depth",
  cite = "Wang et al., CUT3R, CVPR 2025; Zhang et al., MonST3R, ICLR 2025; Wang et al., pi3, 2025",
  help = "One scale (and shift) a sequence. The scripts enlarge estimates bicubically, which makes up depths at edges; "
    .. "here truth is taken at the estimate's pixels. They score a sequence without a valid pixel as perfect; here it "
    .. "is a dash.",
  inputs = depth_frames.inputs {
    align = { kind = "choice", choices = { "median", "scale", "scale_shift", "metric" }, default = "median",
      help = "what is fitted to each sequence" },
    max_depth = { kind = "number", unit = "m", default = 80, min = 0, help = "truth at it or beyond is left out" },
  },
  run = function(input, report)
    local list, results = sequences(input), {}
    for _, folders in ipairs(list) do results[#results + 1] = score(folders, input, report) end
    if #list > 1 then add_mean(results, report) end
  end,
}
