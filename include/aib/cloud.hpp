// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Point clouds and the distances between them.

#include <aib/cloud/box.hpp>
#include <aib/cloud/cloud.hpp>
#include <aib/cloud/compare.hpp>
#include <aib/cloud/crop.hpp>
#include <aib/cloud/distances.hpp>
#include <aib/cloud/neighbours.hpp>
#include <aib/cloud/normals.hpp>
#include <aib/cloud/outliers.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/cloud/select.hpp>
#include <aib/cloud/transform.hpp>
