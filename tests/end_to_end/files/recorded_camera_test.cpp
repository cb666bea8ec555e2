// SPDX-License-Identifier: BSD-3-Clause
// Depth images that were recorded, in place of those of a simulated camera.
#include <cmath>

#include "end_to_end/teleop.hpp"
#include "percepts/png.hpp"

#include <repel/percepts/simulated_camera.hpp>
#include <repel/runs/cameras/sights.hpp>
#include <repel/runs/setup/prepared_run.hpp>

namespace repel::test {
namespace recorded_camera_test {

using nlohmann::json;

constexpr int width = 320;
constexpr int height = 240;
constexpr int count = 60;
constexpr double rate = 30.0;     // [Hz]
constexpr double begin = 1234.5;  // [s] of the first time stamp

/// The scene with its arm at rest, and with other lines about the camera.
std::string still_scene(const std::string& camera) {
  std::string text = text_of(REPEL_SOURCE "/scenes/seen.yaml");
  text.replace(text.find("../robots"), 9, REPEL_SOURCE "/robots");
  text.resize(text.find("script:\n"));
  const std::size_t from = text.find("camera:\n");
  return text.replace(from, text.find("hidden:\n") - from, camera);
}

const std::string parts =
    "  nearest: 300 mm\n  farthest: 2.5 m\n  latency: 33 ms\n  margin: 10 mm\n"
    "  parts: 600\n  law: seen\n";
const std::string simulated =
    "camera:\n  position: 1.25 0.35 0.95 m\n  look_at: 0.50 -0.10 0.15 m\n  view: 60 deg\n" + parts;

std::string recorded(const std::string& folder, const std::string& more = "") {
  return still_scene("camera:\n  recording: " + folder + "\n" + more + parts);
}

/// A folder with what the simulated camera of the scene sees in two seconds, in millimetres.
class Recording {
 public:
  Recording() {
    fs::create_directory(depth());
    const double f = 0.5 * width / std::tan(0.5 * std::acos(-1.0) / 3.0);
    (void)folder_.with("camera.yaml", "width: 320\nheight: 240\nfx: " + std::to_string(f) +
                                          "\nfy: " + std::to_string(f) +
                                          "\ncx: 159.5\ncy: 119.5\nunit: 1 mm\n"
                                          "position: 1.25 0.35 0.95 m\n"
                                          "look_at: 0.50 -0.10 0.15 m\n");
    const scene::Scene scene =
        scene::parse(still_scene(simulated), REPEL_SOURCE "/scenes/still.yaml");
    runs::RunOptions options;
    options.fast = true;
    const auto prepared = runs::prepare(scene, options);
    runs::Sights sights(prepared->scene, prepared->robots, prepared->cell);
    percepts::DepthCamera camera{.width = width, .height = height, .fx = f, .fy = f};
    camera.cx = 159.5, camera.cy = 119.5, camera.nearest = 0.3, camera.farthest = 2.5;
    percepts::SimulatedCamera simulated_camera(camera, sights.meshes());
    TickRecord record;
    const std::vector<double>& start = prepared->cell.description().arms[0].start;
    std::copy(start.begin(), start.end(), record.q.begin());
    const TickRecord* const records[] = {&record};
    std::vector<Pose> X(sights.size());
    std::vector<float> image(camera.pixels());
    for (int i = 0; i < count; ++i) {
      record.time = i / rate;
      sights.place(records, X);
      for (Pose& each : X) each = prepared->scene.cameras[0].X_WC.inverse() * each;
      simulated_camera.take(X, image);
      std::vector<std::uint16_t> pixels;
      for (const float z : image) {
        pixels.push_back(static_cast<std::uint16_t>(std::lround(1e3 * static_cast<double>(z))));
      }
      percepts::test::write_png(name(i), width, height, pixels);
    }
  }
  [[nodiscard]] std::string depth() const { return folder_ / "depth"; }
  [[nodiscard]] std::string name(int i) const {
    return depth() + "/" + std::to_string(begin + i / rate) + ".png";
  }
  [[nodiscard]] std::string path() const { return folder_ / "."; }
  [[nodiscard]] const Folder& folder() const { return folder_; }

 private:
  Folder folder_;
};

json run_of(const std::string& scene, double seconds) {
  const Folder folder;
  const Ending ending = teleop(quoted(folder.with("scene.yaml", scene)) + " --fast --seconds " +
                               std::to_string(seconds) + " --report " + quoted(folder / "r.json"));
  EXPECT_EQ(ending.status, 0) << ending;
  return report_of(folder / "r.json");
}

double nearest_seen(const json& report) {
  for (const json& obstacle : report.at("obstacles")) {
    if (obstacle.at("name") == "seen") return obstacle.at("nearest_m");
  }
  return -1.0;
}

TEST(RecordedCamera, MakesThePartsThatTheSimulatedOneMakes) {
  const Recording recording;
  const json then = run_of(still_scene(simulated), 1.9);
  const json now = run_of(recorded(recording.path()), 1.9);
  const json& a = then.at("camera");
  const json& b = now.at("camera");
  SCOPED_TRACE(a.dump(1) + b.dump(1));
  EXPECT_NEAR(a.at("images"), b.at("images"), 1);
  EXPECT_GT(b.at("images"), 50);
  EXPECT_EQ(b.at("images_lost"), 0);
  EXPECT_EQ(b.at("silent_s"), 0.0);
  EXPECT_GT(a.at("most_cells"), 50);
  EXPECT_NEAR(a.at("most_cells"), b.at("most_cells"), 0.1 * a.at("most_cells").get<double>());
  EXPECT_NEAR(a.at("least_clearance_m"), b.at("least_clearance_m"), 1e-4);
  EXPECT_NEAR(nearest_seen(then), nearest_seen(now), 0.002);
}

TEST(RecordedCamera, IsSilentAtItsEndUnlessItRepeats) {
  const Recording recording;
  const double end = run_of(recorded(recording.path()), 3.0).at("camera").at("silent_s");
  EXPECT_NEAR(end, 3.0 - (count - 1) / rate - 0.2, 0.02);
  const json again = run_of(recorded(recording.path(), "  repeat: yes\n"), 5.0).at("camera");
  EXPECT_EQ(again.at("silent_s"), 0.0);
  EXPECT_NEAR(again.at("images"), 150, 2);
}

TEST(RecordedCamera, LosesImagesThatAreDamaged) {
  const Recording recording;
  for (const int i : {10, 11, 12, 30}) {
    fs::resize_file(recording.name(i), fs::file_size(recording.name(i)) / 2);
  }
  const json camera = run_of(recorded(recording.path()), 1.9).at("camera");
  EXPECT_EQ(camera.at("images_lost"), 4);
  EXPECT_GT(camera.at("images"), 45);
}

TEST(RecordedCamera, UsesTheLastOfTheImagesOfATickAndCountsTheOthers) {
  const Recording recording;
  for (int i = 0; i < count; ++i) {
    fs::rename(recording.name(i), recording.depth() + "/" + std::to_string(1e-3 * i) + ".png");
  }
  const json camera = run_of(recorded(recording.path(), "  repeat: yes\n"), 1.0).at("camera");
  const int used = camera.at("images");
  EXPECT_GT(used, 350) << camera.dump(1);
  EXPECT_NEAR(used + camera.at("images_lost").get<int>(), 1000, 40) << "those of its latency";
}

// Of images 1e-300 s apart that repeat, no tick would ever have taken the last.
TEST(RecordedCamera, IsRefusedIfItsImagesAreFasterThanThoseOfACamera) {
  const Recording recording;
  const auto refusal = [&](const std::string& first, const std::string& second) {
    const Folder pair;
    fs::create_directory(pair / "depth");
    fs::copy(recording.folder() / "camera.yaml", pair / "camera.yaml");
    fs::copy(recording.name(0), pair / ("depth/" + first + ".png"));
    fs::copy(recording.name(1), pair / ("depth/" + second + ".png"));
    try {
      (void)scene::parse(recorded(pair / ".", "  repeat: yes\n"),
                         REPEL_SOURCE "/scenes/still.yaml");
    } catch (const SetupError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto says = [](const std::string& text, const char* what) {
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  says(refusal("1e-300", "2e-300"), "has 1e+300 images in a second; allowed: up to 1000");
  says(refusal("0.000000001", "0.000000002"), "has 1e+09 images in a second");
  says(refusal("0", "1e300"), "is of 1e+300 s; allowed: -1e+10 to 1e+10 s");
  EXPECT_EQ(refusal("1305031102.175", "1305031102.176"), "accepted");
}

TEST(RecordedCamera, IsRefusedWithFileAndValue) {
  const Recording recording;
  const auto says = [&](const std::string& what, const std::string& more = "") {
    const Folder folder;
    const Ending ending =
        teleop(quoted(folder.with("scene.yaml", recorded(recording.path(), more))) + " --fast");
    EXPECT_EQ(ending.status, 1) << ending;
    EXPECT_TRUE(ending.says(what)) << ending;
  };
  says("position", "  position: 0 0 0 m\n");
  says("repeat", "  repeat: often\n");
  const std::string wrong = recording.name(5);
  percepts::test::write_png(wrong, 20, 10, std::vector<std::uint16_t>(200));
  says("20 x 10 pixels of 1 x 16 bits; allowed: 320 x 240");
  fs::rename(wrong, recording.depth() + "/first.png");
  says("first.png' has no time stamp");
  fs::rename(recording.depth() + "/first.png", recording.depth() + "/1234.50.png");
  says("has the time stamp of");
  const std::string file = "camera.yaml";
  const std::string text = text_of(recording.folder() / file);
  (void)recording.folder().with(file, text + "speed: 1\n");
  says("camera.yaml:10");
  (void)recording.folder().with(file, "width: 320\n");
  says("height");
  fs::remove(recording.folder() / file);
  says(file);
}

}  // namespace recorded_camera_test
}  // namespace repel::test
