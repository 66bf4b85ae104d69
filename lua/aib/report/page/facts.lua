-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What stands below the tables of a page: warnings, every number, and what a reader needs to repeat it.
local json = require "aib.json"
local markup = require "aib.report.markup"
local number = require "aib.report.number"
local suggest = require "aib.suggest"
local tables = require "aib.report.page.tables"

local element, text = markup.element, markup.text

local M = {}

function M.notes(report)
  local items = {}
  for i, line in ipairs(report:note_lines()) do items[i] = text("li", {}, line) end
  if #items == 0 then return text("p", {}, "Nothing was missing, doubtful or impossible.") end
  return element("ul", { class = "notes" }, table.concat(items, "\n"))
end

local function option_text(options)
  local parts = {}
  for _, key in ipairs(suggest.keys(options or {})) do
    local value = options[key]
    parts[#parts + 1] = ("%s %s"):format(key, type(value) == "table" and json.encode(value) or tostring(value))
  end
  return table.concat(parts, ", ")
end

--- Every record, a row each.
function M.numbers(report)
  local keys, rows, groups = report:group_keys(), {}, {}
  local heads = table.move(keys, 1, #keys, 1, {})
  table.move({ "metric", "value", "unit", "n", "convention", "depends on" }, 1, 6, #heads + 1, heads)
  for i, r in ipairs(report:records()) do
    local row = {}
    for k, key in ipairs(keys) do row[k] = r.group[key] or "" end
    table.move({ r.name, r.value and number.short(r.value) or "–", r.unit or "", r.n and json.number(r.n) or "",
      r.convention or "", option_text(r.options) }, 1, 6, #row + 1, row)
    rows[i], groups[i] = row, r.group
  end
  return tables.plain("plain numbers", heads, rows, function(i)
    return { ["data-group"] = next(groups[i]) and json.encode(groups[i]) or nil }
  end)
end

--- A word of a shell's command line.
local function quoted(word)
  if word:find("^[%w_./,:=+-]+$") then return word end
  return "'" .. word:gsub("'", "'\\''") .. "'"
end

--- The command that gives these numbers; what lies elsewhere on another machine is named in capitals.
local function command(report)
  local words = { "aib-lua", report.name }
  for _, key in ipairs(report.store.places or {}) do words[#words + 1] = key end
  for _, key in ipairs(suggest.keys(report.store.inputs)) do
    local value = report.store.inputs[key]
    local option = "--" .. key:gsub("_", "-")
    if type(value) == "table" then
      local parts = {}
      for i, x in ipairs(value) do parts[i] = tostring(x) end
      value = table.concat(parts, ",")
    end
    if value == true then words[#words + 1] = option end
    if value ~= "" and type(value) ~= "boolean" then
      words[#words + 1] = option .. " " .. quoted(tostring(value))
    end
  end
  return table.concat(words, " ")
end

local function definitions(list)
  local out = {}
  for i, pair in ipairs(list) do out[i] = text("dt", {}, pair[1]) .. text("dd", {}, pair[2]) end
  return element("dl", {}, table.concat(out))
end

function M.provenance(report)
  local out, conventions, sources = {}, {}, {}
  out[1] = text("p", {}, "The numbers depend on what is listed here and on nothing else: no date, path or machine.")
  out[2] = text("h3", {}, "Command") .. text("pre", {}, command(report))
  local about = { { "aib", report.version or "" }, { "protocol", report.name } }
  if report.cite then about[3] = { "cite", report.cite } end
  out[3] = definitions(about)
  for i, key in ipairs(suggest.keys(report.store.conventions)) do
    conventions[i] = { key, report.store.conventions[key] }
  end
  if #conventions > 0 then out[#out + 1] = text("h3", {}, "Conventions") .. definitions(conventions) end
  for i, name in ipairs(suggest.keys(report.store.sources)) do
    local print = report.store.sources[name]
    sources[i] = { name, json.number(print.bytes), print.sha256 }
  end
  if #sources > 0 then
    out[#out + 1] = element("details", {}, text("summary", {}, ("Input files (%d), by content"):format(#sources))
      .. tables.plain("plain", { "file", "bytes", "SHA-256" }, sources))
  end
  return table.concat(out, "\n")
end

return M
