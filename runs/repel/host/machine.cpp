// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/machine.hpp>

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <repel/schedule/instruction_set.hpp>

#include "commit.hpp"

namespace repel::host {
namespace {

constexpr int priority = 80;

#if defined(__clang__)
constexpr const char* compiler_name = __VERSION__;
#else
constexpr const char* compiler_name = "g++ " __VERSION__;
#endif

bool make_fifo(int level) noexcept {
  sched_param parameter{};
  parameter.sched_priority = level;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter) == 0;
}

/// Keeps idle processors out of deep sleep states while the program runs: a tick on a processor
/// that has just woken is several times slower. The kernel honours the request while the file is
/// open.
bool stay_awake() noexcept {
  static const bool granted = [] {
    const int file = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
    if (file < 0) return false;
    const std::int32_t microseconds = 0;
    return write(file, &microseconds, sizeof microseconds) == sizeof microseconds;
  }();
  return granted;
}

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

Grant request_real_time() noexcept {
  Grant grant;
  grant.priority = make_fifo(priority) ? priority : 0;
  grant.memory_locked = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  grant.kept_awake = stay_awake();
  return grant;
}

int follow_real_time() noexcept {
  return make_fifo(priority - 1) ? priority - 1 : 0;
}

std::vector<int> allowed_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> processors;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return {0};
  for (int i = 0; i < CPU_SETSIZE; ++i) {
    if (CPU_ISSET(i, &set)) processors.push_back(i);
  }
  return processors;
}

bool run_on(const std::vector<int>& processors) noexcept {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int processor : processors) CPU_SET(processor, &set);
  return sched_setaffinity(0, sizeof set, &set) == 0;
}

void clear_own_processor() {
  std::vector<int> others = allowed_processors();
  std::erase(others, sched_getcpu());
  if (others.empty()) return;
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int processor : others) CPU_SET(processor, &set);
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", error)) {
    const int thread = std::atoi(entry.path().filename().c_str());
    if (thread == gettid() || sched_getscheduler(thread) != SCHED_OTHER) continue;
    (void)sched_setaffinity(thread, sizeof set, &set);
  }
}

std::string to_text(const Grant& grant) {
  return (grant.priority > 0 ? "SCHED_FIFO " + std::to_string(grant.priority)
                             : "SCHED_OTHER (SCHED_FIFO refused)") +
         (grant.memory_locked ? ", memory locked" : ", memory not locked") +
         (grant.kept_awake ? ", processors kept awake" : ", processors may sleep");
}

Machine describe_machine(const std::string& scheduler) {
  utsname kernel{};
  uname(&kernel);
  return {cpu_model(),
          std::string(kernel.sysname) + " " + kernel.release + " " + kernel.machine,
          scheduler,
          compiler_name,
          std::string(instruction_set()),
          commit};
}

}  // namespace repel::host
