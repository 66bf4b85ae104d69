// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Mergeable moments, quantiles, histograms.

#include <aib/stats/bootstrap.hpp>
#include <aib/stats/histogram.hpp>
#include <aib/stats/moments.hpp>
#include <aib/stats/quantiles.hpp>
#include <aib/stats/summary.hpp>
