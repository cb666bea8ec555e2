// SPDX-License-Identifier: BSD-3-Clause
// The counters around the tick: they detect the forbidden operations, and they stay at zero for the
// tick and for the work of the coprocessor's threads.
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <thread>

#include <repel/host/heap_guard.hpp>
#include <repel/runs/watch/system_call_guard.hpp>
#include <repel/runs/watch/tick_usage.hpp>
#include <repel/schedule/pair_team.hpp>

#include "loop/slider.hpp"
#include "pairs/boxes.hpp"
#include "realtime/clock.hpp"

namespace repel {
namespace tick_guard_test {

using namespace std::chrono_literals;
using host::HeapGuard;
using runs::Pauses;
using runs::SystemCallGuard;
using runs::TickUsage;

/// Number of the program's guarded sections that made a system call while `work` ran.
template <class Work>
std::int64_t calls_of(Work&& work) {
  const std::int64_t before = SystemCallGuard::calls();
  work();
  return SystemCallGuard::calls() - before;
}

class SystemCalls : public testing::Test {
 protected:
  void SetUp() override {
    SystemCallGuard::arm(Pauses::none);
    if (SystemCallGuard::calls() < 0) {
      GTEST_SKIP() << "no Syscall User Dispatch: it takes Linux 5.11 on x86-64 and no sanitizer";
    }
  }
};

TEST_F(SystemCalls, AreCountedOnceASectionAndMadeAllTheSame) {
  const pid_t parent = getppid();
  const std::int64_t counted = calls_of([&] {
    for (int i = 0; i < 3; ++i) {
      const SystemCallGuard guard;
      EXPECT_EQ(syscall(SYS_getppid), parent);
      EXPECT_EQ(syscall(SYS_getppid), parent);
    }
    EXPECT_EQ(syscall(SYS_getppid), parent);  // not under guard
  });
  EXPECT_EQ(counted, 3);
}

TEST_F(SystemCalls, ByWhichAThreadGivesWayAreCountedUnlessAllowed) {
  const struct {
    Pauses allowed;
    int yields, naps;
  } cases[] = {{Pauses::none, 1, 1}, {Pauses::yields, 0, 1}, {Pauses::naps, 0, 0}};
  for (const auto& expected : cases) {
    SystemCallGuard::arm(expected.allowed);
    const auto yield = [] {
      const SystemCallGuard guard;
      sched_yield();
    };
    const auto nap = [] {
      const SystemCallGuard guard;
      std::this_thread::sleep_for(1us);
    };
    EXPECT_EQ(calls_of(yield), expected.yields);
    EXPECT_EQ(calls_of(nap), expected.naps);
  }
  // Allowed calls do not end the monitoring.
  const auto nap_and_call = [] {
    const SystemCallGuard guard;
    const auto begin = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(1ms);
    EXPECT_GE(std::chrono::steady_clock::now() - begin, 1ms);
    getppid();
  };
  EXPECT_EQ(calls_of(nap_and_call), 1);
}

TEST_F(SystemCalls, OfAWatchedThreadAreCountedButNotThoseOfItsEnd) {
  for (const int calls : {0, 1}) {
    const std::int64_t counted = calls_of([calls] {
      std::thread([calls] {
        SystemCallGuard::arm(Pauses::naps);
        SystemCallGuard::watch_this_thread();
        for (int i = 0; i < 3; ++i) std::this_thread::sleep_for(1us);
        for (int i = 0; i < calls; ++i) getppid();
      }).join();
    });
    EXPECT_EQ(counted, calls);
  }
}

/// Reading the clock used for budgets and timeouts must not be a system call.
class SystemCallsOfTheTick : public SystemCalls {
 protected:
  void SetUp() override {
    SystemCalls::SetUp();
    if (IsSkipped()) return;
    const std::string source = test::clock_in_the_kernel();
    if (!source.empty()) GTEST_SKIP() << "asking the time is a system call here, clock " << source;
  }
};

TEST_F(SystemCallsOfTheTick, AreNone) {
  for (const int threads : {0, 2}) {
    SystemCallGuard::arm(threads == 0 ? Pauses::none : Pauses::yields);
    CoprocessorOptions options;
    options.threads = threads;
    options.lock_step = true;
    test::SliderCell cell(test::push(2.0, 0.1),
                          {.coprocessor = options, .effort_limit = 100.0, .walls = 200});
    const std::int64_t counted = calls_of([&] {
      for (int tick = 0; tick < 700; ++tick) {
        cell.arm.spoilt = tick > 600 && tick < 610;  // covers the code paths of a fault, too
        const SystemCallGuard guard;
        cell.tick(tick == 650 ? 0ns : cell.period);
      }
    });
    EXPECT_EQ(counted, 0) << threads << " threads";
  }
}

TEST_F(SystemCallsOfTheTick, AreNoneWhenItWaitsForThreadsByTheClock) {
  CoprocessorOptions options;
  options.threads = 2;
  options.patience = 10us;  // so that late answers occur, too
  options.on_thread_start = [](int) noexcept {
    SystemCallGuard::arm(Pauses::naps);
    SystemCallGuard::watch_this_thread();
  };
  const std::int64_t counted = calls_of([&] {
    test::SliderCell cell(test::push(2.0, 0.1),
                          {.coprocessor = options, .effort_limit = 100.0, .walls = 200});
    for (int tick = 0; tick < 100; ++tick) {
      const SystemCallGuard guard;
      cell.tick();
    }
  });
  EXPECT_EQ(counted, 0);
}

TEST_F(SystemCallsOfTheTick, AreNoneInTheWorkOfACoprocessorThreadWhateverItsBudget) {
  for (const Budget& budget : {Budget{}, Budget{.work_units = 30}, Budget{.wall = 10us}}) {
    test::Boxes boxes(4, 60, {.range = 0.1}, 3);
    CoprocessorOptions options;
    options.budget = budget;
    detail::PairTeam team(boxes.world, std::make_shared<detail::PairIndex>(boxes.world),
                          detail::PartPoses(boxes.world), options, 0, 0, 0.0);
    team.prime(boxes.world.motion());
    const std::int64_t counted = calls_of([&] {
      for (int tick = 0; tick < 200; ++tick) {
        boxes.move();
        const SystemCallGuard guard;
        (void)team.run(boxes.world.motion());
      }
    });
    EXPECT_EQ(counted, 0);
  }
}

TEST(Usage, CountsAPageFault) {
#ifdef REPEL_SANITIZED
  GTEST_SKIP() << "a sanitizer's shadow memory has faults of its own";
#endif
  TickUsage usage(true);
  if (usage.page_faults() < 0) GTEST_SKIP() << "memory cannot be locked: ulimit -l unlimited";
  const std::size_t size = 4096;
  void* const page =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(page, MAP_FAILED);
  for (const int faults : {1, 0}) {  // the first access, and another
    const std::int64_t before = usage.page_faults();
    usage.begin();
    *static_cast<volatile char*>(page) = 1;
    usage.end();
    EXPECT_EQ(usage.page_faults() - before, faults);
  }
  munmap(page, size);
}

TEST(Usage, CountsAContextSwitch) {
  TickUsage usage(true);
  usage.begin();
  usage.end();
  EXPECT_EQ(usage.voluntary_switches(), 0);
  usage.begin();
  std::this_thread::sleep_for(1ms);
  usage.end();
  EXPECT_GE(usage.voluntary_switches(), 1);
}

TEST(Usage, LeavesOutWhatHappensBetweenTicks) {
  TickUsage usage(true);
  for (int i = 0; i < 3; ++i) {
    usage.begin();
    usage.end();
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(usage.voluntary_switches(), 0);
}

TEST(Heap, GuardCountsAnAllocation) {
  if (HeapGuard::allocations() < 0) GTEST_SKIP() << "a sanitizer owns malloc";
  const std::int64_t before = HeapGuard::allocations();
  int* volatile outside = new int(1);
  {
    const HeapGuard guard;
    int* volatile inside = new int(1);
    delete inside;
  }
  delete outside;
  EXPECT_EQ(HeapGuard::allocations() - before, 1);
}

}  // namespace tick_guard_test
}  // namespace repel
