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

local function remember(self, label, name)
  local of_label = self.used[label] or {}
  self.used[label] = of_label
  of_label[name] = of_label[name] or aib.system.fingerprint(self:path(name))
end

--- Path of a file that is about to be read, remembered under its name.
function files:file(name)
  remember(self, name, name)
  return self:path(name)
end

--- Remembers every file in a folder under the folder's name and returns its path. Raises an io error where it is none.
function files:whole_folder(name)
  for _, entry in ipairs(aib.system.names_in(self:path(name))) do
    local inner = name .. "/" .. entry
    if aib.system.is_folder(self:path(inner)) then
      self:whole_folder(inner)
    else
      remember(self, name, inner)
    end
  end
  return self:path(name)
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

--- What was used: fingerprint by name, pattern or folder.
function files:sources()
  local out = {}
  for label, prints in pairs(self.used) do
    local print = combined(prints)
    out[label] = { files = print.files, bytes = print.bytes, sha256 = print.sha256 }
  end
  return out
end

return M
