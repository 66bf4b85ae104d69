// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Errors, concepts, threads, randomness.

#include <aib/core/concepts.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/core/large_pages.hpp>
#include <aib/core/message.hpp>
#include <aib/core/prefetch.hpp>
#include <aib/core/random.hpp>
#include <aib/core/simd.hpp>
#include <aib/core/simd_doubled.hpp>
#include <aib/core/simd_integers.hpp>
#include <aib/core/simd_plain.hpp>
#include <aib/core/simd_wide.hpp>
