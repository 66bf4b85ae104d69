// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
// aib 0.1.0, the whole library in one header, made by single_include/amalgamate.py.
// Compile with -std=c++20 -ffp-contract=off: results are then the same bits on every machine.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <nanoflann.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <concepts>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <numbers>
#include <numeric>
#include <optional>
#include <queue>
#include <ranges>
#include <set>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <thread>
#include <tuple>
#include <type_traits>
#include <unistd.h>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

// aib/core/message.hpp

namespace aib {

namespace detail {

inline void append(std::string& out, std::string_view part) { out += part; }

template <class Number>
requires std::is_arithmetic_v<Number>
void append(std::string& out, Number value) {
  if constexpr (std::is_same_v<Number, bool>) {
    out += value ? "true" : "false";
  } else if constexpr (std::is_same_v<Number, char>) {
    out += value;
  } else {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    out.append(digits, end);
  }
}

}  // namespace detail

/// The parts written one after another; numbers in their shortest exact form, in no locale.
template <class... Parts>
[[nodiscard]] std::string message(const Parts&... parts) {
  std::string out;
  (detail::append(out, parts), ...);
  return out;
}

}  // namespace aib

// aib/core/error.hpp

namespace aib {

/// Root of every exception that aib throws. The message says where, what was expected, what was
/// found.
class error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file cannot be opened, read or written.
class io_error : public error {
 public:
  io_error(const std::filesystem::path& path, std::string_view what)
      : error(message(path.string(), ": ", what)) {}
};

/// One-based line of a text file.
struct at_line {
  std::size_t number;
};

/// Zero-based byte of a binary file.
struct at_byte {
  std::uint64_t offset;
};

/// The content of a file is not what its format demands.
class format_error : public error {
 public:
  format_error(const std::filesystem::path& path, std::string_view what)
      : error(message(path.string(), ": ", what)) {}
  format_error(const std::filesystem::path& path, at_line line, std::string_view what)
      : error(message(path.string(), ":", line.number, ": ", what)) {}
  format_error(const std::filesystem::path& path, at_byte byte, std::string_view what)
      : error(message(path.string(), ": byte ", byte.offset, ": ", what)) {}
};

/// The caller passed something that the function does not accept.
class argument_error : public error {
 public:
  using error::error;
};

/// A metric over nothing: no valid pixel, no pair, an empty cloud. Carries the counts in its
/// message.
class undefined_error : public error {
 public:
  using error::error;
};

/// The work was stopped through its stop token; nothing half-done is left behind.
class stopped_error : public error {
 public:
  using error::error;
};

}  // namespace aib

// aib/stats/quantiles.hpp

namespace aib::stats {

/// What a quantile between two values is.
enum class quantile_rule {
  linear,    ///< interpolated, numpy's default
  lower,     ///< the smaller value (torch.median)
  midpoint,  ///< their mean
};

/// Quantile of unsorted values, q in [0, 1]. Reorders `values`; takes linear time.
/// Throws undefined_error if there is no value, argument_error if q is outside [0, 1].
template <class Scalar>
double quantile_in_place(std::span<Scalar> values,
                         double q,
                         quantile_rule rule = quantile_rule::linear) {
  if (values.empty()) throw undefined_error("stats::quantile: no values");
  if (!(q >= 0 && q <= 1))
    throw argument_error(message("stats::quantile: q in [0, 1] expected, found ", q));
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), nth, values.end());
  const double low = static_cast<double>(*nth);
  const double share = place - static_cast<double>(below);
  if (share == 0 || rule == quantile_rule::lower) return low;
  const double high = static_cast<double>(*std::min_element(nth + 1, values.end()));
  return rule == quantile_rule::midpoint ? (low + high) / 2 : low + (high - low) * share;
}

/// As quantile_in_place, on a copy.
template <class Scalar>
double quantile(std::span<const Scalar> values,
                double q,
                quantile_rule rule = quantile_rule::linear) {
  std::vector<Scalar> copy(values.begin(), values.end());
  return quantile_in_place<Scalar>(copy, q, rule);
}

/// The middle value, or the mean of the two middle values.
template <class Scalar>
double median(std::span<const Scalar> values) {
  return quantile(values, 0.5);
}

}  // namespace aib::stats

// aib/align/outliers.hpp

namespace aib::align {

struct outlier_options {
  std::optional<double> factor = {};    ///< of the median distance, e.g. 3
  std::optional<double> distance = {};  ///< absolute, unit of the positions
};

/// Distances of positions from their component-wise median, and those that are kept.
struct outlier_split {
  Eigen::Vector3d median_position;
  double median_distance;
  std::vector<std::size_t> kept;     ///< distance <= every limit that is set
  std::vector<std::size_t> removed;  ///< ascending, as kept
};

/// One pass. Throws undefined_error if there is no position.
inline outlier_split split_outliers(std::span<const Eigen::Vector3d> positions,
                                    const outlier_options& options) {
  outlier_split out;
  std::vector<double> values(positions.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < positions.size(); ++i) values[i] = positions[i][axis];
    out.median_position[axis] = stats::quantile_in_place<double>(values, 0.5);
  }
  std::vector<double> distances;
  for (const Eigen::Vector3d& p : positions) distances.push_back((p - out.median_position).norm());
  out.median_distance = stats::median<double>(distances);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double limit = std::min(options.factor ? *options.factor * out.median_distance : infinity,
                                options.distance.value_or(infinity));
  for (std::size_t i = 0; i < positions.size(); ++i)
    (distances[i] <= limit ? out.kept : out.removed).push_back(i);
  return out;
}

}  // namespace aib::align

// aib/align/spread.hpp

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

// aib/core/concepts.hpp

namespace aib {

/// Teaches aib a point type. A specialisation has
///   using scalar = float or double;
///   static scalar coordinate(const Point& point, int axis);   // axis 0, 1, 2
template <class Point>
struct point_traits;

template <std::floating_point Scalar, int Options>
struct point_traits<Eigen::Matrix<Scalar, 3, 1, Options>> {
  using scalar = Scalar;
  static scalar coordinate(const Eigen::Matrix<Scalar, 3, 1, Options>& point, int axis) {
    return point[axis];
  }
};

template <std::floating_point Scalar>
struct point_traits<std::array<Scalar, 3>> {
  using scalar = Scalar;
  static scalar coordinate(const std::array<Scalar, 3>& point, int axis) {
    return point[static_cast<std::size_t>(axis)];
  }
};

/// A type that `point_traits` knows.
template <class Point>
concept point = requires(const Point& p) {
  typename point_traits<Point>::scalar;
  { point_traits<Point>::coordinate(p, 0) } -> std::same_as<typename point_traits<Point>::scalar>;
};

/// Any sized random-access range of points: a vector, a span, a range of your own.
template <class Range>
concept point_range = std::ranges::random_access_range<const Range> &&
    std::ranges::sized_range<const Range> && point<std::ranges::range_value_t<const Range>>;

/// Scalar of the points of a range.
template <point_range Range>
using scalar_of = typename point_traits<std::ranges::range_value_t<const Range>>::scalar;

/// The point as an Eigen vector of another scalar.
template <class Scalar, point Point>
Eigen::Matrix<Scalar, 3, 1> as_vector(const Point& p) {
  using traits = point_traits<Point>;
  return {static_cast<Scalar>(traits::coordinate(p, 0)),
          static_cast<Scalar>(traits::coordinate(p, 1)),
          static_cast<Scalar>(traits::coordinate(p, 2))};
}

}  // namespace aib

// aib/math/rotation.hpp

namespace aib::math {

inline constexpr double degrees_per_radian = 180 / std::numbers::pi;

/// Angle in degrees of an angle in radians.
[[nodiscard]] constexpr double degrees(double radians) { return radians * degrees_per_radian; }

/// Angle in radians of an angle in degrees.
[[nodiscard]] constexpr double radians(double degrees) { return degrees / degrees_per_radian; }

/// Unit quaternion, Hamilton convention, scalar first. Has no alignment demands, unlike Eigen's.
struct quaternion {
  double w = 1;
  double x = 0;
  double y = 0;
  double z = 0;
};

/// Rotation matrix of a quaternion of any length > 0.
/// Throws argument_error if the quaternion is zero or not finite.
Eigen::Matrix3d rotation_from(const quaternion& q);

/// Unit quaternion of a rotation matrix, w >= 0.
quaternion quaternion_from(const Eigen::Matrix3d& rotation);

/// Rotation by the length of `axis_angle` (radians) about its direction.
Eigen::Matrix3d rotation_from(const Eigen::Vector3d& axis_angle);

/// Axis times angle in radians, angle in [0, pi].
Eigen::Vector3d axis_angle_from(const Eigen::Matrix3d& rotation);

/// Geodesic angle of a rotation in radians, [0, pi]; accurate near 0 and near pi.
double rotation_angle(const Eigen::Matrix3d& rotation);

inline Eigen::Matrix3d rotation_from(const quaternion& q) {
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(norm > 0) || !std::isfinite(norm)) {
    throw argument_error(message("math::rotation_from: quaternion (", q.w, ", ", q.x, ", ", q.y,
                                 ", ", q.z, ") has no direction"));
  }
  return Eigen::Quaterniond(q.w / norm, q.x / norm, q.y / norm, q.z / norm).toRotationMatrix();
}

inline quaternion quaternion_from(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  q.normalize();
  const double sign = q.w() < 0 ? -1 : 1;
  return {sign * q.w(), sign * q.x(), sign * q.y(), sign * q.z()};
}

inline Eigen::Matrix3d rotation_from(const Eigen::Vector3d& axis_angle) {
  const double angle = axis_angle.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, axis_angle / angle).toRotationMatrix();
}

inline Eigen::Vector3d axis_angle_from(const Eigen::Matrix3d& rotation) {
  const quaternion q = quaternion_from(rotation);
  const Eigen::Vector3d v(q.x, q.y, q.z);
  const double length = v.norm();
  if (length == 0) return Eigen::Vector3d::Zero();
  return v * (2 * std::atan2(length, q.w) / length);
}

inline double rotation_angle(const Eigen::Matrix3d& rotation) {
  const quaternion q = quaternion_from(rotation);
  return 2 * std::atan2(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z), q.w);
}

}  // namespace aib::math

// aib/math/rigid3.hpp

namespace aib::math {

/// Rigid motion of space: `b_from_a * p_in_a = p_in_b`.
struct rigid3 {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] rigid3 inverse() const {
    return {rotation.transpose(), -(rotation.transpose() * translation)};
  }
  [[nodiscard]] bool is_finite() const { return rotation.allFinite() && translation.allFinite(); }
  [[nodiscard]] Eigen::Matrix4d matrix() const {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = rotation;
    m.topRightCorner<3, 1>() = translation;
    return m;
  }

  /// c_from_a = c_from_b * b_from_a
  friend rigid3 operator*(const rigid3& c_from_b, const rigid3& b_from_a) {
    return {c_from_b.rotation * b_from_a.rotation,
            c_from_b.rotation * b_from_a.translation + c_from_b.translation};
  }
  friend Eigen::Vector3d operator*(const rigid3& b_from_a, const Eigen::Vector3d& p_in_a) {
    return b_from_a.rotation * p_in_a + b_from_a.translation;
  }
};

}  // namespace aib::math

// aib/math/sim3.hpp

namespace aib::math {

/// Similarity of space: `p_in_b = scale * rotation * p_in_a + translation`.
struct sim3 {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] sim3 inverse() const {
    const Eigen::Matrix3d r = rotation.transpose();
    return {1 / scale, r, -(r * translation) / scale};
  }
  [[nodiscard]] Eigen::Matrix4d matrix() const {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = scale * rotation;
    m.topRightCorner<3, 1>() = translation;
    return m;
  }

  friend sim3 operator*(const sim3& c_from_b, const sim3& b_from_a) {
    return {c_from_b.scale * b_from_a.scale, c_from_b.rotation * b_from_a.rotation,
            c_from_b * b_from_a.translation};
  }
  friend Eigen::Vector3d operator*(const sim3& b_from_a, const Eigen::Vector3d& p_in_a) {
    return b_from_a.scale * (b_from_a.rotation * p_in_a) + b_from_a.translation;
  }
  /// Moves a pose: its position as a point, its axes by the rotation alone.
  friend rigid3 operator*(const sim3& b_from_a, const rigid3& a_from_camera) {
    return {b_from_a.rotation * a_from_camera.rotation, b_from_a * a_from_camera.translation};
  }
};

}  // namespace aib::math

// aib/align/umeyama.hpp

namespace aib::align {

/// When points are too close to a line to tell a rotation.
enum class rank_rule {
  relative,  ///< second singular value of either side's positions below 1e-10 of the first
  evo,       ///< fewer than two singular values of the covariance above 2.2e-16, whatever the unit
};

/// A second singular value of this share of the first is refused.
inline constexpr double refused_ratio = 1e-10;

/// A second singular value of this share of the first is worth a warning.
inline constexpr double doubted_ratio = 1e-2;

struct umeyama_options {
  bool scale = true;  ///< false: rigid, scale 1
  rank_rule convention = rank_rule::relative;
};

namespace detail {

/// The proper rotation R that maximises tr(R^T matrix).
/// Source: Umeyama, "Least-squares estimation of transformation parameters between two point
/// patterns", PAMI 1991, Eq. (40)-(43); Markley 1988.
struct best_rotation {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d signed_singular_values;

  explicit best_rotation(const Eigen::Matrix3d& matrix) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d sign(1, 1, 1);
    if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign[2] = -1;
    rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
    signed_singular_values = svd.singularValues().cwiseProduct(sign);
  }
};

/// Two sets of points about their means: covariance 1/n sum (y - my)(x - mx)^T, variance of x.
struct paired_moments {
  Eigen::Vector3d estimate_mean = Eigen::Vector3d::Zero(), reference_mean = estimate_mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double estimate_variance = 0;

  paired_moments(std::span<const Eigen::Vector3d> estimate,
                 std::span<const Eigen::Vector3d> reference) {
    const auto n = static_cast<double>(estimate.size());
    for (const Eigen::Vector3d& x : estimate) estimate_mean += x / n;
    for (const Eigen::Vector3d& y : reference) reference_mean += y / n;
    for (std::size_t i = 0; i < estimate.size(); ++i) {
      const Eigen::Vector3d x = estimate[i] - estimate_mean, y = reference[i] - reference_mean;
      covariance += y * x.transpose() / n;
      estimate_variance += x.squaredNorm() / n;
    }
  }

  /// The transform with this rotation and scale that moves mean to mean.
  [[nodiscard]] math::sim3 centred(double scale, const Eigen::Matrix3d& rotation) const {
    return {scale, rotation, reference_mean - scale * (rotation * estimate_mean)};
  }
};

inline void check_pairs(std::string_view who, std::size_t n_estimate, std::size_t n_reference) {
  if (n_estimate != n_reference) {
    throw argument_error(message(who, ": as many estimated as reference points expected, found ",
                                 n_estimate, " and ", n_reference));
  }
  if (n_estimate == 0) throw undefined_error(message(who, ": no points"));
}

inline void refuse_a_line(std::string_view who, std::string_view side, const spread& s) {
  if (s.ratio() >= refused_ratio) return;
  const Eigen::Vector3d axis = s.axes.col(0);
  if (!(s.singular_values[0] > s.rounding))
    throw undefined_error(message(who, ": the positions of the ", side, " are all in one place"));
  throw undefined_error(message(who, ": the positions of the ", side,
                                " lie on a line: the turn about ", direction_text(axis),
                                " is free"));
}

inline void refuse_as_evo(const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d d = Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
  if (d[1] > std::numeric_limits<double>::epsilon()) return;
  throw undefined_error(message("umeyama: degenerate covariance rank, singular values ", d[0], ", ",
                                d[1], ", ", d[2]));
}

}  // namespace detail

/// The similarity ref_from_est that minimises sum |ref - (s R est + t)|^2 over paired points.
///
/// estimate, reference   n x 3 each, any units
///
/// The rotation is proper also for mirrored points. Throws argument_error if the lengths differ or
/// a point is not finite, undefined_error if the positions of a side lie on a line (see rank_rule).
/// Source: Umeyama, PAMI 1991, Eq. (40)-(43).
inline math::sim3 umeyama(std::span<const Eigen::Vector3d> estimate,
                          std::span<const Eigen::Vector3d> reference,
                          const umeyama_options& options = {}) {
  detail::check_pairs("umeyama", estimate.size(), reference.size());
  const spread estimate_spread = spread_of(estimate), reference_spread = spread_of(reference);
  const detail::paired_moments m(estimate, reference);
  if (options.convention == rank_rule::evo) {
    detail::refuse_as_evo(m.covariance);
  } else {
    detail::refuse_a_line("umeyama", "estimate", estimate_spread);
    detail::refuse_a_line("umeyama", "reference", reference_spread);
  }
  const detail::best_rotation best(m.covariance);
  const double scale =
      options.scale ? best.signed_singular_values.sum() / m.estimate_variance : 1.0;
  return m.centred(scale, best.rotation);
}

/// As above, from any ranges of points.
template <point_range Estimate, point_range Reference>
math::sim3 umeyama(const Estimate& estimate,
                   const Reference& reference,
                   const umeyama_options& options = {}) {
  const auto vectors = [](const auto& range) {
    std::vector<Eigen::Vector3d> out;
    out.reserve(std::ranges::size(range));
    for (const auto& p : range) out.push_back(as_vector<double>(p));
    return out;
  };
  const std::vector<Eigen::Vector3d> e = vectors(estimate), r = vectors(reference);
  return umeyama(std::span<const Eigen::Vector3d>(e), std::span<const Eigen::Vector3d>(r), options);
}

}  // namespace aib::align

// aib/align/pose_fit.hpp

namespace aib::align {

/// What an alignment may change.
enum class align_mode {
  sim3,       ///< rotation, translation, scale
  se3,        ///< rotation, translation
  yaw,        ///< the turn about the vertical, translation: both worlds know where down is
  yaw_scale,  ///< the same and scale
  scale,      ///< scale alone, as evo's --correct_scale without --align
  first,      ///< the rigid motion that lays the first pose of the one on that of the other
};

/// Whether a fit turns about the vertical alone.
[[nodiscard]] constexpr bool is_about_vertical(align_mode mode) {
  return mode == align_mode::yaw || mode == align_mode::yaw_scale;
}

[[nodiscard]] constexpr bool has_scale(align_mode mode) {
  return mode == align_mode::sim3 || mode == align_mode::yaw_scale || mode == align_mode::scale;
}

struct fit_options {
  align_mode mode = align_mode::sim3;
  double rotation_weight = 0;  ///< sim3, se3: > 0: orientations count, a radian as this length
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< yaw, yaw_scale: the vertical of both worlds
  rank_rule convention = rank_rule::relative;
};

/// Paired world_from_camera poses, and fits of ref_from_est to some of them.
class pose_fit {
 public:
  /// estimate, reference   as long, finite
  pose_fit(std::span<const math::rigid3> estimate,
           std::span<const math::rigid3> reference,
           const fit_options& options)
      : estimate_(estimate), reference_(reference), options_(options) {}

  /// Throws undefined_error if the chosen poses do not tell the transform.
  [[nodiscard]] math::sim3 operator()(std::span<const std::size_t> chosen) const;

  /// Distance that a transform leaves between the positions of a pose.
  [[nodiscard]] double residual(const math::sim3& ref_from_est, std::size_t i) const {
    return (ref_from_est * estimate_[i].translation - reference_[i].translation).norm();
  }

  /// Square sum of the residuals of the chosen poses.
  [[nodiscard]] double square_sum(const math::sim3& ref_from_est,
                                  std::span<const std::size_t> chosen) const {
    double sum = 0;
    for (const std::size_t i : chosen) {
      const double r = residual(ref_from_est, i);
      sum += r * r;
    }
    return sum;
  }

  [[nodiscard]] std::vector<Eigen::Vector3d> estimate(std::span<const std::size_t> chosen) const {
    return positions(estimate_, chosen);
  }
  [[nodiscard]] std::vector<Eigen::Vector3d> reference(std::span<const std::size_t> chosen) const {
    return positions(reference_, chosen);
  }

 private:
  static std::vector<Eigen::Vector3d> positions(std::span<const math::rigid3> poses,
                                                std::span<const std::size_t> chosen) {
    std::vector<Eigen::Vector3d> out;
    for (const std::size_t i : chosen) out.push_back(poses[i].translation);
    return out;
  }
  [[nodiscard]] math::sim3 with_rotations(std::span<const std::size_t> chosen) const;
  [[nodiscard]] math::sim3 about_vertical(std::span<const std::size_t> chosen) const;

  std::span<const math::rigid3> estimate_, reference_;
  fit_options options_;
};

inline math::sim3 pose_fit::operator()(std::span<const std::size_t> chosen) const {
  if (chosen.empty()) throw undefined_error("align: no pose");
  if (options_.mode == align_mode::first) {
    const math::rigid3 moved = reference_[chosen.front()] * estimate_[chosen.front()].inverse();
    return {1, moved.rotation, moved.translation};
  }
  if (is_about_vertical(options_.mode)) return about_vertical(chosen);
  const bool turns = options_.mode != align_mode::scale;
  if (turns && options_.rotation_weight > 0) return with_rotations(chosen);
  const math::sim3 fitted =
      umeyama(estimate(chosen), reference(chosen),
              {.scale = options_.mode != align_mode::se3, .convention = options_.convention});
  return turns ? fitted : math::sim3{.scale = fitted.scale};
}

/// Minimises sum |y - (s R x + t)|^2 + w^2 |angle(R Rx, Ry)|^2 (chordal), rotation and scale in
/// turns. Orientations tell what positions on a line leave free.
inline math::sim3 pose_fit::with_rotations(std::span<const std::size_t> chosen) const {
  const std::vector<Eigen::Vector3d> x = estimate(chosen), y = reference(chosen);
  const detail::paired_moments m(x, y);
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  for (const std::size_t i : chosen)
    turned += reference_[i].rotation * estimate_[i].rotation.transpose();
  const double w = options_.rotation_weight;
  turned *= w * w / (2 * static_cast<double>(chosen.size()));
  if (options_.mode == align_mode::se3)
    return m.centred(1, detail::best_rotation(m.covariance + turned).rotation);
  if (const spread s = spread_of(x); !(s.singular_values[0] > s.rounding))
    throw undefined_error("align: the positions of the estimate are all in one place: no scale");
  double scale = 1;
  Eigen::Matrix3d rotation = detail::best_rotation(turned).rotation;
  for (int round = 0; round < 100; ++round) {
    const double before = scale;
    scale = (rotation.transpose() * m.covariance).trace() / m.estimate_variance;
    rotation = detail::best_rotation(scale * m.covariance + turned).rotation;
    if (std::abs(scale - before) <= 1e-15 * std::abs(scale)) break;
  }
  if (!(scale > 0)) {
    throw undefined_error(
        message("align: positions and orientations contradict each other, scale ", scale));
  }
  return m.centred(scale, rotation);
}

/// Source: Zhang and Scaramuzza, "A tutorial on quantitative trajectory evaluation", IROS 2018,
/// Sec. III-C; the scale as in Umeyama, PAMI 1991, Eq. (42).
inline math::sim3 pose_fit::about_vertical(std::span<const std::size_t> chosen) const {
  const Eigen::Vector3d up = options_.up.normalized();
  if (!up.allFinite()) throw argument_error("align: up has no direction");
  const detail::paired_moments m(estimate(chosen), reference(chosen));
  const Eigen::Matrix3d& c = m.covariance;
  // mean of y . R x = cos a tr((I - up up^T) C) + sin a (up . mean of x cross y) + up . C up
  const Eigen::Vector3d cross(c(2, 1) - c(1, 2), c(0, 2) - c(2, 0), c(1, 0) - c(0, 1));
  const double vertical = up.dot(c * up), cosine = c.trace() - vertical, sine = up.dot(cross);
  if (!(std::hypot(cosine, sine) > refused_ratio * c.norm()))
    throw undefined_error("align: the positions leave the turn about the vertical free");
  const Eigen::Vector3d turn = std::atan2(sine, cosine) * up;
  const double scale = options_.mode == align_mode::yaw
                           ? 1
                           : (vertical + std::hypot(cosine, sine)) / m.estimate_variance;
  if (!(scale > 0)) {
    throw undefined_error(
        message("align: heights and the turn contradict each other, scale ", scale));
  }
  return m.centred(scale, math::rotation_from(turn));
}

}  // namespace aib::align

// aib/core/random.hpp

namespace aib {

/// A well-mixed 64-bit number for a counter: the same for any order of calls.
/// Source: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014
/// (SplitMix64).
[[nodiscard]] constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t counter) {
  std::uint64_t z = seed + (counter + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// Seeded random numbers, the same on every machine. The distributions are our own because those of
/// the standard library differ between implementations.
///
/// Satisfies std::uniform_random_bit_generator. Source of the generator: xoshiro256++, Blackman and
/// Vigna, 2021.
class random_engine {
 public:
  using result_type = std::uint64_t;

  explicit constexpr random_engine(std::uint64_t seed = 1) {
    for (std::uint64_t i = 0; i < 4; ++i) state_[i] = random_bits(seed, i);
  }

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~result_type{0}; }

  constexpr result_type operator()() {
    const auto rotate = [](std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); };
    const std::uint64_t result = rotate(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = rotate(state_[3], 45);
    return result;
  }

  /// Uniform in [0, 1), 53 random bits.
  constexpr double uniform() { return static_cast<double>((*this)() >> 11) * 0x1p-53; }

  /// Uniform in [low, high).
  constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform integer in [0, n), n > 0.
  constexpr std::uint64_t below(std::uint64_t n) {
    const std::uint64_t uneven = (0 - n) % n;  // 2^64 mod n values would come up once too often
    std::uint64_t bits = (*this)();
    while (bits < uneven) bits = (*this)();
    return bits % n;
  }

  /// Standard normal (Box and Muller, one of the two values used).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_[4] = {};
};

}  // namespace aib

// aib/align/ransac.hpp

namespace aib::align {

struct ransac_options {
  double distance = 0;  ///< inliers lie within it, unit of the reference; 0: told from the data
  std::size_t iterations = 1000;
  std::uint64_t seed = 1;
};

namespace detail {

/// Diagonal of the box of the points.
inline double extent(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d low = points.front(), high = points.front();
  for (const Eigen::Vector3d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

}  // namespace detail

/// The poses among `chosen` that agree with one transform, ascending.
///
/// With `distance` the transform of three poses that most poses agree with (RANSAC); without, the
/// one with the least median residual, whose inliers lie within 2.5 robust standard deviations,
/// or within a billionth of the extent where nothing but rounding is left.
/// Then fit and inliers in turns until they no longer change.
/// Throws undefined_error if no three poses tell a transform.
/// Source: Fischler and Bolles, CACM 1981; Rousseeuw, "Least median of squares regression", 1984.
inline std::vector<std::size_t> consensus(const pose_fit& fit,
                                          std::span<const std::size_t> chosen,
                                          const ransac_options& options = {}) {
  const auto residuals = [&](const math::sim3& ref_from_est) {
    std::vector<double> out;
    for (const std::size_t i : chosen) out.push_back(fit.residual(ref_from_est, i));
    return out;
  };
  const auto cost = [&](std::vector<double> r) {
    if (options.distance > 0) {
      return -static_cast<double>(
          std::count_if(r.begin(), r.end(), [&](double d) { return d <= options.distance; }));
    }
    return stats::quantile_in_place<double>(r, 0.5, stats::quantile_rule::lower);
  };
  random_engine random(options.seed);
  math::sim3 best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < options.iterations && chosen.size() >= 3; ++k) {
    std::array<std::size_t, 3> sample;
    for (std::size_t& s : sample) s = chosen[random.below(chosen.size())];
    if (sample[0] == sample[1] || sample[0] == sample[2] || sample[1] == sample[2]) continue;
    try {
      const math::sim3 candidate = fit(sample);
      const double c = cost(residuals(candidate));
      if (c < least) {
        least = c;
        best = candidate;
      }
    } catch (const undefined_error&) {  // three poses on a line
    }
  }
  if (!std::isfinite(least))
    throw undefined_error("align: robust: no three poses tell a transform");
  const double n = static_cast<double>(chosen.size());
  const double sigma = 1.4826 * (1 + 5 / std::max(1.0, n - 3)) * least;  // Rousseeuw, Eq. (1.3)
  const double rounding = 1e-9 * detail::extent(fit.reference(chosen));
  const double limit = options.distance > 0 ? options.distance : std::max(2.5 * sigma, rounding);
  std::vector<std::size_t> inliers;
  for (int round = 0; round < 20; ++round) {
    std::vector<std::size_t> next;
    for (const std::size_t i : chosen) {
      if (fit.residual(best, i) <= limit) next.push_back(i);
    }
    if (next == inliers || next.size() < 3) break;
    inliers = std::move(next);
    best = fit(inliers);
  }
  return inliers;
}

}  // namespace aib::align

// aib/pose/trajectory.hpp

namespace aib::pose {

/// Camera poses in the order of their source.
///
/// `names` and `stamps_s` are empty or as long as the poses. Axes of a camera: x right, y down, z
/// forward (OpenCV). A pose that is not finite is not registered.
struct trajectory {
  std::vector<math::rigid3> world_from_camera = {};
  std::vector<std::string> names = {};
  std::vector<double> stamps_s = {};
  std::vector<std::string> warnings = {};  ///< what the reader repaired or doubts, a sentence each

  [[nodiscard]] std::size_t size() const { return world_from_camera.size(); }
  [[nodiscard]] bool empty() const { return world_from_camera.empty(); }
};

/// Throws argument_error unless names and stamps are absent or one a pose.
inline void check(const trajectory& t) {
  const auto fits = [&](std::size_t n) { return n == 0 || n == t.size(); };
  if (fits(t.names.size()) && fits(t.stamps_s.size())) return;
  throw argument_error(message("trajectory: ", t.size(), " poses, ", t.names.size(), " names, ",
                               t.stamps_s.size(), " stamps: one of each a pose expected"));
}

/// The trajectory seen from another frame.
inline trajectory operator*(const math::sim3& b_from_a, trajectory t) {
  for (math::rigid3& pose : t.world_from_camera) pose = b_from_a * pose;
  return t;
}

/// Camera centres.
inline std::vector<Eigen::Vector3d> positions(const trajectory& t) {
  std::vector<Eigen::Vector3d> p;
  p.reserve(t.size());
  for (const math::rigid3& pose : t.world_from_camera) p.push_back(pose.translation);
  return p;
}

/// The poses at `indices`, with their names and stamps.
inline trajectory select(const trajectory& t, const std::vector<std::size_t>& indices) {
  trajectory out;
  for (const std::size_t i : indices) {
    out.world_from_camera.push_back(t.world_from_camera.at(i));
    if (!t.names.empty()) out.names.push_back(t.names.at(i));
    if (!t.stamps_s.empty()) out.stamps_s.push_back(t.stamps_s.at(i));
  }
  return out;
}

}  // namespace aib::pose

// aib/pose/registered.hpp

namespace aib::pose {

/// Throws argument_error unless two trajectories have as many poses and, where both have names, the
/// same names in the same order.
inline void check_associated(std::string_view who,
                             const trajectory& estimate,
                             const trajectory& reference) {
  check(estimate);
  check(reference);
  if (estimate.size() != reference.size()) {
    throw argument_error(message(who, ": ", estimate.size(), " estimated and ", reference.size(),
                                 " reference poses; associate them first"));
  }
  if (estimate.names.empty() || reference.names.empty()) return;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (estimate.names[i] == reference.names[i]) continue;
    throw argument_error(message(who, ": pose ", i, " is \"", estimate.names[i],
                                 "\" in the estimate and \"", reference.names[i],
                                 "\" in the reference; associate them first"));
  }
}

/// The frames that have a finite pose in both of two associated trajectories.
struct registered_frames {
  std::vector<math::rigid3> estimate;   ///< world_from_camera
  std::vector<math::rigid3> reference;  ///< world_from_camera
  std::vector<std::size_t> index;       ///< of each in the trajectories, ascending
};

/// Throws argument_error as check_associated does.
[[nodiscard]] inline registered_frames registered(std::string_view who,
                                                  const trajectory& estimate,
                                                  const trajectory& reference) {
  check_associated(who, estimate, reference);
  registered_frames out;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const math::rigid3& e = estimate.world_from_camera[i];
    const math::rigid3& r = reference.world_from_camera[i];
    if (!e.is_finite() || !r.is_finite()) continue;
    out.estimate.push_back(e);
    out.reference.push_back(r);
    out.index.push_back(i);
  }
  return out;
}

/// The name of a frame of two associated trajectories: one of theirs, else its number.
[[nodiscard]] inline std::string frame_name(const trajectory& estimate,
                                            const trajectory& reference,
                                            std::size_t i) {
  if (!reference.names.empty()) return reference.names[i];
  if (!estimate.names.empty()) return estimate.names[i];
  return message(i);
}

}  // namespace aib::pose

// aib/align/trajectory.hpp

namespace aib::align {

struct trajectory_options {
  fit_options fit = {};
  std::size_t n = 0;              ///< fit to the first n registered frames; 0: to all
  outlier_options outliers = {};  ///< nothing is removed unless asked
  std::optional<ransac_options> robust = {};
  double stand_off = 10;  ///< distance at which the error of a turn is foretold, reference's unit
};

/// How one trajectory lies in the world of another.
struct alignment {
  math::sim3 transform;               ///< ref_from_est
  std::size_t n_inliers;              ///< frames that the fit used
  std::vector<std::size_t> outliers;  ///< registered frames that it did not use, of those offered
  double rmse;                        ///< of the inliers' positions, unit of the reference
  std::optional<double> half_rmse;    ///< of every other inlier under a fit to the others
  double condition;   ///< first over second singular value of the positions, of the worse side
  double turn_deg;    ///< expected error of the turn that the positions tell worst, <= 90
  double turn_error;  ///< what that moves a point `stand_off` away from its axis
  std::vector<std::string> warnings;
};

/// Fits ref_from_est to the positions (and, if asked, orientations) of associated trajectories.
/// Frames without a finite pose are passed over.
///
/// Throws argument_error if the trajectories are not associated, undefined_error if the frames do
/// not tell the transform: the message names what is free.
alignment trajectory(const pose::trajectory& estimate,
                     const pose::trajectory& reference,
                     const trajectory_options& options = {});

namespace detail {

/// The turn that positions tell worst: about their long axis, or the vertical where a fit turns
/// about nothing else.
struct weakest_turn {
  Eigen::Vector3d axis;
  double lever;  ///< root of the square sum of the distances from it
};

inline weakest_turn weakest_turn_of(std::span<const Eigen::Vector3d> positions,
                                    const fit_options& options) {
  const spread s = spread_of(positions);
  if (!is_about_vertical(options.mode))
    return {s.axes.col(0), std::hypot(s.singular_values[1], s.singular_values[2])};
  const Eigen::Vector3d up = options.up.normalized();
  double sum = 0;
  for (const Eigen::Vector3d& p : positions) sum += (p - s.mean).cross(up).squaredNorm();
  return {up, std::sqrt(sum)};
}

/// Standard deviation of a turn, radians, at most a right angle: the residual of a coordinate over
/// the lever.
inline double turn_sigma(double lever, double sse, std::size_t n, std::size_t parameters) {
  constexpr double right_angle = std::numbers::pi / 2;
  const double freedom = 3 * static_cast<double>(n) - static_cast<double>(parameters);
  if (!(freedom > 0) || !(lever > 0)) return right_angle;
  return std::min(right_angle, std::sqrt(sse / freedom) / lever);
}

inline std::size_t parameters_of(align_mode mode) {
  return (is_about_vertical(mode) ? 4u : 6u) + (has_scale(mode) ? 1u : 0u);
}

/// Error of the odd poses of those chosen under a fit to the even ones; nothing where these do not
/// tell it.
inline std::optional<double> half_rmse(const pose_fit& fit, std::span<const std::size_t> chosen) {
  std::vector<std::size_t> even, odd;
  for (std::size_t k = 0; k < chosen.size(); ++k) (k % 2 == 0 ? even : odd).push_back(chosen[k]);
  if (odd.empty()) return std::nullopt;
  try {
    return std::sqrt(fit.square_sum(fit(even), odd) / static_cast<double>(odd.size()));
  } catch (const undefined_error&) {
    return std::nullopt;
  }
}

/// What a user should know about how well the turn is known.
inline std::string turn_warning(const alignment& a, const Eigen::Vector3d& axis, double stand_off) {
  return message("the turn about ", direction_text(axis), ", along which the positions lie ",
                 "(condition ", std::round(a.condition), "), is known to +-",
                 std::round(a.turn_deg * 10) / 10, " deg, ", std::round(a.turn_error * 100) / 100,
                 " at a distance of ", stand_off, "; rotation_weight uses the orientations");
}

/// The scale that the median distances from the median positions tell.
inline double scale_of_medians(std::span<const Eigen::Vector3d> estimate,
                               std::span<const Eigen::Vector3d> reference) {
  return split_outliers(reference, {}).median_distance /
         split_outliers(estimate, {}).median_distance;
}

}  // namespace detail

inline alignment trajectory(const pose::trajectory& estimate,
                            const pose::trajectory& reference,
                            const trajectory_options& options) {
  const pose::registered_frames frames = pose::registered("align::trajectory", estimate, reference);
  const pose_fit fit(frames.estimate, frames.reference, options.fit);
  std::vector<std::size_t> offered(frames.index.size());
  if (options.n > 0) offered.resize(std::min(options.n, offered.size()));
  std::iota(offered.begin(), offered.end(), std::size_t{0});
  if (offered.empty()) {
    throw undefined_error(message("align::trajectory: none of ", estimate.size(),
                                  " frames has a finite pose on both sides"));
  }
  std::vector<std::size_t> used = options.outliers.factor || options.outliers.distance
                                      ? split_outliers(fit.estimate(offered), options.outliers).kept
                                      : offered;
  if (options.robust) used = consensus(fit, used, *options.robust);

  alignment out{.transform = fit(used),
                .n_inliers = used.size(),
                .outliers = {},
                .rmse = 0,
                .half_rmse = detail::half_rmse(fit, used),
                .condition = 1,
                .turn_deg = 0,
                .turn_error = 0,
                .warnings = {}};
  std::vector<std::size_t> left_out;
  std::set_difference(offered.begin(), offered.end(), used.begin(), used.end(),
                      std::back_inserter(left_out));
  for (const std::size_t i : left_out) out.outliers.push_back(frames.index[i]);
  const double sse = fit.square_sum(out.transform, used);
  out.rmse = std::sqrt(sse / static_cast<double>(used.size()));
  const align_mode mode = options.fit.mode;
  if (mode == align_mode::first) return out;

  const std::vector<Eigen::Vector3d> x = fit.estimate(used), y = fit.reference(used);
  out.condition = std::max(spread_of(x).condition(), spread_of(y).condition());
  if (mode != align_mode::scale && !(options.fit.rotation_weight > 0)) {
    const auto in_estimate = detail::weakest_turn_of(x, options.fit);
    const auto in_reference = detail::weakest_turn_of(y, options.fit);
    // Of both sides the thinner: noise widens a line, it never narrows one.
    const double lever = std::min(out.transform.scale * in_estimate.lever, in_reference.lever);
    const double turn = detail::turn_sigma(lever, sse, used.size(), detail::parameters_of(mode));
    out.turn_deg = math::degrees(turn);
    out.turn_error = 2 * options.stand_off * std::sin(turn / 2);
    const bool thin = !is_about_vertical(mode) && 1 / out.condition < doubted_ratio;
    if (thin || out.turn_deg > 5)
      out.warnings.push_back(detail::turn_warning(out, in_reference.axis, options.stand_off));
  }
  if (has_scale(mode)) {
    const double expected = detail::scale_of_medians(x, y);
    const double off = out.transform.scale / expected;
    if (std::isfinite(expected) && (off < 0.5 || off > 2)) {
      out.warnings.push_back(message("the fitted scale ", out.transform.scale, " is far from the ",
                                     expected, " of the median distances: outliers rule the fit; ",
                                     "see outlier_factor and robust"));
    }
  }
  return out;
}

}  // namespace aib::align

// aib/align/batches.hpp

namespace aib::align {

/// Which frames make a batch: the first of these that is set.
struct batches_options {
  std::vector<std::vector<std::string>> names =
      {};  ///< of each batch; those of no pose are missing
  std::vector<std::vector<std::size_t>> frames = {};  ///< of each batch
  std::vector<std::size_t> sizes = {};                ///< of each batch, one after another
  std::size_t size = 200;         ///< of all batches, one after another; the last has what is left
  trajectory_options align = {};  ///< of each batch
};

/// A batch of frames and how it lies in the world of the reference.
struct batch_alignment {
  std::vector<std::size_t> frames;        ///< of the associated trajectories, in the batch's order
  std::vector<std::string> missing = {};  ///< names of the batch that no pose has
  std::optional<alignment> fit = {};      ///< nothing where the frames do not tell the transform
  std::string degenerate = {};            ///< then why
  std::optional<double> seam =
      {};  ///< jump of the position error from the batch before to this one
};

/// Aligns each batch of associated trajectories on its own. A batch whose frames do not tell its
/// transform is named, not guessed.
///
/// Throws argument_error if the trajectories are not associated, the sizes do not add up to their
/// length, a frame is in two batches or beyond the last, or names are given where poses have none.
std::vector<batch_alignment> batches(const pose::trajectory& estimate,
                                     const pose::trajectory& reference,
                                     const batches_options& options = {});

/// Each batch moved by its transform; the poses of degenerate batches and of frames in no batch
/// become NaN, unregistered.
pose::trajectory transformed(const std::vector<batch_alignment>& batches,
                             pose::trajectory estimate);

namespace detail {

inline std::vector<std::size_t> batch_sizes(std::size_t frames, const batches_options& options) {
  if (!options.sizes.empty()) {
    const std::size_t sum =
        std::accumulate(options.sizes.begin(), options.sizes.end(), std::size_t{0});
    if (sum == frames) return options.sizes;
    throw argument_error(
        message("align::batches: sizes that add up to ", frames, " frames expected, found ", sum));
  }
  if (options.size == 0) throw argument_error("align::batches: size > 0 expected");
  std::vector<std::size_t> sizes(frames / options.size, options.size);
  if (frames % options.size != 0) sizes.push_back(frames % options.size);
  return sizes;
}

inline std::vector<batch_alignment> batches_of_sizes(std::size_t frames,
                                                     const batches_options& options) {
  std::vector<batch_alignment> out;
  std::size_t begin = 0;
  for (const std::size_t size : batch_sizes(frames, options)) {
    out.push_back({.frames = std::vector<std::size_t>(size)});
    std::iota(out.back().frames.begin(), out.back().frames.end(), begin);
    begin += size;
  }
  return out;
}

inline std::vector<batch_alignment> batches_of_names(const pose::trajectory& estimate,
                                                     const pose::trajectory& reference,
                                                     const batches_options& options) {
  const auto& names = reference.names.empty() ? estimate.names : reference.names;
  if (names.empty()) throw argument_error("align::batches: by name, but no pose has one");
  std::unordered_map<std::string, std::size_t> frame_of;
  for (std::size_t i = 0; i < names.size(); ++i) frame_of.emplace(names[i], i);
  std::vector<batch_alignment> out;
  for (const std::vector<std::string>& batch : options.names) {
    out.emplace_back();
    for (const std::string& name : batch) {
      const auto at = frame_of.find(name);
      if (at == frame_of.end())
        out.back().missing.push_back(name);
      else
        out.back().frames.push_back(at->second);
    }
  }
  return out;
}

inline std::vector<batch_alignment> batch_lists(const pose::trajectory& estimate,
                                                const pose::trajectory& reference,
                                                const batches_options& options) {
  if (!options.names.empty()) return batches_of_names(estimate, reference, options);
  if (options.frames.empty()) return batches_of_sizes(estimate.size(), options);
  std::vector<batch_alignment> out;
  for (const std::vector<std::size_t>& frames : options.frames) out.push_back({.frames = frames});
  return out;
}

/// Throws argument_error unless every frame exists and is in one batch at most.
inline void check_batches(const std::vector<batch_alignment>& batches, std::size_t n) {
  std::vector<bool> taken(n);
  for (const batch_alignment& batch : batches) {
    for (const std::size_t i : batch.frames) {
      if (i >= n) {
        throw argument_error(message("align::batches: frames below ", n, " expected, found ", i));
      }
      if (taken[i]) throw argument_error(message("align::batches: frame ", i, " comes twice"));
      taken[i] = true;
    }
  }
}

/// Error of a position under a transform; NaN where a pose is not finite.
inline Eigen::Vector3d position_error(const math::sim3& ref_from_est,
                                      const pose::trajectory& estimate,
                                      const pose::trajectory& reference,
                                      std::size_t i) {
  return ref_from_est * estimate.world_from_camera[i].translation -
         reference.world_from_camera[i].translation;
}

inline void align_batch(const pose::trajectory& estimate,
                        const pose::trajectory& reference,
                        const trajectory_options& options,
                        batch_alignment& batch) {
  try {
    batch.fit =
        trajectory(select(estimate, batch.frames), select(reference, batch.frames), options);
    for (std::size_t& i : batch.fit->outliers) i = batch.frames[i];
  } catch (const undefined_error& failure) {
    batch.degenerate = failure.what();
  }
}

/// From the last frame of one batch to the first of the next.
inline std::optional<double> seam_of(const batch_alignment& before,
                                     const batch_alignment& batch,
                                     const pose::trajectory& estimate,
                                     const pose::trajectory& reference) {
  if (!before.fit || !batch.fit) return std::nullopt;
  const double jump =
      (position_error(batch.fit->transform, estimate, reference, batch.frames.front()) -
       position_error(before.fit->transform, estimate, reference, before.frames.back()))
          .norm();
  if (!std::isfinite(jump)) return std::nullopt;
  return jump;
}

}  // namespace detail

inline std::vector<batch_alignment> batches(const pose::trajectory& estimate,
                                            const pose::trajectory& reference,
                                            const batches_options& options) {
  pose::check_associated("align::batches", estimate, reference);
  std::vector<batch_alignment> out = detail::batch_lists(estimate, reference, options);
  detail::check_batches(out, estimate.size());
  for (batch_alignment& batch : out) detail::align_batch(estimate, reference, options.align, batch);
  for (std::size_t k = 1; k < out.size(); ++k)
    out[k].seam = detail::seam_of(out[k - 1], out[k], estimate, reference);
  return out;
}

inline pose::trajectory transformed(const std::vector<batch_alignment>& batches,
                                    pose::trajectory estimate) {
  std::vector<bool> moved(estimate.size());
  for (const batch_alignment& batch : batches) {
    if (!batch.fit) continue;
    for (const std::size_t i : batch.frames) {
      math::rigid3& pose = estimate.world_from_camera.at(i);
      pose = batch.fit->transform * pose;
      moved[i] = true;
    }
  }
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (!moved[i])
      estimate.world_from_camera[i].translation.setConstant(
          std::numeric_limits<double>::quiet_NaN());
  }
  return estimate;
}

}  // namespace aib::align

// aib/cloud/cloud.hpp

namespace aib::cloud {

using color = std::array<std::uint8_t, 3>;

/// Points with what may come with them. A point lies at `origin + points[i]`: float keeps a tenth
/// of a millimetre within a kilometre, the double origin keeps map coordinates (UTM) exact.
///
/// `normals`, `colors` and `labels` are empty or one a point.
struct cloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> points = {};
  std::vector<Eigen::Vector3f> normals = {};
  std::vector<color> colors = {};
  std::vector<std::uint32_t> labels = {};
  std::vector<std::string> warnings = {};  ///< what the reader removed or doubts, a sentence each

  [[nodiscard]] std::size_t size() const { return points.size(); }
  [[nodiscard]] bool empty() const { return points.empty(); }
  [[nodiscard]] Eigen::Vector3d position(std::size_t i) const {
    return origin + points[i].cast<double>();
  }
};

/// The origin that readers give a cloud whose box is [low, high]: 0 where floats hold it well
/// (|coordinate| < 1024), else the box centre in whole units.
[[nodiscard]] inline Eigen::Vector3d natural_origin(const Eigen::Vector3d& low,
                                                    const Eigen::Vector3d& high) {
  if (low.cwiseAbs().maxCoeff() < 1024 && high.cwiseAbs().maxCoeff() < 1024)
    return Eigen::Vector3d::Zero();
  return ((low + high) / 2).array().round();
}

}  // namespace aib::cloud

// aib/cloud/box.hpp

namespace aib::cloud {

/// A box along the axes, both ends included. Empty until something is added.
struct box {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());

  [[nodiscard]] bool empty() const { return !(low.array() <= high.array()).all(); }
  [[nodiscard]] Eigen::Vector3d size() const { return high - low; }
  [[nodiscard]] Eigen::Vector3d centre() const { return (low + high) / 2; }
  [[nodiscard]] bool contains(const Eigen::Vector3d& p) const {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
  void add(const Eigen::Vector3d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

/// Box of the finite points among `points`, which are counted from `origin`.
[[nodiscard]] inline box bounds(std::span<const Eigen::Vector3f> points,
                                const Eigen::Vector3d& origin) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Eigen::Vector3f low = Eigen::Vector3f::Constant(infinity);
  Eigen::Vector3f high = -low;
  for (const Eigen::Vector3f& p : points) {
    if (!p.allFinite()) continue;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {origin + low.cast<double>(), origin + high.cast<double>()};
}

/// Box of the finite points of a cloud.
[[nodiscard]] inline box bounds(const cloud& c) { return bounds(c.points, c.origin); }

}  // namespace aib::cloud

// aib/cloud/positions.hpp

namespace aib::cloud {

/// Whether the three coordinates are finite.
[[nodiscard]] inline bool is_finite(const Eigen::Vector3f& p) {
  return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z());
}

/// Positions in double as the float points of a cloud, counted from their natural origin.
struct placed_points {
  Eigen::Vector3d origin;
  std::vector<Eigen::Vector3f> points;
};

/// Places n positions; `position(i)` is called twice for each i. Non-finite positions stay what
/// they are and have no part in the origin.
template <class Position>
[[nodiscard]] placed_points place(std::size_t n, Position&& position) {
  box all;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d p = position(i);
    if (p.allFinite()) all.add(p);
  }
  placed_points placed;
  placed.origin = all.empty() ? Eigen::Vector3d(0, 0, 0) : natural_origin(all.low, all.high);
  placed.points.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d p = position(i) - placed.origin;
    placed.points[i] = p.cast<float>();
  }
  return placed;
}

/// The cloud of a range of points of any type that `point_traits` knows.
template <point_range Range>
[[nodiscard]] cloud from_points(const Range& range) {
  const auto at = [&](std::size_t i) {
    using difference = std::ranges::range_difference_t<const Range>;
    return as_vector<double>(std::ranges::begin(range)[static_cast<difference>(i)]);
  };
  placed_points placed = place(static_cast<std::size_t>(std::ranges::size(range)), at);
  return {.origin = placed.origin, .points = std::move(placed.points)};
}

/// The finite points of a cloud as floats from a chosen origin. Borrows the cloud where nothing has
/// to be changed.
class finite_points {
 public:
  finite_points(const cloud& source, const Eigen::Vector3d& origin) : n_given_(source.size()) {
    if (source.size() > std::numeric_limits<std::uint32_t>::max()) {
      throw argument_error(
          message("cloud: at most 4 294 967 295 points expected, found ", source.size()));
    }
    if (source.origin == origin && all_finite(source.points)) {
      borrowed_ = source.points;
    } else {
      copy_finite(source, source.origin - origin);
    }
  }

  [[nodiscard]] std::span<const Eigen::Vector3f> points() const {
    return copied_ ? std::span<const Eigen::Vector3f>(own_) : borrowed_;
  }
  [[nodiscard]] std::size_t n_given() const { return n_given_; }
  [[nodiscard]] std::size_t n_dropped() const { return n_given_ - points().size(); }

  /// Index in the cloud of finite point i.
  [[nodiscard]] std::size_t source_index(std::size_t i) const { return copied_ ? kept_[i] : i; }

 private:
  static bool all_finite(std::span<const Eigen::Vector3f> points) {
    for (const Eigen::Vector3f& p : points) {
      if (!is_finite(p)) return false;
    }
    return true;
  }

  void copy_finite(const cloud& source, const Eigen::Vector3d& shift) {
    copied_ = true;
    own_.reserve(source.size());
    kept_.reserve(source.size());
    for (std::size_t i = 0; i < source.size(); ++i) {
      const Eigen::Vector3d moved = shift + source.points[i].cast<double>();
      const Eigen::Vector3f p = moved.cast<float>();
      if (!is_finite(p)) continue;
      own_.push_back(p);
      kept_.push_back(static_cast<std::uint32_t>(i));
    }
  }

  std::size_t n_given_;
  bool copied_ = false;
  std::span<const Eigen::Vector3f> borrowed_;
  std::vector<Eigen::Vector3f> own_;
  std::vector<std::uint32_t> kept_;
};

}  // namespace aib::cloud

// aib/core/executor.hpp

#if defined(__linux__)
#include <sched.h>
#endif

namespace aib {

/// How a caller watches and stops long work. Every option struct with `threads` may carry one.
struct control {
  std::stop_token stop = {};  ///< stops between chunks with stopped_error
  std::function<void(double share)> progress =
      {};  ///< called with 0..1, never from two threads at once
};

/// Threads that the process may use: affinity mask and cgroup quota, at least 1.
unsigned available_threads();

/// The index range [begin, end) of chunk number `index`.
struct chunk {
  std::size_t begin;
  std::size_t end;
  std::size_t index;
};

/// Calls `body(chunk)` for the chunks of [0, n), each `size` items but the last. Chunks depend on
/// `size` alone, so that per-chunk results combined in order are bit-identical for any number of
/// threads.
///
/// threads   0: available_threads()
///
/// A call from inside a body runs on the calling thread. The first exception (lowest chunk) is
/// rethrown. Throws stopped_error when `control.stop` was requested.
template <class Body>
void for_each_chunk(
    std::size_t n, std::size_t size, unsigned threads, const control& control, Body&& body);

/// Maps each chunk to a T and folds them in chunk order: `total = combine(total, map(chunk))`.
template <class T, class Map, class Combine>
T reduce_chunks(std::size_t n,
                std::size_t size,
                unsigned threads,
                const control& control,
                T total,
                Map&& map,
                Combine&& combine);

namespace detail {

inline thread_local bool inside_worker = false;

struct worker_scope {
  bool outer = std::exchange(inside_worker, true);
  ~worker_scope() { inside_worker = outer; }
};

inline unsigned cgroup_threads() {
  std::ifstream file("/sys/fs/cgroup/cpu.max");
  std::string quota;
  double period = 0;
  if (!(file >> quota >> period) || quota == "max" || period <= 0) return ~0u;
  const double threads = std::strtod(quota.c_str(), nullptr) / period;
  return static_cast<unsigned>(std::max(1.0, std::min(threads + 0.5, 1e6)));
}

/// What the workers of one parallel region share.
class region {
 public:
  region(std::size_t n, std::size_t size, const control& control)
      : n_(n), size_(size), chunks_((n + size - 1) / size), control_(control) {}

  std::size_t chunks() const { return chunks_; }

  template <class Body>
  void work(Body& body) {
    const worker_scope scope;
    for (std::size_t i; !stopped() && (i = next_.fetch_add(1)) < chunks_;) {
      try {
        body(chunk{i * size_, std::min(n_, (i + 1) * size_), i});
        finished();
      } catch (...) {
        failed(i);
      }
    }
  }

  void finish() const {
    if (failure_) std::rethrow_exception(failure_);
    if (done_ < chunks_) throw stopped_error("stopped");
  }

 private:
  bool stopped() const {
    return control_.stop.stop_requested() || cancel_.load(std::memory_order_relaxed);
  }

  void finished() {
    const std::scoped_lock lock(mutex_);
    ++done_;
    if (control_.progress)
      control_.progress(static_cast<double>(done_) / static_cast<double>(chunks_));
  }

  void failed(std::size_t index) {
    const std::scoped_lock lock(mutex_);
    cancel_ = true;
    if (index < failed_at_) {
      failed_at_ = index;
      failure_ = std::current_exception();
    }
  }

  std::size_t n_, size_, chunks_;
  const control& control_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> cancel_ = false;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::size_t failed_at_ = ~std::size_t{0};
  std::exception_ptr failure_;
};

}  // namespace detail

inline unsigned available_threads() {
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
#if defined(__linux__)
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0)
    threads = static_cast<unsigned>(std::max(1, CPU_COUNT(&set)));
#endif
  return std::min(threads, detail::cgroup_threads());
}

template <class Body>
void for_each_chunk(
    std::size_t n, std::size_t size, unsigned threads, const control& control, Body&& body) {
  if (size == 0) throw argument_error("for_each_chunk: chunk size 0");
  if (n == 0) return;
  detail::region region(n, size, control);
  if (threads == 0) threads = available_threads();
  const std::size_t workers =
      detail::inside_worker ? 1 : std::min<std::size_t>(threads, region.chunks());
  {
    std::vector<std::jthread> pool;
    pool.reserve(workers - 1);
    for (std::size_t i = 1; i < workers; ++i) pool.emplace_back([&] { region.work(body); });
    region.work(body);
  }
  region.finish();
}

template <class T, class Map, class Combine>
T reduce_chunks(std::size_t n,
                std::size_t size,
                unsigned threads,
                const control& control,
                T total,
                Map&& map,
                Combine&& combine) {
  if (size == 0) throw argument_error("reduce_chunks: chunk size 0");
  std::vector<T> parts((n + size - 1) / size);
  for_each_chunk(n, size, threads, control, [&](const chunk& c) { parts[c.index] = map(c); });
  for (T& part : parts) total = combine(std::move(total), std::move(part));
  return total;
}

}  // namespace aib

// aib/align/icp.hpp

namespace aib::align {

/// What an iteration makes small.
enum class icp_metric {
  point,  ///< distances between corresponding points
  plane,  ///< distances along the normals of the reference
};

struct icp_options {
  /// A pair farther apart is none. Several distances are a schedule, run one after another.
  std::vector<double> max_distance = {};
  icp_metric metric = icp_metric::point;
  bool with_scale = false;
  math::sim3 init = {};              ///< ref_from_est to begin with
  std::size_t max_iterations = 100;  ///< for each distance of the schedule
  double relative_change = 1e-9;     ///< of fitness and rmse, below which it has converged
  unsigned threads = 0;              ///< 0: all
};

struct icp_result {
  math::sim3 transform;  ///< ref_from_est
  double fitness;        ///< share of the estimate that has a corresponding point
  double rmse;           ///< of the distances of corresponding points
  std::size_t n_pairs;
  std::size_t n_iterations;  ///< of the whole schedule
  bool converged;            ///< the last stage stopped before max_iterations
};

/// Iterative closest point: moves the estimate onto the reference from a rough alignment.
///
/// Correspondences are nearest neighbours in double below max_distance. The update is Umeyama's for
/// points, a linearised least-squares step for planes (needs normals of the reference). The same
/// for any number of threads.
///
/// Throws argument_error without a positive max_distance or without normals where they are needed,
/// undefined_error if a cloud has no finite point or no pair is near enough.
/// Source: Besl and McKay, PAMI 1992; Chen and Medioni, IVC 1992; stopping rule as Open3D.
[[nodiscard]] icp_result icp(const cloud::cloud& estimate,
                             const cloud::cloud& reference,
                             const icp_options& options);

namespace detail {

/// Finite positions of a cloud, counted from an origin, and where each stood.
struct icp_points {
  std::vector<Eigen::Vector3d> position;
  std::vector<std::size_t> source;

  icp_points(const cloud::cloud& c, const Eigen::Vector3d& origin) {
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (!cloud::is_finite(c.points[i])) continue;
      position.push_back(c.position(i) - origin);
      source.push_back(i);
    }
    if (position.empty()) {
      throw undefined_error(message("align::icp: no finite point in a cloud of ", c.size()));
    }
  }

  // The interface that nanoflann asks for.
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return position.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return position[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// Corresponding points, the estimate's as they lie now.
struct icp_pairs {
  std::vector<Eigen::Vector3d> estimate;
  std::vector<Eigen::Vector3d> reference;
  std::vector<Eigen::Vector3d> normal;  ///< of the reference, for planes
  double fitness = 0;
  double rmse = 0;
};

class icp_solver {
 public:
  icp_solver(const cloud::cloud& estimate,
             const cloud::cloud& reference,
             const icp_options& options)
      : options_(options),
        reference_cloud_(reference),
        estimate_(estimate, reference.origin),
        reference_(reference, reference.origin),
        tree_(3, reference_, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {}

  [[nodiscard]] icp_result run();

 private:
  using metric = nanoflann::L2_Simple_Adaptor<double, icp_points>;
  using tree = nanoflann::KDTreeSingleIndexAdaptor<metric, icp_points, 3, std::size_t>;
  static constexpr std::size_t none = ~std::size_t{0};

  [[nodiscard]] std::vector<std::size_t> nearest(std::span<const Eigen::Vector3d> moved,
                                                 double max_distance) const;
  [[nodiscard]] icp_pairs pairs(const math::sim3& now, double max_distance) const;
  [[nodiscard]] math::sim3 step(const icp_pairs& p) const;
  [[nodiscard]] math::sim3 plane_step(const icp_pairs& p) const;

  const icp_options& options_;
  const cloud::cloud& reference_cloud_;
  icp_points estimate_;
  icp_points reference_;
  tree tree_;
};

inline std::vector<std::size_t> icp_solver::nearest(std::span<const Eigen::Vector3d> moved,
                                                    double max_distance) const {
  std::vector<std::size_t> match(moved.size(), none);
  for_each_chunk(moved.size(), 4096, options_.threads, {}, [&](const chunk& c) {
    for (std::size_t i = c.begin; i < c.end; ++i) {
      std::size_t index = 0;
      double squared = 0;
      tree_.knnSearch(moved[i].data(), 1, &index, &squared);
      if (squared < max_distance * max_distance) match[i] = index;
    }
  });
  return match;
}

inline icp_pairs icp_solver::pairs(const math::sim3& now, double max_distance) const {
  std::vector<Eigen::Vector3d> moved;
  moved.reserve(estimate_.position.size());
  for (const Eigen::Vector3d& p : estimate_.position) moved.push_back(now * p);
  const auto match = nearest(moved, max_distance);
  icp_pairs found;
  double squares = 0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (match[i] == none) continue;
    const Eigen::Vector3d& to = reference_.position[match[i]];
    found.estimate.push_back(moved[i]);
    found.reference.push_back(to);
    if (options_.metric == icp_metric::plane) {
      const std::size_t source = reference_.source[match[i]];
      found.normal.push_back(reference_cloud_.normals[source].cast<double>());
    }
    squares += (moved[i] - to).squaredNorm();
  }
  const auto n = static_cast<double>(found.estimate.size());
  found.fitness = n / static_cast<double>(moved.size());
  found.rmse = n > 0 ? std::sqrt(squares / n) : 0;
  return found;
}

/// Solves for a small turn, shift and (with scale) stretch that bring the estimate onto the planes.
inline math::sim3 icp_solver::plane_step(const icp_pairs& p) const {
  const int unknowns = options_.with_scale ? 7 : 6;
  Eigen::MatrixXd normal_matrix = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  for (std::size_t i = 0; i < p.estimate.size(); ++i) {
    const Eigen::Vector3d& x = p.estimate[i];
    const Eigen::Vector3d& n = p.normal[i];
    const double residual = n.dot(p.reference[i] - x);
    Eigen::VectorXd row(unknowns);
    row.head<3>() = x.cross(n);
    row.segment<3>(3) = n;
    if (options_.with_scale) row[6] = n.dot(x);
    if (!row.allFinite()) continue;
    normal_matrix += row * row.transpose();
    right += row * residual;
  }
  const Eigen::VectorXd u = normal_matrix.ldlt().solve(right);
  if (!u.allFinite()) throw undefined_error("align::icp: the planes do not hold the estimate");
  const Eigen::Vector3d turn = u.head<3>();
  return {options_.with_scale ? 1 + u[6] : 1, math::rotation_from(turn), u.segment<3>(3)};
}

inline math::sim3 icp_solver::step(const icp_pairs& p) const {
  if (options_.metric == icp_metric::plane) return plane_step(p);
  return umeyama(p.estimate, p.reference, {.scale = options_.with_scale});
}

inline icp_result icp_solver::run() {
  const Eigen::Vector3d& origin = reference_cloud_.origin;
  const math::sim3 to_local{1, Eigen::Matrix3d::Identity(), -origin};
  math::sim3 now = to_local * options_.init * to_local.inverse();
  icp_result result{};
  for (const double distance : options_.max_distance) {
    icp_pairs p = pairs(now, distance);
    result.converged = false;
    for (std::size_t i = 0; i < options_.max_iterations && !result.converged; ++i) {
      if (p.estimate.empty()) {
        throw undefined_error(
            message("align::icp: no point of the estimate within ", distance, " of the reference"));
      }
      now = step(p) * now;
      icp_pairs next = pairs(now, distance);
      result.converged = std::abs(next.fitness - p.fitness) < options_.relative_change &&
                         std::abs(next.rmse - p.rmse) < options_.relative_change;
      p = std::move(next);
      ++result.n_iterations;
    }
    result.fitness = p.fitness;
    result.rmse = p.rmse;
    result.n_pairs = p.estimate.size();
  }
  result.transform = to_local.inverse() * now * to_local;
  return result;
}

inline void check_icp(const cloud::cloud& reference, const icp_options& options) {
  if (options.max_distance.empty()) throw argument_error("align::icp: max_distance expected");
  for (const double d : options.max_distance) {
    if (!(d > 0)) throw argument_error(message("align::icp: max_distance > 0 expected, found ", d));
  }
  if (options.metric == icp_metric::plane && reference.normals.size() != reference.size()) {
    throw argument_error("align::icp: metric plane expects a reference with normals");
  }
}

}  // namespace detail

inline icp_result icp(const cloud::cloud& estimate,
                      const cloud::cloud& reference,
                      const icp_options& options) {
  detail::check_icp(reference, options);
  return detail::icp_solver(estimate, reference, options).run();
}

}  // namespace aib::align

// aib/core/isa.hpp

/// Names the instruction set that this translation unit is compiled for. Code whose machine form
/// depends on it lives in `inline namespace AIB_ISA`, so that units compiled for different machines
/// can be linked together.
#if defined(AIB_PLAIN)
#define AIB_ISA plain
#elif defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define AIB_ISA avx512
#elif defined(__AVX2__)
#define AIB_ISA avx2
#elif defined(__SSE2__)
#define AIB_ISA sse2
#else
#define AIB_ISA plain
#endif

namespace aib {

inline namespace AIB_ISA {}

#define AIB_ISA_TEXT_(name) #name
#define AIB_ISA_TEXT(name) AIB_ISA_TEXT_(name)

/// "avx512", "avx2", "sse2" or "plain".
inline constexpr const char* instruction_set = AIB_ISA_TEXT(AIB_ISA);

#undef AIB_ISA_TEXT
#undef AIB_ISA_TEXT_

}  // namespace aib

// aib/core/simd.hpp

#if !defined(AIB_PLAIN) && defined(__SSE2__)
#include <immintrin.h>
#endif

/// Eight floats and four doubles that are calculated together, for the few loops where that pays.
///
/// The same bits on every machine: each operation is the IEEE one on each lane, nothing is
/// contracted. `min(a, b)` and `max(a, b)` give `b` where the lanes are unordered. `less(a, b)` has
/// bit i set where a < b in lane i. `choose(a, b, x, y)` is x where a < b, else y.
/// `load` and `store` need no alignment. `convert` loads floats into doubles. Of doubles that are
/// positive and normal, `mantissa` is in [1, 2) and `exponent` the power of 2 beside it.
namespace aib {

namespace detail {

inline constexpr std::int64_t fraction_bits = 0x000fffffffffffff;
/// The exponent bits of x behind the leading bits of 2^52 make the double 2^52 + 1023 + exponent.
inline constexpr double exponent_offset = 0x1p52 + 1023;

}  // namespace detail

inline namespace AIB_ISA {

#if !defined(AIB_PLAIN) && defined(__AVX2__)

struct f32x8 {
  static constexpr std::size_t width = 8;
  __m256 v;

  static f32x8 load(const float* p) { return {_mm256_loadu_ps(p)}; }
  static f32x8 broadcast(float x) { return {_mm256_set1_ps(x)}; }
  void store(float* p) const { _mm256_storeu_ps(p, v); }

  friend f32x8 operator+(f32x8 a, f32x8 b) { return {_mm256_add_ps(a.v, b.v)}; }
  friend f32x8 operator-(f32x8 a, f32x8 b) { return {_mm256_sub_ps(a.v, b.v)}; }
  friend f32x8 operator*(f32x8 a, f32x8 b) { return {_mm256_mul_ps(a.v, b.v)}; }
  friend f32x8 operator/(f32x8 a, f32x8 b) { return {_mm256_div_ps(a.v, b.v)}; }
  friend f32x8 sqrt(f32x8 a) { return {_mm256_sqrt_ps(a.v)}; }
  friend f32x8 min(f32x8 a, f32x8 b) { return {_mm256_min_ps(a.v, b.v)}; }
  friend f32x8 max(f32x8 a, f32x8 b) { return {_mm256_max_ps(a.v, b.v)}; }
  friend unsigned less(f32x8 a, f32x8 b) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)));
  }
  friend f32x8 choose(f32x8 a, f32x8 b, f32x8 x, f32x8 y) {
    return {_mm256_blendv_ps(y.v, x.v, _mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ))};
  }
};

struct f64x4 {
  static constexpr std::size_t width = 4;
  __m256d v;

  static f64x4 load(const double* p) { return {_mm256_loadu_pd(p)}; }
  static f64x4 convert(const float* p) { return {_mm256_cvtps_pd(_mm_loadu_ps(p))}; }
  static f64x4 broadcast(double x) { return {_mm256_set1_pd(x)}; }
  void store(double* p) const { _mm256_storeu_pd(p, v); }

  friend f64x4 operator+(f64x4 a, f64x4 b) { return {_mm256_add_pd(a.v, b.v)}; }
  friend f64x4 operator-(f64x4 a, f64x4 b) { return {_mm256_sub_pd(a.v, b.v)}; }
  friend f64x4 operator*(f64x4 a, f64x4 b) { return {_mm256_mul_pd(a.v, b.v)}; }
  friend f64x4 operator/(f64x4 a, f64x4 b) { return {_mm256_div_pd(a.v, b.v)}; }
  friend f64x4 sqrt(f64x4 a) { return {_mm256_sqrt_pd(a.v)}; }
  friend f64x4 min(f64x4 a, f64x4 b) { return {_mm256_min_pd(a.v, b.v)}; }
  friend f64x4 max(f64x4 a, f64x4 b) { return {_mm256_max_pd(a.v, b.v)}; }
  friend unsigned less(f64x4 a, f64x4 b) {
    return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ)));
  }
  friend f64x4 choose(f64x4 a, f64x4 b, f64x4 x, f64x4 y) {
    return {_mm256_blendv_pd(y.v, x.v, _mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ))};
  }
  friend f64x4 mantissa(f64x4 a) {
    const __m256d one = _mm256_set1_pd(1);
    const __m256d fraction = _mm256_castsi256_pd(_mm256_set1_epi64x(detail::fraction_bits));
    return {_mm256_or_pd(_mm256_and_pd(a.v, fraction), one)};
  }
  friend f64x4 exponent(f64x4 a) {
    const __m256i shifted = _mm256_srli_epi64(_mm256_castpd_si256(a.v), 52);
    const __m256d offset = _mm256_set1_pd(0x1p52);
    return {_mm256_sub_pd(_mm256_or_pd(_mm256_castsi256_pd(shifted), offset),
                          _mm256_set1_pd(detail::exponent_offset))};
  }
};

#elif !defined(AIB_PLAIN) && defined(__SSE2__)

struct f32x8 {
  static constexpr std::size_t width = 8;
  __m128 lo, hi;

  static f32x8 load(const float* p) { return {_mm_loadu_ps(p), _mm_loadu_ps(p + 4)}; }
  static f32x8 broadcast(float x) { return {_mm_set1_ps(x), _mm_set1_ps(x)}; }
  void store(float* p) const {
    _mm_storeu_ps(p, lo);
    _mm_storeu_ps(p + 4, hi);
  }

  friend f32x8 operator+(f32x8 a, f32x8 b) {
    return {_mm_add_ps(a.lo, b.lo), _mm_add_ps(a.hi, b.hi)};
  }
  friend f32x8 operator-(f32x8 a, f32x8 b) {
    return {_mm_sub_ps(a.lo, b.lo), _mm_sub_ps(a.hi, b.hi)};
  }
  friend f32x8 operator*(f32x8 a, f32x8 b) {
    return {_mm_mul_ps(a.lo, b.lo), _mm_mul_ps(a.hi, b.hi)};
  }
  friend f32x8 operator/(f32x8 a, f32x8 b) {
    return {_mm_div_ps(a.lo, b.lo), _mm_div_ps(a.hi, b.hi)};
  }
  friend f32x8 sqrt(f32x8 a) { return {_mm_sqrt_ps(a.lo), _mm_sqrt_ps(a.hi)}; }
  friend f32x8 min(f32x8 a, f32x8 b) { return {_mm_min_ps(a.lo, b.lo), _mm_min_ps(a.hi, b.hi)}; }
  friend f32x8 max(f32x8 a, f32x8 b) { return {_mm_max_ps(a.lo, b.lo), _mm_max_ps(a.hi, b.hi)}; }
  friend unsigned less(f32x8 a, f32x8 b) {
    const int low = _mm_movemask_ps(_mm_cmplt_ps(a.lo, b.lo));
    const int high = _mm_movemask_ps(_mm_cmplt_ps(a.hi, b.hi));
    return static_cast<unsigned>(low | high << 4);
  }
  friend f32x8 choose(f32x8 a, f32x8 b, f32x8 x, f32x8 y) {
    const auto half = [](__m128 mask, __m128 yes, __m128 no) {
      return _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no));
    };
    return {half(_mm_cmplt_ps(a.lo, b.lo), x.lo, y.lo), half(_mm_cmplt_ps(a.hi, b.hi), x.hi, y.hi)};
  }
};

struct f64x4 {
  static constexpr std::size_t width = 4;
  __m128d lo, hi;

  static f64x4 load(const double* p) { return {_mm_loadu_pd(p), _mm_loadu_pd(p + 2)}; }
  static f64x4 convert(const float* p) {
    const __m128 floats = _mm_loadu_ps(p);
    return {_mm_cvtps_pd(floats), _mm_cvtps_pd(_mm_movehl_ps(floats, floats))};
  }
  static f64x4 broadcast(double x) { return {_mm_set1_pd(x), _mm_set1_pd(x)}; }
  void store(double* p) const {
    _mm_storeu_pd(p, lo);
    _mm_storeu_pd(p + 2, hi);
  }

  friend f64x4 operator+(f64x4 a, f64x4 b) {
    return {_mm_add_pd(a.lo, b.lo), _mm_add_pd(a.hi, b.hi)};
  }
  friend f64x4 operator-(f64x4 a, f64x4 b) {
    return {_mm_sub_pd(a.lo, b.lo), _mm_sub_pd(a.hi, b.hi)};
  }
  friend f64x4 operator*(f64x4 a, f64x4 b) {
    return {_mm_mul_pd(a.lo, b.lo), _mm_mul_pd(a.hi, b.hi)};
  }
  friend f64x4 operator/(f64x4 a, f64x4 b) {
    return {_mm_div_pd(a.lo, b.lo), _mm_div_pd(a.hi, b.hi)};
  }
  friend f64x4 sqrt(f64x4 a) { return {_mm_sqrt_pd(a.lo), _mm_sqrt_pd(a.hi)}; }
  friend f64x4 min(f64x4 a, f64x4 b) { return {_mm_min_pd(a.lo, b.lo), _mm_min_pd(a.hi, b.hi)}; }
  friend f64x4 max(f64x4 a, f64x4 b) { return {_mm_max_pd(a.lo, b.lo), _mm_max_pd(a.hi, b.hi)}; }
  friend unsigned less(f64x4 a, f64x4 b) {
    const int low = _mm_movemask_pd(_mm_cmplt_pd(a.lo, b.lo));
    const int high = _mm_movemask_pd(_mm_cmplt_pd(a.hi, b.hi));
    return static_cast<unsigned>(low | high << 2);
  }
  friend f64x4 choose(f64x4 a, f64x4 b, f64x4 x, f64x4 y) {
    const auto half = [](__m128d mask, __m128d yes, __m128d no) {
      return _mm_or_pd(_mm_and_pd(mask, yes), _mm_andnot_pd(mask, no));
    };
    return {half(_mm_cmplt_pd(a.lo, b.lo), x.lo, y.lo), half(_mm_cmplt_pd(a.hi, b.hi), x.hi, y.hi)};
  }
  friend f64x4 mantissa(f64x4 a) {
    const auto half = [](__m128d x) {
      const __m128d fraction = _mm_castsi128_pd(_mm_set1_epi64x(detail::fraction_bits));
      return _mm_or_pd(_mm_and_pd(x, fraction), _mm_set1_pd(1));
    };
    return {half(a.lo), half(a.hi)};
  }
  friend f64x4 exponent(f64x4 a) {
    const auto half = [](__m128d x) {
      const __m128d shifted = _mm_castsi128_pd(_mm_srli_epi64(_mm_castpd_si128(x), 52));
      return _mm_sub_pd(_mm_or_pd(shifted, _mm_set1_pd(0x1p52)),
                        _mm_set1_pd(detail::exponent_offset));
    };
    return {half(a.lo), half(a.hi)};
  }
};

#else

/// Lanes in plain code, for machines without vector code of their own here.
template <class Scalar, std::size_t Width>
struct plain_lanes {
  static constexpr std::size_t width = Width;
  Scalar v[Width];

  static plain_lanes load(const Scalar* p) {
    plain_lanes out;
    std::memcpy(out.v, p, sizeof out.v);
    return out;
  }
  static plain_lanes convert(const float* p) {
    plain_lanes out;
    for (std::size_t i = 0; i < Width; ++i) out.v[i] = p[i];
    return out;
  }
  static plain_lanes broadcast(Scalar x) {
    plain_lanes out;
    std::fill_n(out.v, Width, x);
    return out;
  }
  void store(Scalar* p) const { std::memcpy(p, v, sizeof v); }

  template <class Op>
  static plain_lanes each(const plain_lanes& a, const plain_lanes& b, Op op) {
    plain_lanes out;
    for (std::size_t i = 0; i < Width; ++i) out.v[i] = op(a.v[i], b.v[i]);
    return out;
  }
  friend plain_lanes operator+(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x + y; });
  }
  friend plain_lanes operator-(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x - y; });
  }
  friend plain_lanes operator*(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x * y; });
  }
  friend plain_lanes operator/(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x / y; });
  }
  friend plain_lanes sqrt(const plain_lanes& a) {
    return each(a, a, [](Scalar x, Scalar) { return std::sqrt(x); });
  }
  friend plain_lanes min(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x < y ? x : y; });
  }
  friend plain_lanes max(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x > y ? x : y; });
  }
  friend unsigned less(const plain_lanes& a, const plain_lanes& b) {
    unsigned bits = 0;
    for (std::size_t i = 0; i < Width; ++i) bits |= static_cast<unsigned>(a.v[i] < b.v[i]) << i;
    return bits;
  }
  friend plain_lanes choose(const plain_lanes& a,
                            const plain_lanes& b,
                            const plain_lanes& x,
                            const plain_lanes& y) {
    plain_lanes out;
    for (std::size_t i = 0; i < Width; ++i) out.v[i] = a.v[i] < b.v[i] ? x.v[i] : y.v[i];
    return out;
  }
  friend plain_lanes mantissa(const plain_lanes& a) requires(sizeof(Scalar) == 8) {
    return each(a, a, [](Scalar x, Scalar) {
      const auto bits = std::bit_cast<std::int64_t>(x) & detail::fraction_bits;
      return std::bit_cast<Scalar>(bits | std::bit_cast<std::int64_t>(Scalar{1}));
    });
  }
  friend plain_lanes exponent(const plain_lanes& a) requires(sizeof(Scalar) == 8) {
    return each(a, a, [](Scalar x, Scalar) {
      return static_cast<Scalar>((std::bit_cast<std::int64_t>(x) >> 52) - 1023);
    });
  }
};

using f32x8 = plain_lanes<float, 8>;
using f64x4 = plain_lanes<double, 4>;

#endif

/// The smallest and the largest of the lanes; no lane is NaN.
inline float lowest(f32x8 a) {
  float lane[8];
  a.store(lane);
  return *std::min_element(lane, lane + 8);
}
inline float highest(f32x8 a) {
  float lane[8];
  a.store(lane);
  return *std::max_element(lane, lane + 8);
}

/// Sum of the lanes in a fixed order.
inline double sum(f64x4 a) {
  double lane[4];
  a.store(lane);
  return (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

}  // namespace AIB_ISA
}  // namespace aib

// aib/search/buffer.hpp

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace aib::search {

/// An array whose elements begin undefined, in large pages where the system has them: the first
/// touch of millions of small pages would cost as much as the search itself.
template <class T>
class buffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  buffer() = default;
  explicit buffer(std::size_t size) : data_(allocate(size)), size_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] T* data() { return data_.get(); }
  [[nodiscard]] const T* data() const { return data_.get(); }
  [[nodiscard]] T& operator[](std::size_t i) { return data_[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return data_[i]; }
  [[nodiscard]] std::span<const T> span() const { return {data(), size_}; }

 private:
  static constexpr std::size_t large_page = std::size_t{2} << 20;

  static std::size_t alignment(std::size_t size) {
    return size * sizeof(T) >= 2 * large_page ? large_page : 64;
  }

  struct release {
    std::size_t alignment = 64;
    void operator()(T* p) const { ::operator delete (p, std::align_val_t{alignment}); }
  };

  static std::unique_ptr<T[], release> allocate(std::size_t size) {
    const std::size_t bytes = size * sizeof(T);
    const std::size_t align = alignment(size);
    void* memory = ::operator new (bytes, std::align_val_t{align});
#if defined(__linux__)
    if (align == large_page) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    return {static_cast<T*>(memory), release{align}};
  }

  std::unique_ptr<T[], release> data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace aib::search

// aib/search/hilbert.hpp

namespace aib::search {

namespace detail {

/// How the curve lies in one cell: which axis stands at each place, which places run backwards,
/// and whether the walk through the eight children is reversed.
struct hilbert_state {
  std::array<unsigned, 3> axis{0, 1, 2};
  std::array<unsigned, 3> flip{0, 0, 0};
  unsigned reversed = 0;
};

/// One level down: the child's place on the curve and how the curve lies in the child.
struct hilbert_step {
  unsigned place;  ///< 0..7
  hilbert_state child;
};

/// `octant` has bit k set in the upper half of axis k.
/// Source: Skilling, "Programming the Hilbert curve", AIP Conf. Proc. 707, 2004, one bit plane.
constexpr hilbert_step descend(hilbert_state state, unsigned octant) {
  std::array<unsigned, 3> bit{};
  for (std::size_t k = 0; k < 3; ++k) bit[k] = ((octant >> state.axis[k]) & 1) ^ state.flip[k];
  for (std::size_t k = 0; k < 3; ++k) {
    if (bit[k]) {
      state.flip[0] ^= 1;
    } else {
      const unsigned axis = state.axis[0], flip = state.flip[0];
      state.axis[0] = state.axis[k], state.flip[0] = state.flip[k];
      state.axis[k] = axis, state.flip[k] = flip;
    }
  }
  const unsigned second = bit[1] ^ bit[0];
  const unsigned third = bit[2] ^ second;
  const unsigned r = state.reversed;
  state.reversed ^= third;
  return {(bit[0] ^ r) << 2 | (second ^ r) << 1 | (third ^ r), state};
}

inline constexpr std::array<std::array<unsigned, 3>, 6> axis_orders{
    {{0, 1, 2}, {1, 0, 2}, {2, 1, 0}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}}};

constexpr unsigned number_of(const hilbert_state& s) {
  unsigned order = 0;
  while (axis_orders[order] != s.axis) ++order;
  return order << 4 | (s.flip[0] | s.flip[1] << 1 | s.flip[2] << 2) << 1 | s.reversed;
}

constexpr hilbert_state state_of(unsigned number) {
  return {axis_orders[number >> 4],
          {(number >> 1) & 1, (number >> 2) & 1, (number >> 3) & 1},
          number & 1};
}

inline constexpr unsigned hilbert_states = 96;

/// One level: [state][octant] -> next state << 3 | place.
constexpr std::array<std::uint16_t, hilbert_states * 8> make_octant_table() {
  std::array<std::uint16_t, hilbert_states * 8> table{};
  for (unsigned number = 0; number < hilbert_states; ++number) {
    for (unsigned octant = 0; octant < 8; ++octant) {
      const hilbert_step step = descend(state_of(number), octant);
      table[number * 8 + octant] =
          static_cast<std::uint16_t>(number_of(step.child) << 3 | step.place);
    }
  }
  return table;
}

/// Two levels in one look-up: [state][two octants] -> next state << 6 | two places. 12 KB.
constexpr std::array<std::uint16_t, hilbert_states * 64> make_hilbert_table() {
  const auto octants = make_octant_table();
  std::array<std::uint16_t, hilbert_states * 64> table{};
  for (unsigned i = 0; i < table.size(); ++i) {
    const unsigned upper = octants[i / 64 * 8 + i / 8 % 8];
    const unsigned lower = octants[(upper >> 3) * 8 + i % 8];
    table[i] = static_cast<std::uint16_t>((lower >> 3) << 6 | (upper & 7) << 3 | (lower & 7));
  }
  return table;
}

inline constexpr auto hilbert_table = make_hilbert_table();

/// The low 21 bits of x, two zeros between each.
constexpr std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

}  // namespace detail

/// Place of a cell along the Hilbert curve through a cube of 2^bits cells a side: neighbours on the
/// curve are neighbours in space.
///
/// bits   even, at most 20; x, y, z < 2^bits
[[nodiscard]] constexpr std::uint64_t hilbert_key(std::uint32_t x,
                                                  std::uint32_t y,
                                                  std::uint32_t z,
                                                  int bits) {
  const std::uint64_t octants = detail::spread(x) | detail::spread(y) << 1 | detail::spread(z) << 2;
  std::uint64_t key = 0;
  unsigned state = 0;
  for (int shift = 3 * bits - 6; shift >= 0; shift -= 6) {
    const unsigned entry = detail::hilbert_table[state * 64 + ((octants >> shift) & 63)];
    state = entry >> 6;
    key = key << 6 | (entry & 63);
  }
  return key;
}

}  // namespace aib::search

// aib/search/curve.hpp

namespace aib::search {

/// A Hilbert curve through a cube of space. Points outside take the key of the nearest cell, so
/// that a few strays do not take the resolution from all others.
struct curve {
  Eigen::Vector3f low = Eigen::Vector3f::Zero();
  float cells_per_unit = 1;
  int bits = 14;        ///< per axis, even
  int index_bits = 22;  ///< what is left of 64 bits for the index of a point

  [[nodiscard]] std::uint64_t key(const Eigen::Vector3f& p) const {
    return hilbert_key(cell(p, 0), cell(p, 1), cell(p, 2), bits);
  }

 private:
  [[nodiscard]] std::uint32_t cell(const Eigen::Vector3f& p, int axis) const {
    const float last = static_cast<float>((1u << bits) - 1);
    const float place = (p[axis] - low[axis]) * cells_per_unit;
    return static_cast<std::uint32_t>(place > 0 ? std::min(place, last) : 0.0f);
  }
};

namespace detail {

/// Coordinates on one axis of at most 20 000 points of a cloud, evenly picked.
inline void sample_axis(std::span<const Eigen::Vector3f> points,
                        int axis,
                        std::vector<float>& values) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / 20000);
  for (std::size_t i = 0; i < points.size(); i += step) values.push_back(points[i][axis]);
}

struct interval {
  float low;
  float high;
};

/// From the 0.5 to the 99.5 percentile, and a tenth more on both sides.
inline interval bulk_of(std::vector<float>& values) {
  if (values.empty()) return {0, 0};
  const auto cut = static_cast<std::ptrdiff_t>(values.size() / 200);
  std::nth_element(values.begin(), values.begin() + cut, values.end());
  const float low = values[static_cast<std::size_t>(cut)];
  std::nth_element(values.begin(), values.end() - 1 - cut, values.end());
  const float high = *(values.end() - 1 - cut);
  const float margin = (high - low) / 10;
  return {low - margin, high + margin};
}

}  // namespace detail

/// The curve through the bulk of both clouds together.
[[nodiscard]] inline curve common_curve(std::span<const Eigen::Vector3f> a,
                                        std::span<const Eigen::Vector3f> b) {
  const std::size_t most = std::max<std::size_t>({a.size(), b.size(), 2});
  curve c;
  c.index_bits = static_cast<int>(std::bit_width(most - 1));
  c.bits = std::min(14, (64 - c.index_bits) / 3) & ~1;
  float extent = 0;
  std::vector<float> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    detail::sample_axis(a, axis, values);
    detail::sample_axis(b, axis, values);
    const detail::interval bulk = detail::bulk_of(values);
    c.low[axis] = bulk.low;
    extent = std::max(extent, bulk.high - bulk.low);
  }
  if (extent > 0) c.cells_per_unit = static_cast<float>((1u << c.bits) - 1) / extent;
  return c;
}

}  // namespace aib::search

// aib/search/radix_sort.hpp

namespace aib::search {

/// Bits [low, high) of a word.
struct bit_range {
  int low;
  int high;
};

namespace detail {

/// One stable counting pass: from `in` to `out` by the digit at `shift`.
inline void scatter_by_digit(const buffer<std::uint64_t>& in,
                             buffer<std::uint64_t>& out,
                             int shift,
                             int width,
                             unsigned threads,
                             const control& control) {
  const std::size_t digits = std::size_t{1} << width;
  const auto digit = [&](std::uint64_t word) { return (word >> shift) & (digits - 1); };
  const std::size_t share = (in.size() + threads - 1) / threads;
  std::vector<std::size_t> place(digits * threads, 0);  // [chunk][digit]
  for_each_chunk(in.size(), share, threads, control, [&](const chunk& c) {
    std::size_t* count = &place[digits * c.index];
    for (std::size_t i = c.begin; i < c.end; ++i) ++count[digit(in[i])];
  });
  std::size_t next = 0;
  for (std::size_t d = 0; d < digits; ++d) {
    for (std::size_t t = 0; t < threads; ++t) {
      next += std::exchange(place[digits * t + d], next);
    }
  }
  for_each_chunk(in.size(), share, threads, control, [&](const chunk& c) {
    std::size_t* to = &place[digits * c.index];
    for (std::size_t i = c.begin; i < c.end; ++i) out[to[digit(in[i])]++] = in[i];
  });
}

}  // namespace detail

/// Sorts words by some of their bits, equal ones in their order. Linear time; one copy of the words
/// beside them. `threads` >= 1.
inline void radix_sort(buffer<std::uint64_t>& words,
                       bit_range bits,
                       unsigned threads,
                       const control& control = {}) {
  const int total = bits.high - bits.low;
  if (total <= 0 || words.size() < 2) return;
  if (words.size() < 20000) threads = 1;
  const int passes = (total + 10) / 11;
  const int width = (total + passes - 1) / passes;
  buffer<std::uint64_t> other(words.size());
  for (int low = bits.low; low < bits.high; low += width) {
    detail::scatter_by_digit(words, other, low, std::min(width, bits.high - low), threads, control);
    std::swap(words, other);
  }
}

}  // namespace aib::search

// aib/search/box_tree.hpp

namespace aib::search {
inline namespace AIB_ISA {

/// Sixteen points that follow each other on the curve, coordinates side by side.
struct alignas(64) point_block {
  static constexpr std::size_t size = 16;
  float axis[3][size];
};

/// Boxes of eight children, coordinates side by side. A child that does not exist has an empty box,
/// infinitely far from everything.
struct alignas(32) box_node {
  static constexpr std::size_t width = 8;
  float low[3][width];
  float high[3][width];
};

/// Points in the order of a curve, in blocks of 16, under a tree of boxes without pointers: node i
/// of a level has the nodes (or, on level 0, the blocks) 8 i .. 8 i + 7 of the level below.
///
/// 18.2 bytes a point. Points must be finite and not empty.
class box_tree {
 public:
  box_tree(std::span<const Eigen::Vector3f> points,
           const curve& order,
           unsigned threads = 0,
           const control& control = {});

  [[nodiscard]] std::size_t size() const { return index_.size(); }

  /// The last block is filled up with its last point.
  [[nodiscard]] std::span<const point_block> blocks() const { return blocks_.span(); }

  /// Index of the point at a place on the curve.
  [[nodiscard]] std::span<const std::uint32_t> index() const { return index_.span(); }

  /// Curve key of the first point of each block.
  [[nodiscard]] std::span<const std::uint64_t> keys() const { return keys_.span(); }

  [[nodiscard]] std::size_t levels() const { return levels_.size(); }
  [[nodiscard]] std::span<const box_node> level(std::size_t l) const { return levels_[l].span(); }

  [[nodiscard]] std::size_t bytes() const;

 private:
  void fill_blocks(std::span<const Eigen::Vector3f> points,
                   const buffer<std::uint64_t>& sorted,
                   const curve& order,
                   unsigned threads,
                   const control& control);
  void build_levels(unsigned threads, const control& control);

  buffer<point_block> blocks_;
  buffer<std::uint32_t> index_;
  buffer<std::uint64_t> keys_;
  std::vector<buffer<box_node>> levels_;
};

/// Key and index of each point in one word, sorted by key, then index.
inline buffer<std::uint64_t> sort_along(std::span<const Eigen::Vector3f> points,
                                        const curve& order,
                                        unsigned threads,
                                        const control& control) {
  buffer<std::uint64_t> words(points.size());
  for_each_chunk(points.size(), 1 << 16, threads, control, [&](const chunk& c) {
    for (std::size_t i = c.begin; i < c.end; ++i) {
      words[i] = order.key(points[i]) << order.index_bits | i;
    }
  });
  radix_sort(words, {order.index_bits, order.index_bits + 3 * order.bits}, threads, control);
  return words;
}

inline box_tree::box_tree(std::span<const Eigen::Vector3f> points,
                          const curve& order,
                          unsigned threads,
                          const control& control) {
  if (threads == 0) threads = available_threads();
  const auto sorted = sort_along(points, order, threads, control);
  fill_blocks(points, sorted, order, threads, control);
  build_levels(threads, control);
}

inline void box_tree::fill_blocks(std::span<const Eigen::Vector3f> points,
                                  const buffer<std::uint64_t>& sorted,
                                  const curve& order,
                                  unsigned threads,
                                  const control& control) {
  constexpr std::size_t size = point_block::size;
  const std::size_t n = points.size();
  const std::uint64_t index_mask = (std::uint64_t{1} << order.index_bits) - 1;
  blocks_ = buffer<point_block>((n + size - 1) / size);
  index_ = buffer<std::uint32_t>(n);
  keys_ = buffer<std::uint64_t>(blocks_.size());
  for_each_chunk(blocks_.size(), 4096, threads, control, [&](const chunk& c) {
    for (std::size_t b = c.begin; b < c.end; ++b) {
      keys_[b] = sorted[b * size] >> order.index_bits;
      for (std::size_t j = 0; j < size; ++j) {
        const std::size_t place = std::min(b * size + j, n - 1);
        const auto i = static_cast<std::uint32_t>(sorted[place] & index_mask);
        index_[place] = i;
        for (int axis = 0; axis < 3; ++axis) blocks_[b].axis[axis][j] = points[i][axis];
      }
    }
  });
}

/// The range of a whole block on one axis, or of the eight children of a node.
inline std::pair<float, float> range_of(const point_block& block, int axis) {
  const f32x8 a = f32x8::load(block.axis[axis]);
  const f32x8 b = f32x8::load(block.axis[axis] + 8);
  return {lowest(min(a, b)), highest(max(a, b))};
}
inline std::pair<float, float> range_of(const box_node& node, int axis) {
  return {lowest(f32x8::load(node.low[axis])), highest(f32x8::load(node.high[axis]))};
}

/// The nodes above some blocks or nodes.
template <class Child>
buffer<box_node> boxes_above(std::span<const Child> children,
                             unsigned threads,
                             const control& control) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr std::size_t width = box_node::width;
  buffer<box_node> nodes((children.size() + width - 1) / width);
  for_each_chunk(nodes.size(), 4096, threads, control, [&](const chunk& c) {
    for (std::size_t i = c.begin * width; i < c.end * width; ++i) {
      box_node& node = nodes[i / width];
      for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] =
            i < children.size() ? range_of(children[i], axis) : std::pair{infinity, -infinity};
        node.low[axis][i % width] = low;
        node.high[axis][i % width] = high;
      }
    }
  });
  return nodes;
}

inline void box_tree::build_levels(unsigned threads, const control& control) {
  levels_.push_back(boxes_above(blocks(), threads, control));
  while (levels_.back().size() > 1) {
    levels_.push_back(boxes_above(levels_.back().span(), threads, control));
  }
}

inline std::size_t box_tree::bytes() const {
  std::size_t total = blocks_.size() * sizeof(point_block) + index_.size() * sizeof(std::uint32_t) +
                      keys_.size() * sizeof(std::uint64_t);
  for (const auto& level : levels_) total += level.size() * sizeof(box_node);
  return total;
}

}  // namespace AIB_ISA
}  // namespace aib::search

// aib/search/nearest_one.hpp

namespace aib::search {
inline namespace AIB_ISA {

/// Squared length in the one order of operations that all searches use: rounding is monotone, so a
/// box never seems farther than a point in it, and pruning loses no nearest neighbour.
inline f32x8 squared_length(f32x8 x, f32x8 y, f32x8 z) { return (x * x + y * y) + z * z; }

/// Eight-fold a point.
struct query {
  f32x8 axis[3];

  query(float x, float y, float z)
      : axis{f32x8::broadcast(x), f32x8::broadcast(y), f32x8::broadcast(z)} {}
};

/// Squared distances from points in [low, high] (equal for a single point) to the eight boxes.
inline f32x8 squared_distances(const f32x8* low, const f32x8* high, const box_node& node) {
  f32x8 gap[3];
  for (int k = 0; k < 3; ++k) {
    const f32x8 before = f32x8::load(node.low[k]) - high[k];
    const f32x8 behind = low[k] - f32x8::load(node.high[k]);
    gap[k] = max(max(before, behind), f32x8::broadcast(0));
  }
  return squared_length(gap[0], gap[1], gap[2]);
}

/// Squared distances from a point to eight points of a block, from `first` on.
inline f32x8 squared_distances(const query& q, const point_block& block, std::size_t first) {
  return squared_length(q.axis[0] - f32x8::load(block.axis[0] + first),
                        q.axis[1] - f32x8::load(block.axis[1] + first),
                        q.axis[2] - f32x8::load(block.axis[2] + first));
}

/// A node or block that waits to be visited, and how far it is.
struct pending_box {
  float squared;
  std::uint32_t level;  ///< of the box's children; `leaf` for a block or triangle
  std::uint32_t index;

  static constexpr std::uint32_t leaf = ~0u;
};

/// Boxes that wait, the nearest child of the last visited node on top. Eight children a level and
/// eleven levels (2^32 points) never fill it.
class pending_boxes {
 public:
  [[nodiscard]] bool empty() const { return size_ == 0; }
  pending_box pop() { return boxes_[--size_]; }
  void push_root(std::size_t levels) {
    boxes_[size_++] = {0, static_cast<std::uint32_t>(levels - 1), 0};
  }

  /// The children of a node whose bits are set in `mask`, farthest first.
  void push_children(const pending_box& node, f32x8 squared, unsigned mask) {
    float distance[8];
    squared.store(distance);
    const std::size_t bottom = size_;
    const std::uint32_t level = node.level == 0 ? pending_box::leaf : node.level - 1;
    for (; mask != 0; mask &= mask - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(mask));
      std::size_t place = size_++;
      for (; place > bottom && boxes_[place - 1].squared < distance[lane]; --place) {
        boxes_[place] = boxes_[place - 1];
      }
      boxes_[place] = {distance[lane], level, node.index * 8 + lane};
    }
  }

 private:
  pending_box boxes_[96];
  std::size_t size_ = 0;
};

/// The smaller of `bound` and the squared distance from a point to its nearest neighbour.
///
/// near_block   a block to begin with; becomes the block of the neighbour where one was found
inline float nearest_one(const box_tree& tree,
                         const query& q,
                         float bound,
                         std::uint32_t& near_block) {
  const auto visit = [&](std::uint32_t b) {
    const point_block& block = tree.blocks()[b];
    const float least = lowest(min(squared_distances(q, block, 0), squared_distances(q, block, 8)));
    if (least < bound) {
      bound = least;
      near_block = b;
    }
  };
  visit(near_block);
  pending_boxes pending;
  pending.push_root(tree.levels());
  while (!pending.empty()) {
    const pending_box box = pending.pop();
    if (!(box.squared < bound)) continue;
    if (box.level == pending_box::leaf) {
      visit(box.index);
    } else {
      const f32x8 d = squared_distances(q.axis, q.axis, tree.level(box.level)[box.index]);
      pending.push_children(box, d, less(d, f32x8::broadcast(bound)));
    }
  }
  return bound;
}

}  // namespace AIB_ISA
}  // namespace aib::search

// aib/search/nearest_packet.hpp

namespace aib::search {
inline namespace AIB_ISA {

/// Sixteen queries, a lane each, and the squared distances known so far.
struct packet {
  static constexpr std::size_t size = 16;
  f32x8 axis[3][2];
  f32x8 best[2];

  /// Takes the sixteen points of a block into account.
  void visit(const point_block& block) {
    for (std::size_t j = 0; j < point_block::size; ++j) {
      const f32x8 x = f32x8::broadcast(block.axis[0][j]);
      const f32x8 y = f32x8::broadcast(block.axis[1][j]);
      const f32x8 z = f32x8::broadcast(block.axis[2][j]);
      for (int v = 0; v < 2; ++v) {
        best[v] = min(best[v], squared_length(axis[0][v] - x, axis[1][v] - y, axis[2][v] - z));
      }
    }
  }
};

/// Nearest neighbours of up to 256 queries that follow each other on the curve. They share one walk
/// through the tree, which lists the blocks that any of them may need; each packet then goes
/// through the list. Queries that lie far from the cloud would make the list long for all: they are
/// searched alone.
class super_packet {
 public:
  static constexpr std::size_t packets = 16;
  static constexpr std::size_t lanes = packets * packet::size;

  super_packet(const box_tree& tree, float bound) : tree_(tree), bound_(bound) {}

  /// The smaller of the bound and the squared distance of each query, in the order of the blocks.
  ///
  /// queries   1 .. 16 blocks
  /// start     for each of them a block of the tree that is probably near
  std::span<const float> search(std::span<const point_block> queries, const std::uint32_t* start);

 private:
  /// A lane is searched alone when its squared distance to the starting blocks is beyond this many
  /// times the median; a walk that lists more blocks than the limit is given up for searches alone.
  static constexpr float stray_factor = 25;
  static constexpr std::size_t most_candidates = 512;

  void load(std::span<const point_block> queries);
  void visit_start(const std::uint32_t* start);
  void search_strays(std::uint32_t near_block);
  bool list_candidates();
  void add_candidate(const box_node& node, std::size_t lane, std::uint32_t block);
  void pad_candidates();
  void visit_candidates(std::size_t packet_index, std::uint32_t start);
  void search_all_alone(std::uint32_t near_block);

  [[nodiscard]] float stray_threshold() const;
  [[nodiscard]] query lane(std::size_t i) const { return {axis_[0][i], axis_[1][i], axis_[2][i]}; }
  [[nodiscard]] packet load_packet(std::size_t p) const;
  void store_best(std::size_t p, const packet& q);
  [[nodiscard]] static bool may_improve(const packet& q,
                                        const float (&low)[3],
                                        const float (&high)[3]);

  const box_tree& tree_;
  float bound_;
  std::size_t count_ = 0;  ///< lanes in use, a multiple of 16
  alignas(64) float axis_[3][lanes];
  alignas(64) float best_[lanes];
  float found_alone_[lanes];
  bool stray_[lanes];

  std::size_t candidates_ = 0;
  alignas(64) float low_[3][most_candidates + 16];
  alignas(64) float high_[3][most_candidates + 16];
  std::uint32_t block_[most_candidates + 16];
};

/// The box of some lanes, each bound in all eight lanes.
struct lane_box {
  f32x8 low[3];
  f32x8 high[3];
};

inline std::span<const float> super_packet::search(std::span<const point_block> queries,
                                                   const std::uint32_t* start) {
  load(queries);
  visit_start(start);
  search_strays(start[0]);
  if (list_candidates()) {
    for (std::size_t p = 0; p < queries.size(); ++p) visit_candidates(p, start[p]);
  } else {
    search_all_alone(start[0]);
  }
  for (std::size_t i = 0; i < count_; ++i) {
    if (stray_[i]) best_[i] = found_alone_[i];
  }
  return {best_, count_};
}

inline void super_packet::load(std::span<const point_block> queries) {
  count_ = queries.size() * packet::size;
  for (std::size_t p = 0; p < queries.size(); ++p) {
    for (int k = 0; k < 3; ++k) {
      std::copy_n(queries[p].axis[k], packet::size, axis_[k] + p * packet::size);
    }
  }
}

inline packet super_packet::load_packet(std::size_t p) const {
  packet q;
  for (std::size_t v = 0; v < 2; ++v) {
    const std::size_t lane = p * packet::size + 8 * v;
    for (int k = 0; k < 3; ++k) q.axis[k][v] = f32x8::load(axis_[k] + lane);
    q.best[v] = f32x8::load(best_ + lane);
  }
  return q;
}

inline void super_packet::store_best(std::size_t p, const packet& q) {
  for (std::size_t v = 0; v < 2; ++v) q.best[v].store(best_ + p * packet::size + 8 * v);
}

/// Each packet looks at the block that the curve leads it to and at its two neighbours.
inline void super_packet::visit_start(const std::uint32_t* start) {
  const auto last = static_cast<std::uint32_t>(tree_.blocks().size() - 1);
  std::fill_n(best_, count_, bound_);
  for (std::size_t p = 0; p < count_ / packet::size; ++p) {
    packet q = load_packet(p);
    const std::uint32_t from = start[p] > 0 ? start[p] - 1 : 0;
    const std::uint32_t to = std::min(last, start[p] + 1);
    for (std::uint32_t b = from; b <= to; ++b) q.visit(tree_.blocks()[b]);
    store_best(p, q);
  }
}

inline float super_packet::stray_threshold() const {
  float sample[lanes / 5 + 1];
  std::size_t n = 0;
  for (std::size_t i = 0; i < count_; i += 5) sample[n++] = best_[i];
  std::nth_element(sample, sample + n / 2, sample + n);
  return sample[n / 2] * stray_factor;
}

/// Strays are searched alone and then hidden behind a neighbour that is none, so that the box of
/// the queries stays tight.
inline void super_packet::search_strays(std::uint32_t near_block) {
  const float threshold = stray_threshold();
  std::size_t keeper = count_;
  for (std::size_t i = count_; i-- > 0;) {
    stray_[i] = best_[i] > threshold;
    if (!stray_[i]) keeper = i;
  }
  for (std::size_t i = 0; i < count_; ++i) {
    if (!stray_[i]) {
      keeper = i;
      continue;
    }
    found_alone_[i] = nearest_one(tree_, lane(i), best_[i], near_block);
    for (auto& axis : axis_) axis[i] = axis[keeper];
    best_[i] = best_[keeper];
  }
}

/// The box of n lanes (a multiple of 8).
inline lane_box box_of(const float* x, const float* y, const float* z, std::size_t n) {
  lane_box box;
  const float* axis[3] = {x, y, z};
  for (int k = 0; k < 3; ++k) {
    f32x8 low = f32x8::load(axis[k]);
    f32x8 high = low;
    for (std::size_t i = 8; i < n; i += 8) {
      const f32x8 a = f32x8::load(axis[k] + i);
      low = min(low, a);
      high = max(high, a);
    }
    box.low[k] = f32x8::broadcast(lowest(low));
    box.high[k] = f32x8::broadcast(highest(high));
  }
  return box;
}

/// Lists the blocks nearer to the box of all queries than the worst of them needs. False where
/// there are too many.
inline bool super_packet::list_candidates() {
  const lane_box box = box_of(axis_[0], axis_[1], axis_[2], count_);
  const f32x8 worst = f32x8::broadcast(*std::max_element(best_, best_ + count_));
  candidates_ = 0;
  struct place {
    std::uint32_t level, index;
  } pending[96];
  std::size_t size = 0;
  pending[size++] = {static_cast<std::uint32_t>(tree_.levels() - 1), 0};
  while (size > 0) {
    const place at = pending[--size];
    const box_node& node = tree_.level(at.level)[at.index];
    unsigned mask = less(squared_distances(box.low, box.high, node), worst);
    if (at.level == 0 && candidates_ > most_candidates) return false;
    for (; mask != 0; mask &= mask - 1) {
      const auto child = static_cast<std::uint32_t>(std::countr_zero(mask));
      if (at.level == 0) {
        add_candidate(node, child, at.index * 8 + child);
      } else {
        pending[size++] = {at.level - 1, at.index * 8 + child};
      }
    }
  }
  pad_candidates();
  return true;
}

inline void super_packet::add_candidate(const box_node& node,
                                        std::size_t lane,
                                        std::uint32_t block) {
  for (int k = 0; k < 3; ++k) {
    low_[k][candidates_] = node.low[k][lane];
    high_[k][candidates_] = node.high[k][lane];
  }
  block_[candidates_++] = block;
}

/// Fills the list up to a multiple of eight with boxes that nobody needs.
inline void super_packet::pad_candidates() {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (; candidates_ % 8 != 0; ++candidates_) {
    for (int k = 0; k < 3; ++k) {
      low_[k][candidates_] = infinity;
      high_[k][candidates_] = -infinity;
    }
  }
}

/// Whether a box is nearer to any of the sixteen queries than what that one has.
inline bool super_packet::may_improve(const packet& q,
                                      const float (&low)[3],
                                      const float (&high)[3]) {
  unsigned any = 0;
  for (int v = 0; v < 2; ++v) {
    f32x8 gap[3];
    for (int k = 0; k < 3; ++k) {
      const f32x8 before = f32x8::broadcast(low[k]) - q.axis[k][v];
      const f32x8 behind = q.axis[k][v] - f32x8::broadcast(high[k]);
      gap[k] = max(max(before, behind), f32x8::broadcast(0));
    }
    any |= less(squared_length(gap[0], gap[1], gap[2]), q.best[v]);
  }
  return any != 0;
}

inline void super_packet::visit_candidates(std::size_t p, std::uint32_t start) {
  const std::size_t first = p * packet::size;
  const lane_box box = box_of(axis_[0] + first, axis_[1] + first, axis_[2] + first, packet::size);
  packet q = load_packet(p);
  const f32x8 worst = f32x8::broadcast(highest(max(q.best[0], q.best[1])));
  for (std::size_t i = 0; i < candidates_; i += 8) {
    f32x8 gap[3];
    for (int k = 0; k < 3; ++k) {
      const f32x8 before = f32x8::load(low_[k] + i) - box.high[k];
      const f32x8 behind = box.low[k] - f32x8::load(high_[k] + i);
      gap[k] = max(max(before, behind), f32x8::broadcast(0));
    }
    unsigned mask = less(squared_length(gap[0], gap[1], gap[2]), worst);
    for (; mask != 0; mask &= mask - 1) {
      const std::size_t c = i + static_cast<std::size_t>(std::countr_zero(mask));
      const bool seen = block_[c] + 1 >= start && block_[c] <= start + 1;
      if (!seen && may_improve(q, {low_[0][c], low_[1][c], low_[2][c]},
                               {high_[0][c], high_[1][c], high_[2][c]})) {
        q.visit(tree_.blocks()[block_[c]]);
      }
    }
  }
  store_best(p, q);
}

inline void super_packet::search_all_alone(std::uint32_t near_block) {
  for (std::size_t i = 0; i < count_; ++i) {
    if (!stray_[i]) best_[i] = nearest_one(tree_, lane(i), best_[i], near_block);
  }
}

}  // namespace AIB_ISA
}  // namespace aib::search

// aib/search/nearest.hpp

namespace aib::search {

struct nearest_options {
  /// Squared distances are searched below this bound only; a query without such a neighbour gets
  /// the bound itself.
  float squared_bound = std::numeric_limits<float>::infinity();
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

inline namespace AIB_ISA {

/// Squared distance from each point of `queries` to its nearest neighbour in `targets`, in the
/// order in which the points of `queries` were given.
///
/// Bit-equal to the minimum of (dx dx + dy dy) + dz dz in float over all targets, for any
/// instruction set and number of threads. Both trees are built along one curve (`common_curve`).
///
/// Source of the idea: all-nearest-neighbour search by dual traversal, Gray and Moore, "N-body
/// problems in statistical learning", NIPS 2000.
std::vector<float> nearest_squared(const box_tree& queries,
                                   const box_tree& targets,
                                   const nearest_options& options = {});

/// For each block of queries the block of targets in which its middle lies on the curve: the two
/// trees are merged like sorted lists.
class curve_merge {
 public:
  curve_merge(const box_tree& queries, const box_tree& targets, std::size_t first_block)
      : queries_(queries.keys()), targets_(targets.keys()) {
    const auto after = std::upper_bound(targets_.begin(), targets_.end(), queries_[first_block]);
    place_ = after == targets_.begin() ? 0 : static_cast<std::size_t>(after - targets_.begin()) - 1;
  }

  /// Blocks are asked for in order.
  std::uint32_t start_of(std::size_t block) {
    std::uint64_t key = queries_[block];
    if (block + 1 < queries_.size()) key += (queries_[block + 1] - key) / 2;
    while (place_ + 1 < targets_.size() && targets_[place_ + 1] <= key) ++place_;
    return static_cast<std::uint32_t>(place_);
  }

 private:
  std::span<const std::uint64_t> queries_, targets_;
  std::size_t place_ = 0;
};

inline std::vector<float> nearest_squared(const box_tree& queries,
                                          const box_tree& targets,
                                          const nearest_options& options) {
  constexpr std::size_t group = super_packet::packets;
  std::vector<float> squared(queries.size());
  const std::size_t n_blocks = queries.blocks().size();
  for_each_chunk(n_blocks, 32 * group, options.threads, options.control, [&](const chunk& c) {
    const auto search = std::make_unique<super_packet>(targets, options.squared_bound);
    curve_merge merge(queries, targets, c.begin);
    for (std::size_t first = c.begin; first < c.end; first += group) {
      const std::size_t count = std::min(group, c.end - first);
      std::uint32_t start[group] = {};
      for (std::size_t b = 0; b < count; ++b) start[b] = merge.start_of(first + b);
      const auto found = search->search(queries.blocks().subspan(first, count), start);
      const auto index = queries.index().subspan(first * point_block::size);
      const std::size_t used = std::min(found.size(), index.size());
      for (std::size_t i = 0; i < used; ++i) squared[index[i]] = found[i];
    }
  });
  return squared;
}

}  // namespace AIB_ISA
}  // namespace aib::search

// aib/stats/histogram.hpp

namespace aib::stats {

/// Counts of values in equal bins on [low, high), mergeable. Values outside are counted, not
/// dropped.
class histogram {
 public:
  /// Throws argument_error unless low < high and bins > 0.
  histogram(double low, double high, std::size_t bins) : low_(low), high_(high), counts_(bins) {
    if (!(low < high) || bins == 0) {
      throw argument_error(message("stats::histogram: low < high and bins > 0 expected, found ",
                                   low, ", ", high, ", ", bins));
    }
  }

  /// A NaN counts as above.
  void add(double value) {
    if (value < low_) {
      ++below_;
    } else if (value < high_) {
      const double place = (value - low_) / (high_ - low_) * static_cast<double>(counts_.size());
      ++counts_[std::min(static_cast<std::size_t>(place), counts_.size() - 1)];
    } else {
      ++above_;
    }
  }

  /// Throws argument_error if the bins differ.
  histogram& operator+=(const histogram& other) {
    if (other.low_ != low_ || other.high_ != high_ || other.counts_.size() != counts_.size()) {
      throw argument_error("stats::histogram: the bins of merged histograms differ");
    }
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
    below_ += other.below_;
    above_ += other.above_;
    return *this;
  }

  [[nodiscard]] const std::vector<std::uint64_t>& counts() const { return counts_; }
  [[nodiscard]] std::uint64_t below() const { return below_; }
  [[nodiscard]] std::uint64_t above() const { return above_; }
  [[nodiscard]] std::uint64_t total() const {
    std::uint64_t n = below_ + above_;
    for (const std::uint64_t c : counts_) n += c;
    return n;
  }
  /// Lower edge of bin i; edge(bins) is the upper end.
  [[nodiscard]] double edge(std::size_t i) const {
    return low_ + (high_ - low_) * static_cast<double>(i) / static_cast<double>(counts_.size());
  }

 private:
  double low_, high_;
  std::vector<std::uint64_t> counts_;
  std::uint64_t below_ = 0;
  std::uint64_t above_ = 0;
};

}  // namespace aib::stats

// aib/cloud/distances.hpp

namespace aib::cloud {

/// What becomes of a distance that is not below the maximum.
enum class maximum_rule {
  drop,   ///< left out of all statistics but shares (DTU)
  clamp,  ///< counts as the maximum (CloudCompare)
};

struct distance_options {
  std::optional<double> max_distance = {};  ///< none: every distance counts as it is
  maximum_rule rule = maximum_rule::drop;
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

inline namespace AIB_ISA {

/// Distances from each point of a cloud to another thing, with their statistics.
///
/// Statistics throw undefined_error where no distance counts.
class distances {
 public:
  /// Distance from each point to its nearest neighbour, Euclidean, exact in float: both clouds are
  /// brought to one origin in double first.
  ///
  /// Throws undefined_error if either cloud has no finite point, argument_error if max_distance is
  /// not positive.
  distances(const cloud& from, const cloud& to, const distance_options& options = {});

  /// Distances that are known: NaN for a point that had none, any value >= max_distance where it is
  /// that far or farther.
  explicit distances(std::vector<float> values, const distance_options& options = {});

  /// One value a point of the cloud, in its order: NaN for a point that is not finite; beyond the
  /// maximum +infinity (drop) or the maximum (clamp).
  [[nodiscard]] std::span<const float> values() const { return values_; }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] float operator[](std::size_t i) const { return values_[i]; }

  [[nodiscard]] std::size_t n_dropped() const { return n_dropped_; }  ///< not finite
  [[nodiscard]] std::size_t n_beyond() const { return n_beyond_; }    ///< not below max_distance
  [[nodiscard]] std::size_t n_finite() const { return size() - n_dropped_; }
  [[nodiscard]] double share_beyond() const;  ///< of the finite points

  [[nodiscard]] double mean() const;
  [[nodiscard]] double rmse() const;
  [[nodiscard]] double max() const;
  [[nodiscard]] double median() const { return quantile(0.5); }
  /// q in [0, 1], interpolated linearly.
  [[nodiscard]] double quantile(double q) const;

  /// Counts of the distances in equal bins on [0, high). Points beyond the maximum count as above
  /// it with `drop`, as the maximum with `clamp`; those that are not finite are left out.
  [[nodiscard]] stats::histogram histogram(double high, std::size_t bins) const;

  /// Share of the finite points whose distance is strictly below tau. Points beyond the maximum are
  /// in the denominator. Throws argument_error if tau is above the maximum.
  [[nodiscard]] double share_below(double tau) const;

  /// The same for several thresholds, in their order, from one pass.
  [[nodiscard]] std::vector<double> shares_below(std::span<const double> tau) const;

 private:
  void apply_maximum();
  void summarize();
  [[nodiscard]] std::size_t n_counted() const;
  void demand_values(const char* what) const;

  std::vector<float> values_;
  distance_options options_;
  std::size_t n_dropped_ = 0;
  std::size_t n_beyond_ = 0;
  double sum_ = 0;
  double sum_of_squares_ = 0;
  double max_ = 0;
};

}  // namespace AIB_ISA

namespace detail {

inline constexpr std::size_t value_chunk = 1 << 16;

inline void demand_points(const char* function, const char* which, const finite_points& p) {
  if (p.points().empty()) {
    throw undefined_error(message(function, ": no finite point in the ", which, " cloud (",
                                  p.n_given(), " points, ", p.n_dropped(), " not finite)"));
  }
}

inline void check_maximum(const distance_options& options) {
  if (options.max_distance && !(*options.max_distance > 0)) {
    throw argument_error(
        message("cloud::distances: max_distance > 0 expected, found ", *options.max_distance));
  }
}

inline void check_tau(double tau, const distance_options& options) {
  if (!options.max_distance || tau <= *options.max_distance) return;
  throw argument_error(
      message("cloud::distances: tau ", tau, " is above max_distance ", *options.max_distance));
}

/// Whether distances beyond the maximum are left out.
inline bool drops(const distance_options& options) {
  return options.max_distance && options.rule == maximum_rule::drop;
}

/// Makes of distances not below the maximum what the rule says; returns how many there are.
inline std::size_t cut_at_maximum(std::span<float> values, const distance_options& options) {
  if (!options.max_distance) return 0;
  const float beyond = drops(options) ? std::numeric_limits<float>::infinity()
                                      : static_cast<float>(*options.max_distance);
  std::size_t n = 0;
  for (float& value : values) {
    if (static_cast<double>(value) >= *options.max_distance) {
      value = beyond;
      ++n;
    }
  }
  return n;
}

/// Sums over a chunk of distances; those of chunks are added in order.
struct distance_sums {
  std::size_t dropped = 0;
  double sum = 0, squares = 0, max = 0;

  distance_sums& operator+=(const distance_sums& other) {
    dropped += other.dropped;
    sum += other.sum;
    squares += other.squares;
    max = std::max(max, other.max);
    return *this;
  }
};

inline distance_sums sums_of(std::span<const float> values, const distance_options& options) {
  const bool skip_infinite = drops(options);
  distance_sums s;
  for (const float value : values) {
    const double d = value;
    if (std::isnan(d)) ++s.dropped;
    if (std::isnan(d) || (skip_infinite && std::isinf(d))) continue;
    s.sum += d;
    s.squares += d * d;
    s.max = std::max(s.max, d);
  }
  return s;
}

/// A float not below the square of the largest distance that counts.
inline float squared_bound(const distance_options& options) {
  if (!options.max_distance) return std::numeric_limits<float>::infinity();
  const double reach = *options.max_distance * (1 + 1e-6);
  const double largest = std::numeric_limits<float>::max();
  return static_cast<float>(std::min(reach * reach, largest));
}

/// Distances in the order of the cloud, of squares in the order of its finite points.
inline std::vector<float> roots_in_place(const finite_points& from, std::vector<float> squared) {
  for (float& d : squared) d = std::sqrt(d);
  if (from.n_dropped() == 0) return squared;
  std::vector<float> values(from.n_given(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < squared.size(); ++i) values[from.source_index(i)] = squared[i];
  return values;
}

inline search::nearest_options search_options(const distance_options& options) {
  return {.squared_bound = squared_bound(options),
          .threads = options.threads,
          .control = options.control};
}

}  // namespace detail

inline namespace AIB_ISA {

inline distances::distances(const cloud& from, const cloud& to, const distance_options& options)
    : options_(options) {
  detail::check_maximum(options);
  const finite_points a(from, to.origin);
  const finite_points b(to, to.origin);
  detail::demand_points("cloud::distances", "first", a);
  detail::demand_points("cloud::distances", "second", b);
  const search::curve order = search::common_curve(a.points(), b.points());
  const search::box_tree queries(a.points(), order, options.threads, options.control);
  const search::box_tree targets(b.points(), order, options.threads, options.control);
  values_ = detail::roots_in_place(
      a, search::nearest_squared(queries, targets, detail::search_options(options)));
  apply_maximum();
  summarize();
}

inline distances::distances(std::vector<float> values, const distance_options& options)
    : values_(std::move(values)), options_(options) {
  detail::check_maximum(options);
  apply_maximum();
  summarize();
}

inline void distances::apply_maximum() { n_beyond_ = detail::cut_at_maximum(values_, options_); }

inline void distances::summarize() {
  const auto sum_chunk = [&](const chunk& c) {
    return detail::sums_of(values().subspan(c.begin, c.end - c.begin), options_);
  };
  const auto total = reduce_chunks(values_.size(), detail::value_chunk, options_.threads, {},
                                   detail::distance_sums{}, sum_chunk,
                                   [](auto a, const auto& b) { return a += b; });
  n_dropped_ = total.dropped;
  sum_ = total.sum;
  sum_of_squares_ = total.squares;
  max_ = total.max;
}

inline std::size_t distances::n_counted() const {
  const bool drop = options_.max_distance && options_.rule == maximum_rule::drop;
  return n_finite() - (drop ? n_beyond_ : 0);
}

inline void distances::demand_values(const char* what) const {
  if (n_counted() > 0) return;
  throw undefined_error(message("cloud::distances: no distance to take the ", what, " of (", size(),
                                " points, ", n_dropped_, " not finite, ", n_beyond_,
                                " beyond max_distance)"));
}

inline double distances::share_beyond() const {
  if (n_finite() == 0) demand_values("share");
  return static_cast<double>(n_beyond_) / static_cast<double>(n_finite());
}

inline double distances::mean() const {
  demand_values("mean");
  return sum_ / static_cast<double>(n_counted());
}

inline double distances::rmse() const {
  demand_values("root mean square");
  return std::sqrt(sum_of_squares_ / static_cast<double>(n_counted()));
}

inline double distances::max() const {
  demand_values("maximum");
  return max_;
}

inline double distances::quantile(double q) const {
  demand_values("quantile");
  std::vector<float> counted;
  counted.reserve(n_counted());
  const bool all = n_counted() == n_finite();
  std::copy_if(values_.begin(), values_.end(), std::back_inserter(counted),
               [&](float d) { return !std::isnan(d) && (all || !std::isinf(d)); });
  return stats::quantile_in_place<float>(counted, q);
}

inline stats::histogram distances::histogram(double high, std::size_t bins) const {
  stats::histogram counts(0, high, bins);
  for (const float d : values_) {
    if (!std::isnan(d)) counts.add(d);
  }
  return counts;
}

inline std::vector<double> distances::shares_below(std::span<const double> tau) const {
  if (n_finite() == 0) demand_values("share");
  for (const double t : tau) detail::check_tau(t, options_);
  std::vector<double> ascending(tau.begin(), tau.end());
  std::sort(ascending.begin(), ascending.end());
  const auto first_above = [&](double d) {
    const auto above = std::upper_bound(ascending.begin(), ascending.end(), d);
    return static_cast<std::size_t>(above - ascending.begin());
  };
  using counts = std::vector<std::size_t>;  // of values whose first threshold above is this one
  const auto count_chunk = [&](const chunk& c) {
    counts n(tau.size() + 1);
    for (std::size_t i = c.begin; i < c.end; ++i) {
      if (!std::isnan(values_[i])) ++n[first_above(values_[i])];
    }
    return n;
  };
  const auto add = [](counts a, const counts& b) {
    for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
    return a;
  };
  counts below = reduce_chunks(values_.size(), detail::value_chunk, options_.threads, {},
                               counts(tau.size() + 1), count_chunk, add);
  for (std::size_t k = 1; k < below.size(); ++k) below[k] += below[k - 1];
  std::vector<double> share;
  for (const double t : tau) {
    const auto place = std::lower_bound(ascending.begin(), ascending.end(), t) - ascending.begin();
    share.push_back(static_cast<double>(below[static_cast<std::size_t>(place)]) /
                    static_cast<double>(n_finite()));
  }
  return share;
}

inline double distances::share_below(double tau) const {
  return shares_below(std::span(&tau, 1)).front();
}

}  // namespace AIB_ISA
}  // namespace aib::cloud

// aib/cloud/compare.hpp

namespace aib::cloud {

struct compare_options {
  std::vector<double> tau = {};             ///< thresholds of precision, recall and F-score
  std::optional<double> max_distance = {};  ///< none: every distance counts as it is
  maximum_rule rule = maximum_rule::drop;
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

/// Scores at one threshold.
/// Source: Knapitsch et al., "Tanks and Temples", SIGGRAPH 2017, section 4.
struct threshold_scores {
  double tau;
  double precision;  ///< share of the estimate strictly below tau of the reference
  double recall;     ///< share of the reference strictly below tau of the estimate
  double f_score;    ///< harmonic mean of both; 0 where both are 0
};

/// How an estimated cloud differs from a reference. Lengths in the unit of the clouds.
struct comparison {
  double accuracy;      ///< mean distance from the estimate to the reference
  double completeness;  ///< mean distance from the reference to the estimate
  double chamfer;       ///< sum of both
  double chamfer_mean;  ///< half of it
  double f1_distance;   ///< harmonic mean of both, a length; 0 where both are 0
  double accuracy_median;
  double completeness_median;
  double accuracy_rmse;
  double completeness_rmse;
  double hausdorff;                      ///< the larger of both directed maxima
  std::vector<threshold_scores> scores;  ///< one a threshold, in the order asked for
  std::size_t n_estimate;                ///< points that were compared
  std::size_t n_reference;
  std::size_t n_dropped;    ///< points of both clouds that are not finite
  double estimate_beyond;   ///< share of the estimate not below max_distance
  double reference_beyond;  ///< share of the reference not below max_distance
};

/// Distances of the points of a cloud, in memory or not, that know their statistics.
template <class T>
concept distance_statistics = requires(const T& d, std::span<const double> tau) {
  { d.mean() } -> std::convertible_to<double>;
  { d.median() } -> std::convertible_to<double>;
  { d.rmse() } -> std::convertible_to<double>;
  { d.max() } -> std::convertible_to<double>;
  { d.n_finite() } -> std::convertible_to<std::size_t>;
  { d.n_dropped() } -> std::convertible_to<std::size_t>;
  { d.share_beyond() } -> std::convertible_to<double>;
  { d.shares_below(tau) } -> std::convertible_to<std::vector<double>>;
};

namespace detail {

inline double harmonic_mean(double a, double b) { return a + b > 0 ? 2 * a * b / (a + b) : 0; }

}  // namespace detail

inline namespace AIB_ISA {

/// Distances in both directions, each cloud sorted and indexed once.
struct two_way_distances {
  distances to_reference;  ///< of the points of the estimate
  distances to_estimate;   ///< of the points of the reference
};

/// Distances from the estimate to the reference and back.
/// Throws undefined_error if either cloud has no finite point.
[[nodiscard]] inline two_way_distances distances_both_ways(const cloud& estimate,
                                                           const cloud& reference,
                                                           const distance_options& options = {}) {
  detail::check_maximum(options);
  const finite_points e(estimate, reference.origin);
  const finite_points r(reference, reference.origin);
  detail::demand_points("cloud::compare", "estimated", e);
  detail::demand_points("cloud::compare", "reference", r);
  const search::curve order = search::common_curve(e.points(), r.points());
  const search::box_tree e_tree(e.points(), order, options.threads, options.control);
  const search::box_tree r_tree(r.points(), order, options.threads, options.control);
  const auto search = detail::search_options(options);
  return {distances(detail::roots_in_place(e, search::nearest_squared(e_tree, r_tree, search)),
                    options),
          distances(detail::roots_in_place(r, search::nearest_squared(r_tree, e_tree, search)),
                    options)};
}

/// Precision, recall and F-score at thresholds, in their order: with many of them, a curve.
template <distance_statistics Distances>
[[nodiscard]] std::vector<threshold_scores> scores_at(const Distances& to_reference,
                                                      const Distances& to_estimate,
                                                      std::span<const double> tau) {
  const auto precision = to_reference.shares_below(tau);
  const auto recall = to_estimate.shares_below(tau);
  std::vector<threshold_scores> scores;
  for (std::size_t i = 0; i < tau.size(); ++i) {
    scores.push_back(
        {tau[i], precision[i], recall[i], detail::harmonic_mean(precision[i], recall[i])});
  }
  return scores;
}

/// The scores of distances in both directions, wherever they come from.
template <distance_statistics Distances>
[[nodiscard]] comparison score(const Distances& to_reference,
                               const Distances& to_estimate,
                               std::span<const double> tau = {}) {
  const double accuracy = to_reference.mean();
  const double completeness = to_estimate.mean();
  comparison c{.accuracy = accuracy,
               .completeness = completeness,
               .chamfer = accuracy + completeness,
               .chamfer_mean = (accuracy + completeness) / 2,
               .f1_distance = detail::harmonic_mean(accuracy, completeness),
               .accuracy_median = to_reference.median(),
               .completeness_median = to_estimate.median(),
               .accuracy_rmse = to_reference.rmse(),
               .completeness_rmse = to_estimate.rmse(),
               .hausdorff = std::max(to_reference.max(), to_estimate.max()),
               .scores = {},
               .n_estimate = to_reference.n_finite(),
               .n_reference = to_estimate.n_finite(),
               .n_dropped = to_reference.n_dropped() + to_estimate.n_dropped(),
               .estimate_beyond = to_reference.share_beyond(),
               .reference_beyond = to_estimate.share_beyond()};
  c.scores = scores_at(to_reference, to_estimate, tau);
  return c;
}

/// Compares an estimated cloud with a reference: every metric of point clouds from one search.
///
/// Nothing is aligned. A reference sampled from a surface puts a floor under accuracy, see
/// sample::mesh; mesh::compare has none.
/// Throws undefined_error if either cloud has no finite point, argument_error if a tau is above
/// max_distance.
[[nodiscard]] inline comparison compare(const cloud& estimate,
                                        const cloud& reference,
                                        const compare_options& options = {}) {
  const auto both = distances_both_ways(estimate, reference,
                                        {.max_distance = options.max_distance,
                                         .rule = options.rule,
                                         .threads = options.threads,
                                         .control = options.control});
  return score(both.to_reference, both.to_estimate, options.tau);
}

}  // namespace AIB_ISA
}  // namespace aib::cloud

// aib/cloud/neighbours.hpp

namespace aib::cloud {

/// Another point and how far it is.
struct neighbour {
  std::size_t index;  ///< in the cloud
  double distance;
};

/// The finite points of a cloud, to be asked for their k nearest and for those within a radius.
/// Borrows nothing. For the one nearest point of millions see cloud::distances.
class neighbours {
 public:
  explicit neighbours(const cloud& c) : points_(c), tree_(3, points_, {10}) {}
  neighbours(const neighbours&) = delete;
  neighbours& operator=(const neighbours&) = delete;

  [[nodiscard]] std::size_t size() const { return points_.position.size(); }

  /// The k nearest points (fewer where the cloud has no more), nearest first; a point of the cloud
  /// finds itself first.
  [[nodiscard]] std::vector<neighbour> nearest(const Eigen::Vector3d& p, std::size_t k) const {
    k = std::min(k, points_.position.size());
    std::vector<std::size_t> index(k);
    std::vector<double> squared(k);
    const Eigen::Vector3d local = p - points_.origin;
    const std::size_t n =
        k == 0 ? 0 : tree_.knnSearch(local.data(), k, index.data(), squared.data());
    std::vector<neighbour> found;
    for (std::size_t i = 0; i < n; ++i) {
      found.push_back({points_.source[index[i]], std::sqrt(squared[i])});
    }
    return found;
  }

  /// Calls `visit(index)` for each point nearer than `radius`, in no order.
  template <class Visit>
  void for_each_within(const Eigen::Vector3d& p, double radius, Visit&& visit) const {
    const Eigen::Vector3d local = p - points_.origin;
    visitor<Visit> inside{radius * radius, points_.source, visit};
    (void)tree_.radiusSearchCustomCallback(local.data(), inside);
  }

  /// How many points lie nearer than `radius`.
  [[nodiscard]] std::size_t count_within(const Eigen::Vector3d& p, double radius) const {
    std::size_t n = 0;
    for_each_within(p, radius, [&](std::size_t) { ++n; });
    return n;
  }

 private:
  /// A result set, which is the same in every version of nanoflann.
  template <class Visit>
  struct visitor {
    double squared_radius;
    const std::vector<std::size_t>& source;
    Visit& visit;

    bool addPoint(double squared, std::size_t place) {
      if (squared < squared_radius) visit(source[place]);
      return true;
    }
    [[nodiscard]] double worstDist() const { return squared_radius; }
    [[nodiscard]] std::size_t size() const { return 0; }
    [[nodiscard]] bool full() const { return true; }
  };

  struct finite_positions {
    Eigen::Vector3d origin;
    std::vector<Eigen::Vector3d> position;
    std::vector<std::size_t> source;

    explicit finite_positions(const cloud& c) : origin(c.origin) {
      for (std::size_t i = 0; i < c.size(); ++i) {
        if (!is_finite(c.points[i])) continue;
        position.push_back(c.points[i].cast<double>());
        source.push_back(i);
      }
    }

    // The interface that nanoflann asks for.
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return position.size(); }
    [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return position[i][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using metric = nanoflann::L2_Simple_Adaptor<double, finite_positions>;

  finite_positions points_;
  nanoflann::KDTreeSingleIndexAdaptor<metric, finite_positions, 3, std::size_t> tree_;
};

}  // namespace aib::cloud

// aib/cloud/by_label.hpp

namespace aib::cloud {

/// The label of the nearest point of a labelled cloud for each point of another; 0 for a point that
/// is not finite.
/// Throws argument_error if the reference has no labels, undefined_error if it has no finite point.
[[nodiscard]] inline std::vector<std::uint32_t> nearest_labels(const cloud& points,
                                                               const cloud& labelled,
                                                               unsigned threads = 0) {
  if (labelled.labels.size() != labelled.size()) {
    throw argument_error("cloud::nearest_labels: a reference with labels expected");
  }
  const neighbours search(labelled);
  if (search.size() == 0) {
    throw undefined_error(message("cloud::nearest_labels: no finite point in the reference (",
                                  labelled.size(), " points)"));
  }
  std::vector<std::uint32_t> labels(points.size());
  for_each_chunk(points.size(), 1024, threads, {}, [&](const chunk& c) {
    for (std::size_t i = c.begin; i < c.end; ++i) {
      if (!is_finite(points.points[i])) continue;
      labels[i] = labelled.labels[search.nearest(points.position(i), 1).front().index];
    }
  });
  return labels;
}

inline namespace AIB_ISA {

/// The distances of one label: of the points of the estimate that belong to it, and of those of the
/// reference. Either may be empty.
struct label_distances {
  std::uint32_t label;
  distances to_reference;
  distances to_estimate;
};

/// Distances in both directions, label by label in ascending order, for `score` to be taken of
/// each. What a search found stays as it is: the nearest point may have another label.
///
/// estimate_labels, reference_labels   one a point of the estimate, of the reference
///
/// Throws argument_error where labels and distances differ in number.
[[nodiscard]] inline std::vector<label_distances> by_label(
    const two_way_distances& both,
    std::span<const std::uint32_t> estimate_labels,
    std::span<const std::uint32_t> reference_labels,
    const distance_options& options = {}) {
  struct values {
    std::vector<float> estimate, reference;
  };
  const auto check = [](const distances& d, std::span<const std::uint32_t> labels) {
    if (d.size() == labels.size()) return;
    throw argument_error(message("cloud::by_label: a label for each of ", d.size(),
                                 " distances expected, found ", labels.size()));
  };
  check(both.to_reference, estimate_labels);
  check(both.to_estimate, reference_labels);
  std::map<std::uint32_t, values> found;
  for (std::size_t i = 0; i < estimate_labels.size(); ++i) {
    found[estimate_labels[i]].estimate.push_back(both.to_reference[i]);
  }
  for (std::size_t i = 0; i < reference_labels.size(); ++i) {
    found[reference_labels[i]].reference.push_back(both.to_estimate[i]);
  }
  std::vector<label_distances> labels;
  for (auto& [label, v] : found) {
    labels.push_back({label, distances(std::move(v.estimate), options),
                      distances(std::move(v.reference), options)});
  }
  return labels;
}

}  // namespace AIB_ISA
}  // namespace aib::cloud

// aib/raster/view.hpp

namespace aib::raster {

/// A rectangle of pixels that somebody else owns. Row-major, row 0 on top.
template <class T>
struct view {
  T* data = nullptr;
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t stride = 0;  ///< elements from one row to the next

  [[nodiscard]] T& operator()(std::size_t x, std::size_t y) const { return data[y * stride + x]; }
  [[nodiscard]] std::span<T> row(std::size_t y) const { return {data + y * stride, width}; }
  [[nodiscard]] std::size_t size() const { return width * height; }
  [[nodiscard]] bool empty() const { return size() == 0; }

  operator view<const T>() const requires(!std::is_const_v<T>) {
    return {data, width, height, stride};
  }
};

/// The part of a view that begins at (x, y). The caller keeps it inside.
template <class T>
[[nodiscard]] view<T> part(
    view<T> whole, std::size_t x, std::size_t y, std::size_t width, std::size_t height) {
  return {whole.data + y * whole.stride + x, width, height, whole.stride};
}

}  // namespace aib::raster

// aib/raster/image.hpp

namespace aib::raster {

/// A rectangle of pixels, owned, rows without gaps.
template <class T>
class image {
 public:
  image() = default;
  image(std::size_t width, std::size_t height, T value = {})
      : width_(width), height_(height), pixels_(width * height, value) {}

  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t height() const { return height_; }
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }
  [[nodiscard]] bool empty() const { return pixels_.empty(); }

  [[nodiscard]] T* data() { return pixels_.data(); }
  [[nodiscard]] const T* data() const { return pixels_.data(); }
  [[nodiscard]] T& operator()(std::size_t x, std::size_t y) { return pixels_[y * width_ + x]; }
  [[nodiscard]] const T& operator()(std::size_t x, std::size_t y) const {
    return pixels_[y * width_ + x];
  }

  [[nodiscard]] auto begin() { return pixels_.begin(); }
  [[nodiscard]] auto end() { return pixels_.end(); }
  [[nodiscard]] auto begin() const { return pixels_.begin(); }
  [[nodiscard]] auto end() const { return pixels_.end(); }

  [[nodiscard]] raster::view<T> view() { return {data(), width_, height_, width_}; }
  [[nodiscard]] raster::view<const T> view() const { return {data(), width_, height_, width_}; }
  operator raster::view<T>() { return view(); }
  operator raster::view<const T>() const { return view(); }

  friend bool operator==(const image&, const image&) = default;

 private:
  std::size_t width_ = 0;
  std::size_t height_ = 0;
  std::vector<T> pixels_;
};

}  // namespace aib::raster

// aib/raster/color.hpp

namespace aib::raster {

/// Red, green, blue, 8 bits each, sRGB as in PNG and JPEG files.
using rgb = std::array<std::uint8_t, 3>;

using color_image = image<rgb>;

/// A whole number a pixel: classes, or a mask where 0 is outside.
using label_image = image<std::uint16_t>;

/// 1 where the label is not 0.
[[nodiscard]] inline image<std::uint8_t> mask_of(const label_image& labels) {
  image<std::uint8_t> mask(labels.width(), labels.height());
  for (std::size_t i = 0; i < labels.size(); ++i) mask.data()[i] = labels.data()[i] != 0;
  return mask;
}

}  // namespace aib::raster

// aib/raster/colormap.hpp

namespace aib::raster {

/// A colour whose distances are those that people see.
/// Source: Ottosson, "A perceptual color space for image processing", 2020.
struct oklab {
  double lightness;  ///< 0 black, 1 white
  double a;          ///< green to red
  double b;          ///< blue to yellow
};

[[nodiscard]] oklab to_oklab(const rgb& color);

/// Colours outside of sRGB are cut channel by channel.
[[nodiscard]] rgb to_rgb(const oklab& color);

/// The colour at t in [0, 1] from dark blue to light yellow, in equal steps to the eye; readable
/// with red-green blindness and in print. t is clamped, NaN is 0.
[[nodiscard]] rgb sequential_color(double t);

/// The colour at t in [-1, 1]: blue, light grey at 0, red; equal steps to the eye on both sides.
/// t is clamped, NaN is 0.
[[nodiscard]] rgb diverging_color(double t);

namespace detail {

inline double to_linear(std::uint8_t channel) {
  const double c = channel / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

inline std::uint8_t from_linear(double c) {
  const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(encoded, 0.0, 1.0)));
}

inline oklab mix(const oklab& from, const oklab& to, double t) {
  const auto between = [t](double x, double y) { return x + (y - x) * t; };
  return {between(from.lightness, to.lightness), between(from.a, to.a), between(from.b, to.b)};
}

inline constexpr std::size_t color_steps = 256;

/// Colours of t = 0, 1/255, ... 1 on the straight line between two colours.
inline std::array<rgb, color_steps> color_table(const rgb& from, const rgb& to) {
  std::array<rgb, color_steps> table;
  const oklab first = to_oklab(from), last = to_oklab(to);
  for (std::size_t i = 0; i < color_steps; ++i)
    table[i] = to_rgb(mix(first, last, static_cast<double>(i) / (color_steps - 1)));
  return table;
}

inline const rgb& at(const std::array<rgb, color_steps>& table, double t) {
  const double place = t > 0 ? std::min(t, 1.0) * (color_steps - 1) : 0;
  return table[static_cast<std::size_t>(place + 0.5)];
}

}  // namespace detail

inline oklab to_oklab(const rgb& color) {
  const double r = detail::to_linear(color[0]);
  const double g = detail::to_linear(color[1]);
  const double b = detail::to_linear(color[2]);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

inline rgb to_rgb(const oklab& c) {
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(c.lightness + 0.3963377774 * c.a + 0.2158037573 * c.b);
  const double m = cube(c.lightness - 0.1055613458 * c.a - 0.0638541728 * c.b);
  const double s = cube(c.lightness - 0.0894841775 * c.a - 1.2914855480 * c.b);
  return {detail::from_linear(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          detail::from_linear(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          detail::from_linear(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

inline rgb sequential_color(double t) {
  static const auto table = detail::color_table({0, 32, 96}, {255, 233, 69});
  return detail::at(table, t);
}

inline rgb diverging_color(double t) {
  static const auto below = detail::color_table({238, 238, 238}, {20, 70, 170});
  static const auto above = detail::color_table({238, 238, 238}, {170, 30, 40});
  return t < 0 ? detail::at(below, -t) : detail::at(above, t);
}

}  // namespace aib::raster

// aib/cloud/colored.hpp

namespace aib::cloud {

/// The colours of numbers: grey where there is none (NaN).
enum class color_scale {
  sequential,  ///< 0 dark blue to `high` light yellow
  diverging,   ///< -high blue, 0 light grey, high red
};

/// A colour for each value; beyond `high` it is that of `high`.
/// Throws argument_error unless high > 0.
[[nodiscard]] inline std::vector<color> colors_of(std::span<const float> values,
                                                  double high,
                                                  color_scale scale = color_scale::sequential) {
  if (!(high > 0)) {
    throw argument_error(message("cloud::colors_of: high > 0 expected, found ", high));
  }
  std::vector<color> colors;
  colors.reserve(values.size());
  for (const float v : values) {
    const double place = v / high;
    colors.push_back(std::isnan(v)                     ? color{128, 128, 128}
                     : scale == color_scale::diverging ? raster::diverging_color(place)
                                                       : raster::sequential_color(place));
  }
  return colors;
}

/// The cloud in the colours of one value a point, its errors for example.
/// Throws argument_error unless there are as many values as points and high > 0.
[[nodiscard]] inline cloud colored(cloud points,
                                   std::span<const float> values,
                                   double high,
                                   color_scale scale = color_scale::sequential) {
  if (values.size() != points.size()) {
    throw argument_error(message("cloud::colored: a value for each of ", points.size(),
                                 " points expected, found ", values.size()));
  }
  points.colors = colors_of(values, high, scale);
  return points;
}

}  // namespace aib::cloud

// aib/cloud/select.hpp

namespace aib::cloud {

namespace detail {

template <class T>
std::vector<T> picked(const std::vector<T>& all, std::span<const std::size_t> index) {
  std::vector<T> some;
  if (all.empty()) return some;
  some.reserve(index.size());
  for (const std::size_t i : index) some.push_back(all[i]);
  return some;
}

}  // namespace detail

/// The points of some indices, in their order, with all that belongs to them.
[[nodiscard]] inline cloud select(const cloud& c, std::span<const std::size_t> index) {
  return {.origin = c.origin,
          .points = detail::picked(c.points, index),
          .normals = detail::picked(c.normals, index),
          .colors = detail::picked(c.colors, index),
          .labels = detail::picked(c.labels, index),
          .warnings = c.warnings};
}

/// The points of whose index `keep(i)` is true.
template <class Keep>
[[nodiscard]] cloud select_where(const cloud& c, Keep&& keep) {
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (keep(i)) index.push_back(i);
  }
  return select(c, index);
}

}  // namespace aib::cloud

// aib/cloud/crop.hpp

namespace aib::cloud {

/// A part of space.
template <class Volume>
concept volume = requires(const Volume& v, const Eigen::Vector3d& p) {
  { v.contains(p) } -> std::same_as<bool>;
};

/// A box in any orientation, its faces included.
struct oriented_box {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d world_from_box = Eigen::Matrix3d::Identity();  ///< rotation
  Eigen::Vector3d size = Eigen::Vector3d::Ones();                ///< along the box's own axes

  [[nodiscard]] bool contains(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d from_centre = p - centre;
    const Eigen::Vector3d in_box = world_from_box.transpose() * from_centre;
    return (2 * in_box.array().abs() <= size.array()).all();
  }
};

/// A prism over a polygon: the crop volume of Tanks and Temples, Open3D's SelectionPolygonVolume.
///
/// A point is inside where its coordinate on `axis` is in [low, high] and where the polygon, seen
/// along that axis, lies around it by the even-odd rule.
struct polygon_volume {
  int axis = 2;  ///< 0, 1 or 2: the polygon is seen along it
  double low = 0;
  double high = 0;
  std::vector<Eigen::Vector3d> polygon = {};  ///< at least three corners; `axis` plays no part

  [[nodiscard]] bool contains(const Eigen::Vector3d& p) const {
    if (!(p[axis] >= low && p[axis] <= high)) return false;
    const int u = axis == 0 ? 1 : 0;
    const int v = axis == 2 ? 1 : 2;
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector3d& a = polygon[i];
      const Eigen::Vector3d& b = polygon[(i + 1) % polygon.size()];
      if ((a[v] < p[v]) == (b[v] < p[v])) continue;
      if (a[u] + (p[v] - a[v]) / (b[v] - a[v]) * (b[u] - a[u]) < p[u]) inside = !inside;
    }
    return inside;
  }
};

/// What lies on the positive side of a plane, the plane itself left out.
struct half_space {
  Eigen::Vector4d plane = {0, 0, 1, 0};  ///< a, b, c, d of a x + b y + c z + d > 0

  [[nodiscard]] bool contains(const Eigen::Vector3d& p) const {
    return plane.head<3>().dot(p) + plane[3] > 0;
  }
};

/// Cells of which some are in: the observability mask of the DTU benchmark. Cell (i, j, k) has its
/// centre, not its corner, at low + resolution (i, j, k); what lies on a border falls to the even
/// cell.
struct occupancy_grid {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  double resolution = 1;
  std::array<std::size_t, 3> size = {};
  std::vector<std::uint8_t> cells = {};  ///< not 0 is in; k runs fastest, then j

  [[nodiscard]] bool contains(const Eigen::Vector3d& p) const {
    std::size_t index = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      const double place = std::nearbyint((p[a] - low[a]) / resolution);
      if (!(place >= 0 && place < static_cast<double>(size[axis]))) return false;
      index = index * size[axis] + static_cast<std::size_t>(place);
    }
    return cells[index] != 0;
  }
};

/// The points of a cloud that lie in a volume. Points that are not finite lie in none.
template <volume Volume>
[[nodiscard]] cloud crop(const cloud& c, const Volume& volume) {
  return select_where(c, [&](std::size_t i) { return volume.contains(c.position(i)); });
}

}  // namespace aib::cloud

// aib/cloud/voxel_shares.hpp

namespace aib::cloud {

/// What is known of a point at thresholds that grow: it is good from one of them on; below that it
/// is bad where it was observed, and left out where it was not.
struct verdict {
  std::uint32_t first_good;  ///< index of the threshold; as many as there are: at none
  bool observed;
};

/// How the voxel of a point is calculated.
enum class cell_rule {
  exact,   ///< in double
  single,  ///< in float, as ETH3D's tool: points on a border fall elsewhere
};

namespace detail {

/// Cell of a position on a lattice that begins `shift` cells from the world's origin.
inline Eigen::Vector3d cell_of(const Eigen::Vector3d& p,
                               double size,
                               double shift,
                               cell_rule rule) {
  if (rule == cell_rule::exact)
    return (p / size + Eigen::Vector3d::Constant(shift)).array().floor();
  const auto per_unit = static_cast<float>(1.0 / static_cast<float>(size));
  const Eigen::Vector3f single = p.cast<float>();
  return (single.array() * per_unit + static_cast<float>(shift)).floor().cast<double>();
}

/// Points in the order of their cells, which are numbered.
inline std::vector<std::pair<std::uint64_t, std::size_t>> points_by_cell(const cloud& points,
                                                                         double size,
                                                                         double shift,
                                                                         cell_rule rule) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d cell = cell_of(points.position(i), size, shift, rule);
    low = low.cwiseMin(cell);
    high = high.cwiseMax(cell);
  }
  constexpr int bits = 21;
  if (!((high - low).maxCoeff() < (1 << bits))) {
    throw argument_error(message("cloud::voxel_shares: size ", size,
                                 " is too small: more than 2 097 152 voxels on an axis"));
  }
  std::vector<std::pair<std::uint64_t, std::size_t>> sorted;
  sorted.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d cell = cell_of(points.position(i), size, shift, rule) - low;
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) key = key << bits | static_cast<std::uint64_t>(cell[k]);
    sorted.emplace_back(key, i);
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// Sum over voxels of the share of good points, and the number of voxels with any known point.
struct share_sum {
  double shares = 0;
  std::size_t voxels = 0;
};

inline void add_voxel(std::span<const std::pair<std::uint64_t, std::size_t>> members,
                      std::span<const verdict> verdicts,
                      std::vector<share_sum>& sums) {
  for (std::size_t t = 0; t < sums.size(); ++t) {
    std::size_t good = 0, known = 0;
    for (const auto& [cell, i] : members) {
      const bool is_good = verdicts[i].first_good <= t;
      good += is_good;
      known += is_good || verdicts[i].observed;
    }
    if (known == 0) continue;
    sums[t].shares += static_cast<double>(good) / static_cast<double>(known);
    ++sums[t].voxels;
  }
}

}  // namespace detail

/// Share of good points at each threshold, averaged over voxels and not over points, so that
/// density does not weigh: the mean over the voxels of two lattices, half a voxel apart, that have
/// a point of which something is known. Nothing where there is none.
///
/// points     all finite
/// verdicts   one a point
/// size       edge of a voxel, unit of the cloud
///
/// Throws argument_error for a size that is not positive or far too small for the cloud.
/// Source: Schöps et al., "A multi-view stereo benchmark with high-resolution images and
/// multi-camera videos" (ETH3D), CVPR 2017, section 5.
[[nodiscard]] inline std::vector<std::optional<double>> voxel_shares(
    const cloud& points,
    std::span<const verdict> verdicts,
    std::size_t n_thresholds,
    double size,
    cell_rule rule = cell_rule::exact) {
  if (!(size > 0)) {
    throw argument_error(message("cloud::voxel_shares: size > 0 expected, found ", size));
  }
  std::vector<detail::share_sum> sums(n_thresholds);
  for (const double shift : {0.0, 0.5}) {
    const auto sorted = detail::points_by_cell(points, size, shift, rule);
    for (std::size_t first = 0, last = 0; first < sorted.size(); first = last) {
      while (last < sorted.size() && sorted[last].first == sorted[first].first) ++last;
      detail::add_voxel(std::span(sorted).subspan(first, last - first), verdicts, sums);
    }
  }
  std::vector<std::optional<double>> shares;
  for (const detail::share_sum& s : sums) {
    shares.push_back(s.voxels == 0 ? std::nullopt
                                   : std::optional(s.shares / static_cast<double>(s.voxels)));
  }
  return shares;
}

}  // namespace aib::cloud

// aib/cloud/free_space.hpp

namespace aib::cloud {

/// Points that a laser scanner saw from one place.
struct laser_scan {
  cloud points;             ///< in the world
  Eigen::Vector3d scanner;  ///< where it stood in the world
};

/// The cone of a laser beam.
struct laser_beam {
  double start_radius = 0.001125;                        ///< at the scanner, unit of the clouds
  double half_angle = 0.011 * std::numbers::pi / 180.0;  ///< radians

  [[nodiscard]] double radius_at(double distance) const {
    return start_radius + distance * std::tan(half_angle);
  }
};

/// The beams of one scan, to be asked what they say of a point: a beam that passes it on the way to
/// a surface behind it has seen that there is nothing.
class scanned_space {
 public:
  /// Throws undefined_error if no scan point is finite and away from the scanner.
  scanned_space(const laser_scan& scan, const laser_beam& beam)
      : scan_(scan), beam_(beam), directions_(directions_of(scan)), index_(directions_) {}

  /// The verdict of the beams that p lies in: good from the first tolerance on within which their
  /// scan points lie, observed where p is before one of them.
  ///
  /// tolerances   ascending; a distance of exactly a tolerance is within it
  [[nodiscard]] verdict of(const Eigen::Vector3d& p, std::span<const double> tolerances) const {
    const Eigen::Vector3d to_point = p - scan_.scanner;
    const double range = to_point.norm();
    const double beam_radius = beam_.radius_at(range);
    verdict v{static_cast<std::uint32_t>(tolerances.size()), false};
    index_.for_each_within(
        to_point / std::max(range, 1e-300), reach(beam_radius, range), [&](std::size_t i) {
          const Eigen::Vector3d to_scan = scan_.points.position(i) - scan_.scanner;
          const double scan_range = to_scan.norm();
          const double along = to_scan.dot(to_point) / scan_range;
          const Eigen::Vector3d beside = to_point - along / scan_range * to_scan;
          if (along < 0 || beside.norm() > beam_radius) return;
          const double distance = (to_scan - to_point).norm();
          const auto within = std::lower_bound(tolerances.begin(), tolerances.end(), distance);
          v.first_good =
              std::min(v.first_good, static_cast<std::uint32_t>(within - tolerances.begin()));
          v.observed = v.observed || along < scan_range;
        });
    return v;
  }

 private:
  /// The directions of the scan points as points on the unit sphere; NaN where there is none.
  static cloud directions_of(const laser_scan& scan) {
    cloud directions;
    std::size_t n = 0;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Eigen::Vector3d to_scan = scan.points.position(i) - scan.scanner;
      const Eigen::Vector3d direction = to_scan / to_scan.norm();
      directions.points.push_back(direction.cast<float>());
      n += direction.allFinite();
    }
    if (n == 0) {
      throw undefined_error(
          message("cloud::scanned_space: no beam in a scan of ", scan.points.size(), " points"));
    }
    return directions;
  }

  /// How far, on the unit sphere, the direction of a beam around a point can be from the point's,
  /// and a little more for the rounding of directions.
  static double reach(double beam_radius, double range) {
    constexpr double rounding = 1e-6;
    if (beam_radius >= range) return 2 + rounding;
    return 2 * std::sin(std::asin(beam_radius / range) / 2) + rounding;
  }

  const laser_scan& scan_;
  laser_beam beam_;
  cloud directions_;
  neighbours index_;
};

}  // namespace aib::cloud

// aib/cloud/join.hpp

namespace aib::cloud {

namespace detail {

template <class T>
void extend(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// Drops what not every point has.
template <class T>
void clear_unless_all(std::vector<T>& values, std::size_t n) {
  if (values.size() != n) values.clear();
}

}  // namespace detail

/// The points of several clouds in one, in their order, counted from the origin of the first that
/// has points. Normals, colors and labels stay where every cloud with points has them.
[[nodiscard]] inline cloud joined(std::span<const cloud* const> clouds) {
  cloud all;
  for (const cloud* c : clouds) {
    if (all.empty()) all.origin = c->origin;
    const Eigen::Vector3d shift = c->origin - all.origin;
    if (shift.isZero(0)) {
      detail::extend(all.points, c->points);
    } else {
      for (const Eigen::Vector3f& p : c->points) {
        const Eigen::Vector3d moved = shift + p.cast<double>();
        all.points.push_back(moved.cast<float>());
      }
    }
    detail::extend(all.normals, c->normals);
    detail::extend(all.colors, c->colors);
    detail::extend(all.labels, c->labels);
    detail::extend(all.warnings, c->warnings);
  }
  detail::clear_unless_all(all.normals, all.size());
  detail::clear_unless_all(all.colors, all.size());
  detail::clear_unless_all(all.labels, all.size());
  return all;
}

}  // namespace aib::cloud

// aib/cloud/eth3d.hpp

namespace aib::cloud {

/// Whether a scan point at exactly a tolerance from the reconstruction is complete.
enum class eth3d_rule {
  /// As the tool of 2017: yes, but not at the largest tolerance; and voxels calculated in float
  /// where the clouds lie at the world's origin.
  official,
  within,  ///< yes
  below,   ///< no
};

struct eth3d_options {
  std::vector<double> tolerances = {};  ///< in the unit of the clouds
  double voxel = 0.01;                  ///< edge of the voxels over which shares are averaged
  laser_beam beam = {};
  eth3d_rule rule = eth3d_rule::official;
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

/// Scores at one tolerance.
struct eth3d_scores {
  double tolerance;
  double completeness;             ///< share of the scanned surface that was reconstructed
  std::optional<double> accuracy;  ///< share of the reconstruction; none where nothing was observed
  std::optional<double> f_score;   ///< harmonic mean of both; 0 where both are 0
};

struct eth3d_result {
  std::vector<eth3d_scores> scores;       ///< by ascending tolerance
  std::vector<std::size_t> n_unobserved;  ///< points of the reconstruction that nothing is known of
  std::size_t n_reconstruction;           ///< finite points
  std::size_t n_scanned;
};

namespace detail {

inline cloud only_finite(const cloud& c) {
  return select_where(c, [&](std::size_t i) { return is_finite(c.points[i]); });
}

inline cell_rule cells_of(eth3d_rule rule, const cloud& a, const cloud& b) {
  const bool single = rule == eth3d_rule::official && a.origin.isZero(0) && b.origin.isZero(0);
  return single ? cell_rule::single : cell_rule::exact;
}

/// Whether each scan point is complete, from which tolerance on.
inline std::vector<verdict> completeness_verdicts(std::span<const float> distance,
                                                  std::span<const double> tolerances,
                                                  eth3d_rule rule) {
  std::vector<verdict> verdicts;
  for (const float d : distance) {
    const auto first = rule == eth3d_rule::below
                           ? std::upper_bound(tolerances.begin(), tolerances.end(), d)
                           : std::lower_bound(tolerances.begin(), tolerances.end(), d);
    const bool at_largest = rule == eth3d_rule::official && !(d < tolerances.back());
    verdicts.push_back(
        {static_cast<std::uint32_t>(
             at_largest ? tolerances.size() : static_cast<std::size_t>(first - tolerances.begin())),
         true});
  }
  return verdicts;
}

/// Good where any scan says so, else bad where any says so.
inline verdict combined(const verdict& a, const verdict& b) {
  return {std::min(a.first_good, b.first_good), a.observed || b.observed};
}

inline std::vector<verdict> accuracy_verdicts(const cloud& reconstruction,
                                              std::span<const laser_scan> scans,
                                              const eth3d_options& options) {
  std::deque<scanned_space> spaces;
  for (const laser_scan& scan : scans) spaces.emplace_back(scan, options.beam);
  const auto none = static_cast<std::uint32_t>(options.tolerances.size());
  std::vector<verdict> verdicts(reconstruction.size(), {none, false});
  for_each_chunk(
      reconstruction.size(), 1024, options.threads, options.control, [&](const chunk& c) {
        for (std::size_t i = c.begin; i < c.end; ++i) {
          for (const scanned_space& space : spaces) {
            if (verdicts[i].first_good == 0) break;
            verdicts[i] =
                combined(verdicts[i], space.of(reconstruction.position(i), options.tolerances));
          }
        }
      });
  return verdicts;
}

inline std::size_t count_unobserved(std::span<const verdict> verdicts, std::size_t threshold) {
  return static_cast<std::size_t>(
      std::count_if(verdicts.begin(), verdicts.end(),
                    [&](const verdict& v) { return !v.observed && v.first_good > threshold; }));
}

}  // namespace detail

inline namespace AIB_ISA {

/// The scores of the ETH3D benchmark: shares averaged over voxels and not over points, and only
/// what the beams of the scanner observed counts against a reconstruction.
///
/// Accuracy takes a distance of exactly a tolerance as within it.
/// Throws argument_error without positive tolerances, undefined_error where the reconstruction or a
/// scan has no finite point.
/// Source: Schöps et al., CVPR 2017, section 5; github.com/ETH3D/multi-view-evaluation.
[[nodiscard]] inline eth3d_result eth3d(const cloud& reconstruction,
                                        std::span<const laser_scan> scans,
                                        eth3d_options options) {
  auto& tolerances = options.tolerances;
  std::sort(tolerances.begin(), tolerances.end());
  if (tolerances.empty() || !(tolerances.front() > 0)) {
    throw argument_error("cloud::eth3d: positive tolerances expected");
  }
  std::vector<const cloud*> parts;
  for (const laser_scan& scan : scans) parts.push_back(&scan.points);
  const cloud estimate = detail::only_finite(reconstruction);
  const cloud scanned = detail::only_finite(joined(parts));
  const distances missing(scanned, estimate,
                          {.threads = options.threads, .control = options.control});
  const auto complete = detail::completeness_verdicts(missing.values(), tolerances, options.rule);
  const auto accurate = detail::accuracy_verdicts(estimate, scans, options);
  const std::size_t n = tolerances.size();
  const auto cells = detail::cells_of(options.rule, estimate, scanned);
  const auto completeness = voxel_shares(scanned, complete, n, options.voxel, cells);
  const auto accuracy = voxel_shares(estimate, accurate, n, options.voxel, cells);
  eth3d_result result{{}, {}, estimate.size(), scanned.size()};
  for (std::size_t t = 0; t < n; ++t) {
    eth3d_scores s{tolerances[t], *completeness[t], accuracy[t], std::nullopt};
    if (s.accuracy) s.f_score = detail::harmonic_mean(s.completeness, *s.accuracy);
    result.scores.push_back(s);
    result.n_unobserved.push_back(detail::count_unobserved(accurate, t));
  }
  return result;
}

}  // namespace AIB_ISA
}  // namespace aib::cloud

// aib/cloud/normals.hpp

namespace aib::cloud {

struct normal_options {
  std::size_t neighbours = 30;  ///< the point itself included
  unsigned threads = 0;         ///< 0: all
};

/// The cloud with a normal for each point: the direction in which its nearest neighbours spread
/// least. The sign is arbitrary. A point that is not finite, or has fewer than two others, gets
/// (0, 0, 1).
/// Source: Hoppe et al., SIGGRAPH 1992, section 3.2.
[[nodiscard]] inline cloud with_normals(const cloud& c, const normal_options& options = {}) {
  const neighbours search(c);
  cloud result = c;
  result.normals.assign(c.size(), Eigen::Vector3f(0, 0, 1));
  for_each_chunk(c.size(), 1024, options.threads, {}, [&](const chunk& part) {
    for (std::size_t i = part.begin; i < part.end; ++i) {
      if (!is_finite(c.points[i])) continue;
      const auto found = search.nearest(c.position(i), options.neighbours);
      if (found.size() < 3) continue;
      Eigen::Vector3d mean(0, 0, 0);
      for (const neighbour& n : found) mean += c.points[n.index].cast<double>();
      mean /= static_cast<double>(found.size());
      Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
      for (const neighbour& n : found) {
        const Eigen::Vector3d d = c.points[n.index].cast<double>() - mean;
        covariance += d * d.transpose();
      }
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
      const Eigen::Vector3d least = solver.eigenvectors().col(0);
      result.normals[i] = least.cast<float>();
    }
  });
  return result;
}

/// Agreement of normals: |cosine| of the angle to the normal of the nearest point of the other
/// cloud.
struct normal_consistency_result {
  double estimate_mean;  ///< over the estimate ("NC1" of CUT3R)
  double estimate_median;
  double reference_mean;  ///< over the reference ("NC2")
  double reference_median;
};

namespace detail {

inline std::vector<double> normal_cosines(const cloud& from, const cloud& to, unsigned threads) {
  const neighbours search(to);
  std::vector<double> cosine(from.size(), std::numeric_limits<double>::quiet_NaN());
  for_each_chunk(from.size(), 1024, threads, {}, [&](const chunk& part) {
    for (std::size_t i = part.begin; i < part.end; ++i) {
      if (!is_finite(from.points[i])) continue;
      const auto found = search.nearest(from.position(i), 1);
      if (found.empty()) continue;
      const Eigen::Vector3d a = from.normals[i].cast<double>();
      const Eigen::Vector3d b = to.normals[found[0].index].cast<double>();
      cosine[i] = std::abs(a.dot(b));
    }
  });
  std::erase_if(cosine, [](double c) { return std::isnan(c); });
  if (cosine.empty()) throw undefined_error("cloud::normal_consistency: no pair of finite points");
  return cosine;
}

inline double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

}  // namespace detail

/// How well the normals of two clouds agree, over each cloud. Signs play no part.
/// Throws argument_error if a cloud has no normals, undefined_error if one has no finite point.
/// Source: Wang et al., "Continuous 3D perception model with persistent state" (CUT3R), CVPR 2025.
[[nodiscard]] inline normal_consistency_result normal_consistency(const cloud& estimate,
                                                                  const cloud& reference,
                                                                  unsigned threads = 0) {
  for (const cloud* c : {&estimate, &reference}) {
    if (c->normals.size() != c->size()) {
      throw argument_error("cloud::normal_consistency: clouds with normals expected");
    }
  }
  const auto e = detail::normal_cosines(estimate, reference, threads);
  const auto r = detail::normal_cosines(reference, estimate, threads);
  const std::span<const double> es(e), rs(r);
  return {detail::mean_of(es), stats::median(es), detail::mean_of(rs), stats::median(rs)};
}

}  // namespace aib::cloud

// aib/cloud/offsets.hpp

namespace aib::cloud {

/// Signed distances, one a point of a cloud, with their statistics: which way something has moved.
///
/// Statistics throw undefined_error where no value is finite.
class offsets {
 public:
  explicit offsets(std::vector<float> values) : values_(std::move(values)) {
    for (const float v : values_) {
      if (!std::isfinite(v)) continue;
      ++n_finite_;
      sum_ += v;
    }
    for (const float v : values_) {
      if (!std::isfinite(v)) continue;
      squares_ += (v - sum_ / n()) * (v - sum_ / n());
      absolute_ += std::abs(v);
    }
  }

  /// One value a point, in its order; NaN for a point that has none.
  [[nodiscard]] std::span<const float> values() const { return values_; }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] float operator[](std::size_t i) const { return values_[i]; }
  [[nodiscard]] std::size_t n_finite() const { return n_finite_; }
  [[nodiscard]] std::size_t n_dropped() const { return size() - n_finite_; }

  [[nodiscard]] double mean() const { return demand_values(), sum_ / n(); }
  [[nodiscard]] double mean_absolute() const { return demand_values(), absolute_ / n(); }
  /// Standard deviation about the mean, over all values (not n - 1).
  [[nodiscard]] double deviation() const { return demand_values(), std::sqrt(squares_ / n()); }
  [[nodiscard]] double median() const { return quantile(0.5); }
  /// q in [0, 1], interpolated linearly.
  [[nodiscard]] double quantile(double q) const {
    demand_values();
    std::vector<float> finite;
    finite.reserve(n_finite_);
    std::copy_if(values_.begin(), values_.end(), std::back_inserter(finite),
                 [](float v) { return std::isfinite(v); });
    return stats::quantile_in_place<float>(finite, q);
  }

 private:
  [[nodiscard]] double n() const { return static_cast<double>(n_finite_); }
  void demand_values() const {
    if (n_finite_ > 0) return;
    throw undefined_error(message("cloud::offsets: no finite value of ", size()));
  }

  std::vector<float> values_;
  std::size_t n_finite_ = 0;
  double sum_ = 0;
  double squares_ = 0;
  double absolute_ = 0;
};

/// How far each point lies before (positive) or behind the reference: its offset from the nearest
/// point of the reference along that point's normal.
///
/// Small where both surfaces agree but one is shifted along itself, so not a distance between
/// clouds. Throws argument_error if the reference has no normals, undefined_error if it has no
/// finite point.
[[nodiscard]] inline offsets offsets_along_normals(const cloud& from,
                                                   const cloud& reference,
                                                   unsigned threads = 0) {
  if (reference.normals.size() != reference.size()) {
    throw argument_error("cloud::offsets_along_normals: a reference with normals expected");
  }
  const neighbours search(reference);
  if (search.size() == 0) {
    throw undefined_error(
        message("cloud::offsets_along_normals: no finite point in the reference (",
                reference.size(), " points)"));
  }
  std::vector<float> values(from.size(), std::numeric_limits<float>::quiet_NaN());
  for_each_chunk(from.size(), 1024, threads, {}, [&](const chunk& c) {
    for (std::size_t i = c.begin; i < c.end; ++i) {
      if (!is_finite(from.points[i])) continue;
      const std::size_t nearest = search.nearest(from.position(i), 1).front().index;
      const Eigen::Vector3d apart = from.position(i) - reference.position(nearest);
      values[i] = static_cast<float>(apart.dot(reference.normals[nearest].cast<double>()));
    }
  });
  return offsets(std::move(values));
}

}  // namespace aib::cloud

// aib/cloud/outliers.hpp

namespace aib::cloud {

struct statistical_options {
  std::size_t neighbours = 20;  ///< the point itself included
  double ratio = 2;             ///< standard deviations above the mean that are kept
  unsigned threads = 0;         ///< 0: all
};

struct radius_options {
  double radius = 0;
  std::size_t neighbours = 2;  ///< more points than this, the point itself included, are kept
  unsigned threads = 0;        ///< 0: all
};

namespace detail {

/// A number for each point, of NaN where the point is not finite.
template <class Measure>
std::vector<double> measure_points(const cloud& c, unsigned threads, Measure&& measure) {
  std::vector<double> values(c.size(), std::numeric_limits<double>::quiet_NaN());
  for_each_chunk(c.size(), 1024, threads, {}, [&](const chunk& part) {
    for (std::size_t i = part.begin; i < part.end; ++i) {
      if (is_finite(c.points[i])) values[i] = measure(c.position(i));
    }
  });
  return values;
}

}  // namespace detail

/// The points whose mean distance to their nearest neighbours is not far above that of all: below
/// mean + ratio * standard deviation (ddof 1). Duplicates, whose mean distance is 0, go as well.
/// Source: Rusu et al., RAS 2008; the rule is Open3D's remove_statistical_outlier.
[[nodiscard]] inline cloud without_statistical_outliers(const cloud& c,
                                                        const statistical_options& options = {}) {
  if (options.neighbours == 0 || !(options.ratio > 0)) {
    throw argument_error("cloud::without_statistical_outliers: neighbours > 0, ratio > 0 expected");
  }
  const neighbours search(c);
  const auto spread = detail::measure_points(c, options.threads, [&](const Eigen::Vector3d& p) {
    const auto found = search.nearest(p, options.neighbours);
    double sum = 0;
    for (const neighbour& n : found) sum += n.distance;
    return sum / static_cast<double>(found.size());
  });
  double sum = 0, squares = 0, n = 0;
  for (const double s : spread) {
    if (s > 0) sum += s, ++n;
  }
  const double mean = n > 0 ? sum / n : 0;
  for (const double s : spread) {
    if (s > 0) squares += (s - mean) * (s - mean);
  }
  const double limit = mean + options.ratio * (n > 1 ? std::sqrt(squares / (n - 1)) : 0);
  return select_where(c, [&](std::size_t i) { return spread[i] > 0 && spread[i] < limit; });
}

/// The points that have more than so many points, themselves included, nearer than a radius.
[[nodiscard]] inline cloud without_radius_outliers(const cloud& c, const radius_options& options) {
  if (!(options.radius > 0)) {
    throw argument_error(
        message("cloud::without_radius_outliers: radius > 0 expected, found ", options.radius));
  }
  const neighbours search(c);
  const auto count = detail::measure_points(c, options.threads, [&](const Eigen::Vector3d& p) {
    return static_cast<double>(search.count_within(p, options.radius));
  });
  const auto least = static_cast<double>(options.neighbours);
  return select_where(c, [&](std::size_t i) { return count[i] > least; });
}

/// n points chosen at random, each subset equally likely, in their order; all where there are
/// fewer.
[[nodiscard]] inline cloud random_subset(const cloud& c, std::size_t n, std::uint64_t seed = 1) {
  std::vector<std::size_t> index(c.size());
  std::iota(index.begin(), index.end(), std::size_t{0});
  n = std::min(n, index.size());
  random_engine random(seed);
  for (std::size_t i = 0; i < n; ++i)
    std::swap(index[i], index[i + random.below(index.size() - i)]);
  index.resize(n);
  std::sort(index.begin(), index.end());
  return select(c, index);
}

}  // namespace aib::cloud

// aib/cloud/transform.hpp

namespace aib::cloud {

/// The cloud in frame b. Points are moved in double and counted from their new natural origin,
/// normals are turned.
[[nodiscard]] inline cloud operator*(const math::sim3& b_from_a, const cloud& in_a) {
  placed_points placed =
      place(in_a.size(), [&](std::size_t i) { return b_from_a * in_a.position(i); });
  cloud in_b = in_a;
  in_b.origin = placed.origin;
  in_b.points = std::move(placed.points);
  const Eigen::Matrix3f rotation = b_from_a.rotation.cast<float>();
  for (Eigen::Vector3f& normal : in_b.normals) normal = (rotation * normal).eval();
  return in_b;
}

[[nodiscard]] inline cloud operator*(const math::rigid3& b_from_a, const cloud& in_a) {
  return math::sim3{1, b_from_a.rotation, b_from_a.translation} * in_a;
}

}  // namespace aib::cloud

// aib/core/simd_wide.hpp

namespace aib {

inline namespace AIB_ISA {

#if !defined(AIB_PLAIN) && defined(__AVX512F__)

/// Eight doubles that are calculated together, see simd.hpp.
///
/// The masked forms of what works on all lanes: g++ 12 warns of the others.
struct f64x8 {
  static constexpr std::size_t width = 8;
  static constexpr __mmask8 all = 0xff;
  __m512d v;

  static f64x8 load(const double* p) { return {_mm512_loadu_pd(p)}; }
  static f64x8 convert(const float* p) { return {_mm512_maskz_cvtps_pd(all, _mm256_loadu_ps(p))}; }
  static f64x8 broadcast(double x) { return {_mm512_set1_pd(x)}; }
  void store(double* p) const { _mm512_storeu_pd(p, v); }

  friend f64x8 operator+(f64x8 a, f64x8 b) { return {_mm512_add_pd(a.v, b.v)}; }
  friend f64x8 operator-(f64x8 a, f64x8 b) { return {_mm512_sub_pd(a.v, b.v)}; }
  friend f64x8 operator*(f64x8 a, f64x8 b) { return {_mm512_mul_pd(a.v, b.v)}; }
  friend f64x8 operator/(f64x8 a, f64x8 b) { return {_mm512_div_pd(a.v, b.v)}; }
  friend f64x8 min(f64x8 a, f64x8 b) { return {_mm512_maskz_min_pd(all, a.v, b.v)}; }
  friend f64x8 max(f64x8 a, f64x8 b) { return {_mm512_maskz_max_pd(all, a.v, b.v)}; }
  friend f64x8 choose(f64x8 a, f64x8 b, f64x8 x, f64x8 y) {
    return {_mm512_mask_blend_pd(_mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ), y.v, x.v)};
  }
  friend f64x8 mantissa(f64x8 a) {
    const __m512i fraction =
        _mm512_and_epi64(_mm512_castpd_si512(a.v), _mm512_set1_epi64(detail::fraction_bits));
    return {_mm512_castsi512_pd(_mm512_or_epi64(fraction, _mm512_castpd_si512(_mm512_set1_pd(1))))};
  }
  friend f64x8 exponent(f64x8 a) {
    const __m512i shifted = _mm512_maskz_srli_epi64(all, _mm512_castpd_si512(a.v), 52);
    const __m512i offset = _mm512_castpd_si512(_mm512_set1_pd(0x1p52));
    return {_mm512_sub_pd(_mm512_castsi512_pd(_mm512_or_epi64(shifted, offset)),
                          _mm512_set1_pd(detail::exponent_offset))};
  }
};

#else

/// Eight doubles that are calculated together, see simd.hpp.
struct f64x8 {
  static constexpr std::size_t width = 8;
  f64x4 lo, hi;

  static f64x8 load(const double* p) { return {f64x4::load(p), f64x4::load(p + 4)}; }
  static f64x8 convert(const float* p) { return {f64x4::convert(p), f64x4::convert(p + 4)}; }
  static f64x8 broadcast(double x) { return {f64x4::broadcast(x), f64x4::broadcast(x)}; }
  void store(double* p) const {
    lo.store(p);
    hi.store(p + 4);
  }

  friend f64x8 operator+(f64x8 a, f64x8 b) { return {a.lo + b.lo, a.hi + b.hi}; }
  friend f64x8 operator-(f64x8 a, f64x8 b) { return {a.lo - b.lo, a.hi - b.hi}; }
  friend f64x8 operator*(f64x8 a, f64x8 b) { return {a.lo * b.lo, a.hi * b.hi}; }
  friend f64x8 operator/(f64x8 a, f64x8 b) { return {a.lo / b.lo, a.hi / b.hi}; }
  friend f64x8 min(f64x8 a, f64x8 b) { return {min(a.lo, b.lo), min(a.hi, b.hi)}; }
  friend f64x8 max(f64x8 a, f64x8 b) { return {max(a.lo, b.lo), max(a.hi, b.hi)}; }
  friend f64x8 choose(f64x8 a, f64x8 b, f64x8 x, f64x8 y) {
    return {choose(a.lo, b.lo, x.lo, y.lo), choose(a.hi, b.hi, x.hi, y.hi)};
  }
  friend f64x8 mantissa(f64x8 a) { return {mantissa(a.lo), mantissa(a.hi)}; }
  friend f64x8 exponent(f64x8 a) { return {exponent(a.lo), exponent(a.hi)}; }
};

#endif

/// Sum of the lanes in a fixed order.
inline double sum(f64x8 a) {
  double lane[8];
  a.store(lane);
  return ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7]));
}

}  // namespace AIB_ISA

}  // namespace aib

// aib/depth/crop.hpp

namespace aib::depth {

/// The part of a frame that is evaluated, as driving benchmarks cut it.
enum class crop_rule {
  none,
  garg,   ///< Garg et al., "Unsupervised CNN for single view depth estimation", ECCV 2016
  eigen,  ///< Eigen, Puhrsch, Fergus, NeurIPS 2014
};

namespace detail {

/// Shares of height and width; ends are truncated to whole pixels and exclusive.
struct crop_shares {
  double top, bottom, left, right;
};

constexpr crop_shares shares_of(crop_rule c) {
  switch (c) {
    case crop_rule::garg:
      return {0.40810811, 0.99189189, 0.03594771, 0.96405229};
    case crop_rule::eigen:
      return {0.3324324, 0.91351351, 0.0359477, 0.96405229};
    default:
      return {0, 1, 0, 1};
  }
}

}  // namespace detail

/// The cropped part of a view; an empty view stays empty.
template <class T>
[[nodiscard]] raster::view<T> cropped(raster::view<T> whole, crop_rule c) {
  const detail::crop_shares s = detail::shares_of(c);
  const auto at = [](double share, std::size_t size) {
    return static_cast<std::size_t>(share * static_cast<double>(size));
  };
  const std::size_t x = at(s.left, whole.width), y = at(s.top, whole.height);
  return raster::part(whole, x, y, at(s.right, whole.width) - x, at(s.bottom, whole.height) - y);
}

}  // namespace aib::depth

// aib/depth/depth_map.hpp

namespace aib::depth {

/// Planar depth of a view: distance along the optical axis, in the unit of its source.
/// A pixel is valid where it is finite and > 0; readers turn the background markers of their source
/// into 0.
template <class Scalar>
struct basic_depth_map {
  raster::image<Scalar> values;
  std::vector<std::string> warnings = {};  ///< what the reader removed or doubts, a sentence each
};

using depth_map = basic_depth_map<float>;

template <class Scalar>
[[nodiscard]] bool is_valid(Scalar depth) {
  return std::isfinite(depth) && depth > 0;
}

}  // namespace aib::depth

// aib/math/log_ratio.hpp

namespace aib::math {

inline namespace AIB_ISA {

/// ln(a / b) in lanes (f64x4, f64x8), of positive, finite, normal doubles: within 3e-16 of the
/// largest of 1 and the result. The ratio never overflows; equal numbers give exactly 0, near ones
/// of one binade keep their digits; the same bits on every machine.
///
/// ln(a / b) = 2 atanh((a - b) / (a + b)), taken on the mantissas, whose quotient s is at most 1/3;
/// atanh(s) / s by a Chebyshev interpolation in s^2 on [0, 1/9], within 6e-18.
template <class Lanes>
Lanes log_ratio(Lanes a, Lanes b) {
  const Lanes ma = mantissa(a), mb = mantissa(b);
  const Lanes s = (ma - mb) / (ma + mb);
  const Lanes z = s * s, z2 = z * z, z4 = z2 * z2;
  // Terms in pairs (Estrin's scheme): the processor works on all of them at a time.
  const auto pair = [&](double low, double high) {
    return Lanes::broadcast(low) + z * Lanes::broadcast(high);
  };
  const Lanes low = pair(0x1.5555555555555p-2, 0x1.999999999a3ddp-3) +
                    z2 * pair(0x1.24924923d44c6p-3, 0x1.c71c727143318p-4);
  const Lanes middle = pair(0x1.745cf0b0e03bdp-4, 0x1.3b18b294bebf9p-4) +
                       z2 * pair(0x1.10ac75dc602b1p-4, 0x1.eb905e8575054p-5);
  const Lanes high = pair(0x1.687a6e7c95176p-5, 0x1.4b0a26c5f2aefp-4);
  const Lanes series = low + z4 * (middle + z4 * high);
  const Lanes twice = s + s;
  return (exponent(a) - exponent(b)) * Lanes::broadcast(std::numbers::ln2) +
         (twice + twice * (z * series));
}

/// The same of two numbers.
inline double log_ratio(double a, double b) {
  double result[4];
  log_ratio(f64x4::broadcast(a), f64x4::broadcast(b)).store(result);
  return result[0];
}

}  // namespace AIB_ISA

}  // namespace aib::math

// aib/stats/moments.hpp

namespace aib::stats {

/// Count, mean, variance and range of a stream of numbers, mergeable. Deviations are summed about a
/// running mean, so that a small spread about a large mean is kept. Source: Chan, Golub, LeVeque,
/// "Updating formulae and a pairwise algorithm for computing sample variances", 1979.
class moments {
 public:
  /// The moments of values that were summed elsewhere: `squares` is the sum of squared deviations
  /// from `mean`. The range is not known and stays empty.
  [[nodiscard]] static moments from(std::uint64_t count, double mean, double squares) {
    moments m;
    m.count_ = count;
    m.mean_ = mean;
    m.squares_ = squares;
    return m;
  }

  void add(double value) {
    ++count_;
    const double delta = value - mean_;
    mean_ += delta / static_cast<double>(count_);
    squares_ += delta * (value - mean_);
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
  }

  moments& operator+=(const moments& other) {
    if (other.count_ == 0) return *this;
    if (count_ == 0) return *this = other;
    const auto n = static_cast<double>(count_);
    const auto m = static_cast<double>(other.count_);
    const double delta = other.mean_ - mean_;
    mean_ += delta * (m / (n + m));
    squares_ += other.squares_ + delta * delta * (n * m / (n + m));
    count_ += other.count_;
    min_ = std::min(min_, other.min_);
    max_ = std::max(max_, other.max_);
    return *this;
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double mean() const { return mean_; }  ///< 0 of nothing
  [[nodiscard]] double sum() const { return mean_ * static_cast<double>(count_); }
  [[nodiscard]] double variance() const {  ///< population (ddof 0)
    return count_ ? squares_ / static_cast<double>(count_) : 0;
  }
  [[nodiscard]] double deviation() const { return std::sqrt(variance()); }  ///< population
  [[nodiscard]] double mean_square() const { return variance() + mean_ * mean_; }
  [[nodiscard]] double min() const { return min_; }  ///< +inf of nothing
  [[nodiscard]] double max() const { return max_; }  ///< -inf of nothing

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0;
  double squares_ = 0;
  double min_ = std::numeric_limits<double>::infinity();
  double max_ = -std::numeric_limits<double>::infinity();
};

}  // namespace aib::stats

// aib/depth/error_sums.hpp

namespace aib::depth {

/// `scale * depth + shift`.
struct affine {
  double scale = 1;
  double shift = 0;

  friend bool operator==(const affine&, const affine&) = default;
};

/// Which pixels count, and what happens to an estimate before it is compared, in this order: a
/// reference counts strictly between `min` and `max`; an estimate where it is finite and > 0; it is
/// transformed, clamped, and counts where the outcome is finite and > 0.
struct pixel_rules {
  double min = 0;
  double max = std::numeric_limits<double>::infinity();
  affine transform = {};  ///< reference_from_estimate
  double clamp_min = 0;
  double clamp_max = std::numeric_limits<double>::infinity();
  double clamp_log = 0;  ///< least estimate within logarithms, other errors take it as it is
};

/// Whether the rules make another number of a valid estimate.
[[nodiscard]] constexpr bool changes_estimates(const pixel_rules& r) {
  return r.transform != affine{} || r.clamp_min > 0 || r.clamp_log > 0 ||
         r.clamp_max < std::numeric_limits<double>::infinity();
}

/// What the depth errors of a set of pixels are made of. Mergeable: `a += b`.
///
/// The log ratio ln(reference / estimate) is kept as moments, so that a small spread about a large
/// mean survives.
struct error_sums {
  stats::moments log_ratio = {};
  std::uint64_t n_reference = 0;                  ///< pixels with a valid reference
  std::uint64_t n_estimate = 0;                   ///< pixels with a valid estimate
  double abs_log = 0;                             ///< sum |ln(reference / estimate)|
  double abs_difference = 0;                      ///< sum |estimate - reference|
  double squared_difference = 0;                  ///< sum (estimate - reference)^2
  double abs_relative = 0;                        ///< sum |estimate - reference| / reference
  double squared_relative = 0;                    ///< sum (estimate - reference)^2 / reference
  double abs_inverse = 0;                         ///< sum |1 / estimate - 1 / reference|
  double squared_inverse = 0;                     ///< sum (1 / estimate - 1 / reference)^2
  std::array<std::uint64_t, 3> below_delta = {};  ///< ratios strictly below 1.25, 1.25^2, 1.25^3

  error_sums& operator+=(const error_sums& other);
};

inline error_sums& error_sums::operator+=(const error_sums& other) {
  log_ratio += other.log_ratio;
  n_reference += other.n_reference;
  n_estimate += other.n_estimate;
  abs_log += other.abs_log;
  abs_difference += other.abs_difference;
  squared_difference += other.squared_difference;
  abs_relative += other.abs_relative;
  squared_relative += other.squared_relative;
  abs_inverse += other.abs_inverse;
  squared_inverse += other.squared_inverse;
  for (std::size_t k = 0; k < 3; ++k) below_delta[k] += other.below_delta[k];
  return *this;
}

/// Throws argument_error unless `other` has the size of the estimate.
template <class Estimate, class Other>
void check_size(std::string_view function,
                raster::view<const Estimate> estimate,
                std::string_view thing,
                raster::view<const Other> other) {
  if (estimate.width == other.width && estimate.height == other.height) return;
  throw argument_error(message(function, ": the estimate is ", estimate.width, "x", estimate.height,
                               ", the ", thing, " ", other.width, "x", other.height,
                               ": downsample one to the other first"));
}

/// Throws argument_error unless both maps, and the mask where there is one, have one size.
template <class Estimate, class Reference>
void check_sizes(std::string_view function,
                 raster::view<const Estimate> estimate,
                 raster::view<const Reference> reference,
                 raster::view<const std::uint8_t> mask = {}) {
  check_size(function, estimate, "reference", reference);
  if (mask.data) check_size(function, estimate, "mask", mask);
}

namespace detail {

inline namespace AIB_ISA {

inline f64x8 load8(const double* p) { return f64x8::load(p); }
inline f64x8 load8(const float* p) { return f64x8::convert(p); }
inline f64x8 load8(const std::uint8_t* p) {
  double inside[8];
  for (std::size_t i = 0; i < 8; ++i) inside[i] = p[i] ? 1.0 : 0.0;
  return f64x8::load(inside);
}

/// Eight from `p`, of which `n` are there: the others are 0.
template <class T>
f64x8 load8(const T* p, std::size_t n) {
  if (n >= 8) return load8(p);
  T some[8] = {};
  std::copy_n(p, n, some);
  return load8(some);
}

}  // namespace AIB_ISA

}  // namespace detail

inline namespace AIB_ISA {

/// Which sums are wanted: those of the log ratio (and the counts) take half the time.
enum class error_set { all, log_ratio };

/// Adds up rows of pixels, eight at a time in fixed lanes: every instruction set gives the same
/// bits.
template <error_set Set = error_set::all>
class error_adder {
 public:
  explicit error_adder(const pixel_rules& rules)
      : rules_(rules), changes_estimate_(changes_estimates(rules)) {}

  /// Adds a row; `mask` is null or as long, of which 0 leaves a pixel out.
  template <class Estimate, class Reference>
  void add(std::span<const Estimate> estimate,
           std::span<const Reference> reference,
           const std::uint8_t* mask);

  /// The sums of all rows so far.
  [[nodiscard]] error_sums result() const;

 private:
  /// Pixels whose log ratios are kept until their mean is known.
  struct block {
    static constexpr std::size_t size = 512;
    f64x8 log_ratio[size / 8];
    f64x8 weight[size / 8];
  };
  /// A pixel that does not count is estimate = reference = 1: all its errors are 0.
  struct pixels {
    f64x8 estimate;
    f64x8 reference;
    f64x8 weight;  ///< 1 where the pixel counts, else 0
  };

  f64x8 transformed(f64x8 raw) const;
  pixels select(f64x8 estimate, f64x8 reference, const std::uint8_t* mask, std::size_t n);
  f64x8 add(const pixels& p);
  void add_errors(const pixels& p, f64x8 log_ratio);
  void add_log_ratios(const block& b, std::size_t n);

  static f64x8 number(double x) { return f64x8::broadcast(x); }
  static f64x8 is_less(f64x8 a, f64x8 b) { return choose(a, b, number(1), number(0)); }
  static f64x8 absolute(f64x8 a) { return max(a, number(0) - a); }

  pixel_rules rules_;
  bool changes_estimate_;  ///< by transform or clamp
  stats::moments log_ratio_;
  f64x8 n_reference_ = number(0);
  f64x8 n_estimate_ = number(0);
  f64x8 abs_log_ = number(0);
  f64x8 abs_difference_ = number(0);
  f64x8 squared_difference_ = number(0);
  f64x8 abs_relative_ = number(0);
  f64x8 squared_relative_ = number(0);
  f64x8 abs_inverse_ = number(0);
  f64x8 squared_inverse_ = number(0);
  f64x8 below_delta_[3] = {number(0), number(0), number(0)};
};

template <error_set Set>
template <class Estimate, class Reference>
void error_adder<Set>::add(std::span<const Estimate> estimate,
                           std::span<const Reference> reference,
                           const std::uint8_t* mask) {
  block b;
  for (std::size_t first = 0; first < estimate.size(); first += block::size) {
    const std::size_t n = std::min(block::size, estimate.size() - first);
    for (std::size_t i = 0; i < n; i += 8) {
      const std::size_t at = first + i;
      const pixels p =
          select(detail::load8(estimate.data() + at, n - i),
                 detail::load8(reference.data() + at, n - i), mask ? mask + at : nullptr, n - i);
      b.log_ratio[i / 8] = add(p);
      b.weight[i / 8] = p.weight;
    }
    add_log_ratios(b, n);
  }
}

template <error_set Set>
f64x8 error_adder<Set>::transformed(f64x8 raw) const {
  const f64x8 e = number(rules_.transform.scale) * raw + number(rules_.transform.shift);
  return min(max(e, number(rules_.clamp_min)), number(rules_.clamp_max));
}

/// Applies the rules.
template <error_set Set>
typename error_adder<Set>::pixels error_adder<Set>::select(f64x8 raw,
                                                           f64x8 reference,
                                                           const std::uint8_t* mask,
                                                           std::size_t n) {
  const f64x8 zero = number(0), inf = number(std::numeric_limits<double>::infinity());
  f64x8 e = raw;
  f64x8 has_estimate = is_less(zero, raw) * is_less(raw, inf);
  f64x8 has_reference =
      is_less(number(rules_.min), reference) * is_less(reference, number(rules_.max));
  if (changes_estimate_) {
    e = transformed(raw);
    has_estimate = has_estimate * is_less(zero, e) * is_less(e, inf);
  }
  if (mask) {
    const f64x8 inside = detail::load8(mask, n);
    has_estimate = has_estimate * inside;
    has_reference = has_reference * inside;
  }
  n_estimate_ = n_estimate_ + has_estimate;
  n_reference_ = n_reference_ + has_reference;
  const f64x8 weight = has_estimate * has_reference;
  return {.estimate = choose(zero, weight, e, number(1)),
          .reference = choose(zero, weight, reference, number(1)),
          .weight = weight};
}

/// Adds all but the moments of the log ratios, and returns those.
template <error_set Set>
f64x8 error_adder<Set>::add(const pixels& p) {
  const f64x8 e = changes_estimate_ ? max(p.estimate, number(rules_.clamp_log)) : p.estimate;
  const f64x8 log_ratio = p.weight * math::log_ratio(p.reference, e);
  if constexpr (Set == error_set::all) add_errors(p, log_ratio);
  return log_ratio;
}

template <error_set Set>
void error_adder<Set>::add_errors(const pixels& p, f64x8 log_ratio) {
  const f64x8 e = p.estimate, r = p.reference;
  const f64x8 per_reference = number(1) / r;
  const f64x8 difference = absolute(e - r);
  const f64x8 relative = difference * per_reference;
  const f64x8 inverse = absolute(number(1) / e - per_reference);
  abs_log_ = abs_log_ + absolute(log_ratio);
  abs_difference_ = abs_difference_ + difference;
  squared_difference_ = squared_difference_ + difference * difference;
  abs_relative_ = abs_relative_ + relative;
  squared_relative_ = squared_relative_ + difference * relative;
  abs_inverse_ = abs_inverse_ + inverse;
  squared_inverse_ = squared_inverse_ + inverse * inverse;
  // Without division: 1.25^k is exact in binary, and so is its product with a float.
  const f64x8 larger = max(e, r), smaller = min(e, r);
  const auto below = [&](double delta) {
    return p.weight * is_less(larger, number(delta) * smaller);
  };
  below_delta_[0] = below_delta_[0] + below(1.25);
  below_delta_[1] = below_delta_[1] + below(1.5625);
  below_delta_[2] = below_delta_[2] + below(1.953125);
}

template <error_set Set>
void error_adder<Set>::add_log_ratios(const block& b, std::size_t n) {
  f64x8 counts = number(0), total = number(0), squares = number(0);
  for (std::size_t i = 0; 8 * i < n; ++i) {
    counts = counts + b.weight[i];
    total = total + b.log_ratio[i];
  }
  const double count = sum(counts);
  const double mean = count > 0 ? sum(total) / count : 0;
  for (std::size_t i = 0; 8 * i < n; ++i) {
    const f64x8 deviation = b.log_ratio[i] - number(mean) * b.weight[i];
    squares = squares + deviation * deviation;
  }
  log_ratio_ += stats::moments::from(static_cast<std::uint64_t>(count), mean, sum(squares));
}

template <error_set Set>
error_sums error_adder<Set>::result() const {
  const auto count = [](f64x8 lanes) { return static_cast<std::uint64_t>(sum(lanes)); };
  return {.log_ratio = log_ratio_,
          .n_reference = count(n_reference_),
          .n_estimate = count(n_estimate_),
          .abs_log = sum(abs_log_),
          .abs_difference = sum(abs_difference_),
          .squared_difference = sum(squared_difference_),
          .abs_relative = sum(abs_relative_),
          .squared_relative = sum(squared_relative_),
          .abs_inverse = sum(abs_inverse_),
          .squared_inverse = sum(squared_inverse_),
          .below_delta = {count(below_delta_[0]), count(below_delta_[1]), count(below_delta_[2])}};
}

/// The sums over all pixels of a frame after one transform; nothing is fitted. Bit-identical for
/// any number of threads and instruction set. Throws argument_error if the sizes differ.
template <error_set Set = error_set::all, class Estimate, class Reference>
error_sums sum_errors(raster::view<const Estimate> estimate,
                      raster::view<const Reference> reference,
                      const pixel_rules& rules,
                      raster::view<const std::uint8_t> mask = {},
                      unsigned threads = 1) {
  check_sizes("depth::errors", estimate, reference, mask);
  constexpr std::size_t pixels_a_chunk = 1 << 16;
  const std::size_t rows = estimate.width ? 1 + pixels_a_chunk / estimate.width : 1;
  const auto sums_of = [&](const chunk& c) {
    error_adder<Set> adder(rules);
    for (std::size_t y = c.begin; y < c.end; ++y)
      adder.add(estimate.row(y), reference.row(y), mask.data ? mask.row(y).data() : nullptr);
    return adder.result();
  };
  const auto combine = [](error_sums total, const error_sums& part) { return total += part; };
  return reduce_chunks(estimate.height, rows, threads, {}, error_sums{}, sums_of, combine);
}

}  // namespace AIB_ISA

}  // namespace aib::depth

// aib/depth/fit.hpp

namespace aib::depth {

/// How the scale of an estimate, and its shift, follow from the pixels valid in both maps.
enum class alignment {
  none,          ///< the depths as they are
  median,        ///< median reference / median estimate, numpy's median
  median_lower,  ///< the same with the lower of two middle values, torch's median
  scale,         ///< least squares: sum er / sum ee
  scale_l1,      ///< least absolute differences by ten reweighted steps, as CUT3R has it
  scale_shift,   ///< least squares in scale and shift
  log,           ///< exp of the mean log ratio: the scale that srmse is blind to
};

/// Fits the scale (and shift) that takes estimates to references, over one frame, a batch or a
/// sequence: `add` every frame, then `result`. Fitters of parts merge by `a += b`.
///
/// The medians and scale_l1 keep every valid pair of pixels, 16 bytes each; the others sums alone.
class fitter {
 public:
  /// Only the validity of `rules` is used: min and max of the reference.
  explicit fitter(alignment kind = alignment::none, const pixel_rules& rules = {})
      : kind_(kind), rules_(rules) {}

  /// Throws argument_error if the sizes differ.
  template <class Estimate, class Reference>
  void add(raster::view<const Estimate> estimate,
           raster::view<const Reference> reference,
           raster::view<const std::uint8_t> mask = {});

  /// A fitter of nothing (alignment::none) becomes the other. Throws argument_error if kinds
  /// differ.
  fitter& operator+=(const fitter& other);

  /// Pixels valid in both maps, 0 for alignment::none.
  [[nodiscard]] std::uint64_t n_valid() const;

  /// Throws undefined_error if no pixel was valid in both, or if every estimate is the same while a
  /// shift is asked for. Identity for alignment::none.
  [[nodiscard]] affine result() const;

 private:
  /// Means, and sums of products of deviations from them.
  struct pair_moments {
    double n = 0;
    double mean_estimate = 0;
    double mean_reference = 0;
    double estimate_estimate = 0;
    double estimate_reference = 0;

    pair_moments& operator+=(const pair_moments& other);
  };

  [[nodiscard]] bool counts(double estimate, double reference) const {
    return estimate > 0 && std::isfinite(estimate) && reference > rules_.min &&
           reference < rules_.max;
  }
  template <class Estimate, class Reference>
  void add_row(std::span<const Estimate> estimate,
               std::span<const Reference> reference,
               const std::uint8_t* mask);
  [[nodiscard]] bool keeps_pairs() const {
    return kind_ == alignment::median || kind_ == alignment::median_lower ||
           kind_ == alignment::scale_l1;
  }
  [[nodiscard]] affine median() const;
  [[nodiscard]] affine least_absolute() const;
  [[nodiscard]] affine least_squares() const;

  alignment kind_;
  pixel_rules rules_;
  stats::moments log_ratio_;
  pair_moments pairs_;
  std::vector<double> estimates_;
  std::vector<double> references_;
};

template <class Estimate, class Reference>
void fitter::add(raster::view<const Estimate> estimate,
                 raster::view<const Reference> reference,
                 raster::view<const std::uint8_t> mask) {
  check_sizes("depth::fitter", estimate, reference, mask);
  if (kind_ == alignment::log) {
    const pixel_rules valid = {.min = rules_.min, .max = rules_.max};
    log_ratio_ += sum_errors<error_set::log_ratio>(estimate, reference, valid, mask).log_ratio;
  } else if (kind_ != alignment::none) {
    for (std::size_t y = 0; y < estimate.height; ++y)
      add_row(estimate.row(y), reference.row(y), mask.data ? mask.row(y).data() : nullptr);
  }
}

template <class Estimate, class Reference>
void fitter::add_row(std::span<const Estimate> estimate,
                     std::span<const Reference> reference,
                     const std::uint8_t* mask) {
  pair_moments row;
  // Sums about the first pair of the row, so that no digits are lost to a large mean.
  double first_e = 0, first_r = 0, sum_e = 0, sum_r = 0, sum_ee = 0, sum_er = 0;
  for (std::size_t x = 0; x < estimate.size(); ++x) {
    const auto e = static_cast<double>(estimate[x]);
    const auto r = static_cast<double>(reference[x]);
    if ((mask && mask[x] == 0) || !counts(e, r)) continue;
    if (keeps_pairs()) {
      estimates_.push_back(e);
      references_.push_back(r);
      continue;
    }
    if (row.n == 0) {
      first_e = e;
      first_r = r;
    }
    ++row.n;
    sum_e += e - first_e;
    sum_r += r - first_r;
    sum_ee += (e - first_e) * (e - first_e);
    sum_er += (e - first_e) * (r - first_r);
  }
  if (row.n == 0) return;
  row.mean_estimate = first_e + sum_e / row.n;
  row.mean_reference = first_r + sum_r / row.n;
  row.estimate_estimate = sum_ee - sum_e * sum_e / row.n;
  row.estimate_reference = sum_er - sum_e * sum_r / row.n;
  pairs_ += row;
}

inline fitter::pair_moments& fitter::pair_moments::operator+=(const pair_moments& other) {
  if (other.n == 0) return *this;
  const double share = other.n / (n + other.n);
  const double apart_e = other.mean_estimate - mean_estimate;
  const double apart_r = other.mean_reference - mean_reference;
  estimate_estimate += other.estimate_estimate + apart_e * apart_e * n * share;
  estimate_reference += other.estimate_reference + apart_e * apart_r * n * share;
  mean_estimate += apart_e * share;
  mean_reference += apart_r * share;
  n += other.n;
  return *this;
}

inline fitter& fitter::operator+=(const fitter& other) {
  if (kind_ == alignment::none) return *this = other;
  if (other.kind_ != kind_) throw argument_error("depth::fitter: merged fits differ in kind");
  log_ratio_ += other.log_ratio_;
  pairs_ += other.pairs_;
  estimates_.insert(estimates_.end(), other.estimates_.begin(), other.estimates_.end());
  references_.insert(references_.end(), other.references_.begin(), other.references_.end());
  return *this;
}

inline std::uint64_t fitter::n_valid() const {
  return log_ratio_.count() + static_cast<std::uint64_t>(pairs_.n) + estimates_.size();
}

inline affine fitter::result() const {
  if (kind_ == alignment::none) return {};
  if (n_valid() == 0)
    throw undefined_error("depth::fitter: no pixel is valid in estimate and reference");
  switch (kind_) {
    case alignment::median:
    case alignment::median_lower:
      return median();
    case alignment::scale_l1:
      return least_absolute();
    case alignment::log:
      return {std::exp(log_ratio_.mean()), 0};
    default:
      return least_squares();
  }
}

inline affine fitter::median() const {
  const auto rule =
      kind_ == alignment::median ? stats::quantile_rule::midpoint : stats::quantile_rule::lower;
  const std::span<const double> e = estimates_, r = references_;
  return {stats::quantile(r, 0.5, rule) / stats::quantile(e, 0.5, rule), 0};
}

/// Weiszfeld's reweighted least squares, started at the ratio of the means and stopped after ten
/// steps: close to the least absolute differences, and the number CUT3R and pi3 report.
inline affine fitter::least_absolute() const {
  constexpr int steps = 10;
  constexpr double least_residual = 1e-8;
  double sum_estimate = 0, sum_reference = 0;
  for (const double e : estimates_) sum_estimate += e;
  for (const double r : references_) sum_reference += r;
  double scale = sum_reference / sum_estimate;
  for (int step = 0; step < steps; ++step) {
    double estimate_reference = 0, estimate_estimate = 0;
    for (std::size_t i = 0; i < estimates_.size(); ++i) {
      const double e = estimates_[i], r = references_[i];
      const double weight = 1 / (std::abs(scale * e - r) + least_residual);
      estimate_reference += weight * e * r;
      estimate_estimate += weight * e * e;
    }
    scale = estimate_reference / estimate_estimate;
  }
  return {scale, 0};
}

inline affine fitter::least_squares() const {
  const pair_moments& p = pairs_;
  if (kind_ == alignment::scale) {
    return {(p.estimate_reference + p.n * p.mean_estimate * p.mean_reference) /
                (p.estimate_estimate + p.n * p.mean_estimate * p.mean_estimate),
            0};
  }
  if (!(p.estimate_estimate > 0)) {
    throw undefined_error(message("depth::fitter: scale and shift of ", n_valid(),
                                  " pixels with one and the same estimate"));
  }
  const double scale = p.estimate_reference / p.estimate_estimate;
  return {scale, p.mean_reference - scale * p.mean_estimate};
}

}  // namespace aib::depth

// aib/depth/label_sums.hpp

namespace aib::depth {

/// Sums of the pixels of each label.
using label_sums = std::map<std::uint16_t, error_sums>;

inline label_sums& operator+=(label_sums& total, const label_sums& other) {
  for (const auto& [label, sums] : other) total[label] += sums;
  return total;
}

inline namespace AIB_ISA {

/// What sum_errors gives, for the pixels of each label that occurs, 0 among them.
///
/// labels   h x w: glass, frame, truss ... Throws argument_error if the sizes differ.
template <class Estimate, class Reference>
label_sums sum_errors_by_label(raster::view<const Estimate> estimate,
                               raster::view<const Reference> reference,
                               raster::view<const std::uint16_t> labels,
                               const pixel_rules& rules,
                               raster::view<const std::uint8_t> mask = {}) {
  check_sizes("depth::errors", estimate, reference, mask);
  check_size("depth::errors", estimate, "label image", labels);
  std::map<std::uint16_t, error_adder<>> adders;
  for (std::size_t y = 0; y < labels.height; ++y) {
    const auto row = labels.row(y);
    for (std::size_t first = 0, end = 0; first < row.size(); first = end) {
      while (end < row.size() && row[end] == row[first]) ++end;
      adders.try_emplace(row[first], rules)
          .first->second.add(estimate.row(y).subspan(first, end - first),
                             reference.row(y).subspan(first, end - first),
                             mask.data ? mask.row(y).data() + first : nullptr);
    }
  }
  label_sums sums;
  for (const auto& [label, adder] : adders) sums.emplace(label, adder.result());
  return sums;
}

}  // namespace AIB_ISA

}  // namespace aib::depth

// aib/depth/errors.hpp

namespace aib::depth {

/// See pixel_rules for the order of the steps and for `clamp_log`.
struct error_options {
  alignment align = alignment::none;                     ///< fitted to this frame
  double min = 0;                                        ///< a reference counts above it, exclusive
  double max = std::numeric_limits<double>::infinity();  ///< and below it, exclusive
  raster::view<const std::uint8_t> mask = {};            ///< none, or 0 where a pixel is left out
  raster::view<const std::uint16_t> labels = {};         ///< none, or what each pixel shows
  crop_rule crop = crop_rule::none;                      ///< the rest is left out
  affine transform = {};  ///< of a batch or sequence (see fitter), where nothing is aligned here
  double clamp_min = 0;   ///< smaller estimates become this
  double clamp_max = std::numeric_limits<double>::infinity();  ///< larger ones this
  double clamp_log = 0;                                        ///< the same in logarithms alone
  unsigned threads = 1;  ///< 0: all. A frame takes milliseconds: give threads to the frames
};

/// Errors of an estimated depth map over the V pixels valid in estimate and reference;
/// d = ln(reference / estimate), lengths in the unit of the maps. `scale` and `shift` took the
/// estimate to the reference.
struct error_summary {
  double srmse;        ///< mean (d - mean d)^2, the formula of the paper: no root
  double si_log_rmse;  ///< its root
  double silog;        ///< 100 times that root, KITTI's
  double abs_rel;      ///< mean |e - r| / r
  double sq_rel;       ///< mean (e - r)^2 / r
  double rmse;         ///< root of mean (e - r)^2
  double mae;          ///< mean |e - r|
  double rmse_log;     ///< root of mean d^2
  double log10;        ///< mean |log10 e - log10 r|
  double irmse;        ///< root of mean (1 / e - 1 / r)^2
  double imae;         ///< mean |1 / e - 1 / r|
  double delta1;       ///< share with max(e / r, r / e) < 1.25
  double delta2;       ///< ... < 1.25^2
  double delta3;       ///< ... < 1.25^3
  double coverage;     ///< V / valid pixels of the reference
  double scale;
  double shift;
  std::uint64_t n_valid;      ///< V
  std::uint64_t n_reference;  ///< valid pixels of the reference
  std::uint64_t n_estimate;   ///< valid pixels of the estimate
};

/// Name of a number of error_summary, and where it is.
struct error_field {
  std::string_view name;
  double error_summary::*value;
};

/// Every number of error_summary but the counts, in its order: for tables and means.
inline constexpr std::array<error_field, 17> error_fields{{
    {"srmse", &error_summary::srmse},
    {"si_log_rmse", &error_summary::si_log_rmse},
    {"silog", &error_summary::silog},
    {"abs_rel", &error_summary::abs_rel},
    {"sq_rel", &error_summary::sq_rel},
    {"rmse", &error_summary::rmse},
    {"mae", &error_summary::mae},
    {"rmse_log", &error_summary::rmse_log},
    {"log10", &error_summary::log10},
    {"irmse", &error_summary::irmse},
    {"imae", &error_summary::imae},
    {"delta1", &error_summary::delta1},
    {"delta2", &error_summary::delta2},
    {"delta3", &error_summary::delta3},
    {"coverage", &error_summary::coverage},
    {"scale", &error_summary::scale},
    {"shift", &error_summary::shift},
}};

/// Whether a number is a share, of which more is better.
[[nodiscard]] constexpr bool is_share(double error_summary::*field) {
  return field == &error_summary::delta1 || field == &error_summary::delta2 ||
         field == &error_summary::delta3 || field == &error_summary::coverage;
}

/// The errors that sums amount to. Throws undefined_error, with the counts, if no pixel was valid.
error_summary summarize(const error_sums& sums, const affine& transform = {});

/// Errors of one depth map against its reference.
///
/// estimate   h x w, float or double
/// reference  h x w, float or double
///
/// The caller downsamples: maps of two sizes are an argument_error that names both. Throws
/// undefined_error, with the counts, if no pixel is valid in both.
/// Source: Eigen, Puhrsch, Fergus, "Depth map prediction from a single image using a multi-scale
/// deep network", NeurIPS 2014; silog and irmse: KITTI depth benchmark, Uhrig et al., 3DV 2017.
template <class Estimate, class Reference>
error_summary errors(raster::view<const Estimate> estimate,
                     raster::view<const Reference> reference,
                     const error_options& options = {});

/// The part of the options that does not depend on the frame.
[[nodiscard]] inline pixel_rules rules_of(const error_options& o) {
  return {.min = o.min,
          .max = o.max,
          .transform = o.transform,
          .clamp_min = o.clamp_min,
          .clamp_max = o.clamp_max,
          .clamp_log = o.clamp_log};
}

inline error_summary summarize(const error_sums& sums, const affine& transform) {
  const std::uint64_t n_valid = sums.log_ratio.count();
  if (n_valid == 0) {
    throw undefined_error(message("depth::errors: no pixel is valid in both maps, ",
                                  sums.n_estimate, " in the estimate, ", sums.n_reference,
                                  " in the reference"));
  }
  const auto n = static_cast<double>(n_valid);
  const auto share = [&](std::size_t k) { return static_cast<double>(sums.below_delta[k]) / n; };
  return {
      .srmse = sums.log_ratio.variance(),
      .si_log_rmse = sums.log_ratio.deviation(),
      .silog = 100 * sums.log_ratio.deviation(),
      .abs_rel = sums.abs_relative / n,
      .sq_rel = sums.squared_relative / n,
      .rmse = std::sqrt(sums.squared_difference / n),
      .mae = sums.abs_difference / n,
      .rmse_log = std::sqrt(sums.log_ratio.mean_square()),
      .log10 = sums.abs_log / n / std::numbers::ln10,
      .irmse = std::sqrt(sums.squared_inverse / n),
      .imae = sums.abs_inverse / n,
      .delta1 = share(0),
      .delta2 = share(1),
      .delta3 = share(2),
      .coverage = n / static_cast<double>(sums.n_reference),
      .scale = transform.scale,
      .shift = transform.shift,
      .n_valid = n_valid,
      .n_reference = sums.n_reference,
      .n_estimate = sums.n_estimate,
  };
}

/// The sums of a frame, and what took its estimates to its references: the fit that the options ask
/// for, or their transform.
struct frame_sums {
  error_sums sums;
  affine transform = {};
  label_sums by_label = {};  ///< where the options have labels
};

/// A frame without a valid pixel has the identity for a fit. Throws argument_error if the sizes
/// differ, or if the options have both a fit and a transform.
template <error_set Set = error_set::all, class Estimate, class Reference>
frame_sums measure(raster::view<const Estimate> estimate,
                   raster::view<const Reference> reference,
                   const error_options& options) {
  check_sizes("depth::errors", estimate, reference, options.mask);
  if (options.labels.data) check_size("depth::errors", estimate, "label image", options.labels);
  estimate = cropped(estimate, options.crop);
  reference = cropped(reference, options.crop);
  const raster::view<const std::uint8_t> mask = cropped(options.mask, options.crop);
  const raster::view<const std::uint16_t> labels = cropped(options.labels, options.crop);
  pixel_rules rules = rules_of(options);
  if (options.align != alignment::none) {
    if (options.transform != affine{})
      throw argument_error("depth::errors: either `align` or `transform` expected, found both");
    fitter fit(options.align, rules);
    fit.add(estimate, reference, mask);
    if (fit.n_valid() > 0) rules.transform = fit.result();
  }
  frame_sums frame{sum_errors<Set>(estimate, reference, rules, mask, options.threads),
                   rules.transform};
  if (labels.data) frame.by_label = sum_errors_by_label(estimate, reference, labels, rules, mask);
  return frame;
}

/// The srmse of `errors` alone, to the same bits, in half the time. Throws as `errors` does.
template <class Estimate, class Reference>
double srmse(raster::view<const Estimate> estimate,
             raster::view<const Reference> reference,
             const error_options& options = {}) {
  const frame_sums frame = measure<error_set::log_ratio>(estimate, reference, options);
  return summarize(frame.sums, frame.transform).srmse;
}

template <class Estimate, class Reference>
error_summary errors(raster::view<const Estimate> estimate,
                     raster::view<const Reference> reference,
                     const error_options& options) {
  const frame_sums frame = measure(estimate, reference, options);
  return summarize(frame.sums, frame.transform);
}

/// What is known of a set of pixels: its sums, and its errors where it has a valid pixel.
struct error_record {
  error_sums sums = {};
  std::optional<error_summary> errors = {};
};

[[nodiscard]] inline error_record record_of(const error_sums& sums, const affine& transform) {
  error_record record{sums};
  if (sums.log_ratio.count() > 0) record.errors = summarize(sums, transform);
  return record;
}

/// Errors of the pixels of each label that occurs in `options.labels`: of glass, frame, truss ...
/// Where something is fitted, it is fitted to the whole frame. Throws argument_error where there
/// are no labels, and as errors does.
template <class Estimate, class Reference>
std::map<std::uint16_t, error_record> errors_by_label(raster::view<const Estimate> estimate,
                                                      raster::view<const Reference> reference,
                                                      const error_options& options) {
  if (!options.labels.data) throw argument_error("depth::errors_by_label: labels expected");
  const frame_sums frame = measure(estimate, reference, options);
  std::map<std::uint16_t, error_record> records;
  for (const auto& [label, sums] : frame.by_label)
    records.emplace(label, record_of(sums, frame.transform));
  return records;
}

template <class Estimate, class Reference>
error_summary errors(const basic_depth_map<Estimate>& estimate,
                     const basic_depth_map<Reference>& reference,
                     const error_options& options = {}) {
  return errors(estimate.values.view(), reference.values.view(), options);
}

}  // namespace aib::depth

// aib/depth/accumulate.hpp

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

// aib/depth/boundary.hpp

namespace aib::depth {

struct boundary_options {
  double t_min = 1.05;  ///< least ratio of two neighbours' depths at a boundary
  double t_max = 1.25;  ///< the largest of the thresholds
  std::size_t n = 10;   ///< thresholds, evenly spaced, weighted by their size
};

/// Boundary F1 of Depth Pro: do occluding contours lie at the same two neighbours, facing the same
/// of four ways? It does not see the scale. 0..1, higher is better.
///
/// What to know of the definition, which is kept: a contour one pixel off is a miss; the mean is
/// over the four ways even where the reference has contours facing one alone, so that a perfect
/// estimate of a vertical step scores 0.25; without any contour it is 0. Depths below 1e-6 become
/// 1e-6 (a hole in either map is a contour around it); a pair with NaN is none.
///
/// Throws argument_error if the sizes differ or n is 0.
/// Source: Bochkovskii et al., "Depth Pro: sharp monocular metric depth in less than a second",
/// 2024.
[[nodiscard]] double boundary_f1(raster::view<const float> estimate,
                                 raster::view<const float> reference,
                                 const boundary_options& options = {});

namespace detail {

/// Contours that face one way: of the estimate, of the reference, of both.
struct contour_counts {
  std::uint64_t estimate = 0;
  std::uint64_t reference = 0;
  std::uint64_t both = 0;
};

/// NaN stays NaN, as in NumPy's clip.
inline double inverse_depth(float depth) {
  return 1 / (depth < 1e-6f ? 1e-6 : static_cast<double>(depth));
}

inline void count_pair(double e_ratio, double r_ratio, double t, contour_counts& to) {
  const bool e = e_ratio > t, r = r_ratio > t;
  to.estimate += e;
  to.reference += r;
  to.both += e && r;
}

/// Left, right, top, bottom.
inline std::array<contour_counts, 4> count_contours(raster::view<const float> estimate,
                                                    raster::view<const float> reference,
                                                    double t) {
  std::array<contour_counts, 4> counts{};
  const auto count = [&](std::size_t x, std::size_t y, std::size_t next_x, std::size_t next_y,
                         std::size_t way) {
    const double e = inverse_depth(estimate(x, y)), r = inverse_depth(reference(x, y));
    const double next_e = inverse_depth(estimate(next_x, next_y));
    const double next_r = inverse_depth(reference(next_x, next_y));
    count_pair(e / next_e, r / next_r, t, counts[way]);
    count_pair(next_e / e, next_r / r, t, counts[way + 1]);
  };
  for (std::size_t y = 0; y < estimate.height; ++y) {
    for (std::size_t x = 0; x < estimate.width; ++x) {
      if (x + 1 < estimate.width) count(x, y, x + 1, y, 0);
      if (y + 1 < estimate.height) count(x, y, x, y + 1, 2);
    }
  }
  return counts;
}

inline double f1_of(const std::array<contour_counts, 4>& counts) {
  const auto share = [](std::uint64_t part, std::uint64_t whole) {
    return static_cast<double>(part) / static_cast<double>(std::max<std::uint64_t>(whole, 1));
  };
  double recall = 0, precision = 0;
  for (const contour_counts& c : counts) {
    recall += share(c.both, c.reference) / 4;
    precision += share(c.both, c.estimate) / 4;
  }
  return recall + precision > 0 ? 2 * recall * precision / (recall + precision) : 0;
}

}  // namespace detail

inline double boundary_f1(raster::view<const float> estimate,
                          raster::view<const float> reference,
                          const boundary_options& options) {
  check_sizes("depth::boundary_f1", estimate, reference);
  if (options.n == 0) throw argument_error("depth::boundary_f1: n >= 1 expected, found 0");
  const double intervals = static_cast<double>(std::max<std::size_t>(options.n - 1, 1));
  const double step = (options.t_max - options.t_min) / intervals;
  double total = 0, weights = 0;
  for (std::size_t k = 0; k < options.n; ++k) {
    const double t = options.t_min + static_cast<double>(k) * step;
    total += t * detail::f1_of(detail::count_contours(estimate, reference, t));
    weights += t;
  }
  return total / weights;
}

}  // namespace aib::depth

// aib/raster/canny.hpp

namespace aib::raster {

struct canny_options {
  double sigma = 1;   ///< of the Gaussian, pixels; cut off at four of them
  double low = 0.1;   ///< Sobel gradients (8 times the slope) from here on continue an edge
  double high = 0.2;  ///< and from here on begin one
};

/// Edges of a picture, one pixel wide: 1, else 0. The outermost pixels are no edges, nor is a pixel
/// whose surroundings hold a NaN. Beyond the picture nothing is weighed. Source: Canny, "A
/// computational approach to edge detection", PAMI 1986, as scikit-image has it.
[[nodiscard]] image<std::uint8_t> canny(view<const float> picture,
                                        const canny_options& options = {});

namespace detail {

inline std::vector<double> gaussian_weights(double sigma) {
  const auto radius = static_cast<std::size_t>(4 * sigma + 0.5);
  std::vector<double> weights(2 * radius + 1);
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double x = static_cast<double>(i) - static_cast<double>(radius);
    sum += weights[i] = std::exp(-0.5 * x * x / (sigma * sigma));
  }
  for (double& w : weights) w /= sum;
  return weights;
}

enum class axis { x, y };

/// Sums along an axis, weighted; beyond the picture there is 0.
inline image<float> summed_along(const image<float>& from,
                                 const std::vector<double>& weights,
                                 axis along) {
  const std::size_t radius = weights.size() / 2;
  const bool rows = along == axis::x;
  const std::size_t length = rows ? from.width() : from.height();
  image<float> to(from.width(), from.height());
  for (std::size_t y = 0; y < from.height(); ++y) {
    for (std::size_t x = 0; x < from.width(); ++x) {
      const std::size_t at = rows ? x : y;
      double sum = 0;
      for (std::size_t k = at < radius ? radius - at : 0;
           k < weights.size() && at + k - radius < length; ++k) {
        const std::size_t i = at + k - radius;
        sum += weights[k] * static_cast<double>(rows ? from(i, y) : from(x, i));
      }
      to(x, y) = static_cast<float>(sum);
    }
  }
  return to;
}

/// What of the weights falls inside, for each place of an axis.
inline std::vector<double> weight_inside(const std::vector<double>& weights, std::size_t length) {
  const std::size_t radius = weights.size() / 2;
  std::vector<double> inside(length);
  for (std::size_t at = 0; at < length; ++at) {
    for (std::size_t k = 0; k < weights.size(); ++k)
      if (at + k >= radius && at + k - radius < length) inside[at] += weights[k];
  }
  return inside;
}

/// Gaussian mean over what lies inside of the picture.
inline image<float> smoothed(const image<float>& picture, double sigma) {
  const std::vector<double> weights = gaussian_weights(sigma);
  image<float> smooth = summed_along(summed_along(picture, weights, axis::y), weights, axis::x);
  const std::vector<double> across = weight_inside(weights, picture.width());
  const std::vector<double> down = weight_inside(weights, picture.height());
  for (std::size_t y = 0; y < picture.height(); ++y) {
    for (std::size_t x = 0; x < picture.width(); ++x)
      smooth(x, y) = static_cast<float>(static_cast<double>(smooth(x, y)) / (across[x] * down[y]));
  }
  return smooth;
}

/// Sobel gradients; beyond the picture its outermost pixels go on.
struct gradients {
  image<float> x, y, magnitude;
};

inline gradients sobel(const image<float>& p) {
  const image<float> blank(p.width(), p.height());
  gradients g{blank, blank, blank};
  for (std::size_t y = 0; y < p.height(); ++y) {
    const std::size_t up = y > 0 ? y - 1 : y, down = y + 1 < p.height() ? y + 1 : y;
    for (std::size_t x = 0; x < p.width(); ++x) {
      const std::size_t left = x > 0 ? x - 1 : x, right = x + 1 < p.width() ? x + 1 : x;
      const auto across = [&](std::size_t v) { return p(right, v) - p(left, v); };
      const auto along = [&](std::size_t u) { return p(u, down) - p(u, up); };
      g.x(x, y) = across(up) + 2 * across(y) + across(down);
      g.y(x, y) = along(left) + 2 * along(x) + along(right);
      g.magnitude(x, y) = std::hypot(g.x(x, y), g.y(x, y));
    }
  }
  return g;
}

/// Whether the gradients before and behind an inner pixel, in the direction of its own, are not
/// larger. They are interpolated between two of the eight neighbours.
inline bool is_ridge(const gradients& g, std::size_t x, std::size_t y) {
  const float gx = g.x(x, y), gy = g.y(x, y), m = g.magnitude(x, y);
  if (!(m > 0)) return false;
  const bool steep = std::abs(gy) >= std::abs(gx);
  const float share = steep ? std::abs(gx / gy) : std::abs(gy / gx);
  const std::ptrdiff_t turn = (gx < 0) == (gy < 0) ? 1 : -1;
  const auto at = [&](std::ptrdiff_t dx, std::ptrdiff_t dy) {
    return g.magnitude(x + static_cast<std::size_t>(dx), y + static_cast<std::size_t>(dy));
  };
  const auto beside = [&](std::ptrdiff_t way) {
    const float straight = steep ? at(0, way) : at(way, 0);
    const float diagonal = steep ? at(turn * way, way) : at(way, turn * way);
    return diagonal * share + straight * (1 - share);
  };
  return beside(1) <= m && beside(-1) <= m;
}

/// Marks what of `candidates` hangs together with pixel `from`, over sides and corners.
inline void follow(std::size_t from,
                   const image<std::uint8_t>& candidates,
                   image<std::uint8_t>& edges) {
  std::vector<std::size_t> open = {from};
  edges.data()[from] = 1;
  while (!open.empty()) {
    const std::size_t x = open.back() % edges.width(), y = open.back() / edges.width();
    open.pop_back();
    for (std::size_t v = y - 1; v != y + 2; ++v) {  // candidates are inner pixels
      for (std::size_t u = x - 1; u != x + 2; ++u) {
        if (!candidates(u, v) || edges(u, v)) continue;
        edges(u, v) = 1;
        open.push_back(v * edges.width() + u);
      }
    }
  }
}

}  // namespace detail

inline image<std::uint8_t> canny(view<const float> picture, const canny_options& options) {
  image<float> own(picture.width, picture.height);
  for (std::size_t y = 0; y < picture.height; ++y)
    std::copy_n(picture.row(y).begin(), picture.width, own.data() + y * picture.width);
  const detail::gradients g = detail::sobel(detail::smoothed(own, options.sigma));
  image<std::uint8_t> candidates(picture.width, picture.height), edges = candidates;
  for (std::size_t y = 1; y + 1 < picture.height; ++y) {
    for (std::size_t x = 1; x + 1 < picture.width; ++x)
      candidates(x, y) =
          static_cast<double>(g.magnitude(x, y)) >= options.low && detail::is_ridge(g, x, y);
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (candidates.data()[i] && !edges.data()[i] &&
        static_cast<double>(g.magnitude.data()[i]) >= options.high)
      detail::follow(i, candidates, edges);
  }
  return edges;
}

}  // namespace aib::raster

// aib/depth/boundary_errors.hpp

namespace aib::depth {

/// How far the depth edges of an estimate lie from those of the truth, pixels.
struct boundary_errors {
  double accuracy;          ///< mean distance of estimated edges, of those nearer than 10 pixels
  double completeness;      ///< mean distance of both from each other, cut at 10 pixels
  std::size_t n_estimate;   ///< pixels of estimated edges
  std::size_t n_reference;  ///< pixels of true edges
};

/// Depth edges as iBims-1 finds them: Canny (sigma root 2, 0.15, 0.3) of the map scaled to 0..1. A
/// pixel without depth hides the edges near it. Without two different depths there is no edge.
[[nodiscard]] raster::image<std::uint8_t> depth_edges(raster::view<const float> depth);

/// Depth boundary errors (DBE). `edges` are the true ones, not 0: drawn by hand, or depth_edges of
/// the reference. Without an estimated edge near a true one both errors are 10.
///
/// Throws argument_error if the sizes differ, undefined_error if there is no true edge.
/// Source: Koch et al., "Evaluation of CNN-based single-image depth estimation methods", 2018,
/// Eqs. (9), (10), as iBims-1's Python script calculates them.
[[nodiscard]] boundary_errors boundary_error(raster::view<const float> estimate,
                                             raster::view<const std::uint8_t> edges);

namespace detail {

inline constexpr std::size_t edge_reach = 10;

/// Distance to the nearest edge pixel, at most edge_reach.
inline double distance_to(raster::view<const std::uint8_t> edges, std::size_t x, std::size_t y) {
  std::size_t least = edge_reach * edge_reach;
  const auto low = [](std::size_t i) { return i - std::min(i, edge_reach); };
  for (std::size_t v = low(y); v < std::min(y + edge_reach + 1, edges.height); ++v) {
    for (std::size_t u = low(x); u < std::min(x + edge_reach + 1, edges.width); ++u) {
      const std::size_t dx = u > x ? u - x : x - u, dy = v > y ? v - y : y - v;
      if (edges(u, v) && dx * dx + dy * dy < least) least = dx * dx + dy * dy;
    }
  }
  return std::sqrt(static_cast<double>(least));
}

/// Distances of edge pixels to the nearest of other edges.
struct edge_distances {
  std::size_t n = 0;
  double sum = 0;
  std::size_t n_near = 0;  ///< nearer than edge_reach
  double sum_near = 0;
};

inline edge_distances distances_of(raster::view<const std::uint8_t> edges,
                                   raster::view<const std::uint8_t> others) {
  edge_distances d;
  for (std::size_t y = 0; y < edges.height; ++y) {
    for (std::size_t x = 0; x < edges.width; ++x) {
      if (!edges(x, y)) continue;
      const double distance = distance_to(others, x, y);
      ++d.n;
      d.sum += distance;
      if (distance >= edge_reach) continue;
      ++d.n_near;
      d.sum_near += distance;
    }
  }
  return d;
}

}  // namespace detail

inline raster::image<std::uint8_t> depth_edges(raster::view<const float> depth) {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  float least = std::numeric_limits<float>::infinity(), most = 0;
  for (std::size_t y = 0; y < depth.height; ++y) {
    for (const float z : depth.row(y)) {
      if (!is_valid(z)) continue;
      least = std::min(least, z);
      most = std::max(most, z);
    }
  }
  raster::image<float> scaled(depth.width, depth.height, none);
  if (!(most > least)) return {depth.width, depth.height};
  for (std::size_t y = 0; y < depth.height; ++y) {
    for (std::size_t x = 0; x < depth.width; ++x) {
      if (is_valid(depth(x, y))) scaled(x, y) = (depth(x, y) - least) / (most - least);
    }
  }
  return raster::canny(scaled, {.sigma = std::numbers::sqrt2, .low = 0.15, .high = 0.3});
}

inline boundary_errors boundary_error(raster::view<const float> estimate,
                                      raster::view<const std::uint8_t> edges) {
  if (estimate.width != edges.width || estimate.height != edges.height) {
    throw argument_error(message("depth::boundary_error: the estimate is ", estimate.width, "x",
                                 estimate.height, ", the edges are ", edges.width, "x",
                                 edges.height));
  }
  const raster::image<std::uint8_t> found = depth_edges(estimate);
  const detail::edge_distances of_estimate = detail::distances_of(found, edges);
  const detail::edge_distances of_reference = detail::distances_of(edges, found);
  if (of_reference.n == 0) throw undefined_error("depth::boundary_error: no true edge");
  boundary_errors out{detail::edge_reach, detail::edge_reach, of_estimate.n, of_reference.n};
  if (of_estimate.n_near == 0) return out;
  out.accuracy = of_estimate.sum_near / static_cast<double>(of_estimate.n_near);
  out.completeness =
      (of_estimate.sum + of_reference.sum) / static_cast<double>(of_estimate.n + of_reference.n);
  return out;
}

}  // namespace aib::depth

// aib/raster/downsample.hpp

namespace aib::raster {

/// Which source pixel a target pixel takes.
enum class nearest_rule {
  centre,  ///< under the target's centre: ((2i + 1) N) div 2n
  floor,   ///< floor(i N / n), OpenCV's INTER_NEAREST
};

/// Source index of target index i when N samples become n. Integer arithmetic: ties never depend on
/// rounding.
[[nodiscard]] constexpr std::size_t nearest_index(std::size_t i,
                                                  std::size_t N,
                                                  std::size_t n,
                                                  nearest_rule rule) {
  return rule == nearest_rule::centre ? ((2 * i + 1) * N) / (2 * n) : (i * N) / n;
}

/// The image at another size by nearest neighbour: no value is made up, edges and invalid pixels do
/// not bleed. Throws argument_error if a target size is 0 or the image is empty.
template <class T>
[[nodiscard]] image<T> resample_nearest(view<const T> source,
                                        std::size_t width,
                                        std::size_t height,
                                        nearest_rule rule = nearest_rule::centre) {
  if (width == 0 || height == 0 || source.empty()) {
    throw argument_error(message("raster::resample_nearest: cannot make ", width, "x", height,
                                 " of ", source.width, "x", source.height));
  }
  std::vector<std::size_t> column(width);
  for (std::size_t x = 0; x < width; ++x) column[x] = nearest_index(x, source.width, width, rule);
  image<T> target(width, height);
  for (std::size_t y = 0; y < height; ++y) {
    const auto from = source.row(nearest_index(y, source.height, height, rule));
    for (std::size_t x = 0; x < width; ++x) target(x, y) = from[column[x]];
  }
  return target;
}

}  // namespace aib::raster

// aib/raster/draw.hpp

namespace aib::raster {

/// Copies an image into another at (x, y); what lies outside is cut off.
inline void paste(color_image& onto, view<const rgb> image, std::size_t x, std::size_t y) {
  if (x >= onto.width()) return;
  const std::size_t width = std::min(image.width, onto.width() - x);
  for (std::size_t row = 0; row < image.height && y + row < onto.height(); ++row)
    std::copy_n(image.row(row).begin(), width, &onto(x, y + row));
}

/// Size of a character of draw_number with the gap behind it, at scale 1.
inline constexpr std::size_t character_width = 4;
inline constexpr std::size_t character_height = 5;

/// Writes a number into an image at (x, y), `scale` pixels a dot. Knows the characters
/// "0123456789.-+%"; others are blank. What lies outside is cut off.
void draw_number(color_image& onto,
                 std::string_view text,
                 std::size_t x,
                 std::size_t y,
                 const rgb& color,
                 std::size_t scale = 2);

/// Pictures in rows of `columns`, each shrunk (nearest neighbour) to `width` pixels in the shape of
/// the first, on white. No picture gives an empty image.
color_image contact_sheet(std::span<const color_image> pictures,
                          std::size_t columns,
                          std::size_t width);

namespace detail {

/// Rows of three dots, the highest row in the highest bits.
inline std::uint16_t dots_of(char c) {
  constexpr std::string_view known = "0123456789.-+%";
  constexpr std::array<std::uint16_t, 14> dots = {
      0b111'101'101'101'111, 0b010'110'010'010'111, 0b111'001'111'100'111, 0b111'001'111'001'111,
      0b101'101'111'001'001, 0b111'100'111'001'111, 0b111'100'111'101'111, 0b111'001'001'010'010,
      0b111'101'111'101'111, 0b111'101'111'001'111, 0b000'000'000'000'010, 0b000'000'111'000'000,
      0b000'010'111'010'000, 0b101'001'010'100'101};
  const std::size_t at = known.find(c);
  return at == std::string_view::npos ? std::uint16_t{0} : dots[at];
}

}  // namespace detail

inline void draw_number(color_image& onto,
                        std::string_view text,
                        std::size_t x,
                        std::size_t y,
                        const rgb& color,
                        std::size_t scale) {
  for (const char c : text) {
    const unsigned dots = detail::dots_of(c);
    for (std::size_t py = 0; py < 5 * scale; ++py) {
      for (std::size_t px = 0; px < 3 * scale; ++px) {
        const std::size_t bit = 14 - (3 * (py / scale) + px / scale);
        if ((dots >> bit & 1u) && x + px < onto.width() && y + py < onto.height())
          onto(x + px, y + py) = color;
      }
    }
    x += character_width * scale;
  }
}

inline color_image contact_sheet(std::span<const color_image> pictures,
                                 std::size_t columns,
                                 std::size_t width) {
  if (pictures.empty() || columns == 0 || width == 0) return {};
  constexpr std::size_t gap = 6;
  const color_image& first = pictures.front();
  const std::size_t height = std::max<std::size_t>(1, width * first.height() / first.width());
  columns = std::min(columns, pictures.size());
  const std::size_t rows = (pictures.size() + columns - 1) / columns;
  color_image sheet(columns * (width + gap) + gap, rows * (height + gap) + gap, {255, 255, 255});
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const color_image small = resample_nearest(pictures[i].view(), width, height);
    paste(sheet, small.view(), gap + i % columns * (width + gap),
          gap + i / columns * (height + gap));
  }
  return sheet;
}

}  // namespace aib::raster

// aib/depth/error_image.hpp

namespace aib::depth {

struct error_image_options {
  error_options errors = {};  ///< which pixels count, and what takes the estimate to the reference
  double near = 0;            ///< depth of the first colour; 0: 1 % of the references are nearer
  double far = 0;             ///< depth of the last colour; 0: 1 % of the references are farther
  double largest = 0;  ///< relative error of the last colour; 0: 95 % of the errors are smaller
};

/// Three panels side by side: the estimate as transformed, the reference, and the signed error
/// (estimate - reference) / reference. Depths share one scale from blue (near) to yellow (far);
/// the error is blue where the estimate is too near, red where it is too far. Pixels without a
/// value are hatched grey. Below are the scales with their numbers.
///
/// Throws as `errors` does.
[[nodiscard]] raster::color_image error_image(const depth_map& estimate,
                                              const depth_map& reference,
                                              const error_image_options& options = {});

namespace detail {

/// The largest and smallest number that colours stand for.
struct color_range {
  double low;
  double high;
};

inline raster::rgb hatch(std::size_t x, std::size_t y) {
  const std::uint8_t grey = (x + y) / 3 % 2 ? 120 : 95;
  return {grey, grey, grey};
}

/// "12.3": four characters or so, plain notation.
inline std::string short_number(double value) {
  const double size = std::abs(value);
  if (size == 0) return "0";
  const int digits = size >= 100 ? 0 : size >= 10 ? 1 : size >= 0.1 ? 2 : 4;
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits);
  return {text, end.ptr};
}

/// A bar of colours with its lowest, middle and highest number below.
template <class Color>
raster::color_image scale_bar(
    std::size_t width, const color_range& range, double unit, const char* suffix, Color color) {
  constexpr std::size_t bar = 12, gap = 4, scale = 2;
  raster::color_image image(width, bar + 2 * gap + raster::character_height * scale,
                            {255, 255, 255});
  for (std::size_t x = 0; x < width; ++x) {
    const double share = (static_cast<double>(x) + 0.5) / static_cast<double>(width);
    for (std::size_t y = 0; y < bar; ++y) image(x, y) = color(share);
  }
  const std::string labels[] = {short_number(range.low * unit) + suffix,
                                short_number((range.low + range.high) / 2 * unit) + suffix,
                                short_number(range.high * unit) + suffix};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t length = labels[i].size() * raster::character_width * scale;
    const std::size_t room = width > length ? width - length : 0;
    raster::draw_number(image, labels[i], room * i / 2, bar + gap, {0, 0, 0}, scale);
  }
  return image;
}

/// What the pictures show, pixel by pixel; NaN where there is nothing.
struct error_panels {
  raster::image<double> estimate;
  raster::image<double> reference;
  raster::image<double> relative;
};

inline error_panels panels_of(const depth_map& estimate,
                              const depth_map& reference,
                              const error_options& options,
                              const affine& transform) {
  const std::size_t width = estimate.values.width(), height = estimate.values.height();
  const raster::image<double> nothing(width, height, std::numeric_limits<double>::quiet_NaN());
  error_panels panels{nothing, nothing, nothing};
  const auto mask = options.mask;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      if (mask.data && mask(x, y) == 0) continue;
      const double raw = static_cast<double>(estimate.values(x, y));
      const double r = static_cast<double>(reference.values(x, y));
      const double e =
          std::clamp(transform.scale * raw + transform.shift, options.clamp_min, options.clamp_max);
      const bool has_estimate = is_valid(raw) && is_valid(e);
      const bool has_reference = r > options.min && r < options.max;
      if (has_estimate) panels.estimate(x, y) = e;
      if (has_reference) panels.reference(x, y) = r;
      if (has_estimate && has_reference) panels.relative(x, y) = (e - r) / r;
    }
  }
  return panels;
}

inline std::vector<double> numbers_of(const raster::image<double>& image) {
  std::vector<double> numbers;
  std::copy_if(image.begin(), image.end(), std::back_inserter(numbers),
               [](double v) { return std::isfinite(v); });
  return numbers;
}

template <class Color>
raster::color_image painted(const raster::image<double>& numbers,
                            const color_range& range,
                            Color color) {
  raster::color_image image(numbers.width(), numbers.height());
  for (std::size_t y = 0; y < image.height(); ++y) {
    for (std::size_t x = 0; x < image.width(); ++x) {
      const double v = numbers(x, y);
      image(x, y) =
          std::isfinite(v) ? color((v - range.low) / (range.high - range.low)) : hatch(x, y);
    }
  }
  return image;
}

inline color_range depth_range(const error_panels& panels, const error_image_options& options) {
  std::vector<double> depths = numbers_of(panels.reference);
  color_range range{options.near, options.far};
  if (!(range.low > 0)) range.low = stats::quantile_in_place<double>(depths, 0.01);
  if (!(range.high > 0)) range.high = stats::quantile_in_place<double>(depths, 0.99);
  if (!(range.high > range.low)) range.high = range.low * 1.01;
  return range;
}

inline color_range error_range(const error_panels& panels, const error_image_options& options) {
  double largest = options.largest;
  if (!(largest > 0)) {
    std::vector<double> errors = numbers_of(panels.relative);
    for (double& e : errors) e = std::abs(e);
    largest = std::max(stats::quantile_in_place<double>(errors, 0.95), 1e-6);
  }
  return {-largest, largest};
}

}  // namespace detail

inline raster::color_image error_image(const depth_map& estimate,
                                       const depth_map& reference,
                                       const error_image_options& options) {
  const frame_sums frame = measure(estimate.values.view(), reference.values.view(), options.errors);
  (void)summarize(frame.sums);  // throws where there is nothing to show
  const auto panels = detail::panels_of(estimate, reference, options.errors, frame.transform);
  const auto depths = detail::depth_range(panels, options);
  const auto errors = detail::error_range(panels, options);
  const auto sequential = [](double share) { return raster::sequential_color(share); };
  const auto diverging = [](double share) { return raster::diverging_color(2 * share - 1); };

  constexpr std::size_t gap = 6;
  const std::size_t width = estimate.values.width(), height = estimate.values.height();
  const auto depth_bar = detail::scale_bar(2 * width + gap, depths, 1, "", sequential);
  const auto error_bar = detail::scale_bar(width, errors, 100, "%", diverging);
  raster::color_image image(3 * width + 4 * gap, height + 3 * gap + depth_bar.height(),
                            {255, 255, 255});
  const std::size_t second = width + 2 * gap, third = 2 * width + 3 * gap;
  raster::paste(image, detail::painted(panels.estimate, depths, sequential), gap, gap);
  raster::paste(image, detail::painted(panels.reference, depths, sequential), second, gap);
  raster::paste(image, detail::painted(panels.relative, errors, diverging), third, gap);
  raster::paste(image, depth_bar, gap, height + 2 * gap);
  raster::paste(image, error_bar, third, height + 2 * gap);
  return image;
}

}  // namespace aib::depth

// aib/math/camera.hpp

namespace aib::math {

/// Camera models with COLMAP's numbers, up to COLMAP 4.2.
enum class camera_model : std::int32_t {
  simple_pinhole = 0,
  pinhole = 1,
  simple_radial = 2,
  radial = 3,
  opencv = 4,
  opencv_fisheye = 5,
  full_opencv = 6,
  fov = 7,
  simple_radial_fisheye = 8,
  radial_fisheye = 9,
  thin_prism_fisheye = 10,
  rad_tan_thin_prism_fisheye = 11,
  simple_division = 12,
  division = 13,
  simple_fisheye = 14,
  fisheye = 15,
  eucm = 16,
  equirectangular = 17,
};

/// What COLMAP calls a model and how its parameters begin.
struct camera_model_info {
  std::string_view name;  ///< as in cameras.txt
  std::size_t n_parameters;
  std::size_t n_focal;  ///< 1: f, cx, cy, ...   2: fx, fy, cx, cy, ...   0: no focal length
};

inline constexpr std::array<camera_model_info, 18> camera_models{{
    {"SIMPLE_PINHOLE", 3, 1},
    {"PINHOLE", 4, 2},
    {"SIMPLE_RADIAL", 4, 1},
    {"RADIAL", 5, 1},
    {"OPENCV", 8, 2},
    {"OPENCV_FISHEYE", 8, 2},
    {"FULL_OPENCV", 12, 2},
    {"FOV", 5, 2},
    {"SIMPLE_RADIAL_FISHEYE", 4, 1},
    {"RADIAL_FISHEYE", 5, 1},
    {"THIN_PRISM_FISHEYE", 12, 2},
    {"RAD_TAN_THIN_PRISM_FISHEYE", 16, 2},
    {"SIMPLE_DIVISION", 4, 1},
    {"DIVISION", 5, 2},
    {"SIMPLE_FISHEYE", 3, 1},
    {"FISHEYE", 4, 2},
    {"EUCM", 6, 2},
    {"EQUIRECTANGULAR", 2, 0},
}};

[[nodiscard]] constexpr const camera_model_info& info(camera_model model) {
  return camera_models[static_cast<std::size_t>(model)];
}

/// The model of COLMAP's number or name; nothing where COLMAP (up to 4.2) has none such.
[[nodiscard]] constexpr std::optional<camera_model> find_camera_model(std::int64_t id) {
  if (id < 0 || id >= static_cast<std::int64_t>(camera_models.size())) return std::nullopt;
  return static_cast<camera_model>(id);
}
[[nodiscard]] constexpr std::optional<camera_model> find_camera_model(std::string_view name) {
  for (std::size_t i = 0; i < camera_models.size(); ++i) {
    if (camera_models[i].name == name) return static_cast<camera_model>(i);
  }
  return std::nullopt;
}

/// Intrinsics of a camera. Pixel (0.5, 0.5) is the centre of the top left pixel.
struct camera {
  camera_model model = camera_model::pinhole;
  std::uint64_t width = 0;         ///< pixels
  std::uint64_t height = 0;        ///< pixels
  std::vector<double> parameters;  ///< in COLMAP's order, pixels where they are lengths

  [[nodiscard]] bool has_focal() const { return info(model).n_focal > 0; }

  /// Focal lengths and principal point in pixels. Throw argument_error where the model has none.
  [[nodiscard]] double fx() const;
  [[nodiscard]] double fy() const;
  [[nodiscard]] double cx() const;
  [[nodiscard]] double cy() const;
};

namespace detail {

inline double pinhole_parameter(const camera& c, std::size_t index) {
  if (!c.has_focal())
    throw argument_error(message("camera: ", info(c.model).name, " has no focal length"));
  if (index >= c.parameters.size()) {
    throw argument_error(message("camera: ", info(c.model).name, " expects ",
                                 info(c.model).n_parameters, " parameters, found ",
                                 c.parameters.size()));
  }
  return c.parameters[index];
}

}  // namespace detail

inline double camera::fx() const { return detail::pinhole_parameter(*this, 0); }
inline double camera::fy() const {
  return detail::pinhole_parameter(*this, info(model).n_focal - 1);
}
inline double camera::cx() const { return detail::pinhole_parameter(*this, info(model).n_focal); }
inline double camera::cy() const {
  return detail::pinhole_parameter(*this, info(model).n_focal + 1);
}

/// A camera without distortion.
[[nodiscard]] inline camera pinhole(
    std::uint64_t width, std::uint64_t height, double fx, double fy, double cx, double cy) {
  return {camera_model::pinhole, width, height, {fx, fy, cx, cy}};
}

}  // namespace aib::math

// aib/math/projection.hpp

namespace aib::math {

/// Pixel of a point, of every camera model; nothing where the model has none: behind a perspective
/// camera, beyond the range of a division model or of EUCM, at the centre.
///
/// p_in_camera   x right, y down, z forward, any unit
///
/// Throws argument_error if the camera has another number of parameters than its model.
/// Source: COLMAP 4.2, src/colmap/sensor/models.h; FOV: Devernay and Faugeras 2001; division:
/// Fitzgibbon, CVPR 2001; EUCM: Khomutenko, Garcia, Martinet, RA-L 2016.
std::optional<Eigen::Vector2d> project(const camera& camera, const Eigen::Vector3d& p_in_camera);

/// Direction in the camera, unit length, of the points that project to a pixel; nothing where no
/// point does. The inverse of `project` to 1e-9 pixels within the range where the distortion grows.
///
/// Throws argument_error if the camera has another number of parameters than its model.
std::optional<Eigen::Vector3d> unproject(const camera& camera, const Eigen::Vector2d& pixel);

namespace detail {

using point2 = Eigen::Vector2d;

/// Parameters behind focal length and principal point. Throws argument_error if they are too few or
/// too many.
inline std::span<const double> distortion_parameters(const camera& c) {
  const camera_model_info& model = info(c.model);
  if (c.parameters.size() != model.n_parameters) {
    throw argument_error(message("camera: ", model.name, " expects ", model.n_parameters,
                                 " parameters, found ", c.parameters.size()));
  }
  return std::span(c.parameters).subspan(model.n_focal == 0 ? 2 : model.n_focal + 2);
}

/// How a direction becomes a point of the plane that is distorted.
enum class image_plane { perspective, equidistant, other };

constexpr image_plane plane_of(camera_model model) {
  switch (model) {
    case camera_model::simple_pinhole:
    case camera_model::pinhole:
    case camera_model::simple_radial:
    case camera_model::radial:
    case camera_model::opencv:
    case camera_model::full_opencv:
    case camera_model::fov:
      return image_plane::perspective;
    case camera_model::opencv_fisheye:
    case camera_model::simple_radial_fisheye:
    case camera_model::radial_fisheye:
    case camera_model::thin_prism_fisheye:
    case camera_model::rad_tan_thin_prism_fisheye:
    case camera_model::simple_fisheye:
    case camera_model::fisheye:
      return image_plane::equidistant;
    default:
      return image_plane::other;
  }
}

/// 1 + k[0] r2 + k[1] r2^2 + ...
inline double radial(std::span<const double> k, double r2) {
  double sum = 0;
  for (std::size_t i = k.size(); i > 0; --i) sum = (sum + k[i - 1]) * r2;
  return 1 + sum;
}

/// Decentring of Brown: p1 is the weight of the y axis, p2 of the x axis.
inline point2 decentred(const point2& p, double p1, double p2) {
  const double xy = 2 * p.x() * p.y(), r2 = p.squaredNorm();
  return {p1 * xy + p2 * (r2 + 2 * p.x() * p.x()), p2 * xy + p1 * (r2 + 2 * p.y() * p.y())};
}

inline point2 distort_full_opencv(std::span<const double> k, const point2& p) {
  const double numerator[] = {k[0], k[1], k[4]}, r2 = p.squaredNorm();
  return p * (radial(numerator, r2) / radial(k.subspan(5, 3), r2)) + decentred(p, k[2], k[3]);
}

inline point2 distort_fov(double omega, const point2& p) {
  const double r = p.norm();
  if (omega == 0) return p;
  const double slope = 2 * std::tan(omega / 2);
  return p * (r < 1e-12 ? slope / omega : std::atan(r * slope) / (r * omega));
}

inline point2 distort_thin_prism(std::span<const double> k, const point2& p) {
  const double radii[] = {k[0], k[1], k[4], k[5]}, r2 = p.squaredNorm();
  return p * radial(radii, r2) + decentred(p, k[2], k[3]) + r2 * point2(k[6], k[7]);
}

inline point2 distort_rad_tan_thin_prism(std::span<const double> k, const point2& p) {
  const point2 q = p * radial(k.first(6), p.squaredNorm());
  const double r2 = q.squaredNorm();
  return q + decentred(q, k[7], k[6]) +
         point2(k[8] * r2 + k[9] * r2 * r2, k[10] * r2 + k[11] * r2 * r2);
}

/// Distorted point of the image plane of a model that has one.
inline point2 distort(camera_model model, std::span<const double> k, const point2& p) {
  switch (model) {
    case camera_model::simple_radial:
    case camera_model::radial:
    case camera_model::simple_radial_fisheye:
    case camera_model::radial_fisheye:
    case camera_model::opencv_fisheye:
      return p * radial(k, p.squaredNorm());
    case camera_model::opencv:
      return p * radial(k.first(2), p.squaredNorm()) + decentred(p, k[2], k[3]);
    case camera_model::full_opencv:
      return distort_full_opencv(k, p);
    case camera_model::fov:
      return distort_fov(k[0], p);
    case camera_model::thin_prism_fisheye:
      return distort_thin_prism(k, p);
    case camera_model::rad_tan_thin_prism_fisheye:
      return distort_rad_tan_thin_prism(k, p);
    default:
      return p;
  }
}

inline Eigen::Matrix2d distortion_slope(camera_model model,
                                        std::span<const double> k,
                                        const point2& p) {
  constexpr double step = 1e-6;
  Eigen::Matrix2d slope;
  for (int axis = 0; axis < 2; ++axis) {
    const point2 aside = step * point2::Unit(axis);
    slope.col(axis) = (distort(model, k, p + aside) - distort(model, k, p - aside)) / (2 * step);
  }
  return slope;
}

/// The point that `distort` takes to `goal`, by Newton's method from there. Nothing where the steps
/// end beyond the range in which the distortion grows.
inline std::optional<point2> undistort(camera_model model,
                                       std::span<const double> k,
                                       const point2& goal) {
  point2 p = goal;
  for (int round = 0; round < 50; ++round) {
    const point2 miss = distort(model, k, p) - goal;
    if (!miss.allFinite()) return std::nullopt;
    if (miss.norm() <= 1e-15 * (1 + goal.norm())) break;
    p -= distortion_slope(model, k, p).inverse() * miss;
  }
  const bool there = (distort(model, k, p) - goal).norm() <= 1e-13 * (1 + goal.norm());
  const bool this_side = p.dot(goal) > 0 || goal.norm() < 1e-2;
  if (!there || !this_side || !(distortion_slope(model, k, p).determinant() > 0))
    return std::nullopt;
  return p;
}

inline std::optional<point2> on_plane(image_plane plane, const Eigen::Vector3d& p) {
  if (plane == image_plane::perspective) {
    if (!(p.z() > 0)) return std::nullopt;
    return point2(p.head<2>() / p.z());
  }
  const double r = p.head<2>().norm();
  if (r == 0) return p.z() > 0 ? std::optional(point2(0, 0)) : std::nullopt;
  return point2(p.head<2>() * (std::atan2(r, p.z()) / r));
}

inline std::optional<Eigen::Vector3d> off_plane(image_plane plane, const point2& p) {
  if (plane == image_plane::perspective) return Eigen::Vector3d(p.x(), p.y(), 1).normalized();
  const double angle = p.norm();
  if (angle > std::numbers::pi) return std::nullopt;
  const double share = angle == 0 ? 1 : std::sin(angle) / angle;
  return Eigen::Vector3d(share * p.x(), share * p.y(), std::cos(angle));
}

/// The undistorted point of a division model is (x, y, 1 + k r^2).
inline std::optional<point2> project_division(double k, const Eigen::Vector3d& p) {
  const double r2 = p.head<2>().squaredNorm();
  // (x, y) s with s z = 1 + k r2 s^2: the root that is 1 / z without distortion.
  const double root = p.z() * p.z() - 4 * k * r2;
  if (!(root >= 0)) return std::nullopt;
  const double denominator = p.z() + std::sqrt(root);
  if (!(denominator > 0)) return std::nullopt;
  return point2(p.head<2>() * (2 / denominator));
}

inline std::optional<point2> project_eucm(double alpha, double beta, const Eigen::Vector3d& p) {
  const double d = std::sqrt(beta * p.head<2>().squaredNorm() + p.z() * p.z());
  const double w = alpha > 0.5 ? (1 - alpha) / alpha : alpha / (1 - alpha);
  const double denominator = alpha * d + (1 - alpha) * p.z();
  if (!(p.z() > -w * d) || !(denominator > 0)) return std::nullopt;
  return point2(p.head<2>() / denominator);
}

inline std::optional<Eigen::Vector3d> unproject_eucm(double alpha, double beta, const point2& p) {
  const double r2 = p.squaredNorm();
  const double root = 1 - (2 * alpha - 1) * beta * r2;
  if (!(root >= 0)) return std::nullopt;
  const double z = (1 - beta * alpha * alpha * r2) / (alpha * std::sqrt(root) + 1 - alpha);
  return Eigen::Vector3d(p.x(), p.y(), z).normalized();
}

/// Longitude to the right and latitude downwards over the whole image.
inline std::optional<point2> project_sphere(double width, double height, const Eigen::Vector3d& p) {
  if (p.squaredNorm() == 0) return std::nullopt;
  const double longitude = std::atan2(p.x(), p.z());
  const double latitude = std::atan2(p.y(), std::hypot(p.x(), p.z()));
  return point2((longitude / (2 * std::numbers::pi) + 0.5) * width,
                (latitude / std::numbers::pi + 0.5) * height);
}

inline Eigen::Vector3d unproject_sphere(double width, double height, const point2& pixel) {
  const double longitude = 2 * std::numbers::pi * (pixel.x() / width - 0.5);
  const double latitude = std::numbers::pi * (pixel.y() / height - 0.5);
  return {std::cos(latitude) * std::sin(longitude), std::sin(latitude),
          std::cos(latitude) * std::cos(longitude)};
}

}  // namespace detail

inline std::optional<Eigen::Vector2d> project(const camera& camera,
                                              const Eigen::Vector3d& p_in_camera) {
  const std::span<const double> k = detail::distortion_parameters(camera);
  if (!p_in_camera.allFinite()) return std::nullopt;
  std::optional<detail::point2> p;
  switch (camera.model) {
    case camera_model::equirectangular:
      return detail::project_sphere(camera.parameters[0], camera.parameters[1], p_in_camera);
    case camera_model::simple_division:
    case camera_model::division:
      p = detail::project_division(k[0], p_in_camera);
      break;
    case camera_model::eucm:
      p = detail::project_eucm(k[0], k[1], p_in_camera);
      break;
    default:
      p = detail::on_plane(detail::plane_of(camera.model), p_in_camera);
      if (p) p = detail::distort(camera.model, k, *p);
  }
  if (!p) return std::nullopt;
  return Eigen::Vector2d(camera.fx() * p->x() + camera.cx(), camera.fy() * p->y() + camera.cy());
}

inline std::optional<Eigen::Vector3d> unproject(const camera& camera,
                                                const Eigen::Vector2d& pixel) {
  const std::span<const double> k = detail::distortion_parameters(camera);
  if (!pixel.allFinite()) return std::nullopt;
  if (camera.model == camera_model::equirectangular)
    return detail::unproject_sphere(camera.parameters[0], camera.parameters[1], pixel);
  const detail::point2 p((pixel.x() - camera.cx()) / camera.fx(),
                         (pixel.y() - camera.cy()) / camera.fy());
  switch (camera.model) {
    case camera_model::simple_division:
    case camera_model::division:
      return Eigen::Vector3d(p.x(), p.y(), 1 + k[0] * p.squaredNorm()).normalized();
    case camera_model::eucm:
      return detail::unproject_eucm(k[0], k[1], p);
    default: {
      const auto undistorted = detail::undistort(camera.model, k, p);
      if (!undistorted) return std::nullopt;
      return detail::off_plane(detail::plane_of(camera.model), *undistorted);
    }
  }
}

}  // namespace aib::math

// aib/depth/rays.hpp

namespace aib::depth {

/// Where the pixels of a map look: (x / z, y / z) in the camera, NaN where it sees nothing in
/// front. The point of a pixel is `depth * (ray.x, ray.y, 1)`.
using ray_image = raster::image<Eigen::Vector2d>;

/// The rays through the pixel centres of a map of width x height. Where the camera says another
/// size, pixels are scaled to it.
[[nodiscard]] inline ray_image rays(const math::camera& camera,
                                    std::size_t width,
                                    std::size_t height) {
  const auto per_pixel = [](std::uint64_t of_camera, std::size_t of_map) {
    return of_camera > 0 ? static_cast<double>(of_camera) / static_cast<double>(of_map) : 1;
  };
  const double scale_x = per_pixel(camera.width, width), scale_y = per_pixel(camera.height, height);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  ray_image image(width, height, Eigen::Vector2d(nan, nan));
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const Eigen::Vector2d pixel((static_cast<double>(x) + 0.5) * scale_x,
                                  (static_cast<double>(y) + 0.5) * scale_y);
      const auto direction = math::unproject(camera, pixel);
      if (direction && direction->z() > 0) image(x, y) = direction->head<2>() / direction->z();
    }
  }
  return image;
}

/// The point of a pixel, in the camera.
[[nodiscard]] inline Eigen::Vector3d point_at(const Eigen::Vector2d& ray, double depth) {
  return {ray.x() * depth, ray.y() * depth, depth};
}

}  // namespace aib::depth

// aib/depth/normals.hpp

namespace aib::depth {

/// Unit vectors in the camera that point towards it; 0 where there is none.
using normal_image = raster::image<Eigen::Vector3f>;

struct normal_options {
  double max_jump = 0.05;  ///< neighbours whose depths differ by a larger share lie on two surfaces
};

/// Normals of the surface that a depth map shows: the cross product of the differences between the
/// points left and right, above and below. A pixel has one where it and these four are valid and on
/// one surface.
///
/// depth   h x w, planar
/// rays    h x w, see `rays`
///
/// Throws argument_error if the sizes differ.
[[nodiscard]] normal_image normals(raster::view<const float> depth,
                                   const ray_image& rays,
                                   const normal_options& options = {});

struct normal_error_options {
  normal_options normals = {};
  raster::view<const std::uint8_t> mask = {};  ///< none, or 0 where a pixel is left out
  /// Angles in radians; by default 11.25, 22.5 and 30 degrees.
  std::vector<double> tau = {std::numbers::pi / 16, std::numbers::pi / 8, std::numbers::pi / 6};
};

/// Angles between the normals of estimate and reference, in radians, over the pixels where both
/// have one.
struct normal_errors_summary {
  double mean;
  double median;
  double rmse;
  std::vector<double> below;  ///< share with an angle strictly below each tau
  std::uint64_t n_valid;      ///< pixels with both normals
  std::uint64_t n_reference;  ///< with one in the reference
};

/// Errors of the surface orientation. A scale common to the estimate does not matter.
/// Throws undefined_error if no pixel has both normals, argument_error if sizes differ.
/// Source: Fouhey, Gupta, Hebert, "Data-driven 3D primitives for single image understanding",
/// ICCV 2013 (mean, median, rmse, thresholds).
[[nodiscard]] normal_errors_summary normal_errors(raster::view<const float> estimate,
                                                  raster::view<const float> reference,
                                                  const ray_image& rays,
                                                  const normal_error_options& options = {});

/// The angle between two vectors, in [0, pi]; exact near 0 and pi too.
[[nodiscard]] inline double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

namespace detail {

inline Eigen::Vector3f normal_at(raster::view<const float> depth,
                                 const ray_image& rays,
                                 std::size_t x,
                                 std::size_t y,
                                 double max_jump) {
  const auto here = static_cast<double>(depth(x, y));
  bool complete = is_valid(here);
  const auto point = [&](std::size_t at_x, std::size_t at_y) -> Eigen::Vector3d {
    const auto there = static_cast<double>(depth(at_x, at_y));
    const bool same_surface =
        is_valid(there) && std::max(here, there) <= (1 + max_jump) * std::min(here, there);
    complete = complete && same_surface;
    return point_at(rays(at_x, at_y), there);
  };
  const Eigen::Vector3d across = point(x + 1, y) - point(x - 1, y);
  const Eigen::Vector3d down = point(x, y + 1) - point(x, y - 1);
  const Eigen::Vector3d normal = down.cross(across);
  const double length = normal.norm();
  if (!complete || !(length > 0)) return Eigen::Vector3f::Zero();
  const double towards = normal.dot(point_at(rays(x, y), 1)) < 0 ? 1 : -1;
  return (towards / length * normal).cast<float>();
}

}  // namespace detail

inline normal_image normals(raster::view<const float> depth,
                            const ray_image& rays,
                            const normal_options& options) {
  check_size("depth::normals", depth, "rays", rays.view());
  normal_image image(depth.width, depth.height, Eigen::Vector3f::Zero());
  for (std::size_t y = 1; y + 1 < depth.height; ++y)
    for (std::size_t x = 1; x + 1 < depth.width; ++x)
      image(x, y) = detail::normal_at(depth, rays, x, y, options.max_jump);
  return image;
}

inline normal_errors_summary normal_errors(raster::view<const float> estimate,
                                           raster::view<const float> reference,
                                           const ray_image& rays,
                                           const normal_error_options& options) {
  check_sizes("depth::normal_errors", estimate, reference, options.mask);
  const normal_image of_estimate = normals(estimate, rays, options.normals);
  const normal_image of_reference = normals(reference, rays, options.normals);
  normal_errors_summary result{};
  std::vector<double> angles;
  double sum = 0, squares = 0;
  for (std::size_t y = 0; y < estimate.height; ++y) {
    for (std::size_t x = 0; x < estimate.width; ++x) {
      const bool inside = !options.mask.data || options.mask(x, y) != 0;
      if (!inside || of_reference(x, y).isZero(0)) continue;
      ++result.n_reference;
      if (of_estimate(x, y).isZero(0)) continue;
      const double angle =
          angle_between(of_estimate(x, y).cast<double>(), of_reference(x, y).cast<double>());
      angles.push_back(angle);
      sum += angle;
      squares += angle * angle;
    }
  }
  if (angles.empty()) {
    throw undefined_error(message("depth::normal_errors: no pixel has a normal in both maps, ",
                                  result.n_reference, " have one in the reference"));
  }
  const auto n = static_cast<double>(angles.size());
  result.mean = sum / n;
  result.rmse = std::sqrt(squares / n);
  for (const double tau : options.tau) {
    const auto below =
        std::count_if(angles.begin(), angles.end(), [tau](double angle) { return angle < tau; });
    result.below.push_back(static_cast<double>(below) / n);
  }
  result.median = stats::quantile_in_place<double>(angles, 0.5);
  result.n_valid = angles.size();
  return result;
}

}  // namespace aib::depth

// aib/depth/planes.hpp

namespace aib::depth {

/// How an estimate shows what is a plane in the reference.
struct plane_errors_summary {
  double flatness;     ///< rms distance of the estimate's points from their own best plane
  double orientation;  ///< angle between the best planes of both maps, radians
  double
      offset;  ///< signed distance of the estimate's centroid from the reference's plane, away > 0
  double reference_flatness;  ///< flatness of the reference: not far above it is as good as it gets
  std::uint64_t n_valid;      ///< pixels valid in both maps
};

/// Planarity and orientation errors of walls, decks and panels, one plane a label; 0 is no plane.
/// Both planes are fitted to the pixels valid in both maps, by least squares of distances. A label
/// with fewer than three such pixels, or with all of them in a row, is left out.
///
/// The estimate is taken as it is: iBims-1 scales it by the median of each plane first, for which
/// fit it (alignment::median) with the plane as mask.
/// Throws argument_error if the sizes differ.
/// Source: Koch et al., "Evaluation of CNN-based single-image depth estimation methods", ECCV 2018.
[[nodiscard]] std::map<std::uint16_t, plane_errors_summary> plane_errors(
    raster::view<const float> estimate,
    raster::view<const float> reference,
    const ray_image& rays,
    raster::view<const std::uint16_t> planes);

namespace detail {

struct fitted_plane {
  Eigen::Vector3d centroid;
  Eigen::Vector3d normal;  ///< away from the camera
  double flatness;
};

/// Nothing where the points lie on a line.
inline std::optional<fitted_plane> fit_plane(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() < 3) return std::nullopt;
  const auto n = static_cast<double>(points.size());
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const auto& p : points) centroid += p / n;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& p : points) scatter += (p - centroid) * (p - centroid).transpose() / n;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
  constexpr double least_share = 1e-12;
  if (!(axes.eigenvalues()[1] > least_share * axes.eigenvalues()[2])) return std::nullopt;
  const Eigen::Vector3d normal = axes.eigenvectors().col(0);
  return fitted_plane{centroid, normal.dot(centroid) < 0 ? Eigen::Vector3d(-normal) : normal,
                      std::sqrt(std::max(0.0, axes.eigenvalues()[0]))};
}

}  // namespace detail

inline std::map<std::uint16_t, plane_errors_summary> plane_errors(
    raster::view<const float> estimate,
    raster::view<const float> reference,
    const ray_image& rays,
    raster::view<const std::uint16_t> planes) {
  check_sizes("depth::plane_errors", estimate, reference);
  check_size("depth::plane_errors", estimate, "rays", rays.view());
  check_size("depth::plane_errors", estimate, "label image", planes);
  struct point_pairs {
    std::vector<Eigen::Vector3d> estimate, reference;
  };
  std::map<std::uint16_t, point_pairs> by_label;
  for (std::size_t y = 0; y < estimate.height; ++y) {
    for (std::size_t x = 0; x < estimate.width; ++x) {
      const bool counts = planes(x, y) != 0 && is_valid(estimate(x, y)) &&
                          is_valid(reference(x, y)) && !std::isnan(rays(x, y).x());
      if (!counts) continue;
      point_pairs& pairs = by_label[planes(x, y)];
      pairs.estimate.push_back(point_at(rays(x, y), static_cast<double>(estimate(x, y))));
      pairs.reference.push_back(point_at(rays(x, y), static_cast<double>(reference(x, y))));
    }
  }
  std::map<std::uint16_t, plane_errors_summary> result;
  for (const auto& [label, pairs] : by_label) {
    const auto e = detail::fit_plane(pairs.estimate), r = detail::fit_plane(pairs.reference);
    if (!e || !r) continue;
    const double angle = angle_between(e->normal, r->normal);
    result[label] = {.flatness = e->flatness,
                     .orientation = std::min(angle, std::numbers::pi - angle),
                     .offset = r->normal.dot(e->centroid - r->centroid),
                     .reference_flatness = r->flatness,
                     .n_valid = pairs.estimate.size()};
  }
  return result;
}

}  // namespace aib::depth

// aib/depth/presets.hpp

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

// aib/depth/risk_coverage.hpp

namespace aib::depth {

/// The error of a pixel that a confidence is held against.
enum class pixel_error {
  relative,    ///< |e - r| / r
  difference,  ///< |e - r|
  log_ratio,   ///< |ln r - ln e|
};

struct risk_options {
  pixel_error error = pixel_error::relative;
  std::size_t steps = 100;                               ///< of the curves
  double min = 0;                                        ///< a reference counts above it, exclusive
  double max = std::numeric_limits<double>::infinity();  ///< and below it, exclusive
  raster::view<const std::uint8_t> mask = {};            ///< none, or 0 where a pixel is left out
  affine transform = {};                                 ///< of the estimate, see fitter
};

/// Mean error of the most confident pixels against their share. Curve k is at share (k + 1) /
/// steps.
struct risk_curve {
  std::vector<double> coverage;  ///< share of the pixels kept, rising to 1
  std::vector<double> risk;      ///< mean error of the most confident ones
  std::vector<double> oracle;    ///< mean error of the least wrong ones: no confidence does better
  double aurc;                   ///< area under `risk`
  double ause;                   ///< area between both curves in units of the overall mean error
  std::uint64_t n_valid;         ///< pixels valid in both maps
  std::uint64_t n_unsure;        ///< of those, without a finite confidence: they are kept last
};

/// Whether a confidence map knows where its depth map is wrong. The order of the confidences alone
/// counts, so that any rising scale gives the same; pixels of one confidence share their mean
/// error.
///
/// ause 0: the confidence sorts the pixels by their error; a random one gives a constant risk. A
/// perfect depth map has ause 0.
/// Throws undefined_error if no pixel is valid in both maps, argument_error if sizes differ or
/// steps is 0. Source: Ilg et al., "Uncertainty estimates and multi-hypotheses networks for optical
/// flow", ECCV 2018 (sparsification error); Geifman, El-Yaniv, NeurIPS 2017 (risk, coverage).
[[nodiscard]] risk_curve risk_coverage(raster::view<const float> estimate,
                                       raster::view<const float> reference,
                                       raster::view<const float> confidence,
                                       const risk_options& options = {});

namespace detail {

struct judged_pixel {
  double error;
  float confidence;
};

inline double error_of(double e, double r, pixel_error kind) {
  switch (kind) {
    case pixel_error::difference:
      return std::abs(e - r);
    case pixel_error::log_ratio:
      return std::abs(std::log(r / e));
    default:
      return std::abs(e - r) / r;
  }
}

inline std::vector<judged_pixel> judge(raster::view<const float> estimate,
                                       raster::view<const float> reference,
                                       raster::view<const float> confidence,
                                       const risk_options& o) {
  std::vector<judged_pixel> pixels;
  for (std::size_t y = 0; y < estimate.height; ++y) {
    for (std::size_t x = 0; x < estimate.width; ++x) {
      const auto r = static_cast<double>(reference(x, y)),
                 raw = static_cast<double>(estimate(x, y));
      const double e = o.transform.scale * raw + o.transform.shift;
      const bool counts = (!o.mask.data || o.mask(x, y) != 0) && r > o.min && r < o.max &&
                          is_valid(raw) && is_valid(e);
      if (!counts) continue;
      const float sure = confidence(x, y);
      const float lowest = -std::numeric_limits<float>::infinity();
      pixels.push_back({error_of(e, r, o.error), std::isnan(sure) ? lowest : sure});
    }
  }
  return pixels;
}

/// Mean error of the first share (k + 1) / steps of the pixels, by their running sums.
inline std::vector<double> mean_of_first(const std::vector<double>& errors, std::size_t steps) {
  std::vector<double> sums(errors.size());
  std::partial_sum(errors.begin(), errors.end(), sums.begin());
  std::vector<double> means;
  for (std::size_t k = 1; k <= steps; ++k) {
    const std::size_t n = std::max<std::size_t>(1, k * errors.size() / steps);
    means.push_back(sums[n - 1] / static_cast<double>(n));
  }
  return means;
}

/// The errors, the most confident pixel first; the mean of all where several are as confident.
inline std::vector<double> by_confidence(std::vector<judged_pixel> pixels) {
  std::sort(pixels.begin(), pixels.end(), [](const judged_pixel& a, const judged_pixel& b) {
    return a.confidence != b.confidence ? a.confidence > b.confidence : a.error < b.error;
  });
  std::vector<double> errors;
  for (std::size_t first = 0, end = 0; first < pixels.size(); first = end) {
    double sum = 0;
    for (; end < pixels.size() && pixels[end].confidence == pixels[first].confidence; ++end)
      sum += pixels[end].error;
    errors.resize(end, sum / static_cast<double>(end - first));
  }
  return errors;
}

}  // namespace detail

inline risk_curve risk_coverage(raster::view<const float> estimate,
                                raster::view<const float> reference,
                                raster::view<const float> confidence,
                                const risk_options& options) {
  check_sizes("depth::risk_coverage", estimate, reference, options.mask);
  check_size("depth::risk_coverage", estimate, "confidence map", confidence);
  if (options.steps == 0) throw argument_error("depth::risk_coverage: steps >= 1 expected");
  auto pixels = detail::judge(estimate, reference, confidence, options);
  if (pixels.empty())
    throw undefined_error("depth::risk_coverage: no pixel is valid in estimate and reference");
  std::vector<double> best(pixels.size());
  std::transform(pixels.begin(), pixels.end(), best.begin(), [](const auto& p) { return p.error; });
  std::sort(best.begin(), best.end());
  const auto unsure = std::count_if(pixels.begin(), pixels.end(),
                                    [](const auto& p) { return !std::isfinite(p.confidence); });
  risk_curve curve{};
  curve.n_valid = pixels.size();
  curve.n_unsure = static_cast<std::uint64_t>(unsure);
  curve.risk = detail::mean_of_first(detail::by_confidence(std::move(pixels)), options.steps);
  curve.oracle = detail::mean_of_first(best, options.steps);
  const auto steps = static_cast<double>(options.steps);
  const double overall = curve.oracle.back();
  for (std::size_t k = 0; k < options.steps; ++k) {
    curve.coverage.push_back(static_cast<double>(k + 1) / steps);
    curve.aurc += curve.risk[k] / steps;
    if (overall > 0) curve.ause += (curve.risk[k] - curve.oracle[k]) / overall / steps;
  }
  return curve;
}

}  // namespace aib::depth

// aib/depth/strata.hpp

namespace aib::depth {

/// What a pixel of a reference shows. The numbers are labels for errors_by_label.
enum class stratum : std::uint16_t {
  nothing = 0,  ///< no valid depth
  inside = 1,   ///< a surface, away from its edges
  edge = 2,     ///< near a jump of the depth, on either side
  thin = 3,     ///< a bar, cable or rail with farther things (or sky) on both sides
};

struct strata_options {
  double jump = 0.1;  ///< neighbours are apart where one depth exceeds the other by this share
  std::size_t edge_width = 2;  ///< pixels from a jump that are still at the edge
  std::size_t thin_width = 8;  ///< pixels across, along the row or the column
};

/// Sorts the pixels of a reference into strata: global errors hide what is wrong at edges and in
/// thin structures. A pixel without depth counts as farther than any other: sky. What lies at the
/// border of the image is not known to end there. Throws argument_error if jump <= 0.
[[nodiscard]] raster::image<std::uint16_t> strata(raster::view<const float> reference,
                                                  const strata_options& options = {});

namespace detail {

/// A line of pixels: a row or a column.
struct pixel_line {
  const float* depth;
  std::uint16_t* stratum;
  std::size_t size;
  std::size_t depth_step;
  std::size_t stratum_step;

  [[nodiscard]] double at(std::size_t i) const {
    return static_cast<double>(depth[i * depth_step]);
  }
  [[nodiscard]] std::uint16_t& mark(std::size_t i) const { return stratum[i * stratum_step]; }
};

/// Whether pixel i lies farther than its neighbour j by a jump.
inline bool is_farther(const pixel_line& line, std::size_t i, std::size_t j, double jump) {
  return is_valid(line.at(j)) && (!is_valid(line.at(i)) || line.at(i) > (1 + jump) * line.at(j));
}

inline bool has_jump(const pixel_line& line, std::size_t i, double jump) {
  return is_farther(line, i, i + 1, jump) || is_farther(line, i + 1, i, jump);
}

/// Marks the valid pixels from `first` to before `end` that are less than `to`.
inline void raise(const pixel_line& line, std::size_t first, std::size_t end, stratum to) {
  for (std::size_t i = first; i < end; ++i) {
    if (is_valid(line.at(i))) line.mark(i) = std::max(line.mark(i), static_cast<std::uint16_t>(to));
  }
}

inline void mark_line(const pixel_line& line, const strata_options& o) {
  std::size_t first = 0;  // of the run that ends at the jump
  for (std::size_t i = 0; i + 1 < line.size; ++i) {
    if (!has_jump(line, i, o.jump)) continue;
    const std::size_t left = i + 1 > o.edge_width ? i + 1 - o.edge_width : 0;
    raise(line, left, std::min(line.size, i + 1 + o.edge_width), stratum::edge);
    const bool in_front = first > 0 && is_farther(line, first - 1, first, o.jump) &&
                          is_farther(line, i + 1, i, o.jump);
    if (in_front && i + 1 - first <= o.thin_width) raise(line, first, i + 1, stratum::thin);
    first = i + 1;
  }
}

}  // namespace detail

inline raster::image<std::uint16_t> strata(raster::view<const float> reference,
                                           const strata_options& options) {
  if (!(options.jump > 0)) {
    throw argument_error(message("depth::strata: jump > 0 expected, found ", options.jump));
  }
  raster::image<std::uint16_t> image(reference.width, reference.height);
  const auto line = [&](std::size_t x, std::size_t y) {
    return detail::pixel_line{&reference(x, y), &image(x, y), 0, 0, 0};
  };
  for (std::size_t y = 0; y < reference.height && reference.width > 0; ++y) {
    detail::pixel_line row = line(0, y);
    row.size = reference.width;
    row.depth_step = row.stratum_step = 1;
    detail::raise(row, 0, row.size, stratum::inside);
    detail::mark_line(row, options);
  }
  for (std::size_t x = 0; x < reference.width && reference.height > 0; ++x) {
    detail::pixel_line column = line(x, 0);
    column.size = reference.height;
    column.depth_step = reference.stride;
    column.stratum_step = image.width();
    detail::mark_line(column, options);
  }
  return image;
}

}  // namespace aib::depth

// aib/depth/surface_errors.hpp

namespace aib::depth {

/// What a distance between an estimated point and the reference is.
enum class surface_distance {
  normal,  ///< from the plane of the reference's surface: what a gauge would read
  ray,     ///< along the line of sight
};

struct surface_error_options {
  surface_distance distance = surface_distance::normal;
  std::vector<double> tau = {1, 2, 5};  ///< multiples of the ground sampling distance
  double min = 0;                       ///< a reference counts above it, exclusive
  double max = std::numeric_limits<double>::infinity();  ///< and below it, exclusive
  raster::view<const std::uint8_t> mask = {};            ///< none, or 0 where a pixel is left out
  affine transform = {};                                 ///< of the estimate, see fitter
  normal_options normals = {};
};

/// Statistics of non-negative numbers.
struct spread {
  double mean;
  double median;
  double p95;  ///< 95 % are below it
  double rmse;
  double max;
};

/// How far the estimated surface lies from the reference, over the pixels valid in both.
struct surface_error_summary {
  spread distance;                   ///< in the unit of the maps
  spread gsd;                        ///< the same in ground sampling distances of each pixel
  double mean_gsd;                   ///< the mean ground sampling distance, in the unit of the maps
  std::vector<double> within;        ///< share of these pixels strictly below each tau
  std::vector<double> within_total;  ///< share of the reference's pixels: a hole is a miss
  double coverage;                   ///< valid in both / valid in the reference
  std::uint64_t n_valid;
  std::uint64_t n_reference;
  std::uint64_t n_without_normal;  ///< measured along the ray, at edges and borders
};

/// Errors in the units of an inspection: distances at the surface, and multiples of the ground
/// sampling distance depth / f, the size of a photo's pixel on the object.
///
/// estimate, reference   h x w, planar depth in the unit of the reference
/// camera                of the photo: its own focal length counts, whatever the size of the maps
///
/// An error along the ray shrinks by the cosine of the angle of incidence where the surface is seen
/// at a slant: distance = |e - r| * |n . ray|, n the normal of the reference. Throws
/// undefined_error, with the counts, if no pixel is valid in both; argument_error if sizes differ
/// or the camera has no focal length.
[[nodiscard]] surface_error_summary surface_errors(raster::view<const float> estimate,
                                                   raster::view<const float> reference,
                                                   const math::camera& camera,
                                                   const surface_error_options& options = {});

namespace detail {

inline spread spread_of(std::vector<double>& values) {
  double sum = 0, squares = 0;
  for (const double v : values) {
    sum += v;
    squares += v * v;
  }
  const auto n = static_cast<double>(values.size());
  return {.mean = sum / n,
          .median = stats::quantile_in_place<double>(values, 0.5),
          .p95 = stats::quantile_in_place<double>(values, 0.95),
          .rmse = std::sqrt(squares / n),
          .max = *std::max_element(values.begin(), values.end())};
}

/// Distances of the pixels valid in both maps, and their ground sampling distances.
struct surface_distances {
  std::vector<double> distance;
  std::vector<double> gsd;
  std::uint64_t n_reference = 0;
  std::uint64_t n_without_normal = 0;
};

inline surface_distances measure_surface(raster::view<const float> estimate,
                                         raster::view<const float> reference,
                                         const math::camera& camera,
                                         const surface_error_options& o) {
  const ray_image ray = rays(camera, reference.width, reference.height);
  const bool slanted = o.distance == surface_distance::normal;
  const normal_image normal = slanted ? normals(reference, ray, o.normals) : normal_image();
  const double focal = (camera.fx() + camera.fy()) / 2;
  surface_distances found;
  for (std::size_t y = 0; y < reference.height; ++y) {
    for (std::size_t x = 0; x < reference.width; ++x) {
      const auto r = static_cast<double>(reference(x, y)),
                 raw = static_cast<double>(estimate(x, y));
      if ((o.mask.data && o.mask(x, y) == 0) || !(r > o.min && r < o.max)) continue;
      ++found.n_reference;
      const double e = o.transform.scale * raw + o.transform.shift;
      if (!is_valid(raw) || !is_valid(e)) continue;
      const Eigen::Vector3d direction = point_at(ray(x, y), 1);
      const bool has_normal = slanted && !normal(x, y).isZero(0);
      const double per_depth =
          has_normal ? std::abs(normal(x, y).cast<double>().dot(direction)) : direction.norm();
      if (std::isnan(per_depth)) continue;
      if (slanted && !has_normal) ++found.n_without_normal;
      found.distance.push_back(std::abs(e - r) * per_depth);
      found.gsd.push_back(r / focal);
    }
  }
  return found;
}

}  // namespace detail

inline surface_error_summary surface_errors(raster::view<const float> estimate,
                                            raster::view<const float> reference,
                                            const math::camera& camera,
                                            const surface_error_options& options) {
  check_sizes("depth::surface_errors", estimate, reference, options.mask);
  auto found = detail::measure_surface(estimate, reference, camera, options);
  if (found.distance.empty()) {
    throw undefined_error(message("depth::surface_errors: no pixel is valid in both maps, ",
                                  found.n_reference, " are in the reference"));
  }
  const auto n = static_cast<double>(found.distance.size());
  surface_error_summary result{};
  std::vector<double> multiples(found.distance.size());
  for (std::size_t i = 0; i < multiples.size(); ++i) {
    result.mean_gsd += found.gsd[i] / n;
    multiples[i] = found.distance[i] / found.gsd[i];
  }
  for (const double tau : options.tau) {
    const auto below = static_cast<double>(std::count_if(
        multiples.begin(), multiples.end(), [tau](double multiple) { return multiple < tau; }));
    result.within.push_back(below / n);
    result.within_total.push_back(below / static_cast<double>(found.n_reference));
  }
  result.distance = detail::spread_of(found.distance);
  result.gsd = detail::spread_of(multiples);
  result.coverage = n / static_cast<double>(found.n_reference);
  result.n_valid = multiples.size();
  result.n_reference = found.n_reference;
  result.n_without_normal = found.n_without_normal;
  return result;
}

}  // namespace aib::depth

// aib/io/bytes.hpp

namespace aib::io {

/// The number whose bytes lie at `from` in the given order.
template <class T>
[[nodiscard]] T load(const void* from, std::endian order = std::endian::little) {
  static_assert(std::is_arithmetic_v<T>);
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), from, sizeof(T));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// Appends the bytes of a number in the given order.
template <class T>
void store(std::string& to, T value, std::endian order = std::endian::little) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  to.append(bytes.data(), bytes.size());
}

/// Reads numbers one after another from bytes in memory. Every read is checked against the end, and
/// every error names the file, the byte and what was being read.
class byte_reader {
 public:
  byte_reader(std::string_view bytes,
              std::filesystem::path path,
              std::endian order = std::endian::little)
      : bytes_(bytes), path_(std::move(path)), order_(order) {}

  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }

  template <class T>
  T read(std::string_view what) {
    return load<T>(take(sizeof(T), what).data(), order_);
  }

  /// The next `n` bytes, in place.
  std::string_view take(std::size_t n, std::string_view what) {
    if (n > left()) fail(message(what, ": ", n, " bytes expected, ", left(), " left in the file"));
    return bytes_.substr(std::exchange(position_, position_ + n), n);
  }

  /// A count of records that take at least `record_bytes` each: refused where the file cannot hold
  /// so many.
  template <class T>
  std::size_t read_count(std::size_t record_bytes, std::string_view what) {
    const std::size_t at = position_;
    const auto count = static_cast<std::uint64_t>(read<T>(what));
    if (count > left() / record_bytes) {
      position_ = at;
      fail(message(what, ": ", count, " records of at least ", record_bytes,
                   " bytes do not fit in the ", bytes_.size() - at - sizeof(T), " bytes left"));
    }
    return static_cast<std::size_t>(count);
  }

  /// Text up to a NUL, which is skipped.
  std::string_view read_name(std::string_view what) {
    const std::size_t end = bytes_.find('\0', position_);
    if (end == std::string_view::npos) fail(message(what, ": no end of the name in the file"));
    const std::string_view name = bytes_.substr(position_, end - position_);
    position_ = end + 1;
    return name;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, at_byte{position_}, what);
  }

 private:
  std::string_view bytes_;
  std::filesystem::path path_;
  std::endian order_;
  std::size_t position_ = 0;
};

}  // namespace aib::io

// aib/io/file.hpp

namespace aib::io {

/// A regular file opened for reading, of which any part can be read. Throws io_error where the path
/// is not one: missing, a folder, a pipe, not permitted.
class input_file {
 public:
  explicit input_file(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] int descriptor() const { return ::fileno(file_.get()); }

  /// Reads exactly `n` bytes at `offset`. Throws format_error where the file ends before.
  void read_at(std::uint64_t offset, void* to, std::size_t n) const;

 private:
  struct closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, closer> file_;
  std::uint64_t size_ = 0;
};

/// The whole content of a file.
/// Throws io_error where it cannot be read, format_error where it is larger than `max_bytes`.
std::string read_file(const std::filesystem::path& path,
                      std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max());

/// Writes a file under a temporary name beside it; `commit` makes it the file in one step. Where
/// commit is never reached, or fails, the old file stays as it was and the temporary one is
/// removed.
class output_file {
 public:
  explicit output_file(std::filesystem::path path);
  output_file(const output_file&) = delete;
  output_file& operator=(const output_file&) = delete;
  ~output_file();

  /// Throws io_error where the disk is full or the file is not writable.
  void write(const void* data, std::size_t n);
  void write(std::string_view text) { write(text.data(), text.size()); }
  void commit();

 private:
  [[noreturn]] void fail(const char* doing) const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::FILE* file_ = nullptr;
};

/// Writes a whole file in one step, see output_file.
void write_file(const std::filesystem::path& path, std::string_view content);

inline input_file::input_file(std::filesystem::path path) : path_(std::move(path)) {
  // O_NONBLOCK: opening a pipe without a writer must not hang.
  const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) throw io_error(path_, message("cannot open: ", std::strerror(errno)));
  file_.reset(::fdopen(descriptor, "rb"));
  struct stat status = {};
  if (!file_ || ::fstat(descriptor, &status) != 0)
    throw io_error(path_, message("cannot open: ", std::strerror(errno)));
  if (!S_ISREG(status.st_mode)) {
    throw io_error(path_, S_ISDIR(status.st_mode) ? "a file expected, found a folder"
                                                  : "a regular file expected");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

inline void input_file::read_at(std::uint64_t offset, void* to, std::size_t n) const {
  auto* bytes = static_cast<char*>(to);
  while (n > 0) {
    const ssize_t got = ::pread(descriptor(), bytes, n, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw io_error(path_, message("cannot read: ", std::strerror(errno)));
    if (got == 0)
      throw format_error(path_, at_byte{offset},
                         message("the file ends, ", n, " more bytes expected"));
    bytes += got;
    offset += static_cast<std::uint64_t>(got);
    n -= static_cast<std::size_t>(got);
  }
}

inline std::string read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  const input_file file(path);
  if (file.size() > max_bytes) {
    throw format_error(path,
                       message("at most ", max_bytes, " bytes expected, found ", file.size()));
  }
  std::string content(static_cast<std::size_t>(file.size()), '\0');
  file.read_at(0, content.data(), content.size());
  return content;
}

inline output_file::output_file(std::filesystem::path path) : path_(std::move(path)) {
  std::string name = path_.string() + ".XXXXXX";
  const int descriptor = ::mkstemp(name.data());
  if (descriptor < 0) fail("create");
  temporary_ = name;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::fchmod(descriptor, 0666 & ~mask);
  file_ = ::fdopen(descriptor, "wb");
  if (!file_) fail("create");
}

inline output_file::~output_file() {
  if (file_) std::fclose(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

inline void output_file::fail(const char* doing) const {
  throw io_error(path_, message("cannot ", doing, ": ", std::strerror(errno)));
}

inline void output_file::write(const void* data, std::size_t n) {
  if (n > 0 && std::fwrite(data, 1, n, file_) != n) fail("write");
}

inline void output_file::commit() {
  if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) fail("write");
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("write");
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail("replace");
  temporary_.clear();
}

inline void write_file(const std::filesystem::path& path, std::string_view content) {
  output_file file(path);
  file.write(content);
  file.commit();
}

}  // namespace aib::io

// aib/io/half.hpp

namespace aib::io {

/// The value of an IEEE 754 half-precision number from its bits; exact.
[[nodiscard]] constexpr float float_from_half(std::uint16_t bits) {
  const std::uint32_t sign = std::uint32_t{bits & 0x8000u} << 16;
  const std::uint32_t exponent = (bits >> 10) & 0x1fu;
  const std::uint32_t mantissa = bits & 0x3ffu;
  if (exponent == 0) {  // zero and subnormals: mantissa * 2^-24
    const float magnitude = static_cast<float>(mantissa) * 0x1p-24f;
    return sign != 0 ? -magnitude : magnitude;
  }
  const std::uint32_t wide = exponent == 31 ? 255 : exponent + (127 - 15);
  return std::bit_cast<float>(sign | (wide << 23) | (mantissa << 13));
}

}  // namespace aib::io

// aib/io/text.hpp

namespace aib::io {

/// The text without blanks and line ends at both sides.
[[nodiscard]] inline std::string_view trim(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// The fields of a line: parted by `separator`, or by runs of blanks where it is 0. Fields are
/// trimmed.
inline void split(std::string_view line,
                  std::vector<std::string_view>& fields,
                  char separator = 0) {
  fields.clear();
  if (separator == 0) {
    constexpr std::string_view blank = " \t\r\n\v\f";
    for (std::size_t at = line.find_first_not_of(blank); at != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(blank, at), line.size());
      fields.push_back(line.substr(at, end - at));
      at = line.find_first_not_of(blank, end);
    }
    return;
  }
  for (;;) {
    const std::size_t end = line.find(separator);
    fields.push_back(trim(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

/// The number that the whole text is, in no locale; nothing where it is not one. "nan" and "inf"
/// are numbers, a leading + is allowed.
template <class Number>
[[nodiscard]] std::optional<Number> parse(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || text.empty()) return std::nullopt;
  if (code != std::errc()) return std::nullopt;
  return value;
}

/// Walks the lines of a text: LF or CRLF, the last with or without an end; a byte order mark is
/// skipped.
class line_reader {
 public:
  line_reader(std::string_view text, std::filesystem::path path)
      : rest_(text), path_(std::move(path)) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  }

  /// Moves to the next line; false after the last.
  bool next() {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    return true;
  }

  /// Moves to the next line that is neither blank nor a comment ('#').
  bool next_content() {
    while (next()) {
      const std::string_view content = trim(line_);
      if (!content.empty() && content.front() != '#') return true;
    }
    return false;
  }

  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::size_t number() const { return number_; }
  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, at_line{number_}, what);
  }

 private:
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;
  std::filesystem::path path_;
};

}  // namespace aib::io

// aib/io/npy.hpp

namespace aib::io {

/// Element types of arrays, with NumPy's names: kind and bytes.
enum class dtype { b1, i1, i2, i4, i8, u1, u2, u4, u8, f2, f4, f8 };

/// "f4" and the like.
[[nodiscard]] std::string_view name(dtype type);

/// Bytes of an element.
[[nodiscard]] std::size_t size_of(dtype type);

/// The type that holds T: bool, the integers and floats of 1 to 8 bytes.
template <class T>
[[nodiscard]] constexpr dtype dtype_of();

/// A dense array of numbers of any shape. The elements lie in C order (last index fastest) and in
/// the machine's byte order, whatever the file had.
struct array {
  dtype type = dtype::f8;
  std::vector<std::size_t> shape = {};  ///< empty: a single number
  std::string bytes = {};               ///< size() * size_of(type)

  [[nodiscard]] std::size_t size() const;
  /// The sub-array at an index of the first axis: `a[index]`. Throws argument_error if there is
  /// none.
  [[nodiscard]] array at(std::size_t index) const;
  /// Element `i` in C order, as a double. Integers beyond 2^53 are rounded.
  [[nodiscard]] double operator[](std::size_t i) const;
  /// All elements in C order, as float or double.
  template <std::floating_point Scalar>
  [[nodiscard]] std::vector<Scalar> values() const;
};

/// The shape as NumPy prints it: "(8, 5)", "(3,)", "()".
[[nodiscard]] std::string text_of_shape(std::span<const std::size_t> shape);

/// An array of the given shape over a copy of `values`. Throws argument_error where their number
/// is another.
template <class T>
[[nodiscard]] array make_array(std::vector<std::size_t> shape, std::span<const T> values);

/// An NPY file: versions 1 to 3, both byte orders, C and Fortran order, bool, integers and floats
/// of 1 to 8 bytes. Bytes after the elements are ignored, as NumPy does.
///
/// Throws format_error for pickled objects, structures, complex numbers, strings and long doubles,
/// and where the file is shorter than its shape.
/// Source: NumPy Enhancement Proposal 1, and numpy.lib.format of NumPy 2.
[[nodiscard]] array read_npy(const std::filesystem::path& path);

/// The same from bytes in memory; `path` names them in errors.
[[nodiscard]] array parse_npy(std::string bytes, const std::filesystem::path& path);

/// What NumPy writes for an array: version 1, C order, little endian, elements from a multiple of
/// 64 bytes on.
[[nodiscard]] std::string npy_bytes(const array& a);

void write_npy(const std::filesystem::path& path, const array& a);

namespace detail {

struct dtype_info {
  std::string_view name;
  std::size_t bytes;
};

inline constexpr std::array<dtype_info, 12> dtypes{{{"b1", 1},
                                                    {"i1", 1},
                                                    {"i2", 2},
                                                    {"i4", 4},
                                                    {"i8", 8},
                                                    {"u1", 1},
                                                    {"u2", 2},
                                                    {"u4", 4},
                                                    {"u8", 8},
                                                    {"f2", 2},
                                                    {"f4", 4},
                                                    {"f8", 8}}};

/// What the header of an NPY file says.
struct npy_header {
  dtype type = dtype::f8;
  std::endian order = std::endian::little;
  bool fortran = false;
  std::vector<std::size_t> shape;
  std::size_t begin = 0;  ///< byte of the first element
};

/// Reads the header's Python dictionary: no more of the language than NumPy writes there.
class npy_dictionary {
 public:
  npy_dictionary(std::string_view text, std::size_t at_byte, const std::filesystem::path& path)
      : text_(text), offset_(at_byte), path_(path) {}

  npy_header read() {
    expect('{');
    while (!accept('}')) {
      const std::string_view key = quoted();
      expect(':');
      value(key);
      if (!accept(',') && peek() != '}') fail("',' or '}' expected");
    }
    skip_blanks();
    if (at_ < text_.size()) fail("text after the dictionary");
    if (!seen_type_ || !seen_order_ || !seen_shape_)
      fail("the keys descr, fortran_order and shape expected");
    return std::move(header_);
  }

 private:
  void value(std::string_view key) {
    if (key == "descr") {
      once(seen_type_, key);
      type();
    } else if (key == "fortran_order") {
      once(seen_order_, key);
      header_.fortran = boolean();
    } else if (key == "shape") {
      once(seen_shape_, key);
      shape();
    } else {
      fail(message("unknown key '", key, "'"));
    }
  }

  void once(bool& seen, std::string_view key) const {
    if (std::exchange(seen, true)) fail(message("the key ", key, " comes twice"));
  }

  void type() {
    if (peek() == '[') fail("structured elements are not supported; save the fields apart");
    const std::string_view descr = quoted();
    const std::string_view type = descr.size() > 1 ? descr.substr(1) : descr;
    if (type.starts_with('O'))
      fail("the elements are pickled Python objects, which are never loaded");
    const auto known = std::find_if(dtypes.begin(), dtypes.end(),
                                    [&](const dtype_info& info) { return info.name == type; });
    const char order = descr.empty() ? '\0' : descr.front();
    const bool ordered = order == '<' || order == '>' || order == '=';
    if (known == dtypes.end() || !(ordered || (order == '|' && known->bytes == 1))) {
      fail(message("element type '", descr,
                   "' is not supported; bool, integers and floats of 1 to 8 bytes are"));
    }
    header_.type = static_cast<dtype>(known - dtypes.begin());
    if (order == '>') header_.order = std::endian::big;
    if (order == '=') header_.order = std::endian::native;
  }

  bool boolean() {
    if (accept_word("True")) return true;
    if (accept_word("False")) return false;
    fail("fortran_order: True or False expected");
  }

  void shape() {
    constexpr std::size_t max_axes = 32;
    expect('(');
    while (!accept(')')) {
      skip_blanks();
      const std::size_t end = std::min(text_.find_first_not_of("0123456789", at_), text_.size());
      const auto extent = parse<std::size_t>(text_.substr(at_, end - at_));
      if (!extent) fail("shape: a whole number expected");
      at_ = end;
      accept('L');  // Python 2 wrote long integers so
      header_.shape.push_back(*extent);
      if (header_.shape.size() > max_axes) fail("shape: more than 32 axes");
      if (!accept(',') && peek() != ')') fail("shape: ',' or ')' expected");
    }
  }

  std::string_view quoted() {
    const char quote = peek();
    if (quote != '\'' && quote != '"') fail("a quoted name expected");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("a quoted name without an end");
    const std::string_view content = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return content;
  }

  void skip_blanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
  char peek() {
    skip_blanks();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool accept(char c) {
    if (peek() != c || at_ == text_.size()) return false;
    ++at_;
    return true;
  }
  bool accept_word(std::string_view word) {
    skip_blanks();
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail(message("'", c, "' expected"));
  }
  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, at_byte{offset_ + at_}, message("npy: header: ", what));
  }

  std::string_view text_;
  std::size_t offset_;
  const std::filesystem::path& path_;
  std::size_t at_ = 0;
  npy_header header_;
  bool seen_type_ = false;
  bool seen_order_ = false;
  bool seen_shape_ = false;
};

/// Number of elements; nothing where it does not fit in memory's arithmetic.
inline std::optional<std::size_t> element_count(std::span<const std::size_t> shape) {
  constexpr std::size_t limit = std::numeric_limits<std::size_t>::max() / 16;
  std::size_t count = 1;
  bool empty = false;
  for (const std::size_t extent : shape) {
    empty |= extent == 0;
    if (extent > limit / count) return std::nullopt;
    count *= std::max<std::size_t>(extent, 1);
  }
  return empty ? 0 : count;
}

/// The bytes before the header's text: magic, version and its length.
struct npy_preamble {
  std::size_t text_begin;
  std::size_t text_size;
};

inline npy_preamble read_npy_preamble(std::string_view bytes, const std::filesystem::path& path) {
  byte_reader in(bytes, path);
  if (in.take(std::min<std::size_t>(6, bytes.size()), "npy: magic") != "\x93NUMPY")
    throw format_error(path, at_byte{0}, "npy: not an NPY file: it does not begin with \\x93NUMPY");
  const auto version = in.read<std::uint8_t>("npy: version");
  in.read<std::uint8_t>("npy: version");
  if (version < 1 || version > 3)
    in.fail(message("npy: version 1, 2 or 3 expected, found ", unsigned{version}));
  const std::size_t size = version == 1 ? in.read<std::uint16_t>("npy: header length")
                                        : in.read<std::uint32_t>("npy: header length");
  return {in.position(), size};
}

/// The header from the first bytes of a file that holds `file_size`.
/// Refuses a shape that the file cannot hold.
inline npy_header read_npy_header(std::string_view bytes,
                                  std::uint64_t file_size,
                                  const std::filesystem::path& path) {
  const npy_preamble preamble = read_npy_preamble(bytes, path);
  byte_reader in(bytes, path);
  in.take(preamble.text_begin, "npy: magic");
  const std::string_view text = in.take(preamble.text_size, "npy: header");
  npy_header header = npy_dictionary(text, preamble.text_begin, path).read();
  header.begin = in.position();
  const std::uint64_t left = file_size - header.begin;
  const auto count = element_count(header.shape);
  if (!count || *count > left / size_of(header.type)) {
    in.fail(message("npy: ", text_of_shape(header.shape), " elements of type ", name(header.type),
                    " do not fit in the ", left, " bytes left"));
  }
  return header;
}

inline void reverse_elements(std::string& bytes, std::size_t element) {
  for (std::size_t i = 0; i + element <= bytes.size(); i += element)
    std::reverse(bytes.data() + i, bytes.data() + i + element);
}

/// The elements of a Fortran-ordered array in C order.
inline std::string c_ordered(const std::string& bytes,
                             std::span<const std::size_t> shape,
                             std::size_t element) {
  std::vector<std::size_t> stride(shape.size());
  std::size_t step = element;
  for (std::size_t axis = 0; axis < shape.size(); ++axis) {
    stride[axis] = step;
    step *= shape[axis];
  }
  std::string out(bytes.size(), '\0');
  std::vector<std::size_t> index(shape.size(), 0);
  std::size_t from = 0;
  for (std::size_t to = 0; to < out.size(); to += element) {
    std::memcpy(out.data() + to, bytes.data() + from, element);
    for (std::size_t axis = shape.size(); axis-- > 0;) {
      from += stride[axis];
      if (++index[axis] < shape[axis]) break;
      from -= stride[axis] * shape[axis];
      index[axis] = 0;
    }
  }
  return out;
}

inline array make_array(npy_header header, std::string bytes) {
  const std::size_t element = size_of(header.type);
  if (header.order != std::endian::native) reverse_elements(bytes, element);
  if (header.fortran && header.shape.size() > 1) bytes = c_ordered(bytes, header.shape, element);
  return {header.type, std::move(header.shape), std::move(bytes)};
}

template <class T>
double load_native(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return static_cast<double>(value);
}

inline double load_half(const char* from) {
  std::uint16_t bits;
  std::memcpy(&bits, from, sizeof bits);
  return static_cast<double>(float_from_half(bits));
}

inline double load_boolean(const char* from) { return *from != 0 ? 1 : 0; }

/// The function that reads an element of a type.
inline double (*loader(dtype type))(const char*) {
  switch (type) {
    case dtype::b1:
      return load_boolean;
    case dtype::i1:
      return load_native<std::int8_t>;
    case dtype::i2:
      return load_native<std::int16_t>;
    case dtype::i4:
      return load_native<std::int32_t>;
    case dtype::i8:
      return load_native<std::int64_t>;
    case dtype::u1:
      return load_native<std::uint8_t>;
    case dtype::u2:
      return load_native<std::uint16_t>;
    case dtype::u4:
      return load_native<std::uint32_t>;
    case dtype::u8:
      return load_native<std::uint64_t>;
    case dtype::f2:
      return load_half;
    case dtype::f4:
      return load_native<float>;
    case dtype::f8:
      break;
  }
  return load_native<double>;
}

}  // namespace detail

inline std::string_view name(dtype type) {
  return detail::dtypes[static_cast<std::size_t>(type)].name;
}

inline std::size_t size_of(dtype type) {
  return detail::dtypes[static_cast<std::size_t>(type)].bytes;
}

template <class T>
constexpr dtype dtype_of() {
  static_assert(std::is_arithmetic_v<T> && sizeof(T) <= 8, "no element type of arrays");
  if constexpr (std::is_same_v<T, bool>) return dtype::b1;
  if constexpr (std::is_floating_point_v<T>) return sizeof(T) == 4 ? dtype::f4 : dtype::f8;
  const int power = std::countr_zero(sizeof(T));
  return static_cast<dtype>(static_cast<int>(std::is_signed_v<T> ? dtype::i1 : dtype::u1) + power);
}

inline std::size_t array::size() const { return detail::element_count(shape).value_or(0); }

inline array array::at(std::size_t index) const {
  if (shape.empty() || index >= shape.front()) {
    throw argument_error(
        message("array: no element ", index, " on the first axis of ", text_of_shape(shape)));
  }
  const std::size_t n = bytes.size() / shape.front();
  return {type, {shape.begin() + 1, shape.end()}, bytes.substr(index * n, n)};
}

inline double array::operator[](std::size_t i) const {
  return detail::loader(type)(bytes.data() + i * size_of(type));
}

template <std::floating_point Scalar>
std::vector<Scalar> array::values() const {
  std::vector<Scalar> out(size());
  if (type == dtype_of<Scalar>()) {
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }
  const auto load = detail::loader(type);
  const std::size_t element = size_of(type);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<Scalar>(load(bytes.data() + i * element));
  return out;
}

inline std::string text_of_shape(std::span<const std::size_t> shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += message(shape[i], i + 1 < shape.size() ? ", " : "");
  return text + (shape.size() == 1 ? ",)" : ")");
}

template <class T>
array make_array(std::vector<std::size_t> shape, std::span<const T> values) {
  array a{dtype_of<std::remove_const_t<T>>(), std::move(shape), {}};
  if (detail::element_count(a.shape) != values.size()) {
    throw argument_error(
        message("make_array: ", values.size(), " values for shape ", text_of_shape(a.shape)));
  }
  a.bytes.assign(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  return a;
}

inline array read_npy(const std::filesystem::path& path) {
  const input_file file(path);
  const auto part = [&](std::uint64_t offset, std::uint64_t n) {
    std::string bytes(static_cast<std::size_t>(std::min(n, file.size() - offset)), '\0');
    file.read_at(offset, bytes.data(), bytes.size());
    return bytes;
  };
  const std::string start = part(0, 12);
  const detail::npy_preamble preamble = detail::read_npy_preamble(start, path);
  const std::string text = part(0, preamble.text_begin + preamble.text_size);
  detail::npy_header header = detail::read_npy_header(text, file.size(), path);
  std::string elements =
      part(header.begin, *detail::element_count(header.shape) * size_of(header.type));
  return detail::make_array(std::move(header), std::move(elements));
}

inline array parse_npy(std::string bytes, const std::filesystem::path& path) {
  detail::npy_header header = detail::read_npy_header(bytes, bytes.size(), path);
  bytes.erase(0, header.begin);
  bytes.resize(*detail::element_count(header.shape) * size_of(header.type));
  return detail::make_array(std::move(header), std::move(bytes));
}

inline std::string npy_bytes(const array& a) {
  std::string text = message("{'descr': '", size_of(a.type) == 1 ? '|' : '<', name(a.type),
                             "', 'fortran_order': False, 'shape': ", text_of_shape(a.shape), ", }");
  text.append(63 - (10 + text.size()) % 64, ' ');
  text += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  store(bytes, static_cast<std::uint16_t>(text.size()));
  std::string elements = a.bytes;
  if (std::endian::native != std::endian::little)
    detail::reverse_elements(elements, size_of(a.type));
  return bytes + text + elements;
}

inline void write_npy(const std::filesystem::path& path, const array& a) {
  write_file(path, npy_bytes(a));
}

}  // namespace aib::io

// aib/io/positions.hpp

namespace aib::io {

/// Positions as clouds and meshes keep them: `origin + points[i]`.
struct float_positions {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> points = {};
};

/// Double positions as floats from the natural origin of their finite ones.
[[nodiscard]] inline float_positions to_floats(std::span<const Eigen::Vector3d> positions) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(infinite);
  Eigen::Vector3d high = -low;
  for (const Eigen::Vector3d& p : positions) {
    if (!p.allFinite()) continue;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  float_positions result;
  if (low[0] <= high[0]) result.origin = cloud::natural_origin(low, high);
  result.points.reserve(positions.size());
  for (const Eigen::Vector3d& p : positions)
    result.points.emplace_back((p - result.origin).cast<float>());
  return result;
}

/// How many points have a coordinate that is NaN or infinite.
[[nodiscard]] inline std::size_t count_non_finite(std::span<const Eigen::Vector3f> points) {
  // All exponent bits set: looked for in one flat loop without branches, since most files have
  // none.
  const float* flat = points.empty() ? nullptr : points.front().data();
  std::uint32_t any = 0;
  for (std::size_t i = 0; i < 3 * points.size(); ++i)
    any |= (std::bit_cast<std::uint32_t>(flat[i]) & 0x7f800000u) == 0x7f800000u ? 1u : 0u;
  if (any == 0) return 0;
  return static_cast<std::size_t>(std::count_if(
      points.begin(), points.end(), [](const Eigen::Vector3f& p) { return !p.allFinite(); }));
}

/// The sentence that a reader leaves about non-finite points; nothing where all are finite.
[[nodiscard]] inline std::optional<std::string> non_finite_warning(
    std::span<const Eigen::Vector3f> points, std::string_view name) {
  const std::size_t n = count_non_finite(points);
  if (n == 0) return std::nullopt;
  return message(n, " of ", points.size(), " ", name, " are not finite");
}

}  // namespace aib::io

// aib/io/npz.hpp

#if defined(AIB_WITH_EXR) || defined(AIB_WITH_NPZ)
#include <zlib.h>

namespace aib::io {

struct npz_options {
  /// A member that inflates to more than `max_ratio` times its stored size is refused where it
  /// needs more than `max_bytes`: arrays hardly compress so well, bombs do.
  double max_ratio = 100;
  std::uint64_t max_bytes = std::uint64_t{1} << 30;
};

/// What an array is, without its elements.
struct array_info {
  dtype type = dtype::f8;
  std::vector<std::size_t> shape = {};
};

/// Where the bytes of a member lie in the file, as they are or deflated.
struct npz_place {
  std::uint64_t begin;
  std::uint64_t packed;
  bool is_deflated;
};

/// An NPZ file: a zip of NPY arrays, stored or deflated, also beyond 4 GB (zip64). Sizes and places
/// come from the central directory, contents are checked against their CRC-32. Members are read
/// when asked for.
///
/// Needs zlib.
/// Source: PKWARE, APPNOTE.TXT 6.3.10; numpy.savez.
class npz_file {
 public:
  /// Throws io_error where the file cannot be opened, format_error where it is not a zip.
  explicit npz_file(const std::filesystem::path& path, const npz_options& options = {});

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

  /// Names of the arrays, without ".npy", in the order of the file.
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] bool contains(std::string_view name) const { return find(name) != nullptr; }

  /// Reads an array. Throws argument_error where there is none of that name, format_error where it
  /// is damaged, encrypted, of another compression, or pickled.
  [[nodiscard]] array read(std::string_view name) const;

  /// Shape and type from the array's header alone.
  /// Throws as read does.
  [[nodiscard]] array_info read_header(std::string_view name) const;

  /// The same with where the elements begin.
  [[nodiscard]] detail::npy_header npy_header_of(std::string_view name) const;

  /// For readers of a part of a member. Throws as read does.
  [[nodiscard]] npz_place place_of(std::string_view name) const;

  /// Whether the member is no array of numbers (a pickled object for one) and thus never loaded.
  [[nodiscard]] bool is_unreadable(std::string_view name) const;

 private:
  struct member {
    std::string name;
    std::uint64_t offset = 0;  ///< of the local header
    std::uint64_t packed = 0;
    std::uint64_t size = 0;
    std::uint32_t crc = 0;
    std::uint16_t method = 0;
    bool encrypted = false;
  };
  struct directory {
    std::uint64_t offset;
    std::uint64_t bytes;
    std::uint64_t members;
  };

  [[nodiscard]] std::string part(std::uint64_t offset, std::uint64_t n) const;
  [[nodiscard]] directory find_directory() const;
  [[nodiscard]] directory find_directory64(std::uint64_t end) const;
  [[nodiscard]] static member read_entry(byte_reader& in);
  static void read_zip64(std::string_view extra,
                         member& m,
                         std::uint32_t packed,
                         std::uint32_t size,
                         std::uint32_t offset,
                         byte_reader& in);
  [[nodiscard]] const member* find(std::string_view name) const;
  [[nodiscard]] const member& get(std::string_view name) const;
  [[nodiscard]] std::uint64_t data_offset(const member& m) const;
  /// The first `n` bytes of a member's content.
  [[nodiscard]] std::string content(const member& m, std::uint64_t n) const;
  [[nodiscard]] std::string inflated(const member& m, std::uint64_t n) const;
  [[noreturn]] void fail(const member& m, std::string_view what) const;

  input_file file_;
  npz_options options_;
  std::vector<member> members_;
};

/// All arrays of an NPZ file by name are too much at once as a rule; this reads one.
[[nodiscard]] inline array read_npz(const std::filesystem::path& path, std::string_view name) {
  return npz_file(path).read(name);
}

namespace detail {

inline constexpr std::uint32_t zip_local = 0x04034b50;
inline constexpr std::uint32_t zip_central = 0x02014b50;
inline constexpr std::uint32_t zip_end = 0x06054b50;
inline constexpr std::uint32_t zip64_end = 0x06064b50;
inline constexpr std::uint32_t zip64_locator = 0x07064b50;
inline constexpr std::uint32_t in_zip64 = 0xffffffff;  ///< the true number is in the extra field

/// Inflates raw deflate data block by block.
class deflate_stream {
 public:
  deflate_stream() { ready_ = ::inflateInit2(&stream_, -MAX_WBITS) == Z_OK; }
  deflate_stream(const deflate_stream&) = delete;
  deflate_stream& operator=(const deflate_stream&) = delete;
  ~deflate_stream() { ::inflateEnd(&stream_); }

  void input(std::string_view packed) {
    stream_.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed.data()));
    stream_.avail_in = static_cast<uInt>(packed.size());
  }
  /// Fills `out` from `from` on as far as the input goes; false where the data is damaged.
  bool fill(std::string& out, std::size_t& from) {
    while (ready_ && !ended_ && from < out.size()) {
      const std::size_t room = std::min<std::size_t>(out.size() - from, 1u << 30);
      stream_.next_out = reinterpret_cast<Bytef*>(out.data() + from);
      stream_.avail_out = static_cast<uInt>(room);
      const int code = ::inflate(&stream_, Z_NO_FLUSH);
      from += room - stream_.avail_out;
      ended_ = code == Z_STREAM_END;
      if (code == Z_BUF_ERROR || (code == Z_OK && stream_.avail_in == 0)) return true;
      if (code != Z_OK && code != Z_STREAM_END) return false;
    }
    return ready_;
  }

 private:
  z_stream stream_ = {};
  bool ready_ = false;
  bool ended_ = false;
};

inline std::uint32_t crc32_of(std::string_view bytes) {
  uLong crc = ::crc32(0, nullptr, 0);
  while (!bytes.empty()) {
    const std::size_t n = std::min<std::size_t>(bytes.size(), 1u << 30);
    crc = ::crc32(crc, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(n));
    bytes.remove_prefix(n);
  }
  return static_cast<std::uint32_t>(crc);
}

}  // namespace detail

inline npz_file::npz_file(const std::filesystem::path& path, const npz_options& options)
    : file_(path), options_(options) {
  const directory d = find_directory();
  const std::string bytes = part(d.offset, d.bytes);
  byte_reader in(bytes, path);
  constexpr std::size_t entry_bytes = 46;
  if (d.members > bytes.size() / entry_bytes)
    throw format_error(path, message("npz: ", d.members, " members do not fit in the directory"));
  for (std::uint64_t i = 0; i < d.members; ++i) {
    member m = read_entry(in);
    if (!m.name.ends_with(".npy")) continue;
    m.name.resize(m.name.size() - 4);
    members_.push_back(std::move(m));
  }
}

inline std::vector<std::string> npz_file::names() const {
  std::vector<std::string> names;
  for (const member& m : members_) names.push_back(m.name);
  return names;
}

inline array npz_file::read(std::string_view name) const {
  const member& m = get(name);
  const std::filesystem::path inside = message(path().string(), "[", m.name, "]");
  std::string bytes = content(m, m.size);
  if (detail::crc32_of(bytes) != m.crc) fail(m, "the content does not fit its checksum");
  return parse_npy(std::move(bytes), inside);
}

inline array_info npz_file::read_header(std::string_view name) const {
  detail::npy_header header = npy_header_of(name);
  return {header.type, std::move(header.shape)};
}

inline npz_place npz_file::place_of(std::string_view name) const {
  const member& m = get(name);
  static_cast<void>(content(m, std::min<std::uint64_t>(m.size, 1)));  // checks all but the end
  const std::uint64_t begin = data_offset(m);
  if (begin > file_.size() || m.packed > file_.size() - begin) fail(m, "cut off");
  return {begin, m.packed, m.method != 0};
}

inline detail::npy_header npz_file::npy_header_of(std::string_view name) const {
  const member& m = get(name);
  const std::filesystem::path inside = message(path().string(), "[", m.name, "]");
  const auto preamble =
      detail::read_npy_preamble(content(m, std::min<std::uint64_t>(m.size, 12)), inside);
  const std::uint64_t n = std::min<std::uint64_t>(m.size, preamble.text_begin + preamble.text_size);
  return detail::read_npy_header(content(m, n), m.size, inside);
}

inline bool npz_file::is_unreadable(std::string_view name) const {
  try {
    static_cast<void>(read_header(name));
    return false;
  } catch (const format_error&) {
    return true;
  }
}

inline std::string npz_file::part(std::uint64_t offset, std::uint64_t n) const {
  if (offset > file_.size() || n > file_.size() - offset) {
    throw format_error(path(), message("npz: bytes ", offset, " to ", offset + n,
                                       " expected, the file has ", file_.size()));
  }
  std::string bytes(static_cast<std::size_t>(n), '\0');
  file_.read_at(offset, bytes.data(), bytes.size());
  return bytes;
}

inline npz_file::directory npz_file::find_directory() const {
  constexpr std::uint64_t end_bytes = 22;
  constexpr std::uint64_t max_comment = 65535;
  const std::uint64_t tail = std::min(file_.size(), end_bytes + max_comment);
  const std::uint64_t begin = file_.size() - tail;
  const std::string bytes = part(begin, tail);
  const std::size_t at = bytes.rfind("PK\x05\x06");
  if (at == std::string::npos || tail - at < end_bytes)
    throw format_error(path(), "npz: not a zip file, or cut off: no end of the central directory");
  byte_reader in(std::string_view(bytes).substr(at + 8), path());
  in.read<std::uint16_t>("npz: members");
  const auto members = in.read<std::uint16_t>("npz: members");
  const auto size = in.read<std::uint32_t>("npz: directory size");
  const auto offset = in.read<std::uint32_t>("npz: directory offset");
  if (members == 0xffff || size == detail::in_zip64 || offset == detail::in_zip64)
    return find_directory64(begin + at);
  return {offset, size, members};
}

inline npz_file::directory npz_file::find_directory64(std::uint64_t end) const {
  constexpr std::uint64_t locator_bytes = 20;
  if (end < locator_bytes) throw format_error(path(), "npz: zip64 locator expected");
  const std::string bytes = part(end - locator_bytes, locator_bytes);
  byte_reader locator(bytes, path());
  if (locator.read<std::uint32_t>("npz: zip64 locator") != detail::zip64_locator)
    throw format_error(path(), at_byte{end - locator_bytes}, "npz: zip64 locator expected");
  locator.read<std::uint32_t>("npz: disk");
  const auto at = locator.read<std::uint64_t>("npz: zip64 end");
  const std::string record = part(at, 56);
  byte_reader in(record, path());
  if (in.read<std::uint32_t>("npz: zip64 end") != detail::zip64_end)
    throw format_error(path(), at_byte{at}, "npz: zip64 end of the central directory expected");
  in.take(28, "npz: zip64 end");
  const auto members = in.read<std::uint64_t>("npz: members");
  const auto size = in.read<std::uint64_t>("npz: directory size");
  return {in.read<std::uint64_t>("npz: directory offset"), size, members};
}

inline npz_file::member npz_file::read_entry(byte_reader& in) {
  if (in.read<std::uint32_t>("npz: entry") != detail::zip_central)
    in.fail("npz: an entry of the central directory expected");
  member m;
  in.take(4, "npz: versions");
  m.encrypted = (in.read<std::uint16_t>("npz: flags") & 1) != 0;
  m.method = in.read<std::uint16_t>("npz: method");
  in.take(4, "npz: time");
  m.crc = in.read<std::uint32_t>("npz: checksum");
  const auto packed = in.read<std::uint32_t>("npz: packed size");
  const auto size = in.read<std::uint32_t>("npz: size");
  const auto name_bytes = in.read<std::uint16_t>("npz: name length");
  const auto extra_bytes = in.read<std::uint16_t>("npz: extra length");
  const auto comment_bytes = in.read<std::uint16_t>("npz: comment length");
  in.take(8, "npz: attributes");
  const auto offset = in.read<std::uint32_t>("npz: offset");
  m.name = in.take(name_bytes, "npz: name");
  read_zip64(in.take(extra_bytes, "npz: extra field"), m, packed, size, offset, in);
  in.take(comment_bytes, "npz: comment");
  return m;
}

inline void npz_file::read_zip64(std::string_view extra,
                                 member& m,
                                 std::uint32_t packed,
                                 std::uint32_t size,
                                 std::uint32_t offset,
                                 byte_reader& in) {
  m.packed = packed;
  m.size = size;
  m.offset = offset;
  while (extra.size() >= 4) {
    const auto id = load<std::uint16_t>(extra.data());
    const auto bytes = load<std::uint16_t>(extra.data() + 2);
    std::string_view field = extra.substr(4, bytes);
    extra.remove_prefix(std::min<std::size_t>(extra.size(), 4u + bytes));
    if (id != 1) continue;
    for (auto* value : {size == detail::in_zip64 ? &m.size : nullptr,
                        packed == detail::in_zip64 ? &m.packed : nullptr,
                        offset == detail::in_zip64 ? &m.offset : nullptr}) {
      if (value == nullptr) continue;
      if (field.size() < 8) in.fail("npz: the zip64 extra field is too short");
      *value = load<std::uint64_t>(field.data());
      field.remove_prefix(8);
    }
  }
}

inline const npz_file::member* npz_file::find(std::string_view name) const {
  const auto m = std::find_if(members_.begin(), members_.end(),
                              [&](const member& one) { return one.name == name; });
  return m == members_.end() ? nullptr : &*m;
}

inline const npz_file::member& npz_file::get(std::string_view name) const {
  if (const member* m = find(name)) return *m;
  std::string known;
  for (const member& m : members_) known += message(known.empty() ? "" : ", ", m.name);
  throw argument_error(
      message(path().string(), ": npz: no array '", name, "'; there are: ", known));
}

inline std::uint64_t npz_file::data_offset(const member& m) const {
  constexpr std::uint64_t local_bytes = 30;
  const std::string bytes = part(m.offset, local_bytes);
  byte_reader in(bytes, path());
  if (in.read<std::uint32_t>("npz: local header") != detail::zip_local)
    fail(m, message("no local header at byte ", m.offset));
  in.take(22, "npz: local header");
  const auto name_bytes = in.read<std::uint16_t>("npz: name length");
  const auto extra_bytes = in.read<std::uint16_t>("npz: extra length");
  return m.offset + local_bytes + name_bytes + extra_bytes;
}

inline std::string npz_file::content(const member& m, std::uint64_t n) const {
  constexpr std::uint16_t stored = 0;
  constexpr std::uint16_t deflated = 8;
  if (m.encrypted) fail(m, "encrypted");
  if (m.method == deflated) return inflated(m, n);
  if (m.method != stored)
    fail(m, message("compression method ", m.method, " is not supported; 0 and 8 are"));
  if (m.packed != m.size) fail(m, "stored, but of two sizes");
  return part(data_offset(m), n);
}

inline std::string npz_file::inflated(const member& m, std::uint64_t n) const {
  constexpr std::uint64_t best_ratio = 1032;  // of deflate
  const std::uint64_t begin = data_offset(m);
  if (begin > file_.size() || m.packed > file_.size() - begin) fail(m, "cut off");
  const double ratio = static_cast<double>(m.size) / static_cast<double>(m.packed + 1);
  if (m.size / best_ratio > m.packed ||
      (ratio > options_.max_ratio && m.size > options_.max_bytes)) {
    fail(m, message("inflates from ", m.packed, " to ", m.size, " bytes, which no array does"));
  }
  std::string out(static_cast<std::size_t>(n), '\0');
  std::size_t filled = 0;
  detail::deflate_stream stream;
  constexpr std::uint64_t block_bytes = std::uint64_t{1} << 20;
  for (std::uint64_t at = 0; at < m.packed && filled < out.size();) {
    const std::string block = part(begin + at, std::min(block_bytes, m.packed - at));
    stream.input(block);
    if (!stream.fill(out, filled)) fail(m, "the deflated data is damaged");
    at += block.size();
  }
  if (filled < out.size())
    fail(m, message(out.size(), " bytes expected, the deflated data holds ", filled));
  return out;
}

inline void npz_file::fail(const member& m, std::string_view what) const {
  throw format_error(path(), message("npz: '", m.name, "': ", what));
}

}  // namespace aib::io
#endif

// aib/io/array_cloud.hpp

#if defined(AIB_WITH_NPZ)
#endif

namespace aib::io {

/// The points of an array whose last axis is x, y, z; the other axes are run through in their
/// order. Throws format_error for another shape.
inline cloud::cloud cloud_of_array(const array& a, const std::filesystem::path& path) {
  if (a.shape.size() < 2 || a.shape.back() != 3)
    throw format_error(path, message("an array of N x 3 expected, found ", text_of_shape(a.shape)));
  cloud::cloud result;
  const std::size_t n = a.size() / 3;
  if (a.type == dtype::f4 || a.type == dtype::f2) {
    const std::vector<float> values = a.values<float>();
    for (std::size_t i = 0; i < n; ++i)
      result.points.emplace_back(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
  } else {
    std::vector<Eigen::Vector3d> positions;
    for (std::size_t i = 0; i < n; ++i)
      positions.emplace_back(a[3 * i], a[3 * i + 1], a[3 * i + 2]);
    auto floats = to_floats(positions);
    result.origin = floats.origin;
    result.points = std::move(floats.points);
  }
  if (result.empty()) result.warnings.push_back("no points");
  if (auto warning = non_finite_warning(result.points, "points"))
    result.warnings.push_back(std::move(*warning));
  return result;
}

/// Reads a cloud from an NPY file of N x 3 numbers.
inline cloud::cloud read_npy_cloud(const std::filesystem::path& path) {
  return cloud_of_array(read_npy(path), path);
}

#if defined(AIB_WITH_NPZ)

/// Reads a cloud from an NPZ file.
///
/// key   the array; empty: `points`, `xyz`, `pts3d` or `world_points`, else the only one whose last
///       axis is 3
///
/// 8-bit `colors` or `rgb` of the same shape come with it.
/// Throws format_error where there is no such array.
inline cloud::cloud read_npz_cloud(const std::filesystem::path& path, std::string key = {}) {
  const npz_file file(path);
  std::string names;
  std::vector<std::string> candidates;
  for (const std::string& name : file.names()) {
    names += (names.empty() ? "" : ", ") + name;
    if (file.is_unreadable(name)) continue;
    const auto shape = file.read_header(name).shape;
    if (shape.size() >= 2 && shape.back() == 3) candidates.push_back(name);
    const bool usual =
        name == "points" || name == "xyz" || name == "pts3d" || name == "world_points";
    if (key.empty() && usual) key = name;
  }
  if (key.empty() && candidates.size() == 1) key = candidates.front();
  if (key.empty() || !file.contains(key))
    throw format_error(path, message("npz: ",
                                     key.empty() ? "which array holds the points?"
                                                 : message("no array \"", key, "\";"),
                                     " There are ", names));
  const array points = file.read(key);
  cloud::cloud result = cloud_of_array(points, path);
  for (const char* name : {"colors", "rgb"}) {
    if (!file.contains(name) || file.is_unreadable(name)) continue;
    const array colors = file.read(name);
    if (colors.type != dtype::u1 || colors.shape != points.shape) continue;
    for (std::size_t i = 0; i < result.size(); ++i) {
      cloud::color c;
      for (std::size_t k = 0; k < 3; ++k) c[k] = static_cast<std::uint8_t>(colors[3 * i + k]);
      result.colors.push_back(c);
    }
    break;
  }
  return result;
}

#endif

}  // namespace aib::io

// aib/io/array_depth.hpp

#if defined(AIB_WITH_NPZ)
#endif

namespace aib::io {

/// Depth maps in an array: H x W, or N of them, with axes of length 1 before or behind as the
/// methods leave them (VGGT: N x H x W x 1, pi3: 1 x N x H x W x 3).
class array_frames {
 public:
  /// points   the last axis is x, y, z in the frame of the camera, of which z is taken
  /// Throws format_error where the array has not that shape.
  array_frames(array values, const std::filesystem::path& path, std::string_view name);

  [[nodiscard]] std::size_t size() const { return n_; }

  /// Frame number i < size().
  [[nodiscard]] raster::image<float> frame(std::size_t i) const;

 private:
  array values_;
  std::size_t n_ = 1, height_ = 0, width_ = 0;
  std::size_t components_ = 1;
};

/// Reads the depth maps of an NPY or NPZ file.
///
/// key   the array of an NPZ file; empty: `depth`, `depths` or `local_points`, else the only one
///       with two axes or more
///
/// Pickled members are never loaded. Throws format_error where there is no such array.
array_frames read_array_frames(const std::filesystem::path& path, const std::string& key = {});

inline array_frames::array_frames(array values,
                                  const std::filesystem::path& path,
                                  std::string_view name)
    : values_(std::move(values)) {
  std::vector<std::size_t> shape = values_.shape;
  if (shape.size() > 2 && shape.back() == 3 && name == "local_points") {
    components_ = 3;
    shape.pop_back();
  }
  if (shape.size() > 2 && shape.back() == 1) shape.pop_back();
  while (shape.size() > 2 && shape.front() == 1) shape.erase(shape.begin());
  if (shape.size() < 2 || shape.size() > 3 || values_.size() == 0) {
    throw format_error(
        path, message("an array of H x W or N x H x W expected", name.empty() ? "" : " in ", name,
                      ", found ", text_of_shape(values_.shape)));
  }
  width_ = shape.back();
  height_ = shape[shape.size() - 2];
  if (shape.size() == 3) n_ = shape.front();
}

inline raster::image<float> array_frames::frame(std::size_t i) const {
  if (i >= n_) {
    throw argument_error(message("frame ", i + 1, " of ", n_, " does not exist"));
  }
  raster::image<float> image(width_, height_);
  const std::size_t first = i * image.size() * components_ + (components_ - 1);
  for (std::size_t k = 0; k < image.size(); ++k)
    image.data()[k] = static_cast<float>(values_[first + k * components_]);
  return image;
}

#if defined(AIB_WITH_NPZ)

namespace detail {

/// The array of an NPZ file that holds depth.
inline std::string depth_member(const npz_file& file, const std::string& key) {
  const std::vector<std::string> names = file.names();
  const auto list = [&] {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
  };
  if (!key.empty()) {
    if (file.contains(key)) return key;
    throw format_error(file.path(), message("npz: no array \"", key, "\"; there are ", list()));
  }
  for (const char* usual : {"depth", "depths", "local_points"})
    if (file.contains(usual) && !file.is_unreadable(usual)) return usual;
  std::vector<std::string> pictures;
  for (const std::string& name : names) {
    if (!file.is_unreadable(name) && file.read_header(name).shape.size() >= 2)
      pictures.push_back(name);
  }
  if (pictures.size() == 1) return pictures.front();
  throw format_error(file.path(), message("npz: no array is called depth; name one of ", list()));
}

}  // namespace detail

#endif

inline array_frames read_array_frames(const std::filesystem::path& path, const std::string& key) {
  std::string begin(2, '\0');
  const input_file file(path);
  if (file.size() >= begin.size()) file.read_at(0, begin.data(), begin.size());
  if (begin != "PK") return array_frames(read_npy(path), path, key);
#if defined(AIB_WITH_NPZ)
  const npz_file members(path);
  const std::string name = detail::depth_member(members, key);
  return array_frames(members.read(name), path, name);
#else
  throw format_error(path, "this build of aib reads no NPZ; build it with zlib");
#endif
}

}  // namespace aib::io

// aib/mesh/mesh.hpp

namespace aib::mesh {

using triangle = std::array<std::uint32_t, 3>;

/// Triangles over shared vertices. A vertex lies at `origin + vertices[i]`, as a point of a cloud
/// does.
///
/// `labels` is empty or one a triangle; `label_names[k]` names label k where the source does.
struct mesh {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> vertices = {};
  std::vector<triangle> triangles = {};
  std::vector<std::uint32_t> labels = {};
  std::vector<std::string> label_names = {};
  std::vector<std::string> warnings = {};  ///< what the reader removed or doubts, a sentence each

  [[nodiscard]] bool empty() const { return triangles.empty(); }
  [[nodiscard]] Eigen::Vector3d position(std::size_t vertex) const {
    return origin + vertices[vertex].cast<double>();
  }
};

}  // namespace aib::mesh

// aib/io/axes.hpp

namespace aib::io {

/// The axis that points up in a file. Blender's OBJ and glTF exports are Y up by default, its PLY
/// and STL exports Z up.
enum class up_axis { z, y };

/// "z" or "y". Throws argument_error for another name.
[[nodiscard]] inline up_axis parse_up_axis(std::string_view name) {
  if (name == "z") return up_axis::z;
  if (name == "y") return up_axis::y;
  throw argument_error(message("up: \"z\" or \"y\" expected, found \"", name, "\""));
}

namespace detail {

/// (x, y, z) of a Y-up frame in the Z-up frame: (x, -z, y).
template <class Scalar>
Eigen::Matrix<Scalar, 3, 1> z_up_from_y_up(const Eigen::Matrix<Scalar, 3, 1>& v) {
  return {v[0], -v[2], v[1]};
}

}  // namespace detail

/// Turns a cloud so that z points up, with its normals.
inline void turn_z_up(cloud::cloud& cloud, up_axis from) {
  if (from == up_axis::z) return;
  cloud.origin = detail::z_up_from_y_up(cloud.origin);
  for (Eigen::Vector3f& p : cloud.points) p = detail::z_up_from_y_up(p);
  for (Eigen::Vector3f& n : cloud.normals) n = detail::z_up_from_y_up(n);
}

/// Turns a mesh so that z points up.
inline void turn_z_up(mesh::mesh& mesh, up_axis from) {
  if (from == up_axis::z) return;
  mesh.origin = detail::z_up_from_y_up(mesh.origin);
  for (Eigen::Vector3f& v : mesh.vertices) v = detail::z_up_from_y_up(v);
}

}  // namespace aib::io

// aib/io/byte_stream.hpp

namespace aib::io {

/// Walks the bytes of a file from front to back in large blocks; only one block is in memory.
/// Every step is checked against the end of the file before memory is asked for, and every error
/// names the byte and what was being read. The file must outlive the stream.
class byte_stream {
 public:
  explicit byte_stream(const input_file& file, std::uint64_t offset = 0)
      : file_(&file), block_offset_(offset) {}

  [[nodiscard]] std::uint64_t offset() const { return block_offset_ + at_; }
  [[nodiscard]] std::uint64_t left() const { return file_->size() - offset(); }

  /// The next `n` bytes, valid until the next call.
  const char* take(std::size_t n, std::string_view what) {
    if (n > filled_ - at_) refill(n, what);
    const char* bytes = block_.data() + at_;
    at_ += n;
    return bytes;
  }

  template <class T>
  T read_number(std::string_view what, std::endian order = std::endian::little) {
    return load<T>(take(sizeof(T), what), order);
  }

  /// A count of records that take at least `record_bytes` each: refused where the file cannot hold
  /// so many.
  template <class T>
  std::size_t read_count(std::size_t record_bytes, std::string_view what) {
    const std::uint64_t at = offset();
    const auto count = static_cast<std::uint64_t>(read_number<T>(what));
    if (count > left() / record_bytes) {
      throw format_error(file_->path(), at_byte{at},
                         message(what, ": ", count, " records of at least ", record_bytes,
                                 " bytes do not fit in the ", left(), " bytes left"));
    }
    return static_cast<std::size_t>(count);
  }

  /// Text up to a NUL, which is skipped; at most 4096 characters.
  std::string take_name(std::string_view what) {
    std::string name;
    for (char c; (c = *take(1, what)) != '\0'; name += c) {
      if (name.size() == 4096) fail(message(what, ": no end within 4096 characters"));
    }
    return name;
  }

  /// Copies the next `n` bytes to `to`; large pieces go there without a detour.
  void read(void* to, std::size_t n, std::string_view what) {
    const std::size_t ready = std::min(n, filled_ - at_);
    if (ready > 0) std::memcpy(to, take(ready, what), ready);
    if (n == ready) return;
    if (n - ready < block_size) {
      std::memcpy(static_cast<char*>(to) + ready, take(n - ready, what), n - ready);
      return;
    }
    demand(n - ready, what);
    file_->read_at(offset(), static_cast<char*>(to) + ready, n - ready);
    move_to(offset() + (n - ready));
  }

  void skip(std::uint64_t n, std::string_view what) {
    demand(n, what);
    if (n <= filled_ - at_) {
      at_ += static_cast<std::size_t>(n);
    } else {
      move_to(offset() + n);
    }
  }

  /// Throws format_error where fewer than `n` bytes are left.
  void demand(std::uint64_t n, std::string_view what) const {
    if (n > left()) fail(message(what, ": ", n, " bytes expected, ", left(), " left in the file"));
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(file_->path(), at_byte{offset()}, what);
  }

 private:
  static constexpr std::size_t block_size = std::size_t{1} << 20;

  void move_to(std::uint64_t offset) {
    block_offset_ = offset;
    at_ = filled_ = 0;
  }

  void refill(std::size_t n, std::string_view what) {
    demand(n, what);
    const auto wanted = static_cast<std::size_t>(
        std::min<std::uint64_t>(left(), std::max<std::size_t>(n, block_size)));
    const std::size_t kept = filled_ - at_;
    if (kept > 0) std::memmove(block_.data(), block_.data() + at_, kept);
    move_to(offset());
    if (block_.size() < wanted) block_.resize(wanted);
    file_->read_at(block_offset_ + kept, block_.data() + kept, wanted - kept);
    filled_ = wanted;
  }

  const input_file* file_;
  std::vector<char> block_;
  std::uint64_t block_offset_;  ///< place of the block in the file
  std::size_t at_ = 0;          ///< next byte in the block
  std::size_t filled_ = 0;      ///< bytes of the block that were read
};

}  // namespace aib::io

// aib/io/file_kind.hpp

namespace aib::io {

/// Formats of clouds, meshes, depth maps and images that aib knows of; not all of them are read.
enum class file_kind {
  unknown,
  colmap_map,  ///< COLMAP's stereo/depth_maps/*.bin
  dmap,        ///< OpenMVS depth map
  e57,
  exr,
  glb,
  gltf,
  jpeg,
  las,  ///< LAS or LAZ
  npy,
  npz,
  obj,
  pcd,
  pfm,
  ply,
  png,
  stl,
  text_points,  ///< XYZ, CSV, PTS
};

/// The extension in lower case, with its dot.
[[nodiscard]] inline std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

namespace detail {

/// "480&270&1&": what COLMAP writes before its dense maps.
inline bool is_colmap_map(std::string_view begin) {
  std::size_t n_fields = 0;
  bool digits = false;
  for (const char c : begin) {
    if (c >= '0' && c <= '9') {
      digits = true;
    } else if (c == '&' && digits) {
      digits = false;
      if (++n_fields == 3) return true;
    } else {
      return false;
    }
  }
  return false;
}

/// A binary STL says in its bytes 80 to 83 how many triangles of 50 bytes follow. Text before them
/// may begin with "solid" all the same, so that only the size tells.
inline bool is_binary_stl(std::string_view begin, std::uint64_t file_size) {
  if (begin.size() < 84) return false;
  std::uint64_t n = 0;
  for (std::size_t i = 4; i-- > 0;) n = (n << 8) | static_cast<unsigned char>(begin[80 + i]);
  return file_size == 84 + 50 * n;
}

inline file_kind kind_of_content(std::string_view begin) {
  using namespace std::string_view_literals;
  constexpr std::array<std::pair<std::string_view, file_kind>, 18> magics{{
      {"ply\n"sv, file_kind::ply},
      {"ply\r"sv, file_kind::ply},
      {"\x76\x2f\x31\x01"sv, file_kind::exr},
      {"\x89PNG\r\n\x1a\n"sv, file_kind::png},
      {"\xff\xd8\xff"sv, file_kind::jpeg},
      {"\x93NUMPY"sv, file_kind::npy},
      {"PK\x03\x04"sv, file_kind::npz},
      {"PK\x05\x06"sv, file_kind::npz},
      {"Pf\n"sv, file_kind::pfm},
      {"Pf\r"sv, file_kind::pfm},
      {"Pf "sv, file_kind::pfm},
      {"PF\n"sv, file_kind::pfm},
      {"glTF"sv, file_kind::glb},
      {"LASF"sv, file_kind::las},
      {"ASTM-E57"sv, file_kind::e57},
      {"# .PCD"sv, file_kind::pcd},
      {"VERSION "sv, file_kind::pcd},
      {"solid"sv, file_kind::stl},
  }};
  for (const auto& [magic, kind] : magics) {
    if (begin.starts_with(magic)) return kind;
  }
  return is_colmap_map(begin) ? file_kind::colmap_map : file_kind::unknown;
}

inline file_kind kind_of_extension(std::string_view extension) {
  constexpr std::array<std::pair<std::string_view, file_kind>, 21> extensions{{
      {".asc", file_kind::text_points},
      {".csv", file_kind::text_points},
      {".dmap", file_kind::dmap},
      {".e57", file_kind::e57},
      {".exr", file_kind::exr},
      {".glb", file_kind::glb},
      {".gltf", file_kind::gltf},
      {".las", file_kind::las},
      {".laz", file_kind::las},
      {".npy", file_kind::npy},
      {".npz", file_kind::npz},
      {".obj", file_kind::obj},
      {".pcd", file_kind::pcd},
      {".pfm", file_kind::pfm},
      {".ply", file_kind::ply},
      {".png", file_kind::png},
      {".pts", file_kind::text_points},
      {".stl", file_kind::stl},
      {".txt", file_kind::text_points},
      {".xyz", file_kind::text_points},
      {".xyzrgb", file_kind::text_points},
  }};
  for (const auto& [known, kind] : extensions) {
    if (known == extension) return kind;
  }
  return file_kind::unknown;
}

}  // namespace detail

/// The format of a file: told from its first bytes, else from its extension.
/// Throws io_error where the file cannot be read.
[[nodiscard]] inline file_kind kind_of(const std::filesystem::path& path) {
  const input_file file(path);
  std::string begin(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 128)), '\0');
  file.read_at(0, begin.data(), begin.size());
  if (detail::is_binary_stl(begin, file.size())) return file_kind::stl;
  const file_kind kind = detail::kind_of_content(begin);
  return kind != file_kind::unknown ? kind : detail::kind_of_extension(extension_of(path));
}

}  // namespace aib::io

// aib/io/las.hpp

namespace aib::io {

/// Reads a LAS file, versions 1.0 to 1.4, point formats 0 to 10: positions, colours, and the
/// classification as label. Colours of 16 bits become 8; files that store 0..255 in them are told
/// from their largest value.
///
/// Throws format_error where the file is damaged, and for LAZ, which is compressed.
/// Source: ASPRS, "LAS Specification 1.4 - R15".
cloud::cloud read_las(const std::filesystem::path& path);

namespace detail {

struct las_header {
  std::uint64_t n_points = 0;
  std::uint64_t points_at = 0;
  std::size_t format = 0;
  std::size_t record_bytes = 0;
  Eigen::Vector3d scale, offset;
};

/// Bytes of a record, and where its colour lies (0: none), by point format.
inline constexpr std::array<std::size_t, 11> las_record_bytes{20, 28, 26, 34, 57, 63,
                                                              30, 36, 38, 59, 67};
inline constexpr std::array<std::size_t, 11> las_color_at{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

inline las_header read_las_header(const input_file& file) {
  constexpr std::size_t smallest = 227;
  const auto refuse = [&](std::string_view what) {
    throw format_error(file.path(), message("las: ", what));
  };
  if (file.size() < smallest) refuse("the file ends within the header");
  std::string bytes(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 375)), '\0');
  file.read_at(0, bytes.data(), bytes.size());
  const auto u8 = [&](std::size_t at) { return std::size_t{load<std::uint8_t>(&bytes[at])}; };
  if (!bytes.starts_with("LASF") || u8(24) != 1) refuse("not a LAS file of version 1");
  las_header header;
  header.points_at = load<std::uint32_t>(&bytes[96]);
  if (u8(104) >= 64)
    refuse(
        "LAZ is compressed; convert it with `laszip -i in.laz -o out.las` or "
        "`pdal translate in.laz out.las`");
  header.format = u8(104);
  header.record_bytes = load<std::uint16_t>(&bytes[105]);
  header.n_points = load<std::uint32_t>(&bytes[107]);
  if (u8(25) >= 4 && bytes.size() >= 255) header.n_points = load<std::uint64_t>(&bytes[247]);
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    header.scale[k] = load<double>(&bytes[131 + 8 * axis]);
    header.offset[k] = load<double>(&bytes[155 + 8 * axis]);
  }
  if (header.format > 10) refuse(message("point format 0 to 10 expected, found ", header.format));
  if (header.record_bytes < las_record_bytes[header.format])
    refuse(message("records of ", las_record_bytes[header.format], " bytes expected, found ",
                   header.record_bytes));
  if (!header.scale.allFinite() || !header.offset.allFinite())
    refuse("scale or offset is not finite");
  if (header.points_at > file.size() ||
      header.n_points > (file.size() - header.points_at) / header.record_bytes)
    refuse(message(header.n_points, " records of ", header.record_bytes, " bytes from byte ",
                   header.points_at, " expected, the file has ", file.size(), " bytes"));
  return header;
}

}  // namespace detail

inline cloud::cloud read_las(const std::filesystem::path& path) {
  const input_file file(path);
  const auto header = detail::read_las_header(file);
  const auto n = static_cast<std::size_t>(header.n_points);
  const std::size_t color_at = detail::las_color_at[header.format];
  std::vector<Eigen::Vector3d> positions(n);
  std::vector<std::array<std::uint16_t, 3>> colors(color_at > 0 ? n : 0);
  cloud::cloud result;
  result.labels.resize(n);
  std::uint16_t brightest = 0;
  byte_stream in(file, header.points_at);
  for (std::size_t i = 0; i < n; ++i) {
    const char* record = in.take(header.record_bytes, "las: record");
    for (int k = 0; k < 3; ++k)
      positions[i][k] = load<std::int32_t>(record + 4 * k) * header.scale[k] + header.offset[k];
    const bool is_old = header.format < 6;
    const auto classification = load<std::uint8_t>(record + (is_old ? 15 : 16));
    result.labels[i] = is_old ? classification & 31u : classification;
    for (std::size_t k = 0; k < 3 && color_at > 0; ++k) {
      colors[i][k] = load<std::uint16_t>(record + color_at + 2 * k);
      brightest = std::max(brightest, colors[i][k]);
    }
  }
  const unsigned unit = brightest > 255 ? 257 : 1;
  for (const auto& c : colors)
    result.colors.push_back({static_cast<std::uint8_t>(c[0] / unit),
                             static_cast<std::uint8_t>(c[1] / unit),
                             static_cast<std::uint8_t>(c[2] / unit)});
  auto floats = to_floats(positions);
  result.origin = floats.origin;
  result.points = std::move(floats.points);
  if (result.empty()) result.warnings.push_back("no points");
  return result;
}

}  // namespace aib::io

// aib/io/numbers.hpp

namespace aib::io {

/// Takes the next number off the front of a line, in no locale; nothing, and the line as it was,
/// where the next field is not a number or the line is at its end. Fields are parted by blanks and
/// the characters of `separators`. "nan" and "inf" are numbers; what is too small for double is 0.
[[nodiscard]] inline std::optional<double> take_number(std::string_view& line,
                                                       std::string_view separators = " \t\r\v\f") {
  const auto is_separator = [&](char c) { return separators.find(c) != std::string_view::npos; };
  std::size_t at = 0;
  while (at < line.size() && is_separator(line[at])) ++at;
  if (at + 1 < line.size() && line[at] == '+' && line[at + 1] != '-') ++at;
  double value = 0;
  const char* const last = line.data() + line.size();
  const auto [end, code] = std::from_chars(line.data() + at, last, value);
  if (code == std::errc::invalid_argument || (end != last && !is_separator(*end)))
    return std::nullopt;
  if (code == std::errc::result_out_of_range) {
    const std::string_view text(line.data() + at, static_cast<std::size_t>(end - line.data()) - at);
    if (text.find("e-") == std::string_view::npos && text.find("E-") == std::string_view::npos)
      return std::nullopt;
    value = 0;
  }
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  return value;
}

}  // namespace aib::io

// aib/io/obj.hpp

namespace aib::io {

/// Reads vertices and faces of a Wavefront OBJ file. Polygons become fans around their first
/// vertex; indices may be negative (from the end); everything else in the file is passed over.
/// Faces of less than three vertices are dropped with a warning.
///
/// Throws format_error where a number is damaged or an index has no vertex.
/// Source: Wavefront, "Object Files (.obj)", appendix B of the Advanced Visualizer manual.
mesh::mesh read_obj(const std::filesystem::path& path);

namespace detail {

class obj_reader {
 public:
  obj_reader(std::string_view text, const std::filesystem::path& path)
      : lines_(text, path), path_(path) {}

  mesh::mesh read() {
    while (next_statement()) {
      const std::string_view keyword = take_word();
      if (keyword == "v") {
        add_vertex();
      } else if (keyword == "f") {
        add_face();
      }
    }
    if (highest_ >= vertices_.size() && !result_.triangles.empty()) {
      throw format_error(path_, at_line{highest_line_},
                         message("obj: vertex ", highest_ + 1, " of ", vertices_.size()));
    }
    return finish();
  }

 private:
  /// Moves to the next statement; a backslash at the end of a line goes on in the next.
  bool next_statement() {
    if (!lines_.next()) return false;
    rest_ = trim(lines_.line());
    if (!rest_.ends_with('\\')) return true;
    joined_.clear();
    while (rest_.ends_with('\\')) {
      joined_ += rest_.substr(0, rest_.size() - 1);
      joined_ += ' ';
      rest_ = lines_.next() ? trim(lines_.line()) : std::string_view();
    }
    joined_ += rest_;
    rest_ = joined_;
    return true;
  }

  std::string_view take_word() {
    constexpr std::string_view blank = " \t\v\f";
    rest_.remove_prefix(std::min(rest_.find_first_not_of(blank), rest_.size()));
    const std::size_t end = std::min(rest_.find_first_of(blank), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }

  void add_vertex() {
    Eigen::Vector3d v;
    for (int k = 0; k < 3; ++k) {
      const auto number = take_number(rest_);
      if (!number) lines_.fail(message("obj: 3 coordinates of a vertex expected, found ", k));
      v[k] = *number;
    }
    vertices_.push_back(v);
  }

  void add_face() {
    corners_.clear();
    for (std::string_view word = take_word(); !word.empty(); word = take_word())
      corners_.push_back(vertex_of(word.substr(0, word.find('/'))));
    n_dropped_ += corners_.size() < 3 ? 1u : 0u;
    for (std::size_t k = 2; k < corners_.size(); ++k)
      result_.triangles.push_back({corners_[0], corners_[k - 1], corners_[k]});
  }

  /// "3" is the third vertex, "-1" the last one so far. A vertex may come after its face: that it
  /// exists is checked at the end.
  std::uint32_t vertex_of(std::string_view word) {
    const auto index = parse<std::int64_t>(word);
    const auto n = static_cast<std::int64_t>(vertices_.size());
    if (!index || *index == 0 || *index < -n ||
        *index > std::int64_t{std::numeric_limits<std::uint32_t>::max()}) {
      lines_.fail(message("obj: the index of a vertex (1 to ", n, ", or -1 to -", n,
                          ") expected, found \"", word.substr(0, 40), "\""));
    }
    const std::int64_t vertex = *index > 0 ? *index - 1 : n + *index;
    if (static_cast<std::size_t>(vertex) > highest_) {
      highest_ = static_cast<std::size_t>(vertex);
      highest_line_ = lines_.number();
    }
    return static_cast<std::uint32_t>(vertex);
  }

  mesh::mesh finish() {
    auto floats = to_floats(vertices_);
    result_.origin = floats.origin;
    result_.vertices = std::move(floats.points);
    if (n_dropped_ > 0)
      result_.warnings.push_back(
          message(n_dropped_, " faces of less than 3 vertices were dropped"));
    if (result_.triangles.empty()) result_.warnings.push_back("no triangles");
    if (auto warning = non_finite_warning(result_.vertices, "vertices"))
      result_.warnings.push_back(std::move(*warning));
    return std::move(result_);
  }

  line_reader lines_;
  std::filesystem::path path_;
  std::string_view rest_;
  std::string joined_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::uint32_t> corners_;
  std::size_t highest_ = 0;
  std::size_t highest_line_ = 0;
  std::size_t n_dropped_ = 0;
  mesh::mesh result_;
};

}  // namespace detail

inline mesh::mesh read_obj(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  return detail::obj_reader(text, path).read();
}

}  // namespace aib::io

// aib/io/pcd.hpp

namespace aib::io {

/// Reads a PCD file of the Point Cloud Library: ascii, binary and binary_compressed; fields x y z,
/// normal_x normal_y normal_z, rgb or rgba (packed), label. The viewpoint is not applied.
///
/// Throws format_error where the file is damaged.
/// Source: Point Cloud Library, "The PCD (Point Cloud Data) file format".
cloud::cloud read_pcd(const std::filesystem::path& path);

namespace detail {

struct pcd_field {
  std::string name;
  char type = 'F';         ///< F, I or U
  std::size_t bytes = 4;   ///< of one number
  std::size_t count = 1;   ///< numbers a point
  std::size_t offset = 0;  ///< in a binary row
};

struct pcd_header {
  std::vector<pcd_field> fields = {};
  std::uint64_t n = 0;
  std::string data = {};
  std::size_t end = 0;  ///< byte of the first datum
  std::size_t lines = 0;
  bool has_viewpoint = false;

  [[nodiscard]] std::size_t row_bytes() const {
    return fields.empty() ? 0 : fields.back().offset + fields.back().bytes * fields.back().count;
  }
  [[nodiscard]] const pcd_field* find(std::string_view name) const {
    for (const pcd_field& f : fields)
      if (f.name == name) return &f;
    return nullptr;
  }
};

class pcd_header_parser {
 public:
  pcd_header_parser(std::string_view text, const std::filesystem::path& path)
      : text_(text), lines_(text, path) {}

  pcd_header parse() {
    while (lines_.next_content()) {
      split(lines_.line(), words_);
      const std::string_view key = words_[0];
      if (key == "FIELDS" || key == "COLUMNS") parse_names();
      if (key == "SIZE") each([](pcd_field& f, std::size_t v) { f.bytes = v; });
      if (key == "COUNT") each([](pcd_field& f, std::size_t v) { f.count = v; });
      if (key == "TYPE") parse_types();
      if (key == "WIDTH") width_ = number(1);
      if (key == "HEIGHT") height_ = number(1);
      if (key == "POINTS") points_ = number(1);
      if (key == "VIEWPOINT") parse_viewpoint();
      if (key == "DATA") return finish();
    }
    lines_.fail("pcd: no DATA line");
  }

 private:
  void parse_names() {
    for (std::size_t i = 1; i < words_.size(); ++i)
      header_.fields.push_back({std::string(words_[i])});
  }

  template <class Set>
  void each(Set set) {
    if (words_.size() != header_.fields.size() + 1)
      lines_.fail(message("pcd: ", header_.fields.size(), " values expected"));
    for (std::size_t i = 0; i < header_.fields.size(); ++i)
      set(header_.fields[i], static_cast<std::size_t>(number(i + 1)));
  }

  void parse_types() {
    if (words_.size() != header_.fields.size() + 1) lines_.fail("pcd: a TYPE a field expected");
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      if (words_[i + 1] != "F" && words_[i + 1] != "I" && words_[i + 1] != "U")
        lines_.fail("pcd: TYPE F, I or U expected");
      header_.fields[i].type = words_[i + 1][0];
    }
  }

  void parse_viewpoint() {
    constexpr std::array<std::string_view, 8> identity{"VIEWPOINT", "0", "0", "0",
                                                       "1",         "0", "0", "0"};
    for (std::size_t i = 0; i < identity.size() && i < words_.size(); ++i)
      header_.has_viewpoint = header_.has_viewpoint || words_[i] != identity[i];
  }

  std::uint64_t number(std::size_t i) const {
    const auto value = i < words_.size() ? io::parse<std::uint64_t>(words_[i]) : std::nullopt;
    if (!value || *value > std::uint64_t{1} << 40)
      lines_.fail(message("pcd: a whole number expected behind ", words_[0]));
    return *value;
  }

  pcd_header finish() {
    if (words_.size() != 2) lines_.fail("pcd: DATA ascii, binary or binary_compressed expected");
    header_.data = words_[1];
    header_.n = points_ ? *points_ : width_ * height_;
    std::size_t offset = 0;
    for (pcd_field& f : header_.fields) {
      const bool known = f.bytes == 1 || f.bytes == 2 || f.bytes == 4 || f.bytes == 8;
      if (!known || (f.type == 'F' && f.bytes < 4) || f.count == 0 || f.count > 65536)
        lines_.fail(
            message("pcd: field ", f.name, " of ", f.count, " numbers of ", f.bytes, " bytes"));
      f.offset = offset;
      offset += f.bytes * f.count;
    }
    for (const char* axis : {"x", "y", "z"})
      if (!header_.find(axis)) lines_.fail("pcd: fields x, y and z expected");
    const std::string_view line = lines_.line();
    header_.end = static_cast<std::size_t>(line.data() + line.size() - text_.data());
    header_.end = std::min(text_.find('\n', header_.end), text_.size() - 1) + 1;
    header_.lines = lines_.number();
    return std::move(header_);
  }

  std::string_view text_;
  line_reader lines_;
  std::vector<std::string_view> words_;
  pcd_header header_;
  std::uint64_t width_ = 0, height_ = 1;
  std::optional<std::uint64_t> points_;
};

/// Expands LibLZF; false where the result has not exactly `to.size()` bytes.
inline bool expand_lzf(std::string_view from, std::span<char> to) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < from.size();) {
    const std::size_t control = static_cast<unsigned char>(from[i++]);
    const auto next = [&] { return std::size_t{static_cast<unsigned char>(from[i++])}; };
    if (control < 32) {
      const std::size_t run = control + 1;
      if (run > from.size() - i || run > to.size() - n) return false;
      std::memcpy(to.data() + n, from.data() + i, run);
      i += run;
      n += run;
      continue;
    }
    std::size_t run = control >> 5;
    if (from.size() - i < (run == 7 ? 2u : 1u)) return false;
    if (run == 7) run += next();
    run += 2;
    const std::size_t back = ((control & 31) << 8) + next() + 1;
    if (back > n || run > to.size() - n) return false;
    for (std::size_t k = 0; k < run; ++k, ++n) to[n] = to[n - back];
  }
  return n == to.size();
}

inline double pcd_number(const pcd_field& field, const char* at) {
  const auto as = [&]<class I, class U>(I, U) {
    return field.type == 'I' ? static_cast<double>(load<I>(at)) : static_cast<double>(load<U>(at));
  };
  if (field.type == 'F')
    return field.bytes == 4 ? static_cast<double>(load<float>(at)) : load<double>(at);
  switch (field.bytes) {
    case 1:
      return as(std::int8_t{}, std::uint8_t{});
    case 2:
      return as(std::int16_t{}, std::uint16_t{});
    case 4:
      return as(std::int32_t{}, std::uint32_t{});
    default:
      return as(std::int64_t{}, std::uint64_t{});
  }
}

/// Numbers of the wanted fields, point by point.
class pcd_points {
 public:
  pcd_points(const pcd_header& header, std::string_view bytes, const std::filesystem::path& path)
      : header_(header),
        path_(path),
        color_(header.find("rgb") ? header.find("rgb") : header.find("rgba")),
        label_(header.find("label")) {
    if (header.data == "ascii") {
      read_ascii(bytes);
    } else if (header.data == "binary") {
      read_binary(bytes.substr(header.end), header.row_bytes());
    } else if (header.data == "binary_compressed") {
      read_compressed(bytes.substr(header.end));
    } else {
      fail(message("DATA ascii, binary or binary_compressed expected, found ", header.data));
    }
  }

  cloud::cloud finish() {
    auto floats = to_floats(positions_);
    result_.origin = floats.origin;
    result_.points = std::move(floats.points);
    if (header_.has_viewpoint)
      result_.warnings.push_back("the viewpoint in the header was not applied");
    if (result_.empty()) result_.warnings.push_back("no points");
    if (auto warning = non_finite_warning(result_.points, "points"))
      result_.warnings.push_back(std::move(*warning));
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, message("pcd: ", what));
  }

  void read_ascii(std::string_view text) {
    line_reader lines(text, path_);
    for (std::size_t i = 0; i < header_.lines; ++i) lines.next();
    for (std::uint64_t i = 0; i < header_.n; ++i) {
      if (!lines.next_content())
        lines.fail(message("pcd: ", header_.n, " points expected, found ", i));
      std::string_view rest = lines.line();
      add([&](const pcd_field& f, std::size_t) {
        const auto number = take_number(rest);
        if (!number) lines.fail(message("pcd: a number expected for ", f.name));
        return *number;
      });
    }
  }

  void read_binary(std::string_view bytes, std::size_t row) {
    if (header_.n > bytes.size() / row)
      fail(message(header_.n, " points of ", row, " bytes expected, the file has ", bytes.size(),
                   " bytes for them"));
    for (std::uint64_t i = 0; i < header_.n; ++i) {
      const char* at = bytes.data() + i * row;
      add([&](const pcd_field& f, std::size_t k) {
        return pcd_number(f, at + f.offset + k * f.bytes);
      });
    }
  }

  /// Compressed data lie field after field.
  void read_compressed(std::string_view bytes) {
    byte_reader in(bytes, path_);
    const auto packed = in.read<std::uint32_t>("pcd: compressed size");
    const auto size = in.read<std::uint32_t>("pcd: size");
    const std::string_view block = in.take(packed, "pcd: compressed points");
    constexpr std::size_t most = 264;  // what three bytes of LZF can stand for
    if (header_.n > size / header_.row_bytes() || size != header_.n * header_.row_bytes() ||
        size / most > packed)
      fail(message(header_.n, " points of ", header_.row_bytes(), " bytes expected, found ", size,
                   " bytes in ", packed));
    std::vector<char> plain(size);
    if (!expand_lzf(block, plain)) fail("the compressed points are damaged");
    for (std::uint64_t i = 0; i < header_.n; ++i) {
      add([&](const pcd_field& f, std::size_t k) {
        return pcd_number(f, plain.data() + f.offset * header_.n + (i * f.count + k) * f.bytes);
      });
    }
  }

  /// Adds a point whose numbers `get(field, k)` gives in file order.
  template <class Get>
  void add(Get get) {
    Eigen::Vector3d position(0, 0, 0);
    Eigen::Vector3f normal(0, 0, 0);
    for (const pcd_field& f : header_.fields) {
      for (std::size_t k = 0; k < f.count; ++k) {
        const double value = get(f, k);
        if (k > 0) continue;
        if (f.name.size() == 1 && f.name[0] >= 'x' && f.name[0] <= 'z')
          position[f.name[0] - 'x'] = value;
        if (f.name.size() == 8 && f.name.starts_with("normal_") && f.name[7] >= 'x' &&
            f.name[7] <= 'z')
          normal[f.name[7] - 'x'] = static_cast<float>(value);
        if (&f == color_) result_.colors.push_back(color(f, value));
        if (&f == label_) result_.labels.push_back(label_of(value));
      }
    }
    positions_.push_back(position);
    if (header_.find("normal_x")) result_.normals.push_back(normal);
  }

  static std::uint32_t label_of(double value) {
    return value >= 0 && value < 4294967296.0 ? static_cast<std::uint32_t>(value) : 0;
  }

  /// Red, green, blue in the lower bytes of a number, which may be stored as the bits of a float.
  static cloud::color color(const pcd_field& field, double value) {
    const std::uint32_t bits = field.type == 'F'
                                   ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                                   : label_of(value);
    return {static_cast<std::uint8_t>(bits >> 16), static_cast<std::uint8_t>(bits >> 8),
            static_cast<std::uint8_t>(bits)};
  }

  const pcd_header& header_;
  std::filesystem::path path_;
  const pcd_field* color_;
  const pcd_field* label_;
  std::vector<Eigen::Vector3d> positions_;
  cloud::cloud result_;
};

}  // namespace detail

inline cloud::cloud read_pcd(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  const auto header = detail::pcd_header_parser(bytes, path).parse();
  return detail::pcd_points(header, bytes, path).finish();
}

}  // namespace aib::io

// aib/io/ply_header.hpp

namespace aib::io {

enum class ply_format { ascii, binary_little_endian, binary_big_endian };

enum class ply_type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Calls `body(std::type_identity<T>{})` with the C++ type.
template <class Body>
decltype(auto) with_type(ply_type type, Body&& body) {
  switch (type) {
    case ply_type::int8:
      return body(std::type_identity<std::int8_t>{});
    case ply_type::uint8:
      return body(std::type_identity<std::uint8_t>{});
    case ply_type::int16:
      return body(std::type_identity<std::int16_t>{});
    case ply_type::uint16:
      return body(std::type_identity<std::uint16_t>{});
    case ply_type::int32:
      return body(std::type_identity<std::int32_t>{});
    case ply_type::uint32:
      return body(std::type_identity<std::uint32_t>{});
    case ply_type::float32:
      return body(std::type_identity<float>{});
    default:
      return body(std::type_identity<double>{});
  }
}

[[nodiscard]] constexpr std::size_t size_of(ply_type type) {
  constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

/// A column of an element: one number a row, or a list of them.
struct ply_property {
  std::string name;
  ply_type type;
  std::optional<ply_type> list_count = {};  ///< type of the count, where the property is a list
};

/// A table of the file: rows of equal properties.
struct ply_element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<ply_property> properties = {};

  [[nodiscard]] bool has_list() const {
    return std::any_of(properties.begin(), properties.end(),
                       [](const ply_property& p) { return p.list_count.has_value(); });
  }

  /// Bytes of a binary row; where the element has lists, those of a row of empty lists.
  [[nodiscard]] std::size_t row_bytes() const {
    std::size_t n = 0;
    for (const ply_property& p : properties) n += size_of(p.list_count.value_or(p.type));
    return n;
  }

  /// Index of a property, nothing where there is none of this name.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
      if (properties[i].name == property) return i;
    }
    return std::nullopt;
  }
};

/// What stands before the data of a PLY file.
struct ply_header {
  ply_format format = ply_format::ascii;
  std::vector<ply_element> elements = {};
  std::vector<std::string> comments = {};
  std::uint64_t data_offset = 0;
  std::size_t lines = 0;

  [[nodiscard]] const ply_element* find(std::string_view element) const {
    for (const ply_element& e : elements) {
      if (e.name == element) return &e;
    }
    return nullptr;
  }
};

/// Reads the header of a PLY file; LF and CRLF line ends. Throws format_error where it is damaged,
/// longer than a megabyte, or announces more rows than the file can hold.
ply_header read_ply_header(const input_file& file);

namespace detail {

inline std::optional<ply_type> find_ply_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, ply_type>, 16> types{{
      {"char", ply_type::int8},
      {"int8", ply_type::int8},
      {"uchar", ply_type::uint8},
      {"uint8", ply_type::uint8},
      {"short", ply_type::int16},
      {"int16", ply_type::int16},
      {"ushort", ply_type::uint16},
      {"uint16", ply_type::uint16},
      {"int", ply_type::int32},
      {"int32", ply_type::int32},
      {"uint", ply_type::uint32},
      {"uint32", ply_type::uint32},
      {"float", ply_type::float32},
      {"float32", ply_type::float32},
      {"double", ply_type::float64},
      {"float64", ply_type::float64},
  }};
  for (const auto& [known, type] : types) {
    if (known == name) return type;
  }
  return std::nullopt;
}

/// The lines of the header one by one.
class ply_header_parser {
 public:
  explicit ply_header_parser(const input_file& file) : file_(file) { load_text(); }

  ply_header parse() {
    if (file_.size() == 0) throw format_error(file_.path(), "ply: the file is empty");
    if (!next() || trim(line_) != "ply") fail("ply: the first line must be \"ply\"");
    bool has_format = false;
    while (next()) {
      split(line_, fields_);
      if (fields_.empty() || fields_[0] == "obj_info") continue;
      if (fields_[0] == "comment") {
        header_.comments.emplace_back(trim(line_.substr(line_.find("comment") + 7)));
      } else if (fields_[0] == "format") {
        parse_format();
        has_format = true;
      } else if (fields_[0] == "element") {
        parse_element();
      } else if (fields_[0] == "property") {
        parse_property();
      } else if (fields_[0] == "end_header") {
        if (!has_format) fail("ply: no format line in the header");
        header_.data_offset = at_;
        header_.lines = number_;
        check_sizes();
        return std::move(header_);
      } else {
        fail(message("ply: format, element, property, comment or end_header expected, found \"",
                     fields_[0].substr(0, 40), "\""));
      }
    }
    fail(message("ply: no end_header in the first ", text_.size(), " bytes"));
  }

 private:
  static constexpr std::size_t max_header = std::size_t{1} << 20;

  void load_text() {
    text_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(file_.size(), 4096)));
    file_.read_at(0, text_.data(), text_.size());
    while (text_.find("end_header") == std::string::npos && text_.size() < max_header &&
           text_.size() < file_.size() && text_.starts_with("ply")) {
      const std::size_t read = text_.size();
      text_.resize(static_cast<std::size_t>(
          std::min<std::uint64_t>({file_.size(), max_header, std::uint64_t{4} * read})));
      file_.read_at(read, text_.data() + read, text_.size() - read);
    }
  }

  bool next() {
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string::npos) return false;
    line_ = std::string_view(text_).substr(at_, end - at_);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    at_ = end + 1;
    ++number_;
    return true;
  }

  void parse_format() {
    const std::string_view name = fields_.size() > 1 ? fields_[1] : "";
    if (name == "ascii") {
      header_.format = ply_format::ascii;
    } else if (name == "binary_little_endian") {
      header_.format = ply_format::binary_little_endian;
    } else if (name == "binary_big_endian") {
      header_.format = ply_format::binary_big_endian;
    } else {
      fail(
          message("ply: format ascii, binary_little_endian or binary_big_endian expected, found \"",
                  name.substr(0, 40), "\""));
    }
  }

  void parse_element() {
    if (fields_.size() != 3) fail("ply: expected \"element NAME COUNT\"");
    const auto count = io::parse<std::uint64_t>(fields_[2]);
    if (!count) {
      fail(message("ply: count of element ", fields_[1].substr(0, 40), " expected, found \"",
                   fields_[2].substr(0, 40), "\""));
    }
    header_.elements.push_back({std::string(fields_[1]), *count});
  }

  void parse_property() {
    if (header_.elements.empty()) fail("ply: property before the first element");
    ply_property property;
    if (fields_.size() == 5 && fields_[1] == "list") {
      property = {std::string(fields_[4]), type_named(fields_[3]), type_named(fields_[2])};
      if (*property.list_count >= ply_type::float32)
        fail("ply: the count of a list must be an integer type");
    } else if (fields_.size() == 3) {
      property = {std::string(fields_[2]), type_named(fields_[1])};
    } else {
      fail("ply: expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
    }
    header_.elements.back().properties.push_back(std::move(property));
  }

  ply_type type_named(std::string_view name) const {
    if (const auto type = find_ply_type(name)) return *type;
    fail(message("ply: unknown type \"", name.substr(0, 40), "\""));
  }

  void check_sizes() const {
    const bool ascii = header_.format == ply_format::ascii;
    // An ascii number takes a digit and a blank; the last line may lack its end.
    std::uint64_t left = file_.size() - header_.data_offset + (ascii ? 1 : 0);
    for (const ply_element& e : header_.elements) {
      const std::uint64_t row = ascii ? 2 * e.properties.size() : e.row_bytes();
      if (row == 0) continue;
      if (e.count > left / row) {
        throw format_error(
            file_.path(), message("ply: element ", e.name, ": ", e.count, " rows of at least ", row,
                                  " bytes expected, the file has ", left, " bytes for them"));
      }
      left -= e.count * row;
    }
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(file_.path(), at_line{number_}, what);
  }

  const input_file& file_;
  std::string text_;
  std::size_t at_ = 0;
  std::string_view line_;
  std::size_t number_ = 0;
  std::vector<std::string_view> fields_;
  ply_header header_;
};

}  // namespace detail

inline ply_header read_ply_header(const input_file& file) {
  return detail::ply_header_parser(file).parse();
}

}  // namespace aib::io

// aib/io/ply_data.hpp

namespace aib::io::detail {

/// A row of an element as numbers.
struct ply_row {
  std::vector<double> values;  ///< one a property; of a list its length
  std::vector<double> list;    ///< items of the list that was asked for
};

inline constexpr std::size_t no_list = ~std::size_t{0};

/// The data of a PLY file, element by element in file order.
class ply_data {
 public:
  virtual ~ply_data() = default;
  virtual void read_row(const ply_element& element, std::size_t wanted_list, ply_row& row) = 0;
  virtual void skip(const ply_element& element) = 0;
  /// The bytes that come next, where the data are binary.
  virtual byte_stream* stream() { return nullptr; }
  /// An error at the place where the data were last read.
  [[nodiscard]] virtual format_error error(std::string_view what) const = 0;
};

class ply_binary_data : public ply_data {
 public:
  ply_binary_data(const input_file& file, std::uint64_t offset, std::endian order)
      : path_(file.path()), stream_(file, offset), order_(order) {}

  void read_row(const ply_element& element, std::size_t wanted_list, ply_row& row) override {
    row.values.clear();
    row.list.clear();
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const ply_property& p = element.properties[i];
      row.values.push_back(take(p.list_count.value_or(p.type), p));
      if (p.list_count) read_list(p, i == wanted_list, row);
    }
  }

  void skip(const ply_element& element) override {
    if (!element.has_list()) {
      stream_.skip(element.count * element.row_bytes(), element.name);
      return;
    }
    ply_row row;
    for (std::uint64_t i = 0; i < element.count; ++i) read_row(element, no_list, row);
  }

  byte_stream* stream() override { return &stream_; }
  [[nodiscard]] format_error error(std::string_view what) const override {
    return format_error(path_, at_byte{stream_.offset()}, what);
  }

 private:
  double number(ply_type type, const char* from) const {
    return with_type(type, [&]<class T>(std::type_identity<T>) {
      return static_cast<double>(load<T>(from, order_));
    });
  }

  double take(ply_type type, const ply_property& p) {
    return number(type, stream_.take(size_of(type), p.name));
  }

  void read_list(const ply_property& p, bool wanted, ply_row& row) {
    const double count = row.values.back();
    if (count < 0) throw error(message("ply: list ", p.name, " of ", count, " items"));
    const auto n = static_cast<std::size_t>(count);
    const char* items = stream_.take(n * size_of(p.type), p.name);
    if (!wanted) return;
    for (std::size_t k = 0; k < n; ++k)
      row.list.push_back(number(p.type, items + k * size_of(p.type)));
  }

  std::filesystem::path path_;
  byte_stream stream_;
  std::endian order_;
};

/// A row is a line; blank lines between rows are passed over.
class ply_ascii_data : public ply_data {
 public:
  ply_ascii_data(const input_file& file, std::size_t header_lines)
      : path_(file.path()), text_(read_file(path_)), lines_(text_, path_) {
    for (std::size_t i = 0; i < header_lines; ++i) lines_.next();
  }

  void read_row(const ply_element& element, std::size_t wanted_list, ply_row& row) override {
    row.values.clear();
    row.list.clear();
    do {
      if (!lines_.next()) throw error(message("ply: the file ends within element ", element.name));
      rest_ = trim(lines_.line());
    } while (rest_.empty());
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const ply_property& p = element.properties[i];
      row.values.push_back(take(p));
      if (p.list_count) read_list(p, i == wanted_list, row);
    }
    if (rest_.empty()) return;
    throw error(message("ply: ", element.name, " has ", element.properties.size(),
                        " properties, the line goes on with \"", trim(rest_).substr(0, 40), "\""));
  }

  void skip(const ply_element& element) override {
    if (element.properties.empty()) return;
    ply_row row;
    for (std::uint64_t i = 0; i < element.count; ++i) read_row(element, no_list, row);
  }

  [[nodiscard]] format_error error(std::string_view what) const override {
    return format_error(path_, at_line{lines_.number()}, what);
  }

 private:
  double take(const ply_property& p) {
    if (const auto value = take_number(rest_)) return *value;
    if (rest_.empty()) throw error(message("ply: the line ends where ", p.name, " is expected"));
    throw error(message("ply: a number expected for ", p.name, ", found \"",
                        trim(rest_).substr(0, 40), "\""));
  }

  void read_list(const ply_property& p, bool wanted, ply_row& row) {
    const double count = row.values.back();
    if (!(count >= 0)) throw error(message("ply: list ", p.name, " of ", count, " items"));
    for (double k = 0; k < count; ++k) {
      const double item = take(p);
      if (wanted) row.list.push_back(item);
    }
  }

  std::filesystem::path path_;
  std::string text_;
  line_reader lines_;
  std::string_view rest_;
};

inline std::endian byte_order(ply_format format) {
  return format == ply_format::binary_big_endian ? std::endian::big : std::endian::little;
}

inline std::unique_ptr<ply_data> open_ply_data(const input_file& file, const ply_header& header) {
  if (header.format == ply_format::ascii)
    return std::make_unique<ply_ascii_data>(file, header.lines);
  return std::make_unique<ply_binary_data>(file, header.data_offset, byte_order(header.format));
}

}  // namespace aib::io::detail

// aib/io/ply.hpp

namespace aib::io {

/// What to do with a PLY of 3D Gaussian splats, whose centres are not points of a surface.
enum class splat_rule { refuse, centres };

/// Reads the vertices of a PLY file: ascii and binary of both byte orders, properties in any order,
/// lists anywhere, other elements before or behind. Faces are passed over.
///
/// x y z       required; other types than binary float are kept as double, from a natural origin
/// nx ny nz    normals; all zero (as pi3 writes them) means none
/// red green blue   8 or 16 bits, or float 0..1
/// label       unsigned label of a point
///
/// Non-finite points stay, their number is in the warnings.
/// Throws format_error where the file is damaged or holds Gaussian splats that were not asked for.
/// Source of the format: Turk, "The PLY polygon file format", 1994.
cloud::cloud read_ply_cloud(const std::filesystem::path& path,
                            splat_rule splats = splat_rule::refuse);

/// Reads vertices and faces of a PLY file. Polygons become fans around their first vertex; a
/// polygon of less than three vertices is dropped with a warning.
///
/// vertex_indices or vertex_index   list of the face
/// label       unsigned label of a face; a comment "labels: 0=ground 1=tower" names them
///
/// Throws format_error where the file is damaged, has no faces, or an index has no vertex.
mesh::mesh read_ply_mesh(const std::filesystem::path& path);

namespace detail {

/// A colour channel as a byte: T is the type in the file, float channels are 0..1.
template <class T>
std::uint8_t color_byte(double value) {
  if (std::is_floating_point_v<T>) value *= 255;
  if (std::is_same_v<T, std::uint16_t>) value /= 257;
  return value > 0 ? static_cast<std::uint8_t>(std::min(value, 255.0) + 0.5) : std::uint8_t{0};
}

inline std::uint32_t label_of(double value) {
  return value >= 0 && value < 4294967296.0 ? static_cast<std::uint32_t>(value) : 0;
}

/// The scalar property of a name.
inline std::optional<std::size_t> find_scalar(const ply_element& element, std::string_view name) {
  const auto index = element.find(name);
  return index && !element.properties[*index].list_count ? index : std::nullopt;
}

using ply_triple = std::array<std::size_t, 3>;

inline std::optional<ply_triple> find_scalars(const ply_element& element,
                                              std::array<std::string_view, 3> names) {
  ply_triple columns{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto index = find_scalar(element, names[k]);
    if (!index) return std::nullopt;
    columns[k] = *index;
  }
  return columns;
}

/// The vertex element on its way to a cloud.
class ply_vertices {
 public:
  ply_vertices(const ply_element& element,
               const ply_header& header,
               const std::filesystem::path& path)
      : element_(element),
        order_(byte_order(header.format)),
        normal_(find_scalars(element, {"nx", "ny", "nz"})),
        color_(find_scalars(element, {"red", "green", "blue"})),
        label_(find_scalar(element, "label")) {
    const auto position = find_scalars(element, {"x", "y", "z"});
    if (!position) throw format_error(path, "ply: element vertex has no properties x, y and z");
    position_ = *position;
    is_float_ = header.format != ply_format::ascii &&
                std::all_of(position_.begin(), position_.end(),
                            [&](std::size_t i) { return type(i) == ply_type::float32; });
  }

  cloud::cloud read(ply_data& data) {
    const auto n = static_cast<std::size_t>(element_.count);
    is_float_ ? result_.points.resize(n) : doubles_.resize(n);
    if (normal_) result_.normals.resize(n);
    if (color_) result_.colors.resize(n);
    if (label_) result_.labels.resize(n);
    if (data.stream() && !element_.has_list()) {
      read_columns(*data.stream());
    } else {
      read_rows(data);
    }
    return finish();
  }

 private:
  /// Binary rows of equal length, in one piece.
  struct block {
    const char* bytes;
    std::size_t first;  ///< number of its first row
    std::size_t n;
  };

  ply_type type(std::size_t column) const { return element_.properties[column].type; }

  bool is_packed() const {
    return is_float_ && order_ == std::endian::native && position_ == ply_triple{0, 1, 2} &&
           element_.properties.size() == 3;
  }

  void read_columns(byte_stream& stream) {
    const std::size_t stride = element_.row_bytes();
    if (is_packed()) {
      stream.read(result_.points.data(), result_.points.size() * stride, element_.name);
      return;
    }
    const std::size_t rows = std::max<std::size_t>(1, (std::size_t{1} << 18) / stride);
    for (std::size_t first = 0; first < element_.count; first += rows) {
      const std::size_t n = std::min<std::size_t>(rows, element_.count - first);
      const block rows_here{stream.take(n * stride, element_.name), first, n};
      for (std::size_t k = 0; k < 3; ++k) set_columns(rows_here, k);
      if (label_) set_labels(rows_here);
    }
  }

  /// Calls `set(i, number)` for each row i of a block with its number in a column.
  template <class Set>
  void for_each_number(const block& rows, std::size_t column, Set set) const {
    const char* from = rows.bytes;
    for (std::size_t i = 0; i < column; ++i) from += size_of(type(i));
    const std::size_t stride = element_.row_bytes();
    with_type(type(column), [&]<class T>(std::type_identity<T>) {
      if (order_ == std::endian::native) {
        for (std::size_t i = 0; i < rows.n; ++i)
          set(rows.first + i, load<T>(from + i * stride, std::endian::native));
      } else {
        for (std::size_t i = 0; i < rows.n; ++i)
          set(rows.first + i, load<T>(from + i * stride, order_));
      }
    });
  }

  /// Coordinate k of positions and normals, channel k of colours.
  void set_columns(const block& rows, std::size_t k) {
    const auto axis = static_cast<int>(k);
    if (is_float_) {
      for_each_number(rows, position_[k], [&](std::size_t i, auto value) {
        result_.points[i][axis] = static_cast<float>(value);
      });
    } else {
      for_each_number(rows, position_[k], [&](std::size_t i, auto value) {
        doubles_[i][axis] = static_cast<double>(value);
      });
    }
    if (normal_) {
      for_each_number(rows, (*normal_)[k], [&](std::size_t i, auto value) {
        result_.normals[i][axis] = static_cast<float>(value);
      });
    }
    if (color_) {
      for_each_number(rows, (*color_)[k], [&](std::size_t i, auto value) {
        if constexpr (std::is_same_v<decltype(value), std::uint8_t>) {
          result_.colors[i][k] = value;
        } else {
          result_.colors[i][k] = color_byte<decltype(value)>(static_cast<double>(value));
        }
      });
    }
  }

  void set_labels(const block& rows) {
    for_each_number(rows, *label_, [&](std::size_t i, auto value) {
      result_.labels[i] = label_of(static_cast<double>(value));
    });
  }

  void read_rows(ply_data& data) {
    ply_row row;
    for (std::size_t i = 0; i < element_.count; ++i) {
      data.read_row(element_, no_list, row);
      for (std::size_t k = 0; k < 3; ++k) set_row(row, i, k);
      if (label_) result_.labels[i] = label_of(row.values[*label_]);
    }
  }

  void set_row(const ply_row& row, std::size_t i, std::size_t k) {
    const auto axis = static_cast<int>(k);
    const double coordinate = row.values[position_[k]];
    if (is_float_) {
      result_.points[i][axis] = static_cast<float>(coordinate);
    } else {
      doubles_[i][axis] = coordinate;
    }
    if (normal_) result_.normals[i][axis] = static_cast<float>(row.values[(*normal_)[k]]);
    if (color_) {
      const std::size_t column = (*color_)[k];
      result_.colors[i][k] = with_type(type(column), [&]<class T>(std::type_identity<T>) {
        return color_byte<T>(row.values[column]);
      });
    }
  }

  cloud::cloud finish() {
    if (!is_float_) {
      auto floats = to_floats(doubles_);
      result_.origin = floats.origin;
      result_.points = std::move(floats.points);
    }
    const auto is_zero = [](const Eigen::Vector3f& n) { return n.isZero(0); };
    if (std::all_of(result_.normals.begin(), result_.normals.end(), is_zero))
      result_.normals.clear();
    if (auto warning = non_finite_warning(result_.points, "points"))
      result_.warnings.push_back(std::move(*warning));
    return std::move(result_);
  }

  const ply_element& element_;
  std::endian order_;
  ply_triple position_{};
  std::optional<ply_triple> normal_;
  std::optional<ply_triple> color_;
  std::optional<std::size_t> label_;
  bool is_float_ = false;  ///< the file holds float: nothing to gain from double
  std::vector<Eigen::Vector3d> doubles_;
  cloud::cloud result_;
};

/// The face element on its way to triangles.
class ply_faces {
 public:
  ply_faces(const ply_element& element, std::uint64_t n_vertices, const std::filesystem::path& path)
      : element_(element), n_vertices_(n_vertices), label_(find_scalar(element, "label")) {
    auto list = element.find("vertex_indices");
    if (!list) list = element.find("vertex_index");
    if (!list || !element.properties[*list].list_count)
      throw format_error(path, "ply: element face has no list vertex_indices");
    list_ = *list;
  }

  void read(ply_data& data, mesh::mesh& result) const {
    result.triangles.reserve(static_cast<std::size_t>(element_.count));
    ply_row row;
    std::size_t n_dropped = 0;
    for (std::uint64_t i = 0; i < element_.count; ++i) {
      data.read_row(element_, list_, row);
      check(data, i, row.list);
      n_dropped += row.list.size() < 3 ? 1u : 0u;
      for (std::size_t k = 2; k < row.list.size(); ++k) {
        result.triangles.push_back({index(row, 0), index(row, k - 1), index(row, k)});
        if (label_) result.labels.push_back(label_of(row.values[*label_]));
      }
    }
    if (n_dropped > 0)
      result.warnings.push_back(message(n_dropped, " faces of less than 3 vertices were dropped"));
    if (result.triangles.empty()) result.warnings.push_back("no triangles");
  }

 private:
  static std::uint32_t index(const ply_row& row, std::size_t k) {
    return static_cast<std::uint32_t>(row.list[k]);
  }

  void check(const ply_data& data, std::uint64_t face, const std::vector<double>& list) const {
    for (const double v : list) {
      if (v >= 0 && v < static_cast<double>(n_vertices_) && v == std::floor(v)) continue;
      throw data.error(message("ply: face ", face, ": one of ", n_vertices_,
                               " vertices expected, found index ", v));
    }
  }

  const ply_element& element_;
  std::uint64_t n_vertices_;
  std::size_t list_ = 0;
  std::optional<std::size_t> label_;
};

/// Names of the comment "labels: 0=ground 1=tower".
inline std::vector<std::string> ply_label_names(const ply_header& header) {
  constexpr std::size_t max_labels = 65536;
  std::vector<std::string> names;
  std::vector<std::string_view> fields;
  for (const std::string& comment : header.comments) {
    if (!comment.starts_with("labels:")) continue;
    split(std::string_view(comment).substr(7), fields);
    for (const std::string_view field : fields) {
      const std::size_t equals = field.find('=');
      const auto label = parse<std::size_t>(field.substr(0, equals));
      if (equals == std::string_view::npos || !label || *label >= max_labels) continue;
      if (names.size() <= *label) names.resize(*label + 1);
      names[*label] = field.substr(equals + 1);
    }
  }
  return names;
}

inline const ply_element& ply_vertex_element(const ply_header& header,
                                             const std::filesystem::path& path) {
  if (const ply_element* vertex = header.find("vertex")) return *vertex;
  throw format_error(path, "ply: no element vertex");
}

}  // namespace detail

inline cloud::cloud read_ply_cloud(const std::filesystem::path& path, splat_rule splats) {
  const input_file file(path);
  const ply_header header = read_ply_header(file);
  const ply_element& vertex = detail::ply_vertex_element(header, path);
  const bool is_splats = vertex.find("f_dc_0") && vertex.find("opacity");
  if (is_splats && splats == splat_rule::refuse) {
    throw format_error(path,
                       "ply: 3D Gaussian splats (f_dc_0, opacity), whose centres are not points of "
                       "a surface; ask for splats = \"centres\" to read them all the same");
  }
  const auto data = detail::open_ply_data(file, header);
  cloud::cloud result;
  for (const ply_element& element : header.elements) {
    if (&element == &vertex) {
      result = detail::ply_vertices(vertex, header, path).read(*data);
    } else {
      data->skip(element);
    }
  }
  if (result.empty()) result.warnings.push_back("no points");
  if (is_splats) result.warnings.push_back("centres of 3D Gaussian splats");
  return result;
}

inline mesh::mesh read_ply_mesh(const std::filesystem::path& path) {
  const input_file file(path);
  const ply_header header = read_ply_header(file);
  const ply_element& vertex = detail::ply_vertex_element(header, path);
  const ply_element* face = header.find("face");
  if (!face) throw format_error(path, "ply: a mesh expected, found a cloud (no element face)");
  const detail::ply_faces faces(*face, vertex.count, path);
  mesh::mesh result;
  result.label_names = detail::ply_label_names(header);
  const auto data = detail::open_ply_data(file, header);
  for (const ply_element& element : header.elements) {
    if (&element == &vertex) {
      cloud::cloud vertices = detail::ply_vertices(vertex, header, path).read(*data);
      result.origin = vertices.origin;
      result.vertices = std::move(vertices.points);
      for (std::string& w : vertices.warnings) result.warnings.push_back(std::move(w));
    } else if (&element == face) {
      faces.read(*data, result);
    } else {
      data->skip(element);
    }
  }
  return result;
}

}  // namespace aib::io

// aib/io/ply_write.hpp

namespace aib::io {

/// A number for each point or face, written as a float property of this name.
struct ply_scalar {
  std::string name;
  std::span<const float> values;
};

struct ply_cloud_extras {
  std::vector<ply_scalar> scalars = {};       ///< one value a point
  std::span<const cloud::color> colors = {};  ///< instead of the cloud's own
  std::vector<std::string> comments = {};
};

struct ply_mesh_extras {
  std::span<const cloud::color> vertex_colors = {};
  std::span<const cloud::color> face_colors = {};
  std::vector<ply_scalar> face_scalars = {};  ///< one value a triangle
  std::vector<std::string> comments = {};
};

/// Writes a cloud as binary little-endian PLY: x y z as float, or as double where the cloud has an
/// origin; then what it has of normals, colours, label and the scalars.
///
/// Throws argument_error where a column is not as long as the cloud, io_error where the file cannot
/// be written.
void write_ply(const std::filesystem::path& path,
               const cloud::cloud& cloud,
               const ply_cloud_extras& extras = {});

/// Writes a mesh as binary little-endian PLY; labels become a face property, their names a comment.
void write_ply(const std::filesystem::path& path,
               const mesh::mesh& mesh,
               const ply_mesh_extras& extras = {});

namespace detail {

/// Builds header and rows of a PLY file and hands them on in large pieces.
class ply_writer {
 public:
  explicit ply_writer(const std::filesystem::path& path) : file_(path) {
    buffer_ = "ply\nformat binary_little_endian 1.0\n";
  }

  void comment(std::string_view text) {
    std::string line(text);
    std::replace(line.begin(), line.end(), '\n', ' ');
    buffer_ += message("comment ", line, "\n");
  }
  void element(std::string_view name, std::size_t count) {
    buffer_ += message("element ", name, " ", count, "\n");
  }
  void property(std::string_view type, std::string_view name) {
    buffer_ += message("property ", type, " ", name, "\n");
  }
  void color_properties() {
    for (const char* channel : {"red", "green", "blue"}) property("uchar", channel);
  }
  void end_header() { buffer_ += "end_header\n"; }

  template <class T>
  void number(T value) {
    store(buffer_, value);
  }
  void position(const Eigen::Vector3d& origin, const Eigen::Vector3f& point) {
    if (origin.isZero(0)) {
      for (int k = 0; k < 3; ++k) number(point[k]);
    } else {
      for (int k = 0; k < 3; ++k) number(origin[k] + static_cast<double>(point[k]));
    }
  }
  void color(const cloud::color& c) {
    for (const std::uint8_t channel : c) number(channel);
  }
  void end_row() {
    if (buffer_.size() >= std::size_t{1} << 20) flush();
  }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  void flush() {
    file_.write(buffer_);
    buffer_.clear();
  }

  output_file file_;
  std::string buffer_;
};

inline void position_properties(ply_writer& out, const Eigen::Vector3d& origin) {
  const char* type = origin.isZero(0) ? "float" : "double";
  for (const char* axis : {"x", "y", "z"}) out.property(type, axis);
}

inline void demand_length(std::string_view column, std::size_t found, std::size_t expected) {
  if (found == 0 || found == expected) return;
  throw argument_error(
      message("io::write_ply: ", column, ": ", expected, " values expected, found ", found));
}

inline void check_scalars(const std::vector<ply_scalar>& scalars, std::size_t expected) {
  for (const ply_scalar& s : scalars) {
    if (s.name.empty() || s.name.find_first_of(" \t\r\n") != std::string::npos)
      throw argument_error(message("io::write_ply: \"", s.name, "\" is not a name of a property"));
    if (s.values.size() != expected)
      throw argument_error(message("io::write_ply: ", s.name, ": ", expected,
                                   " values expected, found ", s.values.size()));
  }
}

inline std::string label_comment(const std::vector<std::string>& names) {
  std::string comment = "labels:";
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string name = names[i];
    std::replace(name.begin(), name.end(), ' ', '_');
    if (!name.empty()) comment += message(" ", i, "=", name);
  }
  return comment;
}

}  // namespace detail

inline void write_ply(const std::filesystem::path& path,
                      const cloud::cloud& cloud,
                      const ply_cloud_extras& extras) {
  const auto colors =
      extras.colors.empty() ? std::span<const cloud::color>(cloud.colors) : extras.colors;
  detail::demand_length("normals", cloud.normals.size(), cloud.size());
  detail::demand_length("colors", colors.size(), cloud.size());
  detail::demand_length("labels", cloud.labels.size(), cloud.size());
  detail::check_scalars(extras.scalars, cloud.size());

  detail::ply_writer out(path);
  for (const std::string& c : extras.comments) out.comment(c);
  out.element("vertex", cloud.size());
  detail::position_properties(out, cloud.origin);
  if (!cloud.normals.empty())
    for (const char* axis : {"nx", "ny", "nz"}) out.property("float", axis);
  if (!colors.empty()) out.color_properties();
  if (!cloud.labels.empty()) out.property("uint", "label");
  for (const ply_scalar& s : extras.scalars) out.property("float", s.name);
  out.end_header();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    out.position(cloud.origin, cloud.points[i]);
    if (!cloud.normals.empty())
      for (int k = 0; k < 3; ++k) out.number(cloud.normals[i][k]);
    if (!colors.empty()) out.color(colors[i]);
    if (!cloud.labels.empty()) out.number(cloud.labels[i]);
    for (const ply_scalar& s : extras.scalars) out.number(s.values[i]);
    out.end_row();
  }
  out.commit();
}

inline void write_ply(const std::filesystem::path& path,
                      const mesh::mesh& mesh,
                      const ply_mesh_extras& extras) {
  const std::size_t n_faces = mesh.triangles.size();
  detail::demand_length("vertex_colors", extras.vertex_colors.size(), mesh.vertices.size());
  detail::demand_length("face_colors", extras.face_colors.size(), n_faces);
  detail::demand_length("labels", mesh.labels.size(), n_faces);
  detail::check_scalars(extras.face_scalars, n_faces);

  detail::ply_writer out(path);
  for (const std::string& c : extras.comments) out.comment(c);
  if (!mesh.label_names.empty()) out.comment(detail::label_comment(mesh.label_names));
  out.element("vertex", mesh.vertices.size());
  detail::position_properties(out, mesh.origin);
  if (!extras.vertex_colors.empty()) out.color_properties();
  out.element("face", n_faces);
  out.property("list uchar uint", "vertex_indices");
  if (!mesh.labels.empty()) out.property("uint", "label");
  if (!extras.face_colors.empty()) out.color_properties();
  for (const ply_scalar& s : extras.face_scalars) out.property("float", s.name);
  out.end_header();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    out.position(mesh.origin, mesh.vertices[i]);
    if (!extras.vertex_colors.empty()) out.color(extras.vertex_colors[i]);
    out.end_row();
  }
  for (std::size_t i = 0; i < n_faces; ++i) {
    out.number(std::uint8_t{3});
    for (const std::uint32_t v : mesh.triangles[i]) out.number(v);
    if (!mesh.labels.empty()) out.number(mesh.labels[i]);
    if (!extras.face_colors.empty()) out.color(extras.face_colors[i]);
    for (const ply_scalar& s : extras.face_scalars) out.number(s.values[i]);
    out.end_row();
  }
  out.commit();
}

}  // namespace aib::io

// aib/io/xyz.hpp

namespace aib::io {

/// Reads points from text, one a line: XYZ, CSV, PTS, ASC. Numbers are parted by blanks, commas or
/// semicolons; lines that begin with # or // are comments; a first line of names is understood
/// (x y z, nx ny nz, r g b or red green blue); a first line with one number is the count of PTS.
///
/// Without names the columns behind x y z are: one of intensity (passed over), then three that are
/// colours where all of them are whole numbers 0..255 and normals where they are of length 1, then
/// three of the other kind. What is neither is passed over with a warning.
///
/// Throws format_error where a row has another number of columns than the first, or less than 3.
cloud::cloud read_xyz(const std::filesystem::path& path);

namespace detail {

/// A table of numbers in a text file.
class xyz_table {
 public:
  explicit xyz_table(const std::filesystem::path& path)
      : path_(path), text_(read_file(path)), lines_(text_, path) {
    while (lines_.next()) {
      const std::string_view line = trim(lines_.line());
      if (line.empty()) continue;
      if (line.front() == '#' || line.starts_with("//")) {
        if (columns_ == 0)
          read_names(line.substr(std::min(line.find_first_not_of("#/"), line.size())));
        continue;
      }
      read_row(line);
    }
    if (announced_ && *announced_ != static_cast<double>(rows()))
      lines_.fail(message("xyz: ", *announced_, " points announced, found ", rows()));
  }

  [[nodiscard]] std::size_t rows() const { return columns_ == 0 ? 0 : values_.size() / columns_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] double operator()(std::size_t row, std::size_t column) const {
    return values_[row * columns_ + column];
  }

  /// First of three neighbouring columns with these names.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view a,
                                                std::string_view b,
                                                std::string_view c) const {
    if (names_.size() != columns_) return std::nullopt;
    for (std::size_t i = 0; i + 2 < names_.size(); ++i)
      if (names_[i] == a && names_[i + 1] == b && names_[i + 2] == c) return i;
    return std::nullopt;
  }
  [[nodiscard]] bool has_names() const { return columns_ > 0 && names_.size() == columns_; }

 private:
  static constexpr std::string_view separators = " \t\r\v\f,;";

  void read_names(std::string_view line) {
    names_.clear();
    std::string name;
    for (const char c : std::string(line) + ' ') {
      if (separators.find(c) == std::string_view::npos) {
        if (c != '"') name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
      } else if (!name.empty()) {
        names_.push_back(std::exchange(name, {}));
      }
    }
  }

  void read_row(std::string_view line) {
    std::string_view rest = line;
    const std::size_t before = values_.size();
    while (const auto value = take_number(rest, separators)) values_.push_back(*value);
    const std::size_t n = values_.size() - before;
    rest.remove_prefix(std::min(rest.find_first_not_of(separators), rest.size()));
    const bool is_first = columns_ == 0 && !announced_;
    if (is_first && n == 0) return read_names(line);
    if (is_first && n == 1 && rest.empty()) {
      announced_ = values_.back();
      values_.pop_back();
      return;
    }
    if (!rest.empty())
      lines_.fail(message("xyz: a number expected, found \"", rest.substr(0, 40), "\""));
    if (columns_ == 0) columns_ = n;
    if (n < 3 || n != columns_)
      lines_.fail(
          message("xyz: ", std::max<std::size_t>(columns_, 3), " numbers expected, found ", n));
  }

  std::filesystem::path path_;
  std::string text_;
  line_reader lines_;
  std::vector<double> values_;
  std::vector<std::string> names_;
  std::optional<double> announced_;
  std::size_t columns_ = 0;
};

/// Which columns of a table hold what.
struct xyz_columns {
  std::size_t position = 0;
  std::optional<std::size_t> color, normal;
  bool has_unknown = false;
};

inline bool are_colors(const xyz_table& table, std::size_t first) {
  for (std::size_t i = 0; i < table.rows(); ++i) {
    for (std::size_t k = first; k < first + 3; ++k) {
      const double v = table(i, k);
      if (!(v >= 0 && v <= 255) || v != std::floor(v)) return false;
    }
  }
  return true;
}

inline bool are_normals(const xyz_table& table, std::size_t first) {
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const Eigen::Vector3d v(table(i, first), table(i, first + 1), table(i, first + 2));
    if (!(std::abs(v.norm() - 1) < 0.01 || v.isZero(0))) return false;
  }
  return true;
}

inline xyz_columns find_columns(const xyz_table& table, const std::filesystem::path& path) {
  xyz_columns columns;
  if (table.has_names()) {
    const auto position = table.find("x", "y", "z");
    if (!position) throw format_error(path, "xyz: no columns x, y, z in the first line");
    columns.position = *position;
    columns.normal = table.find("nx", "ny", "nz");
    columns.color = table.find("r", "g", "b");
    if (!columns.color) columns.color = table.find("red", "green", "blue");
    return columns;
  }
  const std::size_t extra = table.columns() - 3;
  std::size_t at = 3 + (extra % 3 == 1 ? 1 : 0);
  for (; at + 3 <= table.columns(); at += 3) {
    if (!columns.color && are_colors(table, at)) {
      columns.color = at;
    } else if (!columns.normal && are_normals(table, at)) {
      columns.normal = at;
    } else {
      columns.has_unknown = true;
    }
  }
  columns.has_unknown = columns.has_unknown || at < table.columns();
  return columns;
}

}  // namespace detail

inline cloud::cloud read_xyz(const std::filesystem::path& path) {
  const detail::xyz_table table(path);
  cloud::cloud result;
  if (table.rows() == 0) {
    result.warnings.push_back("no points");
    return result;
  }
  const auto columns = detail::find_columns(table, path);
  std::vector<Eigen::Vector3d> positions(table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const auto triple = [&](std::size_t first) {
      return Eigen::Vector3d(table(i, first), table(i, first + 1), table(i, first + 2));
    };
    positions[i] = triple(columns.position);
    if (columns.normal) result.normals.push_back(triple(*columns.normal).cast<float>());
    if (columns.color) {
      const Eigen::Vector3d c = triple(*columns.color).cwiseMax(0).cwiseMin(255);
      result.colors.push_back({static_cast<std::uint8_t>(c[0]), static_cast<std::uint8_t>(c[1]),
                               static_cast<std::uint8_t>(c[2])});
    }
  }
  auto floats = to_floats(positions);
  result.origin = floats.origin;
  result.points = std::move(floats.points);
  if (columns.has_unknown)
    result.warnings.push_back("columns that are neither colours nor normals were passed over");
  if (auto warning = non_finite_warning(result.points, "points"))
    result.warnings.push_back(std::move(*warning));
  return result;
}

}  // namespace aib::io

// aib/io/glb.hpp

#if defined(AIB_WITH_JSON)
#include <nlohmann/json.hpp>

namespace aib::io {

/// Reads the triangles of a binary glTF 2.0 file (.glb): lists, strips and fans, each node's
/// transformation applied. A label for each node with a mesh, named as the node. Y is up in glTF.
///
/// Throws format_error where the file is damaged, an index has no vertex, or the file has what is
/// not read: compressed, quantised or sparse meshes, buffers outside of the file.
/// Source: Khronos, glTF 2.0 specification.
mesh::mesh read_glb_mesh(const std::filesystem::path& path);

/// Reads the points of a binary glTF 2.0 file with their colours; of a file without points, the
/// vertices of its meshes.
cloud::cloud read_glb_cloud(const std::filesystem::path& path);

namespace detail {

/// What all primitives of a file together hold, in its world.
struct glb_content {
  std::vector<Eigen::Vector3d> vertices = {};
  std::vector<mesh::triangle> triangles = {};
  std::vector<std::uint32_t> labels = {};
  std::vector<std::string> label_names = {};
  std::vector<Eigen::Vector3d> points = {};
  std::vector<cloud::color> colors = {};
};

class glb_reader {
 public:
  using json = nlohmann::json;

  glb_reader(std::string_view bytes, const std::filesystem::path& path) : path_(path) {
    byte_reader in(bytes, path);
    if (in.take(4, "glb: magic") != "glTF") in.fail("glb: not a binary glTF file");
    const auto version = in.read<std::uint32_t>("glb: version");
    if (version != 2) in.fail(message("glb: version 2 expected, found ", version));
    in.take(4, "glb: length");
    while (in.left() >= 8) {
      const auto n = in.read<std::uint32_t>("glb: length of a chunk");
      const std::string_view type = in.take(4, "glb: type of a chunk");
      const std::string_view chunk = in.take(n, "glb: chunk");
      if (type == "JSON") root_ = json::parse(chunk, nullptr, false);
      if (type == std::string_view("BIN\0", 4) && buffer_.empty()) buffer_ = chunk;
    }
    if (!root_.is_object()) fail("no JSON description, or a damaged one");
    for (const json& extension : list(root_, "extensionsRequired")) {
      if (extension.is_string() && extension.get<std::string>().find("unlit") == std::string::npos)
        fail(message("the extension ", extension.get<std::string>(),
                     " is not supported; export the mesh without compression"));
    }
  }

  glb_content read() {
    const json& nodes = list(root_, "nodes");
    visited_.assign(nodes.size(), false);
    for (const std::size_t node : roots(nodes)) visit(node, Eigen::Affine3d::Identity(), 0);
    return std::move(content_);
  }

 private:
  static constexpr std::size_t points = 0, triangles = 4, strip = 5, fan = 6;  // modes
  static constexpr std::size_t max_vertices = std::size_t{1} << 28;

  static const json& list(const json& object, const char* name) {
    static const json empty = json::array();
    const auto found = object.find(name);
    return found != object.end() && found->is_array() ? *found : empty;
  }

  /// Element `index` of the top-level list `name`.
  const json& element(const char* name, std::size_t index) const {
    const json& all = list(root_, name);
    if (index >= all.size() || !all[index].is_object())
      fail(message("no element ", index, " in ", name));
    return all[index];
  }

  std::optional<std::size_t> number(const json& object, const char* name) const {
    const auto found = object.find(name);
    if (found == object.end()) return std::nullopt;
    return whole(*found, name);
  }

  std::size_t whole(const json& value, std::string_view name) const {
    if (!value.is_number_unsigned()) fail(message(name, ": a whole number expected"));
    return value.get<std::size_t>();
  }

  std::vector<std::size_t> roots(const json& nodes) const {
    std::vector<std::size_t> result;
    if (!list(root_, "scenes").empty()) {
      const json& scene = element("scenes", number(root_, "scene").value_or(0));
      for (const json& node : list(scene, "nodes")) result.push_back(whole(node, "scene"));
      return result;
    }
    std::vector<bool> is_child(nodes.size(), false);
    for (const json& node : nodes) {
      for (const json& child : list(node, "children")) {
        const std::size_t index = whole(child, "children");
        if (index < nodes.size()) is_child[index] = true;
      }
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (!is_child[i]) result.push_back(i);
    return result;
  }

  void visit(std::size_t index, const Eigen::Affine3d& world_from_parent, int depth) {
    const json& node = element("nodes", index);
    if (visited_[index] || depth > 1000) fail("the nodes are not a tree");
    visited_[index] = true;
    const Eigen::Affine3d world_from_node = world_from_parent * transformation(node);
    if (const auto shape = number(node, "mesh"))
      add_mesh(element("meshes", *shape), node, world_from_node);
    for (const json& child : list(node, "children"))
      visit(whole(child, "children"), world_from_node, depth + 1);
  }

  template <std::size_t N>
  std::array<double, N> numbers(const json& node,
                                const char* name,
                                std::array<double, N> values) const {
    const json& found = list(node, name);
    if (found.empty()) return values;
    if (found.size() != N) fail(message(name, ": ", N, " numbers expected"));
    for (std::size_t i = 0; i < N; ++i) {
      if (!found[i].is_number()) fail(message(name, ": numbers expected"));
      values[i] = found[i].get<double>();
    }
    return values;
  }

  Eigen::Affine3d transformation(const json& node) const {
    if (node.contains("matrix")) {
      const auto m = numbers<16>(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
      Eigen::Affine3d result;
      for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
          result.matrix()(row, column) = m[static_cast<std::size_t>(4 * column + row)];
      return result;
    }
    const auto t = numbers<3>(node, "translation", {0, 0, 0});
    const auto q = numbers<4>(node, "rotation", {0, 0, 0, 1});
    const auto s = numbers<3>(node, "scale", {1, 1, 1});
    return Eigen::Translation3d(t[0], t[1], t[2]) *
           Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized() *
           Eigen::Scaling(s[0], s[1], s[2]);
  }

  void add_mesh(const json& shape, const json& node, const Eigen::Affine3d& world_from_mesh) {
    const auto label = static_cast<std::uint32_t>(content_.label_names.size());
    const auto named = [](const json& o) {
      const auto name = o.find("name");
      return name != o.end() && name->is_string() ? name->get<std::string>() : std::string();
    };
    content_.label_names.push_back(named(node).empty() ? named(shape) : named(node));
    for (const json& primitive : list(shape, "primitives")) {
      const auto attributes = primitive.find("attributes");
      if (attributes == primitive.end() || !attributes->is_object())
        fail("a primitive without attributes");
      const auto position = number(*attributes, "POSITION");
      if (!position) continue;
      add_primitive(primitive, *position, number(*attributes, "COLOR_0"), world_from_mesh, label);
    }
  }

  void add_primitive(const json& primitive,
                     std::size_t position,
                     std::optional<std::size_t> color,
                     const Eigen::Affine3d& world_from_mesh,
                     std::uint32_t label) {
    const std::size_t mode = number(primitive, "mode").value_or(triangles);
    const bool is_cloud = mode == points;
    if (!is_cloud && (mode < triangles || mode > fan)) return;  // lines
    std::vector<Eigen::Vector3d>& to = is_cloud ? content_.points : content_.vertices;
    const std::size_t first = to.size();
    const accessor source = open(position, 3, true);
    if (source.n > max_vertices - first) fail("more than 2^28 vertices");
    for (std::size_t i = 0; i < source.n; ++i) {
      Eigen::Vector3d p;
      for (int k = 0; k < 3; ++k) p[k] = source.value(i, static_cast<std::size_t>(k));
      to.push_back(world_from_mesh * p);
    }
    if (is_cloud) {
      add_colors(color, source.n);
    } else {
      add_triangles(indices(primitive, source.n), mode, first, label);
    }
  }

  void add_colors(std::optional<std::size_t> color, std::size_t n) {
    content_.colors.resize(content_.points.size(), {0, 0, 0});
    if (!color) return;
    const accessor source = open(*color, 3, false);
    if (source.n != n) fail(message("COLOR_0: ", n, " colours expected, found ", source.n));
    const double unit = source.type == 5126 ? 255 : source.type == 5123 ? 1 / 257.0 : 1;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        content_.colors[content_.colors.size() - n + i][k] =
            static_cast<std::uint8_t>(std::clamp(source.value(i, k) * unit, 0.0, 255.0) + 0.5);
  }

  std::vector<std::uint32_t> indices(const json& primitive, std::size_t n_vertices) const {
    std::vector<std::uint32_t> result;
    if (const auto index = number(primitive, "indices")) {
      const accessor source = open(*index, 1, false);
      for (std::size_t i = 0; i < source.n; ++i) {
        const double value = source.value(i, 0);
        if (!(value < static_cast<double>(n_vertices)))
          fail(message("one of ", n_vertices, " vertices expected, found index ", value));
        result.push_back(static_cast<std::uint32_t>(value));
      }
    } else {
      for (std::size_t i = 0; i < n_vertices; ++i) result.push_back(static_cast<std::uint32_t>(i));
    }
    return result;
  }

  void add_triangles(const std::vector<std::uint32_t>& corners,
                     std::size_t mode,
                     std::size_t first,
                     std::uint32_t label) {
    const auto vertex = [&](std::size_t i) {
      return static_cast<std::uint32_t>(first + corners[i]);
    };
    const std::size_t step = mode == strip || mode == fan ? 1 : 3;
    for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
      const bool flipped = mode == strip && i % 2 == 1;
      const std::size_t a = mode == fan ? 0 : i;
      content_.triangles.push_back(
          {vertex(a), vertex(flipped ? i + 2 : i + 1), vertex(flipped ? i + 1 : i + 2)});
      content_.labels.push_back(label);
    }
  }

  /// A list of tuples in the binary chunk, checked against its end.
  struct accessor {
    const char* data;
    std::size_t n, stride, type, type_bytes;

    double value(std::size_t i, std::size_t k) const {
      const char* at = data + i * stride + k * type_bytes;
      switch (type) {
        case 5121:
          return load<std::uint8_t>(at);
        case 5123:
          return load<std::uint16_t>(at);
        case 5125:
          return load<std::uint32_t>(at);
        default:
          return static_cast<double>(load<float>(at));
      }
    }
  };

  accessor open(std::size_t index, std::size_t components, bool must_be_float) const {
    const json& a = element("accessors", index);
    const auto view_index = number(a, "bufferView");
    if (a.contains("sparse") || !view_index) fail("sparse or empty accessors are not supported");
    const json& view = element("bufferViews", *view_index);
    if (number(view, "buffer").value_or(0) != 0 ||
        (!list(root_, "buffers").empty() && list(root_, "buffers")[0].contains("uri")))
      fail("a buffer outside of the file is not supported");
    accessor result{};
    result.type = number(a, "componentType").value_or(0);
    result.type_bytes = result.type == 5121 ? 1u : result.type == 5123 ? 2u : 4u;
    const bool known =
        result.type == 5121 || result.type == 5123 || result.type == 5125 || result.type == 5126;
    if (!known || (must_be_float && result.type != 5126))
      fail(message("numbers of type ", result.type, " are not supported"));
    result.n = number(a, "count").value_or(0);
    const std::string kind = a.contains("type") && a["type"].is_string() ? a["type"] : "";
    const std::size_t found = kind == "SCALAR" ? 1u
                              : kind == "VEC3" ? 3u
                              : kind == "VEC4" ? 4u
                                               : 0u;
    if (found < components) fail(message("tuples of ", components, " expected, found ", kind));
    const std::size_t tuple = found * result.type_bytes;
    result.stride = number(view, "byteStride").value_or(tuple);
    const std::size_t begin = number(view, "byteOffset").value_or(0);
    const std::size_t offset = number(a, "byteOffset").value_or(0);
    const bool fits = begin <= buffer_.size() && offset <= buffer_.size() - begin &&
                      result.stride >= tuple &&
                      (result.n == 0 ||
                       (tuple <= buffer_.size() - begin - offset &&
                        result.n - 1 <= (buffer_.size() - begin - offset - tuple) / result.stride));
    if (!fits) fail(message("accessor ", index, " leads beyond the end of the file"));
    result.data = buffer_.data() + begin + offset;
    return result;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, message("glb: ", what));
  }

  std::filesystem::path path_;
  json root_;
  std::string_view buffer_;
  std::vector<bool> visited_;
  glb_content content_;
};

inline glb_content read_glb(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  return glb_reader(bytes, path).read();
}

}  // namespace detail

inline mesh::mesh read_glb_mesh(const std::filesystem::path& path) {
  auto content = detail::read_glb(path);
  auto floats = to_floats(content.vertices);
  mesh::mesh result{.origin = floats.origin,
                    .vertices = std::move(floats.points),
                    .triangles = std::move(content.triangles),
                    .labels = std::move(content.labels),
                    .label_names = std::move(content.label_names)};
  if (result.triangles.empty()) result.warnings.push_back("no triangles");
  if (auto warning = non_finite_warning(result.vertices, "vertices"))
    result.warnings.push_back(std::move(*warning));
  return result;
}

inline cloud::cloud read_glb_cloud(const std::filesystem::path& path) {
  auto content = detail::read_glb(path);
  const bool has_points = !content.points.empty();
  auto floats = to_floats(has_points ? content.points : content.vertices);
  cloud::cloud result{.origin = floats.origin, .points = std::move(floats.points)};
  if (has_points) result.colors = std::move(content.colors);
  if (result.empty()) result.warnings.push_back("no points");
  if (auto warning = non_finite_warning(result.points, "points"))
    result.warnings.push_back(std::move(*warning));
  return result;
}

}  // namespace aib::io
#endif

// aib/io/cloud.hpp

#if defined(AIB_WITH_JSON)
#endif

namespace aib::io {

struct cloud_options {
  up_axis up = up_axis::z;                 ///< axis that points up in the file
  splat_rule splats = splat_rule::refuse;  ///< PLY files of 3D Gaussian splats
  std::string key = {};                    ///< NPZ: name of the array; empty: see read_npz_cloud
};

/// Reads a cloud; the format is told from the content, then from the extension: PLY, PCD, XYZ, CSV,
/// PTS, LAS, NPY, NPZ, GLB. Of a mesh file (PLY, OBJ, GLB) the vertices are read.
///
/// Throws format_error where the format is not known or the file is damaged, io_error where it
/// cannot be read.
cloud::cloud read_cloud(const std::filesystem::path& path, const cloud_options& options = {});

namespace detail {

inline cloud::cloud vertices_of(mesh::mesh mesh) {
  return {.origin = mesh.origin,
          .points = std::move(mesh.vertices),
          .warnings = std::move(mesh.warnings)};
}

inline cloud::cloud read_stored_cloud(const std::filesystem::path& path,
                                      const cloud_options& options) {
  switch (kind_of(path)) {
    case file_kind::ply:
      return read_ply_cloud(path, options.splats);
    case file_kind::pcd:
      return read_pcd(path);
    case file_kind::las:
      return read_las(path);
    case file_kind::text_points:
      return read_xyz(path);
    case file_kind::obj:
      return vertices_of(read_obj(path));
    case file_kind::npy:
      return read_npy_cloud(path);
    case file_kind::npz:
#if defined(AIB_WITH_NPZ)
      return read_npz_cloud(path, options.key);
#else
      throw format_error(path, "this build of aib reads no NPZ; build it with zlib");
#endif
    case file_kind::glb:
#if defined(AIB_WITH_JSON)
      return read_glb_cloud(path);
#else
      throw format_error(path, "this build of aib reads no GLB; build it with nlohmann-json");
#endif
    case file_kind::stl:
      throw format_error(path,
                         "a cloud expected, found an STL mesh; read it as a mesh and sample it");
    case file_kind::e57:
      throw format_error(path,
                         "E57 is not supported; convert it with CloudCompare or "
                         "`pdal translate in.e57 out.ply`");
    default:
      throw format_error(path, "a cloud expected: PLY, PCD, XYZ, CSV, PTS, LAS, NPY, NPZ or GLB");
  }
}

}  // namespace detail

inline cloud::cloud read_cloud(const std::filesystem::path& path, const cloud_options& options) {
  cloud::cloud result = detail::read_stored_cloud(path, options);
  turn_z_up(result, options.up);
  return result;
}

/// Writes a cloud as PLY. Throws argument_error for another extension.
inline void write_cloud(const std::filesystem::path& path,
                        const cloud::cloud& cloud,
                        const ply_cloud_extras& extras = {}) {
  if (extension_of(path) != ".ply") {
    throw argument_error(message("io::write_cloud: the extension .ply expected, found \"",
                                 path.extension().string(), "\""));
  }
  write_ply(path, cloud, extras);
}

}  // namespace aib::io

// aib/math/nearest_rotation.hpp

namespace aib::math {

/// A rotation and how far the matrix that it was made from lay from it.
struct projected_rotation {
  Eigen::Matrix3d rotation;
  double residual;  ///< Frobenius norm of (matrix - rotation)
};

/// The rotation nearest to `matrix` in the Frobenius norm; nothing where the matrix is not finite
/// or where its determinant is not positive.
inline std::optional<projected_rotation> nearest_rotation(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite() || !(matrix.determinant() > 0)) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  return projected_rotation{rotation, (matrix - rotation).norm()};
}

}  // namespace aib::math

// aib/io/pose_frame.hpp

namespace aib::io {

/// Which way a written pose maps points.
enum class pose_convention { world_from_camera, camera_from_world };

/// Axes of a camera. opencv: x right, y down, z forward. opengl: x right, y up, z backward.
enum class camera_axes { opencv, opengl };

/// How a file writes its poses; the defaults are the house's own frame.
struct pose_frame {
  pose_convention convention = pose_convention::world_from_camera;
  camera_axes axes = camera_axes::opencv;
};

/// [A | t], the upper rows of a 4 x 4 pose matrix.
using pose_matrix = Eigen::Matrix<double, 3, 4>;

/// A written rotation further than this from a rotation (Frobenius norm) is refused.
inline constexpr double max_rotation_residual = 1e-2;

/// A pose that says "not registered".
[[nodiscard]] math::rigid3 unregistered_pose();

/// The pose that a matrix written in `frame` stands for, in the house's frame.
///
/// The camera centre is taken from the matrix as written (t, or -A^T t), then A is replaced by the
/// nearest rotation. A matrix that is not finite gives an unregistered pose.
/// Throws argument_error where A is mirrored or further than `max_rotation_residual` from a
/// rotation.
[[nodiscard]] math::rigid3 pose_from_matrix(const pose_matrix& matrix,
                                            const pose_frame& frame = {});

/// The same for a quaternion of any length and a translation.
/// Throws argument_error where the quaternion is zero.
[[nodiscard]] math::rigid3 pose_from_quaternion(const math::quaternion& rotation,
                                                const Eigen::Vector3d& translation,
                                                const pose_frame& frame = {});

/// The pose as it is written in `frame`.
[[nodiscard]] math::rigid3 pose_in_frame(const math::rigid3& world_from_camera,
                                         const pose_frame& frame);

namespace detail {

/// Turns y and z of the camera about: OpenGL's axes become OpenCV's and the reverse.
inline void flip_axes(math::rigid3& world_from_camera) {
  world_from_camera.rotation.rightCols<2>() *= -1;
}

}  // namespace detail

inline math::rigid3 unregistered_pose() {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return {Eigen::Matrix3d::Constant(nan), Eigen::Vector3d::Constant(nan)};
}

inline math::rigid3 pose_from_matrix(const pose_matrix& matrix, const pose_frame& frame) {
  if (!matrix.allFinite()) return unregistered_pose();
  const Eigen::Matrix3d written = matrix.leftCols<3>();
  const auto nearest = math::nearest_rotation(written);
  if (!nearest) {
    throw argument_error(
        message("the rotation part has determinant ", written.determinant(), ", 1 expected"));
  }
  if (nearest->residual > max_rotation_residual) {
    throw argument_error(message("the rotation part lies ", nearest->residual,
                                 " from a rotation, at most ", max_rotation_residual, " expected"));
  }
  math::rigid3 pose{nearest->rotation, matrix.col(3)};
  if (frame.convention == pose_convention::camera_from_world) {
    pose.rotation.transposeInPlace();
    pose.translation = -(written.transpose() * matrix.col(3));
  }
  if (frame.axes == camera_axes::opengl) detail::flip_axes(pose);
  return pose;
}

inline math::rigid3 pose_from_quaternion(const math::quaternion& q,
                                         const Eigen::Vector3d& translation,
                                         const pose_frame& frame) {
  const Eigen::Vector4d parts(q.w, q.x, q.y, q.z);
  if (!parts.allFinite() || !translation.allFinite()) return unregistered_pose();
  if (!(parts.squaredNorm() > 0)) throw argument_error("the quaternion is zero");
  math::rigid3 pose{math::rotation_from(q), translation};
  if (frame.convention == pose_convention::camera_from_world) pose = pose.inverse();
  if (frame.axes == camera_axes::opengl) detail::flip_axes(pose);
  return pose;
}

inline math::rigid3 pose_in_frame(const math::rigid3& world_from_camera, const pose_frame& frame) {
  math::rigid3 pose = world_from_camera;
  if (frame.axes == camera_axes::opengl) detail::flip_axes(pose);
  return frame.convention == pose_convention::camera_from_world ? pose.inverse() : pose;
}

}  // namespace aib::io

// aib/io/colmap_records.hpp

/// What the files of a COLMAP model hold, record by record, as the text and the binary reader find
/// it. `io::read_colmap` makes a model of it.
namespace aib::io::colmap {

/// Kind and number of a sensor: kind 0 is a camera, 1 an IMU.
using sensor = std::pair<std::int32_t, std::uint32_t>;

inline constexpr std::int32_t camera_sensor = 0;
inline constexpr std::int32_t imu_sensor = 1;

struct image {
  std::uint32_t id = 0;
  std::uint32_t camera_id = 0;
  math::rigid3 camera_from_world = {};
  std::string name = {};
};

/// Sensors that move together. The reference sensor is the rig's own frame.
struct rig {
  std::optional<sensor> reference = {};
  std::map<sensor, math::rigid3> sensor_from_rig = {};  ///< those whose pose is known
};

struct frame {
  std::uint32_t rig_id = 0;
  math::rigid3 rig_from_world = {};
  std::vector<std::pair<sensor, std::uint64_t>> data = {};  ///< sensor and image
};

struct points {
  std::vector<Eigen::Vector3d> positions = {};
  std::vector<cloud::color> colors = {};
  std::vector<double> errors_px = {};
  std::vector<std::uint64_t> track_lengths = {};
};

/// The pose of a record: camera_from_world, rig_from_world or sensor_from_rig as it stands in the
/// file. Throws argument_error where a number is not finite or the quaternion is zero.
[[nodiscard]] inline math::rigid3 written_pose(const math::quaternion& q,
                                               const Eigen::Vector3d& translation) {
  math::rigid3 pose = pose_from_quaternion(q, translation);
  if (!pose.is_finite()) throw argument_error("the pose is not finite");
  return pose;
}

/// Adds a camera. Throws argument_error where the id is taken or the parameters are not finite.
inline void add_camera(std::map<std::uint32_t, math::camera>& cameras,
                       std::uint32_t id,
                       math::camera camera) {
  for (const double parameter : camera.parameters) {
    if (!std::isfinite(parameter))
      throw argument_error(message("camera ", id, " has a parameter that is not finite"));
  }
  if (!cameras.emplace(id, std::move(camera)).second)
    throw argument_error(message("camera ", id, " comes twice"));
}

/// Adds a rig. Throws argument_error where the id is taken.
inline void add_rig(std::map<std::uint32_t, rig>& rigs, std::uint32_t id, rig r) {
  if (!rigs.emplace(id, std::move(r)).second)
    throw argument_error(message("rig ", id, " comes twice"));
}

}  // namespace aib::io::colmap

// aib/io/colmap_binary.hpp

/// COLMAP's binary files, little endian, of every version to 4.2.
/// Source: COLMAP, scene/reconstruction_io_binary.cc.
namespace aib::io::colmap::binary {

[[nodiscard]] std::map<std::uint32_t, math::camera> read_cameras(const std::filesystem::path& path);
/// Observations in the images are skipped unread.
[[nodiscard]] std::vector<image> read_images(const std::filesystem::path& path);
[[nodiscard]] std::map<std::uint32_t, rig> read_rigs(const std::filesystem::path& path);
[[nodiscard]] std::vector<frame> read_frames(const std::filesystem::path& path);
/// Tracks are counted, not kept.
[[nodiscard]] points read_points(const std::filesystem::path& path);
[[nodiscard]] std::size_t count_points(const std::filesystem::path& path);

namespace detail {

/// Reads a file of `count, record, record, ...`; refuses bytes after the last record.
template <class Record>
void read_records(const std::filesystem::path& path,
                  std::size_t record_bytes,
                  std::string_view what,
                  Record&& record) {
  const input_file file(path);
  byte_stream in(file);
  const auto count = in.read_count<std::uint64_t>(record_bytes, message("colmap: ", what));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = in.offset();
    try {
      record(in);
    } catch (const argument_error& e) {
      throw format_error(path, at_byte{begin}, message("colmap: ", what, ": ", e.what()));
    }
  }
  if (in.left() > 0)
    in.fail(message("colmap: ", in.left(), " bytes after the last of ", count, " ", what));
}

inline Eigen::Vector3d read_vector(byte_stream& in, std::string_view what) {
  const auto x = in.read_number<double>(what);
  const auto y = in.read_number<double>(what);
  const auto z = in.read_number<double>(what);
  return {x, y, z};
}

inline math::rigid3 read_pose(byte_stream& in) {
  math::quaternion q;
  q.w = in.read_number<double>("colmap: quaternion");
  q.x = in.read_number<double>("colmap: quaternion");
  q.y = in.read_number<double>("colmap: quaternion");
  q.z = in.read_number<double>("colmap: quaternion");
  return written_pose(q, read_vector(in, "colmap: translation"));
}

inline sensor read_sensor(byte_stream& in) {
  const auto kind = in.read_number<std::int32_t>("colmap: kind of sensor");
  return {kind, in.read_number<std::uint32_t>("colmap: sensor id")};
}

}  // namespace detail

inline std::map<std::uint32_t, math::camera> read_cameras(const std::filesystem::path& path) {
  std::map<std::uint32_t, math::camera> cameras;
  detail::read_records(path, 40, "cameras", [&](byte_stream& in) {
    const auto id = in.read_number<std::uint32_t>("colmap: camera id");
    const auto model_id = in.read_number<std::int32_t>("colmap: camera model");
    const auto model = math::find_camera_model(model_id);
    if (!model)
      throw argument_error(message("camera ", id, " has model ", model_id, ", 0 to 17 expected"));
    math::camera camera{*model, 0, 0, {}};
    camera.width = in.read_number<std::uint64_t>("colmap: camera width");
    camera.height = in.read_number<std::uint64_t>("colmap: camera height");
    for (std::size_t i = 0; i < math::info(*model).n_parameters; ++i)
      camera.parameters.push_back(in.read_number<double>("colmap: camera parameters"));
    add_camera(cameras, id, std::move(camera));
  });
  return cameras;
}

inline std::vector<image> read_images(const std::filesystem::path& path) {
  constexpr std::size_t observation_bytes = 24;
  std::vector<image> images;
  detail::read_records(path, 73, "images", [&](byte_stream& in) {
    image i;
    i.id = in.read_number<std::uint32_t>("colmap: image id");
    i.camera_from_world = detail::read_pose(in);
    i.camera_id = in.read_number<std::uint32_t>("colmap: camera id");
    i.name = in.take_name("colmap: image name");
    const auto n = in.read_count<std::uint64_t>(observation_bytes, "colmap: observations");
    in.skip(n * observation_bytes, "colmap: observations");
    images.push_back(std::move(i));
  });
  return images;
}

inline std::map<std::uint32_t, rig> read_rigs(const std::filesystem::path& path) {
  std::map<std::uint32_t, rig> rigs;
  detail::read_records(path, 8, "rigs", [&](byte_stream& in) {
    rig r;
    const auto id = in.read_number<std::uint32_t>("colmap: rig id");
    const auto n_sensors = in.read_count<std::uint32_t>(8, "colmap: sensors of a rig");
    if (n_sensors > 0) r.reference = detail::read_sensor(in);
    for (std::size_t i = 1; i < n_sensors; ++i) {
      const sensor s = detail::read_sensor(in);
      if (in.read_number<std::uint8_t>("colmap: whether a sensor has a pose") != 0)
        r.sensor_from_rig[s] = detail::read_pose(in);
    }
    add_rig(rigs, id, std::move(r));
  });
  return rigs;
}

inline std::vector<frame> read_frames(const std::filesystem::path& path) {
  std::vector<frame> frames;
  detail::read_records(path, 68, "frames", [&](byte_stream& in) {
    frame f;
    in.read_number<std::uint32_t>("colmap: frame id");
    f.rig_id = in.read_number<std::uint32_t>("colmap: rig id");
    f.rig_from_world = detail::read_pose(in);
    const auto n = in.read_count<std::uint32_t>(16, "colmap: images of a frame");
    for (std::size_t i = 0; i < n; ++i) {
      const sensor s = detail::read_sensor(in);
      f.data.emplace_back(s, in.read_number<std::uint64_t>("colmap: image id"));
    }
    frames.push_back(std::move(f));
  });
  return frames;
}

inline points read_points(const std::filesystem::path& path) {
  constexpr std::size_t track_bytes = 8;
  points p;
  detail::read_records(path, 51, "points", [&](byte_stream& in) {
    in.read_number<std::uint64_t>("colmap: point id");
    p.positions.push_back(detail::read_vector(in, "colmap: point"));
    cloud::color color;
    for (std::uint8_t& channel : color) channel = in.read_number<std::uint8_t>("colmap: color");
    p.colors.push_back(color);
    p.errors_px.push_back(in.read_number<double>("colmap: point error"));
    const auto n = in.read_count<std::uint64_t>(track_bytes, "colmap: track");
    in.skip(n * track_bytes, "colmap: track");
    p.track_lengths.push_back(n);
  });
  return p;
}

inline std::size_t count_points(const std::filesystem::path& path) {
  const input_file file(path);
  return byte_stream(file).read_count<std::uint64_t>(51, "colmap: points");
}

}  // namespace aib::io::colmap::binary

// aib/io/colmap_text.hpp

/// COLMAP's text files of every version to 4.2.
/// Source: COLMAP, scene/reconstruction_io_text.cc.
namespace aib::io::colmap::text {

[[nodiscard]] std::map<std::uint32_t, math::camera> read_cameras(const std::filesystem::path& path);
/// An image takes two lines, of which the second (its observations, skipped) may be empty. A name
/// may hold blanks.
[[nodiscard]] std::vector<image> read_images(const std::filesystem::path& path);
[[nodiscard]] std::map<std::uint32_t, rig> read_rigs(const std::filesystem::path& path);
[[nodiscard]] std::vector<frame> read_frames(const std::filesystem::path& path);
/// Tracks are counted, not kept.
[[nodiscard]] points read_points(const std::filesystem::path& path);
[[nodiscard]] std::size_t count_points(const std::filesystem::path& path);

namespace detail {

/// Takes the fields of a line one after another. Throws argument_error where one is missing or is
/// not what is expected.
class field_reader {
 public:
  explicit field_reader(std::string_view line) : rest_(trim(line)) {}

  [[nodiscard]] bool done() const { return rest_.empty(); }
  [[nodiscard]] std::string_view rest() const { return rest_; }

  std::string_view next(std::string_view what) {
    if (rest_.empty()) throw argument_error(message(what, " expected, found the end of the line"));
    const std::size_t end = std::min(rest_.find_first_of(" \t"), rest_.size());
    const std::string_view field = rest_.substr(0, end);
    rest_.remove_prefix(end);
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size()));
    return field;
  }

  template <class Number>
  Number number(std::string_view what) {
    const std::string_view field = next(what);
    if (const auto value = parse<Number>(field)) return *value;
    throw argument_error(message(what, " expected, found '", field, "'"));
  }

 private:
  std::string_view rest_;
};

/// Calls `record(fields, lines)` for each line that is neither blank nor a comment and puts the
/// line before what is refused.
template <class Record>
void read_records(const std::filesystem::path& path, Record&& record) {
  const std::string content = read_file(path);
  line_reader lines(content, path);
  while (lines.next_content()) {
    field_reader fields(lines.line());
    try {
      record(fields, lines);
    } catch (const argument_error& e) {
      lines.fail(message("colmap: ", e.what()));
    }
  }
}

inline Eigen::Vector3d read_vector(field_reader& in, std::string_view what) {
  const auto x = in.number<double>(what);
  const auto y = in.number<double>(what);
  const auto z = in.number<double>(what);
  return {x, y, z};
}

inline math::rigid3 read_pose(field_reader& in) {
  math::quaternion q;
  q.w = in.number<double>("quaternion");
  q.x = in.number<double>("quaternion");
  q.y = in.number<double>("quaternion");
  q.z = in.number<double>("quaternion");
  return written_pose(q, read_vector(in, "translation"));
}

inline sensor read_sensor(field_reader& in) {
  const std::string_view kind = in.next("kind of sensor");
  const auto id = in.number<std::uint32_t>("sensor id");
  if (kind == "CAMERA") return {camera_sensor, id};
  if (kind == "IMU") return {imu_sensor, id};
  throw argument_error(message("kind of sensor CAMERA or IMU expected, found '", kind, "'"));
}

/// Whether a line can be the observations of an image: X, Y, POINT3D_ID and so on. Long lines are
/// believed: only a short one can be the next image, its blank line lost.
inline bool is_observations(std::string_view line) {
  constexpr std::size_t longest_image_line = 4096;
  if (line.size() > longest_image_line) return true;
  std::size_t n = 0;
  for (field_reader fields(line); !fields.done(); ++n) {
    if (!parse<double>(fields.next("observation"))) return false;
  }
  return n % 3 == 0;
}

inline void expect_end(const field_reader& fields) {
  if (!fields.done())
    throw argument_error(message("the end of the line expected, found '", fields.rest(), "'"));
}

}  // namespace detail

inline std::map<std::uint32_t, math::camera> read_cameras(const std::filesystem::path& path) {
  std::map<std::uint32_t, math::camera> cameras;
  detail::read_records(path, [&](detail::field_reader& in, line_reader&) {
    const auto id = in.number<std::uint32_t>("camera id");
    const std::string_view name = in.next("camera model");
    const auto model = math::find_camera_model(name);
    if (!model) throw argument_error(message("camera model '", name, "' is not known"));
    math::camera camera{*model, 0, 0, {}};
    camera.width = in.number<std::uint64_t>("camera width");
    camera.height = in.number<std::uint64_t>("camera height");
    while (!in.done()) camera.parameters.push_back(in.number<double>("camera parameter"));
    if (camera.parameters.size() != math::info(*model).n_parameters) {
      throw argument_error(message(math::info(*model).n_parameters, " parameters of ", name,
                                   " expected, found ", camera.parameters.size()));
    }
    add_camera(cameras, id, std::move(camera));
  });
  return cameras;
}

inline std::vector<image> read_images(const std::filesystem::path& path) {
  std::vector<image> images;
  detail::read_records(path, [&](detail::field_reader& in, line_reader& lines) {
    image i;
    i.id = in.number<std::uint32_t>("image id");
    i.camera_from_world = detail::read_pose(in);
    i.camera_id = in.number<std::uint32_t>("camera id");
    i.name = in.rest();
    if (i.name.empty()) throw argument_error("image name expected, found the end of the line");
    images.push_back(std::move(i));
    if (lines.next() && !detail::is_observations(lines.line())) {
      throw argument_error(
          "observations (x, y, point id) or an empty line expected after an image's line");
    }
  });
  return images;
}

inline std::map<std::uint32_t, rig> read_rigs(const std::filesystem::path& path) {
  std::map<std::uint32_t, rig> rigs;
  detail::read_records(path, [&](detail::field_reader& in, line_reader&) {
    rig r;
    const auto id = in.number<std::uint32_t>("rig id");
    const auto n_sensors = in.number<std::uint32_t>("number of sensors");
    if (n_sensors > 0) r.reference = detail::read_sensor(in);
    for (std::uint32_t i = 1; i < n_sensors; ++i) {
      const sensor s = detail::read_sensor(in);
      if (in.number<int>("whether the sensor has a pose") != 0)
        r.sensor_from_rig[s] = detail::read_pose(in);
    }
    detail::expect_end(in);
    add_rig(rigs, id, std::move(r));
  });
  return rigs;
}

inline std::vector<frame> read_frames(const std::filesystem::path& path) {
  std::vector<frame> frames;
  detail::read_records(path, [&](detail::field_reader& in, line_reader&) {
    frame f;
    static_cast<void>(in.number<std::uint32_t>("frame id"));
    f.rig_id = in.number<std::uint32_t>("rig id");
    f.rig_from_world = detail::read_pose(in);
    const auto n = in.number<std::uint32_t>("number of images");
    for (std::uint32_t i = 0; i < n; ++i) {
      const sensor s = detail::read_sensor(in);
      f.data.emplace_back(s, in.number<std::uint64_t>("image id"));
    }
    detail::expect_end(in);
    frames.push_back(std::move(f));
  });
  return frames;
}

inline points read_points(const std::filesystem::path& path) {
  points p;
  detail::read_records(path, [&](detail::field_reader& in, line_reader&) {
    static_cast<void>(in.number<std::uint64_t>("point id"));
    p.positions.push_back(detail::read_vector(in, "point"));
    cloud::color color;
    for (std::uint8_t& channel : color) channel = in.number<std::uint8_t>("color");
    p.colors.push_back(color);
    p.errors_px.push_back(in.number<double>("point error"));
    std::uint64_t fields = 0;
    for (; !in.done(); ++fields) in.next("track");
    if (fields % 2 != 0)
      throw argument_error(message("track: pairs of numbers expected, found ", fields));
    p.track_lengths.push_back(fields / 2);
  });
  return p;
}

inline std::size_t count_points(const std::filesystem::path& path) {
  std::size_t n = 0;
  detail::read_records(path, [&](detail::field_reader&, line_reader&) { ++n; });
  return n;
}

}  // namespace aib::io::colmap::text

// aib/io/trajectory_check.hpp

namespace aib::io {

/// The last step of every reader of poses: refuses a file without a pose and adds a warning for
/// each thing to doubt: poses that are not finite, repeated names, stamps that repeat or go back.
[[nodiscard]] inline pose::trajectory checked_trajectory(pose::trajectory t,
                                                         const std::filesystem::path& path,
                                                         std::string_view format) {
  if (t.empty()) throw format_error(path, message(format, ": no pose in the file"));
  const auto warn = [&](std::size_t n, std::string_view what) {
    if (n > 0) t.warnings.push_back(message(n, " of ", t.size(), " poses ", what));
  };
  const auto repeats = [](auto values) {
    std::sort(values.begin(), values.end());
    return static_cast<std::size_t>(values.end() - std::unique(values.begin(), values.end()));
  };
  std::size_t unregistered = 0;
  for (const math::rigid3& pose : t.world_from_camera) unregistered += pose.is_finite() ? 0 : 1;
  warn(unregistered, "are not finite: not registered");
  warn(repeats(t.names), "repeat a name");
  warn(repeats(t.stamps_s), "repeat a stamp");
  std::size_t backward = 0;
  for (std::size_t i = 1; i < t.stamps_s.size(); ++i)
    backward += t.stamps_s[i] < t.stamps_s[i - 1] ? 1 : 0;
  warn(backward, "have an earlier stamp than the pose before");
  return t;
}

}  // namespace aib::io

// aib/io/colmap.hpp

namespace aib::io {

/// A sparse model of COLMAP or GLOMAP.
struct colmap_model {
  std::filesystem::path path = {};             ///< folder that it was read from
  pose::trajectory trajectory = {};            ///< the registered images, sorted by name
  std::vector<std::uint32_t> image_ids = {};   ///< one a pose
  std::vector<std::uint32_t> camera_ids = {};  ///< one a pose, keys of `cameras`
  std::map<std::uint32_t, math::camera> cameras = {};
  cloud::cloud points = {};                       ///< with colors
  std::vector<double> point_errors_px = {};       ///< one a point, < 0: not known
  std::vector<std::uint64_t> track_lengths = {};  ///< one a point
  std::size_t n_points = 0;                       ///< in the file, also where none were read

  /// The camera of pose `i`.
  [[nodiscard]] const math::camera& camera(std::size_t i) const {
    return cameras.at(camera_ids.at(i));
  }
};

/// How a model's files are written.
enum class colmap_encoding { binary, text };

/// What of a model is read.
enum class colmap_content {
  everything,
  cameras_and_images,  ///< points are counted only
};

/// The folders of the models at `path`: the folder itself, else its numbered sub-folders in the
/// order of their numbers, else those of its folder `sparse`. Empty where there is none.
[[nodiscard]] std::vector<std::filesystem::path> find_colmap_models(
    const std::filesystem::path& path);

/// Reads the models at `path`, see find_colmap_models: cameras, images and points3D, binary where a
/// folder has both kinds (as COLMAP does), of every version to 4.2. Where rigs and frames are
/// there, their poses win over those in images, as in COLMAP. Quaternions are normalised. Without
/// points3D the points are empty, and a warning says so.
///
/// Throws io_error where there is no model, format_error where a file is cut off, has bytes after
/// its last record, an unknown camera model, an image without its camera or a pose that is not
/// finite.
[[nodiscard]] std::vector<colmap_model> read_colmap_models(
    const std::filesystem::path& path, colmap_content content = colmap_content::everything);

/// The largest of the models at `path`: most images, then most points, then the lowest number. A
/// warning of its trajectory names the others.
[[nodiscard]] colmap_model read_colmap(const std::filesystem::path& path,
                                       colmap_content content = colmap_content::everything);

/// Image name -> camera.
[[nodiscard]] std::map<std::string, math::camera> cameras_by_name(const colmap_model& model);

namespace colmap::detail {

namespace fs = std::filesystem;

inline bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

inline std::optional<colmap_encoding> find_encoding(const fs::path& folder) {
  if (is_there(folder / "cameras.bin") && is_there(folder / "images.bin"))
    return colmap_encoding::binary;
  if (is_there(folder / "cameras.txt") && is_there(folder / "images.txt"))
    return colmap_encoding::text;
  return std::nullopt;
}

/// Sub-folders with a number for a name that are models, in the order of the numbers.
inline std::vector<fs::path> numbered_models(const fs::path& folder) {
  std::vector<std::pair<std::uint64_t, fs::path>> found;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const auto number = parse<std::uint64_t>(entry.path().filename().string());
    if (number && find_encoding(entry.path())) found.emplace_back(*number, entry.path());
  }
  std::sort(found.begin(), found.end());
  std::vector<fs::path> folders;
  for (auto& [number, path] : found) folders.push_back(std::move(path));
  return folders;
}

/// The three or five files of a model, whichever way they are written.
class model_files {
 public:
  model_files(fs::path folder, colmap_encoding kind) : folder_(std::move(folder)), kind_(kind) {}

  [[nodiscard]] fs::path file(const char* stem) const {
    return folder_ / (std::string(stem) + (kind_ == colmap_encoding::binary ? ".bin" : ".txt"));
  }
  [[nodiscard]] auto cameras() const {
    return read("cameras", binary::read_cameras, text::read_cameras);
  }
  [[nodiscard]] auto images() const {
    return read("images", binary::read_images, text::read_images);
  }
  [[nodiscard]] auto rigs() const { return read("rigs", binary::read_rigs, text::read_rigs); }
  [[nodiscard]] auto frames() const {
    return read("frames", binary::read_frames, text::read_frames);
  }
  [[nodiscard]] auto points() const {
    return read("points3D", binary::read_points, text::read_points);
  }
  [[nodiscard]] auto point_count() const {
    return read("points3D", binary::count_points, text::count_points);
  }

 private:
  template <class Records>
  Records read(const char* stem,
               Records (*read_binary)(const fs::path&),
               Records (*read_text)(const fs::path&)) const {
    return kind_ == colmap_encoding::binary ? read_binary(file(stem)) : read_text(file(stem));
  }

  fs::path folder_;
  colmap_encoding kind_;
};

/// camera_from_world of each image that the rigs and frames pose.
inline std::map<std::uint64_t, math::rigid3> poses_of_frames(
    const std::map<std::uint32_t, rig>& rigs, const std::vector<frame>& frames) {
  std::map<std::uint64_t, math::rigid3> poses;
  for (const frame& f : frames) {
    const auto r = rigs.find(f.rig_id);
    if (r == rigs.end()) continue;
    for (const auto& [s, image_id] : f.data) {
      if (s.first != camera_sensor) continue;
      if (r->second.reference == s) {
        poses[image_id] = f.rig_from_world;
      } else if (const auto known = r->second.sensor_from_rig.find(s);
                 known != r->second.sensor_from_rig.end()) {
        poses[image_id] = known->second * f.rig_from_world;
      }
    }
  }
  return poses;
}

inline bool differ(const math::rigid3& a, const math::rigid3& b) {
  constexpr double rounding = 1e-6;
  return (a.rotation - b.rotation).norm() > rounding ||
         (a.translation - b.translation).norm() > rounding * (1 + b.translation.norm());
}

/// Lets the rigs' poses win. Returns how many images they moved.
inline std::size_t apply_frames(std::vector<image>& images, const model_files& files) {
  if (!is_there(files.file("rigs")) || !is_there(files.file("frames"))) return 0;
  const auto poses = poses_of_frames(files.rigs(), files.frames());
  std::size_t moved = 0;
  for (image& i : images) {
    const auto pose = poses.find(i.id);
    if (pose == poses.end()) continue;
    moved += differ(pose->second, i.camera_from_world) ? 1 : 0;
    i.camera_from_world = pose->second;
  }
  return moved;
}

inline void check_images(const std::vector<image>& images,
                         const std::map<std::uint32_t, math::camera>& cameras,
                         const fs::path& path) {
  std::vector<std::uint32_t> ids;
  for (const image& i : images) {
    ids.push_back(i.id);
    if (!cameras.contains(i.camera_id)) {
      throw format_error(path, message("colmap: image '", i.name, "' has camera ", i.camera_id,
                                       ", which is not among the ", cameras.size(), " cameras"));
    }
  }
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice != ids.end())
    throw format_error(path, message("colmap: image ", *twice, " comes twice"));
}

inline void read_points(colmap_model& model, const model_files& files, colmap_content content) {
  if (!is_there(files.file("points3D"))) {
    model.points.warnings.push_back("the model has no points3D file: no points");
    return;
  }
  if (content == colmap_content::cameras_and_images) {
    model.n_points = files.point_count();
    return;
  }
  points p = files.points();
  model.n_points = p.positions.size();
  float_positions floats = to_floats(p.positions);
  model.points.origin = floats.origin;
  model.points.points = std::move(floats.points);
  model.points.colors = std::move(p.colors);
  if (auto warning = non_finite_warning(model.points.points, "points"))
    model.points.warnings.push_back(std::move(*warning));
  model.point_errors_px = std::move(p.errors_px);
  model.track_lengths = std::move(p.track_lengths);
}

inline colmap_model read_model(const fs::path& folder,
                               colmap_encoding kind,
                               colmap_content content) {
  const model_files files(folder, kind);
  colmap_model model;
  model.path = folder;
  model.cameras = files.cameras();
  std::vector<image> images = files.images();
  check_images(images, model.cameras, files.file("images"));
  const std::size_t moved = apply_frames(images, files);
  std::sort(images.begin(), images.end(), [](const image& a, const image& b) {
    return std::tie(a.name, a.id) < std::tie(b.name, b.id);
  });
  for (image& i : images) {
    model.trajectory.world_from_camera.push_back(i.camera_from_world.inverse());
    model.trajectory.names.push_back(std::move(i.name));
    model.image_ids.push_back(i.id);
    model.camera_ids.push_back(i.camera_id);
  }
  if (moved > 0) {
    model.trajectory.warnings.push_back(message(
        moved, " of ", images.size(), " images have another pose in rigs and frames, which wins"));
  }
  model.trajectory =
      checked_trajectory(std::move(model.trajectory), files.file("images"), "colmap");
  read_points(model, files, content);
  return model;
}

}  // namespace colmap::detail

inline std::vector<std::filesystem::path> find_colmap_models(const std::filesystem::path& path) {
  if (colmap::detail::find_encoding(path)) return {path};
  auto models = colmap::detail::numbered_models(path);
  if (!models.empty()) return models;
  const std::filesystem::path sparse = path / "sparse";
  if (colmap::detail::find_encoding(sparse)) return {sparse};
  return colmap::detail::numbered_models(sparse);
}

inline std::vector<colmap_model> read_colmap_models(const std::filesystem::path& path,
                                                    colmap_content content) {
  std::vector<colmap_model> models;
  for (const std::filesystem::path& folder : find_colmap_models(path)) {
    const auto kind = colmap::detail::find_encoding(folder);
    models.push_back(colmap::detail::read_model(folder, *kind, content));
  }
  if (models.empty()) {
    throw io_error(path,
                   colmap::detail::is_there(path)
                       ? "colmap: cameras and images (.bin or .txt) expected here, in numbered "
                         "folders or in sparse, found none"
                       : "no such folder");
  }
  return models;
}

inline colmap_model read_colmap(const std::filesystem::path& path, colmap_content content) {
  std::vector<colmap_model> models = read_colmap_models(path, content);
  const auto size = [](const colmap_model& m) {
    return std::pair(m.trajectory.size(), m.n_points);
  };
  const auto largest =
      std::max_element(models.begin(), models.end(),
                       [&](const auto& a, const auto& b) { return size(a) < size(b); });
  colmap_model model = std::move(*largest);
  if (models.size() == 1) return model;
  std::string others;
  for (auto m = models.begin(); m != models.end(); ++m) {
    if (m == largest) continue;
    others += message(others.empty() ? "" : ", ", m->path.filename().string(), " (",
                      m->trajectory.size(), " images)");
  }
  model.trajectory.warnings.push_back(message("model ", model.path.filename().string(), " of ",
                                              models.size(), " is read (", model.trajectory.size(),
                                              " images), not ", others));
  return model;
}

inline std::map<std::string, math::camera> cameras_by_name(const colmap_model& model) {
  std::map<std::string, math::camera> cameras;
  for (std::size_t i = 0; i < model.trajectory.size(); ++i)
    cameras[model.trajectory.names[i]] = model.camera(i);
  return cameras;
}

}  // namespace aib::io

// aib/io/float_pixels.hpp

namespace aib::io {

/// Reads width x height floats that lie in a file row by row, without compression.
/// Throws format_error where the image is empty or the file does not hold it.
[[nodiscard]] inline raster::image<float> read_float_pixels(const input_file& file,
                                                            std::uint64_t offset,
                                                            std::size_t width,
                                                            std::size_t height,
                                                            std::endian order) {
  const std::uint64_t available = offset < file.size() ? (file.size() - offset) / sizeof(float) : 0;
  if (width == 0 || height == 0 || width > available / height) {
    throw format_error(file.path(),
                       message(width, "x", height, " floats expected, the file has ", available));
  }
  raster::image<float> image(width, height);
  file.read_at(offset, image.data(), image.size() * sizeof(float));
  if (order != std::endian::native)
    for (float& value : image) value = load<float>(&value, order);
  return image;
}

}  // namespace aib::io

// aib/io/colmap_depth.hpp

namespace aib::io {

/// Reads a dense map of COLMAP, stereo/depth_maps/NAME.{geometric,photometric}.bin: the text
/// `W&H&C&`, then floats, little endian, row by row from the top. Planar depth, 0 or negative where
/// there is none.
///
/// Throws format_error where the file is damaged or has not one channel (normal maps have three).
/// Source: COLMAP, mvs/mat.h.
inline depth::depth_map read_colmap_depth(const std::filesystem::path& path) {
  const input_file file(path);
  std::string begin(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 64)), '\0');
  file.read_at(0, begin.data(), begin.size());
  std::array<std::size_t, 3> size{};
  std::size_t at = 0;
  for (std::size_t& n : size) {
    const std::size_t end = begin.find('&', at);
    const auto number = parse<std::size_t>(std::string_view(begin).substr(at, end - at));
    if (end == std::string::npos || !number)
      throw format_error(path, "colmap map: \"WIDTH&HEIGHT&CHANNELS&\" expected at the begin");
    n = *number;
    at = end + 1;
  }
  if (size[2] != 1)
    throw format_error(path, message("colmap map: 1 channel expected, found ", size[2]));
  return {read_float_pixels(file, at, size[0], size[1], std::endian::little)};
}

}  // namespace aib::io

// aib/io/posed_images.hpp

namespace aib::io {

/// Size of images in pixels, for files that do not say it; 0: not known.
struct image_extent {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
};

/// Poses with the intrinsics of each, from a file that has both.
struct posed_images {
  pose::trajectory trajectory = {};
  std::vector<math::camera> cameras = {};  ///< one a pose, or none where the file has none
};

}  // namespace aib::io

// aib/io/colmap_write.hpp

namespace aib::io {

/// Writes cameras, images and points3D into a folder, which is made where it is not there. Images
/// have no observations and points no tracks; poses that are not registered are left out.
///
/// Throws argument_error where names, image or camera ids do not fit the poses, an image has no
/// name or one with a line end, or no pose is registered.
void write_colmap(const std::filesystem::path& folder,
                  const colmap_model& model,
                  colmap_encoding encoding = colmap_encoding::binary);

/// A model of the images, numbered from 1; equal intrinsics become one camera.
/// Throws argument_error where the images have no names or no cameras.
[[nodiscard]] colmap_model make_colmap_model(const posed_images& images);

namespace colmap::detail {

inline bool same_camera(const math::camera& a, const math::camera& b) {
  return a.model == b.model && a.width == b.width && a.height == b.height &&
         a.parameters == b.parameters;
}

inline void check_writable(const colmap_model& m) {
  const pose::trajectory& t = m.trajectory;
  if (t.names.size() != t.size() || m.image_ids.size() != t.size() ||
      m.camera_ids.size() != t.size()) {
    throw argument_error(message("write_colmap: ", t.size(), " poses, ", t.names.size(), " names, ",
                                 m.image_ids.size(), " image ids, ", m.camera_ids.size(),
                                 " camera ids: one of each a pose expected"));
  }
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (t.names[i].empty() ||
        t.names[i].find_first_of(std::string_view("\n\r\0", 3)) != std::string::npos)
      throw argument_error(message("write_colmap: pose ", i, " has a name that cannot be written"));
    if (!m.cameras.contains(m.camera_ids[i]))
      throw argument_error(message("write_colmap: no camera ", m.camera_ids[i]));
  }
}

/// Puts numbers and names one after another, as text lines or as bytes.
class record_writer {
 public:
  explicit record_writer(colmap_encoding encoding) : encoding_(encoding) {}

  void begin(std::uint64_t n_records, std::string_view comment) {
    if (is_text()) {
      out_ += message("# ", comment, '\n');
    } else {
      store(out_, n_records);
    }
  }
  template <class Number>
  void put(Number number) {
    if (is_text()) {
      out_ += message(number, ' ');
    } else {
      store(out_, number);
    }
  }
  void put_model(math::camera_model model) {
    if (is_text()) {
      out_ += message(math::info(model).name, ' ');
    } else {
      store(out_, static_cast<std::int32_t>(model));
    }
  }
  void put_name(const std::string& name) {
    out_ += name;
    if (!is_text()) out_ += '\0';
  }
  /// An empty list: in text, the line's end says so.
  void put_empty_list() {
    if (!is_text()) store(out_, std::uint64_t{0});
  }
  void end_line() {
    if (is_text()) out_ += '\n';
  }
  void save(const fs::path& folder, const char* stem) const {
    write_file(folder / (std::string(stem) + (is_text() ? ".txt" : ".bin")), out_);
  }

 private:
  [[nodiscard]] bool is_text() const { return encoding_ == colmap_encoding::text; }

  colmap_encoding encoding_;
  std::string out_;
};

inline void write_cameras(const fs::path& folder, const colmap_model& m, colmap_encoding encoding) {
  record_writer out(encoding);
  out.begin(m.cameras.size(), "CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]");
  for (const auto& [id, camera] : m.cameras) {
    if (camera.parameters.size() != math::info(camera.model).n_parameters) {
      throw argument_error(message("write_colmap: camera ", id, ": ",
                                   math::info(camera.model).n_parameters,
                                   " parameters expected, found ", camera.parameters.size()));
    }
    out.put(id);
    out.put_model(camera.model);
    out.put(camera.width);
    out.put(camera.height);
    for (const double parameter : camera.parameters) out.put(parameter);
    out.end_line();
  }
  out.save(folder, "cameras");
}

inline void write_images(const fs::path& folder, const colmap_model& m, colmap_encoding encoding) {
  const auto& poses = m.trajectory.world_from_camera;
  const auto registered = std::count_if(poses.begin(), poses.end(),
                                        [](const math::rigid3& p) { return p.is_finite(); });
  if (registered == 0) throw argument_error("write_colmap: no registered pose to write");
  record_writer out(encoding);
  out.begin(static_cast<std::uint64_t>(registered),
            "IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME; then POINTS2D[]");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i].is_finite()) continue;
    const math::rigid3 camera_from_world = poses[i].inverse();
    const math::quaternion q = math::quaternion_from(camera_from_world.rotation);
    out.put(m.image_ids[i]);
    for (const double number : {q.w, q.x, q.y, q.z}) out.put(number);
    for (const double number : camera_from_world.translation) out.put(number);
    out.put(m.camera_ids[i]);
    out.put_name(m.trajectory.names[i]);
    out.end_line();
    out.put_empty_list();
    out.end_line();
  }
  out.save(folder, "images");
}

inline void write_points(const fs::path& folder, const colmap_model& m, colmap_encoding encoding) {
  constexpr double unknown_error = -1;
  const auto n = static_cast<std::uint64_t>(m.points.size());
  record_writer out(encoding);
  out.begin(n, "POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]");
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d p = m.points.position(i);
    out.put(static_cast<std::uint64_t>(i + 1));
    for (const double number : p) out.put(number);
    const cloud::color color = m.points.colors.empty() ? cloud::color{} : m.points.colors[i];
    for (const std::uint8_t channel : color) out.put(channel);
    out.put(m.point_errors_px.empty() ? unknown_error : m.point_errors_px[i]);
    out.put_empty_list();
    out.end_line();
  }
  out.save(folder, "points3D");
}

}  // namespace colmap::detail

inline void write_colmap(const std::filesystem::path& folder,
                         const colmap_model& model,
                         colmap_encoding encoding) {
  colmap::detail::check_writable(model);
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) throw io_error(folder, message("cannot create: ", code.message()));
  colmap::detail::write_cameras(folder, model, encoding);
  colmap::detail::write_images(folder, model, encoding);
  colmap::detail::write_points(folder, model, encoding);
}

inline colmap_model make_colmap_model(const posed_images& images) {
  pose::check(images.trajectory);
  const std::size_t n = images.trajectory.size();
  if (images.trajectory.names.empty() || images.cameras.size() != n) {
    throw argument_error(message("make_colmap_model: names and cameras for ", n,
                                 " poses expected, found ", images.trajectory.names.size(),
                                 " names and ", images.cameras.size(), " cameras"));
  }
  colmap_model model;
  model.trajectory = images.trajectory;
  for (std::size_t i = 0; i < n; ++i) {
    const auto known =
        std::find_if(model.cameras.begin(), model.cameras.end(), [&](const auto& entry) {
          return colmap::detail::same_camera(entry.second, images.cameras[i]);
        });
    const auto id = known != model.cameras.end()
                        ? known->first
                        : static_cast<std::uint32_t>(model.cameras.size() + 1);
    model.cameras.try_emplace(id, images.cameras[i]);
    model.image_ids.push_back(static_cast<std::uint32_t>(i + 1));
    model.camera_ids.push_back(id);
  }
  return model;
}

}  // namespace aib::io

// aib/io/number_lines.hpp

namespace aib::io {

/// Fields of a line parted by blanks, by commas, or by both; a comma at the end is allowed. A field
/// between two commas is empty.
inline void split_loosely(std::string_view line, std::vector<std::string_view>& fields) {
  constexpr std::string_view blank = " \t\r\v\f";
  fields.clear();
  for (;;) {
    line.remove_prefix(std::min(line.find_first_not_of(blank), line.size()));
    if (line.empty()) return;
    const std::size_t end = std::min(line.find_first_of(" \t\r\v\f,"), line.size());
    fields.push_back(line.substr(0, end));
    line.remove_prefix(end);
    line.remove_prefix(std::min(line.find_first_not_of(blank), line.size()));
    if (line.starts_with(',')) line.remove_prefix(1);
  }
}

/// Walks the lines of a text that are rows of numbers, parted by blanks or commas. Blank lines and
/// comments ('#') are skipped; every error names the file, the line and the format.
class number_lines {
 public:
  number_lines(std::string_view text, const std::filesystem::path& path, std::string_view format)
      : lines_(text, path), format_(format) {}

  /// Moves to the next row; false after the last. Throws format_error where a field is no number.
  bool next() {
    if (!lines_.next_content()) return false;
    split_loosely(lines_.line(), fields_);
    numbers_.clear();
    for (const std::string_view field : fields_) {
      const auto number = parse<double>(field);
      if (!number) fail(message("a number expected, found '", field, "'"));
      numbers_.push_back(*number);
    }
    return true;
  }

  [[nodiscard]] const std::vector<double>& numbers() const { return numbers_; }
  [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }
  [[nodiscard]] std::size_t line() const { return lines_.number(); }

  /// Refuses a row that has not `n` numbers; `what` names them.
  void expect(std::size_t n, std::string_view what) const {
    if (numbers_.size() == n) return;
    fail(message(n, " numbers (", what, ") expected, found ", numbers_.size()));
  }

  [[noreturn]] void fail(std::string_view what) const { lines_.fail(message(format_, ": ", what)); }

  /// What `make()` returns; the place is put before what it refuses.
  template <class Make>
  auto checked(Make&& make) const {
    try {
      return make();
    } catch (const argument_error& e) {
      fail(e.what());
    }
  }

 private:
  line_reader lines_;
  std::string format_;
  std::vector<std::string_view> fields_;
  std::vector<double> numbers_;
};

}  // namespace aib::io

// aib/io/kitti.hpp

namespace aib::io {

/// Poses of a KITTI odometry text file: the 12 numbers of [R | t] by rows a line,
/// world_from_camera. Neither names nor stamps: line k is frame k. Poses that are not finite stay,
/// unregistered.
///
/// Throws format_error for a line without 12 numbers, a matrix that is not a rotation (see
/// pose_from_matrix) and a file without a pose.
/// Source: Geiger, Lenz, Urtasun, "Are we ready for autonomous driving?", CVPR 2012.
[[nodiscard]] pose::trajectory read_kitti(const std::filesystem::path& path,
                                          const pose_frame& frame = {});

/// Writes a KITTI file, numbers in their shortest exact form. Throws argument_error where there is
/// no pose or one is not registered, which the format cannot say.
void write_kitti(const std::filesystem::path& path, const pose::trajectory& t);

/// Poses of a text file with the 16 numbers of a 4 x 4 matrix by rows a line, world_from_camera:
/// what Depth Anything 3's streaming writes as camera_poses.txt. Else as read_kitti.
[[nodiscard]] pose::trajectory read_matrix_lines(const std::filesystem::path& path,
                                                 const pose_frame& frame = {});

namespace detail {

/// The upper rows of a matrix written by rows; 12 numbers are used.
inline pose_matrix matrix_of_rows(const std::vector<double>& numbers) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers.data());
}

inline pose::trajectory read_pose_rows(const std::filesystem::path& path,
                                       std::string_view format,
                                       std::size_t n,
                                       const pose_frame& frame) {
  const std::string text = read_file(path);
  number_lines lines(text, path, format);
  pose::trajectory t;
  while (lines.next()) {
    lines.expect(n, n == 12 ? "3 x 4 matrix by rows" : "4 x 4 matrix by rows");
    t.world_from_camera.push_back(
        lines.checked([&] { return pose_from_matrix(matrix_of_rows(lines.numbers()), frame); }));
  }
  return checked_trajectory(std::move(t), path, format);
}

}  // namespace detail

inline pose::trajectory read_kitti(const std::filesystem::path& path, const pose_frame& frame) {
  return detail::read_pose_rows(path, "kitti", 12, frame);
}

inline pose::trajectory read_matrix_lines(const std::filesystem::path& path,
                                          const pose_frame& frame) {
  return detail::read_pose_rows(path, "matrix lines", 16, frame);
}

inline void write_kitti(const std::filesystem::path& path, const pose::trajectory& t) {
  if (t.empty()) throw argument_error("write_kitti: no pose to write");
  std::string text;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!t.world_from_camera[i].is_finite()) {
      throw argument_error(
          message("write_kitti: pose ", i, " is not registered, which the format cannot say"));
    }
    const Eigen::Matrix4d m = t.world_from_camera[i].matrix();
    for (Eigen::Index k = 0; k < 12; ++k) text += message(m(k / 4, k % 4), k == 11 ? '\n' : ' ');
  }
  write_file(path, text);
}

}  // namespace aib::io

// aib/io/da3_streaming.hpp

namespace aib::io {

/// Cameras of a text file with `fx fy cx cy` (pixels) a line. The images' size is not in the file:
/// width and height are 0.
/// Throws format_error for a line without 4 numbers.
[[nodiscard]] inline std::vector<math::camera> read_intrinsic_lines(
    const std::filesystem::path& path) {
  const std::string text = read_file(path);
  number_lines lines(text, path, "intrinsics");
  std::vector<math::camera> cameras;
  while (lines.next()) {
    lines.expect(4, "fx fy cx cy");
    const std::vector<double>& n = lines.numbers();
    cameras.push_back(math::pinhole(0, 0, n[0], n[1], n[2], n[3]));
  }
  return cameras;
}

/// What Depth Anything 3's streaming leaves in a folder: camera_poses.txt (see read_matrix_lines)
/// and, where it is there, intrinsic.txt with a line a pose. `path` is the folder or
/// camera_poses.txt.
/// Throws format_error where the two files differ in length.
/// Source: Depth-Anything-3, da3_streaming.
[[nodiscard]] inline posed_images read_da3_streaming(const std::filesystem::path& path,
                                                     const pose_frame& frame = {}) {
  const bool folder = std::filesystem::is_directory(path);
  const std::filesystem::path poses = folder ? path / "camera_poses.txt" : path;
  const std::filesystem::path intrinsics = poses.parent_path() / "intrinsic.txt";
  posed_images images{read_matrix_lines(poses, frame), {}};
  if (!std::filesystem::exists(intrinsics)) return images;
  images.cameras = read_intrinsic_lines(intrinsics);
  if (images.cameras.size() != images.trajectory.size()) {
    throw format_error(intrinsics, message("a line for each of the ", images.trajectory.size(),
                                           " poses expected, found ", images.cameras.size()));
  }
  return images;
}

}  // namespace aib::io

// aib/io/dmap.hpp

namespace aib::io {

/// Reads the depth of an OpenMVS .dmap file: planar, 0 where there is none. Both layouts, "DR"
/// (float) and "D2" (half times a power of two); normals, confidences and views are passed over.
///
/// Throws format_error where the file is damaged or holds no depth.
/// Source: OpenMVS, libs/MVS/Interface.h.
depth::depth_map read_dmap(const std::filesystem::path& path);

namespace detail {

struct dmap_header {
  bool is_half = false;
  int exponent = 0;  ///< halves are depth / 2^exponent
  std::size_t width = 0, height = 0;
};

inline dmap_header read_dmap_header(byte_reader& in) {
  dmap_header header;
  const std::string_view tag = in.take(2, "dmap: tag");
  if (tag != "DR" && tag != "D2") in.fail("dmap: the tag DR or D2 expected at the begin");
  header.is_half = tag == "D2";
  constexpr std::uint8_t has_depth = 1;
  if ((in.read<std::uint8_t>("dmap: type") & has_depth) == 0) in.fail("dmap: no depth in the file");
  const auto exponent = in.read<std::int8_t>("dmap: exponent");
  if (header.is_half) header.exponent = exponent;
  in.take(8, "dmap: size of the image");
  header.width = in.read<std::uint32_t>("dmap: width");
  header.height = in.read<std::uint32_t>("dmap: height");
  in.take(header.is_half ? 12 : 8, "dmap: range");
  in.take(in.read<std::uint16_t>("dmap: length of the name"), "dmap: name");
  in.take(4 * in.read_count<std::uint32_t>(4, "dmap: number of views"), "dmap: views");
  in.take(8 * (9 + 9 + 3), "dmap: camera");
  return header;
}

}  // namespace detail

inline depth::depth_map read_dmap(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  byte_reader in(bytes, path);
  const auto header = detail::read_dmap_header(in);
  const std::size_t pixel = header.is_half ? 2 : 4;
  if (header.width == 0 || header.height == 0 || header.width > in.left() / pixel / header.height) {
    in.fail(message("dmap: ", header.width, "x", header.height, " depths expected, ",
                    in.left() / pixel, " in the file"));
  }
  depth::depth_map result{raster::image<float>(header.width, header.height)};
  const char* from = in.take(pixel * result.values.size(), "dmap: depth").data();
  for (float& depth : result.values) {
    depth = header.is_half ? std::ldexp(float_from_half(load<std::uint16_t>(from)), header.exponent)
                           : load<float>(from);
    from += pixel;
  }
  return result;
}

}  // namespace aib::io

// aib/io/pfm.hpp

namespace aib::io {

/// Reads a gray PFM: "Pf", width, height, scale, then floats row by row from the bottom. A negative
/// scale means little endian; its size is ignored as everybody does, with a warning where it is
/// not 1. Bytes after the pixels are ignored.
///
/// Throws format_error where the file is damaged or has colours ("PF").
/// Source: Debevec, "PFM Portable FloatMap Image Format".
depth::depth_map read_pfm(const std::filesystem::path& path);

/// Writes a gray PFM in the machine's byte order, scale 1.
void write_pfm(const std::filesystem::path& path, raster::view<const float> depth);

namespace detail {

/// The four words of the header; one blank parts the last from the pixels.
class pfm_header {
 public:
  explicit pfm_header(const input_file& file) : path_(file.path()) {
    text_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 256)));
    file.read_at(0, text_.data(), text_.size());
    const std::string_view tag = word("the tag Pf");
    if (tag == "PF") fail("a gray map (Pf) expected, found colours (PF)");
    if (tag != "Pf") fail("the tag Pf expected at the begin");
    width = number<std::size_t>("the width");
    height = number<std::size_t>("the height");
    const auto scale = number<double>("the scale");
    if (!std::isfinite(scale) || scale == 0) fail("a scale other than 0 expected");
    order = scale < 0 ? std::endian::little : std::endian::big;
    factor = std::abs(scale);
  }

  std::size_t width = 0, height = 0;
  std::endian order = std::endian::little;
  double factor = 1;
  [[nodiscard]] std::size_t end() const { return at_; }

 private:
  std::string_view word(std::string_view what) {
    constexpr std::string_view blank = " \t\r\n";
    const std::size_t begin = text_.find_first_not_of(blank, at_);
    const std::size_t end = begin == std::string::npos ? begin : text_.find_first_of(blank, begin);
    if (end == std::string::npos) fail(message(what, " expected, the header ends"));
    at_ = end + 1;
    return std::string_view(text_).substr(begin, end - begin);
  }

  template <class Number>
  Number number(std::string_view what) {
    const std::string_view found = word(what);
    const auto value = parse<Number>(found);
    if (!value) fail(message(what, " expected, found \"", found, "\""));
    return *value;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, message("pfm: ", what));
  }

  std::filesystem::path path_;
  std::string text_;
  std::size_t at_ = 0;
};

}  // namespace detail

inline depth::depth_map read_pfm(const std::filesystem::path& path) {
  const input_file file(path);
  const detail::pfm_header header(file);
  depth::depth_map result{
      read_float_pixels(file, header.end(), header.width, header.height, header.order)};
  raster::image<float>& image = result.values;
  for (std::size_t y = 0; y < image.height() / 2; ++y)
    std::swap_ranges(&image(0, y), &image(0, y) + image.width(), &image(0, image.height() - 1 - y));
  if (header.factor != 1)
    result.warnings.push_back(message("the scale ", header.factor, " in the header was ignored"));
  return result;
}

inline void write_pfm(const std::filesystem::path& path, raster::view<const float> depth) {
  std::string bytes = message("Pf\n", depth.width, " ", depth.height, "\n-1.0\n");
  for (std::size_t y = depth.height; y-- > 0;)
    for (const float value : depth.row(y)) store(bytes, value);
  write_file(path, bytes);
}

}  // namespace aib::io

// aib/io/range_depth.hpp

namespace aib::io {

/// Turns distances along the rays of pixel centres into planar depth, in place.
///
/// camera   intrinsics without distortion; where its size is another than that of the map, they are
///          scaled with each side
///
/// Throws argument_error for a camera with distortion or without a size.
inline void planar_from_range(raster::view<float> range, const math::camera& camera) {
  using enum math::camera_model;
  if (camera.model != pinhole && camera.model != simple_pinhole)
    throw argument_error(message("range: a pinhole camera expected, found ",
                                 math::info(camera.model).name, "; undistort the map first"));
  if (camera.width == 0 || camera.height == 0 || !(camera.fx() > 0) || !(camera.fy() > 0))
    throw argument_error("range: a camera with a size and focal lengths > 0 expected");
  const double scale_x = static_cast<double>(camera.width) / static_cast<double>(range.width);
  const double scale_y = static_cast<double>(camera.height) / static_cast<double>(range.height);
  for (std::size_t y = 0; y < range.height; ++y) {
    const double v = ((static_cast<double>(y) + 0.5) * scale_y - camera.cy()) / camera.fy();
    for (std::size_t x = 0; x < range.width; ++x) {
      const double u = ((static_cast<double>(x) + 0.5) * scale_x - camera.cx()) / camera.fx();
      float& value = range(x, y);
      value = static_cast<float>(static_cast<double>(value) / std::sqrt(1 + u * u + v * v));
    }
  }
}

}  // namespace aib::io

// aib/io/raw_depth.hpp

namespace aib::io {

/// Reads depth that has no header: little-endian floats row by row from the top, as ETH3D has them
/// (its files end in .JPG all the same, infinite where there is no depth). The size is that of the
/// camera. Throws format_error where the file is not exactly that large.
inline depth::depth_map read_raw_depth(const std::filesystem::path& path,
                                       std::size_t width,
                                       std::size_t height) {
  const input_file file(path);
  depth::depth_map result{read_float_pixels(file, 0, width, height, std::endian::little)};
  if (file.size() != result.values.size() * sizeof(float)) {
    throw format_error(
        path, message(width, "x", height, " floats are ", result.values.size() * sizeof(float),
                      " bytes, the file has ", file.size()));
  }
  return result;
}

}  // namespace aib::io

// aib/io/exr_header.hpp

namespace aib::io {

enum class exr_pixel : std::int32_t { uint32 = 0, half = 1, float32 = 2 };

enum class exr_compression : std::uint8_t {
  none,
  rle,
  zips,
  zip,
  piz,
  pxr24,
  b44,
  b44a,
  dwaa,
  dwab
};

struct exr_channel_info {
  std::string name;
  exr_pixel type = exr_pixel::float32;
};

/// Rectangle of pixels, both corners within; y down.
struct exr_window {
  std::int32_t min_x = 0, min_y = 0, max_x = -1, max_y = -1;

  [[nodiscard]] std::size_t width() const {
    return static_cast<std::size_t>(std::int64_t{max_x} - min_x + 1);
  }
  [[nodiscard]] std::size_t height() const {
    return static_cast<std::size_t>(std::int64_t{max_y} - min_y + 1);
  }
  friend bool operator==(const exr_window&, const exr_window&) = default;
};

/// One of the images of a file; most files have one.
struct exr_part {
  std::string name = {};
  std::vector<exr_channel_info> channels = {};
  exr_compression compression = exr_compression::none;
  exr_window data = {};                         ///< pixels that are in the file
  exr_window display = {};                      ///< the picture that they are a part of
  std::size_t tile_width = 0, tile_height = 0;  ///< 0: scan lines
  std::uint64_t offsets_at = 0;                 ///< place of the table of blocks in the file

  [[nodiscard]] bool is_tiled() const { return tile_width > 0; }
  [[nodiscard]] std::size_t pixel_bytes() const {
    std::size_t n = 0;
    for (const exr_channel_info& c : channels) n += c.type == exr_pixel::half ? 2u : 4u;
    return n;
  }
};

struct exr_header {
  std::vector<exr_part> parts = {};
  bool is_multipart = false;  ///< blocks say which part they belong to
};

/// Largest image that is read, in pixels.
inline constexpr std::uint64_t exr_max_pixels = std::uint64_t{1} << 27;

/// Reads and checks the header of an OpenEXR file. Throws format_error where it is damaged, where
/// the image is larger than exr_max_pixels or than what the file can hold, and where it has what
/// aib does not read: deep data, sub-sampled channels. Source of the format: "OpenEXR File Layout",
/// openexr.com.
exr_header read_exr_header(const input_file& file);

/// "ZIP" and the like.
[[nodiscard]] constexpr std::string_view name(exr_compression compression) {
  constexpr std::array<std::string_view, 10> names{"NONE",  "RLE", "ZIPS", "ZIP",  "PIZ",
                                                   "PXR24", "B44", "B44A", "DWAA", "DWAB"};
  return names[static_cast<std::size_t>(compression)];
}

/// Scan lines in a block.
[[nodiscard]] constexpr std::size_t block_lines(exr_compression compression) {
  constexpr std::array<std::size_t, 10> lines{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  return lines[static_cast<std::size_t>(compression)];
}

namespace detail {

class exr_header_parser {
 public:
  explicit exr_header_parser(const input_file& file) : file_(file), stream_(file) {}

  exr_header parse() {
    constexpr std::uint32_t magic = 20000630;
    if (file_.size() < 8 || stream_.read_number<std::uint32_t>("exr: magic") != magic)
      throw format_error(file_.path(), "exr: not an OpenEXR file");
    parse_flags(stream_.read_number<std::uint32_t>("exr: version"));
    std::string attribute = take_name();
    do {
      if (header_.parts.size() == 4096) fail("exr: more than 4096 parts");
      parse_part(std::move(attribute));
    } while (header_.is_multipart && !(attribute = take_name()).empty());
    place_offsets();
    return std::move(header_);
  }

 private:
  void parse_flags(std::uint32_t version) {
    constexpr std::uint32_t tiled = 0x200, long_names = 0x400, deep = 0x800, multipart = 0x1000;
    if ((version & 0xff) != 2) fail(message("exr: version 2 expected, found ", version & 0xff));
    if ((version & ~(0xffu | tiled | long_names | deep | multipart)) != 0)
      fail("exr: unknown flags in the version");
    if ((version & deep) != 0)
      fail("exr: deep data are not supported; flatten the image and save it with ZIP");
    is_tiled_ = (version & tiled) != 0;
    header_.is_multipart = (version & multipart) != 0;
  }

  std::string take_name() { return stream_.take_name("exr: name of an attribute"); }

  void parse_part(std::string attribute) {
    exr_part part;
    seen_ = {};
    for (; !attribute.empty(); attribute = take_name()) {
      const std::string type = stream_.take_name("exr: type of an attribute");
      const auto size = stream_.read_number<std::int32_t>("exr: size of an attribute");
      if (size < 0) fail(message("exr: an attribute of ", size, " bytes"));
      const auto n = static_cast<std::size_t>(size);
      parse_attribute(part, attribute, type, {stream_.take(n, "exr: attribute"), n});
    }
    check(part);
    header_.parts.push_back(std::move(part));
  }

  struct seen_attributes {
    bool channels = false, compression = false, data = false, display = false, tiles = false;
    bool deep = false;
    std::int64_t n_blocks = -1;
  };

  void parse_attribute(exr_part& part,
                       std::string_view name,
                       std::string_view type,
                       std::string_view value) {
    byte_reader in(value, file_.path());
    const auto is = [&](std::string_view n, std::string_view t) { return name == n && type == t; };
    if (is("channels", "chlist")) {
      parse_channels(part, in);
      seen_.channels = true;
    } else if (is("compression", "compression")) {
      const auto code = in.read<std::uint8_t>("exr: compression");
      if (code > static_cast<std::uint8_t>(exr_compression::dwab))
        fail(message("exr: unknown compression ", unsigned{code}));
      part.compression = static_cast<exr_compression>(code);
      seen_.compression = true;
    } else if (is("dataWindow", "box2i")) {
      part.data = parse_window(in);
      seen_.data = true;
    } else if (is("displayWindow", "box2i")) {
      part.display = parse_window(in);
      seen_.display = true;
    } else if (is("tiles", "tiledesc")) {
      part.tile_width = in.read<std::uint32_t>("exr: tiles");
      part.tile_height = in.read<std::uint32_t>("exr: tiles");
      seen_.tiles = true;
    } else if (is("name", "string")) {
      part.name = value;
    } else if (is("type", "string")) {
      seen_.deep = value.starts_with("deep");
      if (header_.is_multipart) is_tiled_ = value == "tiledimage";
    } else if (is("chunkCount", "int")) {
      seen_.n_blocks = in.read<std::int32_t>("exr: chunkCount");
    }
  }

  void parse_channels(exr_part& part, byte_reader& in) {
    for (;;) {
      exr_channel_info channel;
      channel.name = in.read_name("exr: name of a channel");
      if (channel.name.empty()) return;
      const auto type = in.read<std::int32_t>("exr: type of a channel");
      if (type < 0 || type > 2) fail(message("exr: channel ", channel.name, ": type ", type));
      channel.type = static_cast<exr_pixel>(type);
      in.take(4, "exr: channel");
      const auto x_sampling = in.read<std::int32_t>("exr: sampling of a channel");
      const auto y_sampling = in.read<std::int32_t>("exr: sampling of a channel");
      if (x_sampling != 1 || y_sampling != 1) {
        fail(message("exr: channel ", channel.name, " is sub-sampled (", x_sampling, "x",
                     y_sampling, "), which is not supported"));
      }
      part.channels.push_back(std::move(channel));
      if (part.channels.size() > 1024) fail("exr: more than 1024 channels");
    }
  }

  exr_window parse_window(byte_reader& in) {
    exr_window w;
    w.min_x = in.read<std::int32_t>("exr: window");
    w.min_y = in.read<std::int32_t>("exr: window");
    w.max_x = in.read<std::int32_t>("exr: window");
    w.max_y = in.read<std::int32_t>("exr: window");
    const bool ordered = w.max_x >= w.min_x && w.max_y >= w.min_y;
    if (!ordered || w.width() > exr_max_pixels / w.height()) {
      fail(message("exr: window (", w.min_x, ", ", w.min_y, ") to (", w.max_x, ", ", w.max_y,
                   ") is empty or larger than ", exr_max_pixels, " pixels"));
    }
    return w;
  }

  void check(exr_part& part) {
    if (seen_.deep)
      fail("exr: deep data are not supported; flatten the image and save it with ZIP");
    if (!seen_.channels || part.channels.empty()) fail("exr: no channels in the header");
    if (!seen_.compression) fail("exr: no compression in the header");
    if (!seen_.data) fail("exr: no dataWindow in the header");
    if (!seen_.display) part.display = part.data;
    if (!is_tiled_) part.tile_width = part.tile_height = 0;
    if (is_tiled_ && (!seen_.tiles || part.tile_width == 0 || part.tile_height == 0 ||
                      part.tile_width > exr_max_pixels / part.tile_height))
      fail("exr: no size of the tiles in the header");
    n_blocks_.push_back(block_count(part));
  }

  std::uint64_t block_count(const exr_part& part) {
    const auto parts_of = [](std::size_t n, std::size_t size) { return (n + size - 1) / size; };
    const std::uint64_t needed = part.is_tiled()
                                     ? parts_of(part.data.width(), part.tile_width) *
                                           parts_of(part.data.height(), part.tile_height)
                                     : parts_of(part.data.height(), block_lines(part.compression));
    if (!header_.is_multipart) return needed;
    if (seen_.n_blocks < 0 || static_cast<std::uint64_t>(seen_.n_blocks) < needed)
      fail(message("exr: chunkCount of at least ", needed, " expected, found ", seen_.n_blocks));
    return static_cast<std::uint64_t>(seen_.n_blocks);
  }

  void place_offsets() {
    std::uint64_t at = stream_.offset();
    for (std::size_t i = 0; i < header_.parts.size(); ++i) {
      if (n_blocks_[i] > (file_.size() - at) / 8) {
        throw format_error(file_.path(), at_byte{at},
                           message("exr: ", n_blocks_[i], " blocks expected, ", file_.size() - at,
                                   " bytes left in the file"));
      }
      header_.parts[i].offsets_at = at;
      at += 8 * n_blocks_[i];
    }
  }

  [[noreturn]] void fail(std::string_view what) const { stream_.fail(what); }

  const input_file& file_;
  byte_stream stream_;
  exr_header header_;
  bool is_tiled_ = false;
  seen_attributes seen_;
  std::vector<std::uint64_t> n_blocks_;
};

}  // namespace detail

inline exr_header read_exr_header(const input_file& file) {
  return detail::exr_header_parser(file).parse();
}

}  // namespace aib::io

// aib/io/exr_piz.hpp

/// OpenEXR's PIZ codec: Haar wavelets of 16-bit words, their values renumbered without gaps, and
/// Huffman codes of up to 58 bits. Every step is checked; a damaged block gives nothing.
/// Source: the reference implementation of OpenEXR (ImfPizCompressor, ImfWav, ImfHuf).
namespace aib::io::detail {

/// Bits of a block, highest of each byte first.
class exr_bits {
 public:
  explicit exr_bits(std::string_view bytes) : bytes_(bytes) {}

  /// The next n bits (n <= 32); nothing beyond the end.
  std::optional<std::uint32_t> take(unsigned n) {
    if (n > left()) return std::nullopt;
    const std::uint32_t value = peek(n);
    at_ += n;
    return value;
  }

  /// The next n bits (n <= 32) without moving on, zeros beyond the end.
  [[nodiscard]] std::uint32_t peek(unsigned n) const {
    std::uint64_t word = 0;
    const std::size_t first = at_ / 8;
    for (std::size_t k = 0; k < 5; ++k) {
      const auto byte =
          first + k < bytes_.size() ? static_cast<unsigned char>(bytes_[first + k]) : 0u;
      word = (word << 8) | byte;
    }
    return static_cast<std::uint32_t>((word >> (40 - at_ % 8 - n)) & ((std::uint64_t{1} << n) - 1));
  }

  void skip(std::size_t n) { at_ += n; }
  void limit(std::size_t bits) { end_ = at_ + bits; }
  void align() { at_ = (at_ + 7) / 8 * 8; }
  [[nodiscard]] std::size_t left() const { return end_ > at_ ? end_ - at_ : 0; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  std::size_t end_ = 8 * bytes_.size();
};

/// Canonical Huffman code of 65537 symbols: the 16-bit words and a sign for runs.
class piz_huffman {
 public:
  static constexpr std::size_t n_symbols = 65537;
  static constexpr unsigned max_length = 58;

  /// Reads the lengths of the codes of symbols first..last.
  [[nodiscard]] bool read_lengths(exr_bits& bits, std::size_t first, std::size_t last) {
    constexpr std::uint32_t short_run = 59, long_run = 63;
    lengths_.assign(n_symbols, 0);
    for (std::size_t symbol = first; symbol <= last;) {
      const auto length = bits.take(6);
      if (!length) return false;
      if (*length < short_run) {
        lengths_[symbol++] = static_cast<std::uint8_t>(*length);
        continue;
      }
      std::size_t run = *length - short_run + 2;
      if (*length == long_run) {
        const auto more = bits.take(8);
        if (!more) return false;
        run = *more + 6;
      }
      if (run > last + 1 - symbol) return false;
      symbol += run;
    }
    return make_codes();
  }

  /// Decodes `to.size()` words; `run_symbol` repeats the last word as often as the 8 bits behind it
  /// say.
  [[nodiscard]] bool decode(exr_bits& bits, std::size_t run_symbol, std::span<std::uint16_t> to) {
    std::size_t n = 0;
    while (bits.left() > 0) {
      const auto symbol = next(bits);
      if (!symbol) return false;
      if (*symbol == run_symbol) {
        const auto run = bits.take(8);
        if (!run || n == 0 || *run > to.size() - n) return false;
        std::fill_n(to.begin() + static_cast<std::ptrdiff_t>(n), *run, to[n - 1]);
        n += *run;
      } else {
        if (n == to.size()) return false;
        to[n++] = static_cast<std::uint16_t>(*symbol);
      }
    }
    return n == to.size();
  }

 private:
  static constexpr unsigned table_bits = 14;

  /// Code words of each length follow one another; the longest are the smallest numbers.
  bool make_codes() {
    std::array<std::uint64_t, max_length + 1> count{};
    for (const std::uint8_t length : lengths_) ++count[length];
    count[0] = 0;
    std::uint64_t code = 0;
    for (unsigned length = max_length; length > 0; --length) {
      first_code_[length] = code;
      code = (code + count[length]) >> 1;
    }
    std::size_t offset = 0;
    for (unsigned length = 1; length <= max_length; ++length) {
      first_symbol_[length] = offset;
      offset += count[length];
      n_codes_[length] = count[length];
    }
    symbols_.resize(offset);
    auto place = first_symbol_;
    for (std::size_t symbol = 0; symbol < n_symbols; ++symbol) {
      if (lengths_[symbol] > 0)
        symbols_[place[lengths_[symbol]]++] = static_cast<std::uint32_t>(symbol);
    }
    return fill_table();
  }

  /// Short codes are looked up: every continuation of a code leads to its symbol.
  bool fill_table() {
    table_.assign(std::size_t{1} << table_bits, {});
    for (unsigned length = 1; length <= table_bits; ++length) {
      const unsigned rest = table_bits - length;
      if (first_code_[length] + n_codes_[length] > std::uint64_t{1} << length) return false;
      for (std::uint64_t k = 0; k < n_codes_[length]; ++k) {
        const auto begin = static_cast<std::size_t>((first_code_[length] + k) << rest);
        std::fill_n(table_.begin() + static_cast<std::ptrdiff_t>(begin), std::size_t{1} << rest,
                    entry{symbols_[first_symbol_[length] + k], length});
      }
    }
    return true;
  }

  std::optional<std::uint32_t> next(exr_bits& bits) const {
    const entry& found = table_[bits.peek(table_bits)];
    if (found.length > 0) {
      if (found.length > bits.left()) return std::nullopt;
      bits.skip(found.length);
      return found.symbol;
    }
    std::uint64_t code = 0;
    for (unsigned length = 1; length <= max_length; ++length) {
      const auto bit = bits.take(1);
      if (!bit) return std::nullopt;
      code = (code << 1) | *bit;
      if (code >= first_code_[length] && code - first_code_[length] < n_codes_[length])
        return symbols_[first_symbol_[length] + (code - first_code_[length])];
    }
    return std::nullopt;
  }

  struct entry {
    std::uint32_t symbol = 0;
    unsigned length = 0;
  };
  std::vector<std::uint8_t> lengths_;
  std::array<std::uint64_t, max_length + 1> first_code_{};
  std::array<std::uint64_t, max_length + 1> n_codes_{};
  std::array<std::size_t, max_length + 1> first_symbol_{};
  std::vector<std::uint32_t> symbols_;
  std::vector<entry> table_;
};

/// Undoes one step of the wavelet on a pair: low and high become their two neighbours.
struct piz_pair {
  std::uint16_t a, b;
};

template <bool FourteenBits>
piz_pair unlift(std::uint16_t low, std::uint16_t high) {
  if constexpr (FourteenBits) {
    const int h = static_cast<std::int16_t>(high);
    const int a = static_cast<std::int16_t>(low) + (h & 1) + (h >> 1);
    return {static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(a - h)};
  } else {
    const unsigned b = (low - (high >> 1)) & 0xffffu;
    return {static_cast<std::uint16_t>(high + b - 0x8000u), static_cast<std::uint16_t>(b)};
  }
}

/// Undoes the wavelet of a plane: word (x, y) lies at data[x * step_x + y * step_y].
template <bool FourteenBits>
void unlift_plane(std::uint16_t* data,
                  std::size_t width,
                  std::size_t step_x,
                  std::size_t height,
                  std::size_t step_y) {
  const auto at = [=](std::size_t x, std::size_t y) -> std::uint16_t& {
    return data[x * step_x + y * step_y];
  };
  const auto pair = [](std::uint16_t& low, std::uint16_t& high) {
    const auto [a, b] = unlift<FourteenBits>(low, high);
    low = a;
    high = b;
  };
  std::size_t p = 1;
  while (2 * p <= std::min(width, height)) p *= 2;
  for (std::size_t step = p / 2; step > 0; step /= 2) {
    std::size_t y = 0;
    for (; y + 2 * step <= height; y += 2 * step) {
      std::size_t x = 0;
      for (; x + 2 * step <= width; x += 2 * step) {
        pair(at(x, y), at(x, y + step));
        pair(at(x + step, y), at(x + step, y + step));
        pair(at(x, y), at(x + step, y));
        pair(at(x, y + step), at(x + step, y + step));
      }
      if ((width & step) != 0) pair(at(x, y), at(x, y + step));
    }
    if ((height & step) != 0)
      for (std::size_t x = 0; x + 2 * step <= width; x += 2 * step) pair(at(x, y), at(x + step, y));
  }
}

/// Expands a PIZ block. `words` says for each channel how many 16-bit words a pixel has; `to` gets
/// the lines, channel after channel in each. False where the block is damaged.
inline bool expand_piz(std::string_view from,
                       std::size_t width,
                       std::size_t height,
                       std::span<const std::size_t> words,
                       std::span<std::uint8_t> to) {
  constexpr std::size_t bitmap_bytes = 8192;
  const auto u16 = [&](std::size_t at) { return load<std::uint16_t>(from.data() + at); };
  if (from.size() < 4) return false;
  const std::size_t first = u16(0), last = u16(2);
  from.remove_prefix(4);
  std::array<std::uint8_t, bitmap_bytes> bitmap{};
  if (first <= last) {
    const std::size_t n = last - first + 1;
    if (last >= bitmap_bytes || n > from.size()) return false;
    std::copy_n(from.begin(), n, bitmap.begin() + static_cast<std::ptrdiff_t>(first));
    from.remove_prefix(n);
  }
  std::vector<std::uint16_t> value_of(65536, 0);
  std::size_t n_values = 0;
  for (std::size_t v = 0; v < value_of.size(); ++v) {
    if (v == 0 || (bitmap[v / 8] >> (v % 8) & 1) != 0)
      value_of[n_values++] = static_cast<std::uint16_t>(v);
  }

  const auto u32 = [&](std::size_t at) { return load<std::uint32_t>(from.data() + at); };
  if (from.size() < 4 + 20 || u32(0) < 20 || u32(0) > from.size() - 4) return false;
  from = from.substr(4, u32(0));
  const std::size_t first_symbol = u32(0), last_symbol = u32(4), n_bits = u32(12);
  if (first_symbol >= piz_huffman::n_symbols || last_symbol >= piz_huffman::n_symbols) return false;
  exr_bits bits(from.substr(20));
  piz_huffman huffman;
  if (!huffman.read_lengths(bits, first_symbol, last_symbol)) return false;
  bits.align();
  if (n_bits > bits.left()) return false;
  bits.limit(n_bits);
  std::vector<std::uint16_t> planes(to.size() / 2);
  if (!huffman.decode(bits, last_symbol, planes)) return false;

  std::uint16_t* plane = planes.data();
  std::size_t line_offset = 0;
  std::size_t line_words = 0;
  for (const std::size_t w : words) line_words += w * width;
  for (const std::size_t w : words) {
    for (std::size_t k = 0; k < w; ++k) {
      const auto undo = n_values - 1 < (1u << 14) ? unlift_plane<true> : unlift_plane<false>;
      undo(plane + k, width, w, height, w * width);
    }
    for (std::size_t y = 0; y < height; ++y) {
      std::uint8_t* line = to.data() + 2 * (y * line_words + line_offset);
      for (std::size_t i = 0; i < w * width; ++i) {
        const std::uint16_t value = value_of[plane[y * w * width + i]];
        line[2 * i] = static_cast<std::uint8_t>(value & 0xff);
        line[2 * i + 1] = static_cast<std::uint8_t>(value >> 8);
      }
    }
    plane += w * width * height;
    line_offset += w * width;
  }
  return true;
}

}  // namespace aib::io::detail

// aib/io/exr_predictor.hpp

#if !defined(AIB_PLAIN) && defined(__SSE2__)
#include <emmintrin.h>
#endif

/// What OpenEXR's RLE and ZIP codecs do to bytes before they compress them: the bytes at even
/// places first, then those at odd places, then differences of neighbours plus 128.
/// Source: OpenEXR, "OpenEXR File Layout" and the reference implementation (ImfZip).
namespace aib::io {
inline namespace AIB_ISA {

/// Differences back to bytes, in place: b[0] = d[0], b[i] = b[i - 1] + d[i] - 128.
inline void sum_differences(std::uint8_t* bytes, std::size_t n) {
  if (n == 0) return;
  bytes[0] = static_cast<std::uint8_t>(bytes[0] + 128);  // the first has no 128 to take off
  std::size_t i = 0;
  std::uint8_t sum = 0;
#if !defined(AIB_PLAIN) && defined(__SSE2__)
  const __m128i bias = _mm_set1_epi8(-128);
  __m128i carry = _mm_setzero_si128();
  for (; i + 16 <= n; i += 16) {
    auto* at = reinterpret_cast<__m128i*>(bytes + i);
    __m128i x = _mm_add_epi8(_mm_loadu_si128(at), bias);
    x = _mm_add_epi8(x, _mm_slli_si128(x, 1));
    x = _mm_add_epi8(x, _mm_slli_si128(x, 2));
    x = _mm_add_epi8(x, _mm_slli_si128(x, 4));
    x = _mm_add_epi8(x, _mm_slli_si128(x, 8));
    _mm_storeu_si128(at, _mm_add_epi8(x, carry));
    // The last byte sixteen times: the only step that the next block waits for is the addition.
    const __m128i last = _mm_shufflehi_epi16(_mm_unpackhi_epi8(x, x), 0xff);
    carry = _mm_add_epi8(carry, _mm_shuffle_epi32(last, 0xff));
  }
  if (i > 0) sum = bytes[i - 1];
#endif
  for (; i < n; ++i) {
    sum = static_cast<std::uint8_t>(sum + bytes[i] - 128);
    bytes[i] = sum;
  }
}

/// Takes n bytes in turn from two halves: even[0], odd[0], even[1], ... ; n is even.
inline void interleave(const std::uint8_t* even,
                       const std::uint8_t* odd,
                       std::uint8_t* to,
                       std::size_t n) {
  std::size_t i = 0;
#if !defined(AIB_PLAIN) && defined(__SSE2__)
  for (; 2 * i + 32 <= n; i += 16) {
    const __m128i a = _mm_loadu_si128(reinterpret_cast<const __m128i*>(even + i));
    const __m128i b = _mm_loadu_si128(reinterpret_cast<const __m128i*>(odd + i));
    auto* at = reinterpret_cast<__m128i*>(to + 2 * i);
    _mm_storeu_si128(at, _mm_unpacklo_epi8(a, b));
    _mm_storeu_si128(at + 1, _mm_unpackhi_epi8(a, b));
  }
#endif
  for (; 2 * i < n; ++i) {
    to[2 * i] = even[i];
    to[2 * i + 1] = odd[i];
  }
}

/// The way there, for writing: halves, then differences. `to` holds n bytes, n is even.
inline void take_differences(const std::uint8_t* bytes, std::uint8_t* to, std::size_t n) {
  for (std::size_t i = 0; 2 * i < n; ++i) {
    to[i] = bytes[2 * i];
    to[n / 2 + i] = bytes[2 * i + 1];
  }
  for (std::size_t i = n; i-- > 1;) to[i] = static_cast<std::uint8_t>(to[i] - to[i - 1] + 128);
}

}  // namespace AIB_ISA
}  // namespace aib::io

// aib/io/inflate.hpp

#if defined(AIB_WITH_EXR) || defined(AIB_WITH_NPZ)
#if defined(AIB_WITH_LIBDEFLATE)
#include <libdeflate.h>
#else
#include <zlib.h>
#endif

namespace aib::io {

/// Expands zlib streams whose size is known. Uses libdeflate where AIB_WITH_LIBDEFLATE is defined
/// (twice as fast), else zlib. Not to be shared between threads.
class inflater {
 public:
#if defined(AIB_WITH_LIBDEFLATE)
  inflater() : state_(libdeflate_alloc_decompressor()) {
    if (!state_) throw std::bad_alloc();
  }

  /// Whether the stream is sound and holds exactly `n_to` bytes, which are then at `to`.
  [[nodiscard]] bool expand(const void* from, std::size_t n_from, void* to, std::size_t n_to) {
    return libdeflate_zlib_decompress(state_.get(), from, n_from, to, n_to, nullptr) ==
           LIBDEFLATE_SUCCESS;
  }

 private:
  struct free_state {
    void operator()(libdeflate_decompressor* d) const { libdeflate_free_decompressor(d); }
  };
  std::unique_ptr<libdeflate_decompressor, free_state> state_;
#else
  /// Whether the stream is sound and holds exactly `n_to` bytes, which are then at `to`.
  [[nodiscard]] bool expand(const void* from, std::size_t n_from, void* to, std::size_t n_to) {
    auto expanded = static_cast<uLongf>(n_to);
    return uncompress(static_cast<Bytef*>(to), &expanded, static_cast<const Bytef*>(from),
                      static_cast<uLong>(n_from)) == Z_OK &&
           expanded == n_to;
  }
#endif
};

}  // namespace aib::io
#endif

// aib/io/exr_block.hpp

#if defined(AIB_WITH_EXR) || defined(AIB_WITH_NPZ)
namespace aib::io::detail {

/// Pixels of a block: lines of `width` pixels, in each line channel after channel.
struct exr_block_shape {
  std::size_t width;
  std::size_t height;
  std::span<const exr_channel_info> channels;
  std::size_t bytes;  ///< all of it, expanded
};

/// Expands runs: a count c < 0 is followed by -c bytes, a count c >= 0 by one byte that stands
/// c + 1 times. False where the block does not give exactly `to.size()` bytes.
inline bool expand_runs(std::string_view from, std::span<std::uint8_t> to) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < from.size();) {
    const int count = static_cast<signed char>(from[i++]);
    const auto run = static_cast<std::size_t>(count < 0 ? -count : count + 1);
    const std::size_t taken = count < 0 ? run : 1;
    if (run > to.size() - n || taken > from.size() - i) return false;
    if (count < 0) {
      std::memcpy(to.data() + n, from.data() + i, run);
    } else {
      std::memset(to.data() + n, static_cast<unsigned char>(from[i]), run);
    }
    n += run;
    i += taken;
  }
  return n == to.size();
}

/// Expands the planes of a PXR24 block: differences of neighbours, highest byte first; floats have
/// lost their lowest byte.
inline void expand_pxr24(std::span<const std::uint8_t> planes,
                         const exr_block_shape& shape,
                         std::uint8_t* to) {
  const std::uint8_t* from = planes.data();
  for (std::size_t y = 0; y < shape.height; ++y) {
    for (const exr_channel_info& channel : shape.channels) {
      const std::size_t n_bytes = channel.type == exr_pixel::half ? 2 : 4;
      const std::size_t n_planes = channel.type == exr_pixel::float32 ? 3 : n_bytes;
      std::uint32_t value = 0;
      for (std::size_t x = 0; x < shape.width; ++x, to += n_bytes) {
        for (std::size_t k = 0; k < n_planes; ++k)
          value += std::uint32_t{from[k * shape.width + x]} << (8 * (n_bytes - 1 - k));
        for (std::size_t k = 0; k < n_bytes; ++k)
          to[k] = static_cast<std::uint8_t>(value >> (8 * k));
      }
      from += n_planes * shape.width;
    }
  }
}

inline std::size_t pxr24_plane_bytes(const exr_block_shape& shape) {
  std::size_t planes = 0;
  for (const exr_channel_info& c : shape.channels)
    planes += c.type == exr_pixel::half ? 2u : c.type == exr_pixel::float32 ? 3u : 4u;
  return planes * shape.width * shape.height;
}

/// Expands blocks one after another; its memory is used again.
class exr_block_decoder {
 public:
  /// Expands a block, of which `copy` then takes parts. False where it is damaged.
  [[nodiscard]] bool decode(exr_compression compression,
                            std::string_view block,
                            const exr_block_shape& shape) {
    raw_ = reinterpret_cast<const std::uint8_t*>(block.data());
    // A block that the codec could not make smaller is stored as it is.
    if (block.size() == shape.bytes) return true;
    if (block.size() > shape.bytes || compression == exr_compression::none) return false;
    raw_ = nullptr;
    bytes_.resize(shape.bytes);
    switch (compression) {
      case exr_compression::rle:
        return expand_runs(block, bytes_) && sum();
      case exr_compression::zips:
      case exr_compression::zip:
        return expand(block, bytes_) && sum();
      case exr_compression::pxr24:
        return decode_pxr24(block, shape);
      default:
        return decode_piz(block, shape);
    }
  }

  /// Copies n bytes of the block that was decoded last; `begin` and n are even.
  void copy(std::size_t begin, std::size_t n, std::uint8_t* to) const {
    if (raw_) {
      std::memcpy(to, raw_ + begin, n);
    } else {
      const std::uint8_t* even = bytes_.data() + begin / 2;
      interleave(even, even + bytes_.size() / 2, to, n);
    }
  }

 private:
  bool expand(std::string_view block, std::span<std::uint8_t> to) {
    return inflater_.expand(block.data(), block.size(), to.data(), to.size());
  }

  bool sum() {
    sum_differences(bytes_.data(), bytes_.size());
    return true;
  }

  bool decode_pxr24(std::string_view block, const exr_block_shape& shape) {
    planes_.resize(pxr24_plane_bytes(shape));
    raw_ = bytes_.data();
    if (!expand(block, planes_)) return false;
    expand_pxr24(planes_, shape, bytes_.data());
    return true;
  }

  bool decode_piz(std::string_view block, const exr_block_shape& shape) {
    std::vector<std::size_t> words;
    for (const exr_channel_info& c : shape.channels)
      words.push_back(c.type == exr_pixel::half ? 1 : 2);
    raw_ = bytes_.data();
    return expand_piz(block, shape.width, shape.height, words, bytes_);
  }

  inflater inflater_;
  std::vector<std::uint8_t> bytes_;
  std::vector<std::uint8_t> planes_;
  const std::uint8_t* raw_ = nullptr;  ///< the expanded block; null: bytes_ holds two halves
};

}  // namespace aib::io::detail
#endif

// aib/io/exr_channel.hpp

#if defined(AIB_WITH_EXR) || defined(AIB_WITH_NPZ)
namespace aib::io {

/// Reads a channel of a part, all of its data window or some of its lines.
///
/// lines   lines of the data window, ascending, the same may come twice; empty: all of them. Blocks
///         without a wanted line are not read.
///
/// Halves and unsigned integers become float. Returns data.width() x number of lines.
/// Codecs: NONE, RLE, ZIPS, ZIP, PIZ, PXR24, scan lines and tiles (the full resolution of
/// multi-resolution images). Throws format_error for the others and where a block is damaged.
raster::image<float> read_exr_channel(const input_file& file,
                                      const exr_header& header,
                                      std::size_t part,
                                      std::size_t channel,
                                      std::span<const std::size_t> lines = {});

namespace detail {

/// Bytes of a file at any place; neighbours are read together.
class file_window {
 public:
  explicit file_window(const input_file& file) : file_(file) {}

  /// n bytes at `offset`, valid until the next call.
  std::string_view at(std::uint64_t offset, std::size_t n, std::string_view what) {
    if (offset > file_.size() || n > file_.size() - offset) {
      throw format_error(file_.path(), at_byte{offset},
                         message(what, ": ", n, " bytes expected, the file has ", file_.size()));
    }
    if (offset < begin_ || offset + n > begin_ + bytes_.size()) {
      const std::uint64_t wanted = std::max<std::uint64_t>(n, std::uint64_t{1} << 18);
      bytes_.resize(static_cast<std::size_t>(std::min(wanted, file_.size() - offset)));
      file_.read_at(offset, bytes_.data(), bytes_.size());
      begin_ = offset;
    }
    return {bytes_.data() + (offset - begin_), n};
  }

 private:
  const input_file& file_;
  std::vector<char> bytes_;
  std::uint64_t begin_ = 0;
};

/// Reads one channel block by block.
class exr_channel_reader {
 public:
  exr_channel_reader(const input_file& file,
                     const exr_header& header,
                     std::size_t part,
                     std::size_t channel)
      : file_(file),
        window_(file),
        part_(header.parts[part]),
        type_(part_.channels[channel].type),
        part_number_(header.is_multipart ? static_cast<std::int32_t>(part) : -1) {
    for (std::size_t i = 0; i < channel; ++i)
      channel_offset_ += part_.channels[i].type == exr_pixel::half ? 2u : 4u;
    if (part_.compression > exr_compression::pxr24) {
      throw format_error(file.path(), message("exr: compression ", name(part_.compression),
                                              " is not supported; save the file with ZIP"));
    }
    block_width_ = part_.is_tiled() ? part_.tile_width : part_.data.width();
    block_height_ = part_.is_tiled() ? part_.tile_height : block_lines(part_.compression);
    if (std::min(block_width_, part_.data.width()) * std::min(block_height_, part_.data.height()) >
        max_block_bytes / part_.pixel_bytes())
      throw format_error(file.path(), "exr: the blocks are larger than 512 MB");
  }

  raster::image<float> read(std::span<const std::size_t> lines) {
    const std::size_t width = part_.data.width(), height = part_.data.height();
    place_rows(lines);
    raster::image<float> result(width, lines.empty() ? height : lines.size());
    const std::size_t columns = (width + block_width_ - 1) / block_width_;
    for (std::size_t row = 0; row * block_height_ < height; ++row) {
      const std::size_t first = row * block_height_;
      const std::size_t n = std::min(block_height_, height - first);
      if (!is_wanted(first, n)) continue;
      for (std::size_t column = 0; column < columns; ++column) {
        const std::size_t x = column * block_width_;
        const exr_block_shape shape = shape_of(std::min(block_width_, width - x), n);
        decode(row, column, columns, shape);
        copy(result, x, first, shape);
      }
    }
    repeat_rows(result, lines);
    return result;
  }

 private:
  static constexpr std::size_t max_block_bytes = std::size_t{1} << 29;
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  /// row_of_[y]: where line y goes; none where it is not wanted.
  void place_rows(std::span<const std::size_t> lines) {
    row_of_.assign(part_.data.height(), none);
    for (std::size_t i = 0; i < row_of_.size() && lines.empty(); ++i) row_of_[i] = i;
    for (std::size_t i = lines.size(); i-- > 0;) {
      if (lines[i] >= row_of_.size()) throw argument_error("read_exr_channel: no such line");
      row_of_[lines[i]] = i;
    }
  }

  /// Lines that are wanted more than once were read into the first of their rows.
  static void repeat_rows(raster::image<float>& image, std::span<const std::size_t> lines) {
    for (std::size_t i = 1; i < lines.size(); ++i) {
      if (lines[i] == lines[i - 1]) std::copy_n(&image(0, i - 1), image.width(), &image(0, i));
    }
  }

  bool is_wanted(std::size_t first, std::size_t n) const {
    return std::any_of(row_of_.begin() + static_cast<std::ptrdiff_t>(first),
                       row_of_.begin() + static_cast<std::ptrdiff_t>(first + n),
                       [](std::size_t row) { return row != none; });
  }

  exr_block_shape shape_of(std::size_t width, std::size_t height) const {
    return {width, height, part_.channels, width * height * part_.pixel_bytes()};
  }

  void decode(std::size_t row,
              std::size_t column,
              std::size_t columns,
              const exr_block_shape& shape) {
    const std::size_t index = row * columns + column;
    const std::string_view table = window_offsets(index);
    const auto offset = load<std::uint64_t>(table.data());
    const std::size_t n_fields = (part_number_ >= 0 ? 1u : 0u) + (part_.is_tiled() ? 5u : 2u);
    const std::string_view fields = window_.at(offset, 4 * n_fields, "exr: block");
    const auto field = [&](std::size_t i) { return load<std::int32_t>(fields.data() + 4 * i); };
    std::size_t at = 0;
    bool right = part_number_ < 0 || field(at++) == part_number_;
    if (part_.is_tiled()) {
      right = right && field(at) == static_cast<std::int32_t>(column) &&
              field(at + 1) == static_cast<std::int32_t>(row) && field(at + 2) == 0 &&
              field(at + 3) == 0;
      at += 4;
    } else {
      const std::int64_t y = part_.data.min_y + static_cast<std::int64_t>(row * block_height_);
      right = right && field(at++) == y;
    }
    if (!right)
      fail(offset, message("exr: block ", index, " is not at its place; the file is not complete"));
    const std::int32_t size = field(at);
    if (size < 0 || static_cast<std::size_t>(size) > shape.bytes)
      fail(offset, message("exr: block ", index, " of ", size, " bytes, at most ", shape.bytes,
                           " expected"));
    const std::string_view block =
        window_.at(offset + 4 * n_fields, static_cast<std::size_t>(size), "exr: block");
    if (!decoder_.decode(part_.compression, block, shape))
      fail(offset, message("exr: block ", index, " is damaged (", name(part_.compression), ")"));
  }

  /// The place of a block; the table of them is read in one piece.
  std::string_view window_offsets(std::size_t index) {
    if (offsets_.empty()) {
      const std::size_t columns = (part_.data.width() + block_width_ - 1) / block_width_;
      const std::size_t rows = (part_.data.height() + block_height_ - 1) / block_height_;
      offsets_.resize(8 * columns * rows);
      file_.read_at(part_.offsets_at, offsets_.data(), offsets_.size());
    }
    return {offsets_.data() + 8 * index, 8};
  }

  /// Copies the wanted lines of the decoded block to their rows.
  void copy(raster::image<float>& to,
            std::size_t x,
            std::size_t first,
            const exr_block_shape& shape) {
    const std::size_t line_bytes = shape.width * part_.pixel_bytes();
    const std::size_t pixel = type_ == exr_pixel::half ? 2 : 4;
    row_bytes_.resize(shape.width * pixel);
    for (std::size_t y = 0; y < shape.height; ++y) {
      const std::size_t row = row_of_[first + y];
      if (row == none) continue;
      const std::size_t begin = y * line_bytes + channel_offset_ * shape.width;
      float* const pixels = &to(x, row);
      if (type_ == exr_pixel::float32 && std::endian::native == std::endian::little) {
        decoder_.copy(begin, row_bytes_.size(), reinterpret_cast<std::uint8_t*>(pixels));
      } else {
        decoder_.copy(begin, row_bytes_.size(), row_bytes_.data());
        convert({pixels, shape.width});
      }
    }
  }

  void convert(std::span<float> pixels) const {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const std::uint8_t* from = row_bytes_.data();
      switch (type_) {
        case exr_pixel::half:
          pixels[i] = float_from_half(load<std::uint16_t>(from + 2 * i));
          break;
        case exr_pixel::uint32:
          pixels[i] = static_cast<float>(load<std::uint32_t>(from + 4 * i));
          break;
        default:
          pixels[i] = load<float>(from + 4 * i);
      }
    }
  }

  [[noreturn]] void fail(std::uint64_t offset, std::string_view what) const {
    throw format_error(file_.path(), at_byte{offset}, what);
  }

  const input_file& file_;
  file_window window_;
  const exr_part& part_;
  exr_pixel type_;
  std::int32_t part_number_;        ///< -1: the file has one part
  std::size_t channel_offset_ = 0;  ///< bytes of the channels before, a pixel
  std::size_t block_width_ = 0, block_height_ = 0;
  std::vector<char> offsets_;
  std::vector<std::size_t> row_of_;
  std::vector<std::uint8_t> row_bytes_;
  exr_block_decoder decoder_;
};

}  // namespace detail

inline raster::image<float> read_exr_channel(const input_file& file,
                                             const exr_header& header,
                                             std::size_t part,
                                             std::size_t channel,
                                             std::span<const std::size_t> lines) {
  return detail::exr_channel_reader(file, header, part, channel).read(lines);
}

}  // namespace aib::io
#endif

// aib/io/exr.hpp

#if defined(AIB_WITH_EXR) || defined(AIB_WITH_NPZ)
#include <zlib.h>

namespace aib::io {

struct exr_options {
  std::string channel = {};  ///< name of the channel; empty: chosen, see read_exr
  double max_depth = 1e9;    ///< this and beyond is background
  /// Size of the result, by nearest neighbour; 0: that of the file. Only the lines that are needed
  /// are decoded.
  std::size_t width = 0, height = 0;
  raster::nearest_rule rule = raster::nearest_rule::centre;
};

/// Reads a depth map from an OpenEXR file.
///
/// The channel: the one that is named; else `*.Depth.Z`, `Z`, `*.V` or `V`, `Y`; else R where R, G
/// and B are equal; else the only one. Channels of a part with a name may be named with it:
/// `part.channel`.
/// The data window is pasted into the display window; pixels outside of it are 0. Background
/// becomes 0: max_depth (Blender's 1e10) and beyond, infinity, and 65504 in half channels. Half
/// channels hold 11 bits, 1.6 cm at 20 m: the warnings say so.
///
/// Throws format_error where the file is damaged, has no such channel, or has what aib does not
/// read (see read_exr_header, read_exr_channel).
depth::depth_map read_exr(const std::filesystem::path& path, const exr_options& options = {});

/// Names of all channels, with the name of their part where it has one.
/// Throws format_error where the header is damaged.
std::vector<std::string> exr_channel_names(const std::filesystem::path& path);

struct exr_write_options {
  std::string channel = "Z";
  exr_compression compression = exr_compression::zip;  ///< none, zips or zip
};

/// Writes one float channel as scan lines. Throws argument_error for an empty image or another
/// compression, io_error where the file cannot be written.
void write_exr(const std::filesystem::path& path,
               raster::view<const float> depth,
               const exr_write_options& options = {});

namespace detail {

struct exr_choice {
  std::size_t part;
  std::size_t channel;
  bool is_gray = false;  ///< R, of which G and B must be copies
};

/// Finds the channel that holds depth.
class exr_chooser {
 public:
  exr_chooser(const exr_header& header, const std::filesystem::path& path) : path_(path) {
    for (std::size_t p = 0; p < header.parts.size(); ++p) {
      const exr_part& part = header.parts[p];
      for (std::size_t c = 0; c < part.channels.size(); ++c) {
        const std::string& plain = part.channels[c].name;
        candidates_.push_back({plain, part.name.empty() ? plain : part.name + "." + plain, {p, c}});
      }
    }
  }

  exr_choice choose(std::string_view wanted) const {
    if (!wanted.empty()) return named(wanted);
    const auto full = [](std::string_view end) {
      return [=](const candidate& c) { return has_last(c.full, end); };
    };
    const auto plain = [](std::string_view name) {
      return [=](const candidate& c) { return c.plain == name; };
    };
    if (const auto found = first(full("Depth.Z"))) return *found;
    if (const auto found = first(plain("Z"))) return *found;
    if (const auto found = first(full("V"))) return *found;
    if (const auto found = first(plain("Y"))) return *found;
    if (candidates_.size() == 1) return candidates_[0].place;
    const auto r = first(plain("R")), g = first(plain("G")), b = first(plain("B"));
    if (r && g && b && r->part == g->part && r->part == b->part) return {r->part, r->channel, true};
    throw format_error(path_, message("exr: no channel looks like depth; name one of ", names()));
  }

  std::string names() const {
    std::string list;
    for (std::size_t i = 0; i < candidates_.size() && i < 20; ++i)
      list += (i == 0 ? "" : ", ") + candidates_[i].full;
    return candidates_.size() > 20 ? list + ", ..." : list;
  }

 private:
  struct candidate {
    std::string plain;
    std::string full;  ///< with the name of its part
    exr_choice place;
  };

  /// Whether the name is `end` or its last layer is: "a.Depth.Z" has the last "Depth.Z".
  static bool has_last(std::string_view name, std::string_view end) {
    return name == end || (name.size() > end.size() && name.ends_with(end) &&
                           name[name.size() - end.size() - 1] == '.');
  }

  template <class Predicate>
  std::optional<exr_choice> first(Predicate predicate) const {
    const auto found = std::find_if(candidates_.begin(), candidates_.end(), predicate);
    return found == candidates_.end() ? std::nullopt : std::optional(found->place);
  }

  exr_choice named(std::string_view wanted) const {
    if (const auto found = first([&](const candidate& c) { return c.full == wanted; }))
      return *found;
    if (const auto found = first([&](const candidate& c) { return c.plain == wanted; }))
      return *found;
    throw format_error(path_, message("exr: no channel \"", wanted, "\"; there are ", names()));
  }

  const std::filesystem::path& path_;
  std::vector<candidate> candidates_;
};

/// Source line in the data window for each target line; lines outside of it have none.
struct exr_rows {
  std::vector<std::size_t> lines;   ///< wanted lines of the data window, ascending
  std::vector<std::size_t> target;  ///< the target line of each
};

inline exr_rows needed_rows(const exr_part& part, std::size_t height, raster::nearest_rule rule) {
  exr_rows rows;
  for (std::size_t y = 0; y < height; ++y) {
    const auto line =
        static_cast<std::int64_t>(raster::nearest_index(y, part.display.height(), height, rule)) +
        part.display.min_y - part.data.min_y;
    if (line < 0 || line >= static_cast<std::int64_t>(part.data.height())) continue;
    rows.lines.push_back(static_cast<std::size_t>(line));
    rows.target.push_back(y);
  }
  return rows;
}

/// A channel within its display window at the size that is asked for.
inline raster::image<float> read_exr_picture(const input_file& file,
                                             const exr_header& header,
                                             const exr_choice& choice,
                                             const exr_options& options) {
  const exr_part& part = header.parts[choice.part];
  const std::size_t full_width = part.display.width(), full_height = part.display.height();
  const std::size_t width = options.width ? options.width : full_width;
  const std::size_t height = options.height ? options.height : full_height;
  if (part.data == part.display && width == full_width && height == full_height)
    return read_exr_channel(file, header, choice.part, choice.channel);

  raster::image<float> result(width, height);
  const exr_rows rows = needed_rows(part, height, options.rule);
  if (rows.lines.empty()) return result;
  const auto source = read_exr_channel(file, header, choice.part, choice.channel, rows.lines);
  for (std::size_t x = 0; x < width; ++x) {
    const auto column =
        static_cast<std::int64_t>(raster::nearest_index(x, full_width, width, options.rule)) +
        part.display.min_x - part.data.min_x;
    if (column < 0 || column >= static_cast<std::int64_t>(source.width())) continue;
    for (std::size_t i = 0; i < rows.target.size(); ++i)
      result(x, rows.target[i]) = source(static_cast<std::size_t>(column), i);
  }
  return result;
}

/// Sets pixels of `from` and beyond to 0 and counts them.
inline std::size_t clear_background(raster::image<float>& image, float from) {
  std::size_t n = 0;
  for (float& depth : image) {
    const bool background = depth >= from;
    n += background ? 1u : 0u;
    depth = background ? 0.0f : depth;
  }
  return n;
}

}  // namespace detail

inline std::vector<std::string> exr_channel_names(const std::filesystem::path& path) {
  std::vector<std::string> names;
  for (const exr_part& part : read_exr_header(input_file(path)).parts) {
    for (const exr_channel_info& channel : part.channels)
      names.push_back(part.name.empty() ? channel.name : part.name + "." + channel.name);
  }
  return names;
}

inline depth::depth_map read_exr(const std::filesystem::path& path, const exr_options& options) {
  const input_file file(path);
  const exr_header header = read_exr_header(file);
  const detail::exr_chooser chooser(header, path);
  const detail::exr_choice choice = chooser.choose(options.channel);
  const exr_part& part = header.parts[choice.part];
  const exr_channel_info& channel = part.channels[choice.channel];

  depth::depth_map result{detail::read_exr_picture(file, header, choice, options)};
  if (choice.is_gray) {
    for (const char* other : {"G", "B"}) {
      auto same = options;
      same.channel = other;
      if (detail::read_exr_picture(file, header, chooser.choose(other), same) != result.values)
        throw format_error(path, message("exr: R, G and B differ, this is no depth; name one of ",
                                         chooser.names()));
    }
  }
  const bool is_half = channel.type == exr_pixel::half;
  const double limit = is_half ? std::min(options.max_depth, 65504.0) : options.max_depth;
  const std::size_t n = detail::clear_background(result.values, static_cast<float>(limit));
  if (n > 0) {
    result.warnings.push_back(
        message(n, " of ", result.values.size(), " pixels are background (depth >= ", limit, ")"));
  }
  if (is_half) {
    result.warnings.push_back(
        message("channel ", channel.name, " is half: 11 bits, 1.6 cm at a depth of 20 m"));
  }
  if (part.data != part.display)
    result.warnings.push_back("the data window is not the display window; it was pasted");
  return result;
}

namespace detail {

/// Header and blocks of a file with one float channel.
class exr_writer {
 public:
  exr_writer(raster::view<const float> depth, const exr_write_options& options)
      : depth_(depth), options_(options) {}

  std::string bytes() {
    write_header();
    const std::size_t lines = block_lines(options_.compression);
    const std::size_t n_blocks = (depth_.height + lines - 1) / lines;
    const std::size_t table = out_.size();
    out_.resize(table + 8 * n_blocks);
    for (std::size_t i = 0; i < n_blocks; ++i) {
      std::string offset;
      store(offset, static_cast<std::uint64_t>(out_.size()));
      out_.replace(table + 8 * i, 8, offset);
      write_block(i * lines, std::min(lines, depth_.height - i * lines));
    }
    return std::move(out_);
  }

 private:
  void write_header() {
    const auto w = static_cast<std::int32_t>(depth_.width - 1);
    const auto h = static_cast<std::int32_t>(depth_.height - 1);
    store(out_, std::uint32_t{20000630});
    store(out_, std::uint32_t{2});
    attribute("channels", "chlist", channel_list());
    attribute("compression", "compression",
              std::string(1, static_cast<char>(options_.compression)));
    const std::string window = numbers<std::int32_t>({0, 0, w, h});
    attribute("dataWindow", "box2i", window);
    attribute("displayWindow", "box2i", window);
    attribute("lineOrder", "lineOrder", std::string(1, '\0'));
    attribute("pixelAspectRatio", "float", numbers({1.0f}));
    attribute("screenWindowCenter", "v2f", numbers({0.0f, 0.0f}));
    attribute("screenWindowWidth", "float", numbers({1.0f}));
    out_ += '\0';
  }

  std::string channel_list() const {
    std::string list = options_.channel + '\0';
    list += numbers<std::int32_t>({static_cast<std::int32_t>(exr_pixel::float32), 0, 1, 1});
    return list + '\0';
  }

  template <class T>
  static std::string numbers(std::initializer_list<T> values) {
    std::string bytes;
    for (const T v : values) store(bytes, v);
    return bytes;
  }

  void attribute(std::string_view name, std::string_view type, const std::string& value) {
    out_.append(name) += '\0';
    out_.append(type) += '\0';
    store(out_, static_cast<std::int32_t>(value.size()));
    out_ += value;
  }

  void write_block(std::size_t y, std::size_t n) {
    raw_.clear();
    for (std::size_t i = 0; i < n; ++i)
      for (const float depth : depth_.row(y + i)) store(raw_, depth);
    std::string_view block = raw_;
    if (options_.compression != exr_compression::none && compress_raw()) block = packed_;
    store(out_, static_cast<std::int32_t>(y));
    store(out_, static_cast<std::int32_t>(block.size()));
    out_ += block;
  }

  /// Whether the block became smaller.
  bool compress_raw() {
    std::vector<std::uint8_t> differences(raw_.size());
    take_differences(reinterpret_cast<const std::uint8_t*>(raw_.data()), differences.data(),
                     raw_.size());
    uLongf size = compressBound(static_cast<uLong>(raw_.size()));
    packed_.resize(size);
    const int code = compress2(reinterpret_cast<Bytef*>(packed_.data()), &size, differences.data(),
                               static_cast<uLong>(raw_.size()), 4);
    packed_.resize(code == Z_OK ? size : 0);
    return code == Z_OK && packed_.size() < raw_.size();
  }

  raster::view<const float> depth_;
  const exr_write_options& options_;
  std::string out_;
  std::string raw_;
  std::string packed_;
};

}  // namespace detail

inline void write_exr(const std::filesystem::path& path,
                      raster::view<const float> depth,
                      const exr_write_options& options) {
  if (depth.empty() || depth.size() > exr_max_pixels)
    throw argument_error(message("io::write_exr: an image of ", depth.width, "x", depth.height));
  if (options.compression != exr_compression::none &&
      options.compression != exr_compression::zips && options.compression != exr_compression::zip)
    throw argument_error("io::write_exr: compression none, zips or zip expected");
  if (options.channel.empty() || options.channel.size() > 31)
    throw argument_error("io::write_exr: a channel name of 1 to 31 characters expected");
  write_file(path, detail::exr_writer(depth, options).bytes());
}

}  // namespace aib::io
#endif

// aib/io/png.hpp

#if defined(AIB_WITH_PNG)
#include <spng.h>

namespace aib::io {

/// What the header of a PNG file says.
struct png_header {
  std::size_t width = 0, height = 0;
  int bits = 0;  ///< of a channel
  bool is_gray = false, has_palette = false, has_alpha = false;
};

/// Needs libspng. All PNG functions throw format_error where a file is damaged, is larger than 2^27
/// pixels, or has not the pixels that are asked for.
png_header read_png_header(const std::filesystem::path& path);

/// The stored numbers of a gray PNG of 1 to 16 bits, or the indices of a palette: labels, or depth
/// of 16 bits. Refuses colours and transparency.
raster::image<std::uint16_t> read_png_gray(const std::filesystem::path& path);

/// Any PNG as 8-bit red, green, blue; transparency is dropped.
raster::color_image read_png_color(const std::filesystem::path& path);

/// Any PNG as 8-bit red, green, blue, alpha.
raster::image<std::array<std::uint8_t, 4>> read_png_rgba(const std::filesystem::path& path);

/// Writes gray (8 or 16 bits), rgb or rgba pixels, whichever the type is. Throws argument_error for
/// an empty image, io_error where the file cannot be written.
template <class Pixel>
void write_png(const std::filesystem::path& path, raster::view<const Pixel> image);

namespace detail {

struct free_spng {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};

/// An opened PNG file: header checked, pixels not yet read.
class png_decoder {
 public:
  explicit png_decoder(const std::filesystem::path& path)
      : path_(path), bytes_(read_file(path)), context_(spng_ctx_new(0)) {
    constexpr std::uint32_t max_side = 1u << 20;
    constexpr std::size_t max_chunk = std::size_t{1} << 26;
    if (!context_) fail("no memory");
    check(spng_set_image_limits(context_.get(), max_side, max_side));
    check(spng_set_chunk_limits(context_.get(), max_chunk, max_chunk));
    check(spng_set_png_buffer(context_.get(), bytes_.data(), bytes_.size()));
    check(spng_get_ihdr(context_.get(), &ihdr_));
    // Deflate expands at most 1032 times: more pixels than that were never in the file.
    const std::uint64_t pixels = std::uint64_t{ihdr_.width} * ihdr_.height;
    if (pixels > std::uint64_t{1} << 27 || pixels / 8 > 1100 * bytes_.size())
      fail(message(ihdr_.width, "x", ihdr_.height, " pixels in a file of ", bytes_.size(),
                   " bytes"));
  }

  [[nodiscard]] png_header header() const {
    const bool gray = ihdr_.color_type == SPNG_COLOR_TYPE_GRAYSCALE ||
                      ihdr_.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA;
    const bool alpha = ihdr_.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA ||
                       ihdr_.color_type == SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
    return {ihdr_.width,
            ihdr_.height,
            ihdr_.bit_depth,
            gray,
            ihdr_.color_type == SPNG_COLOR_TYPE_INDEXED,
            alpha};
  }

  /// Decodes into n bytes, which must be what the format takes.
  void decode(spng_format format, void* to, std::size_t n) {
    std::size_t needed = 0;
    check(spng_decoded_image_size(context_.get(), format, &needed));
    if (needed != n) fail("an unexpected size");
    check(spng_decode_image(context_.get(), to, n, format, 0));
  }

  [[nodiscard]] std::size_t decoded_size(spng_format format) {
    std::size_t needed = 0;
    check(spng_decoded_image_size(context_.get(), format, &needed));
    return needed;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, message("png: ", what));
  }

 private:
  void check(int code) const {
    if (code != 0) fail(spng_strerror(code));
  }

  std::filesystem::path path_;
  std::string bytes_;
  std::unique_ptr<spng_ctx, free_spng> context_;
  spng_ihdr ihdr_ = {};
};

/// Samples of 1, 2, 4, 8 or 16 bits, the first in the highest bits, each row from a whole byte on.
inline raster::image<std::uint16_t> unpack_samples(const std::vector<std::uint8_t>& packed,
                                                   const png_header& header) {
  raster::image<std::uint16_t> image(header.width, header.height);
  const std::size_t bits = static_cast<std::size_t>(header.bits);
  const std::size_t row_bytes = (header.width * bits + 7) / 8;
  for (std::size_t y = 0; y < header.height; ++y) {
    const std::uint8_t* row = packed.data() + y * row_bytes;
    for (std::size_t x = 0; x < header.width; ++x) {
      const std::size_t bit = x * bits;
      image(x, y) =
          static_cast<std::uint16_t>((row[bit / 8] >> (8 - bits - bit % 8)) & ((1u << bits) - 1));
    }
  }
  return image;
}

template <class Pixel>
constexpr int png_color_type() {
  if constexpr (std::is_integral_v<Pixel>)
    return SPNG_COLOR_TYPE_GRAYSCALE;
  else if constexpr (std::tuple_size_v<Pixel> == 3)
    return SPNG_COLOR_TYPE_TRUECOLOR;
  else
    return SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
}

}  // namespace detail

inline png_header read_png_header(const std::filesystem::path& path) {
  return detail::png_decoder(path).header();
}

inline raster::image<std::uint16_t> read_png_gray(const std::filesystem::path& path) {
  detail::png_decoder decoder(path);
  const png_header header = decoder.header();
  if (!(header.is_gray || header.has_palette) || header.has_alpha)
    decoder.fail("gray pixels without transparency expected, found colours or transparency");
  if (header.bits == 16) {
    raster::image<std::uint16_t> image(header.width, header.height);
    decoder.decode(SPNG_FMT_PNG, image.data(), 2 * image.size());
    return image;
  }
  std::vector<std::uint8_t> packed(decoder.decoded_size(SPNG_FMT_PNG));
  decoder.decode(SPNG_FMT_PNG, packed.data(), packed.size());
  return detail::unpack_samples(packed, header);
}

inline raster::color_image read_png_color(const std::filesystem::path& path) {
  detail::png_decoder decoder(path);
  raster::color_image image(decoder.header().width, decoder.header().height);
  decoder.decode(SPNG_FMT_RGB8, image.data(), 3 * image.size());
  return image;
}

inline raster::image<std::array<std::uint8_t, 4>> read_png_rgba(const std::filesystem::path& path) {
  detail::png_decoder decoder(path);
  raster::image<std::array<std::uint8_t, 4>> image(decoder.header().width, decoder.header().height);
  decoder.decode(SPNG_FMT_RGBA8, image.data(), 4 * image.size());
  return image;
}

template <class Pixel>
void write_png(const std::filesystem::path& path, raster::view<const Pixel> image) {
  if (image.empty()) throw argument_error("io::write_png: an empty image");
  std::vector<Pixel> pixels;
  pixels.reserve(image.size());
  for (std::size_t y = 0; y < image.height; ++y)
    pixels.insert(pixels.end(), image.row(y).begin(), image.row(y).end());

  const std::unique_ptr<spng_ctx, detail::free_spng> context(spng_ctx_new(SPNG_CTX_ENCODER));
  spng_ihdr ihdr = {};
  ihdr.width = static_cast<std::uint32_t>(image.width);
  ihdr.height = static_cast<std::uint32_t>(image.height);
  ihdr.bit_depth = std::is_same_v<Pixel, std::uint16_t> ? 16 : 8;
  ihdr.color_type = static_cast<std::uint8_t>(detail::png_color_type<Pixel>());
  std::size_t n = 0;
  int code = context ? 0 : 1;
  if (code == 0) code = spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
  if (code == 0) code = spng_set_ihdr(context.get(), &ihdr);
  if (code == 0)
    code = spng_encode_image(context.get(), pixels.data(), pixels.size() * sizeof(Pixel),
                             SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
  const std::unique_ptr<void, decltype(&std::free)> bytes(
      code == 0 ? spng_get_png_buffer(context.get(), &n, &code) : nullptr, &std::free);
  if (code != 0 || !bytes) throw argument_error(message("io::write_png: ", spng_strerror(code)));
  write_file(path, {static_cast<const char*>(bytes.get()), n});
}

}  // namespace aib::io
#endif

// aib/io/depth.hpp

#if defined(AIB_WITH_EXR)
#endif
#if defined(AIB_WITH_PNG)
#endif

namespace aib::io {

struct depth_options {
  std::string channel = {};               ///< EXR: name of the channel; empty: see read_exr
  std::string key = {};                   ///< NPZ: name of the array; empty: see read_array_frames
  std::optional<std::size_t> index = {};  ///< NPY, NPZ of several frames: which one
  /// Stored value of one unit of length: 1000 for millimetres, TUM 5000, KITTI 256.
  /// 0: 1000 for PNG, 1 for all others.
  double scale = 0;
  double max_depth = std::numeric_limits<double>::infinity();  ///< this and beyond becomes 0
  std::size_t width = 0, height = 0;  ///< size of the result by nearest neighbour; 0: the file's
  raster::nearest_rule rule = raster::nearest_rule::centre;
  std::size_t raw_width = 0, raw_height = 0;      ///< files without header (ETH3D): their size
  std::optional<math::camera> range_camera = {};  ///< the file holds distances along its rays
};

/// Reads a depth map; the format is told from the content, then from the extension: EXR, PFM, NPY,
/// NPZ, 16-bit PNG, COLMAP .bin, OpenMVS .dmap, and headerless floats where their size is given.
/// Planar depth; pixels without depth are 0 or not finite. What was removed, assumed or is in doubt
/// stands in the warnings.
///
/// Throws format_error where the format is not known or the file is damaged, io_error where it
/// cannot be read, argument_error where an option has no meaning.
depth::depth_map read_depth(const std::filesystem::path& path, const depth_options& options = {});

/// Reads all frames of an NPY or NPZ array; of any other file the one that it has.
/// Throws as read_depth does.
std::vector<depth::depth_map> read_depth_stack(const std::filesystem::path& path,
                                               const depth_options& options = {});

struct depth_write_options {
  double scale = 1000;  ///< PNG: stored value of one unit of length
};

/// Writes a depth map in the format of the extension: .exr (float, ZIP), .pfm, .npy (float, H x W),
/// .png (16 bits; what is not finite, not positive or beyond 65535 becomes 0).
/// Throws argument_error for another extension.
void write_depth(const std::filesystem::path& path,
                 raster::view<const float> depth,
                 const depth_write_options& options = {});

namespace detail {

inline depth::depth_map read_depth_array(const std::filesystem::path& path,
                                         const depth_options& options) {
  const array_frames frames = read_array_frames(path, options.key);
  if (!options.index && frames.size() > 1)
    throw argument_error(message(path.string(), ": ", frames.size(),
                                 " frames in the array; the option index says which to read"));
  return {frames.frame(options.index.value_or(0))};
}

inline depth::depth_map read_exr_depth(const std::filesystem::path& path,
                                       const depth_options& options) {
#if defined(AIB_WITH_EXR)
  // Rays need all pixels at their places; else lines that nobody asks for are not decoded.
  const bool shrink = !options.range_camera;
  return read_exr(path, {.channel = options.channel,
                         .width = shrink ? options.width : 0,
                         .height = shrink ? options.height : 0,
                         .rule = options.rule});
#else
  static_cast<void>(options);
  throw format_error(path, "this build of aib reads no EXR; build it with zlib");
#endif
}

inline depth::depth_map read_png_depth(const std::filesystem::path& path,
                                       const depth_options& options) {
#if defined(AIB_WITH_PNG)
  const png_header header = read_png_header(path);
  if (header.bits != 16 || !header.is_gray)
    throw format_error(path,
                       "png: gray depth of 16 bits expected; 8 bits or colours are a picture "
                       "of depth, not depth");
  const auto stored = read_png_gray(path);
  depth::depth_map result{raster::image<float>(stored.width(), stored.height())};
  std::copy(stored.begin(), stored.end(), result.values.begin());
  if (options.scale == 0)
    result.warnings.push_back("1000 steps a unit were assumed; the option scale says otherwise");
  return result;
#else
  static_cast<void>(options);
  throw format_error(path, "this build of aib reads no PNG; build it with libspng");
#endif
}

inline depth::depth_map read_stored_depth(const std::filesystem::path& path,
                                          file_kind kind,
                                          const depth_options& options) {
  if (options.raw_width > 0 && options.raw_height > 0)
    return read_raw_depth(path, options.raw_width, options.raw_height);
  switch (kind) {
    case file_kind::colmap_map:
      return read_colmap_depth(path);
    case file_kind::dmap:
      return read_dmap(path);
    case file_kind::exr:
      return read_exr_depth(path, options);
    case file_kind::npy:
    case file_kind::npz:
      return read_depth_array(path, options);
    case file_kind::pfm:
      return read_pfm(path);
    case file_kind::png:
      return read_png_depth(path, options);
    default:
      throw format_error(path,
                         "a depth map expected: EXR, PFM, NPY, NPZ, 16-bit PNG, COLMAP .bin, "
                         ".dmap, or floats without header whose size is given");
  }
}

inline void clear_from(depth::depth_map& map, double max_depth) {
  std::size_t n = 0;
  for (float& depth : map.values) {
    if (!(static_cast<double>(depth) >= max_depth)) continue;
    depth = 0;
    ++n;
  }
  if (n > 0) {
    map.warnings.push_back(message(n, " of ", map.values.size(), " pixels are at max_depth ",
                                   max_depth, " or beyond"));
  }
}

/// Stored values to depth of the wanted size.
inline depth::depth_map finish_depth(depth::depth_map map,
                                     file_kind kind,
                                     const depth_options& options) {
  const double usual = kind == file_kind::png ? 1000 : 1;
  const double scale = options.scale > 0 ? options.scale : usual;
  if (scale != 1)
    for (float& depth : map.values) depth = static_cast<float>(static_cast<double>(depth) / scale);
  if (options.range_camera) planar_from_range(map.values, *options.range_camera);
  if (options.max_depth < std::numeric_limits<double>::infinity())
    clear_from(map, options.max_depth);
  const std::size_t width = options.width ? options.width : map.values.width();
  const std::size_t height = options.height ? options.height : map.values.height();
  if (width != map.values.width() || height != map.values.height())
    map.values = raster::resample_nearest<float>(map.values, width, height, options.rule);
  return map;
}

inline void check_depth_options(const depth_options& options) {
  if (!(options.scale >= 0) || !(options.max_depth > 0))
    throw argument_error("io::read_depth: scale >= 0 and max_depth > 0 expected");
}

inline raster::image<std::uint16_t> depth_steps(raster::view<const float> depth, double scale) {
  raster::image<std::uint16_t> steps(depth.width, depth.height);
  for (std::size_t y = 0; y < depth.height; ++y) {
    for (std::size_t x = 0; x < depth.width; ++x) {
      const double step = std::round(static_cast<double>(depth(x, y)) * scale);
      steps(x, y) = step > 0 && step <= 65535 ? static_cast<std::uint16_t>(step) : std::uint16_t{0};
    }
  }
  return steps;
}

}  // namespace detail

inline depth::depth_map read_depth(const std::filesystem::path& path,
                                   const depth_options& options) {
  detail::check_depth_options(options);
  const file_kind kind = kind_of(path);
  return detail::finish_depth(detail::read_stored_depth(path, kind, options), kind, options);
}

inline std::vector<depth::depth_map> read_depth_stack(const std::filesystem::path& path,
                                                      const depth_options& options) {
  detail::check_depth_options(options);
  const file_kind kind = kind_of(path);
  std::vector<depth::depth_map> stack;
  if (kind != file_kind::npy && kind != file_kind::npz) {
    stack.push_back(read_depth(path, options));
    return stack;
  }
  const array_frames frames = read_array_frames(path, options.key);
  for (std::size_t i = 0; i < frames.size(); ++i)
    stack.push_back(detail::finish_depth({frames.frame(i)}, kind, options));
  return stack;
}

inline void write_depth(const std::filesystem::path& path,
                        raster::view<const float> depth,
                        const depth_write_options& options) {
  const std::string extension = extension_of(path);
  if (depth.empty()) throw argument_error("io::write_depth: an empty depth map");
  if (extension == ".pfm") return write_pfm(path, depth);
  if (extension == ".npy") {
    std::vector<float> values;
    for (std::size_t y = 0; y < depth.height; ++y)
      values.insert(values.end(), depth.row(y).begin(), depth.row(y).end());
    return write_npy(path, make_array<float>({depth.height, depth.width}, values));
  }
#if defined(AIB_WITH_EXR)
  if (extension == ".exr") return write_exr(path, depth);
#endif
#if defined(AIB_WITH_PNG)
  if (extension == ".png")
    return write_png<std::uint16_t>(path, detail::depth_steps(depth, options.scale));
#else
  static_cast<void>(options);
#endif
  throw argument_error(
      message("io::write_depth: the extension .exr, .pfm, .npy or .png expected, "
              "found \"",
              path.extension().string(), "\""));
}

}  // namespace aib::io

// aib/io/jpeg.hpp

#if defined(AIB_WITH_JPEG)
#include <jpeglib.h>

namespace aib::io {

namespace detail {

/// libjpeg reports an error by a call that must not return: it jumps back into `run`.
class jpeg_decoder {
 public:
  explicit jpeg_decoder(const std::string& bytes) {
    info_.err = jpeg_std_error(&errors_.base);
    errors_.base.error_exit = [](j_common_ptr info) {
      auto* errors = reinterpret_cast<error_manager*>(info->err);
      info->err->format_message(info, errors->text);
      std::longjmp(errors->back, 1);
    };
    errors_.base.output_message = [](j_common_ptr) {};
    jpeg_create_decompress(&info_);
    bytes_ = reinterpret_cast<const unsigned char*>(bytes.data());
    n_bytes_ = bytes.size();
  }
  ~jpeg_decoder() { jpeg_destroy_decompress(&info_); }
  jpeg_decoder(const jpeg_decoder&) = delete;
  jpeg_decoder& operator=(const jpeg_decoder&) = delete;

  /// False where libjpeg gave up; `error` says why.
  bool read_header() {
    // Nothing with a destructor lives on this frame: longjmp would not run it.
    if (setjmp(errors_.back) != 0) return false;
    jpeg_mem_src(&info_, bytes_, n_bytes_);
    jpeg_read_header(&info_, TRUE);
    info_.out_color_space = JCS_RGB;
    return true;
  }

  bool read_pixels(unsigned char* to) {
    if (setjmp(errors_.back) != 0) return false;
    jpeg_start_decompress(&info_);
    while (info_.output_scanline < info_.output_height) {
      JSAMPROW row = to + std::size_t{3} * info_.output_width * info_.output_scanline;
      jpeg_read_scanlines(&info_, &row, 1);
    }
    jpeg_finish_decompress(&info_);
    return errors_.base.num_warnings == 0;
  }

  [[nodiscard]] std::size_t width() const { return info_.image_width; }
  [[nodiscard]] std::size_t height() const { return info_.image_height; }
  [[nodiscard]] const char* error() const {
    return errors_.text[0] != '\0' ? errors_.text : "damaged pixels";
  }

 private:
  struct error_manager {
    jpeg_error_mgr base;
    std::jmp_buf back;
    char text[JMSG_LENGTH_MAX] = {};
  };
  jpeg_decompress_struct info_ = {};
  error_manager errors_ = {};
  const unsigned char* bytes_ = nullptr;
  std::size_t n_bytes_ = 0;
};

}  // namespace detail

/// Reads a JPEG as 8-bit red, green, blue. Needs libjpeg (libjpeg-turbo).
/// Throws format_error where the file is damaged or larger than 2^27 pixels.
inline raster::color_image read_jpeg(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  detail::jpeg_decoder decoder(bytes);
  if (!decoder.read_header()) throw format_error(path, message("jpeg: ", decoder.error()));
  if (decoder.width() * decoder.height() > std::size_t{1} << 27)
    throw format_error(path, message("jpeg: ", decoder.width(), "x", decoder.height(), " pixels"));
  raster::color_image image(decoder.width(), decoder.height());
  if (!decoder.read_pixels(image.data()->data()))
    throw format_error(path, message("jpeg: ", decoder.error()));
  return image;
}

}  // namespace aib::io
#endif

// aib/io/image.hpp

#if defined(AIB_WITH_PNG)
#endif
#if defined(AIB_WITH_JPEG)
#endif

namespace aib::io {

/// Whether an image file holds one number a pixel (gray, or a palette) and no transparency, so that
/// read_labels reads it. Throws as read_image does.
inline bool is_label_image(const std::filesystem::path& path) {
#if defined(AIB_WITH_PNG)
  if (kind_of(path) == file_kind::png) {
    const png_header header = read_png_header(path);
    return header.is_gray && !header.has_alpha;
  }
#endif
  static_cast<void>(path);
  return false;
}

/// Reads a picture, PNG or JPEG, as 8-bit colours. Transparency is dropped.
/// Throws format_error where the file is damaged or no picture that this build reads.
inline raster::color_image read_image(const std::filesystem::path& path) {
  switch (kind_of(path)) {
    case file_kind::png:
#if defined(AIB_WITH_PNG)
      return read_png_color(path);
#else
      throw format_error(path, "this build of aib reads no PNG; build it with libspng");
#endif
    case file_kind::jpeg:
#if defined(AIB_WITH_JPEG)
      return read_jpeg(path);
#else
      throw format_error(path, "this build of aib reads no JPEG; build it with libjpeg");
#endif
    default:
      throw format_error(path, "an image expected: PNG or JPEG");
  }
}

/// Reads masks and labels: the stored numbers of a gray PNG of 1 to 16 bits or of a palette.
/// Throws format_error for colours, and where the file is damaged.
inline raster::label_image read_labels(const std::filesystem::path& path) {
#if defined(AIB_WITH_PNG)
  if (kind_of(path) == file_kind::png) return read_png_gray(path);
#endif
  throw format_error(path, "a gray PNG or one with a palette expected");
}

/// Writes gray (8 or 16 bits), rgb or rgba pixels as PNG. Throws argument_error for another
/// extension or an empty image.
template <class Pixel>
void write_image(const std::filesystem::path& path, raster::view<const Pixel> image) {
#if defined(AIB_WITH_PNG)
  if (extension_of(path) == ".png") return write_png(path, image);
#endif
  static_cast<void>(image);
  throw argument_error(message("io::write_image: the extension .png expected, found \"",
                               path.extension().string(), "\""));
}

}  // namespace aib::io

// aib/io/depth_frame.hpp

namespace aib::io {

/// The files of a frame; an empty path: there is none.
struct depth_frame_files {
  std::string name;
  std::filesystem::path estimate;
  std::filesystem::path reference;
  std::filesystem::path mask = {};    ///< gray PNG, 0 leaves a pixel out
  std::filesystem::path labels = {};  ///< gray or indexed PNG
};

struct depth_frame_options {
  depth_options estimate = {};
  depth_options reference = {};  ///< its size and rule are not used
  raster::nearest_rule rule = raster::nearest_rule::centre;
};

/// Reads a frame for depth::accumulate, from any thread. Reference, mask and labels are brought to
/// the size of the estimate by nearest neighbour, never the other way: of an EXR file by lines the
/// lines in between are not even decoded.
///
///   depth::accumulate(files.size(), {}, [&](auto i) { return io::read_depth_frame(files[i]); });
///
/// Throws as read_depth and read_labels do.
[[nodiscard]] inline depth::frame read_depth_frame(const depth_frame_files& files,
                                                   const depth_frame_options& options = {}) {
  depth::frame frame{.name = files.name,
                     .estimate = read_depth(files.estimate, options.estimate),
                     .reference = {}};
  const std::size_t width = frame.estimate.values.width(), height = frame.estimate.values.height();
  depth_options of_reference = options.reference;
  of_reference.width = width;
  of_reference.height = height;
  of_reference.rule = options.rule;
  frame.reference = read_depth(files.reference, of_reference);
  const auto at_size = [&](const std::filesystem::path& path) {
    return raster::resample_nearest<std::uint16_t>(read_labels(path), width, height, options.rule);
  };
  if (!files.mask.empty()) frame.mask = raster::mask_of(at_size(files.mask));
  if (!files.labels.empty()) frame.labels = at_size(files.labels);
  return frame;
}

}  // namespace aib::io

// aib/io/euroc.hpp

namespace aib::io {

/// Poses of a EuRoC MAV csv file (state_groundtruth_estimate0/data.csv, vicon0/data.csv, or a
/// pose file of its kind): `stamp [ns], x, y, z, qw, qx, qy, qz` and columns that are not read.
///
/// The poses are those of the body that the file is about (IMU or marker), world_from_body: apply
/// the camera's calibration where cameras are compared. Stamps become seconds.
/// Throws format_error for a line with fewer than 8 numbers, a stamp that is no number of
/// nanoseconds, a zero quaternion and a file without a pose.
/// Source: Burri et al., "The EuRoC micro aerial vehicle datasets", IJRR 2016.
[[nodiscard]] inline pose::trajectory read_euroc(const std::filesystem::path& path,
                                                 const pose_frame& frame = {}) {
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  const std::string text = read_file(path);
  number_lines lines(text, path, "euroc");
  pose::trajectory t;
  while (lines.next()) {
    const std::vector<double>& n = lines.numbers();
    if (n.size() < 8) {
      lines.fail(
          message("at least 8 numbers (stamp x y z qw qx qy qz) expected, found ", n.size()));
    }
    const auto stamp_ns = parse<std::int64_t>(lines.fields().front());
    if (!stamp_ns) {
      lines.fail(
          message("a stamp in whole nanoseconds expected, found '", lines.fields().front(), "'"));
    }
    t.stamps_s.push_back(static_cast<double>(*stamp_ns / ns_per_s) +
                         static_cast<double>(*stamp_ns % ns_per_s) / double{ns_per_s});
    t.world_from_camera.push_back(lines.checked([&] {
      return pose_from_quaternion({n[4], n[5], n[6], n[7]}, {n[1], n[2], n[3]}, frame);
    }));
  }
  return checked_trajectory(std::move(t), path, "euroc");
}

}  // namespace aib::io

// aib/io/fingerprint.hpp

namespace aib::io {

/// SHA-256 of bytes that come in pieces. Source: FIPS 180-4, sections 5 and 6.2.
class sha256 {
 public:
  sha256& add(std::string_view bytes);

  /// The digest of everything added, 64 hexadecimal digits. Nothing can be added after it.
  [[nodiscard]] std::string digest();

 private:
  void compress(const unsigned char* block);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> block_;
  std::size_t filled_ = 0;
  std::uint64_t length_ = 0;
};

/// What tells whether a file is still the same.
struct fingerprint {
  std::uint64_t bytes;
  std::string sha256;
};

/// Size and hash of a file's content. Throws io_error where it cannot be read.
fingerprint fingerprint_of(const std::filesystem::path& path);

namespace detail {

inline constexpr std::array<std::uint32_t, 64> sha256_constants{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

}  // namespace detail

inline sha256& sha256::add(std::string_view bytes) {
  length_ += bytes.size();
  while (!bytes.empty()) {
    const std::size_t n = std::min(bytes.size(), block_.size() - filled_);
    std::memcpy(block_.data() + filled_, bytes.data(), n);
    filled_ += n;
    bytes.remove_prefix(n);
    if (filled_ == block_.size()) {
      compress(block_.data());
      filled_ = 0;
    }
  }
  return *this;
}

inline std::string sha256::digest() {
  const std::uint64_t bits = length_ * 8;
  std::string padding(1 + (119 - filled_) % 64, '\0');
  padding[0] = '\x80';
  for (int shift = 56; shift >= 0; shift -= 8) padding += static_cast<char>(bits >> shift & 0xff);
  add(padding);
  std::string hex;
  for (const std::uint32_t word : state_) {
    for (int shift = 28; shift >= 0; shift -= 4) hex += "0123456789abcdef"[word >> shift & 0xf];
  }
  return hex;
}

inline void sha256::compress(const unsigned char* block) {
  std::array<std::uint32_t, 64> w;
  for (std::size_t i = 0; i < 16; ++i) {
    const unsigned char* b = block + 4 * i;
    w[i] = std::uint32_t{b[0]} << 24 | std::uint32_t{b[1]} << 16 | std::uint32_t{b[2]} << 8 | b[3];
  }
  for (std::size_t i = 16; i < 64; ++i) {
    const auto near = std::rotr(w[i - 2], 17) ^ std::rotr(w[i - 2], 19) ^ w[i - 2] >> 10;
    const auto far = std::rotr(w[i - 15], 7) ^ std::rotr(w[i - 15], 18) ^ w[i - 15] >> 3;
    w[i] = near + w[i - 7] + far + w[i - 16];
  }
  auto [a, b, c, d, e, f, g, h] = state_;
  for (std::size_t i = 0; i < 64; ++i) {
    const auto sum_e = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
    const auto sum_a = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
    const auto first = h + sum_e + ((e & f) ^ (~e & g)) + detail::sha256_constants[i] + w[i];
    const auto second = sum_a + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + first;
    d = c;
    c = b;
    b = a;
    a = first + second;
  }
  const std::array<std::uint32_t, 8> change{a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < 8; ++i) state_[i] += change[i];
}

inline fingerprint fingerprint_of(const std::filesystem::path& path) {
  const input_file file(path);
  sha256 hash;
  std::vector<char> piece(std::size_t{1} << 20);
  for (std::uint64_t at = 0; at < file.size(); at += piece.size()) {
    const auto n =
        static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), file.size() - at));
    file.read_at(at, piece.data(), n);
    hash.add({piece.data(), n});
  }
  return {file.size(), hash.digest()};
}

}  // namespace aib::io

// aib/io/frame_stack.hpp

#if defined(AIB_WITH_NPZ)
#endif

namespace aib::io {

/// The frames of one array of an NPY or NPZ file, read one at a time: depth maps, confidences
/// (H x W each) or point maps (H x W x 3). Memory holds one frame, whatever the file's size. Frames
/// of a deflated member are cheap in their order; going back begins anew.
///
/// The checksum of an NPZ member is not verified, since nobody reads all of it.
class frame_stack {
 public:
  /// key   the array of an NPZ file; empty: as read_array_frames chooses
  /// Throws io_error where the file cannot be opened, format_error where the array is none of N x H
  /// x W (x 1, x 3 for the names of point maps) or is in Fortran order.
  explicit frame_stack(const std::filesystem::path& path, const std::string& key = {});

  [[nodiscard]] std::size_t size() const { return n_; }
  [[nodiscard]] std::size_t height() const { return height_; }
  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] bool is_point_map() const { return components_ == 3; }

  /// Frame i as it is stored. Throws argument_error where there is none.
  [[nodiscard]] array at(std::size_t i);

  /// Frame i as a picture: of a point map its z.
  [[nodiscard]] raster::image<float> frame(std::size_t i);

 private:
  void open_npy(const std::filesystem::path& path);
  void open_npz(const std::filesystem::path& path, const std::string& key);
  void set_shape(const detail::npy_header& header,
                 const std::filesystem::path& path,
                 std::string_view name);

  /// Bytes of the array's file from its first element on.
  class source {
   public:
    source() = default;
    source(const source&) = delete;
    source& operator=(const source&) = delete;
    virtual ~source() = default;
    virtual void read(std::uint64_t offset, std::string& to) = 0;
  };
  class plain_source;
#if defined(AIB_WITH_NPZ)
  class deflated_source;
#endif

  std::unique_ptr<source> source_;
  dtype type_ = dtype::f4;
  bool reversed_ = false;
  std::size_t n_ = 1, height_ = 0, width_ = 0, components_ = 1;
};

namespace detail {

inline bool is_point_map_name(std::string_view name) {
  constexpr std::array<std::string_view, 4> names{"local_points", "points", "world_points",
                                                  "world_points_from_depth"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace detail

/// A part of a file that lies there as it is.
class frame_stack::plain_source : public frame_stack::source {
 public:
  plain_source(const std::filesystem::path& path, std::uint64_t begin)
      : file_(path), begin_(begin) {}
  void read(std::uint64_t offset, std::string& to) override {
    file_.read_at(begin_ + offset, to.data(), to.size());
  }

 private:
  input_file file_;
  std::uint64_t begin_;
};

#if defined(AIB_WITH_NPZ)

/// A deflated part of a file, inflated from its begin on as far as is asked for.
class frame_stack::deflated_source : public frame_stack::source {
 public:
  deflated_source(const std::filesystem::path& path,
                  const npz_place& place,
                  std::uint64_t header_bytes)
      : file_(path), place_(place), header_bytes_(header_bytes) {}

  void read(std::uint64_t offset, std::string& to) override {
    const std::uint64_t wanted = header_bytes_ + offset;
    if (!stream_ || wanted < at_) restart();
    std::string skipped;
    while (at_ < wanted) {
      constexpr std::uint64_t step = std::uint64_t{1} << 20;
      skipped.resize(static_cast<std::size_t>(std::min(step, wanted - at_)));
      fill(skipped);
    }
    fill(to);
  }

 private:
  void restart() {
    stream_ = std::make_unique<detail::deflate_stream>();
    at_ = packed_at_ = 0;
    block_.clear();
  }

  void fill(std::string& to) {
    std::size_t filled = 0;
    while (filled < to.size()) {
      const std::size_t before = filled;
      if (!stream_->fill(to, filled)) fail();
      if (filled == to.size()) break;
      if (packed_at_ == place_.packed) {
        if (filled == before) fail();
        continue;
      }
      constexpr std::uint64_t step = std::uint64_t{1} << 20;
      block_.resize(static_cast<std::size_t>(std::min(step, place_.packed - packed_at_)));
      file_.read_at(place_.begin + packed_at_, block_.data(), block_.size());
      packed_at_ += block_.size();
      stream_->input(block_);
    }
    at_ += to.size();
  }

  [[noreturn]] void fail() const {
    throw format_error(file_.path(), "npz: the deflated data is damaged or cut off");
  }

  input_file file_;
  npz_place place_;
  std::uint64_t header_bytes_;
  std::unique_ptr<detail::deflate_stream> stream_ = {};
  std::string block_ = {};
  std::uint64_t at_ = 0;         ///< of the inflated bytes
  std::uint64_t packed_at_ = 0;  ///< of the deflated ones
};

inline void frame_stack::open_npz(const std::filesystem::path& path, const std::string& key) {
  const npz_file file(path);
  const std::string name = detail::depth_member(file, key);
  const detail::npy_header header = file.npy_header_of(name);
  const npz_place place = file.place_of(name);
  set_shape(header, path, name);
  if (place.is_deflated)
    source_ = std::make_unique<deflated_source>(path, place, header.begin);
  else
    source_ = std::make_unique<plain_source>(path, place.begin + header.begin);
}

#else

inline void frame_stack::open_npz(const std::filesystem::path& path, const std::string&) {
  throw format_error(path, "this build of aib reads no NPZ; build it with zlib");
}

#endif

inline void frame_stack::open_npy(const std::filesystem::path& path) {
  const input_file file(path);
  constexpr std::uint64_t enough = 1 << 16;
  std::string begin(static_cast<std::size_t>(std::min(file.size(), enough)), '\0');
  file.read_at(0, begin.data(), begin.size());
  const detail::npy_header header = detail::read_npy_header(begin, file.size(), path);
  set_shape(header, path, path.stem().string());
  source_ = std::make_unique<plain_source>(path, header.begin);
}

inline frame_stack::frame_stack(const std::filesystem::path& path, const std::string& key) {
  std::string begin(2, '\0');
  {
    const input_file file(path);
    if (file.size() >= begin.size()) file.read_at(0, begin.data(), begin.size());
  }
  if (begin == "PK")
    open_npz(path, key);
  else
    open_npy(path);
}

inline void frame_stack::set_shape(const detail::npy_header& header,
                                   const std::filesystem::path& path,
                                   std::string_view name) {
  std::vector<std::size_t> shape = header.shape;
  if (shape.size() > 2 && shape.back() == 3 && detail::is_point_map_name(name)) {
    components_ = 3;
    shape.pop_back();
  }
  if (shape.size() > 2 && shape.back() == 1) shape.pop_back();
  while (shape.size() > 2 && shape.front() == 1) shape.erase(shape.begin());
  if (shape.size() < 2 || shape.size() > 3 || header.fortran ||
      detail::element_count(shape).value_or(0) == 0) {
    throw format_error(
        path, message("an array of N x H x W in C order expected in ", name, ", found ",
                      text_of_shape(header.shape), header.fortran ? " in Fortran order" : ""));
  }
  type_ = header.type;
  reversed_ = header.order != std::endian::native;
  width_ = shape.back();
  height_ = shape[shape.size() - 2];
  if (shape.size() == 3) n_ = shape.front();
}

inline array frame_stack::at(std::size_t i) {
  if (i >= n_) throw argument_error(message("frame ", i + 1, " of ", n_, " does not exist"));
  array frame{type_, {height_, width_}, {}};
  if (components_ > 1) frame.shape.push_back(components_);
  frame.bytes.resize(height_ * width_ * components_ * size_of(type_));
  source_->read(std::uint64_t{i} * frame.bytes.size(), frame.bytes);
  if (reversed_) detail::reverse_elements(frame.bytes, size_of(type_));
  return frame;
}

inline raster::image<float> frame_stack::frame(std::size_t i) {
  const std::vector<float> values = at(i).values<float>();
  raster::image<float> image(width_, height_);
  for (std::size_t k = 0; k < image.size(); ++k)
    image.data()[k] = values[k * components_ + components_ - 1];
  return image;
}

}  // namespace aib::io

// aib/io/stl.hpp

namespace aib::io {

/// Reads a binary or ascii STL file; which of them is told from the size, since binary files may
/// begin with "solid" too. Corners at the same place become one vertex. Normals are passed over.
///
/// Throws format_error where the file is damaged.
/// Source: 3D Systems, "StereoLithography Interface Specification".
mesh::mesh read_stl(const std::filesystem::path& path);

namespace detail {

/// Numbers equal corners alike: vertices in the order of their first use.
inline mesh::mesh weld(const std::vector<Eigen::Vector3f>& corners) {
  std::vector<std::uint32_t> order(corners.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    std::array<std::uint32_t, 4> k{0, 0, 0, i};  // bits, so that NaN has a place; ties by order
    for (int axis = 0; axis < 3; ++axis)
      k[static_cast<std::size_t>(axis)] = std::bit_cast<std::uint32_t>(corners[i][axis] + 0.0f);
    return k;
  };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
  std::vector<std::uint32_t> first(corners.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto here = key(order[i]);
    const bool same =
        i > 0 && std::equal(here.begin(), here.begin() + 3, key(order[i - 1]).begin());
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  mesh::mesh result;
  std::vector<std::uint32_t> number(corners.size());
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    if (first[i] == i) {
      number[i] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(corners[i]);
    } else {
      number[i] = number[first[i]];
    }
  }
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    result.triangles.push_back({number[i], number[i + 1], number[i + 2]});
  return result;
}

inline std::vector<Eigen::Vector3f> read_binary_stl(const input_file& file) {
  byte_stream in(file);
  in.skip(80, "stl: header");
  const auto n = in.read_number<std::uint32_t>("stl: number of triangles");
  in.demand(std::uint64_t{50} * n, "stl: triangles");
  std::vector<Eigen::Vector3f> corners;
  corners.reserve(std::size_t{3} * n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const char* triangle = in.take(50, "stl: triangle") + 12;
    for (std::size_t k = 0; k < 3; ++k, triangle += 12)
      corners.emplace_back(load<float>(triangle), load<float>(triangle + 4),
                           load<float>(triangle + 8));
  }
  return corners;
}

inline std::vector<Eigen::Vector3f> read_ascii_stl(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  line_reader lines(text, path);
  std::vector<Eigen::Vector3f> corners;
  bool in_facet = false;
  while (lines.next_content()) {
    std::string_view rest = trim(lines.line());
    std::string word(rest.substr(0, rest.find_first_of(" \t")));
    for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    rest.remove_prefix(word.size());
    if (word == "vertex") {
      Eigen::Vector3f corner;
      for (int k = 0; k < 3; ++k) {
        const auto number = take_number(rest);
        if (!number || !in_facet) lines.fail("stl: a vertex of 3 numbers within a facet expected");
        corner[k] = static_cast<float>(*number);
      }
      corners.push_back(corner);
    } else if (word == "facet" || word == "endfacet") {
      if (in_facet == (word == "facet") || corners.size() % 3 != 0)
        lines.fail("stl: facets of 3 vertices expected");
      in_facet = word == "facet";
    } else if (word != "solid" && word != "outer" && word != "endloop" && word != "endsolid") {
      lines.fail(message("stl: facet, outer loop, vertex, endloop or endfacet expected, found \"",
                         word.substr(0, 40), "\""));
    }
  }
  if (in_facet) lines.fail("stl: the file ends within a facet");
  return corners;
}

}  // namespace detail

inline mesh::mesh read_stl(const std::filesystem::path& path) {
  const input_file file(path);
  std::string begin(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 84)), '\0');
  file.read_at(0, begin.data(), begin.size());
  const bool is_ascii = !detail::is_binary_stl(begin, file.size()) &&
                        (begin.starts_with("solid") || begin.starts_with("SOLID"));
  mesh::mesh result =
      detail::weld(is_ascii ? detail::read_ascii_stl(path) : detail::read_binary_stl(file));
  if (result.triangles.empty()) result.warnings.push_back("no triangles");
  if (auto warning = non_finite_warning(result.vertices, "vertices"))
    result.warnings.push_back(std::move(*warning));
  return result;
}

}  // namespace aib::io

// aib/io/mesh.hpp

#if defined(AIB_WITH_JSON)
#endif

namespace aib::io {

struct mesh_options {
  up_axis up = up_axis::z;  ///< axis that points up in the file
};

/// Reads a mesh; the format is told from the content, then from the extension: PLY, OBJ, STL, GLB.
///
/// Throws format_error where the format is not known or the file is damaged, io_error where it
/// cannot be read.
mesh::mesh read_mesh(const std::filesystem::path& path, const mesh_options& options = {});

namespace detail {

inline mesh::mesh read_stored_mesh(const std::filesystem::path& path) {
  switch (kind_of(path)) {
    case file_kind::ply:
      return read_ply_mesh(path);
    case file_kind::obj:
      return read_obj(path);
    case file_kind::stl:
      return read_stl(path);
    case file_kind::glb:
#if defined(AIB_WITH_JSON)
      return read_glb_mesh(path);
#else
      throw format_error(path, "this build of aib reads no GLB; build it with nlohmann-json");
#endif
    case file_kind::gltf:
      throw format_error(path, "glTF of several files is not supported; export it as .glb");
    default:
      throw format_error(path, "a mesh expected: PLY, OBJ, STL or GLB");
  }
}

}  // namespace detail

inline mesh::mesh read_mesh(const std::filesystem::path& path, const mesh_options& options) {
  mesh::mesh result = detail::read_stored_mesh(path);
  turn_z_up(result, options.up);
  return result;
}

/// Writes a mesh as PLY. Throws argument_error for another extension.
inline void write_mesh(const std::filesystem::path& path,
                       const mesh::mesh& mesh,
                       const ply_mesh_extras& extras = {}) {
  if (extension_of(path) != ".ply") {
    throw argument_error(message("io::write_mesh: the extension .ply expected, found \"",
                                 path.extension().string(), "\""));
  }
  write_ply(path, mesh, extras);
}

}  // namespace aib::io

// aib/io/ply_positions.hpp

namespace aib::io {

/// Walks the vertices of a binary PLY file block by block: for files larger than memory.
///
/// Throws format_error where the file is no binary PLY, is damaged, or holds Gaussian splats.
class ply_positions {
 public:
  explicit ply_positions(const std::filesystem::path& path)
      : file_(path),
        header_(read_ply_header(file_)),
        vertex_(detail::ply_vertex_element(header_, path)),
        data_(file_, header_.data_offset, detail::byte_order(header_.format)) {
    if (header_.format == ply_format::ascii)
      throw format_error(path, "ply: a binary file expected, found ascii");
    if (vertex_.find("f_dc_0") && vertex_.find("opacity"))
      throw format_error(path, "ply: a cloud expected, found 3D Gaussian splats");
    const auto columns = detail::find_scalars(vertex_, {"x", "y", "z"});
    if (!columns) throw format_error(path, "ply: element vertex has no properties x, y and z");
    columns_ = *columns;
    for (const ply_element& element : header_.elements) {
      if (&element == &vertex_) break;
      data_.skip(element);
    }
  }
  ply_positions(const ply_positions&) = delete;
  ply_positions& operator=(const ply_positions&) = delete;

  [[nodiscard]] std::uint64_t size() const { return vertex_.count; }

  /// Whether the file holds float: its points count from the world's origin.
  [[nodiscard]] bool is_float() const {
    return std::all_of(columns_.begin(), columns_.end(), [&](std::size_t i) {
      return vertex_.properties[i].type == ply_type::float32;
    });
  }

  /// Makes `block` the next up to 65 536 positions; false at the end.
  [[nodiscard]] bool next(std::vector<Eigen::Vector3d>& block) {
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(size() - read_, 1 << 16));
    block.resize(n);
    if (vertex_.has_list()) {
      for (Eigen::Vector3d& p : block) p = next_row();
    } else {
      read_columns(block);
    }
    read_ += n;
    return n > 0;
  }

 private:
  [[nodiscard]] Eigen::Vector3d next_row() {
    data_.read_row(vertex_, detail::no_list, row_);
    return {row_.values[columns_[0]], row_.values[columns_[1]], row_.values[columns_[2]]};
  }

  void read_columns(std::vector<Eigen::Vector3d>& block) {
    const std::size_t stride = vertex_.row_bytes();
    const char* rows = data_.stream()->take(block.size() * stride, vertex_.name);
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t column = columns_[static_cast<std::size_t>(axis)];
      const char* from = rows;
      for (std::size_t i = 0; i < column; ++i) from += size_of(vertex_.properties[i].type);
      with_type(vertex_.properties[column].type, [&]<class T>(std::type_identity<T>) {
        const std::endian order = detail::byte_order(header_.format);
        for (std::size_t i = 0; i < block.size(); ++i)
          block[i][axis] = static_cast<double>(load<T>(from + i * stride, order));
      });
    }
  }

  input_file file_;
  ply_header header_;
  const ply_element& vertex_;
  detail::ply_binary_data data_;
  detail::ply_triple columns_{};
  detail::ply_row row_;
  std::uint64_t read_ = 0;
};

}  // namespace aib::io

// aib/io/pose_arrays.hpp

namespace aib::io {

/// Poses of an array of N x 4 x 4 or N x 3 x 4 numbers, or of one such matrix; leading axes of
/// length 1 are dropped. `path` names the source in errors.
/// Throws format_error for another shape and a matrix that is not a pose (see pose_from_matrix).
[[nodiscard]] pose::trajectory poses_of_array(const array& matrices,
                                              const pose_frame& frame,
                                              const std::filesystem::path& path);

/// Cameras of an array of N x 3 x 3 intrinsic matrices in pixels of an image of the given size.
/// Throws format_error for another shape.
[[nodiscard]] std::vector<math::camera> cameras_of_array(const array& matrices,
                                                         std::uint64_t width,
                                                         std::uint64_t height,
                                                         const std::filesystem::path& path);

/// The poses as an array of N x 4 x 4 doubles, as they are written in `frame`.
[[nodiscard]] array array_of_poses(const pose::trajectory& t, const pose_frame& frame = {});

namespace detail {

/// The shape without its leading ones, with at least `axes` axes.
inline std::vector<std::size_t> squeezed(const std::vector<std::size_t>& shape, std::size_t axes) {
  std::vector<std::size_t> s = shape;
  while (s.size() > axes && s.front() == 1) s.erase(s.begin());
  if (s.size() + 1 == axes) s.insert(s.begin(), 1);
  return s;
}

}  // namespace detail

inline pose::trajectory poses_of_array(const array& matrices,
                                       const pose_frame& frame,
                                       const std::filesystem::path& path) {
  const auto shape = detail::squeezed(matrices.shape, 3);
  if (shape.size() != 3 || (shape[1] != 3 && shape[1] != 4) || shape[2] != 4) {
    throw format_error(path, message("poses: shape (N, 4, 4) or (N, 3, 4) expected, found ",
                                     text_of_shape(matrices.shape)));
  }
  using rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  const std::vector<double> numbers = matrices.values<double>();
  pose::trajectory t;
  for (std::size_t i = 0; i < shape[0]; ++i) {
    const pose_matrix m = Eigen::Map<const rows>(numbers.data() + i * shape[1] * 4);
    try {
      t.world_from_camera.push_back(pose_from_matrix(m, frame));
    } catch (const argument_error& e) {
      throw format_error(path, message("poses: matrix ", i, ": ", e.what()));
    }
  }
  return checked_trajectory(std::move(t), path, "poses");
}

inline std::vector<math::camera> cameras_of_array(const array& matrices,
                                                  std::uint64_t width,
                                                  std::uint64_t height,
                                                  const std::filesystem::path& path) {
  const auto shape = detail::squeezed(matrices.shape, 3);
  if (shape.size() != 3 || shape[1] != 3 || shape[2] != 3) {
    throw format_error(path, message("intrinsics: shape (N, 3, 3) expected, found ",
                                     text_of_shape(matrices.shape)));
  }
  const std::vector<double> numbers = matrices.values<double>();
  std::vector<math::camera> cameras;
  for (std::size_t i = 0; i < shape[0]; ++i) {
    const std::span k = std::span(numbers).subspan(i * 9, 9);
    cameras.push_back(math::pinhole(width, height, k[0], k[4], k[2], k[5]));
  }
  return cameras;
}

inline array array_of_poses(const pose::trajectory& t, const pose_frame& frame) {
  std::vector<double> numbers;
  for (const math::rigid3& pose : t.world_from_camera) {
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m = pose_in_frame(pose, frame).matrix();
    numbers.insert(numbers.end(), m.data(), m.data() + m.size());
  }
  return make_array<double>({t.size(), 4, 4}, numbers);
}

}  // namespace aib::io

// aib/io/pose_format.hpp

namespace aib::io {

/// Formats of camera poses.
enum class pose_format {
  tum,
  kitti,
  euroc,
  log,  ///< Tanks and Temples
  da3,  ///< Depth Anything 3's streaming: 4 x 4 matrices, one a line
  colmap,
  transforms,
  opensfm,
  metashape,
  reality_capture,
  npy,
  npz,
};

/// A format and the name by which options call it.
struct pose_format_name {
  pose_format format;
  std::string_view name;
};

inline constexpr std::array<pose_format_name, 12> pose_format_names{{
    {pose_format::tum, "tum"},
    {pose_format::kitti, "kitti"},
    {pose_format::euroc, "euroc"},
    {pose_format::log, "log"},
    {pose_format::da3, "da3"},
    {pose_format::colmap, "colmap"},
    {pose_format::transforms, "transforms"},
    {pose_format::opensfm, "opensfm"},
    {pose_format::metashape, "metashape"},
    {pose_format::reality_capture, "reality_capture"},
    {pose_format::npy, "npy"},
    {pose_format::npz, "npz"},
}};

[[nodiscard]] constexpr std::string_view name(pose_format format) {
  return pose_format_names[static_cast<std::size_t>(format)].name;
}

/// The format of a file or folder: from its content, then from its extension.
/// Throws io_error where there is nothing at `path`, format_error where the format cannot be told.
[[nodiscard]] pose_format detect_pose_format(const std::filesystem::path& path);

namespace detail {

/// The folder with an NPZ file for each image: `folder` or its folder `camera`; empty where there
/// is none.
inline std::filesystem::path folder_of_npz(const std::filesystem::path& folder) {
  for (const std::filesystem::path& candidate : {folder, folder / "camera"}) {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(candidate, ignored)) {
      if (entry.path().extension() == ".npz") return candidate;
    }
  }
  return {};
}

inline std::optional<pose_format> format_of_folder(const std::filesystem::path& folder) {
  if (!find_colmap_models(folder).empty()) return pose_format::colmap;
  if (std::filesystem::exists(folder / "camera_poses.txt")) return pose_format::da3;
  if (std::filesystem::exists(folder / "transforms.json")) return pose_format::transforms;
  if (std::filesystem::exists(folder / "reconstruction.json")) return pose_format::opensfm;
  if (!folder_of_npz(folder).empty()) return pose_format::npz;
  return std::nullopt;
}

/// Whether the path names a file of a COLMAP model.
inline bool is_colmap_file(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 5> stems{"cameras", "images", "points3D", "rigs",
                                                  "frames"};
  const bool known = std::find(stems.begin(), stems.end(), path.stem().string()) != stems.end();
  return known && (path.extension() == ".bin" || path.extension() == ".txt") &&
         !find_colmap_models(path.parent_path()).empty();
}

inline bool is_number(std::string_view field) { return parse<double>(field).has_value(); }

/// The format of the first two rows of a text.
inline std::optional<pose_format> format_of_rows(const std::vector<std::string_view>& first,
                                                 const std::vector<std::string_view>& second) {
  constexpr double least_ns = 1e14;  // a day in nanoseconds; in seconds it is beyond any clock
  if (first.empty() || !std::all_of(first.begin(), first.end(), is_number)) return std::nullopt;
  const std::size_t n = first.size();
  if (n == 3 && second.size() == 4) return pose_format::log;
  if (n >= 8 && *parse<double>(first.front()) >= least_ns) return pose_format::euroc;
  if (n == 8) return pose_format::tum;
  if (n == 12) return pose_format::kitti;
  if (n == 16) return pose_format::da3;
  return std::nullopt;
}

inline std::optional<pose_format> format_of_text(std::string_view text,
                                                 const std::filesystem::path& path) {
  line_reader raw(text, path);
  if (raw.next() && trim(raw.line()).starts_with("#name")) return pose_format::reality_capture;
  if (raw.line().starts_with("#timestamp [ns]")) return pose_format::euroc;
  line_reader lines(text, path);
  std::vector<std::string_view> first;
  std::vector<std::string_view> second;
  if (lines.next_content()) split_loosely(lines.line(), first);
  if (lines.next_content()) split_loosely(lines.line(), second);
  return format_of_rows(first, second);
}

/// The beginning of the first line with content, for a message.
inline std::string_view first_words(std::string_view text, const std::filesystem::path& path) {
  constexpr std::size_t enough = 60;
  line_reader lines(text, path);
  return lines.next_content() ? lines.line().substr(0, enough) : std::string_view();
}

inline std::optional<pose_format> format_of_content(std::string_view text,
                                                    const std::filesystem::path& path) {
  if (text.starts_with("\x93NUMPY")) return pose_format::npy;
  if (text.starts_with("PK\x03\x04")) return pose_format::npz;
  std::string_view content = text;
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
  content = trim(content);
  if (content.starts_with('{')) return pose_format::transforms;
  if (content.starts_with('[')) return pose_format::opensfm;
  if (content.starts_with('<')) return pose_format::metashape;
  return format_of_text(text, path);
}

inline std::optional<pose_format> format_of_extension(const std::filesystem::path& path) {
  constexpr std::array<std::pair<std::string_view, pose_format>, 6> extensions{
      {{".tum", pose_format::tum},
       {".kitti", pose_format::kitti},
       {".log", pose_format::log},
       {".npy", pose_format::npy},
       {".npz", pose_format::npz},
       {".xml", pose_format::metashape}}};
  for (const auto& [extension, format] : extensions) {
    if (path.extension() == extension) return format;
  }
  return std::nullopt;
}

}  // namespace detail

inline pose_format detect_pose_format(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) {
    if (const auto format = detail::format_of_folder(path)) return *format;
    throw format_error(path,
                       "a COLMAP model (cameras, images), camera_poses.txt, transforms.json, "
                       "reconstruction.json or NPZ files expected in the folder, found none");
  }
  if (detail::is_colmap_file(path)) return pose_format::colmap;
  constexpr std::size_t enough = 1 << 16;
  const input_file file(path);
  std::string begin(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), enough)), '\0');
  file.read_at(0, begin.data(), begin.size());
  if (const auto format = detail::format_of_content(begin, path)) return *format;
  if (const auto format = detail::format_of_extension(path)) return *format;
  std::string names;
  for (const auto& known : pose_format_names)
    names += message(names.empty() ? "" : ", ", known.name);
  throw format_error(path,
                     message("the format of the poses cannot be told from '",
                             detail::first_words(begin, path), "'; give one as format: ", names));
}

}  // namespace aib::io

// aib/io/reality_capture.hpp

namespace aib::io {

/// A RealityCapture csv file of internal and external camera parameters. Its columns are found by
/// the names in the first line: `#name,x,y,alt,heading,pitch,roll,f,...`; angles are degrees.
///
/// size   of the images, which the file does not say: f (35 mm equivalent) becomes pixels with it.
///        Where it is 0 there are no cameras.
///
/// Principal point and distortion are not taken over (their units are not documented): the cameras
/// are pinholes with the centre of the image; a warning says so where they are not 0.
/// Throws format_error for a missing column, a line of another length and a file without an image.
[[nodiscard]] posed_images read_reality_capture(const std::filesystem::path& path,
                                                const image_extent& size = {});

namespace detail {

/// The rows of a csv file with named columns.
class csv_table {
 public:
  csv_table(std::string_view text, const std::filesystem::path& path) : lines_(text, path) {
    if (!lines_.next()) throw format_error(path, "reality_capture: the file is empty");
    std::string_view header = trim(lines_.line());
    if (header.starts_with('#')) header.remove_prefix(1);
    std::vector<std::string_view> names;
    split(header, names, ',');
    for (std::size_t i = 0; i < names.size(); ++i) columns_[std::string(names[i])] = i;
  }

  bool next() {
    if (!lines_.next_content()) return false;
    split(lines_.line(), fields_, ',');
    if (fields_.size() != columns_.size()) {
      lines_.fail(message("reality_capture: ", columns_.size(), " columns expected, found ",
                          fields_.size()));
    }
    return true;
  }
  [[nodiscard]] bool has(const std::string& column) const { return columns_.contains(column); }
  [[nodiscard]] std::string_view text(const std::string& column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end())
      lines_.fail(message("reality_capture: no column '", column, "' in the first line"));
    return fields_[found->second];
  }
  [[nodiscard]] double number(const std::string& column) const {
    const std::string_view field = text(column);
    if (const auto value = parse<double>(field)) return *value;
    lines_.fail(message("reality_capture: ", column, ": a number expected, found '", field, "'"));
  }

 private:
  line_reader lines_;
  std::map<std::string, std::size_t> columns_;
  std::vector<std::string_view> fields_;
};

/// Orientation of a camera from its angles in degrees: heading clockwise from north, pitch, roll.
inline Eigen::Matrix3d rotation_of_angles(double heading, double pitch, double roll) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(-math::radians(heading), Vector3d::UnitZ()) *
          AngleAxisd(math::radians(pitch), Vector3d::UnitX()) *
          AngleAxisd(math::radians(roll), Vector3d::UnitY()))
      .toRotationMatrix();
}

}  // namespace detail

inline posed_images read_reality_capture(const std::filesystem::path& path,
                                         const image_extent& size) {
  constexpr std::array unused{"px", "py", "k1", "k2", "k3", "k4", "t1", "t2"};
  constexpr double film_width_mm = 36;
  const auto width = static_cast<double>(size.width);
  const auto height = static_cast<double>(size.height);
  const std::string content = read_file(path);
  detail::csv_table table(content, path);
  posed_images images;
  bool left_out = false;
  while (table.next()) {
    const double heading = table.number("heading");
    const double pitch = table.number("pitch");
    const double roll = table.number("roll");
    pose_matrix matrix;
    matrix.leftCols<3>() = detail::rotation_of_angles(heading, pitch, roll);
    matrix.col(3) = Eigen::Vector3d{table.number("x"), table.number("y"), table.number("alt")};
    images.trajectory.names.emplace_back(table.text("name"));
    images.trajectory.world_from_camera.push_back(
        pose_from_matrix(matrix, {pose_convention::world_from_camera, camera_axes::opengl}));
    if (size.width == 0 || !table.has("f")) continue;
    const double f = table.number("f") * std::max(width, height) / film_width_mm;
    images.cameras.push_back(math::pinhole(size.width, size.height, f, f, width / 2, height / 2));
    for (const char* column : unused) left_out |= table.has(column) && table.number(column) != 0;
  }
  images.trajectory = checked_trajectory(std::move(images.trajectory), path, "reality_capture");
  if (left_out) {
    images.trajectory.warnings.push_back(
        "principal points and distortion are left out of the intrinsics");
  }
  return images;
}

}  // namespace aib::io

// aib/io/tanks_and_temples.hpp

namespace aib::io {

/// Poses of a Tanks and Temples .log file: for each frame a line of three whole numbers and the
/// four rows of a matrix, world_from_camera. Record k is frame k, as the benchmark reads it.
///
/// A frame that the tools did not register is written as identity with -1 as the second number: it
/// stays in its place, unregistered.
/// Throws format_error where a record is cut off or is not a pose, and for a file without a pose.
/// Source: Knapitsch et al., "Tanks and Temples", TOG 2017; TanksAndTemples
/// python_toolbox/convert_to_logfile.py.
[[nodiscard]] inline pose::trajectory read_tanks_and_temples(const std::filesystem::path& path,
                                                             const pose_frame& frame = {}) {
  const std::string text = read_file(path);
  number_lines lines(text, path, "log");
  pose::trajectory t;
  while (lines.next()) {
    lines.expect(3, "frame, frame, 0");
    const bool lost = lines.numbers()[1] == -1;
    std::vector<double> rows;
    for (int r = 0; r < 4; ++r) {
      if (!lines.next()) lines.fail("the file ends within a matrix");
      lines.expect(4, "row of a 4 x 4 matrix");
      rows.insert(rows.end(), lines.numbers().begin(), lines.numbers().end());
    }
    const pose_matrix matrix = detail::matrix_of_rows(rows);
    const bool identity = matrix == pose_matrix::Identity();
    t.world_from_camera.push_back(lost && identity ? unregistered_pose() : lines.checked([&] {
      return pose_from_matrix(matrix, frame);
    }));
  }
  return checked_trajectory(std::move(t), path, "log");
}

}  // namespace aib::io

// aib/io/tum.hpp

namespace aib::io {

/// Where the scalar of a written quaternion stands.
enum class quaternion_order {
  xyzw,  ///< last: TUM
  wxyz,  ///< first: what MonST3R and CUT3R write as pred_traj.txt
};

struct tum_options {
  pose_frame frame = {};
  quaternion_order quaternion = quaternion_order::xyzw;
};

/// Poses of a TUM RGB-D text file: `stamp tx ty tz qx qy qz qw` a line, world_from_camera, parted
/// by blanks or commas. Quaternions are normalised; poses that are not finite stay, unregistered.
///
/// Throws format_error for a line without 8 numbers, a stamp that is not finite, a zero quaternion
/// and a file without a pose.
/// Source: Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012.
[[nodiscard]] inline pose::trajectory read_tum(const std::filesystem::path& path,
                                               const tum_options& options = {}) {
  constexpr double normalised = 1e-2;
  const bool w_first = options.quaternion == quaternion_order::wxyz;
  const std::string text = read_file(path);
  number_lines lines(text, path, "tum");
  pose::trajectory t;
  std::size_t not_unit = 0;
  while (lines.next()) {
    lines.expect(8, w_first ? "stamp tx ty tz qw qx qy qz" : "stamp tx ty tz qx qy qz qw");
    const std::vector<double>& n = lines.numbers();
    if (!std::isfinite(n[0])) lines.fail("the stamp is not finite");
    const math::quaternion q = w_first ? math::quaternion{n[4], n[5], n[6], n[7]}
                                       : math::quaternion{n[7], n[4], n[5], n[6]};
    const double norm = std::hypot(std::hypot(q.w, q.x), std::hypot(q.y, q.z));
    not_unit += std::abs(norm - 1) > normalised ? 1 : 0;
    t.stamps_s.push_back(n[0]);
    t.world_from_camera.push_back(lines.checked([&] {
      return pose_from_quaternion(q, {n[1], n[2], n[3]}, options.frame);
    }));
  }
  if (not_unit > 0)
    t.warnings.push_back(message(not_unit, " quaternions are not of length 1: normalised"));
  return checked_trajectory(std::move(t), path, "tum");
}

/// Writes the registered poses as a TUM file, numbers in their shortest exact form. A trajectory
/// without stamps gets its indices. Throws argument_error where no pose is registered.
inline void write_tum(const std::filesystem::path& path,
                      const pose::trajectory& t,
                      const tum_options& options = {}) {
  pose::check(t);
  std::string text;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!t.world_from_camera[i].is_finite()) continue;
    const math::rigid3 pose = pose_in_frame(t.world_from_camera[i], options.frame);
    const math::quaternion q = math::quaternion_from(pose.rotation);
    const Eigen::Vector3d& p = pose.translation;
    const double stamp = t.stamps_s.empty() ? static_cast<double>(i) : t.stamps_s[i];
    text += message(stamp, ' ', p.x(), ' ', p.y(), ' ', p.z(), ' ');
    text += options.quaternion == quaternion_order::wxyz
                ? message(q.w, ' ', q.x, ' ', q.y, ' ', q.z, '\n')
                : message(q.x, ' ', q.y, ' ', q.z, ' ', q.w, '\n');
  }
  if (text.empty()) throw argument_error("write_tum: no registered pose to write");
  write_file(path, text);
}

}  // namespace aib::io

// aib/io/json.hpp

#if defined(AIB_WITH_JSON)
#include <nlohmann/json.hpp>

namespace aib::io {

/// A JSON value that knows its place in its file: whatever is missing or of the wrong kind is
/// refused with the file and the place ("frames[3].transform_matrix"). Borrows the value and path.
class json_node {
 public:
  json_node(const nlohmann::json& value, const std::filesystem::path& path, std::string place = {})
      : value_(&value), path_(&path), place_(std::move(place)) {}

  [[nodiscard]] bool is_object() const { return value_->is_object(); }
  [[nodiscard]] bool is_array() const { return value_->is_array(); }
  [[nodiscard]] bool is_number() const { return value_->is_number(); }

  /// The member of an object, nothing where there is none or it is null.
  [[nodiscard]] std::optional<json_node> find(const std::string& key) const {
    if (!value_->is_object()) fail(message("an object expected, found ", kind()));
    const auto member = value_->find(key);
    if (member == value_->end() || member->is_null()) return std::nullopt;
    return json_node(*member, *path_, place_.empty() ? key : message(place_, '.', key));
  }
  [[nodiscard]] json_node operator[](const std::string& key) const {
    if (auto member = find(key)) return std::move(*member);
    fail(message("'", key, "' expected, found none"));
  }

  /// Length and elements of an array.
  [[nodiscard]] std::size_t size() const {
    if (!value_->is_array()) fail(message("an array expected, found ", kind()));
    return value_->size();
  }
  [[nodiscard]] json_node operator[](std::size_t i) const {
    if (i >= size()) fail(message("at least ", i + 1, " elements expected, found ", size()));
    return {(*value_)[i], *path_, message(place_, '[', i, ']')};
  }

  /// Calls `visit(key, node)` for the members of an object, in the order of their keys.
  template <class Visit>
  void for_each_member(Visit&& visit) const {
    if (!value_->is_object()) fail(message("an object expected, found ", kind()));
    for (auto member = value_->begin(); member != value_->end(); ++member)
      visit(member.key(), json_node(*member, *path_, message(place_, '.', member.key())));
  }

  [[nodiscard]] double number() const {
    if (!value_->is_number()) fail(message("a number expected, found ", kind()));
    return value_->get<double>();
  }
  [[nodiscard]] std::string text() const {
    if (!value_->is_string()) fail(message("a text expected, found ", kind()));
    return value_->get<std::string>();
  }
  /// The number of a member, or `otherwise` where there is none.
  [[nodiscard]] double number(const std::string& key, double otherwise) const {
    const auto member = find(key);
    return member ? member->number() : otherwise;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(*path_, message(place_, place_.empty() ? "" : ": ", what));
  }

 private:
  [[nodiscard]] std::string_view kind() const { return value_->type_name(); }

  const nlohmann::json* value_;
  const std::filesystem::path* path_;
  std::string place_;
};

/// The content of a JSON file. Throws format_error where it is not JSON.
///
/// keep   called as keep(key) for each member of an object; where it says no the member's value is
///        dropped as it is read, so that large parts need no memory
template <class Keep>
[[nodiscard]] nlohmann::json read_json(const std::filesystem::path& path, Keep&& keep) {
  using json = nlohmann::json;
  const std::string text = read_file(path);
  const auto callback = [&](int, json::parse_event_t event, json& parsed) {
    return event != json::parse_event_t::key || keep(parsed.get_ref<const std::string&>());
  };
  try {
    return json::parse(text, callback);
  } catch (const json::parse_error& e) {
    const std::string_view what = e.what();
    const std::size_t end_of_id = what.find("] ");
    throw format_error(
        path, at_byte{e.byte},
        message("json: ", end_of_id == std::string_view::npos ? what : what.substr(end_of_id + 2)));
  } catch (const json::exception& e) {
    throw format_error(path, message("json: ", e.what()));
  }
}

[[nodiscard]] inline nlohmann::json read_json(const std::filesystem::path& path) {
  return read_json(path, [](const std::string&) { return true; });
}

}  // namespace aib::io
#endif

// aib/io/opensfm.hpp

#if defined(AIB_WITH_JSON)
namespace aib::io {

/// The components of an OpenSfM or OpenDroneMap reconstruction.json, in the order of the file; the
/// shots of each sorted by name. Points are not read.
///
/// Cameras are empty where a shot's camera has a projection that COLMAP has not; a warning says so.
/// Throws format_error where it is not such a file or has no shot.
/// Source: OpenSfM, opensfm/io.py, doc/source/reporting.rst.
[[nodiscard]] std::vector<posed_images> read_opensfm_components(const std::filesystem::path& path);

/// The component with the most shots (of equals the first); a warning counts the others.
[[nodiscard]] posed_images read_opensfm(const std::filesystem::path& path);

namespace detail {

/// OpenSfM's camera with COLMAP's parameters. Lengths are written in units of the longer side, from
/// the image's centre.
inline std::optional<math::camera> opensfm_camera(const json_node& j) {
  using math::camera_model;
  const double width = j["width"].number();
  const double height = j["height"].number();
  if (!(width >= 1 && height >= 1 && width < 1e9 && height < 1e9))
    j.fail("width and height of 1 or more pixels expected");
  const double side = std::max(width, height);
  const double f = side * j.number("focal", 0);
  const double fx = side * j.number("focal_x", f / side);
  const double fy = side * j.number("focal_y", fx / side);
  const double cx = width / 2 + side * j.number("c_x", 0);
  const double cy = height / 2 + side * j.number("c_y", 0);
  const auto d = [&](const char* key) { return j.number(key, 0); };
  const auto of = [&](camera_model model, std::vector<double> parameters) {
    return math::camera{model, static_cast<std::uint64_t>(width),
                        static_cast<std::uint64_t>(height), std::move(parameters)};
  };
  const std::string type = j["projection_type"].text();
  if (type == "perspective") return of(camera_model::radial, {f, cx, cy, d("k1"), d("k2")});
  if (type == "fisheye") return of(camera_model::radial_fisheye, {f, cx, cy, d("k1"), d("k2")});
  if (type == "spherical" || type == "equirectangular")
    return of(camera_model::equirectangular, {width, height});
  if (type == "simple_radial" || type == "radial")
    return of(camera_model::opencv, {fx, fy, cx, cy, d("k1"), d("k2"), 0, 0});
  if (type == "brown") {
    return of(camera_model::full_opencv,
              {fx, fy, cx, cy, d("k1"), d("k2"), d("p1"), d("p2"), d("k3"), 0, 0, 0});
  }
  if (type == "fisheye_opencv") {
    return of(camera_model::opencv_fisheye, {fx, fy, cx, cy, d("k1"), d("k2"), d("k3"), d("k4")});
  }
  return std::nullopt;
}

inline Eigen::Vector3d read_json_vector(const json_node& j) {
  if (j.size() != 3) j.fail(message("3 numbers expected, found ", j.size()));
  return {j[0].number(), j[1].number(), j[2].number()};
}

inline posed_images opensfm_component(const json_node& component,
                                      const std::filesystem::path& path) {
  std::map<std::string, std::optional<math::camera>> cameras;
  component["cameras"].for_each_member([&](const std::string& name, const json_node& camera) {
    cameras[name] = opensfm_camera(camera);
  });
  posed_images images;
  component["shots"].for_each_member([&](const std::string& name, const json_node& shot) {
    const Eigen::Matrix3d rotation = math::rotation_from(read_json_vector(shot["rotation"]));
    const math::rigid3 camera_from_world{rotation, read_json_vector(shot["translation"])};
    images.trajectory.names.push_back(name);
    images.trajectory.world_from_camera.push_back(camera_from_world.inverse());
    const std::string camera_name = shot["camera"].text();
    const auto camera = cameras.find(camera_name);
    if (camera == cameras.end()) shot.fail(message("no camera '", camera_name, "' in the file"));
    if (camera->second) images.cameras.push_back(*camera->second);
  });
  images.trajectory = checked_trajectory(std::move(images.trajectory), path, "opensfm");
  if (images.cameras.size() != images.trajectory.size()) {
    images.trajectory.warnings.push_back("a projection is not known: no intrinsics are given");
    images.cameras.clear();
  }
  return images;
}

}  // namespace detail

inline std::vector<posed_images> read_opensfm_components(const std::filesystem::path& path) {
  const nlohmann::json content =
      read_json(path, [](const std::string& key) { return key != "points"; });
  const json_node file(content, path);
  std::vector<posed_images> components;
  for (std::size_t i = 0; i < file.size(); ++i)
    components.push_back(detail::opensfm_component(file[i], path));
  if (components.empty()) throw format_error(path, "opensfm: no reconstruction in the file");
  return components;
}

inline posed_images read_opensfm(const std::filesystem::path& path) {
  std::vector<posed_images> components = read_opensfm_components(path);
  const auto largest = std::max_element(components.begin(), components.end(),
                                        [](const posed_images& a, const posed_images& b) {
                                          return a.trajectory.size() < b.trajectory.size();
                                        });
  posed_images images = std::move(*largest);
  if (components.size() > 1) {
    images.trajectory.warnings.push_back(message("component ", largest - components.begin(), " of ",
                                                 components.size(), " is read (",
                                                 images.trajectory.size(), " images)"));
  }
  return images;
}

}  // namespace aib::io
#endif

// aib/io/transforms.hpp

#if defined(AIB_WITH_JSON)
namespace aib::io {

struct transforms_options {
  pose_frame frame = {pose_convention::world_from_camera, camera_axes::opengl};
  image_extent size = {};
};

/// A transforms.json of NeRF (camera_angle_x) or nerfstudio (fl_x ..., shared or per frame): poses
/// in the order of the frames, named by `file_path` without a leading "./".
///
/// nerfstudio's `applied_transform` is part of the written poses and stays so. Cameras are empty
/// where the file tells no focal length (an angle needs a width) or has a camera model that COLMAP
/// has not; a warning says so.
///
/// Throws format_error where it is not JSON, has no frames, or a frame without a 4 x 4 or 3 x 4
/// transform_matrix.
[[nodiscard]] posed_images read_transforms(const std::filesystem::path& path,
                                           const transforms_options& options = {});

/// Writes a nerfstudio transforms.json: OpenGL axes, intrinsics per frame where there are cameras.
/// Poses that are not registered are left out. Throws argument_error where names or cameras do not
/// fit the poses, no pose is registered or a camera has a model that nerfstudio has not.
void write_transforms(const std::filesystem::path& path, const posed_images& images);

namespace detail {

inline pose_matrix read_transform_matrix(const json_node& rows) {
  if (rows.size() != 4 && rows.size() != 3)
    rows.fail(message("4 or 3 rows expected, found ", rows.size()));
  pose_matrix matrix;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const json_node row = rows[r];
    if (row.size() != 4) row.fail(message("4 numbers expected, found ", row.size()));
    for (std::size_t c = 0; c < 4; ++c) {
      const double number = row[c].number();
      if (r < 3) matrix(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = number;
      if (r == 3 && number != (c == 3 ? 1 : 0)) row.fail("0 0 0 1 expected in the last row");
    }
  }
  return matrix;
}

/// Whether nerfstudio takes the model for a perspective camera with OpenCV's distortion.
inline bool is_perspective(std::string_view model) {
  constexpr std::array<std::string_view, 6> models{
      "", "SIMPLE_PINHOLE", "PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV"};
  return std::find(models.begin(), models.end(), model) != models.end();
}

/// Intrinsics of a frame: its own members, else those of the file.
class transforms_intrinsics {
 public:
  transforms_intrinsics(const json_node& frame,
                        const json_node& file,
                        const transforms_options& options)
      : frame_(frame), file_(file) {
    width_ = number("w").value_or(static_cast<double>(options.size.width));
    height_ = number("h").value_or(static_cast<double>(options.size.height));
  }

  /// Nothing where the focal length or the model is not known.
  [[nodiscard]] std::optional<math::camera> camera() const {
    using math::camera_model;
    const std::string model = model_name();
    if (model == "EQUIRECTANGULAR") return of(camera_model::equirectangular, {width_, height_});
    const auto fx = focal("fl_x", "camera_angle_x", width_);
    if (!fx) return std::nullopt;
    const double fy = focal("fl_y", "camera_angle_y", height_).value_or(*fx);
    const double cx = number("cx").value_or(width_ / 2);
    const double cy = number("cy").value_or(height_ / 2);
    const auto k = [&](const char* key) { return number(key).value_or(0); };
    if (model == "OPENCV_FISHEYE") {
      return of(camera_model::opencv_fisheye,
                {*fx, fy, cx, cy, k("k1"), k("k2"), k("k3"), k("k4")});
    }
    if (!is_perspective(model) || k("k4") != 0) return std::nullopt;
    if (k("k3") != 0) {
      return of(camera_model::full_opencv,
                {*fx, fy, cx, cy, k("k1"), k("k2"), k("p1"), k("p2"), k("k3"), 0, 0, 0});
    }
    if (k("k1") != 0 || k("k2") != 0 || k("p1") != 0 || k("p2") != 0)
      return of(camera_model::opencv, {*fx, fy, cx, cy, k("k1"), k("k2"), k("p1"), k("p2")});
    return of(camera_model::pinhole, {*fx, fy, cx, cy});
  }

 private:
  [[nodiscard]] std::optional<double> number(const std::string& key) const {
    auto member = frame_.find(key);
    if (!member) member = file_.find(key);
    if (!member) return std::nullopt;
    return member->number();
  }

  [[nodiscard]] std::string model_name() const {
    auto member = frame_.find("camera_model");
    if (!member) member = file_.find("camera_model");
    return member ? member->text() : std::string();
  }

  [[nodiscard]] std::optional<double> focal(const char* key,
                                            const char* angle_key,
                                            double extent) const {
    if (const auto f = number(key)) return f;
    const auto angle = number(angle_key);
    if (!angle || !(extent > 0)) return std::nullopt;
    return extent / 2 / std::tan(*angle / 2);
  }

  [[nodiscard]] math::camera of(math::camera_model model, std::vector<double> parameters) const {
    const auto pixels = [&](double extent) {
      if (!(extent >= 0 && extent < 1e9)) frame_.fail("w and h between 0 and 1e9 expected");
      return static_cast<std::uint64_t>(extent);
    };
    return {model, pixels(width_), pixels(height_), std::move(parameters)};
  }

  const json_node& frame_;
  const json_node& file_;
  double width_ = 0;
  double height_ = 0;
};

inline nlohmann::ordered_json json_of_camera(const math::camera& c) {
  using math::camera_model;
  static constexpr std::array names{"k1", "k2", "p1", "p2"};
  static constexpr std::array fisheye_names{"k1", "k2", "k3", "k4"};
  nlohmann::ordered_json j;
  const bool fisheye = c.model == camera_model::opencv_fisheye;
  const bool distorted = fisheye || c.model == camera_model::opencv;
  if (!distorted && c.model != camera_model::pinhole && c.model != camera_model::simple_pinhole) {
    throw argument_error(message("write_transforms: camera model ", math::info(c.model).name,
                                 " is not one of SIMPLE_PINHOLE, PINHOLE, OPENCV, OPENCV_FISHEYE"));
  }
  j["camera_model"] = fisheye ? "OPENCV_FISHEYE" : "OPENCV";
  j["w"] = c.width;
  j["h"] = c.height;
  j["fl_x"] = c.fx();
  j["fl_y"] = c.fy();
  j["cx"] = c.cx();
  j["cy"] = c.cy();
  for (std::size_t i = 0; distorted && i < 4; ++i)
    j[fisheye ? fisheye_names[i] : names[i]] = c.parameters.at(4 + i);
  return j;
}

}  // namespace detail

inline posed_images read_transforms(const std::filesystem::path& path,
                                    const transforms_options& options) {
  const nlohmann::json content = read_json(path);
  const json_node file(content, path, "");
  const json_node frames = file["frames"];
  posed_images images;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const json_node frame = frames[i];
    std::string name = frame["file_path"].text();
    if (name.starts_with("./")) name.erase(0, 2);
    images.trajectory.names.push_back(std::move(name));
    const json_node matrix = frame["transform_matrix"];
    try {
      images.trajectory.world_from_camera.push_back(
          pose_from_matrix(detail::read_transform_matrix(matrix), options.frame));
    } catch (const argument_error& e) {
      matrix.fail(e.what());
    }
    if (auto camera = detail::transforms_intrinsics(frame, file, options).camera())
      images.cameras.push_back(std::move(*camera));
  }
  images.trajectory = checked_trajectory(std::move(images.trajectory), path, "transforms");
  if (images.cameras.size() != images.trajectory.size()) {
    images.trajectory.warnings.push_back(message("intrinsics are known for ", images.cameras.size(),
                                                 " of ", images.trajectory.size(),
                                                 " frames: none are given"));
    images.cameras.clear();
  }
  return images;
}

inline void write_transforms(const std::filesystem::path& path, const posed_images& images) {
  const pose::trajectory& t = images.trajectory;
  pose::check(t);
  if (t.names.empty()) throw argument_error("write_transforms: the poses need names");
  if (!images.cameras.empty() && images.cameras.size() != t.size()) {
    throw argument_error(
        message("write_transforms: ", images.cameras.size(), " cameras for ", t.size(), " poses"));
  }
  nlohmann::ordered_json frames = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!t.world_from_camera[i].is_finite()) continue;
    nlohmann::ordered_json frame;
    frame["file_path"] = t.names[i];
    if (!images.cameras.empty()) frame.update(detail::json_of_camera(images.cameras[i]));
    const Eigen::Matrix4d m =
        pose_in_frame(t.world_from_camera[i], transforms_options{}.frame).matrix();
    for (Eigen::Index r = 0; r < 4; ++r)
      frame["transform_matrix"].push_back({m(r, 0), m(r, 1), m(r, 2), m(r, 3)});
    frames.push_back(std::move(frame));
  }
  if (frames.empty()) throw argument_error("write_transforms: no registered pose to write");
  nlohmann::ordered_json file;
  file["frames"] = std::move(frames);
  write_file(path, file.dump(1) + "\n");
}

}  // namespace aib::io
#endif

// aib/io/pose_npz.hpp

#if defined(AIB_WITH_EXR) || defined(AIB_WITH_NPZ)
namespace aib::io {

struct pose_npz_options {
  std::string key = {};  ///< array of the poses; empty: the first of `pose_keys` that is there
  std::optional<pose_convention> convention = {};  ///< needed where `key` is not of `pose_keys`
  camera_axes axes = camera_axes::opencv;
};

/// An array name by which a method is known to save poses, and what it means.
struct pose_key {
  std::string_view name;
  pose_convention convention;
};

inline constexpr std::array<pose_key, 8> pose_keys{{
    {"extrinsics", pose_convention::camera_from_world},    // Depth Anything 3
    {"exts", pose_convention::camera_from_world},          // Depth Anything 3, its documentation
    {"extrinsic", pose_convention::camera_from_world},     // VGGT
    {"camera_poses", pose_convention::world_from_camera},  // pi3
    {"cam_c2w", pose_convention::world_from_camera},       // MegaSaM
    {"pose", pose_convention::world_from_camera},          // CUT3R
    {"c2w", pose_convention::world_from_camera},
    {"w2c", pose_convention::camera_from_world},
}};

/// Poses and, where they are there, intrinsics (`intrinsics`, `ixts`, `intrinsic`, `K`) of an NPZ
/// file. The images' size is that of `depth` or of the point map; 0 where there is neither.
///
/// Intrinsics whose principal point lies at the far side of the depth map belong to the images'
/// original size (a race in Depth Anything 3's export): they are scaled to the depth map, and a
/// warning says so.
/// Throws argument_error where no array of poses is found or its convention is not known.
[[nodiscard]] posed_images read_pose_npz(const std::filesystem::path& path,
                                         const pose_npz_options& options = {});

/// What CUT3R leaves in a folder `camera`: an NPZ file with one pose (and intrinsics) for each
/// image. The images are named by the files' stems, in their order. Throws format_error where there
/// is none or one of them has more than one pose.
[[nodiscard]] posed_images read_pose_npz_folder(const std::filesystem::path& folder,
                                                const pose_npz_options& options = {});

namespace detail {

inline pose_key find_pose_key(const npz_file& file, const pose_npz_options& options) {
  for (const pose_key& known : pose_keys) {
    if (options.key.empty() ? file.contains(known.name) : options.key == known.name) return known;
  }
  if (options.key.empty()) {
    std::string names;
    for (const std::string& name : file.names()) names += message(names.empty() ? "" : ", ", name);
    throw argument_error(
        message(file.path().string(),
                ": npz: no array of poses known by its name; give one as key: ", names));
  }
  if (!options.convention) {
    throw argument_error(message(file.path().string(), ": npz: '", options.key,
                                 "' does not tell its convention: world_from_camera or "
                                 "camera_from_world is to be given"));
  }
  return {options.key, *options.convention};
}

/// Size of the maps that belong to the poses.
inline image_extent size_of_maps(const npz_file& file) {
  for (const char* name : {"depth", "depths", "depth_conf", "local_points", "points", "conf"}) {
    if (!file.contains(name) || file.is_unreadable(name)) continue;
    std::vector<std::size_t> shape = file.read_header(name).shape;
    const bool channels = shape.size() > 3 && (shape.back() == 1 || shape.back() == 3);
    if (channels) shape.pop_back();
    if (shape.size() >= 2) return {shape.back(), shape[shape.size() - 2]};
  }
  return {};
}

/// Scales intrinsics of the original images to the maps' size. Returns whether it was needed.
inline bool scale_to_maps(math::camera& c) {
  constexpr double far_side = 0.9;
  const auto width = static_cast<double>(c.width);
  const auto height = static_cast<double>(c.height);
  if (c.width == 0 || c.cx() <= far_side * width || c.cy() <= far_side * height) return false;
  const double sx = width / (2 * c.cx());
  const double sy = height / (2 * c.cy());
  c.parameters = {c.fx() * sx, c.fy() * sy, width / 2, height / 2};
  return true;
}

inline std::vector<math::camera> read_npz_cameras(const npz_file& file) {
  for (const char* name : {"intrinsics", "ixts", "intrinsic", "K"}) {
    if (!file.contains(name)) continue;
    const image_extent size = size_of_maps(file);
    return cameras_of_array(file.read(name), size.width, size.height,
                            message(file.path().string(), '[', name, ']'));
  }
  return {};
}

}  // namespace detail

inline posed_images read_pose_npz(const std::filesystem::path& path,
                                  const pose_npz_options& options) {
  const npz_file file(path);
  const pose_key key = detail::find_pose_key(file, options);
  const pose_frame frame{options.convention.value_or(key.convention), options.axes};
  posed_images images;
  images.trajectory =
      poses_of_array(file.read(key.name), frame, message(path.string(), '[', key.name, ']'));
  images.cameras = detail::read_npz_cameras(file);
  const std::size_t n = images.trajectory.size();
  if (!images.cameras.empty() && images.cameras.size() != n) {
    throw format_error(
        path, message("npz: intrinsics for ", images.cameras.size(), " images, poses for ", n));
  }
  const auto scaled = std::count_if(images.cameras.begin(), images.cameras.end(),
                                    [](math::camera& c) { return detail::scale_to_maps(c); });
  if (scaled > 0) {
    images.trajectory.warnings.push_back(
        message(scaled, " of ", n,
                " intrinsics belong to a larger image than the depth maps: scaled to these"));
  }
  return images;
}

inline posed_images read_pose_npz_folder(const std::filesystem::path& folder,
                                         const pose_npz_options& options) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".npz") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  posed_images all;
  for (const std::filesystem::path& file : files) {
    const posed_images one = read_pose_npz(file, options);
    if (one.trajectory.size() != 1)
      throw format_error(file, message("one pose expected, found ", one.trajectory.size()));
    all.trajectory.names.push_back(file.stem().string());
    all.trajectory.world_from_camera.push_back(one.trajectory.world_from_camera.front());
    all.cameras.insert(all.cameras.end(), one.cameras.begin(), one.cameras.end());
  }
  if (all.cameras.size() != files.size()) all.cameras.clear();
  all.trajectory = checked_trajectory(std::move(all.trajectory), folder, "npz");
  return all;
}

}  // namespace aib::io
#endif

// aib/io/metashape.hpp

#if defined(AIB_WITH_XML)
#include <pugixml.hpp>

namespace aib::io {

/// The cameras of an Agisoft Metashape XML file, in the order of the file, named by their labels.
/// A camera without a transform stays, unregistered.
///
/// Poses are in the world of the component's transform, else of the chunk's; where there is
/// neither, in the chunk's own frame of no known unit, and a warning says so. Skew (b2) and k4 have
/// no place in COLMAP's models and are left out of the intrinsics with a warning.
/// Throws format_error where it is no such file, a matrix is not a pose, or there is no camera.
/// Source: Agisoft Metashape Professional manual 2.0, Appendix D (camera models).
[[nodiscard]] posed_images read_metashape(const std::filesystem::path& path);

namespace detail {

/// Reads one document; errors carry the file.
class metashape_reader {
 public:
  explicit metashape_reader(const std::filesystem::path& path) : path_(path) {
    const std::string text = read_file(path);
    const pugi::xml_parse_result parsed = document_.load_buffer(text.data(), text.size());
    if (!parsed) {
      throw format_error(path, at_byte{static_cast<std::uint64_t>(parsed.offset)},
                         message("xml: ", parsed.description()));
    }
    chunk_ = document_.child("document").child("chunk");
    if (!chunk_) fail("<document><chunk> expected");
  }

  posed_images read() {
    read_sensors();
    read_worlds();
    posed_images images;
    for (const pugi::xpath_node& node : chunk_.child("cameras").select_nodes(".//camera"))
      add(images, node.node());
    images.trajectory = checked_trajectory(std::move(images.trajectory), path_, "metashape");
    finish(images);
    return images;
  }

 private:
  void read_sensors() {
    for (const pugi::xml_node sensor : chunk_.child("sensors").children("sensor"))
      sensors_[sensor.attribute("id").value()] = camera_of(sensor);
  }

  /// Transforms to the world by component; that of the chunk has the name "".
  void read_worlds() {
    if (const auto world = world_of(chunk_)) worlds_[""] = *world;
    for (const pugi::xml_node component : chunk_.child("components").children("component")) {
      if (const auto world = world_of(component))
        worlds_[component.attribute("id").value()] = *world;
    }
  }

  void add(posed_images& images, const pugi::xml_node& camera) {
    const std::string label = camera.attribute("label").value();
    images.trajectory.names.push_back(label);
    images.trajectory.world_from_camera.push_back(pose_of(camera, label));
    const auto sensor = sensors_.find(camera.attribute("sensor_id").value());
    if (sensor != sensors_.end() && sensor->second) images.cameras.push_back(*sensor->second);
  }

  math::rigid3 pose_of(const pugi::xml_node& camera, const std::string& label) {
    const pugi::xml_node transform = camera.child("transform");
    if (!transform) return unregistered_pose();
    const std::vector<double> n = numbers(transform, 16);
    using rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
    const std::string component = camera.attribute("component_id").value();
    try {
      const math::rigid3 pose = pose_from_matrix(Eigen::Map<const rows>(n.data()));
      const auto world = worlds_.contains(component) ? worlds_.find(component) : worlds_.find("");
      components_.insert(component);
      if (world != worlds_.end()) return world->second * pose;
      in_chunk_frame_ = true;
      return pose;
    } catch (const argument_error& e) {
      fail(message("camera '", label, "': ", e.what()));
    }
  }

  std::optional<math::sim3> world_of(const pugi::xml_node& owner) const {
    const pugi::xml_node transform = owner.child("transform");
    if (!transform.child("rotation") || !transform.child("translation")) return std::nullopt;
    const std::vector<double> r = numbers(transform.child("rotation"), 9);
    const std::vector<double> t = numbers(transform.child("translation"), 3);
    const double scale = transform.child("scale") ? numbers(transform.child("scale"), 1)[0] : 1;
    pose_matrix matrix;
    matrix << r[0], r[1], r[2], t[0], r[3], r[4], r[5], t[1], r[6], r[7], r[8], t[2];
    try {
      const math::rigid3 rigid = pose_from_matrix(matrix);
      if (!rigid.is_finite() || !(scale > 0) || !std::isfinite(scale))
        throw argument_error("finite numbers and a scale above 0 expected");
      return math::sim3{scale, rigid.rotation, rigid.translation};
    } catch (const argument_error& e) {
      fail(message("<transform> to the world: ", e.what()));
    }
  }

  /// The adjusted calibration of a sensor, else its first; nothing where it has none of a known
  /// type.
  std::optional<math::camera> camera_of(const pugi::xml_node& sensor) {
    using math::camera_model;
    pugi::xml_node c = sensor.find_child_by_attribute("calibration", "class", "adjusted");
    if (!c) c = sensor.child("calibration");
    const pugi::xml_node resolution = sensor.child("resolution");
    const auto width = number(resolution.attribute("width").value());
    const auto height = number(resolution.attribute("height").value());
    if (!c || !(width >= 1 && width < 1e9) || !(height >= 1 && height < 1e9)) return std::nullopt;
    const auto of = [&](camera_model model, std::vector<double> parameters) {
      return math::camera{model, static_cast<std::uint64_t>(width),
                          static_cast<std::uint64_t>(height), std::move(parameters)};
    };
    const auto d = [&](const char* name) {
      const pugi::xml_node value = c.child(name);
      return value ? numbers(value, 1)[0] : 0;
    };
    const std::string_view type = c.attribute("type").value();
    if (type == "spherical") return of(camera_model::equirectangular, {width, height});
    if (!c.child("f")) return std::nullopt;
    const double fx = d("f") + d("b1");
    const double cx = width / 2 + d("cx");
    const double cy = height / 2 + d("cy");
    left_out_ |= d("b2") != 0;
    if (type == "fisheye") {
      left_out_ |= d("p1") != 0 || d("p2") != 0;
      return of(camera_model::opencv_fisheye,
                {fx, d("f"), cx, cy, d("k1"), d("k2"), d("k3"), d("k4")});
    }
    if (type != "frame") return std::nullopt;
    left_out_ |= d("k4") != 0;
    // Metashape's p1 and p2 stand in the other order than OpenCV's.
    return of(camera_model::full_opencv,
              {fx, d("f"), cx, cy, d("k1"), d("k2"), d("p2"), d("p1"), d("k3"), 0, 0, 0});
  }

  void finish(posed_images& images) const {
    std::vector<std::string>& warnings = images.trajectory.warnings;
    if (in_chunk_frame_)
      warnings.push_back("no transform to the world: the frame and unit of the chunk");
    if (components_.size() > 1) {
      warnings.push_back(message("the cameras lie in ", components_.size(),
                                 " components, which need not fit each other"));
    }
    if (left_out_) warnings.push_back("b2, k4 or p of a fisheye are left out of the intrinsics");
    if (images.cameras.size() == images.trajectory.size()) return;
    warnings.push_back(message("intrinsics are known for ", images.cameras.size(), " of ",
                               images.trajectory.size(), " cameras: none are given"));
    images.cameras.clear();
  }

  static double number(std::string_view text) {
    return parse<double>(trim(text)).value_or(std::nan(""));
  }

  std::vector<double> numbers(const pugi::xml_node& node, std::size_t n) const {
    std::vector<std::string_view> fields;
    split(node.child_value(), fields);
    std::vector<double> values;
    for (const std::string_view field : fields) {
      const auto value = parse<double>(field);
      if (!value) fail(message("<", node.name(), ">: a number expected, found '", field, "'"));
      values.push_back(*value);
    }
    if (values.size() != n)
      fail(message("<", node.name(), ">: ", n, " numbers expected, found ", values.size()));
    return values;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, message("metashape: ", what));
  }

  const std::filesystem::path& path_;
  pugi::xml_document document_;
  pugi::xml_node chunk_;
  std::map<std::string, std::optional<math::camera>> sensors_;
  std::map<std::string, math::sim3> worlds_;
  std::set<std::string> components_;
  bool in_chunk_frame_ = false;
  bool left_out_ = false;
};

}  // namespace detail

inline posed_images read_metashape(const std::filesystem::path& path) {
  return detail::metashape_reader(path).read();
}

}  // namespace aib::io
#endif

// aib/io/trajectory.hpp

#ifdef AIB_WITH_JSON
#endif
#ifdef AIB_WITH_NPZ
#endif
#ifdef AIB_WITH_XML
#endif

namespace aib::io {

/// How poses are read. What is left out is told from the file or is the format's own.
struct trajectory_options {
  std::optional<pose_format> format = {};
  std::optional<pose_convention> convention = {};  ///< needed for NPY and unknown NPZ arrays
  std::optional<camera_axes> axes = {};
  quaternion_order quaternion = quaternion_order::xyzw;  ///< TUM only
  std::string key = {};                                  ///< NPZ only: the array of the poses
  std::vector<std::string> names = {};  ///< one a pose, for files that do not name their images
  image_extent size = {};               ///< for intrinsics of files that do not say it
};

/// The poses of a file or folder in the house's frame, with the intrinsics where it has any:
///
/// format             from                                       convention, axes
/// tum                `stamp tx ty tz qx qy qz qw` a line        world_from_camera, opencv
/// kitti              3 x 4 matrix a line                        world_from_camera, opencv
/// euroc              csv with stamps in ns                      world_from_body
/// log                Tanks and Temples                          world_from_camera, opencv
/// da3                camera_poses.txt, intrinsic.txt            world_from_camera, opencv
/// colmap             a model or a folder of models (largest)    its own
/// transforms         transforms.json (NeRF, nerfstudio)         world_from_camera, opengl
/// opensfm            reconstruction.json (largest component)    its own
/// metashape          cameras.xml                                its own
/// reality_capture    csv of internal and external parameters    its own
/// npy, npz           N x 4 x 4 or N x 3 x 4                     as told, opencv
/// npz                a folder of them, one an image (CUT3R)     as told, opencv
///
/// Throws io_error, format_error as the readers do; argument_error where an option does not fit the
/// format or the number of names is not that of the poses.
[[nodiscard]] posed_images read_posed_images(const std::filesystem::path& path,
                                             const trajectory_options& options = {});

/// The poses alone, see read_posed_images.
[[nodiscard]] pose::trajectory read_trajectory(const std::filesystem::path& path,
                                               const trajectory_options& options = {});

/// Image name -> camera, of every format that has intrinsics, see read_posed_images. Images without
/// a name are called by their index ("0", "1", ...).
/// Throws format_error where the file has no intrinsics.
[[nodiscard]] std::map<std::string, math::camera> read_cameras(
    const std::filesystem::path& path, const trajectory_options& options = {});

namespace detail {

[[noreturn]] inline void needs_library(const std::filesystem::path& path,
                                       std::string_view format,
                                       std::string_view library) {
  throw argument_error(message(path.string(), ": ", format, " is read with ", library,
                               ", which this program was built without"));
}

/// The file that is meant where a folder is given.
inline std::filesystem::path file_in(const std::filesystem::path& path, const char* name) {
  return std::filesystem::is_directory(path) ? path / name : path;
}

/// Reads one file in its format with the options that fit it.
class pose_reader {
 public:
  pose_reader(const std::filesystem::path& path,
              pose_format format,
              const trajectory_options& options)
      : path_(path), format_(format), options_(options) {}

  posed_images read() const {
    reject_unused_options();
    switch (format_) {
      case pose_format::tum:
        return {read_tum(path_, {frame(), options_.quaternion}), {}};
      case pose_format::kitti:
        return {read_kitti(path_, frame()), {}};
      case pose_format::euroc:
        return {read_euroc(path_, frame()), {}};
      case pose_format::log:
        return {read_tanks_and_temples(path_, frame()), {}};
      case pose_format::da3:
        return read_da3_streaming(path_, frame());
      case pose_format::colmap:
        return from_colmap();
      case pose_format::transforms:
        return from_transforms();
      case pose_format::opensfm:
        return from_opensfm();
      case pose_format::metashape:
        return from_metashape();
      case pose_format::reality_capture:
        return read_reality_capture(path_, options_.size);
      case pose_format::npy:
        return from_npy();
      case pose_format::npz:
        break;
    }
    return from_npz();
  }

 private:
  pose_frame frame(camera_axes axes = camera_axes::opencv) const {
    return {options_.convention.value_or(pose_convention::world_from_camera),
            options_.axes.value_or(axes)};
  }

  posed_images from_colmap() const {
    const bool folder = std::filesystem::is_directory(path_);
    const colmap_model model =
        read_colmap(folder ? path_ : path_.parent_path(), colmap_content::cameras_and_images);
    posed_images images{model.trajectory, {}};
    for (std::size_t i = 0; i < model.trajectory.size(); ++i)
      images.cameras.push_back(model.camera(i));
    return images;
  }

  posed_images from_npy() const {
    if (!options_.convention) {
      throw argument_error(message(path_.string(),
                                   ": an array does not tell its convention: world_from_camera or "
                                   "camera_from_world is to be given"));
    }
    return {poses_of_array(read_npy(path_), frame(), path_), {}};
  }

#ifdef AIB_WITH_NPZ
  posed_images from_npz() const {
    const pose_npz_options npz{options_.key, options_.convention, frame().axes};
    if (!std::filesystem::is_directory(path_)) return read_pose_npz(path_, npz);
    return read_pose_npz_folder(folder_of_npz(path_), npz);
  }
#else
  posed_images from_npz() const { needs_library(path_, "NPZ", "zlib"); }
#endif

#ifdef AIB_WITH_JSON
  posed_images from_transforms() const {
    return read_transforms(file_in(path_, "transforms.json"),
                           {frame(camera_axes::opengl), options_.size});
  }
  posed_images from_opensfm() const { return read_opensfm(file_in(path_, "reconstruction.json")); }
#else
  posed_images from_transforms() const { needs_library(path_, "JSON", "nlohmann-json"); }
  posed_images from_opensfm() const { needs_library(path_, "JSON", "nlohmann-json"); }
#endif

#ifdef AIB_WITH_XML
  posed_images from_metashape() const { return read_metashape(path_); }
#else
  posed_images from_metashape() const { needs_library(path_, "XML", "pugixml"); }
#endif

  void reject_unused_options() const {
    const auto reject = [&](std::string_view option) {
      throw argument_error(message(path_.string(), ": the option ", option,
                                   " does not fit the format ", name(format_)));
    };
    const bool own_frame = format_ == pose_format::colmap || format_ == pose_format::opensfm ||
                           format_ == pose_format::metashape ||
                           format_ == pose_format::reality_capture;
    if (own_frame && options_.convention) reject("convention");
    if (own_frame && options_.axes) reject("axes");
    if (format_ != pose_format::npz && !options_.key.empty()) reject("key");
    if (format_ != pose_format::tum && options_.quaternion != quaternion_order::xyzw)
      reject("quaternion");
  }

  const std::filesystem::path& path_;
  pose_format format_;
  const trajectory_options& options_;
};

}  // namespace detail

inline posed_images read_posed_images(const std::filesystem::path& path,
                                      const trajectory_options& options) {
  const pose_format format = options.format ? *options.format : detect_pose_format(path);
  posed_images images = detail::pose_reader(path, format, options).read();
  if (options.names.empty()) return images;
  if (options.names.size() != images.trajectory.size()) {
    throw argument_error(message(path.string(), ": ", options.names.size(), " names for ",
                                 images.trajectory.size(), " poses"));
  }
  images.trajectory.names = options.names;
  return images;
}

inline pose::trajectory read_trajectory(const std::filesystem::path& path,
                                        const trajectory_options& options) {
  return read_posed_images(path, options).trajectory;
}

inline std::map<std::string, math::camera> read_cameras(const std::filesystem::path& path,
                                                        const trajectory_options& options) {
  const posed_images images = read_posed_images(path, options);
  if (images.cameras.empty()) {
    throw format_error(path,
                       "no intrinsics in the file, or none without the images' width and height");
  }
  std::map<std::string, math::camera> cameras;
  const std::vector<std::string>& names = images.trajectory.names;
  for (std::size_t i = 0; i < images.cameras.size(); ++i)
    cameras[names.empty() ? message(i) : names[i]] = images.cameras[i];
  return cameras;
}

}  // namespace aib::io

// aib/io/trajectory_write.hpp

#ifdef AIB_WITH_JSON
#endif

namespace aib::io {

/// How poses are written. What is left out is told from the path or is the format's own.
struct trajectory_write_options {
  std::optional<pose_format> format = {};
  pose_frame frame = {};  ///< TUM and NPY only
  colmap_encoding encoding = colmap_encoding::binary;
};

/// Writes poses (and cameras, where the format holds them): tum, kitti, colmap (needs names and
/// cameras), transforms (needs names) or npy (N x 4 x 4).
///
/// Without a format: .json is transforms, .npy npy, .kitti kitti, .txt and .tum tum; a path without
/// an extension is the folder of a COLMAP model.
/// Throws argument_error where the format is not told or not written, or as the writers do.
void write_trajectory(const std::filesystem::path& path,
                      const posed_images& images,
                      const trajectory_write_options& options = {});

namespace detail {

inline pose_format format_to_write(const std::filesystem::path& path) {
  const auto extension = path.extension();
  if (extension == ".json") return pose_format::transforms;
  if (extension == ".npy") return pose_format::npy;
  if (extension == ".kitti") return pose_format::kitti;
  if (extension == ".txt" || extension == ".tum") return pose_format::tum;
  if (extension.empty()) return pose_format::colmap;
  throw argument_error(message("write_trajectory: ", path.string(),
                               ": the extension .txt, .tum, .kitti, .json or .npy expected, or a "
                               "format"));
}

}  // namespace detail

inline void write_trajectory(const std::filesystem::path& path,
                             const posed_images& images,
                             const trajectory_write_options& options) {
  const pose_format format = options.format ? *options.format : detail::format_to_write(path);
  const pose::trajectory& t = images.trajectory;
  const bool own_frame = options.frame.convention == pose_convention::world_from_camera &&
                         options.frame.axes == camera_axes::opencv;
  if (!own_frame && format != pose_format::tum && format != pose_format::npy)
    throw argument_error(message("write_trajectory: ", name(format), " has its own frame"));
  switch (format) {
    case pose_format::tum:
      return write_tum(path, t, {.frame = options.frame});
    case pose_format::kitti:
      return write_kitti(path, t);
    case pose_format::npy:
      return write_npy(path, array_of_poses(t, options.frame));
    case pose_format::colmap:
      return write_colmap(path, make_colmap_model(images), options.encoding);
#ifdef AIB_WITH_JSON
    case pose_format::transforms:
      return write_transforms(path, images);
#endif
    default:
      throw argument_error(message("write_trajectory: ", name(format),
                                   " is not written; tum, kitti, colmap, transforms, npy are"));
  }
}

}  // namespace aib::io

// aib/io/npz_write.hpp

#if defined(AIB_WITH_EXR) || defined(AIB_WITH_NPZ)
namespace aib::io {

/// Writes named arrays as an NPZ file, stored, as numpy.savez does; dates are those of the zip
/// format's beginning, so that the same arrays give the same bytes.
/// Throws argument_error where an array, or all of them, take more than 4 GB.
void write_npz(const std::filesystem::path& path,
               const std::vector<std::pair<std::string, array>>& arrays);

namespace detail {

/// Builds a zip file of stored members.
class zip_writer {
 public:
  void add(const std::string& name, const std::string& content) {
    const std::uint64_t offset = file_.size();
    if (offset + content.size() > max_offset)
      throw argument_error("write_npz: more than 4 GB in one file");
    const std::string member = member_fields(name, content);
    store(file_, zip_local);
    file_ += member + name + content;
    store(directory_, zip_central);
    store(directory_, version);
    directory_ += member;
    directory_ += std::string(10, '\0');  // comment, disk, attributes
    store(directory_, static_cast<std::uint32_t>(offset));
    directory_ += name;
    ++members_;
  }

  std::string finish() {
    const auto begin = static_cast<std::uint32_t>(file_.size());
    file_ += directory_;
    store(file_, zip_end);
    store(file_, std::uint32_t{0});
    store(file_, members_);
    store(file_, members_);
    store(file_, static_cast<std::uint32_t>(directory_.size()));
    store(file_, begin);
    store(file_, std::uint16_t{0});
    return std::move(file_);
  }

 private:
  static constexpr std::uint64_t max_offset = 0xfffffffe;
  static constexpr std::uint16_t version = 20;

  /// What the local header and the directory have in common.
  static std::string member_fields(const std::string& name, const std::string& content) {
    constexpr std::uint16_t january_1_1980 = 1 + (1 << 5);
    std::string fields;
    store(fields, version);
    store(fields, std::uint32_t{0});  // flags, method
    store(fields, std::uint16_t{0});  // time
    store(fields, january_1_1980);
    store(fields, crc32_of(content));
    store(fields, static_cast<std::uint32_t>(content.size()));
    store(fields, static_cast<std::uint32_t>(content.size()));
    store(fields, static_cast<std::uint16_t>(name.size()));
    store(fields, std::uint16_t{0});  // extra field
    return fields;
  }

  std::string file_;
  std::string directory_;
  std::uint16_t members_ = 0;
};

}  // namespace detail

inline void write_npz(const std::filesystem::path& path,
                      const std::vector<std::pair<std::string, array>>& arrays) {
  constexpr std::size_t max_members = 65534;
  if (arrays.size() > max_members)
    throw argument_error(
        message("write_npz: at most ", max_members, " arrays, found ", arrays.size()));
  detail::zip_writer zip;
  for (const auto& [name, a] : arrays) zip.add(name + ".npy", npy_bytes(a));
  write_file(path, zip.finish());
}

}  // namespace aib::io
#endif

// aib/math/angle_of.hpp

namespace aib::math {

inline namespace AIB_ISA {

/// Angles of the vectors (x, y), y >= 0, from the x axis, in radians, [0, pi], in four lanes:
/// within 5e-16 of std::atan2(y, x), none more than 7e-16 of itself; 0 for (0, 0). The same
/// bits on every machine.
///
/// The angle of the shorter over the longer side is that of a near centre, 0, pi/8 or pi/4, and the
/// arc tangent of at most tan(pi/16), by its Taylor series.
inline f64x4 angle_of(f64x4 x, f64x4 y) {
  constexpr double pi = std::numbers::pi;
  constexpr double tan_1 = 0.19891236737965800, tan_3 = 0.66817863791929891;  // of pi/16, 3 pi/16
  constexpr double tan_2 = std::numbers::sqrt2 - 1;
  const auto all = [](double value) { return f64x4::broadcast(value); };
  const f64x4 zero = all(0), width = max(x, zero - x);
  const f64x4 low = min(width, y),
              high = max(max(width, y), all(std::numeric_limits<double>::min()));

  const auto beyond = [&](double tangent, f64x4 yes, f64x4 no) {
    return choose(all(tangent) * high, low, yes, no);
  };
  const f64x4 tangent = beyond(tan_3, all(1), beyond(tan_1, all(tan_2), zero));
  const f64x4 centre = beyond(tan_3, all(pi / 4), beyond(tan_1, all(pi / 8), zero));
  const f64x4 u = (low - tangent * high) / (high + tangent * low);
  const f64x4 z = u * u;
  const auto term = [&](f64x4 higher, double n) { return all(1 / n) - higher * z; };
  f64x4 series = all(1.0 / 25);
  series = term(term(term(series, 23), 21), 19);
  series = term(term(term(series, 17), 15), 13);
  series = term(term(term(series, 11), 9), 7);
  series = term(term(series, 5), 3);
  f64x4 angle = centre + (u - u * (z * series));

  angle = choose(width, y, all(pi / 2) - angle, angle);
  return choose(x, zero, all(pi) - angle, angle);
}

}  // namespace AIB_ISA

}  // namespace aib::math

// aib/search/triangle_tree.hpp

namespace aib::search {

/// Corners of a triangle.
struct corners {
  float at[3][3];  ///< [corner][axis]

  corners() = default;
  corners(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c)
      : at{{a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}, {c.x(), c.y(), c.z()}} {}

  template <class Scalar>
  [[nodiscard]] Eigen::Matrix<Scalar, 3, 1> corner(int k) const {
    return Eigen::Vector3f(at[k]).cast<Scalar>();
  }
};

/// The part of a triangle that a point of it belongs to: its face, edge k (from corner k to the
/// next), or corner k.
enum class triangle_part { face, edge, corner };

/// The point of a triangle that is nearest to a query.
struct surface_point {
  Eigen::Vector3d position;
  triangle_part part = triangle_part::face;
  int k = 0;  ///< which edge or corner
};

/// The point of a triangle that is nearest to p. A triangle without area is treated as its edges.
/// Source: Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
[[nodiscard]] inline surface_point nearest_on_triangle(const Eigen::Vector3d& p,
                                                       const std::array<Eigen::Vector3d, 3>& t) {
  const Eigen::Vector3d ab = t[1] - t[0], ac = t[2] - t[0];
  const Eigen::Vector3d ap = p - t[0], bp = p - t[1], cp = p - t[2];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {t[0], triangle_part::corner, 0};
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {t[1], triangle_part::corner, 1};
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {t[2], triangle_part::corner, 2};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    return {t[0] + d1 / (d1 - d3) * ab, triangle_part::edge, 0};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return {t[1] + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t[2] - t[1]), triangle_part::edge, 1};
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    return {t[0] + d2 / (d2 - d6) * ac, triangle_part::edge, 2};
  }
  const double sum = va + vb + vc;
  return {t[0] + vb / sum * ab + vc / sum * ac, triangle_part::face, 0};
}

inline namespace AIB_ISA {

/// The range of a triangle on one axis.
inline std::pair<float, float> range_of(const corners& t, int axis) {
  return {std::min({t.at[0][axis], t.at[1][axis], t.at[2][axis]}),
          std::max({t.at[0][axis], t.at[1][axis], t.at[2][axis]})};
}

/// The triangle that is nearest to a query, and how near.
struct nearest_triangle {
  std::uint32_t place = 0;  ///< in the order of the tree
  double squared = std::numeric_limits<double>::infinity();
};

/// Triangles in the order of a curve under a tree of boxes, eight to a node. Triangles must be
/// finite and not empty.
class triangle_tree {
 public:
  triangle_tree(std::span<const corners> triangles,
                const curve& order,
                unsigned threads = 0,
                const control& control = {});

  [[nodiscard]] std::size_t size() const { return triangles_.size(); }

  /// Index, as given, of the triangle at a place.
  [[nodiscard]] std::uint32_t index(std::uint32_t place) const { return index_[place]; }

  /// Corners of the triangle at a place.
  [[nodiscard]] std::array<Eigen::Vector3d, 3> triangle(std::uint32_t place) const {
    const corners& t = triangles_[place];
    return {t.corner<double>(0), t.corner<double>(1), t.corner<double>(2)};
  }

  /// The nearest triangle, exact in double. `first_guess` is a place that is probably near; it
  /// changes the time, and among equally near triangles the answer, but not the distance.
  [[nodiscard]] nearest_triangle nearest(const Eigen::Vector3f& p, std::uint32_t first_guess) const;

 private:
  void try_triangle(const Eigen::Vector3d& p, std::uint32_t place, nearest_triangle& best) const;

  buffer<corners> triangles_;
  buffer<std::uint32_t> index_;
  std::vector<buffer<box_node>> levels_;
};

inline triangle_tree::triangle_tree(std::span<const corners> triangles,
                                    const curve& order,
                                    unsigned threads,
                                    const control& control)
    : triangles_(triangles.size()), index_(triangles.size()) {
  if (threads == 0) threads = available_threads();
  std::vector<Eigen::Vector3f> centres;
  centres.reserve(triangles.size());
  for (const corners& t : triangles)
    centres.push_back(t.corner<float>(0) / 3 + t.corner<float>(1) / 3 + t.corner<float>(2) / 3);
  const auto sorted = sort_along(centres, order, threads, control);
  const std::uint64_t mask = (std::uint64_t{1} << order.index_bits) - 1;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    index_[i] = static_cast<std::uint32_t>(sorted[i] & mask);
    triangles_[i] = triangles[index_[i]];
  }
  const std::span<const corners> leaves = triangles_.span();
  levels_.push_back(boxes_above(leaves, threads, control));
  while (levels_.back().size() > 1) {
    const std::span<const box_node> below = levels_.back().span();
    levels_.push_back(boxes_above(below, threads, control));
  }
}

inline void triangle_tree::try_triangle(const Eigen::Vector3d& p,
                                        std::uint32_t place,
                                        nearest_triangle& best) const {
  const Eigen::Vector3d offset = nearest_on_triangle(p, triangle(place)).position - p;
  const double squared = offset.squaredNorm();
  if (squared < best.squared) best = {place, squared};
}

/// Boxes are measured in float, each operation rounded once; a bound that is larger by more than
/// their sum of rounding errors never cuts off a nearer triangle.
inline float bound_above(double squared) {
  return static_cast<float>(std::min(squared * (1 + 1e-5), 3e38)) +
         std::numeric_limits<float>::min();
}

inline nearest_triangle triangle_tree::nearest(const Eigen::Vector3f& p,
                                               std::uint32_t first_guess) const {
  const query q(p.x(), p.y(), p.z());
  const Eigen::Vector3d exact = p.cast<double>();
  nearest_triangle best;
  try_triangle(exact, first_guess, best);
  pending_boxes pending;
  pending.push_root(levels_.size());
  while (!pending.empty()) {
    const pending_box box = pending.pop();
    const float bound = bound_above(best.squared);
    if (!(box.squared < bound)) continue;
    if (box.level == pending_box::leaf) {
      try_triangle(exact, box.index, best);
    } else {
      const f32x8 d = squared_distances(q.axis, q.axis, levels_[box.level][box.index]);
      pending.push_children(box, d, less(d, f32x8::broadcast(bound)));
    }
  }
  return best;
}

}  // namespace AIB_ISA
}  // namespace aib::search

// aib/mesh/distances.hpp

namespace aib::mesh {
inline namespace AIB_ISA {

/// The finite triangles of a mesh under a search tree, for many questions.
class surface_index {
 public:
  /// Throws undefined_error if no triangle is finite.
  explicit surface_index(const mesh& surface, unsigned threads = 0, const control& control = {});

  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  [[nodiscard]] const search::triangle_tree& tree() const { return tree_; }

  /// Index in the mesh of the triangle at a place of the tree.
  [[nodiscard]] std::size_t triangle_at(std::uint32_t place) const {
    return kept_[tree_.index(place)];
  }

 private:
  std::vector<search::corners> finite_triangles(const mesh& surface);
  static std::vector<Eigen::Vector3f> first_corners(std::span<const search::corners> triangles);

  Eigen::Vector3d origin_;
  std::vector<std::size_t> kept_;
  std::vector<search::corners> corners_;
  search::triangle_tree tree_;
};

/// Where on a mesh each point of a cloud is nearest.
struct closest_points {
  std::vector<float> distance;          ///< NaN for a point that is not finite
  std::vector<std::uint32_t> triangle;  ///< index in the mesh; ~0 for a point that is not finite
};

/// The nearest triangle of each point, exact.
/// Throws undefined_error if the cloud has no finite point.
closest_points closest(const cloud::cloud& points,
                       const surface_index& surface,
                       unsigned threads = 0,
                       const control& control = {});

/// Distances from the points of a cloud to the surface of a mesh: exact point-to-triangle
/// distances, without the floor that sampling the mesh would put under them.
///
/// Throws undefined_error if the cloud has no finite point or the mesh no finite triangle.
[[nodiscard]] cloud::distances distances(const cloud::cloud& points,
                                         const mesh& surface,
                                         const cloud::distance_options& options = {});

/// Compares an estimated cloud with a reference mesh: accuracy to the surface itself, completeness
/// and recall by samples of it (sample::mesh).
[[nodiscard]] cloud::comparison compare(const cloud::cloud& estimate,
                                        const mesh& reference,
                                        const cloud::cloud& samples,
                                        const cloud::compare_options& options = {});

inline std::vector<search::corners> surface_index::finite_triangles(const mesh& surface) {
  std::vector<search::corners> finite;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const Eigen::Vector3f corner[] = {surface.vertices[a], surface.vertices[b],
                                      surface.vertices[c]};
    if (!std::all_of(corner, corner + 3, cloud::is_finite)) continue;
    finite.emplace_back(corner[0], corner[1], corner[2]);
    kept_.push_back(t);
  }
  if (finite.empty()) {
    throw undefined_error(
        message("mesh::distances: no finite triangle (", surface.triangles.size(), " triangles)"));
  }
  return finite;
}

inline std::vector<Eigen::Vector3f> surface_index::first_corners(
    std::span<const search::corners> triangles) {
  std::vector<Eigen::Vector3f> first;
  first.reserve(triangles.size());
  for (const search::corners& t : triangles) first.push_back(t.corner<float>(0));
  return first;
}

inline surface_index::surface_index(const mesh& surface, unsigned threads, const control& control)
    : origin_(surface.origin),
      corners_(finite_triangles(surface)),
      tree_(corners_, search::common_curve(first_corners(corners_), {}), threads, control) {}

inline closest_points closest(const cloud::cloud& points,
                              const surface_index& surface,
                              unsigned threads,
                              const control& control) {
  const cloud::finite_points from(points, surface.origin());
  cloud::detail::demand_points("mesh::distances", "estimated", from);
  if (threads == 0) threads = available_threads();
  const search::curve order = search::common_curve(from.points(), {});
  const auto sorted = search::sort_along(from.points(), order, threads, control);
  const std::uint64_t mask = (std::uint64_t{1} << order.index_bits) - 1;
  closest_points found{std::vector<float>(points.size(), std::numeric_limits<float>::quiet_NaN()),
                       std::vector<std::uint32_t>(points.size(), ~std::uint32_t{0})};
  for_each_chunk(sorted.size(), 4096, threads, control, [&](const chunk& c) {
    std::uint32_t near = 0;
    for (std::size_t i = c.begin; i < c.end; ++i) {
      const std::size_t p = sorted[i] & mask;
      const auto best = surface.tree().nearest(from.points()[p], near);
      near = best.place;
      found.distance[from.source_index(p)] = static_cast<float>(std::sqrt(best.squared));
      found.triangle[from.source_index(p)] =
          static_cast<std::uint32_t>(surface.triangle_at(best.place));
    }
  });
  return found;
}

inline cloud::distances distances(const cloud::cloud& points,
                                  const mesh& surface,
                                  const cloud::distance_options& options) {
  const surface_index index(surface, options.threads, options.control);
  auto found = closest(points, index, options.threads, options.control);
  return cloud::distances(std::move(found.distance), options);
}

inline cloud::comparison compare(const cloud::cloud& estimate,
                                 const mesh& reference,
                                 const cloud::cloud& samples,
                                 const cloud::compare_options& options) {
  const cloud::distance_options how{.max_distance = options.max_distance,
                                    .rule = options.rule,
                                    .threads = options.threads,
                                    .control = options.control};
  return cloud::score(distances(estimate, reference, how), cloud::distances(samples, estimate, how),
                      options.tau);
}

}  // namespace AIB_ISA
}  // namespace aib::mesh

// aib/mesh/edges.hpp

namespace aib::mesh {

/// For each triangle the same with corners at one position under one number, so that a mesh whose
/// vertices are repeated (STL, textured OBJ) holds together.
[[nodiscard]] inline std::vector<triangle> welded(const mesh& m) {
  std::vector<std::uint32_t> order(m.vertices.size());
  for (std::size_t v = 0; v < order.size(); ++v) order[v] = static_cast<std::uint32_t>(v);
  const auto coordinates = [&](std::uint32_t v) {
    const Eigen::Vector3f& p = m.vertices[v];
    return std::array{p.x() + 0.0f, p.y() + 0.0f, p.z() + 0.0f};  // -0 as 0
  };
  std::erase_if(order, [&](std::uint32_t v) { return !m.vertices[v].allFinite(); });
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto at_a = coordinates(a), at_b = coordinates(b);
    return at_a != at_b ? at_a < at_b : a < b;
  });
  std::vector<std::uint32_t> first(m.vertices.size());
  for (std::size_t v = 0; v < first.size(); ++v) first[v] = static_cast<std::uint32_t>(v);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (coordinates(order[i]) == coordinates(order[i - 1])) first[order[i]] = first[order[i - 1]];
  }
  std::vector<triangle> triangles;
  triangles.reserve(m.triangles.size());
  for (const auto& [a, b, c] : m.triangles) triangles.push_back({first[a], first[b], first[c]});
  return triangles;
}

/// Directed edges that have no twin: 0 for a watertight mesh, in which every edge is passed as
/// often one way as the other. Triangles with two corners at one place play no part.
[[nodiscard]] inline std::size_t n_open_edges(const mesh& m) {
  std::vector<std::array<std::uint32_t, 3>> edges;  // both ends ascending, then the direction
  for (const triangle& t : welded(m)) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::size_t open = 0;
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    std::ptrdiff_t balance = 0;
    for (; last < edges.size() && edges[last][0] == edges[first][0] &&
           edges[last][1] == edges[first][1];
         ++last) {
      balance += edges[last][2] == 1 ? 1 : -1;
    }
    open += static_cast<std::size_t>(balance < 0 ? -balance : balance);
  }
  return open;
}

/// Whether the mesh encloses a volume: it has triangles, and every edge joins them pairwise with
/// agreeing sides.
[[nodiscard]] inline bool is_watertight(const mesh& m) {
  return !m.empty() && n_open_edges(m) == 0;
}

}  // namespace aib::mesh

// aib/mesh/face_scores.hpp

namespace aib::mesh {

/// What a reconstruction got right, face by face of the reference. NaN where a face has no point.
struct face_scores {
  std::vector<float> accuracy;      ///< mean distance of the estimated points nearest to the face
  std::vector<float> completeness;  ///< mean distance from samples of the face to the estimate
  std::vector<float> recall;        ///< share of these samples strictly below tau
  std::vector<std::size_t> n_estimate;
  std::vector<std::size_t> n_samples;
};

namespace detail {

/// Means of values by face.
class face_means {
 public:
  explicit face_means(std::size_t n_faces) : sum_(n_faces), n_(n_faces) {}

  void add(std::uint32_t face, double value) {
    if (face >= n_.size() || !std::isfinite(value)) return;
    sum_[face] += value;
    ++n_[face];
  }
  [[nodiscard]] std::vector<float> values() const {
    std::vector<float> mean;
    for (std::size_t f = 0; f < n_.size(); ++f) {
      mean.push_back(n_[f] == 0 ? std::numeric_limits<float>::quiet_NaN()
                                : static_cast<float>(sum_[f] / static_cast<double>(n_[f])));
    }
    return mean;
  }
  [[nodiscard]] const std::vector<std::size_t>& counts() const { return n_; }

 private:
  std::vector<double> sum_;
  std::vector<std::size_t> n_;
};

}  // namespace detail

inline namespace AIB_ISA {

/// Scores of each face, to be written as scalars and colours of the mesh.
///
/// samples   points on the mesh (sample::mesh); each belongs to the face nearest to it
/// tau       threshold of recall
///
/// A point farther than max_distance counts for no face with `drop`, as that far with `clamp`.
/// Throws undefined_error if the estimate or the samples have no finite point or the mesh has no
/// finite triangle.
[[nodiscard]] inline face_scores scores_by_face(const cloud::cloud& estimate,
                                                const mesh& reference,
                                                const cloud::cloud& samples,
                                                double tau,
                                                const cloud::distance_options& options = {}) {
  const surface_index index(reference, options.threads, options.control);
  auto near = closest(estimate, index, options.threads, options.control);
  const cloud::distances to_surface(std::move(near.distance), options);
  const auto sampled = closest(samples, index, options.threads, options.control);
  const cloud::distances to_estimate(samples, estimate, options);
  const std::size_t n = reference.triangles.size();
  detail::face_means accuracy(n), completeness(n), recall(n);
  for (std::size_t i = 0; i < to_surface.size(); ++i) accuracy.add(near.triangle[i], to_surface[i]);
  for (std::size_t i = 0; i < to_estimate.size(); ++i) {
    completeness.add(sampled.triangle[i], to_estimate[i]);
    if (!std::isnan(to_estimate[i])) recall.add(sampled.triangle[i], to_estimate[i] < tau);
  }
  return {accuracy.values(), completeness.values(), recall.values(), accuracy.counts(),
          recall.counts()};
}

/// The label of the face nearest to each point; 0 for a point that is not finite.
/// Throws argument_error if the mesh has no labels.
[[nodiscard]] inline std::vector<std::uint32_t> nearest_labels(const cloud::cloud& points,
                                                               const mesh& surface,
                                                               unsigned threads = 0,
                                                               const control& control = {}) {
  if (surface.labels.size() != surface.triangles.size()) {
    throw argument_error("mesh::nearest_labels: a mesh with labels expected");
  }
  const auto near = closest(points, surface_index(surface, threads, control), threads, control);
  std::vector<std::uint32_t> labels(points.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (near.triangle[i] < surface.labels.size()) labels[i] = surface.labels[near.triangle[i]];
  }
  return labels;
}

}  // namespace AIB_ISA
}  // namespace aib::mesh

// aib/mesh/surface.hpp

namespace aib::mesh {

/// Corners of a triangle, counted from the origin of its mesh.
[[nodiscard]] inline std::array<Eigen::Vector3d, 3> corners(const mesh& m, std::size_t t) {
  const auto& [a, b, c] = m.triangles[t];
  return {m.vertices[a].cast<double>(), m.vertices[b].cast<double>(), m.vertices[c].cast<double>()};
}

/// Area of a triangle; 0 where a corner is not finite.
[[nodiscard]] inline double area(const mesh& m, std::size_t t) {
  const auto [a, b, c] = corners(m, t);
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const double twice = ab.cross(ac).norm();
  return std::isfinite(twice) ? twice / 2 : 0;
}

/// Area of all triangles.
[[nodiscard]] inline double area(const mesh& m) {
  double total = 0;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) total += area(m, t);
  return total;
}

}  // namespace aib::mesh

// aib/mesh/offsets.hpp

namespace aib::mesh {

/// The outward direction at each part of a closed surface: a face's normal, at an edge the sum of
/// those of its faces, at a corner the sum weighted by angle. Its side of a nearest point is the
/// side of the surface.
/// Source: Bærentzen and Aanæs, IEEE TVCG 2005, theorem 1.
class pseudonormals {
 public:
  explicit pseudonormals(const mesh& m) : triangles_(welded(m)), corner_(m.vertices.size()) {
    std::fill(corner_.begin(), corner_.end(), Eigen::Vector3d(0, 0, 0));
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto at = corners(m, t);
      const Eigen::Vector3d ab = at[1] - at[0], ac = at[2] - at[0];
      const Eigen::Vector3d normal = ab.cross(ac).normalized();
      face_.push_back(normal.allFinite() ? normal : Eigen::Vector3d(0, 0, 0));
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d next = at[(k + 1) % 3] - at[k], last = at[(k + 2) % 3] - at[k];
        const double angle = std::atan2(next.cross(last).norm(), next.dot(last));
        if (std::isfinite(angle)) corner_[triangles_[t][k]] += angle * face_[t];
        edge_.try_emplace(edge_of(t, k), 0, 0, 0).first->second += face_[t];
      }
    }
  }

  [[nodiscard]] const Eigen::Vector3d& at(std::size_t t, const search::surface_point& p) const {
    const auto k = static_cast<std::size_t>(p.k);
    if (p.part == search::triangle_part::face) return face_[t];
    if (p.part == search::triangle_part::edge) return edge_.at(edge_of(t, k));
    return corner_[triangles_[t][k]];
  }

 private:
  using edge = std::pair<std::uint32_t, std::uint32_t>;

  [[nodiscard]] edge edge_of(std::size_t t, std::size_t k) const {
    return std::minmax(triangles_[t][k], triangles_[t][(k + 1) % 3]);
  }

  std::vector<triangle> triangles_;
  std::vector<Eigen::Vector3d> face_, corner_;
  std::map<edge, Eigen::Vector3d> edge_;
};

inline namespace AIB_ISA {

/// Signed distance from each point to a closed surface: positive outside, negative inside, exact.
///
/// Faces count as seen from outside counter-clockwise. A mesh that is not watertight has no inside:
/// throws argument_error with the number of its open edges. Throws undefined_error if the cloud has
/// no finite point or the mesh no finite triangle.
[[nodiscard]] inline cloud::offsets offsets(const cloud::cloud& points,
                                            const mesh& surface,
                                            unsigned threads = 0,
                                            const control& control = {}) {
  if (const std::size_t open = n_open_edges(surface); open > 0 || surface.empty()) {
    throw argument_error(
        message("mesh::offsets: a watertight mesh expected, found ", open, " open edges"));
  }
  const surface_index index(surface, threads, control);
  const pseudonormals outward(surface);
  auto found = closest(points, index, threads, control);
  for_each_chunk(points.size(), 4096, threads, control, [&](const chunk& c) {
    for (std::size_t i = c.begin; i < c.end; ++i) {
      const std::uint32_t t = found.triangle[i];
      if (t == ~std::uint32_t{0}) continue;
      const Eigen::Vector3d p = points.position(i) - surface.origin;
      const auto nearest = search::nearest_on_triangle(p, corners(surface, t));
      if ((p - nearest.position).dot(outward.at(t, nearest)) < 0) {
        found.distance[i] = -found.distance[i];
      }
    }
  });
  return cloud::offsets(std::move(found.distance));
}

}  // namespace AIB_ISA
}  // namespace aib::mesh

// aib/mesh/transform.hpp

namespace aib::mesh {

/// The mesh in frame b. Vertices are moved in double and counted from their new natural origin.
[[nodiscard]] inline mesh operator*(const math::sim3& b_from_a, const mesh& in_a) {
  cloud::placed_points placed = cloud::place(
      in_a.vertices.size(), [&](std::size_t i) { return b_from_a * in_a.position(i); });
  mesh in_b = in_a;
  in_b.origin = placed.origin;
  in_b.vertices = std::move(placed.points);
  return in_b;
}

[[nodiscard]] inline mesh operator*(const math::rigid3& b_from_a, const mesh& in_a) {
  return math::sim3{1, b_from_a.rotation, b_from_a.translation} * in_a;
}

}  // namespace aib::mesh

// aib/pose/angle_bins.hpp

namespace aib::pose {

/// Bins of angles between ascending edges in degrees: bin k holds edge[k - 1] <= angle < edge[k].
class angle_bins {
 public:
  /// Sorts the edges and drops repeated ones. Throws argument_error unless each is in (0, 360].
  explicit angle_bins(std::vector<double> edges_deg) : edges_deg_(std::move(edges_deg)) {
    for (const double e : edges_deg_) {
      if (e > 0 && e <= 360) continue;
      throw argument_error(message("angle_bins: edges in (0, 360] degrees expected, found ", e));
    }
    std::sort(edges_deg_.begin(), edges_deg_.end());
    edges_deg_.erase(std::unique(edges_deg_.begin(), edges_deg_.end()), edges_deg_.end());
  }

  [[nodiscard]] std::size_t size() const { return edges_deg_.size() + 1; }
  [[nodiscard]] const std::vector<double>& edges_deg() const { return edges_deg_; }

  /// Bin of an angle: the number of edges that it reaches.
  [[nodiscard]] std::size_t find(double angle_deg) const {
    return static_cast<std::size_t>(
        std::upper_bound(edges_deg_.begin(), edges_deg_.end(), angle_deg) - edges_deg_.begin());
  }

  /// Number of bins that lie wholly below an edge. Throws argument_error if it is none of ours.
  [[nodiscard]] std::size_t bins_below(double edge_deg) const {
    const auto at = std::lower_bound(edges_deg_.begin(), edges_deg_.end(), edge_deg);
    if (at == edges_deg_.end() || *at != edge_deg)
      throw argument_error(message("angle_bins: ", edge_deg, " degrees is not an edge"));
    return static_cast<std::size_t>(at - edges_deg_.begin()) + 1;
  }

 private:
  std::vector<double> edges_deg_;
};

/// Finds the bin of an angle from a key in [0, 1] that grows or falls with it, without a root or an
/// arc function. The leading bits of the key choose a cell. Most cells lie within one bin; the
/// others name their first edge, and the key is compared. Where it is too near to an edge for its
/// rounding, the table does not know, and the caller calculates the angle.
class key_table {
 public:
  /// Added to the number of an edge in place of a bin.
  static constexpr std::uint32_t edge = 1u << 30;

  /// Keys nearer to an edge than this are not trusted: tens of roundings of a key in [0, 1].
  static constexpr double doubt = 1e-14;

  /// Cell of a key. All keys below the lowest share one.
  static constexpr std::size_t cell_of(double key) {
    return (std::bit_cast<std::uint64_t>(key > lowest ? key : lowest) >> shift) - first;
  }

  /// Cells of a table.
  static constexpr std::size_t size() { return cell_of(1) + 1; }

  /// keys   of the edges, in any order
  /// bin    bin of a key, std::size_t(double); below `edge`
  template <class BinOfKey>
  key_table(std::vector<double> keys, BinOfKey&& bin) : edges_(std::move(keys)), cells_(size()) {
    std::sort(edges_.begin(), edges_.end());
    for (std::size_t k = 0; k <= edges_.size(); ++k) {
      const double low = k == 0 ? 0 : edges_[k - 1], high = k == edges_.size() ? 1 : edges_[k];
      bins_.push_back(static_cast<std::uint32_t>(bin((low + high) / 2)));
      fill(low, high, bins_.back());
    }
    for (std::size_t k = edges_.size(); k-- > 0;)
      fill(edges_[k] - doubt, edges_[k] + doubt, edge + static_cast<std::uint32_t>(k));
  }

  /// One a cell: the bin of all its keys, or `edge` and its first edge.
  [[nodiscard]] const std::vector<std::uint32_t>& cells() const { return cells_; }

  /// The bin of a key; nothing where an edge is too near.
  [[nodiscard]] std::optional<std::uint32_t> find(double key) const {
    const std::uint32_t cell = cells_[cell_of(key)];
    if (cell < edge) return cell;
    std::size_t k = cell - edge;
    while (k < edges_.size() && key > edges_[k] + doubt) ++k;
    if (k < edges_.size() && key >= edges_[k] - doubt) return std::nullopt;
    return bins_[k];
  }

 private:
  static constexpr double lowest = 0x1p-14;
  static constexpr int shift = 43;  // leaves 9 of 52 fraction bits: 512 cells an octave
  static constexpr std::uint64_t first = std::bit_cast<std::uint64_t>(lowest) >> shift;

  void fill(double low, double high, std::uint32_t value) {
    const auto cell = [&](double key) {
      return cells_.begin() + static_cast<std::ptrdiff_t>(cell_of(std::min(key, 1.0)));
    };
    std::fill(cell(low), cell(high) + 1, value);
  }

  std::vector<double> edges_;
  std::vector<std::uint32_t> bins_;  // below the first edge, between two, above the last
  std::vector<std::uint32_t> cells_;
};

/// Table of rotation errors; their key is sin^2 of half the angle. A bin counts `stride`.
[[nodiscard]] inline key_table rotation_table(const angle_bins& bins, std::size_t stride = 1) {
  std::vector<double> keys;
  for (const double e : bins.edges_deg()) {
    const double s = std::sin(math::radians(e) / 2);
    if (e <= 180) keys.push_back(s * s);
  }
  return {std::move(keys), [&](double key) {
            return stride * bins.find(math::degrees(2 * std::asin(std::sqrt(key))));
          }};
}

/// Table of direction errors below 90 degrees; their key is sin^2 of the angle.
[[nodiscard]] inline key_table front_table(const angle_bins& bins) {
  std::vector<double> keys;
  for (const double e : bins.edges_deg()) {
    const double s = std::sin(math::radians(e));
    if (e <= 90) keys.push_back(s * s);
  }
  return {std::move(keys),
          [&](double key) { return bins.find(math::degrees(std::asin(std::sqrt(key)))); }};
}

/// Table of direction errors above 90 degrees; their key is sin^2 of what is missing to 180.
[[nodiscard]] inline key_table back_table(const angle_bins& bins) {
  std::vector<double> keys;
  for (const double e : bins.edges_deg()) {
    const double s = std::sin(math::radians(180 - e));
    if (e >= 90 && e <= 180) keys.push_back(s * s);
  }
  return {std::move(keys),
          [&](double key) { return bins.find(180 - math::degrees(std::asin(std::sqrt(key)))); }};
}

}  // namespace aib::pose

// aib/stats/summary.hpp

namespace aib::stats {

/// Statistics of a set of errors, named as evo names them.
struct summary {
  std::uint64_t count;
  double rmse;
  double mean;
  double median;
  double std;  ///< population (ddof 0)
  double min;
  double max;
  double sse;  ///< sum of squares
};

/// Throws undefined_error if there is no value.
inline summary summarize(std::span<const double> errors) {
  if (errors.empty()) throw undefined_error("stats::summarize: no values");
  moments m;
  double sse = 0;
  for (const double e : errors) {
    m.add(e);
    sse += e * e;
  }
  return {.count = m.count(),
          .rmse = std::sqrt(sse / static_cast<double>(m.count())),
          .mean = m.mean(),
          .median = median(errors),
          .std = m.deviation(),
          .min = m.min(),
          .max = m.max(),
          .sse = sse};
}

}  // namespace aib::stats

// aib/pose/pose_relation.hpp

namespace aib::pose {

/// What of the motion between two poses is the error, as evo names it.
enum class pose_relation {
  translation,           ///< |t|
  rotation_part,         ///< |R - I|, Frobenius
  full,                  ///< |[R t] - [I 0]|, Frobenius
  angle_deg,             ///< angle of R
  angle_rad,             ///< angle of R
  point_distance,        ///< difference of two distances (rpe); the distance itself (ape)
  point_distance_ratio,  ///< rpe: that difference in percent of the reference's distance
};

inline constexpr std::array<std::string_view, 7> pose_relation_names = {
    "translation",    "rotation_part",        "full", "angle_deg", "angle_rad",
    "point_distance", "point_distance_ratio",
};

[[nodiscard]] constexpr std::string_view name(pose_relation r) {
  return pose_relation_names[static_cast<std::size_t>(r)];
}

/// Errors of frames or of pairs of frames, and their statistics.
struct pose_errors {
  stats::summary summary;
  std::vector<double> errors;      ///< one a frame or pair
  std::vector<std::size_t> index;  ///< the frame of each, the later one of a pair
};

/// Size of a motion that should be none.
[[nodiscard]] inline double magnitude(pose_relation relation, const math::rigid3& error) {
  const double rotation = (error.rotation - Eigen::Matrix3d::Identity()).norm();
  switch (relation) {
    case pose_relation::rotation_part:
      return rotation;
    case pose_relation::full:
      return std::hypot(rotation, error.translation.norm());
    case pose_relation::angle_deg:
      return math::degrees(math::rotation_angle(error.rotation));
    case pose_relation::angle_rad:
      return math::rotation_angle(error.rotation);
    default:
      return error.translation.norm();
  }
}

}  // namespace aib::pose

// aib/pose/ape.hpp

namespace aib::pose {

struct ape_options {
  pose_relation relation = pose_relation::translation;
};

/// Absolute pose error: of each frame the motion E = est^-1 ref. Aligns nothing. Frames without a
/// finite pose are passed over.
///
/// Invariant to a common rigid motion. Throws argument_error if the trajectories are not associated
/// or the relation is a ratio, undefined_error if no frame is registered on both sides.
/// Source: Sturm et al., IROS 2012, Sec. IV-B; evo, core/metrics.py, APE.
inline pose_errors ape(const trajectory& estimate,
                       const trajectory& reference,
                       const ape_options& options = {}) {
  if (options.relation == pose_relation::point_distance_ratio)
    throw argument_error("ape: point_distance_ratio is a relation of pairs; see rpe");
  const registered_frames frames = registered("ape", estimate, reference);
  if (frames.index.empty()) {
    throw undefined_error(
        message("ape: none of ", estimate.size(), " frames has a finite pose on both sides"));
  }
  pose_errors out{.summary = {}, .errors = {}, .index = frames.index};
  for (std::size_t i = 0; i < frames.index.size(); ++i)
    out.errors.push_back(
        magnitude(options.relation, frames.estimate[i].inverse() * frames.reference[i]));
  out.summary = stats::summarize(out.errors);
  return out;
}

}  // namespace aib::pose

// aib/pose/associate.hpp

namespace aib::pose {

enum class match_by { name, stamp, index };

/// How often a pose may be matched.
enum class association_rule {
  one_to_one,
  evo,  ///< each pose of the shorter trajectory takes its nearest stamp, taken or not
};

struct associate_options {
  match_by by = match_by::name;
  double max_gap_s = 0.01;        ///< stamps: largest difference, inclusive
  double offset_s = 0;            ///< stamps: added to those of the estimate
  bool ignore_case = false;       ///< names: IMG_1.jpg is img_1.jpg
  bool ignore_extension = false;  ///< names: 0001.png is 0001.exr
  bool ignore_folder = false;     ///< names: images/0001.png is 0001.png
  association_rule rule = association_rule::one_to_one;
};

/// Poses that belong together, and what was left out.
struct association {
  trajectory estimate;                      ///< in the order of the reference (evo: of the shorter)
  trajectory reference;                     ///< as long
  std::vector<std::size_t> estimate_index;  ///< where each pose stood
  std::vector<std::size_t> reference_index;  ///< where each pose stood
  std::size_t n_matched;
  std::size_t n_estimate_only;   ///< poses of the estimate without a partner
  std::size_t n_reference_only;  ///< poses of the reference without a partner
};

/// Pairs the poses of an estimate with those of a reference: by image name, by the nearest time
/// stamp (closest pairs first, each pose once), or by position in the list.
///
/// Throws argument_error if names (stamps) are missing or not unique under the rules,
/// undefined_error if no pose matches; it says which rule on names would have helped.
association associate(const trajectory& estimate,
                      const trajectory& reference,
                      const associate_options& options = {});

namespace detail {

struct index_pair {
  std::size_t estimate;
  std::size_t reference;
};

inline std::string name_key(std::string_view name, const associate_options& rules) {
  if (rules.ignore_folder) {
    const std::size_t slash = name.find_last_of("/\\");
    if (slash != std::string_view::npos) name.remove_prefix(slash + 1);
  }
  if (rules.ignore_extension) {
    const std::size_t slash = name.find_last_of("/\\"), dot = name.find_last_of('.');
    const std::size_t stem = slash == std::string_view::npos ? 0 : slash + 1;
    if (dot != std::string_view::npos && dot > stem) name = name.substr(0, dot);
  }
  std::string key(name);
  if (rules.ignore_case) {
    for (char& c : key) {
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
  }
  return key;
}

inline std::unordered_map<std::string, std::size_t> name_table(std::string_view whose,
                                                               const trajectory& t,
                                                               const associate_options& rules) {
  std::unordered_map<std::string, std::size_t> table;
  for (std::size_t i = 0; i < t.names.size(); ++i) {
    const auto [at, fresh] = table.emplace(name_key(t.names[i], rules), i);
    if (fresh) continue;
    throw argument_error(message("associate: two poses of the ", whose, " have one name: \"",
                                 t.names[at->second], "\" and \"", t.names[i], "\""));
  }
  return table;
}

inline std::vector<index_pair> match_names(const trajectory& estimate,
                                           const trajectory& reference,
                                           const associate_options& options) {
  if (estimate.names.size() != estimate.size() || reference.names.size() != reference.size())
    throw argument_error("associate: by name, but not every pose has one; try stamp or index");
  const auto table = name_table("estimate", estimate, options);
  name_table("reference", reference, options);
  std::vector<index_pair> pairs;
  for (std::size_t r = 0; r < reference.size(); ++r) {
    const auto at = table.find(name_key(reference.names[r], options));
    if (at != table.end()) pairs.push_back({at->second, r});
  }
  return pairs;
}

/// Indices of stamps in ascending order, equal ones in their own order.
inline std::vector<std::size_t> by_stamp(const std::vector<double>& stamps) {
  std::vector<std::size_t> order(stamps.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stamps[a] < stamps[b]; });
  return order;
}

/// A sorted list whose places are taken one after another.
class free_places {
 public:
  explicit free_places(std::size_t n) : left_(n + 1), right_(n + 1) {
    std::iota(left_.begin(), left_.end(), std::size_t{0});
    std::iota(right_.begin(), right_.end(), std::size_t{0});
  }
  /// Nearest free place at or above i; the length where there is none.
  std::size_t at_or_above(std::size_t i) { return root(right_, i); }
  /// One more than the nearest free place below i; 0 where there is none.
  std::size_t end_below(std::size_t i) { return root(left_, i); }
  void take(std::size_t i) {
    right_[i] = i + 1;
    left_[i + 1] = i;
  }

 private:
  static std::size_t root(std::vector<std::size_t>& parent, std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  std::vector<std::size_t> left_, right_;
};

/// Pairs in ascending order of their gap, each stamp once.
inline std::vector<index_pair> match_stamps(const std::vector<double>& estimate,
                                            const std::vector<double>& reference,
                                            const associate_options& options) {
  const std::vector<std::size_t> order = by_stamp(reference);
  struct candidate {
    double gap;
    std::size_t place, estimate;
    bool operator>(const candidate& o) const {
      if (gap != o.gap) return gap > o.gap;
      return place != o.place ? place > o.place : estimate > o.estimate;
    }
  };
  std::priority_queue<candidate, std::vector<candidate>, std::greater<>> nearest;
  free_places places(order.size());
  const auto offer = [&](std::size_t e, std::size_t place) {
    const double gap = std::abs(reference[order[place]] - (estimate[e] + options.offset_s));
    if (gap <= options.max_gap_s) nearest.push({gap, place, e});
  };
  const auto place_of = [&](std::size_t e) {
    const auto at =
        std::lower_bound(order.begin(), order.end(), estimate[e] + options.offset_s,
                         [&](std::size_t r, double stamp) { return reference[r] < stamp; });
    return static_cast<std::size_t>(at - order.begin());
  };
  const auto offer_neighbours = [&](std::size_t e) {
    const std::size_t above = places.at_or_above(place_of(e)),
                      below = places.end_below(place_of(e));
    if (above < order.size()) offer(e, above);
    if (below > 0) offer(e, below - 1);
  };
  for (std::size_t e = 0; e < estimate.size(); ++e) offer_neighbours(e);
  std::vector<bool> matched(estimate.size());
  std::vector<index_pair> pairs;
  while (!nearest.empty()) {
    const candidate c = nearest.top();
    nearest.pop();
    if (matched[c.estimate]) continue;
    if (places.at_or_above(c.place) != c.place) {  // taken meanwhile
      offer_neighbours(c.estimate);
      continue;
    }
    places.take(c.place);
    matched[c.estimate] = true;
    pairs.push_back({c.estimate, order[c.place]});
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const index_pair& a, const index_pair& b) { return a.reference < b.reference; });
  return pairs;
}

/// evo's core/sync.py: every stamp of the shorter list, nearest one of the longer, repetitions
/// kept.
inline std::vector<index_pair> match_stamps_as_evo(const std::vector<double>& estimate,
                                                   const std::vector<double>& reference,
                                                   const associate_options& options) {
  const bool estimate_longer = estimate.size() > reference.size();
  const auto& shorter = estimate_longer ? reference : estimate;
  const auto& longer = estimate_longer ? estimate : reference;
  const double offset = estimate_longer ? options.offset_s : -options.offset_s;
  const std::vector<std::size_t> order = by_stamp(longer);
  std::vector<index_pair> pairs;
  for (std::size_t s = 0; s < shorter.size(); ++s) {
    std::optional<std::size_t> best;
    double best_gap = std::numeric_limits<double>::infinity();
    const auto at =
        std::lower_bound(order.begin(), order.end(), shorter[s] - offset,
                         [&](std::size_t l, double stamp) { return longer[l] < stamp; });
    const auto begin = at - std::min<std::ptrdiff_t>(at - order.begin(), 2);
    const auto end = at + std::min<std::ptrdiff_t>(order.end() - at, 2);
    for (auto l = begin; l != end; ++l) {
      const double gap = std::abs(shorter[s] - (longer[*l] + offset));
      if (gap < best_gap || (gap == best_gap && *l < *best)) {
        best = *l;
        best_gap = gap;
      }
    }
    if (!best || !(best_gap <= options.max_gap_s)) continue;
    pairs.push_back(estimate_longer ? index_pair{*best, s} : index_pair{s, *best});
  }
  return pairs;
}

inline std::vector<index_pair> match_stamps(const trajectory& estimate,
                                            const trajectory& reference,
                                            const associate_options& options) {
  if (estimate.stamps_s.size() != estimate.size() || reference.stamps_s.size() != reference.size())
    throw argument_error("associate: by stamp, but not every pose has one; try name or index");
  for (const auto* stamps : {&estimate.stamps_s, &reference.stamps_s}) {
    for (const double s : *stamps) {
      if (!std::isfinite(s)) throw argument_error("associate: a stamp is not finite");
    }
  }
  return options.rule == association_rule::evo
             ? match_stamps_as_evo(estimate.stamps_s, reference.stamps_s, options)
             : match_stamps(estimate.stamps_s, reference.stamps_s, options);
}

inline std::vector<index_pair> match_indices(std::size_t n) {
  std::vector<index_pair> pairs;
  for (std::size_t i = 0; i < n; ++i) pairs.push_back({i, i});
  return pairs;
}

/// What a user may try who got nothing.
inline std::string advice(const trajectory& estimate,
                          const trajectory& reference,
                          const associate_options& options) {
  if (options.by == match_by::stamp)
    return message("; stamps within ", options.max_gap_s, " s expected");
  if (options.by == match_by::index) return "";
  const std::string names = estimate.empty() || reference.empty()
                                ? ""
                                : message(", \"", estimate.names.front(), "\" in the one, \"",
                                          reference.names.front(), "\" in the other");
  associate_options loose = options;
  loose.ignore_case = loose.ignore_extension = loose.ignore_folder = true;
  std::unordered_map<std::string, std::size_t> table;
  for (const std::string& name : estimate.names) table.emplace(name_key(name, loose), 0);
  std::size_t n = 0;
  for (const std::string& name : reference.names) n += table.count(name_key(name, loose));
  if (n == 0) return names;
  return message(names, "; ignore_folder, ignore_extension and ignore_case would match ", n);
}

inline std::size_t distinct(std::vector<std::size_t> indices) {
  std::sort(indices.begin(), indices.end());
  return static_cast<std::size_t>(std::unique(indices.begin(), indices.end()) - indices.begin());
}

}  // namespace detail

inline association associate(const trajectory& estimate,
                             const trajectory& reference,
                             const associate_options& options) {
  check(estimate);
  check(reference);
  if (!(options.max_gap_s >= 0))
    throw argument_error(message("associate: max_gap >= 0 expected, found ", options.max_gap_s));
  const std::vector<detail::index_pair> pairs =
      options.by == match_by::name ? detail::match_names(estimate, reference, options)
      : options.by == match_by::stamp
          ? detail::match_stamps(estimate, reference, options)
          : detail::match_indices(std::min(estimate.size(), reference.size()));
  if (pairs.empty()) {
    throw undefined_error(message(
        "associate: none of ", estimate.size(), " estimated poses matches one of ",
        reference.size(), " reference poses", detail::advice(estimate, reference, options)));
  }
  std::vector<std::size_t> e, r;
  for (const detail::index_pair& p : pairs) {
    e.push_back(p.estimate);
    r.push_back(p.reference);
  }
  association out{.estimate = select(estimate, e),
                  .reference = select(reference, r),
                  .estimate_index = e,
                  .reference_index = r,
                  .n_matched = pairs.size(),
                  .n_estimate_only = estimate.size() - detail::distinct(e),
                  .n_reference_only = reference.size() - detail::distinct(r)};
  if (options.by == match_by::name) out.estimate.names = out.reference.names;
  return out;
}

}  // namespace aib::pose

// aib/pose/joint_counts.hpp

namespace aib::pose {

/// Frame pairs counted by rotation error and by direction error at once, mergeable. Every recall,
/// folded or signed, of one error or of both, is a sum of its cells.
class joint_counts {
 public:
  joint_counts(angle_bins rotation, angle_bins translation)
      : rotation_(std::move(rotation)), translation_(std::move(translation)), counts_(places()) {}

  [[nodiscard]] const angle_bins& rotation() const { return rotation_; }
  [[nodiscard]] const angle_bins& translation() const { return translation_; }

  /// Translation bins, and one column of pairs without a direction.
  [[nodiscard]] std::size_t columns() const { return translation_.size() + 1; }
  [[nodiscard]] std::size_t places() const { return rotation_.size() * columns(); }

  /// Index of the cell of a pair.
  [[nodiscard]] std::size_t place(double rotation_deg,
                                  std::optional<double> translation_deg) const {
    const std::size_t column =
        translation_deg ? translation_.find(*translation_deg) : translation_.size();
    return rotation_.find(rotation_deg) * columns() + column;
  }

  /// Adds counts of the same layout.
  template <class Integer>
  void add(const std::vector<Integer>& counts) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += counts[i];
  }

  /// Throw argument_error if the bins differ.
  joint_counts& operator+=(const joint_counts& other) {
    check(other);
    add(other.counts_);
    return *this;
  }
  /// Takes a subset away.
  joint_counts& operator-=(const joint_counts& subset) {
    check(subset);
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] -= subset.counts_[i];
    return *this;
  }

  /// Pairs in one rotation bin and one column.
  [[nodiscard]] std::uint64_t at(std::size_t rotation, std::size_t column) const {
    return counts_[rotation * columns() + column];
  }

  /// Pairs in rotation bins [0, rotation_end) and columns [column, column_end).
  [[nodiscard]] std::uint64_t sum(std::size_t rotation_end,
                                  std::size_t column,
                                  std::size_t column_end) const {
    std::uint64_t n = 0;
    for (std::size_t r = 0; r < rotation_end; ++r) {
      for (std::size_t c = column; c < column_end; ++c) n += at(r, c);
    }
    return n;
  }

  [[nodiscard]] std::uint64_t pairs() const { return sum(rotation_.size(), 0, columns()); }
  [[nodiscard]] std::uint64_t without_direction() const {
    return sum(rotation_.size(), translation_.size(), columns());
  }

 private:
  void check(const joint_counts& other) const {
    if (other.rotation_.edges_deg() == rotation_.edges_deg() &&
        other.translation_.edges_deg() == translation_.edges_deg())
      return;
    throw argument_error("joint_counts: the bins differ");
  }

  angle_bins rotation_, translation_;
  std::vector<std::uint64_t> counts_;
};

}  // namespace aib::pose

// aib/pose/auc_convention.hpp

namespace aib::pose {

/// Whose area under the recall curve. On one trajectory they give from 0.47 to 0.69: the convention
/// is part of the number.
enum class auc_convention {
  paper,                ///< E_i E_j^-1, mean over tau = 1..T of min(RRA, RTA), signed directions
  vggt,                 ///< E_i E_j^-1, max of both errors a pair, folded, last bin closed
  posediffusion,        ///< as vggt with E_j E_i^-1; pi3 as well
  posediffusion_torch,  ///< as posediffusion with T + 1 bins on [0, T]
  da3,                  ///< E_i^-1 E_j from the first camera, else as vggt; depends on that camera
  colmap,  ///< ordered pairs, trapezoids, inclusive, missing frames count as 180 degrees
  exact,   ///< exact area under the recall of the max of both errors, signed
};

inline constexpr std::array<std::string_view, 7> auc_convention_names = {
    "paper", "vggt", "posediffusion", "posediffusion_torch", "da3", "colmap", "exact",
};

[[nodiscard]] constexpr std::string_view name(auc_convention c) {
  return auc_convention_names[static_cast<std::size_t>(c)];
}

/// Whether a convention takes opposite directions for the same.
[[nodiscard]] constexpr bool folds(auc_convention c) {
  return c == auc_convention::vggt || c == auc_convention::posediffusion ||
         c == auc_convention::posediffusion_torch || c == auc_convention::da3;
}

/// Whether a convention's relative pose is E_j E_i^-1: that of the frames in reverse.
[[nodiscard]] constexpr bool reverses(auc_convention c) {
  return c == auc_convention::posediffusion || c == auc_convention::posediffusion_torch;
}

/// Whether a convention is a mean over thresholds, so that counts of pairs suffice.
[[nodiscard]] constexpr bool is_binned(auc_convention c) {
  return c == auc_convention::paper || folds(c);
}

/// Share of pairs by threshold, and its mean.
struct recall {
  double auc = 0;                ///< by the convention
  double auc_signed = 0;         ///< the same with directions over 0..180 degrees
  std::vector<double> rra = {};  ///< at 1, 2, .. max_deg degrees, strictly below
  std::vector<double> rta = {};  ///< folded where the convention folds
};

/// The thresholds of a convention, the bins that they need, and their recalls. `convention` is one
/// that is_binned, `max_deg` in [1, 180].
class recall_thresholds {
 public:
  recall_thresholds(auc_convention convention, unsigned max_deg)
      : convention_(convention), max_deg_(max_deg) {
    if (!is_binned(convention))
      throw argument_error(message("auc: convention ", name(convention), " has no thresholds"));
    if (max_deg < 1 || max_deg > 180)
      throw argument_error(message("auc: max_deg in [1, 180] expected, found ", max_deg));
    for (unsigned k = 1; k <= max_deg; ++k) whole_.push_back({static_cast<double>(k), false});
    averaged_ = convention == auc_convention::posediffusion_torch ? torch(max_deg) : whole_;
    if (folds(convention)) averaged_.back().closed = true;
  }

  [[nodiscard]] angle_bins rotation_bins() const {
    std::vector<double> edges;
    for (const auto* list : {&whole_, &averaged_}) {
      for (const threshold t : *list) edges.push_back(t.edge());
    }
    return angle_bins(std::move(edges));
  }
  [[nodiscard]] angle_bins translation_bins() const {
    std::vector<double> edges;
    for (const auto* list : {&whole_, &averaged_}) {
      for (const threshold t : *list) {
        edges.push_back(t.edge());
        if (t.mirrored() > 0) edges.push_back(t.mirrored());
      }
    }
    return angle_bins(std::move(edges));
  }

  /// Throws undefined_error if no pair has a direction.
  [[nodiscard]] recall of(const joint_counts& counts) const;

 private:
  struct threshold {
    double deg;
    bool closed;  // an error equal to it counts as below

    [[nodiscard]] double edge() const { return closed ? std::nextafter(deg, 360.0) : deg; }
    /// Edge above which a folded error is below.
    [[nodiscard]] double mirrored() const {
      return closed ? 180 - deg : std::nextafter(180 - deg, 360.0);
    }
    [[nodiscard]] bool holds_right_angles() const { return deg > 90 || (closed && deg == 90); }
  };

  static std::vector<threshold> torch(unsigned max_deg) {
    std::vector<threshold> out;
    for (unsigned k = 1; k <= max_deg + 1; ++k)
      out.push_back({static_cast<double>(k) * max_deg / (max_deg + 1), false});
    return out;
  }

  /// Pairs below a threshold in their direction, with rotations in bins [0, rotation_end).
  static std::uint64_t directed(const joint_counts& counts, std::size_t rotation_end, threshold t) {
    return counts.sum(rotation_end, 0, counts.translation().bins_below(t.edge()));
  }
  static std::uint64_t folded(const joint_counts& counts, std::size_t rotation_end, threshold t) {
    if (t.holds_right_angles()) return counts.sum(rotation_end, 0, counts.columns());
    return directed(counts, rotation_end, t) +
           counts.sum(rotation_end, counts.translation().bins_below(t.mirrored()),
                      counts.translation().size());
  }

  auc_convention convention_;
  unsigned max_deg_;
  std::vector<threshold> whole_, averaged_;
};

inline recall recall_thresholds::of(const joint_counts& counts) const {
  const std::uint64_t pairs = counts.pairs();
  if (pairs == counts.without_direction()) {
    throw undefined_error(
        message("auc: none of ", pairs, " pairs has a direction; relative_angles still gives RRA"));
  }
  const auto n = static_cast<double>(pairs);
  const bool folding = folds(convention_);
  const std::size_t all = counts.rotation().size();
  recall out;
  for (const threshold t : whole_) {
    const std::size_t below = counts.rotation().bins_below(t.deg);
    out.rra.push_back(static_cast<double>(counts.sum(below, 0, counts.columns())) / n);
    out.rta.push_back(
        static_cast<double>(folding ? folded(counts, all, t) : directed(counts, all, t)) / n);
  }
  if (convention_ == auc_convention::paper) {
    for (std::size_t k = 0; k < whole_.size(); ++k) out.auc += std::min(out.rra[k], out.rta[k]);
    out.auc_signed = out.auc /= max_deg_;
    return out;
  }
  for (const threshold t : averaged_) {
    const std::size_t below = counts.rotation().bins_below(t.edge());
    out.auc += static_cast<double>(folded(counts, below, t)) / n;
    out.auc_signed += static_cast<double>(directed(counts, below, t)) / n;
  }
  out.auc /= static_cast<double>(averaged_.size());
  out.auc_signed /= static_cast<double>(averaged_.size());
  return out;
}

}  // namespace aib::pose

// aib/pose/baselines.hpp

namespace aib::pose {

/// The camera centres of a trajectory and which of their differences have a direction: those longer
/// than 1e-9 of the longest and than 1e-12 of the largest coordinate.
///
/// Centres are divided by a power of two near their largest coordinate, so that no square
/// overflows; lengths below are in that unit. The longest baseline is bounded by a ball and is
/// searched for only when a baseline lies between the bounds.
class baselines {
 public:
  /// poses     finite
  /// padding   NaN entries behind the centres, for blocks that read over the end
  explicit baselines(std::span<const math::rigid3> poses, std::size_t padding = 0);

  [[nodiscard]] Eigen::Vector3d between(std::size_t i, std::size_t j) const {
    return {x[j] - x[i], y[j] - y[i], z[j] - z[i]};
  }

  /// Any longer baseline has a direction.
  [[nodiscard]] double certain() const { return std::max(2e-9 * radius_, smallest_); }

  [[nodiscard]] bool has_direction(std::size_t i, std::size_t j) const {
    const double length = between(i, j).norm();
    if (length > certain()) return true;
    if (!(length > std::max(1e-9 * radius_, smallest_))) return false;
    return length > std::max(1e-9 * longest(), smallest_);
  }

  std::vector<double> x, y, z;

 private:
  [[nodiscard]] double longest() const;

  std::size_t size_;
  double smallest_;    // 1e-12 of the largest coordinate
  double radius_ = 0;  // of a ball about all centres, and at most the longest baseline
  mutable std::once_flag searched_;
  mutable double longest_ = 0;
};

inline baselines::baselines(std::span<const math::rigid3> poses, std::size_t padding)
    : size_(poses.size()) {
  double largest = 0;
  for (const math::rigid3& p : poses)
    largest = std::max(largest, p.translation.cwiseAbs().maxCoeff());
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  smallest_ = 1e-12 * std::scalbn(largest, -exponent);
  for (auto* axis : {&x, &y, &z})
    axis->resize(size_ + padding, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < size_; ++i) {
    x[i] = std::scalbn(poses[i].translation.x(), -exponent);
    y[i] = std::scalbn(poses[i].translation.y(), -exponent);
    z[i] = std::scalbn(poses[i].translation.z(), -exponent);
    radius_ = std::max(radius_, between(0, i).norm());  // about the first centre
  }
}

inline double baselines::longest() const {
  std::call_once(searched_, [&] {
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = i + 1; j < size_; ++j)
        longest_ = std::max(longest_, between(i, j).norm());
    }
  });
  return longest_;
}

}  // namespace aib::pose

// aib/pose/frame_pairs.hpp

namespace aib::pose {

/// Errors of the relative pose of two frames, in degrees, [0, 180].
struct pair_error {
  double rotation_deg;
  std::optional<double> translation_deg;  ///< between directions; nothing where there is none
};

/// Frames j in [begin, end) that a frame i is paired with.
struct pair_row {
  std::size_t begin;
  std::size_t end;
};

inline namespace AIB_ISA {

/// The relative poses E_i E_j^-1 (camera-from-world) of all pairs of two trajectories, estimate
/// against reference, in a stream: memory grows with the frames, never with the pairs.
///
/// With R the rotation of world_from_camera, C the camera centre, g the reference, p the estimate:
///   rotation      R_ij = R_i^T R_j. The error is the angle of R_p,ij R_g,ij^T, which is that of
///                 A_i^T A_j with the residual A_i = R_p,i R_g,i^T. With unit quaternions a_i of
///                 A_i its half has the cosine |a_i . a_j|: one dot product of four numbers.
///   translation   t_ij = R_i^T (C_j - C_i). The angle between t_p,ij and t_g,ij is that between
///                 A_i^T (C_p,j - C_p,i) and C_g,j - C_g,i: a matrix of frame i, no pair matrix.
/// Neither angle is calculated: sin^2 of it (of its half for rotations) is compared with the sin^2
/// of the edges, see key_table. Some rows of pairs are counted side by side, so that what they read
/// stays in the nearest cache. Results are the same bits for any number of threads.
///
/// A pair has no direction where a baseline is too short for one, see baselines.
class frame_pairs {
 public:
  /// Poses world_from_camera, finite, rotations orthonormal.
  /// Throws argument_error if the lengths differ.
  frame_pairs(std::span<const math::rigid3> estimate, std::span<const math::rigid3> reference);

  [[nodiscard]] std::size_t frames() const { return frames_; }
  [[nodiscard]] const baselines& estimate_baselines() const { return estimate_; }
  [[nodiscard]] const baselines& reference_baselines() const { return reference_; }

  /// Exact errors of one pair.
  [[nodiscard]] pair_error error(std::size_t i, std::size_t j) const;

  /// Calls `visit` with the errors of frame i and those of a row, ascending: the numbers of `error`
  /// up to rounding, many at once.
  ///
  /// visit   void(std::size_t j, double rotation_deg, double translation_deg), the latter NaN where
  ///         there is no direction
  template <class Visit>
  void for_each_error(std::size_t i, pair_row row, Visit&& visit) const;

  /// Counts the pairs of every frame i with the frames of `row(i)` by their errors.
  ///
  /// row   pair_row(std::size_t i), within [0, frames())
  template <class Row>
  [[nodiscard]] joint_counts count_rows(angle_bins rotation,
                                        angle_bins translation,
                                        Row&& row,
                                        unsigned threads = 0,
                                        const control& control = {}) const;

  /// Counts every pair i < j.
  [[nodiscard]] joint_counts count(angle_bins rotation,
                                   angle_bins translation,
                                   unsigned threads = 0,
                                   const control& control = {}) const {
    return count_rows(
        std::move(rotation), std::move(translation),
        [n = frames_](std::size_t i) {
          return pair_row{i + 1, n};
        },
        threads, control);
  }

 private:
  static constexpr std::size_t block = 64;  // pairs that are calculated together, in level 1 cache
  static constexpr std::size_t rows = 16;   // of a chunk

  struct block_keys {
    double rotation[block], direction[block];
    std::uint64_t rotation_cell[block], direction_cell[block];
  };
  /// Squared sines and cosines of errors, of rotations of half the angle, both times a length.
  struct block_errors {
    double rotation_sine2[block], rotation_cosine[block], sine2[block], cosine[block];
    bool has_direction[block];
  };
  /// Where a pair counts, by the cells of its keys. Cells of directions: those of front, those of
  /// back, no_direction.
  struct place_tables {
    explicit place_tables(const joint_counts& bins);
    key_table rotation, front, back;
    std::vector<std::uint32_t> direction_cells;
  };
  static constexpr std::uint64_t no_direction = 2 * key_table::size();

  [[nodiscard]] block_keys keys_of(std::size_t i, std::size_t j) const;
  [[nodiscard]] block_errors errors_of(std::size_t i, std::size_t j) const;
  /// Where the pair of i and j + k counts whose keys lie in the cell of an edge.
  [[nodiscard]] std::size_t place(std::size_t i,
                                  std::size_t j,
                                  std::size_t k,
                                  const block_keys& keys,
                                  const place_tables& tables,
                                  const joint_counts& bins) const;
  /// Counts frame i with those of its row in [j, j + block).
  void count_block(std::size_t i,
                   std::size_t j,
                   pair_row row,
                   const place_tables& tables,
                   const joint_counts& bins,
                   std::vector<std::uint32_t>& counts) const;

  std::size_t frames_;
  std::array<std::vector<double>, 4> residual_;           // quaternions a_i
  std::vector<Eigen::Matrix3d> reference_from_estimate_;  // A_i^T
  baselines estimate_, reference_;
};

inline frame_pairs::frame_pairs(std::span<const math::rigid3> estimate,
                                std::span<const math::rigid3> reference)
    : frames_(estimate.size()), estimate_(estimate, block), reference_(reference, block) {
  if (estimate.size() != reference.size()) {
    throw argument_error(message("frame_pairs: as many estimated as reference poses expected, ",
                                 "found ", estimate.size(), " and ", reference.size()));
  }
  for (auto& component : residual_) component.resize(frames_ + block);
  reference_from_estimate_.reserve(frames_);
  for (std::size_t i = 0; i < frames_; ++i) {
    const Eigen::Matrix3d a = estimate[i].rotation * reference[i].rotation.transpose();
    const math::quaternion q = math::quaternion_from(a);
    residual_[0][i] = q.w;
    residual_[1][i] = q.x;
    residual_[2][i] = q.y;
    residual_[3][i] = q.z;
    reference_from_estimate_.push_back(a.transpose());
  }
}

inline pair_error frame_pairs::error(std::size_t i, std::size_t j) const {
  const auto a = [&](std::size_t k) {
    return Eigen::Quaterniond(residual_[0][k], residual_[1][k], residual_[2][k], residual_[3][k]);
  };
  const Eigen::Quaterniond q = a(i).conjugate() * a(j);
  pair_error out{math::degrees(2 * std::atan2(q.vec().norm(), std::abs(q.w()))), std::nullopt};
  const Eigen::Vector3d g = reference_.between(i, j);
  const Eigen::Vector3d p = estimate_.between(i, j);
  if (reference_.has_direction(i, j) && estimate_.has_direction(i, j)) {
    const Eigen::Vector3d moved = reference_from_estimate_[i] * p;
    out.translation_deg = math::degrees(std::atan2(g.cross(moved).norm(), g.dot(moved)));
  }
  return out;
}

/// Keys of frame i with the frames j .. j + block - 1. Loops without branches over a fixed number
/// of pairs, which every compiler turns into vector code.
inline frame_pairs::block_keys frame_pairs::keys_of(std::size_t i, std::size_t j) const {
  block_keys out;
  const double w = residual_[0][i], x = residual_[1][i], y = residual_[2][i], z = residual_[3][i];
  const double *ws = &residual_[0][j], *xs = &residual_[1][j], *ys = &residual_[2][j],
               *zs = &residual_[3][j];
  for (std::size_t k = 0; k < block; ++k) {
    const double cosine = w * ws[k] + x * xs[k] + y * ys[k] + z * zs[k];
    out.rotation[k] = 1 - cosine * cosine;
    out.rotation_cell[k] = key_table::cell_of(out.rotation[k]);
  }
  const Eigen::Matrix3d& m = reference_from_estimate_[i];
  const double m00 = m(0, 0), m01 = m(0, 1), m02 = m(0, 2), m10 = m(1, 0), m11 = m(1, 1),
               m12 = m(1, 2), m20 = m(2, 0), m21 = m(2, 1), m22 = m(2, 2);
  const double gx = reference_.x[i], gy = reference_.y[i], gz = reference_.z[i];
  const double px = estimate_.x[i], py = estimate_.y[i], pz = estimate_.z[i];
  const double *gxs = &reference_.x[j], *gys = &reference_.y[j], *gzs = &reference_.z[j];
  const double *pxs = &estimate_.x[j], *pys = &estimate_.y[j], *pzs = &estimate_.z[j];
  const double g_certain = reference_.certain() * reference_.certain();
  const double p_certain = estimate_.certain() * estimate_.certain();
  for (std::size_t k = 0; k < block; ++k) {
    const double g0 = gxs[k] - gx, g1 = gys[k] - gy, g2 = gzs[k] - gz;
    const double p0 = pxs[k] - px, p1 = pys[k] - py, p2 = pzs[k] - pz;
    const double u0 = m00 * p0 + m01 * p1 + m02 * p2;
    const double u1 = m10 * p0 + m11 * p1 + m12 * p2;
    const double u2 = m20 * p0 + m21 * p1 + m22 * p2;
    const double gg = g0 * g0 + g1 * g1 + g2 * g2;
    const double pp = p0 * p0 + p1 * p1 + p2 * p2;
    const double dot = g0 * u0 + g1 * u1 + g2 * u2;
    out.direction[k] = 1 - dot * dot / (gg * pp);
    const std::uint64_t cell =
        key_table::cell_of(out.direction[k]) + (dot < 0 ? key_table::size() : 0);
    out.direction_cell[k] = ((gg > g_certain) & (pp > p_certain)) ? cell : no_direction;
  }
  return out;
}

inline frame_pairs::place_tables::place_tables(const joint_counts& bins)
    : rotation(rotation_table(bins.rotation(), bins.columns())),
      front(front_table(bins.translation())),
      back(back_table(bins.translation())),
      direction_cells(front.cells()) {
  direction_cells.insert(direction_cells.end(), back.cells().begin(), back.cells().end());
  direction_cells.push_back(key_table::edge);
}

inline std::size_t frame_pairs::place(std::size_t i,
                                      std::size_t j,
                                      std::size_t k,
                                      const block_keys& keys,
                                      const place_tables& tables,
                                      const joint_counts& bins) const {
  const std::uint64_t cell = keys.direction_cell[k];
  if (cell < no_direction) {
    const key_table& directions = cell < key_table::size() ? tables.front : tables.back;
    const auto rotation = tables.rotation.find(keys.rotation[k]);
    const auto direction = directions.find(keys.direction[k]);
    if (rotation && direction) return *rotation + *direction;
  }
  const pair_error e = error(i, j + k);
  return bins.place(e.rotation_deg, e.translation_deg);
}

inline void frame_pairs::count_block(std::size_t i,
                                     std::size_t j,
                                     pair_row row,
                                     const place_tables& tables,
                                     const joint_counts& bins,
                                     std::vector<std::uint32_t>& counts) const {
  const std::size_t begin = std::max(row.begin, j), end = std::min(row.end, j + block);
  if (begin >= end) return;
  const block_keys keys = keys_of(i, j);
  const std::uint32_t* const rotation = tables.rotation.cells().data();
  const std::uint32_t* const direction = tables.direction_cells.data();
  std::uint32_t* const count = counts.data();
  for (std::size_t k = begin - j; k < end - j; ++k) {
    std::size_t at = rotation[keys.rotation_cell[k]] + direction[keys.direction_cell[k]];
    if (at >= key_table::edge) [[unlikely]]
      at = place(i, j, k, keys, tables, bins);
    ++count[at];
  }
}

/// Not from 1 - cos^2: cross products and the vector of the quaternion keep small angles.
inline frame_pairs::block_errors frame_pairs::errors_of(std::size_t i, std::size_t j) const {
  block_errors out;
  const double w = residual_[0][i], x = residual_[1][i], y = residual_[2][i], z = residual_[3][i];
  const double *ws = &residual_[0][j], *xs = &residual_[1][j], *ys = &residual_[2][j],
               *zs = &residual_[3][j];
  for (std::size_t k = 0; k < block; ++k) {
    const double vx = w * xs[k] - x * ws[k] - (y * zs[k] - z * ys[k]);
    const double vy = w * ys[k] - y * ws[k] - (z * xs[k] - x * zs[k]);
    const double vz = w * zs[k] - z * ws[k] - (x * ys[k] - y * xs[k]);
    out.rotation_sine2[k] = vx * vx + vy * vy + vz * vz;
    out.rotation_cosine[k] = std::abs(w * ws[k] + x * xs[k] + y * ys[k] + z * zs[k]);
  }
  const Eigen::Matrix3d& m = reference_from_estimate_[i];
  const double g_certain = reference_.certain() * reference_.certain();
  const double p_certain = estimate_.certain() * estimate_.certain();
  for (std::size_t k = 0; k < block; ++k) {
    const double g0 = reference_.x[j + k] - reference_.x[i];
    const double g1 = reference_.y[j + k] - reference_.y[i];
    const double g2 = reference_.z[j + k] - reference_.z[i];
    const double p0 = estimate_.x[j + k] - estimate_.x[i];
    const double p1 = estimate_.y[j + k] - estimate_.y[i];
    const double p2 = estimate_.z[j + k] - estimate_.z[i];
    const double u0 = m(0, 0) * p0 + m(0, 1) * p1 + m(0, 2) * p2;
    const double u1 = m(1, 0) * p0 + m(1, 1) * p1 + m(1, 2) * p2;
    const double u2 = m(2, 0) * p0 + m(2, 1) * p1 + m(2, 2) * p2;
    const double c0 = g1 * u2 - g2 * u1, c1 = g2 * u0 - g0 * u2, c2 = g0 * u1 - g1 * u0;
    out.sine2[k] = c0 * c0 + c1 * c1 + c2 * c2;
    out.cosine[k] = g0 * u0 + g1 * u1 + g2 * u2;
    out.has_direction[k] =
        (g0 * g0 + g1 * g1 + g2 * g2 > g_certain) & (p0 * p0 + p1 * p1 + p2 * p2 > p_certain);
  }
  return out;
}

template <class Visit>
void frame_pairs::for_each_error(std::size_t i, pair_row row, Visit&& visit) const {
  double rotation[block], translation[block];
  for (std::size_t j = row.begin; j < row.end; j += block) {
    const block_errors errors = errors_of(i, j);
    for (std::size_t k = 0; k < block; k += f64x4::width) {
      const auto angle = [&](const double* cosine, const double* sine2) {
        return math::angle_of(f64x4::load(cosine + k), sqrt(f64x4::load(sine2 + k)));
      };
      angle(errors.rotation_cosine, errors.rotation_sine2).store(rotation + k);
      angle(errors.cosine, errors.sine2).store(translation + k);
    }
    for (std::size_t k = 0; k < std::min(block, row.end - j); ++k) {
      double translation_deg = math::degrees(translation[k]);
      if (!errors.has_direction[k]) {
        translation_deg =
            error(i, j + k).translation_deg.value_or(std::numeric_limits<double>::quiet_NaN());
      }
      visit(j + k, math::degrees(2 * rotation[k]), translation_deg);
    }
  }
}

template <class Row>
joint_counts frame_pairs::count_rows(angle_bins rotation,
                                     angle_bins translation,
                                     Row&& row,
                                     unsigned threads,
                                     const control& control) const {
  joint_counts total(std::move(rotation), std::move(translation));
  const place_tables tables(total);
  std::mutex mutex;
  for_each_chunk(frames_, rows, threads, control, [&](const chunk& c) {
    std::array<pair_row, rows> row_of;
    pair_row all{frames_, 0};
    for (std::size_t i = c.begin; i < c.end; ++i) {
      const pair_row r = row_of[i - c.begin] = row(i);
      all = {std::min(all.begin, r.begin), std::max(all.end, r.end)};
    }
    std::vector<std::uint32_t> counts(total.places());
    for (std::size_t j = all.begin; j < all.end; j += block) {
      for (std::size_t i = c.begin; i < c.end; ++i)
        count_block(i, j, row_of[i - c.begin], tables, total, counts);
    }
    const std::scoped_lock lock(mutex);  // integers: the order of the sums does not matter
    total.add(counts);
  });
  return total;
}

}  // namespace AIB_ISA

}  // namespace aib::pose

// aib/pose/auc.hpp

namespace aib::pose {

struct auc_options {
  unsigned max_deg = 30;  ///< T, [1, 180]
  auc_convention convention = auc_convention::paper;
  double position_accuracy = 0;  ///< colmap: shorter reference baselines score by rotation alone
  unsigned threads = 0;          ///< 0: all
  struct control control = {};
};

struct auc_result {
  auc_convention convention;
  unsigned max_deg;
  double auc;               ///< share, [0, 1]
  double auc_signed;        ///< the same with signed directions: mirrored centres fold to nothing
  std::vector<double> rra;  ///< share of pairs at 1, 2, .. max_deg degrees
  std::vector<double> rta;  ///< folded where the convention folds
  std::uint64_t n_pairs;
  std::uint64_t n_zero_baseline;  ///< pairs without a direction, which never score
  std::size_t n_unregistered;     ///< frames without a finite pose
};

/// Area under the recall curve of relative pose errors over all frame pairs, 0..max_deg degrees.
///
/// estimate    associated with the reference (`colmap` takes the whole reference where both have
///             names: frames that are missing score there); its world and scale are its own
///
/// Pairs without a direction (see baselines) stay in the denominator; the folding conventions
/// take them for 90 degrees, as their sources do. Invariant to a similarity of either side (`da3`
/// only where it keeps the first camera first).
/// Throws argument_error if the trajectories are not associated or max_deg is out of range,
/// undefined_error if fewer than two frames are registered or no pair has a direction.
/// Source: the conventions' own code, see auc_convention; the paper's Sec. 3.
auc_result auc(const trajectory& estimate,
               const trajectory& reference,
               const auc_options& options = {});

namespace detail {

/// The frames in the form that makes frame_pairs' E_i E_j^-1 the relative pose of a convention.
inline registered_frames frames_for(auc_convention convention, registered_frames frames) {
  for (auto* poses : {&frames.estimate, &frames.reference}) {
    if (reverses(convention)) {
      std::reverse(poses->begin(), poses->end());  // E_j E_i^-1
    } else if (convention == auc_convention::da3) {
      // E_i^-1 E_j of E_i E_0^-1 is the relative pose of the inverse poses.
      const math::rigid3 world_from_first = poses->front();
      for (math::rigid3& pose : *poses) pose = pose.inverse() * world_from_first;
    }
  }
  return frames;
}

/// What the exact area needs of a set of pair errors e, mergeable in order.
struct area_sums {
  double below = 0;  // sum of (T - e) over e <= T
  double last = 0;   // largest e <= T
  std::uint64_t n_zero_baseline = 0;
  std::vector<std::uint64_t> rotation = {};  // errors below k + 1 degrees, from k on
  std::vector<std::uint64_t> translation = {};

  explicit area_sums(unsigned max_deg = 0) : rotation(max_deg), translation(max_deg) {}

  void add(double rotation_deg, double translation_deg) {
    const double e = std::max(rotation_deg, translation_deg);
    const auto limit = static_cast<double>(rotation.size());
    if (e <= limit) {
      below += limit - e;
      last = std::max(last, e);
    }
    if (rotation_deg < limit) ++rotation[static_cast<std::size_t>(rotation_deg)];
    if (translation_deg < limit) ++translation[static_cast<std::size_t>(translation_deg)];
  }

  friend area_sums operator+(area_sums a, const area_sums& b) {
    a.below += b.below;
    a.last = std::max(a.last, b.last);
    a.n_zero_baseline += b.n_zero_baseline;
    for (std::size_t k = 0; k < a.rotation.size(); ++k) {
      a.rotation[k] += b.rotation[k];
      a.translation[k] += b.translation[k];
    }
    return a;
  }
};

/// Sums of all pairs; `add_row(area_sums&, i)` adds those of frame i.
template <class AddRow>
area_sums sum_rows(std::size_t n, const auc_options& options, AddRow&& add_row) {
  return reduce_chunks<area_sums>(
      n, 16, options.threads, options.control, area_sums(options.max_deg),
      [&](const chunk& c) {
        area_sums sums(options.max_deg);
        for (std::size_t i = c.begin; i < c.end; ++i) add_row(sums, i);
        return sums;
      },
      [](area_sums a, const area_sums& b) { return std::move(a) + b; });
}

inline std::vector<double> cumulative_shares(const std::vector<std::uint64_t>& counts, double n) {
  std::vector<double> out;
  std::uint64_t below = 0;
  for (const std::uint64_t c : counts) out.push_back(static_cast<double>(below += c) / n);
  return out;
}

inline auc_result result_of(const area_sums& sums,
                            double area,
                            std::uint64_t n_pairs,
                            std::size_t n_unregistered,
                            const auc_options& options) {
  const auto n = static_cast<double>(n_pairs);
  const double share = area / (n * options.max_deg);
  return {.convention = options.convention,
          .max_deg = options.max_deg,
          .auc = share,
          .auc_signed = share,
          .rra = cumulative_shares(sums.rotation, n),
          .rta = cumulative_shares(sums.translation, n),
          .n_pairs = n_pairs,
          .n_zero_baseline = sums.n_zero_baseline,
          .n_unregistered = n_unregistered};
}

inline auc_result exact_auc(const registered_frames& frames,
                            std::size_t n_unregistered,
                            const auc_options& options) {
  const frame_pairs pairs(frames.estimate, frames.reference);
  const std::size_t n = pairs.frames();
  const area_sums sums = sum_rows(n, options, [&](area_sums& s, std::size_t i) {
    pairs.for_each_error(i, {i + 1, n}, [&](std::size_t, double rotation, double translation) {
      const bool has_direction = !std::isnan(translation);
      s.n_zero_baseline += has_direction ? 0 : 1;
      s.add(rotation, has_direction ? translation : 360);
    });
  });
  const std::uint64_t n_pairs = n * (n - 1) / 2;
  if (sums.n_zero_baseline == n_pairs) {
    throw undefined_error(message("auc: none of ", n_pairs,
                                  " pairs has a direction; relative_angles still gives RRA"));
  }
  return result_of(sums, sums.below, n_pairs, n_unregistered, options);
}

/// Source: COLMAP benchmark/reconstruction/evaluation/utils.py, compute_rel_errors, compute_auc.
inline auc_result colmap_auc(const trajectory& estimate,
                             const trajectory& reference,
                             const auc_options& options) {
  const bool named = !estimate.names.empty() && !reference.names.empty();
  if (!named) check_associated("auc", estimate, reference);
  std::size_t total = 0;  // reference frames, registered or not
  for (const math::rigid3& pose : reference.world_from_camera) total += pose.is_finite() ? 1 : 0;
  const association matched =
      associate(estimate, reference, {.by = named ? match_by::name : match_by::index});
  const registered_frames frames = registered("auc", matched.estimate, matched.reference);
  if (total < 2) throw undefined_error(message("auc: 2 reference frames expected, found ", total));
  const frame_pairs pairs(frames.estimate, frames.reference);
  const std::size_t n = pairs.frames();
  const auto has_short_reference = [&](std::size_t i, std::size_t j) {
    const auto &gi = frames.reference[i].translation, &gj = frames.reference[j].translation;
    return (gj - gi).norm() < options.position_accuracy ||
           !pairs.reference_baselines().has_direction(i, j);
  };
  const area_sums sums = sum_rows(n, options, [&](area_sums& s, std::size_t i) {
    const auto add = [&](std::size_t j, double rotation, double translation) {
      const bool has_direction = !std::isnan(translation);
      s.n_zero_baseline += has_direction ? 0 : 1;
      if (has_short_reference(i, j))
        s.add(rotation, 0);
      else
        s.add(rotation, has_direction ? translation : 90);
    };
    pairs.for_each_error(i, {0, i}, add);
    pairs.for_each_error(i, {i + 1, n}, add);
  });
  return result_of(sums, sums.below + sums.last / 2,
                   static_cast<std::uint64_t>(total) * (total - 1), total - n, options);
}

}  // namespace detail

inline auc_result auc(const trajectory& estimate,
                      const trajectory& reference,
                      const auc_options& options) {
  if (options.max_deg < 1 || options.max_deg > 180)
    throw argument_error(message("auc: max_deg in [1, 180] expected, found ", options.max_deg));
  if (options.convention == auc_convention::colmap)
    return detail::colmap_auc(estimate, reference, options);
  registered_frames frames = registered("auc", estimate, reference);
  const std::size_t n_unregistered = estimate.size() - frames.index.size();
  if (frames.index.size() < 2) {
    throw undefined_error(message("auc: 2 registered frames expected, found ", frames.index.size(),
                                  " of ", estimate.size()));
  }
  if (options.convention == auc_convention::exact)
    return detail::exact_auc(frames, n_unregistered, options);
  frames = detail::frames_for(options.convention, std::move(frames));
  const recall_thresholds thresholds(options.convention, options.max_deg);
  const joint_counts counts = frame_pairs(frames.estimate, frames.reference)
                                  .count(thresholds.rotation_bins(), thresholds.translation_bins(),
                                         options.threads, options.control);
  recall r = thresholds.of(counts);
  return {.convention = options.convention,
          .max_deg = options.max_deg,
          .auc = r.auc,
          .auc_signed = r.auc_signed,
          .rra = std::move(r.rra),
          .rta = std::move(r.rta),
          .n_pairs = counts.pairs(),
          .n_zero_baseline = counts.without_direction(),
          .n_unregistered = n_unregistered};
}

}  // namespace aib::pose

// aib/pose/auc_breakdown.hpp

namespace aib::pose {

/// The AUC of some of the pairs.
struct partial_auc {
  std::optional<recall> value;  ///< nothing where no pair has a direction
  std::uint64_t n_pairs;
  std::uint64_t n_zero_baseline;
};

struct auc_by_batch_result {
  partial_auc intra;  ///< pairs of frames of one batch; needs no alignment
  partial_auc cross;  ///< pairs of frames of two batches; means something after alignment only
};

struct gap_range {
  std::size_t first;  ///< smallest difference of two frames' places in the trajectory
  std::size_t last;   ///< largest, inclusive
};

struct auc_by_gap_result {
  gap_range gap;
  partial_auc part;
};

namespace detail {

/// The frames of a convention and the place of each in its order.
struct placed_frames {
  registered_frames frames;
  std::vector<std::size_t> place;  // in the associated trajectories, in the order of the frames
};

inline placed_frames placed(const trajectory& estimate,
                            const trajectory& reference,
                            const auc_options& options) {
  placed_frames out{registered("auc", estimate, reference), {}};
  out.place = out.frames.index;
  if (reverses(options.convention)) std::reverse(out.place.begin(), out.place.end());
  if (!out.place.empty()) out.frames = frames_for(options.convention, std::move(out.frames));
  return out;
}

inline partial_auc part_of(const joint_counts& counts, const recall_thresholds& thresholds) {
  partial_auc out{{}, counts.pairs(), counts.without_direction()};
  if (out.n_pairs > out.n_zero_baseline) out.value = thresholds.of(counts);
  return out;
}

}  // namespace detail

/// AUC over the pairs within batches and over those across batches.
///
/// batch   the batch of each frame of the associated trajectories
///
/// Per-batch alignment to the reference helps the latter, and the former shows the method alone.
/// Throws argument_error if the trajectories are not associated, `batch` has another length or the
/// convention is not one of thresholds (colmap, exact).
inline auc_by_batch_result auc_by_batch(const trajectory& estimate,
                                        const trajectory& reference,
                                        std::span<const std::size_t> batch,
                                        const auc_options& options = {}) {
  if (batch.size() != estimate.size()) {
    throw argument_error(message("auc_by_batch: the batch of each of ", estimate.size(),
                                 " frames expected, found ", batch.size()));
  }
  const recall_thresholds thresholds(options.convention, options.max_deg);
  const detail::placed_frames all = detail::placed(estimate, reference, options);
  const auto batch_of = [&](std::size_t frame) { return batch[all.place[frame]]; };
  std::vector<std::size_t> order(all.place.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return batch_of(a) < batch_of(b); });
  std::vector<math::rigid3> e, r;
  for (const std::size_t i : order) {
    e.push_back(all.frames.estimate[i]);
    r.push_back(all.frames.reference[i]);
  }
  const auto end_of_batch = [&](std::size_t i) {
    const auto end = std::upper_bound(
        order.begin() + static_cast<std::ptrdiff_t>(i), order.end(), batch_of(order[i]),
        [&](std::size_t b, std::size_t frame) { return b < batch_of(frame); });
    return static_cast<std::size_t>(end - order.begin());
  };
  const joint_counts intra = frame_pairs(e, r).count_rows(
      thresholds.rotation_bins(), thresholds.translation_bins(),
      [&](std::size_t i) {
        return pair_row{i + 1, end_of_batch(i)};
      },
      options.threads, options.control);
  joint_counts cross = frame_pairs(all.frames.estimate, all.frames.reference)
                           .count(thresholds.rotation_bins(), thresholds.translation_bins(),
                                  options.threads, options.control);
  cross -= intra;
  return {detail::part_of(intra, thresholds), detail::part_of(cross, thresholds)};
}

/// AUC over the pairs of frames that lie so many places apart: how far errors accumulate.
///
/// Throws as auc_by_batch, and argument_error if a range is empty or begins at 0.
inline std::vector<auc_by_gap_result> auc_by_gap(const trajectory& estimate,
                                                 const trajectory& reference,
                                                 std::span<const gap_range> gaps,
                                                 const auc_options& options = {}) {
  const recall_thresholds thresholds(options.convention, options.max_deg);
  const detail::placed_frames all = detail::placed(estimate, reference, options);
  const frame_pairs pairs(all.frames.estimate, all.frames.reference);
  std::vector<std::size_t> place = all.place;  // ascending
  if (reverses(options.convention)) {
    for (std::size_t& p : place) p = estimate.size() - 1 - p;
  }
  std::vector<auc_by_gap_result> out;
  for (const gap_range& gap : gaps) {
    if (gap.first < 1 || gap.last < gap.first) {
      throw argument_error(message("auc_by_gap: a range of gaps from 1 on expected, found ",
                                   gap.first, "..", gap.last));
    }
    const auto row = [&](std::size_t i) {
      const auto begin = std::lower_bound(place.begin(), place.end(), place[i] + gap.first);
      const auto end = std::upper_bound(begin, place.end(), place[i] + gap.last);
      return pair_row{static_cast<std::size_t>(begin - place.begin()),
                      static_cast<std::size_t>(end - place.begin())};
    };
    const joint_counts counts =
        pairs.count_rows(thresholds.rotation_bins(), thresholds.translation_bins(), row,
                         options.threads, options.control);
    out.push_back({gap, detail::part_of(counts, thresholds)});
  }
  return out;
}

}  // namespace aib::pose

// aib/pose/delta_pairs.hpp

namespace aib::pose {

enum class delta_unit { frames, m, deg, rad };

struct delta_options {
  double delta = 1;
  delta_unit unit = delta_unit::frames;
  bool all_pairs = false;  ///< every start, not one pair after another
  double tolerance = 0.1;  ///< all pairs by path or angle: share of delta that a pair may miss
};

struct frame_pair {
  std::size_t from;
  std::size_t to;
};

/// Length of the path from the first pose to each.
[[nodiscard]] inline std::vector<double> path_lengths(std::span<const math::rigid3> poses) {
  std::vector<double> out;
  double length = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0) length += (poses[i].translation - poses[i - 1].translation).norm();
    out.push_back(length);
  }
  return out;
}

namespace detail {

[[nodiscard]] inline double turn(const math::rigid3& a, const math::rigid3& b, delta_unit unit) {
  const double angle = math::rotation_angle(a.rotation.transpose() * b.rotation);
  return unit == delta_unit::deg ? math::degrees(angle) : angle;
}

inline std::vector<frame_pair> pairs_by_frames(std::size_t n, const delta_options& options) {
  const auto delta = static_cast<std::size_t>(options.delta);
  const std::size_t step = options.all_pairs ? 1 : delta;
  std::vector<frame_pair> out;
  for (std::size_t i = 0; i + delta < n; i += step) out.push_back({i, i + delta});
  return out;
}

/// Of every place on a path but the last the one whose distance is nearest to delta, the earlier of
/// two, where it misses it by at most a share of delta.
inline std::vector<frame_pair> nearest_along_path(std::span<const double> path,
                                                  double delta,
                                                  double tolerance) {
  std::vector<frame_pair> out;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const auto first = path.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    const auto miss = [&](auto at) { return std::abs(*at - path[i] - delta); };
    auto best = std::lower_bound(first, path.end(), path[i] + delta);
    if (best == path.end() || (best != first && miss(best - 1) <= miss(best))) --best;
    best = std::lower_bound(first, best, *best);  // of equal ones the first
    if (miss(best) <= tolerance * delta)
      out.push_back({i, static_cast<std::size_t>(best - path.begin())});
  }
  return out;
}

inline std::vector<frame_pair> pairs_by_path(std::span<const math::rigid3> poses,
                                             const delta_options& options) {
  if (options.all_pairs)
    return nearest_along_path(path_lengths(poses), options.delta, options.tolerance);
  std::vector<frame_pair> out;
  std::vector<std::size_t> stops;  // as evo: the first pair begins at the first stop, not at 0
  double since = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0) since += (poses[i].translation - poses[i - 1].translation).norm();
    if (since < options.delta) continue;
    stops.push_back(i);
    since = 0;
  }
  for (std::size_t k = 1; k < stops.size(); ++k) out.push_back({stops[k - 1], stops[k]});
  return out;
}

inline std::vector<frame_pair> pairs_by_angle(std::span<const math::rigid3> poses,
                                              const delta_options& options) {
  std::vector<frame_pair> out;
  if (options.all_pairs) {
    const double slack = options.tolerance * options.delta;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      for (std::size_t j = i + 1; j < poses.size(); ++j) {
        const double angle = turn(poses[i], poses[j], options.unit);
        if (options.delta - slack <= angle && angle <= options.delta + slack) out.push_back({i, j});
      }
    }
    return out;
  }
  double since = 0;
  std::size_t from = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    since += turn(poses[i - 1], poses[i], options.unit);
    if (since < options.delta) continue;
    out.push_back({from, i});
    from = i;
    since = 0;
  }
  return out;
}

}  // namespace detail

/// Pairs of poses that are delta frames, metres of path, or degrees or radians of turning apart, in
/// evo's way: one after another (turning adds up from pose to pose), or all (by angle: the angle
/// between the two).
///
/// Throws argument_error unless delta > 0, and whole for frames; undefined_error if no pair is that
/// far apart.
/// Source: evo, core/filters.py.
inline std::vector<frame_pair> delta_pairs(std::span<const math::rigid3> poses,
                                           const delta_options& options) {
  const bool whole = options.delta == std::floor(options.delta);
  if (!(options.delta > 0) || (options.unit == delta_unit::frames && !whole))
    throw argument_error(message("delta > 0, whole for frames, expected, found ", options.delta));
  std::vector<frame_pair> pairs =
      options.unit == delta_unit::frames ? detail::pairs_by_frames(poses.size(), options)
      : options.unit == delta_unit::m    ? detail::pairs_by_path(poses, options)
                                         : detail::pairs_by_angle(poses, options);
  if (pairs.empty()) {
    throw undefined_error(
        message("no two of ", poses.size(), " poses are a delta of ", options.delta, " apart"));
  }
  return pairs;
}

}  // namespace aib::pose

// aib/pose/focal.hpp

namespace aib::pose {

/// The camera that a view was estimated with and the one that took it.
struct camera_pair {
  math::camera estimate;
  math::camera reference;
};

/// What a mean is taken over.
enum class focal_over {
  views,    ///< each registered image counts
  cameras,  ///< each different pair of cameras counts once
};

struct focal_error_result {
  double mre;                ///< mean relative error, a share
  std::size_t n;             ///< views or cameras averaged
  std::vector<double> each;  ///< relative error of each
};

[[nodiscard]] inline bool same_camera(const math::camera& a, const math::camera& b) {
  return a.model == b.model && a.width == b.width && a.height == b.height &&
         a.parameters == b.parameters;
}

/// Focal length of a camera as it would be for an image of another size: fx goes with the width, fy
/// with the height; their mean. Pixels. Throws argument_error where a model has no focal length.
inline double focal_at_size(const math::camera& c, std::uint64_t width, std::uint64_t height) {
  const auto ratio = [](std::uint64_t to, std::uint64_t from) {
    return to == 0 || from == 0 ? 1 : static_cast<double>(to) / static_cast<double>(from);
  };
  return (c.fx() * ratio(width, c.width) + c.fy() * ratio(height, c.height)) / 2;
}

/// Mean of |f - f_ref| / f_ref over views. The estimate's focal lengths are rescaled to the
/// reference's image size (sizes of 0 are unknown: taken for equal), fx and fy averaged.
///
/// Throws undefined_error if there is no view, argument_error where a model has no focal length.
inline focal_error_result focal_error(std::span<const camera_pair> views,
                                      focal_over over = focal_over::views) {
  focal_error_result out{0, 0, {}};
  std::vector<const camera_pair*> counted;
  for (const camera_pair& view : views) {
    const auto is_view = [&](const camera_pair* c) {
      return same_camera(c->estimate, view.estimate) && same_camera(c->reference, view.reference);
    };
    if (over == focal_over::cameras) {
      if (std::any_of(counted.begin(), counted.end(), is_view)) continue;
      counted.push_back(&view);
    }
    const math::camera& ref = view.reference;
    const double f_ref = (ref.fx() + ref.fy()) / 2;
    const double f = focal_at_size(view.estimate, ref.width, ref.height);
    out.each.push_back(std::abs(f - f_ref) / f_ref);
    out.mre += out.each.back();
  }
  out.n = out.each.size();
  if (out.n == 0) throw undefined_error("focal_error: no view");
  out.mre /= static_cast<double>(out.n);
  return out;
}

}  // namespace aib::pose

// aib/pose/intrinsics.hpp

namespace aib::pose {

/// Differences of two cameras, in pixels of the reference's image.
struct reprojection_difference_result {
  double mean;  ///< over the image plane
  double max;
  std::uint64_t n;       ///< pixels of the grid that both cameras see
  std::uint64_t n_lost;  ///< pixels whose ray one of them does not have
};

/// How far apart two cameras show the same direction: rays through a grid of the reference's image,
/// projected by the estimate, whose pixels are rescaled to the reference's size. Compares any two
/// models.
///
/// cells   of the grid along the longer side; their centres are taken
///
/// Throws argument_error if a size is unknown, undefined_error if no ray is seen by both.
inline reprojection_difference_result reprojection_difference(const math::camera& estimate,
                                                              const math::camera& reference,
                                                              std::size_t cells = 32) {
  if (estimate.width * estimate.height * reference.width * reference.height * cells == 0)
    throw argument_error("reprojection_difference: image sizes and a grid expected");
  const auto width = static_cast<double>(reference.width);
  const auto height = static_cast<double>(reference.height);
  const Eigen::Array2d rescale(width / static_cast<double>(estimate.width),
                               height / static_cast<double>(estimate.height));
  const double cell = std::max(width, height) / static_cast<double>(cells);
  const auto columns = static_cast<std::size_t>(std::max(1.0, std::round(width / cell)));
  const auto rows = static_cast<std::size_t>(std::max(1.0, std::round(height / cell)));
  stats::moments differences;
  std::uint64_t lost = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const Eigen::Vector2d pixel(
          (static_cast<double>(column) + 0.5) * width / static_cast<double>(columns),
          (static_cast<double>(row) + 0.5) * height / static_cast<double>(rows));
      const auto ray = unproject(reference, pixel);
      const auto seen = ray ? project(estimate, *ray) : std::nullopt;
      if (seen)
        differences.add((seen->array() * rescale - pixel.array()).matrix().norm());
      else
        ++lost;
    }
  }
  if (differences.count() == 0) {
    throw undefined_error(
        message("reprojection_difference: none of ", lost, " rays is seen by both cameras"));
  }
  return {differences.mean(), differences.max(), differences.count(), lost};
}

struct intrinsics_error_result {
  focal_error_result focal;
  double principal_point_px;  ///< mean distance of the principal points, at the reference's size
  double focal_spread;        ///< standard deviation of the estimated focal length over its mean
  double reprojection_px;     ///< mean reprojection_difference
  double reprojection_max_px;
};

/// Intrinsics of views against those of the reference, all at the reference's image size.
/// Throws undefined_error if there is no view, argument_error where a model has no focal length or
/// an image no size.
inline intrinsics_error_result intrinsics_error(std::span<const camera_pair> views) {
  intrinsics_error_result out{focal_error(views), 0, 0, 0, 0};
  stats::moments point, focal, reprojection;
  reprojection_difference_result d{};
  const camera_pair* before = nullptr;
  for (const camera_pair& view : views) {
    const math::camera &e = view.estimate, &r = view.reference;
    if (!before || !same_camera(before->estimate, e) || !same_camera(before->reference, r))
      d = reprojection_difference(e, r);
    before = &view;
    const double sx = static_cast<double>(r.width) / static_cast<double>(e.width);
    const double sy = static_cast<double>(r.height) / static_cast<double>(e.height);
    point.add(std::hypot(e.cx() * sx - r.cx(), e.cy() * sy - r.cy()));
    focal.add(focal_at_size(e, r.width, r.height));
    reprojection.add(d.mean);
    out.reprojection_max_px = std::max(out.reprojection_max_px, d.max);
  }
  out.principal_point_px = point.mean();
  out.focal_spread = focal.deviation() / focal.mean();
  out.reprojection_px = reprojection.mean();
  return out;
}

}  // namespace aib::pose

// aib/pose/kitti_odometry.hpp

namespace aib::pose {

struct kitti_odometry_options {
  std::vector<double> lengths_m = {100, 200, 300, 400, 500, 600, 700, 800};
  std::size_t step = 10;  ///< frames from one start to the next
};

/// Mean errors of segments.
struct segment_errors {
  double translation_percent;  ///< of the segment's length
  double rotation_deg_per_m;
  std::uint64_t n;  ///< segments
};

struct kitti_odometry_result {
  segment_errors all;                     ///< over all segments, each counts once
  std::vector<double> lengths_m;          ///< those that have a segment
  std::vector<segment_errors> by_length;  ///< one of each
};

/// KITTI odometry's errors: over segments of the reference's path, from every `step`-th frame, the
/// motion (est_i^-1 est_j)^-1 (ref_i^-1 ref_j), divided by the segment's length.
///
/// Invariant to a rigid motion of either side. Frames without a finite pose are passed over. Throws
/// argument_error if the trajectories are not associated, undefined_error if the path is shorter
/// than every length.
/// Source: Geiger, Lenz, Urtasun, CVPR 2012; devkit, evaluate_odometry.cpp.
inline kitti_odometry_result kitti_odometry(const trajectory& estimate,
                                            const trajectory& reference,
                                            const kitti_odometry_options& options = {}) {
  if (options.step == 0) throw argument_error("kitti_odometry: step > 0 expected");
  const registered_frames frames = registered("kitti_odometry", estimate, reference);
  const std::vector<double> path = path_lengths(frames.reference);
  kitti_odometry_result out{};
  for (const double length : options.lengths_m) {
    if (!(length > 0))
      throw argument_error(message("kitti_odometry: lengths > 0 expected, found ", length));
    segment_errors sum{};
    for (std::size_t i = 0; i < path.size(); i += options.step) {
      std::size_t j = i;
      while (j < path.size() && !(path[j] > path[i] + length)) ++j;
      if (j == path.size()) break;
      const auto motion = [&](const std::vector<math::rigid3>& poses) {
        return poses[i].inverse() * poses[j];
      };
      const math::rigid3 error = motion(frames.estimate).inverse() * motion(frames.reference);
      sum.translation_percent += 100 * error.translation.norm() / length;
      sum.rotation_deg_per_m += math::degrees(math::rotation_angle(error.rotation)) / length;
      ++sum.n;
    }
    if (sum.n == 0) continue;
    const auto n = static_cast<double>(sum.n);
    out.all.translation_percent += sum.translation_percent;
    out.all.rotation_deg_per_m += sum.rotation_deg_per_m;
    out.all.n += sum.n;
    out.lengths_m.push_back(length);
    out.by_length.push_back({sum.translation_percent / n, sum.rotation_deg_per_m / n, sum.n});
  }
  if (out.all.n == 0) {
    throw undefined_error(message("kitti_odometry: no segment; the reference's path is ",
                                  path.empty() ? 0 : path.back(), " m long"));
  }
  out.all.translation_percent /= static_cast<double>(out.all.n);
  out.all.rotation_deg_per_m /= static_cast<double>(out.all.n);
  return out;
}

}  // namespace aib::pose

// aib/pose/pair_histogram.hpp

namespace aib::pose {

struct pair_histogram_options {
  std::vector<double> rotation_deg = {1, 2, 5, 10, 15, 20, 30, 60, 90};  ///< edges, (0, 360]
  std::vector<double> translation_deg = {1, 2, 5, 10, 15, 20, 30, 60, 90, 120, 150};
  unsigned threads = 0;  ///< 0: all
  struct control control = {};
};

/// Frame pairs by rotation error (rows) and direction error (columns). Bin k holds
/// edge[k - 1] <= error < edge[k]; the first begins at 0, the last has no end.
struct pair_histogram_result {
  std::vector<double> rotation_deg;                ///< edges, ascending, each once
  std::vector<double> translation_deg;             ///< edges, ascending, each once
  std::vector<std::vector<std::uint64_t>> counts;  ///< one row a rotation bin
  std::vector<std::uint64_t> without_direction;    ///< pairs of each rotation bin that have none
  std::uint64_t n_pairs;
  std::uint64_t n_zero_baseline;  ///< sum of `without_direction`
  std::size_t n_unregistered;     ///< frames left out because a pose is not finite
};

/// The joint histogram of relative rotation and signed direction errors of all frame pairs, of
/// which every RRA, RTA and binned AUC with these edges is a sum.
///
/// estimate    associated with the reference; its world and scale are its own
///
/// Throws argument_error if the trajectories are not associated or an edge is out of range,
/// undefined_error if fewer than two frames are registered.
inline pair_histogram_result pair_histogram(const trajectory& estimate,
                                            const trajectory& reference,
                                            const pair_histogram_options& options = {}) {
  const registered_frames frames = registered("pair_histogram", estimate, reference);
  if (frames.index.size() < 2) {
    throw undefined_error(message("pair_histogram: 2 registered frames expected, found ",
                                  frames.index.size(), " of ", estimate.size()));
  }
  const joint_counts counts =
      frame_pairs(frames.estimate, frames.reference)
          .count(angle_bins(options.rotation_deg), angle_bins(options.translation_deg),
                 options.threads, options.control);
  const std::size_t columns = counts.translation().size();
  pair_histogram_result out{.rotation_deg = counts.rotation().edges_deg(),
                            .translation_deg = counts.translation().edges_deg(),
                            .counts = {},
                            .without_direction = {},
                            .n_pairs = counts.pairs(),
                            .n_zero_baseline = counts.without_direction(),
                            .n_unregistered = estimate.size() - frames.index.size()};
  for (std::size_t r = 0; r < counts.rotation().size(); ++r) {
    std::vector<std::uint64_t> row;
    for (std::size_t c = 0; c < columns; ++c) row.push_back(counts.at(r, c));
    out.counts.push_back(std::move(row));
    out.without_direction.push_back(counts.at(r, columns));
  }
  return out;
}

}  // namespace aib::pose

// aib/pose/registration.hpp

namespace aib::pose {

struct registration {
  double rate;                       ///< n_registered / n_total
  std::size_t n_registered;          ///< reference frames with a finite pose in the estimate
  std::size_t n_total;               ///< frames of the reference
  std::vector<std::string> missing;  ///< names of the others, in the reference's order
};

/// Share of the reference's frames that have a pose in an estimate, or in any of several
/// sub-models. Frames of the estimate that the reference does not name do not count.
///
/// rules   how names are compared, see associate_options
///
/// Throws argument_error if poses have no names, undefined_error if the reference is empty.
inline registration registration_rate(std::span<const trajectory> estimates,
                                      const trajectory& reference,
                                      const associate_options& rules = {}) {
  if (reference.empty()) throw undefined_error("registration_rate: the reference has no frame");
  std::unordered_set<std::string> posed;
  for (const trajectory& estimate : estimates) {
    if (estimate.names.size() != estimate.size() || reference.names.empty())
      throw argument_error("registration_rate: poses with names expected");
    for (std::size_t i = 0; i < estimate.size(); ++i) {
      if (estimate.world_from_camera[i].is_finite())
        posed.insert(detail::name_key(estimate.names[i], rules));
    }
  }
  registration out{0, 0, reference.size(), {}};
  for (const std::string& name : reference.names) {
    if (posed.contains(detail::name_key(name, rules)))
      ++out.n_registered;
    else
      out.missing.push_back(name);
  }
  out.rate = static_cast<double>(out.n_registered) / static_cast<double>(out.n_total);
  return out;
}

inline registration registration_rate(const trajectory& estimate,
                                      const trajectory& reference,
                                      const associate_options& rules = {}) {
  return registration_rate(std::span(&estimate, 1), reference, rules);
}

/// Index of the sub-model that is scored: most frames, then most points, then the lowest index.
/// Never by score. Throws undefined_error if there is none.
///
/// n_points   one a model, or empty
inline std::size_t largest_model(std::span<const trajectory> models,
                                 std::span<const std::size_t> n_points = {}) {
  if (models.empty()) throw undefined_error("largest_model: no model");
  std::size_t best = 0;
  for (std::size_t i = 1; i < models.size(); ++i) {
    const bool more_points = !n_points.empty() && n_points[i] > n_points[best];
    if (models[i].size() > models[best].size() ||
        (models[i].size() == models[best].size() && more_points))
      best = i;
  }
  return best;
}

}  // namespace aib::pose

// aib/pose/relative_angles.hpp

namespace aib::pose {

struct relative_angles_options {
  std::vector<double> tau_deg = {5, 15, 30};  ///< thresholds, (0, 180]
  unsigned threads = 0;                       ///< 0: all
  struct control control = {};
};

/// Shares are of all pairs; a pair without a direction never scores in `rta`.
struct relative_angles_result {
  std::vector<double> tau_deg;  ///< as asked for
  std::vector<double> rra;      ///< relative rotation accuracy: share of pairs below each tau
  std::vector<double> rta;      ///< relative translation accuracy, signed directions
  std::uint64_t n_pairs;
  std::uint64_t n_zero_baseline;  ///< pairs without a direction
  std::size_t n_unregistered;     ///< frames left out because a pose is not finite
};

/// Shares of frame pairs whose relative rotation, and whose relative translation direction, is off
/// by strictly less than each tau.
///
/// estimate    associated with the reference; its world and scale are its own
///
/// Invariant to a similarity of either side. Throws argument_error if the trajectories are not
/// associated or a tau is out of range, undefined_error if fewer than two frames are registered.
/// Source: Jin et al., "Image matching across wide baselines", IJCV 2021, Sec. 3.3.
inline relative_angles_result relative_angles(const trajectory& estimate,
                                              const trajectory& reference,
                                              const relative_angles_options& options = {}) {
  for (const double tau : options.tau_deg) {
    if (!(tau > 0 && tau <= 180))
      throw argument_error(message("relative_angles: tau in (0, 180] expected, found ", tau));
  }
  const registered_frames frames = registered("relative_angles", estimate, reference);
  if (frames.index.size() < 2) {
    throw undefined_error(message("relative_angles: 2 registered frames expected, found ",
                                  frames.index.size(), " of ", estimate.size()));
  }
  const angle_bins bins(options.tau_deg);
  const joint_counts counts = frame_pairs(frames.estimate, frames.reference)
                                  .count(bins, bins, options.threads, options.control);
  relative_angles_result out{.tau_deg = options.tau_deg,
                             .rra = {},
                             .rta = {},
                             .n_pairs = counts.pairs(),
                             .n_zero_baseline = counts.without_direction(),
                             .n_unregistered = estimate.size() - frames.index.size()};
  const auto n = static_cast<double>(out.n_pairs);
  for (const double tau : options.tau_deg) {
    const std::size_t below = bins.bins_below(tau);
    out.rra.push_back(static_cast<double>(counts.sum(below, 0, counts.columns())) / n);
    out.rta.push_back(static_cast<double>(counts.sum(bins.size(), 0, below)) / n);
  }
  return out;
}

}  // namespace aib::pose

// aib/pose/rpe.hpp

namespace aib::pose {

/// Whose path or turning tells which poses are a delta apart.
enum class pairs_from { estimate, reference };

struct rpe_options {
  pose_relation relation = pose_relation::translation;
  delta_options pairs = {};
  pairs_from from = pairs_from::estimate;  ///< evo's default
};

/// Relative pose error: of each pair of poses a delta apart the motion
/// E = (ref_i^-1 ref_j)^-1 (est_i^-1 est_j). Frames without a finite pose are passed over before
/// deltas are counted.
///
/// Invariant to a rigid motion of either side. Pairs with a reference distance of 0 have no
/// point_distance_ratio and are left out. Throws argument_error if the trajectories are not
/// associated or delta is not positive, undefined_error if no pair is a delta apart.
/// Source: Sturm et al., IROS 2012, Sec. IV-A; evo, core/metrics.py, RPE.
inline pose_errors rpe(const trajectory& estimate,
                       const trajectory& reference,
                       const rpe_options& options = {}) {
  const registered_frames frames = registered("rpe", estimate, reference);
  const auto& path = options.from == pairs_from::estimate ? frames.estimate : frames.reference;
  const bool ratio = options.relation == pose_relation::point_distance_ratio;
  pose_errors out;
  for (const frame_pair& pair : delta_pairs(path, options.pairs)) {
    const auto motion = [&](const std::vector<math::rigid3>& poses) {
      return poses[pair.from].inverse() * poses[pair.to];
    };
    const math::rigid3 est = motion(frames.estimate), ref = motion(frames.reference);
    double error = magnitude(options.relation, ref.inverse() * est);
    if (ratio || options.relation == pose_relation::point_distance)
      error = std::abs(ref.translation.norm() - est.translation.norm());
    if (ratio) {
      if (ref.translation.norm() == 0) continue;
      error *= 100 / ref.translation.norm();
    }
    out.errors.push_back(error);
    out.index.push_back(frames.index[pair.to]);
  }
  if (out.errors.empty()) throw undefined_error("rpe: no reference pose moves over a delta");
  out.summary = stats::summarize(out.errors);
  return out;
}

}  // namespace aib::pose

// aib/pose/sub_trajectory.hpp

namespace aib::pose {

struct sub_trajectory_options {
  std::vector<double> lengths = {};  ///< empty: 10, 20, .. 50 % of the reference's path
  double tolerance = 0.2;            ///< share of the length that a sub-trajectory may miss
};

/// Errors over the sub-trajectories of one length.
struct sub_trajectory_errors {
  double length;
  stats::summary translation;          ///< unit of the positions
  stats::summary translation_percent;  ///< of the length
  stats::summary rotation_deg;
  stats::summary rotation_deg_per_m;
  stats::summary yaw_deg;      ///< about the world's z axis
  stats::summary gravity_deg;  ///< of roll and pitch: what gravity would tell
};

/// Relative errors by the length of sub-trajectories, as rpg_trajectory_evaluation has them: every
/// frame starts one that ends where the reference's path is nearest to the length; the error
/// (ref_i^-1 ref_j)^-1 (est_i^-1 est_j) is turned into the estimate's world. Lengths with fewer
/// than two sub-trajectories are left out.
///
/// Invariant to a translation and a turn about z of either side. Frames without a finite pose are
/// passed over. Throws argument_error if the trajectories are not associated, undefined_error if no
/// length has two.
/// Source: Zhang and Scaramuzza, IROS 2018, Sec. IV; rpg_trajectory_evaluation,
/// compute_trajectory_errors.py.
inline std::vector<sub_trajectory_errors> sub_trajectories(
    const trajectory& estimate,
    const trajectory& reference,
    const sub_trajectory_options& options = {}) {
  const registered_frames frames = registered("sub_trajectories", estimate, reference);
  const std::vector<double> path = path_lengths(frames.reference);
  std::vector<double> lengths = options.lengths;
  if (lengths.empty() && !path.empty()) {
    for (int k = 1; k <= 5; ++k) lengths.push_back(path.back() * k / 10);
  }
  std::vector<sub_trajectory_errors> out;
  for (const double length : lengths) {
    std::vector<double> translation, percent, rotation, per_m, yaw, gravity;
    for (const frame_pair& pair : detail::nearest_along_path(path, length, options.tolerance)) {
      const auto motion = [&](const std::vector<math::rigid3>& poses) {
        return poses[pair.from].inverse() * poses[pair.to];
      };
      const math::rigid3 error = motion(frames.reference).inverse() * motion(frames.estimate);
      const Eigen::Matrix3d& w = frames.estimate[pair.to].rotation;
      const Eigen::Matrix3d r = w * error.rotation * w.transpose();
      translation.push_back(error.translation.norm());
      percent.push_back(100 * translation.back() / length);
      rotation.push_back(math::degrees(math::rotation_angle(r)));
      per_m.push_back(rotation.back() / length);
      yaw.push_back(math::degrees(std::abs(std::atan2(r(1, 0), r(0, 0)))));
      const double pitch = std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0)));
      gravity.push_back(math::degrees(std::hypot(pitch, std::atan2(r(2, 1), r(2, 2)))));
    }
    if (translation.size() < 2) continue;
    out.push_back({length, stats::summarize(translation), stats::summarize(percent),
                   stats::summarize(rotation), stats::summarize(per_m), stats::summarize(yaw),
                   stats::summarize(gravity)});
  }
  if (out.empty()) {
    throw undefined_error(message("sub_trajectories: no length has two; the reference's path is ",
                                  path.empty() ? 0 : path.back(), " long"));
  }
  return out;
}

}  // namespace aib::pose

// aib/pose/worst_pairs.hpp

namespace aib::pose {

struct worst_pairs_options {
  std::size_t n = 10;    ///< how many
  unsigned threads = 0;  ///< 0: all
  struct control control = {};
};

struct worst_pair {
  std::string first, second;  ///< names, or numbers where there are none
  double rotation_deg;
  std::optional<double> translation_deg;  ///< signed direction; nothing where there is none
};

/// The pairs of frames with the largest error, rotation or direction, in descending order.
/// Throws argument_error if the trajectories are not associated.
inline std::vector<worst_pair> worst_pairs(const trajectory& estimate,
                                           const trajectory& reference,
                                           const worst_pairs_options& options = {}) {
  const registered_frames frames = registered("worst_pairs", estimate, reference);
  const frame_pairs pairs(frames.estimate, frames.reference);
  struct found {
    double error;
    std::size_t i, j;
    bool operator<(const found& o) const {
      if (error != o.error) return error > o.error;
      return i != o.i ? i < o.i : j < o.j;
    }
  };
  const auto keep_worst = [&](std::vector<found>& list) {
    const std::size_t n = std::min(options.n, list.size());
    std::partial_sort(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(n), list.end());
    list.resize(n);
  };
  const auto worst = reduce_chunks<std::vector<found>>(
      pairs.frames(), 64, options.threads, options.control, std::vector<found>(),
      [&](const chunk& c) {
        std::vector<found> list;
        double least = -1;  // of the worst so far, once there are enough
        for (std::size_t i = c.begin; i < c.end; ++i) {
          const auto add = [&](std::size_t j, double rotation, double translation) {
            const double error = translation > rotation ? translation : rotation;  // NaN: rotation
            if (!(error > least)) return;
            list.push_back({error, i, j});
            if (list.size() < 2 * options.n + 100) return;
            keep_worst(list);
            least = list.empty() ? least : list.back().error;
          };
          pairs.for_each_error(i, {i + 1, pairs.frames()}, add);
        }
        keep_worst(list);
        return list;
      },
      [&](std::vector<found> a, const std::vector<found>& b) {
        a.insert(a.end(), b.begin(), b.end());
        keep_worst(a);
        return a;
      });
  std::vector<worst_pair> out;
  for (const found& f : worst) {
    const pair_error e = pairs.error(f.i, f.j);
    out.push_back({frame_name(estimate, reference, frames.index[f.i]),
                   frame_name(estimate, reference, frames.index[f.j]), e.rotation_deg,
                   e.translation_deg});
  }
  return out;
}

}  // namespace aib::pose

// aib/sample/eliminate.hpp

namespace aib::sample {

struct eliminate_options {
  std::size_t n = 0;  ///< points that stay
  double area = 0;    ///< of the surface that the points lie on, square units
  unsigned threads = 0;
};

namespace detail {

/// Points and how strongly their neighbours crowd them.
class crowd {
 public:
  crowd(const cloud::cloud& points, const eliminate_options& options)
      : points_(points),
        search_(points),
        reach_(2 * std::sqrt(options.area /
                             (2 * std::numbers::sqrt3 * static_cast<double>(options.n)))),
        weight_(points.size()),
        gone_(points.size()) {
    for_each_chunk(points.size(), 1024, options.threads, {}, [&](const chunk& c) {
      for (std::size_t i = c.begin; i < c.end; ++i) {
        for (const std::size_t j : neighbours_of(i)) weight_[i] += pressure(i, j);
      }
    });
  }

  /// Takes the most crowded points away until n are left.
  [[nodiscard]] std::vector<std::size_t> reduced_to(std::size_t n) {
    using entry = std::pair<double, std::size_t>;
    std::priority_queue<entry> queue;
    for (std::size_t i = 0; i < weight_.size(); ++i) queue.emplace(weight_[i], i);
    for (std::size_t left = weight_.size(); left > n;) {
      const auto [weight, i] = queue.top();
      queue.pop();
      if (gone_[i] || weight != weight_[i]) continue;  // has been put in again with less
      gone_[i] = true;
      --left;
      for (const std::size_t j : neighbours_of(i)) {
        if (gone_[j]) continue;
        weight_[j] -= pressure(j, i);
        queue.emplace(weight_[j], j);
      }
    }
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < gone_.size(); ++i) {
      if (!gone_[i]) kept.push_back(i);
    }
    return kept;
  }

 private:
  /// Ascending, so that sums do not depend on the tree.
  [[nodiscard]] std::vector<std::size_t> neighbours_of(std::size_t i) const {
    std::vector<std::size_t> near;
    search_.for_each_within(points_.position(i), reach_, [&](std::size_t j) {
      if (j != i) near.push_back(j);
    });
    std::sort(near.begin(), near.end());
    return near;
  }

  /// Yuksel, equation 2, with alpha = 8.
  [[nodiscard]] double pressure(std::size_t i, std::size_t j) const {
    const double d = (points_.position(i) - points_.position(j)).norm();
    return std::pow(std::max(0.0, 1 - d / reach_), 8);
  }

  const cloud::cloud& points_;
  cloud::neighbours search_;
  double reach_;
  std::vector<double> weight_;
  std::vector<char> gone_;
};

}  // namespace detail

/// n of many points on a surface, evenly spread: the most crowded goes first, again and again
/// (a Poisson-disk sample). In the order of the cloud; all where there are not more than n.
///
/// points   finite; five times n or more give a good spread
///
/// Throws argument_error unless n and area are positive.
/// Source: Yuksel, "Sample elimination for generating Poisson disk sample sets", CGF 2015.
[[nodiscard]] inline cloud::cloud eliminate(const cloud::cloud& points,
                                            const eliminate_options& options) {
  if (options.n == 0 || !(options.area > 0)) {
    throw argument_error(message("sample::eliminate: n and area > 0 expected, found ", options.n,
                                 " and ", options.area));
  }
  if (points.size() <= options.n) return points;
  return cloud::select(points, detail::crowd(points, options).reduced_to(options.n));
}

}  // namespace aib::sample

// aib/sample/thin.hpp

namespace aib::sample {

struct thin_options {
  double spacing = 0;  ///< in the unit of the cloud
  std::uint64_t seed = 1;
};

namespace detail {

/// Chosen points in cells as wide as the spacing: a point nearer than it lies in one of 27 cells.
class spaced_points {
 public:
  explicit spaced_points(double spacing) : spacing_(spacing) {}

  /// Keeps p unless a kept point lies within the spacing.
  bool keep(const Eigen::Vector3d& p) {
    const cell at = cell_of(p);
    for (std::int64_t k = 0; k < 27; ++k) {
      const cell beside{at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1};
      const auto found = cells_.find(beside);
      if (found == cells_.end()) continue;
      for (const Eigen::Vector3d& q : found->second) {
        if ((p - q).squaredNorm() <= spacing_ * spacing_) return false;
      }
    }
    cells_[at].push_back(p);
    return true;
  }

 private:
  using cell = std::array<std::int64_t, 3>;
  struct hash {
    std::size_t operator()(const cell& c) const {
      std::uint64_t mixed = 0;
      for (const std::int64_t k : c) mixed = random_bits(mixed, static_cast<std::uint64_t>(k));
      return static_cast<std::size_t>(mixed);
    }
  };

  [[nodiscard]] cell cell_of(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d place = (p / spacing_).array().floor().max(-9e18).min(9e18);
    return {static_cast<std::int64_t>(place.x()), static_cast<std::int64_t>(place.y()),
            static_cast<std::int64_t>(place.z())};
  }

  double spacing_;
  std::unordered_map<cell, std::vector<Eigen::Vector3d>, hash> cells_;
};

/// 0 .. n-1 in random order.
inline std::vector<std::size_t> shuffled(std::size_t n, std::uint64_t seed) {
  random_engine random(seed);
  std::vector<std::size_t> order(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = random.below(i + 1);
    order[i] = order[j];
    order[j] = i;
  }
  return order;
}

}  // namespace detail

/// The points, taken in random order, that have no point taken before within the spacing: no two
/// lie within it, and no point is left without one. In the order of the cloud; points that are not
/// finite are left out.
///
/// Throws argument_error if the spacing is not positive.
/// Source: the density of the DTU benchmark, Aanæs et al., IJCV 2016, section 4.
[[nodiscard]] inline cloud::cloud thin(const cloud::cloud& points, const thin_options& options) {
  if (!(options.spacing > 0)) {
    throw argument_error(message("sample::thin: spacing > 0 expected, found ", options.spacing));
  }
  detail::spaced_points kept(options.spacing);
  std::vector<std::size_t> index;
  for (const std::size_t i : detail::shuffled(points.size(), options.seed)) {
    if (!cloud::is_finite(points.points[i])) continue;
    if (kept.keep(points.points[i].cast<double>())) index.push_back(i);
  }
  std::sort(index.begin(), index.end());
  return cloud::select(points, index);
}

}  // namespace aib::sample

// aib/sample/mesh.hpp

namespace aib::sample {

/// How points are spread.
enum class spread {
  uniform,  ///< at random
  poisson,  ///< at random but evenly: no two very near, no large hole (Poisson disk)
};

/// How many points; exactly one of the three is given.
struct mesh_options {
  std::optional<std::size_t> n = {};   ///< this many
  std::optional<double> spacing = {};  ///< uniform: one a square of this side; poisson: none nearer
  std::optional<double> per_area = {};  ///< this many a square unit
  spread method = spread::uniform;
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: all
};

/// Points on a surface and how densely they lie.
struct mesh_samples {
  cloud::cloud points;  ///< with face normals, and labels where the mesh has them
  double area;          ///< of the mesh, square units
  double density;       ///< points a square unit
  /// Mean distance from a point of the surface to the nearest sample: below it an accuracy against
  /// these samples says nothing. Uniform: 0.5 / sqrt(density). Poisson: measured.
  double floor;
};

/// Mean distance from a point of a surface to the nearest of randomly placed samples.
[[nodiscard]] inline double sampling_floor(double density) { return 0.5 / std::sqrt(density); }

/// Points on a mesh, uniform by area. A triangle of area a gets n a / area points, rounded up or
/// down by one random offset for all; within it they are independent.
///
/// With `poisson` these points are candidates: five times n, of which the most crowded are taken
/// away (sample::eliminate), or, for a spacing, so many that few holes are left, of which none
/// nearer than the spacing to another is kept (sample::thin).
///
/// Points lie in the order of their triangles and have the triangle's normal and label.
/// The same for any number of threads.
/// Throws argument_error unless exactly one of n, spacing, per_area is given and positive,
/// undefined_error if the mesh has no area.
mesh_samples mesh(const aib::mesh::mesh& surface, const mesh_options& options);

namespace detail {

inline std::size_t sample_count(const mesh_options& options, double area) {
  if (options.n.has_value() + options.spacing.has_value() + options.per_area.has_value() != 1) {
    throw argument_error("sample::mesh: exactly one of n, spacing and per_area expected");
  }
  const double n = options.n         ? static_cast<double>(*options.n)
                   : options.spacing ? area / (*options.spacing * *options.spacing)
                                     : area * *options.per_area;
  const bool positive = !options.spacing || *options.spacing > 0;
  if (!(n > 0) || !positive) {
    throw argument_error("sample::mesh: n, spacing or per_area must be positive");
  }
  if (n > std::numeric_limits<std::uint32_t>::max()) {
    throw argument_error(message("sample::mesh: at most 4 294 967 295 points expected, found ", n));
  }
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(n)));
}

/// Index of the first sample of each triangle, and at the end their number.
inline std::vector<std::size_t> sample_starts(const aib::mesh::mesh& surface,
                                              double area,
                                              std::size_t n,
                                              double offset) {
  std::vector<std::size_t> starts;
  starts.reserve(surface.triangles.size() + 1);
  double below = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const double place = below / area * static_cast<double>(n) + offset;
    starts.push_back(std::min(n, static_cast<std::size_t>(place)));
    below += aib::mesh::area(surface, t);
  }
  starts.push_back(n);
  return starts;
}

/// Uniform in [0, 1) for a counter.
inline double uniform(std::uint64_t seed, std::uint64_t counter) {
  return static_cast<double>(random_bits(seed, counter) >> 11) * 0x1p-53;
}

/// A point of a triangle for two uniform numbers.
/// Source: Osada et al., "Shape distributions", ACM TOG 2002, equation 1.
inline Eigen::Vector3d point_in(const std::array<Eigen::Vector3d, 3>& corner, double u, double v) {
  const double root = std::sqrt(u);
  return (1 - root) * corner[0] + root * (1 - v) * corner[1] + root * v * corner[2];
}

inline Eigen::Vector3f unit_normal(const std::array<Eigen::Vector3d, 3>& corner) {
  const Eigen::Vector3d ab = corner[1] - corner[0];
  const Eigen::Vector3d ac = corner[2] - corner[0];
  const Eigen::Vector3d normal = ab.cross(ac).normalized();
  return normal.cast<float>();
}

/// An empty cloud that n points will lie in.
inline cloud::cloud room_for(const aib::mesh::mesh& surface, std::size_t n) {
  cloud::cloud points;
  points.origin = surface.origin;
  points.points.resize(n);
  points.normals.resize(n);
  if (!surface.labels.empty()) points.labels.resize(n);
  return points;
}

}  // namespace detail

namespace detail {

/// Points at random, uniform by area.
inline mesh_samples uniform_samples(const aib::mesh::mesh& surface, const mesh_options& options) {
  const double area = aib::mesh::area(surface);
  if (!(area > 0)) {
    throw undefined_error(
        message("sample::mesh: the mesh has no area (", surface.triangles.size(), " triangles)"));
  }
  const std::size_t n = sample_count(options, area);
  const double offset = uniform(options.seed, 0);
  const auto starts = sample_starts(surface, area, n, offset);
  cloud::cloud points = room_for(surface, n);
  for_each_chunk(surface.triangles.size(), 4096, options.threads, {}, [&](const chunk& c) {
    for (std::size_t t = c.begin; t < c.end; ++t) {
      if (starts[t] == starts[t + 1]) continue;
      const auto corner = aib::mesh::corners(surface, t);
      const Eigen::Vector3f normal = unit_normal(corner);
      for (std::size_t i = starts[t]; i < starts[t + 1]; ++i) {
        const Eigen::Vector3d p =
            point_in(corner, uniform(options.seed, 2 * i + 1), uniform(options.seed, 2 * i + 2));
        points.points[i] = p.cast<float>();
        points.normals[i] = normal;
        if (!points.labels.empty()) points.labels[i] = surface.labels[t];
      }
    }
  });
  const double density = static_cast<double>(n) / area;
  return {std::move(points), area, density, sampling_floor(density)};
}

/// Candidates for a Poisson-disk sample: for a spacing, ten a disk of half of it.
inline mesh_samples candidates(const aib::mesh::mesh& surface, mesh_options options) {
  if (options.spacing) {
    options.per_area = 10 / (std::numbers::pi / 4 * *options.spacing * *options.spacing);
    options.spacing.reset();
  } else {
    const double area = aib::mesh::area(surface);
    options.n = 5 * (area > 0 ? sample_count(options, area) : 1);
    options.per_area.reset();
  }
  return uniform_samples(surface, options);
}

inline mesh_samples poisson_samples(const aib::mesh::mesh& surface, const mesh_options& options) {
  if (options.spacing && !(*options.spacing > 0)) {
    throw argument_error("sample::mesh: n, spacing or per_area must be positive");
  }
  mesh_samples samples = candidates(surface, options);
  const cloud::cloud all = std::move(samples.points);
  samples.points =
      options.spacing
          ? thin(all, {.spacing = *options.spacing, .seed = options.seed})
          : eliminate(all, {.n = all.size() / 5, .area = samples.area, .threads = options.threads});
  samples.density = static_cast<double>(samples.points.size()) / samples.area;
  const cloud::distances apart(all, samples.points, {.threads = options.threads});
  // The kept points are candidates too, at distance 0.
  samples.floor = apart.mean() * static_cast<double>(all.size()) /
                  static_cast<double>(all.size() - std::min(all.size() - 1, samples.points.size()));
  return samples;
}

}  // namespace detail

inline mesh_samples mesh(const aib::mesh::mesh& surface, const mesh_options& options) {
  return options.method == spread::poisson ? detail::poisson_samples(surface, options)
                                           : detail::uniform_samples(surface, options);
}

}  // namespace aib::sample

// aib/sample/unproject.hpp

namespace aib::sample {

/// What the numbers of a confidence map are, and thus what `min_confidence` is compared with.
enum class confidence_rule {
  raw,         ///< the number itself is above it (DA3, VGGT: never below 1)
  sigmoid,     ///< 1 / (1 + exp(-number)) is above it (pi3 stores logits)
  percentile,  ///< a share: that part of the valid pixels, the least confident, is left out
};

/// What a depth is.
enum class depth_meaning {
  planar,  ///< distance along the optical axis
  range,   ///< distance from the camera centre
};

struct unproject_options {
  raster::view<const float> confidence = {};  ///< none, or of the size of the map
  std::optional<double> min_confidence = {};  ///< a pixel is kept strictly above it
  confidence_rule rule = confidence_rule::raw;
  std::size_t stride = 1;     ///< every stride-th column and row
  double pixel_offset = 0.5;  ///< of a pixel's centre from its index: 0.5 as COLMAP, or 0
  depth_meaning meaning = depth_meaning::planar;
  raster::view<const raster::rgb> colors = {};  ///< none, or of the size of the map
  unsigned threads = 0;                         ///< 0: all
};

/// Points of a depth map, and what became of its pixels.
struct unprojected {
  cloud::cloud points;   ///< row by row
  std::size_t n_valid;   ///< pixels of the grid with a depth
  std::size_t n_unsure;  ///< of those, left out for their confidence
  std::size_t n_unseen;  ///< left out because the camera sees nothing there
};

/// The points that a depth map shows, in world frame.
///
/// depth              in the unit of the pose
/// camera             any model; where its size differs from the map's, pixels are scaled to it
/// world_from_camera  a depth map and a pose of a method's own scale give points of that scale:
///                    align the points afterwards
///
/// The order of the points does not depend on the number of threads. Throws argument_error if the
/// sizes differ, stride is 0, the pose is not finite or only one of confidence and min_confidence
/// is given.
[[nodiscard]] unprojected unproject(const depth::depth_map& map,
                                    const math::camera& camera,
                                    const math::rigid3& world_from_camera,
                                    const unproject_options& options = {});

namespace detail {

inline void check(const depth::depth_map& map,
                  const math::rigid3& pose,
                  const unproject_options& options) {
  const auto require = [&](bool holds, const auto&... what) {
    if (!holds) throw argument_error(message("sample::unproject: ", what...));
  };
  const auto same_size = [&](std::string_view thing, const auto& view) {
    require(!view.data || (view.width == map.values.width() && view.height == map.values.height()),
            "the depth map is ", map.values.width(), "x", map.values.height(), ", the ", thing, " ",
            view.width, "x", view.height);
  };
  same_size("confidence map", options.confidence);
  same_size("picture", options.colors);
  require(options.stride > 0, "stride >= 1 expected, found 0");
  require(pose.is_finite(), "the pose is not finite");
  require(options.min_confidence.has_value() == (options.confidence.data != nullptr),
          "a confidence map and min_confidence go together, found one of them");
}

/// The confidence as stored that a pixel must exceed. Of a percentile: the quantile of the
/// confidences of valid pixels.
inline double confidence_threshold(const depth::depth_map& map, const unproject_options& options) {
  const double least = *options.min_confidence;
  if (options.rule == confidence_rule::raw) return least;
  if (!(least >= 0 && least <= 1)) {
    throw argument_error(
        message("sample::unproject: min_confidence in [0, 1] expected, found ", least));
  }
  if (options.rule == confidence_rule::sigmoid) return std::log(least / (1 - least));
  std::vector<float> of_valid;
  for (std::size_t y = 0; y < map.values.height(); y += options.stride) {
    for (std::size_t x = 0; x < map.values.width(); x += options.stride) {
      if (depth::is_valid(map.values(x, y))) of_valid.push_back(options.confidence(x, y));
    }
  }
  if (of_valid.empty() || least == 0) return -HUGE_VAL;
  return stats::quantile_in_place<float>(of_valid, least, stats::quantile_rule::lower);
}

/// Unprojects rows of one map.
class unprojector {
 public:
  unprojector(const depth::depth_map& map,
              const math::camera& camera,
              const math::rigid3& world_from_camera,
              const unproject_options& options)
      : map_(map.values), camera_(camera), pose_(world_from_camera), options_(options) {
    if (options.confidence.data) threshold_ = confidence_threshold(map, options);
    if (camera.width > 0 && camera.height > 0) {
      scale_x_ = static_cast<double>(camera.width) / static_cast<double>(map_.width);
      scale_y_ = static_cast<double>(camera.height) / static_cast<double>(map_.height);
    }
  }

  /// Adds the points of a row to `to`, which are counted from `to.points.origin`.
  void add_row(std::size_t y, unprojected& to) const {
    for (std::size_t x = 0; x < map_.width; x += options_.stride) {
      const float depth = map_(x, y);
      if (!depth::is_valid(depth)) continue;
      ++to.n_valid;
      if (threshold_ && !(options_.confidence(x, y) > *threshold_)) {
        ++to.n_unsure;
      } else if (const auto p_in_camera = point(x, y, depth)) {
        const Eigen::Vector3d p = pose_ * *p_in_camera - to.points.origin;
        to.points.points.push_back(p.cast<float>());
        if (options_.colors.data) to.points.colors.push_back(options_.colors(x, y));
      } else {
        ++to.n_unseen;
      }
    }
  }

 private:
  [[nodiscard]] std::optional<Eigen::Vector3d> point(std::size_t x,
                                                     std::size_t y,
                                                     double depth) const {
    const Eigen::Vector2d pixel((static_cast<double>(x) + options_.pixel_offset) * scale_x_,
                                (static_cast<double>(y) + options_.pixel_offset) * scale_y_);
    const auto direction = math::unproject(camera_, pixel);
    if (!direction) return std::nullopt;
    if (options_.meaning == depth_meaning::range) return *direction * depth;
    if (!(direction->z() > 0)) return std::nullopt;
    return *direction * (depth / direction->z());
  }

  raster::view<const float> map_;
  const math::camera& camera_;
  const math::rigid3& pose_;
  const unproject_options& options_;
  std::optional<double> threshold_ = {};
  double scale_x_ = 1;
  double scale_y_ = 1;
};

inline unprojected append(unprojected a, const unprojected& b) {
  const auto extend = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  extend(a.points.points, b.points.points);
  extend(a.points.colors, b.points.colors);
  a.n_valid += b.n_valid;
  a.n_unsure += b.n_unsure;
  a.n_unseen += b.n_unseen;
  return a;
}

}  // namespace detail

inline unprojected unproject(const depth::depth_map& map,
                             const math::camera& camera,
                             const math::rigid3& world_from_camera,
                             const unproject_options& options) {
  detail::check(map, world_from_camera, options);
  const Eigen::Vector3d& centre = world_from_camera.translation;
  unprojected nothing{};
  nothing.points.origin = cloud::natural_origin(centre, centre);
  if (map.values.empty()) return nothing;
  const detail::unprojector rows(map, camera, world_from_camera, options);
  const std::size_t n_rows = (map.values.height() + options.stride - 1) / options.stride;
  const auto points_of = [&](const chunk& c) {
    unprojected part = nothing;
    for (std::size_t i = c.begin; i < c.end; ++i) rows.add_row(i * options.stride, part);
    return part;
  };
  return reduce_chunks(n_rows, 32, options.threads, {}, nothing, points_of, detail::append);
}

}  // namespace aib::sample

// aib/sample/point_map.hpp

namespace aib::sample {

/// The points of a point map, as pi3 and DUSt3R predict them, in world frame.
///
/// xyz                height * width points in the frame of the camera, row by row; one is valid
///                    where its z is a valid depth and x and y are finite
/// world_from_camera  the identity for maps in world frame, whose z is above 0 then
/// options            confidence, min_confidence, rule and stride; the others have no meaning
///
/// Throws argument_error as unproject does, and where the numbers are not that many.
[[nodiscard]] inline unprojected place_point_map(std::span<const float> xyz,
                                                 std::size_t width,
                                                 std::size_t height,
                                                 const math::rigid3& world_from_camera,
                                                 const unproject_options& options = {}) {
  if (xyz.size() != width * height * 3) {
    throw argument_error(message("sample::place_point_map: ", width, "x", height,
                                 " points expected, found ", xyz.size(), " numbers"));
  }
  depth::depth_map z{raster::image<float>(width, height)};
  for (std::size_t k = 0; k < width * height; ++k) z.values.data()[k] = xyz[3 * k + 2];
  detail::check(z, world_from_camera, options);
  std::optional<double> threshold;
  if (options.confidence.data) threshold = detail::confidence_threshold(z, options);
  const Eigen::Vector3d& centre = world_from_camera.translation;
  unprojected made{};
  made.points.origin = cloud::natural_origin(centre, centre);
  for (std::size_t y = 0; y < height; y += options.stride) {
    for (std::size_t x = 0; x < width; x += options.stride) {
      const float* at = xyz.data() + 3 * (y * width + x);
      const Eigen::Vector3d p_in_camera = Eigen::Map<const Eigen::Vector3f>(at).cast<double>();
      if (!depth::is_valid(at[2]) || !p_in_camera.allFinite()) continue;
      ++made.n_valid;
      if (threshold && !(options.confidence(x, y) > *threshold)) {
        ++made.n_unsure;
        continue;
      }
      const Eigen::Vector3d p = world_from_camera * p_in_camera - made.points.origin;
      made.points.points.push_back(p.cast<float>());
    }
  }
  return made;
}

}  // namespace aib::sample

// aib/sample/voxel.hpp

namespace aib::sample {

/// Where the lattice of voxels begins.
enum class voxel_anchor {
  world,   ///< at the origin of the world: one more point moves no other
  open3d,  ///< half a voxel below the cloud's own corner, as Open3D's voxel_down_sample
};

/// The one point that stands for a voxel.
enum class voxel_pick {
  mean,     ///< mean of its points
  centre,   ///< centre of the voxel
  nearest,  ///< that of its points which is nearest to their mean
};

struct voxel_options {
  double size = 0;  ///< edge of a voxel, in the unit of the cloud
  voxel_anchor anchor = voxel_anchor::world;
  voxel_pick pick = voxel_pick::mean;
  unsigned threads = 0;  ///< 0: all
};

/// One point for each voxel that has any, in the order of the lattice. Normal, colour and label are
/// those of the voxel's point nearest to the chosen one. Points that are not finite are left out.
///
/// The cell of a point is calculated in double. The same for any number of threads.
/// Throws argument_error if size is not positive or far too small for the cloud.
[[nodiscard]] cloud::cloud voxel(const cloud::cloud& points, const voxel_options& options);

namespace detail {

/// The lattice: which cell a point lies in, counted from the lowest cell of the cloud.
class voxel_lattice {
 public:
  voxel_lattice(const cloud::cloud& points, const voxel_options& options)
      : points_(points), size_(options.size) {
    if (!(options.size > 0 && std::isfinite(options.size))) {
      throw argument_error(message("sample::voxel: size > 0 expected, found ", options.size));
    }
    const cloud::box box = cloud::bounds(points);
    anchor_.setZero();
    if (options.anchor == voxel_anchor::open3d) anchor_ = box.low.array() - size_ * 0.5;
    if (box.empty()) return;
    const Eigen::Vector3d low = cell_of(box.low), high = cell_of(box.high);
    first_ = low;
    for (int k = 0; k < 3; ++k) {
      if (!(std::abs(low[k]) < 0x1p52 && std::abs(high[k]) < 0x1p52 && high[k] - low[k] < 0x1p31)) {
        throw argument_error(
            message("sample::voxel: size ", size_, " is too small for a cloud of ", box.size()[k]));
      }
      const auto cells = static_cast<std::uint64_t>(high[k] - low[k]) + 1;
      bits_[static_cast<std::size_t>(k)] = static_cast<int>(std::bit_width(cells));
    }
  }

  /// Bits that the cells take on an axis.
  [[nodiscard]] int bits(std::size_t axis) const { return bits_[axis]; }

  [[nodiscard]] std::array<std::uint64_t, 3> cell(std::size_t i) const {
    const Eigen::Vector3d c = cell_of(points_.position(i)) - first_;
    return {static_cast<std::uint64_t>(c.x()), static_cast<std::uint64_t>(c.y()),
            static_cast<std::uint64_t>(c.z())};
  }

  /// Centre of the cell of point i.
  [[nodiscard]] Eigen::Vector3d centre(std::size_t i) const {
    const Eigen::Vector3d c = cell_of(points_.position(i));
    return anchor_.array() + (c.array() + 0.5) * size_;
  }

 private:
  [[nodiscard]] Eigen::Vector3d cell_of(const Eigen::Vector3d& p) const {
    return ((p - anchor_) / size_).array().floor();
  }

  const cloud::cloud& points_;
  double size_;
  Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  std::array<int, 3> bits_{};
};

/// Finite points sorted by their cell (z, then y, then x), then index: one radix sort an axis, the
/// least important axis first, each stable.
inline search::buffer<std::uint64_t> sort_by_cell(const cloud::cloud& points,
                                                  const voxel_lattice& lattice,
                                                  unsigned threads) {
  const int index_bits = std::max(1, static_cast<int>(std::bit_width(points.size())));
  const std::uint64_t mask = (std::uint64_t{1} << index_bits) - 1;
  std::vector<std::uint64_t> finite;
  finite.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (cloud::is_finite(points.points[i])) finite.push_back(i);
  }
  search::buffer<std::uint64_t> words(finite.size());
  std::copy(finite.begin(), finite.end(), words.data());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for_each_chunk(words.size(), 1 << 16, threads, {}, [&](const chunk& c) {
      for (std::size_t w = c.begin; w < c.end; ++w) {
        const std::uint64_t i = words[w] & mask;
        words[w] = lattice.cell(i)[axis] << index_bits | i;
      }
    });
    search::radix_sort(words, {index_bits, index_bits + lattice.bits(axis)}, threads);
  }
  for (std::size_t w = 0; w < words.size(); ++w) words[w] &= mask;
  return words;
}

/// Where each voxel's points begin in the sorted list, and at the end its length.
inline std::vector<std::size_t> voxel_starts(const search::buffer<std::uint64_t>& sorted,
                                             const voxel_lattice& lattice) {
  std::vector<std::size_t> starts;
  std::array<std::uint64_t, 3> last{};
  for (std::size_t w = 0; w < sorted.size(); ++w) {
    const auto cell = lattice.cell(sorted[w]);
    if (w == 0 || cell != last) starts.push_back(w);
    last = cell;
  }
  starts.push_back(sorted.size());
  return starts;
}

/// Index of the point nearest to a position, the first among equals.
inline std::size_t nearest_of(const cloud::cloud& points,
                              std::span<const std::uint64_t> index,
                              const Eigen::Vector3d& to) {
  return *std::min_element(index.begin(), index.end(), [&](std::uint64_t a, std::uint64_t b) {
    return (points.position(a) - to).squaredNorm() < (points.position(b) - to).squaredNorm();
  });
}

/// Mean position of some points.
inline Eigen::Vector3d mean_of(const cloud::cloud& points, std::span<const std::uint64_t> index) {
  Eigen::Vector3d sum(0, 0, 0);
  for (const std::uint64_t i : index) sum += points.points[i].cast<double>();
  return points.origin + sum / static_cast<double>(index.size());
}

}  // namespace detail

inline cloud::cloud voxel(const cloud::cloud& points, const voxel_options& options) {
  const unsigned threads = options.threads == 0 ? available_threads() : options.threads;
  const detail::voxel_lattice lattice(points, options);
  const auto sorted = detail::sort_by_cell(points, lattice, threads);
  const auto starts = detail::voxel_starts(sorted, lattice);
  const std::size_t n = starts.size() - 1;
  std::vector<std::size_t> source(n);
  std::vector<Eigen::Vector3d> position(n);
  for_each_chunk(n, 4096, threads, {}, [&](const chunk& c) {
    for (std::size_t v = c.begin; v < c.end; ++v) {
      const auto members = sorted.span().subspan(starts[v], starts[v + 1] - starts[v]);
      const bool centre = options.pick == voxel_pick::centre;
      position[v] = centre ? lattice.centre(members.front()) : detail::mean_of(points, members);
      source[v] = detail::nearest_of(points, members, position[v]);
    }
  });
  cloud::cloud picked = cloud::select(points, source);
  if (options.pick == voxel_pick::nearest) return picked;
  cloud::placed_points placed =
      cloud::place(n, [&](std::size_t v) -> const Eigen::Vector3d& { return position[v]; });
  picked.origin = placed.origin;
  picked.points = std::move(placed.points);
  return picked;
}

}  // namespace aib::sample

// aib/sample/voxel_grid.hpp

namespace aib::sample {

/// Voxels that clouds are added to, one after another: a scene of thousands of depth maps becomes
/// one cloud in memory that grows with its voxels, not with its points.
///
/// A voxel stands for its points by their mean position and mean colour; normals and labels are
/// left out. Lattice at the origin of the world.
class voxel_grid {
 public:
  /// Only size and threads of the options are used. Throws argument_error if size is not positive.
  explicit voxel_grid(const voxel_options& options);

  /// Points that are not finite are left out. The same for any number of threads. Throws
  /// argument_error if the size is far too small for the cloud.
  void add(const cloud::cloud& points);

  [[nodiscard]] std::size_t size() const { return voxels_.size(); }
  [[nodiscard]] std::uint64_t n_points() const { return n_points_; }  ///< added, finite

  /// One point for each voxel, in the order of the lattice; with colours if all clouds had them.
  [[nodiscard]] cloud::cloud result() const;

 private:
  /// Cell of the world: z, y, x.
  using cell = std::array<std::int64_t, 3>;
  struct cell_hash {
    std::size_t operator()(const cell& c) const {
      std::uint64_t h = 0;
      for (const std::int64_t k : c) {
        h = (h ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15u;
        h ^= h >> 32;
      }
      return static_cast<std::size_t>(h);
    }
  };
  /// Sums of the points of a voxel; offsets are from its corner, so that no digits are lost.
  struct sums {
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    std::array<std::uint64_t, 3> color = {};
    std::uint64_t n = 0;

    sums& operator+=(const sums& other);
  };

  [[nodiscard]] cell cell_of(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d corner_of(const cell& c) const;
  [[nodiscard]] sums sum_of(const cloud::cloud& points, std::span<const std::uint64_t> index) const;

  voxel_options options_;
  std::unordered_map<cell, sums, cell_hash> voxels_;
  std::uint64_t n_points_ = 0;
  bool has_colors_ = true;
};

inline voxel_grid::voxel_grid(const voxel_options& options)
    : options_{.size = options.size, .threads = options.threads} {
  if (!(options.size > 0 && std::isfinite(options.size)))
    throw argument_error(message("sample::voxel_grid: size > 0 expected, found ", options.size));
  if (options_.threads == 0) options_.threads = available_threads();
}

inline voxel_grid::sums& voxel_grid::sums::operator+=(const sums& other) {
  offset += other.offset;
  for (std::size_t k = 0; k < 3; ++k) color[k] += other.color[k];
  n += other.n;
  return *this;
}

inline voxel_grid::cell voxel_grid::cell_of(const Eigen::Vector3d& p) const {
  const auto at = [&](double x) {
    return static_cast<std::int64_t>(std::floor(x / options_.size));
  };
  return {at(p.z()), at(p.y()), at(p.x())};
}

inline Eigen::Vector3d voxel_grid::corner_of(const cell& c) const {
  return Eigen::Vector3d(static_cast<double>(c[2]), static_cast<double>(c[1]),
                         static_cast<double>(c[0])) *
         options_.size;
}

inline voxel_grid::sums voxel_grid::sum_of(const cloud::cloud& points,
                                           std::span<const std::uint64_t> index) const {
  sums total;
  const Eigen::Vector3d corner = corner_of(cell_of(points.position(index.front())));
  for (const std::uint64_t i : index) {
    total.offset += points.position(i) - corner;
    if (points.colors.empty()) continue;
    for (std::size_t k = 0; k < 3; ++k) total.color[k] += points.colors[i][k];
  }
  total.n = index.size();
  return total;
}

inline void voxel_grid::add(const cloud::cloud& points) {
  if (points.size() == 0) return;
  const detail::voxel_lattice lattice(points, options_);
  const auto sorted = detail::sort_by_cell(points, lattice, options_.threads);
  const auto starts = detail::voxel_starts(sorted, lattice);
  const std::size_t n = starts.size() - 1;
  std::vector<sums> parts(n);
  for_each_chunk(n, 4096, options_.threads, {}, [&](const chunk& c) {
    for (std::size_t v = c.begin; v < c.end; ++v)
      parts[v] = sum_of(points, sorted.span().subspan(starts[v], starts[v + 1] - starts[v]));
  });
  for (std::size_t v = 0; v < n; ++v)
    voxels_[cell_of(points.position(sorted[starts[v]]))] += parts[v];
  n_points_ += sorted.size();
  has_colors_ = has_colors_ && !points.colors.empty();
}

inline cloud::cloud voxel_grid::result() const {
  std::vector<std::pair<cell, sums>> sorted(voxels_.begin(), voxels_.end());
  std::sort(sorted.begin(), sorted.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  cloud::placed_points placed = cloud::place(sorted.size(), [&](std::size_t v) -> Eigen::Vector3d {
    const auto& [at, sum] = sorted[v];
    return corner_of(at) + sum.offset / static_cast<double>(sum.n);
  });
  cloud::cloud result;
  result.origin = placed.origin;
  result.points = std::move(placed.points);
  if (!has_colors_) return result;
  for (const auto& voxel : sorted) {
    const sums& sum = voxel.second;
    const auto mean = [&](std::size_t k) {
      return static_cast<std::uint8_t>((2 * sum.color[k] + sum.n) / (2 * sum.n));
    };
    result.colors.push_back({mean(0), mean(1), mean(2)});
  }
  return result;
}

}  // namespace aib::sample

// aib/stats/bootstrap.hpp

namespace aib::stats {

struct bootstrap_options {
  std::size_t block = 10;  ///< neighbours drawn together; 1: independent values
  std::size_t resamples = 2000;
  double level = 0.95;  ///< share of the resampled means inside the interval
  std::uint64_t seed = 1;
};

/// A mean and how far it may be off.
struct interval {
  double mean;
  double low;
  double high;
  double deviation;  ///< of the resampled means: the standard error
};

/// Percentile interval of the mean of a series whose neighbours are alike, as frames of a flight
/// that overlap by 80 % are: blocks of consecutive values are drawn with replacement, the series
/// taken as a ring. With independent draws (block = 1) the interval of such a series is too narrow.
/// A difference of two conditions: pass the differences frame by frame.
///
/// A block longer than the series is the series, and the interval a point. Throws undefined_error
/// if there is no value, argument_error if block or resamples is 0 or level outside (0, 1).
/// Source: Politis, Romano, "A circular block-resampling procedure for stationary data", 1992.
[[nodiscard]] inline interval bootstrap_mean(std::span<const double> values,
                                             const bootstrap_options& options = {}) {
  if (values.empty()) throw undefined_error("stats::bootstrap_mean: no values");
  if (options.block == 0 || options.resamples == 0 || !(options.level > 0 && options.level < 1)) {
    throw argument_error(
        message("stats::bootstrap_mean: block and resamples > 0 and level in "
                "(0, 1) expected, found ",
                options.block, ", ", options.resamples, " and ", options.level));
  }
  const std::size_t n = values.size();
  random_engine random(options.seed);
  std::vector<double> means(options.resamples);
  for (double& mean : means) {
    moments sample;
    while (sample.count() < n) {
      const std::size_t first = random.below(n);
      const std::size_t length = std::min(options.block, n - sample.count());
      for (std::size_t i = 0; i < length; ++i) sample.add(values[(first + i) % n]);
    }
    mean = sample.mean();
  }
  moments of_values, of_means;
  for (const double v : values) of_values.add(v);
  for (const double m : means) of_means.add(m);
  const double tail = (1 - options.level) / 2;
  return {.mean = of_values.mean(),
          .low = quantile<double>(means, tail),
          .high = quantile<double>(means, 1 - tail),
          .deviation = of_means.deviation()};
}

}  // namespace aib::stats

// aib/stream/partition.hpp

namespace aib::stream {

/// A coordinate triple as it lies on disk.
using point = std::array<float, 3>;

/// Space cut into tiles by planes along the axes, each at the median of a sample, across the
/// longest side.
class partition {
 public:
  /// 2^depth tiles.
  partition(std::vector<point> sample, int depth) : depth_(depth) {
    nodes_.resize((std::size_t{1} << depth) - 1);
    split(sample, 0, 0);
  }

  [[nodiscard]] std::size_t size() const { return nodes_.size() + 1; }

  [[nodiscard]] std::uint16_t tile_of(const point& p) const {
    std::size_t node = 0;
    while (node < nodes_.size()) {
      const cut& c = nodes_[node];
      node = 2 * node + (p[c.axis] < c.place ? 1 : 2);
    }
    return static_cast<std::uint16_t>(node - nodes_.size());
  }

 private:
  struct cut {
    std::size_t axis = 0;
    float place = 0;
  };

  static std::size_t longest_axis(std::span<const point> points) {
    std::array<float, 3> extent{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] =
          std::minmax_element(points.begin(), points.end(),
                              [k](const point& a, const point& b) { return a[k] < b[k]; });
      extent[k] = (*high)[k] - (*low)[k];
    }
    return static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) -
                                    extent.begin());
  }

  void split(std::span<point> points, std::size_t node, int level) {
    if (level == depth_) return;
    const std::size_t half = points.size() / 2;
    if (!points.empty()) {
      const std::size_t k = longest_axis(points);
      std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(half),
                       points.end(), [k](const point& a, const point& b) { return a[k] < b[k]; });
      nodes_[node] = {k, points[half][k]};
    }
    split(points.first(half), 2 * node + 1, level + 1);
    split(points.subspan(half), 2 * node + 2, level + 1);
  }

  int depth_;
  std::vector<cut> nodes_;
};

}  // namespace aib::stream

// aib/stream/spill.hpp

namespace aib::stream {

/// Numbers that wait on disk. The file has no name from the start: it is gone when this object is,
/// and when the program is killed.
template <class T>
requires(std::is_trivially_copyable_v<T>) class spill {
 public:
  /// Throws io_error where the folder is not writable.
  explicit spill(const std::filesystem::path& folder) : folder_(folder) {
    std::string name = (folder / "aib_spill.XXXXXX").string();
    file_ = ::mkostemp(name.data(), O_CLOEXEC);
    if (file_ < 0) fail("cannot create a temporary file");
    ::unlink(name.c_str());
  }
  spill(spill&& other) noexcept
      : folder_(std::move(other.folder_)),
        file_(std::exchange(other.file_, -1)),
        written_(other.written_),
        buffer_(std::move(other.buffer_)) {}
  spill& operator=(spill&&) = delete;
  ~spill() {
    if (file_ >= 0) ::close(file_);
  }

  [[nodiscard]] std::uint64_t size() const { return written_ + buffer_.size(); }

  void append(const T& value) {
    buffer_.push_back(value);
    if (buffer_.size() * sizeof(T) >= buffer_bytes) flush();
  }
  void append(std::span<const T> values) {
    flush();
    write(values);
  }

  /// Values first .. first + to.size().
  void read(std::uint64_t first, std::span<T> to) {
    flush();
    auto* bytes = reinterpret_cast<char*>(to.data());
    std::size_t left = to.size_bytes();
    for (auto offset = static_cast<off_t>(first * sizeof(T)); left > 0;) {
      const ssize_t got = ::pread(file_, bytes, left, offset);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) fail("cannot read a temporary file");
      bytes += got;
      offset += got;
      left -= static_cast<std::size_t>(got);
    }
  }

 private:
  static constexpr std::size_t buffer_bytes = std::size_t{1} << 16;

  void flush() {
    write(buffer_);
    buffer_.clear();
  }

  void write(std::span<const T> values) {
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    for (std::size_t left = values.size_bytes(); left > 0;) {
      const ssize_t put = ::write(file_, bytes, left);
      if (put < 0 && errno == EINTR) continue;
      if (put < 0) fail("cannot write a temporary file");
      bytes += put;
      left -= static_cast<std::size_t>(put);
    }
    written_ += values.size();
  }

  [[noreturn]] void fail(const char* what) const {
    throw io_error(folder_, message(what, ": ", std::strerror(errno)));
  }

  std::filesystem::path folder_;
  int file_ = -1;
  std::uint64_t written_ = 0;
  std::vector<T> buffer_;
};

}  // namespace aib::stream

// aib/stream/stored_distances.hpp

namespace aib::stream {

/// Distances that lie on disk, with the statistics of cloud::distances, bit for bit.
class stored_distances {
 public:
  stored_distances(const std::filesystem::path& folder, const cloud::distance_options& options)
      : values_(folder), options_(options), upper_halves_(halves) {}

  /// Takes the next distance: NaN for a point that is not finite.
  void append(float value) {
    chunk_.push_back(value);
    if (chunk_.size() == cloud::detail::value_chunk) take_chunk();
  }
  /// To be called after the last.
  void finish() { take_chunk(); }

  [[nodiscard]] std::size_t n_dropped() const { return sums_.dropped; }
  [[nodiscard]] std::size_t n_finite() const { return values_.size() - sums_.dropped; }
  [[nodiscard]] double mean() const { return sums_.sum / counted(); }
  [[nodiscard]] double rmse() const { return std::sqrt(sums_.squares / counted()); }
  [[nodiscard]] double max() const { return demand_values(), sums_.max; }
  [[nodiscard]] double share_beyond() const {
    return static_cast<double>(n_beyond_) / static_cast<double>(n_finite());
  }

  [[nodiscard]] double median() const {
    demand_values();
    const double place = 0.5 * static_cast<double>(n_counted() - 1);
    const auto below = static_cast<std::uint64_t>(place);
    const double low = nth(below);
    const double share = place - static_cast<double>(below);
    return share == 0 ? low : low + (static_cast<double>(nth(below + 1)) - low) * share;
  }

  [[nodiscard]] std::vector<double> shares_below(std::span<const double> tau) const {
    std::vector<std::uint64_t> below(tau.size());
    for_each_value([&](float d) {
      for (std::size_t k = 0; k < tau.size(); ++k) below[k] += static_cast<double>(d) < tau[k];
    });
    std::vector<double> shares;
    for (const std::uint64_t n : below)
      shares.push_back(static_cast<double>(n) / static_cast<double>(n_finite()));
    return shares;
  }

 private:
  static constexpr std::size_t halves = std::size_t{1} << 16;

  [[nodiscard]] std::uint64_t n_counted() const {
    return n_finite() - (cloud::detail::drops(options_) ? n_beyond_ : 0);
  }
  [[nodiscard]] double counted() const { return demand_values(), static_cast<double>(n_counted()); }
  void demand_values() const {
    if (n_counted() > 0) return;
    throw undefined_error(message("stream::compare_clouds: no distance that counts (", n_finite(),
                                  " points, ", n_beyond_, " beyond max_distance)"));
  }

  [[nodiscard]] bool counts(float d) const {
    return !std::isnan(d) && !(cloud::detail::drops(options_) && std::isinf(d));
  }

  /// Distances are not negative, so that their bits have their order.
  void take_chunk() {
    n_beyond_ += cloud::detail::cut_at_maximum(chunk_, options_);
    sums_ += cloud::detail::sums_of(chunk_, options_);
    for (const float d : chunk_) {
      if (counts(d)) ++upper_halves_[std::bit_cast<std::uint32_t>(d) >> 16];
    }
    values_.append(std::span<const float>(chunk_));
    chunk_.clear();
  }

  template <class Visit>
  void for_each_value(Visit&& visit) const {
    std::vector<float> block;
    for (std::uint64_t first = 0; first < values_.size(); first += block.size()) {
      block.resize(static_cast<std::size_t>(
          std::min<std::uint64_t>(values_.size() - first, cloud::detail::value_chunk)));
      values_.read(first, block);
      for (const float d : block) visit(d);
    }
  }

  /// Bin of the value of a rank, and how many values lie in the bins below it.
  static std::pair<std::uint32_t, std::uint64_t> bin_of(std::span<const std::uint64_t> bins,
                                                        std::uint64_t rank) {
    std::uint64_t below = 0;
    std::uint32_t bin = 0;
    while (below + bins[bin] <= rank) below += bins[bin++];
    return {bin, below};
  }

  /// The value of a rank, from 0: by the upper half of its bits, then the lower.
  [[nodiscard]] float nth(std::uint64_t rank) const {
    const auto [upper, below] = bin_of(upper_halves_, rank);
    std::vector<std::uint64_t> lower_halves(halves);
    for_each_value([&, upper = upper](float d) {
      const auto bits = std::bit_cast<std::uint32_t>(d);
      if (counts(d) && bits >> 16 == upper) ++lower_halves[bits & 0xffff];
    });
    return std::bit_cast<float>(upper << 16 | bin_of(lower_halves, rank - below).first);
  }

  mutable spill<float> values_;
  cloud::distance_options options_;
  std::vector<float> chunk_;
  std::vector<std::uint64_t> upper_halves_;
  cloud::detail::distance_sums sums_;
  std::uint64_t n_beyond_ = 0;
};

}  // namespace aib::stream

// aib/stream/tiled_cloud.hpp

namespace aib::stream {

/// A cloud on disk: how many points it has, and the origin that a reader would give it.
struct cloud_file {
  std::filesystem::path path;
  std::uint64_t size = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

namespace detail {

inline void demand_go(const control& control) {
  if (control.stop.stop_requested()) throw stopped_error("stopped");
}

/// Calls `visit(index, position)` for each point of a file.
template <class Visit>
void for_each_position(const std::filesystem::path& path, const control& control, Visit&& visit) {
  io::ply_positions positions(path);
  std::vector<Eigen::Vector3d> block;
  std::uint64_t index = 0;
  while (positions.next(block)) {
    demand_go(control);
    for (const Eigen::Vector3d& p : block) visit(index++, p);
  }
}

}  // namespace detail

/// Looks through a file for its origin, as io::read_ply_cloud finds it.
[[nodiscard]] inline cloud_file open_cloud(const std::filesystem::path& path,
                                           const control& control = {}) {
  cloud_file file{.path = path};
  {
    const io::ply_positions positions(path);
    file.size = positions.size();
    if (positions.is_float()) return file;
  }
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  detail::for_each_position(path, control, [&](std::uint64_t, const Eigen::Vector3d& p) {
    if (!p.allFinite()) return;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  });
  if (low[0] <= high[0]) file.origin = cloud::natural_origin(low, high);
  return file;
}

namespace detail {

/// Calls `visit(index, point)` for each point as a cloud in memory has it, counted from `origin`.
template <class Visit>
void for_each_point(const cloud_file& file,
                    const Eigen::Vector3d& origin,
                    const control& control,
                    Visit&& visit) {
  const Eigen::Vector3d shift = file.origin - origin;
  for_each_position(file.path, control, [&](std::uint64_t i, const Eigen::Vector3d& position) {
    const Eigen::Vector3d local = position - file.origin;
    const Eigen::Vector3f stored = local.cast<float>();
    const Eigen::Vector3d moved = shift + stored.cast<double>();
    const Eigen::Vector3f p = moved.cast<float>();
    visit(i, point{p.x(), p.y(), p.z()});
  });
}

}  // namespace detail

[[nodiscard]] inline bool is_finite(const point& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// A box in float, empty until something is added.
struct float_box {
  point low{HUGE_VALF, HUGE_VALF, HUGE_VALF};
  point high{-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};

  void add(const point& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }

  /// Not above the squared distance, calculated in float, to any point in the box: each operation
  /// rounds once, and rounding keeps order.
  [[nodiscard]] float squared_distance(const point& p) const {
    float d[3];
    for (std::size_t k = 0; k < 3; ++k) d[k] = std::max({low[k] - p[k], p[k] - high[k], 0.0f});
    return (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
  }
};

/// The points of one tile, in the order of their file.
struct tile {
  spill<point> points;
  float_box box;
};

/// A cloud in tiles on disk.
struct tiled_cloud {
  static constexpr std::uint16_t nowhere = 0xffff;  ///< tile of a point that is not finite

  std::vector<tile> tiles;
  spill<std::uint16_t> tile_of;  ///< of each point, in the order of the file
  std::uint64_t n_finite = 0;

  tiled_cloud(const cloud_file& file,
              const Eigen::Vector3d& origin,
              const partition& cuts,
              const std::filesystem::path& folder,
              const control& control)
      : tile_of(folder) {
    for (std::size_t t = 0; t < cuts.size(); ++t) tiles.push_back({spill<point>(folder), {}});
    detail::for_each_point(file, origin, control, [&](std::uint64_t, const point& p) {
      const std::uint16_t t = is_finite(p) ? cuts.tile_of(p) : nowhere;
      tile_of.append(t);
      if (t == nowhere) return;
      tiles[t].points.append(p);
      tiles[t].box.add(p);
      ++n_finite;
    });
  }
};

/// Every k-th finite point, at most about n.
inline void add_sample(const cloud_file& file,
                       const Eigen::Vector3d& origin,
                       std::uint64_t n,
                       const control& control,
                       std::vector<point>& sample) {
  const std::uint64_t step = std::max<std::uint64_t>(1, file.size / n);
  detail::for_each_point(file, origin, control, [&](std::uint64_t i, const point& p) {
    if (i % step == 0 && is_finite(p)) sample.push_back(p);
  });
}

}  // namespace aib::stream

// aib/stream/compare_clouds.hpp

namespace aib::stream {

struct compare_clouds_options {
  std::uint64_t memory = std::uint64_t{2} << 30;  ///< bytes that the search may take
  std::filesystem::path folder = {};  ///< for what is spilled; the system's temporary one
  cloud::compare_options compare = {};
};

inline namespace AIB_ISA {

namespace tiles {

/// Bytes that a point of a slice takes, as a query and as a target: itself, its index, its tree and
/// what sorting takes.
inline constexpr std::uint64_t bytes_a_point = 140;

/// More tiles would take too many open files; they are then searched in slices.
inline constexpr int most_cuts = 7;

/// Searches the queries of one cloud in the tiles of another.
class search_pass {
 public:
  search_pass(tiled_cloud& targets,
              std::size_t slice,
              float squared_bound,
              const compare_clouds_options& options)
      : targets_(targets), slice_(slice), bound_(squared_bound), options_(options) {}

  /// Squared distance of each query: tiles that may have something nearer, nearest tile first.
  [[nodiscard]] std::vector<float> nearest(std::span<const Eigen::Vector3f> queries) {
    std::vector<float> best(queries.size(), bound_);
    float_box box;
    for (const Eigen::Vector3f& q : queries) box.add(triple(q));
    for (const std::size_t t : by_distance(box)) visit(targets_.tiles[t], queries, best);
    return best;
  }

  static point triple(const Eigen::Vector3f& p) { return {p.x(), p.y(), p.z()}; }

 private:
  /// Tiles that have points, from the one whose box is nearest to the middle of a box.
  [[nodiscard]] std::vector<std::size_t> by_distance(const float_box& box) const {
    point middle;
    for (std::size_t k = 0; k < 3; ++k) middle[k] = box.low[k] / 2 + box.high[k] / 2;
    std::vector<std::pair<float, std::size_t>> order;
    for (std::size_t t = 0; t < targets_.tiles.size(); ++t) {
      const tile& candidate = targets_.tiles[t];
      if (candidate.points.size() > 0)
        order.emplace_back(candidate.box.squared_distance(middle), t);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::size_t> index;
    for (const auto& [distance, t] : order) index.push_back(t);
    return index;
  }

  void visit(tile& target, std::span<const Eigen::Vector3f> queries, std::vector<float>& best) {
    std::vector<std::uint32_t> asked;
    std::vector<Eigen::Vector3f> asking;
    float_box box;
    float farthest = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      if (!(target.box.squared_distance(triple(queries[i])) < best[i])) continue;
      asked.push_back(static_cast<std::uint32_t>(i));
      asking.push_back(queries[i]);
      box.add(triple(queries[i]));
      farthest = std::max(farthest, best[i]);
    }
    if (asked.empty()) return;
    std::vector<Eigen::Vector3f> points;
    for (std::uint64_t first = 0; first < target.points.size(); first += slice_) {
      read(target, first, slice_, points);
      std::erase_if(points, [&](const Eigen::Vector3f& p) {
        return !(box.squared_distance(triple(p)) < farthest);  // nearer to none
      });
      if (points.empty()) continue;
      const auto found = search(asking, points);
      for (std::size_t i = 0; i < asked.size(); ++i)
        best[asked[i]] = std::min(best[asked[i]], found[i]);
    }
  }

  [[nodiscard]] std::vector<float> search(std::span<const Eigen::Vector3f> queries,
                                          std::span<const Eigen::Vector3f> points) const {
    const aib::search::curve order = aib::search::common_curve(queries, points);
    const unsigned threads = options_.compare.threads;
    const control stop{.stop = options_.compare.control.stop};
    const aib::search::box_tree a(queries, order, threads, stop);
    const aib::search::box_tree b(points, order, threads, stop);
    return aib::search::nearest_squared(
        a, b, {.squared_bound = bound_, .threads = threads, .control = stop});
  }

 public:
  /// Up to `most` points of a tile from `first` on.
  static void read(tile& t,
                   std::uint64_t first,
                   std::size_t most,
                   std::vector<Eigen::Vector3f>& points) {
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(t.points.size() - first, most));
    std::vector<point> triples(n);
    t.points.read(first, triples);
    points.resize(n);
    for (std::size_t i = 0; i < n; ++i) points[i] = {triples[i][0], triples[i][1], triples[i][2]};
  }

 private:
  tiled_cloud& targets_;
  std::size_t slice_;
  float bound_;
  const compare_clouds_options& options_;
};

/// Distances that come tile by tile, put in the order of the file.
inline stored_distances in_file_order(tiled_cloud& queries,
                                      spill<float>& by_tile,
                                      const compare_clouds_options& options,
                                      const cloud::distance_options& how) {
  constexpr std::size_t block = 4096;
  struct cursor {
    std::uint64_t next, end;
    std::vector<float> values;
    std::size_t at = 0;
  };
  std::vector<cursor> cursors;
  std::uint64_t first = 0;
  for (const tile& t : queries.tiles) {
    cursors.push_back({first, first + t.points.size(), {}});
    first += t.points.size();
  }
  const auto take = [&](cursor& c) {
    if (c.at == c.values.size()) {
      c.values.resize(static_cast<std::size_t>(std::min<std::uint64_t>(block, c.end - c.next)));
      by_tile.read(c.next, c.values);
      c.next += c.values.size();
      c.at = 0;
    }
    return c.values[c.at++];
  };
  stored_distances stored(options.folder, how);
  std::vector<std::uint16_t> tile_of;
  for (std::uint64_t i = 0; i < queries.tile_of.size(); i += tile_of.size()) {
    detail::demand_go(options.compare.control);
    tile_of.resize(static_cast<std::size_t>(
        std::min<std::uint64_t>(queries.tile_of.size() - i, cloud::detail::value_chunk)));
    queries.tile_of.read(i, tile_of);
    for (const std::uint16_t t : tile_of) {
      stored.append(t == tiled_cloud::nowhere ? std::numeric_limits<float>::quiet_NaN()
                                              : std::sqrt(take(cursors[t])));
    }
  }
  stored.finish();
  return stored;
}

/// How far the searches of both directions are.
struct progress {
  const control& watched;
  std::uint64_t total;
  std::uint64_t done = 0;

  void add(std::uint64_t n) {
    done += n;
    if (watched.progress) watched.progress(static_cast<double>(done) / static_cast<double>(total));
  }
};

inline stored_distances distances(tiled_cloud& queries,
                                  tiled_cloud& targets,
                                  std::size_t slice,
                                  const compare_clouds_options& options,
                                  const cloud::distance_options& how,
                                  progress& progress) {
  search_pass search(targets, slice, cloud::detail::squared_bound(how), options);
  spill<float> by_tile(options.folder);
  std::vector<Eigen::Vector3f> points;
  for (tile& t : queries.tiles) {
    for (std::uint64_t first = 0; first < t.points.size(); first += points.size()) {
      search_pass::read(t, first, slice, points);
      by_tile.append(std::span<const float>(search.nearest(points)));
      progress.add(points.size());
    }
  }
  return in_file_order(queries, by_tile, options, how);
}

inline void demand_points(const tiled_cloud& c, const char* which, const cloud_file& file) {
  if (c.n_finite > 0) return;
  throw undefined_error(message("stream::compare_clouds: no finite point in the ", which,
                                " cloud (", file.size, " points)"));
}

}  // namespace tiles

/// Compares clouds that need not fit in memory: what cloud::compare says of the same files, bit for
/// bit.
///
/// estimate, reference   binary PLY files
///
/// Both are cut into tiles by planes and spilled; a tile is searched in its counterpart, and its
/// points near enough to another tile in that as well. Spilled files have no names: nothing stays
/// behind, whatever happens. Disk: about 44 bytes a point of both.
///
/// Throws undefined_error if either cloud has no finite point, argument_error if a tau is above
/// max_distance or memory below 16 MB, format_error where a file is no binary PLY.
[[nodiscard]] inline cloud::comparison compare_clouds(const std::filesystem::path& estimate,
                                                      const std::filesystem::path& reference,
                                                      compare_clouds_options options = {}) {
  constexpr std::uint64_t least = 16 << 20;
  if (options.memory < least) {
    throw argument_error(message("stream::compare_clouds: memory of ", least,
                                 " bytes or more expected, found ", options.memory));
  }
  if (options.folder.empty()) options.folder = std::filesystem::temp_directory_path();
  const cloud::compare_options& c = options.compare;
  const cloud::distance_options how{
      .max_distance = c.max_distance, .rule = c.rule, .threads = c.threads, .control = c.control};
  cloud::detail::check_maximum(how);
  for (const double tau : c.tau) cloud::detail::check_tau(tau, how);
  const cloud_file e = open_cloud(estimate, c.control), r = open_cloud(reference, c.control);
  const auto slice = static_cast<std::size_t>(options.memory / 2 / tiles::bytes_a_point);
  const auto needed = static_cast<int>(std::bit_width(std::max(e.size, r.size) / slice));
  std::vector<point> sample;
  constexpr std::uint64_t sampled = 100'000;
  add_sample(e, r.origin, sampled, c.control, sample);
  add_sample(r, r.origin, sampled, c.control, sample);
  const partition cuts(std::move(sample), std::min(tiles::most_cuts, needed));
  tiled_cloud est(e, r.origin, cuts, options.folder, c.control);
  tiled_cloud ref(r, r.origin, cuts, options.folder, c.control);
  tiles::demand_points(est, "estimated", e);
  tiles::demand_points(ref, "reference", r);
  tiles::progress progress{c.control, est.n_finite + ref.n_finite};
  const auto to_reference = tiles::distances(est, ref, slice, options, how, progress);
  const auto to_estimate = tiles::distances(ref, est, slice, options, how, progress);
  return cloud::score(to_reference, to_estimate, c.tau);
}

}  // namespace AIB_ISA
}  // namespace aib::stream
