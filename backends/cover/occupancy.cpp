// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cover/occupancy.hpp>

#include <algorithm>
#include <string>

#include <repel/base/setup_error.hpp>

namespace repel::cover {
namespace {

bool all_of(const CubeRange& range, const auto& is_true) {
  for (int z = range.low[2]; z <= range.high[2]; ++z) {
    for (int y = range.low[1]; y <= range.high[1]; ++y) {
      for (int x = range.low[0]; x <= range.high[0]; ++x) {
        if (!is_true(x, y, z)) return false;
      }
    }
  }
  return true;
}

double reach_of(const OccupancyGrid& grid, const CubeRange& range) {
  Vec3 size = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    size[axis] = range.high[k] + 1 - range.low[k];
  }
  return 0.5 * grid.edge * size.norm();
}

/// Grows by one layer in a direction if that is solid and within reach.
bool grow(const OccupancyGrid& grid, CubeRange& range, std::size_t axis, bool upwards,
          double reach) {
  CubeRange layer = range;
  const int next = upwards ? range.high[axis] + 1 : range.low[axis] - 1;
  if (next < 0 || next >= grid.size[axis]) return false;
  layer.low[axis] = layer.high[axis] = next;
  CubeRange larger = range;
  (upwards ? larger.high : larger.low)[axis] = next;
  if (reach_of(grid, larger) > reach) return false;
  if (!all_of(layer, [&](int x, int y, int z) { return grid.solid[grid.place(x, y, z)] != 0; })) {
    return false;
  }
  range = larger;
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

OccupancyGrid coarser(const OccupancyGrid& grid, int factor, const std::array<int, 3>& before) {
  (void)checked("factor of the cubes", factor, 1, 1'000'000, "");
  OccupancyGrid coarse{grid.low, factor * grid.edge, {}, {}};
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    (void)checked("cubes before the first", before[k], 0, factor - 1, "");
    coarse.low[axis] -= before[k] * grid.edge;
    coarse.size[k] = (before[k] + grid.size[k] + factor - 1) / factor;
  }
  coarse.solid.assign(coarse.place(0, 0, coarse.size[2]), 0);
  for (int z = 0; z < grid.size[2]; ++z) {
    for (int y = 0; y < grid.size[1]; ++y) {
      for (int x = 0; x < grid.size[0]; ++x) {
        if (grid.solid[grid.place(x, y, z)] == 0) continue;
        coarse.solid[coarse.place((x + before[0]) / factor, (y + before[1]) / factor,
                                  (z + before[2]) / factor)] = 1;
      }
    }
  }
  return coarse;
}

CubeRange grown_from(const OccupancyGrid& grid, const std::array<int, 3>& cube, double reach) {
  CubeRange range{cube, cube};
  for (bool grows = true; grows;) {
    grows = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const bool upwards : {false, true}) {
        grows = grow(grid, range, axis, upwards, reach) || grows;
      }
    }
  }
  return range;
}

std::vector<std::vector<Vec3>> boxes_of(const OccupancyGrid& grid, int most) {
  std::vector<std::vector<Vec3>> boxes;
  std::vector<std::uint8_t> is_covered(grid.solid.size(), 0);
  std::size_t count = 0;
  const CubeRange whole{{0, 0, 0}, {grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1}};
  (void)all_of(whole, [&](int x, int y, int z) {
    const std::size_t seed = grid.place(x, y, z);
    if (grid.solid[seed] == 0 || is_covered[seed] != 0) return true;
    const CubeRange range = grown_from(grid, {x, y, z});
    (void)all_of(range, [&](int u, int v, int w) {
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
