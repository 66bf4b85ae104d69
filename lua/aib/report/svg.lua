-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- One chart as SVG: lines, steps or coloured paths over two axes; intervals over one. Texts and axes take the colour
--- around them (currentColor), so that it reads on light and on dark; the lines have colours that red-green blindness
--- tells apart, and dashes for print.
---
---   chart = { title =, width =, height =, x = axis, y = axis, lines = { line, ... }, equal = true|nil, bar = bar|nil,
---             frames = names of x = 1, 2, ... }
---   axis  = { label =, unit =, scale = "linear" | "log", low =, high = }    bounds where the data is not to give them
---   line  = { label =, x = numbers, y = numbers, color =, dash =, width =, place = number of its colour,
---             colors = one a piece }
---   bar   = { label =, high =, colors = list }                              the colours of values from 0 to high
local axes = require "aib.report.axes"
local markup = require "aib.report.markup"

local M = {}

--- Okabe and Ito's colours, without black and the yellow that white swallows.
M.palette = { "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9" }
local dashes <const> = { false, "7 3", "2 3", "9 3 2 3" }

--- Colour and dash of the i-th line: colours first, then dashes.
function M.manner(i)
  local n = #M.palette
  return M.palette[(i - 1) % n + 1], dashes[(i - 1) // n % #dashes + 1] or nil
end

local function number(x) return (("%.1f"):format(x):gsub("%.0$", "")) end

local function text_at(x, y, words, attributes)
  attributes.x, attributes.y, attributes.fill = number(x), number(y), "currentColor"
  return markup.text("text", attributes, words)
end

local function stroke(path, attributes)
  attributes.d, attributes.fill = path, "none"
  return markup.element("path", attributes)
end

local font <const> = 12
local function width_of(words) return 0.63 * font * (utf8.len(words) or #words) end

local plot = {}
plot.__index = plot

function plot:add(element) self.out[#self.out + 1] = element end

--- Pixel of a point; nil where it has none.
function plot:pixel(x, y)
  local u, v = self.x.place(x), self.y.place(y)
  if not u or not v or u ~= u or v ~= v then return nil end
  local box = self.box
  return box.left + u * box.width, box.top + (1 - v) * box.height
end

local function shortened(words, most)
  if (utf8.len(words) or #words) <= most then return words end
  return words:sub(1, (utf8.offset(words, most) or most) - 1) .. "…"
end

--- Names of the lines above the plot, as many rows as they take. Returns the height.
function plot:legend(lines, width)
  local left = self.box.left
  local x, y, row = left, font, font + 6
  for i, line in ipairs(lines) do
    local words = shortened(line.label or "", 60)
    local needed = 30 + width_of(words) + 14
    if words ~= "" then
      if x > left and x + needed > width then x, y = left, y + row end
      local color, dash = M.manner(line.place or i)
      self:add(stroke(("M%s %sh22"):format(number(x), number(y - 4)), { stroke = line.color or color,
        ["stroke-width"] = 2.5, ["stroke-dasharray"] = line.dash or dash }))
      self:add(text_at(x + 28, y, words, {}))
      x = x + needed
    end
  end
  return x > left and y + 8 or 0
end

function plot:frame(chart)
  local box = self.box
  local bottom, right = box.top + box.height, box.left + box.width
  local grid, ticks = {}, {}
  for _, tick in ipairs(self.x.ticks) do
    local px = box.left + self.x.place(tick) * box.width
    grid[#grid + 1] = ("M%s %sV%s"):format(number(px), number(box.top), number(bottom))
    ticks[#ticks + 1] = text_at(px, bottom + 16, self.x.text(tick), { ["text-anchor"] = "middle" })
  end
  for _, tick in ipairs(self.y.ticks) do
    local py = box.top + (1 - self.y.place(tick)) * box.height
    grid[#grid + 1] = ("M%s %sH%s"):format(number(box.left), number(py), number(right))
    ticks[#ticks + 1] = text_at(box.left - 7, py + 4, self.y.text(tick), { ["text-anchor"] = "end" })
  end
  self:add(stroke(table.concat(grid), { stroke = "currentColor", ["stroke-opacity"] = 0.14 }))
  self:add(stroke(("M%s %sV%sH%s"):format(number(box.left), number(box.top), number(bottom), number(right)),
    { stroke = "currentColor", ["stroke-opacity"] = 0.6 }))
  self:add(table.concat(ticks))
  self:add(text_at(box.left + box.width / 2, bottom + 36, axes.label(chart.x), { ["text-anchor"] = "middle" }))
  local turned = ("rotate(-90 %s %s)"):format(13, number(box.top + box.height / 2))
  self:add(text_at(13, box.top + box.height / 2, axes.label(chart.y), { ["text-anchor"] = "middle",
    transform = turned }))
end

--- Pieces of a line between its gaps.
function plot:path(line, steps)
  local parts, pen = {}, false
  for i, x in ipairs(line.x) do
    local px, py = self:pixel(x, line.y[i])
    if not px then
      pen = false
    elseif not pen then
      parts[#parts + 1], pen = ("M%s %s"):format(number(px), number(py)), true
      if line.x[i + 1] == nil or line.y[i + 1] ~= line.y[i + 1] then parts[#parts + 1] = "h0.01" end
    elseif steps then
      parts[#parts + 1] = ("H%sV%s"):format(number(px), number(py))
    else
      parts[#parts + 1] = ("L%s %s"):format(number(px), number(py))
    end
  end
  return table.concat(parts)
end

function plot:line(line, i, steps)
  local color, dash = M.manner(line.place or i)
  if line.colors then return self:coloured(line) end
  self:add(stroke(self:path(line, steps), { stroke = line.color or color, ["stroke-width"] = line.width or 2,
    ["stroke-dasharray"] = line.dash or dash, ["stroke-linejoin"] = "round", ["stroke-linecap"] = "round",
    ["data-line"] = self.is_marked and i }))
end

--- A path whose pieces have the colours of the points where they end.
function plot:coloured(line)
  for k = 2, #line.x do
    local ax, ay = self:pixel(line.x[k - 1], line.y[k - 1])
    local bx, by = self:pixel(line.x[k], line.y[k])
    if ax and bx then
      self:add(stroke(("M%s %sL%s %s"):format(number(ax), number(ay), number(bx), number(by)), {
        stroke = line.colors[k], ["stroke-width"] = line.width or 4, ["stroke-linecap"] = "round" }))
    end
  end
end

--- The colours of values, from 0 at the left, above the plot.
function plot:bar(bar, top)
  local left, width, n = self.box.left, 160, #bar.colors
  for k, color in ipairs(bar.colors) do
    self:add(markup.element("rect", { x = number(left + (k - 1) * width / n), y = number(top), fill = color,
      width = number(width / n + 0.5), height = 10 }))
  end
  self:add(text_at(left, top + 24, "0", {}))
  self:add(text_at(left + width, top + 24, ("%.3g"):format(bar.high), { ["text-anchor"] = "end" }))
  self:add(text_at(left + width + 10, top + 10, bar.label, {}))
  return top + 34
end

--- Bounds of an axis: those that are given, else those of the data.
local function bounds(axis, lists, from_zero)
  local low, high = axes.range_of(lists)
  low, high = low or 0, high or 1
  if axis.scale == "log" then
    local positive = {}
    for _, list in ipairs(lists) do
      for _, x in ipairs(list) do
        if x > 0 then positive[#positive + 1] = x end
      end
    end
    low, high = axes.range_of { positive }
    low, high = low or 0.1, high or 1
  elseif from_zero and low > 0 and low < 0.6 * high then
    low = 0
  end
  return axis.low or low, axis.high or high
end

local function columns(lines, key)
  local lists = {}
  for i, line in ipairs(lines) do lists[i] = line[key] end
  return lists
end

--- The same length of a unit on both axes, with some room around.
local function make_equal(box, x, y)
  local per_unit = 0.94 * math.min(box.width / (x[2] - x[1]), box.height / (y[2] - y[1]))
  local function widened(range, pixels)
    local missing = pixels / per_unit - (range[2] - range[1])
    return { range[1] - missing / 2, range[2] + missing / 2 }
  end
  return widened(x, box.width), widened(y, box.height)
end

local function document(chart, width, height, content, standalone)
  local title = markup.text("title", {}, chart.title or "")
  return markup.element("svg", {
    xmlns = "http://www.w3.org/2000/svg", viewBox = ("0 0 %d %d"):format(width, height), role = "img",
    width = standalone and width or nil, height = standalone and height or nil,
    ["font-family"] = "system-ui, sans-serif", ["font-size"] = font, color = standalone and "#222" or nil,
    style = standalone and "background:#fff" or nil, ["aria-label"] = chart.title,
  }, title .. content)
end

--- Lines over two axes. `standalone`: a file of its own, else part of a page.
function M.lines(chart, standalone)
  local width, height = chart.width or 640, chart.height or 360
  local self = setmetatable({ out = {} }, plot)
  local left = 62
  self.box = { left = left }
  local top = self:legend(chart.lines, width)
  if chart.bar then top = self:bar(chart.bar, top + 2) end
  self.box = { left = left, top = top + 6, width = width - left - 16, height = height - top - 6 - 46 }
  local x_low, x_high = bounds(chart.x, columns(chart.lines, "x"), false)
  local y_low, y_high = bounds(chart.y, columns(chart.lines, "y"), true)
  if chart.equal then
    local x, y = make_equal(self.box, { x_low, math.max(x_high, x_low + 1e-9) },
      { y_low, math.max(y_high, y_low + 1e-9) })
    x_low, x_high, y_low, y_high = x[1], x[2], y[1], y[2]
  end
  self.x = axes.axis(x_low, x_high, { scale = chart.x.scale, ticks = 6, exact = true })
  self.y = axes.axis(y_low, y_high, { scale = chart.y.scale, exact = chart.equal or chart.y.high ~= nil })
  if chart.frames then
    self.x.text = function(tick) return ((chart.frames[math.tointeger(tick)] or ""):gsub("%.[^.]*$", "")) end
  end
  self:frame(chart)
  self.is_marked = chart.equal  -- a page shows and hides the lines of what stays a drawing
  for i, line in ipairs(chart.lines) do self:line(line, i, chart.steps) end
  return document(chart, width, height, table.concat(self.out), standalone)
end

--- Values with bounds, one below the other, over one axis; a line at 0 where it lies inside.
function M.intervals(chart, standalone)
  local width, row = chart.width or 640, 28
  local height = #chart.rows * row + 60
  local self = setmetatable({ out = {} }, plot)
  local longest, lists = 0, {}
  for i, r in ipairs(chart.rows) do
    longest = math.max(longest, width_of(shortened(r.label, 48)))
    lists[i] = { r.low, r.high, r.value, 0 }
  end
  local left = math.min(longest + 12, 0.55 * width)
  self.box = { left = left, top = 6, width = width - left - 16, height = #chart.rows * row }
  local low, high = axes.range_of(lists)
  self.x = axes.axis(low, high, { ticks = 5 })
  self.y = { ticks = {}, place = function(y) return 1 - y end }
  self:frame { x = chart.x, y = {} }
  local zero = self:pixel(0, 0)
  self:add(stroke(("M%s %sv%s"):format(number(zero), 6, self.box.height), { stroke = "currentColor" }))
  for i, r in ipairs(chart.rows) do
    local y = 6 + (i - 0.5) * row
    local from, at, to = self:pixel(r.low, 0), self:pixel(r.value, 0), self:pixel(r.high, 0)
    local color = M.palette[1]
    self:add(text_at(left - 10, y + 4, shortened(r.label, 48), { ["text-anchor"] = "end" }))
    self:add(stroke(("M%s %sH%sM%s %sv8M%s %sv8"):format(number(from), number(y), number(to), number(from),
      number(y - 4), number(to), number(y - 4)), { stroke = color, ["stroke-width"] = 2 }))
    self:add(markup.element("circle", { cx = number(at), cy = number(y), r = 4.5, fill = color }))
  end
  return document(chart, width, height, table.concat(self.out), standalone)
end

return M
