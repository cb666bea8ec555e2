#include <repel/robots/kinematics.hpp>

#include <cassert>
#include <cstddef>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <vector>

#include "kdl_chain.hpp"

namespace repel {

using detail::chain_of;
using detail::from_kdl;
using detail::to_kdl;

struct Kinematics::Impl {
  struct Axis {
    JointType type;
    Vec3 direction_L;
    Vec3 direction_W;
  };

  explicit Impl(const ArmModel& arm)
      : chain(chain_of(arm)),
        poses_solver(chain),
        // KDL works in the base frame.
        gravity_solver(chain, to_kdl(Vec3(arm.X_WB.linear().transpose() * arm.gravity_W))),
        q(chain.getNrOfJoints()),
        gravity(chain.getNrOfJoints()),
        X_BL(chain.getNrOfSegments()),
        X_WL(chain.getNrOfSegments() + 1, arm.X_WB),
        X_LT(arm.X_LT) {
    for (const ArmLink& link : arm.links) axes.push_back({link.type, link.axis_J, Vec3::Zero()});
  }

  void place_links() noexcept {
    poses_solver.JntToCart(q, X_BL);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      X_WL[i + 1] = X_WL[0] * from_kdl(X_BL[i]);
      axes[i].direction_W = X_WL[i + 1].linear() * axes[i].direction_L;
    }
    X_WT = X_WL.back() * X_LT;
  }

  KDL::Chain chain;  // the solvers refer to it
  KDL::ChainFkSolverPos_recursive poses_solver;
  KDL::ChainDynParam gravity_solver;
  KDL::JntArray q;
  KDL::JntArray gravity;
  std::vector<KDL::Frame> X_BL;
  std::vector<Pose> X_WL;  // the base, then the links
  Pose X_LT;
  Pose X_WT;
  std::vector<Axis> axes;
};

Kinematics::Kinematics(const ArmModel& arm) : impl_(std::make_unique<Impl>(arm)) {
  impl_->place_links();
}
Kinematics::Kinematics(Kinematics&&) noexcept = default;
Kinematics& Kinematics::operator=(Kinematics&&) noexcept = default;
Kinematics::~Kinematics() = default;

int Kinematics::links() const noexcept {
  return static_cast<int>(impl_->axes.size());
}

void Kinematics::update(std::span<const double> q) noexcept {
  assert(q.size() == impl_->axes.size());
  for (std::size_t i = 0; i < impl_->axes.size(); ++i) impl_->q(static_cast<unsigned>(i)) = q[i];
  impl_->place_links();
}

Pose Kinematics::X_WL(int link) const noexcept {
  assert(link >= -1 && link < links());
  return impl_->X_WL[static_cast<std::size_t>(link) + 1U];
}

Pose Kinematics::X_WT() const noexcept {
  return impl_->X_WT;
}

void Kinematics::jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept {
  assert(J.cols() == links());
  J.setZero();
  for (int joint = 0; joint <= link; ++joint) {
    const auto& axis = impl_->axes[static_cast<std::size_t>(joint)];
    if (axis.type == JointType::prismatic) {
      J.col(joint).head<3>() = axis.direction_W;
    } else {
      J.col(joint).head<3>() = axis.direction_W.cross(p_WQ - X_WL(joint).translation());
      J.col(joint).tail<3>() = axis.direction_W;
    }
  }
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): a Ref is a view and is written through
void Kinematics::tool_jacobian(JacobianRef J) const noexcept {
  jacobian(links() - 1, X_WT().translation(), J);
}

void Kinematics::gravity_torques(std::span<double> out) noexcept {
  assert(out.size() == impl_->axes.size());
  impl_->gravity_solver.JntToGravity(impl_->q, impl_->gravity);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = impl_->gravity(static_cast<unsigned>(i));
}

}  // namespace repel

void repel::robots::is_built_for(EigenAlignmentHere /*alignment*/,
                                 VectorRegisterHere /*size*/) noexcept {}
