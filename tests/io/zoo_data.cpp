// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/cloud.hpp>
#include <aib/io/depth.hpp>
#include <aib/io/mesh.hpp>

#include <doctest/doctest.h>

#include "zoo.hpp"
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#if defined(AIB_WITH_EXR)
#include <zlib.h>
#endif

using namespace aib;
using nlohmann::json;

namespace {

/// Positions against the box and the sums that another program found.
void check_positions(const Eigen::Vector3d& origin,
                     const std::vector<Eigen::Vector3f>& points,
                     const json& expect) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  std::size_t n_finite = 0;
  for (const Eigen::Vector3f& p : points) {
    if (!p.allFinite()) continue;
    const Eigen::Vector3d position = origin + p.cast<double>();
    sum += position;
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
    ++n_finite;
  }
  if (expect.contains("finite_vertices")) CHECK(n_finite == expect["finite_vertices"]);
  const auto near = [&](double found, const json& expected) {
    const double value = expected.get<double>();
    CHECK(std::abs(found - value) <= 1e-6 * (1 + std::abs(value) + high.cwiseAbs().maxCoeff()) *
                                         (1 + static_cast<double>(points.size()) / 1000));
  };
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    if (expect.contains("sum_xyz")) near(sum[k], expect["sum_xyz"][axis]);
    if (!expect.contains("bbox")) continue;
    near(low[k], expect["bbox"][0][axis]);
    near(high[k], expect["bbox"][1][axis]);
  }
}

const zoo::entry ply("ply", [](const auto& path, const json& expect) {
  const auto cloud = io::read_cloud(path);
  if (expect.contains("vertices")) CHECK(cloud.size() == expect["vertices"]);
  check_positions(cloud.origin, cloud.points, expect);
  if (expect.contains("colors")) {
    REQUIRE(cloud.colors.size() == cloud.size());
    const auto& first = expect["colors"]["first"];
    const double unit = first[2] == 1.0 ? 255 : 1;  // float colours are shares in the expectation
    CHECK(cloud.colors[0][2] == first[2].get<double>() * unit);
  }
  if (!expect.contains("triangles_after_fan")) return;
  const auto mesh = io::read_mesh(path);
  CHECK(mesh.vertices == cloud.points);
  CHECK(mesh.triangles.size() == expect["triangles_after_fan"]);
});

const zoo::entry obj("obj", [](const auto& path, const json& expect) {
  const auto mesh = io::read_mesh(path);
  if (expect.contains("v")) CHECK(mesh.vertices.size() == expect["v"]);
  if (expect.contains("triangles_after_fan"))
    CHECK(mesh.triangles.size() == expect["triangles_after_fan"]);
  check_positions(mesh.origin, mesh.vertices, expect);
});

const zoo::entry stl("stl", [](const auto& path, const json& expect) {
  const auto mesh = io::read_mesh(path);
  if (expect.contains("triangles")) CHECK(mesh.triangles.size() == expect["triangles"]);
  check_positions(mesh.origin, mesh.vertices, expect);
  if (!expect.contains("area")) return;
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d ab = mesh.position(b) - mesh.position(a);
    const Eigen::Vector3d ac = mesh.position(c) - mesh.position(a);
    area += ab.cross(ac).norm() / 2;
  }
  CHECK(area == doctest::Approx(expect["area"].get<double>()).epsilon(1e-6));
});

const zoo::entry pfm("pfm", [](const auto& path, const json& expect) {
  const auto map = io::read_depth(path);
  if (!expect.contains("sum")) return;
  CHECK(map.values.height() == expect["shape"][0]);
  CHECK(map.values.width() == expect["shape"][1]);
  double sum = 0;
  for (const float depth : map.values) sum += std::isfinite(depth) ? static_cast<double>(depth) : 0;
  CHECK(sum == doctest::Approx(expect["sum"].get<double>()).epsilon(1e-12));
  if (expect["first_c_order"].is_number())
    CHECK(map.values(0, 0) == expect["first_c_order"].get<float>());
  CHECK(map.values(map.values.width() - 1, map.values.height() - 1) ==
        expect["last_c_order"].get<float>());
});

#if defined(AIB_WITH_PNG)

const zoo::entry png("png", [](const auto& path, const json& expect) {
  const auto map = io::read_depth(path, {.scale = 1});
  if (!expect.contains("sum_per_channel")) return;
  double sum = 0;
  for (const float depth : map.values) sum += static_cast<double>(depth);
  CHECK(map.values.width() == expect["width"]);
  CHECK(sum == expect["sum_per_channel"][0]);
});

#endif

#if defined(AIB_WITH_EXR)

void check_channel(const raster::image<float>& image, const std::string& name, const json& part) {
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(image.data()),
                         static_cast<uInt>(image.size() * sizeof(float)));
  for (const json& channel : part.value("channels", json::array())) {
    if (channel.value("name", "") == name && channel.contains("crc32_le_f32"))
      CHECK(crc == std::stoul(channel["crc32_le_f32"].get<std::string>(), nullptr, 16));
  }
}

const zoo::entry exr("exr", [](const auto& path, const json& expect) {
  // A fuzzer's file whose list of channels claims 800 MB: OpenEXR overlooks it, aib refuses it.
  if (path.filename() == "openexr-tests__comp_bad_pos_bounds_pxr24.exr") return;
  const io::input_file file(path);
  const auto header = io::read_exr_header(file);
  const json parts = expect.value("parts", json::array());
  for (std::size_t p = 0; p < header.parts.size(); ++p) {
    const auto& part = header.parts[p];
    // The lossy codecs of films are refused by name; everything else is read to the bit.
    const auto codec = io::name(part.compression);
    if (codec.starts_with("DWA") || codec.starts_with("B44")) {
      CHECK_THROWS_AS(io::read_exr_channel(file, header, p, 0), format_error);
      return;
    }
    for (std::size_t c = 0; c < part.channels.size(); ++c) {
      const auto image = io::read_exr_channel(file, header, p, c);
      if (p < parts.size()) check_channel(image, part.channels[c].name, parts[p]);
    }
  }
});

#endif

}  // namespace
