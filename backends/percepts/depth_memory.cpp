#include <repel/percepts/depth_memory.hpp>

#include <algorithm>
#include <cstddef>

namespace repel::percepts {

DepthMemory::DepthMemory(const DepthCamera& camera, double keeps)
    : camera_(checked(camera)),
      keeps_(repel::checked("keeps", keeps, 0.0, 1e6, "s")),
      depths_(camera.pixels(), 0.0F),
      times_(camera.pixels(), 0.0) {}

int DepthMemory::fill(std::span<float> depth, double time) noexcept {
  if (depth.size() < depths_.size()) return 0;
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
