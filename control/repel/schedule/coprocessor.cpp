// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/coprocessor.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include <repel/schedule/beside_worker.hpp>
#include <repel/schedule/pair_team.hpp>

namespace repel {

struct Coprocessor::Parts {
  explicit Parts(const World& world) : prototype(world) {}

  const detail::PartPoses prototype;  ///< of the parts at set-up
  std::shared_ptr<const detail::PairIndex> pairs;
  std::unique_ptr<detail::PairTeam> team;  ///< of the caller
  std::unique_ptr<detail::WidenedForces> widened;
  std::vector<std::unique_ptr<detail::BesideWorker>> beside;  ///< the last one is in use
  detail::BesideWorker* current = nullptr;                    ///< the one that the caller uses
  std::atomic<detail::BesideWorker*> offered{nullptr};
  const detail::WholeAnswer* answer = nullptr;
  detail::Watch watch;
  detail::Supervisor supervisor;  // last member: joined before the data it uses is destroyed
};

Coprocessor::Coprocessor(const World& world, const CoprocessorOptions& options)
    : world_(&world),
      options_(checked_options(world, options)),
      threads_(useful_threads()),
      parts_(std::make_unique<Parts>(world)) {
  const bool beside = works_beside();
  lookahead_ = beside ? lookahead_for(options_.period) : 0.0;
  parts_->pairs = std::make_shared<const detail::PairIndex>(world, lookahead_);
  const int helpers = beside ? 0 : threads_;
  parts_->team = std::make_unique<detail::PairTeam>(world, parts_->pairs, parts_->prototype,
                                                    options_, helpers, 0, lookahead_);
  parts_->team->prime(world.motion());
  if (beside) {
    parts_->widened = std::make_unique<detail::WidenedForces>(world, most_near());
    add_beside_worker(world.motion());
    parts_->current = parts_->beside.back().get();
    parts_->current->prime();
    parts_->current->start();
  }
  parts_->team->start();
  if (threads_ > 0) {
    parts_->supervisor.start([this] { tend(); });
  }
}

Coprocessor::~Coprocessor() {
  parts_->supervisor.stop();
}

const PairForces& Coprocessor::exchange() noexcept {
  ++exchanges_;
  const Motion& motion = world_->motion();
  if (works_beside()) {
    forces_ = &beside(motion);
  } else {
    const bool late = parts_->team->run(motion);
    report_.shared = parts_->team->shared();
    report_.count(late);
    forces_ = &parts_->team->pairs().forces();
  }
  return *forces_;
}

void Coprocessor::rehearse() noexcept {
  if (!works_beside()) parts_->team->rehearse(world_->motion());
}

bool Coprocessor::is_past(std::int64_t exchange) noexcept {
  if (exchanges_ < exchange || !parts_->team->is_settled()) return false;
  if (!works_beside()) return true;
  if (options_.lock_step) (void)wait_for(exchange, {});
  const detail::WholeAnswer& newest = parts_->current->newest();
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
  if (!uses_answer_) return parts_->team->pairs().separation_of(id);
  for (std::size_t i = 0; i < parts_->answer->count; ++i) {
    if (parts_->answer->near[i].pair == id) return parts_->answer->shown[i].separation;
  }
  return {};
}

void Coprocessor::visit_near(void (*see)(const void* of, const NearPair& near) noexcept,
                             const void* of) const noexcept {
  if (!uses_answer_) {
    parts_->team->pairs().for_each_near(world_->motion(),
                                        [&](const NearPair& near) { see(of, near); });
    return;
  }
  const detail::WholeAnswer& answer = *parts_->answer;
  for (std::size_t i = 0; i < answer.count; ++i) {
    NearPair near = answer.shown[i];
    near.force = parts_->widened->size(i);
    near.age += report_.age;
    see(of, near);
  }
}

PairExtremes Coprocessor::extremes_of(PairId id) const noexcept {
  PairExtremes extremes = parts_->team->extremes_of(id);
  if (stopped_) {
    for (const auto& worker : parts_->beside) extremes.add(worker->team().extremes_of(id));
  }
  return extremes;
}

void Coprocessor::stop() {
  parts_->supervisor.stop();
  parts_->team->stop();
  for (const auto& worker : parts_->beside) worker->stop();
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

void Coprocessor::add_beside_worker(const Motion& motion) {
  parts_->beside.push_back(
      std::make_unique<detail::BesideWorker>(*world_, motion, parts_->pairs, parts_->prototype,
                                             options_, threads_ - 1, 0, lookahead_, most_near()));
}

const PairForces& Coprocessor::beside(const Motion& motion) noexcept {
  if (auto* fresh = parts_->offered.exchange(nullptr, std::memory_order_acq_rel))
    parts_->current = fresh;
  if (options_.lock_step) (void)wait_for(exchanges_ - 1, {});
  parts_->answer = &parts_->current->newest();
  parts_->current->post(exchanges_, motion);
  report_.age = exchanges_ - parts_->answer->exchange;
  ++report_.shared;
  // A pair without memory has no answer that could be widened.
  const bool is_usable = report_.age <= greatest_age && parts_->answer->totals.crowded == 0;
  if (!is_usable && uses_answer_) parts_->team->skip_ticks();
  uses_answer_ = is_usable;
  if (uses_answer_) {
    parts_->widened->widen(*parts_->answer, motion);
  } else {
    report_.age = 0;
    (void)parts_->team->run(motion);
  }
  report_.count(!uses_answer_ || parts_->current->is_team_late());
  return uses_answer_ ? parts_->widened->forces() : parts_->team->pairs().forces();
}

bool Coprocessor::wait_for(std::int64_t exchange, Clock::time_point until) noexcept {
  for (unsigned spins = 1; parts_->current->newest().exchange < exchange; ++spins) {
    if (!options_.lock_step && spins % 16 == 0 && Clock::now() >= until) return false;
    if (spins % 4096 == 0) std::this_thread::yield();
    detail::WorkerThread::pause();
  }
  return true;
}

void Coprocessor::tend() {
  parts_->team->tend(usage_);
  if (!parts_->beside.empty()) {
    parts_->beside.back()->tend(usage_);
    if (!options_.lock_step && parts_->watch.is_overdue(parts_->beside.back()->beats()))
      replace_beside();
  }
  const auto lost =
      std::count_if(parts_->beside.begin(), parts_->beside.end(), [this](const auto& worker) {
        return worker != parts_->beside.back() && !worker->has_ended();
      });
  lost_.store(static_cast<int>(lost), std::memory_order_release);
  page_faults_.store(usage_.page_faults, std::memory_order_relaxed);
  switches_.store(usage_.switches, std::memory_order_relaxed);
  restarts_.store(usage_.restarts, std::memory_order_relaxed);
}

void Coprocessor::replace_beside() {
  parts_->beside.back()->request_stop();
  lost_.fetch_add(1, std::memory_order_release);
  // The caller moves its world meanwhile: until it posts a motion, the new one has none.
  Motion nowhere;
  nowhere.bodies.resize(static_cast<std::size_t>(world_->body_count()));
  add_beside_worker(nowhere);
  parts_->beside.back()->start();
  parts_->watch = {};
  parts_->offered.store(parts_->beside.back().get(), std::memory_order_release);
  ++usage_.restarts;
}

}  // namespace repel
