// SPDX-License-Identifier: BSD-3-Clause
#include "multibody.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include <repel/base/setup_error.hpp>

namespace repel::bullet::detail {
namespace {

/// Bullet's frame B of a link: at the centre of mass, along the principal axes of inertia.
struct PrincipalFrame {
  Pose X_LB = Pose::Identity();
  Vec3 moments = Vec3::Zero();  ///< [kg m^2]
};

PrincipalFrame principal_frame(const ArmLink& link) {
  const Eigen::SelfAdjointEigenSolver<Mat3> inertia(link.I_C_L);
  Mat3 R_LB = inertia.eigenvectors();
  if (R_LB.determinant() < 0.0) R_LB.col(0) *= -1.0;
  PrincipalFrame frame;
  frame.X_LB.linear() = R_LB;
  frame.X_LB.translation() = link.p_LC;
  frame.moments = inertia.eigenvalues().cwiseMax(0.0);
  return frame;
}

btQuaternion to_bullet(const Mat3& R) {
  const Eigen::Quaterniond q(R);
  return {q.x(), q.y(), q.z(), q.w()};
}

}  // namespace

btTransform to_bullet(const Pose& X) {
  return btTransform(to_bullet(Mat3(X.linear())), to_bullet(Vec3(X.translation())));
}

void require_double_precision() {
  static_assert(sizeof(btScalar) == sizeof(double), "build against pkg-config bullet-float64");
  // A number that a float cannot hold must survive a round trip through the library.
  const double value = 1.0 + 1e-12;
  btMultiBody body(1, 0.0, {0, 0, 0}, true, false);
  body.setupPrismatic(0, 1.0, {1, 1, 1}, -1, {0, 0, 0, 1}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}, true);
  body.finalizeMultiDof();
  body.setJointPos(0, value);
  if (body.getJointPos(0) != value || body.getRVector(0).z() != value) {
    throw SetupError("the Bullet library in use is not built in double precision");
  }
}

std::unique_ptr<btMultiBody> make_multibody(const ArmModel& model) {
  const int links = static_cast<int>(model.links.size());
  auto body = std::make_unique<btMultiBody>(links, 0.0, btVector3(0, 0, 0), true, false);
  Pose X_PA = Pose::Identity();  // A: Bullet's frame of the parent link
  for (int i = 0; i < links; ++i) {
    const ArmLink& link = model.links[static_cast<std::size_t>(i)];
    const auto [X_LB, moments] = principal_frame(link);
    const Pose X_AJ = X_PA.inverse() * link.X_PJ;
    const Mat3 R_BL = X_LB.linear().transpose();
    const btQuaternion R_BA = to_bullet(Mat3(R_BL * X_AJ.linear().transpose()));
    const btVector3 axis_B = to_bullet(Vec3(R_BL * link.axis_J));
    const btVector3 p_AJ_A = to_bullet(Vec3(X_AJ.translation()));
    const btVector3 p_JB_B = to_bullet(Vec3(R_BL * link.p_LC));
    const btVector3 inertia = to_bullet(moments);
    if (link.type == JointType::revolute) {
      body->setupRevolute(i, link.mass, inertia, i - 1, R_BA, axis_B, p_AJ_A, p_JB_B, true);
    } else {
      body->setupPrismatic(i, link.mass, inertia, i - 1, R_BA, axis_B, p_AJ_A, p_JB_B, true);
    }
    X_PA = X_LB;
  }
  body->finalizeMultiDof();
  // Bullet damps by 4 % by default. Its clamp of speeds at 100 rad/s and its deactivation of bodies
  // at rest apply only in its world, which is not used.
  body->setLinearDamping(0.0);
  body->setAngularDamping(0.0);
  return body;
}

}  // namespace repel::bullet::detail
