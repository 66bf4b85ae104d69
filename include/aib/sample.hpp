// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Clouds from meshes, depth maps and voxels.

#include <aib/sample/eliminate.hpp>
#include <aib/sample/mesh.hpp>
#include <aib/sample/point_map.hpp>
#include <aib/sample/thin.hpp>
#include <aib/sample/unproject.hpp>
#include <aib/sample/voxel.hpp>
#include <aib/sample/voxel_grid.hpp>
#include <aib/sample/voxel_lattice.hpp>
