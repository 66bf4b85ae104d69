---@meta aib.system
error("Cannot require a meta file")

---What the Lua modules of the shell need from the machine: files, the terminal, errors with a kind.
---@class aib.system
local system = {}

---Whether there is a regular file.
---@param path string
---@return boolean
function system.is_file(path) end

---Whether there is a folder.
---@param path string
---@return boolean
function system.is_folder(path) end

---Names in a folder, sorted by their bytes.
---@param folder string
---@return string[]
function system.names_in(folder) end

---The whole content of a file.
---@param path string
---@return string
function system.read_text(path) end

---Writes a whole file in one step: it is there in full, or as it was before.
---@param path string
---@param text string
function system.write_text(path, text) end

---What tells whether a file is still the same: { bytes =, sha256 = }.
---@param path string
---@return table
function system.fingerprint(path) end

---Makes a folder and those above it; none is made anew.
---@param path string
function system.make_folder(path) end

---Tells a file that was not touched without reading it: size and time of the last change, as a text.
---@param path string
---@return string
function system.status(path) end

---SHA-256 of a text, 64 hexadecimal digits.
---@param text string
---@return string
function system.sha256(text) end

---Whether a stream is a terminal.
---@param stream "stdout"|"stderr"
---@return boolean
function system.is_terminal(stream) end

---Columns of the terminal; 80 where there is none.
---@param stream "stdout"|"stderr"
---@return integer
function system.columns(stream) end

---The library's calls say no more how far they are.
function system.silence() end

---How many threads the library uses from now on; 0: all.
---@param n integer
function system.use_threads(n) end

---What to add to "unknown X 'name'": the nearest of the known names, or all of them.
---@param name string
---@param known string[]
---@return string
function system.suggestion(name, known) end

---Says of which kind a message is that a Lua module is about to raise.
---@param kind "argument"|"format"|"io"|"undefined"|"stopped"|"internal"
---@param text string
function system.remember(kind, text) end

return system
