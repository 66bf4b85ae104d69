---@meta aib.files
error("Cannot require a meta file")

---Files of one folder by names relative to it; remembers what was used, with its content hash.
---@class aib.files
local files = {}

---@class aib.Files
local instance = {}

---The files of a folder; an io error where it is none.
---@param folder string
---@return aib.Files
function files.new(folder) end

---The name that a pattern gives an image: {name} stands for its name, {stem} for the name without its extension.
---@param pattern string
---@param image string
---@return string
function files.expand(pattern, image) end

---What tells whether a file was touched: its size and the time of its last change; of a folder, those of its files and
---the names of its folders. Nil where there is nothing.
---@param path string
---@return string|nil status
function files.status(path) end

---Path of a file or folder.
---@param name string
---@return string
function instance:path(name) end

---Path of a file that is about to be read, remembered under its name.
---@param name string
---@return string
function instance:file(name) end

---Path of a file or of a folder that is about to be read, remembered.
---@param name string
---@return string
function instance:any(name) end

---Remembers every file in a folder under the folder's name and returns its path.
---@param name string
---@return string
function instance:whole_folder(name) end

---Path of an image's file, remembered under the pattern.
---@param pattern string
---@param image string
---@return string
function instance:frame(pattern, image) end

---Remembers that an image's file is not there, where that is so.
---@param pattern string
---@param image string
function instance:miss(pattern, image) end

---Those images for which the pattern names a file that is there; an io error where none is.
---@param pattern string
---@param images string[]
---@return string[]
function instance:present(pattern, images) end

---What was used: { files =, bytes =, sha256 = } by name, folder or pattern.
---@return table<string, table>
function instance:sources() end

return files
