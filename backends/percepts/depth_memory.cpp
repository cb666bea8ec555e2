// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/depth_memory.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace repel::percepts {

DepthMemory::DepthMemory(const DepthCamera& camera, double keeps)
    : camera_(checked(camera)),
      keeps_(repel::checked("keeps", keeps, 0.0, 1e6, "s")),
      depths_(camera.pixels(), 0.0F),
      times_(camera.pixels(), 0.0) {}

/// Whether a pixel measured beside another has a depth like that, or none beside it is measured.
bool DepthMemory::is_likely(std::span<const float> depth, std::size_t at, float z) const noexcept {
  const int column = static_cast<int>(at) % camera_.width;
  const int row = static_cast<int>(at) / camera_.width;
  bool is_alone = true;
  for (int v = std::max(row - 1, 0); v <= std::min(row + 1, camera_.height - 1); ++v) {
    for (int u = std::max(column - 1, 0); u <= std::min(column + 1, camera_.width - 1); ++u) {
      const float beside = depth[camera_.at(u, v)];
      if (!camera_.measures(beside)) continue;
      if (std::abs(beside - z) < 0.05F * z) return true;
      is_alone = false;
    }
  }
  return is_alone;
}

int DepthMemory::fill(std::span<float> depth, double time) noexcept {
  if (depth.size() < depths_.size()) return 0;
  // First what is lost: the others must not yet be filled in.
  for (std::size_t i = 0; i < depths_.size(); ++i) {
    const bool is_lost = !camera_.measures(depth[i]) && !(depth[i] < 0.0F) && depths_[i] > 0.0F;
    if (is_lost && !is_likely(depth, i, depths_[i])) depths_[i] = 0.0F;
  }
  int filled = 0;
  for (std::size_t i = 0; i < depths_.size(); ++i) {
    if (camera_.measures(depth[i])) {
      depths_[i] = depth[i];
      times_[i] = time;
      continue;
    }
    const bool is_behind_robot = depth[i] < 0.0F;
    if (is_behind_robot) {
      times_[i] = time;  // its time begins when the robot gives it free
    } else if (!(time - times_[i] <= keeps_)) {
      depths_[i] = 0.0F;
    }
    depth[i] = depths_[i];
    filled += depths_[i] > 0.0F ? 1 : 0;
  }
  return filled;
}

void DepthMemory::forget() noexcept {
  std::fill(depths_.begin(), depths_.end(), 0.0F);
}

}  // namespace repel::percepts
