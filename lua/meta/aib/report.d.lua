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

---@class aib.report.Axis
---@field label? string
---@field unit? string
---@field scale? "linear"|"log"
---@field low? number  # with high: the bounds, else those of the data
---@field high? number

---Whether a page was asked for. Only then do the functions below do something: what is dear to compute for them alone
---is computed where this holds.
---@return boolean
function instance:draws() end

---Asks for what a page draws; `--html` does.
function instance:draw() end

---A line of a figure. Lines of one title, whose groups differ in the method alone, share a figure.
---@param spec { title: string, x: aib.report.Axis, y: aib.report.Axis, at: number[], values: number[], label?: string, text?: string, steps?: boolean, equal?: boolean }  # equal: the same length of a unit on both axes
function instance:curve(spec) end

---Numbers of frames along the flight; a click opens the frame where there is one.
---@param spec { title: string, y: aib.report.Axis, frames: string[], values: number[], label?: string, text?: string }
function instance:timeline(spec) end

---A value with its interval; those of one title share a figure. Records "x", "x_low" and "x_high" are drawn without.
---@param spec { title: string, value: number, low: number, high: number, unit?: string, label?: string, text?: string }
function instance:interval(spec) end

---Estimate, truth and relative error of a frame, at most 240 columns of each.
---@param spec { name: string, estimate: aib.DepthMap, reference: aib.DepthMap, transform?: aib.Affine, errors?: table<string, number> }
function instance:frame(spec) end

---Points in space, at most `limit` (100 000), in the colours of one value each.
---@param spec { role: "estimate"|"reference", cloud: aib.Cloud, values?: aib.Distances|aib.Offsets|number[], label?: string, unit?: string, limit?: integer }
function instance:cloud(spec) end

---A mesh in space, with values of its faces.
---@param spec { mesh: aib.Mesh, faces?: { label: string, unit: string, values: number[] }[] }
function instance:mesh(spec) end

---Cameras in space, joined by name to the true ones; those in `missing` are marked.
---@param spec { estimate: aib.Trajectory, reference: aib.Trajectory, missing?: string[], errors?: table<string, number> }
function instance:cameras(spec) end

---Estimate, truth and relative error of depth maps as one picture, a row a frame. Maps that are paths are read with
---the options `estimate` and `reference` of `aib.io.read_depth`, the truth at the size of the estimate.
---@param frames { estimate: aib.DepthMap|string, reference: aib.DepthMap|string, transform?: aib.Affine }[]
---@param options? { columns: integer, width: integer, estimate: table, reference: table, rule: "centre"|"floor" }  # 1 column, 960 pixels a row
---@return aib.Image sheet
function report.montage(frames, options) end

---A new report.
---@param info table  # name, title, cite, version
---@return aib.Report
function report.new(info) end

return report
