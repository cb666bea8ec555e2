// SPDX-License-Identifier: BSD-3-Clause
#include <repel/robots/mjcf.hpp>

#include <repel/base/setup_error.hpp>

#ifdef REPEL_HAS_MUJOCO
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>

#include <repel/geometry/facets.hpp>

#include "child_process.hpp"
#include "merged_body.hpp"
#include "parcel.hpp"
#include "urdf_document.hpp"
#endif

namespace repel {

#ifdef REPEL_HAS_MUJOCO
namespace {

/// A hinge or slide as MuJoCo has compiled it.
struct MjcfJoint {
  std::string name;
  int is_slide = 0;
  Vec3 p_BJ{0, 0, 0};      ///< [m] of its axis, in the body
  Vec3 axis_B{0, 0, 1};    ///< unit
  double reference = 0.0;  ///< [rad] or [m] position in which its body stands as the file puts it
  double lower = 0.0;      ///< [rad] or [m]
  double upper = 0.0;
  double damping = 0.0;       ///< [N m s/rad] or [N s/m]
  double friction = 0.0;      ///< [N m] or [N]
  double armature = 0.0;      ///< [kg m^2] or [kg]
  double effort_limit = 0.0;  ///< [N m] or [N]; 0: unknown
  double stiffness = 0.0;     ///< [N m/rad] or [N/m] of its spring
};

struct MjcfBody {
  std::string name;
  int parent = 0;
  Pose X_PB = Pose::Identity();  ///< [m] with all joints at their references
  double mass = 0.0;             ///< [kg]
  Pose X_BC = Pose::Identity();  ///< [m] principal axes of inertia
  Vec3 moments{0, 0, 0};         ///< [kg m^2]
  std::vector<MjcfJoint> joints;
  std::vector<RobotPart> parts;  ///< X_LP: in the body
};

struct MjcfSite {
  std::string name;
  int body = 0;
  Pose X_BS = Pose::Identity();  ///< [m]
};

/// An active equality constraint, or a tendon.
struct MjcfTie {
  std::string what;                 ///< it is
  int acts = 0;                     ///< 0: a tendon that actuators alone pull
  int is_coupling = 0;              ///< of the positions of two joints
  std::vector<std::string> joints;  ///< whose motion it feels
};

/// What an arm is made of.
struct MjcfArm {
  std::string name;
  Vec3 gravity_W{0, 0, 0};       ///< [m/s^2]
  std::vector<MjcfBody> bodies;  ///< parents first; the first is the world
  std::vector<MjcfSite> sites;
  std::vector<MjcfTie> ties;
};

struct EndMjcf {
  void operator()(mjModel* ended) const { mj_deleteModel(ended); }
};
using MjcfModel = std::unique_ptr<mjModel, EndMjcf>;

Pose pose_of(const mjtNum* p, const mjtNum* q) {
  Pose X = Pose::Identity();
  X.translation() = Vec3(p[0], p[1], p[2]);
  X.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  return X;
}

/// What MuJoCo says about the file, on one line, with the number of the line it gives: at the end,
/// as "line 3" or "line = 3".
[[noreturn]] void fail_as(std::string message, const std::string& path) {
  constexpr std::string_view mark = ", line ";
  const auto at = message.rfind(mark);
  int line = 0;
  if (at != std::string::npos) {
    const auto digits = message.find_first_not_of("= ", at + mark.size());
    line = digits == std::string::npos ? 0 : std::atoi(message.c_str() + digits);
    message.resize(at);
  }
  std::string text;
  for (const char c : message) {
    if (c != '\n') {
      text += c;
    } else if (!text.empty() && text.back() != ' ') {
      text += ", ";
    }
  }
  while (!text.empty() && (text.back() == ' ' || text.back() == ',')) text.pop_back();
  throw SetupError("MuJoCo refuses the file: " + text, path, line);
}

/// Reads a compiled model; runs in the child process.
class MjcfGathering {
 public:
  MjcfGathering(const mjModel& model, const std::string& path) : m_(model), path_(path) {}

  [[nodiscard]] MjcfArm arm() const {
    require_bodies_and_joints_alone();
    constexpr int first_with_parts = 1;  // what stands in the world is around the arm
    MjcfArm arm;
    arm.bodies = bodies(first_with_parts);
    arm.name = m_.names;  // the name of the model is the first
    if ((m_.opt.disableflags & mjDSBL_GRAVITY) == 0) {
      arm.gravity_W = Eigen::Map<const Vec3>(m_.opt.gravity);
    }
    for (int i = 0; i < m_.njnt; ++i) {
      at(arm.bodies, m_.jnt_bodyid[i]).joints.push_back(joint(i));
    }
    for (int i = 0; i < m_.nsite; ++i) {
      arm.sites.push_back({name_of(mjOBJ_SITE, i, "site"), m_.site_bodyid[i],
                           pose_of(m_.site_pos + 3 * i, m_.site_quat + 4 * i)});
    }
    for (int i = 0; i < m_.neq; ++i) {
      if (m_.eq_active[i] != 0) arm.ties.push_back(constraint(i));
    }
    for (int i = 0; i < m_.ntendon; ++i) arm.ties.push_back(tendon(i));
    return arm;
  }

  /// Bodies without their joints, and the parts of those from `first_with_parts` on.
  [[nodiscard]] std::vector<MjcfBody> bodies(int first_with_parts) const {
    if (static_cast<std::size_t>(m_.nbody) > detail::most_urdf_links) {
      refuse("the file has " + std::to_string(m_.nbody) + " bodies",
             "up to " + std::to_string(detail::most_urdf_links));
    }
    std::vector<MjcfBody> all;
    for (int i = 0; i < m_.nbody; ++i) all.push_back(body(i));
    for (int i = 0; i < m_.ngeom; ++i) {
      if (m_.geom_bodyid[i] < first_with_parts || !touches(i)) continue;
      MjcfBody& body = at(all, m_.geom_bodyid[i]);
      body.parts.push_back(part(i, body));
    }
    return all;
  }

 private:
  static MjcfBody& at(std::vector<MjcfBody>& bodies, int body) {
    return bodies[static_cast<std::size_t>(body)];
  }

  [[nodiscard]] std::string name_of(mjtObj type, int id, const std::string& kind) const {
    const char* const name = mj_id2name(&m_, type, id);
    return name != nullptr ? name : kind + "_" + std::to_string(id);
  }

  [[noreturn]] void refuse(const std::string& what, const std::string& allowed) const {
    throw SetupError(what + "; allowed: " + allowed, path_);
  }

  /// What would move the arm beside its joints, and is not part of an ArmModel.
  void require_bodies_and_joints_alone() const {
    const std::string alone = "an arm of bodies, hinges and slides";
    if (m_.opt.density > 0.0 || m_.opt.viscosity > 0.0) {
      refuse("the option density or viscosity gives the arm a medium", "0");
    }
    for (int i = 1; i < m_.nbody; ++i) {
      if (m_.body_mocapid[i] < 0) continue;
      refuse("body '" + name_of(mjOBJ_BODY, i, "body") + "' is a mocap body", alone);
    }
  }

  using Joints = std::set<int>;

  /// Adds the joints that move one body against the other.
  void add_between(int a, int b, Joints& joints) const {
    while (a != b) {
      int& outer = a > b ? a : b;  // a parent has the smaller index
      for (int i = 0; i < m_.body_jntnum[outer]; ++i) joints.insert(m_.body_jntadr[outer] + i);
      outer = m_.body_parentid[outer];
    }
  }

  /// Those that change the length of a tendon.
  [[nodiscard]] Joints joints_of_tendon(int tendon) const {
    Joints joints;
    int before = -1;  // the body that it comes from
    for (int i = m_.tendon_adr[tendon]; i < m_.tendon_adr[tendon] + m_.tendon_num[tendon]; ++i) {
      const int object = m_.wrap_objid[i];
      int body = -1;
      switch (m_.wrap_type[i]) {
        case mjWRAP_JOINT:
          joints.insert(object);
          break;
        case mjWRAP_SITE:
          body = m_.site_bodyid[object];
          break;
        case mjWRAP_SPHERE:
        case mjWRAP_CYLINDER:
          body = m_.geom_bodyid[object];
          break;
        default:  // a pulley, behind which it begins anew
          break;
      }
      if (before >= 0 && body >= 0) add_between(before, body, joints);
      before = body;
    }
    return joints;
  }

  [[nodiscard]] MjcfTie tie(std::string what, bool acts, const Joints& joints) const {
    MjcfTie tie{std::move(what), acts ? 1 : 0, 0, {}};
    for (const int i : joints) tie.joints.push_back(name_of(mjOBJ_JOINT, i, "joint"));
    return tie;
  }

  [[nodiscard]] MjcfTie constraint(int i) const {
    Joints joints;
    const int type = m_.eq_type[i];
    for (const int object : {m_.eq_obj1id[i], m_.eq_obj2id[i]}) {
      if (object < 0) continue;  // a constant
      if (type == mjEQ_JOINT) joints.insert(object);
      if (type == mjEQ_TENDON) joints.merge(joints_of_tendon(object));
    }
    if (type == mjEQ_CONNECT || type == mjEQ_WELD) {
      add_between(m_.eq_obj1id[i], m_.eq_obj2id[i], joints);
    }
    MjcfTie result = tie(
        "'" + name_of(mjOBJ_EQUALITY, i, "equality") + "' is an equality constraint", true, joints);
    result.is_coupling = type == mjEQ_JOINT && joints.size() == 2 ? 1 : 0;
    return result;
  }

  [[nodiscard]] MjcfTie tendon(int i) const {
    std::string has;
    if (m_.tendon_stiffness[i] > 0.0) has = " with a spring";
    if (m_.tendon_damping[i] > 0.0) has = " with damping";
    if (m_.tendon_frictionloss[i] > 0.0) has = " with dry friction";
    if (m_.tendon_limited[i] != 0) has = " with limits";
    return tie("'" + name_of(mjOBJ_TENDON, i, "tendon") + "' is a tendon" + has, !has.empty(),
               joints_of_tendon(i));
  }

  [[nodiscard]] MjcfBody body(int i) const {
    MjcfBody body;
    body.name = i == 0 ? "world" : name_of(mjOBJ_BODY, i, "body");
    body.parent = m_.body_parentid[i];
    body.X_PB = pose_of(m_.body_pos + 3 * i, m_.body_quat + 4 * i);
    body.mass = m_.body_mass[i];
    body.X_BC = pose_of(m_.body_ipos + 3 * i, m_.body_iquat + 4 * i);
    body.moments = Eigen::Map<const Vec3>(m_.body_inertia + 3 * i);
    return body;
  }

  [[nodiscard]] MjcfJoint joint(int i) const {
    MjcfJoint joint;
    joint.name = name_of(mjOBJ_JOINT, i, "joint");
    const int type = m_.jnt_type[i];
    if (type != mjJNT_HINGE && type != mjJNT_SLIDE) {
      refuse("joint '" + joint.name + "' is a " + (type == mjJNT_FREE ? "free" : "ball") + " joint",
             "hinge, slide");
    }
    const int dof = m_.jnt_dofadr[i];
    joint.is_slide = type == mjJNT_SLIDE ? 1 : 0;
    joint.p_BJ = Eigen::Map<const Vec3>(m_.jnt_pos + 3 * i);
    joint.axis_B = Eigen::Map<const Vec3>(m_.jnt_axis + 3 * i);
    joint.reference = m_.qpos0[m_.jnt_qposadr[i]];
    const bool limited = m_.jnt_limited[i] != 0;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    joint.lower = limited ? m_.jnt_range[2 * i] : -infinity;
    joint.upper = limited ? m_.jnt_range[2 * i + 1] : infinity;
    joint.damping = m_.dof_damping[dof];
    joint.friction = m_.dof_frictionloss[dof];
    joint.armature = m_.dof_armature[dof];
    joint.effort_limit = effort_limit(i);
    joint.stiffness = m_.jnt_stiffness[i];
    return joint;
  }

  /// The most that the actuators of a joint give; 0 if one of them has no limit or pulls it by a
  /// tendon, or there is none.
  [[nodiscard]] double effort_limit(int joint) const {
    double sum = 0.0;
    for (int i = 0; i < m_.nu; ++i) {
      const int kind = m_.actuator_trntype[i];
      if (kind == mjTRN_TENDON && joints_of_tendon(m_.actuator_trnid[2 * i]).contains(joint)) {
        return 0.0;
      }
      if ((kind != mjTRN_JOINT && kind != mjTRN_JOINTINPARENT) ||
          m_.actuator_trnid[2 * i] != joint) {
        continue;
      }
      const auto most = [i](const mjtNum* range) {
        return std::max(std::abs(range[2 * i]), std::abs(range[2 * i + 1]));
      };
      const double gear = std::abs(m_.actuator_gear[6 * i]);
      const bool is_motor = m_.actuator_gaintype[i] == mjGAIN_FIXED &&
                            m_.actuator_biastype[i] == mjBIAS_NONE &&
                            m_.actuator_dyntype[i] == mjDYN_NONE;
      if (m_.actuator_forcelimited[i] != 0) {
        sum += gear * most(m_.actuator_forcerange);
      } else if (is_motor && m_.actuator_ctrllimited[i] != 0) {
        sum += gear * std::abs(m_.actuator_gainprm[mjNGAIN * i]) * most(m_.actuator_ctrlrange);
      } else {
        return 0.0;
      }
    }
    return sum;
  }

  /// Without these bits a geom is only looked at.
  [[nodiscard]] bool touches(int geom) const {
    return m_.geom_contype[geom] != 0 || m_.geom_conaffinity[geom] != 0;
  }

  [[nodiscard]] RobotPart part(int i, const MjcfBody& body) const {
    RobotPart part;
    const char* const name = mj_id2name(&m_, mjOBJ_GEOM, i);
    part.name = name != nullptr ? name : body.name + "_" + std::to_string(body.parts.size());
    part.X_LP = pose_of(m_.geom_pos + 3 * i, m_.geom_quat + 4 * i);
    const mjtNum* const size = m_.geom_size + 3 * i;
    const std::string geom = "geom '" + part.name + "' of body '" + body.name + "' is ";
    switch (m_.geom_type[i]) {
      case mjGEOM_SPHERE:
        part.kind = PartKind::sphere;
        part.size = {size[0], 0.0, 0.0};
        break;
      case mjGEOM_CAPSULE:
        part.kind = PartKind::capsule;
        part.size = {size[0], size[1], 0.0};
        break;
      case mjGEOM_CYLINDER:
        part.kind = PartKind::cylinder;
        part.size = {size[0], size[1], 0.0};
        break;
      case mjGEOM_BOX:
        part.kind = PartKind::box;
        part.size = {size[0], size[1], size[2]};
        break;
      case mjGEOM_MESH:
        part.kind = PartKind::hull;
        part.points = hull_of(m_.geom_dataid[i]);
        break;
      case mjGEOM_ELLIPSOID:
        part.kind = PartKind::ellipsoid;
        part.size = {size[0], size[1], size[2]};
        break;
      case mjGEOM_PLANE:
        refuse(geom + "a plane, which has no end", "a box in its place");
      default:
        refuse(geom + "a height field", "sphere, capsule, cylinder, ellipsoid, box, mesh");
    }
    return part;
  }

  [[nodiscard]] std::vector<Vec3> hull_of(int mesh) const {
    std::vector<Vec3> points;
    const float* const vertices = m_.mesh_vert + 3 * m_.mesh_vertadr[mesh];
    for (int i = 0; i < m_.mesh_vertnum[mesh]; ++i) {
      points.emplace_back(vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]);
    }
    const std::vector<Facet> facets = hull_facets(points);
    if (!facets.empty()) points = hull_corners(points, facets);
    return points;
  }

  const mjModel& m_;
  const std::string& path_;
};

void put(const MjcfJoint& joint, detail::Parcel& parcel) {
  parcel.put_list(joint.name);
  parcel.put(joint.is_slide);
  parcel.put(joint.p_BJ);
  parcel.put(joint.axis_B);
  for (const double value : {joint.reference, joint.lower, joint.upper, joint.damping,
                             joint.friction, joint.armature, joint.effort_limit, joint.stiffness}) {
    parcel.put(value);
  }
}

MjcfJoint take_joint(detail::Unpacking& parcel) {
  MjcfJoint joint;
  joint.name = parcel.take_list<std::string>();
  joint.is_slide = parcel.take<int>();
  joint.p_BJ = parcel.take<Vec3>();
  joint.axis_B = parcel.take<Vec3>();
  for (double* value : {&joint.reference, &joint.lower, &joint.upper, &joint.damping,
                        &joint.friction, &joint.armature, &joint.effort_limit, &joint.stiffness}) {
    *value = parcel.take<double>();
  }
  return joint;
}

void put(const RobotPart& part, detail::Parcel& parcel) {
  parcel.put_list(part.name);
  parcel.put(part.kind);
  parcel.put(part.size);
  parcel.put(part.X_LP);
  parcel.put_list(part.points);
}

RobotPart take_part(detail::Unpacking& parcel) {
  RobotPart part;
  part.name = parcel.take_list<std::string>();
  part.kind = parcel.take<PartKind>();
  part.size = parcel.take<Vec3>();
  part.X_LP = parcel.take<Pose>();
  part.points = parcel.take_list<std::vector<Vec3>>();
  return part;
}

void put(const MjcfBody& body, detail::Parcel& parcel) {
  parcel.put_list(body.name);
  parcel.put(body.parent);
  parcel.put(body.X_PB);
  parcel.put(body.mass);
  parcel.put(body.X_BC);
  parcel.put(body.moments);
  parcel.put(body.joints.size());
  for (const MjcfJoint& joint : body.joints) put(joint, parcel);
  parcel.put(body.parts.size());
  for (const RobotPart& part : body.parts) put(part, parcel);
}

MjcfBody take_body(detail::Unpacking& parcel) {
  MjcfBody body;
  body.name = parcel.take_list<std::string>();
  body.parent = parcel.take<int>();
  body.X_PB = parcel.take<Pose>();
  body.mass = parcel.take<double>();
  body.X_BC = parcel.take<Pose>();
  body.moments = parcel.take<Vec3>();
  for (auto count = parcel.take<std::size_t>(); count > 0; --count) {
    body.joints.push_back(take_joint(parcel));
  }
  for (auto count = parcel.take<std::size_t>(); count > 0; --count) {
    body.parts.push_back(take_part(parcel));
  }
  return body;
}

std::string packed(const MjcfArm& arm) {
  detail::Parcel parcel;
  parcel.put_list(arm.name);
  parcel.put(arm.gravity_W);
  parcel.put(arm.bodies.size());
  for (const MjcfBody& body : arm.bodies) put(body, parcel);
  parcel.put(arm.sites.size());
  for (const MjcfSite& site : arm.sites) {
    parcel.put_list(site.name);
    parcel.put(site.body);
    parcel.put(site.X_BS);
  }
  parcel.put(arm.ties.size());
  for (const MjcfTie& tie : arm.ties) {
    parcel.put_list(tie.what);
    parcel.put(tie.acts);
    parcel.put(tie.is_coupling);
    parcel.put(tie.joints.size());
    for (const std::string& joint : tie.joints) parcel.put_list(joint);
  }
  return parcel.take();
}

MjcfArm unpacked(const std::string& bytes) {
  detail::Unpacking parcel(bytes);
  MjcfArm arm;
  arm.name = parcel.take_list<std::string>();
  arm.gravity_W = parcel.take<Vec3>();
  for (auto count = parcel.take<std::size_t>(); count > 0; --count) {
    arm.bodies.push_back(take_body(parcel));
    const MjcfBody& body = arm.bodies.back();
    const auto index = static_cast<int>(arm.bodies.size()) - 1;
    const bool follows = index == 0 ? body.parent == 0 : body.parent >= 0 && body.parent < index;
    if (!follows) throw SetupError("cannot be read: its reader was disturbed");
  }
  for (auto count = parcel.take<std::size_t>(); count > 0; --count) {
    MjcfSite& site = arm.sites.emplace_back();
    site.name = parcel.take_list<std::string>();
    site.body = parcel.take<int>();
    site.X_BS = parcel.take<Pose>();
    const bool stands = site.body >= 0 && static_cast<std::size_t>(site.body) < arm.bodies.size();
    if (!stands) throw SetupError("cannot be read: its reader was disturbed");
  }
  for (auto count = parcel.take<std::size_t>(); count > 0; --count) {
    MjcfTie& tie = arm.ties.emplace_back();
    tie.what = parcel.take_list<std::string>();
    tie.acts = parcel.take<int>();
    tie.is_coupling = parcel.take<int>();
    for (auto joints = parcel.take<std::size_t>(); joints > 0; --joints) {
      tie.joints.push_back(parcel.take_list<std::string>());
    }
  }
  return arm;
}

/// What the child process does: `gather` chooses.
std::string mjcf_in(const std::string& path, MjcfArm (*gather)(const MjcfGathering&)) {
  mju_user_error = [](const char* message) { throw std::runtime_error(message); };
  mju_user_warning = [](const char*) {};
  if (mj_version() != mjVERSION_HEADER) {  // as where a program has loaded another one before
    throw SetupError("the MuJoCo library in use is of version " + std::to_string(mj_version()) +
                         "; allowed: " + std::to_string(mjVERSION_HEADER) + ", as built against",
                     path);
  }
  char message[1000] = "";
  const MjcfModel model(mj_loadXML(path.c_str(), nullptr, message, sizeof message));
  if (!model) fail_as(message, path);
  return packed(gather(MjcfGathering(*model, path)));
}

/// What `gather` finds in the file at `path`, by a child process.
MjcfArm gathered(const std::string& path, MjcfArm (*gather)(const MjcfGathering&)) {
  detail::require_root(path, "mujoco");  // MuJoCo would take a URDF file too, and change it
  constexpr detail::ChildLimits limits{.seconds = 10, .memory = std::size_t{1} << 30};
  std::string bytes;
  try {
    bytes = detail::result_of_child([&] { return mjcf_in(path, gather); }, limits);
  } catch (const SetupError& error) {
    if (!error.file().empty()) throw;
    throw SetupError("the file, with all that it includes, " + std::string(error.what()), path);
  }
  return unpacked(bytes);
}

/// Makes a robot of what was read.
class MjcfBuilder {
 public:
  MjcfBuilder(const MjcfArm& arm, const MjcfOptions& options, const std::string& path)
      : arm_(arm), options_(options), path_(path), moves_with_(arm.bodies.size(), -1) {
    require_holds();
    choose_end();
    robot_.arm.name = arm.name;
    robot_.arm.gravity_W = arm.gravity_W;
    X_LB_.push_back(Pose::Identity());
    for (std::size_t i = 0; i < arm.bodies.size(); ++i) add(i);
    if (robot_.arm.links.empty()) fail("no joint moves; allowed: 1 or more");
    for (const MjcfTie& tie : arm.ties) require_beside(tie);
    robot_.arm.X_LT = X_LB_[end_] * X_BT_;
    robot_.end = arm.bodies[end_].name;
  }

  [[nodiscard]] Robot take() { return std::move(robot_); }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw SetupError(what, path_); }

  [[nodiscard]] const Hold* hold_of(const MjcfJoint& joint) const {
    const auto found = std::ranges::find(options_.hold, joint.name, &Hold::joint);
    return found == options_.hold.end() ? nullptr : &*found;
  }

  /// Whether it is not to move, or coupled with one that is not to.
  [[nodiscard]] bool is_held(const MjcfJoint& joint) const {
    if (hold_of(joint) != nullptr) return true;
    return std::ranges::any_of(arm_.ties, [&](const MjcfTie& tie) {
      return tie.is_coupling != 0 && std::ranges::count(tie.joints, joint.name) > 0 &&
             std::ranges::any_of(options_.hold, [&](const Hold& hold) {
               return std::ranges::count(tie.joints, hold.joint) > 0;
             });
    });
  }

  void require_holds() const {
    for (const Hold& hold : options_.hold) {
      const bool known = std::ranges::any_of(arm_.bodies, [&](const MjcfBody& body) {
        return std::ranges::count(body.joints, hold.joint, &MjcfJoint::name) > 0;
      });
      if (!known) fail("no joint '" + hold.joint + "' to hold");
      if (std::ranges::count(options_.hold, hold.joint, &Hold::joint) > 1) {
        fail("joint '" + hold.joint + "' is to be held twice; allowed: once");
      }
    }
  }

  /// Whether `ancestor` is `body`, or between it and the world.
  [[nodiscard]] bool carries(std::size_t ancestor, std::size_t body) const {
    while (body > ancestor) body = static_cast<std::size_t>(arm_.bodies[body].parent);
    return body == ancestor;
  }

  void choose_end() {
    if (options_.tip.empty()) return choose_last();
    const auto body = std::ranges::find(arm_.bodies, options_.tip, &MjcfBody::name);
    const auto site = std::ranges::find(arm_.sites, options_.tip, &MjcfSite::name);
    if (body != arm_.bodies.end()) {
      end_ = static_cast<std::size_t>(body - arm_.bodies.begin());
    } else if (site != arm_.sites.end()) {
      end_ = static_cast<std::size_t>(site->body);
      X_BT_ = site->X_BS;
    } else {
      fail("no body or site '" + options_.tip + "' to be the tip");
    }
    robot_.tool = options_.tip;
    robot_.end_reason = robot_.tool_reason = "the chosen tip";
  }

  [[nodiscard]] bool moves(const MjcfBody& body) const {
    return std::ranges::any_of(body.joints,
                               [&](const MjcfJoint& joint) { return !is_held(joint); });
  }

  /// The end of the line of joints, or where fingers branch off it.
  void choose_last() {
    std::vector<std::size_t> moving;
    for (std::size_t i = 0; i < arm_.bodies.size(); ++i) {
      if (moves(arm_.bodies[i])) moving.push_back(i);
    }
    // Those of the line carry all that move and come later.
    const auto off = std::ranges::find_if(moving, [&](std::size_t i) {
      return std::ranges::any_of(
          moving, [&](std::size_t other) { return other > i && !carries(i, other); });
    });
    const std::vector<std::size_t> line(moving.begin(), off), fingers(off, moving.end());
    if (!line.empty()) end_ = line.back();
    robot_.end_reason = robot_.tool_reason = "the last body that moves";
    if (!fingers.empty()) {
      if (!are_fingers(fingers, line.size())) refuse_branches(fingers);
      end_ = fingers.front();
      const auto carries_all = [&] {
        return std::ranges::all_of(fingers, [&](std::size_t i) { return carries(end_, i); });
      };
      while (!carries_all()) end_ = static_cast<std::size_t>(arm_.bodies[end_].parent);
      robot_.end_reason = robot_.tool_reason = "the body that carries the fingers";
    }
    robot_.tool = arm_.bodies[end_].name;
  }

  /// Whether each joint is tied to another one, and no branch has as many bodies as the line.
  [[nodiscard]] bool are_fingers(const std::vector<std::size_t>& bodies, std::size_t line) const {
    return std::ranges::all_of(bodies, [&](std::size_t body) {
      const auto length = std::ranges::count_if(
          bodies, [&](std::size_t other) { return other <= body && carries(other, body); });
      return static_cast<std::size_t>(length) < line &&
             std::ranges::all_of(arm_.bodies[body].joints, [&](const MjcfJoint& joint) {
               return is_held(joint) || is_tied(joint);
             });
    });
  }

  [[nodiscard]] bool is_tied(const MjcfJoint& joint) const {
    return std::ranges::any_of(arm_.ties, [&](const MjcfTie& tie) {
      return tie.joints.size() > 1 && std::ranges::count(tie.joints, joint.name) > 0;
    });
  }

  [[noreturn]] void refuse_branches(const std::vector<std::size_t>& bodies) const {
    const std::size_t first = bodies.front();
    const std::size_t second =
        *std::ranges::find_if(bodies, [&](std::size_t i) { return !carries(first, i); });
    fail(
        "bodies '" + arm_.bodies[first].name + "' and '" + arm_.bodies[second].name +
        "' move on branches of their own; allowed: one line of joints, which may end in fingers "
        "that a constraint or tendon ties to one another, or a chosen tip (`tip_link` of a scene)");
  }

  [[nodiscard]] bool is_of_arm(const std::string& joint) const {
    return std::ranges::count(robot_.arm.links, joint, &ArmLink::joint_name) > 0;
  }

  /// @throws SetupError if `tie` acts on a joint of the arm. A joint that is coupled with the last
  ///   one alone follows that: it is the other finger where one is the arm.
  void require_beside(const MjcfTie& tie) const {
    const auto found =
        std::ranges::find_if(tie.joints, [&](const auto& joint) { return is_of_arm(joint); });
    if (tie.acts == 0 || found == tie.joints.end()) return;
    const auto in_arm =
        std::ranges::count_if(tie.joints, [&](const auto& joint) { return is_of_arm(joint); });
    if (tie.is_coupling != 0 && in_arm == 1 && *found == robot_.arm.links.back().joint_name) return;
    fail(tie.what + ", which acts on joint '" + *found +
         "' of the arm; allowed: one of held joints alone");
  }

  void add(std::size_t index) {
    const MjcfBody& body = arm_.bodies[index];
    const auto parent = static_cast<std::size_t>(body.parent);
    int link = index == 0 ? -1 : moves_with_[parent];
    Pose X_LB = index == 0 ? Pose::Identity() : Pose(X_LB_[parent] * body.X_PB);
    const bool in_arm = carries(index, end_);
    std::size_t left = body.joints.size();
    for (const MjcfJoint& joint : body.joints) {
      --left;
      if (in_arm && !is_held(joint)) {
        if (joint.stiffness > 0.0) {
          fail("joint '" + joint.name + "' has a spring, stiffness " + to_text(joint.stiffness) +
               "; allowed: 0, or a joint that is held");
        }
        ArmLink& moved = robot_.arm.links.emplace_back(moving_link(joint, X_LB));
        moved.name = left == 0 ? body.name : body.name + "/" + joint.name;
        link = static_cast<int>(robot_.arm.links.size()) - 1;
        X_LB = Eigen::Translation3d(-joint.p_BJ) * Pose::Identity();
      } else {
        const HeldJoint held = held_joint(joint);
        robot_.held.push_back(held);
        X_LB = X_LB * displacement(joint, held.position - joint.reference);
      }
    }
    if (link >= 0) {
      ArmLink& carrier = robot_.arm.links[static_cast<std::size_t>(link)];
      detail::add_body(body.mass, body.moments.asDiagonal(), X_LB * body.X_BC, carrier);
    }
    for (RobotPart part : body.parts) {
      part.in_link = body.name;
      part.link = link;
      part.X_LP = X_LB * part.X_LP;
      robot_.parts.push_back(std::move(part));
    }
    robot_.links.push_back({body.name, body.mass, link, X_LB});
    const auto is_child = [index](const MjcfBody& other) {
      return static_cast<std::size_t>(other.parent) == index;
    };
    const auto behind = arm_.bodies.begin() + static_cast<std::ptrdiff_t>(index) + 1;
    if (link >= 0 && std::none_of(behind, arm_.bodies.end(), is_child)) {
      robot_.tips.push_back(body.name);
    }
    moves_with_[index] = link;
    if (index > 0) X_LB_.push_back(X_LB);
  }

  /// Its frame is on the axis of the joint, with the axes that the body has at zero.
  [[nodiscard]] static ArmLink moving_link(const MjcfJoint& joint, const Pose& X_PB) {
    ArmLink link;
    link.joint_name = joint.name;
    link.type = joint.is_slide != 0 ? JointType::prismatic : JointType::revolute;
    link.X_PJ = X_PB * displacement(joint, -joint.reference) * Eigen::Translation3d(joint.p_BJ);
    link.axis_J = joint.axis_B;
    link.lower = joint.lower;
    link.upper = joint.upper;
    link.effort_limit = joint.effort_limit;
    link.viscous_friction = joint.damping;
    link.coulomb_friction = joint.friction;
    link.rotor_inertia = joint.armature;
    return link;
  }

  /// How a body moves when its joint moves by `change` [rad] or [m], in the frame of the body.
  [[nodiscard]] static Pose displacement(const MjcfJoint& joint, double change) {
    if (joint.is_slide != 0) return Pose(Eigen::Translation3d(change * joint.axis_B));
    return Eigen::Translation3d(joint.p_BJ) * Eigen::AngleAxisd(change, joint.axis_B) *
           Eigen::Translation3d(-joint.p_BJ);
  }

  [[nodiscard]] HeldJoint held_joint(const MjcfJoint& joint) const {
    const Hold* const hold = hold_of(joint);
    const bool slides = joint.is_slide != 0;
    HeldJoint held{joint.name, slides ? "prismatic" : "revolute",
                   std::clamp(0.0, joint.lower, joint.upper),
                   hold != nullptr  ? "as chosen"
                   : is_held(joint) ? "coupled with a held joint"
                                    : "beside the chain"};
    if (hold == nullptr || !hold->position) return held;
    held.position = *hold->position;
    const std::string at = "joint '" + joint.name + "' is to be held at " + to_text(held.position);
    if (hold->type && (*hold->type == JointType::prismatic) != slides) {
      fail(at +
           "; allowed: " + (slides ? "a length, since it slides" : "an angle, since it turns"));
    }
    if (!(held.position >= joint.lower && held.position <= joint.upper)) {
      fail(at + "; allowed: " + to_text(joint.lower) + " to " + to_text(joint.upper) +
           (slides ? " m" : " rad"));
    }
    return held;
  }

  const MjcfArm& arm_;
  const MjcfOptions& options_;
  const std::string& path_;
  std::size_t end_ = 0;           // the last body of the arm
  Pose X_BT_ = Pose::Identity();  // tool in that body
  std::vector<int> moves_with_;   // link of each body
  std::vector<Pose> X_LB_;        // pose of each body in that link
  Robot robot_;
};

}  // namespace

Robot load_mjcf_arm(const std::string& path, const MjcfOptions& options) {
  const MjcfArm arm = gathered(path, [](const MjcfGathering& from) { return from.arm(); });
  return MjcfBuilder(arm, options, path).take();
}

std::vector<RobotPart> load_mjcf_parts(const std::string& path) {
  const MjcfArm found = gathered(path, [](const MjcfGathering& from) {
    MjcfArm all;
    all.bodies = from.bodies(0);
    return all;
  });
  std::vector<RobotPart> parts;
  std::vector<Pose> X_WB;
  for (const MjcfBody& body : found.bodies) {
    X_WB.push_back(X_WB.empty() ? Pose::Identity()
                                : X_WB[static_cast<std::size_t>(body.parent)] * body.X_PB);
    for (RobotPart part : body.parts) {
      part.in_link = body.name;
      part.X_LP = X_WB.back() * part.X_LP;
      parts.push_back(std::move(part));
    }
  }
  return parts;
}

bool reads_mjcf() noexcept {
  return true;
}
#else
namespace {

[[noreturn]] void refuse(const std::string& path) {
  throw SetupError(
      "MJCF files cannot be read, repel is built without MuJoCo; to have it: apt-get install "
      "libmujoco-dev, and build again",
      path);
}

}  // namespace

Robot load_mjcf_arm(const std::string& path, const MjcfOptions&) {
  refuse(path);
}

std::vector<RobotPart> load_mjcf_parts(const std::string& path) {
  refuse(path);
}

bool reads_mjcf() noexcept {
  return false;
}
#endif

}  // namespace repel
