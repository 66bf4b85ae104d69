// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/SVD>

#include <optional>

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
