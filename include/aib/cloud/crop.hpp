// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/box.hpp>
#include <aib/cloud/cloud.hpp>
#include <aib/cloud/select.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

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
