---@meta aib.results
error("Cannot require a meta file")

---Reading back what reports wrote as JSON.
---@class aib.results
local results = {}

---The content of a result file; its records have a `place`: metric and group as one text. A format error where the file
---breaks results.schema.json, or a shard was changed since it was written.
---@param path string
---@return table
function results.read(path) end

---What two records of one place were computed by differently, as a sentence; nil where they can be compared.
---@param a table
---@param b table
---@return string|nil
function results.difference(a, b) end

return results
