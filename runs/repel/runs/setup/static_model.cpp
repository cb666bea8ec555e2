// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/setup/static_model.hpp>

#include <map>
#include <string>
#include <string_view>

#include <repel/robots/mjcf.hpp>
#include <repel/robots/parts.hpp>
#include <repel/robots/sdf.hpp>

namespace repel::runs {

namespace {

std::vector<RobotPart> parts_of(const scene::StaticModel& model, CoversBeside& covers) {
  if (model.format == scene::ModelFormat::mjcf) return load_mjcf_parts(model.file);
  UrdfOptions options;
  options.package_paths = model.packages;
  if (model.covers) options.convex_parts = covers.reader();
  const auto read = model.format == scene::ModelFormat::sdf ? &load_sdf_parts : &load_parts;
  return read(model.file, options);
}

}  // namespace

std::vector<scene::Obstacle> obstacles_of(const scene::StaticModel& model, CoversBeside& covers) {
  std::vector<scene::Obstacle> obstacles;
  const std::vector<RobotPart> parts = parts_of(model, covers);
  std::map<std::string_view, int> counts;
  for (const RobotPart& part : parts) ++counts[part.in_link];
  for (const RobotPart& part : parts) {
    const std::string link = model.name + '/' + part.in_link;
    obstacles.push_back(
        {link + '/' + part.name,
         shape_of(part, {.levels = 1}),
         to_text(part.kind),
         model.X_WM * part.X_LP,
         model.law,
         {},
         {covers.gaps_of(part), counts[part.in_link] > 1 ? link : "", model.paint}});
  }
  if (obstacles.empty()) {
    throw SetupError("'" + model.name + "' has no collision part; allowed: 1 or more", model.file);
  }
  return obstacles;
}

}  // namespace repel::runs
