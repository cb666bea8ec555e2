// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Walls of random kinds around a tool.
#pragma once

#include <cstdint>
#include <random>

#include "setting.hpp"

namespace repel::hard_walls {

/// Random numbers.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_(seed) {}
  /// Between these.
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  /// From 0 to `of` - 1.
  int pick(int of) { return std::uniform_int_distribution<int>(0, of - 1)(random_); }
  /// A unit vector.
  Vec3 direction() {
    std::normal_distribution<double> normal;
    return Vec3(normal(random_), normal(random_), normal(random_)).normalized();
  }

 private:
  std::mt19937_64 random_;
};

/// Puts walls of a random kind around the first tool of a setting; the arm starts free of them.
/// @return false if none were found
[[nodiscard]] bool add_free_walls(Setting& setting, Draws& draws);

}  // namespace repel::hard_walls
