// SPDX-License-Identifier: BSD-3-Clause
#include <repel/robots/sdf.hpp>

#include <filesystem>

#include <repel/base/setup_error.hpp>
#include <repel/common/input_limits.hpp>

#ifdef REPEL_HAS_SDFORMAT
#include <tinyxml2.h>
#include <sdf/sdf.hh>

#include "child_process.hpp"
#include "mesh.hpp"
#include "parcel.hpp"
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
  // A model is a folder or a file; a pipe or a device may have no end.
  const auto is_there = [&](const fs::path& at) {
    return fs::is_directory(at, error) || fs::is_regular_file(at, error);
  };
  for (const std::string& folder : folders) {
    if (is_there(fs::path(folder) / rest)) return (fs::path(folder) / rest).string();
  }
  const fs::path start = fs::absolute(file, error).lexically_normal().parent_path();
  for (fs::path folder = start;; folder = folder.parent_path()) {
    if (is_there(folder / rest)) return (folder / rest).string();
    if (folder == folder.parent_path()) return {};
  }
}

/// A collision element, as the child process sends it.
struct Collision {
  enum class Kind : int { box, sphere, cylinder, capsule, ellipsoid, mesh, plane, other };

  std::string name, in_link;
  Pose X_WP = Pose::Identity();
  Kind kind = Kind::other;
  Vec3 size = Vec3::Zero();             ///< [m] as RobotPart::size; of a mesh its scale
  std::string mesh, submesh, named_in;  ///< uri, and the file that names it
  std::string file;                     ///< with the element
  int line = 0;
};

void put(const Collision& collision, detail::Parcel& parcel) {
  for (const std::string* text : {&collision.name, &collision.in_link, &collision.mesh,
                                  &collision.submesh, &collision.named_in, &collision.file}) {
    parcel.put_list(*text);
  }
  parcel.put(collision.X_WP);
  parcel.put(collision.kind);
  parcel.put(collision.size);
  parcel.put(collision.line);
}

Collision take_collision(detail::Unpacking& parcel) {
  Collision collision;
  for (std::string* text : {&collision.name, &collision.in_link, &collision.mesh,
                            &collision.submesh, &collision.named_in, &collision.file}) {
    *text = parcel.take_list<std::string>();
  }
  collision.X_WP = parcel.take<Pose>();
  collision.kind = parcel.take<Collision::Kind>();
  collision.size = parcel.take<Vec3>();
  collision.line = parcel.take<int>();
  return collision;
}

/// Gathers the collision elements of models.
class Gathering {
 public:
  explicit Gathering(const std::string& path) : path_(path) {}

  /// Adds those of `model` and of the models in it.
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

  [[nodiscard]] const std::vector<Collision>& all() const { return all_; }

 private:
  void add(const sdf::Collision& element, const std::string& link, const Pose& X_WL) {
    Collision& collision = all_.emplace_back();
    collision.name = element.Name();
    collision.in_link = link;
    collision.X_WP = X_WL * pose_of_element(element, path_);
    const sdf::ElementPtr at = element.Element();
    collision.file = at && !at->FilePath().empty() ? at->FilePath() : path_;
    collision.line = at ? at->LineNumber().value_or(0) : 0;
    describe(*element.Geom(), collision);
    if (all_.size() > input_limits.entries) {
      throw SetupError("more than " + std::to_string(input_limits.entries) + " collisions",
                       collision.file, collision.line);
    }
  }

  void describe(const sdf::Geometry& geometry, Collision& collision) const {
    using Kind = Collision::Kind;
    const auto is = [&](Kind kind, double x, double y, double z) {
      collision.kind = kind;
      collision.size = {x, y, z};
    };
    switch (geometry.Type()) {
      case sdf::GeometryType::BOX: {
        const auto size = geometry.BoxShape()->Size();
        return is(Kind::box, 0.5 * size.X(), 0.5 * size.Y(), 0.5 * size.Z());
      }
      case sdf::GeometryType::SPHERE:
        return is(Kind::sphere, geometry.SphereShape()->Radius(), 0.0, 0.0);
      case sdf::GeometryType::CYLINDER:
        return is(Kind::cylinder, geometry.CylinderShape()->Radius(),
                  0.5 * geometry.CylinderShape()->Length(), 0.0);
      case sdf::GeometryType::CAPSULE:
        return is(Kind::capsule, geometry.CapsuleShape()->Radius(),
                  0.5 * geometry.CapsuleShape()->Length(), 0.0);
      case sdf::GeometryType::ELLIPSOID: {
        const auto radii = geometry.EllipsoidShape()->Radii();
        return is(Kind::ellipsoid, radii.X(), radii.Y(), radii.Z());
      }
      case sdf::GeometryType::MESH: {
        const sdf::Mesh& mesh = *geometry.MeshShape();
        collision.mesh = mesh.Uri();
        collision.submesh = mesh.Submesh();
        // Relative to the file that names it, which may be an included one.
        collision.named_in = mesh.FilePath().empty() ? path_ : mesh.FilePath();
        return is(Kind::mesh, mesh.Scale().X(), mesh.Scale().Y(), mesh.Scale().Z());
      }
      case sdf::GeometryType::PLANE:
        return is(Kind::plane, 0.0, 0.0, 0.0);
      default:
        return is(Kind::other, 0.0, 0.0, 0.0);
    }
  }

  const std::string& path_;
  std::vector<Collision> all_;
};

/// Makes parts of them.
class PartMaker {
 public:
  PartMaker(const std::string& path, const UrdfOptions& options)
      : packages_(options.package_paths),
        meshes_({path, options.package_paths}, options.convex_parts) {}

  void add(const Collision& collision) {
    try {
      require_finite(collision);
      for (RobotPart& part : parts_of(collision)) {
        part.name = collision.name + part.name;
        part.in_link = collision.in_link;
        part.X_LP = collision.X_WP;
        parts_.push_back(std::move(part));
      }
    } catch (const SetupError& error) {
      throw SetupError("collision '" + collision.name + "': " + error.what(), collision.file,
                       collision.line);
    }
  }

  [[nodiscard]] std::vector<RobotPart> take() { return std::move(parts_); }

 private:
  static void require_finite(const Collision& collision) {
    if (is_finite(collision.X_WP) && is_finite(collision.size)) return;
    throw SetupError("its pose or size is not finite; allowed: numbers");
  }

  /// With the ends of their names.
  std::vector<RobotPart> parts_of(const Collision& collision) {
    using Kind = Collision::Kind;
    RobotPart part;
    part.size = collision.size;
    switch (collision.kind) {
      case Kind::box:
        part.kind = PartKind::box;
        return {part};
      case Kind::sphere:
        part.kind = PartKind::sphere;
        return {part};
      case Kind::cylinder:
        part.kind = PartKind::cylinder;
        return {part};
      case Kind::capsule:
        part.kind = PartKind::capsule;
        return {part};
      case Kind::ellipsoid:
        part.kind = PartKind::ellipsoid;
        return {part};
      case Kind::mesh:
        return parts_of_mesh(collision);
      case Kind::plane:
        throw SetupError("a plane has no end; allowed: a box in its place");
      case Kind::other:
        break;
    }
    throw SetupError("allowed: a box, sphere, cylinder, capsule, ellipsoid or mesh");
  }

  std::vector<RobotPart> parts_of_mesh(const Collision& collision) {
    if (!collision.submesh.empty()) {
      throw SetupError("a submesh, '" + collision.submesh + "'; allowed: the whole mesh of a file");
    }
    const auto found = std::filesystem::absolute(
        detail::find_mesh(collision.mesh, {collision.named_in, packages_}));
    const detail::MeshParts& read = meshes_.parts("file://" + found.string(), collision.size);
    std::vector<RobotPart> parts;
    for (const std::vector<Vec3>& hull : read.hulls) {
      RobotPart& part = parts.emplace_back();
      if (read.is_cover) part.name = "/" + std::to_string(parts.size());
      part.kind = PartKind::hull;
      part.points = hull;
      part.is_of_cover = read.is_cover;
      part.mesh = read.path;
      part.mesh_scale = collision.size;
    }
    return parts;
  }

  std::vector<std::string> packages_;
  detail::MeshReader meshes_;
  std::vector<RobotPart> parts_;
};

/// What the child process does: all collisions of the file and those that it includes.
std::string collisions_in(const std::string& path, const UrdfOptions& options) {
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
  Gathering gathering(path);
  if (root.Model() != nullptr) gathering.add(*root.Model(), "", Pose::Identity());
  if (root.WorldCount() == 1) {
    const sdf::World& world = *root.WorldByIndex(0);
    for (std::uint64_t i = 0; i < world.ModelCount(); ++i) {
      gathering.add(*world.ModelByIndex(i), "", Pose::Identity());
    }
  }
  detail::Parcel parcel;
  parcel.put(gathering.all().size());
  for (const Collision& collision : gathering.all()) put(collision, parcel);
  return parcel.take();
}

}  // namespace

std::vector<RobotPart> load_sdf_parts(const std::string& path, const UrdfOptions& options) {
  detail::require_root(path, "sdf");  // libsdformat would take a URDF file too, and change it
  // libsdformat follows files that include themselves until something ends.
  constexpr detail::ChildLimits limits{.seconds = 10, .memory = std::size_t{1} << 30};
  std::string bytes;
  try {
    bytes = detail::result_of_child([&] { return collisions_in(path, options); }, limits);
  } catch (const SetupError& error) {
    if (!error.file().empty()) throw;
    throw SetupError("the file, with all that it includes, " + std::string(error.what()), path);
  }
  detail::Unpacking parcel(bytes);
  PartMaker maker(path, options);
  for (auto count = parcel.take<std::size_t>(); count > 0; --count) {
    maker.add(take_collision(parcel));
  }
  return maker.take();
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
