// SPDX-License-Identifier: BSD-3-Clause
// Recordings show the parts of the world and what pushes them, in little room.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <repel/record/mcap_reader.hpp>
#include <repel/record/mcap_writer.hpp>
#include <repel/reduction/shape_mesh.hpp>
#include <repel/runs/setup/prepared_run.hpp>
#include <repel/scene/scene.hpp>

#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace scene_update_test {

/// The messages of a topic, by tick.
std::map<std::uint32_t, nlohmann::json> by_tick(const std::string& file, const std::string& topic) {
  record::McapReader reader(file);
  std::map<std::uint32_t, nlohmann::json> all;
  record::McapMessage message;
  while (reader.next(message)) {
    const record::McapChannel& channel = reader.channels().at(message.channel);
    if (channel.topic != topic) continue;
    if (topic == "/bodies" || topic == "/contacts") {
      EXPECT_EQ(reader.schemas().at(channel.schema).name, "foxglove.SceneUpdate");
      EXPECT_EQ(reader.schemas().at(channel.schema).encoding, "jsonschema");
      EXPECT_TRUE(nlohmann::json::accept(reader.schemas().at(channel.schema).data));
    }
    EXPECT_TRUE(all.emplace(message.sequence, nlohmann::json::parse(message.data)).second);
  }
  return all;
}

Vec3 vector_of(const nlohmann::json& xyz) {
  return {xyz.at("x").get<double>(), xyz.at("y").get<double>(), xyz.at("z").get<double>()};
}

double metadata_of(const nlohmann::json& entity, const std::string& key) {
  for (const auto& each : entity.at("metadata")) {
    if (each.at("key") == key) return std::stod(each.at("value").get<std::string>());
  }
  return std::nan("");
}

/// Entities by their ids, each with every list that the schema wants and no two alike.
std::map<std::string, nlohmann::json> entities_of(const nlohmann::json& update) {
  EXPECT_EQ(update.at("deletions").size(), 1U);
  EXPECT_EQ(update.at("deletions").at(0).at("type"), 1) << "all before";
  std::map<std::string, nlohmann::json> entities;
  for (const auto& entity : update.at("entities")) {
    for (const char* list : {"metadata", "arrows", "cubes", "spheres", "cylinders", "lines",
                             "triangles", "texts", "models"}) {
      EXPECT_TRUE(entity.at(list).is_array()) << list;
    }
    EXPECT_TRUE(entities.emplace(entity.at("id").get<std::string>(), entity).second)
        << entity.at("id");
  }
  return entities;
}

void record(const std::string& arguments, const std::string& file) {
  const Ending ending = teleop(arguments + " --log " + quoted(file));
  ASSERT_EQ(ending.status, 0) << ending;
}

TEST(RecordedScene, BodiesAreThePartsOfTheWorldInTheFramesOfThePoses) {
  const Folder folder;
  record("two_arms --fast --seconds 1", folder / "run.mcap");
  const auto updates = by_tick(folder / "run.mcap", "/bodies");
  ASSERT_EQ(updates.size(), 1U) << "no part comes or goes";
  EXPECT_EQ(updates.begin()->first, 0U);
  const auto entities = entities_of(updates.begin()->second);
  std::set<std::string> frames{"world"};
  const auto poses = by_tick(folder / "run.mcap", "/poses");
  for (const auto& each : poses.begin()->second.at("transforms")) {
    frames.insert(each.at("child_frame_id").get<std::string>());
  }

  const auto prepared =
      runs::prepare(scene::load(REPEL_SOURCE "/scenes/two_arms.yaml"), runs::RunOptions{});
  const World& world = prepared->cell.world();
  EXPECT_EQ(entities.size(), world.parts().size());
  std::map<std::string, int> groups;
  for (const Part& part : world.parts()) {
    SCOPED_TRACE(part.name);
    ASSERT_TRUE(entities.contains(part.name));
    const nlohmann::json& entity = entities.at(part.name);
    EXPECT_EQ(entity.at("frame_id"), world.body_name(part.body));
    EXPECT_TRUE(frames.contains(entity.at("frame_id").get<std::string>()));
    EXPECT_TRUE(entity.at("frame_locked").get<bool>());
    ++groups[entity.at("metadata").at(0).at("value").get<std::string>()];
    const nlohmann::json& drawn = entity.at("triangles").at(0);
    EXPECT_LT((vector_of(drawn.at("pose").at("position")) - part.X_BP.translation()).norm(), 1e-12);
    const TriangleMesh mesh = mesh_of(part.shape);
    ASSERT_EQ(drawn.at("points").size(), mesh.vertices.size());
    ASSERT_EQ(drawn.at("indices").size(), 3 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      EXPECT_LT((vector_of(drawn.at("points").at(i)) - mesh.vertices[i]).norm(), 1e-6);
    }
  }
  EXPECT_GT(groups["tool"], 1);
  EXPECT_GT(groups["link"], 1);
  EXPECT_GT(groups["obstacle"], 0);
}

TEST(RecordedScene, PartsHaveTheColoursOfTheScene) {
  const Folder folder;
  record("glove_box --fast --seconds 0.1", folder / "run.mcap");
  const auto updates = by_tick(folder / "run.mcap", "/bodies");
  const auto entities = entities_of(updates.begin()->second);
  const auto color_of = [&](const char* part) {
    return entities.at(part).at("triangles").at(0).at("color");
  };
  EXPECT_EQ(color_of("top_pane").at("a"), 0.25) << "glass";
  EXPECT_EQ(color_of("balance"), (nlohmann::json{{"r", 1.0}, {"g", 1.0}, {"b", 1.0}, {"a", 1.0}}));
  EXPECT_EQ(color_of("palm").at("a"), 1.0);
  EXPECT_NE(color_of("palm"), color_of("balance"));
}

TEST(RecordedScene, ContactsAreThePairsAndForcesOfTheSameTick) {
  const Folder folder;
  record("anderson_4x8 --fast --seconds 6", folder / "run.mcap");
  const auto separations = by_tick(folder / "run.mcap", "/separations");
  const auto forces = by_tick(folder / "run.mcap", "/forces");
  const auto contacts = by_tick(folder / "run.mcap", "/contacts");
  ASSERT_EQ(contacts.size(), 300U) << "50 times a second";
  int pushes = 0;
  int sums = 0;
  for (const auto& [tick, update] : contacts) {
    SCOPED_TRACE(tick);
    auto entities = entities_of(update);
    for (const auto& row : separations.at(tick).at("pairs")) {
      const auto found = entities.find(row.at("pair").get<std::string>());
      ASSERT_NE(found, entities.end());
      const nlohmann::json entity = found->second;
      entities.erase(found);
      EXPECT_EQ(entity.at("frame_id"), "world");
      const nlohmann::json& ends = entity.at("lines").at(0).at("points");
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(vector_of(ends.at(0))[axis], row.at("a").at(axis).get<double>());
        EXPECT_EQ(vector_of(ends.at(1))[axis], row.at("b").at(axis).get<double>());
      }
      EXPECT_EQ(metadata_of(entity, "distance_m"), row.at("distance").get<double>());
      const auto force = row.at("force").get<double>();
      EXPECT_EQ(metadata_of(entity, "force_n"), force);
      ASSERT_EQ(entity.at("arrows").size(), force > 0.0 ? 1U : 0U);
      if (!(force > 0.0)) continue;
      ++pushes;
      const nlohmann::json& arrow = entity.at("arrows").at(0);
      EXPECT_NEAR(arrow.at("shaft_length").get<double>() + arrow.at("head_length").get<double>(),
                  0.002 * force, 2e-6);
      const nlohmann::json& q = arrow.at("pose").at("orientation");
      const Vec3 along = Eigen::Quaterniond(q.at("w").get<double>(), q.at("x").get<double>(),
                                            q.at("y").get<double>(), q.at("z").get<double>()) *
                         Vec3::UnitX();
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(along[axis], row.at("extraction").at(axis).get<double>(), 1e-5);
      }
    }
    const auto size = forces.at(tick).at("arms").at(0).at("force_n").get<double>();
    ASSERT_EQ(entities.size(), size > 0.0 ? 1U : 0U);
    if (!(size > 0.0)) continue;
    ++sums;
    EXPECT_EQ(entities.begin()->first, "force on tool");
    EXPECT_EQ(metadata_of(entities.begin()->second, "force_n"), size);
  }
  EXPECT_GT(pushes, 100);
  EXPECT_GT(sums, 50);
}

/// Where Foxglove would not read a schema; empty: nowhere. It knows one type for each property,
/// items for each array, properties for each object, and no references.
std::string unreadable(const nlohmann::json& schema, const std::string& at) {
  if (!schema.contains("type") || !schema.at("type").is_string()) return at + ": no type";
  const std::string type = schema.at("type");
  if (type == "array" && !schema.contains("items")) return at + ": no items";
  if (type == "array") return unreadable(schema.at("items"), at + "[]");
  if (type != "object") return {};
  if (!schema.contains("properties")) return at + ": no properties";
  for (const auto& [name, property] : schema.at("properties").items()) {
    const std::string where = unreadable(property, at + "/" + name);
    if (!where.empty()) return where;
  }
  return {};
}

TEST(RecordedScene, EverySchemaIsOneThatViewersRead) {
  const Folder folder;
  record("seen --fast --seconds 0.1", folder / "run.mcap");
  const record::McapReader reader(folder / "run.mcap");
  EXPECT_EQ(reader.schemas().size(), 10U);
  for (const auto& [id, schema] : reader.schemas()) {
    EXPECT_EQ(unreadable(nlohmann::json::parse(schema.data), schema.name), "");
  }
}

/// Where a value is not as its schema says; empty: nowhere.
std::string disagreement(const nlohmann::json& value, const nlohmann::json& schema,
                         const std::string& at) {
  const std::string type = schema.at("type");
  const bool fits = type == "object"    ? value.is_object()
                    : type == "array"   ? value.is_array()
                    : type == "integer" ? value.is_number_integer()
                    : type == "number"  ? value.is_number()
                    : type == "boolean" ? value.is_boolean()
                                        : value.is_string();
  if (!fits) return at + " is " + value.dump() + ", not of the type " + type;
  if (type == "array") {
    for (const nlohmann::json& item : value) {
      const std::string where = disagreement(item, schema.at("items"), at + "[]");
      if (!where.empty()) return where;
    }
  }
  if (type != "object") return {};
  for (const auto& [name, item] : value.items()) {
    const bool is_named = schema.at("properties").contains(name);
    if (!is_named && !schema.contains("additionalProperties")) return at + "/" + name + " is new";
    const nlohmann::json& of_item =
        is_named ? schema.at("properties").at(name) : schema.at("additionalProperties");
    const std::string where = disagreement(item, of_item, at + "/" + name);
    if (!where.empty()) return where;
  }
  return {};
}

// Where nothing was near, `nearest_m` was null, and its schema says that it is a number.
TEST(RecordedScene, EveryMessageIsAsItsSchemaSays) {
  for (const char* const run : {"anderson_4x8 --fast --seconds 6", "empty --fast --seconds 1",
                                "six_axes --fast --seconds 4", "seen --fast --seconds 1"}) {
    const Folder folder;
    record(run, folder / "run.mcap");
    record::McapReader reader(folder / "run.mcap");
    std::map<std::uint16_t, nlohmann::json> schemas;
    for (const auto& [id, channel] : reader.channels()) {
      schemas[id] = nlohmann::json::parse(reader.schemas().at(channel.schema).data);
    }
    record::McapMessage message;
    std::size_t without_pair = 0;
    while (reader.next(message)) {
      const nlohmann::json value = nlohmann::json::parse(message.data);
      const std::string& topic = reader.channels().at(message.channel).topic;
      ASSERT_EQ(disagreement(value, schemas.at(message.channel), topic), "") << run;
      without_pair += topic == "/separations" && !value.contains("nearest_m") ? 1U : 0U;
    }
    EXPECT_GT(without_pair, 0U) << run;
  }
}

// The bodies are written again when one comes or goes.
TEST(RecordedScene, PartsThatComeAndGoDoSoInTheRecording) {
  const Folder folder;
  record("bin_picking --fast --seconds 20", folder / "run.mcap");
  const auto updates = by_tick(folder / "run.mcap", "/bodies");
  EXPECT_GT(updates.size(), 2U);
  std::set<std::size_t> counts;
  for (const auto& [tick, update] : updates) counts.insert(entities_of(update).size());
  EXPECT_GT(counts.size(), 1U);
}

// What a camera sees gets other shapes while the run lasts, at the same ticks in every repetition.
TEST(RecordedScene, WhatACameraSeesIsTheSameInTwoRuns) {
  const Folder folder;
  for (const char* name : {"a.mcap", "b.mcap"}) record("seen --fast --seconds 1", folder / name);
  const auto first = by_tick(folder / "a.mcap", "/bodies");
  EXPECT_GT(first.size(), 5U);
  std::set<std::string> shapes;
  for (const auto& [tick, update] : first) {
    for (const auto& [id, entity] : entities_of(update)) {
      shapes.insert(id + entity.at("triangles").dump());
    }
  }
  EXPECT_GT(shapes.size(), entities_of(first.begin()->second).size() + 5);
  for (const char* topic : {"/bodies", "/contacts", "/forces", "/separations"}) {
    EXPECT_TRUE(by_tick(folder / "a.mcap", topic) == by_tick(folder / "b.mcap", topic)) << topic;
  }
}

TEST(RecordedScene, TheForceAndTheMarginOfHardWallsAreThoseOfTheTable) {
  const Folder folder;
  const std::string scene = folder.with("scene.yaml", robot_text() + table_text() + push_text());
  for (const char* name : {"run.csv", "run.mcap"}) {
    record(quoted(scene) + " --walls hard --fast --seconds 2", folder / name);
  }
  const Columns table = columns_of(folder / "run.csv");
  const auto forces = by_tick(folder / "run.mcap", "/forces");
  const std::vector<double>& held = table.at("held_n");
  ASSERT_EQ(forces.size(), held.size());
  double most = 0.0;
  int proven = 0;  // ticks
  for (const auto& [tick, row] : forces) {
    ASSERT_EQ(row.at("arms").at(0).at("held_n").get<double>(), held[tick]) << tick;
    most = std::max(most, held[tick]);
    const nlohmann::json& arm = row.at("arms").at(0);
    const double margin = table.at("hold_margin_m")[tick];
    ASSERT_EQ(arm.contains("hold_margin_m"), !std::isnan(margin)) << tick;
    if (std::isnan(margin)) continue;
    ASSERT_EQ(arm.at("hold_margin_m").get<double>(), margin) << tick;
    ++proven;
  }
  EXPECT_GT(most, 1.0);
  EXPECT_GT(proven, 100);
}

// Of those, at least, that say what is not drawn.
TEST(RecordedScene, ARecordingIsAFourthOfItsMessages) {
  if (!record::has_zstd()) GTEST_SKIP() << "built without zstd";
  const Folder folder;
  record("anderson_4x8 --fast --seconds 10", folder / "run.mcap");
  record::McapReader reader(folder / "run.mcap");
  std::uintmax_t plain = 0;
  record::McapMessage message;
  while (reader.next(message)) {
    const std::string& topic = reader.channels().at(message.channel).topic;
    if (topic != "/bodies" && topic != "/contacts") plain += 31 + message.data.size();
  }
  const auto size = std::filesystem::file_size(folder / "run.mcap");
  EXPECT_GT(plain, 4 * size) << static_cast<double>(plain) / static_cast<double>(size);
}

}  // namespace scene_update_test
}  // namespace repel::test
