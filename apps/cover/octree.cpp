// SPDX-License-Identifier: BSD-3-Clause
#include "octree.hpp"

#include <memory>

#include <repel/base/setup_error.hpp>

#ifdef REPEL_COVER_OCTOMAP
#include <repel/octrees/grid.hpp>
#endif

namespace repel::cover {

bool is_octree(const std::string& path) {
  return path.ends_with(".bt") || path.ends_with(".ot");
}

#ifdef REPEL_COVER_OCTOMAP
OccupancyGrid read_octree(const std::string& path, bool is_unseen_solid) {
  const std::unique_ptr<octomap::OcTree> tree = octrees::read_tree(path);
  if (tree->getNumLeafNodes() == 0) {
    throw SetupError("the map '" + path + "' is empty; allowed: one with a cube");
  }
  const CubeRange range = octrees::known_range(*tree);
  double cubes = 1.0;
  for (std::size_t k = 0; k < 3; ++k) cubes *= range.high[k] + 1 - range.low[k];
  if (!(cubes <= static_cast<double>(OccupancyGrid::most))) {
    throw SetupError("the map '" + path + "' spans " + to_text(cubes, 3) +
                     " cubes; allowed: up to " + std::to_string(OccupancyGrid::most));
  }
  return octrees::grid_of(*tree, range, is_unseen_solid);
}
#else
OccupancyGrid read_octree(const std::string& path, bool /*is_unseen_solid*/) {
  throw SetupError("the map '" + path +
                   "' cannot be read by this build; to have it: apt-get install liboctomap-dev, "
                   "then build again");
}
#endif

}  // namespace repel::cover
