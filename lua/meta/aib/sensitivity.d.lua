---@meta aib.sensitivity
error("Cannot require a meta file")

---How numbers of frames change over conditions of one scene, from differences of the same views.
---@class aib.sensitivity
local sensitivity = {}

---The frames of a condition.
---@class aib.sensitivity.Level
---@field condition string
---@field names string[]
---@field values number[]

---@class aib.Sensitivity
---@field change { mean: number, low: number, high: number, deviation: number }  # from the first level to the last
---@field slope { mean: number, low: number, high: number, deviation: number }  # per level
---@field within number  # the change is smaller than this at the interval's level
---@field n integer  # frames in all levels

---Paired differences over levels in their order, with block bootstrap intervals; nil where nothing is paired.
---@param levels aib.sensitivity.Level[]
---@param options? { block?: integer, resamples?: integer, level?: number, seed?: integer }
---@return aib.Sensitivity|nil
function sensitivity.of(levels, options) end

---Adds the records of a metric to a report and returns a sentence that says them; nil where nothing is paired.
---@param report aib.Report
---@param metric string
---@param levels aib.sensitivity.Level[]
---@param depends? table<string, any>  # what they depend on, as their options
---@param unit? string  # of the metric
---@return string|nil sentence
function sensitivity.add(report, metric, levels, depends, unit) end

---The mean of a series of frames and its bootstrap interval; blocks are at most a quarter of the series.
---@param values number[]
---@param options? { block?: integer, resamples?: integer, level?: number, seed?: integer }
---@return { mean: number, low: number, high: number, deviation: number } interval
function sensitivity.interval(values, options) end

return sensitivity
