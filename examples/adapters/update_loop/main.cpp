// SPDX-License-Identifier: BSD-3-Clause
// A controller in an update loop drives three rails into a wall that exists only in the model, is
// deactivated there, and activated again.
#include <cstdio>

#include <gantry.hpp>

#include "gantry_controller.hpp"

int main() {
  adapters::GantryController controller;
  stand_in::Gantry gantry(controller);  // in place of controller manager and hardware
  if (!gantry.configure()) return 1;
  repel::network::HandInput hand;
  hand.ball.linear = {0.1, 0.0, 0.0};  // 100 mm/s towards the wall
  for (int run = 0; run < 2; ++run) {
    if (!gantry.activate()) return 1;
    for (int k = 0; k <= 3000; ++k) {
      controller.lead(hand);  // a subscription of your own does this
      gantry.cycle();
      const repel::TickRecord& tick = *controller.record();
      if (k % 500 == 0 && tick.pairs.near > 0) {
        std::printf("%.1f s: %5.1f mm from the wall, %4.1f N\n", tick.time,
                    1e3 * tick.pairs.nearest, tick.virtual_force.force.norm());
      }
    }
    gantry.deactivate();
    gantry.cycles(1000);  // the brakes hold the arm
    std::printf("deactivated, at x = %.3f m\n", gantry.q[0]);
  }
}
