-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

local aib = require "aib"

local minimal <const> = [[
return {
  scenes = { { name = "s", poses = "p", conditions = { "low", "high" } }, { name = "t", poses = "q" } },
  methods = {
    { name = "A", parameters = "estimated", results = { { scene = "s", condition = "high", models = "m" } } },
    { name = "B", parameters = "ground truth", results = { { scene = "t", cloud = "c.ply" } } },
  },
}
]]

--- Opens a folder whose benchmark.lua is this text.
local function open(text)
  local folder = os.tmpname()
  os.remove(folder)
  assert(os.execute("mkdir " .. folder))
  aib.system.write_text(folder .. "/benchmark.lua", text)
  local ok, result = pcall(aib.benchmark.open, folder)
  assert(os.execute("rm -r " .. folder))
  if not ok then error(result, 0) end
  return result
end

local function replaced(old, new)
  local at = assert(minimal:find(old, 1, true), old)
  return minimal:sub(1, at - 1) .. new .. minimal:sub(at + #old)
end

return aib.test {
  ["the units are every scene, condition and method in the order of the file"] = function(t)
    local names = {}
    for i, unit in ipairs(open(minimal).units) do
      names[i] = ("%s %s %s %s"):format(unit.scene.name, unit.condition, unit.method.name, unit.result ~= nil)
    end
    t:equal(names, {
      "s low A false", "s low B false", "s high A true", "s high B false", "t nil A false", "t nil B true",
    })
  end,

  ["a benchmark.lua that is wrong is a format error that says where"] = function(t)
    local function wrong(text, part)
      t:raises(part, open, text)
      local _, caught = pcall(open, text)
      t:equal(aib.error_kind(caught), "format")
    end
    wrong("return 1", "benchmark.lua: a table expected, found number")
    wrong("return {", "benchmark.lua:1:")
    wrong("print(1)", "benchmark.lua:1: a benchmark is data: the global 'print' is not available")
    wrong("return {}", "scenes is missing")
    wrong("return { scenes = {}, method = {} }", "unknown field 'method', did you mean 'methods'?")
    wrong(replaced('name = "s"', "name = 3"), "scene 1: name: a string expected, found number")
    wrong(replaced('name = "t"', 'name = "s"'), "two scenes are called 's'")
    wrong(replaced('poses = "q"', "posse = 1"), "scene 2: unknown field 'posse', did you mean 'poses'?")
    wrong(replaced('name = "B"', 'name = "A"'), "two methods are called 'A'")
    wrong(replaced('"estimated"', '"guessed"'), "method A: parameters: unknown 'guessed'")
    wrong(replaced('condition = "high"', 'condition = "hihg"'),
      "result 1: condition: unknown 'hihg', did you mean 'high'?")
    wrong(replaced('condition = "high", ', ""), "result 1: condition: unknown 'nil'")
    wrong(replaced('scene = "t"', 'scene = "t", condition = "low"'), "condition: scene 't' has none")
    wrong(replaced('models = "m"', 'models = "m", poses = "p"'), "models or poses expected, found both")
    wrong(replaced('models = "m"', 'models = "m", frame = "world"'), "frame: unknown 'world'")
    wrong(replaced("{ { scene = \"t\"", "{ { scene = \"t\" }, { scene = \"t\""), "two results are of 't'")
  end,

  ["patterns stand for images"] = function(t)
    t:equal(aib.files.expand("d/{stem}.exr", "000001.png"), "d/000001.exr")
    t:equal(aib.files.expand("d/{name}.bin", "a.b.png"), "d/a.b.png.bin")
    t:equal(aib.files.expand("{stem}{other}", "x/y.png"), "x/y{other}")
  end,

  ["files that were used are known by name and content, however they were found"] = function(t)
    local folder = os.tmpname()
    os.remove(folder)
    assert(os.execute("mkdir -p " .. folder .. "/d/e"))
    for name, text in pairs { ["a"] = "1", ["d/1.x"] = "2", ["d/2.x"] = "3", ["d/e/f"] = "4" } do
      aib.system.write_text(folder .. "/" .. name, text)
    end
    local files = aib.files.new(folder .. "/")
    t:equal(files:file("a"), folder .. "/a")
    t:equal(files:present("d/{stem}.x", { "2.png", "1.png", "3.png" }), { "2.png", "1.png" })
    files:frame("d/{stem}.x", "2.png")
    files:frame("d/{stem}.x", "1.png")
    files:whole_folder("d")
    local sources = files:sources()
    t:equal(sources.a, { bytes = 1, sha256 = aib.system.sha256("1") })
    t:equal(sources["d/{stem}.x"], { files = 2, bytes = 2, sha256 = aib.system.sha256(
      aib.system.sha256("3") .. "  d/2.x\n" .. aib.system.sha256("2") .. "  d/1.x\n") })
    t:equal(sources.d.files, 2)
    t:raises("d/{stem}.y: no file for any of 1 images; the first would be d/9.y", files.present, files, "d/{stem}.y",
      { "9.png" })
    t:raises("no such folder", aib.files.new, folder .. "/nothing")
    assert(os.execute("rm -r " .. folder))
  end,
}
