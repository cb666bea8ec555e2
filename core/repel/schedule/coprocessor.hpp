/// @file
/// The coprocessor: threads that turn the newest poses into the newest forces. It stands for the
/// attached processor of the paper (section 4).
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <repel/base/mailbox.hpp>
#include <repel/schedule/pair_worker.hpp>

namespace repel {

struct CoprocessorOptions {
  int threads = 0;  ///< 0: the pairs are worked through in the caller; else memory is taken twice
  Budget budget;    ///< per tick; a deputy in the caller has that of its thread
  std::chrono::nanoseconds period{2500000};   ///< between ticks, so that idle workers can sleep
  std::chrono::nanoseconds patience{500000};  ///< how long the caller waits for an answer; this
                                              ///< and the period are taken from 0 to 1 s
  void (*on_thread_start)(int index) noexcept = nullptr;  ///< called in each worker: priority etc.
  bool every_pair = false;  ///< evaluate also those that cannot be within range: to compare with
  bool lock_step = false;   ///< wait for every answer (up to a second) and never sleep: for replays
};

/// Host and workers exchange motions and forces through wait-free mailboxes. A worker always takes
/// the newest motion whole; the host takes its forces when they are those of this exchange.
///
/// For each worker the host holds a deputy over the same pairs. When a worker does not answer in
/// time, be it slow, stalled or gone, its deputy does the work in the caller: the forces are those
/// of the present motion whatever the workers do. Where the host would only wait it lets one deputy
/// in turn do the same work, so that each has seen one of the last `threads` motions. It has come
/// on another way than its worker: its forces agree to rounding, not bitwise, and by less for the
/// springs of passable pairs and for pairs that are stale because the budget binds.
class Coprocessor {
 public:
  /// So many times in a row a worker that is late is waited for with the whole patience.
  static constexpr std::int64_t patient_ticks = 4;

  /// Evaluates every pair once, with threads twice, and starts the threads. May allocate and throw.
  Coprocessor(const World& world, const CoprocessorOptions& options)
      : world_(&world), options_(options) {
    checked("threads", options.threads, 0, world.limits().threads, "");
    const std::chrono::nanoseconds none{0};
    options_.period = std::clamp(options.period, none, longest_wait);
    options_.patience =
        options.lock_step ? longest_wait : std::clamp(options.patience, none, longest_wait);
    const int seats = std::max(1, options.threads);
    blocks_ = detail::PairWorker::blocks_of(world);
    total_ = PairForces(world.body_count());
    const auto pairs =
        options.every_pair ? nullptr : std::make_shared<const detail::PairIndex>(world);
    for (int i = 0; i < seats; ++i) {
      seats_.push_back(std::make_unique<Seat>(world, pairs, options.budget, i, seats));
      if (options.threads == 0) continue;
      seats_[i]->worker = std::make_unique<Worker>(world, pairs, options.budget, i, seats);
    }
    for (int i = 0; i < options.threads; ++i) {
      Worker& worker = *seats_[i]->worker;
      worker.thread = std::jthread([this, i, &worker](const std::stop_token& stop) {
        if (options_.on_thread_start != nullptr) options_.on_thread_start(i);
        serve(worker, stop);
      });
    }
  }
  Coprocessor(const Coprocessor&) = delete;
  Coprocessor& operator=(const Coprocessor&) = delete;

  /// The forces at `world.motion()`. Cost with threads: a copy of the motion for each, the work of
  /// one of them, the wait, the work of each that is stood in for, one sum. A worker that has been
  /// late for `patient_ticks` is waited for only shortly, after its deputy, until it is in time.
  const PairForces& exchange() noexcept {
    const Motion& motion = world_->motion();
    if (options_.threads == 0) {
      seats_.front()->deputy.run(motion);
    } else {
      ask_workers(motion);
    }
    sum();
    return total_;
  }

  /// Without threads: asks the near pairs of the last motion again and forgets the answers, so that
  /// the caches have code and data of the next exchange. With threads: nothing.
  void rehearse() noexcept {
    if (options_.threads == 0) seats_.front()->deputy.rehearse(world_->motion());
  }

  /// True when some worker was stood in for at the last exchange.
  [[nodiscard]] bool late() const noexcept { return report_.stood_in > 0; }
  /// How the workers keep up, as of the last exchange.
  [[nodiscard]] const WorkerReport& workers() const noexcept { return report_; }
  [[nodiscard]] int threads() const noexcept { return options_.threads; }

  /// see(NearPair) for each pair that was near at the last exchange, in any order. Between
  /// exchanges, by the thread that makes them: whose answers were used rests until the next.
  template <class See>
  void for_each_near(const See& see) const noexcept {
    for (const auto& seat : seats_) seat->used().for_each_near(world_->motion(), see);
  }

  /// The last answer for a pair; one that claims nothing if it had to give its memory to another
  /// since (`Limits::candidates`). On the same condition, or after `stop`.
  [[nodiscard]] Separation separation_of(PairId id) const noexcept {
    const auto [seat, block] = place_of(id);
    return seat.used().blocks()[block].separation_of(id);
  }
  /// How near a pair has come and how hard it has pushed. On the same condition.
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept {
    const auto [seat, block] = place_of(id);
    const PairExtremes here = seat.deputy.blocks()[block].extremes_of(id);
    if (seat.worker == nullptr) return here;
    PairExtremes there = seat.worker->share.blocks()[block].extremes_of(id);
    if (seat.has_stood_in) there.add(here);
    return there;
  }

  /// Ends the threads, as the destructor does. Waits for each to finish its tick, for ever for one
  /// that is stalled for ever, and not for one that was killed. Not for the tick.
  void stop() {
    for (auto& seat : seats_) {
      if (seat->worker != nullptr) seat->worker->thread = {};
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  using Pairs = std::shared_ptr<const detail::PairIndex>;

  // Numbered, because the tick is the caller's to count.
  struct Order {
    std::int64_t exchange = 0;
    Clock::time_point posted;
    Motion motion;
  };
  struct Answer {
    std::int64_t exchange = 0;
    std::vector<PairForces> blocks;  // of the worker
  };
  /// What a thread works with.
  struct Worker {
    Worker(const World& world, const Pairs& pairs, const Budget& budget, int index, int stride)
        : share(world, pairs, budget, index, stride),
          inbox({0, {}, world.motion()}),
          outbox(primed(world)) {}
    Answer primed(const World& world) {
      share.prime(world.motion());
      Answer answer;
      for (const auto& block : share.blocks()) answer.blocks.push_back(block.forces());
      return answer;
    }
    void answer() noexcept {
      share.run(inbox.newest().motion);
      Answer& draft = outbox.draft();
      draft.exchange = inbox.newest().exchange;
      // Of the same size: nothing is taken from the heap.
      for (std::size_t b = 0; b < draft.blocks.size(); ++b) {
        draft.blocks[b] = share.blocks()[b].forces();
      }
      outbox.post();
    }
    detail::PairWorker share;
    Mailbox<Order> inbox;
    Mailbox<Answer> outbox;
    std::jthread thread;
  };
  /// A share of the pairs, and who works on it: the host alone without threads, else the worker.
  struct Seat {
    Seat(const World& world, const Pairs& pairs, const Budget& budget, int index, int stride)
        : deputy(world, pairs, budget, index, stride) {
      deputy.prime(world.motion());
    }
    [[nodiscard]] const PairForces& forces(std::size_t block) const noexcept {
      return in_time ? worker->outbox.newest().blocks[block] : deputy.blocks()[block].forces();
    }
    [[nodiscard]] const detail::PairWorker& used() const noexcept {
      return in_time ? worker->share : deputy;
    }
    [[nodiscard]] bool is_silent() const noexcept { return silence >= patient_ticks; }
    /// A worker that comes back on a budget that binds has old answers: until none is older than
    /// the deputy's, which has run before the wait.
    [[nodiscard]] bool caught_up() const noexcept {
      std::int64_t here = 0, there = 0;
      for (std::size_t b = 0; b < deputy.blocks().size(); ++b) {
        here = std::max(here, deputy.blocks()[b].forces().totals.oldest_age);
        there = std::max(there, worker->outbox.newest().blocks[b].totals.oldest_age);
      }
      return there <= here;
    }
    detail::PairWorker deputy;
    std::unique_ptr<Worker> worker;
    std::int64_t silence = 0;   ///< [ticks] in a row it has been stood in for
    bool ahead = false;         ///< the deputy has run before the wait of this exchange
    bool in_time = false;       ///< the worker's forces of this exchange are used
    bool has_stood_in = false;  ///< the deputy, at any time
  };

  [[nodiscard]] std::pair<const Seat&, std::size_t> place_of(PairId id) const noexcept {
    const auto block =
        static_cast<std::size_t>(detail::PairShare::block_of(id, static_cast<int>(blocks_)));
    return {*seats_[block % seats_.size()], block / seats_.size()};
  }

  void ask_workers(const Motion& motion) noexcept {
    ++exchanges_;
    const auto now = Clock::now();
    for (auto& seat : seats_) {
      Order& draft = seat->worker->inbox.draft();
      draft.exchange = exchanges_;
      draft.posted = now;
      draft.motion.tick = motion.tick;
      std::copy(motion.bodies.begin(), motion.bodies.end(), draft.motion.bodies.begin());
      seat->worker->inbox.post();
    }
    const auto patiently = now + options_.patience;
    const auto in_turn = static_cast<std::size_t>(exchanges_) % seats_.size();
    for (std::size_t i = 0; i < seats_.size(); ++i) {
      seats_[i]->ahead = i == in_turn || seats_[i]->is_silent();
      if (seats_[i]->ahead) seats_[i]->deputy.run(motion);
    }
    const auto shortly = Clock::now() + options_.patience / 16;
    report_ = {0, 0, report_.ticks, report_.longest_silence};
    for (auto& seat : seats_) {
      seat->in_time = seat->is_silent() ? answers(*seat->worker, shortly) && seat->caught_up()
                                        : answers(*seat->worker, patiently);
      if (!seat->in_time && !seat->ahead) seat->deputy.run(motion);
      seat->silence = seat->in_time ? 0 : seat->silence + 1;
      seat->has_stood_in = seat->has_stood_in || !seat->in_time;
      report_.stood_in += seat->in_time ? 0 : 1;
      report_.silence = std::max(report_.silence, seat->silence);
    }
    report_.ticks += late() ? 1 : 0;
    report_.longest_silence = std::max(report_.longest_silence, report_.silence);
  }

  /// One turn of a spinning wait. In lock step threads may outnumber the processors and must make
  /// room for each other; by the clock a tick makes no system call.
  void relax(unsigned spins) const noexcept {
    if (options_.lock_step && spins % 4096 == 4095) std::this_thread::yield();
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }

  /// Waits for the answer of this exchange; false when it is not there by then.
  [[nodiscard]] bool answers(Worker& worker, Clock::time_point until) const noexcept {
    for (unsigned spins = 0;; ++spins) {
      worker.outbox.take();
      if (worker.outbox.newest().exchange == exchanges_) return true;
      if (spins % 16 == 15 && Clock::now() >= until) return false;
      relax(spins);
    }
  }

  /// Adds up block by block in the order of the pairs, whoever worked on them.
  void sum() noexcept {
    total_.clear();
    total_.tick = world_->motion().tick;
    for (std::size_t b = 0; b < blocks_; ++b) {
      const PairForces& block = seats_[b % seats_.size()]->forces(b / seats_.size());
      if (block.totals.near == 0 && block.totals.crowded == 0) continue;
      total_.add(block);
    }
  }

  /// A worker answers, then sleeps until shortly before the next motion is due and spins for it.
  void serve(Worker& worker, const std::stop_token& stop) noexcept {
    const auto nap = options_.period - std::min(options_.period / 2, nanoseconds_before);
    for (unsigned spins = 0; !stop.stop_requested(); ++spins) {
      if (!worker.inbox.take()) {
        relax(spins);
        if (!options_.lock_step && spins > spins_before_nap) {
          std::this_thread::sleep_for(options_.period / 8);
        }
        continue;
      }
      worker.answer();
      spins = 0;
      if (!options_.lock_step) std::this_thread::sleep_until(worker.inbox.newest().posted + nap);
    }
  }

  static constexpr std::chrono::nanoseconds longest_wait{std::chrono::seconds(1)};
  static constexpr std::chrono::nanoseconds nanoseconds_before{200000};
  static constexpr unsigned spins_before_nap = 200000;

  const World* world_;
  CoprocessorOptions options_;
  PairForces total_;
  WorkerReport report_;
  std::int64_t exchanges_ = 0;
  std::size_t blocks_ = 0;  ///< of all workers
  std::vector<std::unique_ptr<Seat>> seats_;
};

}  // namespace repel
