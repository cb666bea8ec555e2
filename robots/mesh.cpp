#include "mesh.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <iterator>
#include <optional>

#include <tinyxml2.h>

#include <repel/base/input_limits.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/geometry/facets.hpp>
#include <repel/robots/read_mesh.hpp>

#include "child_process.hpp"

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

/// Collects every vertex of a scene, transformed by its nodes.
// NOLINTNEXTLINE(misc-no-recursion): a scene is a tree, read once at set-up
void gather(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above,
            std::vector<aiVector3D>& out) {
  const aiMatrix4x4 X = above * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    if (mesh.mNumVertices > input_limits.mesh_vertices - out.size()) {
      throw SetupError("has more than " + std::to_string(input_limits.mesh_vertices) +
                       " vertices; allowed: up to " + std::to_string(input_limits.mesh_vertices));
    }
    std::transform(mesh.mVertices, mesh.mVertices + mesh.mNumVertices, std::back_inserter(out),
                   [&](const aiVector3D& v) { return X * v; });
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    gather(scene, *node.mChildren[i], X, out);
  }
}

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
  const aiScene& scene = read_scene(importer, path, aiProcess_JoinIdenticalVertices);
  std::vector<aiVector3D> vertices;
  gather(scene, *scene.mRootNode, aiMatrix4x4(), vertices);
  std::vector<Vec3> points;
  append_scaled(vertices, scale, points);
  // A planar set has no facets: all of its points stay.
  const std::vector<Facet> facets = hull_facets(points);
  if (!facets.empty()) points = hull_corners(points, facets);
  return points;
}

/// Collects the triangles of a scene, in the order in which gather() takes the vertices.
// NOLINTNEXTLINE(misc-no-recursion): a scene is a tree, read once at set-up
void gather_triangles(const aiScene& scene, const aiNode& node, int& vertices,
                      std::vector<std::array<int, 3>>& out) {
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
      const aiFace& face = mesh.mFaces[k];
      if (face.mNumIndices != 3) continue;
      out.push_back({vertices + static_cast<int>(face.mIndices[0]),
                     vertices + static_cast<int>(face.mIndices[1]),
                     vertices + static_cast<int>(face.mIndices[2])});
    }
    vertices += static_cast<int>(mesh.mNumVertices);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    gather_triangles(scene, *node.mChildren[i], vertices, out);
  }
}

/// read_mesh() in this process; errors do not name the file.
TriangleMesh read_triangles(const std::string& path, const Vec3& scale) {
  Assimp::Importer importer;
  const aiScene& scene = read_scene(importer, path, aiProcess_Triangulate);
  std::vector<aiVector3D> vertices;
  gather(scene, *scene.mRootNode, aiMatrix4x4(), vertices);
  TriangleMesh mesh;
  append_scaled(vertices, scale, mesh.vertices);
  int count = 0;
  gather_triangles(scene, *scene.mRootNode, count, mesh.triangles);
  if (mesh.triangles.empty()) throw SetupError("holds no triangle");
  return mesh;
}

template <class T>
void append_bytes(std::string& text, const std::vector<T>& values) {
  text.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

template <class T>
std::vector<T> values_from(const char* bytes, std::size_t size) {
  std::vector<T> values(size / sizeof(T));
  if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), bytes, size);
  return values;
}

/// Runs `work` on a mesh file in a child process, within the limits of the file's size.
std::string result_for_file(const fs::path& path, const std::function<std::string()>& work) {
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  const std::string file = "mesh '" + path.string() + "' ";
  if (error || bytes > input_limits.mesh_bytes) {
    throw SetupError(file + "has " + std::to_string(bytes) + " bytes; allowed: up to " +
                     std::to_string(input_limits.mesh_bytes));
  }
  const auto mebibytes = static_cast<int>(bytes >> 20U);
  const ChildLimits limits{.seconds = std::min(input_limits.mesh_seconds, 1 + 2 * mebibytes),
                           .memory = std::min<std::size_t>(input_limits.mesh_memory,
                                                           (std::size_t{256} << 20) + 64 * bytes)};
  try {
    return result_of_child(work, limits);
  } catch (const SetupError& wrong) {
    throw SetupError(file + wrong.what());
  }
}

}  // namespace

std::vector<Vec3> hull_of_mesh(const fs::path& path, const Vec3& scale) {
  const std::string numbers = result_for_file(path, [&] {
    std::string text;
    append_bytes(text, read_hull(path.string(), scale));
    return text;
  });
  return values_from<Vec3>(numbers.data(), numbers.size());
}

TriangleMesh triangles_of_mesh(const fs::path& path, const Vec3& scale) {
  const std::string numbers = result_for_file(path, [&] {
    const TriangleMesh mesh = read_triangles(path.string(), scale);
    std::string text;
    append_bytes(text, std::vector<std::size_t>{mesh.vertices.size()});
    append_bytes(text, mesh.vertices);
    append_bytes(text, mesh.triangles);
    return text;
  });
  const char* const begin = numbers.data() + sizeof(std::size_t);
  const std::size_t vertices =
      values_from<std::size_t>(numbers.data(), sizeof(std::size_t))[0] * sizeof(Vec3);
  return {values_from<Vec3>(begin, vertices),
          values_from<std::array<int, 3>>(begin + vertices,
                                          numbers.size() - sizeof(std::size_t) - vertices)};
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
