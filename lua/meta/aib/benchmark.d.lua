---@meta aib.benchmark
error("Cannot require a meta file")

---Benchmark folders. `benchmark.lua` in them is a data file, run without globals.
---@class aib.benchmark
local benchmark = {}

---@class aib.benchmark.Scene
---@field name string
---@field conditions? string[]
---@field poses string  # trajectory with image names: COLMAP model, transforms.json, ...
---@field cameras? string|table  # default: what the poses bring
---@field depth? string  # pattern of depth maps; {stem} and {name} stand for the image
---@field mesh? string
---@field points? string  # instead of samples of the mesh
---@field crop? table  # { min = {x, y, z}, max = {x, y, z} }: the part of space that is scored

---@class aib.benchmark.Result
---@field scene string
---@field condition? string
---@field models? string  # folder of COLMAP or GLOMAP models
---@field poses? string  # or a trajectory with image names
---@field cameras? string|table
---@field output? string  # instead of models and poses: folder of what a method left, see `aib.method.open`
---@field kind? string  # of the output, where its content is not to tell it
---@field names? string[]|string  # of the output's frames
---@field layout? aib.method.Layout  # of the output
---@field confidence? number  # points of the output's depth maps are kept above it
---@field confidence_rule? "raw"|"sigmoid"|"percentile"  # what its confidences are; the method's own
---@field depth? string  # pattern
---@field cloud? string  # point cloud; "model": the sparse points of the scored model
---@field frame? "method"|"reference"  # of cloud and depth; default: that of the parameters
---@field model? string  # sub-model whose frame it is; default: the scored one

---@class aib.benchmark.Method
---@field name string
---@field parameters "estimated"|"ground truth"
---@field results aib.benchmark.Result[]

---Opens a folder: { name =, scenes =, methods =, units =, files = }. `units` is every scene x condition x method; a
---unit's `result` is nil where the method has none. An error is one sentence with the place.
---@param folder string
---@return table
function benchmark.open(folder) end

return benchmark
