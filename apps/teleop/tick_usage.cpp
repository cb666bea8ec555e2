#include "tick_usage.hpp"

#include <sys/mman.h>

namespace repel::teleop {

TickUsage::TickUsage() noexcept : locked_(mlockall(MCL_CURRENT) == 0) {}

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

}  // namespace repel::teleop
