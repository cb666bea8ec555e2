// SPDX-License-Identifier: BSD-3-Clause
// The live view at the operator's side of a divided scene, with the site as another program.
#include <unistd.h>

#include <optional>

#include "end_to_end/live.hpp"

namespace repel::test {
namespace station_view_test {

const Vec3 down(0, 0, -0.06);

/// The scene `remote` with a script that soon rests.
std::string scene_text() {
  std::string text = text_of(REPEL_SOURCE "/scenes/remote.yaml");
  text.resize(text.find("script:"));
  const std::string here = "../robots";
  text.replace(text.find(here), here.size(), REPEL_SOURCE "/robots");
  return text +
         "script:\n  - {name: aside, device: six_axes, duration: 2.5 s, linear: 0 40 0 mm/s}\n";
}

/// A site and a station, both with a view, joined by a link with the delay of the scene. The script
/// waits until the site is there.
class Both {
 public:
  Both() { station_.emplace(arguments("station")); }
  void begin_site() { site_.emplace(arguments("site")); }
  void kill_site() { site_.reset(); }
  [[nodiscard]] LiveTeleop& site() { return *site_; }
  [[nodiscard]] LiveTeleop& station() { return *station_; }
  [[nodiscard]] Json report() const { return report_of(folder_ / "report.json"); }

 private:
  [[nodiscard]] std::vector<std::string> arguments(const std::string& side) const {
    std::vector<std::string> all{side, scene_, "--impaired", "--link", link_};
    if (side == "station") all.insert(all.end(), {"--report", folder_ / "report.json"});
    return all;
  }

  Folder folder_;
  std::string scene_ = folder_.with("scene.yaml", scene_text());
  std::string link_ = "udp:127.0.0.1:" + std::to_string(22000 + getpid() % 20000);
  std::optional<LiveTeleop> site_, station_;
};

Vec3 tool_of(const Json& frame, const Json& scene) {
  const Json& pose = frame.at("bodies")[scene.at("arms")[0].at("tool_body").get<std::size_t>()];
  return {pose[0].get<double>(), pose[1].get<double>(), pose[2].get<double>()};
}

double speed_of(const Json& frame) {
  const Json& v = frame.at("arms")[0].at("v");
  return Vec3(v[0].get<double>(), v[1].get<double>(), v[2].get<double>()).norm();
}

/// The script is over, and the tool has come to rest.
bool rests(const Json& frame) {
  return frame.at("phase").get<std::string>().empty() && speed_of(frame) < 1e-3;
}

/// What a page at the site shows just after the moment that one at the station shows.
Json at_the_site(
    LivePage& page, const Json& frame, const std::function<void()>& meanwhile = [] {}) {
  const double time = frame.at("time_s").get<double>();
  return page.await(
      "frame", [&](const Json& f) { return f.at("time_s").get<double>() >= time; }, meanwhile);
}

TEST(StationView, ShowsWhatThePageAtTheSiteShows) {
  Both both;
  LivePage here(both.station());
  const Json scene = here.await("scene");
  ASSERT_FALSE(scene.is_null());
  EXPECT_TRUE(has_status(here.await("frame"), "silent_site")) << "nobody is there yet";
  both.begin_site();
  LivePage there(both.site());
  EXPECT_EQ(scene.at("parts"), there.await("scene").at("parts"));
  EXPECT_EQ(scene.at("arms")[0].at("modules"), Json::parse(R"(["six_axes", "line"])"));
  const Json moving = here.await("frame", [](const Json& f) {
    return f.at("phase") == "aside" && !has_status(f, "silent_site") && speed_of(f) > 0.02;
  });
  ASSERT_FALSE(moving.is_null());
  EXPECT_EQ(scene.at("scripted"), true);
  EXPECT_FALSE(moving.contains("script_over"));
  const Json resting = here.await("frame", rests);
  ASSERT_FALSE(resting.is_null());
  EXPECT_TRUE(resting.contains("script_over"));
  EXPECT_NE(resting.at("arms")[0].at("q"), moving.at("arms")[0].at("q"));
  EXPECT_GT((tool_of(resting, scene) - tool_of(moving, scene)).norm(), 5e-3);
  const Json same = at_the_site(there, resting);
  ASSERT_FALSE(same.is_null());
  EXPECT_LT((tool_of(resting, scene) - tool_of(same, scene)).norm(), 5e-3);
  const Json timing = here.await("timing");
  EXPECT_EQ(timing.at("dropped"), 0);
  EXPECT_GT(timing.at("ticks"), 100);
  EXPECT_EQ(both.station().interrupt().status, 0);
  const Json report = both.report();
  for (const char* count : {"allocations_in_tick", "system_calls_in_tick"}) {
    const Json& counted = report.at(count);
    EXPECT_TRUE(counted.is_null() || counted == 0) << count << ' ' << counted;
  }
  EXPECT_TRUE(report.at("nearest_m").is_null()) << "nothing is near, from the first packet on";
}

TEST(StationView, APageAtTheStationDrivesTheRobotAndFeelsItsTable) {
  Both both;
  both.begin_site();
  LivePage here(both.station());
  LivePage there(both.site());
  const Json scene = there.await("scene");
  ASSERT_FALSE(scene.is_null());
  const Json who = there.await("operator");
  EXPECT_EQ(who.at("by"), "device");
  EXPECT_EQ(who.at("name"), "The station");
  EXPECT_EQ(there.refusal_of({{"type", "take"}}), "the operator is at the station");
  const Json first = there.await("frame", [](const Json& f) { return f.at("tick") > 0; });
  ASSERT_FALSE(first.is_null());
  ASSERT_FALSE(here.take().is_null());
  const Json pushed = here.drive(down, [](const Json& f) { return force_of(f) > 5.0; });
  ASSERT_FALSE(pushed.is_null());
  const Json held = here.drive(Vec3::Zero(), [&](const Json& f) {
    return f.at("time_s").get<double>() > pushed.at("time_s").get<double>() + 0.5 &&
           speed_of(f) < 1e-3;
  });
  ASSERT_FALSE(held.is_null());
  EXPECT_GT(force_of(held), 3.0);
  ASSERT_FALSE(held.at("pairs").empty());
  const Json same = at_the_site(there, held, [&] {
    here.say({{"type", "servo_cv"},
              {"linear", {0, 0, 0}},
              {"angular", {0, 0, 0}},
              {"frame", "world"},
              {"clutch", true}});
  });
  ASSERT_FALSE(same.is_null());
  EXPECT_LT(tool_of(same, scene).z(), tool_of(first, scene).z() - 0.01);
  EXPECT_LT((tool_of(same, scene) - tool_of(held, scene)).norm(), 5e-3);
  EXPECT_NEAR(force_of(same), force_of(held), 0.1 * force_of(held));
  EXPECT_NEAR(same.at("pairs")[0].at("d").get<double>(), held.at("pairs")[0].at("d").get<double>(),
              1e-3);
  EXPECT_EQ(same.at("pairs")[0].at("i"), held.at("pairs")[0].at("i"));
  // A page that falls silent is an operator who does: the site holds.
  const Json silent =
      there.await("frame", [](const Json& f) { return has_status(f, "silent_device"); });
  EXPECT_FALSE(silent.is_null());
}

TEST(StationView, TheRobotCannotBePausedFromElsewhere) {
  Both both;
  LivePage here(both.station());
  const Json box{{"type", "add_box"}, {"size", {0.1, 0.1, 0.1}}, {"position", {0, 0, 0}}};
  for (const Json& message :
       {Json{{"type", "pause"}}, Json{{"type", "resume"}}, Json{{"type", "step"}, {"ticks", 1}},
        Json{{"type", "restart"}}, box}) {
    EXPECT_EQ(here.refusal_of(message), "the robot is elsewhere: from here it can be driven only");
  }
  EXPECT_EQ(here.refusal_of({{"type", "seek"}, {"time_s", 1.0}}), "no such message for a live run");
  EXPECT_TRUE(here.await("frame").at("running"));
}

TEST(StationView, WithoutTheSiteThePageIsServedAndSaysSo) {
  Both both;
  both.begin_site();
  LivePage here(both.station());
  const Json scene = here.await("scene");
  ASSERT_FALSE(scene.is_null());
  const auto is_heard = [](const Json& f) { return !has_status(f, "silent_site"); };
  const Json heard = here.await("frame", [&](const Json& f) { return is_heard(f) && rests(f); });
  ASSERT_FALSE(heard.is_null());
  both.kill_site();
  const Json silent =
      here.await("frame", [](const Json& f) { return has_status(f, "silent_site"); });
  ASSERT_FALSE(silent.is_null());
  EXPECT_EQ(silent.at("arms")[0].at("gain"), 0.0);
  EXPECT_LT((tool_of(silent, scene) - tool_of(heard, scene)).norm(), 5e-3) << "the last picture";
  LivePage another(both.station());
  EXPECT_EQ(another.await("scene").at("parts"), scene.at("parts"));
  EXPECT_TRUE(has_status(another.await("frame"), "silent_site"));
  both.begin_site();
  EXPECT_FALSE(here.await("frame", is_heard).is_null());
  EXPECT_EQ(both.station().interrupt().status, 0);
}

}  // namespace station_view_test
}  // namespace repel::test
