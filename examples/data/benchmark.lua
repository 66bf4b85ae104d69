-- Two rendered structures and what real programs made of their pictures; see README.md. Every path is relative to this
-- folder; what a result does not name, the method does not have.

--- The part of a scene that is scored: the ground goes on to 16 m, which no camera sees.
local crop = { min = { -10, -10, -1 }, max = { 10, 10, 6 } }

local function truth(folder)
  return {
    poses = "gt/" .. folder .. "/poses", depth = "gt/" .. folder .. "/depth/{stem}.exr",
    mesh = "gt/" .. folder .. "/mesh.ply", crop = crop,
  }
end

local crane, office = truth("crane"), truth("office")
crane.name = "crane"
office.name, office.conditions = "office", { "very low", "high" }

--- Results of a method in its folders of every scene and condition; `fields(folder)` says what it left there.
local function everywhere(fields)
  local results = { fields("crane"), fields("office_vlow"), fields("office_high") }
  results[1].scene = "crane"
  results[2].scene, results[2].condition = "office", "very low"
  results[3].scene, results[3].condition = "office", "high"
  return results
end

local colmap = everywhere(function(folder)
  local dense = "methods/sgbm_colmap/" .. folder
  return {
    models = "methods/colmap/" .. folder .. "/sparse", depth = dense .. "/depth/{stem}.exr",
    cloud = dense .. "/fused.ply",
  }
end)
colmap[2].depth, colmap[2].cloud = nil, nil  -- the dense step was not run on the nearly clean office

return {
  name = "crane and office",
  licence = "CC0-1.0",
  scenes = { crane, office },
  methods = {
    { name = "COLMAP + SGBM", parameters = "estimated", results = colmap },
    { name = "GLOMAP", parameters = "estimated", results = everywhere(function(folder)
      return { models = "methods/glomap/" .. folder .. "/sparse" }
    end) },
    { name = "SGBM, true poses", parameters = "ground truth", results = everywhere(function(folder)
      local dense = "methods/sgbm_gtposes/" .. folder
      return { depth = dense .. "/depth/{stem}.exr", cloud = dense .. "/fused.ply" }
    end) },
  },
}
