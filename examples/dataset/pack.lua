-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Makes a benchmark folder of what lies in it: benchmark.lua, LICENSE, SHA256SUMS.
---
---   aib-lua examples/dataset/pack.lua FOLDER
---
---   gt/SCENE/                    of plan.lua and truth.lua
---   images/SCENE[-CONDITION]/    the pictures that methods get
---   methods/METHOD/SCENE[-CONDITION]/run.json, sparse/, dense/    what run_colmap.sh left
local aib = require "aib"

local conditions <const> = { "very_low", "low", "medium", "high" }

local licence <const> = [[
The scenes, pictures and truth in this folder were made with the generators of aib (examples/dataset) and may be used
for anything: CC0-1.0, https://creativecommons.org/publicdomain/zero/1.0/
]]

local function names_in(folder) return aib.system.is_folder(folder) and aib.system.names_in(folder) or {} end

local function json_of(path) return aib.json.decode(aib.system.read_text(path), path) end

--- Lua text of a table of texts, numbers and tables; fields sorted.
local function literal(value, indent)
  if type(value) ~= "table" then return type(value) == "string" and ("%q"):format(value) or aib.json.number(value) end
  if type(value[1]) == "number" then return "{ " .. table.concat(value, ", ") .. " }" end
  local inner, parts, keys = indent .. "  ", {}, {}
  for _, item in ipairs(value) do parts[#parts + 1] = inner .. literal(item, inner) end
  for key in pairs(value) do
    if type(key) == "string" then keys[#keys + 1] = key end
  end
  table.sort(keys)
  for _, key in ipairs(keys) do parts[#parts + 1] = ("%s%s = %s"):format(inner, key, literal(value[key], inner)) end
  if #parts == 0 then return "{}" end
  return "{\n" .. table.concat(parts, ",\n") .. ",\n" .. indent .. "}"
end

--- Conditions that a scene has pictures of, cleanest first; none where there is one set of pictures.
local function conditions_of(folder, scene)
  local found = {}
  for _, condition in ipairs(conditions) do
    if aib.system.is_folder(("%s/images/%s-%s"):format(folder, scene, condition)) then found[#found + 1] = condition end
  end
  return #found > 0 and found or nil
end

local function scenes_in(folder)
  local scenes = {}
  for _, name in ipairs(names_in(folder .. "/gt")) do
    local truth = "gt/" .. name
    scenes[#scenes + 1] = {
      name = name, conditions = conditions_of(folder, name), poses = truth .. "/poses",
      depth = truth .. "/depth/{stem}.exr", labels = truth .. "/labels/{stem}.png", mesh = truth .. "/mesh.ply",
      points = truth .. "/points.ply",
      crop = json_of(("%s/%s/plan.json"):format(folder, truth)).crop,
    }
  end
  return scenes
end

--- The result of one run, nil where it has none.
local function result_of(folder, unit, place)
  if #names_in(("%s/%s/sparse"):format(folder, place)) == 0 then return nil end
  local scene, condition = unit:match "^([^-]+)%-?(.*)$"
  local result = { scene = scene, condition = condition ~= "" and condition or nil, models = place .. "/sparse",
    cloud = "model" }
  if aib.system.is_file(("%s/%s/dense/fused.ply"):format(folder, place)) then
    result.cloud = place .. "/dense/fused.ply"
    result.depth = place .. "/dense/stereo/depth_maps/{name}.photometric.bin"
  end
  return result
end

local function methods_in(folder)
  local methods = {}
  for _, name in ipairs(names_in(folder .. "/methods")) do
    local method = { parameters = "estimated", results = {} }
    for _, unit in ipairs(names_in(("%s/methods/%s"):format(folder, name))) do
      local place = ("methods/%s/%s"):format(name, unit)
      if aib.system.is_file(("%s/%s/run.json"):format(folder, place)) then
        method.name = method.name or json_of(("%s/%s/run.json"):format(folder, place)).method
        method.results[#method.results + 1] = result_of(folder, unit, place)
      end
    end
    if method.name then methods[#methods + 1] = method end
  end
  return methods
end

--- Sums of the files that a benchmark hands out: truth, pictures, benchmark.lua.
local function checksums(folder)
  local lines = {}
  local function add(path)
    local full = folder .. "/" .. path
    if aib.system.is_folder(full) then
      for _, name in ipairs(aib.system.names_in(full)) do add(path .. "/" .. name) end
    elseif aib.system.is_file(full) then
      lines[#lines + 1] = ("%s  %s\n"):format(aib.system.fingerprint(full).sha256, path)
    end
  end
  for _, part in ipairs { "LICENSE", "benchmark.lua", "gt", "images" } do add(part) end
  return table.concat(lines)
end

local folder = arg[1]
if not folder then
  io.stderr:write "usage: pack.lua FOLDER\n"
  os.exit(2)
end
local benchmark = { name = "assets made by aib", licence = "CC0-1.0", scenes = scenes_in(folder),
  methods = methods_in(folder) }
aib.system.write_text(folder .. "/LICENSE", licence)
aib.system.write_text(folder .. "/benchmark.lua", "return " .. literal(benchmark, "") .. "\n")
aib.system.write_text(folder .. "/SHA256SUMS", checksums(folder))
print(("%s: %d scenes, %d methods"):format(folder, #benchmark.scenes, #benchmark.methods))
