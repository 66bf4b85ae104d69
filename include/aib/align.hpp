// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Transforms that bring an estimate onto a reference.

#include <aib/align/batches.hpp>
#include <aib/align/icp.hpp>
#include <aib/align/outliers.hpp>
#include <aib/align/pose_fit.hpp>
#include <aib/align/ransac.hpp>
#include <aib/align/spread.hpp>
#include <aib/align/trajectory.hpp>
#include <aib/align/umeyama.hpp>
