// SPDX-License-Identifier: BSD-3-Clause
#include <dlfcn.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include <repel/base/setup_error.hpp>

#include "engines.hpp"

namespace repel::cover {
namespace {

// The C functions of CoACD, as its Python package declares them.
extern "C" {
struct CoacdMesh {
  double* vertices;
  std::uint64_t vertex_count;
  int* triangles;
  std::uint64_t triangle_count;
};
struct CoacdMeshes {
  CoacdMesh* meshes;
  std::uint64_t count;
};
using CoacdRun = CoacdMeshes (*)(const CoacdMesh&, double threshold, int most_hulls, int preprocess,
                                 int preprocess_resolution, int sample_resolution, int nodes,
                                 int iterations, int depth, bool pca, bool merge, bool decimate,
                                 int most_vertices, bool extrude, double extrude_margin,
                                 int approximation, unsigned seed, bool real_metric);
using CoacdFree = void (*)(CoacdMeshes);
using CoacdSetLog = void (*)(const char*);
}

struct Close {
  void operator()(void* library) const { (void)dlclose(library); }
};

template <class Function>
Function function_of(void* library, const char* name, const std::string& path) {
  void* const found = dlsym(library, name);
  if (found == nullptr) {
    throw SetupError("'" + path + "' has no function " + name +
                     "; allowed: the library of the PyPI package coacd");
  }
  return reinterpret_cast<Function>(found);
}

std::string find_by_python() {
  constexpr const char* question =
      "python3 -c 'import importlib.util as u, glob, os; s = u.find_spec(\"coacd\"); "
      "print(next(iter(glob.glob(os.path.join(os.path.dirname(s.origin), \"lib_coacd*.so\"))), "
      "\"\") if s else \"\")' 2>/dev/null";
  // NOLINTNEXTLINE(cert-env33-c): set-up of an offline program; nothing of it comes from a user
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(question, "r"), &pclose);
  std::string path;
  std::array<char, 4096> text{};
  if (pipe && std::fgets(text.data(), static_cast<int>(text.size()), pipe.get()) != nullptr) {
    path = text.data();
    while (!path.empty() && path.back() == '\n') path.pop_back();
  }
  return path;
}

}  // namespace

std::string coacd_library() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): read once, before there are threads
  const char* const given = std::getenv("REPEL_COACD");
  return given != nullptr ? given : find_by_python();
}

PointSets coacd_parts(const Solid& solid, const std::string& path, double threshold, int most) {
  if (path.empty()) {
    throw SetupError(
        "the engine coacd is not installed; to have it: python3 -m pip install coacd, or set "
        "REPEL_COACD to its library lib_coacd.so");
  }
  const std::unique_ptr<void, Close> library(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL));
  if (!library) {
    throw SetupError("the library of coacd '" + path +
                     "' cannot be loaded; allowed: an existing "
                     "lib_coacd.so");
  }
  const auto run = function_of<CoacdRun>(library.get(), "CoACD_run", path);
  const auto free = function_of<CoacdFree>(library.get(), "CoACD_freeMeshArray", path);
  function_of<CoacdSetLog>(library.get(), "CoACD_setLogLevel", path)("error");
  std::vector<double> vertices;
  std::vector<int> triangles;
  for (const Triangle& t : solid.surface().triangles()) {
    for (const Vec3& p : t) {
      triangles.push_back(static_cast<int>(triangles.size()));
      vertices.insert(vertices.end(), p.begin(), p.end());
    }
  }
  const CoacdMesh mesh{vertices.data(), vertices.size() / 3, triangles.data(),
                       triangles.size() / 3};
  // Its own defaults, but for the threshold and the number of parts.
  const CoacdMeshes found = run(mesh, threshold, most, 0, 50, 2000, 20, 150, 3, false, true, false,
                                256, false, 0.01, 0, 0, false);
  PointSets parts;
  for (std::uint64_t i = 0; i < found.count; ++i) {
    const CoacdMesh& part = found.meshes[i];
    std::vector<Vec3>& points = parts.emplace_back();
    for (std::uint64_t k = 0; k < part.vertex_count; ++k) {
      const double* p = part.vertices + 3 * k;
      points.emplace_back(p[0], p[1], p[2]);
    }
  }
  free(found);
  if (parts.empty()) throw SetupError("coacd found no parts");
  return parts;
}

}  // namespace repel::cover
