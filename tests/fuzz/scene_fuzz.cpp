// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary text as a scene: read, or refused by a SetupError that names the file; its networks are
// built or refused likewise. Seeds are the scenes of the repository, from whose folder it is run.
#include <repel/scene/scene.hpp>

#include <cmath>
#include <string>

#include <fuzz/bytes.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/scene/build_network.hpp>

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

}  // namespace
}  // namespace repel::scene

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  const std::string file = "scenes/fuzz.yaml";
  try {
    repel::scene::check(repel::scene::parse(text, file));
  } catch (const repel::SetupError& error) {
    repel::fuzz::require(error.file() == file, "an error names the file");
  }
  return 0;
}
