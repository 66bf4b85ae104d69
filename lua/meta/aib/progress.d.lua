---@meta aib.progress
error("Cannot require a meta file")

---Progress of long work on stderr: one line that is redrawn on a terminal, a plain line now and then otherwise.
---@class aib.progress
---@field quiet boolean  # nothing is shown
local progress = {}

---@class aib.Progress
local instance = {}

---Says that the next of the steps begins.
---@param what? string
function instance:step(what) end

---Says a sentence that stays.
---@param text string
function instance:say(text) end

---Ends it; `local progress <close> = aib.progress(...)` does so by itself.
function instance:close() end

---Shows nothing from now on, neither this nor how far a long call of the library is.
function progress.silence() end

---Progress over `total` steps, called `noun`: `aib.progress(#units, "units")` is the same.
---@param total integer
---@param noun? string
---@param sink? table  # { write =, clock =, redraws = } instead of stderr and the clock
---@return aib.Progress
function progress.new(total, noun, sink) end

return progress
