// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How much of a tick the evaluation of pairs may take.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>

namespace repel {

/// Budget for the pair evaluations of one tick. A pair that could not be evaluated keeps its last
/// answer, with its distance reduced by the motion since.
struct Budget {
  std::int64_t work_units = 0;  ///< support-map pairs per tick; 0 = no limit. The pair that has
                                ///< been begun is finished
  std::chrono::nanoseconds wall{0};  ///< per tick, from its beginning; 0 = no limit
  /// [ticks] A near pair without a new answer for longer than this is expired: its force fades out
  /// linearly and is zero after twice that time.
  std::int64_t max_age = 100;
};

namespace detail {

/// When the evaluation of a tick has to end.
struct EvaluationLimit {
  using Clock = std::chrono::steady_clock;
  static constexpr std::int64_t no_limit = std::numeric_limits<std::int64_t>::max();

  Clock::time_point deadline = Clock::time_point::max();
  std::int64_t work_units = no_limit;  ///< support-map pairs

  /// That of a budget which begins now. Reads the clock where it has a limit of time.
  [[nodiscard]] static EvaluationLimit from_now(const Budget& budget) noexcept;

  [[nodiscard]] bool is_counted() const noexcept { return work_units < no_limit; }
  [[nodiscard]] bool is_set() const noexcept;
  /// @param spent support-map pairs so far
  [[nodiscard]] bool is_reached(std::int64_t spent) const noexcept;
};

inline EvaluationLimit EvaluationLimit::from_now(const Budget& budget) noexcept {
  EvaluationLimit limit;
  if (budget.wall.count() > 0) limit.deadline = Clock::now() + budget.wall;
  if (budget.work_units > 0) limit.work_units = budget.work_units;
  return limit;
}

inline bool EvaluationLimit::is_set() const noexcept {
  return is_counted() || deadline != Clock::time_point::max();
}

inline bool EvaluationLimit::is_reached(std::int64_t spent) const noexcept {
  return spent >= work_units || (deadline != Clock::time_point::max() && Clock::now() >= deadline);
}

}  // namespace detail
}  // namespace repel
