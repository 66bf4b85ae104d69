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

---What it is in a few numbers, of the valid depths.
---@return { width: integer, height: integer, n_valid: integer, mean: number|nil, std: number|nil, min: number|nil, max: number|nil } summary
function depth_map:summary() end

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
---@field imae number  # mean |1 / e - 1 / r|
---@field delta1 number  # share with max(e / r, r / e) < 1.25
---@field delta2 number  # ... < 1.25^2
---@field delta3 number  # ... < 1.25^3
---@field coverage number  # valid in both / valid in the reference
---@field scale number
---@field shift number
---@field n_valid integer
---@field n_reference integer
---@field n_estimate integer
---@field by_label table<integer, aib.DepthErrors>|nil  # where the options have labels; counts alone of a label without a valid pixel

---Errors of one depth map against its reference. Undefined where no pixel is valid in both. With `labels` the errors of
---the pixels of each label too, in `by_label`; a fit is over the whole frame.
---@param estimate aib.DepthMap
---@param reference aib.DepthMap
---@param options? aib.DepthErrorOptions|{ mask: aib.LabelImage, labels: aib.LabelImage }
---@return aib.DepthErrors errors
function depth.errors(estimate, reference, options) end

---The srmse of `errors` alone, in half the time.
---@param estimate aib.DepthMap
---@param reference aib.DepthMap
---@param options? aib.DepthErrorOptions|{ mask: aib.LabelImage }
---@return number srmse
function depth.srmse(estimate, reference, options) end

---Statistics of numbers that are not negative.
---@class aib.Spread
---@field mean number
---@field median number
---@field p95 number  # 95 % are below it
---@field rmse number
---@field max number

---Errors in the units of an inspection, over the pixels valid in both maps.
---@class aib.SurfaceErrors
---@field distance aib.Spread  # at the surface, in the unit of the maps
---@field gsd aib.Spread  # the same in ground sampling distances: depth / f of each pixel
---@field mean_gsd number  # the mean ground sampling distance, in the unit of the maps
---@field within table<number, number>  # share of these pixels strictly below each tau
---@field within_total table<number, number>  # share of the reference's pixels: a hole is a miss
---@field coverage number
---@field n_valid integer
---@field n_reference integer
---@field n_without_normal integer  # measured along the ray: edges and borders

---Distances between the estimated surface and the reference: in the unit of the maps, and in multiples of the ground
---sampling distance, the size of a photo's pixel on the object. The distance is that from the plane of the reference's
---surface ("normal"), so that a slanted view does not enlarge it, or along the line of sight ("ray").
---@param estimate aib.DepthMap
---@param reference aib.DepthMap
---@param camera aib.Camera  # of the photo: its own focal length counts, whatever the size of the maps
---@param options? { distance: "normal"|"ray", tau: number[], min: number, max: number, mask: aib.LabelImage, transform: aib.Affine, max_jump: number }  # tau {1, 2, 5}
---@return aib.SurfaceErrors errors
function depth.surface_errors(estimate, reference, camera, options) end

---Angles between the normals of both maps, over the pixels where both have one: the four neighbours are valid and no
---larger share than max_jump (0.05) apart.
---@param estimate aib.DepthMap
---@param reference aib.DepthMap
---@param camera aib.Camera
---@param options? { tau: number[], mask: aib.LabelImage, max_jump: number }  # tau in degrees, {11.25, 22.5, 30}
---@return { mean_deg: number, median_deg: number, rmse_deg: number, below: table<number, number>, n_valid: integer, n_reference: integer } errors
function depth.normal_errors(estimate, reference, camera, options) end

---How an estimate shows what is a plane in the reference.
---@class aib.PlaneErrors
---@field flatness number  # rms distance of its points from their own best plane
---@field orientation_deg number  # angle between the best planes of both maps
---@field offset number  # signed distance of its centroid from the reference's plane, away > 0
---@field reference_flatness number
---@field n_valid integer

---Planarity and orientation errors, one plane a label; 0 is no plane. A label without a plane's worth of valid pixels
---is left out.
---@param estimate aib.DepthMap
---@param reference aib.DepthMap
---@param camera aib.Camera
---@param planes aib.LabelImage
---@return table<integer, aib.PlaneErrors> errors
function depth.plane_errors(estimate, reference, camera, planes) end

---Mean error of the most confident pixels against their share.
---@class aib.RiskCurve
---@field coverage number[]  # share of the pixels kept, rising to 1
---@field risk number[]  # mean error of the most confident ones
---@field oracle number[]  # of the least wrong ones
---@field aurc number  # area under risk
---@field ause number  # area between the curves, in units of the overall mean error; 0 is perfect
---@field n_valid integer
---@field n_unsure integer  # without a finite confidence: kept last

---Whether a confidence map knows where its depth map is wrong. The order of the confidences alone counts.
---@param estimate aib.DepthMap
---@param reference aib.DepthMap
---@param confidence aib.DepthMap
---@param options? { error: "relative"|"difference"|"log_ratio", steps: integer, min: number, max: number, mask: aib.LabelImage, transform: aib.Affine }
---@return aib.RiskCurve curve
function depth.risk_coverage(estimate, reference, confidence, options) end

---Labels of what a reference shows, for `errors { labels = }`: 0 nothing, 1 inside of a surface, 2 at a depth edge,
---3 thin structure, with farther things or sky on both sides.
---@param reference aib.DepthMap
---@param options? { jump: number, edge_width: integer, thin_width: integer }  # share 0.1; 2 and 8 pixels
---@return aib.LabelImage labels
function depth.strata(reference, options) end

---Boundary F1 of Depth Pro, with its properties: one pixel off is a miss, and a perfect estimate of a single vertical
---step scores 0.25.
---@param estimate aib.DepthMap
---@param reference aib.DepthMap
---@param options? { t_min: number, t_max: number, n: integer }  # 1.05 to 1.25 in 10 thresholds
---@return number f1
function depth.boundary_f1(estimate, reference, options) end

---Depth edges as iBims-1 finds them: Canny (sigma root 2, 0.15, 0.3) of the map scaled to 0..1. 1 on an edge, else 0.
---@param depth aib.DepthMap
---@return aib.LabelImage edges
function depth.edges(depth) end

---Depth boundary errors (DBE) of iBims-1, pixels: how far estimated edges lie from true ones, of those nearer than 10
---pixels; how far both lie from each other, cut at 10. Both are 10 where no estimated edge is near a true one.
---@param estimate aib.DepthMap
---@param edges aib.LabelImage  # not 0 on a true edge: drawn, or aib.depth.edges of the reference
---@return { accuracy: number, completeness: number, n_estimate: integer, n_reference: integer } errors
function depth.boundary_errors(estimate, edges) end

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

---@class aib.DepthFrameFiles
---@field name string
---@field estimate string  # path
---@field reference string  # path
---@field mask? string  # path of a gray PNG, 0 leaves a pixel out
---@field labels? string  # path of a gray or indexed PNG

---How one of the two maps is read, see `aib.io.read_depth`.
---@class aib.DepthReading
---@field channel? string
---@field key? string
---@field scale? number
---@field max_depth? number

---Reads and scores frames, as many at a time as there are threads. Reference, mask and labels are brought to the size of
---the estimate by nearest neighbour. The result does not depend on the threads; the memory not on the number of frames.
---@param frames aib.DepthFrameFiles[]
---@param options? aib.DepthErrorOptions|{ align_over: "frame"|"sequence", estimate: aib.DepthReading, reference: aib.DepthReading, rule: "centre"|"floor" }
---@return aib.Accumulator accumulator
function depth.evaluate(frames, options) end

---Starts the errors of many frames.
---@param options? aib.DepthErrorOptions
---@return aib.Accumulator accumulator
function depth.accumulate(options) end

---Adds a frame. One without a valid pixel is kept and named, and spoils no mean.
---@param estimate aib.DepthMap
---@param reference aib.DepthMap
---@param options? { name: string, mask: aib.LabelImage, labels: aib.LabelImage }
---@return aib.Accumulator self
function accumulator:add(estimate, reference, options) end

---The labels that occur in any frame, sorted.
---@return integer[] labels
function accumulator:labels() end

---The same over the pixels of one label alone, without the frames that have none of them.
---@param label integer
---@return aib.Accumulator accumulator
function accumulator:of_label(label) end

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
