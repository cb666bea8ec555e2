// SPDX-License-Identifier: BSD-3-Clause
#include "program.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "../harness.hpp"
#include "rival.hpp"

namespace repel::bench {

namespace {

/// Prints progress to stderr; the table follows at the end. The file gets the last repetition of
/// each measurement, whose percentiles are over all repetitions.
class Progress final : public benchmark::BenchmarkReporter {
 public:
  explicit Progress(std::size_t count) : count_(static_cast<int>(count)) {}
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    if (runs.empty() || runs.back().run_type != Run::RT_Iteration) return;
    failed_ = failed_ || runs.back().error_occurred;
    if (runs.back().error_occurred) {
      std::fprintf(stderr, "%s: %s\n", runs.back().benchmark_name().c_str(),
                   runs.back().error_message.c_str());
    }
    std::fprintf(stderr, "\r%d of %d measured", ++measured_, count_);
  }
  void Finalize() override { std::fprintf(stderr, "\n"); }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  int count_;
  int measured_ = 0;
  bool failed_ = false;
};

class LastRepetition final : public benchmark::JSONReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    if (!runs.empty() && runs.back().run_type == Run::RT_Iteration) {
      JSONReporter::ReportRuns({runs.back()});
    }
  }
};

}  // namespace

bool Arguments::has(const std::string& flag) {
  return std::erase(words_, flag) > 0;
}

std::string Arguments::value(const std::string& flag, const std::string& otherwise) {
  return taken(flag).value_or(otherwise);
}

std::optional<std::string> Arguments::taken(const std::string& flag) {
  const auto found = std::find(words_.begin(), words_.end(), flag);
  if (found == words_.end()) return std::nullopt;
  if (found + 1 == words_.end()) throw std::invalid_argument(flag + " needs a value");
  std::string value = found[1];
  words_.erase(found, found + 2);
  return value;
}

void Arguments::end() const {
  if (!words_.empty()) {
    throw std::invalid_argument("unknown argument: " + words_.front() + " (see --help)");
  }
}

QueryOptions query_options(Arguments arguments, double seconds) {
  QueryOptions options{split(arguments.value("--rival", "")), arguments.has("--quick"),
                       arguments.has("--list"), arguments.number("--seconds", seconds, 1e-3, 1e6)};
  arguments.end();
  return options;
}

std::vector<std::string> split(const std::string& names) {
  std::vector<std::string> parts;
  std::istringstream stream(names);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

bool is_chosen(const std::vector<std::string>& chosen, const std::string& name) {
  return chosen.empty() || std::find(chosen.begin(), chosen.end(), name) != chosen.end();
}

void check_names(const char* what, const std::vector<std::string>& names,
                 const std::vector<std::string>& known) {
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw std::invalid_argument("there is no " + std::string(what) + " " + name +
                                  " here (see --list)");
    }
  }
}

void enlist(const std::string& title, double seconds,
            const std::function<void(benchmark::State&)>& run) {
  constexpr int repetitions = 10;
  benchmark::RegisterBenchmark(title.c_str(), run)
      ->UseManualTime()
      ->Unit(benchmark::kNanosecond)
      ->Repetitions(repetitions)
      ->MinTime(seconds / repetitions);
}

bool run_enlisted(std::size_t count, bool to_file) {
  Progress progress(count);
  LastRepetition file;
  benchmark::RunSpecifiedBenchmarks(&progress, to_file ? &file : nullptr);
  return !progress.failed();
}

std::string build_line() {
  const Build build = this_build();
  return build.machine + "; " + build.compiler + "; " + build.simd + "; flags " + build.flags +
         "; commit " + build.commit;
}

int start(int argc, char** argv, const char* about,
          int (*run)(const Arguments& arguments, bool to_file)) {
  bool to_file = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--help") == 0) return std::printf("%s", about) < 0 ? 1 : 0;
    to_file = to_file || std::strcmp(argv[i], "--json") == 0;
  }
  std::stable_sort(libraries().begin(), libraries().end(), [](const auto& a, const auto& b) {
    return a.ours != b.ours ? a.ours : !a.ours && a.name < b.name;
  });
  try {
    std::vector<char*> arguments(argv, argv + argc);
    // Interleaved, so that disturbances of the machine affect all libraries alike.
    std::string interleaved = "--benchmark_enable_random_interleaving=true";
    arguments.insert(arguments.begin() + 1, interleaved.data());
    const int code = run(Arguments(initialize(argc + 1, arguments.data())), to_file);
    std::fflush(nullptr);
    // FCL and Coal each link their own octomap, whose destructors collide at exit.
    std::quick_exit(code);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}

std::vector<Library>& libraries() {
  static std::vector<Library> all;
  return all;
}

}  // namespace repel::bench
