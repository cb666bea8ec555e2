// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Names and message schemas of the channels of a recording. Foxglove reads a channel only if every
/// property of its schema has one type, every array items, and every object properties.
#pragma once

#include <cstddef>
#include <string>

#include <repel/network/elements/signals.hpp>

namespace repel::runs::mcap {

struct Channel {
  const char* topic;
  const char* schema;  ///< its name
  const char* text;    ///< JSON Schema
};

inline constexpr const char* profile = "";
inline constexpr const char* run_metadata = "repel run";
inline constexpr const char* end_metadata = "repel end";
inline constexpr const char* scene_attachment = "scene.yaml";

/// Of a change of the scene file, in the metadata of a run.
inline std::string change_word(std::size_t change) {
  std::string name = "set ";
  return name.append(std::to_string(change));
}

/// The robot of an arm, in the order of Scene::arm_setup().
inline std::string robot_attachment(std::size_t arm) {
  std::string name = "robot ";
  return name.append(std::to_string(arm)).append(".urdf");
}

/// The file of one of Scene::models.
inline std::string model_attachment(std::size_t model) {
  std::string name = "model ";
  return name.append(std::to_string(model)).append(".urdf");
}

/// A file of Scene::part_lists; those of meshes in URDF files come after those of the scene.
inline std::string parts_attachment(std::size_t list) {
  std::string name = "parts ";
  return name.append(std::to_string(list)).append(".yaml");
}

/// The name of a field of a hand: that of its C++ member, without its frame.
inline std::string name_of(const network::HandField& field) {
  const std::string name = field.name;
  return name.ends_with("_W") ? name.substr(0, name.size() - 2) : name;
}

/// The inputs of the tick: what a replay needs. What hands do is added
/// to it from their fields.
inline constexpr Channel inputs{"/inputs", "repel.Inputs", R"({
  "title": "repel.Inputs", "type": "object",
  "description": "What a tick has read. SI units, radians, world axes.",
  "properties": {
    "tick": {"type": "integer"}, "time_s": {"type": "number"},
    "arms": {"type": "array", "items": {"type": "object", "properties": {
      "q": {"type": "array", "items": {"type": "number"}, "description": "joints [rad] or [m]"},
      "v": {"type": "array", "items": {"type": "number"}, "description": "their rates"},
      "status": {"type": "integer", "description": "bits of the tick"},
      "elapsed_ticks": {"type": "integer", "description": "since the tick before"},
      "q_read": {"type": "array", "items": {"type": "number"},
        "description": "as read, if not believed"},
      "v_read": {"type": "array", "items": {"type": "number"},
        "description": "as read, if not believed"},
      "force_read": {"type": "array", "items": {"type": "number"},
        "description": "of a force sensor [N], axes of the tool"},
      "torque_read": {"type": "array", "items": {"type": "number"},
        "description": "likewise [N m], about its origin"},
      "phase": {"type": "integer", "description": "of the script"},
      "not_finite": {"type": "array", "items": {"type": "string"},
        "description": "what was no finite number: NAME or NAME/INDEX, then nan, inf or -inf"},
      "sound": {"type": "boolean"}, "silent_for_s": {"type": "number"}}}}}})"};

/// The fields of a tick that have an entry are added to it.
inline constexpr Channel forces{"/forces", "repel.Forces", R"({
  "title": "repel.Forces", "type": "object",
  "description": "What came out of a tick. Wrenches about the origin of the tool, world axes.",
  "properties": {
    "tick": {"type": "integer"},
    "arms": {"type": "array", "items": {"type": "object", "properties": {
      "force_n": {"type": "number", "description": "size of the virtual force [N]"}}}}}})"};

inline constexpr Channel separations{"/separations", "repel.Separations", R"({
  "title": "repel.Separations", "type": "object",
  "description": "The pairs that are near, the nearest first. Metres, newtons, world axes.",
  "properties": {
    "tick": {"type": "integer"}, "nearest_m": {"type": "number", "description": "left out: none"},
    "near": {"type": "integer"}, "evaluated": {"type": "integer"},
    "omitted": {"type": "integer", "description": "near as well, but farther than those here"},
    "pairs": {"type": "array", "items": {"type": "object", "properties": {
      "pair": {"type": "string"}, "index": {"type": "integer"},
      "distance": {"type": "number"},
      "lower": {"type": "number", "description": "left out: unknown"},
      "upper": {"type": "number", "description": "left out: unknown"},
      "a": {"type": "array", "items": {"type": "number"}, "description": "witness point"},
      "b": {"type": "array", "items": {"type": "number"}, "description": "witness point"},
      "extraction": {"type": "array", "items": {"type": "number"}},
      "level": {"type": "integer"}, "force": {"type": "number"},
      "stale": {"type": "boolean"}, "age": {"type": "integer"}}}}}})"};

inline constexpr Channel energy{"/energy", "repel.Energy", R"({
  "title": "repel.Energy", "type": "object",
  "description": "The ledger of each module of the networks [J], by arm/module.",
  "properties": {"tick": {"type": "integer"},
    "energy_j": {"type": "object", "properties": {},
      "additionalProperties": {"type": "number"}}}})"};

inline constexpr Channel timing{"/timing", "repel.Timing", R"({
  "title": "repel.Timing", "type": "object",
  "properties": {"tick": {"type": "integer"},
    "compute_us": {"type": "number", "description": "of the tick"},
    "late_us": {"type": "number", "description": "how long after it was due it began"}}})"};

/// A schema that Foxglove knows by name.
inline constexpr Channel poses{"/poses", "foxglove.FrameTransforms", R"({
  "title": "foxglove.FrameTransforms", "type": "object",
  "description": "Poses of the bodies in the world.",
  "properties": {"transforms": {"type": "array", "items": {"type": "object",
    "title": "foxglove.FrameTransform", "properties": {
      "timestamp": {"type": "object", "title": "time", "properties": {
        "sec": {"type": "integer", "minimum": 0},
        "nsec": {"type": "integer", "minimum": 0, "maximum": 999999999}}},
      "parent_frame_id": {"type": "string"}, "child_frame_id": {"type": "string"},
      "translation": {"type": "object", "title": "foxglove.Vector3", "properties": {
        "x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"}}},
      "rotation": {"type": "object", "title": "foxglove.Quaternion", "properties": {
        "x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"},
        "w": {"type": "number"}}}}}}}})"};

/// Likewise, as are those below.
inline constexpr Channel joints{"/joints", "foxglove.JointStates", R"({
  "title": "foxglove.JointStates", "type": "object",
  "description": "The joints of all arms; those of a partner begin with its name.",
  "properties": {
    "timestamp": {"type": "object", "title": "time", "properties": {
      "sec": {"type": "integer", "minimum": 0},
      "nsec": {"type": "integer", "minimum": 0, "maximum": 999999999}}},
    "joints": {"type": "array", "items": {"type": "object", "title": "foxglove.JointState",
      "properties": {
        "name": {"type": "string"},
        "position": {"type": "number", "description": "[rad] or [m]"},
        "velocity": {"type": "number", "description": "[rad/s] or [m/s]"},
        "effort": {"type": "number", "description": "sent to it [N m] or [N]"}}}}}})"};

inline constexpr Channel log{"/log", "foxglove.Log", R"({
  "title": "foxglove.Log", "type": "object",
  "description": "Phases of scripts, and faults and limits where they begin and end.",
  "properties": {
    "timestamp": {"type": "object", "title": "time", "properties": {
      "sec": {"type": "integer", "minimum": 0},
      "nsec": {"type": "integer", "minimum": 0, "maximum": 999999999}}},
    "level": {"type": "integer", "title": "foxglove.LogLevel",
      "description": "2: info, 3: warning, 4: error"},
    "message": {"type": "string"},
    "name": {"type": "string", "description": "of the arm, or repel"},
    "file": {"type": "string", "description": "none"},
    "line": {"type": "integer", "minimum": 0, "description": "none"}}})"};

/// The topic of a camera is this and its name.
inline constexpr Channel cameras{"/cameras/", "foxglove.RawImage", R"({
  "title": "foxglove.RawImage", "type": "object",
  "description": "Depths that a camera has measured, every n-th row and column of them.",
  "properties": {
    "timestamp": {"type": "object", "title": "time", "properties": {
      "sec": {"type": "integer", "minimum": 0},
      "nsec": {"type": "integer", "minimum": 0, "maximum": 999999999}}},
    "frame_id": {"type": "string"},
    "width": {"type": "integer", "minimum": 0}, "height": {"type": "integer", "minimum": 0},
    "encoding": {"type": "string", "description": "16UC1: [mm], 0: nothing was measured"},
    "step": {"type": "integer", "minimum": 0, "description": "bytes of a row"},
    "data": {"type": "string", "contentEncoding": "base64"}}})"};

/// Its text is scene_update_schema(). Of two channels, since a viewer that jumps to a
/// moment knows only the last message of each.
inline constexpr const char* scene_update = "foxglove.SceneUpdate";
inline constexpr const char* bodies_topic = "/bodies";
inline constexpr const char* contacts_topic = "/contacts";

}  // namespace repel::runs::mcap
