// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/box.hpp>
#include <aib/mesh/distances.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/mesh/surface.hpp>
#include <aib/mesh/transform.hpp>

#include "cloud.hpp"
#include "kit.hpp"
#include <string>

namespace aib::bind {

namespace {

cloud::box bounds(const mesh::mesh& m) { return cloud::bounds(m.vertices, m.origin); }

std::string print_mesh(const mesh::mesh& m) {
  return message("mesh(", grouped(m.triangles.size()), " triangles, ", grouped(m.vertices.size()),
                 " vertices", m.labels.empty() ? "" : ", labels", extent_text(bounds(m)), ")");
}

std::size_t bytes_of_mesh(const mesh::mesh& m) {
  return m.vertices.size() * sizeof(Eigen::Vector3f) + m.triangles.size() * sizeof(mesh::triangle) +
         m.labels.size() * sizeof(std::uint32_t);
}

}  // namespace

void bind_mesh(lua_State* state) {
  type<mesh::mesh>(state, "mesh", print_mesh, bytes_of_mesh)
      .field("n_triangles", [](const mesh::mesh& m) { return m.triangles.size(); })
      .field("n_vertices", [](const mesh::mesh& m) { return m.vertices.size(); })
      .field("label_names", [](const mesh::mesh& m) { return m.label_names; })
      .field("warnings", [](const mesh::mesh& m) { return m.warnings; })
      .method("bounds", {},
              [](lua_State* l, const mesh::mesh& m) { return as_record(l, bounds(m)); })
      .method("area", {}, [](const mesh::mesh& m) { return mesh::area(m); })
      .method("transformed", {"transform"},
              [](const mesh::mesh& m, const math::sim3& b_from_a) { return b_from_a * m; });
  module(state, "mesh")
      .function("distances", {"cloud", "mesh", "options"},
                [](session& s, const cloud::cloud& points, const mesh::mesh& m, options& o) {
                  const auto how = distance_options(o, s);
                  o.done();
                  return mesh::distances(points, m, how);
                })
      .function(
          "compare", {"est", "ref", "options"},
          [](lua_State* l, session& s, const cloud::cloud& est, const mesh::mesh& ref, options& o) {
            const auto how = distance_options(o, s);
            const auto tau = o.numbers("tau", {});
            const auto* samples = o.object<cloud::cloud>("samples");
            if (!samples) o.reject("samples", "points on the mesh (aib.sample.mesh) expected");
            o.done();
            return as_record(l, cloud::score(mesh::distances(est, ref, how),
                                             cloud::distances(*samples, est, how), tau));
          });
}

}  // namespace aib::bind
