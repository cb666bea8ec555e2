// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cover/cover.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/reduction/shape.hpp>

#include "coverage.hpp"
#include "engines.hpp"
#include "excess.hpp"
#include "seams.hpp"
#include "solid.hpp"

namespace repel::cover {
namespace {

/// Of the error, for the cuts: parts that took all of it could not reach into their neighbours.
constexpr double for_cuts = 0.7;
constexpr int samples_of_mean = 20'000;
constexpr int samples_of_seams = 100'000;

void check(const CoverOptions& options) {
  (void)checked("parts", options.parts, 1, 1000, "");
  (void)checked("error", options.error, 1e-6, 1.0, "m");
  (void)checked("overlap", options.overlap, 0.0, 1.0, "m");
  if (options.close >= 0.0) (void)checked("close", options.close, 0.0, 10.0, "m");
  if (std::isnan(options.close)) (void)checked("close", options.close, 0.0, 10.0, "m");
}

/// Farther away a shape could have no corner, and squares of squares would overflow.
void check(const TriangleMesh& mesh) {
  for (const Vec3& p : mesh.vertices) {
    for (const double x : p) (void)checked("a corner", x, -Shape::largest, Shape::largest, "m");
  }
  for (const auto& triangle : mesh.triangles) {
    for (const int vertex : triangle) {
      if (vertex >= 0 && static_cast<std::size_t>(vertex) < mesh.vertices.size()) continue;
      throw SetupError("has a triangle of vertex " + std::to_string(vertex) +
                       "; allowed: from 0, below " + std::to_string(mesh.vertices.size()));
    }
  }
}

void say(const CoverOptions& options, const std::string& text) {
  if (options.progress) options.progress(text);
}

double closed_up_to(const CoverOptions& options) {
  return options.close >= 0.0 ? options.close : options.error;
}

/// Planes are computed to some 1e-16 of the coordinates, corners of cut polytopes to about 1e-12
/// of the size.
double margin_of(const Solid& solid) {
  const double reach =
      solid.bounds().low.cwiseAbs().cwiseMax(solid.bounds().high.cwiseAbs()).norm();
  return std::max(1e-9 * solid.size(), 1e-13 * reach);
}

/// A set in one plane becomes this thick.
double thickness_of(const CoverOptions& options) {
  return 0.25 * options.error;
}

std::vector<ConvexPart> parts_of(const PointSets& sets, double thickness) {
  std::vector<ConvexPart> parts;
  for (const std::vector<Vec3>& points : sets) {
    ConvexPart part = ConvexPart::of(points, thickness);
    if (!part.planes.empty()) parts.push_back(std::move(part));
  }
  return parts;
}

double largest_excess(const std::vector<ConvexPart>& parts, const Solid& solid, double enough) {
  double largest = 0.0;
  for (const ConvexPart& part : parts) {
    largest = std::max(
        largest,
        excess_of(part, solid, {.gap = 0.1 * enough, .enough = enough, .most_pieces = 5000}).bound);
  }
  return largest;
}

/// With a smaller threshold of concavity each time, until the parts are within the error or too
/// many.
PointSets by_coacd(const Solid& solid, const CoverOptions& options) {
  const std::string library = coacd_library();
  PointSets best;
  for (const double threshold : {0.2, 0.1, 0.05, 0.02, 0.01}) {
    say(options, "CoACD, threshold " + to_text(threshold));
    PointSets sets = coacd_parts(solid, library, threshold, options.parts);
    if (static_cast<int>(sets.size()) > options.parts && !best.empty()) break;
    best = std::move(sets);
    const double excess =
        largest_excess(parts_of(best, thickness_of(options)), solid, options.error);
    if (excess <= options.error) break;
  }
  return best;
}

/// With a smaller concavity each time, until the parts are within the error or too many.
PointSets by_hacd(const Solid& solid, const CoverOptions& options) {
  PointSets best;
  for (const double of_error : {64.0, 16.0, 4.0, 2.0, 1.0, 0.5, 0.25}) {
    const double concavity = of_error * options.error;
    say(options, "HACD, concavity " + to_text(1e3 * concavity) + " mm");
    PointSets sets = hacd_parts(solid, concavity);
    if (static_cast<int>(sets.size()) > options.parts) {
      if (!best.empty()) break;
      throw SetupError("is divided into " + std::to_string(sets.size()) +
                       " parts by hacd at least; allowed: " + std::to_string(options.parts) +
                       ", see --parts");
    }
    best = std::move(sets);
    const double excess =
        largest_excess(parts_of(best, thickness_of(options)), solid, options.error);
    if (excess <= options.error) break;
  }
  return best;
}

PointSets one_hull(const Solid& solid) {
  std::vector<Vec3> points;
  for (const Triangle& t : solid.as_given()) points.insert(points.end(), t.begin(), t.end());
  return {points};
}

/// Removes parts that lie in another one.
void remove_hidden(std::vector<ConvexPart>& parts) {
  for (std::size_t i = parts.size(); i-- > 0;) {
    const bool is_hidden = std::any_of(parts.begin(), parts.end(), [&](const ConvexPart& other) {
      return &other != &parts[i] &&
             std::all_of(parts[i].vertices.begin(), parts[i].vertices.end(),
                         [&](const Vec3& p) { return other.contains(p, 0.0); });
    });
    if (is_hidden) parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

/// Fills in what is proven of `parts`.
void prove(const std::vector<ConvexPart>& parts, const Solid& solid, const CoverOptions& options,
           Cover& cover) {
  const double margin = margin_of(solid);
  say(options, "which points of the surface are in no part");
  cover.uncovered_m = margin;
  for (Gap& gap : gaps_in(solid.as_given(), parts, margin)) {
    cover.uncovered_m = std::max(cover.uncovered_m, gap.depth + margin);
    cover.uncovered.push_back({std::move(gap.polygon), gap.depth});
  }
  const ExcessOptions fine{.gap = 0.05 * options.error};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    say(options, "excess of part " + std::to_string(i + 1) + " of " + std::to_string(parts.size()));
    const Excess excess = excess_of(parts[i], solid, fine);
    cover.excess_m = std::max(cover.excess_m, excess.bound + margin);
    cover.excess_reached_m = std::max(cover.excess_reached_m, excess.reached);
    cover.parts.push_back(parts[i].vertices);
  }
  cover.excess_mean_m = mean_excess(parts, solid, samples_of_mean);
  say(options, "depth of the seams");
  cover.seam_m = seam_depth(solid, parts, options.overlap, samples_of_seams);
  cover.faults = solid.faults().sentences();
  cover.is_closed = solid.is_closed();
}

}  // namespace

Cover cover_of(const TriangleMesh& mesh, const CoverOptions& options) {
  check(options);
  check(mesh);
  const Solid solid(mesh, closed_up_to(options));
  Cover cover;
  PointSets sets;
  switch (options.engine) {
    case Engine::automatic:
    case Engine::planes:
      cover.engine = "planes";
      sets = cut_by_planes(solid, options.parts, for_cuts * options.error, thickness_of(options),
                           options.progress);
      break;
    case Engine::coacd:
      cover.engine = "coacd";
      sets = by_coacd(solid, options);
      break;
    case Engine::hacd:
      cover.engine = "hacd";
      sets = by_hacd(solid, options);
      break;
    case Engine::hull:
      cover.engine = "hull";
      sets = one_hull(solid);
      break;
  }
  std::vector<ConvexPart> parts = parts_of(sets, thickness_of(options));
  const double margin = margin_of(solid);
  (void)fill_gaps(solid.as_given(), parts, 0.5 * margin, options.error, thickness_of(options));
  if (parts.size() > 1) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      say(options,
          "overlap of part " + std::to_string(i + 1) + " of " + std::to_string(parts.size()));
      parts[i] = grown(parts[i], solid, options.overlap, options.error);
    }
  }
  remove_hidden(parts);
  prove(parts, solid, options, cover);
  return cover;
}

Cover checked_cover(const TriangleMesh& mesh, const std::vector<std::vector<Vec3>>& parts,
                    const CoverOptions& options) {
  check(options);
  check(mesh);
  const Solid solid(mesh, closed_up_to(options));
  Cover cover;
  cover.engine = "given";
  prove(parts_of(parts, thickness_of(options)), solid, options, cover);
  return cover;
}

bool has_coacd() {
  return !coacd_library().empty();
}

void is_built_for(EigenAlignmentHere /*alignment*/, VectorRegisterHere /*size*/) noexcept {}

}  // namespace repel::cover
