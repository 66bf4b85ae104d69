-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Files of one folder, by names relative to it; remembers what was used, with its content hash.
local aib = require "aib"
local failure = require "aib.failure"

local files = {}
files.__index = files

local M = {}

--- The files of a folder. Raises an io error where it is none.
function M.new(folder)
  if not aib.system.is_folder(folder) then failure.raise("io", folder .. ": no such folder") end
  return setmetatable({ folder = folder:gsub("(.)/+$", "%1"), used = {} }, files)
end

--- Path of a file or folder.
function files:path(name)
  if name:sub(1, 1) == "/" or self.folder == "." then return name end
  return self.folder .. "/" .. name
end

--- What tells whether a file was touched: its size and the time of its last change; of a folder, those of its files
--- and the names of its folders. Nil where there is nothing.
function M.status(path)
  if aib.system.is_file(path) then return aib.system.status(path) end
  if not aib.system.is_folder(path) then return nil end
  local lines = {}
  for i, entry in ipairs(aib.system.names_in(path)) do
    local inner = path .. "/" .. entry
    lines[i] = aib.system.is_folder(inner) and entry .. "/" or entry .. " " .. aib.system.status(inner)
  end
  return aib.system.sha256(table.concat(lines, "\n"))
end

local fingerprints = {}

--- Content and status of a file; one that several units read is read once for its hash.
local function fingerprint(path)
  local status = aib.system.is_file(path) and aib.system.status(path) or "none"
  local id = path .. "\0" .. status
  if not fingerprints[id] then
    local print = aib.system.fingerprint(path)
    fingerprints[id] = { bytes = print.bytes, sha256 = print.sha256, status = status }
  end
  return fingerprints[id]
end

local function remember(self, label, name)
  local of_label = self.used[label] or {}
  self.used[label] = of_label
  of_label[name] = of_label[name] or fingerprint(self:path(name))
end

--- Path of a file that is about to be read, remembered under its name.
function files:file(name)
  remember(self, name, name)
  return self:path(name)
end

--- Remembers that an image's file is not there, where that is so: it is seen when it comes.
function files:miss(pattern, image)
  local name = M.expand(pattern, image)
  if aib.system.is_file(self:path(name)) then return end
  self.used[pattern] = self.used[pattern] or {}
  self.used[pattern][name] = { status = "none" }
end

--- One fingerprint for several files: the sum of their sizes, and the hash of the sorted lines "hash  name".
local function combined(prints)
  local lines, bytes, count = {}, 0, 0
  for name, print in pairs(prints) do
    count, bytes = count + 1, bytes + print.bytes
    lines[count] = print.sha256 .. "  " .. name .. "\n"
  end
  table.sort(lines)
  if count == 1 then return select(2, next(prints)) end
  return { files = count, bytes = bytes, sha256 = aib.system.sha256(table.concat(lines)) }
end

--- Remembers all files in a folder as one, those of its folders as theirs, and returns its path. Raises an io error
--- where it is none.
function files:whole_folder(name)
  local path, prints = self:path(name), {}
  if self.used[name] then return path end
  self.used[name] = {}
  local entries, status = aib.system.names_in(path), M.status(path)
  for _, entry in ipairs(entries) do
    local inner = name .. "/" .. entry
    if aib.system.is_folder(self:path(inner)) then
      self:whole_folder(inner)
    else
      prints[inner] = fingerprint(self:path(inner))
    end
  end
  local print = next(prints) and combined(prints) or {}
  self.used[name][name] = { files = print.files, bytes = print.bytes, sha256 = print.sha256, status = status }
  return path
end

--- Path of a file or of a folder that is about to be read, remembered.
function files:any(name)
  if aib.system.is_folder(self:path(name)) then return self:whole_folder(name) end
  return self:file(name)
end

--- The name that a pattern gives an image: {name} stands for its name, {stem} for the name without its extension.
function M.expand(pattern, image)
  local values = { name = image, stem = (image:gsub("%.[^./]*$", "")) }
  return (pattern:gsub("{(%a+)}", values))
end

--- Those of `images` (a list of names) for which a pattern names a file that is there. Raises an io error where there
--- is none.
function files:present(pattern, images)
  local list = {}
  for _, image in ipairs(images) do
    if aib.system.is_file(self:path(M.expand(pattern, image))) then list[#list + 1] = image end
  end
  if #list == 0 then
    failure.raise("io", ("%s: no file for any of %d images; the first would be %s"):format(self:path(pattern), #images,
      images[1] and M.expand(pattern, images[1]) or "nothing"))
  end
  return list
end

--- Path of an image's file, remembered under the pattern.
function files:frame(pattern, image)
  local name = M.expand(pattern, image)
  remember(self, pattern, name)
  return self:path(name)
end

--- What was used: fingerprint by name, pattern or folder.
function files:sources()
  local out = {}
  for label, prints in pairs(self.used) do
    local with_content = {}
    for name, print in pairs(prints) do
      if print.sha256 then with_content[name] = print end
    end
    local print = next(with_content) and combined(with_content)
    out[label] = print and { files = print.files, bytes = print.bytes, sha256 = print.sha256 } or nil
  end
  return out
end

return M
