// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Depth maps and their errors.

#include <aib/depth/accumulate.hpp>
#include <aib/depth/boundary.hpp>
#include <aib/depth/boundary_errors.hpp>
#include <aib/depth/crop.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/depth/error_image.hpp>
#include <aib/depth/error_sums.hpp>
#include <aib/depth/errors.hpp>
#include <aib/depth/fit.hpp>
#include <aib/depth/label_sums.hpp>
#include <aib/depth/normals.hpp>
#include <aib/depth/planes.hpp>
#include <aib/depth/presets.hpp>
#include <aib/depth/rays.hpp>
#include <aib/depth/risk_coverage.hpp>
#include <aib/depth/strata.hpp>
#include <aib/depth/surface_errors.hpp>
