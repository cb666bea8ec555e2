/// @file
/// What is asked of a distance query and how it can end.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace repel {

/// Why a query stopped. The default is the one that claims nothing.
enum class QueryEnd : std::uint8_t {
  bad_input,     ///< a pose or an option was not finite: nothing is claimed, mend the input
  converged,     ///< the bracket is as narrow as `QueryOptions::tolerance` asks
  touching,      ///< the shapes touch: the sign is 0 as far as arithmetic can tell
  far_apart,     ///< the gap is proven larger than `QueryOptions::ignore_beyond`
  budget_spent,  ///< the bracket is true but wide: raise `QueryOptions::iterations`, or accept it
                 ///< for a curved shape a million times larger than the other
};

/// How deep an overlap is said to be. Each is continuous, changes no faster than the shapes move,
/// and is never deeper than the penetration depth, the shortest way out.
enum class Measure : std::uint8_t {
  reduction,      ///< by the nested levels of both shapes (Anderson 1993); every shape has it
  deepest_point,  ///< the largest sum of the depths of a common point below both surfaces; for
                  ///< all but hulls without thickness, else as `reduction`
  exact,          ///< the penetration depth itself; for boxes, hulls, spheres and capsules, else as
                  ///< `reduction`
};

struct QueryOptions {
  double tolerance = 1e-14;  ///< largest (v.v - v.w) / v.v, the relative duality gap
  int iterations = 256;      ///< cap on support-map pairs in each precision; at least 1
  double ignore_beyond = std::numeric_limits<double>::infinity();  ///< [m]
  /// A bracket wider than this share of the distance is decided in extended precision. 1e-7 leaves
  /// gaps of boxes and hulls above a micrometre to double; 1e-12 gives the distance of their gaps
  /// to so many digits down to a nanometre, at some microseconds for each gap under a centimetre.
  double relative_width = 1e-7;
  Measure measure = Measure::deepest_point;
};

/// What a query leaves for the next one on the same pair: the names of up to four point pairs and
/// the pair of levels they belong to, or of the planes that meet at the deepest point. Any content
/// is safe; good content saves iterations.
struct WarmStart {
  static constexpr std::uint8_t deepest_point = 255;  ///< as a level: the names are of planes

  std::array<std::uint32_t, 4> a{};  ///< Convex::Point::name on A
  std::array<std::uint32_t, 4> b{};  ///< and on B
  std::uint8_t size = 0;
  std::uint8_t level_a = 0;
  std::uint8_t level_b = 0;
  /// Of the pair of levels before that one, which meets: point pairs around a common point.
  std::array<std::uint32_t, 4> met_a{};
  std::array<std::uint32_t, 4> met_b{};
  std::uint8_t met_size = 0;  ///< 4 when they are known
};

}  // namespace repel
