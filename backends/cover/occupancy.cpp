#include <repel/cover/occupancy.hpp>

#include <algorithm>
#include <string>

#include <repel/base/setup_error.hpp>

namespace repel::cover {
namespace {

/// Cubes from `low` to `high`, both included.
struct CubeRange {
  std::array<int, 3> low, high;

  [[nodiscard]] bool all(const auto& is_true) const {
    for (int z = low[2]; z <= high[2]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) {
          if (!is_true(x, y, z)) return false;
        }
      }
    }
    return true;
  }
};

/// Grows by one layer in a direction if that is solid.
bool grow(const OccupancyGrid& grid, CubeRange& range, std::size_t axis, bool upwards) {
  CubeRange layer = range;
  const int next = upwards ? range.high[axis] + 1 : range.low[axis] - 1;
  if (next < 0 || next >= grid.size[axis]) return false;
  layer.low[axis] = layer.high[axis] = next;
  if (!layer.all([&](int x, int y, int z) { return grid.solid[grid.place(x, y, z)] != 0; })) {
    return false;
  }
  (upwards ? range.high : range.low)[axis] = next;
  return true;
}

std::vector<Vec3> corners_of_range(const OccupancyGrid& grid, const CubeRange& range) {
  std::vector<Vec3> corners;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 p = grid.low;
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const bool is_high = ((corner >> axis) & 1) != 0;
      p[axis] += grid.edge * (is_high ? range.high[k] + 1 : range.low[k]);
    }
    corners.push_back(p);
  }
  return corners;
}

}  // namespace

OccupancyGrid coarser(const OccupancyGrid& grid, int factor) {
  (void)checked("factor of the cubes", factor, 1, 1'000'000, "");
  OccupancyGrid coarse{grid.low, factor * grid.edge, {}, {}};
  for (std::size_t k = 0; k < 3; ++k) coarse.size[k] = (grid.size[k] + factor - 1) / factor;
  coarse.solid.assign(coarse.place(0, 0, coarse.size[2]), 0);
  for (int z = 0; z < grid.size[2]; ++z) {
    for (int y = 0; y < grid.size[1]; ++y) {
      for (int x = 0; x < grid.size[0]; ++x) {
        if (grid.solid[grid.place(x, y, z)] == 0) continue;
        coarse.solid[coarse.place(x / factor, y / factor, z / factor)] = 1;
      }
    }
  }
  return coarse;
}

std::vector<std::vector<Vec3>> boxes_of(const OccupancyGrid& grid, int most) {
  std::vector<std::vector<Vec3>> boxes;
  std::vector<std::uint8_t> is_covered(grid.solid.size(), 0);
  std::size_t count = 0;
  const CubeRange whole{{0, 0, 0}, {grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1}};
  (void)whole.all([&](int x, int y, int z) {
    const std::size_t seed = grid.place(x, y, z);
    if (grid.solid[seed] == 0 || is_covered[seed] != 0) return true;
    CubeRange range{{x, y, z}, {x, y, z}};
    for (bool grows = true; grows;) {
      grows = false;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool upwards : {false, true}) grows = grow(grid, range, axis, upwards) || grows;
      }
    }
    (void)range.all([&](int u, int v, int w) {
      is_covered[grid.place(u, v, w)] = 1;
      return true;
    });
    ++count;
    if (static_cast<int>(count) <= most) boxes.push_back(corners_of_range(grid, range));
    return true;
  });
  if (static_cast<int>(count) > most) {
    throw SetupError("the map needs " + std::to_string(count) + " boxes; allowed: up to " +
                     std::to_string(most) + ", see --parts, or larger cubes, see --cube");
  }
  return boxes;
}

}  // namespace repel::cover
