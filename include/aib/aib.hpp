// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The whole library.

#include <aib/align.hpp>
#include <aib/cloud.hpp>
#include <aib/core.hpp>
#include <aib/depth.hpp>
#include <aib/io.hpp>
#include <aib/math.hpp>
#include <aib/mesh.hpp>
#include <aib/pose.hpp>
#include <aib/raster.hpp>
#include <aib/render.hpp>
#include <aib/report.hpp>
#include <aib/sample.hpp>
#include <aib/search.hpp>
#include <aib/stats.hpp>
#include <aib/stream.hpp>
#include <aib/survey.hpp>
