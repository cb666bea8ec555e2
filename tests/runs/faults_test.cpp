// SPDX-License-Identifier: BSD-3-Clause
// Faults that are injected into runs of scenes.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <end_to_end/folder.hpp>
#include <repel/cell/layout.hpp>
#include <repel/runs/engine/session.hpp>
#include <repel/runs/faults/injected_faults.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/world/kinematics.hpp>

namespace repel::runs {
namespace faults_test {

constexpr double begin = 1.2;  // [s] the tool is on its way down then
constexpr double rate = 400.0;
constexpr auto first = static_cast<std::size_t>(begin * rate);  // tick of the fault

scene::Scene plates() {
  return scene::load(REPEL_SOURCE "/scenes/plates.yaml");
}

RunOptions options(const std::vector<faults::Choice>& chosen, double seconds = begin + 0.5) {
  RunOptions options;
  options.fast = true;
  options.keep_records = true;
  options.seconds = seconds;
  options.backend = "ideal";
  options.faults = chosen;
  return options;
}

RunResult run(const RunOptions& options, const Recording* recording = nullptr) {
  const std::atomic<bool> stop{false};
  const scene::Scene scene = recording == nullptr ? plates() : recording->scene;
  return run_session(scene, options, {}, recording, stop, stop, [](const Progress&) {});
}

std::vector<TickRecord> records_of(const std::vector<faults::Choice>& chosen,
                                   double seconds = begin + 0.5) {
  return run(options(chosen, seconds)).arms.front().records;
}

/// Ticks from the begin of a fault until this status; -1: never.
int told_after(const std::string& fault, Status status) {
  const std::vector<TickRecord> records = records_of({{fault, begin}});
  for (std::size_t k = 0; k < records.size(); ++k) {
    if ((records[k].status & status) == 0U) continue;
    EXPECT_GE(k, first) << fault;
    return static_cast<int>(k - first);
  }
  return -1;
}

bool same(const TickRecord& a, const TickRecord& b) {
  return a.status == b.status &&
         std::memcmp(a.torques.data(), b.torques.data(), sizeof a.torques) == 0 &&
         std::memcmp(a.q_read.data(), b.q_read.data(), sizeof a.q_read) == 0;
}

/// Number of ticks that both have, and from the first on alike.
std::size_t alike(const std::vector<TickRecord>& a, const std::vector<TickRecord>& b) {
  const auto ends = std::mismatch(a.begin(), a.end(), b.begin(), b.end(), same);
  return static_cast<std::size_t>(ends.first - a.begin());
}

std::string complaint(const auto& work) {
  try {
    work();
  } catch (const SetupError& error) {
    return error.what();
  }
  return "none";
}

TEST(FaultsOfRuns, AreToldWithinTheTimeOfTheDocs) {
  EXPECT_EQ(told_after("position NaN, wrist", status::bad_joints), 0);
  EXPECT_EQ(told_after("frame of zeros once", status::implausible_joints), 0);
  const int frozen = told_after("frame frozen", status::frozen_joints);
  EXPECT_TRUE(frozen >= 0 && frozen <= 2) << frozen;
  EXPECT_EQ(told_after("pose NaN once", status::bad_pose), 0);
  EXPECT_EQ(told_after("pose away by 10 mm", status::bad_pose), 0);
  EXPECT_EQ(told_after("mass negative", status::bad_pose), 0);
  EXPECT_EQ(told_after("clock stopped", status::clock_fault), 0);
  EXPECT_EQ(told_after("loop stands still for 0.15 s", status::clock_gap), 0);
  EXPECT_EQ(told_after("drive stops by itself", status::arm_stopped), 1);
  EXPECT_GT(told_after("all torques turned round", status::energy_gain), 0);
  EXPECT_EQ(told_after("rates of the hand NaN", status::bad_command), 0);
  EXPECT_EQ(told_after("device silent", status::silent_device), std::lround(0.02 * rate) + 1);
}

TEST(FaultsOfRuns, ChangeNoBitBeforeTheyBegin) {
  const std::vector<TickRecord> sound = records_of({});
  std::vector<faults::Choice> later;
  for (const char* name : {"noise of 10 mrad", "pose frozen", "clock twice as fast",
                           "torques halved", "hand turns round"}) {
    const std::vector<TickRecord> faulty = records_of({{name, begin}});
    ASSERT_EQ(faulty.size(), sound.size());
    EXPECT_GE(alike(sound, faulty), first) << name;
    EXPECT_LT(alike(sound, faulty), sound.size()) << name << " makes no difference";
    later.push_back({name, 1e3});
  }
  EXPECT_EQ(alike(sound, records_of(later)), sound.size());
}

TEST(FaultsOfRuns, AreTheSameInEveryRun) {
  const std::vector<faults::Choice> chosen{{"noise of 0.1 rad/s", begin},
                                           {"clock jitters by 0.4 ticks", begin}};
  const std::vector<TickRecord> one = records_of(chosen);
  EXPECT_EQ(alike(one, records_of(chosen)), one.size());
}

// The shoulder is the joint that moves the tool most, and it seems farther off the table.
TEST(FaultsOfRuns, FindTheJointAndTheWall) {
  for (const double when : {begin, 4.0}) {  // on the way, and pressing
    const std::vector<TickRecord> records =
        records_of({{"slipped away by 1 rad, shoulder", when}}, when + 0.1);
    const auto at = static_cast<std::size_t>(when * rate);
    const TickRecord& last = records[at - 1];
    const auto prepared = prepare(plates(), options({}));
    Kinematics arm(prepared->robots.front().arm);
    arm.update(std::span(last.q).first(6));
    Jacobian J(6, 6);
    arm.tool_jacobian(J);
    Eigen::Index shoulder = 0;
    (void)J.topRows<3>().colwise().norm().maxCoeff(&shoulder);
    for (Eigen::Index i = 0; i < 6; ++i) {
      const auto joint = static_cast<std::size_t>(i);
      const double off = records[at].q_read[joint] - last.q[joint];
      EXPECT_NEAR(std::abs(off), i == shoulder ? 1.0 : 0.0, 0.02) << "joint " << i;
      EXPECT_TRUE(i != shoulder || J(2, i) * off > 0.0) << "it seems nearer to the table";
    }
  }
}

/// Unit, from the tool of the first arm to the impassable body that is nearest to it; zero without.
Vec3 to_wall(const Cell& cell) {
  NearPair nearest;
  nearest.separation.distance = 1e3;
  cell.coprocessor().for_each_near([&](const NearPair& near) {
    const Pair& pair = cell.world().pair(near.pair);
    const bool is_of_tool = cell.world().part(pair.a).body == cell.layout(0).tool;
    if (!is_of_tool || pair.law.passable) return;
    if (near.separation.distance < nearest.separation.distance) nearest = near;
  });
  return -nearest.separation.extraction_W;
}

TEST(FaultsOfRuns, PushTheHandIntoTheNearestWall) {
  const std::atomic<bool> stop{false};
  const scene::Scene scene = scene::load(REPEL_SOURCE "/scenes/storage_tank.yaml");
  RunOptions wanted = options({}, 12.0);
  SessionOptions session;
  double when = -1.0;  // [s]
  Vec3 inward = Vec3::Zero();
  session.on_tick = [&](const Cell& cell, std::span<const TickRecord* const> records) {
    const Vec3 direction = to_wall(cell);
    if (when >= 0.0 || direction.isZero() || std::abs(direction.z()) > 0.3) return;
    when = records.front()->time + 1.0 / rate;
    inward = direction;
  };
  const auto run_once = [&] {
    return run_session(scene, wanted, session, nullptr, stop, stop, [](const Progress&) {});
  };
  wanted.rate_hz = rate;
  (void)run_once();
  ASSERT_GT(when, 0.0) << "the tool was beside no wall";
  wanted.faults = {{"hand at 10 m/s", when}};
  const std::vector<TickRecord> records = run_once().arms.front().records;
  const TickRecord& at = records[static_cast<std::size_t>(std::lround(when * rate))];
  EXPECT_LT((at.command.hand.ball.linear - 10.0 * inward).norm(), 1e-12) << when;
}

TEST(FaultsOfRuns, ALoopThatStandsStillMissesItsTicks) {
  const std::vector<TickRecord> records = records_of({{"loop stands still for 0.15 s", begin}});
  EXPECT_EQ(records[first - 1].elapsed, 1);
  EXPECT_EQ(records[first].elapsed, 61);
  EXPECT_EQ(records[first + 1].elapsed, 1);
  EXPECT_NE(records[first].status & status::arm_stopped, 0U) << "by its watchdog";
}

TEST(FaultsOfRuns, AreInTheRecordingAndItsReplayIsTheSame) {
  const test::Folder folder;
  const std::vector<std::vector<faults::Choice>> all{
      {{"all positions NaN", begin}},
      {{"mass 1e6 times", begin}, {"pose away by 10 mm once", 1.5}},
      {{"clock at its end", begin}},
      {{"clock jitters by 0.4 ticks", begin}},
      {{"torque turned round, shoulder", begin}, {"noise of 10 mrad", 1.3}},
      {{"silent for NaN", begin}, {"Jacobian doubled", 1.25}, {"drive stops by itself", 1.4}}};
  for (const std::vector<faults::Choice>& chosen : all) {
    SCOPED_TRACE(faults::to_text(chosen));
    RunOptions wanted = options(chosen);
    wanted.log = folder / "run.mcap";
    (void)run(wanted);
    const Recording recording = load_recording(wanted.log, [](const std::string&) {
      return std::string(REPEL_SOURCE "/scenes/plates.yaml");
    });
    EXPECT_EQ(faults::to_text(recording.options.faults), faults::to_text(chosen));
    const RunResult result = run(recording.options, &recording);
    EXPECT_EQ(result.replay.ticks, static_cast<std::int64_t>(recording.ticks()));
    EXPECT_EQ(result.replay.same, result.replay.ticks);
    EXPECT_EQ(result.options.faults.size(), chosen.size());
  }
}

TEST(FaultsOfRuns, ThatCannotBeHadAreRefusedByName) {
  const auto refusal = [](const std::string& text) {
    return complaint([&] { (void)faults::choice_in(text); });
  };
  EXPECT_EQ(refusal("frame frozen@2.5"), "none");
  EXPECT_EQ(refusal("frame frozen@2.5 s"),
            "the fault 'frame frozen' begins at '2.5 s'; allowed: 0 to 1e+06 s");
  EXPECT_EQ(refusal("frame frozen"),
            "the fault 'frame frozen' lacks the time at which it begins; allowed: NAME@SECONDS, as "
            "'frame frozen@2.5'");
  const std::string unknown = refusal("posiion frozen, shoulder@1");
  EXPECT_NE(unknown.find("no fault is called 'posiion frozen, shoulder' (did you mean 'position "
                         "frozen, shoulder', "),
            std::string::npos)
      << unknown;
  EXPECT_EQ(refusal("xyz@1"),
            "no fault is called 'xyz'; allowed: those that teleop list --faults prints");
  const std::string brake = refusal("brake drags, wrist@1");
  EXPECT_NE(brake.find("needs brakes of single joints"), std::string::npos) << brake;
  EXPECT_NE(brake.find("'drive stops by itself'"), std::string::npos) << brake;
  EXPECT_EQ(brake.find("'brake does not"), std::string::npos) << brake;
  for (const double never : {-1.0, 2e6, std::nan("")}) {
    EXPECT_NE(complaint([&] {
                (void)prepare(plates(), options({{"frame frozen", never}}));
              }),
              "none");
  }
  ArmDescription slider;
  slider.model.links.emplace_back();
  slider.start = {0.0};
  EXPECT_EQ(complaint([&] {
              faults::InjectedFaults(std::vector<faults::Choice>{{"joints exchanged"}}, slider,
                                     rate);
            }),
            "the fault 'joints exchanged' is one of two joints; allowed: with an arm that has "
            "them");
  EXPECT_NE(complaint([] {
              faults::require_no_operator(std::vector<faults::Choice>{{"hand turns round"}});
            }).find("who is in another program"),
            std::string::npos);
}

TEST(FaultsOfRuns, AreReadAsTheyAreWritten) {
  const std::vector<faults::Choice> all{{"position frozen, shoulder", 0.1}, {"scale 1e9", 1e6}};
  const std::vector<faults::Choice> read = faults::choices_in(faults::to_text(all));
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].name, all[i].name);
    EXPECT_EQ(read[i].begin, all[i].begin);
  }
  EXPECT_TRUE(faults::choices_in("").empty());
  for (const faults::Fault& each : faults::all_faults()) {
    EXPECT_EQ(std::string(each.name).find_first_of("@;"), std::string::npos) << each.name;
  }
}

}  // namespace faults_test
}  // namespace repel::runs
