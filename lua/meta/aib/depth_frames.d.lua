---@meta aib.depth_frames
error("Cannot require a meta file")

---Where every protocol of depth maps begins: pairs the files of two folders, scores them, says what was found.
---@class aib.depth_frames
---@field fields string[]  # every number of a frame, in the order of tables
local depth_frames = {}

---The inputs of pairing and of what is written beside the report, and those of the protocol.
---@param own table
---@return table inputs
function depth_frames.inputs(own) end

---The frames of which both maps are there, with `missing`, the names of the references without an estimate; an io
---error where there is none. In a pattern * is what pairs two files; "*" alone is any depth file, paired by its stem.
---@param folders { estimate: string, reference: string, estimate_pattern?: string, reference_pattern?: string, masks?: string, labels?: string }
---@return aib.DepthFrameFiles[] frames
function depth_frames.pair(folders) end

---Paths of the files of a folder that fit a pattern, by the name of their frame, and the names in the order of the files;
---an io error where there is none.
---@param folder string
---@param pattern string
---@return table<string, string> paths, string[] names
function depth_frames.files_in(folder, pattern) end

---The frame of an image: its name without folder and extension.
---@param image string
---@return string frame
function depth_frames.stem(image) end

---How the maps of a protocol's inputs are read: options of `aib.depth.evaluate`, which `own` completes.
---@param input table
---@param own table
---@return table options
function depth_frames.reading(input, own) end

---`aib.depth.evaluate` with progress.
---@param frames aib.DepthFrameFiles[]
---@param options table  # as `reading` gives them
---@return aib.Accumulator errors
function depth_frames.evaluate(frames, options) end

---Adds errors to a report; nil: dashes. `factors` turns numbers into other units: { abs_rel = { 100, "%" } }.
---@param errors aib.DepthErrors|nil
---@param report aib.Report
---@param how { metrics: string[], n?: integer, convention?: string, options?: table, factors?: table }
function depth_frames.report(errors, report, how) end

---Says which frames have no estimate or no valid pixel, and counts them.
---@param frames aib.DepthFrameFiles[]
---@param summary aib.DepthErrors|nil
---@param report aib.Report
function depth_frames.report_frames(frames, summary, report) end

---Writes the errors of each frame as CSV, in their order.
---@param path string
---@param frames aib.DepthErrors[]
function depth_frames.write_csv(path, frames) end

---Writes the error images of frames one below the other.
---@param path string
---@param records aib.DepthErrors[]  # the frames shown
---@param files aib.DepthFrameFiles[]
---@param options table  # as `reading` gives them
function depth_frames.write_sheet(path, records, files, options) end

---Writes what the inputs ask for beside the report.
---@param errors aib.Accumulator
---@param frames aib.DepthFrameFiles[]
---@param options table
---@param input table
function depth_frames.write(errors, frames, options, input) end

return depth_frames
