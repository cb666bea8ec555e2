// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Cost of an open live-view page for the tick: one real-time run with the page alternately open
/// and closed.

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <thread>

#include <nlohmann/json.hpp>

#include <repel/host/command_line.hpp>
#include <repel/host/times.hpp>
#include <repel/runs/engine/session.hpp>

#include "client.hpp"

namespace {

using namespace repel;

struct Arguments {
  std::string scene = "scenes/anderson_4x8.yaml";
  std::string page = "backends/visual/page";
  double seconds = 60.0;
  double turn = 2.0;
  std::uint16_t port = 8458;
  std::string json;
};

void describe(CLI::App& app, Arguments& a) {
  app.add_option("scene", a.scene, "Scene file")->capture_default_str();
  app.add_option("--page", a.page, "Folder of the page")->capture_default_str();
  app.add_option("--seconds", a.seconds, "How long to run [s]")
      ->capture_default_str()
      ->check(host::between(4.0, 1e4));
  app.add_option("--turn", a.turn, "How long the page is open, and not open, at a time [s]")
      ->capture_default_str()
      ->check(host::between(0.5, 1e3));
  app.add_option("--port", a.port, "Port of the live view")->capture_default_str();
  app.add_option("--json", a.json, "Write the report as JSON to FILE")->type_name("FILE");
  app.footer(
      "The page is a client that takes and reads every picture, in a thread beside the run. Of "
      "the\n"
      "script two phases are played, then the arm is held: every tick has the same work.\n\n"
      "Exit status: 0 it ran, 1 bad file, 2 bad usage.");
}

/// Ticks [from, to) with or without a page.
struct Turn {
  std::int64_t from, to;
  bool open;
};

/// Opens and closes the page alternately until the run is over; returns which ticks fell in which
/// phase.
std::vector<Turn> take_turns(const Arguments& a, double rate_hz, const std::atomic<bool>& over,
                             std::int64_t& bytes) {
  constexpr std::int64_t margin = 40;  // [ticks] excluded at each change
  std::vector<Turn> turns;
  const auto length = static_cast<std::int64_t>(a.turn * rate_hz);
  try {
    std::int64_t closed_from = -1;
    std::this_thread::sleep_for(std::chrono::seconds(2));  // until the arm holds still
    while (!over) {
      Client page(a.port);
      const std::int64_t first = page.next();
      if (closed_from >= 0) turns.push_back({closed_from + margin, first - margin, false});
      std::int64_t last = first;
      while (!over && last < first + length) last = page.next();
      turns.push_back({first + margin, last - margin, true});
      bytes += page.bytes();
      closed_from = last;
      if (over) break;
      std::this_thread::sleep_for(std::chrono::duration<double>(a.turn));
    }
  } catch (const std::exception&) {
    // The run ended in the middle of a phase, which does not count.
  }
  return turns;
}

struct Summary {
  std::vector<double> us;  ///< compute of each tick [us]

  [[nodiscard]] double percentile(double share) {
    if (us.empty()) return 0.0;
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(us.size() - 1));
    std::nth_element(us.begin(), us.begin() + place, us.end());
    return us[static_cast<std::size_t>(place)];
  }
};

int run(const Arguments& arguments) {
  host::Output json(arguments.json);
  scene::Scene scene = scene::load(arguments.scene);
  // The tool is pressed on the table and held there, so that every tick has the same work.
  scene.script.resize(std::min<std::size_t>(2, scene.script.size()));
  runs::RunOptions options;
  options.rate_hz = scene.rate_hz;
  options.seconds = arguments.seconds;
  options.threads = scene.budget.threads;
  options.keep_records = true;
  runs::SessionOptions session;
  session.view = true;
  session.listen = "127.0.0.1:" + std::to_string(arguments.port);
  session.page = arguments.page;

  std::atomic<bool> over = false;
  std::int64_t bytes = 0;
  std::vector<Turn> turns;
  std::thread looking([&] { turns = take_turns(arguments, options.rate_hz, over, bytes); });
  const runs::RunResult result =
      runs::run_session(scene, options, session, nullptr, host::interruption(), host::insistence(),
                        [](const runs::Progress& p) { std::fprintf(stderr, "\r%7.2f s", p.time); });
  over = true;
  looking.join();
  Summary open, closed;
  for (const Turn& turn : turns) {
    const auto end = std::min<std::int64_t>(turn.to, std::ssize(result.times));
    for (std::int64_t i = turn.from; i < end; ++i) {
      (turn.open ? open : closed)
          .us.push_back(1e-3 * static_cast<double>(
                                   result.times[static_cast<std::size_t>(i)].compute.count()));
    }
  }
  // Without a contact force there was less to do, and without a phase of each kind there is no
  // ratio.
  if (open.us.empty() || closed.us.empty() || !(result.totals().peak_force > 1.0)) {
    throw SetupError(
        "nothing to compare: the arm was not pressed, or a page never opened and closed");
  }
  const double ratio = open.percentile(0.99) / closed.percentile(0.99);
  std::printf("\n%-16s %8s %8s %8s %8s\n", "page", "ticks", "p50 [us]", "p99 [us]", "max [us]");
  for (auto* each : {&closed, &open}) {
    std::printf("%-16s %8zu %8.2f %8.2f %8.1f\n", each == &open ? "open" : "not open",
                each->us.size(), each->percentile(0.5), each->percentile(0.99),
                each->percentile(1.0));
  }
  std::printf("ratio of p99       %.3f\n", ratio);
  std::printf(
      "sent to the page   %.0f kB/s\n",
      1e-3 * static_cast<double>(bytes) / (static_cast<double>(open.us.size()) / options.rate_hz));
  host::print_machine(result.machine, stdout);
  const auto figures = [](Summary& times) -> nlohmann::ordered_json {
    return {{"ticks", times.us.size()},
            {"p50_us", times.percentile(0.5)},
            {"p99_us", times.percentile(0.99)},
            {"max_us", times.percentile(1.0)}};
  };
  host::write({{"scene", scene.name},
               {"rate_hz", options.rate_hz},
               {"not_open", figures(closed)},
               {"open", figures(open)},
               {"p99_ratio", ratio},
               {"machine", host::to_json(result.machine)}},
              json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return host::start(argc, argv, "view", "What an open page of the live view costs the tick.", 1,
                     describe, run);
}
