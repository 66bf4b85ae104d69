// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
// What the tests of the larger domains include anyway.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>
