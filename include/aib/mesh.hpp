// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Triangle meshes and distances to them.

#include <aib/mesh/distances.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/mesh/surface.hpp>
#include <aib/mesh/transform.hpp>
