#include <repel/reduction/answer.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace answer_test {

TEST(Answer, ADefaultOneClaimsNothing) {
  const Separation s;
  EXPECT_EQ(s.end, QueryEnd::bad_input);
  EXPECT_EQ(s.lower, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(s.upper, std::numeric_limits<double>::infinity());
}

TEST(Answer, CoresApartGiveTheGapLessTheirDepths) {
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

}  // namespace answer_test
}  // namespace repel
