-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The page as a text: what it holds without a browser, and that no label breaks out of its place.
local aib = require "aib"
local html = require "aib.report.html"

local here <const> = arg[0]:match("^(.*)/[^/]*$") or "."

local nasty <const> = "</script><script>alert(1)</script><img src=x onerror=\"alert('2')\">&amp;\u{2028}"

local function report_of(add, drawn)
  local report = aib.report.new { name = "demo", title = nasty, cite = nasty, version = "1.2.3" }
  if drawn then report:draw() end
  add(report)
  return report
end

local function labelled(report)
  for i, method in ipairs { nasty, ("x"):rep(200), "C" } do
    local cell = report:within { scene = nasty, method = method }
    cell:add("depth.srmse", 0.1 * i, { unit = "m", n = 7, convention = nasty, options = { a = nasty } })
    cell:note(nasty)
    cell:curve { title = nasty, x = { label = nasty, unit = "m" }, y = { label = nasty }, at = { 1, 2, 3 },
      values = { 1, i, 2 } }
    cell:timeline { title = "along", y = { label = "e" }, frames = { nasty, "b" }, values = { 1, 0 / 0 } }
  end
  report:convention(nasty, nasty)
  report:source(nasty, { bytes = 1, sha256 = "ab" })
end

local function count(text, part)
  local n, at = 0, 1
  while true do
    local first, last = text:find(part, at, true)
    if not first then return n end
    n, at = n + 1, last + 1
  end
end

--- The page without its script and style, which hold code of their own.
local function markup_of(page)
  local script = require("aib.shell").text("report/page.js")
  local at = script ~= "" and page:find(script, 1, true)
  return at and page:sub(1, at - 1) .. page:sub(at + #script) or page
end

--- What the page's script reads, whether there is a script or not.
local function data_of(report)
  return require("aib.report.page.data").elements(report, require("aib.report.figures").of(report))
end

--- The document in it.
local function document_of(elements)
  local text = elements:match('<script id="report" type="application/json">(.-)</script>')
  return aib.json.decode(text, "page")
end

return aib.test {
  ["labels with markup, quotes and 200 letters stay labels"] = function(t)
    local page = html(report_of(labelled, true))
    t:check(not markup_of(page):find("<img", 1, true))
    t:check(not page:find("<script>alert", 1, true))
    t:contains(page, ("x"):rep(200))
    local data = data_of(report_of(labelled, true))
    t:equal(document_of(data).records[1].group.scene, nasty)
    t:check(not data:find("\u{2028}", 1, true))
    t:equal(count(data, "</script>"), 1)
  end,

  ["a page asks no network and says so to the browser"] = function(t)
    local page = html(report_of(labelled, true))
    t:contains(page, "default-src 'none'")
    for _, reference in ipairs { ' src="http', ' href="http', "@import", "url(http" } do
      t:check(not markup_of(page):find(reference, 1, true), reference)
    end
  end,

  ["tables, figures, notes, numbers and provenance are there without a script"] = function(t)
    local page = html(report_of(function(report)
      for i, method in ipairs { "A", "B", "C" } do
        local cell = report:within { scene = "s", method = method }
        cell:add("x", i, { better = "lower", n = 3, convention = "mean" })
        cell:curve { title = "Curve", x = { label = "tau", unit = "m", scale = "log" }, y = { label = "share" },
          at = { 0.01, 0.1, 1 }, values = { 0, 0.5, 1 } }
      end
      report:note("watch out")
      report.store.inputs = { rule = "centre", tau = { 0.1, 0.2 }, quick = false }
    end, true))
    t:contains(page, "<b>1</b>")
    t:contains(page, "<u>2</u>")
    t:contains(page, ">watch out<")
    t:contains(page, "aib-lua demo --rule centre --tau 0.1,0.2")
    t:equal(count(page, "<figure "), 1)
    t:equal(count(page, "<svg "), 1)
    t:contains(page, ">tau (m)<")
  end,

  ["lines of one title in one scene share a figure, those of another scene do not"] = function(t)
    local report = report_of(function(report)
      for _, scene in ipairs { "s", "t" } do
        for _, method in ipairs { "A", "B" } do
          report:within({ scene = scene, method = method }):curve { title = "Curve", x = {}, y = {}, at = { 1 },
            values = { 2 } }
        end
      end
    end, true)
    local figures = require("aib.report.figures").of(report)
    t:equal(#figures, 2)
    t:equal(figures[1].where, "s")
    t:equal(figures[1].lines[2].label, "B")
    t:equal(figures[2].lines[2].place, figures[1].lines[2].place)
  end,

  ["a timeline has the frames of any of its lines, with gaps"] = function(t)
    local report = report_of(function(report)
      local function add(method, frames)
        report:within({ method = method }):timeline { title = "T", y = {}, frames = frames, values = { 1, 2 } }
      end
      add("A", { "b", "c" })
      add("B", { "a", "b" })
    end, true)
    local figure = require("aib.report.figures").of(report)[1]
    t:equal(figure.frames, { "a", "b", "c" })
    t:check(figure.lines[1].y[1] ~= figure.lines[1].y[1])
    t:equal(figure.lines[1].y[2], 1)
    t:equal(document_of(data_of(report)).figures[1].lines[1].y[1], aib.json.null)
  end,

  ["records with bounds are intervals"] = function(t)
    local report = report_of(function(report)
      for name, value in pairs { change = 0.2, change_low = 0.1, change_high = 0.3 } do report:add(name, value) end
    end)
    local figures = require("aib.report.figures").of(report)
    t:equal(figures[1].rows[1].low, 0.1)
    t:contains(html(report), "<svg ")
  end,

  ["confidence that orders as errors do lies on the order by error"] = function(t)
    local drawings = require "aib.evaluation.drawings"
    local map = here .. "/../../examples/data/gt/office/depth/000000.exr"
    local ref <close> = aib.io.read_depth(map)
    local est <close> = aib.io.read_depth(map)
    local report = report_of(function(report)
      local curves = {}
      drawings.add_risk(report, curves, est, ref, ref, { scale = 1.1, shift = 0 })
      drawings.risk(report, curves)
    end, true)
    local lines = require("aib.report.figures").of(report)[1].lines
    t:equal(#lines, 2)
    for _, line in ipairs(lines) do
      for _, y in ipairs(line.y) do t:near(y, 0.1, 1e-6) end
    end
  end,

  ["nothing is kept for a page that nobody asked for"] = function(t)
    local report = report_of(labelled)
    t:equal(report:draws(), false)
    t:equal(report.store.views, nil)
  end,

  ["a mistake in a view is an error at its line"] = function(t)
    report_of(function(report)
      t:raises("test_page.lua:", function() report:curve { titel = "x" } end)
      t:raises("report:curve: unknown field 'titel', did you mean 'title'?", report.curve, report, { titel = "x" })
      t:raises("report:curve: values: a table expected, found nil", report.curve, report, { title = "x", x = {}, y = {},
        at = {} })
    end)
  end,

  ["geometry and frames are packed, the same data once"] = function(t)
    local cloud = aib.cloud.from_points { { 0, 0, 0 }, { 1, 2, 3 }, { 1, 1, 1 } }
    local page = data_of(report_of(function(report)
      for _, method in ipairs { "A", "B" } do
        report:within({ method = method }):cloud { role = "estimate", cloud = cloud, values = { 0, 1, 0 / 0 } }
      end
    end, true))
    local views = document_of(page).views
    t:equal(#views, 2)
    t:equal(views[1].n, 3)
    t:equal(views[1].box.max, { 1, 2, 3 })
    t:equal(views[1].positions, views[2].positions)
    t:check(views[1].positions ~= views[1].values.data)
    t:contains(page, ('<script id="data-%d"'):format(views[1].positions))
  end,

  ["the same report gives the same bytes"] = function(t)
    t:check(html(report_of(labelled, true)) == html(report_of(labelled, true)))
  end,
}
