// SPDX-License-Identifier: BSD-3-Clause
// The kinematics in closed form compared with the chain of KDL.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include <repel/robots/dynamics.hpp>

#include "arms.hpp"

namespace repel {
namespace kinematics_test {

TEST(Kinematics, InertiaAndGravityTorquesAreThoseOfKdl) {
  constexpr unsigned seed = 20240501;
  for (const ArmModel& arm : test::all_arms()) {
    SCOPED_TRACE(arm.name + ", seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    Kinematics kinematics(arm);
    Dynamics kdl(arm);
    for (int sample = 0; sample < 20; ++sample) {
      const auto q = test::random_joints(arm, random);
      kinematics.update(q);
      Eigen::MatrixXd M, expected(q.size(), q.size());
      ASSERT_TRUE(kinematics.mass_matrix(M));
      kdl.inertia(q, expected);
      EXPECT_LT((M - expected).norm(), 1e-12 * expected.norm()) << M;
      std::vector<double> torques(q.size()), balance(q.size());
      kinematics.gravity_torques(torques);
      kdl.bias(q, std::vector<double>(q.size(), 0.0), balance);
      for (std::size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(torques[i], balance[i], 1e-11) << i;
    }
  }
}

}  // namespace kinematics_test
}  // namespace repel
