#include <repel/robots/urdf.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include <urdf_parser/urdf_parser.h>

#include <repel/base/setup_error.hpp>

#include "urdf_document.hpp"

namespace repel {
namespace {

Vec3 from_urdf(const urdf::Vector3& v) {
  return {v.x, v.y, v.z};
}

Pose from_urdf(const urdf::Pose& X) {
  const auto& r = X.rotation;
  Pose result = Pose::Identity();
  result.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  result.translation() = from_urdf(X.position);
  return result;
}

/// Inertia of a mass about the origin, at `p` from it.
Mat3 point_inertia(double mass, const Vec3& p) {
  return mass * (p.squaredNorm() * Mat3::Identity() - p * p.transpose());
}

/// Adds a body with its own mass, centre and inertia to those of the link it is fixed to.
void add_body(const urdf::Inertial& body, const Pose& X_LN, ArmLink& link) {
  const double total = link.mass + body.mass;
  if (!(total > 0.0)) return;
  const Pose X_LC = X_LN * from_urdf(body.origin);
  Mat3 I;
  I << body.ixx, body.ixy, body.ixz,  //
      body.ixy, body.iyy, body.iyz,   //
      body.ixz, body.iyz, body.izz;
  const Vec3 centre = (link.mass * link.p_LC + body.mass * X_LC.translation()) / total;
  link.I_C_L += point_inertia(link.mass, link.p_LC - centre) +
                X_LC.linear() * I * X_LC.linear().transpose() +
                point_inertia(body.mass, X_LC.translation() - centre);
  link.p_LC = centre;
  link.mass = total;
}

RobotPart part_of(const urdf::Geometry& geometry, bool is_capsule) {
  RobotPart part;
  if (const auto* box = dynamic_cast<const urdf::Box*>(&geometry)) {
    part.kind = PartKind::box;
    part.size = 0.5 * from_urdf(box->dim);
  } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&geometry)) {
    part.kind = PartKind::sphere;
    part.size = {sphere->radius, 0.0, 0.0};
  } else {
    const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
    part.kind = is_capsule ? PartKind::capsule : PartKind::cylinder;
    part.size = {cylinder.radius, 0.5 * cylinder.length, 0.0};
  }
  return part;
}

/// Walks a parsed model from its root outward and gathers links and parts.
class ArmBuilder {
 public:
  ArmBuilder(const detail::UrdfDocument& document, const urdf::ModelInterface& model,
             const UrdfOptions& options)
      : document_(document), options_(options) {
    robot_.arm.name = model.getName();
    require_known(model);
    find_chain(model);
    add(*model.getRoot(), -1, Pose::Identity());
    finish(model);
  }

  Robot take() { return std::move(robot_); }

 private:
  bool moves(const urdf::Joint& joint) const {
    return joint.type != urdf::Joint::FIXED &&
           std::find(options_.hold.begin(), options_.hold.end(), joint.name) == options_.hold.end();
  }

  void require_known(const urdf::ModelInterface& model) const {
    for (const std::string& name : options_.hold) {
      if (!model.getJoint(name)) {
        document_.fail_at_link(model.getRoot()->name, "has no joint '" + name + "' to hold");
      }
    }
    if (!options_.tip.empty() && !model.getLink(options_.tip)) {
      document_.fail_at_link(model.getRoot()->name, "leads to no tip '" + options_.tip + "'");
    }
  }

  /// The links from the root to the tip.
  void find_chain(const urdf::ModelInterface& model) {
    urdf::LinkConstSharedPtr tip = model.getRoot();
    while (options_.tip.empty() && !tip->child_links.empty()) {
      if (tip->child_links.size() > 1) {
        document_.fail_at_link(tip->name, "branches into '" + tip->child_links[0]->name +
                                              "' and '" + tip->child_links[1]->name +
                                              "'; allowed: one chain, or a chosen tip");
      }
      tip = tip->child_links.front();
    }
    if (!options_.tip.empty()) tip = model.getLink(options_.tip);
    tip_ = tip->name;
    for (; tip; tip = tip->getParent()) chain_.insert(tip->name);
  }

  /// Adds `node`, fixed to arm link `link` at `X_LN`, and all beyond it.
  // NOLINTNEXTLINE(misc-no-recursion): a file is a tree, read once at set-up
  void add(const urdf::Link& node, int link, const Pose& X_LN) {
    if (link >= 0 && node.inertial) add_body(*node.inertial, X_LN, robot_.arm.links.back());
    add_parts(node, link, X_LN);
    if (node.name == tip_) robot_.arm.X_LT = X_LN;
    // The rest of the chain comes last, so that `links.back()` is still this link for its branches.
    for (const bool in_chain : {false, true}) {
      for (const auto& child : node.child_links) {
        if (chain_.contains(child->name) == in_chain) add_child(*child, link, X_LN);
      }
    }
  }

  // NOLINTNEXTLINE(misc-no-recursion): as add()
  void add_child(const urdf::Link& child, int link, const Pose& X_LN) {
    const urdf::Joint& joint = *child.parent_joint;
    const Pose X_LJ = X_LN * from_urdf(joint.parent_to_joint_origin_transform);
    if (!moves(joint)) return add(child, link, X_LJ);
    if (!chain_.contains(child.name)) {
      document_.fail_at_joint(joint.name, "moves beside the chain to '" + tip_ +
                                              "'; allowed: a joint of the chain, or one to hold");
    }
    robot_.arm.links.push_back(moving_link(child, joint, X_LJ));
    add(child, link + 1, Pose::Identity());
  }

  ArmLink moving_link(const urdf::Link& child, const urdf::Joint& joint, const Pose& X_PJ) const {
    ArmLink link;
    link.name = child.name;
    link.joint_name = joint.name;
    link.type = joint.type == urdf::Joint::PRISMATIC ? JointType::prismatic : JointType::revolute;
    link.X_PJ = X_PJ;
    const double axis_length = from_urdf(joint.axis).norm();
    if (!(axis_length > 1e-6)) {
      document_.fail_at_joint(joint.name, "has an axis of length " + to_text(axis_length) +
                                              "; allowed: more than 1e-06");
    }
    link.axis_J = from_urdf(joint.axis) / axis_length;
    const bool endless = joint.type == urdf::Joint::CONTINUOUS;
    link.lower = endless ? -std::numeric_limits<double>::infinity() : joint.limits->lower;
    link.upper = endless ? std::numeric_limits<double>::infinity() : joint.limits->upper;
    link.velocity_limit = joint.limits->velocity;
    link.effort_limit = joint.limits->effort;
    link.viscous_friction = joint.dynamics ? joint.dynamics->damping : 0.0;
    link.coulomb_friction = joint.dynamics ? joint.dynamics->friction : 0.0;
    link.rotor_inertia = document_.rotor_inertia(joint.name);
    return link;
  }

  void add_parts(const urdf::Link& node, int link, const Pose& X_LN) {
    for (std::size_t i = 0; i < node.collision_array.size(); ++i) {
      const urdf::Collision& collision = *node.collision_array[i];
      RobotPart part = part_of(*collision.geometry, document_.is_capsule(node.name, i));
      part.name = collision.name.empty() ? node.name + "_" + std::to_string(i) : collision.name;
      part.link = link;
      part.X_LP = X_LN * from_urdf(collision.origin);
      robot_.parts.push_back(std::move(part));
    }
  }

  void finish(const urdf::ModelInterface& model) const {
    if (robot_.arm.links.empty()) {
      document_.fail_at_link(model.getRoot()->name, "carries no moving joint; allowed: 1 or more");
    }
    for (const ArmLink& link : robot_.arm.links) {
      const bool positive = link.I_C_L.llt().info() == Eigen::Success;
      if (link.mass > 0.0 && positive) continue;
      document_.fail_at_link(link.name,
                             "moves with a mass of " + to_text(link.mass) + " kg" +
                                 (positive ? "" : " and an inertia that is not positive") +
                                 "; allowed: an <inertial> with mass and inertia above 0");
    }
  }

  const detail::UrdfDocument& document_;
  const UrdfOptions& options_;
  std::string tip_;
  std::set<std::string> chain_;
  Robot robot_;
};

}  // namespace

Robot parse_arm(std::string_view urdf, const UrdfOptions& options, const std::string& file) {
  detail::UrdfDocument document(urdf, file);
  const auto model = urdf::parseURDF(document.text_for_urdfdom());
  if (!model) throw SetupError("urdfdom cannot read this file; it has said why on stderr", file);
  document.require_all_collisions(*model);
  return ArmBuilder(document, *model, options).take();
}

Robot load_arm(const std::string& path, const UrdfOptions& options) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw SetupError("cannot be opened", path);
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  return parse_arm(text, options, path);
}

}  // namespace repel
