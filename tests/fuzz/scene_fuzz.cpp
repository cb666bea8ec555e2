// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary text as a scene, as the camera.yaml of recorded images, or as a list of convex parts:
// read, or refused by a SetupError that names the file; the networks of a scene are built or
// refused likewise. Seeds are the scenes of the repository, from whose folder it is run. The role
// of a text is chosen by its contents.
#include <repel/scene/scene.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>

#include <end_to_end/folder.hpp>
#include <fuzz/bytes.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/scene/build_network.hpp>
#include <repel/scene/part_list.hpp>

namespace repel::scene {
namespace {

using fuzz::require;

ArmModel arm_with(std::size_t joints) {
  ArmModel arm;
  arm.links.resize(joints);
  for (ArmLink& link : arm.links) {
    link.lower = -3.0;
    link.upper = 3.0;
  }
  return arm;
}

void check(const Scene& scene) {
  require(scene.rate_hz >= 1.0 && scene.rate_hz <= 1e5, "the rate is in range");
  require(!scene.tool.empty(), "there is a tool");
  for (const Obstacle& obstacle : scene.obstacles) {
    require(is_finite(obstacle.X_WP) && is_rigid(obstacle.X_WP), "a pose is rigid");
    require(std::isfinite(obstacle.shape.reach()), "a shape ends");
    require(obstacle.law.range > 0.0, "a law has a range");
  }
  for (std::size_t i = 0; i <= scene.partners.size(); ++i) {
    const ArmSetup& setup = scene.arm_setup(i);
    require(setup.robot.start.size() == setup.robot.start_types.size(), "starts have kinds");
    try {
      (void)build_network(scene, setup, arm_with(setup.robot.start.size()), scene.rate_hz);
    } catch (const SetupError& error) {
      require(error.file() == scene.file, "an error names the file");
    }
  }
}

/// A scene whose camera has the images in this folder.
std::string scene_with(const std::string& folder) {
  std::string text = test::text_of("scenes/seen.yaml");
  const std::size_t camera = text.find("camera:\n");
  const std::size_t end = text.find("hidden:\n");
  return text.replace(
      camera, end - camera,
      "camera:\n  recording: " + folder + "\n  law: seen\n  silent_after: 1000 s\n");
}

void check_camera(const std::string& text) {
  static const test::Folder folder;
  static const bool has_images = std::filesystem::create_directory(folder / "depth");
  static const std::string first = folder.with("depth/0.5.png", "an image");
  static const std::string second = folder.with("depth/0.6.png", "another");
  static const std::string scene = scene_with(folder / ".");
  require(has_images, "there is a folder for images");
  const std::string file = folder.with("camera.yaml", text);
  try {
    check(parse(scene, "scenes/fuzz.yaml"));
  } catch (const SetupError& error) {
    require(!error.file().empty(), "an error names a file");
  }
}

void check_part_list(const std::string& text) {
  static const test::Folder folder;
  const std::string path = folder.with("fuzz.parts.yaml", text);
  try {
    const PartList list = read_part_list(path);
    for (const std::vector<Vec3>& part : list.parts) {
      for (const Vec3& p : part) require(is_finite(p), "a corner is somewhere");
    }
    require(list.gaps.deepest.size() <= list.gaps.count, "each gap is counted");
  } catch (const SetupError& error) {
    require(error.file() == path, "an error names the file");
  }
}

void check_scene(const std::string& text) {
  const std::string file = "scenes/fuzz.yaml";
  try {
    check(parse(text, file));
  } catch (const SetupError& error) {
    require(error.file() == file, "an error names the file");
  }
}

}  // namespace
}  // namespace repel::scene

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  const auto has = [&](std::string_view word) { return text.find(word) != std::string::npos; };
  if (has("fx:") && !has("robot")) {
    repel::scene::check_camera(text);
  } else if (has("uncovered:") && !has("robot")) {
    repel::scene::check_part_list(text);
  } else {
    repel::scene::check_scene(text);
  }
  return 0;
}
