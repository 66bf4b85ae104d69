-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A report as LaTeX: booktabs tables, to be read by \input. Needs \usepackage{booktabs}.

local escapes = {
  ["\\"] = "\\textbackslash{}", ["{"] = "\\{", ["}"] = "\\}", ["$"] = "\\$", ["&"] = "\\&", ["#"] = "\\#",
  ["%"] = "\\%", ["_"] = "\\_", ["~"] = "\\textasciitilde{}", ["^"] = "\\textasciicircum{}",
}
local symbols = {
  ["↓"] = "$\\downarrow$", ["↑"] = "$\\uparrow$", ["–"] = "--", ["±"] = "$\\pm$",
  ["≤"] = "$\\le$", ["≥"] = "$\\ge$", ["×"] = "$\\times$", ["·"] = "$\\cdot$",
  ["°"] = "$^\\circ$", ["τ"] = "$\\tau$", ["²"] = "$^2$", ["…"] = "\\dots{}",
}

local function escaped(text)
  return (text:gsub("[\\{}$&#%%_~^]", escapes):gsub(utf8.charpattern, symbols))
end

--- The lines of one level of the header, with a rule below what spans columns.
local function add_level(out, level, is_last)
  local cells, rules, at = {}, {}, 2
  for i, head in ipairs(level) do
    cells[i] = escaped(head.text)
    if head.span > 1 then
      cells[i] = ("\\multicolumn{%d}{c}{%s}"):format(head.span, cells[i])
      rules[#rules + 1] = ("\\cmidrule(lr){%d-%d}"):format(at, at + head.span - 1)
    end
    at = at + head.span
  end
  out[#out + 1] = " & " .. table.concat(cells, " & ") .. " \\\\"
  if #rules > 0 and not is_last then out[#out + 1] = table.concat(rules, " ") end
end

local function cell_text(cell)
  local value = escaped(cell.text)
  if cell.best then value = "\\textbf{" .. value .. "}" end
  return cell.aside and ("%s {\\scriptsize (%s)}"):format(value, escaped(cell.aside)) or value
end

local function add_grid(out, grid, label)
  table.move({
    "", "\\begin{table}", "\\centering", ("\\caption{%s}"):format(escaped(grid.title)), ("\\label{%s}"):format(label),
    ("\\begin{tabular}{l%s}"):format(("r"):rep(grid.columns)), "\\toprule",
  }, 1, 7, #out + 1, out)
  for depth, level in ipairs(grid.header) do add_level(out, level, depth == #grid.header) end
  out[#out + 1] = "\\midrule"
  for _, row in ipairs(grid.rows) do
    local cells = { escaped(row.label) }
    for c, cell in ipairs(row) do cells[c + 1] = cell_text(cell) end
    out[#out + 1] = table.concat(cells, " & ") .. " \\\\"
  end
  table.move({ "\\bottomrule", "\\end{tabular}" }, 1, 2, #out + 1, out)
  for _, note in ipairs(grid.notes) do out[#out + 1] = "\\par\\smallskip{\\footnotesize " .. escaped(note) .. "}" end
  out[#out + 1] = "\\end{table}"
end

return function(report)
  local out = { "% " .. report.title:gsub("\n", " ") .. ", aib " .. report.version }
  for i, grid in ipairs(report:grids()) do add_grid(out, grid, ("tab:%s-%d"):format(report.name, i)) end
  for _, note in ipairs(report:note_lines()) do out[#out + 1] = "% " .. note:gsub("\n", " ") end
  return table.concat(out, "\n") .. "\n"
end
