-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The program itself: flags, exit codes, what it prints.
local aib = require "aib"

local program <const> = arg[-1]

local function quoted(word) return "'" .. word:gsub("'", "'\\''") .. "'" end

--- Runs aib-lua. Returns everything that it printed and its exit code.
local function run(words, input)
  local parts = { quoted(program) }
  for i, word in ipairs(words) do parts[i + 1] = quoted(word) end
  local from = input and ("printf %%s %s | "):format(quoted(input)) or ""
  local pipe <close> = assert(io.popen(from .. table.concat(parts, " ") .. " 2>&1" .. (input and "" or " </dev/null")))
  local text = pipe:read("a")
  local _, _, code = pipe:close()
  return text, code
end

--- Writes files into a new folder and returns it.
local function folder_with(files)
  local folder = os.tmpname()
  os.remove(folder)
  assert(os.execute("mkdir -p " .. quoted(folder)))
  for name, text in pairs(files) do aib.system.write_text(folder .. "/" .. name, text) end
  return setmetatable({ path = folder }, { __close = function() os.execute("rm -r " .. quoted(folder)) end })
end

local function expect(t, words, expected, expected_code, input)
  local text, code = run(words, input)
  t:equal(text, expected, table.concat(words, " "))
  t:equal(code, expected_code, table.concat(words, " ") .. ": exit code")
end

return aib.test {
  ["-e runs code with aib as a global"] = function(t)
    expect(t, { "-e", "print(aib.version == require'aib'.version)" }, "true\n", 0)
    expect(t, { "-e", "x = 1", "-e", "print(x)" }, "1\n", 0)
  end,

  ["-v prints versions, -l requires a module, -W turns warnings on"] = function(t)
    t:contains(run { "-v" }, "aib " .. aib.version)
    expect(t, { "-l", "aib", "-e", "print(aib.version)" }, aib.version .. "\n", 0)
    expect(t, { "-l", "a=aib", "-e", "print(a == aib)" }, "true\n", 0)
    expect(t, { "-W", "-e", "warn('careful')" }, "Lua warning: careful\n", 0)
  end,

  ["- runs standard input, with arguments"] = function(t)
    expect(t, { "-", "one", "two" }, "one\ttwo\n2\n", 0, "print(...) print(#arg)")
    expect(t, {}, "3\n", 0, "print(1 + 2)")
  end,

  ["a script has arg and finds modules beside it"] = function(t)
    local folder <close> = folder_with {
      ["main.lua"] = "local near = require 'near' print(near, arg[0]:match('[^/]*$'), arg[1], ...)",
      ["near.lua"] = "return 'beside'",
    }
    expect(t, { folder.path .. "/main.lua", "a" }, "beside\tmain.lua\ta\ta\n", 0)
  end,

  ["a script's error has file and line and exit code 1"] = function(t)
    local folder <close> = folder_with { ["bad.lua"] = "local x = 1\nerror('no')\n", ["broken.lua"] = "local = 3" }
    local text, code = run { folder.path .. "/bad.lua" }
    t:contains(text, "bad.lua:2: no\nstack traceback:")
    t:equal(code, 1)
    text, code = run { folder.path .. "/broken.lua" }
    t:contains(text, "broken.lua:1: <name> expected near '='")
    t:equal(code, 1)
    expect(t, { "-e", "error(setmetatable({}, {__tostring = function() return 'mine' end}))" }, "aib-lua: mine\n", 1)
  end,

  ["a bad file is a sentence and exit code 3"] = function(t)
    expect(t, { "-e", "aib.system.read_text('nowhere.txt')" },
      "aib-lua: (command line):1: nowhere.txt: cannot open: No such file or directory\n", 3)
  end,

  ["a command line that is not understood is exit code 2"] = function(t)
    local again = "\ntry aib-lua --help\n"
    expect(t, { "--thread" }, "aib-lua: unknown option '--thread', did you mean '--threads'?" .. again, 2)
    expect(t, { "--threads", "x" }, "aib-lua: --threads: a number of threads expected, found 'x'" .. again, 2)
    expect(t, { "-q" }, "aib-lua: unknown option '-q'" .. again, 2)
    expect(t, { "-e" }, "aib-lua: -e: a value expected, found nothing" .. again, 2)
    expect(t, { "aset_inspection" },
      "aib-lua: no script or protocol 'aset_inspection', did you mean 'asset_inspection'?" .. again, 2)
  end,

  ["an undefined global is an error with a suggestion"] = function(t)
    local text, code = run { "-e", "prnt(1)" }
    t:contains(text, "(command line):1: undefined variable 'prnt', did you mean 'print'?")
    t:equal(code, 1)
    local folder <close> = folder_with { ["a.lua"] = "print(aib)", ["b.lua"] = "function f()\n  count = 1\nend\nf()" }
    local begin = 'a.lua:1: undefined variable \'aib\'; begin with: local aib = require "aib"'
    t:contains(run { folder.path .. "/a.lua" }, begin)
    t:contains(run { folder.path .. "/b.lua" }, "b.lua:2: assignment to undefined variable 'count' inside a function")
  end,

  ["a global may be defined outside of functions, also as nil"] = function(t)
    expect(t, { "-e", "a = nil b = 2 print(a, b) local function f() b = 3 end f() print(b)" }, "nil\t2\n3\n", 0)
  end,

  ["protocols are found by name: here, on AIB_PATH, installed"] = function(t)
    local source = "local aib = require 'aib' return aib.protocol { name = 'p', title = 'Mine', inputs = {}, "
      .. "run = function(_, report) report:add('x', 1) end }"
    local folder <close> = folder_with { ["mine.lua"] = source }
    local here, shell = quoted(folder.path), quoted(program)
    local function output(command) return assert(io.popen(command .. " 2>&1")):read("a") end
    t:contains(output(("cd %s && %s mine"):format(here, shell)), "x")
    t:contains(output(("AIB_PATH=%s %s mine"):format(here, shell)), "x")
    t:contains(output(("AIB_PATH=%s %s --list"):format(here, shell)), "mine                      Mine\n")
    t:contains(output(("AIB_PATH=%s %s -E mine"):format(here, shell)), "no script or protocol 'mine'")
    t:contains(run { "--list" }, "asset_inspection")
  end,

  ["every installed protocol has a title, help, every format of results, and refuses other options"] = function(t)
    local list, n = run { "--list" }, 0
    for line in list:gmatch "[^\n]+" do
      local name, title = line:match "^(%S+)%s+(.+)$"
      t:check(title, line)
      local text, code = run { name, "--help" }
      t:equal(code, 0, name)
      t:contains(text, "usage: aib-lua " .. name)
      for _, option in ipairs { "--json", "--csv", "--markdown", "--latex", "--html", "--threads", "--quiet" } do
        t:contains(text, "\n  " .. option, name)
      end
      text, code = run { name, "--no-such-option" }
      t:equal(code, 2, name)
      t:contains(text, name .. ": unknown option '--no-such-option'")
      n = n + 1
    end
    t:check(n >= 18, n .. " protocols")
  end,

  ["a protocol takes the shell's flags after its name, too"] = function(t)
    local source = "local aib = require 'aib' return aib.protocol { name = 'p', inputs = {}, "
      .. "run = function(_, report) report:add('x', 1) end }"
    local folder <close> = folder_with { ["p.lua"] = source }
    local script = folder.path .. "/p.lua"
    expect(t, { script, "--threads", "1", "--quiet" }, "", 0)
    expect(t, { "--threads", "1", "--quiet", script, "--quiet" }, "", 0)
    expect(t, { script, "--sandbox" }, "p: --sandbox goes before the name: aib-lua --sandbox p (see --help)\n", 2)
  end,

  ["numbers keep their point whatever locale a script asks for"] = function(t)
    local code = "os.setlocale('') os.setlocale('C.UTF-8', 'numeric') print(1.5, tonumber '1.5')"
    expect(t, { "-e", code }, "1.5\t1.5\n", 0)
    expect(t, { "-e", "print(os.setlocale('no such locale'), os.setlocale('C'))" }, "nil\tC\n", 0)
  end,

  ["Ctrl-C stops Lua code, also where it catches errors, with exit code 130"] = function(t)
    for _, code in ipairs { "while true do end", "while true do pcall(function() while true do end end) end" } do
      local command = ("timeout --preserve-status --signal=INT 0.2 %s -e %s"):format(quoted(program), quoted(code))
      local _, _, status = os.execute(command .. " 2>/dev/null")
      t:equal(status, 130, code)
    end
  end,

  ["Ctrl-C ends what cannot be stopped"] = function(t)
    local code = "coroutine.wrap(function() while true do end end)()"
    local _, _, status = os.execute(
      ("timeout --preserve-status --signal=INT 0.2 %s -e %s 2>/dev/null"):format(quoted(program), quoted(code)))
    t:equal(status, 130)
  end,

  ["a failed test is told with its line, and is exit code 1"] = function(t)
    local folder <close> = folder_with {
      ["t.lua"] = "local aib = require 'aib' return aib.test {\n"
        .. "a = function(t) t:equal({ 1, 'x' }, { 1, 'y' }) end,\n"
        .. "b = function(t) t:near(1, 2, 0.5) end,\n"
        .. "c = function(t) t:raises('z', function() end) end,\n"
        .. "d = function(t) t:skip('no data') end,\n"
        .. "e = function(t) t:check(true) end,\n}",
    }
    local text, code = run { folder.path .. "/t.lua" }
    t:equal(code, 1)
    t:contains(text, "FFFs.\n")
    t:contains(text, 't.lua:2: expected {[1] = 1, [2] = "y"}, found {[1] = 1, [2] = "x"}')
    t:contains(text, "t.lua:3: expected 2 within 0.5, found 1")
    t:contains(text, 't.lua:4: expected an error with "z", found none')
    t:contains(text, "SKIPPED: d: no data")
    t:contains(text, "1 passed, 3 failed, 1 skipped")
  end,

  ["--help says everything that the command line takes"] = function(t)
    local text = run { "--help" }
    for _, flag in ipairs { "-e", "-l", "-i", "-v", "-E", "-W", "--list", "--threads", "--quiet", "--version" } do
      t:contains(text, flag)
    end
  end,
}
