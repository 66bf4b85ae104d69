---@meta aib.units
error("Cannot require a meta file")

---Long evaluations in parts that are kept, reused, split into shards and merged to the same bytes: of each unit of work
---one for what needs all of its images, and one for every 32 images.
---@class aib.units
local units = {}

---@class aib.units.Job
---@field report aib.Report
---@field files table  # aib.files of the folder that the units read
---@field units table[]
---@field results? string  # folder that keeps finished parts
---@field shard? string  # "3/16"
---@field name fun(unit: table): string
---@field group fun(unit: table): table<string, string>
---@field describe fun(unit: table): table  # what it depends on besides files, as JSON
---@field n_images fun(unit: table): integer  # that are evaluated one by one
---@field evaluate fun(unit: table, part: aib.units.Part, range?: { first: integer, last: integer }): table[]  # fills part.report and part.frames, or, of a range of images, part.rows; the aib.files it read

---@class aib.units.Part
---@field name string
---@field unit integer  # number of its unit
---@field group table<string, string>
---@field frames table<string, { names: string[], values: number[] }>
---@field rows table[]  # of a range of images
---@field views? table[]  # for a page
---@field report? aib.Report  # while it is made

---Evaluates the parts of this shard or reads them back. Returns them in their order, and how many were reused. Where
---parts are kept, a line on stderr says which were made.
---@param job aib.units.Job
---@return aib.units.Part[] parts
---@return integer reused
function units.run(job) end

---The parts by unit.
---@param parts aib.units.Part[]
---@return aib.units.Part[][] units
function units.grouped(parts) end

---Adds what a part found to a report; its files are remembered.
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
