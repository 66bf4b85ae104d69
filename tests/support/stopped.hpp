// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/executor.hpp>

#include <stop_token>

namespace aib::support {

/// The control of work that somebody has already asked to stop.
inline control stopped() {
  std::stop_source source;
  source.request_stop();
  return {.stop = source.get_token()};
}

}  // namespace aib::support
