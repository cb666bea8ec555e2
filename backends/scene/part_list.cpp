// SPDX-License-Identifier: BSD-3-Clause
#include <repel/scene/part_list.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <ostream>
#include <system_error>

#include <repel/base/setup_error.hpp>
#include <repel/common/input_limits.hpp>
#include <repel/common/text_file.hpp>
#include <repel/reduction/shape.hpp>

#include "yaml.hpp"

namespace repel::scene {
namespace {

constexpr Rule coordinate{unit::length, -Shape::largest, Shape::largest};
constexpr Rule bound{unit::length, 0.0, Shape::largest};

std::string text_of(const Vec3& p) {
  return to_text(p.x()) + " " + to_text(p.y()) + " " + to_text(p.z());
}

Gaps gaps_of(const Map& map) {
  Gaps gaps;
  if (const Value* list = map.find("gaps")) {
    for (const Value& entry : list->list(Gaps::most_kept)) {
      const Map gap(entry);
      gap.allow({"at", "depth"});
      gaps.deepest.push_back({gap.at("at").vector(coordinate), gap.at("depth").number(bound)});
    }
  }
  gaps.count = gaps.deepest.size();
  if (const Value* count = map.find("gap_count")) {
    gaps.count = static_cast<std::size_t>(
        count->integer(static_cast<std::int64_t>(gaps.count), 1'000'000'000));
  }
  return gaps;
}

}  // namespace

void write_part_list(const PartList& list, std::ostream& out) {
  out << "# Convex parts that cover a mesh, for `shape: mesh` of a scene.\n";
  if (!list.mesh.empty()) out << "mesh: '" << list.mesh << "'\n";
  if (!list.checksum.empty()) out << "checksum: '" << list.checksum << "'\n";
  out << "scale: " << text_of(list.scale) << "\n"
      << "uncovered: " << to_text(list.uncovered) << " m\n"
      << "excess: " << to_text(list.excess) << " m\n";
  if (list.seam) out << "seam: " << to_text(*list.seam) << " m\n";
  if (list.gaps.count > 0) out << "gap_count: " << list.gaps.count << "\ngaps:\n";
  for (const Gap& gap : list.gaps.deepest) {
    out << "  - {at: " << text_of(gap.p_M) << " m, depth: " << to_text(gap.depth) << " m}\n";
  }
  out << "parts:\n";
  for (const std::vector<Vec3>& part : list.parts) {
    out << "  - points:\n";
    for (const Vec3& p : part) out << "      - " << text_of(p) << " m\n";
  }
}

PartList read_part_list(const std::string& path) {
  const Value document = Value::document(text_of_file(path, "a list of parts"), path);
  static const Keys keys{key::text("mesh"),
                         key::text("checksum"),
                         key::vector("scale", {unit::none, -1e6, 1e6}),
                         {"uncovered", Key::Kind::number, bound},
                         {"excess", Key::Kind::number, bound},
                         {"seam", Key::Kind::number, bound},
                         key::any("gap_count"),
                         key::any("gaps"),
                         key::any("parts").required()};
  const Map map(document, keys);
  PartList list;
  map.read("mesh", list.mesh);
  map.read("checksum", list.checksum);
  map.read("scale", list.scale);
  map.read("uncovered", list.uncovered);
  map.read("excess", list.excess);
  if (map.find("seam") != nullptr) list.seam = map.number("seam");
  list.gaps = gaps_of(map);
  for (const Value& entry : map.at("parts").list()) {
    const Map part(entry);
    part.allow({"points"});
    std::vector<Vec3>& points = list.parts.emplace_back();
    for (const Value& point : part.at("points").list()) points.push_back(point.vector(coordinate));
  }
  return list;
}

PartList part_list_of(const std::string& mesh, const std::string& path) {
  PartList list = read_part_list(path);
  if (!list.checksum.empty() && list.checksum != checksum_of_file(mesh)) {
    std::string text = "the parts in '" + path + "' are of another version of the mesh '" + mesh +
                       "'; to have its parts: cover '" + mesh + "' -o '" + path + "'";
    if (list.scale != Vec3::Ones()) text.append(" --scale ").append(text_of(list.scale));
    throw SetupError(text);
  }
  if (list.parts.empty()) {
    throw SetupError("the file '" + path + "' has no part; allowed: 1 or more");
  }
  return list;
}

PartList list_beside(const std::string& mesh, const Vec3& scale, std::vector<std::string>& lists) {
  const std::string path = part_list_beside(mesh);
  std::error_code unused;
  if (!std::filesystem::is_regular_file(path, unused)) return {};
  PartList list = part_list_of(mesh, path);
  if (list.scale.cwiseAbs().cwiseMin(scale.cwiseAbs()).minCoeff() == 0.0) {
    throw SetupError("the parts in '" + path + "' have the scale " + text_of(list.scale) +
                     " and the mesh '" + mesh + "' " + text_of(scale) + "; allowed: not 0");
  }
  const Vec3 ratio = scale.cwiseQuotient(list.scale);
  const double most = ratio.cwiseAbs().maxCoeff();  // what distances grow by, at most
  for (std::vector<Vec3>& part : list.parts) {
    for (Vec3& p : part) p = ratio.cwiseProduct(p);
  }
  for (Gap& gap : list.gaps.deepest) gap = {ratio.cwiseProduct(gap.p_M), most * gap.depth};
  for (double* length : {&list.uncovered, &list.excess}) *length *= most;
  if (list.seam) {
    *list.seam *= most;
    // Where lengths change by different factors, it is another depth that was not searched for.
    if (ratio.cwiseAbs().minCoeff() != most) list.seam.reset();
  }
  list.scale = scale;
  if (std::find(lists.begin(), lists.end(), path) == lists.end()) lists.push_back(path);
  return list;
}

std::vector<std::vector<Vec3>> parts_beside(const std::string& mesh, const Vec3& scale,
                                            std::vector<std::string>& lists) {
  return list_beside(mesh, scale, lists).parts;
}

std::string checksum_of_file(const std::string& path) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text_of_file(path, "a mesh file", input_limits.mesh_bytes)) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3U;
  }
  char digits[17];
  (void)std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

}  // namespace repel::scene
