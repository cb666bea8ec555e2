// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/command_line.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <memory>
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

/// How many letters are to be added, left out, replaced, or swapped with the next one, to get from
/// one word to another.
std::size_t steps_between(const std::string& from, const std::string& to) {
  std::vector<std::vector<std::size_t>> steps(from.size() + 1,
                                              std::vector<std::size_t>(to.size() + 1));
  for (std::size_t i = 0; i <= from.size(); ++i) {
    for (std::size_t j = 0; j <= to.size(); ++j) {
      std::size_t& fewest = steps[i][j] = i + j;
      if (i == 0 || j == 0) continue;
      const std::size_t replaced = steps[i - 1][j - 1] + (from[i - 1] == to[j - 1] ? 0 : 1);
      fewest = std::min({steps[i - 1][j] + 1, steps[i][j - 1] + 1, replaced});
      const bool is_swap = i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1];
      if (is_swap) fewest = std::min(fewest, steps[i - 2][j - 2] + 1);
    }
  }
  return steps.back().back();
}

/// Breaks the descriptions that CLI11 leaves on one line.
class Help : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_option_desc(const CLI::Option* option) const override {
    constexpr std::size_t width = 70;  // beside the 30 columns of the names
    std::string text = option->get_description();
    for (std::size_t line = 0; text.size() > line + width;) {
      const std::size_t end = text.rfind(' ', line + width);
      if (end == std::string::npos || end < line) break;  // a word that is longer than a line
      text[end] = '\n';
      line = end + 1;
    }
    return text;
  }
};

/// What is wrong with an option that the command given does not have.
std::string complaint_about(const CLI::App& app, const std::string& option) {
  std::string owners;
  std::vector<std::string> names;
  std::vector<const CLI::App*> all = app.get_subcommands({});
  all.push_back(&app);
  for (const CLI::App* each : all) {
    for (const CLI::Option* known : each->get_options()) {
      if (known->nonpositional()) names.push_back(known->get_name());
    }
    if (each->get_option_no_throw(option) == nullptr) continue;
    owners += (owners.empty() ? "" : ", ") + app.get_name() + " " + each->get_name();
  }
  if (!owners.empty()) return option + " belongs to: " + owners;
  const std::string meant = closest(option, names);
  return "unknown option " + option + (meant.empty() ? "" : "; did you mean " + meant + "?");
}

std::string complaint(const CLI::App* app, const CLI::Error& error) {
  std::string what = error.what();
  const bool is_unknown = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  for (const std::string& word : app->remaining(true)) {
    if (!is_unknown || !word.starts_with('-')) continue;
    what = complaint_about(*app, word.substr(0, word.find('=')));
    break;
  }
  return app->get_name() + ": " + what + "\nRun with --help for more information.\n";
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

std::string closest(const std::string& word, std::span<const std::string> words) {
  const auto steps = [&](const std::string& each) { return steps_between(word, each); };
  const auto best = std::ranges::min_element(words, {}, steps);
  const std::size_t few = std::max<std::size_t>(1, word.size() / 3);
  return best != words.end() && steps(*best) <= few ? *best : std::string();
}

void refuse_empty(const CLI::App& app) {
  std::vector<const CLI::App*> all = app.get_subcommands({});
  all.push_back(&app);
  for (const CLI::App* each : all) {
    for (const CLI::Option* option : each->get_options()) {
      for (const std::string& value : option->results()) {
        if (!value.empty()) continue;
        throw CLI::ValidationError(option->get_name(),
                                   "the value is empty; allowed: one with characters");
      }
    }
  }
}

void set_up(CLI::App& app) {
  app.formatter(std::make_shared<Help>());
  app.failure_message(complaint);
  app.set_version_flag("--version", version_of(app.get_name().c_str()));
}

}  // namespace repel::host
