---@meta aib.stats

---Statistics of numbers.
---@class aib.Stats
local stats = {}

---Statistics of a set of errors, named as evo names them.
---@class aib.Summary
---@field count integer
---@field rmse number
---@field mean number
---@field median number
---@field std number  # population (ddof 0)
---@field min number
---@field max number
---@field sse number  # sum of squares

---Count, mean, spread and range of a stream of numbers, mergeable. `#m` is the count.
---@class aib.Moments
---@field mean number  # 0 of nothing
---@field std number  # population (ddof 0)
---@field min number  # +inf of nothing
---@field max number  # -inf of nothing
local moments = {}

---What it is in a few numbers.
---@return { count: integer, mean: number|nil, std: number|nil, min: number|nil, max: number|nil } summary
function moments:summary() end

---Adds a value.
---@param value number
---@return aib.Moments self
function moments:add(value) end

---Adds the values of another.
---@param other aib.Moments
---@return aib.Moments self
function moments:merge(other) end

---Moments of nothing yet.
---@return aib.Moments moments
function stats.moments() end

---Statistics of values. Undefined where there is none.
---@param values number[]
---@return aib.Summary summary
function stats.summary(values) end

---Quantile of values, in any order. Undefined where there is none.
---@param values number[]
---@param q number  # in [0, 1]
---@param options? { rule?: "linear"|"lower"|"midpoint" }  # between two values; "linear" is numpy's and the default
---@return number quantile
function stats.quantile(values, q, options) end

---The mean of a series and a bootstrap interval of it: blocks of neighbours are drawn together. For a difference of two
---conditions pass the differences frame by frame.
---@param values number[]
---@param options? { block?: integer, resamples?: integer, level?: number, seed?: integer }  # 10, 2000, 0.95, 1
---@return { mean: number, low: number, high: number, deviation: number } interval
function stats.bootstrap(values, options) end

return stats
