/// @file
/// The coprocessor: threads that compute pair forces from the newest poses. It is the counterpart
/// of the attached processor of the paper (section 4).
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <repel/schedule/pair_forces.hpp>
#include <repel/schedule/worker_thread.hpp>

namespace repel {

/// Evaluates the pairs of a world in its worker threads, or in the calling thread.
///
/// For each worker the caller has a substitute as a fallback: a second memory of the same pairs.
/// When a worker misses its timeout (slow, stalled or terminated), the caller evaluates its pairs
/// with the substitute, so that the forces always belong to the present motion. While the caller
/// would otherwise wait, it runs the substitutes round-robin, so that each has been run with one of
/// the last `threads` motions. Worker and substitute have not processed the same motions: their
/// forces agree up to rounding, not bitwise; the difference is larger for the springs of passable
/// pairs and for pairs that are stale because the budget does not cover all.
class Coprocessor {
 public:
  /// Number of consecutive late ticks for which a worker is still given the full `patience`.
  static constexpr std::int64_t patient_ticks = 4;

  /// Evaluates every pair once (twice with threads) and starts the threads. Allocates; may throw.
  Coprocessor(const World& world, const CoprocessorOptions& options)
      : world_(&world), options_(options) {
    checked("threads", options.threads, 0, world.limits().threads, "");
    const std::chrono::nanoseconds none{0};
    options_.period = std::clamp(options.period, none, longest_wait);
    options_.patience =
        options.lock_step ? longest_wait : std::clamp(options.patience, none, longest_wait);
    blocks_ = detail::PairPartition::blocks_of(world);
    total_ = PairForces(world.body_count());
    const auto pairs =
        options.every_pair ? nullptr : std::make_shared<const detail::PairIndex>(world);
    const int shares = std::max(1, options.threads);
    for (int i = 0; i < shares; ++i) {
      shares_.push_back(std::make_unique<Share>(world, pairs, options_, i, shares));
    }
    for (auto& share : shares_) {
      if (share->worker != nullptr) share->worker->start();
    }
  }
  Coprocessor(const Coprocessor&) = delete;
  Coprocessor& operator=(const Coprocessor&) = delete;

  /// The forces at `world.motion()`. Cost with threads: one copy of the motion per thread, the
  /// share of one worker, the wait, the share of each late worker, one sum. After `patient_ticks`
  /// late ticks in a row, a worker's substitute runs first and the worker gets only patience / 16,
  /// until it is in time again.
  const PairForces& exchange() noexcept {
    if (options_.threads == 0) {
      shares_.front()->substitute.run(world_->motion());
    } else {
      exchange_with_workers(world_->motion());
    }
    sum();
    return total_;
  }

  /// Without threads: repeats queries of the last exchange and discards their answers, to warm the
  /// CPU caches for the next. With threads: no effect.
  void rehearse() noexcept {
    if (options_.threads == 0) shares_.front()->substitute.rehearse(world_->motion());
  }

  /// True when some worker was late at the last exchange.
  [[nodiscard]] bool late() const noexcept { return report_.stood_in > 0; }
  /// Lateness statistics of the workers, as of the last exchange.
  [[nodiscard]] const WorkerReport& workers() const noexcept { return report_; }
  [[nodiscard]] int threads() const noexcept { return options_.threads; }

  /// Calls see(NearPair) for each pair that was near at the last exchange, in unspecified order.
  /// Call it between exchanges and from the same thread: workers whose forces were used are idle
  /// until the next exchange.
  template <class See>
  void for_each_near(const See& see) const noexcept {
    for (const auto& share : shares_) share->used().for_each_near(world_->motion(), see);
  }

  /// The last answer for a pair; a default `Separation`, which bounds nothing, if its slot has been
  /// reused for another pair (`Limits::candidates`). Same calling condition, or after `stop`.
  [[nodiscard]] Separation separation_of(PairId id) const noexcept {
    const auto [share, block] = place_of(id);
    return share.used().blocks()[block].separation_of(id);
  }
  /// Least distance and largest force of a pair since set-up. Same calling condition.
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept {
    const auto [share, block] = place_of(id);
    const PairExtremes here = share.substitute.blocks()[block].extremes_of(id);
    if (share.worker == nullptr) return here;
    PairExtremes there = share.worker->share().blocks()[block].extremes_of(id);
    if (share.has_been_late) there.add(here);
    return there;
  }

  /// Joins the threads, as the destructor does. Each finishes its tick first: blocks for ever if
  /// one is stalled for ever, but not for a thread that was killed. Not real-time safe.
  void stop() {
    for (auto& share : shares_) {
      if (share->worker != nullptr) share->worker->stop();
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// Some of the blocks, with the worker and the substitute that evaluate them.
  struct Share {
    Share(const World& world, const std::shared_ptr<const detail::PairIndex>& pairs,
          const CoprocessorOptions& options, int index, int shares)
        : substitute(world, pairs, options.budget, index, shares) {
      substitute.prime(world.motion());
      if (options.threads == 0) return;
      worker = std::make_unique<detail::WorkerThread>(world, pairs, options, index);
    }
    [[nodiscard]] const PairForces& forces(std::size_t block) const noexcept {
      return in_time ? worker->forces()[block] : substitute.blocks()[block].forces();
    }
    [[nodiscard]] const detail::WorkerShare& used() const noexcept {
      return in_time ? worker->share() : substitute;
    }
    [[nodiscard]] bool is_silent() const noexcept { return silence >= patient_ticks; }
    /// A worker that is in time again has old answers if the budget does not cover all pairs. True
    /// if its oldest answer is not older than that of the substitute. Requires that the substitute
    /// has run at this exchange.
    [[nodiscard]] bool has_caught_up() const noexcept {
      std::int64_t here = 0, there = 0;
      for (std::size_t b = 0; b < worker->forces().size(); ++b) {
        here = std::max(here, substitute.blocks()[b].forces().totals.oldest_age);
        there = std::max(there, worker->forces()[b].totals.oldest_age);
      }
      return there <= here;
    }
    detail::WorkerShare substitute;  ///< run by the caller; the only evaluator without threads
    std::unique_ptr<detail::WorkerThread> worker;
    std::int64_t silence = 0;    ///< [ticks] in a row the worker has been late
    bool substituted = false;    ///< the substitute has run at this exchange
    bool in_time = false;        ///< the worker's forces of this exchange are used
    bool has_been_late = false;  ///< the worker was late at some exchange
  };

  [[nodiscard]] std::pair<const Share&, std::size_t> place_of(PairId id) const noexcept {
    const auto block =
        static_cast<std::size_t>(detail::PairPartition::block_of(id, static_cast<int>(blocks_)));
    return {*shares_[block % shares_.size()], block / shares_.size()};
  }

  void exchange_with_workers(const Motion& motion) noexcept {
    ++exchanges_;
    const auto now = Clock::now();
    for (auto& share : shares_) share->worker->post(exchanges_, now, motion);
    const auto patiently = now + options_.patience;
    const auto in_turn = static_cast<std::size_t>(exchanges_) % shares_.size();
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      shares_[i]->substituted = i == in_turn || shares_[i]->is_silent();
      if (shares_[i]->substituted) shares_[i]->substitute.run(motion);
    }
    const auto shortly = Clock::now() + options_.patience / 16;
    report_ = {0, 0, report_.ticks, report_.longest_silence};
    for (auto& share : shares_) {
      share->in_time = share->is_silent()
                           ? share->worker->wait(exchanges_, shortly) && share->has_caught_up()
                           : share->worker->wait(exchanges_, patiently);
      if (!share->in_time && !share->substituted) share->substitute.run(motion);
      share->silence = share->in_time ? 0 : share->silence + 1;
      share->has_been_late = share->has_been_late || !share->in_time;
      report_.stood_in += share->in_time ? 0 : 1;
      report_.silence = std::max(report_.silence, share->silence);
    }
    report_.ticks += late() ? 1 : 0;
    report_.longest_silence = std::max(report_.longest_silence, report_.silence);
  }

  /// Adds up the blocks in a fixed order, independent of which thread evaluated them.
  void sum() noexcept {
    total_.clear();
    total_.tick = world_->motion().tick;
    for (std::size_t b = 0; b < blocks_; ++b) {
      const PairForces& block = shares_[b % shares_.size()]->forces(b / shares_.size());
      if (block.totals.near == 0 && block.totals.crowded == 0) continue;
      total_.add(block);
    }
  }

  static constexpr std::chrono::nanoseconds longest_wait{std::chrono::seconds(1)};

  const World* world_;
  CoprocessorOptions options_;
  PairForces total_;
  WorkerReport report_;
  std::int64_t exchanges_ = 0;
  std::size_t blocks_ = 0;  ///< of all shares
  std::vector<std::unique_ptr<Share>> shares_;
};

}  // namespace repel
