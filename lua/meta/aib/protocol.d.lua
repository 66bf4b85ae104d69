---@meta aib.protocol
error("Cannot require a meta file")

---One input of a protocol. It is given as `--key value`, by place where it has one, or by name from Lua.
---@class aib.protocol.Input
---@field kind "text"|"path"|"file"|"folder"|"output"|"number"|"integer"|"choice"|"list"|"flag"
---@field default? any  # an input without one has to be given; a flag is false
---@field unit? string  # of a number: "5cm" is 0.05 where it is "m"
---@field min? number
---@field max? number
---@field above? number  # a bound that is not allowed itself: 0 of a length that has to be there
---@field choices? string[]  # of a choice
---@field ending? string  # of an output: ".png"
---@field of? string  # kind of a list's elements, default "path"
---@field position? integer  # also given by place; inputs without default are, by name, where none says so
---@field help? string

---@class aib.protocol.Spec
---@field name string  # as it is called on the command line
---@field title? string
---@field cite? string
---@field help? string
---@field inputs? table<string, aib.protocol.Input>
---@field run fun(input: table, report: aib.Report)
---@field finish? fun(input: table, report: aib.Report, parts: aib.units.Part[], files: table)  # what follows from all units, for aib-lua merge

---@class aib.Protocol
local protocol = {}

---Runs over inputs by name and returns what was found.
---@param inputs? table
---@param options? { draw: boolean }  # with what a page shows
---@return aib.Report
function protocol:run(inputs, options) end

---Runs as a program: prints the report, writes the files that were asked for.
---@param arguments string[]
---@return integer exit_code
function protocol:main(arguments) end
