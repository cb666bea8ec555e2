// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A leader and its threads: together they evaluate the pairs of a motion.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include <repel/pairs/pair_search.hpp>
#include <repel/schedule/pair_forces.hpp>
#include <repel/schedule/shared_tick.hpp>
#include <repel/schedule/supervisor.hpp>
#include <repel/schedule/worker_thread.hpp>

namespace repel::detail {

/// The leader, the thread that calls `run`, selects the near pairs, shares their evaluation with
/// the threads and sums the forces. It waits for a thread that has begun a batch, but not for long:
/// if the thread is late, the leader goes over to a second memory of the same pairs, which the late
/// thread cannot touch, and evaluates all of them by itself, until the thread has finished. Then
/// the other memory is the spare one. A thread that does not go on is replaced, and so is the
/// memory it holds.
class PairTeam {
 public:
  /// Pairs, near ones and ones that may be, from which on sharing them is faster than evaluating
  /// them alone.
  static constexpr int worth_sharing = 64;

  /// Allocates. @param prototype poses of the parts at rest @param threads number of threads
  /// besides the leader @param first_index of their numbers for `on_thread_start` @param lookahead
  /// [m] by which a pair may be out of its range and yet be near
  PairTeam(const World& world, std::shared_ptr<const PairIndex> pairs, const PartPoses& prototype,
           const CoprocessorOptions& options, int threads, int first_index, double lookahead);

  /// Evaluates every pair once, without a budget, so that each has an answer at the first tick.
  void prime(const Motion& motion) noexcept;
  /// Starts the threads.
  void start();
  /// Asks them to end.
  void request_stop() noexcept;
  /// Joins them: blocks for ever if one is stalled for ever, but not for one that was killed.
  void stop();
  [[nodiscard]] int threads() const noexcept { return static_cast<int>(helpers_.size()); }

  /// Computes the forces at `motion`. True if the threads were late, and the leader did their work.
  bool run(const Motion& motion) noexcept;

  /// Ticks have passed without this team.
  void skip_ticks() noexcept { current_->pairs().skip_ticks(); }

  /// Repeats queries of the last tick and discards their answers, to warm the CPU caches.
  void rehearse(const Motion& motion) noexcept;

  /// The pairs as of the last `run`.
  [[nodiscard]] const AnyPairSet& pairs() const noexcept { return current_->pairs(); }
  /// Ticks whose pairs were shared.
  [[nodiscard]] std::int64_t shared() const noexcept { return shared_; }
  /// Before `stop`, without what a memory knows that a late or dead thread holds.
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept;

  /// No thread is still at work for an earlier tick. Callable between ticks by the leader.
  [[nodiscard]] bool is_settled() const noexcept;

  /// Looks after the threads: replaces those that do not go on, and the memory they hold; adds up
  /// what the operating system did to them. To be called every now and then by one thread, not in
  /// the tick: it allocates.
  void tend(WorkerUsage& usage);

 private:
  using Clock = std::chrono::steady_clock;

  struct Helper {
    std::unique_ptr<WorkerThread> thread;
    Watch watch;
    ThreadUsage::Counts seen;
  };

  SharedTick* add_set();

  void start_helper(std::size_t i);

  void tend(std::size_t i, WorkerUsage& usage);
  void note_lost() noexcept;

  /// Passes what the search finds to the pairs of this tick.
  struct Sink {
    bool take(PairId id, std::int32_t list, double distance) noexcept;
    int end(std::int32_t list) noexcept { return pairs.end(list); }
    void drop(std::int32_t list) noexcept { pairs.drop(list); }
    AnyPairSet& pairs;
    const Motion& motion;
    PartPoses& poses;
  };

  /// One tick with the current memory. False if a thread was late.
  bool answer(const Motion& motion, const EvaluationLimit& limit, bool may_share) noexcept;

  /// Waits until the threads have finished their batches, or for the patience of the options; in
  /// lock step by no clock.
  [[nodiscard]] bool is_finished() const noexcept;

  static constexpr int rehearsed_pairs = 32;
  static constexpr std::int64_t longest_rest = 1024;    ///< [ticks]
  static constexpr std::int64_t forgives_after = 1024;  ///< [ticks]

  const World* world_;
  CoprocessorOptions options_;
  double lookahead_;           ///< [m]
  const PartPoses prototype_;  ///< of the evaluators
  Evaluator leader_;
  std::shared_ptr<const PairIndex> pairs_;
  PairSearch search_;
  Pace pace_;
  /// Of the leader until `start` and after `stop`, between of `tend`.
  std::vector<std::unique_ptr<SharedTick>> sets_;
  bool stopped_ = false;
  SharedTick* current_ = nullptr;
  SharedTick* spare_ = nullptr;  ///< not idle while a thread is late
  std::int64_t round_ = 0;
  std::int64_t shared_ = 0;
  std::int64_t rest_ = 0;       ///< [ticks] for which the threads are still left alone
  std::int64_t last_rest_ = 0;  ///< [ticks]
  std::atomic<SharedTick*> open_to_all_{nullptr};  ///< what the threads work on
  std::atomic<SharedTick*> held_{nullptr};         ///< a memory that a late thread holds
  std::atomic<SharedTick*> offered_{nullptr};      ///< a new memory in its place
  std::atomic<int> lost_{0};                       ///< threads given up that may yet go on
  Watch held_watch_;
  int first_index_;
  std::vector<std::unique_ptr<WorkerThread>> given_up_;
  std::vector<Helper> helpers_;  // last members: joined before the data they use is destroyed
};

}  // namespace repel::detail
