// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The penetration depth of two convex sets.
#pragma once

#include <limits>

#include <repel/base/vec.hpp>

namespace repel::detail {

/// The length of the shortest separating translation, with proven bounds.
struct Depth {
  double value = 0.0;                                      ///< [m] best estimate
  double lower = 0.0;                                      ///< [m] lower bound of the depth
  double upper = std::numeric_limits<double>::infinity();  ///< [m] upper bound of the depth
  Vec<double> n_W{};      ///< unit: A separates from B by moving along -n_W
  Vec<double> p_AQa_W{};  ///< [m] the point of A that leaves B last, from the origin of A
  int iterations = 0;     ///< support-map pairs evaluated
  bool closed = false;    ///< the bounds differ by no more than rounding
};

}  // namespace repel::detail
