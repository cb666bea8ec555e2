// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One tick of the pairs of a world that several threads evaluate together.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include <repel/schedule/any_pair_set.hpp>

namespace repel::detail {

/// What a thread needs of its own to evaluate pairs.
struct Evaluator {
  PartPoses poses;
  bool is_leader = false;
  std::int64_t round = -1;  ///< that `poses` belong to
};

/// A set of pairs whose batches are taken as they come: whoever is free takes the next, the leader
/// the first one left, the others the last. So most pairs stay from tick to tick with the thread
/// that has them in its cache. The leader, always the same thread, opens a round when the set is
/// idle, and from then until all batches taken are finished it is not. Nobody waits in here; a
/// thread that stalls in a batch keeps it, and the set is not idle until it has finished.
class SharedTick {
 public:
  SharedTick(const World& world, int slots, const Budget& budget, double lookahead);

  /// Of the leader, while the set is idle.
  [[nodiscard]] AnyPairSet& pairs() noexcept { return *pairs_; }
  [[nodiscard]] const AnyPairSet& pairs() const noexcept { return *pairs_; }
  /// True when no thread is in a batch.
  [[nodiscard]] bool is_idle() const noexcept;

  /// Leader: opens the batches that AnyPairSet::select has made to all threads. Copies the motion,
  /// which the caller may change while a late thread still reads it.
  /// @param round larger than any before
  void open(std::int64_t round, const Motion& motion, int batches) noexcept;

  /// Any thread: takes batches of the open round and evaluates them until none is left. False if
  /// there was none.
  bool work(Evaluator& evaluator) noexcept;

 private:
  /// The batches not yet taken, in one number that is exchanged as a whole.
  [[nodiscard]] static std::uint64_t span(std::uint32_t first, std::uint32_t end) noexcept;
  [[nodiscard]] static std::uint32_t first_of(std::uint64_t span) noexcept;
  [[nodiscard]] static std::uint32_t end_of(std::uint64_t span) noexcept;

  void evaluate_taken(int batch, Evaluator& evaluator) noexcept;

  std::unique_ptr<AnyPairSet> pairs_;
  Motion motion_;            ///< of the round
  std::int64_t round_ = -1;  ///< that is open
  // Each on a cache line of its own: all threads write to them.
  alignas(64) std::atomic<std::uint64_t> left_{0};  ///< the span of batches not yet taken
  alignas(64) std::atomic<int> unfinished_{0};      ///< batches of the round that are not finished
};

}  // namespace repel::detail
