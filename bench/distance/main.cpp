/// @file
/// Distance queries side by side: ours and those of other libraries, on the same tasks, checked
/// against exact answers before their time counts.

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <sstream>

#include "../main.hpp"
#include "table.hpp"

namespace repel::bench {

namespace {

constexpr const char* about =
    "distance_bench: distance queries of repel and other libraries, side by side.\n"
    "Every answer is checked before its time counts; exit code 1 when one of ours is wrong.\n"
    "\n"
    "  --task A,B    only these tasks; default all\n"
    "  --rival A,B   only these libraries; default all that were built\n"
    "  --sweep       run time against error too: tolerances 1e-2 to 1e-14\n"
    "  --quick       fewer pairs, less time: a look, not a result\n"
    "  --seconds S   time for each library on each task; default 0.5\n"
    "  --list        the tasks and the libraries of this build\n"
    "  --json FILE   writes the results as JSON\n"
    "  --help        this text\n";

struct Options {
  std::vector<std::string> tasks, rivals;
  bool sweep = false;
  bool quick = false;
  bool list = false;
  double seconds = 0.5;
};

std::vector<std::string> split(const std::string& names) {
  std::vector<std::string> parts;
  std::istringstream stream(names);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

/// Throws std::invalid_argument for what is not known.
Options parse(const std::vector<std::string>& arguments) {
  Options options;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::string& flag = arguments[i];
    const auto value = [&]() -> const std::string& {
      if (i + 1 == arguments.size()) throw std::invalid_argument(flag + " needs a value");
      return arguments[++i];
    };
    if (flag == "--task") {
      options.tasks = split(value());
    } else if (flag == "--rival") {
      options.rivals = split(value());
    } else if (flag == "--seconds") {
      options.seconds = std::stod(value());
    } else if (flag == "--sweep") {
      options.sweep = true;
    } else if (flag == "--quick") {
      options.quick = true;
    } else if (flag == "--list") {
      options.list = true;
    } else {
      throw std::invalid_argument("unknown argument: " + flag + " (see --help)");
    }
  }
  return options;
}

/// Throws std::invalid_argument for a name that is not among those known.
void check_names(const char* what, const std::vector<std::string>& names,
                 const std::vector<std::string>& known) {
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw std::invalid_argument("there is no " + std::string(what) + " " + name +
                                  " here (see --list)");
    }
  }
}

bool is_chosen(const std::vector<std::string>& chosen, const std::string& name) {
  return chosen.empty() || std::find(chosen.begin(), chosen.end(), name) != chosen.end();
}

/// Progress goes to stderr and the table comes at the end; the file gets, of the repetitions of a
/// measurement, the last, whose percentiles are over all.
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

class Suite {
 public:
  explicit Suite(Options options) : options_(std::move(options)) {}

  void enlist() {
    std::vector<std::string> built;
    for (const Library& library : libraries()) built.push_back(library.name);
    check_names("task", options_.tasks, task_names());
    check_names("library", options_.rivals, built);
    for (const std::string& name : task_names()) {
      if (!is_chosen(options_.tasks, name)) continue;
      for (const Library& library : libraries()) {
        if (!is_chosen(options_.rivals, library.name)) continue;
        add_comparison(name, library);
        if (options_.sweep && is_swept(name)) add_sweep(name, library);
      }
    }
  }
  [[nodiscard]] std::size_t size() const { return compared_.size() + swept_.size(); }
  [[nodiscard]] std::string tables() const {
    return comparison_table(compared_) + "\n" + sweep_table(swept_);
  }
  /// True when one of our own answers is wrong.
  [[nodiscard]] bool is_wrong() const {
    const auto wrong = [](const auto& m) {
      return m->library().name == "repel" && m->verdict().wrong() > 0;
    };
    return std::any_of(compared_.begin(), compared_.end(), wrong);
  }

 private:
  static bool is_swept(const std::string& task) {
    return task == "box" || task == "8v" || task == "32v";
  }

  std::shared_ptr<CheckedTask> task(const std::string& name) {
    auto& drawn = tasks_[name];
    if (!drawn) drawn = std::make_shared<CheckedTask>(make_task(name, options_.quick));
    return drawn;
  }

  void add_comparison(const std::string& name, const Library& library) {
    const auto drawn = task(name);
    if (!(drawn->task.overlap ? library.depths : library.gaps)) return;
    for (const Start start : {Start::cold, Start::warm}) {
      const std::string title = name + (start == Start::warm ? "/warm/" : "/cold/") + library.name;
      add(compared_, title, library, drawn, start, library.tolerance);
    }
  }
  void add_sweep(const std::string& name, const Library& library) {
    if (!library.sweeps || !library.gaps) return;
    for (int digits = 2; digits <= 14; digits += options_.quick ? 4 : 1) {
      const std::string title =
          "error/" + name + "/" + library.name + "/1e-" + std::to_string(digits);
      add(swept_, title, library, task(name), Start::cold, std::pow(10.0, -digits));
    }
  }
  void add(Measurements& list, const std::string& title, const Library& library,
           std::shared_ptr<CheckedTask> drawn, Start start, double tolerance) {
    Measurement& m = *list.emplace_back(
        std::make_unique<Measurement>(library, std::move(drawn), start, tolerance));
    constexpr int repetitions = 10;
    benchmark::RegisterBenchmark(title.c_str(), [&m](benchmark::State& state) { m.run(state); })
        ->UseManualTime()
        ->Unit(benchmark::kNanosecond)
        ->Repetitions(repetitions)
        ->MinTime((options_.quick ? 0.1 : 1.0) * options_.seconds / repetitions);
  }

  Options options_;
  std::map<std::string, std::shared_ptr<CheckedTask>> tasks_;
  Measurements compared_, swept_;
};

void print_list() {
  std::printf("tasks:");
  for (const std::string& name : task_names()) std::printf(" %s", name.c_str());
  std::printf("\nlibraries:");
  for (const Library& library : libraries()) {
    std::printf(" %s (%s)", library.name.c_str(), library.version.c_str());
  }
  std::printf("\n%s", REPEL_ABSENT_RIVALS);
}

int run(const Options& options, bool to_file) {
  Suite suite(options);
  std::fprintf(stderr, "drawing the tasks and computing their exact answers\n");
  suite.enlist();
  Progress progress(suite.size());
  LastRepetition file;
  benchmark::RunSpecifiedBenchmarks(&progress, to_file ? &file : nullptr);
  const Build build = this_build();
  std::printf("%s; %s; %s; flags %s; commit %s\n\n%s", build.machine.c_str(),
              build.compiler.c_str(), build.simd.c_str(), build.flags.c_str(), build.commit.c_str(),
              suite.tables().c_str());
  std::printf("\n%s", REPEL_ABSENT_RIVALS);
  if (suite.is_wrong()) std::fprintf(stderr, "an answer of repel is wrong\n");
  return suite.is_wrong() || progress.failed() ? 1 : 0;
}

}  // namespace

std::vector<Library>& libraries() {
  static std::vector<Library> all;
  return all;
}

}  // namespace repel::bench

int main(int argc, char** argv) {
  using namespace repel::bench;
  bool to_file = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--help") == 0) return std::printf("%s", about) < 0 ? 1 : 0;
    to_file = to_file || std::strcmp(argv[i], "--json") == 0;
  }
  auto& all = libraries();
  std::sort(all.begin(), all.end(), [](const Library& a, const Library& b) {
    return std::pair(a.name != "repel", a.name) < std::pair(b.name != "repel", b.name);
  });
  try {
    std::vector<char*> arguments(argv, argv + argc);
    // Whatever disturbs the machine meanwhile hits all libraries alike.
    std::string interleaved = "--benchmark_enable_random_interleaving=true";
    arguments.insert(arguments.begin() + 1, interleaved.data());
    const Options options = parse(initialize(argc + 1, arguments.data()));
    if (options.list) return print_list(), 0;
    const int code = run(options, to_file);
    std::fflush(nullptr);
    // FCL and Coal each bring their own octomap, and the destructors of the two collide.
    std::quick_exit(code);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
