// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/support_table.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include <repel/geometry/vertex_scan.hpp>
#include <support/families.hpp>

namespace repel {
namespace support_table_test {

using families::Rng;
using Points = std::vector<Vec3>;

constexpr unsigned seed = 911;

/// The first candidate with the largest dot product, in the precision of `d`.
template <class T>
std::uint32_t best_candidate(const SupportTable& table, const Points& vertices, const Vec<T>& d) {
  const Vec<double> rounded{static_cast<double>(d.x()), static_cast<double>(d.y()),
                            static_cast<double>(d.z())};
  std::uint32_t best = 0;
  T most(-std::numeric_limits<double>::infinity());
  for (const std::uint32_t i : table.candidates(rounded)) {
    const T along = dot(Vec<T>(vertices[i].x(), vertices[i].y(), vertices[i].z()), d);
    if (along > most) {
      most = along;
      best = i;
    }
  }
  return best;
}

Points turned(Points points, const Mat3& R) {
  for (Vec3& p : points) p = R * p;
  return points;
}

/// A cube of `side` points along an edge, on its surface only.
Points cube_grid(int side) {
  Points points;
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      for (int z = 0; z < side; ++z) {
        const bool inside = x % (side - 1) != 0 && y % (side - 1) != 0 && z % (side - 1) != 0;
        if (!inside) points.emplace_back(x, y, z);
      }
    }
  }
  return points;
}

struct Case {
  std::string name;
  Points points;
};

std::vector<Case> cases(Rng& rng) {
  std::vector<Case> all;
  for (const int count : {1, 2, 3, 17, 64, 300, 3000}) {
    all.push_back(
        {std::to_string(count) + " on a sphere", families::cloud(rng, count, 1).vertices});
  }
  const Mat3 R = families::rotation(rng);
  all.push_back({"prism", families::prism(500, 1.0, 0.5).vertices});
  all.push_back({"prism, turned", turned(families::prism(500, 1.0, 0.5).vertices, R)});
  all.push_back({"plate", turned(families::prism(100, 1.0, 1e-6).vertices, R)});
  all.push_back({"needle", turned(families::prism(100, 1e-6, 1.0).vertices, R)});
  all.push_back({"cube grid", cube_grid(12)});
  all.push_back({"cube grid, turned", turned(cube_grid(12), R)});
  Points inside = families::cloud(rng, 100, 1.0).vertices;
  for (int i = 0; i < 300; ++i) inside.push_back(0.5 * families::direction(rng));
  all.push_back({"points inside", inside});
  Points twice = families::cloud(rng, 100, 1.0).vertices;
  for (int i = 0; i < 100; ++i) twice.push_back(twice[i]);
  all.push_back({"each twice", twice});
  for (const double apart : {1e-9, 1e-14, 1e-16}) {
    Points near = families::cloud(rng, 100, 1.0).vertices;
    for (int i = 0; i < 300; ++i) near.push_back(near[i % 100] + apart * families::direction(rng));
    all.push_back({"clusters", near});
    Points jittered = turned(cube_grid(10), R);
    for (Vec3& p : jittered) p += apart * families::direction(rng);
    all.push_back({"jittered cube grid", jittered});
  }
  Points away = families::cloud(rng, 200, 1.0).vertices;
  for (Vec3& p : away) p += Vec3(500, -200, 300);
  all.push_back({"away from its origin", away});
  return all;
}

/// Along differences of vertices, perpendicular to them, nearly so, along axes, and random.
std::vector<Vec3> directions(const Points& points, Rng& rng) {
  const auto any = [&] { return points[rng() % points.size()]; };
  std::vector<Vec3> all;
  for (int i = 0; i < 300; ++i) {
    const Vec3 o = any();
    const Vec3 across = (any() - o).cross(any() - o);
    all.push_back(across);
    all.push_back(across.normalized() +
                  families::log_uniform(rng, 1e-17, 1e-3) * families::direction(rng));
    all.emplace_back(any() - o);
    all.push_back(families::log_uniform(rng, 1e-9, 1e9) * families::direction(rng));
  }
  for (int i = 0; i < 27; ++i) all.emplace_back(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
  return all;
}

TEST(SupportTable, FindsTheVertexThatTheScanFinds) {
  Rng rng(seed);
  for (const Case& c : cases(rng)) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + c.name);
    const SupportTable table(c.points);
    const VertexScan scan(c.points);
    int wrong = 0;
    for (const Vec3& d : directions(c.points, rng)) {
      if (d.norm() == 0.0) continue;
      wrong += best_candidate(table, c.points, Vec<double>(d)) == scan.scan(Vec<double>(d)) ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0);
  }
}

TEST(SupportTable, FindsTheVertexThatTheScanFindsInExtendedPrecision) {
  Rng rng(seed);
  for (const Case& c : cases(rng)) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + c.name);
    const SupportTable table(c.points);
    const VertexScan scan(c.points);
    int wrong = 0;
    for (int i = 0; i < 100; ++i) {
      const auto number = [&] {
        return DoubleDouble(families::uniform(rng, -1, 1)) +
               DoubleDouble(1e-17 * families::uniform(rng, -1, 1));
      };
      const Vec<DoubleDouble> d(number(), number(), number());
      wrong += best_candidate(table, c.points, d) == scan.scan(d) ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0);
  }
}

TEST(SupportTable, CandidatesAreFewOnASphereHoweverManyItsVertices) {
  Rng rng(seed);
  for (const int count : {100, 1000, 5000}) {
    const SupportTable table(families::cloud(rng, count, 1.0).vertices);
    std::size_t sum = 0;
    for (int i = 0; i < 1000; ++i) {
      const auto found = table.candidates(Vec<double>(families::direction(rng)));
      EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
      sum += found.size();
    }
    EXPECT_LE(sum, 1000U * 12U) << "seed " << seed << ", " << count << " vertices";
  }
}

TEST(SupportTable, HoldsNoMoreThanItsVerticesAllow) {
  Rng rng(seed);
  for (const Case& c : cases(rng)) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + c.name);
    EXPECT_LE(SupportTable(c.points).bytes(), SupportTable::most_bytes(c.points.size()));
  }
  Points ends = families::cloud(rng, 1000, 1e-13).vertices;
  for (std::size_t i = 0; i < ends.size(); i += 2) ends[i] += Vec3(1, 2, 3);
  const SupportTable table(ends);
  EXPECT_LE(table.bytes(), SupportTable::most_bytes(ends.size()));
  const VertexScan scan(ends);
  for (const Vec3& d : directions(ends, rng)) {
    if (d.norm() == 0.0) continue;
    EXPECT_EQ(best_candidate(table, ends, Vec<double>(d)), scan.scan(Vec<double>(d)));
  }
}

TEST(SupportTable, EveryDirectionHasACandidate) {
  const SupportTable table(families::prism(50, 1.0, 0.5).vertices);
  const double none = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double x : {0.0, -0.0, none, infinite, -infinite, 1e308, 1e-310, -1.0}) {
    for (const double y : {0.0, none, infinite, -1e308, 5e-324, 1.0}) {
      for (const double z : {0.0, -infinite, none, 1.0}) {
        const auto found = table.candidates({x, y, z});
        ASSERT_FALSE(found.empty());
        EXPECT_LT(found.back(), 100U);
      }
    }
  }
}

TEST(SupportTable, ADefaultOneIsEmpty) {
  EXPECT_TRUE(SupportTable().empty());
  EXPECT_FALSE(SupportTable(Points{{1, 2, 3}}).empty());
}

}  // namespace support_table_test
}  // namespace repel
