// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/coprocessor_options.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include <repel/base/setup_error.hpp>
#include <repel/schedule/coprocessor.hpp>

#include "pairs/boxes.hpp"

namespace repel {
namespace coprocessor_options_test {

using namespace std::chrono_literals;

TEST(CoprocessorOptions, RefusesMoreThreadsThanTheLimit) {
  World world(Capacities{.threads = 2});
  CoprocessorOptions options;
  for (const int threads : {-1, 3}) {
    options.threads = threads;
    EXPECT_THROW(Coprocessor(world, options), SetupError) << threads;
  }
}

std::atomic<unsigned> started{0};

TEST(CoprocessorOptions, CallsTheStartFunctionInEachWorker) {
  started = 0;
  const test::Boxes boxes(4, 48, {}, 1);  // enough pairs for three threads
  CoprocessorOptions options;
  options.threads = 3;
  options.lock_step = true;
  options.on_thread_start = [](int index) noexcept { started |= 1U << index; };
  Coprocessor coprocessor(boxes.world, options);
  const auto until = std::chrono::steady_clock::now() + 10s;
  while (started != 7U && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(started, 7U);
}

TEST(CoprocessorOptions, ModesHaveNames) {
  for (const CoprocessorMode mode : {CoprocessorMode::together, CoprocessorMode::beside}) {
    EXPECT_EQ(coprocessor_mode_named(to_text(mode)), mode);
  }
  EXPECT_FALSE(coprocessor_mode_named("elsewhere"));
}

}  // namespace coprocessor_options_test
}  // namespace repel
