// SPDX-License-Identifier: BSD-3-Clause
#include <repel/robots/sdf.hpp>

#include <filesystem>

#include <repel/base/input_limits.hpp>
#include <repel/base/setup_error.hpp>

#ifdef REPEL_HAS_SDFORMAT
#include <tinyxml2.h>
#include <sdf/sdf.hh>

#include "mesh.hpp"
#include "urdf_document.hpp"
#endif

namespace repel {

#ifdef REPEL_HAS_SDFORMAT
namespace {

Pose from_sdf(const ignition::math::Pose3d& X) {
  Pose result = Pose::Identity();
  result.translation() = Vec3(X.Pos().X(), X.Pos().Y(), X.Pos().Z());
  const ignition::math::Quaterniond& q = X.Rot();
  result.linear() = Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).normalized().toRotationMatrix();
  return result;
}

[[noreturn]] void fail_with(const sdf::Error& error, const std::string& path) {
  throw SetupError(error.Message(), error.FilePath().value_or(path),
                   error.LineNumber().value_or(0));
}

/// The pose of a model, link or collision in what it is in.
template <class Element>
Pose pose_of_element(const Element& element, const std::string& path) {
  ignition::math::Pose3d X;
  const sdf::Errors errors = element.SemanticPose().Resolve(X, "");
  if (!errors.empty()) fail_with(errors[0], path);
  Pose result = from_sdf(X);
  if (!is_finite(result)) {
    const sdf::ElementPtr at = element.Element();
    throw SetupError("the pose of '" + element.Name() + "' is not finite; allowed: numbers", path,
                     at ? at->LineNumber().value_or(0) : 0);
  }
  return result;
}

/// The folder or file behind model://NAME..., package://NAME... or a path; empty: not found.
std::string found_uri(const std::string& uri, const std::filesystem::path& file,
                      const std::vector<std::string>& folders) {
  namespace fs = std::filesystem;
  std::error_code error;
  const auto colon = uri.find("://");
  const fs::path rest = colon == std::string::npos ? uri : uri.substr(colon + 3);
  for (const std::string& folder : folders) {
    if (fs::exists(fs::path(folder) / rest, error)) return (fs::path(folder) / rest).string();
  }
  const fs::path start = fs::absolute(file, error).lexically_normal().parent_path();
  for (fs::path folder = start;; folder = folder.parent_path()) {
    if (fs::exists(folder / rest, error)) return (folder / rest).string();
    if (folder == folder.parent_path()) return {};
  }
}

/// Converts the collision elements of models.
class SdfReader {
 public:
  SdfReader(const std::string& path, const UrdfOptions& options)
      : path_(path),
        packages_(options.package_paths),
        meshes_({path, options.package_paths}, options.convex_parts) {}

  /// Appends the parts of `model` and of the models in it.
  /// @param scope that its name follows
  // NOLINTNEXTLINE(misc-no-recursion): models nest no deeper than the file
  void add(const sdf::Model& model, const std::string& scope, const Pose& X_WO) {
    const std::string name = scope + model.Name() + "::";
    const Pose X_WM = X_WO * pose_of_element(model, path_);
    for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
      const sdf::Link& link = *model.LinkByIndex(i);
      const Pose X_WL = X_WM * pose_of_element(link, path_);
      for (std::uint64_t k = 0; k < link.CollisionCount(); ++k) {
        add(*link.CollisionByIndex(k), name + link.Name(), X_WL);
      }
    }
    for (std::uint64_t i = 0; i < model.ModelCount(); ++i) add(*model.ModelByIndex(i), name, X_WM);
  }

  [[nodiscard]] std::vector<RobotPart> take() { return std::move(parts_); }

 private:
  void add(const sdf::Collision& collision, const std::string& link, const Pose& X_WL) {
    if (++collisions_ > input_limits.entries) {
      fail_at(collision, "more than " + std::to_string(input_limits.entries) + " collisions");
    }
    const Pose X_WP = X_WL * pose_of_element(collision, path_);
    try {
      for (RobotPart& part : parts_of(*collision.Geom())) {
        part.name = collision.Name() + part.name;
        part.in_link = link;
        part.X_LP = X_WP;
        parts_.push_back(std::move(part));
      }
    } catch (const SetupError& error) {
      fail_at(collision, error.what());
    }
  }

  [[noreturn]] void fail_at(const sdf::Collision& collision, const std::string& what) const {
    const sdf::ElementPtr at = collision.Element();
    const std::string file = at && !at->FilePath().empty() ? at->FilePath() : path_;
    throw SetupError("collision '" + collision.Name() + "': " + what, file,
                     at ? at->LineNumber().value_or(0) : 0);
  }

  /// With the ends of their names.
  std::vector<RobotPart> parts_of(const sdf::Geometry& geometry) {
    RobotPart part;
    switch (geometry.Type()) {
      case sdf::GeometryType::BOX: {
        const auto size = geometry.BoxShape()->Size();
        part.kind = PartKind::box;
        part.size = 0.5 * Vec3(size.X(), size.Y(), size.Z());
        return {part};
      }
      case sdf::GeometryType::SPHERE:
        part.kind = PartKind::sphere;
        part.size = {geometry.SphereShape()->Radius(), 0.0, 0.0};
        return {part};
      case sdf::GeometryType::CYLINDER:
        part.kind = PartKind::cylinder;
        part.size = {geometry.CylinderShape()->Radius(), 0.5 * geometry.CylinderShape()->Length(),
                     0.0};
        return {part};
      case sdf::GeometryType::CAPSULE:
        part.kind = PartKind::capsule;
        part.size = {geometry.CapsuleShape()->Radius(), 0.5 * geometry.CapsuleShape()->Length(),
                     0.0};
        return {part};
      case sdf::GeometryType::MESH:
        return parts_of(*geometry.MeshShape());
      case sdf::GeometryType::PLANE:
        throw SetupError("a plane has no end; allowed: a box in its place");
      default:
        throw SetupError("allowed: a box, sphere, cylinder, capsule or mesh");
    }
  }

  std::vector<RobotPart> parts_of(const sdf::Mesh& mesh) {
    if (!mesh.Submesh().empty()) {
      throw SetupError("a submesh, '" + mesh.Submesh() + "'; allowed: the whole mesh of a file");
    }
    const Vec3 scale(mesh.Scale().X(), mesh.Scale().Y(), mesh.Scale().Z());
    // Relative to the file that names it, which may be an included one.
    const std::string file = mesh.FilePath().empty() ? path_ : mesh.FilePath();
    const auto found = std::filesystem::absolute(detail::find_mesh(mesh.Uri(), {file, packages_}));
    const detail::MeshParts& read = meshes_.parts("file://" + found.string(), scale);
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
  }

  std::string path_;
  std::vector<std::string> packages_;
  detail::MeshReader meshes_;
  std::vector<RobotPart> parts_;
  std::size_t collisions_ = 0;
};

/// libsdformat would take a URDF file too, and change it.
void require_sdf(const std::string& path) {
  tinyxml2::XMLDocument document;
  const std::string text = detail::text_of_description(path);
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw SetupError(document.ErrorStr(), path, document.ErrorLineNum());
  }
  const tinyxml2::XMLElement& root = *document.RootElement();
  if (std::string_view(root.Name()) == "sdf") return;
  throw SetupError("the file begins with <" + std::string(root.Name()) + ">; allowed: <sdf>", path,
                   root.GetLineNum());
}

}  // namespace

std::vector<RobotPart> load_sdf_parts(const std::string& path, const UrdfOptions& options) {
  require_sdf(path);
  sdf::Console::Instance()->SetQuiet(true);  // what it would print is in the errors it returns
  sdf::ParserConfig config;
  config.SetFindCallback(
      [&](const std::string& uri) { return found_uri(uri, path, options.package_paths); });
  sdf::Root root;
  const sdf::Errors errors = root.Load(path, config);
  if (!errors.empty()) fail_with(errors[0], path);
  if (root.WorldCount() > 1) {
    throw SetupError("the file has " + std::to_string(root.WorldCount()) + " worlds; allowed: 1",
                     path);
  }
  SdfReader reader(path, options);
  if (root.Model() != nullptr) reader.add(*root.Model(), "", Pose::Identity());
  if (root.WorldCount() == 1) {
    const sdf::World& world = *root.WorldByIndex(0);
    for (std::uint64_t i = 0; i < world.ModelCount(); ++i) {
      reader.add(*world.ModelByIndex(i), "", Pose::Identity());
    }
  }
  return reader.take();
}

bool reads_sdf() noexcept {
  return true;
}
#else
std::vector<RobotPart> load_sdf_parts(const std::string& path, const UrdfOptions&) {
  throw SetupError(
      "SDF files cannot be read, repel is built without libsdformat; to have it: apt-get install "
      "libsdformat-dev, and build again",
      path);
}

bool reads_sdf() noexcept {
  return false;
}
#endif

}  // namespace repel
