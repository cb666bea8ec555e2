// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/shared_tick.hpp>

#include <atomic>
#include <cstdint>

namespace repel::detail {

SharedTick::SharedTick(const World& world, int slots, const Budget& budget, double lookahead)
    : pairs_(make_pair_set(world, slots, budget, lookahead)) {
  motion_.bodies.resize(static_cast<std::size_t>(world.body_count()));
}

bool SharedTick::is_idle() const noexcept {
  return unfinished_.load(std::memory_order_acquire) == 0;
}

void SharedTick::open(std::int64_t round, const Motion& motion, int batches) noexcept {
  motion_.take(motion);
  round_ = round;
  unfinished_.store(batches, std::memory_order_relaxed);
  left_.store(span(0, static_cast<std::uint32_t>(batches)), std::memory_order_release);
}

bool SharedTick::work(Evaluator& evaluator) noexcept {
  bool any = false;
  std::uint64_t left = left_.load(std::memory_order_acquire);
  while (first_of(left) < end_of(left)) {
    const std::uint32_t first = first_of(left);
    const std::uint32_t last = end_of(left) - 1;
    const bool takes_first = evaluator.is_leader;
    const std::uint64_t rest = takes_first ? span(first + 1, last + 1) : span(first, last);
    if (!left_.compare_exchange_weak(left, rest, std::memory_order_acq_rel,
                                     std::memory_order_acquire)) {
      continue;
    }
    any = true;
    evaluate_taken(static_cast<int>(takes_first ? first : last), evaluator);
    left = left_.load(std::memory_order_acquire);
  }
  return any;
}

std::uint64_t SharedTick::span(std::uint32_t first, std::uint32_t end) noexcept {
  return std::uint64_t{first} << 32U | end;
}

std::uint32_t SharedTick::first_of(std::uint64_t span) noexcept {
  return static_cast<std::uint32_t>(span >> 32U);
}

std::uint32_t SharedTick::end_of(std::uint64_t span) noexcept {
  return static_cast<std::uint32_t>(span);
}

void SharedTick::evaluate_taken(int batch, Evaluator& evaluator) noexcept {
  if (evaluator.round != round_) {
    evaluator.round = round_;
    evaluator.poses.begin_tick();
  }
  (void)pairs_->evaluate(batch, motion_, evaluator.poses);
  unfinished_.fetch_sub(1, std::memory_order_release);
}

}  // namespace repel::detail
