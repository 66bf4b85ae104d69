// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/align/umeyama.hpp>

#include <doctest/doctest.h>

#include "../pose/golden.hpp"
#include "../pose/synthetic.hpp"
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

using namespace aib;

namespace test_umeyama {

namespace {

using points = std::vector<Eigen::Vector3d>;

points points_of(const nlohmann::json& rows) {
  points out;
  for (const auto& row : rows) {
    Eigen::Vector3d p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[static_cast<Eigen::Index>(k)] = row.at(k).is_string()
                                            ? std::numeric_limits<double>::quiet_NaN()
                                            : row.at(k).get<double>();
    }
    out.push_back(p);
  }
  return out;
}

double rmse(const math::sim3& t, const points& x, const points& y) {
  double sse = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sse += (t * x[i] - y[i]).squaredNorm();
  return std::sqrt(sse / static_cast<double>(x.size()));
}

points cube() { return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}; }

points moved(const math::sim3& t, points p) {
  for (auto& q : p) q = t * q;
  return p;
}

}  // namespace

TEST_CASE("umeyama finds the similarity that made the points") {
  const math::sim3 truth = synthetic::some_sim3();
  const math::sim3 found = align::umeyama(cube(), moved(truth, cube()));
  CHECK((found.matrix() - truth.matrix()).norm() < 1e-13);
  const math::sim3 rigid = align::umeyama(cube(), moved(truth, cube()), {.scale = false});
  CHECK(rigid.scale == 1);
  CHECK((rigid.rotation - truth.rotation).norm() < 1e-13);
}

TEST_CASE("points may be of any type that point_traits knows") {
  std::vector<std::array<float, 3>> floats;
  for (const auto& p : cube())
    floats.push_back(
        {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  CHECK(align::umeyama(floats, cube()).scale == doctest::Approx(1));
}

TEST_CASE("points on a line are refused in any unit, and so is one place") {
  for (const double unit : {1e-9, 1.0, 1e6}) {
    points line;
    for (int i = 0; i < 10; ++i) line.push_back(unit * i * Eigen::Vector3d(0.6, 0.8, 0));
    CHECK_THROWS_AS(align::umeyama(line, line), undefined_error);
    const points small = moved({unit, Eigen::Matrix3d::Identity(), {0, 0, 0}}, cube());
    CHECK(align::umeyama(small, cube()).scale == doctest::Approx(1 / unit));
  }
  CHECK_THROWS_WITH_AS(align::umeyama(points(4, {1, 2, 3}), points(4, {1, 2, 3})),
                       "umeyama: the positions of the estimate are all in one place",
                       undefined_error);
  CHECK_THROWS_AS(align::umeyama(points{}, points{}), undefined_error);
  CHECK_THROWS_AS(align::umeyama(points(2), points(3)), argument_error);
}

TEST_CASE("evo's degenerate and other inputs") {
  if (!support::has_shared("umeyama")) return;
  const auto json = support::read_json(support::shared() / "golden" / "traj" /
                                       "expected_umeyama_degenerate.json");
  // On this our relative test answers where evo's absolute one refuses.
  const std::set<std::string> ours_accepts = {"tiny_both_1e-9"};
  for (const auto& c : json.at("expected")) {
    const std::string name = c.at("name");
    CAPTURE(name);
    const points x = points_of(c.at("x_n_by_3")), y = points_of(c.at("y_n_by_3"));
    const bool scale = c.at("with_scale");
    const auto fit = [&](align::rank_rule rule) {
      return align::umeyama(x, y, {.scale = scale, .convention = rule});
    };
    if (c.contains("raises")) {
      CHECK_THROWS_AS(fit(align::rank_rule::evo), error);
      if (ours_accepts.contains(name))
        CHECK(rmse(fit(align::rank_rule::relative), x, y) < 1e-6 + (scale ? 0 : 1));
      else
        CHECK_THROWS_AS(fit(align::rank_rule::relative), error);
      continue;
    }
    for (const auto rule : {align::rank_rule::evo, align::rank_rule::relative}) {
      const math::sim3 t = fit(rule);
      const auto& r = c.at("result");
      const double s = r.at("s");
      CHECK(std::abs(t.scale - s) <= 1e-7 * s);
      CHECK((t.rotation - support::matrix3(r.at("R"))).norm() <= 1e-7);
      const Eigen::Vector3d translation = support::vector3(r.at("t"));
      CHECK((t.translation - translation).norm() <= 1e-7 * (1 + translation.norm()));
      CHECK(t.rotation.determinant() == doctest::Approx(1));
      const double expected = c.at("rmse");
      CHECK(std::abs(rmse(t, x, y) - expected) <= 1e-7 * expected + 1e-9);
    }
  }
}

}  // namespace test_umeyama
