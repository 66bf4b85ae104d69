// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Nearest neighbours and ray queries.

#include <aib/search/box_tree.hpp>
#include <aib/search/buffer.hpp>
#include <aib/search/curve.hpp>
#include <aib/search/hilbert.hpp>
#include <aib/search/nearest.hpp>
#include <aib/search/nearest_one.hpp>
#include <aib/search/nearest_packet.hpp>
#include <aib/search/radix_sort.hpp>
#include <aib/search/ray_fan.hpp>
#include <aib/search/ray_one.hpp>
#include <aib/search/ray_trace.hpp>
#include <aib/search/ray_tree.hpp>
#include <aib/search/ray_triangles.hpp>
#include <aib/search/triangle_tree.hpp>
