// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The answer of all near pairs at one motion, and the forces it gives at a later one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <repel/pairs/near_answer.hpp>
#include <repel/pairs/near_pair.hpp>
#include <repel/schedule/any_pair_set.hpp>

namespace repel::detail {

/// All near pairs at one motion. Sized once: it can be filled and copied without allocation.
struct WholeAnswer {
  /// @param most largest number of near pairs
  WholeAnswer(const World& world, int most);

  /// @param pairs as of a tick with `at`
  void fill(const AnyPairSet& pairs, const Motion& at, std::int64_t exchange_of_it) noexcept;
  [[nodiscard]] std::span<const NearAnswer> all() const noexcept { return {near.data(), count}; }

  std::int64_t exchange = 0;  ///< number of the exchange in which the motion was posted
  bool is_settled = true;     ///< no thread was still at work for an earlier motion
  Motion motion;              ///< that was answered
  PairTotals totals;
  std::vector<NearAnswer> near;
  std::vector<NearPair> shown;  ///< the same pairs, for displays and logs
  std::size_t count = 0;        ///< number of valid entries of both
};

/// Computes the forces of a WholeAnswer at a later motion: for every pair the force of its law at a
/// distance that is not larger than the true one, from what both bodies can have done since. All
/// memory is allocated at construction.
class WidenedForces {
 public:
  WidenedForces(const World& world, int most);

  [[nodiscard]] const PairForces& forces() const noexcept { return forces_; }
  /// [N] Size of the force of each pair of the answer, as of the last `widen`.
  [[nodiscard]] double size(std::size_t i) const noexcept { return sizes_[i]; }

  /// Computes them. Cost: about 20 ns for each near pair.
  void widen(const WholeAnswer& answer, const Motion& now) noexcept;

 private:
  /// Adds the pairs from `first` on that are of the same two bodies. Returns the first that is not.
  std::size_t add_run(std::span<const NearAnswer> all, std::size_t first,
                      const Motion& now) noexcept;

  /// @param acts the share of its law that acts now
  [[nodiscard]] double size_of(const NearAnswer& answer,
                               const RelativeMotion<double, Vec<double>>& relative,
                               double acts) const noexcept;
  void supply(const NearAnswer& answer, double gained, const Motion& now) noexcept;
  /// [m] Not larger than the true one.
  [[nodiscard]] double distance_of(const NearAnswer& answer, const Pair& pair) const noexcept;
  [[nodiscard]] const MotionSince& since(BodyId body) const noexcept;

  const World* world_;
  std::vector<MotionSince> since_;  ///< by BodyId
  std::vector<double> sizes_;       ///< [N] by position in the answer
  PairForces forces_;
};

}  // namespace repel::detail
