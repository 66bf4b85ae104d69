---@meta aib.align

---Transforms that lay an estimate upon a reference. Nothing is moved here: `transform * thing` does that.
---@class aib.align
local align = {}

---The similarity that minimises the square distances of paired points. Points on a line are refused.
---@param est aib.Trajectory|number[][]
---@param ref aib.Trajectory|number[][]  # as long
---@param options? { scale?: boolean, convention?: "relative"|"evo" }
---@return aib.Sim3 ref_from_est
function align.umeyama(est, ref, options) end

---What a fit may change and which frames it trusts.
---@class aib.AlignOptions
---@field mode? "sim3"|"se3"|"yaw"|"yaw_scale"|"scale"|"first"  # yaw: turns about the vertical alone; first: lays the first pose upon the first
---@field n? integer  # fit to the first n registered frames; all
---@field rotation_weight? number  # orientations count, a radian as this length: for straight flights
---@field up? number[]  # yaw, yaw_scale: the vertical of both worlds; {0, 0, 1}
---@field outlier_factor? number  # leaves out frames farther than this times the median distance from the median position
---@field outlier_distance? number  # the same, a distance
---@field robust? boolean  # finds the frames that agree, then fits to them
---@field robust_distance? number  # how near frames that agree are; told from the data
---@field robust_iterations? integer  # 1000
---@field seed? integer  # 1
---@field convention? "relative"|"evo"  # when positions are too close to a line
---@field stand_off? number  # distance at which turn_error is foretold; 10

---@class aib.Alignment
---@field transform aib.Sim3  # ref_from_est
---@field n_inliers integer
---@field outliers integer[]  # frames that were left out
---@field rmse number  # of the inliers' positions
---@field half_rmse number|nil  # of every other inlier, fitted to the others
---@field condition number  # first over second singular value of the positions
---@field turn_deg? number  # expected error of the turn that the positions tell worst: about their long axis; yaw: about the vertical; not with rotation_weight or a mode that turns nothing
---@field turn_error? number  # what that moves a point at stand_off
---@field warnings string[]

---Fits the frame of one trajectory to that of another. An undefined fit says what is free.
---@param est aib.Trajectory
---@param ref aib.Trajectory  # associated
---@param options? aib.AlignOptions
---@return aib.Alignment alignment
function align.trajectory(est, ref, options) end

---@class aib.BatchOptions : aib.AlignOptions
---@field size? integer  # frames of a batch; 200
---@field sizes? integer[]  # of each batch instead, one after another
---@field frames? integer[][]  # the frames of each batch instead, in any order; none in two
---@field names? string[][]  # the image names of each batch instead; those of no pose are missing

---@class aib.BatchAlignment : aib.Alignment
---@field frames integer[]
---@field missing string[]  # names of the batch that no pose has
---@field first integer|nil  # the first of the frames
---@field last integer|nil  # the last
---@field degenerate string|nil  # why there is no transform
---@field seam number|nil  # jump of the position error from the batch before

---Fits each batch on its own: frames one after another, or the lists that are given. A batch that does not tell its transform is named, not guessed.
---@param est aib.Trajectory
---@param ref aib.Trajectory  # associated
---@param options? aib.BatchOptions
---@return aib.BatchAlignment[] batches
---@return aib.Trajectory moved  # poses of degenerate batches and of frames in no batch are not registered
function align.batches(est, ref, options) end

---@class aib.IcpOptions
---@field max_distance number|number[]  # of a pair; a list is a schedule
---@field metric? "point"|"plane"
---@field with_scale? boolean
---@field init? aib.Sim3  # ref_from_est to begin with
---@field max_iterations? integer  # 100
---@field relative_change? number  # 1e-9

---Moves a cloud upon another from a rough alignment: iterative closest point.
---@param est aib.Cloud
---@param ref aib.Cloud
---@param options aib.IcpOptions
---@return { transform: aib.Sim3, rmse: number, fitness: number, converged: boolean, n_pairs: integer, n_iterations: integer } result
function align.icp(est, ref, options) end
