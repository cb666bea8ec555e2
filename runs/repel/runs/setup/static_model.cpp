// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/setup/static_model.hpp>

#include <utility>

#include <repel/robots/parts.hpp>
#include <repel/robots/sdf.hpp>

namespace repel::runs {

std::vector<scene::Obstacle> obstacles_of(const scene::StaticModel& model, CoversBeside& covers) {
  UrdfOptions options;
  options.package_paths = model.packages;
  if (model.covers) options.convex_parts = covers.reader();
  const auto read = model.is_sdf ? &load_sdf_parts : &load_parts;
  std::vector<scene::Obstacle> obstacles;
  for (const RobotPart& part : read(model.file, options)) {
    std::string name = model.name;
    name.append(1, '/').append(part.in_link).append(1, '/').append(part.name);
    obstacles.push_back({std::move(name),
                         shape_of(part, {.levels = 1}),
                         to_text(part.kind),
                         model.X_WM * part.X_LP,
                         model.law,
                         {},
                         covers.gaps_of(part)});
  }
  if (obstacles.empty()) {
    throw SetupError("'" + model.name + "' has no collision part; allowed: 1 or more", model.file);
  }
  return obstacles;
}

}  // namespace repel::runs
