// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Rotations, transforms, cameras.

#include <aib/math/angle_of.hpp>
#include <aib/math/camera.hpp>
#include <aib/math/geodesy.hpp>
#include <aib/math/log_ratio.hpp>
#include <aib/math/nearest_rotation.hpp>
#include <aib/math/projection.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/rotation.hpp>
#include <aib/math/sim3.hpp>
#include <aib/math/view.hpp>
