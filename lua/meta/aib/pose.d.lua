---@meta aib.pose

---Errors of camera poses and intrinsics. The order is estimate, reference, options; trajectories are associated first.
---Nothing here aligns. Shares are 0..1, angles degrees.
---@class aib.pose
local pose = {}

---Camera poses; `t[i]` is a pose, `#t` their number, `transform * t` the moved trajectory.
---@class aib.Trajectory
---@field names string[]  # empty, or one a pose
---@field stamps number[]  # seconds; empty, or one a pose
---@field warnings string[]  # what the reader repaired or doubts
local trajectory = {}

---Camera centres.
---@return number[][] positions
function trajectory:positions() end

---Length of the path from the first pose to the last.
---@return number length
function trajectory:path_length() end

---What it is in a few numbers; the box is that of the registered centres.
---@return { n: integer, n_registered: integer, path_length: number, min: number[]|nil, max: number[]|nil, first_stamp: number|nil, last_stamp: number|nil } summary
function trajectory:summary() end

---Some of the poses.
---@param indices integer[]
---@return aib.Trajectory selected
function trajectory:select(indices) end

---The trajectory in another frame, as `transform * trajectory`.
---@param transform aib.Sim3
---@return aib.Trajectory moved
function trajectory:transformed(transform) end

---A trajectory of poses.
---@param poses aib.Pose[]
---@param options? { names?: string[], stamps?: number[] }
---@return aib.Trajectory trajectory
function pose.trajectory(poses, options) end

---@class aib.NameRules
---@field ignore_case? boolean
---@field ignore_extension? boolean
---@field ignore_folder? boolean

---@class aib.AssociateOptions : aib.NameRules
---@field by? "name"|"stamp"|"index"
---@field max_gap? number  # of stamps, seconds; 0.01
---@field offset? number  # added to the estimate's stamps
---@field convention? "one_to_one"|"evo"  # evo: a pose may be matched again

---Pairs the poses of two trajectories, each once. Stamps: the closest pairs first.
---@param est aib.Trajectory
---@param ref aib.Trajectory
---@param options? aib.AssociateOptions
---@return aib.Trajectory est2
---@return aib.Trajectory ref2
---@return { n_matched: integer, n_estimate_only: integer, n_reference_only: integer, estimate_index: integer[], reference_index: integer[] } info
function pose.associate(est, ref, options) end

---Share of the reference's frames that have a pose in an estimate, or in any of several.
---@param est aib.Trajectory|aib.Trajectory[]
---@param ref aib.Trajectory
---@param options? aib.NameRules
---@return { rate: number, n_registered: integer, n_total: integer, missing: string[] } registration
function pose.registration_rate(est, ref, options) end

---@alias aib.Relation "translation"|"rotation_part"|"full"|"angle_deg"|"angle_rad"|"point_distance"|"point_distance_ratio"

---@class aib.PoseErrors : aib.Summary
---@field errors number[]  # one a frame or pair
---@field index integer[]  # the frame of each, the later one of a pair

---Absolute pose error of each frame, as evo has it.
---@param est aib.Trajectory
---@param ref aib.Trajectory
---@param options? { relation?: aib.Relation }
---@return aib.PoseErrors errors
function pose.ape(est, ref, options) end

---@class aib.RpeOptions
---@field relation? aib.Relation
---@field delta? number  # 1
---@field unit? "frames"|"m"|"deg"|"rad"
---@field all_pairs? boolean
---@field tolerance? number  # all pairs by path or angle: share of delta that a pair may miss; 0.1
---@field pairs_from? "estimate"|"reference"  # whose path tells the pairs

---Relative pose error of pairs of frames a delta apart, as evo has it.
---@param est aib.Trajectory
---@param ref aib.Trajectory
---@param options? aib.RpeOptions
---@return aib.PoseErrors errors
function pose.rpe(est, ref, options) end

---@class aib.AucOptions
---@field max_deg? integer  # 30
---@field convention? "paper"|"vggt"|"posediffusion"|"pi3"|"posediffusion_torch"|"da3"|"colmap"|"exact"
---@field position_accuracy? number  # colmap: shorter reference baselines score by rotation alone

---@class aib.Auc
---@field auc number  # share
---@field auc_signed number  # the same with signed directions
---@field convention string
---@field max_deg integer
---@field n_pairs integer
---@field n_zero_baseline integer  # pairs without a direction, which never score
---@field n_unregistered integer
---@field rra table<number, number>  # share of pairs below 1, 2, .. max_deg degrees
---@field rta table<number, number>

---Area under the recall curve of relative pose errors over all frame pairs. The convention is part of the number.
---@param est aib.Trajectory
---@param ref aib.Trajectory  # colmap: the whole reference
---@param options? aib.AucOptions
---@return aib.Auc auc
function pose.auc(est, ref, options) end

---Shares of frame pairs whose relative rotation, and direction, is off by less than each tau.
---@param est aib.Trajectory
---@param ref aib.Trajectory
---@param options? { tau?: number[] }
---@return { rra: table<number, number>, rta: table<number, number>, n_pairs: integer, n_zero_baseline: integer, n_unregistered: integer } angles
function pose.relative_angles(est, ref, options) end

---Frame pairs by rotation error (rows) and signed direction error (columns). Bin k holds
---edge[k - 1] <= error < edge[k]; the last has no end. Every RRA, RTA and AUC of these edges is a sum of it.
---@class aib.PairHistogram
---@field rotation number[]  # edges, degrees
---@field translation number[]  # edges, degrees
---@field counts integer[][]  # one row a rotation bin
---@field without_direction integer[]  # pairs of each rotation bin that have none
---@field n_pairs integer
---@field n_zero_baseline integer
---@field n_unregistered integer

---The joint histogram of the relative errors of all frame pairs, in one pass.
---@param est aib.Trajectory
---@param ref aib.Trajectory
---@param options? { rotation?: number[], translation?: number[] }  # edges, degrees
---@return aib.PairHistogram histogram
function pose.pair_histogram(est, ref, options) end

---@class aib.PartialAuc
---@field n_pairs integer
---@field n_zero_baseline integer
---@field auc number|nil  # nil where no pair has a direction
---@field auc_signed number|nil
---@field rra table<number, number>|nil
---@field rta table<number, number>|nil

---AUC over the pairs within batches, and over those across them, which means something after alignment only.
---@param est aib.Trajectory
---@param ref aib.Trajectory
---@param batch integer[]  # the batch of each frame
---@param options? aib.AucOptions
---@return { intra: aib.PartialAuc, cross: aib.PartialAuc } parts
function pose.auc_by_batch(est, ref, batch, options) end

---AUC over the pairs of frames that lie so many places apart.
---@param est aib.Trajectory
---@param ref aib.Trajectory
---@param gaps integer[][]  # {first, last}, inclusive
---@param options? aib.AucOptions
---@return aib.PartialAuc[] parts  # with first and last
function pose.auc_by_gap(est, ref, gaps, options) end

---The pairs of frames with the largest error, by name.
---@param est aib.Trajectory
---@param ref aib.Trajectory
---@param options? { n?: integer }
---@return { first: string, second: string, rotation_deg: number, translation_deg: number|nil }[] pairs
function pose.worst_pairs(est, ref, options) end

---@class aib.SegmentErrors
---@field translation_percent number
---@field rotation_deg_per_m number
---@field n integer  # segments

---KITTI odometry's errors over segments of 100 to 800 m.
---@param est aib.Trajectory
---@param ref aib.Trajectory
---@param options? { lengths?: number[], step?: integer }
---@return aib.SegmentErrors errors  # and by_length: a list of the same with length
function pose.kitti_odometry(est, ref, options) end

---@class aib.SubTrajectoryErrors
---@field length number
---@field translation aib.Summary
---@field translation_percent aib.Summary
---@field rotation_deg aib.Summary
---@field rotation_deg_per_m aib.Summary
---@field yaw_deg aib.Summary
---@field gravity_deg aib.Summary  # of roll and pitch

---Relative errors by the length of sub-trajectories, as rpg_trajectory_evaluation has them.
---@param est aib.Trajectory
---@param ref aib.Trajectory
---@param options? { lengths?: number[], tolerance?: number }
---@return aib.SubTrajectoryErrors[] errors
function pose.sub_trajectories(est, ref, options) end

---Mean relative error of focal lengths, rescaled to the reference's image size. `each`: of every image,
---by name, where the mean is over views.
---@param cameras table<string, aib.Camera>
---@param ref table<string, aib.Camera>|number  # a number: the focal length of all, in pixels
---@param options? { over?: "views"|"cameras" }
---@return { mre: number, n: integer, each?: table<string, number> } error
function pose.focal_error(cameras, ref, options) end

---Focal length, principal point, spread and reprojection of cameras against those of the reference.
---@param cameras table<string, aib.Camera>
---@param ref table<string, aib.Camera>
---@return { focal_mre: number, focal_spread: number, principal_point_px: number, reprojection_px: number, reprojection_max_px: number, n: integer } errors
function pose.intrinsics_error(cameras, ref) end

---How far apart two cameras show the same direction, over the image plane, in pixels of the reference.
---@param est aib.Camera
---@param ref aib.Camera
---@return { mean: number, max: number, n: integer, n_lost: integer } difference
function pose.reprojection_difference(est, ref) end
