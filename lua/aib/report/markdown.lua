-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A report as Markdown (GitHub's tables).

local function escaped(text) return (text:gsub("[|*_`<\\]", "\\%0")) end

--- One heading a column: the texts of all levels.
local function headings(grid)
  local heads = {}
  for _, level in ipairs(grid.header) do
    local at = 1
    for _, head in ipairs(level) do
      for c = at, at + head.span - 1 do
        if head.text ~= "" then heads[c] = heads[c] and heads[c] .. ", " .. head.text or head.text end
      end
      at = at + head.span
    end
  end
  return heads
end

local function line(cells) return "| " .. table.concat(cells, " | ") .. " |" end

local function cell_text(cell)
  local value = escaped(cell.text)
  if cell.best then value = "**" .. value .. "**" end
  return cell.aside and value .. " (" .. escaped(cell.aside) .. ")" or value
end

local function add_grid(out, grid)
  local heads, marks, texts = { "" }, { ":--" }, headings(grid)
  for c = 1, grid.columns do
    heads[c + 1] = escaped(texts[c] or "")
    marks[c + 1] = "--:"
  end
  table.move({ "", "## " .. escaped(grid.title), "", line(heads), line(marks) }, 1, 5, #out + 1, out)
  for _, row in ipairs(grid.rows) do
    local cells = { escaped(row.label) }
    for c, cell in ipairs(row) do cells[c + 1] = cell_text(cell) end
    out[#out + 1] = line(cells)
  end
  for _, note in ipairs(grid.notes) do table.move({ "", escaped(note) }, 1, 2, #out + 1, out) end
end

return function(report)
  local out = { "# " .. escaped(report.title) }
  for _, grid in ipairs(report:grids()) do add_grid(out, grid) end
  local lines = report:note_lines()
  if #lines > 0 then table.move({ "", "## Notes", "" }, 1, 3, #out + 1, out) end
  for _, note in ipairs(lines) do out[#out + 1] = "* " .. escaped(note) end
  return table.concat(out, "\n") .. "\n"
end
