/// @file
/// The coprocessor: threads that turn the newest poses into the newest forces. It stands for the
/// attached processor of the paper (section 4).
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <repel/base/mailbox.hpp>
#include <repel/base/status.hpp>
#include <repel/schedule/pair_worker.hpp>

namespace repel {

struct CoprocessorOptions {
  int threads = 0;                            ///< 0: the pairs are worked through in the caller
  Budget budget;                              ///< per tick
  std::chrono::nanoseconds period{2500000};   ///< between ticks, so that idle workers can sleep
  std::chrono::nanoseconds patience{500000};  ///< how long the caller waits for an answer
  void (*on_thread_start)(int index) noexcept = nullptr;  ///< called in each worker: priority etc.
  bool lock_step = false;  ///< wait for every answer (up to a second) and never sleep: for replays
  bool every_pair = false;  ///< evaluate every pair at every tick
};

/// Host and workers exchange motions and forces through wait-free mailboxes. A worker always takes
/// the newest motion whole; the host takes the newest forces. When they are not those of this tick
/// the host goes on with what it has, and says so.
class Coprocessor {
 public:
  /// Evaluates every pair once and starts the threads. May allocate and throw.
  Coprocessor(const World& world, const CoprocessorOptions& options)
      : world_(&world), options_(options) {
    checked("threads", options.threads, 0, world.limits().threads, "");
    const int workers = std::max(1, options.threads);
    blocks_ = detail::PairWorker::blocks_of(world);
    total_.on_body.resize(world.body_count());
    const auto pairs = std::make_shared<const detail::PairIndex>(world);
    for (int i = 0; i < workers; ++i) {
      seats_.push_back(std::make_unique<Seat>(world, pairs, options.budget, i, workers));
    }
    for (int i = 0; i < options.threads; ++i) {
      seats_[i]->thread =
          std::jthread([this, i, seat = seats_[i].get()](const std::stop_token& stop) {
            if (options_.on_thread_start != nullptr) options_.on_thread_start(i);
            serve(*seat, stop);
          });
    }
  }
  Coprocessor(const Coprocessor&) = delete;
  Coprocessor& operator=(const Coprocessor&) = delete;

  /// The forces at the newest motion the workers have answered; those of `world.motion()` unless
  /// `late()` says otherwise. Cost with threads: one copy of the motion, the wait, one sum.
  const PairForces& exchange() noexcept {
    const Motion& motion = world_->motion();
    late_ = false;
    if (options_.threads == 0) {
      seats_.front()->worker.run(motion);
      sum([](const Seat& seat, std::size_t b) -> const PairForces& {
        return seat.worker.blocks()[b].forces();
      });
      return total_;
    }
    for (auto& seat : seats_) {
      Motion& draft = seat->inbox.draft();
      draft.tick = motion.tick;
      std::copy(motion.bodies.begin(), motion.bodies.end(), draft.bodies.begin());
      seat->inbox.post();
    }
    wait_for(motion.tick);
    sum([](const Seat& seat, std::size_t b) -> const PairForces& {
      return seat.outbox.newest()[b];
    });
    return total_;
  }

  /// Without threads: asks the near pairs of the last motion again and forgets the answers, which
  /// brings code and data of the next exchange into the caches. With threads: nothing.
  void rehearse() const noexcept {
    if (options_.threads == 0) seats_.front()->worker.rehearse(world_->motion());
  }

  /// True when some worker had not answered this tick and its older forces were used.
  [[nodiscard]] bool late() const noexcept { return late_; }
  [[nodiscard]] int threads() const noexcept { return options_.threads; }

  /// The last answer for a pair; the default one, which claims nothing, for a pair that had to give
  /// its memory to another since (`Limits::candidates`). Only with 0 threads, or between ticks in
  /// lock step: the workers write it.
  [[nodiscard]] Separation separation_of(PairId id) const noexcept {
    return block_of(id).separation_of(id);
  }
  /// How near a pair has come and how hard it has pushed. On the same condition.
  [[nodiscard]] const PairExtremes& extremes_of(PairId id) const noexcept {
    return block_of(id).extremes_of(id);
  }

  /// Ends the threads, waiting for each to finish its tick. Not for the tick; nothing is exchanged
  /// afterwards.
  void stop() {
    for (auto& seat : seats_) seat->thread = {};
  }

 private:
  using Clock = std::chrono::steady_clock;
  using Answer = std::vector<PairForces>;  // by block of the worker

  struct Seat {
    Seat(const World& world, std::shared_ptr<const detail::PairIndex> pairs, const Budget& budget,
         int index, int stride)
        : worker(world, std::move(pairs), budget, index, stride),
          inbox(world.motion()),
          outbox(primed(world)) {}

    Answer primed(const World& world) {
      worker.prime(world.motion());
      Answer answer;
      for (const auto& block : worker.blocks()) answer.push_back(block.forces());
      return answer;
    }
    void copy_to(Answer& answer) const noexcept {
      for (std::size_t b = 0; b < answer.size(); ++b) {
        const PairForces& from = worker.blocks()[b].forces();
        answer[b].tick = from.tick;
        answer[b].totals = from.totals;
        std::copy(from.on_body.begin(), from.on_body.end(), answer[b].on_body.begin());
      }
    }
    detail::PairWorker worker;
    Mailbox<Motion> inbox;
    Mailbox<Answer> outbox;
    std::jthread thread;
  };

  [[nodiscard]] const detail::PairBlock& block_of(PairId id) const noexcept {
    const auto block =
        static_cast<std::size_t>(detail::PairShare::block_of(id, static_cast<int>(blocks_)));
    return seats_[block % seats_.size()]->worker.blocks()[block / seats_.size()];
  }

  /// One turn of a spinning wait. In lock step threads may outnumber the processors and must make
  /// room for each other; by the clock a tick makes no system call.
  void relax(int spins) const noexcept {
    if (options_.lock_step && spins % 4096 == 4095) std::this_thread::yield();
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }

  void wait_for(std::int64_t tick) noexcept {
    const auto patience =
        options_.lock_step ? std::chrono::nanoseconds(std::chrono::seconds(1)) : options_.patience;
    const auto until = Clock::now() + patience;
    for (auto& seat : seats_) {
      for (int spins = 0;; ++spins) {
        seat->outbox.take();
        const Answer& answer = seat->outbox.newest();
        if (answer.empty() || answer.front().tick == tick) break;
        if (spins % 16 == 15 && Clock::now() >= until) {
          late_ = true;
          break;
        }
        relax(spins);
      }
    }
  }

  /// Adds up block by block in the order of the pairs, whoever worked on them.
  template <class ForcesOf>
  void sum(ForcesOf&& forces_of) noexcept {
    total_.clear();
    total_.tick = world_->motion().tick;
    const std::size_t workers = seats_.size();
    for (std::size_t b = 0; b < blocks_; ++b) {
      const PairForces& block = forces_of(*seats_[b % workers], b / workers);
      if (block.totals.near == 0 && block.totals.crowded == 0) continue;
      for (std::size_t i = 0; i < total_.on_body.size(); ++i) total_.on_body[i] += block.on_body[i];
      total_.totals.add(block.totals);
      const std::int64_t behind = total_.tick - block.tick;
      if (behind > 0) {
        total_.totals.stale += block.totals.near - block.totals.stale;
        total_.totals.oldest_age =
            std::max(total_.totals.oldest_age, block.totals.oldest_age + behind);
      }
    }
  }

  /// A worker answers, then sleeps until shortly before the next motion is due and spins for it.
  void serve(Seat& seat, const std::stop_token& stop) noexcept {
    const auto nap = options_.period - std::min(options_.period / 2, nanoseconds_before);
    for (int spins = 0; !stop.stop_requested(); ++spins) {
      if (!seat.inbox.take()) {
        relax(spins);
        if (!options_.lock_step && spins > spins_before_nap) {
          std::this_thread::sleep_for(options_.period / 8);
        }
        continue;
      }
      const auto taken = Clock::now();
      seat.worker.run(seat.inbox.newest());
      seat.copy_to(seat.outbox.draft());
      seat.outbox.post();
      spins = 0;
      if (!options_.lock_step) std::this_thread::sleep_until(taken + nap);
    }
  }

  static constexpr std::chrono::nanoseconds nanoseconds_before{200000};
  static constexpr int spins_before_nap = 200000;

  const World* world_;
  CoprocessorOptions options_;
  PairForces total_;
  bool late_ = false;
  std::size_t blocks_ = 0;  ///< of all workers
  std::vector<std::unique_ptr<Seat>> seats_;
};

}  // namespace repel
