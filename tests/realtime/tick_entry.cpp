// One tick and nothing else: what is set up is reached by reference, so that no set-up code comes
// into this object. symbols.sh reads what it leaves undefined.
#include <repel/loop/tick.hpp>
#include <repel/schedule/deadline.hpp>

#include "loop/slider.hpp"

namespace repel::test {

using SliderTeleoperator = Teleoperator<SliderArm, SliderKinematics>;

/// The tick with the pairs worked through in its own thread or by others.
const TickRecord& one_tick(SliderTeleoperator& teleoperator,
                           std::chrono::nanoseconds now) noexcept {
  return teleoperator.tick(now);
}

/// What a thread of the coprocessor does in a tick.
void one_answer(detail::PairWorker& worker, Mailbox<Motion>& inbox) noexcept {
  if (inbox.take()) worker.run(inbox.newest());
}

/// What the loop around the tick adds.
void one_account(DeadlineMonitor& monitor, RunTotals& totals, const TickRecord& record) noexcept {
  monitor.record({}, {});
  totals.add(record);
}

}  // namespace repel::test
