#include "machine.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cstdint>
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

/// Keeps idle processors from sleeping deeply for as long as the program runs: a tick that begins
/// on a processor just woken is several times slower. The kernel holds it while the file is open.
bool stay_awake() noexcept {
  const int file = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  if (file < 0) return false;
  const std::int32_t microseconds = 0;
  return write(file, &microseconds, sizeof microseconds) == sizeof microseconds;
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
  std::string granted = make_fifo(priority) ? "SCHED_FIFO " + std::to_string(priority)
                                            : "SCHED_OTHER (SCHED_FIFO refused)";
  const bool locked = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  granted += locked ? ", memory locked" : ", memory not locked";
  granted += stay_awake() ? ", processors kept awake" : ", processors may sleep";
  return granted;
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
