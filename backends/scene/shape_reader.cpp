// SPDX-License-Identifier: BSD-3-Clause
#include "shape_reader.hpp"

#include <filesystem>
#include <set>
#include <system_error>

#include <repel/reduction/shape.hpp>
#include <repel/scene/part_list.hpp>

#include "grammar.hpp"
#include "pose_reader.hpp"

namespace repel::scene::detail {
namespace {

/// Limits the total number of hull points in a scene, since each costs time in the reduction.
/// @param where the error is, if there are too many
void count_hull(const Value& where, std::size_t points, const ShapeFile& shapes) {
  shapes.hull_points += points;
  if (shapes.hull_points <= input_limits.hull_points) return;
  where.fail("the hulls of the scene up to this one have " + std::to_string(shapes.hull_points) +
             " points; allowed: up to " + std::to_string(input_limits.hull_points) + " in all");
}

/// The size keys of a shape of this kind.
std::vector<std::string_view> size_keys(std::string_view kind) {
  if (kind == "box") return {"size"};
  if (kind == "sphere") return {"radius"};
  if (kind == "ellipsoid") return {"size"};
  if (kind == "hull") return {"points"};
  if (kind == "mesh") return {"file", "parts"};
  return {"radius", "length"};
}

/// With as few levels as possible: whoever needs more reduces it again.
Shape shape_of(const Map& map, std::string_view kind, const ShapeFile& shapes) {
  constexpr ReductionOptions coarse{.levels = 1};
  if (kind == "box") return Shape::box(0.5 * map.vector("size"), coarse);
  if (kind == "ellipsoid") return Shape::ellipsoid(0.5 * map.vector("size"), coarse);
  if (kind == "hull") {
    const Value& list = map.at("points");
    std::vector<Vec3> points;
    for (const Value& point : list.list(input_limits.values)) {
      points.push_back(point.vector(position));
    }
    // A single hull that is too large is refused by the shape itself.
    if (points.size() <= input_limits.entries) count_hull(list, points.size(), shapes);
    return Shape::hull(points, coarse);
  }
  const double radius = map.number("radius");
  if (kind == "sphere") return Shape::sphere(radius, coarse);
  const double half_length = 0.5 * map.number("length");
  if (kind == "capsule") return Shape::capsule(radius, half_length, coarse);
  if (kind == "cone") return Shape::cone(radius, half_length, coarse);
  if (kind == "cylinder") return Shape::cylinder(radius, half_length, coarse);
  map.at("shape").fail_with_value("a shape that is made of sizes");
}

/// The convex parts of a mesh, from the list that `parts` names or that lies beside the mesh.
std::vector<Part> parts_of_mesh(const Map& map, const ShapeFile& shapes) {
  const Value& mesh = map.at("file");
  const std::string mesh_path = mesh.path();
  const Value* const named = map.find("parts");
  const bool is_beside = named == nullptr || named->text() == "auto";
  const std::string path = is_beside ? part_list_beside(mesh_path) : named->path();
  std::error_code unused;
  if (!std::filesystem::is_regular_file(path, unused)) {
    mesh.fail("the mesh '" + mesh_path + "' has no convex parts yet: there is no file '" + path +
              "'; to have it: cover '" + mesh_path + "'");
  }
  const PartList list = mesh.located([&] { return part_list_of(mesh_path, path); });
  shapes.part_lists.push_back(path);
  std::vector<Part> parts;
  const std::string whole = map.at("name").text();
  const Shown shown{.of = list.parts.size() > 1 ? whole : "", .paint = paint_of(map)};
  for (const std::vector<Vec3>& points : list.parts) {
    count_hull(mesh, points.size(), shapes);
    std::string name = whole;
    name.append(1, '/').append(std::to_string(parts.size() + 1));
    const Shape hull = mesh.located([&] { return Shape::hull(points, {.levels = 1}); },
                                    name + " in '" + path + "': ");
    parts.push_back({name, hull, "hull", pose_of(map), shown});
  }
  parts.front().shown.gaps = list.gaps;
  return parts;
}

}  // namespace

Paint paint_of(const Map& map) {
  Paint paint;
  if (const Value* color = map.find("color")) paint.color = color->color();
  if (map.find("opacity") != nullptr) paint.opacity = map.number("opacity");
  return paint;
}

std::vector<Part> parts_of(const Value& value, const Map& map, const ShapeFile& shapes) {
  const std::string name = map.at("name").text();
  const std::string kind(map.word("shape"));
  std::vector<std::string_view> of_others{"size", "radius", "length",   "points",
                                          "file", "parts",  "packages", "covers"};
  for (const std::string_view own : size_keys(kind)) std::erase(of_others, own);
  map.refuse(of_others);
  if (kind == "mesh") return parts_of_mesh(map, shapes);
  const Shape shape =
      value.located([&] { return shape_of(map, kind, shapes); }, kind + " '" + name + "': ");
  return {{name, shape, kind, pose_of(map), {.paint = paint_of(map)}}};
}

std::vector<Part> tool_of(const Value& value, const ShapeFile& shapes) {
  std::vector<Part> parts;
  std::set<std::string> names;
  for (const Value& entry : value.list()) {
    const Map map(entry, grammar::tool_part());
    for (Part& part : parts_of(entry, map, shapes)) parts.push_back(std::move(part));
    require_new(names, map);
  }
  if (parts.empty()) value.fail("'tool' has no part; allowed: 1 or more");
  return parts;
}

}  // namespace repel::scene::detail
