// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Distance queries of repel and of other libraries compared on the same tasks; times count only if
/// the answers agree with the exact ones.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>

#include "program.hpp"
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

struct Options : QueryOptions {
  std::vector<std::string> tasks;
  bool sweep = false;
};

/// Throws std::invalid_argument for an unknown name.
Options parse(Arguments arguments) {
  const std::vector<std::string> tasks = split(arguments.value("--task", ""));
  const bool sweep = arguments.has("--sweep");
  return {query_options(arguments, 0.5), tasks, sweep};
}

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
  /// True if an answer of repel is wrong.
  [[nodiscard]] bool is_wrong() const {
    const auto wrong = [](const auto& m) { return m->library().ours && m->verdict().wrong() > 0; };
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
    if (!(drawn->task.overlap ? library.is_checked_in_overlap() : library.gaps)) return;
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
    const double seconds = (options_.quick ? 0.1 : 1.0) * options_.seconds;
    bench::enlist(title, seconds, [&m](benchmark::State& state) { m.run(state); });
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

int run(const Arguments& arguments, bool to_file) {
  const Options options = parse(arguments);
  if (options.list) return print_list(), 0;
  Suite suite(options);
  std::fprintf(stderr, "drawing the tasks and computing their exact answers\n");
  suite.enlist();
  const bool ran = run_enlisted(suite.size(), to_file);
  std::printf("%s\n\n%s\n%s", build_line().c_str(), suite.tables().c_str(), REPEL_ABSENT_RIVALS);
  if (suite.is_wrong()) std::fprintf(stderr, "an answer of repel is wrong\n");
  return suite.is_wrong() || !ran ? 1 : 0;
}

}  // namespace

}  // namespace repel::bench

int main(int argc, char** argv) {
  return repel::bench::start(argc, argv, repel::bench::about, repel::bench::run);
}
