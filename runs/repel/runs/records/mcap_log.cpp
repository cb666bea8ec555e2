// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/records/mcap_log.hpp>

#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <type_traits>

#include <nlohmann/json.hpp>

#include <repel/record/mcap_writer.hpp>
#include <repel/runs/records/mcap_events.hpp>
#include <repel/runs/records/mcap_image.hpp>
#include <repel/runs/records/mcap_names.hpp>
#include <repel/runs/records/mcap_scene.hpp>
#include <repel/runs/records/mcap_time.hpp>

namespace repel::runs {
namespace {

using Json = nlohmann::json;

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw SetupError("the file cannot be opened", path);
  return {std::istreambuf_iterator<char>(file), {}};
}

Json to_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

template <std::size_t N>
Json first_of(const std::array<double, N>& values, std::size_t count) {
  return std::vector<double>(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
}

/// A JSON Schema of a value.
template <class Value>
Json schema_of(const Value& /*value*/, const std::string& description) {
  if constexpr (std::is_same_v<Value, bool>) {
    return {{"type", "boolean"}, {"description", description}};
  } else if constexpr (std::is_arithmetic_v<Value>) {
    const char* type = std::is_integral_v<Value> ? "integer" : "number";
    return {{"type", type}, {"description", description}};
  } else if constexpr (std::is_same_v<Value, Stop>) {
    return {{"type", "string"}, {"description", description}};
  } else {
    return {{"type", "array"}, {"items", {{"type", "number"}}}, {"description", description}};
  }
}

/// The schema of the inputs, with what both hands do.
std::string schema_of_inputs() {
  Json schema = Json::parse(mcap::inputs.text);
  Json& fields = schema["properties"]["arms"]["items"]["properties"];
  const network::HandInput hand;
  for (const std::string prefix : {"", "second_"}) {
    network::for_each_field(
        [&](const network::HandField& field, const auto& x) {
          std::string told = prefix.empty() ? "" : "of a second hand: ";
          told += field.what;
          if (*field.unit != '\0') told.append(" [").append(field.unit).append("]");
          fields[prefix + mcap::name_of(field)] = schema_of(x, told);
        },
        hand);
  }
  return schema.dump();
}

/// Enters what a hand does, each number under its name behind `prefix`. What is, to the last bit,
/// as if there were no hand is left out. @param moves its rates and its direction are there anyway
void add_hand(const network::HandInput& hand, const std::string& prefix, bool moves, Json& inputs) {
  const network::HandInput none;
  network::for_each_field(
      [&](const network::HandField& field, const auto& x, const auto& otherwise) {
        const bool is_there = (moves && field.moves) || std::memcmp(&x, &otherwise, sizeof x) != 0;
        if (!is_there) return;
        Json& entry = inputs[prefix + mcap::name_of(field)];
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(x)>>) {
          entry = x;
        } else {
          entry = to_json(x);
        }
      },
      hand, none);
}

/// JSON has no number that is not finite: there is 0 in its place, and its name and what it is in
/// a list of their own.
void tell_not_finite(Json& values) {
  Json told = Json::array();
  const auto look = [&](Json& value, const std::string& name) {
    if (!value.is_number_float() || std::isfinite(value.get<double>())) return;
    const auto x = value.get<double>();
    told.push_back(name + (std::isnan(x) ? " nan" : x > 0.0 ? " inf" : " -inf"));
    value = 0.0;
  };
  for (auto& [name, value] : values.items()) {
    if (!value.is_array()) {
      look(value, name);
      continue;
    }
    for (std::size_t i = 0; i < value.size(); ++i) look(value[i], name + "/" + std::to_string(i));
  }
  if (!told.empty()) values["not_finite"] = std::move(told);
}

Json inputs_of(const TickRecord& k, std::size_t joints) {
  const network::Command& command = k.command;
  Json inputs = {
      {"q", first_of(k.q, joints)},        {"v", first_of(k.v, joints)}, {"status", k.status},
      {"elapsed_ticks", k.elapsed},        {"phase", k.phase},           {"sound", command.sound},
      {"silent_for_s", command.silent_for}};
  add_hand(command.hand, "", true, inputs);
  add_hand(command.second, "second_", false, inputs);
  // Where a second hand moves in older recordings, they have none and mean that of the first.
  if (command.second.scale != command.hand.scale) inputs["second_scale"] = command.second.scale;
  if ((k.status & status::blind) != 0U) {
    inputs["q_read"] = first_of(k.q_read, joints);
    inputs["v_read"] = first_of(k.v_read, joints);
  }
  if (k.wrench_read) {
    inputs["force_read"] = to_json(k.wrench_read->force);
    inputs["torque_read"] = to_json(k.wrench_read->torque);
  }
  tell_not_finite(inputs);
  return inputs;
}

/// The schema of the forces.
std::string schema_of_forces() {
  Json schema = Json::parse(mcap::forces.text);
  Json& fields = schema["properties"]["arms"]["items"]["properties"];
  const TickRecord none;
  for_each_field(
      [&](const TickField& field, const auto& x) {
        if (*field.entry != '\0') fields[field.entry] = schema_of(x, field.what);
      },
      none);
  return schema.dump();
}

Json forces_of(const TickRecord& k, std::size_t joints) {
  Json forces = {{"force_n", k.virtual_force.force.norm()}};
  for_each_field(
      [&](const TickField& field, const auto& x) {
        using Value = std::remove_cvref_t<decltype(x)>;
        if (*field.entry == '\0') return;
        Json entry;
        if constexpr (std::is_same_v<Value, Vec3>) {
          entry = to_json(x);
        } else if constexpr (std::is_same_v<Value, JointNumbers>) {
          entry = first_of(x, joints);
        } else if constexpr (std::is_same_v<Value, Stop>) {
          entry = to_text(x);
        } else if constexpr (std::is_same_v<Value, double>) {
          if (field.may_lack && !std::isfinite(x)) return;
          entry = x;
        } else if constexpr (std::is_arithmetic_v<Value>) {
          entry = x;
        }
        forces[field.entry] = std::move(entry);
      },
      k);
  return forces;
}

class McapLog final : public TickLog {
 public:
  McapLog(const std::string& path, const Heading& heading, const scene::Scene& scene,
          const RunOptions& options, const Cell& cell, const std::vector<scene::Shown>& shown,
          BesideTicks& beside)
      : path_(path),
        heading_(heading),
        frames_(mcap::frames_of(heading)),
        joint_names_(joint_names_of(heading)),
        parts_(cell.world(), heading, shown),
        pushes_(cell.world(), heading),
        events_(heading),
        beside_(beside),
        writer_(path, {.profile = mcap::profile,
                       .chunk_bytes = 1 << 20,
                       .compression = record::McapCompression::zstd}) {
    using std::chrono::system_clock;
    // Without a start time, repetitions of a run that is not in real time give identical files.
    if (!options.fast) {
      begin_ns_ = static_cast<std::uint64_t>(
          std::chrono::nanoseconds(system_clock::now().time_since_epoch()).count());
    }
    std::map<std::string, std::string> how = metadata_of(scene, options);
    if (!options.faults.empty()) how["faults"] = faults::to_text(options.faults);
    writer_.add_metadata(mcap::run_metadata, how);
    writer_.attach(mcap::scene_attachment, "application/yaml", read_file(scene.file), begin_ns_);
    for (std::size_t i = 0; i <= scene.partners.size(); ++i) {
      attach(mcap::robot_attachment(i), "application/xml", scene.arm_setup(i).robot.urdf);
    }
    for (std::size_t i = 0; i < scene.models.size(); ++i) {
      attach(mcap::model_attachment(i), "application/xml", scene.models[i].file);
    }
    for (std::size_t i = 0; i < scene.part_lists.size(); ++i) {
      attach(mcap::parts_attachment(i), "application/yaml", scene.part_lists[i]);
    }
    inputs_ = add(mcap::inputs, schema_of_inputs());
    forces_ = add(mcap::forces, schema_of_forces());
    separations_ = add(mcap::separations);
    energy_ = add(mcap::energy);
    timing_ = add(mcap::timing);
    poses_ = add(mcap::poses);
    joints_ = add(mcap::joints);
    log_ = add(mcap::log);
    if (!scene.cameras.empty()) {
      const std::uint16_t image =
          writer_.add_schema(mcap::cameras.schema, "jsonschema", mcap::cameras.text);
      for (const std::string& name : heading.cameras) {
        cameras_.push_back(writer_.add_channel(mcap::cameras.topic + name, image, "json"));
      }
      for (const scene::CameraChoice& camera : scene.cameras) X_WC_.push_back(camera.X_WC);
    }
    // One schema for both of them.
    const std::uint16_t scene_update =
        writer_.add_schema(mcap::scene_update, "jsonschema", mcap::scene_update_schema());
    bodies_ = writer_.add_channel(mcap::bodies_topic, scene_update, "json");
    contacts_ = writer_.add_channel(mcap::contacts_topic, scene_update, "json");
    every_ = std::max<std::int64_t>(1, std::llround(options.rate_hz / poses_per_second));
    every_scene_ =
        std::max<std::int64_t>(1, std::llround(std::ceil(options.rate_hz / scenes_per_second)));
    now_ns_ = begin_ns_;
    say(mcap::Level::info, "the scene " + scene.name + " at " + to_text(options.rate_hz) +
                               " Hz, by the back end " + options.backend);
    for (const std::string& warning : cell.warnings()) say(mcap::Level::warning, warning);
    writer_.flush();
    if (writer_.failed()) throw SetupError(writer_.error());
  }

  void write(const Snapshot& tick) override {
    const TickRecord& k = tick.arms.front();
    now_ns_ = at(k.time);
    sequence_ = static_cast<std::uint32_t>(k.tick);
    Json inputs{{"tick", k.tick}, {"time_s", k.time}, {"arms", Json::array()}};
    Json forces{{"tick", k.tick}, {"arms", Json::array()}};
    Json energy{{"tick", k.tick}, {"energy_j", Json::object()}};
    for (std::size_t i = 0; i < heading_.arms.size(); ++i) {
      const ArmHeading& arm = heading_.arms[i];
      inputs["arms"].push_back(inputs_of(tick.arms[i], arm.joints.size()));
      forces["arms"].push_back(forces_of(tick.arms[i], arm.joints.size()));
      for (std::size_t module = 0; module < arm.modules.size(); ++module) {
        energy["energy_j"][arm.prefix() + arm.modules[module]] = tick.arms[i].energy[module];
      }
    }
    put(inputs_, inputs);
    put(forces_, forces);
    put(separations_, separations_of(tick));
    put(energy_, energy);
    put(timing_, {{"tick", k.tick},
                  {"compute_us", static_cast<double>(tick.times.compute.count()) / 1e3},
                  {"late_us", static_cast<double>(tick.times.late.count()) / 1e3}});
    if (k.tick % every_ == 0) {
      put(poses_, transforms_of(tick));
      put(joints_, joints_of(tick));
    }
    for (const Json& event : events_.follow(tick, now_ns_)) put(log_, event);
    for (const DepthPicture& picture : beside_.pictures.take(k.tick)) {
      const std::string& frame = frames_[heading_.bodies.size() + picture.camera];
      put(cameras_[picture.camera], mcap::image_json(picture, frame, at(picture.time)));
    }
    parts_.follow(tick, beside_.shapes.take(k.tick));
    if (k.tick % every_scene_ != 0) return;
    if (const auto bodies = parts_.update(tick, now_ns_)) put(bodies_, *bodies);
    put(contacts_, pushes_.update(tick, now_ns_));
  }
  void flush() override { writer_.flush(); }
  void close(std::int64_t dropped) override {
    if (dropped > 0) {
      say(mcap::Level::warning, "the log was too slow for " + std::to_string(dropped) + " ticks");
    }
    writer_.add_metadata(mcap::end_metadata, {{"ticks_dropped", std::to_string(dropped)}});
    writer_.close();
  }
  [[nodiscard]] std::string trouble() const override { return writer_.error(); }

 private:
  static constexpr double poses_per_second = 100.0;
  static constexpr double scenes_per_second = 50.0;  // at most

  static std::map<std::string, std::string> metadata_of(const scene::Scene& scene,
                                                        const RunOptions& options) {
    const auto word = [](bool yes) { return std::string(yes ? "yes" : "no"); };
    std::map<std::string, std::string> words{
        {"version", "1"},
        {"scene", scene.file},
        {"rate_hz", to_text(options.rate_hz)},
        {"backend", options.backend},
        {"threads", std::to_string(options.threads)},
        {"coprocessor", std::string(to_text(options.coprocessor))},
        {"budget", options.budget},
        {"measure", options.measure.empty() ? to_text(scene.measure) : options.measure},
        {"levels", std::to_string(options.levels > 0 ? options.levels : scene.levels)},
        {"by_the_clock", word(!options.fast)},
        {"every_pair", word(options.every_pair)},
        {"tool_alone", word(options.tool_alone)},
        {"hold", options.hold},
        {"prediction", word(options.prediction)},
        {"contact", word(options.contact)},
        {"plant_inertia", to_text(options.plant_inertia)}};
    for (std::size_t i = 0; i < scene.changes.size(); ++i) {
      const scene::Change& change = scene.changes[i];
      words.emplace(mcap::change_word(i), change.path + "=" + change.value);
    }
    return words;
  }

  static std::vector<std::string> joint_names_of(const Heading& heading) {
    std::vector<std::string> names;
    for (const ArmHeading& arm : heading.arms) {
      for (const std::string& joint : arm.joint_names) names.push_back(arm.prefix() + joint);
    }
    return mcap::told_apart(names);
  }

  /// [ns] Of messages of this scene time [s].
  [[nodiscard]] std::uint64_t at(double time) const {
    return begin_ns_ + static_cast<std::uint64_t>(std::llround(1e9 * time));
  }

  void attach(const std::string& name, const char* type, const std::string& path) {
    writer_.attach(name, type, read_file(path), begin_ns_);
  }

  std::uint16_t add(const mcap::Channel& channel) { return add(channel, channel.text); }
  std::uint16_t add(const mcap::Channel& channel, const std::string& text) {
    const std::uint16_t schema = writer_.add_schema(channel.schema, "jsonschema", text);
    return writer_.add_channel(channel.topic, schema, "json");
  }

  void put(std::uint16_t channel, const Json& message) {
    writer_.write(channel, sequence_, now_ns_,
                  message.dump(-1, ' ', false, Json::error_handler_t::replace));
  }

  void say(mcap::Level level, const std::string& message) {
    put(log_, mcap::log_json(now_ns_, level, "repel", message));
  }

  [[nodiscard]] Json separations_of(const Snapshot& tick) const {
    // What there is not is left out.
    const auto add = [](Json& to, const char* name, double x) {
      if (std::isfinite(x)) to[name] = x;
    };
    Json pairs = Json::array();
    for (const NearPair& near : tick.near()) {
      const Separation& s = near.separation;
      pairs.push_back({{"pair", heading_.pairs[static_cast<std::size_t>(near.pair.index)]},
                       {"index", near.pair.index},
                       {"distance", s.distance},
                       {"a", to_json(s.p_WA)},
                       {"b", to_json(s.p_WB)},
                       {"extraction", to_json(s.extraction_W)},
                       {"level", s.level},
                       {"force", near.force},
                       {"stale", near.stale},
                       {"age", near.age}});
      add(pairs.back(), "lower", s.lower);
      add(pairs.back(), "upper", s.upper);
    }
    const PairTotals& totals = tick.arms.front().pairs;
    Json message = {{"tick", tick.arms.front().tick},
                    {"near", totals.near},
                    {"evaluated", totals.evaluated},
                    {"omitted", tick.pairs_omitted},
                    {"pairs", std::move(pairs)}};
    add(message, "nearest_m", totals.nearest);
    return message;
  }

  [[nodiscard]] Json transforms_of(const Snapshot& tick) const {
    Json transforms = Json::array();
    const auto add = [&](const Pose& X, const std::string& frame) {
      const Vec3 p = X.translation();
      const Eigen::Quaterniond q(X.linear());
      transforms.push_back(
          {{"timestamp", mcap::time_json(now_ns_)},
           {"parent_frame_id", frames_.front()},
           {"child_frame_id", frame},
           {"translation", {{"x", p.x()}, {"y", p.y()}, {"z", p.z()}}},
           {"rotation", {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}}});
    };
    const std::size_t bodies = tick.X_WB.size();
    for (std::size_t i = 1; i < bodies; ++i) add(tick.X_WB[i], frames_[i]);  // 0 is the world
    for (std::size_t i = 0; i < X_WC_.size(); ++i) add(X_WC_[i], frames_[bodies + i]);
    return {{"transforms", std::move(transforms)}};
  }

  [[nodiscard]] Json joints_of(const Snapshot& tick) const {
    Json joints = Json::array();
    for (std::size_t arm = 0; arm < heading_.arms.size(); ++arm) {
      const TickRecord& k = tick.arms[arm];
      for (std::size_t i = 0; i < heading_.arms[arm].joints.size(); ++i) {
        Json joint{{"name", joint_names_[joints.size()]}};
        const auto add = [&](const char* name, double x) {
          if (std::isfinite(x)) joint[name] = x;
        };
        add("position", k.q[i]);
        add("velocity", k.v[i]);
        add("effort", k.torques[i]);
        joints.push_back(std::move(joint));
      }
    }
    return {{"timestamp", mcap::time_json(now_ns_)}, {"joints", std::move(joints)}};
  }

  std::string path_;
  Heading heading_;
  std::vector<std::string> frames_;       // of the bodies, by BodyId, then of the cameras
  std::vector<std::string> joint_names_;  // of all arms
  std::vector<Pose> X_WC_;                // [m] of the cameras
  mcap::Bodies parts_;
  mcap::Contacts pushes_;
  mcap::Events events_;
  BesideTicks& beside_;
  record::McapWriter writer_;
  std::uint64_t begin_ns_ = 0;
  std::uint64_t now_ns_ = 0;
  std::uint32_t sequence_ = 0;
  std::int64_t every_ = 1;  // ticks between two messages of poses, and of what is drawn
  std::int64_t every_scene_ = 1;
  std::uint16_t inputs_ = 0, forces_ = 0, separations_ = 0, energy_ = 0, timing_ = 0, poses_ = 0,
                joints_ = 0, log_ = 0, bodies_ = 0, contacts_ = 0;
  std::vector<std::uint16_t> cameras_;
};

}  // namespace

std::unique_ptr<TickLog> mcap_log(const std::string& path, const Heading& heading,
                                  const scene::Scene& scene, const RunOptions& options,
                                  const Cell& cell, const std::vector<scene::Shown>& shown,
                                  BesideTicks& beside) {
  return std::make_unique<McapLog>(path, heading, scene, options, cell, shown, beside);
}

}  // namespace repel::runs
