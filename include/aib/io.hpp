// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Readers and writers.

#include <aib/io/axes.hpp>
#include <aib/io/byte_stream.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/cloud.hpp>
#include <aib/io/file.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/io/fingerprint.hpp>
#include <aib/io/half.hpp>
#include <aib/io/mesh.hpp>
#include <aib/io/npy.hpp>
#include <aib/io/numbers.hpp>
#include <aib/io/ply.hpp>
#include <aib/io/ply_data.hpp>
#include <aib/io/ply_header.hpp>
#include <aib/io/ply_write.hpp>
#include <aib/io/positions.hpp>
#include <aib/io/text.hpp>
