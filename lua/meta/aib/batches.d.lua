---@meta aib.batches
error("Cannot require a meta file")

---Batches of a method, each in a frame and scale of its own, against the truth.
---@class aib.batches
local batches = {}

---A batch and how it lies in the world of the truth.
---@class aib.BatchPart
---@field name string
---@field batch aib.Batch
---@field est aib.Trajectory  # paired with ref
---@field ref aib.Trajectory
---@field first integer  # place of its frames among all
---@field last integer
---@field alignment aib.Alignment|nil
---@field degenerate string|nil  # why there is no alignment
---@field half_rmse number|nil  # of every other frame, fitted to the others
---@field seam number|nil  # jump of the position error from the batch before

---@class aib.BatchFit
---@field parts aib.BatchPart[]
---@field est aib.Trajectory  # all frames as they are
---@field ref aib.Trajectory
---@field batch integer[]  # the part of each frame
---@field moved { est: aib.Trajectory, ref: aib.Trajectory, batch: integer[], kept: integer[] }  # frames of aligned batches in the truth's frame; kept: no outliers

---Aligns every batch to the truth by a Sim(3) of its own after outliers are removed. A batch that does not tell its
---transform is named, not guessed.
---@param list aib.Batch[]
---@param truth aib.Trajectory
---@param options? { outlier_factor?: number, outlier_distance?: number, robust?: boolean, rotation_weight?: number, convention?: "relative"|"evo", seed?: integer, given?: boolean, names?: aib.NameRules }  # given: the poses are in the truth's frame already
---@return aib.BatchFit fit
function batches.align(list, truth, options) end

---AUC over the pairs within all batches, across the aligned ones, and over all pairs of the aligned ones.
---@param fit aib.BatchFit
---@param options? { convention?: string, max_deg?: integer }
---@return { intra: aib.PartialAuc|nil, cross: aib.PartialAuc|nil, all: aib.Auc|nil } auc
function batches.auc(fit, options) end

---Position errors of the frames of aligned batches, all and without outliers; nil where no batch is aligned.
---@param fit aib.BatchFit
---@return { all: aib.PoseErrors, kept: aib.PoseErrors|nil }|nil errors
function batches.ape(fit) end

---@class aib.BatchPointOptions
---@field min_confidence? number  # points are kept strictly above it; of a percentile from it on
---@field rule? "raw"|"sigmoid"|"percentile"  # instead of the method's
---@field stride? integer
---@field pixel_offset? number  # where in its pixel a depth lies, 0.5

---The points of a batch in its own frame.
---@param batch aib.Batch
---@param options? aib.BatchPointOptions
---@return aib.Cloud points
---@return { n_valid: integer, n_unsure: integer } counts
function batches.points(batch, options) end

---The points of all aligned batches in the frame of the truth.
---@param fit aib.BatchFit
---@param options? aib.BatchPointOptions
---@return aib.Cloud points
---@return { n_valid: integer, n_unsure: integer, n_batches: integer } counts
function batches.cloud(fit, options) end

---Cameras of all batches by image name.
---@param list aib.Batch[]
---@return table<string, aib.Camera>|nil cameras
function batches.cameras(list) end

---Cuts one batch into batches of consecutive images of the scene.
---@param batch aib.Batch
---@param names string[]  # of the scene, in order
---@param size integer
---@return aib.Batch[] parts
function batches.split(batch, names, size) end

return batches
