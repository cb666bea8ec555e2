// SPDX-License-Identifier: BSD-3-Clause
// What a simulated arm can touch, and what is refused.
#include <repel/simulated/contact.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace repel {
namespace contact_test {

TEST(Contact, TheCoreReachesAsFarAsTheSizesOfAShapeSay) {
  EXPECT_EQ(core_extents(Shape::box({0.1, 0.2, 0.3})), Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(core_extents(Shape::sphere(0.1)), Vec3(0.0, 0.0, 0.0));
  EXPECT_EQ(core_extents(Shape::capsule(0.1, 0.3)), Vec3(0.0, 0.0, 0.3));
  EXPECT_EQ(core_extents(Shape::cylinder(0.1, 0.3)), Vec3(0.1, 0.1, 0.3));
  EXPECT_EQ(core_extents(Shape::cone(0.1, 0.3)), Vec3(0.1, 0.1, 0.3));
}

/// The error message of an arm of one link for a part on `link` at `X_LP`.
std::string complaint(int link, const Pose& X_LP) {
  ArmModel model;
  model.links.emplace_back();
  const std::vector<ContactPart> parts{{"rod", link, Shape::sphere(0.1), X_LP}};
  try {
    require_touchable(parts, model);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Contact, APartOnNoLinkOrAtNoPoseIsRefusedByName) {
  EXPECT_EQ(complaint(-1, Pose::Identity()), "accepted");
  EXPECT_EQ(complaint(0, Pose::Identity()), "accepted");
  EXPECT_EQ(complaint(1, Pose::Identity()), "part 'rod': link is 1; allowed: -1 to 0");
  EXPECT_NE(complaint(-2, Pose::Identity()), "accepted");
  Pose bent = Pose::Identity();
  bent.linear() *= 2.0;
  EXPECT_EQ(complaint(0, bent), "part 'rod': X_LP is not a rigid pose");
  Pose nowhere = Pose::Identity();
  nowhere.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint(0, nowhere), "part 'rod': X_LP is not a rigid pose");
}

}  // namespace contact_test
}  // namespace repel
