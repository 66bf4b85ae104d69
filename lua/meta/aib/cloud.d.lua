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

---A distance for each point of a cloud, in its order: `d[i]`, `#d`. NaN for a point that is not finite; beyond the
---maximum +infinity (drop) or the maximum (clamp).
---@class aib.Distances
---@field n_dropped integer  # points that are not finite
---@field n_beyond integer  # not below max_distance
local distances = {}

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
---@param volume aib.Box|aib.OrientedBox|aib.PolygonVolume
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
