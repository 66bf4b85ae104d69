---@meta aib.report
error("Cannot require a meta file")

---What a protocol found: records, notes, and the tables that show them. One record list feeds every format.
---@class aib.report
local report = {}

---@class aib.Report
local instance = {}

---@class aib.report.Options
---@field unit? string
---@field better? "lower"|"higher"  # the best is bold, an arrow stands in the title
---@field n? number  # how many frames, pairs, points are behind it
---@field group? table<string, string>  # scene, condition, method, or keys of your own
---@field convention? string  # which of several definitions
---@field options? table  # what the number depends on
---@field note? string  # why there is none

---Adds a number and returns it. nil is a dash; a function is called, and where what it computes is undefined the number
---is a dash with a note.
---@param name string
---@param value number|nil|fun(): number
---@param options? aib.report.Options
---@return number|nil
function instance:add(name, value, options) end

---The same report, where every record is of this group too.
---@param group table<string, string>
---@return aib.Report
function instance:within(group) end

---Adds a sentence under a key, or, with one argument, under the name of the group.
---@param key string
---@param text? string
function instance:note(key, text) end

---The result of a function; nil and the reason where it is undefined. Other errors pass.
---@param compute function
---@param what? string  # noted with the reason
---@return any result, string|nil reason
function instance:attempt(compute, what) end

---States a convention that the records follow.
---@param key string
---@param text string
function instance:convention(key, text) end

---Names a file that the numbers come from, with its content hash.
---@param label string
---@param fingerprint table  # as aib.system.fingerprint gives it
function instance:source(label, fingerprint) end

---@class aib.report.Table
---@field title string  # unit and arrow are added
---@field metrics (string|table)[]  # names, or { "name", label = "AUC30", percent = true }
---@field down? string[]  # group keys, "metric" among them; default { "method" }
---@field across? string[]  # the same; default { "scene", "condition" }
---@field beside? table[]  # { metric = "name", percent = true } or { field = "n" }: stands beside every value
---@field bold_from? table  # { metric = "depth.coverage", at_least = 0.5 }: below it no value is the best
---@field notes? string[]

---Adds a table. Without any, a report shows all records in one.
---@param spec aib.report.Table
function instance:table(spec) end

---The records in their order: name, value, unit, better, n, group, convention, options, note.
---@return table[]
function instance:records() end

---A new report.
---@param info table  # name, title, cite, version
---@return aib.Report
function report.new(info) end

return report
