-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Poses, cameras and arrays as scripts read and write them.
local aib = require "aib"

--- Writes files into a new folder, removed at the end of the scope, and returns a function from name to path.
local function folder_with(files)
  local folder = os.tmpname()
  os.remove(folder)
  assert(os.execute("mkdir -p '" .. folder .. "'"))
  for name, text in pairs(files) do aib.system.write_text(folder .. "/" .. name, text) end
  return setmetatable({}, {
    __call = function(_, name) return folder .. "/" .. name end,
    __close = function() os.execute("rm -r '" .. folder .. "'") end,
  })
end

local kitti <const> = "1 0 0 1 0 1 0 2 0 0 1 3\n1 0 0 4 0 1 0 5 0 0 1 6\n"

return aib.test {
  ["a trajectory is read, its format told from the content"] = function(t)
    local path <close> = folder_with { ["poses.txt"] = kitti }
    local trajectory = aib.io.read_trajectory(path "poses.txt", { names = { "a.png", "b.png" } })
    t:equal(#trajectory, 2)
    t:equal(trajectory.names, { "a.png", "b.png" })
    t:equal(trajectory:positions()[2][3], 6.0)
  end,

  ["every component of an OpenSfM reconstruction can be read"] = function(t)
    local component <const> = [[{
      "cameras": {"c": {"projection_type": "perspective", "width": 64, "height": 48, "focal": 1}},
      "shots": {"%s": {"camera": "c", "rotation": [0, 0, 0], "translation": [1, 2, 3]}}}]]
    local path <close> = folder_with {
      ["reconstruction.json"] = ("[" .. component .. "," .. component .. "]"):format("a.jpg", "b.jpg"),
    }
    local components = aib.io.read_opensfm_components(path "reconstruction.json")
    t:equal({ #components, components[2].trajectory.names }, { 2, { "b.jpg" } })
    t:equal(components[1].trajectory:positions()[1], { -1.0, -2.0, -3.0 })
    t:equal(components[1].cameras["a.jpg"].fx, 64.0)
  end,

  ["convention and axes turn the poses"] = function(t)
    local path <close> = folder_with { ["poses.txt"] = kitti }
    local inverse = aib.io.read_trajectory(path "poses.txt", { convention = "camera_from_world" })
    t:equal(inverse:positions()[1][1], -1.0)
  end,

  ["a wrong file or option is refused in a sentence"] = function(t)
    local path <close> = folder_with { ["poses.txt"] = "1 2 3\n" }
    local function refuses(sentence, options) t:raises(sentence, aib.io.read_trajectory, path "poses.txt", options) end
    refuses("poses.txt:1: tum: 8 numbers", { format = "tum" })
    refuses("cannot be told from '1 2 3'")
    refuses("did you mean 'format'", { formt = "tum" })
    refuses("'tumm'", { format = "tumm" })
  end,

  ["poses and cameras come back from the COLMAP model that they are written to"] = function(t)
    local path <close> = folder_with { ["poses.txt"] = kitti }
    local trajectory = aib.io.read_trajectory(path "poses.txt", { names = { "a.png", "b.png" } })
    local camera = aib.math.camera { width = 640, height = 480, parameters = { 500, 501, 320, 240 } }
    for _, encoding in ipairs { "binary", "text" } do
      aib.io.write_trajectory(path(encoding), trajectory, {
        cameras = { ["a.png"] = camera, ["b.png"] = camera },
        encoding = encoding,
      })
      local model = aib.io.read_colmap(path(encoding))
      t:equal(model.trajectory.names, { "a.png", "b.png" })
      t:equal(model.trajectory:positions()[2][1], 4.0)
      t:equal(model.cameras["b.png"].fy, 501.0)
      t:equal(#model.points, 0)
      t:equal(#aib.io.read_colmap_models(path(encoding)), 1)
      t:equal(aib.io.read_cameras(path(encoding))["a.png"].parameters, { 500.0, 501.0, 320.0, 240.0 })
    end
  end,

  ["a camera shows itself and knows what it has not"] = function(t)
    local pinhole = aib.math.camera { width = 640, height = 480, parameters = { 500, 501, 320, 240 } }
    t:equal(tostring(pinhole), "camera(PINHOLE 640x480, f 500)")
    local sphere = aib.math.camera { model = "EQUIRECTANGULAR", parameters = { 1000, 500 } }
    t:equal(sphere.fx, nil)
    t:raises("4 numbers of PINHOLE expected, found 1", aib.math.camera, { parameters = { 500 } })
    t:raises("finite numbers expected", aib.math.camera, { parameters = { 0 / 0, 500, 320, 240 } })
    t:raises("a camera model of COLMAP expected, found 'PINHOL', did you mean 'PINHOLE'?", aib.math.camera,
      { model = "PINHOL" })
  end,

  ["an array comes back from the NPY file that it is written to"] = function(t)
    local path <close> = folder_with { ["poses.txt"] = kitti }
    aib.io.write_trajectory(path "poses.npy", aib.io.read_trajectory(path "poses.txt"))
    local array = aib.io.read_array(path "poses.npy")
    t:equal(tostring(array), "array(f8 (2, 4, 4))")
    t:equal(array.shape, { 2, 4, 4 })
    t:equal(#array, 32)
    t:equal(array[4], 1.0)
    t:equal(array:at(2):at(3)[4], 6.0)
    aib.io.write_array(path "copy.npy", array)
    t:equal(aib.io.read_array(path "copy.npy").shape, { 2, 4, 4 })
    t:equal(aib.io.array_names(path "copy.npy"), {})
  end,
}
