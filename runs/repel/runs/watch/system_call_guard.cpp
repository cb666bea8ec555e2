// SPDX-License-Identifier: BSD-3-Clause
// By hand: a byte in memory switches the dispatch; a filter of libseccomp cannot be lifted again.
#include <repel/runs/watch/system_call_guard.hpp>

#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#if __has_include(<valgrind/valgrind.h>)
#include <valgrind/valgrind.h>
#endif

#if defined(__x86_64__) && defined(PR_SET_SYSCALL_USER_DISPATCH) && !defined(REPEL_SANITIZED)
#define REPEL_COUNTS_SYSTEM_CALLS 1
#else
#define REPEL_COUNTS_SYSTEM_CALLS 0
#endif

namespace repel::runs {
namespace {

constexpr unsigned char let_pass = 0;
constexpr unsigned char hand_over = 1;

// Globals, because the kernel and a signal handler take no parameters.
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
thread_local volatile unsigned char selector = let_pass;
thread_local bool armed = false;
thread_local Pauses pauses = Pauses::none;
std::atomic<std::int64_t> counted{0};
std::atomic<bool> refused{REPEL_COUNTS_SYSTEM_CALLS == 0};
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

/// Ends the watch before the thread exits, since its exit is not part of a tick.
struct EndOfWatch {
  EndOfWatch() = default;
  EndOfWatch(const EndOfWatch&) = delete;
  EndOfWatch& operator=(const EndOfWatch&) = delete;
  ~EndOfWatch() { selector = let_pass; }
};

#if REPEL_COUNTS_SYSTEM_CALLS

bool is_pause(long number) noexcept {
  return (pauses != Pauses::none && number == SYS_sched_yield) ||
         (pauses == Pauses::naps && number == SYS_clock_nanosleep);
}

/// SIGSYS handler, called instead of a system call, with the registers of the call.
void on_system_call(int /*signal*/, siginfo_t* /*info*/, void* context) noexcept {
  selector = let_pass;
  greg_t* registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  if (is_pause(registers[REG_RAX])) {
    const int error = errno;
    const long result = syscall(registers[REG_RAX], registers[REG_RDI], registers[REG_RSI],
                                registers[REG_RDX], registers[REG_R10]);
    registers[REG_RAX] = result == -1 ? -errno : result;
    errno = error;
    selector = hand_over;
    return;
  }
  counted.fetch_add(1, std::memory_order_relaxed);
  constexpr int length_of_instruction = 2;
  registers[REG_RIP] -= length_of_instruction;  // repeats the call on return, and lets it through
}

/// Installs the handler. Returns the address of the signal restorer, whose own system call must be
/// let through (rt_sigreturn); null on failure.
void* install_handler() noexcept {
  struct sigaction action = {};
  action.sa_sigaction = on_system_call;
  action.sa_flags = SA_SIGINFO;
  if (sigaction(SIGSYS, &action, nullptr) != 0) return nullptr;
  struct {  // layout of the kernel's sigaction
    void* handler = nullptr;
    unsigned long flags = 0;
    void* restorer = nullptr;
    unsigned long mask = 0;
  } kept;
  syscall(SYS_rt_sigaction, SIGSYS, nullptr, &kept, sizeof kept.mask);
  return kept.restorer;
}

bool is_under_valgrind() noexcept {
#ifdef RUNNING_ON_VALGRIND
  return RUNNING_ON_VALGRIND != 0;
#else
  return false;
#endif
}

bool arm_this_thread() noexcept {
  if (is_under_valgrind()) return false;  // its own system calls would be handed over, too
  constexpr unsigned long length_of_restorer = 16;
  void* const restorer = install_handler();
  return restorer != nullptr && prctl(PR_SET_SYSCALL_USER_DISPATCH, PR_SYS_DISPATCH_ON, restorer,
                                      length_of_restorer, &selector) == 0;
}

#else

bool arm_this_thread() noexcept {
  return false;
}

#endif

}  // namespace

SystemCallGuard::SystemCallGuard() noexcept {
  if (!armed) refused = true;
  selector = armed ? hand_over : let_pass;
}
SystemCallGuard::~SystemCallGuard() {
  selector = let_pass;
}

void SystemCallGuard::arm(Pauses allowed) noexcept {
  pauses = allowed;
  static thread_local const EndOfWatch end;
  if (armed) return;
  armed = arm_this_thread();
  if (!armed) refused = true;
}

void SystemCallGuard::watch_this_thread() noexcept {
  selector = armed ? hand_over : let_pass;
}

std::int64_t SystemCallGuard::calls() noexcept {
  return refused ? -1 : counted.load(std::memory_order_relaxed);
}

}  // namespace repel::runs
