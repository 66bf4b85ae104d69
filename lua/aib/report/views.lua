-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What a page draws beside the tables. Every function below is a method of the report, belongs to the report's group,
--- and does nothing unless a page was asked for (report:draws()). Data is packed at once, so that what was given can be
--- closed.
---
---   cell:curve { title = "Recall", x = { label = "tau", unit = "m", scale = "log" }, y = { label = "recall" },
---     at = taus, values = shares }
---   cell:timeline { title = "Depth error", y = { label = "sRMSE" }, frames = names, values = numbers }
---   cell:interval { title = "Change", label = "very low to high", value = 0.1, low = 0.05, high = 0.2 }
---   cell:frame { name = "000012", estimate = depth, reference = depth, transform = { scale = 1 } }
---   cell:cloud { role = "estimate", cloud = cloud, values = distances, label = "distance to the truth", unit = "m" }
---   cell:mesh { mesh = mesh, faces = { { label = "completeness", unit = "m", values = list } } }
---   cell:cameras { estimate = trajectory, reference = trajectory, missing = names }
---
--- Lines of one title, in groups that differ in the method alone, share a figure. A curve is drawn in steps where
--- `steps` is true, and with the same length of a unit on both axes where `equal` is.
local json = require "aib.json"
local packed = require("aib").packed
local suggest = require "aib.suggest"

local views = {}

local fields <const> = {
  curve = { title = "string", x = "table", y = "table", at = "table", values = "table", label = "string",
    text = "string", steps = "boolean", equal = "boolean" },
  timeline = { title = "string", y = "table", frames = "table", values = "table", label = "string", text = "string" },
  interval = { title = "string", unit = "string", label = "string", value = "number", low = "number", high = "number",
    text = "string" },
  frame = { name = "string", estimate = "userdata", reference = "userdata", transform = "table", errors = "table" },
  cloud = { role = "string", cloud = "userdata", values = "any", label = "string", unit = "string", limit = "number" },
  mesh = { mesh = "userdata", faces = "table" },
  cameras = { estimate = "userdata", reference = "userdata", missing = "table", errors = "table" },
}
local optional <const> = { label = true, text = true, steps = true, equal = true, unit = true, transform = true,
  values = true, limit = true, faces = true, missing = true, errors = true }
local needs_values <const> = { curve = true, timeline = true }

local function check(kind, spec, level)
  local what = "report:" .. kind
  if type(spec) ~= "table" then error(("%s: a table expected, found %s"):format(what, type(spec)), level + 1) end
  suggest.check_types(what, spec, fields[kind], level + 1)
  for _, field in ipairs(suggest.keys(fields[kind])) do
    local may_miss = optional[field] and not (field == "values" and needs_values[kind])
    if spec[field] == nil and not may_miss then
      error(("%s: %s: a %s expected, found nil"):format(what, field, fields[kind][field]), level + 1)
    end
  end
end

local function as_list(values) return json.list(table.move(values, 1, #values, 1, {})) end

--- What of a spec a page needs, by kind.
local pack = {}

function pack.curve(spec)
  return { title = spec.title, x = spec.x, y = spec.y, at = as_list(spec.at), values = as_list(spec.values),
    label = spec.label, text = spec.text, steps = spec.steps, equal = spec.equal }
end

function pack.timeline(spec)
  return { title = spec.title, y = spec.y, frames = as_list(spec.frames), values = as_list(spec.values),
    label = spec.label, text = spec.text }
end

function pack.interval(spec)
  return { title = spec.title, unit = spec.unit, label = spec.label, value = spec.value, low = spec.low,
    high = spec.high, text = spec.text }
end

function pack.frame(spec)
  local frame = packed.depth(spec.estimate, spec.reference, { transform = spec.transform })
  frame.name, frame.errors = spec.name, spec.errors
  return frame
end

function pack.cloud(spec)
  local points = packed.points(spec.cloud, { limit = spec.limit, values = spec.values })
  points.role, points.label, points.unit = spec.role, spec.label, spec.unit
  return points
end

local most_triangles <const> = 500000

--- A mesh that is too large for a page is named in it, and left out.
function pack.mesh(spec)
  if spec.mesh.n_triangles > most_triangles then return { n_triangles = spec.mesh.n_triangles, is_left_out = true } end
  local mesh = packed.mesh(spec.mesh)
  mesh.faces = json.list()
  for i, face in ipairs(spec.faces or {}) do
    mesh.faces[i] = { label = face.label, unit = face.unit, values = packed.values(face.values) }
  end
  return mesh
end

--- A millionth of the unit is enough for the eye.
local function rounded(x) return math.floor(1e6 * x + 0.5) / 1e6 end

--- Centre and rotation (world from camera, by rows) of each pose, in the order of the trajectory.
local function poses_of(trajectory)
  local list = json.list()
  for i = 1, #trajectory do
    local pose, numbers = trajectory[i], json.list()
    if pose.is_registered then
      for k = 1, 3 do numbers[k] = rounded(pose.centre[k]) end
      for r = 1, 3 do
        for c = 1, 3 do numbers[#numbers + 1] = rounded(pose.rotation[r][c]) end
      end
    end
    list[i] = { name = trajectory.names[i] or ("%06d"):format(i), pose = numbers }
  end
  return list
end

function pack.cameras(spec)
  return { estimate = poses_of(spec.estimate), reference = poses_of(spec.reference),
    missing = as_list(spec.missing or {}), errors = spec.errors }
end

local function adder(kind)
  return function(self, spec)
    check(kind, spec, 2)
    local list = self.store.views
    if not list then return end
    local view = pack[kind](spec)
    view.kind, view.group = kind, self.group
    list[#list + 1] = view
  end
end

for kind in pairs(fields) do views[kind] = adder(kind) end

--- Whether a page was asked for: what is dear to compute for a view alone is computed then.
function views:draws() return self.store.views ~= nil end

--- Asks for views. Without the library that packs data there are none.
function views:draw()
  if packed.points then self.store.views = {} end
end

return views
