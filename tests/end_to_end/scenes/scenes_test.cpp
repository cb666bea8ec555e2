// SPDX-License-Identifier: BSD-3-Clause
// Every scene of the repository agrees with its reference report, and has a page that shows it.
#include "end_to_end/whole_run.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <set>

namespace repel::test {
namespace scenes_test {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string scenes = REPEL_SOURCE "/scenes/";

/// The names of the elements of a list, or the keys of an object.
std::vector<std::string> names_in(const json& list) {
  std::vector<std::string> all;
  for (const auto& [key, value] : list.items()) {
    all.push_back(list.is_object() ? key : value.at("name").get<std::string>());
  }
  return all;
}

/// Rounding differs between machines, and is amplified where the arm slides.
void expect_near(const json& value, const json& reference, const char* key) {
  const json& is = value.at(key);
  const json& was = reference.at(key);
  ASSERT_EQ(is.is_null(), was.is_null()) << key;
  if (is.is_null()) return;
  const bool force = std::string(key) == "peak_force_n";
  const double room = force ? std::max(1.0, 0.05 * was.get<double>()) : 0.001;
  EXPECT_NEAR(is.get<double>(), was.get<double>(), room) << key;
}

void expect_like_arm(const json& arm, const json& reference) {
  expect_near(arm, reference, "peak_force_n");
  EXPECT_EQ(names_in(arm.at("status_ticks")), names_in(reference.at("status_ticks")));
  EXPECT_EQ(names_in(arm.at("modules")), names_in(reference.at("modules")));
  for (const json& module : arm.at("modules")) {
    if (!module.at("claims_passive").get<bool>()) continue;
    EXPECT_LE(module.at("deficit"), 1e-9) << module;
  }
}

void expect_like(const json& report, const json& reference) {
  for (const char* key : {"scene", "backend", "rate_hz", "ticks", "pairs"}) {
    EXPECT_EQ(report.at(key), reference.at(key)) << key;
  }
  expect_near(report, reference, "nearest_m");
  expect_near(report, reference, "deepest_m");
  const json& obstacles = report.at("obstacles");
  ASSERT_EQ(names_in(obstacles), names_in(reference.at("obstacles")));
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    SCOPED_TRACE(obstacles[i].at("name"));
    for (const char* key : {"nearest_m", "deepest_m", "peak_force_n"}) {
      expect_near(obstacles[i], reference.at("obstacles")[i], key);
    }
  }
  expect_like_arm(report, reference);
  const json& partners = report.at("partners");
  ASSERT_EQ(names_in(partners), names_in(reference.at("partners")));
  for (std::size_t i = 0; i < partners.size(); ++i) {
    SCOPED_TRACE(partners[i].at("name"));
    expect_like_arm(partners[i], reference.at("partners")[i]);
  }
}

TEST(Scenes, HaveAReportAPictureAndAPageThatTheListLeadsTo) {
  const std::string list = text_of(scenes + "README.md");
  for (const std::string& name : scene_names()) {
    EXPECT_TRUE(fs::exists(scenes + "reports/" + name + ".json")) << name << ": scenes/publish";
    EXPECT_TRUE(fs::exists(scenes + "pictures/" + name + ".svg")) << name << ": scenes/publish";
    EXPECT_NE(list.find("](" + name + ".md)"), std::string::npos) << name;
    const std::string page = text_of(scenes + name + ".md");
    EXPECT_NE(page.find("](pictures/" + name + ".svg)"), std::string::npos) << name;
    EXPECT_NE(page.find("./run " + name), std::string::npos) << name;
  }
}

TEST(Scenes, HaveTheFiguresOfTheirReportOnTheirPage) {
  for (const std::string& name : scene_names()) {
    const std::string page = text_of(scenes + name + ".md");
    const json reference = report_of(scenes + "reports/" + name + ".json");
    for (const json& obstacle : reference.at("obstacles")) {
      const double force = obstacle.at("peak_force_n");
      if (force < 1.0) continue;
      std::array<char, 100> row{};
      std::snprintf(row.data(), row.size(), "| `%s` | %.0f | %.1f |",
                    obstacle.at("name").get<std::string>().c_str(), force,
                    1e3 * obstacle.at("nearest_m").get<double>());
      EXPECT_NE(page.find(row.data()), std::string::npos) << name << ": " << row.data();
    }
  }
}

TEST(Scenes, HaveNoReportOrPictureOfWhatIsGone) {
  const std::set<std::string> all = scene_names();
  for (const char* folder : {"reports", "pictures"}) {
    for (const auto& entry : fs::directory_iterator(scenes + folder)) {
      EXPECT_TRUE(all.contains(entry.path().stem().string())) << entry.path();
    }
  }
}

TEST(Scenes, DoWhatTheirReferenceReportsSay) {
  for (const std::string& name : scene_names()) {
    SCOPED_TRACE(name);
    const WholeRun& run = whole_run_of(name);
    if (run.ending.says("is not built in")) GTEST_SKIP() << run.ending;
    ASSERT_EQ(run.ending.status, 0) << run.ending;
    expect_like(run.report, run.reference);
  }
}

// A passable body may be entered; all others keep their distance, from any part of an arm.
TEST(Scenes, LetNothingBeTouchedThatMayNotBeEntered) {
  const std::set<std::string> passable = {"membrane", "crust", "skin"};
  for (const std::string& name : scene_names()) {
    const json reference = report_of(scenes + "reports/" + name + ".json");
    for (const json& obstacle : reference.at("obstacles")) {
      if (passable.contains(obstacle.at("name")) || obstacle.at("nearest_m").is_null()) continue;
      EXPECT_GT(obstacle.at("nearest_m"), 0.002) << name << ' ' << obstacle;
      EXPECT_EQ(obstacle.at("deepest_m"), 0.0) << name << ' ' << obstacle;
    }
  }
}

}  // namespace scenes_test
}  // namespace repel::test
