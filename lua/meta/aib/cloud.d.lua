---@meta aib.cloud

---Point clouds and the distances between them. The order is estimate, reference, options. Nothing here aligns.
---@class aib.cloud
local cloud = {}

---Points with what may come with them; `c[i]` is {x, y, z}, `#c` their number, `transform * c` the moved cloud.
---@class aib.Cloud
---@field has_normals boolean
---@field has_colors boolean
---@field has_labels boolean
---@field origin number[]  # points are floats counted from it
---@field warnings string[]  # what the reader removed or doubts
local point_cloud = {}

---Box of the finite points.
---@return aib.Box box
function point_cloud:bounds() end

---What it is in a few numbers; the box is that of the finite points.
---@return { n: integer, n_finite: integer, min: number[]|nil, max: number[]|nil, has_normals: boolean, has_colors: boolean, has_labels: boolean } summary
function point_cloud:summary() end

---Label of a point.
---@param index integer
---@return integer label
function point_cloud:label(index) end

---The cloud in another frame, as `transform * cloud`.
---@param transform aib.Sim3
---@return aib.Cloud moved
function point_cloud:transformed(transform) end

---@class aib.Box
---@field min number[]  # x, y, z
---@field max number[]

---A box in any orientation.
---@class aib.OrientedBox
---@field centre number[]
---@field size number[]  # along its own axes
---@field rotation number[][]  # world from box, three rows

---Crop volume of Tanks and Temples, as in its JSON files.
---@class aib.PolygonVolume
---@field orthogonal_axis "X"|"Y"|"Z"
---@field axis_min number
---@field axis_max number
---@field bounding_polygon number[][]

---What lies on the positive side of a plane.
---@class aib.HalfSpace
---@field plane number[]  # a, b, c, d of a x + b y + c z + d > 0

---Cells of which those that are not 0 are in, as DTU's observability masks; `min` is the centre of the first.
---@class aib.Grid
---@field grid aib.Array  # X x Y x Z
---@field min number[]
---@field resolution number

---A distance for each point of a cloud, in its order: `d[i]`, `#d`. NaN for a point that is not finite; beyond the
---maximum +infinity (drop) or the maximum (clamp).
---@class aib.Distances
---@field n_dropped integer  # points that are not finite
---@field n_beyond integer  # not below max_distance
local distances = {}

---What it is in a few numbers, nil where no distance counts.
---@return { n: integer, n_dropped: integer, n_beyond: integer, mean: number|nil, median: number|nil, rmse: number|nil, max: number|nil } summary
function distances:summary() end

---Mean of the distances that count.
---@return number mean
function distances:mean() end

---Their median.
---@return number median
function distances:median() end

---Root of their mean square.
---@return number rmse
function distances:rmse() end

---The largest of them.
---@return number max
function distances:max() end

---A quantile of them.
---@param q number  # 0..1, interpolated linearly
---@return number quantile
function distances:quantile(q) end

---Counts in equal bins from 0 to max.
---@param options { max: number, bins?: integer }  # 100 bins
---@return { counts: integer[], above: integer, width: number } histogram
function distances:histogram(options) end

---Share of the finite points strictly below tau.
---@param tau number
---@return number share
function distances:share_below(tau) end

---Share of the finite points not below max_distance.
---@return number share
function distances:share_beyond() end

---The cloud of a list of points.
---@param points number[][]
---@return aib.Cloud cloud
function cloud.from_points(points) end

---The points of several clouds, in their order.
---@param clouds aib.Cloud[]
---@return aib.Cloud all
function cloud.joined(clouds) end

---The points that lie in a volume.
---@param points aib.Cloud
---@param volume aib.Box|aib.OrientedBox|aib.PolygonVolume|aib.HalfSpace|aib.Grid
---@return aib.Cloud inside
function cloud.crop(points, volume) end

---@class aib.StatisticalOptions
---@field neighbours? integer  # the point itself included, default 20
---@field ratio? number  # standard deviations above the mean that are kept, default 2

---The points whose mean distance to their nearest neighbours is not far above that of all, as Open3D keeps them.
---@param points aib.Cloud
---@param options? aib.StatisticalOptions
---@return aib.Cloud kept
function cloud.without_statistical_outliers(points, options) end

---@class aib.RadiusOptions
---@field radius number
---@field neighbours? integer  # more points than this, the point itself included, are kept; default 2

---The points that have enough others nearer than a radius.
---@param points aib.Cloud
---@param options aib.RadiusOptions
---@return aib.Cloud kept
function cloud.without_radius_outliers(points, options) end

---n points chosen at random, in their order; all where there are fewer.
---@param points aib.Cloud
---@param n integer
---@param options? { seed?: integer }
---@return aib.Cloud subset
function cloud.random_subset(points, n, options) end

---The cloud with a normal for each point, of any sign, from its nearest neighbours.
---@param points aib.Cloud
---@param options? { neighbours?: integer }  # the point itself included, default 30
---@return aib.Cloud with_normals
function cloud.with_normals(points, options) end

---@class aib.DistanceOptions
---@field max_distance? number
---@field rule? "drop"|"clamp"  # what becomes of a distance beyond it: left out (default), or the maximum

---Distance from each point to its nearest neighbour, exact.
---@param from aib.Cloud
---@param to aib.Cloud
---@param options? aib.DistanceOptions
---@return aib.Distances distances
function cloud.distances(from, to, options) end

---@class aib.CompareOptions: aib.DistanceOptions
---@field tau? number|number[]  # thresholds of precision, recall and F-score

---How an estimated cloud differs from a reference; lengths in the unit of the clouds.
---@class aib.Comparison
---@field accuracy number  # mean distance from the estimate to the reference
---@field completeness number  # mean distance from the reference to the estimate
---@field chamfer number  # sum of both
---@field chamfer_mean number  # half of it
---@field f1_distance number  # harmonic mean of both distances, a length; 0 where both are 0
---@field accuracy_median number
---@field completeness_median number
---@field accuracy_rmse number
---@field completeness_rmse number
---@field hausdorff number  # the larger of both directed maxima
---@field precision table<number, number>  # by tau: share of the estimate strictly below tau
---@field recall table<number, number>  # by tau: share of the reference strictly below tau
---@field f_score table<number, number>  # by tau: harmonic mean of precision and recall; 0 where both are 0
---@field n_estimate integer  # finite points
---@field n_reference integer
---@field n_dropped integer  # points of both that are not finite
---@field estimate_beyond number  # share of the estimate not below max_distance
---@field reference_beyond number

---Every metric of point clouds from one search.
---@param est aib.Cloud
---@param ref aib.Cloud
---@param options? aib.CompareOptions
---@return aib.Comparison comparison
function cloud.compare(est, ref, options) end

---Distances in both directions, from one search: for `score` and `curve`, to be drawn or written.
---@param est aib.Cloud
---@param ref aib.Cloud
---@param options? aib.DistanceOptions
---@return aib.Distances to_reference  # of the points of the estimate
---@return aib.Distances to_estimate  # of the points of the reference
function cloud.distances_both_ways(est, ref, options) end

---The metrics of distances that are known, as `compare` gives them.
---@param to_reference aib.Distances
---@param to_estimate aib.Distances
---@param options? { tau?: number|number[] }
---@return aib.Comparison comparison
function cloud.score(to_reference, to_estimate, options) end

---Precision, recall and F-score at equal steps up to a threshold.
---@param to_reference aib.Distances
---@param to_estimate aib.Distances
---@param options { max: number, steps?: integer }  # 100 steps
---@return { tau: number[], precision: number[], recall: number[], f_score: number[] } curve
function cloud.curve(to_reference, to_estimate, options) end

---@class aib.LabelComparison: aib.Comparison
---@field label integer
---@field name string|nil  # of the label, where a mesh names it

---A comparison for each label: of the reference's points that have it, and of the estimate's that are nearest to such a
---point. Where one of them is missing, only `label`, `n_estimate` and `n_reference` are there.
---@param est aib.Cloud
---@param ref aib.Cloud  # with labels
---@param options? aib.CompareOptions
---@return aib.LabelComparison[] comparisons  # by ascending label
function cloud.compare_by_label(est, ref, options) end

---A signed distance for each point of a cloud: `o[i]`, `#o`. NaN for a point that is not finite.
---@class aib.Offsets
---@field n_dropped integer  # values that are not finite
local offsets = {}

---What it is in a few numbers, nil where there is none.
---@return { n: integer, n_dropped: integer, mean: number|nil, mean_absolute: number|nil, median: number|nil, deviation: number|nil } summary
function offsets:summary() end

---Mean of the offsets: how far all has moved.
---@return number mean
function offsets:mean() end

---Mean of their sizes.
---@return number mean_absolute
function offsets:mean_absolute() end

---Their median.
---@return number median
function offsets:median() end

---Standard deviation about the mean.
---@return number deviation
function offsets:deviation() end

---A quantile of them.
---@param q number  # 0..1, interpolated linearly
---@return number quantile
function offsets:quantile(q) end

---How far each point lies before (positive) or behind the reference, along the normal of its nearest point there.
---@param from aib.Cloud
---@param ref aib.Cloud  # with normals
---@return aib.Offsets offsets
function cloud.offsets(from, ref) end

---The cloud in the colours of one value a point: 0 dark blue to max light yellow; offsets -max blue, 0 light grey, max
---red. NaN is grey.
---@param points aib.Cloud
---@param values aib.Distances|aib.Offsets|number[]
---@param options { max: number, scale?: "sequential"|"diverging" }
---@return aib.Cloud colored
function cloud.colored(points, values, options) end

---The same colours as a list, for `face_colors` of `aib.io.write_mesh`.
---@param values aib.Distances|aib.Offsets|number[]
---@param options { max: number, scale?: "sequential"|"diverging" }
---@return integer[][] colors  # {red, green, blue}, 0..255
function cloud.colors_of(values, options) end

---@class aib.LaserScan
---@field points aib.Cloud  # in the world
---@field scanner number[]  # where it stood

---@class aib.Eth3dOptions
---@field tolerances number|number[]
---@field voxel? number  # edge of the voxels over which shares are averaged, default 0.01
---@field beam_radius? number  # at the scanner, default 0.001125
---@field beam_half_angle_deg? number  # default 0.011
---@field rule? "official"|"within"|"below"  # a point at exactly a tolerance is complete: but not at the largest
---(official: the tool of 2017, voxels in float as it has them), always, never

---@class aib.Eth3d
---@field completeness table<number, number>  # by tolerance
---@field accuracy table<number, number>  # by tolerance; nil where nothing was observed
---@field f_score table<number, number>
---@field n_unobserved table<number, integer>  # points of the estimate that count neither way
---@field n_estimate integer
---@field n_reference integer

---The scores of the ETH3D benchmark: shares averaged over voxels; only what laser beams saw to be free, or a surface,
---counts in accuracy.
---@param est aib.Cloud
---@param scans aib.LaserScan[]
---@param options aib.Eth3dOptions
---@return aib.Eth3d scores
function cloud.eth3d(est, scans, options) end

---Means and medians of |cosine| between normals of nearest points.
---@class aib.NormalConsistency
---@field estimate_mean number  # over the estimate
---@field estimate_median number
---@field reference_mean number  # over the reference
---@field reference_median number

---How well the normals of two clouds agree, as CUT3R scores it; both have normals.
---@param est aib.Cloud
---@param ref aib.Cloud
---@return aib.NormalConsistency consistency
function cloud.normal_consistency(est, ref) end

return cloud
