// SPDX-License-Identifier: BSD-3-Clause
// In place of CoACD: covers the half of every mesh where x is least, and leaves the other.
#include <algorithm>
#include <cstdint>
#include <vector>

extern "C" {

struct Mesh {
  double* vertices;
  std::uint64_t vertex_count;
  int* triangles;
  std::uint64_t triangle_count;
};

struct Meshes {
  Mesh* meshes;
  std::uint64_t count;
};

// NOLINTNEXTLINE(readability-identifier-naming): the name that is looked for
Meshes CoACD_run(const Mesh& mesh, double, int, int, int, int, int, int, int, bool, bool, bool, int,
                 bool, double, int, unsigned, bool) {
  double low = 1e300;
  double high = -1e300;
  for (std::uint64_t i = 0; i < mesh.vertex_count; ++i) {
    low = std::min(low, mesh.vertices[3 * i]);
    high = std::max(high, mesh.vertices[3 * i]);
  }
  static std::vector<double> vertices;
  vertices.assign(mesh.vertices, mesh.vertices + 3 * mesh.vertex_count);
  for (std::uint64_t i = 0; i < mesh.vertex_count; ++i) {
    vertices[3 * i] = std::min(vertices[3 * i], 0.5 * (low + high));
  }
  static Mesh part;
  part = {vertices.data(), mesh.vertex_count, nullptr, 0};
  return {&part, 1};
}

// NOLINTNEXTLINE(readability-identifier-naming): as above
void CoACD_freeMeshArray(Meshes) {}

// NOLINTNEXTLINE(readability-identifier-naming): as above
void CoACD_setLogLevel(const char*) {}
}
