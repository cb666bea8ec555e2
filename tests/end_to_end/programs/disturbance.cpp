// SPDX-License-Identifier: BSD-3-Clause
// Loaded into teleop with LD_PRELOAD, this replaces a function called by every tick with one that
// performs an operation forbidden in a tick. REPEL_DISTURBANCE selects the operation.
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <mutex>
#include <string_view>

namespace {

void fault() {
  constexpr std::size_t size = 4096;
  void* const page =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  *static_cast<volatile char*>(page) = 1;
  munmap(page, size);
}

void disturb() {
  static const char* const name = std::getenv("REPEL_DISTURBANCE");
  const std::string_view kind(name == nullptr ? "" : name);
  if (kind == "allocation") {
    void* volatile memory = std::malloc(1);
    std::free(memory);
  } else if (kind == "system call") {
    getppid();
  } else if (kind == "page fault") {
    fault();
  } else if (kind == "context switch") {
    const timespec nap{0, 1000};
    nanosleep(&nap, nullptr);
  } else if (kind == "lock") {
    static std::mutex mutex;
    const std::lock_guard<std::mutex> lock(mutex);
  }
}

}  // namespace

// A tick asks for the time before and after its network.
std::chrono::steady_clock::time_point std::chrono::steady_clock::now() noexcept {
  disturb();
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return time_point(seconds(now.tv_sec) + nanoseconds(now.tv_nsec));
}
