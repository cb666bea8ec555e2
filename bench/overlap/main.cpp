// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Overlap queries of several libraries compared: cost of a depth query, its error against the
/// exact depth, and its continuity while one solid moves through the other.

#include <cstdio>
#include <stdexcept>

#include "paths.hpp"
#include "program.hpp"
#include "rows.hpp"

namespace repel::bench {

namespace {

constexpr const char* about =
    "overlap_bench: how deep pairs overlap, by every measure of repel and by other libraries.\n"
    "Exit code 1 when an answer of ours is wrong: deeper than the exact depth, outside its\n"
    "bracket, or not finite; or when its value jumps: it changes by more than the solids move.\n"
    "\n"
    "  --rival A,B   only these libraries beside ours; default all that were built\n"
    "  --quick       fewer pairs, less time: a look, not a result\n"
    "  --seconds S   time for each setting on each input, cold and warm; default 0.3\n"
    "  --list        the settings and the libraries of this build\n"
    "  --json FILE   writes the results as JSON\n"
    "  --help        this text\n";

/// The same solids for all libraries.
class Input {
 public:
  Input(const std::string& name, int vertices, bool quick)
      : pairs_(
            std::make_shared<CheckedTask>(named(name, overlap_task(vertices, quick ? 32 : 200)))),
        presses_(press_task(vertices, quick ? 8 : 100)),
        sweeps_(sweep_task(vertices, quick ? 16 : 400)) {}

  [[nodiscard]] Row row(const Library& library) const {
    const auto measured = [&](Start start) {
      return std::make_unique<Measurement>(library, pairs_, start, library.tolerance);
    };
    return {library, measured(Start::cold), measured(Start::warm),
            conduct_of(library, presses_, sweeps_)};
  }

 private:
  static Task named(const std::string& name, Task task) {
    task.name = name;
    return task;
  }

  std::shared_ptr<CheckedTask> pairs_;
  CheckedTask presses_;
  Task sweeps_;
};

/// The fields of a row in the file other than its times.
void count(const Conduct& conduct, benchmark::State& state) {
  state.counters["median_dead_zone_m"] = conduct.median_dead_zone;
  state.counters["worst_dead_zone_m"] = conduct.worst_dead_zone;
  state.counters["value_jump_less_motion_m"] = conduct.excess;
  state.counters["direction_jump_rad"] = conduct.turn;
  state.counters["median_direction_jump_rad"] = conduct.median_turn;
  state.counters["wrong_on_the_way"] = conduct.wrong;
}

Rows measure(const QueryOptions& options, bool to_file) {
  Rows rows;
  for (const auto& [name, vertices] : {std::pair("box", 0), std::pair("16v", 16)}) {
    const Input input(name, vertices, options.quick);
    for (const Library& library : libraries()) {
      if (!library.depths || !(library.ours || is_chosen(options.rivals, library.name))) continue;
      std::fprintf(stderr, "\r%s, %s: moving through each other     ", name, library.name.c_str());
      rows.push_back(input.row(library));
    }
  }
  const double seconds = (options.quick ? 0.1 : 1.0) * options.seconds;
  for (Row& row : rows) {
    for (Measurement* m : {row.cold.get(), row.warm.get()}) {
      const std::string start = m->start() == Start::warm ? "/warm/" : "/cold/";
      enlist(m->task().name + start + row.library.name, seconds,
             [&row, m](benchmark::State& state) {
               m->run(state);
               count(row.conduct, state);
             });
    }
  }
  if (!run_enlisted(2 * rows.size(), to_file)) throw std::runtime_error("a benchmark failed");
  return rows;
}

int run(const Arguments& arguments, bool to_file) {
  const QueryOptions options = query_options(arguments, 0.3);
  std::vector<std::string> names{"repel"};
  for (const Library& library : libraries()) {
    if (options.list) std::printf("%s (%s)\n", library.name.c_str(), library.version.c_str());
    if (!library.ours) names.push_back(library.name);
  }
  if (options.list) return std::printf("%s", REPEL_ABSENT_RIVALS) < 0 ? 1 : 0;
  check_names("library", options.rivals, names);
  const Rows rows = measure(options, to_file);
  std::printf("%s\n\n%s\n%s", build_line().c_str(), overlap_table(rows).c_str(),
              REPEL_ABSENT_RIVALS);
  const std::string wrong = faults(rows);
  std::fprintf(stderr, "%s", wrong.c_str());
  return wrong.empty() ? 0 : 1;
}

}  // namespace

}  // namespace repel::bench

int main(int argc, char** argv) {
  return repel::bench::start(argc, argv, repel::bench::about, repel::bench::run);
}
