-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Calls every bound function, and protocols' command lines, with made-up values. What a refusal expects is tried next,
--- so that calls get deeper: types of arguments, names, types and choices of options. A call gives results or raises a
--- sentence of a known kind that names the function; anything else is a finding.
---
---   aib-lua fuzz_calls.lua [CALLS [SEED]]     in an empty folder: it writes files
local aib = require "aib"
local shell = require "aib.shell"

local calls <const> = math.tointeger(tonumber(arg[1])) or 20000
math.randomseed(math.tointeger(tonumber(arg[2])) or 1)

local function any(list) return list[math.random(#list)] end

-- Values --------------------------------------------------------------------------------------------------------------

local function camera()
  return aib.math.camera { model = "PINHOLE", width = 4, height = 3, parameters = { 4, 4, 2, 1.5 } }
end

local function cloud(n)
  local points = {}
  for i = 1, n or math.random(0, 9) do points[i] = { math.random(), math.random(), math.random() } end
  return aib.cloud.from_points(points)
end

local function trajectory()
  local poses, names, stamps = {}, {}, {}
  for i = 1, math.random(0, 6) do
    poses[i], names[i], stamps[i] = aib.math.pose { centre = { math.random(), i, 0 } }, "f" .. i, i
  end
  return aib.pose.trajectory(poses, { names = names, stamps = stamps })
end

local function depth_map()
  local rows = {}
  for y = 1, 3 do
    rows[y] = {}
    for x = 1, 4 do rows[y][x] = any { 0, 1, 2.5, 0 / 0, math.huge, math.random() } end
  end
  return aib.depth.map(rows)
end

local function labels() return aib.raster.labels { { 0, 1, 2, 3 }, { 0, 1, 2, 3 }, { 65535, 0, 0, 1 } } end

local tetrahedron <const> = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
local function mesh()
  aib.system.write_text("mesh.obj", tetrahedron)
  return aib.io.read_mesh "mesh.obj"
end

local function loop()
  local t = {}
  t[1], t.x = t, t
  return t
end

--- AddressSanitizer ends a process that asks for more memory than there is: then nothing asks for that.
local small <const> = os.getenv "AIB_FUZZ_SMALL"

--- Objects by the name that messages give their type.
local makers = {
  cloud = cloud, trajectory = trajectory, depth_map = depth_map, label_image = labels, camera = camera, mesh = mesh,
  ["integer >= 0"] = function()
    return any(small and { 0, 1, 2, 3 } or { 0, 1, 2, 3, 2 ^ 31, 2 ^ 53, math.maxinteger })
  end,
  ["integer"] = function() return any(small and { 0, 1, -1 } or { 0, 1, -1, math.mininteger, math.maxinteger }) end,
  number = function()
    return any(small and { 0, 1, -1, 0.5, 30, 0 / 0, -math.huge, math.random() }
      or { 0, 1, -1, 0.5, 30, 1e-300, 1e300, 0 / 0, math.huge, -math.huge, math.random() })
  end,
  boolean = function() return any { true, false } end,
  string = function() return any { "", "a", "a.ply", "a.txt", "no/such/file", "a\0b", "ä", ("x"):rep(300), "%s%n" } end,
  table = function() return any { {}, { 1, 2, 3 }, { a = 1 }, { { 1, 2, 3 }, { 4, 5, 6 } }, loop() } end,
  ["function"] = function() return function() return 1 end end,
  sim3 = function() return aib.math.sim3 { scale = any { 1, 2 }, translation = { math.random(), 0, 0 } } end,
  pose = function() return aib.math.pose { centre = { math.random(), 0, 0 } } end,
  array = function() return aib.io.array { { 1, 2 }, { 3, 0 / 0 } } end,
  distances = function() return aib.cloud.distances(cloud(3), cloud(2)) end,
  offsets = function() return aib.mesh.offsets(cloud(3), mesh()) end,
  image = function() return aib.depth.error_image(aib.depth.map { { 1, 2 } }, aib.depth.map { { 1, 3 } }) end,
  moments = function() return aib.stats.moments():add(1):add(3) end,
  accumulator = function() return aib.depth.accumulate():add(depth_map(), depth_map(), { name = "a" }) end,
  fitter = function() return aib.depth.fit():add(depth_map(), depth_map()) end,
  voxel_grid = function() return aib.sample.voxel_grid { size = 0.5 } end,
}
makers["path (string)"] = makers.string
local kinds = {}
for kind in pairs(makers) do kinds[#kinds + 1] = kind end
table.sort(kinds)

local function anything() return makers[any(kinds)]() end

--- A value of what a message expects: "cloud", "list of numbers", "number or nil".
local function of_kind(kind)
  if math.random(12) == 1 then return anything() end
  local element = kind:match "^list of (.*)$"
  if element then
    element = element:gsub("^([%w_]+)ies%f[^%w_]", "%1y"):gsub("^([%w_]+)s%f[^%w_]", "%1")
    local list = {}
    for i = 1, math.random(0, 4) do list[i] = of_kind(element) end
    return list
  end
  kind = kind:gsub(" or nil$", "")
  local maker = makers[kind] or makers[kind:match "^%a+" or ""] or anything
  return maker()
end

-- Calls ---------------------------------------------------------------------------------------------------------------

local learned = {}  -- by function: { arguments = { [i] = kind }, options = { [name] = kind or list of choices } }

local function memory_of(name)
  learned[name] = learned[name] or { arguments = {}, options = {}, n = math.random(0, 3) }
  return learned[name]
end

local function option_value(known)
  if type(known) == "table" and math.random(8) > 1 then return any(known) end
  return type(known) == "string" and of_kind(known) or anything()
end

--- Options that say how often something is done: a large number takes its time, as it should.
local loops <const> = {
  resamples = true, robust_iterations = true, max_iterations = true, n = true, steps = true, bins = true,
}

local function options_from(memory)
  local options = {}
  for name, known in pairs(memory.options) do
    if math.random(3) == 1 then options[name] = loops[name] and math.random(0, 9) or option_value(known) end
  end
  if math.random(6) == 1 then options[any { "no_such", "", 1, "tau" }] = anything() end
  return options
end

local function argument(memory, i)
  local kind = memory.arguments[i]
  if kind == "options" then return options_from(memory) end
  return kind and of_kind(kind) or anything()
end

--- Takes from a refusal what is expected.
local function learn(memory, message)
  local at, _, kind = message:match "argument (%d+) %(([%w_]+)%): (.-) expected, found"
  if at then
    memory.n = math.max(memory.n, tonumber(at))
    memory.arguments[tonumber(at)] = kind:find "options" and "options" or kind
  end
  local choices = message:match "option '[^']*': one of (.-) expected"
  local name = message:match "option '([^']*)': "
  if choices then
    local list = {}
    for choice in choices:gmatch "[%w_]+" do list[#list + 1] = choice end
    memory.options[name] = list
  elseif name then
    memory.options[name] = message:match "option '[^']*': (.-) expected, found" or true
  end
  for _, known in ipairs { message:match "%(known: (.-)%)", message:match "did you mean '(.-)'%?" } do
    for option in known:gmatch "[%w_]+" do memory.options[option] = memory.options[option] or true end
  end
  local most = message:match "at most (%d+) arguments expected"
  if most then memory.n = tonumber(most) end
end

local findings = 0
local function finding(name, what)
  findings = findings + 1
  print(("FOUND  %s: %s"):format(name, what))
end

local good_kinds <const> = { argument = true, io = true, output = true, format = true, undefined = true }

--- The function of a name such as "aib.pose.auc" or "cloud:bounds", and whether it takes an object first.
local function resolve(name)
  local owner, separator, member = name:match "^([%w_.]+)([:.])([%w_]+)$"
  if owner:find "^aib" then
    local value = aib
    for part in (owner .. "." .. member):gsub("^aib%.", ""):gmatch "[^.]+" do value = value[part] end
    return value
  end
  local maker = makers[owner]
  if not maker then return nil end
  if separator == ":" then return function(...) return maker()[member](...) end, owner end
  if member:find "^__" then return nil end
  return function(object) return object[member] end, owner
end

local function call(name)
  local f, object = resolve(name)
  if type(f) ~= "function" then return end
  local memory = memory_of(name)
  local arguments = table.pack()
  if object then arguments[1] = math.random(20) > 1 and makers[object]() or anything() end
  local shift = object and 1 or 0
  local n = math.random(25) == 1 and math.random(0, 6) or memory.n
  if math.random(5) == 1 then n = n + 1 end
  for i = 1, n do arguments[shift + i] = argument(memory, i) end
  local ok, message = pcall(f, table.unpack(arguments, 1, shift + n))
  if ok then return end
  if type(message) ~= "string" then return finding(name, "an error of type " .. type(message)) end
  local kind = aib.error_kind(message)
  learn(memory, message)
  if not good_kinds[kind] and not message:find "not enough memory" and not (object and kind == "script") then
    finding(name, ("an error of kind %s: %s"):format(kind, message))
  elseif kind == "argument" and #message > 2000 then
    finding(name, "a message of " .. #message .. " bytes")
  end
end

-- Protocols -----------------------------------------------------------------------------------------------------------

local input_kinds <const> = {
  "text", "path", "file", "folder", "output", "number", "integer", "choice", "list", "flag", "no_kind",
}

local function input()
  local spec = { kind = any(input_kinds) }
  local function maybe(name, value) if math.random(3) == 1 then spec[name] = value end end
  maybe("default", anything())
  maybe("unit", any { "m", "deg", "s", "B", "px", 3 })
  maybe("min", any { 0, -1, "a" })
  maybe("max", any { 0, 1e9, {} })
  maybe("above", any { 0, -1, "a" })
  maybe("ending", any { ".png", "", 3 })
  maybe("choices", any { { "a", "b" }, {}, "a", { 1, {} } })
  maybe("of", any(input_kinds))
  maybe("position", any { 1, 2, 0, "x" })
  maybe("help", any { "sentence", 3, ("long "):rep(50) })
  return spec
end

local words <const> = {
  "--a", "--b", "--a=", "--a=1", "--b=x,y", "--no-a", "--", "-", "-h", "--help", "", "1", "5cm", "1e999", "a,b",
  "--json", "--json=", "--csv", "no/such/x.json", "--threads", "--threads=-1", "--quiet=1", "--\0", "--ä",
  ("x"):rep(200), "--sandbox", "1,,2", "nan", "0x10",
}

local function silent(f, ...)
  local stdout, stderr = io.stdout, io.stderr
  local said = {}
  local sink = { write = function(self, ...) said[#said + 1] = table.concat { ... } return self end }
  io.stdout, io.stderr = sink, sink  -- luacheck: ignore 122
  local results = table.pack(pcall(f, ...))
  io.stdout, io.stderr = stdout, stderr  -- luacheck: ignore 122
  return results[1], results[2], table.concat(said)
end

local function command_line()
  local spec = { name = "p", inputs = {}, run = function() end }
  for _, key in ipairs { "a", "b", "c" } do
    if math.random(2) == 1 then spec.inputs[key] = input() end
  end
  if math.random(20) == 1 then spec[any { "name", "title", "help", "inputs", "run", "nonsense" }] = anything() end
  local declared, protocol = pcall(aib.protocol, spec)
  if not declared then
    if not tostring(protocol):find "aib%.protocol" then finding("aib.protocol", tostring(protocol)) end
    return
  end
  local arguments = {}
  for i = 1, math.random(0, 5) do arguments[i] = any(words) end
  local ok, code, said = silent(protocol.main, protocol, arguments)
  if not ok or code == 1 or not math.tointeger(code) then
    finding("protocol:main", ("%s after %s: %s"):format(tostring(code), table.concat(arguments, " "), said))
  end
end

-- Run -----------------------------------------------------------------------------------------------------------------

local names = {}
for _, name in ipairs(shell.bound_names()) do
  if not (name:find "^aib%.system" or name:find "^aib%.shell" or name:find "%.__") then names[#names + 1] = name end
end

local trace <const> = os.getenv "AIB_FUZZ_TRACE"
for i = 1, calls do
  local name = i % 8 == 0 and "protocol" or any(names)
  if trace then io.stderr:write(name, "\n") end
  if name == "protocol" then command_line() else call(name) end
end
print(("%d calls of %d functions, %d findings"):format(calls, #names, findings))
os.exit(findings == 0 and 0 or 1)
