// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The coprocessor: evaluates the pairs of a world, with threads beside or together with the
/// caller. It is the counterpart of the attached processor of the paper (Anderson 1993, section 4).
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>

#include <repel/pairs/forces_and_totals.hpp>
#include <repel/pairs/near_pair.hpp>
#include <repel/schedule/built_alike.hpp>
#include <repel/schedule/coprocessor_options.hpp>
#include <repel/schedule/pair_forces.hpp>

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
  Coprocessor(const World& world, const CoprocessorOptions& options);
  Coprocessor(const Coprocessor&) = delete;
  Coprocessor& operator=(const Coprocessor&) = delete;
  ~Coprocessor();

  /// The forces at `world.motion()`. Cost alone: the search and the near pairs. Together: a part of
  /// it, and the wait for a batch; if a thread is late, its patience, a search of all pairs and all
  /// near pairs. Beside: two copies of the motion, and about 20 ns for each near pair.
  [[gnu::noinline]] const PairForces& exchange() noexcept;

  /// Repeats queries of the last exchange and discards their answers, to warm the CPU caches for
  /// the next. Beside: no effect.
  void rehearse() noexcept;

  /// Number of exchanges since set-up.
  [[nodiscard]] std::int64_t exchanges() const noexcept { return exchanges_; }
  /// All workers have passed this exchange: none uses an older motion any more. A part that was
  /// absent since then may get another shape. Call it just before an exchange.
  [[nodiscard]] bool is_past(std::int64_t exchange) noexcept;

  /// True when some thread was late at the last exchange, and the caller did its work.
  [[nodiscard]] bool late() const noexcept { return report_.stood_in > 0; }
  /// What the caller knows of the threads, as of the last exchange.
  [[nodiscard]] const WorkerReport& workers() const noexcept { return report_; }
  /// What the operating system did to the threads, as of the last 50 ms, and how many have been
  /// replaced. Callable from the thread that exchanges.
  [[nodiscard]] WorkerUsage usage() const noexcept;
  /// Number of threads at work: those asked for that have a processor, and enough pairs.
  [[nodiscard]] int threads() const noexcept { return threads_; }
  [[nodiscard]] CoprocessorMode mode() const noexcept { return options_.mode; }  ///< as asked for

  /// Beside: waits until the last motion has been answered; true at once in the other mode. For
  /// programs that do not run by the clock, between ticks. False on timeout; none in lock step.
  [[nodiscard]] bool wait_for_answer(std::chrono::nanoseconds timeout) noexcept;

  /// Calls see(NearPair) for each pair that was near at the last exchange, in an unspecified order.
  /// Call it between exchanges and from the same thread.
  template <class See>
  void for_each_near(const See& see) const noexcept {
    visit_near(
        [](const void* of, const NearPair& near) noexcept { (*static_cast<const See*>(of))(near); },
        &see);
  }

  /// The last answer for a pair; a default `Separation`, which bounds nothing, if its slot has been
  /// reused for another pair (`Capacities::candidates`), or beside if it is not near. Same calling
  /// condition, or after `stop`.
  [[nodiscard]] Separation separation_of(PairId id) const noexcept;
  /// Least distance and largest force of a pair since set-up. Same calling condition; beside, only
  /// after `stop`.
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept;

  /// Joins the threads, as the destructor does. Each finishes its tick first: blocks for ever if
  /// one is stalled for ever, but not for a thread that was killed. Not real-time safe.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::nanoseconds longest_wait{std::chrono::seconds(1)};

  /// The threads, what they work on, and what the caller has of it.
  struct Parts;

  void visit_near(void (*see)(const void* of, const NearPair& near) noexcept,
                  const void* of) const noexcept;

  static CoprocessorOptions checked_options(const World& world, CoprocessorOptions options);
  /// A thread without a processor of its own would take that of another thread or of the caller,
  /// and one for which there are never enough pairs would wait for ever.
  [[nodiscard]] int useful_threads() const noexcept;
  [[nodiscard]] bool works_beside() const noexcept;
  /// [m] What bodies that approach each other at 1 m/s move until the next but one answer: a pair
  /// that is out of range by more cannot be within range when the answer is used.
  [[nodiscard]] static double lookahead_for(std::chrono::nanoseconds period) noexcept;
  [[nodiscard]] int most_near() const noexcept;
  void add_beside_worker(const Motion& motion);

  const PairForces& beside(const Motion& motion) noexcept;

  // In lock step, however long it takes.
  [[nodiscard]] bool wait_for(std::int64_t exchange, Clock::time_point until) noexcept;

  /// Called by the supervisor.
  void tend();

  void replace_beside();

  const World* world_;
  CoprocessorOptions options_;
  int threads_;
  double lookahead_ = 0.0;    ///< [m]
  bool uses_answer_ = false;  ///< at the last exchange
  bool stopped_ = false;
  const PairForces* forces_ = nullptr;
  WorkerReport report_;
  std::int64_t exchanges_ = 0;
  std::atomic<int> lost_{0};  ///< workers given up that may yet go on
  WorkerUsage usage_;         ///< of the supervisor; the next three are for the caller
  std::atomic<std::int64_t> page_faults_{0}, switches_{0}, restarts_{0};
  std::unique_ptr<Parts> parts_;  // last member: its threads use the others
};

}  // namespace repel
