// SPDX-License-Identifier: BSD-3-Clause
// Runs a scene as the program teleop does, without its command line: the arm is simulated, the
// operator is the script of the scene.
//     06_run_a_scene [SCENE]
#include <atomic>
#include <cstdio>

#include <repel/runs/engine/run.hpp>

using namespace repel;

int main(int argc, char** argv) try {
  const scene::Scene scene = scene::load(argc > 1 ? argv[1] : "scenes/plates.yaml");
  runs::RunOptions options = runs::options_of(scene);
  options.seconds = 5.0;
  options.fast = true;  // not by the clock
  const std::atomic<bool> stop{false};
  const auto prepared = runs::prepare(scene, options);
  const runs::RunResult result = runs::run(*prepared, {}, stop, [](const runs::Progress&) {});
  for (const runs::ObstacleResult& each : result.obstacles) {
    std::printf("%-12s pushed with %5.1f N at most, nearest %5.1f mm\n", each.name.c_str(),
                each.extremes.peak_force, 1e3 * each.extremes.nearest);
  }
} catch (const SetupError& error) {
  std::fprintf(stderr, "06_run_a_scene: %s\n", error.what());
  return 1;
}
