// SPDX-License-Identifier: BSD-3-Clause
// One tick only: objects are passed by reference, so that this object file contains no set-up code.
// symbols.sh reads its undefined symbols.
#include <repel/base/mailbox.hpp>
#include <repel/cell/cell.hpp>
#include <repel/common/deadline.hpp>
#include <repel/pairs/pairs.hpp>
#include <repel/schedule/pair_team.hpp>
#include <repel/schedule/shared_tick.hpp>
#include <repel/schedule/whole_answer.hpp>

#include "loop/slider.hpp"

namespace repel::test {

/// The tick, with the pairs evaluated in its own thread or by workers.
const TickRecord& one_tick(Cell& cell, const ArmReadings& readings, const network::Command& hands,
                           std::chrono::nanoseconds now) noexcept {
  return cell.step(readings, hands, now);
}

/// The kinematics of a test arm, called by the tick.
void one_update(SliderKinematics& kinematics, std::span<const double> q) noexcept {
  kinematics.update(q);
}

/// The work of a coprocessor thread in a tick.
bool one_answer(detail::SharedTick& pairs, detail::Evaluator& evaluator) noexcept {
  return pairs.work(evaluator);
}
/// The evaluation of pairs, which the machine has compiled for several instruction sets and calls
/// through a table.
const PairForces& one_evaluation(Pairs& pairs) noexcept {
  pairs.for_each_near([](const NearPair& /*near*/) {});
  return pairs.exchange();
}
void one_rehearsal(detail::PairSet& pairs, const Motion& motion,
                   detail::PartPoses& poses) noexcept {
  (void)pairs.rehearse(motion, poses, 32);
  pairs.skip_ticks();
  pairs.forget(poses);
  pairs.for_each_answer(motion,
                        [](const NearPair& /*near*/, const detail::NearAnswer& /*answer*/) {});
}
/// The work of a thread that leads others, and its answer.
void one_whole_answer(detail::PairTeam& team, Mailbox<Motion>& inbox,
                      Mailbox<detail::WholeAnswer>& outbox) noexcept {
  if (!inbox.take()) return;
  (void)team.run(inbox.newest());
  outbox.draft().fill(team.pairs(), inbox.newest(), 1);
  outbox.post();
}

/// The additional work of the loop around the tick.
void one_account(DeadlineMonitor& monitor, RunTotals& totals, const TickRecord& record) noexcept {
  monitor.record({}, {});
  totals.add(record);
}

}  // namespace repel::test
