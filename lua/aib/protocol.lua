-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Protocols: an evaluation with typed inputs, a command line, and results in every format.
---
---   return aib.protocol {
---     name = "depth_errors", cite = "...", help = "Scores depth maps of a folder.",
---     inputs = { est = { kind = "file", help = "..." }, max_depth = { kind = "number", unit = "m", default = 80 } },
---     run = function(input, report) report:add("rmse", ..., { unit = "m", better = "lower" }) end,
---   }
---
--- finish = function(input, report, parts, files) says what follows from all units of aib.units, for aib-lua merge.
local aib = require "aib"
local command_line = require "aib.command_line"
local failure = require "aib.failure"
local inputs = require "aib.inputs"
local new_report = require("aib.report").new
local progress = require "aib.progress"
local suggest = require "aib.suggest"

local protocol = {}
protocol.__index = protocol
protocol.__name = "aib.protocol"
protocol.__tostring = function(self) return ("protocol(%s)"):format(self.name) end

local fields <const> = { name = "string", title = "string", cite = "string", help = "string", inputs = "table",
  run = "function", finish = "function" }
local exit <const> = { ok = 0, script = 1, usage = 2, input = 3, stopped = 130 }
local exit_of_kind <const> = { io = exit.input, format = exit.input, stopped = exit.stopped }

--- Places of inputs on a command line: those with a position, else those that have to be given, by name.
local function give_places(list)
  local placed = {}
  for _, input in ipairs(list) do
    if input.position then placed[#placed + 1] = input end
  end
  if #placed > 0 then
    table.sort(placed, function(a, b) return a.position < b.position end)
  else
    for _, input in ipairs(list) do
      if input.default == nil then placed[#placed + 1] = input end
    end
  end
  for place, input in ipairs(placed) do input.place = place end
end

local function check_spec(spec, level)
  if type(spec) ~= "table" then error("aib.protocol: a table expected, found " .. type(spec), level + 1) end
  suggest.check_types("aib.protocol", spec, fields, level + 1)
  if not spec.name then error("aib.protocol: name: a string expected", level + 1) end
  if not spec.run then error("aib.protocol: run: a function expected", level + 1) end
end

local lies_elsewhere <const> = { folder = true, path = true, output = true }

--- Files are told by their name and content in a report, folders not at all: the numbers do not depend on where they
--- lie.
local function state_inputs(report, list, values)
  local function state_file(path)
    local name = path:match("[^/]*$")
    while report.store.sources[name] do name = name .. "'" end
    report:source(name, aib.system.fingerprint(path))
    return name
  end
  for _, input in ipairs(list) do
    local value, kind = values[input.key], input.kind == "list" and (input.of or "path") or input.kind
    if kind == "file" then
      if input.kind == "list" then
        local names = {}
        for i, path in ipairs(value) do names[i] = state_file(path) end
        value = names
      else
        value = state_file(value)
      end
    end
    if not lies_elsewhere[kind] then
      report.store.inputs[input.key] = value
    elseif input.default == nil then
      table.insert(report.store.places, inputs.label(input))
    end
  end
end

--- Runs the protocol over inputs by name and returns the report. Errors of the script pass; where a metric that the
--- script did not guard is undefined, the report ends there with a note. options.draw: with what a page shows.
function protocol:run(values, options)
  local report = new_report { name = self.name, title = self.title, cite = self.cite, version = aib.version }
  if options and options.draw then report:draw() end
  local function wrong(sentence) failure.raise("argument", self.name .. ": " .. sentence) end
  local input = inputs.complete(self.inputs, values or {}, wrong)
  state_inputs(report, self.inputs, input)
  local _, reason = report:attempt(function() self.body(input, report) end)
  if reason then report:note("", "the evaluation ended early: " .. reason) end
  return report
end

local function print_error(text) io.stderr:write(text, "\n") end

local function traced(value) return { value = value, trace = failure.trace(value) } end

--- Of which kinds of errors a sentence is told; of the others, which are mistakes of the script, the trace.
local sentence_of_kind <const> = { io = true, format = true, output = true, argument = true, stopped = true }

--- Says what went wrong; of what the library refused, with the line of the script. Returns the exit code.
local function explain(self, caught)
  if type(caught) == "string" then caught = { value = caught, trace = caught } end  -- Lua had no memory for the trace
  if type(caught.value) == "table" and caught.value.usage then
    print_error(("%s: %s (see --help)"):format(self.name, caught.value.usage))
    return exit.usage
  end
  local kind = failure.kind(caught.value)
  if sentence_of_kind[kind] or failure.is_memory(caught.value) then
    local sentence, position = failure.message(caught.value)
    local where = kind == "argument" and position and (" (%s)"):format(position) or ""
    print_error(self.name .. ": " .. sentence .. where)
  else
    print_error(caught.trace)
  end
  return exit_of_kind[kind] or exit.script
end

--- Runs the protocol as a program. Returns the exit code: 0 ok, 1 it failed or its results cannot be written, 2 the
--- command line is not understood, 3 an input file is bad, 130 interrupted.
function protocol:main(arguments)
  local call
  local ok, caught = xpcall(function()
    call = command_line.parse(self, arguments)
    if call.quiet then progress.silence() end
    if call.threads then aib.system.use_threads(call.threads) end
    if call.help then
      io.stdout:write(command_line.help(self))
    else
      command_line.show(self:run(call.inputs, { draw = call.outputs.html ~= nil }), call)
    end
  end, traced)
  return ok and exit.ok or explain(self, caught)
end

--- Makes a protocol; the result of the script that declares it.
return function(spec)
  check_spec(spec, 2)
  local list = {}
  for _, key in ipairs(suggest.keys(spec.inputs or {})) do
    if command_line.reserved[key] then
      error(("aib.protocol: input '%s': the name is taken by every protocol's --%s"):format(key, key), 2)
    end
    list[#list + 1] = inputs.declare(key, spec.inputs[key], 2)
  end
  give_places(list)
  return setmetatable({
    name = spec.name, title = spec.title or spec.name, cite = spec.cite, help = spec.help, inputs = list,
    body = spec.run, finish = spec.finish,
  }, protocol)
end
