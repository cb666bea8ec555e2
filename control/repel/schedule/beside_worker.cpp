// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/beside_worker.hpp>

#include <atomic>
#include <cstdint>
#include <memory>

namespace repel::detail {

BesideWorker::BesideWorker(const World& world, const Motion& motion,
                           const std::shared_ptr<const PairIndex>& pairs,
                           const PartPoses& prototype, const CoprocessorOptions& options,
                           int threads, int index, double lookahead, int most_near)
    : pace_(options.period),
      team_(world, pairs, prototype, options, threads, index + 1, lookahead),
      inbox_({0, motion}),
      outbox_(WholeAnswer(world, most_near)),
      thread_(options, index, pace_) {}

void BesideWorker::prime() noexcept {
  team_.prime(inbox_.newest().motion);
  answer(inbox_.newest());
}

void BesideWorker::start() {
  team_.start();
  thread_.start([this]() noexcept {
    if (!inbox_.take()) return false;
    late_.store(team_.run(inbox_.newest().motion), std::memory_order_relaxed);
    answer(inbox_.newest());
    return true;
  });
}

void BesideWorker::request_stop() noexcept {
  thread_.request_stop();
  team_.request_stop();
}

void BesideWorker::stop() {
  thread_.stop();
  team_.stop();
}

void BesideWorker::post(std::int64_t exchange, const Motion& motion) noexcept {
  pace_.tick();
  Request& draft = inbox_.draft();
  draft.exchange = exchange;
  draft.motion.take(motion);
  inbox_.post();
}

const WholeAnswer& BesideWorker::newest() noexcept {
  outbox_.take();
  return outbox_.newest();
}

void BesideWorker::tend(WorkerUsage& usage) {
  team_.tend(usage);
  const ThreadUsage::Counts now = thread_.look_at_usage();
  usage.page_faults += now.page_faults - seen_.page_faults;
  usage.switches += now.switches - seen_.switches;
  seen_ = now;
}

void BesideWorker::answer(const Request& request) noexcept {
  outbox_.draft().fill(team_.pairs(), request.motion, request.exchange);
  outbox_.draft().is_settled = team_.is_settled();
  outbox_.post();
}

}  // namespace repel::detail
