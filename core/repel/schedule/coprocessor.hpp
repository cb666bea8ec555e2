// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The coprocessor: evaluates the pairs of a world, with threads beside or together with the
/// caller. It is the counterpart of the attached processor of the paper (Anderson 1993, section 4).
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <repel/schedule/beside_worker.hpp>
#include <repel/schedule/pair_forces.hpp>
#include <repel/schedule/pair_team.hpp>

namespace repel {

/// Computes the forces of all pairs, alone or with threads (`CoprocessorMode`).
///
/// Together: the threads take part where there are enough near pairs. The forces are those of the
/// present motion, with the same bits for any number of threads.
///
/// Beside: the threads evaluate the motion of the last exchange while the caller goes on. It never
/// waits: it takes their newest whole answer and computes the forces for the present motion from
/// it, at distances that are not larger than the true ones.
///
/// Whenever threads are late, stalled or dead, the caller evaluates all pairs at the present motion
/// by itself. Threads that do not go on are replaced after half a second. In lock step it waits for
/// them, and nothing depends on a clock. With threads, all memory of the pairs is allocated twice,
/// with several threads beside three times.
class Coprocessor {
 public:
  /// [ticks] Greatest age of an answer that is used beside.
  static constexpr std::int64_t greatest_age = 4;

  /// Evaluates every pair once and starts the threads. Allocates.
  /// @throws SetupError for a number of threads below 0 or above `Capacities::threads`; for
  /// `every_pair` with parts that can come and go
  Coprocessor(const World& world, const CoprocessorOptions& options)
      : world_(&world),
        options_(checked_options(world, options)),
        threads_(useful_threads()),
        prototype_(world) {
    const bool beside = works_beside();
    lookahead_ = beside ? lookahead_for(options_.period) : 0.0;
    pairs_ = std::make_shared<const detail::PairIndex>(world, lookahead_);
    const int helpers = beside ? 0 : threads_;
    team_ = std::make_unique<detail::PairTeam>(world, pairs_, prototype_, options_, helpers, 0,
                                               lookahead_);
    team_->prime(world.motion());
    if (beside) {
      widened_ = std::make_unique<detail::WidenedForces>(world, most_near());
      beside_.push_back(make_beside_worker(world.motion()));
      current_ = beside_.back().get();
      current_->prime();
      current_->start();
    }
    team_->start();
    if (threads_ > 0) {
      supervisor_.start([this] { tend(); });
    }
  }
  Coprocessor(const Coprocessor&) = delete;
  Coprocessor& operator=(const Coprocessor&) = delete;
  ~Coprocessor() { supervisor_.stop(); }

  /// The forces at `world.motion()`. Cost alone: the search and the near pairs. Together: a part of
  /// it, and the wait for a batch; if a thread is late, its patience, a search of all pairs and all
  /// near pairs. Beside: two copies of the motion, and about 20 ns for each near pair.
  [[gnu::noinline]] const PairForces& exchange() noexcept {
    ++exchanges_;
    const Motion& motion = world_->motion();
    if (works_beside()) {
      forces_ = &beside(motion);
    } else {
      const bool late = team_->run(motion);
      report_.shared = team_->shared();
      report_.count(late);
      forces_ = &team_->pairs().forces();
    }
    return *forces_;
  }

  /// Repeats queries of the last exchange and discards their answers, to warm the CPU caches for
  /// the next. Beside: no effect.
  void rehearse() noexcept {
    if (!works_beside()) team_->rehearse(world_->motion());
  }

  /// Number of exchanges since set-up.
  [[nodiscard]] std::int64_t exchanges() const noexcept { return exchanges_; }
  /// No thread uses a motion older than that of the exchange of this number, nor will: a part that
  /// has been absent since then may get another shape. Call it just before an exchange.
  [[nodiscard]] bool is_past(std::int64_t exchange) noexcept {
    if (exchanges_ < exchange || !team_->is_settled()) return false;
    if (!works_beside()) return true;
    if (options_.lock_step) (void)wait_for(exchange, {});
    const detail::WholeAnswer& newest = current_->newest();
    return newest.exchange >= exchange && newest.is_settled &&
           lost_.load(std::memory_order_acquire) == 0;
  }

  /// True when some thread was late at the last exchange, and the caller did its work.
  [[nodiscard]] bool late() const noexcept { return report_.stood_in > 0; }
  /// What the caller knows of the threads, as of the last exchange.
  [[nodiscard]] const WorkerReport& workers() const noexcept { return report_; }
  /// What the operating system did to the threads, as of the last 50 ms, and how many have been
  /// replaced. Callable from the thread that exchanges.
  [[nodiscard]] WorkerUsage usage() const noexcept {
    return {page_faults_.load(std::memory_order_relaxed), switches_.load(std::memory_order_relaxed),
            restarts_.load(std::memory_order_relaxed)};
  }
  /// Number of threads at work: those asked for that have a processor, and enough pairs.
  [[nodiscard]] int threads() const noexcept { return threads_; }
  [[nodiscard]] CoprocessorMode mode() const noexcept { return options_.mode; }  ///< as asked for

  /// Beside: waits until the last motion has been answered; true at once in the other mode. For
  /// programs that do not run by the clock, between ticks. False on timeout; none in lock step.
  [[nodiscard]] bool wait_for_answer(std::chrono::nanoseconds timeout) noexcept {
    if (!works_beside()) return true;
    return wait_for(exchanges_, Clock::now() + std::min(timeout, longest_wait));
  }

  /// Calls see(NearPair) for each pair that was near at the last exchange, in an unspecified order.
  /// Call it between exchanges and from the same thread.
  template <class See>
  void for_each_near(const See& see) const noexcept {
    if (!uses_answer_) return team_->pairs().for_each_near(world_->motion(), see);
    for (std::size_t i = 0; i < answer_->count; ++i) {
      NearPair near = answer_->shown[i];
      near.force = widened_->size(i);
      near.age += report_.age;
      see(near);
    }
  }

  /// The last answer for a pair; a default `Separation`, which bounds nothing, if its slot has been
  /// reused for another pair (`Capacities::candidates`), or beside if it is not near. Same calling
  /// condition, or after `stop`.
  [[nodiscard]] Separation separation_of(PairId id) const noexcept {
    if (!uses_answer_) return team_->pairs().separation_of(id);
    for (std::size_t i = 0; i < answer_->count; ++i) {
      if (answer_->near[i].pair == id) return answer_->shown[i].separation;
    }
    return {};
  }
  /// Least distance and largest force of a pair since set-up. Same calling condition; beside, only
  /// after `stop`.
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept {
    PairExtremes extremes = team_->extremes_of(id);
    if (stopped_) {
      for (const auto& worker : beside_) extremes.add(worker->team().extremes_of(id));
    }
    return extremes;
  }

  /// Joins the threads, as the destructor does. Each finishes its tick first: blocks for ever if
  /// one is stalled for ever, but not for a thread that was killed. Not real-time safe.
  void stop() {
    supervisor_.stop();
    team_->stop();
    for (const auto& worker : beside_) worker->stop();
    stopped_ = true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::nanoseconds longest_wait{std::chrono::seconds(1)};

  static CoprocessorOptions checked_options(const World& world, CoprocessorOptions options) {
    checked("threads", options.threads, 0, world.limits().threads, "");
    if (options.every_pair && !world.loose().empty()) {
      throw SetupError(
          "every_pair with parts that can come and go; allowed: one without the other");
    }
    const std::chrono::nanoseconds none{0};
    options.period = std::clamp(options.period, none, longest_wait);
    options.patience = std::clamp(options.patience, none, longest_wait);
    if (options.lock_step) options.budget.wall = none;
    return options;
  }
  /// A thread without a processor of its own would take that of another thread or of the caller,
  /// and one for which there are never enough pairs would wait for ever.
  [[nodiscard]] int useful_threads() const noexcept {
    const auto pairs = static_cast<int>(world_->pairs().size());
    const int alone = options_.mode == CoprocessorMode::beside && pairs > 0 ? 1 : 0;
    const int with_work = std::max(alone, pairs / detail::PairTeam::worth_sharing);
    const int most = std::min(options_.threads, with_work);
    if (options_.lock_step) return most;
    const int processors = options_.processors > 0
                               ? options_.processors
                               : static_cast<int>(std::thread::hardware_concurrency());
    return std::min(most, std::max(alone, processors - 1));
  }
  [[nodiscard]] bool works_beside() const noexcept {
    return threads_ > 0 && options_.mode == CoprocessorMode::beside;
  }
  /// [m] What bodies that approach each other at 1 m/s move until the next but one answer: a pair
  /// that is out of range by more cannot be within range when the answer is used.
  [[nodiscard]] static double lookahead_for(std::chrono::nanoseconds period) noexcept {
    return std::clamp(2.0 * std::chrono::duration<double>(period).count(), 1e-4, 5e-3);
  }
  [[nodiscard]] int most_near() const noexcept {
    const int all = static_cast<int>(world_->pairs().size());
    return options_.every_pair ? all : std::min(all, world_->limits().candidates);
  }
  [[nodiscard]] std::unique_ptr<detail::BesideWorker> make_beside_worker(const Motion& motion) {
    return std::make_unique<detail::BesideWorker>(*world_, motion, pairs_, prototype_, options_,
                                                  threads_ - 1, 0, lookahead_, most_near());
  }

  const PairForces& beside(const Motion& motion) noexcept {
    if (auto* fresh = offered_.exchange(nullptr, std::memory_order_acq_rel)) current_ = fresh;
    if (options_.lock_step) (void)wait_for(exchanges_ - 1, {});
    answer_ = &current_->newest();
    current_->post(exchanges_, motion);
    report_.age = exchanges_ - answer_->exchange;
    ++report_.shared;
    // A pair without memory has no answer that could be widened.
    const bool is_usable = report_.age <= greatest_age && answer_->totals.crowded == 0;
    if (!is_usable && uses_answer_) team_->skip_ticks();
    uses_answer_ = is_usable;
    if (uses_answer_) {
      widened_->widen(*answer_, motion);
    } else {
      report_.age = 0;
      (void)team_->run(motion);
    }
    report_.count(!uses_answer_ || current_->is_team_late());
    return uses_answer_ ? widened_->forces() : team_->pairs().forces();
  }

  // In lock step, however long it takes.
  [[nodiscard]] bool wait_for(std::int64_t exchange, Clock::time_point until) noexcept {
    for (unsigned spins = 1; current_->newest().exchange < exchange; ++spins) {
      if (!options_.lock_step && spins % 16 == 0 && Clock::now() >= until) return false;
      if (spins % 4096 == 0) std::this_thread::yield();
      detail::WorkerThread::pause();
    }
    return true;
  }

  /// Called by the supervisor.
  void tend() {
    team_->tend(usage_);
    if (!beside_.empty()) {
      beside_.back()->tend(usage_);
      if (!options_.lock_step && watch_.is_overdue(beside_.back()->beats())) replace_beside();
    }
    const auto lost = std::count_if(beside_.begin(), beside_.end(), [this](const auto& worker) {
      return worker != beside_.back() && !worker->has_ended();
    });
    lost_.store(static_cast<int>(lost), std::memory_order_release);
    page_faults_.store(usage_.page_faults, std::memory_order_relaxed);
    switches_.store(usage_.switches, std::memory_order_relaxed);
    restarts_.store(usage_.restarts, std::memory_order_relaxed);
  }

  void replace_beside() {
    beside_.back()->request_stop();
    lost_.fetch_add(1, std::memory_order_release);
    // The caller moves its world meanwhile: until it posts a motion, the new one has none.
    Motion nowhere;
    nowhere.bodies.resize(static_cast<std::size_t>(world_->body_count()));
    beside_.push_back(make_beside_worker(nowhere));
    beside_.back()->start();
    watch_ = {};
    offered_.store(beside_.back().get(), std::memory_order_release);
    ++usage_.restarts;
  }

  const World* world_;
  CoprocessorOptions options_;
  int threads_;
  double lookahead_ = 0.0;             ///< [m]
  const detail::PartPoses prototype_;  ///< of the parts at set-up
  std::shared_ptr<const detail::PairIndex> pairs_;
  std::unique_ptr<detail::PairTeam> team_;  ///< of the caller
  std::unique_ptr<detail::WidenedForces> widened_;
  std::vector<std::unique_ptr<detail::BesideWorker>> beside_;  ///< the last one is in use
  detail::BesideWorker* current_ = nullptr;                    ///< the one that the caller uses
  std::atomic<detail::BesideWorker*> offered_{nullptr};
  const detail::WholeAnswer* answer_ = nullptr;
  bool uses_answer_ = false;  ///< at the last exchange
  bool stopped_ = false;
  const PairForces* forces_ = nullptr;
  WorkerReport report_;
  std::int64_t exchanges_ = 0;
  std::atomic<int> lost_{0};  ///< workers given up that may yet go on
  detail::Watch watch_;
  WorkerUsage usage_;  ///< of the supervisor; the next three are for the caller
  std::atomic<std::int64_t> page_faults_{0}, switches_{0}, restarts_{0};
  detail::Supervisor supervisor_;  // last member: joined before the data it uses is destroyed
};

}  // namespace repel
