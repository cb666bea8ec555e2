// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The result of a distance query.
#pragma once

#include <limits>

#include <repel/base/vec.hpp>
#include <repel/distance/query.hpp>

namespace repel {

/// The distance of two convex sets with proven bounds.
struct Gap {
  double distance = 0.0;  ///< [m] best estimate; 0 when the sets intersect
  double lower = 0.0;     ///< [m] lower bound of the distance
  double upper = std::numeric_limits<double>::infinity();  ///< [m] upper bound of the distance
  bool meets = false;                                      ///< the sets are proven to intersect
  Vec<double> n_BA_W{};                ///< unit, from B to A; zero at a distance of exactly 0
  Vec<double> p_AQa_W{};               ///< [m] witness point on A, from the origin of A
  Vec<double> p_AQb_W{};               ///< [m] witness point on B, from the origin of A
  int iterations = 0;                  ///< support-map pairs evaluated
  bool extended = false;               ///< decided in extended precision
  QueryEnd end = QueryEnd::bad_input;  ///< why the query stopped
};

}  // namespace repel
