---@meta aib

---Evaluation of 3D reconstructions. The order of arguments is estimate, reference, options; shares are 0..1, angles
---degrees, lengths the unit of the input. A metric over nothing raises an error of the kind "undefined".
---@class aib
---@field version string
---@field instruction_set "avx512"|"avx2"|"sse2"|"plain"  # what the binary was built for
local aib = {}

---Kind of a caught error, from its message: "argument" (the call is wrong), "io" (a file cannot be read),
---"output" (one cannot be written), "format" (its content is wrong), "undefined" (a metric over nothing), "stopped" (Ctrl-C), "internal" (a bug of aib),
---"script" (any error of Lua code).
---@param message any  # what pcall gave
---@return "argument"|"io"|"output"|"format"|"undefined"|"stopped"|"internal"|"script" kind
function aib.error_kind(message) end

---Name of a value's type: "cloud" of a cloud, else what Lua's own type gives.
---@param value any
---@return string name
function aib.type(value) end

---Makes a protocol: an evaluation with typed inputs, a command line, and results in every format.
---
---A script that returns one gets `--help`, typed options, progress, and `--json`, `--csv`, `--markdown`, `--latex` and
---`--html` for nothing. Exit codes: 0 ok, 1 the script failed, 2 the command line is not understood, 3 an input file is
---bad, 130 interrupted. A metric that is undefined is a dash with a note. An unknown field or kind is an error with a
---suggestion.
---@param spec aib.protocol.Spec
---@return aib.Protocol
function aib.protocol(spec) end

return aib
