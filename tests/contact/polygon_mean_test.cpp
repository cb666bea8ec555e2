// SPDX-License-Identifier: BSD-3-Clause
#include <repel/contact/polygon_mean.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <repel/contact/overlap.hpp>
#include <support/families.hpp>

namespace repel::detail {
namespace polygon_mean_test {

constexpr unsigned seed = 42;
constexpr double tilt = 0.005;

/// A convex polygon around r = 0, with corners on an ellipse.
Flat polygon(families::Rng& rng, int corners, bool of_a) {
  const double start = families::uniform(rng, 0.0, 6.0);
  const Planar centre{families::uniform(rng, -0.02, 0.02), families::uniform(rng, -0.02, 0.02)};
  const double wide = families::uniform(rng, 0.04, 0.1);
  Flat flat;
  for (int i = 0; i < corners; ++i) {
    const double angle = start + 2.0 * M_PI * (i + families::uniform(rng, -0.3, 0.3)) / corners;
    flat.outline.add(centre + Planar{0.06 * std::cos(angle), wide * std::sin(angle)}, of_a);
  }
  const double steep = families::uniform(rng, 0.0, 2.5) * tilt;
  const double way = families::uniform(rng, 0.0, 6.0);
  flat.slope = {steep * std::cos(way), steep * std::sin(way)};
  return flat;
}

/// The polygons of all lanes.
struct Drawn {
  std::array<Flat, lane_count> a, b;
  PolygonLanes lanes_a, lanes_b;

  Drawn(families::Rng& rng, int most) {
    for (int k = 0; k < lane_count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      a[i] = polygon(rng, families::count_between(rng, 3, most), true);
      b[i] = polygon(rng, families::count_between(rng, 3, most), false);
      EXPECT_TRUE(lanes_a.set(k, a[i]));
      EXPECT_TRUE(lanes_b.set(k, b[i]));
    }
  }
  template <std::size_t sides>
  [[nodiscard]] PolygonMean<sides> mean() const {
    const auto size = [](const PlanarLanes& v) { return dot(v, v); };
    return {lanes_a, lanes_b, lanes_b.slope - lanes_a.slope, all_of(tilt),
            roots(larger(size(lanes_a.slope), size(lanes_b.slope)))};
  }
};

Planar at(const PlanarLanes& v, int k) {
  return {v.x[k], v.y[k]};
}

/// How the means of all lanes compare with those of each pair alone.
struct Compared {
  int sure = 0, all = 0;
  double pulled = 0.0;

  template <std::size_t sides>
  void compare(const Drawn& drawn) {
    const PolygonMean<sides> mean = drawn.mean<sides>();
    for (int k = 0; k < lane_count; ++k) {
      const Flat& a = drawn.a[static_cast<std::size_t>(k)];
      const Flat& b = drawn.b[static_cast<std::size_t>(k)];
      Outline outline;
      Sides of;
      const bool found = find_overlap(a.outline, b.outline, false, outline, of);
      ++all;
      if (mean.is_sure()[k] == 0) continue;
      ++sure;
      ASSERT_TRUE(found);
      const Planar s = b.slope - a.slope;
      const TiltMean alone(outline, of, s, tilt, std::max(norm(a.slope), norm(b.slope)));
      EXPECT_NEAR(mean.nearer()[k], alone.nearer(), 1e-12);
      EXPECT_NEAR(mean.held()[k], alone.held(), 1e-12);
      EXPECT_LE(norm(at(mean.point(), k) - alone.point()), 1e-9);
      EXPECT_LE(norm(at(mean.pull(), k) - alone.pull()), 1e-9);
      EXPECT_NEAR(mean.drill()[k], alone.drill(), 1e-10);
      EXPECT_LE(
          norm(at(mean.lifted({all_of(b.slope.x), Lanes{}}), k) - alone.lifted({b.slope.x, 0.0})),
          1e-10);
      pulled = std::max(pulled, norm(alone.pull()));
    }
  }
};

TEST(PolygonMean, IsThatOfEachPairAlone) {
  families::Rng rng(seed);
  Compared compared;
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "group", i));
    const Drawn quadrangles(rng, 4);
    compared.compare<4>(quadrangles);
    Drawn any(rng, static_cast<int>(PolygonLanes::most));
    any.lanes_a.extend();
    any.lanes_b.extend();
    compared.compare<PolygonLanes::most>(any);
  }
  EXPECT_GT(compared.sure, compared.all / 2);
  EXPECT_GT(compared.pulled, 0.3 * tilt);
}

}  // namespace polygon_mean_test
}  // namespace repel::detail
