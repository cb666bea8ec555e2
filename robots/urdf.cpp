// SPDX-License-Identifier: BSD-3-Clause
#include <repel/robots/urdf.hpp>

#include <limits>

#include <urdf_parser/urdf_parser.h>
#include <Eigen/Eigenvalues>

#include <repel/base/setup_error.hpp>

#include "chain_choice.hpp"
#include "held_joints.hpp"
#include "merged_body.hpp"
#include "mesh.hpp"
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

/// Adds mass, centre of mass and inertia of a body to those of the link it is fixed to.
void add_body(const urdf::Inertial& body, const Pose& X_LN, ArmLink& link) {
  Mat3 I;
  I << body.ixx, body.ixy, body.ixz,  //
      body.ixy, body.iyy, body.iyz,   //
      body.ixz, body.iyz, body.izz;
  detail::add_body(body.mass, I, X_LN * from_urdf(body.origin), link);
}

/// Converts any geometry except a mesh.
RobotPart simple_part(const urdf::Geometry& geometry, bool is_capsule) {
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

/// Converts the collision elements of links.
class PartReader {
 public:
  PartReader(const detail::UrdfDocument& document, const UrdfOptions& options,
             const std::string& file)
      : document_(document), meshes_({file, options.package_paths}, options.convex_parts) {}

  /// Appends the parts of `node` to `parts`.
  /// @param link index in ArmModel::links, -1 for the base
  void add(const urdf::Link& node, int link, const Pose& X_LN, std::vector<RobotPart>& parts) {
    for (std::size_t i = 0; i < node.collision_array.size(); ++i) {
      const urdf::Collision& collision = *node.collision_array[i];
      for (RobotPart& part : parts_of(node.name, i, *collision.geometry)) {
        std::string name =
            collision.name.empty() ? node.name + "_" + std::to_string(i) : collision.name;
        part.name = name.append(part.name);
        part.in_link = node.name;
        part.link = link;
        part.X_LP = X_LN * from_urdf(collision.origin);
        parts.push_back(std::move(part));
      }
    }
  }

 private:
  /// The parts of collision `index` of `link`, with the ends of their names.
  std::vector<RobotPart> parts_of(const std::string& link, std::size_t index,
                                  const urdf::Geometry& shape) {
    const auto* mesh = dynamic_cast<const urdf::Mesh*>(&shape);
    if (!mesh) return {simple_part(shape, document_.is_capsule(link, index))};
    try {
      const Vec3 scale = from_urdf(mesh->scale);
      const detail::MeshParts& read = meshes_.parts(mesh->filename, scale);
      std::vector<RobotPart> parts;
      for (const std::vector<Vec3>& hull : read.hulls) {
        RobotPart& part = parts.emplace_back();
        if (read.is_cover) part.name = "/" + std::to_string(parts.size());
        part.kind = PartKind::hull;
        part.points = hull;
        part.is_of_cover = read.is_cover;
        part.mesh = read.path;
        part.mesh_scale = scale;
      }
      return parts;
    } catch (const SetupError& error) {
      document_.fail_at_collision(link, index, error.what());
    }
  }

  const detail::UrdfDocument& document_;
  detail::MeshReader meshes_;
};

/// Appends the parts of `node` and of its subtree, with every joint at zero.
// NOLINTNEXTLINE(misc-no-recursion): the tree is no deeper than UrdfDocument allows
void add_at_zero(const urdf::Link& node, const Pose& X_RN, PartReader& reader,
                 std::vector<RobotPart>& parts) {
  reader.add(node, -1, X_RN, parts);
  for (const auto& child : node.child_links) {
    const urdf::Pose& X_NC = child->parent_joint->parent_to_joint_origin_transform;
    add_at_zero(*child, X_RN * from_urdf(X_NC), reader, parts);
  }
}

/// Traverses a parsed model from its root outward and collects links and parts.
class ArmBuilder {
 public:
  ArmBuilder(const detail::UrdfDocument& document, const urdf::ModelInterface& model,
             const UrdfOptions& options, const std::string& file)
      : document_(document),
        chain_(document, model, options),
        joints_(document, model, chain_),
        reader_(document, options, file) {
    robot_.arm.name = model.getName();
    robot_.end = chain_.end().link;
    robot_.end_reason = chain_.end().reason;
    add(*model.getRoot(), -1, Pose::Identity());
    if (robot_.arm.links.empty()) {
      document_.fail_at_link(model.getRoot()->name, "carries no moving joint; allowed: 1 or more");
    }
    require_possible_inertias();
    choose_tool();
  }

  Robot take() { return std::move(robot_); }

 private:
  /// Adds `node`, fixed to arm link `link` at `X_LN`, and its subtree.
  // NOLINTNEXTLINE(misc-no-recursion): the tree is no deeper than UrdfDocument allows
  void add(const urdf::Link& node, int link, const Pose& X_LN) {
    if (link >= 0 && node.inertial) add_body(*node.inertial, X_LN, robot_.arm.links.back());
    robot_.links.push_back({node.name, node.inertial ? node.inertial->mass : 0.0, link, X_LN});
    if (link >= 0 && node.child_links.empty()) robot_.tips.push_back(node.name);
    reader_.add(node, link, X_LN, robot_.parts);
    // The rest of the chain comes last, so that `links.back()` is still this link for its side
    // branches.
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
    if (joint.type == urdf::Joint::FIXED) return add(child, link, X_LJ);
    if (joints_.moves(joint)) {
      robot_.arm.links.push_back(moving_link(child, joint, X_LJ));
      return add(child, link + 1, Pose::Identity());
    }
    const HeldJoint& held = joints_.held(joint);
    require_no_gap(joint, link);
    robot_.held.push_back(held);
    add(child, link, X_LJ * joints_.displacement(joint, held.position));
  }

  /// A joint with several coordinates may say where the base stands, but is not part of an arm.
  void require_no_gap(const urdf::Joint& joint, int link) const {
    const bool has_one = joint.type != urdf::Joint::PLANAR && joint.type != urdf::Joint::FLOATING;
    if (has_one || link < 0 || chain_.hold_of(joint) || !chain_.contains(joint.child_link_name)) {
      return;
    }
    document_.fail_at_joint(joint.name, "is '" + document_.type_of(joint.name) +
                                            "' and between joints of the arm; allowed: revolute, "
                                            "continuous, prismatic, fixed, or one to hold");
  }

  ArmLink moving_link(const urdf::Link& child, const urdf::Joint& joint, const Pose& X_PJ) const {
    ArmLink link;
    link.name = child.name;
    link.joint_name = joint.name;
    link.type = joint.type == urdf::Joint::PRISMATIC ? JointType::prismatic : JointType::revolute;
    link.X_PJ = X_PJ;
    document_.require_range(joint.name);
    link.axis_J = detail::axis_of(joint, document_);
    const bool endless = joint.type == urdf::Joint::CONTINUOUS;
    link.lower = endless ? -std::numeric_limits<double>::infinity() : joint.limits->lower;
    link.upper = endless ? std::numeric_limits<double>::infinity() : joint.limits->upper;
    const double unlimited = std::numeric_limits<double>::infinity();  // if the file gives no limit
    link.velocity_limit = joint.limits ? joint.limits->velocity : unlimited;
    link.effort_limit = joint.limits ? joint.limits->effort : unlimited;
    link.viscous_friction = joint.dynamics ? joint.dynamics->damping : 0.0;
    link.coulomb_friction = joint.dynamics ? joint.dynamics->friction : 0.0;
    link.rotor_inertia = document_.rotor_inertia(joint.name);
    return link;
  }

  void require_possible_inertias() const {
    for (const ArmLink& link : robot_.arm.links) {
      const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(link.I_C_L).eigenvalues();
      if (moments.minCoeff() >= -1e-9 * moments.maxCoeff()) continue;
      document_.fail_at_link(link.name, "has an inertia with a principal moment of " +
                                            to_text(moments.minCoeff()) +
                                            " kg m^2; allowed: 0 or more");
    }
  }

  /// Sets the tool frame.
  void choose_tool() {
    const int last = static_cast<int>(robot_.arm.links.size()) - 1;
    std::vector<std::string> still;  // fixed to the last moving link, which is the first of them
    for (const RobotLink& link : robot_.links) {
      if (link.link == last) still.push_back(link.name);
    }
    const detail::ChosenLink tool = chain_.tool(still);
    robot_.tool = tool.link;
    robot_.tool_reason = tool.reason;
    for (const RobotLink& link : robot_.links) {
      if (link.name == tool.link) robot_.arm.X_LT = link.X_LN;
    }
  }

  const detail::UrdfDocument& document_;
  detail::ChainChoice chain_;
  detail::HeldJoints joints_;
  PartReader reader_;
  Robot robot_;
};

urdf::ModelInterfaceSharedPtr model_of(const detail::UrdfDocument& document,
                                       const std::string& file) {
  auto model = urdf::parseURDF(document.text_for_urdfdom());
  if (!model) throw SetupError("urdfdom cannot read this file; it has said why on stderr", file);
  document.require_all_collisions(*model);
  return model;
}

}  // namespace

Robot parse_arm(std::string_view urdf, const UrdfOptions& options, const std::string& file) {
  const detail::UrdfDocument document(urdf, file);
  const auto model = model_of(document, file);
  return ArmBuilder(document, *model, options, file).take();
}

Robot load_arm(const std::string& path, const UrdfOptions& options) {
  return parse_arm(detail::text_of_description(path), options, path);
}

std::vector<RobotPart> load_parts(const std::string& path, const UrdfOptions& options) {
  const detail::UrdfDocument document(detail::text_of_description(path), path);
  const auto model = model_of(document, path);
  PartReader reader(document, options, path);
  std::vector<RobotPart> parts;
  add_at_zero(*model->getRoot(), Pose::Identity(), reader, parts);
  return parts;
}

bool reads_meshes() noexcept {
  return detail::has_mesh_reader();
}

}  // namespace repel
