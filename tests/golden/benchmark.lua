-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

-- The full scenes of the shared folder, with everything for which it holds expected numbers. The test lays this file
-- beside links to its gt and methods, and beside transforms.json of the scenes with the names of the images alone.

local function truth(folder)
  return {
    poses = folder .. "_transforms.json", depth = "gt/" .. folder .. "/depth/{stem}.exr",
    points = "gt/" .. folder .. "/gt_points.ply",
  }
end

local crane, office = truth("crane"), truth("office")
crane.name, office.name, office.conditions = "crane", "office", { "high" }

--- A result in each folder: `crane` first, then `office_high`.
local function both(fields)
  local results = { fields("crane"), fields("office_high") }
  results[1].scene = "crane"
  results[2].scene, results[2].condition = "office", "high"
  return results
end

local function models_of(method)
  return function(folder) return { models = "methods/" .. method .. "/" .. folder .. "/sparse" } end
end

--- The sparse points of a sub-model of the crane, in the frame of that sub-model.
local function points_of(method, model)
  return {
    name = method .. " points " .. model, parameters = "estimated",
    results = {
      { scene = "crane", models = "methods/" .. method .. "/crane/sparse", cloud = "model", model = model },
    },
  }
end

local function estimated(name, results) return { name = name, parameters = "estimated", results = results } end

return {
  name = "shared scenes",
  scenes = { crane, office },
  methods = {
    estimated("colmap", both(function(folder)
      local dense = "methods/sgbm_colmap/" .. folder
      return {
        models = "methods/colmap/" .. folder .. "/sparse", depth = dense .. "/depth/{stem}.exr",
        cloud = dense .. "/fused.ply",
      }
    end)),
    estimated("colmap_wrongfocal", { { scene = "crane", models = "methods/colmap_wrongfocal/crane/sparse" } }),
    estimated("glomap", both(models_of("glomap"))),
    estimated("glomap_vgc", { { scene = "crane", models = "methods/glomap_vgc/crane/sparse" } }),
    estimated("colmap42", both(models_of("colmap42"))),
    {
      name = "sgbm_gtposes", parameters = "ground truth",
      results = both(function(folder)
        local dense = "methods/sgbm_gtposes/" .. folder
        return { depth = dense .. "/depth/{stem}.exr", cloud = dense .. "/fused.ply" }
      end),
    },
    points_of("colmap", "0"), points_of("colmap", "1"), points_of("glomap", "0"), points_of("colmap42", "1"),
  },
}
