// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Parts and forces of a run as messages foxglove.SceneUpdate.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <repel/loop/tap.hpp>
#include <repel/runs/records/dated.hpp>
#include <repel/runs/records/heading.hpp>
#include <repel/scene/shown.hpp>
#include <repel/world/world.hpp>

namespace repel::runs::mcap {

/// The parts of a world: each an entity with the name of the part, in the frame of its body in
/// `/poses`. Repeated names get numbers, see told_apart. Its triangles are those of the live view,
/// mesh_of(shape).
class Bodies {
 public:
  /// @param world as it is at the start; its names, shapes and pairs are copied
  /// @param shown of its parts, in their order; those left out at its end have the usual colours
  Bodies(const World& world, const Heading& heading, const std::vector<scene::Shown>& shown);

  /// To be called at every tick: notes what has come and gone.
  /// @param reshaped what BesideTicks::shapes gave for this tick
  void follow(const Snapshot& tick, const std::vector<NewShape>& reshaped);

  /// A whole update if parts have come or gone or got another shape since the last one; otherwise
  /// nothing.
  [[nodiscard]] std::optional<nlohmann::json> update(const Snapshot& tick, std::uint64_t now_ns);

 private:
  struct Entity {
    std::size_t body = 0;
    nlohmann::json json;
  };

  std::vector<Entity> entities_;  ///< by PartId
  /// Of parts not yet removed: only then they are added with it.
  std::map<std::int32_t, Shape> waiting_;
  std::vector<std::uint8_t> there_;  ///< Snapshot::is_there of the last tick
  bool has_changed_ = true;          ///< since the last update
};

/// [m/N] length of the arrows of forces.
inline constexpr double arrow_per_newton = 0.002;

/// The near pairs of a tick and the forces on the tools, in the frame of the world.
class Contacts {
 public:
  Contacts(const World& world, const Heading& heading);

  [[nodiscard]] nlohmann::json update(const Snapshot& tick, std::uint64_t now_ns) const;

 private:
  std::string world_;               ///< its frame
  std::vector<std::string> pairs_;  ///< ids by PairId
  std::vector<std::string> sums_;   ///< ids by arm
  std::vector<double> ranges_;      ///< [m] of the laws, by PairId
};

/// The JSON Schema of the messages.
[[nodiscard]] std::string scene_update_schema();

/// The names, repeated ones with a number: "seen", "seen #2", ... Viewers tell frames and entities
/// apart by their names alone.
[[nodiscard]] std::vector<std::string> told_apart(const std::vector<std::string>& names);

/// The frames of the bodies, by BodyId, and behind them those of the cameras.
[[nodiscard]] std::vector<std::string> frames_of(const Heading& heading);

}  // namespace repel::runs::mcap
