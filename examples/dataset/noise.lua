-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Sensor noise on rendered pictures:
---
---   aib-lua examples/dataset/noise.lua FROM TO [SEED]
---
--- Every PNG of FROM that is not yet in TO. A frame's noise depends on SEED (default 1) and on the frame's number, not
--- on which others are made.
local aib = require "aib"

local from, to, seed = arg[1], arg[2], math.tointeger(tonumber(arg[3] or 1))
if not to or not seed then
  io.stderr:write "usage: noise.lua FROM TO [SEED]\n"
  os.exit(2)
end

aib.system.make_folder(to)
local n_made, n_kept = 0, 0
for _, name in ipairs(aib.system.names_in(from)) do
  local number = name:match "^(%d+)%.png$"
  if number and aib.system.is_file(to .. "/" .. name) then
    n_kept = n_kept + 1
  elseif number then
    local partial = ("%s/.%s.partial.png"):format(to, number)
    local frame = math.tointeger(tonumber(number))
    aib.survey.sensor_noise_file(from .. "/" .. name, partial, { seed = seed, frame = frame })
    assert(os.rename(partial, to .. "/" .. name))
    n_made = n_made + 1
  end
end
print(("%s: noise on %d pictures, %d were there"):format(to, n_made, n_kept))
