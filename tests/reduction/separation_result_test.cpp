// SPDX-License-Identifier: BSD-3-Clause
#include <repel/reduction/separation_result.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace separation_result_test {

TEST(SeparationResult, ADefaultOneClaimsNothing) {
  const Separation s;
  EXPECT_EQ(s.end, QueryEnd::bad_input);
  EXPECT_EQ(s.lower, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(s.upper, std::numeric_limits<double>::infinity());
}

TEST(SeparationResult, CoresApartGiveTheGapLessTheirDepths) {
  Gap gap;
  gap.distance = gap.lower = gap.upper = 1.0;
  gap.n_BA_W = {0.0, 0.0, 1.0};
  gap.p_AQa_W = {0.0, 0.0, -0.5};
  gap.p_AQb_W = {0.0, 0.0, -1.5};
  gap.end = QueryEnd::converged;
  Pose X_WA = Pose::Identity();
  X_WA.translation() = Vec3(10, 20, 30);
  const Separation s = detail::apart(gap, 0.25, 0.5, X_WA);
  EXPECT_DOUBLE_EQ(s.distance, 0.25);
  EXPECT_LT(s.lower, 0.25) << "rounded outward";
  EXPECT_GT(s.upper, 0.25) << "rounded outward";
  EXPECT_EQ(s.p_WA, Vec3(10, 20, 29.25));
  EXPECT_EQ(s.p_WB, Vec3(10, 20, 29));
  EXPECT_EQ(s.extraction_W, Vec3::UnitZ());
  EXPECT_EQ(s.end, QueryEnd::converged);
}

TEST(SeparationResult, LanesHaveTheBitsOfASinglePair) {
  Gap gap;
  gap.distance = 0.1;
  gap.lower = 0.1 - 1e-15;
  gap.upper = 0.1 + 1e-15;
  gap.n_BA_W = {0.6, 0.0, -0.8};
  gap.p_AQa_W = {0.3, 0.7, -0.5};
  gap.p_AQb_W = {0.24, 0.7, -0.42};
  Pose X_WA = Pose::Identity();
  X_WA.translation() = Vec3(1.1, 2.3, 3.7);
  const Separation one = detail::apart(gap, 0.013, 0.027, X_WA);
  struct {
    detail::Lanes distance, lower, upper;
    detail::LaneVec n_BA_W, p_AQa_W, p_AQb_W;
  } lane_gap{detail::all_of(gap.distance),      detail::all_of(gap.lower),
             detail::all_of(gap.upper),         detail::LaneVec::all(gap.n_BA_W),
             detail::LaneVec::all(gap.p_AQa_W), detail::LaneVec::all(gap.p_AQb_W)};
  const detail::Apart<detail::Lanes, detail::LaneVec> lanes(
      lane_gap, detail::all_of(0.013), detail::all_of(0.027),
      detail::LaneVec::all(Vec<double>(X_WA.translation())));
  for (int k = 0; k < detail::lane_count; ++k) {
    EXPECT_EQ(lanes.distance[k], one.distance);
    EXPECT_EQ(lanes.lower[k], one.lower);
    EXPECT_EQ(lanes.upper[k], one.upper);
    EXPECT_EQ(lanes.p_WA.at(k), one.p_WA);
    EXPECT_EQ(lanes.p_WB.at(k), one.p_WB);
    EXPECT_EQ(lanes.extraction_W.at(k), one.extraction_W);
  }
}

}  // namespace separation_result_test
}  // namespace repel
