#include "multibody.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

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

void require(bool fact, const ArmLink& link, const std::string& otherwise) {
  if (!fact) throw SetupError("joint '" + link.joint_name + "': " + otherwise);
}

void require_valid(const ArmLink& link) {
  const auto not_negative = [&](const char* what, double value, const char* unit) {
    checked("joint '" + link.joint_name + "': " + what, value, 0.0,
            std::numeric_limits<double>::max(), unit);
  };
  not_negative("mass", link.mass, "kg");
  not_negative("viscous friction", link.viscous_friction, "N m s/rad");
  not_negative("Coulomb friction", link.coulomb_friction, "N m");
  not_negative("rotor inertia", link.rotor_inertia, "kg m^2");
  require(is_finite(link.X_PJ) && is_rigid(link.X_PJ), link, "X_PJ is not a rigid pose");
  require(std::abs(link.axis_J.norm() - 1.0) <= 1e-9, link, "axis_J is not of unit length");
  require(is_finite(link.p_LC), link, "the centre of mass is not finite");
  require(link.I_C_L.allFinite() && link.I_C_L.isApprox(link.I_C_L.transpose(), 1e-9), link,
          "the inertia is not a finite symmetric matrix");
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(link.I_C_L).eigenvalues();
  require(moments.minCoeff() >= -1e-9 * moments.maxCoeff(), link,
          "the inertia has a negative principal moment");
  require(link.lower < link.upper, link,
          "the limits are " + to_text(link.lower) + " to " + to_text(link.upper) +
              "; the lower must be below the upper (-inf and inf: no stop)");
}

}  // namespace

btTransform to_bullet(const Pose& X) {
  return btTransform(to_bullet(Mat3(X.linear())), to_bullet(Vec3(X.translation())));
}

void require_double_precision() {
  static_assert(sizeof(btScalar) == sizeof(double), "build against pkg-config bullet-float64");
  // A number no float can hold must survive a round trip through the library.
  const double value = 1.0 + 1e-12;
  btMultiBody body(1, 0.0, {0, 0, 0}, true, false);
  body.setupPrismatic(0, 1.0, {1, 1, 1}, -1, {0, 0, 0, 1}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}, true);
  body.finalizeMultiDof();
  body.setJointPos(0, value);
  if (body.getJointPos(0) != value || body.getRVector(0).z() != value) {
    throw SetupError("the Bullet library in use is not built in double precision");
  }
}

void require_valid(const ArmModel& model) {
  if (model.links.empty()) throw SetupError("arm '" + model.name + "' has no links");
  if (!is_finite(model.X_WB) || !is_rigid(model.X_WB)) {
    throw SetupError("arm '" + model.name + "': X_WB is not a rigid pose");
  }
  if (!is_finite(model.gravity_W)) {
    throw SetupError("arm '" + model.name + "': gravity is not finite");
  }
  for (const ArmLink& link : model.links) require_valid(link);
}

std::unique_ptr<btMultiBody> make_multibody(const ArmModel& model) {
  const int links = static_cast<int>(model.links.size());
  auto body = std::make_unique<btMultiBody>(links, 0.0, btVector3(0, 0, 0), true, false);
  Pose X_PA = Pose::Identity();  // A: Bullet's frame of the parent
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
  // Bullet damps by 4 % unless told not to. Its clamp of speeds at 100 rad/s and its putting to
  // sleep are at work only in its world, which is not used.
  body->setLinearDamping(0.0);
  body->setAngularDamping(0.0);
  return body;
}

}  // namespace repel::bullet::detail
