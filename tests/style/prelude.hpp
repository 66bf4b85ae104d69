// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
// What most public headers include, read once for g++: clang tells that a header includes all that
// it uses; g++, in half the time so, that it parses every header and has nothing to warn of.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>
