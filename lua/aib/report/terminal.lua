-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- A report on a terminal: tables, then notes.
local text = require "aib.report.text"

local bold <const>, dim <const>, plain <const> = "\27[1m", "\27[2m", "\27[0m"
local gap <const> = 3

--- Marks text for the eye where the terminal has colours.
local function styled(style, mark, words) return style.color and words ~= "" and mark .. words .. plain or words end

--- Widths of column `c`: the value (right-aligned, with room for a star where there is no bold) and what stands
--- beside it (left-aligned).
local function layout_of(grid, c, style)
  local values, asides, heads = {}, {}, {}
  for i, row in ipairs(grid.rows) do
    values[i] = row[c].text
    asides[#asides + 1] = row[c].aside
  end
  for _, level in ipairs(grid.header) do
    local at = 1
    for _, head in ipairs(level) do
      if at == c and head.span == 1 then heads[#heads + 1] = head.text end
      at = at + head.span
    end
  end
  local star = style.color and 0 or 1
  local value, aside = text.widest(values), text.widest(asides)
  local content = value + star + (aside > 0 and 1 + aside or 0)
  return { value = value, width = math.max(content, text.widest(heads)) }
end

--- Ranges of columns that fit beside the labels, each as wide as the terminal allows.
local function blocks(layouts, label_width, columns)
  local ranges, first, used = {}, 1, label_width
  for c, layout in ipairs(layouts) do
    if c > first and used + gap + layout.width > columns then
      ranges[#ranges + 1] = { first, c - 1 }
      first, used = c, label_width
    end
    used = used + gap + layout.width
  end
  ranges[#ranges + 1] = { first, #layouts }
  return ranges
end

local function cell_text(cell, layout, style)
  local value = text.right(cell.text, layout.value)
  local used = layout.value
  if cell.best then
    value = style.color and value:gsub("%S.*", bold .. "%0" .. plain) or value .. "*"
  elseif not style.color then
    value = value .. " "
  end
  if not style.color then used = used + 1 end
  if cell.aside then
    value = value .. " " .. styled(style, dim, cell.aside)
    used = used + 1 + text.width(cell.aside)
  end
  return value .. (" "):rep(layout.width - used)
end

local function header_line(level, range, layouts, label_width)
  local line, at = (" "):rep(label_width), 1
  for _, head in ipairs(level) do
    local from, to = math.max(at, range[1]), math.min(at + head.span - 1, range[2])
    if from <= to then
      local n = gap * (to - from)
      for c = from, to do n = n + layouts[c].width end
      line = line .. (" "):rep(gap) .. text.left(head.text, n)
    end
    at = at + head.span
  end
  return line
end

local function add_block(out, grid, range, layouts, label_width, style)
  local total = label_width
  for c = range[1], range[2] do total = total + gap + layouts[c].width end
  for _, level in ipairs(grid.header) do
    out[#out + 1] = header_line(level, range, layouts, label_width)
  end
  out[#out + 1] = styled(style, dim, ("─"):rep(total))
  for _, row in ipairs(grid.rows) do
    local line = text.left(row.label, label_width)
    for c = range[1], range[2] do
      line = line .. (" "):rep(gap) .. cell_text(row[c], layouts[c], style)
    end
    out[#out + 1] = line
  end
end

local function add_wrapped(out, words, style, indent)
  for _, line in ipairs(text.wrapped(words, style.columns, indent)) do
    out[#out + 1] = styled(style, dim, line)
  end
end

local function add_grid(out, grid, style)
  local labels, layouts = {}, {}
  for i, row in ipairs(grid.rows) do labels[i] = row.label end
  for c = 1, grid.columns do layouts[c] = layout_of(grid, c, style) end
  local label_width = text.widest(labels)
  out[#out + 1] = styled(style, bold, grid.title)
  for i, range in ipairs(blocks(layouts, label_width, style.columns)) do
    if i > 1 then out[#out + 1] = "" end
    add_block(out, grid, range, layouts, label_width, style)
  end
  for _, note in ipairs(grid.notes) do add_wrapped(out, note, style) end
  out[#out + 1] = ""
end

local function add_notes(out, lines, style)
  if #lines == 0 then return end
  out[#out + 1] = styled(style, bold, "Notes")
  for _, line in ipairs(lines) do
    for _, part in ipairs(text.wrapped("• " .. line, style.columns, "  ")) do out[#out + 1] = part end
  end
end

--- The text of a report. style = { columns = width of the terminal, color = true|nil (else the best are starred) }
return function(report, style)
  local out = {}
  for _, grid in ipairs(report:grids()) do add_grid(out, grid, style) end
  add_notes(out, report:note_lines(), style)
  for i, line in ipairs(out) do out[i] = line:gsub("%s+$", "") end
  return (table.concat(out, "\n"):gsub("\n*$", "\n"))
end
