// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Depth maps and their errors.

#include <aib/depth/depth_map.hpp>
