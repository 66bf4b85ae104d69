-- The reference of the scripting interface as Markdown, a page a module: aib-lua reference.lua FOLDER
-- The words are those of the stubs, which editors and help() show too.
local shell = require "aib.shell"
local stubs = require "aib.stubs"
local suggest = require "aib.suggest"

local folder = assert(arg[1], "usage: aib-lua reference.lua FOLDER")

local function cell(text) return (text:gsub("|", "\\|"):gsub("[<>]", { ["<"] = "&lt;", [">"] = "&gt;" })) end

--- A table of { name =, type =, optional =, text = }, nothing where there is none.
local function rows(title, list)
  if #list == 0 then return "" end
  local lines = { ("| %s | type | |\n|---|---|---|"):format(title) }
  for _, item in ipairs(list) do
    lines[#lines + 1] = ("| %s%s | %s | %s |")
      :format(item.name, item.optional and " (optional)" or "", cell(item.type), cell(item.text))
  end
  return table.concat(lines, "\n") .. "\n\n"
end

local function paragraph(entry)
  local text = table.concat(entry.text, "\n")
  return text == "" and "" or text:gsub("<", "&lt;") .. "\n\n"
end

local function section(entry, module)
  if entry.kind == "class" then
    local heading = entry.name == module and "" or ("## %s\n\n"):format(entry.name)
    return heading .. paragraph(entry) .. rows("field", entry.fields)
  end
  return ("### %s(%s)\n\n%s%s%s%s"):format(entry.name, entry.arguments, paragraph(entry),
    rows("argument", entry.params), rows("option", stubs.options(entry)), rows("returns", entry.returns))
end

--- The entries of a stub: first the module and its functions, then each type with its methods.
local function page(text)
  local entries, module = stubs.parse(text), text:match("^%-%-%-@meta ([%w_.]+)")
  local owners, out = {}, {}
  for name, entry in pairs(entries) do
    local owner = entry.kind == "class" and name or name:match("^(.*)[.:]")
    if entry.kind ~= "field" then
      owners[owner] = owners[owner] or {}
      owners[owner][name] = entry
    end
  end
  local order = suggest.keys(owners)
  table.sort(order, function(a, b)
    if (a == module) ~= (b == module) then return a == module end
    return a < b
  end)
  for _, owner in ipairs(order) do
    if entries[owner] then out[#out + 1] = section(entries[owner], module) end
    for _, name in ipairs(suggest.keys(owners[owner])) do
      if name ~= owner then out[#out + 1] = section(owners[owner][name], module) end
    end
  end
  return ("# %s\n\n%s"):format(module, table.concat(out))
end

for _, path in ipairs(shell.paths()) do
  if path:find("^meta/") then
    local text = shell.text(path)
    local file <close> = assert(io.open(folder .. "/" .. text:match("^%-%-%-@meta ([%w_.]+)") .. ".md", "w"))
    file:write(page(text))
  end
end
