// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/depth/accumulate.hpp>
#include <aib/depth/crop.hpp>
#include <aib/depth/fit.hpp>

namespace aib::depth {

/// Evaluation scripts whose numbers aib repeats.
enum class preset { paper, kitti, monodepth2, cut3r, pi3 };

/// The options of an evaluation script. What they do not say, and where aib differs on purpose:
///
/// paper       the maps as they are: srmse does not see the scale. Mean over frames.
/// kitti       the maps as they are, in metres. The tool prints irmse in 1/km, errors in percent,
///             and fills holes of the estimate; here they lower the coverage.
/// monodepth2  median scaling per image, 1 mm < reference < 80 m, estimates clamped to that range,
///             Garg's crop. The script resizes disparities bilinearly before: the caller's task.
/// cut3r, pi3  one lower median over the whole sequence, reference < 80, estimates below 1e-5
///             raised to it in logarithms alone. The scripts give 0 for a sequence without a valid
///             pixel (a perfect score), and NaN where one estimate is; here the first is
///             undefined_error, the second one pixel less. A negative estimate after scale_shift
///             counts there and is left out here. Their other alignments are `scale_l1`,
///             `scale_shift` and `none`. The mean over sequences is weighted by pixels: pooled.
///
/// Source: evaluate_depth.py of monodepth2; eval/video_depth/tools.py of CUT3R; utils/depth.py of
/// pi3 (branch evaluation); KITTI depth development kit.
[[nodiscard]] inline accumulate_options options_of(preset p) {
  switch (p) {
    case preset::monodepth2:
      return {.errors = {.align = alignment::median,
                         .min = 1e-3,
                         .max = 80,
                         .crop = crop_rule::garg,
                         .clamp_min = 1e-3,
                         .clamp_max = 80}};
    case preset::cut3r:
    case preset::pi3:
      return {.errors = {.align = alignment::median_lower, .max = 80, .clamp_log = 1e-5},
              .align_over = scope::sequence};
    default:
      return {};
  }
}

}  // namespace aib::depth
