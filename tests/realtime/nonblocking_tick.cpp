// SPDX-License-Identifier: BSD-3-Clause
// The tick called from a function declared nonblocking: RealtimeSanitizer aborts this program at
// the first call in it that might block. Built and run by realtime_sanitizer.sh.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "loop/slider.hpp"

namespace repel::test {
namespace {

/// The only function declared nonblocking; everything it calls is checked at run time.
double one_tick(SliderCell& cell, std::chrono::nanoseconds elapsed, bool break_the_promise) noexcept
    [[clang::nonblocking]] {
  if (break_the_promise) {
    void* volatile memory = std::malloc(1);
    std::free(memory);
  }
  return cell.tick(elapsed).virtual_force.force.norm();
}

double run(int threads, bool break_the_promise) {
  CoprocessorOptions options;
  options.threads = threads;
  options.patience = std::chrono::milliseconds(1);
  options.budget.wall = std::chrono::milliseconds(1);
  SliderCell cell(push(2.0, 0.1), {.coprocessor = options, .effort_limit = 100.0, .walls = 200});
  double peak = 0.0;
  for (int tick = 0; tick < 700; ++tick) {
    cell.arm.spoilt = tick > 600 && tick < 610;  // covers the code paths of a fault, too
    const bool stuck = tick == 650;
    peak = std::max(peak, one_tick(cell, stuck ? std::chrono::nanoseconds(0) : SliderCell::period,
                                   break_the_promise));
  }
  return peak;
}

}  // namespace
}  // namespace repel::test

int main(int argc, char** argv) {
  const bool break_the_promise = argc == 2 && std::strcmp(argv[1], "--canary") == 0;
  for (const int threads : {0, 2}) {
    const double peak = repel::test::run(threads, break_the_promise);
    std::printf("%d threads: peak force %.1f N\n", threads, peak);
    if (!(peak > 10.0)) return 1;
  }
  return 0;
}
