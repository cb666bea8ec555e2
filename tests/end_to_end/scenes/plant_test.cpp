// SPDX-License-Identifier: BSD-3-Clause
// Simulated arms that are not as their model says: another inertia, a payload.
#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace plant_test {

using nlohmann::json;

/// A robot without obstacles and commands: it holds still. `payload` is what it carries.
std::string still_text(const std::string& payload) {
  std::string text = robot_text() + "obstacles: []\n";
  const std::string links = "  links: []\n";
  return text.replace(text.find(links), links.size(), payload);
}

/// How far the tool sinks [m] in the run.
double sunk(const Columns& log) {
  return log.at("z_m").front() - log.at("z_m").back();
}

TEST(Plant, AnotherInertiaMovesAnotherWayAndTheReportSaysSo) {
  const Folder folder;
  const std::string log = folder / "log.csv";
  const std::string files = " --log " + quoted(log) + " --report " + quoted(folder / "r.json");
  for (const std::string backend : {"bullet", "ode", "mujoco", "reference"}) {
    const std::string run = "anderson_4x8 --fast --seconds 2 --backend " + backend + files;
    const Ending nominal = teleop(run);
    if (nominal.says("is not built in")) continue;
    ASSERT_EQ(nominal.status, 0) << nominal;
    EXPECT_FALSE(nominal.says("plant inertia")) << nominal;
    EXPECT_EQ(report_of(folder / "r.json").at("plant_inertia"), 1.0);
    const std::string as_modelled = text_of(log);
    ASSERT_EQ(teleop(run + " --plant-inertia 1").status, 0);
    EXPECT_TRUE(text_of(log) == as_modelled) << backend;
    const Ending heavy = teleop(run + " --plant-inertia 1.7");
    ASSERT_EQ(heavy.status, 0) << heavy;
    EXPECT_TRUE(heavy.says("plant inertia          1.7 times that of the model")) << heavy;
    EXPECT_EQ(report_of(folder / "r.json").at("plant_inertia"), 1.7);
    EXPECT_FALSE(text_of(log) == as_modelled) << backend;
    expect_finite_forces(columns_of(log));
  }
}

TEST(Plant, AnArmAtRestStaysWhateverItsInertia) {
  const Folder folder;
  const std::string scene = quoted(folder.with("still.yaml", still_text("")));
  for (const std::string backend : {"bullet", "ode", "reference"}) {
    for (const std::string factor : {"0.3", "3"}) {
      const Ending ending =
          teleop(scene + " --fast --seconds 3 --backend " + backend + " --plant-inertia " + factor +
                 " --log " + quoted(folder / "log.csv"));
      ASSERT_EQ(ending.status, 0) << ending;
      EXPECT_LT(std::abs(sunk(columns_of(folder / "log.csv"))), 1e-5) << backend << ' ' << factor;
    }
  }
}

/// How far the tool sinks [m] in 3 s with a payload of `mass`, with checks of the report.
double sunk_with(const std::string& mass, const std::string& known, const std::string& options) {
  const Folder folder;
  const std::string text =
      still_text("  payload: {mass: " + mass + " kg, position: 0 0 30 mm, known: " + known + "}\n");
  const Ending ending =
      teleop(quoted(folder.with("still.yaml", text)) + " --fast --seconds 3 " + options +
             " --log " + quoted(folder / "log.csv") + " --report " + quoted(folder / "r.json"));
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("payload                " + mass + " kg")) << ending;
  EXPECT_EQ(ending.says("unknown to the controller"), known == "no") << ending;
  const json report = report_of(folder / "r.json");
  EXPECT_EQ(report.at("payload_kg"), std::stod(mass));
  EXPECT_EQ(report.at("payload_known"), known == "yes");
  EXPECT_EQ(report.at("stop").at("running"), report.at("ticks")) << "it must be in control";
  return sunk(columns_of(folder / "log.csv"));
}

TEST(Plant, OnlyAPayloadThatIsUnknownMakesTheArmSink) {
  for (const std::string backend : {"bullet", "ode", "reference"}) {
    EXPECT_LT(std::abs(sunk_with("3", "yes", "--backend " + backend)), 1e-5) << backend;
    EXPECT_GT(sunk_with("3", "no", "--backend " + backend), 1e-3) << backend;
  }
}

// Without stiction the arm comes to rest where its springs carry the weight.
TEST(Plant, TheWeightOfAPayloadIsTheSameAtAnyInertia) {
  const double unknown = sunk_with("1", "no", "--backend reference");
  EXPECT_GT(unknown, 5e-4);
  for (const std::string factor : {"0.3", "3"}) {
    EXPECT_NEAR(sunk_with("1", "no", "--backend reference --plant-inertia " + factor), unknown,
                0.01 * unknown)
        << factor;
  }
}

TEST(Plant, APayloadIsNothingToAnArmWhoseLinksHaveNoMass) {
  const Folder folder;
  const std::string scene = quoted(folder.with(
      "still.yaml", still_text("  payload: {mass: 4 kg, position: 0 0 30 mm, known: no}\n")));
  const Ending ending =
      teleop(scene + " --fast --seconds 0.5 --backend ideal --report " + quoted(folder / "r.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  EXPECT_FALSE(ending.says("payload")) << ending;
  const json report = report_of(folder / "r.json");
  EXPECT_EQ(report.at("payload_kg"), 0.0);
  EXPECT_TRUE(report.at("payload_known").is_null());
}

TEST(Plant, ARecordingKnowsItAndIsReplayedBitForBit) {
  const Folder folder;
  const std::string text =
      still_text("  payload: {mass: 2 kg, position: 0 0 30 mm}\n") + push_text();
  const std::string scene = quoted(folder.with("push.yaml", text));
  const std::string file = quoted(folder / "run.mcap");
  const Ending run = teleop(scene + " --fast --seconds 2 --plant-inertia 0.5 --log " + file);
  ASSERT_EQ(run.status, 0) << run;
  const Ending again = teleop("replay " + file + " --report " + quoted(folder / "r.json"));
  ASSERT_EQ(again.status, 0) << again;
  const json report = report_of(folder / "r.json");
  EXPECT_EQ(report.at("plant_inertia"), 0.5);
  EXPECT_EQ(report.at("payload_kg"), 2.0);
  EXPECT_EQ(report.at("replay").at("same"), 800);
  EXPECT_EQ(teleop("replay " + file + " --plant-inertia 2").status, 2);
}

TEST(Plant, AFactorOutOfRangeOrForABackEndWithoutMassesIsRefused) {
  for (const std::string factor : {"0.29", "3.1", "-1", "nan", "heavy"}) {
    const Ending ending = teleop("--plant-inertia " + factor);
    EXPECT_EQ(ending.status, 2) << ending;
    EXPECT_TRUE(ending.says("0.3 to 3")) << ending;
  }
  const Ending ideal = teleop("--plant-inertia 2 --backend ideal");
  EXPECT_EQ(ideal.status, 2) << ideal;
  EXPECT_TRUE(ideal.says("ideal") && ideal.says("bullet, ode, mujoco, reference")) << ideal;
}

}  // namespace plant_test
}  // namespace repel::test
