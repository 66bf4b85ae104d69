-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What the Lua tests share: folders that go away, copies, the shell as a program.
local aib = require "aib"

local M = {}

--- Folder of the sources, and that of expected numbers beside it, from where the test script lies.
M.root = (arg[0]:match("^(.*)/[^/]*$") or ".") .. "/../.."
M.shared = M.root .. "/../shared"

--- A word that the shell takes as it is.
function M.quoted(word) return "'" .. word:gsub("'", "'\\''") .. "'" end

local function shell(...)
  local words = {}
  for i, word in ipairs { ... } do words[i] = M.quoted(word) end
  assert(os.execute(table.concat(words, " ")))
end

--- A new folder { path = }, removed where the variable ends: local folder <close> = support.scratch_folder()
function M.scratch_folder()
  local path = os.tmpname()
  os.remove(path)
  shell("mkdir", path)
  return setmetatable({ path = path }, { __close = function() shell("rm", "-rf", path) end })
end

--- A link to a file or folder, wherever the link lies.
function M.link(target, path) os.execute(("ln -s \"$(realpath %s)\" %s"):format(M.quoted(target), M.quoted(path))) end
function M.copy_folder(from, to) shell("cp", "-r", "--no-preserve=mode", from, to) end

--- Whether the folder of expected numbers is here.
function M.has_shared() return aib.system.is_file(M.shared .. "/scenes/reference.json") end

--- The protocol of a script in examples/protocols.
function M.protocol(name) return assert(loadfile(("%s/examples/protocols/%s.lua"):format(M.root, name)))() end

--- The program that runs this test stands before its options.
local program = 0
while arg[program - 1] do program = program - 1 end

--- Path of that program.
function M.program() return arg[program] end

--- A path that holds in any folder.
function M.absolute(path)
  local pipe = assert(io.popen("realpath " .. M.quoted(path)))
  local text = pipe:read "l"
  pipe:close()
  return text
end

--- Runs aib-lua, the program that runs this test. Returns what it printed, what it complained of, and its exit code.
function M.aib_lua(...)
  local words = { M.quoted(arg[program]) }
  for i, word in ipairs { ... } do words[i + 1] = M.quoted(word) end
  local complaints = os.tmpname()
  local pipe = assert(io.popen(table.concat(words, " ") .. " 2>" .. complaints .. " </dev/null"))
  local output = pipe:read("a")
  local _, _, code = pipe:close()
  local text = aib.system.read_text(complaints)
  os.remove(complaints)
  return output, text, code
end

return M
