// SPDX-License-Identifier: BSD-3-Clause
#include "thinning.hpp"

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace repel::detail {
namespace {

/// The cells of a cube are numbered along its sides, of which each has fewer than 2^20.
constexpr int bits_of_side = 20;

TriangleMesh gathered(const TriangleMesh& mesh, const Vec3& low, double cell) {
  TriangleMesh result;
  std::unordered_map<std::uint64_t, int> first;
  std::vector<int> becomes;
  becomes.reserve(mesh.vertices.size());
  for (const Vec3& p : mesh.vertices) {
    std::uint64_t key = 0;
    for (const double x : Vec3((p - low) / cell)) {
      key = key << bits_of_side | static_cast<std::uint64_t>(x);
    }
    const auto [known, is_new] = first.try_emplace(key, static_cast<int>(result.vertices.size()));
    if (is_new) result.vertices.push_back(p);
    becomes.push_back(known->second);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<int, 3> t{becomes[static_cast<std::size_t>(a)],
                               becomes[static_cast<std::size_t>(b)],
                               becomes[static_cast<std::size_t>(c)]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result.triangles.push_back(t);
  }
  return result;
}

}  // namespace

TriangleMesh thinned(TriangleMesh mesh, std::size_t most) {
  if (mesh.triangles.size() <= most) return mesh;
  Vec3 low = mesh.vertices.front();
  Vec3 high = low;
  for (const Vec3& p : mesh.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double extent = (high - low).maxCoeff();
  TriangleMesh result;
  if (!(extent > 0.0) || !std::isfinite(extent)) return result;
  for (double cell = extent / 512.0; cell <= 2.0 * extent; cell *= 1.5) {
    result = gathered(mesh, low, cell);
    if (result.triangles.size() <= most) break;
  }
  return result;
}

}  // namespace repel::detail
