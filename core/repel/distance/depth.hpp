/// @file
/// The penetration depth of two convex sets.
#pragma once

#include <limits>

#include <repel/base/vec.hpp>

namespace repel::detail {

/// The length of the shortest way out of an overlap, between proven bounds.
struct Depth {
  double value = 0.0;                                      ///< [m] best value
  double lower = 0.0;                                      ///< [m] the depth is at least this
  double upper = std::numeric_limits<double>::infinity();  ///< [m] and at most this
  Vec<double> n_W{};      ///< unit: A leaves B by moving against it
  Vec<double> p_AQa_W{};  ///< [m] the point of A that leaves B last, from the origin of A
  int iterations = 0;     ///< support-map pairs evaluated
  bool closed = false;    ///< the bounds are as near to each other as rounding lets them be
};

}  // namespace repel::detail
