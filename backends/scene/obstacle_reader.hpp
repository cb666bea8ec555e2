// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads the laws of a scene file, and all that it places in the world: obstacles, models, parts
/// that come and go, and what only cameras see.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <repel/scene/scene.hpp>

#include "shape_reader.hpp"
#include "yaml.hpp"

namespace repel::scene::detail {

using Laws = std::map<std::string, ForceLaw>;

/// Those of `laws`, and the one called `default`.
[[nodiscard]] Laws laws_of(const Map& scene);

/// The law that `key` names; if it is missing, `default`.
[[nodiscard]] const ForceLaw& law_called(const Laws& laws, const Map& map,
                                         std::string_view key = "law");

/// @param models to which those among the obstacles are added
[[nodiscard]] std::vector<Obstacle> obstacles_of(const Value& value, const Laws& laws,
                                                 const ShapeFile& shapes,
                                                 std::vector<StaticModel>& models);

/// The parts of `loose`.
[[nodiscard]] std::vector<LoosePart> loose_of(const Map& scene, const Laws& laws,
                                              const ShapeFile& shapes);

/// What `spare` reserves.
[[nodiscard]] SpareParts spare_of(const Map& scene, const Laws& laws);

/// What only the cameras see.
[[nodiscard]] std::vector<HiddenPart> hidden_of(const Map& scene, const ShapeFile& shapes,
                                                bool has_camera);

}  // namespace repel::scene::detail
