// SPDX-License-Identifier: BSD-3-Clause
#include "held_joints.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel::detail {
namespace {

constexpr double most_turn = 1e6;  // [rad] of a continuous joint

bool has_limits(const urdf::Joint& joint) {
  return joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::PRISMATIC;
}

/// Whether one number says where it stands.
bool has_position(const urdf::Joint& joint) {
  return joint.type != urdf::Joint::PLANAR && joint.type != urdf::Joint::FLOATING;
}

std::string unit_of(const urdf::Joint& joint) {
  return joint.type == urdf::Joint::PRISMATIC ? "m" : "rad";
}

std::string range_of(const urdf::Joint& joint) {
  return to_text(joint.limits->lower) + " to " + to_text(joint.limits->upper) + " " +
         unit_of(joint);
}

}  // namespace

/// Whether `joint` moves if it mimics none.
bool HeldJoints::is_of_the_arm(const urdf::Joint& joint) const {
  return joint.type != urdf::Joint::FIXED && has_position(joint) &&
         chain_.contains(joint.child_link_name) && chain_.hold_of(joint) == nullptr;
}

bool HeldJoints::moves(const urdf::Joint& joint) const {
  if (!is_of_the_arm(joint)) return false;
  if (!joint.mimic) return true;
  if (follows_a_moving_one(joint)) refuse_follower(joint);
  return false;
}

/// Whether the joint that `joint` mimics, directly or through others, is one of the arm.
bool HeldJoints::follows_a_moving_one(const urdf::Joint& joint) const {
  const urdf::Joint* at = &joint;
  while (at->mimic) {
    at = model_.getJoint(at->mimic->joint_name).get();
    if (chain_.hold_of(*at) != nullptr) return false;
  }
  return is_of_the_arm(*at);
}

void HeldJoints::refuse_follower(const urdf::Joint& joint) const {
  document_.fail_at_joint(
      joint.name, "mimics '" + joint.mimic->joint_name + "', which moves with the chain to '" +
                      chain_.end().link +
                      "'; a joint of the arm must move on its own; allowed: to hold '" +
                      joint.name +
                      "' at a given place (`hold` of a scene, --hold), to hold the mimicked joint, "
                      "or a tip before that");
}

const HeldJoint& HeldJoints::held(const urdf::Joint& joint) {
  std::vector<const urdf::Joint*> open;  // each mimics the next
  for (const urdf::Joint* at = &joint; !held_.contains(at->name);) {
    open.push_back(at);
    const Hold* hold = chain_.hold_of(*at);
    if (!at->mimic || (hold != nullptr && hold->position)) break;
    if (follows_a_moving_one(*at)) {
      if (hold == nullptr) refuse_follower(*at);
      break;
    }
    at = model_.getJoint(at->mimic->joint_name).get();
    if (at->type == urdf::Joint::FIXED) held_[at->name] = {at->name, "fixed", 0.0, ""};
  }
  std::reverse(open.begin(), open.end());
  for (const urdf::Joint* at : open) {
    const Hold* hold = chain_.hold_of(*at);
    const auto leader = at->mimic ? held_.find(at->mimic->joint_name) : held_.end();
    if (hold != nullptr && hold->position) {
      held_[at->name] = as_chosen(*at, *hold);
    } else if (leader != held_.end() && !follows_a_moving_one(*at)) {
      held_[at->name] = following(*at, leader->second.position);
    } else {
      held_[at->name] = near_zero(*at);
    }
  }
  return held_.at(joint.name);
}

HeldJoint HeldJoints::as_chosen(const urdf::Joint& joint, const Hold& hold) const {
  const double q = *hold.position;
  const auto refuse = [&](const std::string& allowed) {
    document_.fail_at_joint(joint.name, "is to be held at " + to_text(q) + "; allowed: " + allowed);
  };
  if (!has_position(joint)) refuse("no value, since it has more than one coordinate");
  const bool slides = joint.type == urdf::Joint::PRISMATIC;
  if (hold.type && (*hold.type == JointType::prismatic) != slides) {
    refuse(slides ? "a length, since it slides" : "an angle, since it turns");
  }
  if (has_limits(joint) && !(q >= joint.limits->lower && q <= joint.limits->upper)) {
    refuse(range_of(joint));
  }
  return within_limits(joint, q, "as chosen");
}

HeldJoint HeldJoints::near_zero(const urdf::Joint& joint) const {
  return within_limits(joint, 0.0,
                       chain_.hold_of(joint) != nullptr ? "as chosen" : "beside the chain");
}

HeldJoint HeldJoints::following(const urdf::Joint& joint, double leader) const {
  const double q = joint.mimic->multiplier * leader + joint.mimic->offset;
  return within_limits(joint, q, "mimics " + joint.mimic->joint_name);
}

HeldJoint HeldJoints::within_limits(const urdf::Joint& joint, double wanted,
                                    const std::string& reason) const {
  HeldJoint held{joint.name, document_.type_of(joint.name), wanted, reason};
  if (!has_limits(joint)) {
    if (std::abs(wanted) <= most_turn) return held;
    document_.fail_at_joint(joint.name, "is to be held at " + to_text(wanted) + " rad; allowed: " +
                                            to_text(-most_turn) + " to " + to_text(most_turn));
  }
  if (!(joint.limits->lower <= joint.limits->upper)) {
    document_.fail_at_joint(joint.name, "has limits from " + range_of(joint) +
                                            "; allowed: lower not above "
                                            "upper");
  }
  held.position = std::clamp(wanted, joint.limits->lower, joint.limits->upper);
  if (held.position != wanted) {
    held.reason += "; " + to_text(wanted, 6) + " " + unit_of(joint) + " is out of its range " +
                   range_of(joint);
  }
  return held;
}

Vec3 axis_of(const urdf::Joint& joint, const UrdfDocument& document) {
  const Vec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
  const double length = axis.norm();
  if (length > 1e-6) return axis / length;
  document.fail_at_joint(joint.name,
                         "has an axis of length " + to_text(length) + "; allowed: more than 1e-06");
}

Pose HeldJoints::displacement(const urdf::Joint& joint, double position) const {
  Pose X = Pose::Identity();
  if (position == 0.0) return X;
  const Vec3 axis = axis_of(joint, document_);
  if (joint.type == urdf::Joint::PRISMATIC) {
    X.translation() = position * axis;
  } else {
    X.linear() = Eigen::AngleAxisd(position, axis).toRotationMatrix();
  }
  return X;
}

}  // namespace repel::detail
