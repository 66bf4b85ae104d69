// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/colmap.hpp>
#include <aib/io/kitti.hpp>
#include <aib/io/npy.hpp>
#include <aib/io/npz.hpp>
#include <aib/io/transforms.hpp>
#include <aib/io/tum.hpp>

#include <doctest/doctest.h>

#include "zoo.hpp"
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace aib;
using nlohmann::json;

namespace {

/// A number of the manifest, in which what is not finite is a text.
double number(const json& value) {
  if (value == "NaN") return std::nan("");
  if (value == "Infinity") return std::numeric_limits<double>::infinity();
  if (value == "-Infinity") return -std::numeric_limits<double>::infinity();
  return value.get<double>();
}

void check_number(double found, const json& expected) {
  const double wanted = number(expected);
  if (std::isfinite(wanted)) {
    CHECK(found == doctest::Approx(wanted).epsilon(1e-12));
  } else {
    CHECK((std::isnan(wanted) ? std::isnan(found) : found == wanted));
  }
}

void check_array(const io::array& a, const json& expect) {
  if (!expect.contains("shape")) return;
  CHECK(a.shape == expect.at("shape").get<std::vector<std::size_t>>());
  CHECK(name(a.type) == expect.at("dtype").get<std::string>().substr(1));
  double sum = 0;
  const std::vector<double> values = a.values<double>();
  for (const double value : values) sum += std::isfinite(value) ? value : 0;
  if (expect.contains("sum")) check_number(sum, expect.at("sum"));
  if (expect.contains("first_c_order")) check_number(values.front(), expect.at("first_c_order"));
  if (expect.contains("last_c_order")) check_number(values.back(), expect.at("last_c_order"));
  if (expect.contains("second_c_order")) check_number(values.at(1), expect.at("second_c_order"));
}

void check_npz(const std::filesystem::path& path, const json& expect) {
  const io::npz_file file(path);
  for (const std::string& name : file.names()) {
    if (file.is_unreadable(name) && expect.contains("numpy")) continue;  // pickled
    const io::array a = file.read(name);
    const json members = expect.value("members", json::object());
    if (members.contains(name)) check_array(a, members.at(name));
  }
}

void check_trajectory(const pose::trajectory& t, const json& expect) {
  const std::string key = expect.contains("poses") ? "poses" : "frames";
  if (expect.contains(key)) CHECK(t.size() == expect.at(key).get<std::size_t>());
  const auto check_position = [&](const char* name, const math::rigid3& pose) {
    if (!expect.contains(name)) return;
    const auto p = expect.at(name).get<std::vector<double>>();
    CHECK((pose.translation - Eigen::Vector3d(p[0], p[1], p[2])).norm() < 1e-12);
  };
  check_position("first_position", t.world_from_camera.front());
  check_position("last_position", t.world_from_camera.back());
  check_position("last_t", t.world_from_camera.back());
}

void check_transforms(const std::filesystem::path& path, const json& expect) {
  const io::posed_images images = io::read_transforms(path, {.size = {800, 800}});
  check_trajectory(images.trajectory, expect);
  if (expect.contains("fl_x")) CHECK(images.cameras.at(0).fx() == number(expect.at("fl_x")));
  if (expect.contains("focal_for_width_800"))
    check_number(images.cameras.at(0).fx(), expect.at("focal_for_width_800"));
  if (!expect.contains("fl_x_per_frame")) return;
  for (std::size_t i = 0; i < images.cameras.size(); ++i)
    CHECK(images.cameras[i].fx() == number(expect.at("fl_x_per_frame").at(i)));
}

/// Broken models are one folder, sound ones come as text and binary.
void check_colmap(const std::filesystem::path& path, const json& expect) {
  for (const char* kind : {"bin", "txt", ""}) {
    if (!std::filesystem::exists(path / kind / "images.bin") &&
        !std::filesystem::exists(path / kind / "images.txt"))
      continue;
    const io::colmap_model model = io::read_colmap(path / kind);
    if (!expect.contains("images")) continue;
    CHECK(model.trajectory.size() == expect.at("images").size());
    CHECK(model.cameras.size() == expect.at("cameras").size());
  }
}

const zoo::entry npy("npy", [](const auto& path, const json& expect) {
  check_array(io::read_npy(path), expect);
});
const zoo::entry npz("npz", check_npz);
const zoo::entry tum("tum", [](const auto& path, const json& expect) {
  check_trajectory(io::read_tum(path), expect);
});
const zoo::entry kitti("kitti", [](const auto& path, const json& expect) {
  check_trajectory(io::read_kitti(path), expect);
});
const zoo::entry transforms("transforms.json", check_transforms);
const zoo::entry colmap("colmap_model_dir", check_colmap);

}  // namespace
