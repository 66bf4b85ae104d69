-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- The bundled benchmark: its numbers are those that numpy and scipy gave, whatever the threads and the folder.
local aib = require "aib"
local support = require "support"

local root <const> = support.root
local data <const> = root .. "/examples/data"
local script <const> = root .. "/examples/protocols/asset_inspection.lua"

--- Records of the default run, by group name and metric.
local function records()
  local report, groups = support.protocol("asset_inspection"):run { benchmark = data }, {}
  for _, r in ipairs(report:records()) do
    local group = report:within(r.group):group_name()
    groups[group] = groups[group] or {}
    groups[group][r.name] = r
  end
  return groups
end

--- The result files of a run in a process of its own, by format.
local function results(t, benchmark, ...)
  local scratch <close> = support.scratch_folder()
  local words = { ... }
  table.move({ script, benchmark, "--quiet" }, 1, 3, #words + 1, words)
  local formats <const> = { "json", "csv", "markdown", "latex", "html" }
  for _, format in ipairs(formats) do
    table.move({ "--" .. format, scratch.path .. "/" .. format }, 1, 2, #words + 1, words)
  end
  local _, complaints, code = support.aib_lua(table.unpack(words))
  t:equal(complaints, "")
  t:equal(code, 0)
  local texts = {}
  for _, format in ipairs(formats) do texts[format] = aib.system.read_text(scratch.path .. "/" .. format) end
  return texts
end

return aib.test {
  ["details: strata share the pixels, ground sampling distances are nested, labels are named"] = function(t)
    local report, found = support.protocol("asset_inspection"):run { benchmark = data, details = true }, {}
    for _, r in ipairs(report:records()) do
      if r.group.scene == "crane" and r.group.method == "SGBM, true poses" then
        found[r.name .. "/" .. (r.group.stratum or r.group.label or "")] = r
      end
    end
    local function value(name) return found[name].value end
    t:check(value "depth.srmse/edge" > value "depth.srmse/inside", "depth is worse at edges")
    t:equal(found["depth.srmse/inside"].n, 14)
    local within = { value "depth.within_1gsd/", value "depth.within_2gsd/", value "depth.within_5gsd/" }
    t:check(0 < within[1] and within[1] < within[2] and within[2] < within[3])
    t:check(within[3] <= value "depth.coverage/")
    t:check(value "cloud.completeness/tower" < value "cloud.completeness/")
    t:check(value "cloud.accuracy_exact/" < value "cloud.accuracy/", "samples add to the distance")
  end,

  ["poses, focal lengths, alignments and depth are what others computed"] = function(t)
    local path = root .. "/tests/golden/bundled.json"
    local found = records()
    for group, numbers in pairs(aib.json.decode(aib.system.read_text(path), path).numbers) do
      for name, value in pairs(numbers) do
        local place = group .. ": " .. name
        local record = found[group] and found[group][name == "depth.n_frames" and "depth.srmse" or name]
        t:check(record, place .. " is missing")
        -- The true poses are quaternions here, matrices of floats where the numbers come from.
        local relative = name:find("^align") and 2e-6 or 1e-9
        t:near(name == "depth.n_frames" and record.n or record.value, value, relative * math.abs(value), place)
      end
    end
  end,

  ["what a method does not have is no number"] = function(t)
    local found = records()
    t:equal(found["office / very low / COLMAP + SGBM"]["depth.srmse"], nil)
    t:equal(found["crane / GLOMAP"]["cloud.chamfer"], nil)
    t:equal(found["crane / SGBM, true poses"]["pose.auc30"].value, nil)
    t:equal(found["crane / SGBM, true poses"]["pose.auc30"].note, "the poses are given")
    t:equal(found["crane / SGBM, true poses"]["pose.registration_rate"], nil)
  end,

  ["the results are the same bytes for any number of threads and in any folder"] = function(t)
    local moved <close> = support.scratch_folder()
    support.copy_folder(data, moved.path .. "/elsewhere")
    local here = results(t, data, "--threads", "1")
    local there = results(t, moved.path .. "/elsewhere", "--threads", "3")
    t:equal(here, there)
    t:check(not here.json:find(root, 1, true), "no path is in the results")
  end,

  ["numbers say what they depend on"] = function(t)
    local json = aib.json.decode(results(t, data, "--threads", "1").json)
    t:equal(json.aib, { format = 1, version = aib.version })
    t:equal(json.inputs.rule, "centre")
    t:equal(json.inputs.outlier_factor, 3)
    t:equal(#json.sources["gt/crane/mesh.ply"].sha256, 64)
    t:equal(json.sources["gt/crane/depth/{stem}.exr"].files, 14)
    for _, record in ipairs(json.records) do
      if record.name == "depth.srmse" and record.value ~= aib.json.null then
        t:equal(record.convention, "mean over frames")
        t:equal(record.options.rule, "centre")
        t:check(record.n > 0)
      end
    end
  end,
}
