// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Converts arbitrary bytes to numbers, with an increased share of dangerous values.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

#include <repel/base/types.hpp>

namespace repel::fuzz {

/// Aborts when a contract is violated; the fuzzer keeps the input.
inline void require(bool held, const char* contract) {
  if (held) return;
  std::fprintf(stderr, "broken contract: %s\n", contract);
  std::abort();
}

/// Reads until the bytes are used up; returns zeros after that.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  template <class T>
  T take() {
    T value{};
    const std::size_t count = sizeof(T) < size_ ? sizeof(T) : size_;
    if (count > 0) std::memcpy(&value, data_, count);
    data_ += count;
    size_ -= count;
    return value;
  }

  /// The first byte selects the encoding: raw bits, an entry of a table, or an ordinary length.
  double number() {
    using limits = std::numeric_limits<double>;
    static constexpr std::array<double, 16> special{0.0,
                                                    -0.0,
                                                    limits::quiet_NaN(),
                                                    limits::infinity(),
                                                    -limits::infinity(),
                                                    limits::max(),
                                                    limits::lowest(),
                                                    limits::denorm_min(),
                                                    limits::min(),
                                                    1e-9,
                                                    1e6,
                                                    -1e6,
                                                    1.0,
                                                    -1.0,
                                                    1e-140,
                                                    1e140};
    const auto kind = take<std::uint8_t>();
    if (kind < 8) return with_digits(take<double>());
    if (kind < 32) return special[kind % special.size()];
    return length();
  }

  /// Zero for lengths whose squares are denormal: they define no direction.
  static double with_digits(double x) {
    return std::abs(x) > 1e-165 && std::abs(x) < 1e-150 ? 0.0 : x;
  }

  /// -32 to 32 in steps of 2^-10.
  double length() { return take<std::int16_t>() / 1024.0; }

  Vec3 vector() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }

  Vec3 near() {
    const double x = length();
    const double y = length();
    return {x, y, length()};
  }

  /// Arbitrary numbers, a rigid pose anywhere, or, most often, a rigid pose near the origin.
  Pose pose() {
    Pose X = Pose::Identity();
    const auto kind = take<std::uint8_t>();
    if (kind < 8) {
      for (int i = 0; i < 12; ++i) X.matrix()(i % 3, i / 3) = number();
      return X;
    }
    const Vec3 axis = near();
    const Eigen::Quaterniond q(length(), axis.x(), axis.y(), axis.z());
    if (q.norm() > 0.0) X.linear() = q.normalized().toRotationMatrix();
    X.translation() = kind < 64 ? vector() : near();
    return X;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

}  // namespace repel::fuzz
