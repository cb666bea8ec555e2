// SPDX-License-Identifier: BSD-3-Clause
#include <repel/octrees/grid.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>

#include "child_process.hpp"
#include "parcel.hpp"

namespace repel::octrees {
namespace {

/// Of the cube at the origin, in each direction; OctoMap counts from the lowest.
constexpr int middle_key = 32768;

octomap::OcTreeKey key_of(const std::array<int, 3>& cube) {
  const auto key = [](int each) {
    return static_cast<octomap::key_type>(std::clamp(each + middle_key, 0, 2 * middle_key - 1));
  };
  return {key(cube[0]), key(cube[1]), key(cube[2])};
}

/// The part of a row of cubes that is in a range, counted from the first of that; none: `last` is
/// before `first`.
struct Overlap {
  int first, last;
};
Overlap overlap(int begin, int edge, int low, int high) {
  return {std::max(begin, low) - low, std::min(begin + edge - 1, high) - low};
}

/// What each byte of a file of OctoMap may take in memory: two of them may describe nine nodes.
constexpr std::size_t expansion = 256;
constexpr std::size_t most_levels = 16;  // below the root: the bits of a key
constexpr std::size_t node_bytes = sizeof(float) + 1;

/// Hands on the edge of a cube, and the nodes as a file .ot has them: of each the occupancy and
/// which children follow. In a child process; errors do not name the file.
std::string nodes_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::unique_ptr<octomap::AbstractOcTree> any;
  if (path.ends_with(".bt")) {
    auto tree = std::make_unique<octomap::OcTree>(0.1);
    if (tree->readBinary(file)) any = std::move(tree);
  } else {
    any.reset(octomap::AbstractOcTree::read(file));
  }
  const auto* const tree = dynamic_cast<const octomap::OcTree*>(any.get());
  if (tree == nullptr) {
    throw SetupError("cannot be read; allowed: a file of OctoMap, of the type OcTree");
  }
  if (!file.good()) throw SetupError("is cut off; allowed: a whole file of OctoMap");
  std::ostringstream nodes;
  (void)tree->writeData(nodes);
  detail::Parcel parcel;
  parcel.put(tree->getResolution());
  parcel.put_list(std::move(nodes).str());
  return parcel.take();
}

/// @throws SetupError unless they are those of one tree that is no deeper than its keys, in which
/// OctoMap would go astray, and is occupied by numbers
void require_sound(std::string_view nodes) {
  if (nodes.empty()) return;
  std::vector<int> to_come{1};  // nodes of each level, from the root
  while (!to_come.empty()) {
    if (to_come.back() == 0) {
      to_come.pop_back();
      continue;
    }
    --to_come.back();
    if (nodes.size() < node_bytes) throw SetupError("lacks nodes; allowed: all of them");
    float log_odds = 0.0F;
    std::memcpy(&log_odds, nodes.data(), sizeof log_odds);
    if (!std::isfinite(log_odds)) {
      throw SetupError("has an occupancy that is not finite; allowed: numbers");
    }
    const int children = std::popcount(static_cast<unsigned char>(nodes[sizeof log_odds]));
    nodes.remove_prefix(node_bytes);
    if (children > 0 && to_come.size() > most_levels) {
      throw SetupError("is deeper than " + std::to_string(most_levels) +
                       " levels; allowed: up to these");
    }
    to_come.push_back(children);
  }
  if (!nodes.empty()) throw SetupError("has nodes beside its tree; allowed: none");
}

}  // namespace

cover::CubeRange cubes_in(const Region& region, double cube) {
  cover::CubeRange range;
  double count = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    const double farthest = (middle_key - 1) * cube;
    const double low =
        repel::checked("low corner of the region", region.low[axis], -farthest, farthest, "m");
    const double high =
        repel::checked("high corner of the region", region.high[axis], low, farthest, "m");
    range.low[k] = static_cast<int>(std::floor(low / cube));
    range.high[k] = std::max(range.low[k], static_cast<int>(std::ceil(high / cube)) - 1);
    count *= range.high[k] + 1 - range.low[k];
  }
  if (!(count <= static_cast<double>(Region::most))) {
    throw SetupError("the region of the map has " + to_text(count, 3) + " cubes; allowed: up to " +
                     std::to_string(Region::most) + ", with larger cubes or a smaller region");
  }
  return range;
}

std::unique_ptr<octomap::OcTree> read_tree(const std::string& path) {
  const std::string bytes =
      detail::result_of_file(path, "map", expansion, [&] { return nodes_in(path); });
  try {
    detail::Unpacking parcel(bytes);
    const double cube = repel::checked("edge of a cube", parcel.take<double>(), 1e-6, 1e3, "m");
    auto nodes = parcel.take_list<std::string>();
    require_sound(nodes);
    auto tree = std::make_unique<octomap::OcTree>(cube);
    if (nodes.empty()) return tree;
    std::istringstream stream(std::move(nodes));
    (void)tree->readData(stream);
    return tree;
  } catch (const SetupError& wrong) {
    throw SetupError("map '" + path + "' " + wrong.what());
  }
}

cover::CubeRange known_range(const octomap::OcTree& tree) {
  std::array<double, 3> low{};
  std::array<double, 3> high{};
  tree.getMetricMin(low[0], low[1], low[2]);
  tree.getMetricMax(high[0], high[1], high[2]);
  cover::CubeRange range;
  for (std::size_t k = 0; k < 3; ++k) {
    range.low[k] = static_cast<int>(std::lround(low[k] / tree.getResolution()));
    range.high[k] = static_cast<int>(std::lround(high[k] / tree.getResolution())) - 1;
  }
  return range;
}

cover::OccupancyGrid grid_of(const octomap::OcTree& tree, const cover::CubeRange& range,
                             bool is_unseen_solid) {
  cover::OccupancyGrid grid;
  grid.edge = tree.getResolution();
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    grid.low[axis] = grid.edge * range.low[k];
    grid.size[k] = range.high[k] + 1 - range.low[k];
  }
  grid.solid.assign(grid.place(0, 0, grid.size[2]), is_unseen_solid ? 1 : 0);
  const auto end = tree.end_leafs_bbx();
  for (auto leaf = tree.begin_leafs_bbx(key_of(range.low), key_of(range.high)); leaf != end;
       ++leaf) {
    const bool is_occupied = tree.isNodeOccupied(*leaf);
    if (is_occupied == is_unseen_solid) continue;  // as it is already
    const octomap::OcTreeKey key = leaf.getIndexKey();
    const int edge = 1 << (tree.getTreeDepth() - leaf.getDepth());
    const Overlap x = overlap(key[0] - middle_key, edge, range.low[0], range.high[0]);
    const Overlap y = overlap(key[1] - middle_key, edge, range.low[1], range.high[1]);
    const Overlap z = overlap(key[2] - middle_key, edge, range.low[2], range.high[2]);
    const std::uint8_t solid = is_occupied ? 1 : 0;
    for (int w = z.first; w <= z.last; ++w) {
      for (int v = y.first; v <= y.last; ++v) {
        for (int u = x.first; u <= x.last; ++u) grid.solid[grid.place(u, v, w)] = solid;
      }
    }
  }
  return grid;
}

void is_built_for(EigenAlignmentHere /*alignment*/, VectorRegisterHere /*size*/) noexcept {}

}  // namespace repel::octrees
