// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/box.hpp>
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
}

}  // namespace aib::bind
