// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Data as the page of a report carries it.

#if defined(AIB_WITH_EXR) || defined(AIB_WITH_NPZ)
#include <aib/report/packed.hpp>
#include <aib/report/packed_depth.hpp>
#include <aib/report/packed_points.hpp>
#endif
