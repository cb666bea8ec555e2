// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as a file of OctoMap, and trees of arbitrary nodes behind a valid head: a tree
// that can be asked, or a SetupError that names the file.
#include <repel/octrees/grid.hpp>

#include <string>

#include <end_to_end/folder.hpp>
#include <fuzz/bytes.hpp>
#include <repel/base/setup_error.hpp>

namespace repel::octrees {
namespace {

using fuzz::require;

void check_tree(const octomap::OcTree& tree) {
  if (tree.getNumLeafNodes() == 0) return;
  const cover::CubeRange range = known_range(tree);
  double cubes = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    require(range.low[k] >= -32768 && range.high[k] < 32768 && range.low[k] <= range.high[k],
            "what is known is in the tree");
    cubes *= range.high[k] + 1 - range.low[k];
  }
  if (cubes > 1e5) return;
  const cover::OccupancyGrid grid = grid_of(tree, range, false);
  require(grid.edge > 0.0 && grid.low.allFinite(), "a grid is somewhere");
  require(static_cast<double>(grid.solid.size()) == cubes, "a grid has its cubes");
}

void check_file(const std::string& name, const std::string& bytes) {
  static const test::Folder folder;
  const std::string path = folder.with(name, bytes);
  try {
    check_tree(*read_tree(path));
  } catch (const SetupError& error) {
    require(std::string(error.what()).find(path) != std::string::npos, "an error names the file");
  }
}

void check_one(const std::string& bytes) {
  const std::string rest =
      "\nid OcTree\nsize " + std::to_string(bytes.size() / 2 + 1) + "\nres 0.1\ndata\n";
  const bool is_text = bytes.find("OcTree file") != std::string::npos;
  if (bytes.find("# Octomap") != std::string::npos) {
    check_file(is_text ? "map.ot" : "map.bt", bytes);
  } else if (bytes.size() % 2 == 0) {
    check_file("map.bt", "# Octomap OcTree binary file" + rest + bytes);
  } else {
    check_file("map.ot", "# Octomap OcTree file" + rest + bytes);
  }
}

}  // namespace
}  // namespace repel::octrees

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  repel::octrees::check_one(std::string(data, data + size));
  return 0;
}
