// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Options, warm start and end conditions of a distance query.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace repel {

/// Why a query stopped. The default makes no claim.
enum class QueryEnd : std::uint8_t {
  bad_input,  ///< a pose or an option was not finite or out of range: no claim is made, correct the
              ///< input
  converged,  ///< the bracket is as narrow as `QueryOptions::tolerance` requires
  touching,   ///< the shapes touch: the sign cannot be told from 0 within rounding
  far_apart,  ///< the gap is proven to be larger than `QueryOptions::ignore_beyond`
  budget_spent,  ///< the bracket is valid but wide: raise `QueryOptions::iterations`, or accept it
                 ///< for a curved shape a million times larger than the other
};

/// How overlap is measured. Each measure is continuous, changes no faster than the shapes move, and
/// never exceeds the penetration depth, the shortest separating translation.
enum class Measure : std::uint8_t {
  reduction,      ///< by the nested levels of both shapes (Anderson 1993); for every shape
  deepest_point,  ///< the largest sum of the depths of a common point below both surfaces; for all
                  ///< but hulls without thickness, which fall back to `reduction`
  exact,  ///< the penetration depth itself; for boxes, hulls, spheres and capsules, others fall
          ///< back to `reduction`
};

/// Its name, as scene files and options spell it.
[[nodiscard]] inline std::string to_text(Measure measure) {
  switch (measure) {
    case Measure::reduction:
      return "reduction";
    case Measure::deepest_point:
      return "deepest_point";
    case Measure::exact:
      break;
  }
  return "exact";
}

/// All measures, the default first.
inline constexpr std::array<Measure, 3> all_measures{Measure::deepest_point, Measure::reduction,
                                                     Measure::exact};

/// The measure of that name; none for another word.
[[nodiscard]] inline std::optional<Measure> measure_named(std::string_view name) {
  for (const Measure measure : all_measures) {
    if (name == to_text(measure)) return measure;
  }
  return {};
}

/// What a query is asked for. Values out of range end it as `QueryEnd::bad_input`.
struct QueryOptions {
  double tolerance = 1e-14;  ///< largest (v.v - v.w) / v.v, the relative duality gap
  int iterations = 256;      ///< limit of support-map pairs in each precision; at least 1
  double ignore_beyond = std::numeric_limits<double>::infinity();  ///< [m]
  /// A bracket wider than this fraction of the distance is decided in extended precision. With
  /// 1e-7, gaps of boxes and hulls above a micrometre stay in double; with 1e-12, their distance is
  /// right to that many digits down to a nanometre, at some microseconds for each gap below a
  /// centimetre.
  double relative_width = 1e-7;
  Measure measure = Measure::deepest_point;  ///< of an overlap; apart it plays no part
};

/// State of a query for the next one on the same pair: the names of up to four point pairs and
/// their pair of levels, or the names of the planes meeting at the deepest point, or the polytope
/// of an exact depth. Any content is safe; good content saves iterations.
struct WarmStart {
  static constexpr std::uint8_t deepest_point = 255;  ///< value of a level: the names are of planes
  static constexpr std::uint8_t exact_depth = 254;    ///< value of a level: see `faces`
  static constexpr std::size_t most_corners = 16;     ///< of the polytope

  std::array<std::uint32_t, 4> a{};  ///< Convex::Point::name on A
  std::array<std::uint32_t, 4> b{};  ///< Convex::Point::name on B
  std::uint8_t size = 0;             ///< how many entries of `a` and `b` are valid
  std::uint8_t level_a = 0;          ///< of A, or one of the values above
  std::uint8_t level_b = 0;          ///< of B, likewise
  /// The intersecting pair of levels before that one: point pairs around a common point.
  std::array<std::uint32_t, 4> met_a{};
  std::array<std::uint32_t, 4> met_b{};  ///< likewise, on B
  std::uint8_t met_size = 0;             ///< 4 when they are known
  /// Of the polytope of an exact depth, whose `size` corners are named in `a`, `b`, `met_a` and
  /// `met_b`, each by its point of A in the lower half and its point of B in the upper half: the
  /// corners of each face, four bits each.
  std::array<std::uint16_t, 2 * most_corners - 4> faces{};
};

}  // namespace repel
