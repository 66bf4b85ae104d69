// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Flights: planned, measured, and what goes wrong with them.

#include <aib/survey/clearance.hpp>
#include <aib/survey/facade.hpp>
#include <aib/survey/facing.hpp>
#include <aib/survey/flight_path.hpp>
#include <aib/survey/fly.hpp>
#include <aib/survey/footprint.hpp>
#include <aib/survey/frame_scale.hpp>
#include <aib/survey/lens.hpp>
#include <aib/survey/linear.hpp>
#include <aib/survey/measure.hpp>
#include <aib/survey/orbit.hpp>
#include <aib/survey/outline.hpp>
#include <aib/survey/perturb.hpp>
#include <aib/survey/sensor_noise.hpp>
