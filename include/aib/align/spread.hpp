// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace aib::align {

namespace detail {

/// Turns columns a and b of the rows until they are orthogonal; whether they were not.
inline bool orthogonalize(std::vector<Eigen::Vector3d>& rows, Eigen::Matrix3d& axes, int a, int b) {
  double aa = 0, bb = 0, ab = 0;
  for (const Eigen::Vector3d& row : rows) {
    aa += row[a] * row[a];
    bb += row[b] * row[b];
    ab += row[a] * row[b];
  }
  if (!(std::abs(ab) > 1e-15 * std::sqrt(aa) * std::sqrt(bb))) return false;
  const double slope = (bb - aa) / (2 * ab);
  const double tangent = std::copysign(1 / (std::abs(slope) + std::hypot(1, slope)), slope);
  const double cosine = 1 / std::hypot(1, tangent), sine = cosine * tangent;
  const auto turn = [&](auto&& row) {
    const double from_a = row[a], from_b = row[b];
    row[a] = cosine * from_a - sine * from_b;
    row[b] = sine * from_a + cosine * from_b;
  };
  for (Eigen::Vector3d& row : rows) turn(row);
  for (int r = 0; r < 3; ++r) turn(axes.row(r));
  return true;
}

inline std::string direction_text(const Eigen::Vector3d& v) {
  const auto digits = [](double x) { return std::round(x * 1000) / 1000 + 0.0; };  // no -0
  return message("(", digits(v[0]), ", ", digits(v[1]), ", ", digits(v[2]), ")");
}

}  // namespace detail

/// How points lie about their mean: along which axes, how far.
struct spread {
  Eigen::Vector3d mean;
  Eigen::Matrix3d axes;             ///< columns, longest first
  Eigen::Vector3d singular_values;  ///< of the centred points, descending; square sums of the axes
  double rounding;                  ///< singular value that rounding of the coordinates can give

  /// Second singular value over the first: 0 for points on a line or in one place.
  [[nodiscard]] double ratio() const {
    if (!(singular_values[0] > rounding) || !(singular_values[1] > rounding)) return 0;
    return singular_values[1] / singular_values[0];
  }
  /// First singular value over the second: how much worse the turn about the long axis is known.
  [[nodiscard]] double condition() const {
    return ratio() > 0 ? 1 / ratio() : std::numeric_limits<double>::infinity();
  }
};

/// Of the centred points themselves, not of their covariance: a square would hide everything below
/// 1e-8. Throws argument_error if a point is not finite, undefined_error if there is none.
/// Source: Hestenes, "Inversion of matrices by biorthogonalization", 1958 (one-sided Jacobi).
inline spread spread_of(std::span<const Eigen::Vector3d> points) {
  if (points.empty()) throw undefined_error("align: no points");
  const auto n = static_cast<double>(points.size());
  spread out{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), 0};
  double largest = 0;
  for (const Eigen::Vector3d& p : points) {
    if (!p.allFinite()) throw argument_error("align: a point is not finite");
    out.mean += p / n;
    largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  out.rounding = 4 * std::numeric_limits<double>::epsilon() * largest * std::sqrt(n);
  std::vector<Eigen::Vector3d> rows;
  for (const Eigen::Vector3d& p : points) rows.push_back(p - out.mean);
  bool turned = true;
  for (int sweep = 0; sweep < 30 && turned; ++sweep) {
    turned = false;
    for (const auto& [a, b] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}})
      turned = detail::orthogonalize(rows, out.axes, a, b) || turned;
  }
  for (const Eigen::Vector3d& row : rows) out.singular_values += row.cwiseAbs2();
  out.singular_values = out.singular_values.cwiseSqrt();
  for (const auto& [a, b] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
    if (out.singular_values[a] >= out.singular_values[b]) continue;
    std::swap(out.singular_values[a], out.singular_values[b]);
    out.axes.col(a).swap(out.axes.col(b));
  }
  for (int axis = 0; axis < 3; ++axis) {  // the largest component points forward
    Eigen::Index at = 0;
    out.axes.col(axis).cwiseAbs().maxCoeff(&at);
    if (out.axes(at, axis) < 0) out.axes.col(axis) *= -1;
  }
  return out;
}

}  // namespace aib::align
