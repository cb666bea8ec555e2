// SPDX-License-Identifier: BSD-3-Clause
#include "camera_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <system_error>

#include <repel/base/setup_error.hpp>
#include <repel/common/text_file.hpp>

#include "grammar.hpp"
#include "pose_reader.hpp"

namespace repel::scene::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_images = 1'000'000;
constexpr double most_seconds = 1e10;  // of a time stamp: those of Unix time, to a microsecond

[[noreturn]] void refuse(const fs::path& path, const std::string& what) {
  throw SetupError("the recording '" + path.string() + "' " + what);
}

/// [s] The time in the name of an image.
double time_of(const fs::path& image) {
  const std::string stem = image.stem().string();
  double time = 0.0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), time);
  if (error != std::errc{} || end != stem.data() + stem.size() || !std::isfinite(time)) {
    refuse(image, "has no time stamp for a name; allowed: seconds, as in 12.345.png");
  }
  if (std::abs(time) > most_seconds) {
    refuse(image, "is of " + to_text(time) + " s; allowed: " + to_text(-most_seconds) + " to " +
                      to_text(most_seconds) + " s");
  }
  return time;
}

std::vector<RecordedImage> images_in(const fs::path& folder) {
  std::vector<RecordedImage> images;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".png") continue;
    images.push_back({time_of(entry.path()), entry.path().string()});
    if (images.size() > most_images) {
      refuse(folder, "has too many images; allowed: up to " + std::to_string(most_images));
    }
  }
  if (error) refuse(folder, "cannot be read: " + error.message());
  if (images.empty()) refuse(folder, "has no images; allowed: files such as 12.345.png");
  std::sort(images.begin(), images.end(),
            [](const RecordedImage& a, const RecordedImage& b) { return a.time < b.time; });
  const auto same = std::adjacent_find(
      images.begin(), images.end(),
      [](const RecordedImage& a, const RecordedImage& b) { return !(a.time < b.time); });
  if (same != images.end()) {
    refuse(same->file, "has the time stamp of '" + std::next(same)->file + "'; allowed: one each");
  }
  return images;
}

/// A camera at `position` that looks at a point, `look_at`, its image upright; or with
/// `orientation`, a quaternion x y z w of its axes.
Pose pose_of_camera(const Map& map) {
  Pose X = Pose::Identity();
  X.translation() = map.vector("position");
  if (const Value* const orientation = map.find("orientation")) {
    if (const Value* const look_at = map.find("look_at")) {
      look_at->fail("'look_at' beside 'orientation'; allowed: one of the two");
    }
    const std::vector<double> q = orientation->numbers({unit::none, -1.0, 1.0}, 4, 4);
    const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
    if (!(std::abs(turn.norm() - 1.0) <= 1e-3)) {
      orientation->fail_with_value("x y z w of a rotation, the sum of whose squares is 1");
    }
    X.linear() = turn.normalized().toRotationMatrix();
    return X;
  }
  const Value& at = map.at("look_at");
  const Vec3 axis = at.vector(position) - X.translation();
  if (axis.norm() < 1e-3) at.fail_with_value("a point 1 mm or more from the camera");
  const Vec3 z = axis.normalized();
  // Looking straight up or down, the top of the image is towards x.
  const Vec3 up = std::abs(z.z()) > 0.999 ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
  const Vec3 x = z.cross(up).normalized();
  X.linear() << x, z.cross(x), z;
  return X;
}

/// Reads `camera.yaml` of a folder, and lists the images beside it in `depth`, in the order of
/// their time stamps. An image is named by its time stamp. Sets the pose, the size, the focal
/// lengths, and the mean rate of `camera`.
/// @throws SetupError naming file, line and value of what is wrong
RecordingChoice recording_of(const std::string& folder, CameraChoice& camera) {
  const std::string file = (fs::path(folder) / "camera.yaml").string();
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {  // a pipe would be waited for
    throw SetupError("there is no such file; allowed: what the images do not say", file);
  }
  const Value document = Value::document(text_of_file(file, "a recorded camera"), file);
  static const Keys keys{key::integer("width", 16, 1920).required(),
                         key::integer("height", 16, 1080).required(),
                         key::number("fx", unit::none, 1.0, 1e5).required(),
                         key::number("fy", unit::none, 1.0, 1e5).required(),
                         key::number("cx", unit::none, -1e5, 1e5).required(),
                         key::number("cy", unit::none, -1e5, 1e5).required(),
                         key::number("unit", unit::length, 1e-6, 1.0),
                         key::vector("position", position),
                         key::vector("look_at", position),
                         key::any("orientation")};
  const Map map(document, keys);
  RecordingChoice recording;
  recording.folder = folder;
  camera.width = static_cast<int>(map.integer("width"));
  camera.height = static_cast<int>(map.integer("height"));
  recording.fx = map.number("fx");
  recording.fy = map.number("fy");
  recording.cx = map.number("cx");
  recording.cy = map.number("cy");
  map.read("unit", recording.unit);
  camera.X_WC = pose_of_camera(map);
  recording.images = images_in(fs::path(folder) / "depth");
  const std::size_t count = recording.images.size();
  if (count > 1) {
    const double duration = recording.images.back().time - recording.images.front().time;
    camera.rate_hz = static_cast<double>(count - 1) / duration;
    if (!(camera.rate_hz <= 1.001 * most_camera_rate_hz)) {  // stamps are rounded
      refuse(folder, "has " + to_text(camera.rate_hz, 3) + " images in a second; allowed: up to " +
                         to_text(most_camera_rate_hz));
    }
  }
  return recording;
}

constexpr std::size_t most_cameras = 8;
constexpr int most_seen = 2000;  // parts that are reserved for what all cameras see

/// What is wrong with the images of a camera.
void read_faults(const Map& map, CameraChoice& camera) {
  map.read("noise", camera.noise);
  map.read("lost", camera.lost);
  map.read("seed", camera.seed);
}

/// The rays through the corners of the image, with z = 1.
std::array<Vec3, 4> corner_rays(const CameraChoice& camera) {
  double left = -std::tan(0.5 * camera.view);
  double right = -left;
  double top = left * camera.height / camera.width;
  double bottom = -top;
  if (camera.recording) {
    const RecordingChoice& from = *camera.recording;
    left = (-0.5 - from.cx) / from.fx;
    right = (camera.width - 0.5 - from.cx) / from.fx;
    top = (-0.5 - from.cy) / from.fy;
    bottom = (camera.height - 0.5 - from.cy) / from.fy;
  }
  return {{{left, top, 1.0}, {right, top, 1.0}, {left, bottom, 1.0}, {right, bottom, 1.0}}};
}

/// The map of a camera, in which all that it can see has a place.
std::optional<MapChoice> map_of(const Map& of_camera, const CameraChoice& camera) {
  const Value* const value = of_camera.find("map");
  if (value == nullptr) return {};
  const Map map(*value, grammar::camera_map());
  MapChoice choice;
  map.read("cube", choice.cube);
  map.read("keeps", choice.keeps);
  choice.low = choice.high = camera.X_WC.translation();
  for (const Vec3& ray : corner_rays(camera)) {
    const Vec3 corner = camera.X_WC * (camera.farthest * ray);
    choice.low = choice.low.cwiseMin(corner);
    choice.high = choice.high.cwiseMax(corner);
  }
  constexpr double most = 16e6;
  const double cubes = ((choice.high - choice.low) / choice.cube).array().ceil().prod();
  if (!(cubes <= most)) {
    value->fail("a map of all that the camera can see has " + to_text(cubes, 3) +
                " cubes; allowed: up to " + to_text(most) + ", by larger ones, or less 'farthest'");
  }
  if (camera.is_unseen_solid) {
    of_camera.at("unseen").fail(
        "what is unseen is solid beside 'map'; allowed: 'free', since the arm is in it");
  }
  return choice;
}

/// Where a simulated camera is and what its images are like.
void read_simulated(const Map& map, CameraChoice& camera) {
  camera.X_WC = pose_of_camera(map);
  map.read("width", camera.width);
  map.read("height", camera.height);
  map.read("view", camera.view);
  map.read("rate", camera.rate_hz);
  read_faults(map, camera);
}

/// The same of recorded images.
void read_recorded(const Map& map, CameraChoice& camera) {
  const Value& value = map.at("recording");
  camera.recording = value.located([&] { return recording_of(value.folder(), camera); });
  map.read("repeat", camera.recording->repeats);
}

CameraChoice camera_of(const Value& value, const Laws& laws, const Keys& keys) {
  const Map map(value, keys);
  CameraChoice camera;
  if (map.find("recording") != nullptr) {
    map.refuse({"position", "look_at", "orientation", "width", "height", "view", "rate", "noise",
                "lost", "seed"});
    read_recorded(map, camera);
  } else {
    map.refuse({"repeat"});
    read_simulated(map, camera);
  }
  map.read("nearest", camera.nearest);
  if (const Value* farthest = map.find("farthest")) {
    camera.farthest = farthest->number({unit::length, camera.nearest, 1000.0});
  }
  map.read("latency", camera.latency);
  if (map.find("unseen") != nullptr) camera.is_unseen_solid = map.word("unseen") == "solid";
  map.read("margin", camera.margin);
  map.read("parts", camera.parts);
  map.read("silent_after", camera.silent_after);
  if (!(camera.silent_after > camera.latency + 1.0 / camera.rate_hz)) {
    value.fail(
        "the camera would be silent between two images; allowed: silent_after above "
        "latency and 1 / rate together");
  }
  camera.law = law_called(laws, map);
  camera.map = map_of(map, camera);
  return camera;
}

}  // namespace

std::vector<CameraChoice> cameras_of(const Map& scene, const Laws& laws) {
  std::vector<CameraChoice> cameras;
  const Value* const only = scene.find("camera");
  if (only != nullptr) cameras.push_back(camera_of(*only, laws, grammar::camera()));
  const Value* const all = scene.find("cameras");
  if (all == nullptr) return cameras;
  if (only != nullptr) all->fail("'cameras' beside 'camera'; allowed: one of the two");
  std::set<std::string> names;
  int parts = 0;
  for (const Value& entry : all->list(most_cameras)) {
    CameraChoice& camera = cameras.emplace_back(camera_of(entry, laws, grammar::named_camera()));
    const Map map(entry);
    const Value& name = map.at("name");
    camera.name = name.text();
    // `blind` takes them for something else.
    if (camera.name == "yes" || camera.name == "no") name.fail_with_value("another name");
    require_new(names, map);
    parts += camera.parts;
  }
  if (parts > most_seen) {
    all->fail("the cameras reserve " + std::to_string(parts) + " parts; allowed: up to " +
              std::to_string(most_seen) + " together");
  }
  return cameras;
}

}  // namespace repel::scene::detail
