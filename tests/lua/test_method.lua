-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Adapters of methods, on three frames of what each left (methods/, cut by cut.py), and batches against the truth.
local aib = require "aib"

local here <const> = (arg[0]:match("^(.*)/[^/]*$") or ".") .. "/methods/"
local data <const> = here .. "../../../examples/data/"

local function open(name, options) return aib.method.open(here .. name, options) end

--- A folder of text files that goes away.
local function folder_of(files)
  local path = os.tmpname()
  os.remove(path)
  for name, text in pairs(files) do
    aib.system.make_folder((path .. "/" .. name):match "^(.*)/")
    aib.system.write_text(path .. "/" .. name, text)
  end
  return setmetatable({ path = path }, { __close = function() os.execute("rm -r " .. path) end })
end

local function crc32(text)
  local crc = 0xffffffff
  for i = 1, #text do
    crc = crc ~ text:byte(i)
    for _ = 1, 8 do crc = crc >> 1 ~ (crc & 1) * 0xedb88320 end
  end
  return crc ~ 0xffffffff
end

--- The bytes of an NPZ file of arrays, each { name, shape, data, type }, as numpy.savez stores them.
local function npz(arrays)
  local files, index = "", ""
  for _, array in ipairs(arrays) do
    local name, shape, content, kind = array[1] .. ".npy", table.unpack(array, 2)
    local head = ("{'descr': '%s', 'fortran_order': False, 'shape': %s, }"):format(kind, shape)
    head = head .. (" "):rep(-(#head + 11) % 64) .. "\n"
    local npy = "\x93NUMPY\1\0" .. ("<s2"):pack(head) .. content
    local about = ("<I2I2I2I2I2I4I4I4I2I2"):pack(20, 0, 0, 0, 0, crc32(npy), #npy, #npy, #name, 0)
    index = index .. "PK\1\2\20\0" .. about .. ("<I2I2I2I4I4"):pack(0, 0, 0, 0, #files) .. name
    files = files .. "PK\3\4" .. about .. name .. npy
  end
  return files .. index .. "PK\5\6" .. ("<I2I2I2I2I4I4I2"):pack(0, 0, #arrays, #arrays, #index, #files, 0)
end

--- Height of the first camera in the world of its batch, which every reader must agree on.
local function centre(batch, i) return batch.trajectory[i].centre end

return aib.test {
  ["every method is told from its files"] = function(t)
    local kinds = { da3 = "da3", da3_spelling = "da3", da3_streaming = "da3_streaming", vggt = "vggt", pi3 = "pi3",
      pi3_demo = "pi3", cut3r = "cut3r", monst3r = "dust3r" }
    for name, kind in pairs(kinds) do
      local method = open(name)
      t:equal(method.kind, kind, name)
      t:check(#method.why > 5, name .. " says why")
    end
    t:equal(aib.method.open(data .. "methods/colmap/crane").kind, "colmap")
    t:equal(aib.method.open(data .. "methods/sgbm_colmap/crane").kind, "cloud")
  end,

  ["frames have names, poses, depth and confidence"] = function(t)
    for _, name in ipairs { "da3", "da3_spelling", "da3_streaming", "vggt", "cut3r", "monst3r" } do
      local batch = open(name).batches[1]
      t:equal(batch.names, { "000000.png", "000001.png", "000002.png" }, name)
      t:equal(batch.trajectory.names, batch.names, name)
      t:check(batch.named, name)
      local depth, confidence, camera = batch.depth(3), batch.confidence(3), batch.cameras["000002.png"]
      t:equal({ confidence.width, confidence.height }, { depth.width, depth.height }, name)
      t:equal({ camera.width, camera.height }, { depth.width, depth.height }, name)
      t:equal(batch.rule, "raw", name)
    end
  end,

  ["either spelling and streaming give the same poses and cameras as the export"] = function(t)
    local a = open("da3").batches[1]
    for _, name in ipairs { "da3_spelling", "da3_streaming" } do
      local b = open(name).batches[1]
      for i = 1, 3 do
        for k = 1, 3 do t:near(centre(b, i)[k], centre(a, i)[k], 1e-5, name) end
        t:near(b.depth(i):at(80, 50), a.depth(i):at(80, 50), 0, name)
        t:near(b.cameras[a.names[i]].fx, a.cameras[a.names[i]].fx, 1e-3, name)
      end
    end
  end,

  ["intrinsics of another image size are scaled, and that is said"] = function(t)
    t:equal(open("da3").batches[1].warnings, {})
    t:contains(open("da3_spelling").batches[1].warnings[1], "3 of 3 intrinsics belong to a larger image")
  end,

  ["pi3: batches, logits, and points instead of intrinsics"] = function(t)
    local method = open "pi3"
    t:equal(#method.batches, 2)
    t:contains(method.why, "in 2 batch folders")
    local batch = method.batches[2]
    t:equal(batch.names[1], "000012.png")
    t:equal(batch.rule, "sigmoid")
    t:equal(batch.cameras, nil)
    t:equal(batch.point_map(1).shape, { 70, 112, 3 })
    local all, counts = aib.batches.points(batch, { stride = 4 })
    t:equal(#all, counts.n_valid)
    t:check(#aib.batches.points(batch, { stride = 4, min_confidence = 0.75 }) < #all)
  end,

  ["pi3's demo: confidences after the sigmoid, depth from points in the world"] = function(t)
    local batch = open("pi3_demo").batches[1]
    t:equal(batch.rule, "raw")
    local depth = batch.depth(1)
    t:equal({ depth.width, depth.height }, { 112, 70 })
    t:check(depth:at(50, 60) > 0)
  end,

  ["names are given where files have none"] = function(t)
    local folder <close> = folder_of { ["poses.txt"] = "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n" }
    local layout = { poses = "poses.txt" }
    local batch = aib.method.open(folder.path, { layout = layout }).batches[1]
    t:equal({ batch.names, batch.named }, { { "0", "1" }, false })
    batch = aib.method.open(folder.path, { layout = layout, names = { "a.png", "b.png" } }).batches[1]
    t:equal(batch.trajectory.names, { "a.png", "b.png" })
    t:raises("names", aib.method.open, folder.path, { layout = layout, names = { "a.png" } })
  end,

  ["a layout describes any other method"] = function(t)
    local batch = aib.method.open(here .. "monst3r", { layout = {
      poses = "pred_traj.txt", format = "tum", quaternion = "wxyz", names = "names.txt",
      depth = "frame_{index:4}.npy", confidence = "conf_{index}.npy",
    } }).batches[1]
    local known = open("monst3r").batches[1]
    t:equal(batch.names, known.names)
    t:equal(centre(batch, 2), centre(known, 2))
    t:equal(batch.depth(3):at(5, 5), known.depth(3):at(5, 5))
    batch = aib.method.open(here .. "vggt", { layout = {
      poses = "predictions.npz", names = "names.txt", depth = { file = "predictions.npz", key = "depth" },
    } }).batches[1]
    t:equal(batch.depth(2):at(9, 9), open("vggt").batches[1].depth(2):at(9, 9))
    t:raises("did you mean 'poses'", aib.method.open, here .. "vggt", { layout = { pose = "x" } })
  end,

  ["a method of one's own is asked first"] = function(t)
    local folder <close> = folder_of { ["mine.txt"] = "0 0 0 0 0 0 0 1\n" }
    aib.method.add {
      kind = "mine",
      find = function(path) return aib.system.is_file(path .. "/mine.txt") and "mine.txt" or nil end,
      open = function(path)
        return { names = { "a" }, named = true, trajectory = aib.io.read_trajectory(path .. "/mine.txt",
          { names = { "a" } }) }
      end,
    }
    t:equal(aib.method.kinds()[1], "mine")
    t:equal(aib.method.open(folder.path).batches[1].names, { "a" })
    t:equal(open("da3").kind, "da3")
  end,

  ["what is no method says so"] = function(t)
    local folder <close> = folder_of { ["readme.txt"] = "nothing" }
    local message = t:raises("nothing of a known method", aib.method.open, folder.path)
    t:contains(message, "vggt")
    t:raises("no such folder", aib.method.open, folder.path .. "/no")
    t:raises("did you mean 'vggt'", aib.method.open, here .. "vggt", { kind = "vgt" })
    t:raises("nothing of colmap", aib.method.open, here .. "vggt", { kind = "colmap" })
    t:raises("did you mean 'names'", aib.method.open, here .. "vggt", { name = {} })
  end,

  ["OpenMVS: names, poses and cameras stand in the headers of its depth maps"] = function(t)
    local identity = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }
    local header = ("<c2BBI4I4I4I4ff"):pack("DR", 1, 0, 4, 2, 2, 1, 0.5, 9) .. ("<s2I4I4"):pack("in/a.png", 1, 7)
    for _, x in ipairs { 3, 0, 2, 0, 3, 1, 0, 0, 1 } do header = header .. ("<d"):pack(x) end
    for _, x in ipairs(identity) do header = header .. ("<d"):pack(x) end
    for _, x in ipairs { 5, 6, 7 } do header = header .. ("<d"):pack(x) end
    local folder <close> = folder_of { ["depth0000.dmap"] = header .. ("<ff"):pack(1.5, 2.5) }
    local method = aib.method.open(folder.path)
    local batch = method.batches[1]
    t:equal({ method.kind, batch.names }, { "openmvs", { "a.png" } })
    t:equal(centre(batch, 1), { 5, 6, 7 })
    t:equal(batch.cameras["a.png"].fx, 3)
    t:equal(batch.depth(1):at(2, 1), 2.5)

    -- The later layout: halves times a power of two, and one more number in the header.
    local d2 = ("<c2BbI4I4I4I4fff"):pack("D2", 1, 1, 4, 2, 2, 1, 0.5, 9, 1) .. header:sub(29)
    local later <close> = folder_of { ["depth0000.dmap"] = d2 .. ("<I2I2"):pack(0x3A00, 0x3D00) }  -- 0.75, 1.25
    batch = aib.method.open(later.path).batches[1]
    t:equal({ batch.names, centre(batch, 1), batch.cameras["a.png"].fx }, { { "a.png" }, { 5, 6, 7 }, 3 })
    t:equal({ batch.depth(1):at(1, 1), batch.depth(1):at(2, 1) }, { 1.5, 2.5 })
  end,

  ["OpenDroneMap: depth maps that OpenMVS made of it are named"] = function(t)
    local folder <close> = folder_of {
      ["opensfm/reconstruction.json"] = [=[[{ "cameras": { "c": { "projection_type": "perspective", "width": 4,
        "height": 2, "focal": 0.8, "k1": 0, "k2": 0 } }, "shots": { "a.png": { "camera": "c", "rotation": [0, 0, 0],
        "translation": [-1, -2, -3] } }, "points": {} }]]=],
      ["opensfm/undistorted/openmvs/depth0000.dmap"] = "DR",
    }
    local method = aib.method.open(folder.path)
    local batch = method.batches[1]
    t:equal({ method.kind, batch.names, centre(batch, 1), batch.depth }, { "opensfm", { "a.png" }, { 1, 2, 3 }, nil })
    t:contains(batch.warnings[1], "opensfm/undistorted/openmvs: depth maps of OpenMVS")
  end,

  ["MegaSaM: cam_c2w, depths and intrinsic in one file"] = function(t)
    local pose = { 1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1 }
    local folder <close> = folder_of { ["scene.npz"] = npz {
      { "depths", "(1, 1, 2)", ("<ff"):pack(1.5, 2.5), "<f4" },
      { "cam_c2w", "(1, 4, 4)", ("<" .. ("d"):rep(16)):pack(table.unpack(pose)), "<f8" },
      { "intrinsic", "(3, 3)", ("<ddddddddd"):pack(3, 0, 1, 0, 3, 0.5, 0, 0, 1), "<f8" },
    } }
    local method = aib.method.open(folder.path, { names = { "a.png" } })
    local batch = method.batches[1]
    t:equal({ method.kind, centre(batch, 1), batch.depth(1):at(2, 1) }, { "megasam", { 5, 6, 7 }, 2.5 })
    t:equal({ batch.cameras["a.png"].fx, batch.cameras["a.png"].width }, { 3, 2 })
  end,

  ["a method with one frame of reference is cut into batches by the scene's images"] = function(t)
    local truth = aib.io.read_trajectory(data .. "gt/crane/poses")
    local batch = aib.method.open(data .. "methods/colmap/crane").batches[1]
    local parts = aib.batches.split(batch, truth.names, 20)
    local n = 0
    for _, part in ipairs(parts) do
      t:check(#part.names <= 20)
      n = n + #part.names
    end
    t:equal(n, #batch.names)
    local fit = aib.batches.align(parts, truth, { outlier_factor = 3 })
    t:equal(#fit.parts, #parts)
    local whole = aib.batches.align({ batch }, truth, { outlier_factor = 3 })
    t:check(aib.batches.ape(fit).all.rmse < aib.batches.ape(whole).all.rmse, "a fit of each part is never worse")
    t:equal(aib.batches.auc(whole).cross, nil)
    t:check(aib.batches.auc(fit).cross.auc > 0.9)
  end,

  ["a batch that does not tell its transform is named and left out"] = function(t)
    local poses, names = {}, {}
    for i = 1, 6 do poses[i], names[i] = aib.math.pose { centre = { i, i < 4 and 0 or i * i, 0 } }, "f" .. i end
    local truth = aib.pose.trajectory(poses, { names = names })
    local function part(name, first, last)
      local list = {}
      for i = first, last do list[#list + 1] = i end
      return { name = name, trajectory = truth:select(list), names = { table.unpack(names, first, last) } }
    end
    local fit = aib.batches.align({ part("straight", 1, 3), part("curved", 4, 6) }, truth)
    t:equal(fit.parts[1].alignment, nil)
    t:contains(fit.parts[1].degenerate, "line")
    t:equal(#fit.moved.est, 3)
    t:equal(aib.batches.ape(fit).all.count, 3)
    t:equal(aib.batches.auc(fit).intra.n_pairs, 6)
  end,
}
