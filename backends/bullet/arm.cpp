// SPDX-License-Identifier: BSD-3-Clause
#include "repel/bullet/arm.hpp"

#include <memory>
#include <span>
#include <vector>

#include <repel/base/setup_error.hpp>

#include "contacts.hpp"
#include "implicit_joints.hpp"
#include "multibody.hpp"

namespace repel::bullet {
namespace {

ArmModel validated(const ArmModel& model, const ArmOptions& options) {
  detail::require_double_precision();
  require_simulable(model);
  require_valid(options);
  return model;
}

class Engine final : public ArmEngine {
 public:
  Engine(const ArmModel& given, const ArmOptions& options, std::span<const ContactPart> parts);

  void put(std::span<const double> at, std::span<const double> moving) noexcept override;
  bool sub_step(std::span<const double> torque, bool braked, double h) noexcept override;
  std::span<const double> q() const noexcept override { return {q_.data(), links()}; }
  std::span<const double> v() const noexcept override { return {v_.data(), links()}; }

 private:
  std::size_t links() const noexcept { return model().links.size(); }
  void read_state() noexcept;
  void load(const Eigen::VectorXd& joint_torque) noexcept;
  void find_free_acceleration() noexcept;
  void require_inertia_at_every_joint();

  detail::ImplicitJoints joints_;
  std::unique_ptr<btMultiBody> body_;
  std::unique_ptr<detail::Contacts> contacts_;  // null without parts
  Eigen::VectorXd q_, v_, a_;                   // state; acceleration
  Eigen::MatrixXd M_inverse_;
  // Bullet's scratch memory; generalized vectors have 6 entries for the base, then one per joint.
  btAlignedObjectArray<btScalar> scalars_;
  btAlignedObjectArray<btVector3> vectors_;
  btAlignedObjectArray<btMatrix3x3> matrices_;
  std::vector<btScalar> unit_force_, response_;
};

Engine::Engine(const ArmModel& given, const ArmOptions& options, std::span<const ContactPart> parts)
    : ArmEngine(validated(given, options)),
      joints_(model(), options),
      body_(detail::make_multibody(model())),
      contacts_(parts.empty()
                    ? nullptr
                    : std::make_unique<detail::Contacts>(model(), options, parts, contacts())),
      q_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(links()))),
      v_(q_),
      a_(q_),
      M_inverse_(q_.size(), q_.size()),
      unit_force_(6 + links()),
      response_(6 + links()) {
  put(start_of(model()), {});
  require_inertia_at_every_joint();
  // The first step allocates Bullet's scratch memory.
  (void)sub_step(std::vector<double>(links()), false, 1e-3);
}

void Engine::put(std::span<const double> at, std::span<const double> moving) noexcept {
  body_->clearForcesAndTorques();
  body_->clearVelocities();
  body_->setBaseWorldTransform(detail::to_bullet(model().X_WB));
  for (int i = 0; i < q_.size(); ++i) {
    const auto joint = static_cast<std::size_t>(i);
    body_->setJointPos(i, at[joint]);
    body_->setJointVel(i, moving.empty() ? 0.0 : moving[joint]);
  }
  if (contacts_) contacts_->forget();
  read_state();
}

void Engine::read_state() noexcept {
  for (int i = 0; i < q_.size(); ++i) {
    q_[i] = body_->getJointPos(i);
    v_[i] = body_->getJointVel(i);
  }
}

void Engine::load(const Eigen::VectorXd& joint_torque) noexcept {
  body_->clearForcesAndTorques();
  for (int i = 0; i < q_.size(); ++i) {
    body_->addLinkForce(i, detail::to_bullet(Vec3(body_->getLinkMass(i) * model().gravity_W)));
    body_->addJointTorque(i, joint_torque[i]);
  }
}

// a = M^-1 (u - c) by the articulated-body algorithm. Then M^-1 column by column, from the factors
// that the algorithm leaves: the acceleration change due to a unit torque at one joint.
void Engine::find_free_acceleration() noexcept {
  body_->computeAccelerationsArticulatedBodyAlgorithmMultiDof(0.0, scalars_, vectors_, matrices_,
                                                              false, false, false);
  for (int i = 0; i < q_.size(); ++i) a_[i] = scalars_[static_cast<int>(q_.size()) + 6 + i];
  for (int i = 0; i < q_.size(); ++i) {
    unit_force_[6 + static_cast<std::size_t>(i)] = 1.0;
    body_->calcAccelerationDeltasMultiDof(unit_force_.data(), response_.data(), scalars_, vectors_);
    unit_force_[6 + static_cast<std::size_t>(i)] = 0.0;
    M_inverse_.col(i) = Eigen::Map<const Eigen::VectorXd>(response_.data() + 6, q_.size());
  }
}

void Engine::require_inertia_at_every_joint() {
  load(Eigen::VectorXd::Zero(q_.size()));
  find_free_acceleration();
  for (int i = 0; i < q_.size(); ++i) {
    if (M_inverse_(i, i) > 0.0) continue;  // Bullet returns 0 for a joint that moves no mass
    throw SetupError("joint '" + model().links[static_cast<std::size_t>(i)].joint_name +
                     "' moves no mass; give its link a mass or an inertia about the joint axis");
  }
}

// Bullet's own world is not used: it integrates only the result of its articulated-body algorithm,
// so D and f would have to be fed back as torques. That costs a second run of the algorithm and
// multiplies the rounding error of a by D / M.
bool Engine::sub_step(std::span<const double> torque, bool braked, double h) noexcept {
  load(joints_.linearize(q_, v_, torque, h));  // gravity and joint torque
  find_free_acceleration();                    // -> a, M^-1
  if (contacts_) contacts_->find(q_);
  joints_.solve(M_inverse_, a_, v_, h, braked,
                contacts_.get());  // -> a with rotors, stops and friction
  if (contacts_) contacts_->note_forces();
  v_ += h * a_;
  const bool moves = v_.allFinite() && (q_ + h * v_).allFinite();
  if (!moves) v_.setZero();
  for (int i = 0; i < q_.size(); ++i) body_->setJointVel(i, v_[i]);
  body_->stepPositionsMultiDof(h);  // q += h v
  read_state();
  return moves;
}

}  // namespace

Arm::Arm(const ArmModel& model, const ArmOptions& options, std::span<const ContactPart> parts)
    : SimulatedArm(std::make_unique<Engine>(model, options, parts), options.substeps,
                   options.watchdog) {}

}  // namespace repel::bullet
