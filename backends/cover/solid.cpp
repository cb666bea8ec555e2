// SPDX-License-Identifier: BSD-3-Clause
#include "solid.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include <repel/base/setup_error.hpp>

namespace repel::cover {
namespace {

using Corners = std::array<int, 3>;
using Edge = std::pair<int, int>;  // the smaller index first

struct HashOfPoint {
  std::size_t operator()(const std::array<double, 3>& p) const {
    std::size_t seed = 0;
    for (const double x : p) seed = seed * 1000003 + std::hash<double>{}(x == 0.0 ? 0.0 : x);
    return seed;
  }
};

/// Vertices that are equal become one.
std::vector<int> merged(const std::vector<Vec3>& vertices) {
  std::unordered_map<std::array<double, 3>, int, HashOfPoint> known;
  std::vector<int> first(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3& v = vertices[i];
    first[i] = known.emplace(std::array{v.x(), v.y(), v.z()}, static_cast<int>(i)).first->second;
  }
  return first;
}

double six_volumes(const std::vector<Vec3>& v, const Corners& t) {
  return v[t[0]].dot(v[t[1]].cross(v[t[2]]));
}

bool has_area(const std::vector<Vec3>& v, const Corners& t) {
  const Vec3 u = v[t[1]] - v[t[0]];
  const Vec3 w = v[t[2]] - v[t[0]];
  const double longest =
      std::max({u.squaredNorm(), w.squaredNorm(), Vec3(v[t[2]] - v[t[1]]).squaredNorm()});
  return u.cross(w).norm() > 1e-12 * longest;
}

/// The edges of triangles, and how each triangle passes along them.
class Edges {
 public:
  struct Use {
    int triangle = 0;
    bool forward = true;  ///< from the smaller index to the larger
  };

  explicit Edges(const std::vector<Corners>& triangles) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const int a = triangles[i][k];
        const int b = triangles[i][(k + 1) % 3];
        if (a == b) continue;
        uses_[{std::min(a, b), std::max(a, b)}].push_back({static_cast<int>(i), a < b});
      }
    }
  }

  [[nodiscard]] const std::map<Edge, std::vector<Use>>& all() const { return uses_; }

 private:
  std::map<Edge, std::vector<Use>> uses_;
};

/// Turns triangles until neighbours across edges of two agree; a sheet that had to be turned in
/// part then encloses a positive volume. Returns how many are turned.
class Turning {
 public:
  Turning(const std::vector<Vec3>& vertices, std::vector<Corners>& triangles)
      : vertices_(vertices), triangles_(triangles), neighbours_(triangles.size()) {
    const Edges edges(triangles);
    for (const auto& [edge, uses] : edges.all()) {
      if (uses.size() != 2) continue;
      const bool agree = uses[0].forward != uses[1].forward;
      neighbours_[uses[0].triangle].emplace_back(uses[1].triangle, agree);
      neighbours_[uses[1].triangle].emplace_back(uses[0].triangle, agree);
    }
  }

  std::size_t run() {
    std::size_t count = 0;
    side_.assign(triangles_.size(), 0);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (side_[i] == 0) count += turn_sheet(static_cast<int>(i));
    }
    return count;
  }

 private:
  std::size_t turn_sheet(int start) {
    std::vector<int> sheet{start};
    side_[start] = 1;
    std::size_t other = 0;
    for (std::size_t next = 0; next < sheet.size(); ++next) {
      const int at = sheet[next];
      for (const auto& [neighbour, agrees] : neighbours_[at]) {
        if (side_[neighbour] != 0) continue;
        side_[neighbour] = agrees ? side_[at] : -side_[at];
        if (side_[neighbour] < 0) ++other;
        sheet.push_back(neighbour);
      }
    }
    if (other == 0) return 0;
    double volume = 0.0;
    for (const int i : sheet) volume += side_[i] * six_volumes(vertices_, triangles_[i]);
    const int wrong = volume >= 0.0 ? -1 : 1;
    std::size_t count = 0;
    for (const int i : sheet) {
      if (side_[i] != wrong) continue;
      std::swap(triangles_[i][1], triangles_[i][2]);
      ++count;
    }
    return count;
  }

  const std::vector<Vec3>& vertices_;
  std::vector<Corners>& triangles_;
  std::vector<std::vector<std::pair<int, bool>>> neighbours_;
  std::vector<int> side_;
};

/// The directed edges that have no opposite, from each start.
std::multimap<int, int> open_edges(const std::vector<Corners>& triangles) {
  std::multimap<int, int> open;
  const Edges edges(triangles);
  for (const auto& [edge, uses] : edges.all()) {
    int sum = 0;
    for (const auto& use : uses) sum += use.forward ? 1 : -1;
    for (; sum > 0; --sum) open.emplace(edge.first, edge.second);
    for (; sum < 0; ++sum) open.emplace(edge.second, edge.first);
  }
  return open;
}

/// Takes a closed walk along open edges out of `open`; without an end if there is none from there.
std::vector<int> take_rim(std::multimap<int, int>& open) {
  std::vector<int> rim{open.begin()->first};
  for (;;) {
    const auto next = open.find(rim.back());
    if (next == open.end()) return {};
    const int to = next->second;
    open.erase(next);
    const auto met = std::find(rim.begin(), rim.end(), to);
    if (met == rim.end()) {
      rim.push_back(to);
      continue;
    }
    // What leads to the walk without being part of it goes back.
    for (auto i = rim.begin(); i != met; ++i) open.emplace(*i, *(i + 1));
    return {met, rim.end()};
  }
}

/// Closes holes by fans around the middle of their rims; a vertex is added for each.
std::size_t close_holes(std::vector<Vec3>& vertices, std::vector<Corners>& triangles,
                        double widest) {
  std::multimap<int, int> open = open_edges(triangles);
  std::size_t count = 0;
  while (!open.empty()) {
    const std::vector<int> rim = take_rim(open);
    if (rim.empty()) continue;
    Vec3 middle = Vec3::Zero();
    for (const int i : rim) middle += vertices[i] / static_cast<double>(rim.size());
    const bool is_small = std::all_of(
        rim.begin(), rim.end(), [&](int i) { return (vertices[i] - middle).norm() <= widest; });
    if (!is_small) continue;
    const int top = static_cast<int>(vertices.size());
    vertices.push_back(middle);
    for (std::size_t i = 0; i < rim.size(); ++i) {
      triangles.push_back({rim[(i + 1) % rim.size()], rim[i], top});
    }
    ++count;
  }
  return count;
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace

std::vector<std::string> MeshFaults::sentences() const {
  std::vector<std::string> all;
  const auto say = [&](std::size_t count, const char* one, const char* many) {
    if (count > 0) all.push_back(counted(count, one, many));
  };
  say(not_finite, "triangle has a corner that is not a finite number: it is left out",
      "triangles have corners that are not finite numbers: they are left out");
  say(without_area, "triangle has no area", "triangles have no area");
  say(duplicates, "triangle is there twice: it counts once",
      "triangles are there twice: they count once");
  say(turned, "triangle faced the other way than its neighbours: it is turned",
      "triangles faced the other way than their neighbours: they are turned");
  say(closed_holes, "small hole is closed", "small holes are closed");
  if (is_inside_out) all.emplace_back("all triangles face inward: they are turned");
  if (open_edges > 0) {
    all.push_back("the surface is open, " + counted(open_edges, "edge has", "edges have") +
                  " no opposite: nothing is inside of it, so excess is measured from the surface");
  }
  return all;
}

Solid::Solid(const TriangleMesh& mesh, double widest_hole)
    : surface_(repaired(mesh, widest_hole)) {}

std::vector<Triangle> Solid::repaired(const TriangleMesh& mesh, double widest_hole) {
  std::vector<Vec3> vertices = mesh.vertices;
  const std::vector<int> first = merged(vertices);
  std::vector<Corners> triangles;
  std::set<Corners> known;
  const int count = static_cast<int>(vertices.size());
  for (const Corners& given : mesh.triangles) {
    const bool is_usable = std::all_of(given.begin(), given.end(), [&](int i) {
      return i >= 0 && i < count && is_finite(vertices[i]);
    });
    if (!is_usable) {
      ++faults_.not_finite;
      continue;
    }
    as_given_.push_back({vertices[given[0]], vertices[given[1]], vertices[given[2]]});
    for (const Vec3& p : as_given_.back()) bounds_.add(p);
    Corners t{first[given[0]], first[given[1]], first[given[2]]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    if (!known.insert(t).second) {
      ++faults_.duplicates;
      continue;
    }
    // One without area stays for the sake of its neighbours: it closes what is between them.
    if (!has_area(vertices, t)) ++faults_.without_area;
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  faults_.turned = Turning(vertices, triangles).run();
  double volume = 0.0;
  for (const Corners& t : triangles) volume += six_volumes(vertices, t);
  if (open_edges(triangles).empty() && volume < 0.0) {
    faults_.is_inside_out = true;
    for (Corners& t : triangles) std::swap(t[1], t[2]);
  }
  faults_.closed_holes = close_holes(vertices, triangles, widest_hole);
  faults_.open_edges = open_edges(triangles).size();
  std::vector<Triangle> result;
  for (const Corners& t : triangles) {
    if (has_area(vertices, t)) result.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
  }
  if (result.empty()) throw SetupError("has no triangle with area; allowed: 1 or more");
  return result;
}

}  // namespace repel::cover
