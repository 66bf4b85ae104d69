// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "camera.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace aib::bind {

namespace {

using math::camera;

std::string print(const camera& c) {
  std::string text = message("camera(", math::info(c.model).name, " ", c.width, "x", c.height);
  if (c.has_focal()) text += message(", f ", c.fx());
  return text + ")";
}

/// A length in pixels, nil for a model that has none.
template <double (camera::*Length)() const>
std::optional<double> length(const camera& c) {
  if (!c.has_focal()) return std::nullopt;
  return (c.*Length)();
}

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const auto& info : math::camera_models) names.emplace_back(info.name);
  return names;
}

camera make_camera(options& o) {
  const std::string name = o.text("model", "PINHOLE");
  const auto model = math::find_camera_model(name);
  if (!model) {
    o.reject("model", message("a camera model of COLMAP expected, found '", name, "'",
                              suggestion(name, model_names())));
  }
  camera c{*model, o.count("width", 0), o.count("height", 0), o.numbers("parameters", {})};
  const std::size_t n = math::info(*model).n_parameters;
  if (c.parameters.size() != n) {
    o.reject("parameters",
             message(n, " numbers of ", name, " expected, found ", c.parameters.size()));
  }
  if (!std::all_of(c.parameters.begin(), c.parameters.end(),
                   [](double p) { return std::isfinite(p); }))
    o.reject("parameters", "finite numbers expected");
  o.done();
  return c;
}

}  // namespace

void bind_camera(lua_State* state) {
  type<camera>(state, "camera", print)
      .field("model", [](const camera& c) { return math::info(c.model).name; })
      .field("width", [](const camera& c) { return c.width; })
      .field("height", [](const camera& c) { return c.height; })
      .field("parameters", [](const camera& c) { return c.parameters; })
      .field("fx", [](const camera& c) { return length<&camera::fx>(c); })
      .field("fy", [](const camera& c) { return length<&camera::fy>(c); })
      .field("cx", [](const camera& c) { return length<&camera::cx>(c); })
      .field("cy", [](const camera& c) { return length<&camera::cy>(c); });
  module(state, "math").function("camera", {"options"}, [](options& o) { return make_camera(o); });
}

}  // namespace aib::bind
