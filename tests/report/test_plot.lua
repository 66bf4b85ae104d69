-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

local aib = require "aib"
local axes = require "aib.report.axes"
local plot = aib.report.plot

--- A quarter circle of cameras, each moved by `off` along x.
local function path(off)
  local poses, names = {}, {}
  for i = 1, 10 do
    local a = (i - 1) * math.pi / 18
    poses[i] = aib.math.pose { centre = { math.cos(a) + off, math.sin(a), 0.1 * i } }
    names[i] = ("%02d"):format(i)
  end
  return aib.pose.trajectory(poses, { names = names })
end

--- Every element is closed in its order.
local function check_markup(t, text)
  local open = {}
  for closing, name, rest in text:gmatch("<(/?)([%w]+)([^>]*)>") do
    if closing == "/" then
      t:equal(table.remove(open), name)
    elseif not rest:find("/$") then
      open[#open + 1] = name
    end
  end
  t:equal(#open, 0)
end

return aib.test {
  ["ticks are round numbers inside of the axis"] = function(t)
    t:equal(axes.axis(0, 1, {}).ticks, { 0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0 })
    t:equal(axes.axis(0.01, 1, { scale = "log" }).ticks, { 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0 })
    local axis = axes.axis(0.013, 0.094, {})
    t:check(axis.low <= 0.013 and axis.high >= 0.094)
  end,

  ["an axis over one value has room around it"] = function(t)
    local axis = axes.axis(5, 5, {})
    t:near(axis.place(5), 0.5, 1e-12)
    t:near(axes.axis(2, 2, { scale = "log" }).place(2), 0.5, 1e-12)
    t:equal(axes.axis(0.1, 1, { scale = "log" }).place(0), nil)
  end,

  ["a trajectory has units on its axes, and its two directions the same scale"] = function(t)
    local figure = plot.trajectory({ ["<b>&"] = path(0.1) }, path(0), { view = "above" })
    check_markup(t, figure)
    t:contains(figure, ">x (m)<")
    t:contains(figure, ">y (m)<")
    t:contains(figure, "&lt;b&gt;&amp;")
    t:contains(plot.trajectory(path(0), nil, { view = "side" }), ">z (m)<")
    t:raises("one of above, front, side expected, found 'below'", plot.trajectory, path(0), nil, { view = "below" })
    t:raises("unknown field 'veiw', did you mean 'view'?", plot.trajectory, path(0), nil, { veiw = "above" })
  end,

  ["an APE path has the colours of its errors and their scale"] = function(t)
    local figure = plot.ape(path(0.1), path(0))
    check_markup(t, figure)
    t:contains(figure, "APE (m)")
    t:contains(figure, ">0.1<")
  end,

  ["recall and precision have a line for each part"] = function(t)
    local auc = aib.pose.auc(path(0.1), path(0))
    t:contains(plot.auc(auc), ">rotation<")
    t:contains(plot.auc { A = auc, B = auc }, ">B, direction<")
    local curve = { tau = { 0.01, 0.1, 1 }, precision = { 0, 0.5, 1 }, recall = { 0, 0.2, 1 }, f_score = { 0, 0.3, 1 } }
    check_markup(t, plot.precision_recall(curve))
    t:contains(plot.precision_recall(curve), ">threshold (m)<")
  end,

  ["a gap in a line is a gap, and a line of nothing is drawn without fault"] = function(t)
    local figure = plot.lines({ { label = "a", x = { 1, 2, 3, 4 }, y = { 1, 0 / 0, 3, 2 } } }, { x = {}, y = {} })
    check_markup(t, figure)
    t:check(not figure:find("nan", 1, true))
    t:equal(select(2, figure:match('d="(M[^"]*)" fill="none" stroke="#0072B2" stroke%-linecap'):gsub("M", "")), 2)
    t:contains(plot.lines({ { label = "a", x = { 1, 2 }, y = { 1, 0 / 0 } } }, {}), "h0.01")
    check_markup(t, plot.lines({ { label = "", x = {}, y = {} } }, {}))
  end,

  ["a figure is written as SVG, and as PNG where rsvg-convert is"] = function(t)
    t:raises(".svg", plot.write, "figure.pdf", "")
    local base, figure = os.tmpname(), plot.lines({ { label = "a", x = { 1, 2 }, y = { 1, 2 } } }, { width = 300 })
    plot.write(base .. ".svg", figure)
    t:contains(aib.system.read_text(base .. ".svg"), figure)
    os.remove(base .. ".svg")
    os.remove(base)
    if not os.execute "command -v rsvg-convert >/dev/null 2>&1" then
      t:raises("rsvg%-convert", plot.write, base .. ".png", figure)
      t:skip("rsvg-convert is not here")
    end
    plot.write(base .. ".png", figure)
    t:contains(tostring(aib.io.read_image(base .. ".png")), "image(600x")
    os.remove(base .. ".png")
  end,

  ["a montage has a row a frame, of maps or of files"] = function(t)
    local file, map = os.tmpname() .. ".npy", aib.depth.map { { 1, 2 }, { 3, 4 } }
    aib.io.write_depth(file, map)
    local sheet = aib.report.montage({ { estimate = map, reference = file }, { estimate = file, reference = map },
      { estimate = map, reference = map, transform = { scale = 2, shift = 0 } } }, { width = 300 })
    local one = aib.report.montage({ { estimate = map, reference = map } }, { width = 300 })
    t:equal(sheet.width, one.width)
    t:check(sheet.height > 2 * one.height)
    t:raises("widht", aib.report.montage, {}, { widht = 3 })
    os.remove(file)
  end,
}
