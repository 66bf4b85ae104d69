// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Depth, normals and labels of meshes by rays.

#include <aib/render/depth.hpp>
#include <aib/render/frame.hpp>
#include <aib/render/hits.hpp>
#include <aib/render/view_rays.hpp>
#include <aib/render/visible.hpp>
