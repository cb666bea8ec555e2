// SPDX-License-Identifier: BSD-3-Clause
#include "mesh.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <unordered_map>

#include <tinyxml2.h>

#include <repel/base/setup_error.hpp>
#include <repel/common/input_limits.hpp>
#include <repel/geometry/facets.hpp>
#include <repel/robots/read_mesh.hpp>

#include "child_process.hpp"
#include "parcel.hpp"

#ifdef REPEL_HAS_ASSIMP
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>
#endif

namespace repel::detail {
namespace {

namespace fs = std::filesystem;

constexpr int deepest_package = 4;  // levels of folders below a package path that are searched
constexpr std::size_t most_points = 10000;  // maximum of a hull

/// Whether the folder has the name `package`, or its package.xml gives that name.
bool is_package(const fs::path& folder, const std::string& package) {
  if (folder.filename() == package) return true;
  tinyxml2::XMLDocument manifest;
  std::error_code error;
  const fs::path file = folder / "package.xml";
  if (!fs::is_regular_file(file, error) || fs::file_size(file, error) > input_limits.file_bytes ||
      manifest.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) {
    return false;
  }
  const auto* root = manifest.FirstChildElement("package");
  const auto* name = root ? root->FirstChildElement("name") : nullptr;
  return name && name->GetText() && name->GetText() == package;
}

/// The file `rest` in `folder`, if that is the package and has the file.
std::optional<fs::path> in_package(const fs::path& folder, const std::string& package,
                                   const fs::path& rest) {
  std::error_code error;
  if (is_package(folder, package) && fs::is_regular_file(folder / rest, error)) {
    return folder / rest;
  }
  return std::nullopt;
}

std::optional<fs::path> below(const fs::path& top, const std::string& package,
                              const fs::path& rest) {
  if (auto found = in_package(top, package, rest)) return found;
  std::error_code error;
  fs::recursive_directory_iterator folder(top, fs::directory_options::skip_permission_denied,
                                          error);
  for (; !error && folder != fs::recursive_directory_iterator(); folder.increment(error)) {
    if (folder.depth() + 1 >= deepest_package) folder.disable_recursion_pending();
    if (!folder->is_directory(error)) continue;
    if (auto found = in_package(folder->path(), package, rest)) return found;
  }
  return std::nullopt;
}

/// Searches the folders above the description, and in each one a subfolder with the package's name.
std::optional<fs::path> above(const fs::path& file, const std::string& package,
                              const fs::path& rest) {
  std::error_code error;
  const fs::path start = fs::absolute(file, error).lexically_normal().parent_path();
  for (fs::path folder = start;; folder = folder.parent_path()) {
    if (auto found = in_package(folder, package, rest)) return found;
    if (auto found = in_package(folder / package, package, rest)) return found;
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

[[noreturn]] void fail_to_find(const std::string& uri, const MeshFolders& folders) {
  std::string where;
  for (const std::string& path : folders.package_paths) where += "'" + path + "', ";
  throw SetupError("mesh '" + uri + "' is not found in " + where + "or the folders above '" +
                   folders.file.string() +
                   "'; allowed: an existing file (`packages` of a scene and --package-path say "
                   "where packages are)");
}

/// @throws SetupError unless `hull`, of the mesh file at `path`, can be a part of a robot
void require_fit_hull(const std::vector<Vec3>& hull, const std::string& path) {
  const std::string file = "mesh '" + path + "' ";
  if (hull.empty() || hull.size() > most_points) {
    throw SetupError(file + "has a hull of " + std::to_string(hull.size()) +
                     " corners; allowed: 1 to " + std::to_string(most_points));
  }
  if (!std::all_of(hull.begin(), hull.end(), [](const Vec3& p) { return is_finite(p); })) {
    throw SetupError(file + "has a corner that is not finite");
  }
}

}  // namespace

bool has_mesh_reader() noexcept {
#ifdef REPEL_HAS_ASSIMP
  return true;
#else
  return false;
#endif
}

fs::path find_mesh(const std::string& uri, const MeshFolders& folders) {
  const auto colon = uri.find("://");
  const std::string scheme = colon == std::string::npos ? "" : uri.substr(0, colon);
  const std::string rest = colon == std::string::npos ? uri : uri.substr(colon + 3);
  std::error_code error;
  if (scheme.empty() || scheme == "file") {
    fs::path path = scheme.empty() ? folders.file.parent_path() / rest : fs::path(rest);
    if (fs::is_regular_file(path, error)) return path;
    throw SetupError("mesh '" + uri + "' is not a file; looked at '" + path.string() +
                     "'; allowed: an existing file");
  }
  const auto slash = rest.find('/');
  if ((scheme != "package" && scheme != "model") || slash == std::string::npos) {
    throw SetupError("mesh '" + uri +
                     "' cannot be followed; allowed: package://NAME/PATH, model://NAME/PATH, "
                     "file://PATH or a path");
  }
  const std::string package = rest.substr(0, slash);
  const fs::path path = rest.substr(slash + 1);
  for (const std::string& top : folders.package_paths) {
    if (auto found = below(fs::absolute(top, error).lexically_normal(), package, path)) {
      return *found;
    }
  }
  if (auto found = above(folders.file, package, path)) return *found;
  for (const std::string& top : folders.package_paths) {  // a package whose folder has another name
    if (fs::is_regular_file(top / path, error)) return top / path;
  }
  fail_to_find(uri, folders);
}

MeshParts MeshReader::read(const std::string& path, const Vec3& scale) const {
  MeshParts parts;
  parts.path = path;
  if (convex_parts_) parts.hulls = convex_parts_(path, scale);
  parts.is_cover = !parts.hulls.empty();
  if (!parts.is_cover) parts.hulls.push_back(hull_of_mesh(path, scale));
  for (const std::vector<Vec3>& hull : parts.hulls) require_fit_hull(hull, path);
  return parts;
}

const MeshParts& MeshReader::parts(const std::string& uri, const Vec3& scale) {
  const std::string path = find_mesh(uri, folders_).string();
  const Key key(path, scale.x(), scale.y(), scale.z());
  const auto known = meshes_.find(key);
  std::error_code error;
  if (known == meshes_.end()) bytes_ += fs::file_size(path, error);
  const auto require_at_most = [&](std::uintmax_t count, std::uintmax_t most, const char* what) {
    if (count <= most) return;
    throw SetupError("mesh '" + uri + "': the robot's meshes up to this one have " +
                     std::to_string(count) + " " + what + "; allowed: up to " +
                     std::to_string(most) + " in all");
  };
  require_at_most(bytes_, input_limits.mesh_bytes, "bytes");
  require_at_most(meshes_.size() + (known == meshes_.end() ? 1 : 0), input_limits.meshes, "files");
  const MeshParts& parts = known != meshes_.end()
                               ? known->second
                               : meshes_.emplace(key, read(path, scale)).first->second;
  for (const std::vector<Vec3>& hull : parts.hulls) corners_ += hull.size();
  require_at_most(corners_, input_limits.hull_points, "corners");
  return parts;
}

#ifdef REPEL_HAS_ASSIMP
namespace {

/// The vertices and triangles of a scene. Vertices that are equal become one: in STL each facet has
/// its own.
class Gathering {
 public:
  /// Adds `node` and all below it, transformed by them.
  // NOLINTNEXTLINE(misc-no-recursion): a scene is a tree, read once at set-up
  void add(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above) {
    const aiMatrix4x4 X = above * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add(*scene.mMeshes[node.mMeshes[i]], X);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(scene, *node.mChildren[i], X);
  }

  [[nodiscard]] const std::vector<aiVector3D>& vertices() const { return vertices_; }
  [[nodiscard]] std::vector<std::array<int, 3>> take_triangles() { return std::move(triangles_); }

 private:
  using Bits = std::array<std::uint32_t, 3>;

  struct Hash {
    std::size_t operator()(const Bits& bits) const {
      std::uint64_t hash = 0xcbf29ce484222325U;
      for (const std::uint32_t word : bits) hash = (hash ^ word) * 0x9e3779b97f4a7c15U;
      return static_cast<std::size_t>(hash ^ (hash >> 29U));
    }
  };

  void add(const aiMesh& mesh, const aiMatrix4x4& X) {
    std::vector<int> index(mesh.mNumVertices);
    for (unsigned k = 0; k < mesh.mNumVertices; ++k) index[k] = index_of(X * mesh.mVertices[k]);
    for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
      const aiFace& face = mesh.mFaces[k];
      if (face.mNumIndices != 3) continue;
      require(triangles_.size() + 1, input_limits.mesh_triangles, "triangles");
      std::array<int, 3>& triangle = triangles_.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) {
        const unsigned vertex = face.mIndices[i];
        if (vertex >= index.size()) {  // not every reader of assimp looks
          throw SetupError("names vertex " + std::to_string(vertex) + " of " +
                           std::to_string(index.size()) + "; allowed: from 0, below that");
        }
        triangle[i] = index[vertex];
      }
    }
  }

  int index_of(const aiVector3D& v) {
    Bits bits;
    const std::array<float, 3> numbers{v.x + 0.0F, v.y + 0.0F, v.z + 0.0F};  // -0 is 0
    std::memcpy(bits.data(), numbers.data(), sizeof bits);
    const auto [known, is_new] = index_.try_emplace(bits, static_cast<int>(vertices_.size()));
    if (is_new) {
      require(vertices_.size() + 1, input_limits.mesh_vertices, "different vertices");
      vertices_.push_back(v);
    }
    return known->second;
  }

  static void require(std::size_t count, std::size_t most, const char* what) {
    if (count <= most) return;
    throw SetupError("has more than " + std::to_string(most) + " " + what + "; allowed: up to " +
                     std::to_string(most));
  }

  std::vector<aiVector3D> vertices_;
  std::vector<std::array<int, 3>> triangles_;
  std::unordered_map<Bits, int, Hash> index_;
};

/// The scene in a file, as long as `importer` lives.
const aiScene& read_scene(Assimp::Importer& importer, const std::string& path, unsigned steps) {
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(path, steps);
  if (!scene || !scene->mRootNode) {
    throw SetupError(std::string("cannot be read: ") + importer.GetErrorString());
  }
  return *scene;
}

/// Appends `vertices`, scaled, to `points`.
void append_scaled(const std::vector<aiVector3D>& vertices, const Vec3& scale,
                   std::vector<Vec3>& points) {
  points.reserve(points.size() + vertices.size());
  for (const aiVector3D& v : vertices) {
    points.emplace_back(scale.cwiseProduct(Vec3(v.x, v.y, v.z)));
    if (!is_finite(points.back())) throw SetupError("has a corner that is not finite");
  }
  if (points.empty()) throw SetupError("holds no corner");
}

/// hull_of_mesh() in this process; errors do not name the file.
std::vector<Vec3> read_hull(const std::string& path, const Vec3& scale) {
  Assimp::Importer importer;
  const aiScene& scene = read_scene(importer, path, 0);
  Gathering gathering;
  gathering.add(scene, *scene.mRootNode, aiMatrix4x4());
  std::vector<Vec3> points;
  append_scaled(gathering.vertices(), scale, points);
  // A planar set has no facets: all of its points stay.
  const std::vector<Facet> facets = hull_facets(points);
  if (!facets.empty()) points = hull_corners(points, facets);
  return points;
}

/// read_mesh() in this process; errors do not name the file.
TriangleMesh read_triangles(const std::string& path, const Vec3& scale) {
  Assimp::Importer importer;
  const aiScene& scene = read_scene(importer, path, aiProcess_Triangulate);
  Gathering gathering;
  gathering.add(scene, *scene.mRootNode, aiMatrix4x4());
  TriangleMesh mesh;
  append_scaled(gathering.vertices(), scale, mesh.vertices);
  mesh.triangles = gathering.take_triangles();
  if (mesh.triangles.empty()) throw SetupError("holds no triangle");
  return mesh;
}

/// @throws SetupError unless `mesh`, which a child process has sent, has the vertices that its
/// triangles name
void require_sound(const TriangleMesh& mesh, const fs::path& path) {
  const auto is_vertex = [&](int index) {
    return index >= 0 && static_cast<std::size_t>(index) < mesh.vertices.size();
  };
  for (const auto& triangle : mesh.triangles) {
    if (std::all_of(triangle.begin(), triangle.end(), is_vertex)) continue;
    throw SetupError("mesh '" + path.string() + "' has a triangle of vertices that it has not");
  }
  for (const Vec3& p : mesh.vertices) {
    if (!is_finite(p))
      throw SetupError("mesh '" + path.string() + "' has a corner that is not finite");
  }
}

/// What each byte of a mesh file may take in memory.
constexpr std::size_t expansion = 64;

}  // namespace

std::vector<Vec3> hull_of_mesh(const fs::path& path, const Vec3& scale) {
  const std::string bytes = result_of_file(path, "mesh", expansion, [&] {
    Parcel parcel;
    parcel.put_list(read_hull(path.string(), scale));
    return parcel.take();
  });
  return Unpacking(bytes).take_list<std::vector<Vec3>>();
}

TriangleMesh triangles_of_mesh(const fs::path& path, const Vec3& scale) {
  const std::string bytes = result_of_file(path, "mesh", expansion, [&] {
    const TriangleMesh mesh = read_triangles(path.string(), scale);
    Parcel parcel;
    parcel.put_list(mesh.vertices);
    parcel.put_list(mesh.triangles);
    return parcel.take();
  });
  Unpacking parcel(bytes);
  TriangleMesh mesh;
  mesh.vertices = parcel.take_list<std::vector<Vec3>>();
  mesh.triangles = parcel.take_list<std::vector<std::array<int, 3>>>();
  require_sound(mesh, path);
  return mesh;
}
#else
namespace {

[[noreturn]] void fail_without_reader(const fs::path& path) {
  throw SetupError(
      "mesh '" + path.string() +
      "' cannot be read, repel is built without assimp; to have it: apt-get install "
      "libassimp-dev, and build again; allowed without: box, sphere, cylinder, capsule");
}

}  // namespace

std::vector<Vec3> hull_of_mesh(const fs::path& path, const Vec3&) {
  fail_without_reader(path);
}

TriangleMesh triangles_of_mesh(const fs::path& path, const Vec3&) {
  fail_without_reader(path);
}
#endif

}  // namespace repel::detail

namespace repel {

TriangleMesh read_mesh(const std::filesystem::path& path, const Vec3& scale) {
  return detail::triangles_of_mesh(path, scale);
}

}  // namespace repel
