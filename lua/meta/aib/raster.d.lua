---@meta aib.raster

---Images: pictures, and label images, which are masks too (0 is outside). Columns and rows count from 1.
---@class aib.Raster
local raster = {}

---A picture of 8-bit red, green and blue.
---@class aib.Image
---@field width integer
---@field height integer
local image = {}

---What it is in a few numbers: size and mean colour.
---@return { width: integer, height: integer, mean: number[]|nil } summary
function image:summary() end

---Red, green and blue of a pixel.
---@param column integer
---@param row integer
---@return integer[] rgb  # 0..255 each
function image:at(column, row) end

---A whole number a pixel, 0..65535.
---@class aib.LabelImage
---@field width integer
---@field height integer
local label_image = {}

---What it is in a few numbers: size and pixels by label.
---@return { width: integer, height: integer, counts: table<integer, integer> } summary
function label_image:summary() end

---The label of a pixel.
---@param column integer
---@param row integer
---@return integer label
function label_image:at(column, row) end

---1 where the image has a label, else 0.
---@param label integer
---@return aib.LabelImage mask
function label_image:mask(label) end

---A label image from its rows: `aib.raster.labels { { 0, 1 }, { 2, 2 } }`.
---@param rows integer[][]
---@return aib.LabelImage labels
function raster.labels(rows) end

---Pictures in rows, each shrunk to `width` pixels in the shape of the first.
---@param pictures aib.Image[]
---@param options? { columns: integer, width: integer }  # 3 and 480
---@return aib.Image sheet
function raster.contact_sheet(pictures, options) end

return raster
