-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The multi-view evaluation of ETH3D: completeness and accuracy per tolerance, averaged over voxels; accuracy only
--- where the scanner's beams observed something.
---
---   aib-lua eth3d reconstruction.ply scan_alignment.mlp --tolerances 0.01,0.02,0.05
local aib = require "aib"
local clouds = require "aib.evaluation.clouds"
local drawings = require "aib.evaluation.drawings"
local failure = require "aib.failure"

--- The matrix of a mesh in a MeshLab project: rows of four numbers.
local function rows_of(text, path)
  local numbers = {}
  for number in text:gmatch("%S+") do numbers[#numbers + 1] = tonumber(number) end
  if #numbers ~= 16 then
    failure.raise("format", ("%s: MLMatrix44: 16 numbers expected, found %d"):format(path, #numbers))
  end
  local rows = {}
  for r = 0, 2 do rows[r + 1] = { table.unpack(numbers, 4 * r + 1, 4 * r + 4) } end
  return rows
end

--- The scans of a MeshLab project in the world, each with the place of its scanner.
local function read_project(path)
  local folder, scans = path:match("^(.*/)[^/]*$") or "", {}
  for mesh, matrix in aib.system.read_text(path):gmatch("<MLMesh(.-)>%s*<MLMatrix44>(.-)</MLMatrix44>") do
    local file = mesh:match('filename="([^"]*)"')
    if not file then failure.raise("format", path .. ": MLMesh: a filename expected") end
    local rows = rows_of(matrix, path)
    local world_from_scan = aib.math.sim3 {
      rotation = { { rows[1][1], rows[1][2], rows[1][3] }, { rows[2][1], rows[2][2], rows[2][3] },
        { rows[3][1], rows[3][2], rows[3][3] } },
      translation = { rows[1][4], rows[2][4], rows[3][4] },
    }
    scans[#scans + 1] = {
      points = world_from_scan * clouds.read(file:sub(1, 1) == "/" and file or folder .. file),
      scanner = { rows[1][4], rows[2][4], rows[3][4] },
    }
  end
  if #scans == 0 then failure.raise("format", path .. ": an MLMesh with an MLMatrix44 expected, found none") end
  return scans
end

local function read_scans(input)
  if input.reference:lower():find("%.mlp$") then return read_project(input.reference) end
  if #input.scanner ~= 3 then failure.usage("--scanner: X,Y,Z expected, found " .. table.concat(input.scanner, ",")) end
  return { { points = clouds.read(input.reference), scanner = input.scanner } }
end

--- The scores against the tolerance, and the clouds in the colours of their distances, observed or not.
local function draw(report, estimate, scans, scores, tolerances)
  if not report:draws() then return end
  local curves = {}
  for _, part in ipairs { { "Accuracy", "accuracy" }, { "Completeness", "completeness" }, { "F-score", "f_score" } } do
    local values = {}
    for i, tolerance in ipairs(tolerances) do values[i] = scores[part[2]][tolerance] or 0 / 0 end
    curves[#curves + 1] = { part[1], values }
  end
  drawings.against_threshold(report, tolerances, curves)
  local parts = {}
  for i, scan in ipairs(scans) do parts[i] = scan.points end
  local reference = aib.cloud.joined(parts)
  local to_reference, to_estimate = aib.cloud.distances_both_ways(estimate, reference)
  drawings.errors_of_points(report, estimate, reference, to_reference, to_estimate, tolerances[#tolerances])
end

return aib.protocol {
  name = "eth3d",
  title = "ETH3D multi-view evaluation",
  cite = "Schöps et al., A multi-view stereo benchmark, CVPR 2017",
  inputs = {
    estimate = { kind = "file", position = 1, help = "reconstructed cloud" },
    reference = { kind = "file", position = 2, help = "MeshLab project (.mlp) of the scans, or one scan" },
    tolerances = { kind = "list", of = "number", unit = "m", above = 0, default = { 0.01, 0.02, 0.05, 0.1, 0.2, 0.5 },
      help = "evaluated at each" },
    voxel = { kind = "number", unit = "m", default = 0.01, above = 0, help = "edge of the voxels that are averaged" },
    scanner = { kind = "list", of = "number", unit = "m", default = { 0, 0, 0 }, help = "its place, for one scan" },
    beam_radius = { kind = "number", unit = "m", default = 0.001125, help = "of the laser beam at the scanner" },
    beam_half_angle = { kind = "number", unit = "deg", default = 0.011, help = "of the beam's cone" },
    rule = { kind = "choice", choices = { "official", "within", "below" }, default = "official",
      help = "a scan point at exactly a tolerance is complete: but not at the largest, always, never" },
  },
  run = function(input, report)
    local estimate, scans = clouds.read(input.estimate), read_scans(input)
    local s = aib.cloud.eth3d(estimate, scans, {
      tolerances = input.tolerances, voxel = input.voxel, beam_radius = input.beam_radius,
      beam_half_angle_deg = input.beam_half_angle, rule = input.rule,
    })
    local options = { voxel = input.voxel, rule = input.rule }
    for _, tolerance in ipairs(input.tolerances) do
      for _, name in ipairs { "completeness", "accuracy", "f_score" } do
        report:add(("eth3d.%s@%gm"):format(name, tolerance), s[name][tolerance], {
          better = "higher", n = name == "completeness" and s.n_reference or s.n_estimate,
          convention = input.rule, options = options,
        })
      end
      if not s.accuracy[tolerance] then report:note("accuracy", ("nothing observed at %g m"):format(tolerance)) end
    end
    draw(report, estimate, scans, s, input.tolerances)
  end,
}
