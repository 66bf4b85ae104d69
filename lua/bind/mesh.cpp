// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/box.hpp>
#include <aib/mesh/distances.hpp>
#include <aib/mesh/edges.hpp>
#include <aib/mesh/face_scores.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/mesh/offsets.hpp>
#include <aib/mesh/surface.hpp>
#include <aib/mesh/transform.hpp>

#include "cloud.hpp"
#include "kit.hpp"
#include <cstddef>
#include <string>
#include <vector>

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

const cloud::cloud& samples_option(options& o) {
  const auto* samples = o.object<cloud::cloud>("samples");
  if (!samples) o.reject("samples", "points on the mesh (aib.sample.mesh) expected");
  return *samples;
}

record as_record(lua_State* state, const mesh::face_scores& s) {
  record r(state);
  r.set("accuracy", s.accuracy).set("completeness", s.completeness).set("recall", s.recall);
  return r.set("n_estimate", s.n_estimate).set("n_samples", s.n_samples);
}

/// Gives each label the name that the mesh has for it.
void name_labels(std::vector<record>& list, const mesh::mesh& m) {
  for (record& r : list) {
    const auto label = r.table().get<std::size_t>("label");
    if (label < m.label_names.size()) r.set("name", m.label_names[label]);
  }
}

record summary_of(lua_State* state, const mesh::mesh& m) {
  record r = bind::as_record(state, bounds(m));
  r.set("n_triangles", m.triangles.size()).set("n_vertices", m.vertices.size());
  return r.set("n_open_edges", mesh::n_open_edges(m)).set("area", mesh::area(m));
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
      .field("n_open_edges", [](const mesh::mesh& m) { return mesh::n_open_edges(m); })
      .method("summary", {}, [](lua_State* l, const mesh::mesh& m) { return summary_of(l, m); })
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
      .function("offsets", {"cloud", "mesh"},
                [](session& s, const cloud::cloud& points, const mesh::mesh& m) {
                  return mesh::offsets(points, m, s.threads, s.control);
                })
      .function("with_labels", {"cloud", "mesh"},
                [](session& s, const cloud::cloud& points, const mesh::mesh& m) {
                  cloud::cloud labelled = points;
                  labelled.labels = mesh::nearest_labels(points, m, s.threads, s.control);
                  return labelled;
                })
      .function(
          "face_scores", {"est", "ref", "options"},
          [](lua_State* l, session& s, const cloud::cloud& est, const mesh::mesh& ref, options& o) {
            const auto how = distance_options(o, s);
            const auto& samples = samples_option(o);
            const double tau = o.number("tau", 0);
            o.done();
            return as_record(l, mesh::scores_by_face(est, ref, samples, tau, how));
          })
      .function(
          "compare_by_label", {"est", "ref", "options"},
          [](lua_State* l, session& s, const cloud::cloud& est, const mesh::mesh& ref, options& o) {
            const auto how = distance_options(o, s);
            const auto tau = o.numbers("tau", {});
            const auto& samples = samples_option(o);
            o.done();
            const auto labels = mesh::nearest_labels(est, ref, s.threads, s.control);
            const cloud::two_way_distances both{mesh::distances(est, ref, how),
                                                cloud::distances(samples, est, how)};
            auto list = as_records(l, cloud::by_label(both, labels, samples.labels, how), tau);
            name_labels(list, ref);
            return list;
          })
      .function(
          "compare", {"est", "ref", "options"},
          [](lua_State* l, session& s, const cloud::cloud& est, const mesh::mesh& ref, options& o) {
            const auto how = distance_options(o, s);
            const auto tau = o.numbers("tau", {});
            const auto& samples = samples_option(o);
            o.done();
            return as_record(l, cloud::score(mesh::distances(est, ref, how),
                                             cloud::distances(samples, est, how), tau));
          });
}

}  // namespace aib::bind
