// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for <franka/duration.h> of libfranka.
#pragma once

#include <chrono>
#include <cstdint>
#include <ratio>

namespace franka {

class Duration {  // of whole milliseconds
 public:
  Duration() noexcept = default;
  explicit Duration(uint64_t milliseconds) noexcept : milliseconds_(milliseconds) {}
  Duration(std::chrono::duration<uint64_t, std::milli> time) noexcept
      : milliseconds_(time.count()) {}
  operator std::chrono::duration<uint64_t, std::milli>() const noexcept {
    return std::chrono::duration<uint64_t, std::milli>(milliseconds_);
  }
  double toSec() const noexcept { return 1e-3 * static_cast<double>(milliseconds_); }
  uint64_t toMSec() const noexcept { return milliseconds_; }

  Duration& operator+=(const Duration& rhs) noexcept { return *this = *this + rhs; }
  Duration& operator-=(const Duration& rhs) noexcept { return *this = *this - rhs; }
  Duration& operator*=(uint64_t rhs) noexcept { return *this = *this * rhs; }
  Duration& operator/=(uint64_t rhs) noexcept { return *this = *this / rhs; }
  Duration& operator%=(const Duration& rhs) noexcept { return *this = *this % rhs; }
  Duration& operator%=(uint64_t rhs) noexcept { return *this = *this % rhs; }
  Duration operator+(const Duration& rhs) const noexcept {
    return Duration(milliseconds_ + rhs.milliseconds_);
  }
  Duration operator-(const Duration& rhs) const noexcept {
    return Duration(milliseconds_ - rhs.milliseconds_);
  }
  Duration operator*(uint64_t rhs) const noexcept { return Duration(milliseconds_ * rhs); }
  uint64_t operator/(const Duration& rhs) const noexcept {
    return milliseconds_ / rhs.milliseconds_;
  }
  Duration operator/(uint64_t rhs) const noexcept { return Duration(milliseconds_ / rhs); }
  Duration operator%(const Duration& rhs) const noexcept {
    return Duration(milliseconds_ % rhs.milliseconds_);
  }
  Duration operator%(uint64_t rhs) const noexcept { return Duration(milliseconds_ % rhs); }

  bool operator==(const Duration& rhs) const noexcept { return milliseconds_ == rhs.milliseconds_; }
  bool operator!=(const Duration& rhs) const noexcept { return milliseconds_ != rhs.milliseconds_; }
  bool operator<(const Duration& rhs) const noexcept { return milliseconds_ < rhs.milliseconds_; }
  bool operator<=(const Duration& rhs) const noexcept { return milliseconds_ <= rhs.milliseconds_; }
  bool operator>(const Duration& rhs) const noexcept { return milliseconds_ > rhs.milliseconds_; }
  bool operator>=(const Duration& rhs) const noexcept { return milliseconds_ >= rhs.milliseconds_; }

 private:
  uint64_t milliseconds_ = 0;
};

inline Duration operator*(uint64_t lhs, const Duration& rhs) noexcept {
  return rhs * lhs;
}

}  // namespace franka
