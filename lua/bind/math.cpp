// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/math/nearest_rotation.hpp>
#include <aib/math/projection.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/sim3.hpp>

#include "kit.hpp"
#include <string>

namespace aib::bind {

namespace {

using math::rigid3;
using math::sim3;

std::string text(const Eigen::Vector3d& v) { return message(v[0], ", ", v[1], ", ", v[2]); }

std::string print_sim3(const sim3& t) {
  return message("sim3(scale ", t.scale, ", turned by ",
                 math::degrees(math::rotation_angle(t.rotation)), " deg, translation ",
                 text(t.translation), ")");
}

std::string print_pose(const rigid3& p) {
  return message("pose(centre ", text(p.translation), ", turned by ",
                 math::degrees(math::rotation_angle(p.rotation)), " deg)");
}

/// A rotation given as a matrix, refused where it is none.
Eigen::Matrix3d rotation_option(options& o, const Eigen::Matrix3d& fallback) {
  const auto matrix = o.get<Eigen::Matrix3d>("rotation");
  if (!matrix) return fallback;
  const auto nearest = math::nearest_rotation(*matrix);
  if (!nearest || nearest->residual > 1e-2) o.reject("rotation", "a rotation matrix expected");
  return nearest->rotation;
}

/// `transform * thing`: of two of the same kind their product, of anything else what its method
/// `transformed` gives.
sol::object product(lua_State* l, const sim3& b_from_a, const sol::object& thing) {
  if (const auto* other = get_if<sim3>(thing)) {
    push(l, b_from_a * *other);
  } else if (const auto* pose = get_if<rigid3>(thing)) {
    push(l, b_from_a * *pose);
  } else if (const auto point = read_if<Eigen::Vector3d>(thing)) {
    push(l, Eigen::Vector3d(b_from_a * *point));
  } else if (thing.get_type() == sol::type::userdata) {
    thing.push(l);
    lua_getfield(l, -1, "transformed");
    lua_insert(l, -2);
    push(l, b_from_a);
    lua_call(l, 2, 1);
  } else {
    throw argument_error(
        "sim3 * thing: a transform, pose, point {x, y, z}, trajectory, cloud or mesh expected");
  }
  return sol::stack::pop<sol::object>(l);
}

void bind_sim3(lua_State* state) {
  type<sim3>(state, "sim3", print_sim3)
      .field("scale", [](const sim3& t) { return t.scale; })
      .field("rotation", [](const sim3& t) { return t.rotation; })
      .field("translation", [](const sim3& t) { return t.translation; })
      .field("angle_deg",
             [](const sim3& t) { return math::degrees(math::rotation_angle(t.rotation)); })
      .method("inverse", {}, [](const sim3& t) { return t.inverse(); })
      .method("summary", {},
              [](lua_State* l, const sim3& t) {
                record r(l);
                r.set("scale", t.scale).set("translation", t.translation);
                r.set("angle_deg", math::degrees(math::rotation_angle(t.rotation)));
                return r.set("shift", t.translation.norm());
              })
      .method("matrix", {}, [](const sim3& t) { return t.matrix(); })
      .meta("__mul", {"thing"}, [](lua_State* l, const sim3& b_from_a, const sol::object& thing) {
        return product(l, b_from_a, thing);
      });
}

void bind_pose_type(lua_State* state) {
  type<rigid3>(state, "pose", print_pose)
      .field("rotation", [](const rigid3& p) { return p.rotation; })
      .field("centre", [](const rigid3& p) { return p.translation; })
      .field("is_registered", [](const rigid3& p) { return p.is_finite(); })
      .method("matrix", {}, [](const rigid3& p) { return p.matrix(); })
      .method("inverse", {}, [](const rigid3& p) { return p.inverse(); });
}

}  // namespace

void bind_math(lua_State* state) {
  bind_sim3(state);
  bind_pose_type(state);
  module(state, "math")
      .function("sim3", {"options"},
                [](options& o) {
                  const sim3 t{o.number("scale", 1), rotation_option(o, sim3{}.rotation),
                               o.get<Eigen::Vector3d>("translation").value_or(sim3{}.translation)};
                  if (!(t.scale > 0)) o.reject("scale", "a scale > 0 expected");
                  if (!t.translation.allFinite())
                    o.reject("translation", "finite numbers expected");
                  o.done();
                  return t;
                })
      .function("project", {"camera", "point"},
                [](const math::camera& c, const Eigen::Vector3d& point) {
                  return math::project(c, point);
                })
      .function("unproject", {"camera", "pixel"},
                [](const math::camera& c, const Eigen::Vector2d& pixel) {
                  return math::unproject(c, pixel);
                })
      .function("pose", {"options"}, [](options& o) {
        const rigid3 p{rotation_option(o, rigid3{}.rotation),
                       o.get<Eigen::Vector3d>("centre").value_or(rigid3{}.translation)};
        o.done();
        return p;
      });
}

}  // namespace aib::bind
