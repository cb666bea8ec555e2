#include "machine.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/utsname.h>

#include <fstream>

#include "commit.hpp"
#include "heap_guard.hpp"

namespace repel::teleop {
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

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

std::string request_real_time() {
  const std::string locked =
      mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? "memory locked" : "memory not locked";
  if (make_fifo(priority)) return "SCHED_FIFO " + std::to_string(priority) + ", " + locked;
  return "SCHED_OTHER (SCHED_FIFO refused), " + locked;
}

void follow_real_time(int /*index*/) noexcept {
  HeapGuard::watch_this_thread();
  (void)make_fifo(priority - 1);
}

Machine describe_machine(const std::string& scheduler) {
  utsname kernel{};
  uname(&kernel);
  return {cpu_model(), std::string(kernel.sysname) + " " + kernel.release + " " + kernel.machine,
          scheduler, compiler_name, commit};
}

}  // namespace repel::teleop
