// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/io/depth.hpp>
#include <aib/raster/downsample.hpp>

#include "kit.hpp"

/// What the bindings that read depth maps share.
namespace aib::bind {

/// Which channel or array of a file is the depth, and what its values mean.
inline io::depth_options depth_values(options& o) {
  io::depth_options d;
  d.channel = o.text("channel", d.channel);
  d.key = o.text("key", d.key);
  d.scale = o.number("scale", d.scale);
  d.max_depth = o.number("max_depth", d.max_depth);
  return d;
}

/// The pixel of a larger map that stands for one of a smaller map.
inline raster::nearest_rule rule_option(options& o) {
  using enum raster::nearest_rule;
  return o.choice("rule", centre, {{"centre", centre}, {"floor", floor}});
}

}  // namespace aib::bind
