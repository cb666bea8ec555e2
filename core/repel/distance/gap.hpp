/// @file
/// The answer of a distance query.
#pragma once

#include <limits>

#include <repel/base/vec.hpp>
#include <repel/distance/query.hpp>

namespace repel {

/// The distance of two convex sets, between proven bounds.
struct Gap {
  double distance = 0.0;                                   ///< [m] best value; 0 when the sets meet
  double lower = 0.0;                                      ///< [m] the distance is at least this
  double upper = std::numeric_limits<double>::infinity();  ///< [m] and at most this
  bool meets = false;                                      ///< the sets are proven to share a point
  Vec<double> n_BA_W{};   ///< unit, from B to A; zero when the sets meet or touch
  Vec<double> p_AQa_W{};  ///< [m] witness point on A, from the origin of A
  Vec<double> p_AQb_W{};  ///< [m] witness point on B, from the origin of A
  int iterations = 0;     ///< support-map pairs evaluated
  bool extended = false;  ///< decided in extended precision
  QueryEnd end = QueryEnd::bad_input;
};

}  // namespace repel
