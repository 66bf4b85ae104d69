// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <Eigen/Core>

#include "kit.hpp"
