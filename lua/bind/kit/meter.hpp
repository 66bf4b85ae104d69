// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string_view>

namespace aib::bind {

/// How far a long call of the library is, as a percentage behind whatever stands on the terminal's
/// line; the cursor stays where it was. Silent for calls shorter than a second. For `control`.
class meter {
 public:
  /// On stderr.
  meter();
  /// clock   seconds from any start
  /// write   takes what the terminal is given
  meter(std::function<double()> clock, std::function<void(std::string_view)> write);

  /// share   0..1; one that does not rise begins another call
  void operator()(double share);

 private:
  void erase();

  std::function<double()> clock_;
  std::function<void(std::string_view)> write_;
  double share_ = 1;
  double began_ = 0;
  double drawn_ = 0;
  bool is_shown_ = false;
};

}  // namespace aib::bind
