-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A report as one HTML page that opens from disk: tables, figures, warnings and provenance are there without a script;
--- with the bundle in the binary (lua/report) they sort, explain themselves and open frames, and the geometry is seen.
local json = require "aib.json"
local facts = require "aib.report.page.facts"
local data = require "aib.report.page.data"
local figures_of = require("aib.report.figures").of
local figure_page = require "aib.report.page.figures"
local markup = require "aib.report.markup"
local shell = require "aib.shell"
local tables = require "aib.report.page.tables"

local element, text = markup.element, markup.text

local without_script <const> = "This aib-lua was built without the page's script (Node.js was missing), so that "
  .. "sorting, frames and the 3-D view are not here. Tables, figures and numbers are complete."

--- No request leaves the page, whatever a label holds.
local policy <const> = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:"

local function section(id, title, content)
  if not content or content == "" then return nil end
  local heading = text("h2", { id = id .. "-title" }, title)
  return { id = id, title = title,
    html = element("section", { id = id, ["aria-labelledby"] = id .. "-title" }, heading .. content) }
end

local function all(list, make)
  local out = {}
  for i, item in ipairs(list) do out[i] = make(item) end
  return table.concat(out, "\n")
end

--- The figures of each scene and condition together, in the order of their first ones.
local function by_place(figures)
  local places, index = {}, {}
  for _, figure in ipairs(figures) do
    local where = figure.where or ""
    if not index[where] then
      index[where] = { title = where, group = figure.group, figures = {} }
      places[#places + 1] = index[where]
    end
    table.insert(index[where].figures, figure)
  end
  return places
end

local function figures_of_place(place)
  local title = place.title ~= "" and place.title or place.figures[1].kind == "interval" and "Intervals"
  title = title and text("h3", {}, title) or ""
  local group = place.group and next(place.group) and json.encode(place.group)
  return element("div", { class = "place", ["data-group"] = group }, title
    .. element("div", { class = "figures" }, all(place.figures, figure_page.figure)))
end

local function has_view(report, ...)
  for _, view in ipairs(report.store.views or {}) do
    for _, kind in ipairs { ... } do
      if view.kind == kind then return true end
    end
  end
end

--- The sections that have content, in their order. Frames and geometry are filled by the script.
local function sections_of(report, figures, script)
  local places = {}
  for i, record in ipairs(report:records()) do places[record] = i - 1 end
  local scripted = script ~= ""
  local candidates = {
    section("overview", "Overview", element("div", { class = "grids" },
      all(report:grids(), function(grid) return tables.table(grid, places) end))),
    section("figures", "Figures", all(by_place(figures), figures_of_place)),
    section("geometry", "Geometry", scripted and has_view(report, "cloud", "mesh", "cameras")
      and element("div", { id = "viewer" }, "")),
    section("frames", "Frames", scripted and has_view(report, "frame") and element("div", { id = "triptych" }, "")),
    section("notes", "Notes and warnings", facts.notes(report)),
    section("numbers", "Every number", element("details", {},
      text("summary", {}, ("%d numbers"):format(#report:records())) .. facts.numbers(report))),
    section("provenance", "How to repeat it", facts.provenance(report)),
  }
  local list = {}
  for i = 1, 7 do list[#list + 1] = candidates[i] end
  return list
end

local function navigation(sections)
  return element("nav", { ["aria-label"] = "Sections" }, all(sections, function(s)
    return text("a", { href = "#" .. s.id }, s.title)
  end))
end

local function footer(licences)
  local own = text("p", {}, "Written by aib-lua; the page holds everything it shows and asks no network.")
  if licences == "" then return element("footer", {}, own) end
  return element("footer", {}, own .. element("details", {}, text("summary", {}, "Licences of the page's libraries")
    .. text("pre", {}, licences)))
end

local function head(title, style)
  return table.concat({
    '<head>\n<meta charset="utf-8">', '<meta name="viewport" content="width=device-width, initial-scale=1">',
    '<meta http-equiv="Content-Security-Policy" content="' .. policy .. '">',
    text("title", {}, title), "<style>\n" .. style .. "</style>\n</head>",
  }, "\n")
end

return function(report)
  local script, licences = shell.text("report/page.js"), shell.text("report/licences.txt")
  local figures = figures_of(report)
  local sections = sections_of(report, figures, script)
  local about = report.cite and text("p", { class = "cite" }, report.cite) or ""
  local body = {
    element("header", {}, element("div", { id = "bar" }, navigation(sections)) .. text("h1", {}, report.title)
      .. about),
    script == "" and text("p", { class = "warning" }, without_script) or "",
    element("main", {}, all(sections, function(s) return s.html end)),
    footer(licences),
    script ~= "" and data.elements(report, figures) .. "\n<script>\n" .. script .. "</script>" or "",
  }
  return '<!DOCTYPE html>\n<html lang="en">\n' .. head(report.title, shell.text("report/page.css")) .. "\n<body>\n"
    .. table.concat(body, "\n") .. "\n</body>\n</html>\n"
end
