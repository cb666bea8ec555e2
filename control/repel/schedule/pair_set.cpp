// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/pair_set.hpp>

#include <cstdint>
#include <span>
#include <utility>

namespace repel::detail {

PairSet::PairSet(const World& world, int slots, const Budget& budget, double lookahead)
    : singles_(world, slots, budget.max_age, lookahead),
      lanes_(singles_),
      candidates_(memory().slots()),
      due_(memory().slots()),
      is_near_(memory().slots()),
      fitting_(memory().slots()),
      plan_(memory().slots() / lane_count + 1, memory().slots()) {}

void PairSet::prime(const Motion& motion, PartPoses& poses) noexcept {
  for (PairId id{0}; id.index < memory().pairs(); ++id.index) {
    if (!acts(singles_.world(), id, motion)) continue;
    singles_.evaluate(memory().slot_for(id), motion, poses, singles_.forces().totals);
  }
  singles_.forces().clear();
}

void PairSet::track_all(const PairIndex& index) noexcept {
  all_near_ = true;
  const auto end = [&](std::size_t list) {
    return list < index.lists.size() ? index.lists[list].first : memory().pairs();
  };
  for (std::size_t list = 0; list < index.lists.size(); ++list) {
    for (std::int32_t i = index.lists[list].first; i < end(list + 1); ++i) {
      const PairId id = index.pairs[i];
      candidates_.add(id, memory().slot_for(id), static_cast<std::int32_t>(list));
    }
    candidates_.update(static_cast<std::int32_t>(list), [](std::int32_t) { return false; });
  }
}

void PairSet::begin_tick(std::int64_t tick) noexcept {
  singles_.begin_tick(tick);
  lanes_.begin_tick();
}

bool PairSet::take(PairId id, std::int32_t list, double distance, const Motion& motion,
                   PartPoses& poses) noexcept {
  const int slot = memory().slot_for(id);
  const PairTracking& tracking = memory().tracking(slot);
  if (tracking.is_loose && tracking.list == PairMemory::none) memory().forget(slot);
  singles_.set_clearance(slot, motion, distance - singles_.reach(slot));
  if (memory().is_temporary(slot)) {
    PairTotals& totals = singles_.forces().totals;
    ++totals.crowded;
    if (singles_.is_due(slot, motion)) {
      ++totals.near;
      singles_.evaluate(slot, motion, poses, totals);
      singles_.push(slot, motion);
    }
    return false;
  }
  memory().tracking(slot).found = true;
  if (memory().add_to_list(slot, list)) candidates_.add(id, slot, list);
  return true;
}

int PairSet::end(std::int32_t list) noexcept {
  int kept = 0;
  candidates_.update(list, [&](std::int32_t slot) {
    PairTracking& tracking = memory().tracking(slot);
    const bool leaves = !tracking.found && tracking.lane < 0;
    kept += !tracking.found && !leaves ? 1 : 0;
    if (leaves) singles_.remove_from_list(slot);
    tracking.found = false;
    return leaves;
  });
  return kept;
}

void PairSet::drop(std::int32_t list) noexcept {
  candidates_.update(list, [&](std::int32_t slot) {
    singles_.remove_from_list(slot);
    return true;
  });
}

int PairSet::select(const Motion& motion, PartPoses& poses, const EvaluationLimit& limit) noexcept {
  // Pairs in lanes are evaluated several at a time: too coarse for a budget in work units.
  if (limit.is_counted()) lanes_.remove_all(poses);
  find_due(motion);
  singles_.forces().totals.near += lanes_.count();
  return plan_.plan(
      limit, lanes_.groups(), due_count_, [&](int k) { return due(k).key(); },
      [&](std::int32_t k) { return singles_.time_to_touch(due(k).slot, motion); });
}

std::int64_t PairSet::evaluate(int batch, const Motion& motion, PartPoses& poses,
                               std::int64_t spent) noexcept {
  return plan_.run(
      batch, spent,
      [&](int g, PairTotals& totals) { lanes_.evaluate_group(g, motion, poses, totals); },
      [&](int k, bool allowed, PairTotals& totals) {
        const std::int32_t slot = due(k).slot;
        if (k + ahead < due_count_) memory().prefetch(due(k + ahead).slot);
        is_near_[k] = all_near_ || is_near(slot, motion, poses) ? 1 : 0;
        if (is_near_[k] == 0) return;
        ++totals.near;
        if (!allowed && memory().answer(slot).known()) return;
        singles_.evaluate(slot, motion, poses, totals);
      });
}

void PairSet::evaluate_all(const Motion& motion, PartPoses& poses) noexcept {
  std::int64_t spent = singles_.forces().totals.iterations;
  for (int k = 0; k < plan_.batches(); ++k) spent += evaluate(k, motion, poses, spent);
}

void PairSet::finish(const Motion& motion, const PartPoses& poses) noexcept {
  plan_.finish(singles_.forces().totals, [&](int k) { return due(k).key(); });
  lanes_.push(motion);
  for_each_near_single([&](std::int32_t slot) { singles_.push(slot, motion); });
  lanes_.remove_ended(poses);
  if (plan_.limit().is_counted()) return;
  fitting_count_ = 0;
  for_each_near_single([&](std::int32_t slot) {
    if (!memory().tracking(slot).is_loose && lanes_.may_add(slot))
      fitting_[fitting_count_++] = slot;
  });
  const int more = lanes_.to_add(fitting_count_);
  if (more < 0) lanes_.remove_last(-more, poses);
  for (int i = 0; i < more; ++i) lanes_.add(fitting_[i], poses);
}

void PairSet::forget(const PartPoses& poses) noexcept {
  skip_ticks();
  if (all_near_) return;
  lanes_.remove_all(poses);
  for (const Candidate& candidate : candidates_.all()) singles_.remove_from_list(candidate.slot);
  candidates_.clear();
}

int PairSet::rehearse(const Motion& motion, PartPoses& poses, int most) noexcept {
  int done = lanes_.rehearse(most, motion, poses);
  for_each_near_single([&](std::int32_t slot) {
    if (done < most) singles_.rehearse(slot, poses), ++done;
  });
  return done;
}

Separation PairSet::separation_of(PairId id) const noexcept {
  const int slot = memory().slot_of(id);
  return slot == PairMemory::none ? Separation{} : lanes_.separation_of(slot);
}

PairExtremes PairSet::extremes_of(PairId id) const noexcept {
  return lanes_.extremes_of(id);
}

void PairSet::find_due(const Motion& motion) noexcept {
  due_count_ = 0;
  const std::span<Candidate> all = candidates_.all();
  // Every pair in a lane is a candidate: if there are no other candidates, skip the scan.
  if (all.size() == static_cast<std::size_t>(lanes_.count())) return;
  std::int32_t list = PairMemory::none;
  double travel = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].list != list) {
      list = all[i].list;
      travel = singles_.travel(all[i].slot, motion);
    }
    due_[due_count_] = static_cast<std::int32_t>(i);
    due_count_ += travel < all[i].due_at ? 0 : 1;
  }
  const int asked = std::exchange(due_count_, 0);
  for (int k = 0; k < asked; ++k) {
    const std::int32_t i = due_[k];
    const PairTracking& tracking = memory().tracking(all[i].slot);
    const bool is_due = all_near_ || singles_.is_due(all[i].slot, motion);
    all[i].due_at = is_due ? all[i].due_at : tracking.due_at;
    due_[due_count_] = i;
    due_count_ += tracking.lane < 0 && is_due ? 1 : 0;
  }
}

bool PairSet::is_near(int slot, const Motion& motion, PartPoses& poses) noexcept {
  const PairAnswer& answer = memory().answer(slot);
  if (answer.in_range) return true;
  const double reach = singles_.reach(slot);
  double clearance =
      answer.lower_bound(singles_.body_a(slot, motion), singles_.body_b(slot, motion)) - reach;
  if (!(clearance > 0.0) && clearance + singles_.lost_to_rotation(slot, motion) > 0.0) {
    clearance = singles_.lower_bound_by_shapes(slot, motion, poses) - reach;
  }
  singles_.set_clearance(slot, motion, clearance);
  if (clearance > 0.0) return false;
  singles_.clear_history(slot);
  return true;
}

}  // namespace repel::detail
