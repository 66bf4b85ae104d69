// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "meter.hpp"

#include <aib/core/message.hpp>

#include <chrono>
#include <cstdio>
#include <utility>

namespace aib::bind {

namespace {

constexpr double patience_s = 1;
constexpr double between_s = 0.2;

double now_s() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

void write_error(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); }

}  // namespace

meter::meter() : meter(now_s, write_error) {}

meter::meter(std::function<double()> clock, std::function<void(std::string_view)> write)
    : clock_(std::move(clock)), write_(std::move(write)) {}

void meter::operator()(double share) {
  const double now = clock_();
  if (share <= share_) began_ = now;
  share_ = share;
  if (share >= 1) return erase();
  if (now - began_ < patience_s || now - drawn_ < between_s) return;
  drawn_ = now;
  is_shown_ = true;
  write_(message("\0337\033[K  ", static_cast<int>(100 * share), " %\0338"));
}

void meter::erase() {
  if (std::exchange(is_shown_, false)) write_("\033[K");
}

}  // namespace aib::bind
