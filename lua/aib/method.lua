-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What a method left in a folder: told from the content, one batch for each frame of reference.
---
---   local method = aib.method.open "results/da3/office"
---   print(method.kind, method.why)          -- da3   exports/mini_npz/results.npz with depth
---   for _, batch in ipairs(method.batches) do
---     for i, name in ipairs(batch.names) do local depth = batch.depth(i) end
---   end
---
--- A method is an adapter (lua/aib/methods): { kind =, find = function(folder) -> why | nil, open = function(folder,
--- options) -> batch }. One of your own:
---
---   aib.method.add {
---     kind = "mine",
---     find = function(folder) return aib.system.is_file(folder .. "/mine.npz") and "mine.npz" end,
---     open = function(folder, options)
---       return { names = options.names, trajectory = aib.io.read_trajectory(folder .. "/mine.npz"), ... }
---     end,
---   }
local aib = require "aib"
local failure = require "aib.failure"
local kit = require "aib.methods.kit"
local suggest = require "aib.suggest"

local M = {}

local function adapter(name) return (require("aib.methods." .. name)) end

--- In the order in which they are asked: those with the surest signs first.
local adapters = {
  adapter "vggt", adapter "pi3", adapter "megasam", adapter "da3", adapter "da3_streaming", adapter "cut3r",
  adapter "dust3r", adapter "openmvs", adapter "opensfm", adapter "colmap", adapter "cloud",
}

local option_fields <const> = {
  kind = true, names = true, confidence = true, layout = true, batches = true, maps = true,
}
local confidence_rules <const> = { raw = true, sigmoid = true, percentile = true }

--- Adds an adapter; it is asked before the others.
function M.add(new)
  for _, field in ipairs { "find", "open" } do
    if type(new[field]) ~= "function" then
      error(("aib.method.add: %s: a function expected, found %s"):format(field, type(new[field])), 2)
    end
  end
  if type(new.kind) ~= "string" then error("aib.method.add: kind: a name expected", 2) end
  for i, known in ipairs(adapters) do
    if known.kind == new.kind then table.remove(adapters, i) break end
  end
  table.insert(adapters, 1, new)
end

--- Names of the methods that are known.
function M.kinds()
  local kinds = {}
  for i, known in ipairs(adapters) do kinds[i] = known.kind end
  return kinds
end

--- Batch folders, sorted by their numbers; the folder itself where there are none.
local function folders_of(folder, pattern)
  local folders = {}
  for _, name in ipairs(kit.numbered(folder, pattern)) do
    local path = folder .. "/" .. name
    if aib.system.is_folder(path) then folders[#folders + 1] = { path = path, name = name } end
  end
  if #folders == 0 then folders[1] = { path = folder, name = "0" } end
  return folders
end

local function named_adapter(kind)
  for _, known in ipairs(adapters) do
    if known.kind == kind then return known end
  end
  error(("aib.method.open: kind: unknown '%s'%s"):format(kind, suggest.hint(kind, M.kinds())), 4)
end

--- The adapter that knows the folder, and why.
local function find(folder)
  for _, known in ipairs(adapters) do
    local why = known.find(folder)
    if why then return known, why end
  end
  failure.raise("format", ("%s: nothing of a known method (%s); a layout describes any other"):format(folder,
    table.concat(M.kinds(), ", ")))
end

--- The adapter and why it was chosen; `kind` names it.
local function choose(folder, options)
  if options.layout then return adapter "layout", "a layout was given" end
  if not options.kind then return find(folder) end
  local known = named_adapter(options.kind)
  local why = known.find(folder)
  if not why then failure.raise("format", ("%s: nothing of %s"):format(folder, options.kind)) end
  return known, why
end

--- Names for a batch whose files tell none: the next of the list, after those that were used.
local function rename(batch, names, used)
  local n = #batch.names
  if used + n > #names then return end
  local own = table.move(names, used + 1, used + n, 1, {})
  if batch.trajectory then
    local poses = {}
    for i = 1, #batch.trajectory do poses[i] = batch.trajectory[i] end
    batch.trajectory = aib.pose.trajectory(poses, { names = own })
  end
  if batch.cameras then
    local cameras = {}
    for i, old in ipairs(batch.names) do cameras[own[i]] = batch.cameras[old] end
    batch.cameras = cameras
  end
  batch.names, batch.named = own, true
end

local function completed(batch, place, options)
  batch.name = place.name
  batch.warnings = batch.warnings or {}
  batch.rule = options.confidence or batch.rule or "raw"
  for _, warning in ipairs(batch.trajectory and batch.trajectory.warnings or {}) do
    batch.warnings[#batch.warnings + 1] = warning
  end
  if type(batch.points) == "function" then
    local read = batch.points
    batch.points = nil
    setmetatable(batch, { __index = function(self, key)
      if key ~= "points" then return nil end
      rawset(self, "points", read())
      return self.points
    end })
  end
  return batch
end

--- The names that are given for all batches together; those of names.txt beside the batch folders are these too.
local function list_of(folder, options, n_folders)
  if type(options.names) == "string" then return kit.read_names(options.names) end
  if options.names then return options.names end
  if n_folders > 1 and kit.exists(folder, "names.txt") then return kit.read_names(folder .. "/names.txt") end
end

--- Opens what a method left.
---
---   kind        name of the method, where the content is not to tell it
---   names       names of all frames in their order (a list or a text file), for files that have none
---   confidence  "raw" | "sigmoid" | "percentile" instead of the method's own rule
---   layout      table of patterns, see aib.methods.layout
---   batches     Lua pattern of batch folders with their number (default "^batch_(%d+)$")
---   maps        COLMAP: "geometric" | "photometric"
function M.open(folder, options)
  options = options or {}
  suggest.check_keys("aib.method.open", options, option_fields, 2)
  if options.confidence and not confidence_rules[options.confidence] then
    error(("aib.method.open: confidence: raw, sigmoid or percentile expected, found '%s'"):format(
      options.confidence), 2)
  end
  if not aib.system.is_folder(folder) then failure.raise("io", folder .. ": no such folder") end
  local folders = folders_of(folder, options.batches or "^batch_(%d+)$")
  local chosen, why = choose(folders[1].path, options)
  local names, used = list_of(folder, options, #folders), 0
  local method = { kind = chosen.kind, why = why, batches = {}, warnings = {} }
  for i, place in ipairs(folders) do
    if i > 1 and chosen.find and not chosen.find(place.path) then
      failure.raise("format", ("%s: %s expected as in %s"):format(place.path, chosen.kind, folders[1].path))
    end
    local own = { maps = options.maps, layout = options.layout }
    if names and #folders == 1 then own.names = names end
    local batch = chosen.open(place.path, own)
    if not batch.named and names then rename(batch, names, used) end
    used = used + #batch.names
    method.batches[i] = completed(batch, place, options)
  end
  if #folders > 1 then method.why = ("%s, in %d batch folders"):format(why, #folders) end
  return method
end

--- Whether the poses are the true ones, as they are where a method was given them: no error of them means anything.
--- They agree to a millionth of the size of the scene and a thousandth of a degree.
function M.poses_are_given(est, ref)
  local paired, truth = aib.pose.associate(est, ref, { by = "name" })
  if #paired == 0 then return false end
  local extent = truth:path_length()
  local ape = aib.pose.ape(paired, truth)
  local turn = aib.pose.ape(paired, truth, { relation = "angle_deg" })
  return ape.max <= 1e-6 * math.max(extent, 1e-9) and turn.max <= 1e-3
end

return M
