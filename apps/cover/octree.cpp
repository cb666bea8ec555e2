#include "octree.hpp"

#include <cmath>
#include <memory>

#include <repel/base/setup_error.hpp>

#ifdef REPEL_COVER_OCTOMAP
#include <octomap/OcTree.h>
#endif

namespace repel::cover {

bool is_octree(const std::string& path) {
  return path.ends_with(".bt") || path.ends_with(".ot");
}

#ifdef REPEL_COVER_OCTOMAP
namespace {

std::unique_ptr<octomap::OcTree> load(const std::string& path) {
  const std::string trouble = "the map '" + path + "' cannot be read; allowed: a file of OctoMap";
  if (path.ends_with(".bt")) {
    auto tree = std::make_unique<octomap::OcTree>(0.1);
    if (!tree->readBinary(path)) throw SetupError(trouble);
    return tree;
  }
  std::unique_ptr<octomap::AbstractOcTree> any(octomap::AbstractOcTree::read(path));
  auto* const tree = dynamic_cast<octomap::OcTree*>(any.get());
  if (tree == nullptr) throw SetupError(trouble + " of the type OcTree");
  (void)any.release();
  return std::unique_ptr<octomap::OcTree>(tree);
}

}  // namespace

OccupancyGrid read_octree(const std::string& path, bool is_unseen_solid) {
  const std::unique_ptr<octomap::OcTree> tree = load(path);
  if (tree->getNumLeafNodes() == 0) {
    throw SetupError("the map '" + path + "' is empty; allowed: one with a cube");
  }
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  OccupancyGrid grid;
  grid.edge = tree->getResolution();
  tree->getMetricMin(x, y, z);
  grid.low = {x, y, z};
  tree->getMetricMax(x, y, z);
  const Vec3 extent = (Vec3(x, y, z) - grid.low) / grid.edge;
  if (!(extent.prod() <= static_cast<double>(OccupancyGrid::most))) {
    throw SetupError("the map '" + path + "' spans " + to_text(extent.prod(), 3) +
                     " cubes; allowed: up to " + std::to_string(OccupancyGrid::most));
  }
  for (int axis = 0; axis < 3; ++axis) {
    grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(std::lround(extent[axis]));
  }
  grid.solid.assign(grid.place(0, 0, grid.size[2]), is_unseen_solid ? 1 : 0);
  for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf) {
    const int edge = static_cast<int>(std::lround(leaf.getSize() / grid.edge));
    const Vec3 corner(leaf.getX(), leaf.getY(), leaf.getZ());
    std::array<int, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
      at[static_cast<std::size_t>(axis)] = static_cast<int>(
          std::lround((corner[axis] - 0.5 * leaf.getSize() - grid.low[axis]) / grid.edge));
    }
    const std::uint8_t solid = tree->isNodeOccupied(*leaf) ? 1 : 0;
    for (int w = at[2]; w < at[2] + edge; ++w) {
      for (int v = at[1]; v < at[1] + edge; ++v) {
        for (int u = at[0]; u < at[0] + edge; ++u) grid.solid[grid.place(u, v, w)] = solid;
      }
    }
  }
  return grid;
}
#else
OccupancyGrid read_octree(const std::string& path, bool /*is_unseen_solid*/) {
  throw SetupError("the map '" + path +
                   "' cannot be read by this build; to have it: apt-get install liboctomap-dev, "
                   "then build again");
}
#endif

}  // namespace repel::cover
