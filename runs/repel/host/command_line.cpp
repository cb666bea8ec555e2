// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/command_line.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <repel/base/setup_error.hpp>
#include <system_error>

#include "commit.hpp"

namespace repel::host {
namespace {

// Globals, because a signal handler has no other way to pass on what happened.
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<bool> interrupted{false};
std::atomic<bool> insisted{false};
std::atomic<std::int64_t> first_signal_ns{0};
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

/// Handles SIGINT, SIGTERM and SIGHUP. Signals within 0.1 s of the first count as the same request:
/// `timeout` sends its signal twice in a row, a terminal that closes sends SIGHUP as well.
void note_signal(int signal) {
  constexpr std::int64_t same_wish_ns = 100'000'000;
  const std::int64_t now = std::chrono::steady_clock::now().time_since_epoch().count();
  std::int64_t first = 0;
  if (first_signal_ns.compare_exchange_strong(first, now)) {
    interrupted = true;
  } else if (signal != SIGHUP && now - first >= same_wish_ns) {
    insisted = true;
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
  }
}

/// A number in fixed notation, without an exponent.
std::string in_full(double value) {
  char digits[32];
  const auto end =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed).ptr;
  return {digits, end};
}

}  // namespace

CLI::Validator between(double low, double high) {
  return {[low, high](const std::string& text) {
            double value = 0.0;
            const bool number = CLI::detail::lexical_cast(text, value);
            if (number && value >= low && value <= high) return std::string();
            constexpr std::size_t readable = 24;
            const std::string found =
                number && text.size() > readable ? repel::to_text(value) : text;
            return found + " is not a number from " + in_full(low) + " to " + in_full(high);
          },
          in_full(low) + " to " + in_full(high), "between"};
}

const std::atomic<bool>& interruption() {
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
  if (std::signal(SIGHUP, note_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  return interrupted;
}

const std::atomic<bool>& insistence() {
  return insisted;
}

Output::Output(const std::string& path) : path_(path), part_(path) {
  if (path.empty()) return;
  errno = 0;
  file_.open(part_.name(), std::ios::binary | std::ios::app);
  check();
}

std::ostream& Output::stream() {
  errno = 0;
  return file_;
}

void Output::close() {
  file_.close();
  check();
  part_.put_in_place();
}

void Output::check() const {
  if (file_) return;
  std::string what = "cannot write the file";
  if (errno != 0) what += ": " + std::generic_category().message(errno);
  throw SetupError(what, path_);
}

bool has_printed() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return true;
  struct stat out {};
  return fstat(STDOUT_FILENO, &out) == 0 && (S_ISFIFO(out.st_mode) || S_ISSOCK(out.st_mode));
}

std::string version_of(const char* name) {
  return std::string(name) + " " + REPEL_VERSION + ", commit " + commit;
}

}  // namespace repel::host
