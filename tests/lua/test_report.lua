-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

local aib = require "aib"
local new_report = aib.report.new

local function report_of(add)
  local report = new_report { name = "demo", title = "Demo", version = "1.2.3" }
  add(report)
  return report
end

--- Three methods over a scene and the two conditions of another.
local function table_report()
  return report_of(function(report)
    local places = {
      { scene = "crane" }, { scene = "office", condition = "low" }, { scene = "office", condition = "high" },
    }
    for p, place in ipairs(places) do
      for m, method in ipairs { "A", "B", "C" } do
        place.method = method
        local cell = report:within(place)
        local missing = method == "C" and p == 1
        cell:add("srmse", not missing and 0.1 * m * p or nil, { unit = "m", better = "lower", n = 7,
          note = missing and "no depth" or nil })
        cell:add("coverage", m == 1 and 0.25 or 0.75, { better = "higher" })
      end
    end
    report:table {
      title = "Depth", metrics = { "srmse" }, beside = { { metric = "coverage", percent = true }, { field = "n" } },
      bold_from = { metric = "coverage", at_least = 0.5 }, notes = { "Best from 50 % on." },
    }
  end)
end

local function terminal(report, columns, color)
  return require("aib.report.terminal")(report, { columns = columns or 80, color = color })
end

return aib.test {
  ["a table has methods down, scenes and conditions across, unit and arrow in the title"] = function(t)
    t:equal(terminal(table_report()), [[
Depth (m) ↓
    crane              office
                       low                high
──────────────────────────────────────────────────────────
A   0.100  25.0 %, 7   0.200  25.0 %, 7   0.300  25.0 %, 7
B   0.200* 75.0 %, 7   0.400* 75.0 %, 7   0.600* 75.0 %, 7
C       –              0.600  75.0 %, 7   0.900  75.0 %, 7
Best from 50 % on.

Notes
• crane / C: srmse: no depth
]])
  end,

  ["a table that is too wide goes on below"] = function(t)
    local text = terminal(table_report(), 42)
    for line in text:gmatch("[^\n]+") do t:check(utf8.len(line) <= 42, line) end
    t:contains(text, "    office\n    high\n────────────────────\nA   0.300  25.0 %, 7\n")
  end,

  ["the best is bold on a terminal"] = function(t)
    t:contains(terminal(table_report(), 80, true), "\27[1m0.200\27[0m")
  end,

  ["the best is bold in Markdown and LaTeX"] = function(t)
    local report = table_report()
    t:contains(require("aib.report.markdown")(report), "| B | **0.200** (75.0 %, 7) |")
    t:contains(require("aib.report.markdown")(report), "|  | crane | office, low | office, high |")
    t:contains(require("aib.report.latex")(report), "B & \\textbf{0.200} {\\scriptsize (75.0 \\%, 7)} &")
    t:contains(require("aib.report.latex")(report), "\\multicolumn{2}{c}{office}")
    t:contains(require("aib.report.latex")(report), "\\caption{Depth (m) $\\downarrow$}")
    t:contains(require("aib.report.html")(report), "><b>0.200</b> <small>75.0 %, 7</small></td>")
  end,

  ["equal values are equally good, and one value alone is not the best"] = function(t)
    local report = report_of(function(r)
      for _, method in ipairs { "A", "B" } do
        r:within({ method = method, scene = "s" }):add("x", 0.5, { better = "higher" })
      end
      r:within({ method = "A", scene = "other" }):add("x", 0.5, { better = "higher" })
      r:table { title = "X", metrics = { "x" } }
    end)
    t:contains(terminal(report), "A   0.500*   0.500\n")
    t:contains(terminal(report), "B   0.500*       –\n")
  end,

  ["a share in percent is never rounded to all or nothing"] = function(t)
    local percent = require("aib.report.number").percent
    t:equal(percent(0.99999), "99.9")
    t:equal(percent(1), "100.0")
    t:equal(percent(0), "0.0")
    t:equal(percent(0.00001), "0.001")
  end,

  ["decimals follow the smallest value of a table"] = function(t)
    local number = require "aib.report.number"
    t:equal(number.decimals { 1, 0.5 }, 3)
    t:equal(number.decimals { 1, 0.0012 }, 4)
    t:equal(number.fixed(0.00000012, 6), "1.2e-07")
    t:equal(number.fixed(12, 3), "12")
  end,

  ["a metric without a value is a dash with a note"] = function(t)
    local report = report_of(function(r)
      r:add("mean", function() return aib.stats.summary({}).mean end, { unit = "m" })
    end)
    t:equal(report:records()[1].value, nil)
    t:contains(terminal(report), "mean (m)   –")
    t:contains(terminal(report), "• mean: stats::summarize: no values")
    t:contains(require("aib.report.json")(report), '"value": null')
  end,

  ["an error that is not an undefined metric passes"] = function(t)
    report_of(function(r)
      t:raises("nonsense", r.add, r, "x", function() error("nonsense") end)
    end)
  end,

  ["a mistake in a record is an error at its line"] = function(t)
    report_of(function(r)
      t:raises("test_report.lua:", function() r:add("x", 1, { unti = "m" }) end)
      t:raises("unknown field 'unti', did you mean 'unit'?", r.add, r, "x", 1, { unti = "m" })
      t:raises('better: "lower" or "higher" expected, found "smaller"', r.add, r, "x", 1, { better = "smaller" })
      t:raises("unit: a string expected, found number", r.add, r, "x", 1, { unit = 3 })
      t:raises("a number expected, found string", r.add, r, "x", "1")
      t:raises("unknown field 'metric', did you mean 'metrics'?", r.table, r, { title = "T", metric = "x" })
      t:raises("metrics: a list of names expected", r.table, r, { title = "T" })
    end)
  end,

  ["the same note of several groups is said once"] = function(t)
    local report = report_of(function(r)
      for _, method in ipairs { "A", "B" } do r:within({ method = method }):note("too few") end
      r:within({ method = "A" }):note("too few")
    end)
    t:equal(report:note_lines(), { "too few (A; B)" })
  end,

  ["groups are merged, and records of one group share what was added in two places"] = function(t)
    local report = report_of(function(r)
      r:within({ scene = "s" }):within({ method = "m" }):add("x", 1)
      r:add("y", 2, { group = { method = "m", scene = "s" } })
    end)
    t:equal(report:records()[1].group_id, report:records()[2].group_id)
    t:equal(report:within({ method = "m", scene = "s" }):group_name(), "s / m")
  end,

  ["without a table of its own a report shows all records"] = function(t)
    local report = report_of(function(r)
      r:add("rmse", 0.5, { unit = "m", better = "lower" })
      r:add("n", 3)
    end)
    t:equal(terminal(report), "Demo\n───────────────────\nrmse (m) ↓   0.500\nn                3\n")
  end,

  ["JSON holds records with what they depend on and nothing of the machine"] = function(t)
    local report = report_of(function(r)
      r:within({ method = "A" }):add("x", 1 / 3, { unit = "m", better = "lower", n = 2, convention = "paper",
        options = { tau = 0.1 } })
      r:convention("x", "as printed")
      r:source("a.ply", { bytes = 3, sha256 = "ab" })
    end)
    t:equal(aib.json.decode(require("aib.report.json")(report)), {
      aib = { format = 1, version = "1.2.3" }, protocol = { name = "demo", title = "Demo" }, inputs = {}, notes = {},
      conventions = { x = "as printed" }, sources = { ["a.ply"] = { bytes = 3, sha256 = "ab" } },
      records = { { name = "x", value = 1 / 3, unit = "m", better = "lower", n = 2, convention = "paper",
        group = { method = "A" }, options = { tau = 0.1 } } },
    })
  end,

  ["CSV quotes what needs it and keeps every digit"] = function(t)
    local report = report_of(function(r)
      r:within({ method = 'A, "b"', scene = "s" }):add("x", 1 / 3, { unit = "m", n = 2 })
      r:within({ scene = "t" }):add("y", nil, { note = "none" })
    end)
    t:equal(require("aib.report.csv")(report), 'scene,method,metric,value,unit,better,n,convention,note\n'
      .. 's,"A, ""b""",x,0.3333333333333333,m,,2,,\n' .. 't,,y,,,,,,none\n')
  end,

  ["LaTeX escapes what it reads as commands"] = function(t)
    local report = report_of(function(r)
      r:add("a_b & 50% {x} ~ ^ \\ #$", 1)
    end)
    t:contains(require("aib.report.latex")(report),
      "a\\_b \\& 50\\% \\{x\\} \\textasciitilde{} \\textasciicircum{} \\textbackslash{} \\#\\$ & 1")
  end,
}
