-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Depth maps of a method, for the protocol asset_inspection.
local aib = require "aib"
local drawings = require "aib.evaluation.drawings"
local with = require "aib.evaluation.with"

local M = {}

--- What is told of the frames; what is of a length needs the scale of the alignment.
local depth_metrics <const> = {
  { name = "srmse", better = "lower" }, { name = "si_log_rmse", better = "lower" },
  { name = "coverage", better = "higher" }, { name = "abs_rel", better = "lower", of_length = true },
  { name = "delta1", better = "higher", of_length = true }, { name = "delta2", better = "higher", of_length = true },
  { name = "delta3", better = "higher", of_length = true },
}

local gsd_taus <const> = { 1, 2, 5 }
local strata <const> = { "inside", "edge", "thin" }

--- Adds a frame's errors to an accumulator; the truth is brought to the method's size, never the other way. Shares
--- within some ground sampling distances go to `gsd`, by tau, where the scale is known. A page shows the frame in
--- `cell`, and `risks` takes what its confidence, where there is one, is worth.
function M.add_frame(errors, gsd, name, est, scale, truth, input, cell, confidence, risks)
  local full <close> = truth.depth(name)
  local ref <close> = aib.depth.downsample(full, est.width, est.height, { rule = input.rule })
  errors:add(est, ref, { name = name, labels = input.details and aib.depth.strata(ref) or nil })
  truth.drawn = truth.drawn or drawings.chosen(truth.depth_names)
  local transform = { scale = scale or 1, shift = 0 }
  drawings.frame(cell, truth.drawn, name, est, ref, transform)
  if truth.drawn[name] then drawings.add_risk(cell, risks, est, ref, confidence, transform) end
  local camera = input.details and scale and (truth.cameras or {})[name]
  if not camera then return end
  local ok, surface = pcall(aib.depth.surface_errors, est, ref, camera, {
    tau = gsd_taus, transform = { scale = scale, shift = 0 },
  })
  if not ok and aib.error_kind(surface) ~= "undefined" then error(surface, 0) end
  for _, tau in ipairs(ok and gsd_taus or {}) do
    gsd[tau] = gsd[tau] or aib.stats.moments()
    gsd[tau]:add(surface.within_total[tau])
  end
end

--- Errors inside of surfaces, at depth edges and in thin structures, and shares of the truth's pixels within some
--- ground sampling distances.
local function add_depth_details(errors, gsd, how, cell)
  for label, stratum in ipairs(strata) do
    local of_stratum = errors:of_label(label)
    local mean = #of_stratum > 0 and cell:attempt(function() return of_stratum:result() end) or {}
    for _, name in ipairs { "srmse", "coverage" } do
      cell:within({ stratum = stratum }):add("depth." .. name, mean[name], {
        better = name == "srmse" and "lower" or "higher", n = mean.n_defined, convention = "mean over frames",
        options = how,
      })
    end
  end
  for _, tau in ipairs(gsd_taus) do
    cell:add(("depth.within_%dgsd"):format(tau), gsd[tau] and gsd[tau].mean, {
      better = "higher", n = gsd[tau] and #gsd[tau], convention = "share of the truth's pixels, mean over frames",
      options = how,
    })
  end
end

--- Adds what an accumulator of frames found. Metrics of a length are those of `scaled`: frames whose scale is known,
--- nil where there is none.
function M.add_depth(errors, scaled, gsd, truth, how_scaled, input, cell, frames)
  local mean = cell:attempt(function() return errors:result() end, "depth") or { n_defined = 0 }
  local of_length = scaled == errors and mean
    or scaled and cell:attempt(function() return scaled:result() end) or { n_defined = 0 }
  local how = { rule = input.rule, frames_expected = #truth.depth_names }
  for _, metric in ipairs(depth_metrics) do
    local from = metric.of_length and of_length or mean
    cell:add("depth." .. metric.name, from[metric.name], {
      better = metric.better, n = scaled and from.n_defined or mean.n_defined, convention = "mean over frames",
      options = metric.of_length and with(how_scaled, how) or how,
    })
  end
  local empty = #errors - mean.n_defined
  if empty > 0 then cell:note(("depth: %d of %d frames have no valid pixel"):format(empty, #errors)) end
  local kept = { names = aib.json.list(), values = aib.json.list() }
  drawings.depth_series(cell, errors:frames())
  for _, frame in ipairs(errors:frames()) do
    if frame.srmse then
      kept.names[#kept.names + 1], kept.values[#kept.values + 1] = frame.name, frame.srmse
    end
  end
  frames["depth.srmse"] = kept
  if input.details then add_depth_details(errors, gsd, with(how_scaled, how), cell) end
end

function M.score_depth(unit, truth, files, frame, input, cell, frames)
  local errors = aib.depth.accumulate { transform = { scale = frame.scale or 1 } }
  local gsd = {}
  for _, name in ipairs(files:present(unit.result.depth, truth.depth_names)) do
    local est <close> = aib.io.read_depth(files:frame(unit.result.depth, name))
    M.add_frame(errors, gsd, name, est, frame.scale, truth, input, cell)
  end
  M.add_depth(errors, frame.scale and errors, gsd, truth, frame.how, input, cell, frames)
end


return M
