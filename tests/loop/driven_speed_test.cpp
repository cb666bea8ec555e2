// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/driven_speed.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "support/draws.hpp"
#include "support/families.hpp"

namespace repel {
namespace driven_speed_test {

using Vector = ArmInertia::Vector;
constexpr unsigned seed = 27;
constexpr double horizon = 0.015, limit = 0.25;

/// Three masses on rails along x, y and z: the last has the mass of the first, and so on.
struct Rails : ArmKinematics {
  Rails() {
    for (const double mass : {2.0, 3.0, 5.0}) {
      ArmLink link;
      link.type = JointType::prismatic;
      link.mass = mass;
      model.links.push_back(link);
    }
  }
  void update(std::span<const double> /*q*/) noexcept override {}
  [[nodiscard]] Pose X_WT() const noexcept override { return Pose::Identity(); }
  [[nodiscard]] Pose X_WL(int /*link*/) const noexcept override { return Pose::Identity(); }
  void tool_jacobian(JacobianRef J) const noexcept override { jacobian(2, {0, 0, 0}, J); }
  void jacobian(int link, const Vec3& /*p_WQ*/, JacobianRef J) const noexcept override {
    J.setZero();
    for (int i = 0; i <= link; ++i) J(i, i) = 1.0;
  }
  void gravity_torques(std::span<double> out) noexcept override {
    std::fill(out.begin(), out.end(), 0.0);
  }
  ArmModel model;
};

struct DrivenSpeed : testing::Test {
  Rails rails;
  ArmInertia inertia{rails.model};
  network::Jacobian jacobian = network::Jacobian::Zero(6, 3);

  DrivenSpeed() {
    rails.tool_jacobian(jacobian);
    (void)inertia.update(rails);
  }
  /// [m/s] after the horizon, with this share of the torques. The rails carry each other: 10, 8
  /// and 5 kg.
  [[nodiscard]] static double speed_after(const Vector& v, const Vector& torques, double share) {
    const Vec3 mass(10.0, 8.0, 5.0);
    Vec3 then;
    for (int i = 0; i < 3; ++i) then[i] = v(i) + share * horizon * torques(i) / mass[i];
    return then.norm();
  }
  [[nodiscard]] double share(const Vector& v, const Vector& torques) const {
    return share_within(jacobian, v, torques, inertia, horizon, limit);
  }
};

TEST_F(DrivenSpeed, IsTheGreatestShareThatKeepsTheLimit) {
  families::Rng rng(seed);
  int cut = 0;
  for (int i = 0; i < families::draws(2000); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "motion", i));
    Vector v(3), torques(3);
    for (Eigen::Index k = 0; k < 3; ++k) {
      v(k) = families::uniform(rng, -0.14, 0.14);
      torques(k) = std::pow(10.0, families::uniform(rng, 0.0, 6.0)) * (rng() % 2 == 0 ? 1.0 : -1.0);
    }
    const double s = share(v, torques);
    ASSERT_GE(s, 0.0);
    ASSERT_LE(s, 1.0);
    EXPECT_LE(speed_after(v, torques, s), limit * (1.0 + 1e-9));
    if (s < 1.0) {
      EXPECT_NEAR(speed_after(v, torques, s), limit, 1e-6);
    }
    cut += s < 1.0 ? 1 : 0;
  }
  EXPECT_GT(cut, families::draws(1000));
}

TEST_F(DrivenSpeed, AToolThatIsTooFastIsNotDrivenOnButMayBeHeldBack) {
  const Vector v = Vector::Constant(3, 0.2);
  EXPECT_EQ(share(v, Vector::Constant(3, 1.0)), 0.0);
  EXPECT_EQ(share(v, Vector::Constant(3, -1.0)), 1.0);
}

TEST_F(DrivenSpeed, AtRestNothingIsHeldBackAndWithoutAMassNothingIsKnown) {
  EXPECT_EQ(share(Vector::Zero(3), Vector::Zero(3)), 1.0);
  EXPECT_EQ(share(Vector::Constant(3, 0.1), Vector::Constant(3, std::nan(""))), 1.0);
}

}  // namespace driven_speed_test
}  // namespace repel
