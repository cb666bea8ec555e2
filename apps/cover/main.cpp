// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Covers a mesh by overlapping convex parts, and proves what it says of them.

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/cover/cover.hpp>
#include <repel/host/command_line.hpp>
#include <repel/robots/read_mesh.hpp>
#include <repel/scene/part_list.hpp>

#include "octree.hpp"
#include "report.hpp"

namespace {

using namespace repel;
using namespace repel::cover;

struct Arguments {
  std::string mesh, parts_file, json;
  std::vector<double> scale;
  CoverOptions options;
  double cube = 0.0;  // [m] 0: that of the map
  std::string engine = "auto";
  std::string unseen = "free";
  bool allow_gaps = false;
  bool is_quiet = false;
};

const std::map<std::string, Engine>& engines() {
  static const std::map<std::string, Engine> all{{"auto", Engine::automatic},
                                                 {"planes", Engine::planes},
                                                 {"coacd", Engine::coacd},
                                                 {"hacd", Engine::hacd},
                                                 {"hull", Engine::hull}};
  return all;
}

/// Accepts a length from `low` to `high` [m] with a unit.
CLI::Option* length(CLI::Option* option, double low, double high) {
  const std::map<std::string, double> units{{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}};
  return option->type_name("LENGTH")
      ->check(host::between(low, high))
      ->transform(CLI::AsNumberWithUnit(units, CLI::AsNumberWithUnit::CASE_SENSITIVE));
}

void describe(CLI::App& app, Arguments& a) {
  app.add_option("mesh", a.mesh,
                 "STL, OBJ, glTF, DAE or another mesh file, in m; or a map of OctoMap, .bt or .ot")
      ->required()
      ->type_name("MESH");
  app.add_option("-o,--output", a.parts_file,
                 "Where the parts go, for `shape: mesh` of a scene; by default MESH.parts.yaml")
      ->type_name("FILE");
  app.add_option("--parts", a.options.parts, "At most so many parts, 1 to 1000")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  length(app.add_option("--error", a.options.error,
                        "How far parts may reach out of the mesh, 1um to 1m; without a unit m; by "
                        "default 2mm"),
         1e-6, 1.0);
  length(app.add_option("--overlap", a.options.overlap,
                        "How far parts reach into their neighbours, 0 to 1m; by default 5mm"),
         0.0, 1.0);
  length(app.add_option("--close", a.options.close,
                        "Close holes with all points at most this far from their rim, 0 to 10m; "
                        "by default as --error"),
         0.0, 10.0);
  app.add_option(
         "--engine", a.engine,
         "Engine dividing the mesh: auto, planes (built in), coacd (the PyPI package), hacd" +
             std::string(has_hacd() ? "" : " (not here: built without libbullet-extras-dev)") +
             ", hull")
      ->type_name("NAME")
      ->check(CLI::IsMember(&engines()))
      ->capture_default_str();
  app.add_option("--scale", a.scale, "Factors of x, y and z, such as 0.001 for a mesh in mm")
      ->type_name("X [Y Z]")
      ->expected(1, 3)
      ->check(host::between(-1e6, 1e6));
  app.add_option("--unseen", a.unseen, "Of a map: unseen space counts as free or solid")
      ->type_name("WHAT")
      ->check(CLI::IsMember({"free", "solid"}))
      ->capture_default_str();
  length(app.add_option("--cube", a.cube,
                        "Of a map: join its cubes to larger ones of about this edge, 0 to 10m; "
                        "solid if any of them is"),
         0.0, 10.0);
  app.add_option("--json", a.json, "Write parts [m], uncovered pieces and all bounds to FILE")
      ->type_name("FILE");
  app.add_flag("--allow-gaps", a.allow_gaps, "Succeed although some of the surface is in no part");
  app.add_flag("--quiet", a.is_quiet, "No progress and no report");
  app.footer(
      "Exit status: 0 every point of the surface is in a part, 1 some is not or the mesh was "
      "refused, 2 bad usage.\ndocs/covers.md explains the figures and their proofs.");
}

/// Says on stderr what is being done: on a terminal in one line, otherwise every few seconds.
class Progress {
 public:
  explicit Progress(bool is_quiet) : is_quiet_(is_quiet), is_terminal_(isatty(2) != 0) {}
  ~Progress() {
    if (has_line_) std::fputs("\r\033[K", stderr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void say(const std::string& text) {
    using namespace std::chrono_literals;
    const auto now = std::chrono::steady_clock::now();
    if (is_quiet_ || now - last_ < (is_terminal_ ? 100ms : 5s)) return;
    last_ = now;
    if (is_terminal_) {
      std::fprintf(stderr, "\r\033[K%.78s", text.c_str());
      has_line_ = true;
    } else {
      std::fprintf(stderr, "cover: %s\n", text.c_str());
    }
  }

 private:
  bool is_quiet_;
  bool is_terminal_;
  bool has_line_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void print(const Cover& cover, const Arguments& a, double seconds) {
  const auto mm = [](double metres) { return repel::to_text(1e3 * metres, 3); };
  for (const std::string& fault : cover.faults) std::printf("mesh: %s\n", fault.c_str());
  std::size_t corners = 0;
  for (const auto& part : cover.parts) corners += part.size();
  std::printf("parts       %zu, with %zu corners, by %s in %.1f s\n", cover.parts.size(), corners,
              cover.engine.c_str(), seconds);
  std::printf("uncovered   %s%s mm\n", cover.uncovered.empty() ? "nothing; bound " : "up to ",
              mm(cover.uncovered_m).c_str());
  std::printf("excess      at most %s mm, reached %s mm, mean %s mm\n", mm(cover.excess_m).c_str(),
              mm(cover.excess_reached_m).c_str(), mm(cover.excess_mean_m).c_str());
  if (cover.seam_m) {
    std::printf("seams       %s mm deep\n", mm(*cover.seam_m).c_str());
  } else {
    std::printf("seams       none\n");
  }
  if (cover.excess_m > a.options.error) {
    std::printf("The excess is more than the %s mm asked for: %s.\n", mm(a.options.error).c_str(),
                cover.is_closed ? "raise --parts" : "the surface is open, see --close");
  }
}

void print_gaps(const Cover& cover) {
  constexpr std::size_t most = 5;
  std::vector<Uncovered> gaps = cover.uncovered;
  std::sort(gaps.begin(), gaps.end(),
            [](const Uncovered& a, const Uncovered& b) { return a.depth > b.depth; });
  std::fprintf(stderr, "cover: %zu pieces of the surface are in no part; deepest:\n", gaps.size());
  for (std::size_t i = 0; i < std::min(most, gaps.size()); ++i) {
    const Vec3 p = 1e3 * gaps[i].polygon[0];
    std::fprintf(stderr, "  %.3g mm deep, from %.3f %.3f %.3f mm\n", 1e3 * gaps[i].depth, p.x(),
                 p.y(), p.z());
  }
}

/// The boxes of a map. They contain its cubes, and nothing else unless those were joined.
Cover cover_of_map(const Arguments& a) {
  OccupancyGrid grid = read_octree(a.mesh, a.unseen == "solid");
  const double edge = grid.edge;
  const int factor = std::max(1, static_cast<int>(std::lround(a.cube / edge)));
  if (factor > 1) grid = coarser(grid, factor);
  Cover cover;
  cover.engine = "boxes";
  cover.parts = boxes_of(grid, a.options.parts);
  cover.uncovered_m = 1e-9 * grid.edge;
  cover.excess_m = std::sqrt(3.0) * (factor - 1) * edge + cover.uncovered_m;
  return cover;
}

Cover cover_of_mesh(const Arguments& a, const Vec3& scale) {
  TriangleMesh mesh = read_mesh(a.mesh, scale);
  if (scale.prod() < 0.0) {  // mirrored: outside would be inside
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  Progress progress(a.is_quiet);
  CoverOptions options = a.options;
  options.engine = engines().at(a.engine);
  options.progress = [&](const std::string& text) { progress.say(text); };
  try {
    return cover_of(mesh, options);
  } catch (const SetupError& error) {
    throw SetupError("mesh '" + a.mesh + "' " + error.what());
  }
}

/// Where the surface is in no part, deepest first.
scene::Gaps gaps_of(const Cover& cover) {
  scene::Gaps gaps;
  gaps.count = cover.uncovered.size();
  for (const Uncovered& piece : cover.uncovered) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : piece.polygon) sum += p;
    gaps.deepest.push_back({sum / static_cast<double>(piece.polygon.size()), piece.depth});
  }
  std::stable_sort(gaps.deepest.begin(), gaps.deepest.end(),
                   [](const scene::Gap& a, const scene::Gap& b) { return a.depth > b.depth; });
  if (gaps.count > scene::Gaps::most_kept) gaps.deepest.resize(scene::Gaps::most_kept);
  return gaps;
}

int run(const Arguments& a) {
  const std::string parts_file =
      a.parts_file.empty() ? scene::part_list_beside(a.mesh) : a.parts_file;
  host::require_apart({{"the mesh", a.mesh}}, {{"--output", parts_file}, {"--json", a.json}});
  Vec3 scale = Vec3::Ones();
  if (a.scale.size() == 1) scale *= a.scale[0];
  if (a.scale.size() == 2) throw SetupError("--scale has 2 factors; allowed: 1 or 3");
  if (a.scale.size() == 3) scale = {a.scale[0], a.scale[1], a.scale[2]};
  if (scale.cwiseAbs().minCoeff() == 0.0) throw SetupError("--scale has a 0; allowed: not 0");
  const auto start = std::chrono::steady_clock::now();
  const bool is_map = is_octree(a.mesh);
  if (is_map && !a.scale.empty()) throw SetupError("--scale of a map; allowed: of a mesh");
  host::Output parts(parts_file);
  host::Output json(a.json);
  const Cover cover = is_map ? cover_of_map(a) : cover_of_mesh(a, scale);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  scene::write_part_list(
      {std::filesystem::path(a.mesh).filename().string(), scene::checksum_of_file(a.mesh), scale,
       cover.uncovered_m, cover.excess_m, cover.seam_m, cover.parts, gaps_of(cover)},
      parts.stream());
  parts.close();
  if (json.wanted()) {
    json.stream() << report_of(cover, a.mesh, a.options).dump(1) << "\n";
    json.close();
  }
  if (!a.is_quiet) print(cover, a, seconds);
  if (cover.uncovered.empty()) return 0;
  print_gaps(cover);
  return a.allow_gaps ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return repel::host::start(argc, argv, "cover",
                            "Covers a mesh by overlapping convex parts, and proves how much of the "
                            "mesh they miss and how far they reach out of it.",
                            1, describe, run);
}
