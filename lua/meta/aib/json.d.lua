---@meta aib.json
error("Cannot require a meta file")

---JSON text of values and values of JSON text: keys sorted, numbers in their shortest exact form.
---@class aib.json
---@field null table  # stands for null, which a Lua table cannot hold
local json = {}

---Tables with 1..n are arrays, others objects; an empty table is an object unless made by `list`.
---@param value any
---@return string
function json.encode(value) end

---A format error that begins with `name` (a path) says the line and what was expected.
---@param text string
---@param name? string
---@return any
function json.decode(text, name) end

---A table that is written as an array even where it is empty.
---@param t? table
---@return table
function json.list(t) end

---The shortest decimal text that reads back as the same number.
---@param x number
---@return string
function json.number(x) end

return json
