// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/sample/mesh.hpp>

#include "kit.hpp"
#include <cstdint>
#include <utility>

namespace aib::bind {

void bind_sample(lua_State* state) {
  module(state, "sample")
      .function("mesh", {"mesh", "options"},
                [](lua_State* l, session& s, const mesh::mesh& surface, options& o) {
                  const sample::mesh_options how{
                      .n = o.get<std::size_t>("n"),
                      .spacing = o.get<double>("spacing"),
                      .per_area = o.get<double>("per_area"),
                      .seed = static_cast<std::uint64_t>(o.integer("seed", 1)),
                      .threads = s.threads};
                  o.done();
                  auto samples = sample::mesh(surface, how);
                  record info(l);
                  info.set("area", samples.area).set("density", samples.density);
                  info.set("floor", samples.floor);
                  return results(std::move(samples.points), info);
                });
}

}  // namespace aib::bind
