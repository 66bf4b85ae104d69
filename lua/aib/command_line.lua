-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The command line of a protocol: parsing, --help, and where its results go.
local aib = require "aib"
local inputs = require "aib.inputs"
local number = require "aib.report.number"
local suggest = require "aib.suggest"
local text = require "aib.report.text"

local M = {}

local formats <const> = { "json", "csv", "markdown", "latex", "html" }
local format_help <const> = {
  json = "every number with its convention, options and sources", csv = "the records, a line each",
  markdown = "the tables as Markdown", latex = "the tables as LaTeX (booktabs)",
  html = "a page that opens from disk: tables, charts, frames, 3-D",
}

--- Names that no input can have.
M.reserved = { help = true, quiet = true, threads = true, sandbox = true }
for _, format in ipairs(formats) do M.reserved[format] = true end

local threads <const> = { key = "threads", kind = "integer", min = 0, max = 65536 }

local function by_option_name(protocol)
  local known = {}
  for _, input in ipairs(protocol.inputs) do known[input.key] = input end
  return known
end

local function option_names(protocol)
  local names = { "--help", "--quiet", "--threads" }
  for _, format in ipairs(formats) do names[#names + 1] = "--" .. format end
  for _, input in ipairs(protocol.inputs) do names[#names + 1] = "--" .. input.key:gsub("_", "-") end
  table.sort(names)
  return names
end

--- A list grows with each time that it is given.
local function give(values, input, value)
  if input.kind == "list" and values[input.key] then
    table.move(value, 1, #value, #values[input.key] + 1, values[input.key])
  else
    values[input.key] = value
  end
end

local parser = {}
parser.__index = parser

local function wrong(sentence) error({ usage = sentence }, 0) end

function parser:next_value(name)
  self.at = self.at + 1
  local value = self.arguments[self.at]
  if value == nil then wrong(("--%s: a value is missing"):format(name)) end
  return value
end

function parser:option(name, value)
  local key = name:gsub("-", "_")
  if M.reserved[key] then return self:common_option(key, value) end
  local input = self.known[key]
  local negated = not input and key:match("^no_(.*)")
  if negated and self.known[negated] and self.known[negated].kind == "flag" and not value then
    self.call.inputs[negated] = false
    return
  end
  if not input then
    wrong(("unknown option '--%s'%s"):format(name, suggest.hint("--" .. name, option_names(self.protocol))))
  end
  if input.kind == "flag" and not value then value = "true" end
  give(self.call.inputs, input, inputs.parse(input, value or self:next_value(name), wrong))
end

function parser:common_option(key, value)
  if key == "help" or key == "quiet" then
    if value then wrong(("--%s takes no value, found '%s'"):format(key, value)) end
    self.call[key] = true
    return
  end
  if key == "sandbox" then wrong("--sandbox goes before the name: aib-lua --sandbox " .. self.protocol.name) end
  if key == "threads" then
    self.call.threads = inputs.value(threads, value or self:next_value(key), wrong)
    return
  end
  self.call.outputs[key] = inputs.value({ key = key, kind = "output" }, value or self:next_value(key), wrong)
end

--- Gives the arguments without a name to the places that no option has filled, in their order. The first list among
--- them takes those that are more than there are places.
function parser:fill_places()
  local open = {}
  for _, input in ipairs(self.places) do
    if input.kind == "flag" or self.call.inputs[input.key] == nil then open[#open + 1] = input end
  end
  local surplus = math.max(0, #self.unnamed - #open)
  local at = 0
  for _, input in ipairs(open) do
    local take = 1
    if input.kind == "list" then take, surplus = 1 + surplus, 0 end
    for _ = 1, take do
      at = at + 1
      if self.unnamed[at] then give(self.call.inputs, input, inputs.parse(input, self.unnamed[at], wrong)) end
    end
  end
  if not self.unnamed[at + 1] then return end
  local most = at == 0 and "no argument" or number.count(at, "argument") .. " at most"
  wrong(("%s expected, found '%s' too"):format(most, self.unnamed[at + 1]))
end

function parser:run()
  local only_places = false
  while self.at < #self.arguments do
    self.at = self.at + 1
    local argument = self.arguments[self.at]
    local name, value = argument:match("^%-%-([^=]+)=(.*)$")
    if only_places or not argument:find("^%-.") then
      self.unnamed[#self.unnamed + 1] = argument
    elseif argument == "--" then
      only_places = true
    elseif argument == "-h" then
      self.call.help = true
    elseif argument:find("^%-%-") then
      self:option(name or argument:sub(3), value)
    else
      wrong(("unknown option '%s'%s"):format(argument, suggest.hint(argument, option_names(self.protocol))))
    end
  end
end

local function in_places(protocol)
  local places = {}
  for _, input in ipairs(protocol.inputs) do
    if input.place then places[input.place] = input end
  end
  return places
end

--- The call that the arguments make: { inputs = values by name, outputs = path by format, help =, quiet =, threads = }.
--- Raises { usage = sentence } where they are not understood.
function M.parse(protocol, arguments)
  local self = setmetatable({
    protocol = protocol, arguments = arguments, at = 0, unnamed = {}, places = in_places(protocol),
    known = by_option_name(protocol), call = { inputs = {}, outputs = {} },
  }, parser)
  self:run()
  if self.call.help then return self.call end
  self:fill_places()
  self.call.inputs = inputs.complete(protocol.inputs, self.call.inputs, wrong)
  return self.call
end

-- Help ----------------------------------------------------------------------------------------------------------------

local function value_name(input)
  if input.kind == "flag" then return "" end
  if input.kind == "choice" then return " " .. table.concat(input.choices, "|") end
  if input.kind == "list" then return " A,B,..." end
  if input.kind == "integer" then return " N" end
  if input.kind == "number" then return " X" .. (input.unit or "") end
  if input.kind == "output" then return " FILE" end
  return " " .. input.kind:upper()
end

local function default_text(input)
  if input.default == nil or input.kind == "flag" then return "" end
  local value = type(input.default) == "table" and table.concat(input.default, ",") or tostring(input.default)
  return value == "" and "" or (" (default %s)"):format(value)
end

local function add_lines(out, left, words)
  local indent = 26
  local lines = text.wrapped(words, 79 - indent)
  if #left + 4 > indent then
    out[#out + 1] = "  " .. left
    left = ""
  end
  out[#out + 1] = "  " .. text.left(left, indent - 2) .. (lines[1] or "")
  for i = 2, #lines do out[#out + 1] = (" "):rep(indent) .. lines[i] end
end

--- The text of --help.
function M.help(protocol)
  local usage = { "usage: aib-lua " .. protocol.name .. " [options]" }
  for _, input in ipairs(protocol.inputs) do
    if not input.place and input.default == nil then usage[#usage + 1] = inputs.label(input) .. value_name(input) end
  end
  for _, input in ipairs(in_places(protocol)) do
    local label = inputs.label(input) .. (input.kind == "list" and "..." or "")
    usage[#usage + 1] = input.default == nil and label or "[" .. label .. "]"
  end
  local out = { table.concat(usage, " "), "" }
  if protocol.help then
    for _, line in ipairs(text.wrapped(protocol.help, 79)) do out[#out + 1] = line end
    out[#out + 1] = ""
  end
  for _, input in ipairs(in_places(protocol)) do
    add_lines(out, inputs.label(input), (input.help or input.kind) .. default_text(input))
  end
  local options = {}
  for _, input in ipairs(protocol.inputs) do
    if not input.place then
      add_lines(options, inputs.label(input) .. value_name(input), (input.help or "") .. default_text(input))
    end
  end
  if #options > 0 then
    out[#out + 1] = "\noptions:"
    table.move(options, 1, #options, #out + 1, out)
  end
  out[#out + 1] = "\nresults:"
  for _, format in ipairs(formats) do add_lines(out, ("--%s FILE"):format(format), format_help[format]) end
  add_lines(out, "--quiet", "print nothing but errors")
  add_lines(out, "--threads N", "threads of the library (0, the default: all)")
  if protocol.cite then out[#out + 1] = "\ncite: " .. protocol.cite end
  return table.concat(out, "\n") .. "\n"
end

-- Results -------------------------------------------------------------------------------------------------------------

local function terminal_style()
  local is_terminal = aib.system.is_terminal("stdout")
  local plain = os.getenv("NO_COLOR") or os.getenv("TERM") == "dumb"
  return {
    columns = math.max(40, math.tointeger(tonumber(os.getenv("COLUMNS") or "")) or aib.system.columns("stdout")),
    color = is_terminal and not plain or nil,
  }
end

--- Shows a report and writes the files that were asked for, each in one step and only when all are made.
function M.show(report, call)
  local contents = {}
  for format in pairs(call.outputs) do contents[format] = require("aib.report." .. format)(report) end
  if not call.quiet then io.stdout:write(require("aib.report.terminal")(report, terminal_style())) end
  for _, format in ipairs(formats) do
    if contents[format] then aib.system.write_text(call.outputs[format], contents[format]) end
  end
end

return M
