// SPDX-License-Identifier: BSD-3-Clause
#include <repel/base/lanes.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace repel::detail {
namespace lanes_test {

Vec<double> numbered(int k) {
  return {k + 0.25, -k - 0.5, 3.0 * k};
}

TEST(Lanes, AreWhatTheirNumbersAreOneByOne) {
  const Lanes a = lanes_of([](int k) { return k % 2 == 0 ? 2.0 * k + 1.0 : -k; });
  const Lanes b = lanes_of([](int k) { return 1.5 * k; });
  double most = -1e300, least = 1e300;
  for (int k = 0; k < lane_count; ++k) {
    EXPECT_EQ(larger(a, b)[k], std::max(a[k], b[k]));
    EXPECT_EQ(smaller(a, b)[k], std::min(a[k], b[k]));
    EXPECT_EQ(magnitudes(a)[k], std::abs(a[k]));
    EXPECT_EQ(roots(magnitudes(a))[k], std::sqrt(std::abs(a[k])));
    EXPECT_EQ(bits_of(a > b) >> k & 1U, a[k] > b[k] ? 1U : 0U);
    most = std::max(most, a[k]);
    least = std::min(least, a[k]);
  }
  EXPECT_EQ(largest_of(a), most);
  EXPECT_EQ(least_of(a), least);
  EXPECT_EQ(bits_of(a == a), (1U << lane_count) - 1U);
  EXPECT_EQ(bits_of(~(a == a)), 0U);
}

TEST(Lanes, AMissingNumberHoldsInNoComparison) {
  const Lanes none = Lanes{} + std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(bits_of((none < 1.0) | (none >= 1.0) | (none == none)), 0U);
}

TEST(LaneVec, TakesVectorsApartAndPutsThemTogether) {
  const LaneVec v = LaneVec::of(numbered);
  const auto each = v.each();
  for (int k = 0; k < lane_count; ++k) {
    EXPECT_EQ(v.x[k], numbered(k).x());
    EXPECT_EQ(v.y[k], numbered(k).y());
    EXPECT_EQ(v.z[k], numbered(k).z());
    EXPECT_EQ(to_vec3(each[static_cast<std::size_t>(k)]), to_vec3(numbered(k)));
  }
  const LaneVec same = LaneVec::all(numbered(2));
  EXPECT_EQ(bits_of((same.x == 2.25) & (same.y == -2.5) & (same.z == 6.0)),
            (1U << lane_count) - 1U);
}

TEST(LaneVec, ComputesInEachLaneWhatVecDoes) {
  const auto other = [](int k) { return Vec<double>(1.0 - k, 2.0, 0.125 * k); };
  const LaneVec a = LaneVec::of(numbered);
  const LaneVec b = LaneVec::of(other);
  const auto crossed = cross(a, b).each();
  const auto added = (a + b - -b).each();
  const auto scaled = (sum(magnitudes(a)) * product(a, b)).each();
  const auto chosen = either(a.x > 1.0, a, b).each();
  for (int k = 0; k < lane_count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Vec3 p = to_vec3(numbered(k));
    const Vec3 q = to_vec3(other(k));
    EXPECT_DOUBLE_EQ(dot(a, b)[k], p.dot(q));
    EXPECT_LE((to_vec3(crossed[i]) - p.cross(q)).norm(), 1e-14);
    EXPECT_LE((to_vec3(added[i]) - (p + 2.0 * q)).norm(), 1e-14);
    EXPECT_LE((to_vec3(scaled[i]) - p.cwiseAbs().sum() * p.cwiseProduct(q)).norm(), 1e-12);
    EXPECT_EQ(to_vec3(chosen[i]), p.x() > 1.0 ? p : q);
  }
}

TEST(LanePose, TurnsIntoTheWorldAndBack) {
  const auto pose = [](int k) {
    Pose X = Pose::Identity();
    X.linear() = Eigen::AngleAxisd(0.3 * k + 0.1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    X.translation() = Vec3(k, 2.0, 3.0);
    return X;
  };
  std::array<Pose, lane_count> each;
  std::array<const Pose*, lane_count> places;
  for (std::size_t k = 0; k < each.size(); ++k) {
    each[k] = pose(static_cast<int>(k));
    places[k] = &each[k];
  }
  const LanePose X = LanePose::of(places);
  const auto turned = X.rotate(LaneVec::of(numbered)).each();
  const auto back = X.rotate_transposed(LaneVec::of(numbered)).each();
  for (int k = 0; k < lane_count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Vec3 v = to_vec3(numbered(k));
    EXPECT_LE((to_vec3(turned[i]) - pose(k).linear() * v).norm(), 1e-14 * (1.0 + v.norm()));
    EXPECT_LE((to_vec3(back[i]) - pose(k).linear().transpose() * v).norm(),
              1e-14 * (1.0 + v.norm()));
    EXPECT_EQ(X.columns[3].x[k], k);
  }
  EXPECT_EQ(LanePose::all(pose(1)).columns[1].z[0], pose(1)(2, 1));
}

}  // namespace lanes_test
}  // namespace repel::detail
