---@meta aib.depth

---Depth maps and their errors. The order is estimate, reference, options; maps have one size, see `downsample`.
---@class aib.Depth
local depth = {}

---Planar depth of a view, 0 or not finite where there is none.
---@class aib.DepthMap
---@field width integer
---@field height integer
---@field warnings string[]  # what the reader removed or doubts
local depth_map = {}

---Depth of a pixel; columns and rows count from 1.
---@param column integer
---@param row integer
---@return number depth
function depth_map:at(column, row) end

---The depth map with every depth times a factor.
---@param factor number
---@return aib.DepthMap scaled
function depth_map:scaled(factor) end

---A depth map from its rows: `aib.depth.map { { 1, 2 }, { 0, 4 } }`.
---@param rows number[][]
---@return aib.DepthMap map
function depth.map(rows) end

---A depth map at another size by nearest neighbour: no value is made up.
---@param map aib.DepthMap
---@param width integer
---@param height integer
---@param options? { rule: "centre"|"floor" }  # "floor" is OpenCV's index
---@return aib.DepthMap resampled
function depth.downsample(map, width, height, options) end

---Scale and shift that take estimates to references.
---@class aib.Affine
---@field scale number
---@field shift number

---@class aib.DepthErrorOptions
---@field preset? "paper"|"kitti"|"monodepth2"|"cut3r"|"pi3"  # options of a published script, which the others change
---@field crop? "none"|"garg"|"eigen"  # the part that is evaluated
---@field align? "none"|"median"|"median_lower"|"scale"|"scale_l1"|"scale_shift"|"log"  # fitted to each frame; none by default
---@field min? number  # a reference counts above it, exclusive
---@field max? number  # and below it, exclusive
---@field transform? aib.Affine  # of a batch or sequence, from `aib.depth.fit`; not together with `align`
---@field clamp_min? number  # smaller estimates become this
---@field clamp_max? number  # larger ones this
---@field clamp_log? number  # smaller estimates become this in logarithms alone

---Errors over the pixels valid in both maps; d = ln(reference / estimate), lengths in the unit of the maps.
---@class aib.DepthErrors
---@field srmse number  # mean (d - mean d)^2, the formula of the paper: no root
---@field si_log_rmse number  # its root
---@field silog number  # 100 times that root, KITTI's
---@field abs_rel number
---@field sq_rel number
---@field rmse number
---@field mae number
---@field rmse_log number
---@field log10 number
---@field irmse number  # rms of 1 / e - 1 / r
---@field delta1 number  # share with max(e / r, r / e) < 1.25
---@field delta2 number  # ... < 1.25^2
---@field delta3 number  # ... < 1.25^3
---@field coverage number  # valid in both / valid in the reference
---@field scale number
---@field shift number
---@field n_valid integer
---@field n_reference integer
---@field n_estimate integer

---Errors of one depth map against its reference. Undefined where no pixel is valid in both.
---@param estimate aib.DepthMap
---@param reference aib.DepthMap
---@param options? aib.DepthErrorOptions|{ mask: aib.LabelImage }
---@return aib.DepthErrors errors
function depth.errors(estimate, reference, options) end

---A picture of three panels: the estimate as aligned, the reference, and the signed relative error; blue is near or
---too near, yellow far, red too far, hatched grey without a value. Written by `aib.io.write_image`.
---@param estimate aib.DepthMap
---@param reference aib.DepthMap
---@param options? aib.DepthErrorOptions|{ mask: aib.LabelImage, near: number, far: number, largest: number }  # ends of the scales; by quantiles where absent
---@return aib.Image picture
function depth.error_image(estimate, reference, options) end

---Errors of many frames, mean of frames or pooled over pixels.
---@class aib.Accumulator
local accumulator = {}

---Starts the errors of many frames.
---@param options? aib.DepthErrorOptions
---@return aib.Accumulator accumulator
function depth.accumulate(options) end

---Adds a frame. One without a valid pixel is kept and named, and spoils no mean.
---@param estimate aib.DepthMap
---@param reference aib.DepthMap
---@param options? { name: string, mask: aib.LabelImage }
---@return aib.Accumulator self
function accumulator:add(estimate, reference, options) end

---Appends the frames of another accumulator.
---@param other aib.Accumulator
---@return aib.Accumulator self
function accumulator:merge(other) end

---Mean of the frames, or errors over all pixels. Has `n_frames`, `n_defined` and `undefined`, the names of frames
---without a valid pixel, too; the counts are totals.
---@param options? { pooled: boolean }
---@return aib.DepthErrors errors
function accumulator:result(options) end

---The errors of each frame with its `name`, in order; sorted by `field`, the worst first, where it is given.
---@param options? { field: string }
---@return aib.DepthErrors[] frames
function accumulator:frames(options) end

---The mean of a field over the frames and a bootstrap interval of it: blocks of neighbouring frames are drawn
---together, since they overlap.
---@param options? { field: string, block: integer, resamples: integer, level: number, seed: integer }
---@return { mean: number, low: number, high: number, deviation: number } interval
function accumulator:interval(options) end

---Fits scale (and shift) over a batch or a sequence.
---@class aib.Fitter
---@field n_valid integer
local fitter = {}

---Starts a fit over many frames.
---@param options? { align: string, min: number, max: number }  # align is "median" by default
---@return aib.Fitter fitter
function depth.fit(options) end

---Adds the valid pixels of a frame.
---@param estimate aib.DepthMap
---@param reference aib.DepthMap
---@param options? { mask: aib.LabelImage }
---@return aib.Fitter self
function fitter:add(estimate, reference, options) end

---Adds the frames of another fit.
---@param other aib.Fitter
---@return aib.Fitter self
function fitter:merge(other) end

---The scale and shift that fit all frames best.
---@return aib.Affine transform
function fitter:result() end

return depth
