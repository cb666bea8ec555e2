// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The threads that evaluate the newest motion beside the caller, as the attached processor of the
/// paper does (Anderson 1993, section 4).
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include <repel/base/mailbox.hpp>
#include <repel/schedule/pair_team.hpp>
#include <repel/schedule/whole_answer.hpp>

namespace repel::detail {

/// A thread that leads a team. It and the caller exchange motions and answers through wait-free
/// mailboxes: it always takes a consistent snapshot of the newest motion, and the caller the newest
/// whole answer. Exchanges are numbered separately, because the tick numbers are up to the caller.
class BesideWorker {
 public:
  /// Allocates. @param motion at present @param prototype poses of the parts at rest @param threads
  /// of the team besides its leader
  /// @param index of the thread for `on_thread_start`; those of the team follow
  BesideWorker(const World& world, const Motion& motion,
               const std::shared_ptr<const PairIndex>& pairs, const PartPoses& prototype,
               const CoprocessorOptions& options, int threads, int index, double lookahead,
               int most_near);

  /// Evaluates every pair once, and answers for the motion given at construction.
  void prime() noexcept;
  void start();
  void request_stop() noexcept;
  /// Joins the threads: blocks for ever if one is stalled for ever, but not for one that was
  /// killed.
  void stop();

  /// Caller: posts a motion. Cost: a copy of it.
  void post(std::int64_t exchange, const Motion& motion) noexcept;
  /// Caller: the newest whole answer. It stays as it is until the next call.
  [[nodiscard]] const WholeAnswer& newest() noexcept;
  /// A thread of the team was late at its last tick.
  [[nodiscard]] bool is_team_late() const noexcept { return late_.load(std::memory_order_relaxed); }

  [[nodiscard]] std::uint64_t beats() const noexcept { return thread_.beats(); }
  /// Its leader will not do any more work.
  [[nodiscard]] bool has_ended() const noexcept { return thread_.has_ended(); }
  /// Not in the tick: see PairTeam::tend.
  void tend(WorkerUsage& usage);
  /// The team; only after `stop`.
  [[nodiscard]] const PairTeam& team() const noexcept { return team_; }

 private:
  struct Request {
    std::int64_t exchange = 0;
    Motion motion;
  };

  void answer(const Request& request) noexcept;

  Pace pace_;
  PairTeam team_;
  Mailbox<Request> inbox_;
  Mailbox<WholeAnswer> outbox_;
  ThreadUsage::Counts seen_;
  std::atomic<bool> late_{false};
  WorkerThread thread_;  // last member: joined before the data it uses is destroyed
};

}  // namespace repel::detail
