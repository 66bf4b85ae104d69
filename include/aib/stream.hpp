// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Drivers over files larger than memory.

#include <aib/stream/compare_clouds.hpp>
#include <aib/stream/noisy_image.hpp>
#include <aib/stream/partition.hpp>
#include <aib/stream/render_frames.hpp>
#include <aib/stream/spill.hpp>
#include <aib/stream/stored_distances.hpp>
#include <aib/stream/tiled_cloud.hpp>
