// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Statistics of the long comparison: for every invariant, how often it was checked and violated.
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>

namespace repel::accuracy {

enum class Law {
  sign,
  bracket,
  ended,
  absolute,
  relative,
  depth,
  on_shapes,
  along_normal,
  swapped,
  moved,
  reordered,
  oracle,
};
inline constexpr int law_count = 12;

/// One line for each invariant, in the order of the enumeration.
inline constexpr std::array<const char*, law_count> law_names{
    "the sign is right",
    "the bracket holds the truth and the distance",
    "it ends as converged, apart and deeper than 1e-9 of the size",
    "the error is at most 2e-14 of the larger size",
    "the error is at most 1e-6 of the distance",
    "in overlap the distance is never deeper than the depth",
    "witness points lie on their shapes, to 1e-9 of the size",
    "between witness points lies the distance along the normal, to 1e-9 of the size",
    "A and B swapped give the same",
    "a rigid motion of both, up to 1 km, changes nothing but rounding",
    "order and repetition of vertices change nothing",
    "the oracle proved its answer",
};

/// Sums and maxima only, so that merging does not depend on the distribution over threads.
struct Tally {
  std::array<long, law_count> asked{};
  std::array<long, law_count> broken{};
  long pairs = 0;
  long answers = 0;
  long apart = 0;
  long overlapping = 0;
  long below_micrometre = 0;  ///< of the separated pairs
  long extended = 0;          ///< decided in extended precision
  long most_iterations = 0;
  double worst_absolute = 0.0;  ///< error relative to the larger size
  double worst_relative = 0.0;  ///< error relative to the distance
  double worst_on_shape = 0.0;  ///< [1] relative to the size
  double worst_between = 0.0;   ///< [1] relative to the size

  /// Counts one check; returns whether the invariant held.
  bool ask(Law law, bool held) {
    ++asked[static_cast<int>(law)];
    broken[static_cast<int>(law)] += held ? 0 : 1;
    return held;
  }

  [[nodiscard]] long failures() const {
    long sum = 0;
    for (const long b : broken) sum += b;
    return sum;
  }

  void add(const Tally& t) {
    for (int i = 0; i < law_count; ++i) {
      asked[i] += t.asked[i];
      broken[i] += t.broken[i];
    }
    pairs += t.pairs;
    answers += t.answers;
    apart += t.apart;
    overlapping += t.overlapping;
    below_micrometre += t.below_micrometre;
    extended += t.extended;
    most_iterations = std::max(most_iterations, t.most_iterations);
    worst_absolute = std::max(worst_absolute, t.worst_absolute);
    worst_relative = std::max(worst_relative, t.worst_relative);
    worst_on_shape = std::max(worst_on_shape, t.worst_on_shape);
    worst_between = std::max(worst_between, t.worst_between);
  }

  void print() const {
    std::printf("%ld pairs: %ld apart (%ld by less than a micrometre), %ld in overlap\n", pairs,
                apart, below_micrometre, overlapping);
    std::printf("%ld answers, at most %ld iterations; %ld pairs decided in extended precision\n\n",
                answers, most_iterations, extended);
    std::printf("%12s %8s  law\n", "asked", "broken");
    for (int i = 0; i < law_count; ++i) {
      std::printf("%12ld %8ld  %s\n", asked[i], broken[i], law_names[i]);
    }
    std::printf("\nworst error: %.2g of the larger size, %.2g of the distance\n", worst_absolute,
                worst_relative);
    std::printf("worst witness: %.2g of the size off its shape, %.2g off the normal\n",
                worst_on_shape, worst_between);
  }
};

}  // namespace repel::accuracy
