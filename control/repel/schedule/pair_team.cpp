// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/pair_team.hpp>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>

namespace repel::detail {

PairTeam::PairTeam(const World& world, std::shared_ptr<const PairIndex> pairs,
                   const PartPoses& prototype, const CoprocessorOptions& options, int threads,
                   int first_index, double lookahead)
    : world_(&world),
      options_(options),
      lookahead_(lookahead),
      prototype_(prototype),
      leader_{.poses = prototype_, .is_leader = true},
      pairs_(std::move(pairs)),
      search_(pairs_),
      pace_(options.period),
      first_index_(first_index),
      helpers_(static_cast<std::size_t>(threads)) {
  current_ = add_set();
  if (threads == 0) return;
  spare_ = add_set();
  open_to_all_.store(current_, std::memory_order_release);
}

void PairTeam::prime(const Motion& motion) noexcept {
  leader_.poses.begin_tick();
  current_->pairs().prime(motion, leader_.poses);
  (void)answer(motion, {}, false);
}

void PairTeam::start() {
  for (std::size_t i = 0; i < helpers_.size(); ++i) start_helper(i);
}

void PairTeam::request_stop() noexcept {
  for (Helper& helper : helpers_) helper.thread->request_stop();
}

void PairTeam::stop() {
  for (Helper& helper : helpers_) {
    if (helper.thread != nullptr) helper.thread->stop();
  }
  for (auto& thread : given_up_) thread->stop();
  stopped_ = true;
}

bool PairTeam::run(const Motion& motion) noexcept {
  const EvaluationLimit limit = EvaluationLimit::from_now(options_.budget);
  if (SharedTick* fresh = offered_.exchange(nullptr, std::memory_order_acq_rel)) spare_ = fresh;
  // Without a spare memory, a late thread could not be replaced.
  const bool all_are_back = spare_ != nullptr && spare_->is_idle();
  const bool may_share = all_are_back && rest_ == 0 && !limit.is_counted();
  rest_ -= rest_ > 0 ? 1 : 0;
  if (answer(motion, limit, may_share)) return spare_ != nullptr && !all_are_back;
  // Each time they are late, they are left alone for twice as long.
  rest_ = std::min(std::max<std::int64_t>(1, 2 * last_rest_), longest_rest);
  last_rest_ = rest_;
  std::swap(current_, spare_);
  open_to_all_.store(current_, std::memory_order_release);
  held_.store(spare_, std::memory_order_release);
  current_->pairs().forget(leader_.poses);
  search_.repeat();
  return answer(motion, limit, false);
}

void PairTeam::rehearse(const Motion& motion) noexcept {
  (void)current_->pairs().rehearse(motion, leader_.poses, rehearsed_pairs);
}

PairExtremes PairTeam::extremes_of(PairId id) const noexcept {
  PairExtremes extremes = current_->pairs().extremes_of(id);
  if (stopped_) {
    for (const auto& set : sets_) extremes.add(set->pairs().extremes_of(id));
  } else if (spare_ != nullptr && spare_->is_idle()) {
    extremes.add(spare_->pairs().extremes_of(id));
  }
  return extremes;
}

bool PairTeam::is_settled() const noexcept {
  if (helpers_.empty()) return true;
  return spare_ != nullptr && spare_->is_idle() && current_->is_idle() &&
         lost_.load(std::memory_order_acquire) == 0;
}

void PairTeam::tend(WorkerUsage& usage) {
  for (std::size_t i = 0; i < helpers_.size(); ++i) tend(i, usage);
  note_lost();
  SharedTick* const held = held_.load(std::memory_order_acquire);
  const bool is_held = held != nullptr && !held->is_idle();
  if (!is_held) held_watch_ = {};
  if (is_held && held_watch_.is_overdue(1)) {
    held_.store(nullptr, std::memory_order_release);
    offered_.store(add_set(), std::memory_order_release);
  }
}

SharedTick* PairTeam::add_set() {
  const int slots =
      options_.every_pair ? static_cast<int>(world_->pairs().size()) : world_->limits().candidates;
  sets_.push_back(std::make_unique<SharedTick>(*world_, slots, options_.budget, lookahead_));
  if (options_.every_pair) sets_.back()->pairs().track_all(*pairs_);
  return sets_.back().get();
}

void PairTeam::start_helper(std::size_t i) {
  Helper& helper = helpers_[i];
  helper.thread =
      std::make_unique<WorkerThread>(options_, first_index_ + static_cast<int>(i), pace_);
  helper.watch = {};
  helper.seen = {};
  helper.thread->start([this, evaluator = Evaluator{.poses = prototype_}]() mutable noexcept {
    return open_to_all_.load(std::memory_order_acquire)->work(evaluator);
  });
}

void PairTeam::tend(std::size_t i, WorkerUsage& usage) {
  Helper& helper = helpers_[i];
  const ThreadUsage::Counts now = helper.thread->look_at_usage();
  usage.page_faults += now.page_faults - helper.seen.page_faults;
  usage.switches += now.switches - helper.seen.switches;
  helper.seen = now;
  if (options_.lock_step) return;  // the leader waits, however long it takes
  if (!helper.watch.is_overdue(helper.thread->beats())) return;
  helper.thread->request_stop();
  given_up_.push_back(std::move(helper.thread));
  note_lost();
  start_helper(i);
  ++usage.restarts;
}

void PairTeam::note_lost() noexcept {
  const auto lost = std::count_if(given_up_.begin(), given_up_.end(),
                                  [](const auto& thread) { return !thread->has_ended(); });
  lost_.store(static_cast<int>(lost), std::memory_order_release);
}

bool PairTeam::Sink::take(PairId id, std::int32_t list, double distance) noexcept {
  return pairs.take(id, list, distance, motion, poses);
}

bool PairTeam::answer(const Motion& motion, const EvaluationLimit& limit, bool may_share) noexcept {
  AnyPairSet& pairs = current_->pairs();
  leader_.poses.begin_tick();
  leader_.round = ++round_;
  pairs.begin_tick(motion.tick);
  if (!options_.every_pair) search_.run(motion, Sink{pairs, motion, leader_.poses});
  const int batches = pairs.select(motion, leader_.poses, limit);
  if (may_share && pairs.selected() >= worth_sharing) {
    ++shared_;
    pace_.tick();
    current_->open(round_, motion, batches);
    (void)current_->work(leader_);
    if (!is_finished()) return false;
    last_rest_ -= last_rest_ > 0 && round_ % forgives_after == 0 ? 1 : 0;
  } else {
    pairs.evaluate_all(motion, leader_.poses);
  }
  pairs.finish(motion, leader_.poses);
  return true;
}

bool PairTeam::is_finished() const noexcept {
  if (current_->is_idle()) return true;
  const Clock::time_point until = Clock::now() + options_.patience;
  for (unsigned spins = 1; !current_->is_idle(); ++spins) {
    if (options_.lock_step) {
      if (spins % 4096 == 0) std::this_thread::yield();
    } else if (spins % 16 == 0 && Clock::now() >= until) {
      return current_->is_idle();
    }
    WorkerThread::pause();
  }
  return true;
}

}  // namespace repel::detail
