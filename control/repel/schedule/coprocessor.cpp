// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/coprocessor.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>

namespace repel {

Coprocessor::Coprocessor(const World& world, const CoprocessorOptions& options)
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

const PairForces& Coprocessor::exchange() noexcept {
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

void Coprocessor::rehearse() noexcept {
  if (!works_beside()) team_->rehearse(world_->motion());
}

bool Coprocessor::is_past(std::int64_t exchange) noexcept {
  if (exchanges_ < exchange || !team_->is_settled()) return false;
  if (!works_beside()) return true;
  if (options_.lock_step) (void)wait_for(exchange, {});
  const detail::WholeAnswer& newest = current_->newest();
  return newest.exchange >= exchange && newest.is_settled &&
         lost_.load(std::memory_order_acquire) == 0;
}

WorkerUsage Coprocessor::usage() const noexcept {
  return {page_faults_.load(std::memory_order_relaxed), switches_.load(std::memory_order_relaxed),
          restarts_.load(std::memory_order_relaxed)};
}

bool Coprocessor::wait_for_answer(std::chrono::nanoseconds timeout) noexcept {
  if (!works_beside()) return true;
  return wait_for(exchanges_, Clock::now() + std::min(timeout, longest_wait));
}

Separation Coprocessor::separation_of(PairId id) const noexcept {
  if (!uses_answer_) return team_->pairs().separation_of(id);
  for (std::size_t i = 0; i < answer_->count; ++i) {
    if (answer_->near[i].pair == id) return answer_->shown[i].separation;
  }
  return {};
}

PairExtremes Coprocessor::extremes_of(PairId id) const noexcept {
  PairExtremes extremes = team_->extremes_of(id);
  if (stopped_) {
    for (const auto& worker : beside_) extremes.add(worker->team().extremes_of(id));
  }
  return extremes;
}

void Coprocessor::stop() {
  supervisor_.stop();
  team_->stop();
  for (const auto& worker : beside_) worker->stop();
  stopped_ = true;
}

CoprocessorOptions Coprocessor::checked_options(const World& world, CoprocessorOptions options) {
  checked("threads", options.threads, 0, world.limits().threads, "");
  if (options.every_pair && !world.loose().empty()) {
    throw SetupError("every_pair with parts that can come and go; allowed: one without the other");
  }
  const std::chrono::nanoseconds none{0};
  options.period = std::clamp(options.period, none, longest_wait);
  options.patience = std::clamp(options.patience, none, longest_wait);
  if (options.lock_step) options.budget.wall = none;
  return options;
}

int Coprocessor::useful_threads() const noexcept {
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

bool Coprocessor::works_beside() const noexcept {
  return threads_ > 0 && options_.mode == CoprocessorMode::beside;
}

double Coprocessor::lookahead_for(std::chrono::nanoseconds period) noexcept {
  return std::clamp(2.0 * std::chrono::duration<double>(period).count(), 1e-4, 5e-3);
}

int Coprocessor::most_near() const noexcept {
  const int all = static_cast<int>(world_->pairs().size());
  return options_.every_pair ? all : std::min(all, world_->limits().candidates);
}

std::unique_ptr<detail::BesideWorker> Coprocessor::make_beside_worker(const Motion& motion) {
  return std::make_unique<detail::BesideWorker>(*world_, motion, pairs_, prototype_, options_,
                                                threads_ - 1, 0, lookahead_, most_near());
}

const PairForces& Coprocessor::beside(const Motion& motion) noexcept {
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

bool Coprocessor::wait_for(std::int64_t exchange, Clock::time_point until) noexcept {
  for (unsigned spins = 1; current_->newest().exchange < exchange; ++spins) {
    if (!options_.lock_step && spins % 16 == 0 && Clock::now() >= until) return false;
    if (spins % 4096 == 0) std::this_thread::yield();
    detail::WorkerThread::pause();
  }
  return true;
}

void Coprocessor::tend() {
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

void Coprocessor::replace_beside() {
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

}  // namespace repel
