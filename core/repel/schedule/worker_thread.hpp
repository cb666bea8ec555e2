/// @file
/// A worker of the coprocessor: a thread that evaluates its share of the pairs at the newest
/// motion.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include <repel/base/mailbox.hpp>
#include <repel/schedule/worker_share.hpp>

namespace repel::detail {

/// The caller and the thread exchange motions and forces through wait-free mailboxes: the thread
/// always takes a consistent snapshot of the newest motion, and the caller uses its forces only if
/// they belong to the motion posted last. Exchanges are numbered separately, because the tick
/// numbers are up to the caller.
class WorkerThread {
 public:
  using Clock = std::chrono::steady_clock;

  /// Evaluates every pair of the share once. Does not start the thread: see `start`.
  WorkerThread(const World& world, const std::shared_ptr<const PairIndex>& pairs,
               const CoprocessorOptions& options, int index)
      : options_(options),
        index_(index),
        share_(world, pairs, options.budget, index, options.threads),
        inbox_({0, {}, world.motion()}),
        outbox_(primed(world)) {}

  void start() {
    thread_ = std::jthread([this](const std::stop_token& stop) {
      if (options_.on_thread_start != nullptr) options_.on_thread_start(index_);
      serve(stop);
    });
  }
  /// Joins the thread after it has finished its tick: blocks for ever if it is stalled for ever,
  /// but not if it was killed.
  void stop() { thread_ = {}; }

  /// Posts a motion to the thread. Cost: a copy of it.
  void post(std::int64_t exchange, Clock::time_point now, const Motion& motion) noexcept {
    Request& draft = inbox_.draft();
    draft.exchange = exchange;
    draft.posted = now;
    draft.motion.tick = motion.tick;
    std::copy(motion.bodies.begin(), motion.bodies.end(), draft.motion.bodies.begin());
    inbox_.post();
  }
  /// Spins until the forces of that exchange have arrived; false on timeout at `until`.
  [[nodiscard]] bool wait(std::int64_t exchange, Clock::time_point until) noexcept {
    for (unsigned spins = 0;; ++spins) {
      outbox_.take();
      if (outbox_.newest().exchange == exchange) return true;
      if (spins % 16 == 15 && Clock::now() >= until) return false;
      relax(spins);
    }
  }

  /// The forces of each block of the share, as last received.
  [[nodiscard]] const std::vector<PairForces>& forces() const noexcept {
    return outbox_.newest().blocks;
  }
  /// Only while the thread is idle: from a successful `wait` to the next `post`, or after `stop`.
  [[nodiscard]] const WorkerShare& share() const noexcept { return share_; }

 private:
  struct Request {
    std::int64_t exchange = 0;
    Clock::time_point posted;
    Motion motion;
  };
  struct Result {
    std::int64_t exchange = 0;
    std::vector<PairForces> blocks;
  };

  [[nodiscard]] Result primed(const World& world) {
    share_.prime(world.motion());
    Result result;
    for (const auto& block : share_.blocks()) result.blocks.push_back(block.forces());
    return result;
  }

  /// Thread loop: answers a motion, sleeps until shortly before the next is due, and spins for it.
  void serve(const std::stop_token& stop) noexcept {
    const auto nap = options_.period - std::min(options_.period / 2, awake_before);
    for (unsigned spins = 0; !stop.stop_requested(); ++spins) {
      if (!inbox_.take()) {
        relax(spins);
        if (!options_.lock_step && spins > spins_before_nap) {
          std::this_thread::sleep_for(options_.period / 8);
        }
        continue;
      }
      answer();
      spins = 0;
      if (!options_.lock_step) std::this_thread::sleep_until(inbox_.newest().posted + nap);
    }
  }

  void answer() noexcept {
    share_.run(inbox_.newest().motion);
    Result& draft = outbox_.draft();
    draft.exchange = inbox_.newest().exchange;
    // Same size as before, so the copies do not allocate.
    for (std::size_t b = 0; b < draft.blocks.size(); ++b) {
      draft.blocks[b] = share_.blocks()[b].forces();
    }
    outbox_.post();
  }

  /// One iteration of a spin wait. In lock step there may be more threads than processors, so it
  /// yields from time to time; otherwise it makes no system call.
  void relax(unsigned spins) const noexcept {
    if (options_.lock_step && spins % 4096 == 4095) std::this_thread::yield();
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }

  static constexpr std::chrono::nanoseconds awake_before{200000};
  static constexpr unsigned spins_before_nap = 200000;

  CoprocessorOptions options_;
  int index_;
  WorkerShare share_;
  Mailbox<Request> inbox_;
  Mailbox<Result> outbox_;
  std::jthread thread_;  // last member: joined before the data it uses is destroyed
};

}  // namespace repel::detail
