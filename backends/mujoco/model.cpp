// SPDX-License-Identifier: BSD-3-Clause
#include "model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/geometry/facets.hpp>

#include "errors.hpp"

namespace repel::mujoco::detail {
namespace {

constexpr int most_points = 100;  // of contact, at a time
constexpr int rows_per_point = 3;

/// ` name="values"`.
std::string attribute(const char* name, std::span<const double> values) {
  std::string text = " " + std::string(name) + "=\"";
  for (const double value : values) text += to_text(value) + ' ';
  text.back() = '"';
  return text;
}
std::string attribute(const char* name, std::initializer_list<double> values) {
  return attribute(name, std::span(values.begin(), values.size()));
}
std::string attribute(const char* name, const Vec3& values) {
  return attribute(name, {values.x(), values.y(), values.z()});
}

std::string placed(const Vec3& p, const Mat3& R) {
  const Eigen::Quaterniond q(R);
  return attribute("pos", p) + attribute("quat", {q.w(), q.x(), q.y(), q.z()});
}
std::string placed(const Pose& X) {
  return placed(X.translation(), X.linear());
}

[[noreturn]] void refuse(const ContactPart& part) {
  throw SetupError("part '" + part.name +
                   "' cannot be touched in MuJoCo; allowed: boxes, spheres, capsules, cylinders, "
                   "ellipsoids and hulls that have a thickness");
}

std::string form_of(const ContactPart& part, const std::string& mesh) {
  const Level& level = part.shape.level(0);
  const Vec3 size = core_extents(part.shape);
  switch (level.core.kind()) {  // a kind that is missing here does not compile
    case Convex::Kind::polytope:
      return " type=\"mesh\" mesh=\"" + mesh + '"';
    case Convex::Kind::box:
      if (level.depth > 0.0 && size.z() > 0.0) {
        return " type=\"capsule\"" + attribute("size", {level.depth, size.z()});
      }
      if (level.depth > 0.0) return " type=\"sphere\"" + attribute("size", {level.depth});
      if (size.minCoeff() > 0.0) return " type=\"box\"" + attribute("size", size);
      break;
    case Convex::Kind::cylinder:
      if (size.minCoeff() > 0.0) {
        return " type=\"cylinder\"" + attribute("size", {size.x(), size.z()});
      }
      break;
    case Convex::Kind::ellipsoid:
      return " type=\"ellipsoid\"" + attribute("size", size);
    case Convex::Kind::cone:
      break;
  }
  refuse(part);
}

constexpr char part_prefix[] = "part_";

std::string name_of(std::size_t part) {
  return part_prefix + std::to_string(part);
}

std::string geoms_on(int link, std::span<const ContactPart> parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].link != link) continue;
    text += "<geom" + form_of(parts[i], name_of(i)) + placed(parts[i].X_LP) +
            (link < 0 ? " contype=\"0\" conaffinity=\"1\"/>\n"
                      : " contype=\"1\" conaffinity=\"0\"/>\n");
  }
  return text;
}

std::vector<Vec3> corners_of(const Convex& polytope) {
  std::vector<Vec3> corners;
  for (int corner = 0; corner < polytope.vertex_count(); ++corner) {
    const Vec<double> p = polytope.place(static_cast<std::uint32_t>(corner));
    corners.emplace_back(p.x(), p.y(), p.z());
  }
  return corners;
}

std::string meshes_of(std::span<const ContactPart> parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Convex& core = parts[i].shape.level(0).core;
    if (core.kind() != Convex::Kind::polytope) continue;
    const std::vector<Vec3> corners = corners_of(core);
    if (hull_facets(corners).empty()) refuse(parts[i]);  // qhull would print pages about it
    const std::span numbers(corners.front().data(), 3 * corners.size());
    text += "<mesh name=\"" + name_of(i) + '"' + attribute("vertex", numbers) + "/>\n";
  }
  return text;
}

/// Frame of the principal axes of inertia of a link, and the moments about them [kg m^2].
std::pair<Mat3, Vec3> principal_inertia(const ArmLink& link) {
  const Eigen::SelfAdjointEigenSolver<Mat3> inertia(link.I_C_L);
  Mat3 R_LB = inertia.eigenvectors();
  if (R_LB.determinant() < 0.0) R_LB.col(0) *= -1.0;
  return {R_LB, inertia.eigenvalues().cwiseMax(0.0)};
}

// Masses and inertias are written into the compiled model. The compiler refuses zeros; the engine
// takes them where the joint moves something else.
std::string mjcf_of(const ArmModel& model, const SimulationOptions& options,
                    std::span<const ContactPart> parts) {
  const auto points = parts.empty() ? 0 : most_points;
  const auto rows = static_cast<int>(model.links.size()) + rows_per_point * points;
  std::string text =
      "<mujoco>\n<compiler angle=\"radian\" inertiafromgeom=\"false\"/>\n"
      "<option solver=\"Newton\" cone=\"elliptic\" jacobian=\"dense\"" +
      attribute("gravity", model.gravity_W) + "/>\n<size njmax=\"" + std::to_string(rows) +
      "\" nconmax=\"" + std::to_string(points) + "\"/>\n<default><geom condim=\"3\"" +
      attribute("friction", {options.contact_friction, 0.0, 0.0}) + "/></default>\n<asset>\n" +
      meshes_of(parts) + "</asset>\n<worldbody>\n" + geoms_on(-1, parts);
  Pose X_PJ = model.X_WB;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const ArmLink& link = model.links[i];
    X_PJ = X_PJ * link.X_PJ;
    text += "<body" + placed(X_PJ) + "><inertial mass=\"1\" diaginertia=\"1 1 1\"" +
            placed(link.p_LC, principal_inertia(link).first) + "/><joint type=\"" +
            (link.type == JointType::revolute ? "hinge" : "slide") + '"' +
            attribute("axis", link.axis_J) + "/>\n" + geoms_on(static_cast<int>(i), parts);
    X_PJ = Pose::Identity();
  }
  for (std::size_t i = 0; i < model.links.size(); ++i) text += "</body>";
  return text + "</worldbody>\n</mujoco>\n";
}

/// The part that MuJoCo's message names, if it names one.
const ContactPart* part_in(const std::string& message, std::span<const ContactPart> parts) {
  const auto at = message.find(part_prefix);
  if (at == std::string::npos) return nullptr;
  const auto index = std::stoul(message.substr(at + std::strlen(part_prefix)));
  return index < parts.size() ? &parts[index] : nullptr;
}

Model loaded(const std::string& mjcf, std::span<const ContactPart> parts) {
  struct Files {
    Files() { mj_defaultVFS(&files); }
    ~Files() { mj_deleteVFS(&files); }
    Files(const Files&) = delete;
    Files& operator=(const Files&) = delete;
    mjVFS files;
  };
  if (mj_version() != mjVERSION_HEADER) {  // as where a program has loaded another one before
    throw SetupError("the MuJoCo library in use is of version " + std::to_string(mj_version()) +
                     "; allowed: " + std::to_string(mjVERSION_HEADER) + ", as built against");
  }
  constexpr char file[] = "arm.xml";
  const auto folder = std::make_unique<Files>();  // two megabytes
  if (mj_makeEmptyFileVFS(&folder->files, file, static_cast<int>(mjcf.size())) != 0) {
    throw SetupError("MuJoCo takes no model of " + std::to_string(mjcf.size()) + " bytes");
  }
  std::memcpy(folder->files.filedata[0], mjcf.data(), mjcf.size());
  char message[1000] = "";
  Model model(mj_loadXML(file, &folder->files, message, sizeof message));
  if (model) return model;
  const ContactPart* const part = part_in(message, parts);
  if (part != nullptr) refuse(*part);
  throw SetupError("MuJoCo refuses the model: " + std::string(message));
}

}  // namespace

Model compiled(const ArmModel& model, const SimulationOptions& options,
               std::span<const ContactPart> parts) {
  const ErrorsThrown scope;
  Model result = loaded(mjcf_of(model, options, parts), parts);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const std::size_t body = i + 1;
    result->body_mass[body] = model.links[i].mass;
    const Vec3 moments = principal_inertia(model.links[i]).second;
    std::copy_n(moments.data(), 3, result->body_inertia + 3 * body);
    // The shortcuts for single bodies leave out an inertia that is set later.
    result->body_simple[body] = 0;
    result->dof_simplenum[i] = 0;
  }
  const Data data(mj_makeData(result.get()));
  mj_setConst(result.get(), data.get());
  return result;
}

}  // namespace repel::mujoco::detail
