-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Attacks on `aib-lua --sandbox`. Each is a script that gets through when it prints "ESCAPED".
local aib = require "aib"

local program <const> = arg[-1]

local function quoted(word) return "'" .. word:gsub("'", "'\\''") .. "'" end

local function shell(command)
  local pipe <close> = assert(io.popen(command .. " 2>&1 </dev/null"))
  local text = pipe:read("a")
  local _, _, code = pipe:close()
  return text, code
end

--- A folder with a script, a readable folder `data` with a link that leads out of it, a writable `out`, and a secret
--- beside them.
local function scene(script)
  local top = os.tmpname()
  os.remove(top)
  assert(os.execute(("mkdir -p %s/script %s/data %s/out"):format(top, top, top)))
  assert(os.execute(("ln -s ../secret.txt %s/data/link && ln -s / %s/data/all"):format(top, top)))
  aib.system.write_text(top .. "/secret.txt", "secret")
  aib.system.write_text(top .. "/data/fine.txt", "fine")
  aib.system.write_text(top .. "/script/attack.lua", ("local top <const> = %q\n"):format(top) .. script)
  return setmetatable({ path = top }, { __close = function() os.execute("rm -r " .. quoted(top)) end })
end

local function run(script, flags)
  local at <close> = scene(script)
  return shell(("%s --sandbox --read %s/data --write %s/out %s %s/script/attack.lua")
    :format(quoted(program), at.path, at.path, flags or "", at.path))
end

local has_landlock <const> = not run("print(1)"):find("Landlock", 1, true)

--- A case that is skipped where the kernel cannot confine.
local function confined(body)
  return function(t)
    if not has_landlock then t:skip("this kernel has no Landlock") end
    body(t)
  end
end

--- A case where the script must not print ESCAPED.
local function attack(script, flags)
  return confined(function(t)
    local text = run(script, flags)
    t:check(not text:find("ESCAPED", 1, true), text)
    t:check(not text:find("secret\n", 1, true), text)
  end)
end

return aib.test {
  ["a harmless script reads, writes, requires and computes"] = confined(function(t)
    local text, code = run [[
      local aib = require "aib"
      print(aib.system.read_text(top .. "/data/fine.txt"), io.open(top .. "/data/fine.txt"):read("a"))
      aib.system.write_text(top .. "/out/result.txt", "result")
      print(aib.system.read_text(top .. "/out/result.txt"), ("%.1f"):format(aib.stats.summary({ 1, 3 }).mean))
      print(pcall(function() return 1 + load("return 2")() end))
    ]]
    t:equal(text, "fine\tfine\nresult\t2.0\ntrue\t3\n")
    t:equal(code, 0)
  end),

  ["a protocol runs and writes its results"] = confined(function(t)
    local at <close> = scene [[
      local aib = require "aib"
      return aib.protocol { name = "p", inputs = {}, run = function(_, report) report:add("x", 1) end }
    ]]
    local text, code = shell(("%s --sandbox --write %s/out %s/script/attack.lua --json %s/out/r.json"):format(
      quoted(program), at.path, at.path, at.path))
    t:equal(code, 0, text)
    t:contains(aib.system.read_text(at.path .. "/out/r.json"), '"x"')
  end),

  ["a file outside is not read, however it is called"] = attack [[
    local aib = require "aib"
    for _, path in ipairs { "/secret.txt", "/data/../secret.txt", "/data/link", "/out/../secret.txt" } do
      local file = io.open(top .. path)
      if file then print("ESCAPED", path, file:read("a")) end
      if pcall(aib.system.read_text, top .. path) then print("ESCAPED", path) end
      if pcall(io.lines, top .. path) then print("ESCAPED", path) end
    end
    if io.open("/etc/passwd") or io.open(top .. "/data/all/etc/passwd") then print("ESCAPED passwd") end
    if pcall(aib.system.names_in, "/") then print("ESCAPED names") end
    if loadfile(top .. "/secret.txt") or pcall(dofile, top .. "/secret.txt") then print("ESCAPED load") end
  ]],

  ["a file outside is not written, nor one that may be read alone"] = attack [[
    local aib = require "aib"
    for _, path in ipairs { "/new.txt", "/data/new.txt", "/out/../new.txt", "/data/fine.txt", "/script/attack.lua" } do
      if io.open(top .. path, "w") then print("ESCAPED", path) end
      if pcall(aib.system.write_text, top .. path, "x") then print("ESCAPED", path) end
    end
  ]],

  ["no program is started"] = attack [[
    for _, f in ipairs { "os.execute", "io.popen", "os.remove", "os.rename", "os.tmpname", "package.loadlib" } do
      local module, name = f:match("(%a+)%.(%a+)")
      if rawget(_G[module], name) then print("ESCAPED", f) end
    end
    if os.getenv("PATH") or os.getenv("HOME") then print("ESCAPED environment") end
  ]],

  ["no native module is loaded"] = attack [[
    package.cpath = top .. "/data/?.so"
    local ok, e = pcall(require, "evil")
    if ok or tostring(e):find("%.so") then print("ESCAPED", e) end
  ]],

  ["no bytecode is run"] = attack [[
    local bytecode = "\27Lua" .. ("\0"):rep(100)
    if load(bytecode, "x", "b") or load(function() return nil end, "x", "b") == nil then print("ESCAPED") end
    local f, e = load(bytecode, "x", "b")
    if f or not e:find("binary chunk") then print("ESCAPED", e) end
    if rawget(string, "dump") or rawget(require "string", "dump") then print("ESCAPED dump") end
  ]],

  ["the debug library is not reached"] = attack [[
    if rawget(debug, "getregistry") or rawget(debug, "sethook") then print("ESCAPED") end
    if package.loaded.debug or pcall(require, "debug") then print("ESCAPED loaded") end
  ]],

  ["no finalizer is set"] = attack [[
    if pcall(setmetatable, {}, { __gc = function() while true do end end }) then print("ESCAPED") end
    local meta = setmetatable({}, { __index = function() return print end })
    pcall(setmetatable, {}, meta)
    if pcall(collectgarbage, "stop") or pcall(collectgarbage, "generational") then print("ESCAPED collector") end
  ]],

  ["what is refused is said in a sentence"] = confined(function(t)
    local text, code = run [[
      print(select(2, pcall(setmetatable, {}, { __gc = print })))
      print(select(2, pcall(collectgarbage, "stop")))
    ]]
    t:equal({ text, code }, {
      "sandbox: a metatable without __gc expected\nsandbox: collectgarbage 'collect' or 'count' expected\n", 0,
    })
  end),

  ["the methods of strings and the types of aib are not replaced"] = attack [[
    local aib = require "aib"
    string.format = function() return "ESCAPED" end
    package.loaded.string.rep = function() return "ESCAPED" end
    print(("%d"):format(1), ("x"):rep(2))
    if type(getmetatable("")) == "table" then print("ESCAPED metatable") end
    if type(getmetatable(aib.stats.moments())) == "table" then print("ESCAPED type") end
  ]],

  ["memory bombs end in an error of Lua"] = confined(function(t)
    for _, bomb in ipairs {
      "local t = {} for i = 1, 1e9 do t[i] = {} end",
      "local s = 'x' while true do s = s .. s end",
      "return ('x'):rep(1 << 30)",
      "return string.rep('x', 1 << 30, string.rep('y', 1 << 30))",
    } do
      local text, code = run(bomb, "--memory 64")
      t:contains(text, "not enough memory", bomb)
      t:equal(code, 1, bomb)
    end
  end),

  ["the budget of instructions holds against pcall, coroutines and handlers"] = confined(function(t)
    for _, bomb in ipairs {
      "while true do end",
      "while true do pcall(function() while true do end end) end",
      "while true do coroutine.wrap(function() pcall(function() while true do end end) end)() end",
      "local function f() return f() end xpcall(f, function() while true do end end)",
      "local t = setmetatable({}, { __close = function() while true do end end }) do local x <close> = t end",
      "table.sort({ 3, 2, 1 }, function() while true do end end)",
      "('x'):gsub('x', function() while true do end end)",
    } do
      local text, code = run(bomb, "--instructions 1000000 --seconds 20")
      t:contains(text, "sandbox: the budget of instructions is used up", bomb)
      t:equal(code, 1, bomb)
    end
  end),

  ["patterns that never end run out of processor time"] = confined(function(t)
    local text, code = run("local s = ('a'):rep(40) print(s:find(('a?'):rep(40) .. s .. s))", "--seconds 1")
    t:contains(text, "sandbox: the processor time is used up")
    t:equal(code, 1)
  end),

  ["the flags say what they need"] = function(t)
    local function usage(flags, expected)
      local text, code = shell(quoted(program) .. " " .. flags)
      t:contains(text, expected)
      t:equal(code, 2)
    end
    usage("--sandbox", "--sandbox: a script expected, without -e, -l, -W and -i")
    usage("--sandbox -e 'print(1)' x.lua", "--sandbox: a script expected, without -e, -l, -W and -i")
    usage("--read / x.lua", "--read is for --sandbox, which is not given")
    usage("--sandbox --memory much x.lua", "--memory: a number of MB expected, found 'much'")
    usage("--sandbox --seconds -1 x.lua", "--seconds: a number of seconds expected, found '-1'")
    usage("--sandbox --instructions 1e9 x.lua", "--instructions: a number of instructions expected, found '1e9'")
    usage("--sandbox --read", "--read: a value expected, found nothing")
  end,
}
