// SPDX-License-Identifier: BSD-3-Clause
// A tick that is shown to a page and driven by it neither allocates nor makes a system call.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include <repel/host/heap_guard.hpp>
#include <repel/runs/watch/system_call_guard.hpp>

#include "support/web_page.hpp"
#include "visual/gantry.hpp"

namespace repel::test {
namespace live_view_guard_test {

using host::HeapGuard;
using runs::SystemCallGuard;

TEST(LiveView, TheTickNeitherAllocatesNorMakesASystemCall) {
  SystemCallGuard::arm(runs::Pauses::none);
  GantryLoop loop;
  loop.own.hand.ball.linear = Vec3(0.15, 0.0, 0.0);
  visual::LiveView view(loop.cell, visual::scene_info_of(loop.cell, "gantry"), free_port());
  std::atomic<bool> over{false};
  std::atomic<int> pictures{0};
  const std::uint16_t port = port_of(view.url());
  std::jthread reader([&] {
    WebPage page(port);
    (void)page.say(R"({"type": "take"})");
    while (!over) {
      (void)page.say(R"({"type": "servo_cv", "linear": [0.15, 0, 0], "angular": [0, 0, 0],)"
                     R"( "frame": "tool", "clutch": true})");
      const auto text = page.next(std::chrono::milliseconds(20));
      if (text && text->find(R"("type":"frame")") != std::string::npos) ++pictures;
    }
  });
  const std::int64_t allocated = HeapGuard::allocations();
  const std::int64_t called = SystemCallGuard::calls();
  int driven = 0;
  const auto end = std::chrono::steady_clock::now() + patience;
  while ((pictures < 20 || driven < 1000) && std::chrono::steady_clock::now() < end) {
    {
      const HeapGuard heap;
      const SystemCallGuard calls;
      (void)loop.step(view);
    }
    driven += loop.is_driven ? 1 : 0;
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  over = true;
  EXPECT_GE(pictures, 20);
  EXPECT_GE(driven, 1000) << "the page drove";
  EXPECT_EQ(HeapGuard::allocations(), allocated);
  EXPECT_EQ(SystemCallGuard::calls(), called);
}

}  // namespace live_view_guard_test
}  // namespace repel::test
