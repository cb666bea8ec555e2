// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/facets.hpp>

#include <gtest/gtest.h>

#include <Eigen/SVD>

#include <map>
#include <set>
#include <string>
#include <vector>

#include <support/draws.hpp>
#include <support/families.hpp>

namespace repel {
namespace facets_test {

using families::Rng;

constexpr unsigned seed = 47;

/// Checks that a list of triangles is the surface of the hull of `points`.
void expect_is_the_hull(const std::vector<Facet>& facets, const std::vector<Vec3>& points) {
  ASSERT_FALSE(facets.empty());
  double size = 0.0;
  for (const Vec3& p : points) size = std::max(size, p.norm());
  std::map<std::pair<int, int>, int> edges;
  std::set<int> corners;
  for (const Facet& f : facets) {
    EXPECT_NEAR(f.n.norm(), 1.0, 1e-14);
    double farthest = -1e300;
    for (const Vec3& p : points) farthest = std::max(farthest, f.n.dot(p));
    EXPECT_LE(farthest, f.offset) << "a point is outside";
    EXPECT_GE(farthest, f.offset - 1e-15 * size) << "the half space does not touch the hull";
    for (int k = 0; k < 3; ++k) {
      corners.insert(f.vertices[k]);
      ++edges[{f.vertices[k], f.vertices[(k + 1) % 3]}];
      EXPECT_NEAR(f.n.dot(points[f.vertices[k]]), f.offset, 4e-15 * size);
    }
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1) << "two facets go round one edge the same way";
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U) << "an edge has one facet only";
  }
  const int undirected = static_cast<int>(edges.size()) / 2;
  EXPECT_EQ(static_cast<int>(corners.size()) - undirected + static_cast<int>(facets.size()), 2);
}

/// [m^3] By the divergence theorem, in 32 digits; right only if all facets are oriented outward.
double volume(const std::vector<Facet>& facets, const std::vector<Vec3>& points) {
  DoubleDouble six_times;
  const auto from_first = [&](int i) {
    return detail::finer(detail::exact_difference(points[i], points[facets.front().vertices[0]]));
  };
  for (const auto& f : facets) {
    const auto& [a, b, c] = f.vertices;
    six_times += dot(from_first(a), cross(from_first(b), from_first(c)));
  }
  return six_times.hi / 6.0;
}

TEST(Facets, ACubeHasTwelveTrianglesAndItsOwnVolume) {
  Rng rng(seed);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "cube", i));
    std::vector<Vec3> corners = families::box({0.5, 0.5, 0.5}).vertices;
    const Mat3 R = i == 0 ? Mat3(Mat3::Identity()) : families::rotation(rng);
    for (Vec3& p : corners) p = R * p;
    const std::vector<Facet> facets = hull_facets(corners);
    expect_is_the_hull(facets, corners);
    EXPECT_EQ(facets.size(), 12U);
    EXPECT_NEAR(volume(facets, corners), 1.0, 1e-14);
    for (const Facet& f : facets) EXPECT_NEAR(f.offset, 0.5, 1e-14);
  }
}

TEST(Facets, HullsOfRandomCloudsAreClosedSurfaces) {
  Rng rng(seed);
  for (const int count : {4, 5, 6, 8, 12, 20, 50, 100, 300}) {
    for (int i = 0; i < 10; ++i) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(count) + " points");
      std::vector<Vec3> points;
      for (int k = 0; k < count; ++k) {
        points.push_back(families::uniform(rng, 0.2, 1.0) * families::direction(rng));
      }
      expect_is_the_hull(hull_facets(points), points);
    }
  }
}

TEST(Facets, PointsOnASphereAreAllCorners) {
  Rng rng(seed);
  const std::vector<Vec3> points = families::cloud(rng, 200, 2.0).vertices;
  const std::vector<Facet> facets = hull_facets(points);
  expect_is_the_hull(facets, points);
  EXPECT_EQ(facets.size(), 2U * 200U - 4U);
}

TEST(Facets, FarFromTheOriginTheHullIsTheSame) {
  Rng rng(seed);
  std::vector<Vec3> points = families::cloud(rng, 30, 1.0).vertices;
  const std::size_t count = hull_facets(points).size();
  for (Vec3& p : points) p += Vec3(50, -20, 30);
  const std::vector<Facet> facets = hull_facets(points);
  expect_is_the_hull(facets, points);
  EXPECT_EQ(facets.size(), count);
}

TEST(Facets, PointsInsideAndRepeatedPointsChangeNothing) {
  Rng rng(seed);
  const std::vector<Vec3> points = families::cloud(rng, 20, 1.0).vertices;
  std::vector<Vec3> more = points;
  for (int i = 0; i < 40; ++i) more.push_back(0.05 * families::direction(rng));
  more.insert(more.end(), points.begin(), points.end());
  const std::vector<Facet> facets = hull_facets(more);
  expect_is_the_hull(facets, more);
  EXPECT_EQ(facets.size(), hull_facets(points).size());
  EXPECT_NEAR(volume(facets, more), volume(hull_facets(points), points), 1e-14);
}

TEST(Facets, ManyPointsOnEachFaceOfABoxStillGiveTheBox) {
  Rng rng(seed);
  for (const bool turned : {false, true}) {
    SCOPED_TRACE("seed " + std::to_string(seed) + (turned ? ", turned" : ""));
    const Mat3 R = turned ? families::rotation(rng) : Mat3(Mat3::Identity());
    std::vector<Vec3> points;
    for (int x = 0; x < 4; ++x) {
      for (int y = 0; y < 4; ++y) {
        for (int z = 0; z < 4; ++z) points.push_back(R * Vec3(x, y, z));
      }
    }
    const std::vector<Facet> facets = hull_facets(points);
    expect_is_the_hull(facets, points);
    EXPECT_NEAR(volume(facets, points), 27.0, 1e-10);
  }
}

TEST(Facets, NeedlesAndPlatesHaveFacetsDownToAMillionth) {
  Rng rng(seed);
  for (const Vec3& h : {Vec3(1e-6, 1e-6, 1.0), Vec3(1.0, 1.0, 1e-6), Vec3(1e-6, 1e-3, 1.0)}) {
    std::vector<Vec3> corners = families::box(h).vertices;
    const Mat3 R = families::rotation(rng);
    for (Vec3& p : corners) p = R * p;
    SCOPED_TRACE("seed " + std::to_string(seed) + ", box " + std::to_string(h.x()));
    const std::vector<Facet> facets = hull_facets(corners);
    expect_is_the_hull(facets, corners);
    EXPECT_NEAR(volume(facets, corners) / (8.0 * h.prod()), 1.0, 1e-6);
  }
}

TEST(Facets, ACornerPushedIntoTheFaceBesideItSpoilsNothing) {
  const std::vector<Vec3> twins{{0.89318004734100054, 0.15787789155032875, -0.011350615097172032},
                                {-0.78475291117490797, 0.0094667479936192973, -0.30830925491795808},
                                {-0.57256753966155871, 0.65724496795046572, 0.045732837091290869},
                                {0.80043009165278223, -0.0052504578587290436, 0.45629148598223768},
                                {0.80042996610630668, -0.0052504978263890976, 0.45629155388157994}};
  const std::vector<Vec3> needle{{-0.26765336725847177, -0.52487659029860545, -0.17131319732154018},
                                 {-0.1756487249058479, 0.65809463011743385, -0.4196410713434402},
                                 {0.26862143906674113, -0.02055133715017865, 0.49948472622091827},
                                 {-0.17565956342197095, 0.65811480827903424, -0.41963336186523981},
                                 {-0.65024571336951242, 0.32102040420492184, 0.08278140530729973}};
  for (const std::vector<Vec3>& points : {twins, needle}) {
    expect_is_the_hull(hull_facets(points), points);
  }
}

/// Points of a kind on which a hull with rounded decisions fails: nearly in a plane, nearly on a
/// line, on a lattice, in clusters, some of them duplicated.
std::vector<Vec3> thin_points(int kind, Rng& rng) {
  std::vector<Vec3> points;
  const int count = families::count_between(rng, 4, 24);
  const double thin = families::log_uniform(rng, 1e-17, 1e-3);
  const auto lattice = [&] { return static_cast<double>(families::count_between(rng, -2, 2)); };
  for (int i = 0; i < count; ++i) {
    const Vec3 p = families::uniform(rng, 0.2, 1.0) * families::direction(rng);
    if (kind == 0) points.emplace_back(p.x(), p.y(), thin * p.z());
    if (kind == 1) points.emplace_back(p.x(), thin * p.y(), thin * p.z());
    if (kind == 2) points.emplace_back(lattice(), lattice(), lattice());
    if (kind == 3) points.emplace_back(lattice(), lattice(), thin * lattice());
    if (kind == 4) points.push_back(i < 5 ? p : Vec3(points[i % 5] + 1e-9 * p));
    if (kind == 5) points.push_back(i < 4 ? p : Vec3(points[i % 3] + thin * p));
  }
  const int repeated = families::count_between(rng, 0, 4);
  for (int i = 0; i < repeated; ++i) points.push_back(points[i]);
  if (families::count_between(rng, 0, 1) == 0) return points;
  const Mat3 R = families::rotation(rng);
  const Vec3 away = families::log_uniform(rng, 1e-3, 1e3) * families::direction(rng);
  for (Vec3& p : points) p = R * p + (kind % 2 == 0 ? Vec3(Vec3::Zero()) : away);
  return points;
}

/// [m] Largest distance of the points from their best-fit plane.
double thickness(const std::vector<Vec3>& points) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
  Eigen::MatrixXd rows(points.size(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) rows.row(i) = (points[i] - mean).transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeThinV);
  return (rows * svd.matrixV().col(2)).cwiseAbs().maxCoeff();
}

TEST(Facets, ThinLatticeAndClusteredHullsAreClosedSurfaces) {
  Rng rng(seed);
  int solid = 0;
  constexpr int count = families::draws(20000);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "hull", i));
    const std::vector<Vec3> points = thin_points(i % 6, rng);
    const std::vector<Facet> facets = hull_facets(points);
    if (facets.empty()) {
      double size = 0.0;
      for (const Vec3& p : points) size = std::max(size, p.cwiseAbs().maxCoeff());
      EXPECT_LE(thickness(points), 3e-14 * size) << "a solid has no facets";
      continue;
    }
    ++solid;
    expect_is_the_hull(facets, points);
    if (HasFailure()) break;
  }
  EXPECT_GT(solid, count * 7 / 10);
  EXPECT_LT(solid, count);
}

TEST(Facets, TenThousandPointsOnASphereAreAllCorners) {
  Rng rng(seed);
  const std::vector<Vec3> points = families::cloud(rng, 10000, 1.0).vertices;
  const std::vector<Facet> facets = hull_facets(points);
  EXPECT_EQ(facets.size(), 2U * 10000U - 4U);
  double least = 1.0;
  for (const Facet& f : facets) least = std::min(least, f.offset);
  EXPECT_GT(least, 0.99);
  EXPECT_NEAR(volume(facets, points), 4.0 / 3.0 * M_PI, 0.01);
}

TEST(Facets, CornersAreThePointsOfTheFacetsInTheirOrder) {
  Rng rng(seed);
  const std::vector<Vec3> box = families::box({0.5, 0.4, 0.3}).vertices;
  std::vector<Vec3> points;
  for (const Vec3& p : box) {
    points.push_back(0.1 * families::direction(rng));
    points.push_back(p);
  }
  EXPECT_EQ(hull_corners(points, hull_facets(points)), box);
  EXPECT_TRUE(hull_corners(points, {}).empty());
}

TEST(Facets, PointsWithoutAVolumeHaveNone) {
  Rng rng(seed);
  const Mat3 R = families::rotation(rng);
  std::vector<Vec3> plane, line;
  for (int i = 0; i < 30; ++i) {
    plane.push_back(R * Vec3(families::uniform(rng, -1, 1), families::uniform(rng, -1, 1), 0.4));
    line.push_back(R * Vec3(families::uniform(rng, -1, 1), 0.2, 0.4));
  }
  EXPECT_TRUE(hull_facets(plane).empty()) << "seed " << seed;
  EXPECT_TRUE(hull_facets(line).empty()) << "seed " << seed;
  EXPECT_TRUE(hull_facets(std::vector<Vec3>(10, Vec3(1, 2, 3))).empty());
  EXPECT_TRUE(hull_facets(std::vector<Vec3>(10, Vec3::Zero())).empty());
  EXPECT_TRUE(hull_facets(families::cloud(rng, 3, 1.0).vertices).empty());
  EXPECT_TRUE(hull_facets({}).empty());
}

}  // namespace facets_test
}  // namespace repel
