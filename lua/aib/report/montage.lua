-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Estimate, truth and relative error of depth maps as one picture, a row a frame.
---
---   aib.io.write_image("worst.png", aib.report.montage { { estimate = "est/7.exr", reference = "gt/7.exr" } })
local aib = require "aib"
local suggest = require "aib.suggest"

--- A depth map that is given, or that a file holds.
local function opened(source, options)
  if type(source) == "string" then return aib.io.read_depth(source, options) end
  return source
end

--- The error image of a frame; what it opened is closed. A truth from a file is read at the estimate's size.
local function picture_of(frame, options)
  local est = opened(frame.estimate, options.estimate)
  local ref = opened(frame.reference, { scale = (options.reference or {}).scale, width = est.width,
    height = est.height, rule = options.rule })
  local picture = aib.depth.error_image(est, ref, { transform = frame.transform })
  if est ~= frame.estimate then est:close() end
  if ref ~= frame.reference then ref:close() end
  return picture
end

return function(frames, options)
  options = options or {}
  suggest.check_keys("aib.report.montage", options, { columns = true, width = true, estimate = true, reference = true,
    rule = true }, 2)
  local pictures = {}
  for i, frame in ipairs(frames) do pictures[i] = picture_of(frame, options) end
  return aib.raster.contact_sheet(pictures, { columns = options.columns or 1, width = options.width or 960 })
end
