// SPDX-License-Identifier: BSD-3-Clause
#include <repel/robots/visuals.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <tuple>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/common/input_limits.hpp>
#include <repel/reduction/shape_mesh.hpp>
#include <repel/robots/parts.hpp>

#include "mesh.hpp"
#include "thinning.hpp"
#include "urdf_document.hpp"

namespace repel {
namespace {

using Element = tinyxml2::XMLElement;
using Color = std::array<double, 4>;

std::string attribute(const Element* element, const char* name) {
  const char* const text = element != nullptr ? element->Attribute(name) : nullptr;
  return text != nullptr ? text : "";
}

const Element* child_of(const Element* element, const char* name) {
  return element != nullptr ? element->FirstChildElement(name) : nullptr;
}

/// The numbers of an attribute, as a vector; `otherwise` without it.
Vec3 vector_of(const Element* element, const char* name, const Vec3& otherwise) {
  const std::vector<double> n =
      element != nullptr ? detail::UrdfDocument::numbers(*element, name) : std::vector<double>();
  return n.size() == 3 ? Vec3(n[0], n[1], n[2]) : otherwise;
}

double number_of(const Element& element, const char* name) {
  return detail::UrdfDocument::numbers(element, name).front();
}

Pose pose_of(const Element* origin) {
  const Vec3 rpy = vector_of(origin, "rpy", Vec3::Zero());
  Pose X = Pose::Identity();
  X.linear() =
      (Eigen::AngleAxisd(rpy.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vec3::UnitY()) *
       Eigen::AngleAxisd(rpy.x(), Vec3::UnitX()))
          .toRotationMatrix();
  X.translation() = vector_of(origin, "xyz", Vec3::Zero());
  return X;
}

/// The colour of a <material>; none: it has none, or one that is none.
std::optional<Color> color_in(const Element* material) {
  const Element* const color = child_of(material, "color");
  if (color == nullptr) return std::nullopt;
  const std::vector<double> n = detail::UrdfDocument::numbers(*color, "rgba");
  const bool is_one = n.size() == 4 && std::all_of(n.begin(), n.end(), [](double x) {
                        return x >= 0.0 && x <= 1.0;  // NaN fails both
                      });
  return is_one ? std::optional(Color{n[0], n[1], n[2], n[3]}) : std::nullopt;
}

/// Reads what is seen, link by link.
class VisualReader {
 public:
  VisualReader(const detail::UrdfDocument& document, const UrdfOptions& options, std::string file)
      : document_(document), folders_{file, options.package_paths}, file_(std::move(file)) {
    name_colors();
  }

  void add(const RobotLink& link, const Robot& robot) {
    const Element* const element = document_.link(link.name);
    const std::size_t before = result_.all.size();
    for (const Element* e = child_of(element, "visual"); e != nullptr;
         e = e->NextSiblingElement("visual")) {
      if (++tried_ <= input_limits.meshes) add_visual(*e, link);
      if (tried_ == input_limits.meshes + 1) {
        warn(*e, "more than " + std::to_string(input_limits.meshes) +
                     " visuals; the others are left out");
      }
    }
    if (result_.all.size() == before) add_parts(link, robot);
  }

  RobotVisuals take() {
    leave_out_empty();  // as the parts that are a line or a point
    share_out();
    return std::move(result_);
  }

 private:
  using Key = std::tuple<std::string, double, double, double>;  // path and scale

  void warn(const Element& at, const std::string& what) {
    result_.warnings.emplace_back(SetupError(what, file_, at.GetLineNum()).what());
  }

  /// Materials of the file, then those in links: the first of a name counts.
  void name_colors() {
    const auto note = [this](const Element* material) {
      if (const auto color = color_in(material)) {
        colors_.emplace(attribute(material, "name"), *color);
      }
    };
    const Element& robot = document_.robot();
    for (const Element* e = child_of(&robot, "material"); e != nullptr;
         e = e->NextSiblingElement("material")) {
      note(e);
    }
    for (const Element* link = child_of(&robot, "link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      for (const Element* e = child_of(link, "visual"); e != nullptr;
           e = e->NextSiblingElement("visual")) {
        note(child_of(e, "material"));
      }
    }
  }

  std::optional<Color> color_of(const Element& visual) const {
    const Element* const material = child_of(&visual, "material");
    if (material == nullptr) return std::nullopt;
    if (const auto own = color_in(material)) return own;
    const auto named = colors_.find(attribute(material, "name"));
    return named != colors_.end() ? std::optional(named->second) : std::nullopt;
  }

  void add_visual(const Element& element, const RobotLink& link) {
    try {
      document_.require_numbers(element, "visual of link '" + link.name + "'");
      RobotVisual visual;
      visual.mesh = mesh_of_geometry(element, link.name);
      visual.in_link = link.name;
      visual.link = link.link;
      visual.X_LV = link.X_LN * pose_of(child_of(&element, "origin"));
      visual.color = color_of(element);
      result_.all.push_back(std::move(visual));
    } catch (const SetupError& error) {
      if (error.line() > 0) {
        result_.warnings.emplace_back(error.what());
      } else {
        warn(element, error.what());
      }
    }
  }

  /// Of a link that shows nothing else: its collision parts.
  void add_parts(const RobotLink& link, const Robot& robot) {
    for (const RobotPart& part : robot.parts) {
      if (part.in_link != link.name) continue;
      RobotVisual visual;
      visual.in_link = link.name;
      visual.link = part.link;
      visual.X_LV = part.X_LP;
      visual.collision = part.name;
      try {
        visual.mesh = mesh_of(shape_of(part, {.levels = 1}));
      } catch (const SetupError& error) {
        result_.warnings.push_back("part '" + part.name + "': " + error.what());
        continue;
      }
      result_.all.push_back(std::move(visual));
    }
  }

  TriangleMesh mesh_of_geometry(const Element& visual, const std::string& link) {
    const Element* const geometry = child_of(&visual, "geometry");
    const Element* const shape = geometry != nullptr ? geometry->FirstChildElement() : nullptr;
    const std::string kind = shape != nullptr ? shape->Name() : "";
    constexpr std::array kinds{"box", "sphere", "cylinder", "capsule", "mesh"};
    if (shape == nullptr || std::count(kinds.begin(), kinds.end(), kind) == 0) {
      throw SetupError("a visual of link '" + link +
                       "' holds none of box, sphere, cylinder, capsule, mesh; it is left out");
    }
    if (kind == "mesh") {
      return mesh_in_file(attribute(shape, "filename"), vector_of(shape, "scale", Vec3::Ones()));
    }
    const ReductionOptions whole{.levels = 1};
    if (kind == "box")
      return mesh_of(Shape::box(0.5 * vector_of(shape, "size", Vec3::Zero()), whole));
    const double radius = number_of(*shape, "radius");
    if (kind == "sphere") return mesh_of(Shape::sphere(radius, whole));
    const double half = 0.5 * number_of(*shape, "length");
    if (kind == "capsule") return mesh_of(Shape::capsule(radius, half, whole));
    if (kind == "cylinder") return mesh_of(Shape::cylinder(radius, half, whole));
    throw SetupError("a visual of link '" + link + "' is of a kind that has no mesh");
  }

  /// Each combination of file and scale is read once. Simplified at once: there may be many.
  const TriangleMesh& mesh_in_file(const std::string& uri, const Vec3& scale) {
    const std::string path = detail::find_mesh(uri, folders_).string();
    const Key key(path, scale.x(), scale.y(), scale.z());
    const auto known = meshes_.find(key);
    if (known != meshes_.end()) return known->second;
    std::error_code error;
    bytes_ += std::filesystem::file_size(path, error);
    if (bytes_ > input_limits.mesh_bytes) {
      throw SetupError("mesh '" + uri + "': the visuals up to this one have " +
                       std::to_string(bytes_) + " bytes; allowed: up to " +
                       std::to_string(input_limits.mesh_bytes) + " in all");
    }
    TriangleMesh mesh = detail::triangles_of_mesh(path, scale);
    const std::size_t triangles = mesh.triangles.size();
    mesh = detail::thinned(std::move(mesh), most_visual_triangles);
    if (mesh.triangles.empty()) throw SetupError("mesh '" + path + "' has no extent");
    if (mesh.triangles.size() < triangles) {
      result_.warnings.push_back("mesh '" + path + "' is shown by " +
                                 std::to_string(mesh.triangles.size()) + " of " +
                                 std::to_string(triangles) + " triangles");
    }
    return meshes_.emplace(key, std::move(mesh)).first->second;
  }

  void leave_out_empty() {
    std::erase_if(result_.all, [](const RobotVisual& v) { return v.mesh.triangles.empty(); });
  }

  /// Of all visuals together, no more triangles than allowed.
  void share_out() {
    std::size_t total = 0;
    for (const RobotVisual& each : result_.all) total += each.mesh.triangles.size();
    if (total <= most_visual_triangles) return;
    for (RobotVisual& each : result_.all) {
      const std::size_t share = each.mesh.triangles.size() * most_visual_triangles / total;
      each.mesh = detail::thinned(std::move(each.mesh), share);
    }
    leave_out_empty();
    result_.warnings.push_back("the visuals have " + std::to_string(total) +
                               " triangles; they are shown by no more than " +
                               std::to_string(most_visual_triangles));
  }

  const detail::UrdfDocument& document_;
  detail::MeshFolders folders_;
  std::string file_;
  std::map<std::string, Color> colors_;
  std::map<Key, TriangleMesh> meshes_;
  std::uintmax_t bytes_ = 0;
  std::size_t tried_ = 0;  // visuals of the file
  RobotVisuals result_;
};

}  // namespace

RobotVisuals parse_visuals(std::string_view urdf, const Robot& robot, const UrdfOptions& options,
                           const std::string& file) {
  const detail::UrdfDocument document(urdf, file);
  VisualReader reader(document, options, file);
  for (const RobotLink& link : robot.links) reader.add(link, robot);
  return reader.take();
}

RobotVisuals load_visuals(const std::string& path, const Robot& robot, const UrdfOptions& options) {
  return parse_visuals(detail::text_of_description(path), robot, options, path);
}

}  // namespace repel
