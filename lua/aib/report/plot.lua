-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Figures for papers, as SVG: units on the axes, colours that red-green blindness tells apart, nothing else.
---
---   aib.report.plot.write("path.svg", aib.report.plot.trajectory(est, ref, { view = "above" }))
local aib = require "aib"
local axes = require "aib.report.axes"
local suggest = require "aib.suggest"
local svg = require "aib.report.svg"

local M = {}

local views <const> = {
  above = { 1, 2, "x", "y" }, side = { 1, 3, "x", "z" }, front = { 2, 3, "y", "z" },
}

local function check(name, options, known)
  options = options or {}
  local set = { title = true, width = true, height = true, unit = true }
  for _, key in ipairs(known) do set[key] = true end
  suggest.check_keys("aib.report.plot." .. name, options, set, 3)
  return options
end

local function view_of(name)
  local view = views[name or "above"]
  if not view then error(("plot: view: one of above, front, side expected, found '%s'"):format(tostring(name)), 3) end
  return view
end

local function path_of(trajectory, view)
  local line = { x = {}, y = {} }
  for i, p in ipairs(trajectory:positions()) do line.x[i], line.y[i] = p[view[1]], p[view[2]] end
  return line
end

local function map(options, view, lines, bar)
  local unit = options.unit or "m"
  return svg.lines({
    title = options.title or "Trajectory", width = options.width or 640, height = options.height or 480, equal = true,
    x = { label = view[3], unit = unit }, y = { label = view[4], unit = unit }, lines = lines, bar = bar,
  }, true)
end

--- Paths of cameras: the reference dashed, estimates by name or one alone.
function M.trajectory(estimates, reference, options)
  options = check("trajectory", options, { "view" })
  local view, lines = view_of(options.view), {}
  if type(estimates) ~= "table" then estimates = { estimate = estimates } end
  for i, name in ipairs(suggest.keys(estimates)) do
    lines[i] = path_of(estimates[name], view)
    lines[i].label = name
  end
  if reference then
    local line = path_of(reference, view)
    line.label, line.color, line.dash, line.width = "reference", "#666666", "5 4", 1.5
    lines[#lines + 1] = line
  end
  return map(options, view, lines)
end

local function hex(c) return ("#%02x%02x%02x"):format(c[1], c[2], c[3]) end

local function colors_of(values, high)
  local list = aib.cloud.colors_of(values, { max = high })
  for i, c in ipairs(list) do list[i] = hex(c) end
  return list
end

local function ramp(high)
  local values = {}
  for i = 1, 32 do values[i] = high * (i - 0.5) / 32 end
  return colors_of(values, high)
end

--- The estimate's path in the colours of its absolute errors, the last colour where 5 % are beyond (`max` says
--- otherwise); both trajectories are paired.
function M.ape(est, ref, options)
  options = check("ape", options, { "view", "relation", "max" })
  local errors = aib.pose.ape(est, ref, { relation = options.relation }).errors
  local high = math.max(1e-12, options.max or aib.stats.quantile(errors, 0.95))
  local view = view_of(options.view)
  local path, truth = path_of(est, view), path_of(ref, view)
  path.colors = colors_of(errors, high)
  truth.label, truth.color, truth.dash, truth.width = "reference", "#666666", "5 4", 1.5
  options.title = options.title or "Absolute pose error along the path"
  local unit = options.relation and options.relation:find("angle") and options.relation:match("_(%a+)$") or "m"
  local _, largest = axes.range_of { errors }
  local label = ("APE (%s), largest %.3g"):format(unit, largest)
  return map(options, view, { truth, path }, { label = label, high = high, colors = ramp(high) })
end

--- Recall of relative poses against the angle, from results of aib.pose.auc by name: rotations solid, directions
--- dashed.
function M.auc(results, options)
  options = check("auc", options, {})
  if results.rra then results = { [""] = results } end
  local lines, most = {}, 0
  for i, name in ipairs(suggest.keys(results)) do
    local auc, color = results[name], svg.manner(i)
    most = math.max(most, auc.max_deg)
    for _, part in ipairs { { "rra", "rotation" }, { "rta", "direction", "6 3" } } do
      local line = { label = (name == "" and "" or name .. ", ") .. part[2], color = color, dash = part[3], x = { 0 },
        y = { 0 } }
      for tau = 1, auc.max_deg do line.x[tau + 1], line.y[tau + 1] = tau, auc[part[1]][tau] end
      lines[#lines + 1] = line
    end
  end
  return svg.lines({ title = options.title or "Recall of relative poses", width = options.width,
    height = options.height, x = { label = "threshold", unit = "deg", low = 0, high = most },
    y = { label = "share of pairs", low = 0, high = 1 }, lines = lines }, true)
end

local parts_of_curve <const> = {
  { "f_score", "F-score" }, { "precision", "precision", "7 3" }, { "recall", "recall", "2 3" },
}

--- Precision, recall and F-score against the threshold, from results of aib.cloud.curve by name; log axis.
function M.precision_recall(curves, options)
  options = check("precision_recall", options, {})
  if curves.tau then curves = { [""] = curves } end
  local lines = {}
  for i, name in ipairs(suggest.keys(curves)) do
    local curve, color = curves[name], svg.manner(i)
    for _, part in ipairs(parts_of_curve) do
      lines[#lines + 1] = { label = (name == "" and "" or name .. ", ") .. part[2], color = color, dash = part[3],
        x = curve.tau, y = curve[part[1]], width = part[3] and 1.5 or 2.5 }
    end
  end
  return svg.lines({ title = options.title or "Precision and recall", width = options.width, height = options.height,
    x = { label = "threshold", unit = options.unit or "m", scale = "log" },
    y = { label = "share", low = 0, high = 1 }, lines = lines }, true)
end

--- Lines of your own: { { label =, x = numbers, y = numbers }, ... }; x and y say label, unit and scale.
function M.lines(lines, options)
  options = check("lines", options, { "x", "y" })
  return svg.lines({ title = options.title, width = options.width, height = options.height, x = options.x or {},
    y = options.y or {}, lines = lines }, true)
end

local declaration <const> = '<?xml version="1.0" encoding="UTF-8"?>\n'

--- Hands a figure to rsvg-convert, which draws with cairo: two pixels a unit.
local function write_png(path, figure)
  local here = io.popen and os.execute "command -v rsvg-convert >/dev/null 2>&1"
  if not here then
    error(("plot.write: %s: a PNG needs the program rsvg-convert (librsvg); an .svg needs nothing"):format(path), 3)
  end
  local name = path:gsub("'", "'\\''")
  local pipe = assert(io.popen(("rsvg-convert --zoom 2 --output '%s.part'"):format(name), "w"))
  pipe:write(declaration, figure, "\n")
  if not (pipe:close() and os.rename(path .. ".part", path)) then
    error(("plot.write: %s: rsvg-convert could not write it"):format(path), 3)
  end
end

--- Writes a figure; the ending says how: .svg, or .png where rsvg-convert is found.
function M.write(path, figure)
  if path:find("%.png$") then return write_png(path, figure) end
  if not path:find("%.svg$") then error(("plot.write: %s: .svg or .png expected"):format(path), 2) end
  aib.system.write_text(path, declaration .. figure .. "\n")
end

return M
