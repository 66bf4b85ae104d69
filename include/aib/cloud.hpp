// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Point clouds and the distances between them.

#include <aib/cloud/box.hpp>
#include <aib/cloud/by_label.hpp>
#include <aib/cloud/cloud.hpp>
#include <aib/cloud/colored.hpp>
#include <aib/cloud/compare.hpp>
#include <aib/cloud/crop.hpp>
#include <aib/cloud/distances.hpp>
#include <aib/cloud/eth3d.hpp>
#include <aib/cloud/free_space.hpp>
#include <aib/cloud/join.hpp>
#include <aib/cloud/neighbours.hpp>
#include <aib/cloud/normals.hpp>
#include <aib/cloud/offsets.hpp>
#include <aib/cloud/origin.hpp>
#include <aib/cloud/outliers.hpp>
#include <aib/cloud/point_tree.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/cloud/select.hpp>
#include <aib/cloud/transform.hpp>
#include <aib/cloud/voxel_shares.hpp>
