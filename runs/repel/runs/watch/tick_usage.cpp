// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/watch/tick_usage.hpp>

#include <sys/mman.h>

#include <array>
#include <cstddef>

namespace repel::runs {
namespace {

/// What the caller calls later finds its stack in memory, however deep the set-up has been.
[[gnu::noinline]] bool touch_stack() noexcept {
  constexpr std::size_t depth = std::size_t{256} * 1024;  // [bytes] many times what a tick needs
  constexpr std::size_t page = 4096;
  std::array<volatile char, depth> stack;  // NOLINT(*-member-init): only one byte of each page
  for (std::size_t i = 0; i < depth; i += page) stack[i] = 1;
  return stack[0] != 0;
}

}  // namespace

TickUsage::TickUsage(bool lock) noexcept
    : locked_(lock && touch_stack() && mlockall(MCL_CURRENT) == 0) {}

void TickUsage::begin() noexcept {
  getrusage(RUSAGE_THREAD, &before_);
}

void TickUsage::end() noexcept {
  rusage now{};
  getrusage(RUSAGE_THREAD, &now);
  faults_ += now.ru_minflt - before_.ru_minflt + now.ru_majflt - before_.ru_majflt;
  voluntary_ += now.ru_nvcsw - before_.ru_nvcsw;
  involuntary_ += now.ru_nivcsw - before_.ru_nivcsw;
}

std::int64_t TickUsage::page_faults() const noexcept {
  return locked_ ? faults_ : -1;
}

}  // namespace repel::runs
