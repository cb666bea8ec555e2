// SPDX-License-Identifier: BSD-3-Clause
#include <repel/robots/dynamics.hpp>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <kdl/chaindynparam.hpp>
#include <limits>

#include <repel/simulated/brake_torque.hpp>

#include "kdl_chain.hpp"

namespace repel {

namespace {

std::span<double> span_of(Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}
std::span<const double> span_of(const Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

}  // namespace

struct Dynamics::Impl {
  explicit Impl(const ArmModel& arm)
      : chain(detail::chain_of(arm)),
        solver(chain, detail::to_kdl(Vec3(arm.X_WB.linear().transpose() * arm.gravity_W))),
        links(chain.getNrOfJoints()),
        q(links),
        v(links),
        coriolis(links),
        gravity(links),
        M(links) {
    for (const ArmLink& link : arm.links) rotors.push_back(link.rotor_inertia);
  }

  KDL::Chain chain;  // the solver refers to it
  KDL::ChainDynParam solver;
  unsigned links;
  KDL::JntArray q, v, coriolis, gravity;
  KDL::JntSpaceInertiaMatrix M;
  std::vector<double> rotors;
};

Dynamics::Dynamics(const ArmModel& arm) : impl_(std::make_unique<Impl>(arm)) {}
Dynamics::Dynamics(Dynamics&&) noexcept = default;
Dynamics& Dynamics::operator=(Dynamics&&) noexcept = default;
Dynamics::~Dynamics() = default;

int Dynamics::links() const noexcept {
  return static_cast<int>(impl_->links);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a Ref is a view and is written through
void Dynamics::inertia(std::span<const double> q, MatrixRef M) noexcept {
  std::copy(q.begin(), q.end(), impl_->q.data.begin());
  impl_->solver.JntToMass(impl_->q, impl_->M);
  M = impl_->M.data;
  for (unsigned i = 0; i < impl_->links; ++i) M(i, i) += impl_->rotors[i];
}

void Dynamics::bias(std::span<const double> q, std::span<const double> v,
                    std::span<double> out) noexcept {
  std::copy(q.begin(), q.end(), impl_->q.data.begin());
  std::copy(v.begin(), v.end(), impl_->v.data.begin());
  impl_->solver.JntToCoriolis(impl_->q, impl_->v, impl_->coriolis);
  impl_->solver.JntToGravity(impl_->q, impl_->gravity);
  for (unsigned i = 0; i < impl_->links; ++i) out[i] = impl_->coriolis(i) + impl_->gravity(i);
}

namespace {

// Joints move beyond their limits, so that a reset may put them there as well.
ArmModel without_limits(ArmModel model) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (ArmLink& link : model.links) {
    link.lower = -infinity;
    link.upper = infinity;
  }
  return model;
}

class ReferenceEngine final : public ArmEngine {
 public:
  ReferenceEngine(const ArmModel& arm, const ReferenceOptions& options)
      : ArmEngine(without_limits(arm)),
        dynamics_(arm),
        friction_speed_(options.friction_speed),
        M_(dynamics_.links(), dynamics_.links()) {
    const double largest = std::numeric_limits<double>::max();
    checked("ReferenceOptions::substeps", options.substeps, 1, 100000, "");
    checked("ReferenceOptions::friction_speed", options.friction_speed,
            std::numeric_limits<double>::min(), largest, "rad/s or m/s");
    const Vector zero = Vector::Zero(dynamics_.links());
    at_ = {zero, zero};
    bias_ = viscous_ = most_held_ = zero;
    dynamics_.inertia(span_of(at_.q), M_);
    for (Eigen::Index i = 0; i < zero.size(); ++i) {
      const ArmLink& link = arm.links[static_cast<std::size_t>(i)];
      checked("joint '" + link.joint_name + "': inertia it moves", M_(i, i), 1e-12, largest,
              "kg m^2 or kg");
      viscous_[i] = link.viscous_friction;
      most_held_[i] = link.coulomb_friction + brake_torque(arm, static_cast<int>(i));
    }
  }

  void put(std::span<const double> q, std::span<const double> v) noexcept override {
    std::copy(q.begin(), q.end(), at_.q.begin());
    at_.v.setZero();
    std::copy(v.begin(), v.end(), at_.v.begin());
  }

  bool sub_step(std::span<const double> torque, bool braked, double h) noexcept override {
    const Eigen::Map<const Vector> tau(torque.data(), at_.q.size());
    const State next = braked ? slowed(h) : driven(tau, h);
    const bool moves = next.q.allFinite() && next.v.allFinite();
    if (moves) {
      at_ = next;
    } else {
      at_.v.setZero();
    }
    return moves;
  }

  std::span<const double> q() const noexcept override { return span_of(at_.q); }
  std::span<const double> v() const noexcept override { return span_of(at_.v); }

  double kinetic_energy() noexcept {
    dynamics_.inertia(span_of(at_.q), M_);
    return 0.5 * at_.v.dot(M_ * at_.v);
  }

 private:
  using Vector = Eigen::VectorXd;

  struct State {
    Vector q, v;
  };

  /// Time derivative of the state: velocity and acceleration.
  State rate(const Eigen::Map<const Vector>& torque, const State& x) {
    dynamics_.inertia(span_of(x.q), M_);
    dynamics_.bias(span_of(x.q), span_of(x.v), span_of(bias_));
    Vector tau = torque - bias_;
    for (Eigen::Index i = 0; i < tau.size(); ++i) {
      const ArmLink& link = model().links[static_cast<std::size_t>(i)];
      tau[i] -= link.viscous_friction * x.v[i] +
                link.coulomb_friction * std::tanh(x.v[i] / friction_speed_);
    }
    return {x.v, M_.llt().solve(tau)};
  }

  static State moved(const State& x, const State& rate, double h) {
    return {x.q + h * rate.q, x.v + h * rate.v};
  }

  State driven(const Eigen::Map<const Vector>& torque, double h) {
    const State k1 = rate(torque, at_);
    const State k2 = rate(torque, moved(at_, k1, 0.5 * h));
    const State k3 = rate(torque, moved(at_, k2, 0.5 * h));
    const State k4 = rate(torque, moved(at_, k3, h));
    return {at_.q + h / 6.0 * (k1.q + 2.0 * k2.q + 2.0 * k3.q + k4.q),
            at_.v + h / 6.0 * (k1.v + 2.0 * k2.v + 2.0 * k3.v + k4.v)};
  }

  // Semi-implicit Euler with dry friction f, that of the brakes included, and no motor torque:
  //     (M + h B) v' = M v + h (f - c),   |f_i| <= F_i,   f_i = -F_i sign(v'_i) unless v'_i = 0.
  // The search starts from the friction that stops every joint; if that is within the bounds, the
  // arm is held without any error.
  State slowed(double h) {
    dynamics_.inertia(span_of(at_.q), M_);
    dynamics_.bias(span_of(at_.q), span_of(at_.v), span_of(bias_));
    const Vector holding = bias_ - M_ * at_.v / h;
    const Vector f = holding.cwiseMin(most_held_).cwiseMax(-most_held_);
    if (f == holding) return {at_.q, Vector::Zero(f.size())};
    M_.diagonal() += h * viscous_;
    const Eigen::MatrixXd W = M_.inverse();
    Vector v = h * W * (f - holding);
    oppose(W, f, h, v);
    return {at_.q + h * v, v};
  }

  /// Finds the friction by projected Gauss-Seidel, starting from `f`, and updates the velocity `v`.
  void oppose(const Eigen::MatrixXd& W, Vector f, double h, Vector& v) const {
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      double change = 0.0;  // [rad/s] largest in this sweep
      for (Eigen::Index i = 0; i < f.size(); ++i) {
        const double stopping = f[i] - v[i] / (h * W(i, i));
        const double added = std::clamp(stopping, -most_held_[i], most_held_[i]) - f[i];
        f[i] += added;
        v += added * h * W.col(i);
        change = std::max(change, h * std::abs(added) * W(i, i));
      }
      if (change < settled) return;
    }
  }

  static constexpr int most_sweeps = 1000;
  static constexpr double settled = 1e-14;  // [rad/s] or [m/s]

  Dynamics dynamics_;
  double friction_speed_;  // [rad/s] or [m/s]
  Eigen::MatrixXd M_;
  State at_;
  Vector bias_;
  Vector viscous_, most_held_;  // [N m s/rad]; [N m] dry friction of a joint and its brake
};

}  // namespace

ReferenceArm::ReferenceArm(const ArmModel& model, const ReferenceOptions& options)
    : SimulatedArm(std::make_unique<ReferenceEngine>(model, options), options.substeps,
                   options.watchdog) {}

double ReferenceArm::kinetic_energy() noexcept {
  return static_cast<ReferenceEngine&>(engine()).kinetic_energy();
}

}  // namespace repel

void repel::robots::is_built_for(EigenAlignmentHere /*alignment*/,
                                 VectorRegisterHere /*size*/) noexcept {}
