-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Where every protocol of depth maps begins: pairs the files of two folders, scores them, says what was found.
---
---   local frames = depth_frames.pair(input)
---   local errors = depth_frames.evaluate(frames, { align = "median" })
---   depth_frames.report(errors:result(), report, { metrics = { "abs_rel" }, convention = "mean over frames" })
local aib = require "aib"
local csv_line = require "aib.report.csv_line"
local drawings = require "aib.evaluation.drawings"
local failure = require "aib.failure"
local suggest = require "aib.suggest"

local M = {}

local extensions <const> = { exr = true, pfm = true, npy = true, npz = true, png = true, dmap = true, bin = true }

local better_higher <const> = { delta1 = true, delta2 = true, delta3 = true, coverage = true }
local unit_of <const> = { rmse = "m", mae = "m", sq_rel = "m", irmse = "1/m", imae = "1/m", shift = "m" }

--- Every number of a frame, in the order of tables.
M.fields = { "srmse", "si_log_rmse", "silog", "abs_rel", "sq_rel", "rmse", "mae", "rmse_log", "log10", "irmse", "imae",
  "delta1", "delta2", "delta3", "coverage", "scale", "shift" }

--- The inputs of pairing and of what is written beside the report, and those of the protocol.
function M.inputs(own)
  return suggest.with({
    estimate = { kind = "folder", position = 1, help = "folder of estimated depth maps" },
    reference = { kind = "folder", position = 2, help = "folder of true depth maps" },
    estimate_pattern = { kind = "path", default = "*",
      help = 'names of the estimates, * is what pairs them: "*_pred.npy"; "*" is any depth file, paired by its stem' },
    reference_pattern = { kind = "path", default = "*", help = "the same of the references" },
    estimate_scale = { kind = "number", default = 0, min = 0, help = "stored value of a metre; 0: the format's own" },
    reference_scale = { kind = "number", default = 0, min = 0, help = "the same of the references" },
    masks = { kind = "path", default = "", help = "folder of gray PNGs of the same names; 0 leaves a pixel out" },
    rule = { kind = "choice", choices = { "centre", "floor" }, default = "centre",
      help = "pixel of a reference that stands for one of a smaller estimate" },
    per_frame = { kind = "output", default = "",
      help = "CSV file to write: the errors of each frame, the worst first" },
    sheet = { kind = "output", ending = ".png", default = "",
      help = "PNG file to write: estimate, truth, error of the worst frames" },
    worst = { kind = "integer", default = 6, min = 1, help = "frames on it" },
    worst_by = { kind = "choice", choices = M.fields, default = "srmse", help = "error that says which are the worst" },
  }, own)
end

--- What * stands for where a file name fits the pattern; nil where it does not.
local function name_in(pattern, file)
  if pattern == "*" then
    local stem, extension = file:match("^(.+)%.(%w+)$")
    return extensions[extension] and stem
  end
  local before, after = pattern:match("^([^*]*)%*([^*]*)$")
  if not before then failure.usage(("pattern '%s': one * expected"):format(pattern)) end
  local fits = #file > #before + #after and file:sub(1, #before) == before and file:sub(-#after - 1, -1):sub(2) == after
  return fits and file:sub(#before + 1, #file - #after) or nil
end

--- Paths of the files that fit, by the name of their frame, and the names in the order of the files. Raises an io error
--- where there is none.
function M.files_in(folder, pattern)
  local paths, names = {}, {}
  for _, file in ipairs(aib.system.names_in(folder)) do
    local name = name_in(pattern, file)
    if name and aib.system.is_file(folder .. "/" .. file) then
      if not paths[name] then names[#names + 1] = name end
      paths[name] = folder .. "/" .. file
    end
  end
  if #names == 0 then
    local wanted = pattern == "*" and table.concat(suggest.keys(extensions), ", ") or pattern
    failure.raise("io", ("%s: no depth map (%s)"):format(folder, wanted))
  end
  return paths, names
end

--- The frame of an image: its name without folder and extension.
function M.stem(image) return (image:match("[^/]*$"):gsub("%.[^.]*$", "")) end

--- Path of the mask or label image of a frame; nil without a folder of them.
local function image_of(folder, name)
  if not folder or folder == "" then return nil end
  local path = ("%s/%s.png"):format(folder, name)
  if not aib.system.is_file(path) then failure.raise("io", path .. ": no such file") end
  return path
end

--- The frames of which both maps are there: a list of { name =, estimate =, reference =, mask =, labels = } with the
--- paths, and `missing`, the names of the references without an estimate. Raises an io error where there is none.
--- `folders` = { estimate =, reference =, estimate_pattern =, reference_pattern =, masks =, labels = }.
function M.pair(folders)
  local estimates, estimate_names = M.files_in(folders.estimate, folders.estimate_pattern or "*")
  local references, names = M.files_in(folders.reference, folders.reference_pattern or "*")
  local frames = { missing = {} }
  for _, name in ipairs(names) do
    if estimates[name] then
      frames[#frames + 1] = { name = name, estimate = estimates[name], reference = references[name],
        mask = image_of(folders.masks, name), labels = image_of(folders.labels, name) }
    else
      table.insert(frames.missing, name)
    end
  end
  if #frames == 0 then
    failure.raise("io", ("%s and %s: no depth maps of one name; %d estimates (%s ...), %d references (%s ...)"):format(
      folders.estimate, folders.reference, #estimate_names, estimate_names[1] or "", #names, names[1] or ""))
  end
  return frames
end

--- How the maps of a protocol's inputs are read: options of aib.depth.evaluate, which `own` completes.
function M.reading(input, own)
  return suggest.with({ rule = input.rule, estimate = { scale = input.estimate_scale },
    reference = { scale = input.reference_scale } }, own)
end

local batch_size <const> = 32

--- aib.depth.evaluate with progress. Frames are scored in batches, which merge to the bits of one run, unless one fit
--- is over all of them.
function M.evaluate(frames, options)
  local one_fit = options.align_over == "sequence" or options.preset == "cut3r"
  if one_fit then return aib.depth.evaluate(frames, options) end
  local progress <close> = aib.progress(#frames, "frames")
  local errors
  for first = 1, #frames, batch_size do
    local last = math.min(first + batch_size - 1, #frames)
    for i = first, last do progress:step(frames[i].name) end
    local part = aib.depth.evaluate(table.move(frames, first, last, 1, {}), options)
    errors = errors and errors:merge(part) or part
  end
  return errors
end

--- Adds errors to a report.
--- `how` = { metrics = names, n =, convention =, options =, factors = { name = { 100, "%" } } }.
function M.report(errors, report, how)
  for _, name in ipairs(how.metrics) do
    local factor, unit = 1, unit_of[name]
    if how.factors and how.factors[name] then factor, unit = table.unpack(how.factors[name]) end
    report:add("depth." .. name, errors and errors[name] and factor * errors[name], {
      unit = unit, better = better_higher[name] and "higher" or "lower", n = how.n, convention = how.convention,
      options = how.options,
    })
  end
end

--- Says which frames were left out, and counts them.
function M.report_frames(frames, summary, report)
  local expected = #frames + #frames.missing
  local function say(what, list)
    report:add("depth.frames_" .. what, #list, { better = "lower", n = expected })
    if #list == 0 then return end
    local shown = table.concat(list, ", ", 1, math.min(5, #list))
    local more = #list > 5 and " ..." or ""
    report:note("frames", ("%d of %d %s: %s"):format(#list, expected, (what:gsub("_", " ")), shown .. more))
  end
  say("missing", frames.missing)
  say("without_a_valid_pixel", summary and summary.undefined or {})
end

--- Writes the errors of each frame (aib.Accumulator:frames) as CSV.
function M.write_csv(path, frames)
  local columns = table.move(M.fields, 1, #M.fields, 2, { "name" })
  table.move({ "n_valid", "n_reference", "n_estimate" }, 1, 3, #columns + 1, columns)
  local lines = { csv_line(columns) }
  for _, frame in ipairs(frames) do
    local values = {}
    for i, column in ipairs(columns) do values[i] = frame[column] or "" end
    lines[#lines + 1] = csv_line(values)
  end
  aib.system.write_text(path, table.concat(lines))
end

--- Writes the error images of frames one below the other. `records` are the errors of as many of `files` as are shown.
function M.write_sheet(path, records, files, options)
  local by_name, frames = {}, {}
  for _, frame in ipairs(files) do by_name[frame.name] = frame end
  for i, record in ipairs(records) do
    local frame = by_name[record.name]
    frames[i] = { estimate = frame.estimate, reference = frame.reference,
      transform = { scale = record.scale, shift = record.shift } }
  end
  aib.io.write_image(path, aib.report.montage(frames,
    { estimate = options.estimate, reference = options.reference, rule = options.rule }))
end

--- Shows errors along the frames, and some frames, in the page of a report that has one.
function M.draw(errors, frames, options, report)
  if not report:draws() then return end
  local records, by_name, names = errors:frames(), {}, {}
  drawings.depth_series(report, records)
  for i, frame in ipairs(frames) do by_name[frame.name], names[i] = frame, frame.name end
  local chosen = drawings.chosen(names)
  for _, record in ipairs(records) do
    local frame = chosen[record.name] and record.srmse and by_name[record.name]
    if frame then
      local est <close> = aib.io.read_depth(frame.estimate, options.estimate)
      local ref <close> = aib.io.read_depth(frame.reference, { scale = options.reference.scale, width = est.width,
        height = est.height, rule = options.rule })
      drawings.frame(report, chosen, record.name, est, ref, { scale = record.scale, shift = record.shift })
    end
  end
end

--- Writes what the inputs ask for beside the report. `errors` is an aib.Accumulator over `frames`.
function M.write(errors, frames, options, input)
  local worst = errors:frames { field = input.worst_by }
  if input.per_frame ~= "" then M.write_csv(input.per_frame, worst) end
  if input.sheet == "" then return end
  local shown = {}
  for _, frame in ipairs(worst) do
    if frame.srmse and #shown < input.worst then shown[#shown + 1] = frame end
  end
  if #shown > 0 then M.write_sheet(input.sheet, shown, frames, options) end
end

return M
