-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- What the metrics are, in a sentence each: shown beside a number in the page.
local M = {}

local metrics <const> = {
  ["depth.srmse"] = "Variance of the log ratio of estimated and true depth over common valid pixels.",
  ["depth.si_log_rmse"] = "Root of sRMSE: scale-invariant log RMSE.",
  ["depth.silog"] = "100 times the root of the variance of the log ratio (KITTI).",
  ["depth.abs_rel"] = "Mean of |estimate - truth| / truth over common valid pixels.",
  ["depth.sq_rel"] = "Mean of (estimate - truth)² / truth.",
  ["depth.rmse"] = "Root of the mean squared depth error.",
  ["depth.mae"] = "Mean absolute depth error.",
  ["depth.rmse_log"] = "Root of the mean squared log ratio.",
  ["depth.log10"] = "Mean absolute difference of base-10 logarithms.",
  ["depth.irmse"] = "Root of the mean squared error of inverse depth.",
  ["depth.imae"] = "Mean absolute error of inverse depth.",
  ["depth.coverage"] = "Share of the truth's valid pixels that the estimate covers.",
  ["pose.auc30"] = "Area under the recall of relative poses over all pairs of frames, up to 30 degrees.",
  ["pose.auc30_signed"] = "The same, directions of translation with their sign.",
  ["pose.auc30_joint"] = "The same of both errors of a pair at once.",
  ["pose.auc30_intra"] = "AUC30 over the pairs of frames of one batch.",
  ["pose.auc30_cross"] = "AUC30 over the pairs of frames of different batches.",
  ["pose.registration_rate"] = "Share of the expected images that got a pose.",
  ["pose.n_registered"] = "Images that got a pose.",
  ["pose.ape_rmse"] = "Root mean square distance of camera centres after alignment.",
  ["align.rmse"] = "Residual of the alignment over the cameras that it was fitted to.",
  ["align.scale"] = "Scale that takes the method's units to the truth's.",
  ["align.condition"] = "How well the camera positions determine the alignment; large is bad.",
  ["camera.focal_mre"] = "Mean relative error of the focal length.",
  ["cloud.accuracy"] = "Mean distance from the estimate's points to the true surface.",
  ["cloud.accuracy_exact"] = "The same to the triangles of the true mesh.",
  ["cloud.accuracy_median"] = "Median distance from the estimate's points to the true surface.",
  ["cloud.completeness"] = "Mean distance from the true surface to the estimate's nearest point.",
  ["cloud.completeness_median"] = "Median distance from the true surface to the estimate.",
  ["cloud.chamfer"] = "Accuracy + completeness.",
  ["cloud.chamfer_mean"] = "Half of accuracy + completeness.",
  ["cloud.f1_distance"] = "Harmonic mean of accuracy and completeness: a distance, lower is better.",
  ["cloud.hausdorff"] = "The largest distance in either direction.",
  ["cloud.sampling_floor"] = "What a perfect cloud would score against the samples of the mesh.",
  ["cloud.n_outside"] = "Points outside of the scene's crop, which do not count.",
  ["registration_rate"] = "Share of the reference's frames that got a pose.",
}

--- Of names with a number or statistic in them.
local patterns <const> = {
  { "^depth%.delta(%d)$", "Share of pixels whose ratio to the truth, either way, is below 1.25 to the power %s." },
  { "^depth%.within_(%d)gsd$", "Share of the truth's pixels within %s ground sampling distances." },
  { "^pose%.rra(%d+)$", "Share of frame pairs whose relative rotation is off by less than %s degrees." },
  { "^pose%.rta(%d+)$", "Share of frame pairs whose direction of translation is off by less than %s degrees." },
  { "precision@?(.*)$", "Share of the estimate's points nearer to the truth than the threshold %s." },
  { "recall@?(.*)$", "Share of the truth's points nearer to the estimate than the threshold %s." },
  { "f_score@?(.*)$", "Harmonic mean of precision and recall at the threshold %s." },
  { "^sensitivity%.(.-)_change$", "Paired change of %s over frames, from the first condition to the last." },
  { "^sensitivity%.(.-)_slope$", "Change of %s from one condition to the next." },
  { "^sensitivity%.(.-)_within$", "%s changes by less than this, at the level of the interval." },
  { "^(.+)_low$", "Lower bound of the 95 %% interval of %s." },
  { "^(.+)_high$", "Upper bound of the 95 %% interval of %s." },
  { "^ape%.(%w+)$", "Absolute pose error, %s over paired poses." },
  { "^rpe%.(%w+)$", "Relative pose error, %s over pairs of poses." },
  { "^rank of (.+)$", "Mean rank by %s over scenes and conditions." },
}

--- The sentence of a metric; nil where there is none.
function M.of(name)
  if metrics[name] then return metrics[name] end
  for _, p in ipairs(patterns) do
    local part = name:match(p[1])
    if part then return (p[2]:format(part):gsub(" %.$", ".")) end
  end
end

return M
