// SPDX-License-Identifier: BSD-3-Clause
#include "crowding.hpp"

#include <cmath>
#include <cstdint>

#include "brute_force.hpp"

namespace repel::scale {
namespace {

/// Whether more pairs than the target are within range, in the mean over samples of all ticks.
bool is_crowded(const Scene& scene) {
  constexpr int samples = 1000;
  const Setting& setting = scene.setting();
  BruteForce brute(scene);
  const double most = setting.near * samples;
  double near = 0.0;
  for (int i = 0; i < samples && near <= most; ++i) {
    near += brute.count_near(scene.placements(std::int64_t{setting.ticks} * i / samples),
                             static_cast<int>(most - near) + 1);
  }
  return near > most;
}

}  // namespace

Scene crowded_scene(const Setting& setting) {
  Scene scene(setting);
  double low = 0.002;
  double high = 20.0;
  while (high > 1.01 * low) {
    const double middle = std::sqrt(low * high);
    scene.spread(middle);
    (is_crowded(scene) ? low : high) = middle;
  }
  scene.spread(high);
  return scene;
}

}  // namespace repel::scale
