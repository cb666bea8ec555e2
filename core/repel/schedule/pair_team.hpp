// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A leader and its threads: together they evaluate the pairs of a motion.
#pragma once

#include <algorithm>
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
           const CoprocessorOptions& options, int threads, int first_index, double lookahead)
      : world_(&world),
        options_(options),
        lookahead_(lookahead),
        prototype_(prototype),
        leader_{.poses = prototype_, .is_leader = true},
        pairs_(std::move(pairs)),
        search_(pairs_),
        pace_(options.period),
        first_index_(first_index),
        helpers_(static_cast<std::size_t>(threads)) {
    current_ = add_set();
    if (threads == 0) return;
    spare_ = add_set();
    open_to_all_.store(current_, std::memory_order_release);
  }

  /// Evaluates every pair once, without a budget, so that each has an answer at the first tick.
  void prime(const Motion& motion) noexcept {
    leader_.poses.begin_tick();
    current_->pairs().prime(motion, leader_.poses);
    (void)answer(motion, {}, false);
  }
  /// Starts the threads.
  void start() {
    for (std::size_t i = 0; i < helpers_.size(); ++i) start_helper(i);
  }
  /// Asks them to end.
  void request_stop() noexcept {
    for (Helper& helper : helpers_) helper.thread->request_stop();
  }
  /// Joins them: blocks for ever if one is stalled for ever, but not for one that was killed.
  void stop() {
    for (Helper& helper : helpers_) {
      if (helper.thread != nullptr) helper.thread->stop();
    }
    for (auto& thread : given_up_) thread->stop();
    stopped_ = true;
  }
  [[nodiscard]] int threads() const noexcept { return static_cast<int>(helpers_.size()); }

  /// Computes the forces at `motion`. True if the threads were late, and the leader did their work.
  bool run(const Motion& motion) noexcept {
    const EvaluationLimit limit = limit_from_now();
    if (SharedTick* fresh = offered_.exchange(nullptr, std::memory_order_acq_rel)) spare_ = fresh;
    // Without a spare memory, a late thread could not be replaced.
    const bool all_are_back = spare_ != nullptr && spare_->is_idle();
    const bool may_share = all_are_back && rest_ == 0 && !limit.is_counted();
    rest_ -= rest_ > 0 ? 1 : 0;
    if (answer(motion, limit, may_share)) return spare_ != nullptr && !all_are_back;
    // Each time they are late, they are left alone for twice as long.
    rest_ = std::min(std::max<std::int64_t>(1, 2 * last_rest_), longest_rest);
    last_rest_ = rest_;
    std::swap(current_, spare_);
    open_to_all_.store(current_, std::memory_order_release);
    held_.store(spare_, std::memory_order_release);
    current_->pairs().forget(leader_.poses);
    search_.repeat();
    return answer(motion, limit, false);
  }

  /// Ticks have passed without this team.
  void skip_ticks() noexcept { current_->pairs().skip_ticks(); }

  /// Repeats queries of the last tick and discards their answers, to warm the CPU caches.
  void rehearse(const Motion& motion) noexcept {
    (void)current_->pairs().rehearse(motion, leader_.poses, rehearsed_pairs);
  }

  /// The pairs as of the last `run`.
  [[nodiscard]] const PairSet& pairs() const noexcept { return current_->pairs(); }
  /// Ticks whose pairs were shared.
  [[nodiscard]] std::int64_t shared() const noexcept { return shared_; }
  /// Before `stop`, without what a memory knows that a late or dead thread holds.
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept {
    PairExtremes extremes = current_->pairs().extremes_of(id);
    if (stopped_) {
      for (const auto& set : sets_) extremes.add(set->pairs().extremes_of(id));
    } else if (spare_ != nullptr && spare_->is_idle()) {
      extremes.add(spare_->pairs().extremes_of(id));
    }
    return extremes;
  }

  /// No thread is still at work for an earlier tick. Callable between ticks by the leader.
  [[nodiscard]] bool is_settled() const noexcept {
    if (helpers_.empty()) return true;
    return spare_ != nullptr && spare_->is_idle() && current_->is_idle() &&
           lost_.load(std::memory_order_acquire) == 0;
  }

  /// Looks after the threads: replaces those that do not go on, and the memory they hold; adds up
  /// what the operating system did to them. To be called every now and then by one thread, not in
  /// the tick: it allocates.
  void tend(WorkerUsage& usage) {
    for (std::size_t i = 0; i < helpers_.size(); ++i) tend(i, usage);
    note_lost();
    SharedTick* const held = held_.load(std::memory_order_acquire);
    const bool is_held = held != nullptr && !held->is_idle();
    if (!is_held) held_watch_ = {};
    if (is_held && held_watch_.is_overdue(1)) {
      held_.store(nullptr, std::memory_order_release);
      offered_.store(add_set(), std::memory_order_release);
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  struct Helper {
    std::unique_ptr<WorkerThread> thread;
    Watch watch;
    ThreadUsage::Counts seen;
  };

  SharedTick* add_set() {
    const int slots = options_.every_pair ? static_cast<int>(world_->pairs().size())
                                          : world_->limits().candidates;
    sets_.push_back(std::make_unique<SharedTick>(*world_, slots, options_.budget, lookahead_));
    if (options_.every_pair) sets_.back()->pairs().track_all(*pairs_);
    return sets_.back().get();
  }

  void start_helper(std::size_t i) {
    Helper& helper = helpers_[i];
    helper.thread =
        std::make_unique<WorkerThread>(options_, first_index_ + static_cast<int>(i), pace_);
    helper.watch = {};
    helper.seen = {};
    helper.thread->start([this, evaluator = Evaluator{.poses = prototype_}]() mutable noexcept {
      return open_to_all_.load(std::memory_order_acquire)->work(evaluator);
    });
  }

  void tend(std::size_t i, WorkerUsage& usage) {
    Helper& helper = helpers_[i];
    const ThreadUsage::Counts now = helper.thread->look_at_usage();
    usage.page_faults += now.page_faults - helper.seen.page_faults;
    usage.switches += now.switches - helper.seen.switches;
    helper.seen = now;
    if (options_.lock_step) return;  // the leader waits, however long it takes
    if (!helper.watch.is_overdue(helper.thread->beats())) return;
    helper.thread->request_stop();
    given_up_.push_back(std::move(helper.thread));
    note_lost();
    start_helper(i);
    ++usage.restarts;
  }
  void note_lost() noexcept {
    const auto lost = std::count_if(given_up_.begin(), given_up_.end(),
                                    [](const auto& thread) { return !thread->has_ended(); });
    lost_.store(static_cast<int>(lost), std::memory_order_release);
  }

  [[nodiscard]] EvaluationLimit limit_from_now() const noexcept {
    EvaluationLimit limit;
    if (options_.budget.wall.count() > 0) limit.deadline = Clock::now() + options_.budget.wall;
    if (options_.budget.work_units > 0) limit.work_units = options_.budget.work_units;
    return limit;
  }

  /// Passes what the search finds to the pairs of this tick.
  struct Sink {
    bool take(PairId id, std::int32_t list, double distance) noexcept {
      return pairs.take(id, list, distance, motion, poses);
    }
    int end(std::int32_t list) noexcept { return pairs.end(list); }
    void drop(std::int32_t list) noexcept { pairs.drop(list); }
    PairSet& pairs;
    const Motion& motion;
    PartPoses& poses;
  };

  /// One tick with the current memory. False if a thread was late.
  bool answer(const Motion& motion, const EvaluationLimit& limit, bool may_share) noexcept {
    PairSet& pairs = current_->pairs();
    leader_.poses.begin_tick();
    leader_.round = ++round_;
    pairs.begin_tick(motion.tick);
    if (!options_.every_pair) search_.run(motion, Sink{pairs, motion, leader_.poses});
    const int batches = pairs.select(motion, leader_.poses, limit);
    if (may_share && pairs.selected() >= worth_sharing) {
      ++shared_;
      pace_.tick();
      current_->open(round_, motion, batches);
      (void)current_->work(leader_);
      if (!is_finished()) return false;
      last_rest_ -= last_rest_ > 0 && round_ % forgives_after == 0 ? 1 : 0;
    } else {
      pairs.evaluate_all(motion, leader_.poses);
    }
    pairs.finish(motion, leader_.poses);
    return true;
  }

  /// Waits until the threads have finished their batches, or for the patience of the options; in
  /// lock step by no clock.
  [[nodiscard]] bool is_finished() const noexcept {
    if (current_->is_idle()) return true;
    const Clock::time_point until = Clock::now() + options_.patience;
    for (unsigned spins = 1; !current_->is_idle(); ++spins) {
      if (options_.lock_step) {
        if (spins % 4096 == 0) std::this_thread::yield();
      } else if (spins % 16 == 0 && Clock::now() >= until) {
        return current_->is_idle();
      }
      WorkerThread::pause();
    }
    return true;
  }

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
