// SPDX-License-Identifier: BSD-3-Clause
// The program as a browser sees it.
#include <repel/robots/urdf.hpp>

#include "end_to_end/live.hpp"

namespace repel::test {
namespace live_test {

const Vec3 down(0, 0, -0.1);
const Vec3 up(0, 0, 0.1);

bool touches(const Json& frame) {
  return force_of(frame) > 5.0;
}

TEST(Live, APageIsToldAllPartsAndSeesThemMove) {
  LiveTeleop program({"anderson_4x8"});
  LivePage page(program);
  const Json scene = page.await("scene");
  ASSERT_FALSE(scene.is_null());
  EXPECT_EQ(scene.at("name"), "anderson_4x8");
  EXPECT_EQ(scene.at("mode"), "live");
  EXPECT_EQ(scene.at("parts").size(), 4U + 11U + 8U);
  EXPECT_EQ(scene.at("pairs").size(), 120U);
  int obstacles = 0;
  for (const Json& part : scene.at("parts")) {
    EXPECT_FALSE(part.at("levels").empty());
    EXPECT_FALSE(part.at("levels")[0].at("triangles").empty()) << part.at("name");
    obstacles += part.at("group") == "obstacle" ? 1 : 0;
  }
  EXPECT_EQ(obstacles, 8);
  const Json& base = scene.at("visuals").at(0);
  EXPECT_EQ(base.at("name"), "base_link");
  EXPECT_EQ(base.at("body"), 0);
  EXPECT_EQ(page.await("operator").at("by"), "script");
  const Json first = page.await("frame", [](const Json& f) { return f.at("tick") > 0; });
  ASSERT_FALSE(first.is_null());
  const Json later = page.await("frame", [&](const Json& f) {
    return f.at("tick") > first.at("tick") && f.at("bodies") != first.at("bodies");
  });
  ASSERT_FALSE(later.is_null());
  EXPECT_EQ(later.at("bodies").size(), scene.at("bodies").size());
  EXPECT_EQ(page.await("timing").at("dropped"), 0);
  EXPECT_EQ(program.interrupt().status, 0);
}

TEST(Live, TheBaseOfEachRobotIsShownWhereItStands) {
  LiveTeleop program({"two_arms"});
  LivePage page(program);
  const Json scene = page.await("scene");
  ASSERT_FALSE(scene.is_null());
  ASSERT_EQ(scene.at("arms").size(), 2U);
  ASSERT_TRUE(scene.contains("visuals"));
  std::vector<Json> feet[2];
  for (const Json& each : scene.at("visuals")) {
    EXPECT_EQ(each.contains("color"), reads_meshes()) << "else it shows its collision parts";
    EXPECT_FALSE(each.at("triangles").empty());
    for (const Json& vertex : each.at("triangles")) {
      EXPECT_LT(3 * vertex.get<std::size_t>(), each.at("vertices").size());
    }
    if (each.at("name") == "base_link") feet[each.at("arm").get<std::size_t>()].push_back(each);
    for (const Json& part : scene.at("parts")) {
      EXPECT_FALSE(part.at("body") == each.at("body") && part.at("pose") == each.at("pose") &&
                   part.at("levels")[0].at("vertices").size() == each.at("vertices").size())
          << "it is a part already";
    }
  }
  for (const std::vector<Json>& of_arm : feet) {
    ASSERT_EQ(of_arm.size(), 2U) << "housing, and what is dark; or foot and column";
    for (const Json& each : of_arm) EXPECT_EQ(each.at("body"), 0) << "the world";
  }
  EXPECT_NE(feet[0][0].at("pose"), feet[1][0].at("pose"));
  EXPECT_EQ(program.interrupt().status, 0);
}

TEST(Live, PartsHaveTheColoursAndTheObstacleOfTheScene) {
  LiveTeleop program({"glove_box_mesh"});
  LivePage page(program);
  const Json scene = page.await("scene");
  ASSERT_FALSE(scene.is_null());
  int panes = 0;
  for (const Json& part : scene.at("parts")) {
    const std::string name = part.at("name");
    const bool is_glass = name.starts_with("glass/");
    panes += is_glass ? 1 : 0;
    EXPECT_EQ(part.contains("color"), part.at("group") == "obstacle") << name;
    EXPECT_EQ(part.contains("opacity"), is_glass) << name;
    EXPECT_EQ(part.value("of", ""), is_glass                     ? "glass"
                                    : name.starts_with("frame/") ? "frame"
                                                                 : "")
        << name;
  }
  EXPECT_EQ(panes, 4);
  EXPECT_EQ(program.interrupt().status, 0);
}

TEST(Live, ADrivenToolIsHeldUpByTheTable) {
  LiveTeleop program({"anderson_4x8"});
  LivePage page(program);
  const Json scene = page.await("scene");
  ASSERT_FALSE(page.take().is_null());
  const Json frame = page.drive(down, [](const Json& f) {
    if (!touches(f)) return false;
    for (const Json& pair : f.at("pairs")) {
      if (pair.at("f") > 1.0) return true;
    }
    return false;
  });
  ASSERT_FALSE(frame.is_null());
  const Json& nearest = frame.at("pairs")[0];
  const auto part = scene.at("pairs")[nearest.at("i").get<std::size_t>()][1].get<std::size_t>();
  EXPECT_EQ(scene.at("parts")[part].at("name"), "table");
  EXPECT_LT(nearest.at("d"), 0.02);
  EXPECT_EQ(frame.at("phase"), "");
  EXPECT_TRUE(frame.contains("script_over"));
  EXPECT_GT(frame.at("arms")[0].at("force")[2], 0.0) << "it is pushed up";
  page.say({{"type", "release"}});
  const Json who = page.await("operator", [](const Json& o) { return o.at("by") == "nobody"; });
  EXPECT_FALSE(who.is_null());
  EXPECT_EQ(program.interrupt().status, 0);
}

TEST(Live, OfTwoPagesOneDrives) {
  LiveTeleop program({"plates"});
  LivePage one(program);
  LivePage two(program);
  ASSERT_FALSE(one.take().is_null());
  EXPECT_EQ(two.refusal_of({{"type", "take"}}), "another page has the controls");
  EXPECT_EQ(two.refusal_of({{"type", "pause"}}), "another page has the controls");
  one.say({{"type", "release"}});
  EXPECT_FALSE(
      one.await("operator", [](const Json& o) { return o.at("by") == "nobody"; }).is_null());
  EXPECT_FALSE(two.take().is_null());
}

const std::string secret = "0f1e2d3c4b5a69788796a5b4c3d2e1f0";

/// Opens a page that sends this secret.
void present(LivePage& page, const std::string& text) {
  page.say({{"type", "secret"}, {"secret", text}});
}

TEST(Live, WhereOtherMachinesReachItASecretIsNeeded) {
  const Folder folder;
  const std::string path = folder.with("secret", secret + "\nnot this\n");
  LiveTeleop program({"plates", "--secret", path, "--plain"}, "0.0.0.0:0");
  LivePage stranger(program);
  present(stranger, "not this");
  EXPECT_EQ(stranger.page().await_close(), 4401);
  LivePage page(program);
  present(page, secret);
  ASSERT_FALSE(page.await("scene").is_null());
  ASSERT_FALSE(page.take().is_null());
  page.page().close();
  const Ending ending = program.interrupt();
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("#secret=")) << "how to add it: " << ending;
  EXPECT_FALSE(ending.says(secret)) << ending;
}

TEST(Live, TheSecretCanComeFromTheEnvironment) {
  ASSERT_EQ(::setenv("REPEL_TEST_SECRET", secret.c_str(), 1), 0);
  LiveTeleop program({"plates", "--secret-env", "REPEL_TEST_SECRET"});
  (void)::unsetenv("REPEL_TEST_SECRET");
  LivePage page(program);
  present(page, secret);
  EXPECT_FALSE(page.await("scene").is_null());
}

TEST(Live, ListeningForOthersWithoutASecretEndsWithTwoAndSaysWhatToAdd) {
  for (const char* place : {"0.0.0.0:0", "[::]:0", "192.0.2.1:8448", "[2001:db8::1]:8448"}) {
    const Ending ending = teleop(std::string("plates --view --listen ") + place);
    EXPECT_EQ(ending.status, 2) << ending;
    for (const char* words :
         {place, "--secret FILE", "--secret-env", "--tls self", "--plain", "ssh -L"}) {
      EXPECT_TRUE(ending.says(words)) << words << '\n' << ending;
    }
  }
}

TEST(Live, ListeningForOthersWithoutTlsHasToBeSaidOutLoud) {
  const Folder folder;
  const std::string listen =
      "plates --view --listen 0.0.0.0:0 --secret " + quoted(folder.with("secret", secret));
  const Ending silent = teleop(listen);
  EXPECT_EQ(silent.status, 2) << silent;
  for (const char* words : {"--tls self", "CERTIFICATE,KEY", "--plain"}) {
    EXPECT_TRUE(silent.says(words)) << words << '\n' << silent;
  }
  EXPECT_FALSE(silent.says("--secret FILE")) << silent;
  for (const char* wrong : {" --tls", " --tls both", " --tls a,", " --tls self --plain"}) {
    EXPECT_EQ(teleop(listen + wrong).status, 2) << wrong;
  }
  const Ending missing = teleop(listen + " --tls none.pem,none.pem");
  EXPECT_EQ(missing.status, 1) << missing;
  EXPECT_TRUE(missing.says("none.pem")) << missing;
}

TEST(Live, ACertificateOfItsOwnComesWithItsFingerprint) {
  const Folder folder;
  ASSERT_EQ(::setenv("XDG_STATE_HOME", (folder / "state").c_str(), 1), 0);
  LiveTeleop program({"plates", "--tls", "self"});
  (void)::unsetenv("XDG_STATE_HOME");
  const Ending ending = program.interrupt();
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("https://127.0.0.1:")) << ending;
  EXPECT_TRUE(ending.says("SHA-256")) << ending;
  EXPECT_FALSE(text_of(folder / "state/repel/page.pem").empty());
}

TEST(Live, ASecretThatIsNoneEndsWithTwoAndIsNotShown) {
  const Folder folder;
  const std::string listen = "plates --view --listen 0.0.0.0:0 --plain ";
  for (const std::string& text :
       {std::string(), std::string("\nsecond line is long enough"), std::string("123456789012345"),
        std::string("with spaces within it"), std::string(300, 'x'),
        std::string("\x01\x02\x03\x04\x05\x06\x07\x08\x0e\x0f\x10\x11\x12\x13\x14\x15")}) {
    const std::string path = folder.with("secret", text);
    const Ending ending = teleop(listen + "--secret " + quoted(path));
    EXPECT_EQ(ending.status, 2) << ending;
    EXPECT_TRUE(ending.says(path)) << ending;
    EXPECT_FALSE(text.size() > 3 && ending.says(text)) << ending;
  }
  for (const std::string& wrong :
       {"--secret " + quoted(folder / "none"), std::string("--secret-env REPEL_NOT_SET"),
        "--secret " + quoted(folder / "none") + " --secret-env HOME"}) {
    const Ending ending = teleop(listen + wrong);
    EXPECT_EQ(ending.status, 2) << ending;
  }
}

TEST(Live, WhoMayDriveIsSaidOnTheCommandLine) {
  for (const char* wrong : {"--view-only", "--view --page-drives", "--secret file",
                            "--view --view-only --page-drives --device spacenav",
                            "--view --listen localhost:0", "--view --listen 127.0.0.1:70000"}) {
    const Ending ending = teleop(std::string("plates ") + wrong);
    EXPECT_EQ(ending.status, 2) << ending;
  }
  const Ending help = teleop("run --help");
  for (const char* option :
       {"--secret", "--secret-env", "--tls", "--plain", "--view-only", "--page-drives"}) {
    EXPECT_TRUE(help.says(option)) << option;
  }
}

TEST(Live, ViewOnlyIsToLookOn) {
  LiveTeleop program({"plates", "--view-only"});
  LivePage page(program);
  EXPECT_EQ(page.await("operator").at("looks_on"), true);
  for (const char* type : {"take", "pause", "restart", "step", "servo_cv"}) {
    EXPECT_EQ(page.refusal_of({{"type", type}}), "pages look on only") << type;
  }
  const Json first = page.await("frame", [](const Json& f) { return f.at("tick") > 0; });
  ASSERT_FALSE(first.is_null());
  EXPECT_NE(first.at("phase"), "") << "the script goes on";
}

// The page controls one of the two arms; the other continues its script.
TEST(Live, OfTwoArmsTheFirstIsDriven) {
  LiveTeleop program({"two_arms"});
  LivePage page(program);
  EXPECT_EQ(page.await("scene").at("arms").size(), 2U);
  ASSERT_FALSE(page.take().is_null());
  const Json first = page.drive(up, [](const Json& f) { return f.at("tick") > 0; });
  ASSERT_FALSE(first.is_null());
  const Json later = page.drive(up, [&](const Json& f) {
    return f.at("arms")[0].at("v")[2] > 0.02 &&
           f.at("arms")[1].at("q") != first.at("arms")[1].at("q");
  });
  EXPECT_FALSE(later.is_null());
}

// First silent, with the forces faded out; then available to another page.
TEST(Live, WhoeverIsKilledAtTheControlsLosesThem) {
  LiveTeleop program({"anderson_4x8"});
  LivePage other(program);
  {
    LivePage driver(program);
    ASSERT_FALSE(driver.take().is_null());
    ASSERT_FALSE(driver.drive(down, touches).is_null());
    driver.page().line().reset();
  }
  const Json silent =
      other.await("frame", [](const Json& f) { return has_status(f, "silent_device"); });
  ASSERT_FALSE(silent.is_null());
  const Json faded =
      other.await("frame", [](const Json& f) { return f.at("arms")[0].at("gain") == 0.0; });
  ASSERT_FALSE(faded.is_null());
  const Json who = other.await("operator", [](const Json& o) { return o.at("by") == "nobody"; });
  ASSERT_FALSE(who.is_null());
  ASSERT_FALSE(other.take().is_null());
  const Json again = other.drive(up, [](const Json& f) {
    return !has_status(f, "silent_device") && f.at("arms")[0].at("v")[2] > 0.02;
  });
  EXPECT_FALSE(again.is_null());
}

/// Misuse by a page, on connections of its own.
void misbehave(const LiveTeleop& program, int round) {
  WebPage flood(program.port());
  for (int i = 0; i < 1000 && flood.say("{\"type\":\"take\"}x"); ++i) {
  }
  WebPage huge(program.port());
  Frame frame{Frame::text, std::string(1 << 20, 'g')};
  frame.announced = 1U << 30U;
  (void)huge.send(frame);
  EXPECT_EQ(huge.await_close() == 0 ? 1009 : huge.close_code(), 1009);
  Line garbage(program.port());
  (void)garbage.send(std::string(5000, static_cast<char>(round)));
  EXPECT_EQ(ask(program.port(), {"GET", "/", "evil.example"}).status, 403);
}

TEST(Live, FloodsAndGigabytesDoNotReachTheTick) {
  const Folder folder;
  const std::string path = folder / "report.json";
  LiveTeleop program({"anderson_4x8", "--report", path});
  LivePage page(program);
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const Json first = page.await("frame", [](const Json& f) { return f.at("tick") > 0; });
  ASSERT_FALSE(first.is_null());
  const auto begin = now();
  Json last = first;
  for (int round = 0; round < 8; ++round) {
    misbehave(program, round);
    last = page.await("frame", [&](const Json& f) { return f.at("tick") > last.at("tick"); });
    ASSERT_FALSE(last.is_null());
  }
  // The last frame received is up to one frame behind the clock.
  const std::int64_t target = last.at("tick").get<std::int64_t>() + 800;
  last = page.await("frame", [&](const Json& f) { return f.at("tick") >= target; });
  ASSERT_FALSE(last.is_null());
  const double passed = std::chrono::duration<double>(now() - begin).count();
  // A machine that stands still skips ticks, and their time passes all the same.
  const double time = last.at("time_s").get<double>() - first.at("time_s").get<double>();
  EXPECT_GT(time, 0.5 * passed);
  EXPECT_LT(time, 2.0 * passed);
  EXPECT_GE(last.at("time_s"), last.at("tick").get<double>() / 400.0);
  const Ending ending = program.interrupt();
  EXPECT_EQ(ending.status, 0) << ending;
  const Json report = report_of(path);
  EXPECT_GE(report.at("ticks"), last.at("tick"));
  EXPECT_EQ(report.at("interrupted"), true);
  for (const char* what : {"allocations_in_tick", "system_calls_in_tick"}) {
    EXPECT_TRUE(report.at(what).is_null() || report.at(what) == 0) << what << report.at(what);
  }
  // It is silent only in its last ticks, when it releases control.
  EXPECT_LE(report.at("status_ticks").value("silent_device", 0), 200);
  for (const char* fault :
       {"bad_pose", "bad_command", "bad_joints", "clock_fault", "expired_pairs", "network_fault"}) {
    EXPECT_EQ(report.at("status_ticks").value(fault, 0), 0) << fault;
  }
}

TEST(Live, PausedItStandsAndAStepIsOneTick) {
  LiveTeleop program({"plates"});
  LivePage page(program);
  ASSERT_FALSE(page.await("frame").is_null());  // there is none before the first tick
  page.say({{"type", "pause"}});
  ASSERT_FALSE(
      page.await("frame", [](const Json& f) { return f.at("running") == false; }).is_null());
  // The running tick may still arrive; after that the same frame is repeated.
  std::int64_t tick = -1;
  const auto stands = [&](const Json& f) {
    const std::int64_t before = std::exchange(tick, f.at("tick").get<std::int64_t>());
    return f.at("running") == false && before == tick;
  };
  ASSERT_FALSE(page.await("frame", stands).is_null());
  for (const int ticks : {1, 1, 5}) {
    tick += ticks;
    const Json frame = page.await(
        "frame", [&](const Json& f) { return f.at("tick") >= tick; },
        [&, said = false]() mutable {
          if (!std::exchange(said, true)) page.say({{"type", "step"}, {"ticks", ticks}});
        });
    ASSERT_FALSE(frame.is_null());
    EXPECT_EQ(frame.at("tick"), tick);
    EXPECT_EQ(frame.at("running"), false);
  }
  EXPECT_EQ(page.await("frame").at("tick"), tick) << "it stands";
  page.say({{"type", "resume"}});
  EXPECT_FALSE(
      page.await("frame", [&](const Json& f) { return f.at("tick") > tick + 50; }).is_null());
}

TEST(Live, ARestartBeginsFromTheBeginningWithTheScript) {
  LiveTeleop program({"plates"});
  LivePage page(program);
  ASSERT_FALSE(page.take().is_null());
  const Json before = page.drive(up, [](const Json& f) { return f.at("tick") > 300; });
  ASSERT_FALSE(before.is_null());
  page.say({{"type", "restart"}});
  const Json after =
      page.await("frame", [&](const Json& f) { return f.at("tick") < before.at("tick"); });
  ASSERT_FALSE(after.is_null());
  EXPECT_NE(after.at("phase"), "");
  ASSERT_FALSE(page.take().is_null());
  EXPECT_FALSE(page.drive(up, [](const Json& f) { return f.at("phase") == ""; }).is_null());
  EXPECT_EQ(program.interrupt().status, 0);
}

/// Records a run controlled by a page, until the tool has been on the table and off again.
void record(const std::string& path) {
  LiveTeleop program({"anderson_4x8", "--log", path});
  LivePage page(program);
  ASSERT_FALSE(page.take().is_null());
  EXPECT_NE(page.refusal_of({{"type", "restart"}}), "") << "a log begins once";
  ASSERT_FALSE(page.drive(down, touches).is_null());
  page.say({{"type", "pause"}});
  page.say({{"type", "step"}, {"ticks", 3}});
  page.say({{"type", "resume"}});
  ASSERT_FALSE(page.drive(up, [](const Json& f) { return force_of(f) == 0.0; }).is_null());
  page.say({{"type", "release"}});
  ASSERT_FALSE(
      page.await("operator", [](const Json& o) { return o.at("by") == "nobody"; }).is_null());
  const Ending ending = program.interrupt();
  ASSERT_EQ(ending.status, 0) << ending;
}

TEST(Live, ARunThatWasDrivenCanBeGoneThroughAgain) {
  const Folder folder;
  record(folder / "run.mcap");
  const Ending ending = teleop("replay " + quoted(folder / "run.mcap") + " --report " +
                               quoted(folder / "report.json"));
  EXPECT_EQ(ending.status, 0) << ending;
  const Json replay = report_of(folder / "report.json").at("replay");
  EXPECT_GT(replay.at("ticks"), 100);
  EXPECT_EQ(replay.at("same"), replay.at("ticks"));
  EXPECT_EQ(replay.at("force_difference_n"), 0.0);
}

TEST(Live, ARecordingCanBeWoundToItsEndAndBack) {
  const Folder folder;
  record(folder / "run.mcap");
  LiveTeleop program({"replay", folder / "run.mcap"});
  LivePage page(program);
  const Json scene = page.await("scene");
  ASSERT_FALSE(scene.is_null());
  EXPECT_EQ(scene.at("mode"), "replay");
  const double duration = scene.at("duration_s");
  EXPECT_EQ(page.refusal_of({{"type", "take"}}), "this is a recording");
  const auto wound_to = [&](double time, double expected) {
    page.say({{"type", "seek"}, {"time_s", time}});
    const Json frame = page.await("frame", [&](const Json& f) {
      return std::abs(f.at("time_s").get<double>() - expected) < 1e-6;
    });
    EXPECT_FALSE(frame.is_null()) << time;
  };
  const double last = duration - 1.0 / 400.0;
  page.say({{"type", "pause"}});
  for (const double time : {0.5, 0.1, 0.3, duration, 0.2, duration + 5.0, 0.0}) {
    wound_to(time, std::min(time, last));
  }
  page.say({{"type", "speed"}, {"factor", 100.0}});
  page.say({{"type", "resume"}});
  wound_to(duration, last);
  page.say({{"type", "speed"}, {"factor", 1.0}});
  // It runs on from there at once, so that the picture of that very moment may be missed.
  page.say({{"type", "seek"}, {"time_s", 0.4}});
  const Json frame = page.await("frame", [&](const Json& f) {
    return f.at("time_s") >= 0.4 - 1e-6 && f.at("time_s") < last - 1e-6;
  });
  EXPECT_FALSE(frame.is_null());
  EXPECT_TRUE(program.runs());
  const Ending ending = program.interrupt();
  EXPECT_EQ(ending.status, 0) << ending;
}

}  // namespace live_test
}  // namespace repel::test
