// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/depth/crop.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/depth/errors.hpp>
#include <aib/depth/fit.hpp>
#include <aib/depth/label_sums.hpp>
#include <aib/raster/image.hpp>
#include <aib/raster/view.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace aib::depth {

/// What is kept of a frame: its sums, and its errors where it has a valid pixel.
struct frame_record {
  std::string name;
  error_sums sums = {};
  affine transform = {};
  std::optional<error_summary> errors = {};
  label_sums by_label = {};  ///< of a frame that came with labels
};

/// The errors of many frames, in both ways of taking them together.
struct frames_summary {
  /// Means over the frames that have a valid pixel; coverage over those that have a reference,
  /// where a frame without a valid pixel counts as 0. Counts are totals.
  error_summary mean;
  /// Over all pixels as if they were one frame. `scale` and `shift` are the means of the frames.
  error_summary pooled;
  std::size_t n_frames;                ///< frames added
  std::size_t n_defined;               ///< frames with a valid pixel
  std::vector<std::string> undefined;  ///< names of the others
};

/// Errors of frames, one by one. Accumulators of parts merge by `a += b`, the frames of b after
/// those of a: the result is that of one run in that order, to the last bit.
class accumulator {
 public:
  /// Mask and labels of the options are not used: each frame brings its own.
  explicit accumulator(const error_options& options = {}) : options_(options) {}

  /// Adds a frame; one without a valid pixel is kept as such. Throws argument_error if sizes
  /// differ.
  template <class Estimate, class Reference>
  void add(std::string name,
           raster::view<const Estimate> estimate,
           raster::view<const Reference> reference,
           raster::view<const std::uint8_t> mask = {},
           raster::view<const std::uint16_t> labels = {});

  accumulator& operator+=(const accumulator& other);

  /// The labels that occur in any frame, sorted.
  [[nodiscard]] std::vector<std::uint16_t> labels() const;

  /// The same over the pixels of one label alone, without the frames that have none of them.
  [[nodiscard]] accumulator of_label(std::uint16_t label) const;

  /// The frames in the order in which they were added.
  [[nodiscard]] const std::vector<frame_record>& frames() const { return frames_; }

  /// Throws undefined_error, with the counts, if no frame has a valid pixel.
  [[nodiscard]] frames_summary result() const;

 private:
  [[nodiscard]] error_summary mean() const;

  error_options options_;
  std::vector<frame_record> frames_;
};

/// Indices of the frames, the worst value of `field` first: the largest, of shares the smallest.
/// Frames without a valid pixel are last, in their order.
[[nodiscard]] std::vector<std::size_t> worst_first(
    const std::vector<frame_record>& frames, double error_summary::*field = &error_summary::srmse);

/// A frame as a loader hands it over; an empty mask leaves nothing out.
struct frame {
  std::string name;
  depth_map estimate;
  depth_map reference;
  raster::image<std::uint8_t> mask = {};
  raster::image<std::uint16_t> labels = {};
};

/// What one fit of scale and shift is over.
enum class scope { frame, sequence };

struct accumulate_options {
  error_options errors = {};
  scope align_over = scope::frame;  ///< sequence: one fit over all frames, which are loaded twice
  unsigned threads = 0;             ///< 0: all; so many frames are in memory at a time
  aib::control control = {};
};

/// One fit of scale and shift over the frames that `load` gives, see accumulate.
template <class Load>
[[nodiscard]] affine fit_frames(std::size_t n, const accumulate_options& options, Load load) {
  const auto fit_of = [&](const chunk& c) {
    const frame f = load(c.begin);
    fitter one(options.errors.align, rules_of(options.errors));
    one.add(cropped(f.estimate.values.view(), options.errors.crop),
            cropped(f.reference.values.view(), options.errors.crop),
            cropped(f.mask.view(), options.errors.crop));
    return one;
  };
  const auto combine = [](fitter total, const fitter& part) { return total += part; };
  return reduce_chunks(n, 1, options.threads, options.control, fitter(), fit_of, combine).result();
}

/// Loads frames 0 .. n - 1 by `load(i) -> frame`, from several threads at a time, and accumulates
/// them in order: the result does not depend on the number of threads. What `load` throws is thrown
/// here.
template <class Load>
[[nodiscard]] accumulator accumulate(std::size_t n, const accumulate_options& options, Load load) {
  error_options errors = options.errors;
  if (options.align_over == scope::sequence && errors.align != alignment::none) {
    errors.transform = fit_frames(n, options, load);
    errors.align = alignment::none;
  }
  const auto errors_of = [&](const chunk& c) {
    accumulator one(errors);
    frame f = load(c.begin);
    one.add(std::move(f.name), std::as_const(f.estimate.values).view(),
            std::as_const(f.reference.values).view(), std::as_const(f.mask).view(),
            std::as_const(f.labels).view());
    return one;
  };
  const auto combine = [](accumulator total, const accumulator& part) { return total += part; };
  return reduce_chunks(n, 1, options.threads, options.control, accumulator(errors), errors_of,
                       combine);
}

template <class Estimate, class Reference>
void accumulator::add(std::string name,
                      raster::view<const Estimate> estimate,
                      raster::view<const Reference> reference,
                      raster::view<const std::uint8_t> mask,
                      raster::view<const std::uint16_t> labels) {
  error_options options = options_;
  options.mask = mask;
  options.labels = labels;
  frame_sums measured = measure(estimate, reference, options);
  frames_.push_back({.name = std::move(name),
                     .sums = measured.sums,
                     .transform = measured.transform,
                     .errors = record_of(measured.sums, measured.transform).errors,
                     .by_label = std::move(measured.by_label)});
}

inline std::vector<std::uint16_t> accumulator::labels() const {
  std::set<std::uint16_t> all;
  for (const frame_record& f : frames_)
    for (const auto& [label, sums] : f.by_label) all.insert(label);
  return {all.begin(), all.end()};
}

inline accumulator accumulator::of_label(std::uint16_t label) const {
  accumulator part(options_);
  for (const frame_record& f : frames_) {
    const auto found = f.by_label.find(label);
    if (found == f.by_label.end()) continue;
    part.frames_.push_back({.name = f.name,
                            .sums = found->second,
                            .transform = f.transform,
                            .errors = record_of(found->second, f.transform).errors});
  }
  return part;
}

inline accumulator& accumulator::operator+=(const accumulator& other) {
  frames_.insert(frames_.end(), other.frames_.begin(), other.frames_.end());
  return *this;
}

inline frames_summary accumulator::result() const {
  error_sums total;
  std::vector<std::string> undefined;
  for (const frame_record& f : frames_) {
    total += f.sums;
    if (!f.errors) undefined.push_back(f.name);
  }
  if (undefined.size() == frames_.size()) {
    throw undefined_error(message("depth::accumulator: none of ", frames_.size(),
                                  " frames has a pixel that is valid in both maps, ",
                                  total.n_estimate, " are in the estimates, ", total.n_reference,
                                  " in the references"));
  }
  const error_summary means = mean();
  return {.mean = means,
          .pooled = summarize(total, {means.scale, means.shift}),
          .n_frames = frames_.size(),
          .n_defined = frames_.size() - undefined.size(),
          .undefined = std::move(undefined)};
}

inline error_summary accumulator::mean() const {
  error_summary total{};
  double n_defined = 0, n_reference = 0;
  for (const frame_record& f : frames_) {
    if (f.sums.n_reference > 0) ++n_reference;
    total.n_valid += f.sums.log_ratio.count();
    total.n_reference += f.sums.n_reference;
    total.n_estimate += f.sums.n_estimate;
    if (!f.errors) continue;
    ++n_defined;
    for (const auto& [name, value] : error_fields) total.*value += (*f.errors).*value;
  }
  for (const auto& [name, value] : error_fields) {
    total.*value /= value == &error_summary::coverage ? n_reference : n_defined;
  }
  return total;
}

inline std::vector<std::size_t> worst_first(const std::vector<frame_record>& frames,
                                            double error_summary::*field) {
  std::vector<std::size_t> order(frames.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const double sign = is_share(field) ? -1 : 1;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (!frames[a].errors || !frames[b].errors) return frames[a].errors && !frames[b].errors;
    return sign * ((*frames[a].errors).*field) > sign * ((*frames[b].errors).*field);
  });
  return order;
}

}  // namespace aib::depth
