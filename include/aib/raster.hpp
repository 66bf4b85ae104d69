// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Images and views of images.

#include <aib/raster/canny.hpp>
#include <aib/raster/color.hpp>
#include <aib/raster/colormap.hpp>
#include <aib/raster/downsample.hpp>
#include <aib/raster/draw.hpp>
#include <aib/raster/image.hpp>
#include <aib/raster/view.hpp>
