// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Trajectories and their errors; needs Eigen alone.

#include <aib/pose/trajectory.hpp>
