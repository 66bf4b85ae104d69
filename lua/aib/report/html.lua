-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A report as one HTML page without scripts.

local escapes = { ["&"] = "&amp;", ["<"] = "&lt;", [">"] = "&gt;", ['"'] = "&quot;" }

local function escaped(text) return (text:gsub('[&<>"]', escapes)) end

local style <const> = [[
body { font: 16px/1.5 system-ui, sans-serif; max-width: 70em; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; margin: 2em 0 0.5em; font-variant-numeric: tabular-nums }
caption { text-align: left; font-weight: bold; padding-bottom: 0.5em }
th, td { padding: 0.2em 1em; text-align: right }
tbody th { text-align: left; font-weight: normal }
thead tr:last-child th { border-bottom: 1px solid }
small { opacity: 0.6 }
]]

local function cell_html(cell)
  local value = escaped(cell.text)
  if cell.best then value = "<b>" .. value .. "</b>" end
  if cell.aside then value = value .. " <small>" .. escaped(cell.aside) .. "</small>" end
  return "<td>" .. value .. "</td>"
end

local function add_grid(out, grid)
  out[#out + 1] = ("<table>\n<caption>%s</caption>\n<thead>"):format(escaped(grid.title))
  for _, level in ipairs(grid.header) do
    local cells = { "<th></th>" }
    for i, head in ipairs(level) do
      cells[i + 1] = ('<th colspan="%d">%s</th>'):format(head.span, escaped(head.text))
    end
    out[#out + 1] = "<tr>" .. table.concat(cells) .. "</tr>"
  end
  out[#out + 1] = "</thead>\n<tbody>"
  for _, row in ipairs(grid.rows) do
    local cells = { ('<th scope="row">%s</th>'):format(escaped(row.label)) }
    for c, cell in ipairs(row) do cells[c + 1] = cell_html(cell) end
    out[#out + 1] = "<tr>" .. table.concat(cells) .. "</tr>"
  end
  out[#out + 1] = "</tbody>\n</table>"
  for _, note in ipairs(grid.notes) do out[#out + 1] = "<p><small>" .. escaped(note) .. "</small></p>" end
end

return function(report)
  local title = escaped(report.title)
  local out = {
    '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
    ("<title>%s</title>\n<style>\n%s</style>\n</head>\n<body>\n<h1>%s</h1>"):format(title, style, title),
  }
  for _, grid in ipairs(report:grids()) do add_grid(out, grid) end
  local lines = report:note_lines()
  if #lines > 0 then out[#out + 1] = "<h2>Notes</h2>\n<ul>" end
  for _, note in ipairs(lines) do out[#out + 1] = "<li>" .. escaped(note) .. "</li>" end
  if #lines > 0 then out[#out + 1] = "</ul>" end
  out[#out + 1] = "</body>\n</html>"
  return table.concat(out, "\n") .. "\n"
end
