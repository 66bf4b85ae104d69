// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Point clouds and the distances between them.

#include <aib/cloud/cloud.hpp>
