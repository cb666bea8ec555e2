// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Forward kinematics, Jacobians, gravity compensation and inertia of an arm of links.
#pragma once

#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <repel/base/setup_error.hpp>
#include <repel/base/spatial.hpp>
#include <repel/base/types.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/arm_kinematics.hpp>

namespace repel {

namespace detail {

inline void require_usable(const ArmLink& link) {
  const bool finite = is_finite(link.X_PJ) && is_finite(link.p_LC) && is_finite(link.I_C_L) &&
                      link.mass - link.mass == 0.0;
  if (!finite) throw SetupError("link '" + link.name + "' holds a value that is not finite");
  const std::string axis_length = "length of the axis of joint '" + link.joint_name + "'";
  checked(axis_length, norm(link.axis_J), 1.0 - 1e-9, 1.0 + 1e-9, "");
}

/// @throws SetupError if the arm has no link, a value is not finite or an axis is not of unit
/// length
inline void require_usable(const ArmModel& arm) {
  if (arm.links.empty()) throw SetupError("arm '" + arm.name + "' has no link; allowed: 1 or more");
  if (!is_finite(arm.X_WB) || !is_finite(arm.X_LT) || !is_finite(arm.gravity_W)) {
    throw SetupError("arm '" + arm.name + "' has a base, tool or gravity that is not finite");
  }
  for (const ArmLink& link : arm.links) require_usable(link);
}

inline Vec3 vector_product(const Vec3& a, const Vec3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Mat3 vector_product_matrix(const Vec3& u) {
  Mat3 U;
  U << 0.0, -u[2], u[1], u[2], 0.0, -u[0], -u[1], u[0], 0.0;
  return U;
}

/// a b^T
inline Mat3 outer_product(const Vec3& a, const Vec3& b) noexcept {
  Mat3 product;
  for (int k = 0; k < 9; ++k) product.data()[k] = a[k % 3] * b[k / 3];
  return product;
}

inline Pose pose_with(const Mat3& R, const Vec3& p) noexcept {
  Pose X = Pose::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) X.data()[4 * i + k] = R.data()[3 * i + k];
    X.data()[12 + i] = p[i];
  }
  return X;
}

/// A link and the joint that carries it.
struct PlacedLink {
  explicit PlacedLink(const ArmLink& model)
      : link(model),
        turns(model.type == JointType::revolute),
        p_PJ(origin(model.X_PJ)),
        axis_P(rotation(model.X_PJ) * model.axis_J),
        fixed(rotation(model.X_PJ)),
        of_cosine(Mat3::Zero()),
        of_sine(Mat3::Zero()) {
    if (!turns) return;
    const Mat3 R_PJ = fixed;
    fixed = R_PJ * outer_product(link.axis_J, link.axis_J);
    for (int k = 0; k < 9; ++k) of_cosine.data()[k] = R_PJ.data()[k] - fixed.data()[k];
    of_sine = R_PJ * vector_product_matrix(link.axis_J);
  }

  /// Moves the joint to `q` [rad] or [m], on the parent P.
  void place(const Mat3& R_WP, const Vec3& p_WP, double q) noexcept {
    axis = R_WP * axis_P;
    p = p_WP + R_WP * p_PJ;
    if (turns) {
      const double c = std::cos(q), s = std::sin(q);
      Mat3 R_PL;
      for (int k = 0; k < 9; ++k) {
        R_PL.data()[k] = fixed.data()[k] + (c * of_cosine.data()[k] + s * of_sine.data()[k]);
      }
      R = R_WP * R_PL;
    } else {
      R = R_WP * fixed;
      p = p + q * axis;
    }
    centre = p + R * link.p_LC;
  }

  /// The twist of the point `q` [m] that moves with the joint, at a rate of 1.
  [[nodiscard]] Twist twist_at(const Vec3& q) const noexcept {
    if (!turns) return {axis, {0, 0, 0}};
    return {vector_product(axis, q - p), axis};
  }

  ArmLink link;
  bool turns;
  Vec3 p_PJ, axis_P;  // [m] and unit, in the parent
  // The rotation from the parent to the link, fixed + cos(q) of_cosine + sin(q) of_sine (Rodrigues)
  Mat3 fixed, of_cosine, of_sine;

  // World axes, as of the last update:
  Mat3 R = Mat3::Zero();
  Vec3 p{0, 0, 0};       // [m] origin
  Vec3 axis{0, 0, 1};    // of the joint
  Vec3 centre{0, 0, 0};  // [m] of mass
  Twist at_tip{};        // of the origin of the last link, at a rate of 1
};

/// Links that move as one body.
struct CompositeLink {
  double mass = 0.0;     // [kg]
  Vec3 centre{0, 0, 0};  // [m]
  double I[6] = {};      // [kg m^2] about the centre, world axes: xx, yy, zz, yz, zx, xy

  /// By the parallel-axis theorem.
  void add(const PlacedLink& body) noexcept {
    const double sum = mass + body.link.mass;
    const double share = sum > 0.0 ? body.link.mass / sum : 0.0;
    const Vec3 d = body.centre - centre;
    const Vec3 moment = share * mass * d;
    const double square = dot(moment, d);
    const Mat3 half = body.R * body.link.I_C_L;
    const auto entry = [&](int i, int k) {  // of R I R' - moment d'
      const double *h = half.data() + i, *r = body.R.data() + k;
      return h[0] * r[0] + h[3] * r[3] + h[6] * r[6] - moment[i] * d[k];
    };
    I[0] += entry(0, 0) + square;
    I[1] += entry(1, 1) + square;
    I[2] += entry(2, 2) + square;
    I[3] += entry(1, 2);
    I[4] += entry(2, 0);
    I[5] += entry(0, 1);
    centre = centre + share * d;
    mass = sum;
  }

  /// I w [kg m^2/s].
  [[nodiscard]] Vec3 spin(const Vec3& w) const noexcept {
    return {I[0] * w[0] + I[5] * w[1] + I[4] * w[2], I[5] * w[0] + I[1] * w[1] + I[3] * w[2],
            I[4] * w[0] + I[3] * w[1] + I[2] * w[2]};
  }
};

}  // namespace detail

/// Forward kinematics, Jacobians, gravity torques and inertia of one arm, in closed form: `update`
/// places every link once, all else is read off these poses. After construction nothing here
/// allocates, locks or throws. Not thread-safe: use one instance per thread.
///
/// Spans have one entry per link, base outward. Joint positions that are not finite give poses,
/// Jacobians and torques that are not finite.
class Kinematics final : public ArmKinematics {
 public:
  /// All joints start at zero.
  /// @throws SetupError if `arm` has no link, a value is not finite or an axis is not of unit
  ///   length
  explicit Kinematics(const ArmModel& arm)
      : X_WB_(arm.X_WB), X_LT_(arm.X_LT), X_WT_(arm.X_LT), gravity_W_(arm.gravity_W) {
    detail::require_usable(arm);
    for (const ArmLink& link : arm.links) bodies_.emplace_back(link);
    std::vector<double> zeros(bodies_.size());
    place({zeros.data(), zeros.size()});
  }

  /// The number of moving links.
  [[nodiscard]] int links() const noexcept { return static_cast<int>(bodies_.size()); }

  /// Sets the joint positions `q` [rad] or [m]; all other functions refer to this pose.
  void update(std::span<const double> q) noexcept override { place(q); }

  /// Pose of a link in the world [m]; of the base for -1.
  [[nodiscard]] Pose X_WL(int link) const noexcept override {
    assert(link >= -1 && link < links());
    if (link < 0) return X_WB_;
    const detail::PlacedLink& body = bodies_[static_cast<std::size_t>(link)];
    return detail::pose_with(body.R, body.p);
  }

  /// Pose of the tool frame in the world [m].
  [[nodiscard]] Pose X_WT() const noexcept override { return X_WT_; }

  /// Jacobian of the point Q fixed on `link` (-1: the base), currently at `p_WQ` [m]; world axes.
  // NOLINTNEXTLINE(performance-unnecessary-value-param): a Ref is a view and is written through
  void jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept override {
    assert(J.cols() == links());
    double* column = J.data();
    int joint = 0;
    for (const detail::PlacedLink& body : bodies_) {
      const Twist V = joint++ <= link ? body.twist_at(p_WQ) : Twist{};
      for (int i = 0; i < 3; ++i) {
        column[i] = V.linear[i];
        column[i + 3] = V.angular[i];
      }
      column += J.outerStride();
    }
  }

  /// Jacobian of the origin of the tool frame; world axes.
  // NOLINTNEXTLINE(performance-unnecessary-value-param): a Ref is a view and is written through
  void tool_jacobian(JacobianRef J) const noexcept override {
    jacobian(links() - 1, origin(X_WT_), J);
  }

  /// The torques [N m] or forces [N] that hold the arm still against gravity.
  // From the tip, with the mass m and the first moment h of all links beyond a joint.
  void gravity_torques(std::span<double> out) noexcept override {
    assert(out.size() == bodies_.size());
    double m = 0.0;
    Vec3 h{0, 0, 0};
    for (std::size_t i = out.size(); i-- > 0;) {
      const detail::PlacedLink& body = bodies_[i];
      m += body.link.mass;
      h = h + body.link.mass * body.centre;
      const Vec3 moved =
          body.turns ? detail::vector_product(body.axis, h - m * body.p) : m * body.axis;
      out[i] = -dot(gravity_W_, moved);
    }
  }

  /// The joint-space inertia matrix [kg m^2] or [kg], rotors included. Allocates unless `M` has the
  /// size of the arm. @return true
  // The composite rigid body algorithm (Featherstone 2008, section 6.2): the momentum of all links
  // beyond a joint that turns at a rate of 1, along the axes before it. Momenta are about the
  // origin of the last link, where the inertias are least and rounding matters most.
  [[nodiscard]] bool mass_matrix(Eigen::MatrixXd& M) const noexcept override {
    const std::size_t n = bodies_.size();
    const Vec3& tip = bodies_.back().p;
    M.resize(links(), links());
    detail::CompositeLink beyond;
    for (std::size_t i = n; i-- > 0;) {
      const detail::PlacedLink& body = bodies_[i];
      beyond.add(body);
      const Twist V = body.twist_at(beyond.centre);
      const Vec3 P = beyond.mass * V.linear;
      const Vec3 L = beyond.spin(V.angular) + detail::vector_product(beyond.centre - tip, P);
      for (std::size_t k = 0; k <= i; ++k) {
        const Twist& along = bodies_[k].at_tip;
        M.data()[n * i + k] = M.data()[n * k + i] = dot(along.linear, P) + dot(along.angular, L);
      }
      M.data()[n * i + i] += body.link.rotor_inertia;
    }
    return true;
  }

 private:
  void place(std::span<const double> q) noexcept {
    assert(q.size() == bodies_.size());
    Mat3 R_WP = rotation(X_WB_);
    Vec3 p_WP = origin(X_WB_);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      bodies_[i].place(R_WP, p_WP, q[i]);
      R_WP = bodies_[i].R;
      p_WP = bodies_[i].p;
    }
    for (detail::PlacedLink& body : bodies_) body.at_tip = body.twist_at(p_WP);
    X_WT_ = composed(detail::pose_with(R_WP, p_WP), X_LT_);
  }

  std::vector<detail::PlacedLink> bodies_;  // base outward
  Pose X_WB_, X_LT_, X_WT_;
  Vec3 gravity_W_;
};

}  // namespace repel
