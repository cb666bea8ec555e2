// SPDX-License-Identifier: BSD-3-Clause
#include "camera_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <system_error>

#include <repel/base/setup_error.hpp>
#include <repel/common/text_file.hpp>
#include <repel/reduction/shape.hpp>

namespace repel::scene::detail {
namespace {

namespace fs = std::filesystem;

constexpr Rule camera_position{unit::length, -Shape::largest, Shape::largest};
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

}  // namespace

Pose pose_of_camera(const Map& map) {
  Pose X = Pose::Identity();
  X.translation() = map.at("position").vector(camera_position);
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
  const Vec3 axis = at.vector(camera_position) - X.translation();
  if (axis.norm() < 1e-3) at.fail_with_value("a point 1 mm or more from the camera");
  const Vec3 z = axis.normalized();
  // Looking straight up or down, the top of the image is towards x.
  const Vec3 up = std::abs(z.z()) > 0.999 ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
  const Vec3 x = z.cross(up).normalized();
  X.linear() << x, z.cross(x), z;
  return X;
}

RecordingChoice recording_of(const std::string& folder, CameraChoice& camera) {
  const std::string file = (fs::path(folder) / "camera.yaml").string();
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {  // a pipe would be waited for
    throw SetupError("there is no such file; allowed: what the images do not say", file);
  }
  const Value document = Value::document(text_of_file(file, "a recorded camera"), file);
  const Map map(document);
  map.allow(
      {"width", "height", "fx", "fy", "cx", "cy", "unit", "position", "look_at", "orientation"});
  RecordingChoice recording;
  recording.folder = folder;
  camera.width = static_cast<int>(map.at("width").integer(16, 1920));
  camera.height = static_cast<int>(map.at("height").integer(16, 1080));
  recording.fx = map.at("fx").number({unit::none, 1.0, 1e5});
  recording.fy = map.at("fy").number({unit::none, 1.0, 1e5});
  recording.cx = map.at("cx").number({unit::none, -1e5, 1e5});
  recording.cy = map.at("cy").number({unit::none, -1e5, 1e5});
  map.read("unit", {unit::length, 1e-6, 1.0}, recording.unit);
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

}  // namespace repel::scene::detail
