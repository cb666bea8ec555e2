// SPDX-License-Identifier: BSD-3-Clause
#include <repel/robots/kinematics.hpp>

#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

#include <repel/base/spatial.hpp>

#include "usable_arm.hpp"

namespace repel {

namespace detail {

inline Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Mat3 cross_matrix(const Vec3& u) {
  Mat3 U;
  U << 0.0, -u[2], u[1], u[2], 0.0, -u[0], -u[1], u[0], 0.0;
  return U;
}

inline Pose pose_of(const Mat3& R, const Vec3& p) noexcept {
  Pose X = Pose::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) X.data()[4 * i + k] = R.data()[3 * i + k];
    X.data()[12 + i] = p[i];
  }
  return X;
}

/// A link and the joint that carries it.
struct Body {
  explicit Body(const ArmLink& model)
      : link(model),
        turns(model.type == JointType::revolute),
        p_PJ(origin(model.X_PJ)),
        axis_P(rotation(model.X_PJ) * model.axis_J),
        fixed(rotation(model.X_PJ)),
        of_cosine(Mat3::Zero()),
        of_sine(Mat3::Zero()) {
    if (!turns) return;
    const Mat3 R_PJ = fixed;
    fixed = R_PJ * Mat3(link.axis_J * link.axis_J.transpose());
    of_cosine = R_PJ - fixed;
    of_sine = R_PJ * cross_matrix(link.axis_J);
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
    return {cross(axis, q - p), axis};
  }

  ArmLink link;
  bool turns;
  Vec3 p_PJ, axis_P;  // [m] and unit, in the parent
  // The rotation from the parent to the link, fixed + cos(q) of_cosine + sin(q) of_sine (Rodrigues)
  Mat3 fixed, of_cosine, of_sine;

  // World axes, as of the last update:
  Mat3 R = Mat3::Identity();
  Vec3 p{0, 0, 0};       // [m] origin
  Vec3 axis{0, 0, 1};    // of the joint
  Vec3 centre{0, 0, 0};  // [m] of mass
  Twist at_tip{};        // of the origin of the last link, at a rate of 1
};

/// Links that move as one body.
struct Composite {
  double mass = 0.0;     // [kg]
  Vec3 centre{0, 0, 0};  // [m]
  double I[6] = {};      // [kg m^2] about the centre, world axes: xx, yy, zz, yz, zx, xy

  /// By the parallel-axis theorem.
  void add(const Body& body) noexcept {
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

using detail::Body;
using detail::Composite;
using detail::cross;
using detail::pose_of;

struct Kinematics::Impl {
  explicit Impl(const ArmModel& arm)
      : X_WB(arm.X_WB), X_LT(arm.X_LT), X_WT(arm.X_LT), gravity_W(arm.gravity_W) {
    detail::require_usable(arm);
    for (const ArmLink& link : arm.links) bodies.emplace_back(link);
    update(std::vector<double>(bodies.size(), 0.0));
  }

  void update(std::span<const double> q) noexcept {
    Mat3 R_WP = rotation(X_WB);
    Vec3 p_WP = origin(X_WB);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      bodies[i].place(R_WP, p_WP, q[i]);
      R_WP = bodies[i].R;
      p_WP = bodies[i].p;
    }
    for (Body& body : bodies) body.at_tip = body.twist_at(p_WP);
    X_WT = composed(pose_of(R_WP, p_WP), X_LT);
  }

  std::vector<Body> bodies;  // base outward
  Pose X_WB, X_LT, X_WT;
  Vec3 gravity_W;
};

Kinematics::Kinematics(const ArmModel& arm) : impl_(std::make_unique<Impl>(arm)) {}
Kinematics::Kinematics(Kinematics&&) noexcept = default;
Kinematics& Kinematics::operator=(Kinematics&&) noexcept = default;
Kinematics::~Kinematics() = default;

int Kinematics::links() const noexcept {
  return static_cast<int>(impl_->bodies.size());
}

void Kinematics::update(std::span<const double> q) noexcept {
  assert(q.size() == impl_->bodies.size());
  impl_->update(q);
}

Pose Kinematics::X_WL(int link) const noexcept {
  assert(link >= -1 && link < links());
  if (link < 0) return impl_->X_WB;
  const Body& body = impl_->bodies[static_cast<std::size_t>(link)];
  return pose_of(body.R, body.p);
}

Pose Kinematics::X_WT() const noexcept {
  return impl_->X_WT;
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a Ref is a view and is written through
void Kinematics::jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept {
  assert(J.cols() == links());
  double* column = J.data();
  int joint = 0;
  for (const Body& body : impl_->bodies) {
    const Twist V = joint++ <= link ? body.twist_at(p_WQ) : Twist{};
    for (int i = 0; i < 3; ++i) {
      column[i] = V.linear[i];
      column[i + 3] = V.angular[i];
    }
    column += J.outerStride();
  }
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a Ref is a view and is written through
void Kinematics::tool_jacobian(JacobianRef J) const noexcept {
  jacobian(links() - 1, origin(impl_->X_WT), J);
}

// From the tip, with the mass m and the first moment h of all links beyond a joint.
void Kinematics::gravity_torques(std::span<double> out) noexcept {
  assert(out.size() == impl_->bodies.size());
  double m = 0.0;
  Vec3 h{0, 0, 0};
  for (std::size_t i = out.size(); i-- > 0;) {
    const Body& body = impl_->bodies[i];
    m += body.link.mass;
    h = h + body.link.mass * body.centre;
    const Vec3 moved = body.turns ? cross(body.axis, h - m * body.p) : m * body.axis;
    out[i] = -dot(impl_->gravity_W, moved);
  }
}

// The composite rigid body algorithm (Featherstone 2008, section 6.2): the momentum of all links
// beyond a joint that turns at a rate of 1, along the axes before it. Momenta are about the origin
// of the last link, where the inertias are least and rounding matters most.
bool Kinematics::mass_matrix(Eigen::MatrixXd& M) const noexcept {
  const std::vector<Body>& bodies = impl_->bodies;
  const std::size_t n = bodies.size();
  const Vec3& tip = bodies.back().p;
  M.resize(links(), links());
  Composite beyond;
  for (std::size_t i = n; i-- > 0;) {
    const Body& body = bodies[i];
    beyond.add(body);
    const Twist V = body.twist_at(beyond.centre);
    const Vec3 P = beyond.mass * V.linear;
    const Vec3 L = beyond.spin(V.angular) + cross(beyond.centre - tip, P);
    for (std::size_t k = 0; k <= i; ++k) {
      const Twist& along = bodies[k].at_tip;
      M.data()[n * i + k] = M.data()[n * k + i] = dot(along.linear, P) + dot(along.angular, L);
    }
    M.data()[n * i + i] += body.link.rotor_inertia;
  }
  return true;
}

}  // namespace repel

void repel::robots::is_built_for(EigenAlignmentHere /*alignment*/,
                                 VectorRegisterHere /*size*/) noexcept {}
