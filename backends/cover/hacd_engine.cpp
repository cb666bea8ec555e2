// SPDX-License-Identifier: BSD-3-Clause
#include "engines.hpp"

#include <repel/base/setup_error.hpp>

#ifdef REPEL_HAS_HACD
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include <HACD/hacdHACD.h>
#endif

namespace repel::cover {
#ifdef REPEL_HAS_HACD
namespace {

/// HACD scales a mesh to this diagonal; its concavity is a length at that scale.
constexpr double hacd_scale = 1000.0;
/// Its time grows with the square of the triangles, and it cannot be asked to stop.
constexpr std::size_t most_hacd_triangles = 20'000;
constexpr rlim_t most_hacd_seconds = 600;

/// A mesh whose triangles share their corners, as HACD needs it to see neighbours.
struct SharedMesh {
  std::vector<HACD::Vec3<HACD::Real>> points;
  std::vector<HACD::Vec3<long>> triangles;
};

SharedMesh shared(const std::vector<Triangle>& surface) {
  SharedMesh mesh;
  std::map<std::tuple<double, double, double>, long> known;
  const auto index_of = [&](const Vec3& p) {
    const auto [at, is_new] =
        known.try_emplace({p.x(), p.y(), p.z()}, static_cast<long>(mesh.points.size()));
    if (is_new) mesh.points.emplace_back(p.x(), p.y(), p.z());
    return at->second;
  };
  for (const Triangle& t : surface) {
    const long a = index_of(t[0]);
    const long b = index_of(t[1]);
    const long c = index_of(t[2]);
    mesh.triangles.emplace_back(a, b, c);
  }
  return mesh;
}

/// The corners of the triangles of each cluster. The hulls of HACD are not taken: they may miss
/// some of them.
PointSets parts_by_hacd(const std::vector<Triangle>& surface, SharedMesh mesh, double concavity) {
  HACD::HACD hacd;
  hacd.SetPoints(mesh.points.data());
  hacd.SetNPoints(mesh.points.size());
  hacd.SetTriangles(mesh.triangles.data());
  hacd.SetNTriangles(mesh.triangles.size());
  hacd.SetScaleFactor(hacd_scale);
  hacd.SetCompacityWeight(1e-4);
  hacd.SetVolumeWeight(0.0);
  hacd.SetNClusters(1);
  hacd.SetNVerticesPerCH(256);
  hacd.SetConcavity(concavity);
  hacd.SetConnectDist(concavity);
  // Meshes of machines have large triangles: corners alone show little of what is concave.
  hacd.SetAddExtraDistPoints(true);
  hacd.SetAddNeighboursDistPoints(false);
  hacd.SetAddFacesPoints(true);
  hacd.NormalizeData();
  if (!hacd.Compute(false, false)) return {};
  PointSets parts(hacd.GetNClusters());
  for (std::size_t t = 0; t < surface.size(); ++t) {
    const auto cluster = static_cast<std::size_t>(hacd.GetPartition()[t]);
    if (cluster >= parts.size()) return {};
    parts[cluster].insert(parts[cluster].end(), surface[t].begin(), surface[t].end());
  }
  std::erase_if(parts, [](const std::vector<Vec3>& part) { return part.empty(); });
  return parts;
}

struct CloseFile {
  void operator()(std::FILE* file) const { (void)std::fclose(file); }
};

bool write_sets(const PointSets& sets, std::FILE* file) {
  for (const std::vector<Vec3>& set : sets) {
    const std::size_t count = set.size();
    if (std::fwrite(&count, sizeof count, 1, file) != 1) return false;
    for (const Vec3& p : set) {
      if (std::fwrite(p.data(), sizeof(double), 3, file) != 3) return false;
    }
  }
  return std::fflush(file) == 0;
}

PointSets read_sets(std::FILE* file) {
  PointSets sets;
  std::size_t count = 0;
  std::rewind(file);
  while (std::fread(&count, sizeof count, 1, file) == 1) {
    std::vector<Vec3>& set = sets.emplace_back(count, Vec3::Zero());
    for (Vec3& p : set) {
      if (std::fread(p.data(), sizeof(double), 3, file) != 3) return {};
    }
  }
  return sets;
}

}  // namespace

// In a process of its own: HACD prints, and may crash or never end on a mesh that is not a
// manifold.
PointSets hacd_parts(const Solid& solid, double concavity) {
  const std::vector<Triangle>& surface = solid.surface().triangles();
  if (surface.size() > most_hacd_triangles) {
    throw SetupError("has " + std::to_string(surface.size()) + " triangles; allowed for hacd: " +
                     std::to_string(most_hacd_triangles) + " at most; take the engine planes");
  }
  SharedMesh mesh = shared(surface);
  const std::unique_ptr<std::FILE, CloseFile> file(std::tmpfile());
  if (!file) throw SetupError("needs a temporary file for hacd; allowed: space in /tmp");
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) throw SetupError("needs a process for hacd; allowed: one more process");
  if (child == 0) {
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    const rlimit limit{most_hacd_seconds, most_hacd_seconds};
    (void)setrlimit(RLIMIT_CPU, &limit);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    (void)dup2(nowhere, STDOUT_FILENO);
    (void)dup2(nowhere, STDERR_FILENO);
    _exit(write_sets(parts_by_hacd(surface, std::move(mesh), hacd_scale * concavity / solid.size()),
                     file.get())
              ? 0
              : 1);
  }
  int status = 0;
  (void)waitpid(child, &status, 0);
  PointSets parts;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) parts = read_sets(file.get());
  if (parts.empty()) {
    throw SetupError("cannot be divided by hacd: it crashed, took longer than " +
                     std::to_string(most_hacd_seconds) +
                     " s or found no parts; allowed: another engine, such as planes");
  }
  return parts;
}
#else
PointSets hacd_parts(const Solid& /*solid*/, double /*concavity*/) {
  throw SetupError(
      "cannot be divided by the engine hacd, repel is built without it; to have it: apt-get "
      "install libbullet-extras-dev, and build again");
}
#endif

bool has_hacd() {
#ifdef REPEL_HAS_HACD
  return true;
#else
  return false;
#endif
}

}  // namespace repel::cover
