---@meta aib.consistency
error("Cannot require a meta file")

---Finds numbers that cannot stand together: a harmonic mean above the arithmetic one, a share above 1, a joint recall
---above its marginals.
---@class aib.consistency
local consistency = {}

---Sentences about what is impossible among the numbers of one group.
---@param values table<string, number>  # by metric name
---@param rounding? number  # half a unit of the last digit of a printed table
---@return string[] impossible
---@return string[] empty  # no contradiction, but it tells nothing: an accuracy below that of a perfect cloud
function consistency.check(values, rounding) end

---Checks every group of a report and notes what is impossible.
---@param report aib.Report
---@param rounding? number  # as of check
---@return integer count
---@return integer groups  # that have some
function consistency.check_report(report, rounding) end

return consistency
