// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Triangle meshes and distances to them.

#include <aib/mesh/distances.hpp>
#include <aib/mesh/edges.hpp>
#include <aib/mesh/face_scores.hpp>
#include <aib/mesh/finite_triangles.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/mesh/offsets.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/mesh/surface.hpp>
#include <aib/mesh/transform.hpp>
