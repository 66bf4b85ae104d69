---@meta aib.units
error("Cannot require a meta file")

---Long evaluations in units of work that are kept, reused, split into shards and merged to the same bytes.
---@class aib.units
local units = {}

---@class aib.units.Job
---@field report aib.Report
---@field files table  # aib.files of the folder that the units read
---@field units table[]
---@field results? string  # folder that keeps finished units
---@field shard? string  # "3/16"
---@field name fun(unit: table): string
---@field group fun(unit: table): table<string, string>
---@field describe fun(unit: table): table  # what it depends on besides files, as JSON
---@field evaluate fun(unit: table, part: aib.units.Part): table[]  # fills part.report and part.frames; the aib.files it read

---@class aib.units.Part
---@field name string
---@field group table<string, string>
---@field frames table<string, { names: string[], values: number[] }>
---@field report? aib.Report  # while it is made

---Evaluates the units of this shard or reads them back, adds them to the report in their order, and returns the parts
---and how many were reused.
---@param job aib.units.Job
---@return aib.units.Part[] parts
---@return integer reused
function units.run(job) end

---Adds what a unit found to a report; its files are remembered.
---@param report aib.Report
---@param files table
---@param part aib.units.Part
function units.absorb(report, files, part) end

---The parts of all shards of a run in its order.
---@param shards { path: string, result: table }[]
---@return aib.units.Part[] parts
function units.joined(shards) end

---Place and number of shards of "3/16"; 1, 1 of nothing.
---@param text string|nil
---@return integer index
---@return integer count
function units.shard_of(text) end

return units
