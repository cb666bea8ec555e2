// SPDX-License-Identifier: BSD-3-Clause
// Forces and reports when there are more near pairs than the budget covers.
#include "end_to_end/whole_run.hpp"

namespace repel::test {
namespace budget_test {

/// The results of a run.
struct Outcome {
  Ending ending;
  nlohmann::json report;
  std::string log;
  double most_near = 0.0;  ///< largest number of pairs in one tick
};

Outcome run_of(const std::string& arguments, int status = 0) {
  const Folder folder;
  Outcome run;
  run.ending = teleop(arguments + " --fast --report " + quoted(folder / "report.json") + " --log " +
                      quoted(folder / "log.csv"));
  EXPECT_EQ(run.ending.status, status) << arguments << '\n' << run.ending;
  if (run.ending.status != status) return run;
  run.report = report_of(folder / "report.json");
  run.log = text_of(folder / "log.csv");
  const Columns columns = columns_of(folder / "log.csv");
  expect_finite_forces(columns);
  run.most_near =
      *std::max_element(columns.at("pairs_near").begin(), columns.at("pairs_near").end());
  return run;
}

std::int64_t units_of(const Outcome& run) {
  return run.report.at("budget").at("work_units");
}
bool has_status(const Outcome& run, const char* name) {
  return run.report.at("status_ticks").contains(name);
}

/// Four tool parts among 80 small blocks, all within range: 320 pairs, of several blocks.
std::string crowd(const std::string& budget) {
  std::string text = "name: crowd\n" + robot_text();
  for (const char* part : {"a", "b", "c"}) {
    text += std::string("  - {name: ") + part +
            ", shape: box, size: 20 20 60 mm, position: 0 0 -30 mm}\n";
  }
  text += "laws:\n  default: {range: 1 m, surface_force: 0.2 N, damping: 0.01 N s/m}\n" + budget +
          "obstacles:\n";
  for (int i = 0; i < 80; ++i) {
    text += "  - {name: block" + std::to_string(i) +
            ", shape: box, size: 9 9 9 mm, position: " + std::to_string(550 + 10 * (i % 10)) + " " +
            std::to_string(-200 + 10 * (i / 10)) + " 380 mm}\n";
  }
  return text + push_text();
}

/// The scene with a tenth of the budget that all its pairs need.
Outcome overload(const std::string& budget, const std::string& options = "", int status = 0) {
  const Folder folder;
  const std::string scene = quoted(folder.with("crowd.yaml", crowd(budget))) + " --seconds 1 ";
  const Outcome enough = run_of(scene + "--budget 1000000");
  EXPECT_EQ(enough.report.at("pairs_stale"), 0);
  EXPECT_EQ(enough.report.at("pairs_near_per_tick"), 320.0);
  const double units = enough.report.at("support_pairs_per_tick");
  return run_of(scene + options + "--budget " + std::to_string(std::lround(0.1 * units)), status);
}

TEST(Budget, TenTimesTooManyPairsAreStaleWithinTheBoundOnTheirAge) {
  const Outcome run = overload("");
  EXPECT_TRUE(has_status(run, "stale_pairs"));
  EXPECT_FALSE(has_status(run, "expired_pairs"));
  EXPECT_GT(run.report.at("pairs_stale_per_tick"), 160.0);
  EXPECT_GT(run.report.at("refresh_energy_j"), 0.0);
  EXPECT_GT(run.report.at("peak_force_n"), 0.0);
  const double answered = run.report.at("pairs_evaluated_per_tick");
  EXPECT_GT(answered, 0.0);
  EXPECT_GT(run.report.at("oldest_age_ticks"), 0);
  // Half of the evaluations are round-robin; their costs within a tick differ.
  EXPECT_LT(run.report.at("oldest_age_ticks"), 2.0 * 2.0 * 320.0 / answered);
  for (const char* words : {"oldest answer", "given too much", "status stale_pairs"}) {
    EXPECT_TRUE(run.ending.says(words)) << words << '\n' << run.ending;
  }
}

TEST(Budget, AnswersBeyondTheAgeTheSceneAllowsExpireAndTheForceIsTakenBack) {
  const Outcome run = overload("budget: {max_age: 3}\n", "", 5);
  EXPECT_EQ(run.report.at("budget").at("max_age_ticks"), 3);
  EXPECT_TRUE(has_status(run, "expired_pairs"));
  EXPECT_TRUE(run.ending.says("status expired_pairs")) << run.ending;
  const Folder folder;
  const Columns log = columns_of(folder.with("log.csv", run.log));
  EXPECT_EQ(log.at("gain").back(), 0.0);
}

TEST(Budget, OverloadIsTheSameBitsEveryTimeAndWithAnyNumberOfThreads) {
  const Outcome first = overload("");
  for (const int threads : {0, 2}) {
    const Outcome run = overload("", "--threads " + std::to_string(threads) + " ");
    EXPECT_EQ(run.report.at("threads"), threads);
    EXPECT_TRUE(run.log == first.log) << threads << " threads: another log";
  }
}

TEST(Budget, OneSupportPairIsEnoughToRunEveryScene) {
  for (const std::string& scene : scene_names()) {
    SCOPED_TRACE(scene);
    const Outcome run = run_of(scene + " --seconds 5 --budget 1");
    EXPECT_EQ(units_of(run), 1);
    for (const char* fault : {"bad_pose", "bad_command", "bad_joints", "clock_fault"}) {
      EXPECT_FALSE(has_status(run, fault)) << fault;
    }
    const bool few = run.most_near < 2.0;
    EXPECT_EQ(has_status(run, "stale_pairs"), !few);
    EXPECT_EQ(run.report.at("oldest_age_ticks") > 0, !few);
  }
}

// 24 s is the length of the script.
TEST(Budget, EveryPairOfTheDefaultSceneFitsThatOfTheI860) {
  const std::string scene = "anderson_4x8 --tool-alone --every-pair --seconds 24 --budget ";
  const Outcome fits = run_of(scene + "i860");
  EXPECT_EQ(fits.report.at("budget").at("name"), "i860");
  EXPECT_EQ(fits.report.at("pairs_evaluated_per_tick"), 32.0);
  EXPECT_EQ(fits.report.at("pairs_stale"), 0);
  // It took nearly all of them while a cylinder was searched for point by point.
  EXPECT_LE(fits.report.at("support_pairs_most"), units_of(fits) * 7 / 10);
  EXPECT_GT(fits.report.at("budget").at("machine_times_budget"), 0.0);
  EXPECT_TRUE(fits.ending.says("times the budget")) << fits.ending;

  const Outcome less = run_of(scene + std::to_string(units_of(fits) / 4));
  EXPECT_GT(less.report.at("pairs_stale"), 0);
}

TEST(Budget, OfTheI860IsOneOfSupportPairsInASecond) {
  const Outcome slow = run_of("empty --seconds 0.1 --rate 400 --budget i860");
  const Outcome quick = run_of("empty --seconds 0.1 --rate 800 --budget i860");
  EXPECT_EQ(units_of(slow), 2 * units_of(quick));
  EXPECT_EQ(units_of(run_of("empty --seconds 0.001 --rate 100000 --budget i860")), 1);
}

TEST(Budget, OfTheCommandLineTakesThePlaceOfTheScenes) {
  const Folder folder;
  const std::string scene =
      quoted(folder.with("scene.yaml", robot_text() + table_text() + push_text() +
                                           "budget: {work: 7, wall: 1 ms}\n")) +
      " --seconds 0.1 ";
  EXPECT_EQ(units_of(run_of(scene)), 7);
  EXPECT_EQ(units_of(run_of(scene + "--budget 12")), 12);
  EXPECT_EQ(units_of(run_of(scene + "--budget none")), 0);
}

}  // namespace budget_test
}  // namespace repel::test
