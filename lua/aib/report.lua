-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What a protocol found: records in the order in which they were added, notes, and the tables that show them.
--- One record list feeds every format (aib.report.terminal, markdown, latex, html, csv, json).
local failure = require "aib.failure"
local grids = require "aib.report.grid"
local suggest = require "aib.suggest"
local views = require "aib.report.views"

local report = {}
report.__index = report

-- What a page draws: report:curve, report:cloud, ...
for name, method in pairs(views) do report[name] = method end

--- aib.report.plot and montage are loaded where they are used first.
local drawn_elsewhere <const> = { plot = true, montage = true }
setmetatable(report, {
  __index = function(_, name) return drawn_elsewhere[name] and require("aib.report." .. name) or nil end,
})

local directions <const> = { lower = true, higher = true }

local add_fields <const> = {
  unit = "string", better = "string", n = "number", group = "table", convention = "string", options = "table",
  note = "string",
}

--- A new report. info = { name=, title=, cite=, version= }
function report.new(info)
  local store = { records = {}, notes = {}, tables = {}, conventions = {}, inputs = {}, sources = {}, places = {},
    noted = {} }
  return setmetatable({
    name = info.name, title = info.title or info.name, cite = info.cite, version = info.version,
    group = {}, store = store,
  }, report)
end

--- The same report, where every record is of this group too:
---   local cell = report:within { scene = "crane", method = "COLMAP" }
function report:within(group)
  local merged = {}
  for key, value in pairs(self.group) do merged[key] = value end
  for key, value in pairs(group) do merged[key] = tostring(value) end
  local view = setmetatable({ group = merged }, { __index = self })
  return view
end

--- "crane / high / COLMAP": what a group is called in notes.
function report:group_name()
  local parts = {}
  for _, key in ipairs(report.ordered_keys { self.group }) do parts[#parts + 1] = self.group[key] end
  return table.concat(parts, " / ")
end

local leading_keys <const> = { "scene", "condition", "method", "model", "batch" }

--- The keys that occur in `groups`: scene, condition, method, model, batch first, others by name.
function report.ordered_keys(groups)
  local present, keys = {}, {}
  for _, group in ipairs(groups) do
    for key in pairs(group) do present[key] = true end
  end
  for _, key in ipairs(leading_keys) do
    if present[key] then keys[#keys + 1] = key end
    present[key] = nil
  end
  for _, key in ipairs(suggest.keys(present)) do keys[#keys + 1] = key end
  return keys
end

--- The same text for groups of the same content.
local function group_id(group)
  local parts = {}
  for _, key in ipairs(suggest.keys(group)) do parts[#parts + 1] = key .. "\0" .. group[key] end
  return table.concat(parts, "\1")
end

local function check_options(name, options, level)
  suggest.check_types("report:add " .. name, options, add_fields, level + 1)
  if options.better and not directions[options.better] then
    error(('report:add %s: better: "lower" or "higher" expected, found "%s"'):format(name, options.better), level + 1)
  end
end

local function keep_trace(caught)
  if failure.kind(caught) ~= "undefined" then failure.trace(caught) end
  return caught
end

--- The result of a function, or nil and the reason where what it computes is undefined (no valid pixel, no pair);
--- `what` is noted then. Other errors pass.
---   local errors = report:attempt(function() return aib.depth.errors(est, ref) end, "depth")
function report:attempt(compute, what)
  local ok, result = xpcall(compute, keep_trace)
  if ok then return result end
  if failure.kind(result) ~= "undefined" then error(result, 0) end
  local reason = failure.message(result)
  if what then self:note(("%s: %s"):format(what, reason)) end
  return nil, reason
end

--- Adds a number.
---
--- value    a number; nil: there is none (a dash); or a function that returns it: where that is undefined, a dash with
---          a note
--- options  unit, better = "lower" | "higher", n = count behind it, group = { scene=, method=, condition= },
---          convention = which definition, options = table of what it depends on, note = why there is none
---
--- Returns the value.
function report:add(name, value, options)
  options = options or {}
  check_options(name, options, 2)
  local note = options.note
  if type(value) == "function" then
    local reason
    value, reason = self:attempt(value)
    note = note or reason
  end
  if value ~= nil and type(value) ~= "number" then
    error(("report:add %s: a number expected, found %s"):format(name, type(value)), 2)
  end
  if value and value ~= value then value, note = nil, note or "not a number" end
  local view = options.group and self:within(options.group) or self
  self:insert {
    name = name, value = value, unit = options.unit, better = options.better, n = options.n, group = view.group,
    convention = options.convention, options = options.options, note = note,
  }
  if note then view:note(view:group_name(), ("%s: %s"):format(name, note)) end
  return value
end

function report:insert(record)
  local list = self.store.records
  record.group_id = group_id(record.group)
  list[#list + 1] = record
end

--- Adds a sentence for the reader, under a key or under the name of the group; the same one is kept once.
function report:note(key, text)
  if text == nil then key, text = self:group_name(), key end
  local id = key .. "\0" .. text
  if self.store.noted[id] then return end
  self.store.noted[id] = true
  local list = self.store.notes
  list[#list + 1] = { key = key, text = text }
end

--- States a convention that every record follows: report:convention("depth", "mean over frames").
function report:convention(key, text) self.store.conventions[key] = text end

--- Names a file that the numbers come from, with its content hash, under a name that does not depend on the machine.
function report:source(label, fingerprint) self.store.sources[label] = fingerprint end

--- Adds a table, see aib.report.grid.
function report:table(spec)
  grids.check(spec, 2)
  local list = self.store.tables
  list[#list + 1] = spec
end

function report:records() return self.store.records end
function report:notes() return self.store.notes end

--- The notes as sentences; what is said of several groups is said once.
function report:note_lines()
  local lines, keys = {}, {}
  for _, note in ipairs(self.store.notes) do
    if not keys[note.text] then
      keys[note.text] = {}
      lines[#lines + 1] = note.text
    end
    if note.key ~= "" then table.insert(keys[note.text], note.key) end
  end
  for i, text in ipairs(lines) do
    if #keys[text] == 1 then lines[i] = keys[text][1] .. ": " .. text end
    if #keys[text] > 1 then lines[i] = ("%s (%s)"):format(text, table.concat(keys[text], "; ")) end
  end
  return lines
end

--- Keys of the records' groups in the order of tables.
function report:group_keys()
  local groups = {}
  for i, record in ipairs(self.store.records) do groups[i] = record.group end
  return report.ordered_keys(groups)
end

--- The tables as grids; where none was asked for, one of all records.
function report:grids()
  local specs = self.store.tables
  if #specs == 0 then specs = grids.default(self) end
  local out = {}
  for _, spec in ipairs(specs) do out[#out + 1] = grids.build(spec, self) end
  return out
end

return report
