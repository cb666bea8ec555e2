#include "command_line.hpp"

#include <charconv>
#include <csignal>
#include <repel/base/setup_error.hpp>

namespace repel::host {
namespace {

// A signal handler has nothing else to write to.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<bool> interrupted{false};

/// A round number as people write it, without an exponent.
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
            return text + " is not a number from " + in_full(low) + " to " + in_full(high);
          },
          in_full(low) + " to " + in_full(high), "between"};
}

const std::atomic<bool>& interruption() {
  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  return interrupted;
}

Output::Output(const std::string& path) : path_(path) {
  if (path.empty()) return;
  file_.open(path);
  check();
}

void Output::close() {
  file_.close();
  check();
}

void Output::check() const {
  if (!file_) throw SetupError("cannot write the file", path_);
}

}  // namespace repel::host
