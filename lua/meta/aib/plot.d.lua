---@meta aib.report.plot

---Figures for papers as SVG: units on the axes, colours that red-green blindness tells apart. Each gives the text of a
---picture, for `write`.
---@class aib.report.plot
local plot = {}

---@class aib.report.PlotOptions
---@field title? string  # for screen readers; papers have captions
---@field width? number  # pixels, 640
---@field height? number
---@field unit? string  # of lengths, "m"

---Paths of cameras; the reference dashed.
---@param estimates aib.Trajectory|table<string, aib.Trajectory>
---@param reference? aib.Trajectory
---@param options? aib.report.PlotOptions|{ view: "above"|"side"|"front" }
---@return string svg
function plot.trajectory(estimates, reference, options) end

---The estimate's path in the colours of its absolute errors. Both are paired.
---@param est aib.Trajectory
---@param ref aib.Trajectory
---@param options? aib.report.PlotOptions|{ view: "above"|"side"|"front", relation: aib.Relation, max: number }
---@return string svg
function plot.ape(est, ref, options) end

---Recall of relative poses against the angle.
---@param results aib.Auc|table<string, aib.Auc>
---@param options? aib.report.PlotOptions
---@return string svg
function plot.auc(results, options) end

---Precision, recall and F-score against the threshold, from `aib.cloud.curve`; logarithmic.
---@param curves table
---@param options? aib.report.PlotOptions
---@return string svg
function plot.precision_recall(curves, options) end

---Lines of your own.
---@param lines { label: string, x: number[], y: number[] }[]
---@param options? aib.report.PlotOptions|{ x: aib.report.Axis, y: aib.report.Axis }
---@return string svg
function plot.lines(lines, options) end

---Writes a figure as .svg, or as .png where the program rsvg-convert (librsvg, cairo) is found.
---@param path string
---@param figure string
function plot.write(path, figure) end

return plot
