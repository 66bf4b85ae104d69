// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Trajectories and their errors; needs Eigen alone.

#include <aib/pose/angle_bins.hpp>
#include <aib/pose/ape.hpp>
#include <aib/pose/associate.hpp>
#include <aib/pose/auc.hpp>
#include <aib/pose/auc_breakdown.hpp>
#include <aib/pose/auc_convention.hpp>
#include <aib/pose/baselines.hpp>
#include <aib/pose/delta_pairs.hpp>
#include <aib/pose/focal.hpp>
#include <aib/pose/frame_pairs.hpp>
#include <aib/pose/intrinsics.hpp>
#include <aib/pose/joint_counts.hpp>
#include <aib/pose/kitti_odometry.hpp>
#include <aib/pose/pair_histogram.hpp>
#include <aib/pose/pose_relation.hpp>
#include <aib/pose/registered.hpp>
#include <aib/pose/registration.hpp>
#include <aib/pose/relative_angles.hpp>
#include <aib/pose/rpe.hpp>
#include <aib/pose/sub_trajectory.hpp>
#include <aib/pose/trajectory.hpp>
#include <aib/pose/worst_pairs.hpp>
