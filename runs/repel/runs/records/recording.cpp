// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/records/recording.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <type_traits>

#include <nlohmann/json.hpp>

#include <repel/common/json_fields.hpp>
#include <repel/common/text_file.hpp>
#include <repel/record/mcap_reader.hpp>
#include <repel/runs/records/mcap_names.hpp>
#include <repel/simulated/changed_arm.hpp>

namespace repel::runs {
namespace {

using Json = nlohmann::json;
using record::McapReader;

/// Reads the values of one message; a missing value or a wrong type is an error in the file.
class Fields {
 public:
  Fields(const Json& json, const std::string& file) : json_(json), file_(file) {}

  [[nodiscard]] Fields at(const std::string& name) const {
    const Json& found = fields::member(json_, name.c_str());
    if (found.is_discarded()) bad(name.c_str());
    return {found, file_};
  }
  [[nodiscard]] bool has(const std::string& name) const { return json_.contains(name); }
  [[nodiscard]] Fields entry(std::size_t i) const {
    if (!json_.is_array() || i >= json_.size()) bad("an entry");
    return {json_[i], file_};
  }
  /// NaN for null: older recordings wrote it for numbers that are not finite.
  [[nodiscard]] double number() const {
    if (json_.is_null()) return std::numeric_limits<double>::quiet_NaN();
    return as<double>("a number");
  }
  [[nodiscard]] std::int64_t integer() const { return as<std::int64_t>("a whole number"); }
  [[nodiscard]] bool yes() const { return as<bool>("true or false"); }
  [[nodiscard]] std::string text() const { return as<std::string>("a text"); }
  [[nodiscard]] Vec3 vector() const {
    return {entry(0).number(), entry(1).number(), entry(2).number()};
  }
  template <std::size_t N>
  void read(std::array<double, N>& values) const {
    if (!json_.is_array() || json_.size() > N) bad("a list of joints");
    for (std::size_t i = 0; i < json_.size(); ++i) values[i] = entry(i).number();
  }

  /// These values, with those in their places of which `not_finite` tells.
  [[nodiscard]] Json with_not_finite() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Json values = json_;
    const Fields told = at("not_finite");
    for (std::size_t i = 0; i < told.json_.size(); ++i) {
      const std::string text = told.entry(i).text();
      const std::size_t end = std::min(text.size(), text.find_first_of("/ "));
      const auto value = values.find(text.substr(0, end));
      if (value == values.end()) continue;
      const double x = text.ends_with(" inf")    ? infinity
                       : text.ends_with(" -inf") ? -infinity
                                                 : std::numeric_limits<double>::quiet_NaN();
      if (value->is_number()) *value = x;
      if (!value->is_array() || end == text.size()) continue;
      const std::size_t index = std::strtoul(text.c_str() + end + 1, nullptr, 10);
      if (index < value->size()) (*value)[index] = x;
    }
    return values;
  }

 private:
  template <class T>
  [[nodiscard]] T as(const char* what) const {
    const auto value = fields::value_of<T>(json_);
    if (!value) bad(what);
    return *value;
  }
  [[noreturn]] void bad(const char* what) const {
    std::string text = "not a recording of this program: a message lacks ";
    text += what;
    throw SetupError(text, file_);
  }

  const Json& json_;
  const std::string& file_;
};

/// Reads those of a hand's numbers that there are, under their names behind `prefix`. @param all
/// those that are always recorded must be there
void read_hand(const Fields& arm, const std::string& prefix, bool all, network::HandInput& hand) {
  network::for_each_field(
      [&](const network::HandField& field, auto& x) {
        const std::string name = prefix + mcap::name_of(field);
        if (!arm.has(name) && !(all && field.moves)) return;
        const Fields value = arm.at(name);
        using Value = std::remove_cvref_t<decltype(x)>;
        if constexpr (std::is_same_v<Value, double>) {
          x = value.number();
        } else if constexpr (std::is_same_v<Value, Vec3>) {
          x = value.vector();
        } else {
          x = static_cast<Value>(value.integer());
        }
      },
      hand);
}

void read_inputs(const Fields& arm, TickRecord& k) {
  arm.at("q").read(k.q);
  arm.at("v").read(k.v);
  k.q_read = k.q;
  k.v_read = k.v;
  // Present only if the readings were rejected.
  if (arm.has("q_read")) arm.at("q_read").read(k.q_read);
  if (arm.has("v_read")) arm.at("v_read").read(k.v_read);
  if (arm.has("force_read")) {
    k.wrench_read = Wrench{arm.at("force_read").vector(), arm.at("torque_read").vector()};
  }
  if (arm.has("elapsed_ticks")) {
    k.elapsed = std::max<std::int64_t>(1, arm.at("elapsed_ticks").integer());
  }
  k.status = static_cast<Status>(arm.at("status").integer());
  k.phase = static_cast<std::int32_t>(arm.at("phase").integer());
  read_hand(arm, "", true, k.command.hand);
  // Older recordings have no `second_scale`. A second hand used the scale of the first.
  if (arm.has("second_linear")) k.command.second.scale = k.command.hand.scale;
  read_hand(arm, "second_", false, k.command.second);
  k.command.sound = arm.at("sound").yes();
  k.command.silent_for = arm.at("silent_for_s").number();
}

void read_forces(const Fields& arm, TickRecord& k) {
  for_each_field(
      [&](const TickField& field, auto& x) {
        using Value = std::remove_cvref_t<decltype(x)>;
        if (*field.entry == '\0' || (field.may_lack && !arm.has(field.entry))) return;
        const Fields value = arm.at(field.entry);
        if constexpr (std::is_same_v<Value, Vec3>) {
          x = value.vector();
        } else if constexpr (std::is_same_v<Value, JointNumbers>) {
          value.read(x);
        } else if constexpr (std::is_same_v<Value, double>) {
          x = value.number();
        } else if constexpr (std::is_same_v<Value, bool>) {
          x = value.yes();
        }
      },
      k);
}

/// Assembles ticks from messages: a tick is complete when all three of its messages have been read.
class Ticks {
 public:
  Ticks(Recording& recording, std::size_t arms) : recording_(recording) {
    recording.arms.resize(arms);
  }

  void add(const std::string& topic, const Json& json) {
    const Fields message(json, recording_.file);
    if (topic == mcap::inputs.topic) return begin(message);
    if (open_ && message.at("tick").integer() != tick_) open_ = false;  // its rest is missing
    if (!open_) return;
    if (topic == mcap::forces.topic) {
      for (std::size_t i = 0; i < records_.size(); ++i) {
        read_forces(message.at("arms").entry(i), records_[i]);
      }
      has_forces_ = true;
    } else {
      end(message);
    }
  }

 private:
  void begin(const Fields& message) {
    tick_ = message.at("tick").integer();
    const auto expected = static_cast<std::int64_t>(recording_.ticks());
    if (tick_ > expected && recording_.missing == 0) recording_.missing = tick_ - expected;
    open_ = tick_ == expected && recording_.missing == 0;
    if (!open_) return;
    has_forces_ = false;
    records_.assign(recording_.arms.size(), TickRecord{});
    for (std::size_t i = 0; i < records_.size(); ++i) {
      records_[i].tick = tick_;
      records_[i].time = message.at("time_s").number();
      const Fields arm = message.at("arms").entry(i);
      if (arm.has("not_finite")) {
        const Json values = arm.with_not_finite();
        read_inputs({values, recording_.file}, records_[i]);
      } else {
        read_inputs(arm, records_[i]);
      }
    }
  }
  void end(const Fields& message) {
    if (!has_forces_) return;
    const auto time = [&](const char* name) {
      return std::chrono::nanoseconds(std::llround(1e3 * message.at(name).number()));
    };
    recording_.times.push_back({time("late_us"), time("compute_us")});
    for (std::size_t i = 0; i < records_.size(); ++i) recording_.arms[i].push_back(records_[i]);
    open_ = false;
  }

  Recording& recording_;
  std::vector<TickRecord> records_;
  std::int64_t tick_ = 0;
  bool open_ = false;
  bool has_forces_ = false;
};

/// Null if there is none.
const std::string* find_attachment(const McapReader& reader, const std::string& name) {
  for (const record::McapAttachment& each : reader.attachments()) {
    if (each.name == name) return &each.data;
  }
  return nullptr;
}

const std::string& attachment(const McapReader& reader, const std::string& name,
                              const std::string& file) {
  if (const std::string* data = find_attachment(reader, name)) return *data;
  std::string text = "not a recording of this program: it has no attachment ";
  text += name;
  throw SetupError(text, file);
}

/// @throws SetupError if it is neither empty nor the name of a measure
void require_measure(const std::string& name) {
  if (name.empty() || measure_named(name)) return;
  std::string allowed;
  for (const Measure each : all_measures) {
    allowed += (allowed.empty() ? "" : ", ") + to_text(each);
  }
  throw SetupError("measure of the recording is '" + name + "'; allowed: " + allowed);
}

/// What the metadata of a recording says of its scene.
struct RecordedScene {
  std::string file;
  std::vector<scene::Change> changes;
};

void read_options(const McapReader& reader, Recording& recording, RecordedScene& scene) {
  for (const record::McapMetadata& each : reader.metadata()) {
    if (each.name != mcap::run_metadata) continue;
    const auto word = [&](const char* name) {
      const auto found = each.entries.find(name);
      return found == each.entries.end() ? std::string() : found->second;
    };
    RunOptions& options = recording.options;
    if (word("version") != "1") {
      throw SetupError("a recording of another version: " + word("version") + "; allowed: 1",
                       recording.file);
    }
    scene.file = word("scene");
    for (std::size_t i = 0; each.entries.contains(mcap::change_word(i)); ++i) {
      const std::string change = word(mcap::change_word(i).c_str());
      const std::size_t equals = std::min(change.find('='), change.size());
      scene.changes.push_back(
          {change.substr(0, equals), change.substr(std::min(equals + 1, change.size()))});
    }
    options.rate_hz = std::strtod(word("rate_hz").c_str(), nullptr);
    options.threads =
        static_cast<int>(std::clamp(std::strtol(word("threads").c_str(), nullptr, 10), -1L, 1000L));
    // Older recordings do not have it.
    options.coprocessor =
        coprocessor_mode_named(word("coprocessor")).value_or(CoprocessorMode::together);
    options.backend = word("backend");
    options.budget = word("budget");
    options.every_pair = word("every_pair") == "yes";
    options.tool_alone = word("tool_alone") == "yes";
    options.hold = word("hold");
    options.prediction = word("prediction") == "yes";  // older recordings had none
    options.contact = word("contact") == "yes";        // likewise: readings were judged without
    options.measure = word("measure");  // older recordings have neither: those of their scene
    options.levels = static_cast<int>(std::clamp(std::strtol(word("levels").c_str(), nullptr, 10),
                                                 -1L, ReductionOptions::most_levels + 1L));
    const std::string inertia = word("plant_inertia");  // older recordings do not have it
    if (!inertia.empty()) options.plant_inertia = std::strtod(inertia.c_str(), nullptr);
    try {
      checked("rate_hz of the recording", options.rate_hz, 1.0, 1e5, "Hz");
      checked("threads of the recording", options.threads, 0.0, 16.0, "");
      checked("plant_inertia of the recording", options.plant_inertia, least_inertia_factor,
              most_inertia_factor, "");
      checked("levels of the recording", options.levels, 0.0, ReductionOptions::most_levels, "");
      require_measure(options.measure);
      options.faults = faults::choices_in(word("faults"));  // without the key: none
    } catch (const SetupError& error) {
      throw SetupError(error.what(), recording.file);
    }
    return;
  }
  throw SetupError("not a recording of this program: it has no metadata 'repel run'",
                   recording.file);
}

/// @param recorded content of the attachment called `name`
/// @param what begins the message: "the robot is"
void require_same(const std::string& recorded, const std::string& name, const std::string& path,
                  const char* what, const std::string& recording) {
  if (text_of_file(path, "the file as it was recorded") != recorded) {
    throw SetupError(std::string(what) +
                         " not as it was recorded; allowed: the file that is attached to " +
                         recording + " as '" + name + "'",
                     path);
  }
}

void require_same(const McapReader& reader, const std::string& name, const std::string& path,
                  const char* what, const std::string& recording) {
  require_same(attachment(reader, name, recording), name, path, what, recording);
}

void read_scene(const McapReader& reader, RecordedScene recorded,
                const std::function<std::string(const std::string&)>& find, Recording& recording) {
  namespace fs = std::filesystem;
  std::error_code error;
  const std::string path =
      fs::exists(recorded.file, error) ? recorded.file : find(fs::path(recorded.file).stem());
  recording.scene = scene::parse(attachment(reader, mcap::scene_attachment, recording.file), path,
                                 {}, std::move(recorded.changes));
  const scene::Scene& scene = recording.scene;
  for (std::size_t i = 0; i <= scene.partners.size(); ++i) {
    require_same(reader, mcap::robot_attachment(i), scene.arm_setup(i).robot.urdf, "the robot is",
                 recording.file);
  }
  for (std::size_t i = 0; i < scene.models.size(); ++i) {
    require_same(reader, mcap::model_attachment(i), scene.models[i].file, "the model is",
                 recording.file);
  }
  for (std::size_t i = 0; i < scene.part_lists.size(); ++i) {
    require_same(reader, mcap::parts_attachment(i), scene.part_lists[i], "the parts of a mesh are",
                 recording.file);
  }
  for (std::size_t i = scene.part_lists.size();; ++i) {
    const std::string* list = find_attachment(reader, mcap::parts_attachment(i));
    if (list == nullptr) break;
    recording.urdf_parts.push_back(*list);
  }
}

}  // namespace

void require_recorded_lists(const Recording& recording, const std::vector<std::string>& lists) {
  const auto name_of = [&](std::size_t i) {
    return mcap::parts_attachment(recording.scene.part_lists.size() + i);
  };
  const std::size_t recorded = recording.urdf_parts.size();
  for (std::size_t i = 0; i < std::min(recorded, lists.size()); ++i) {
    require_same(recording.urdf_parts[i], name_of(i), lists[i],
                 "the parts of a mesh of a URDF file are", recording.file);
  }
  if (lists.size() > recorded) {
    throw SetupError("this list of parts of a mesh of a URDF file was not there when " +
                         recording.file + " was recorded; allowed: none",
                     lists[recorded]);
  }
  if (lists.size() < recorded) {
    throw SetupError(
        "a mesh of a URDF file has no list of parts any more; allowed: the file that is "
        "attached as '" +
            name_of(lists.size()) + "'",
        recording.file);
  }
}

Recording load_recording(const std::string& path,
                         const std::function<std::string(const std::string&)>& find) {
  std::error_code error;
  if (!std::filesystem::exists(path, error) && std::filesystem::exists(path + ".part", error)) {
    throw SetupError(
        "there is no such file; an interrupted run has left " + path + ".part, for replay as well",
        path);
  }
  McapReader reader(path);
  Recording recording;
  recording.file = path;
  RecordedScene scene;
  read_options(reader, recording, scene);
  read_scene(reader, std::move(scene), find, recording);
  Ticks ticks(recording, 1 + recording.scene.partners.size());
  record::McapMessage message;
  while (reader.next(message)) {
    const std::string& topic = reader.channels().at(message.channel).topic;
    if (topic != mcap::inputs.topic && topic != mcap::forces.topic && topic != mcap::timing.topic)
      continue;
    if (message.data.size() > input_limits.message_bytes) {
      throw SetupError("a message of " + std::to_string(message.data.size()) +
                           " bytes; allowed: up to " + std::to_string(input_limits.message_bytes),
                       path);
    }
    const Json json = Json::parse(message.data, nullptr, false);
    if (json.is_discarded()) throw SetupError("a message is no JSON", path);
    ticks.add(topic, json);
  }
  recording.not_whole = reader.why_not_whole();
  if (recording.ticks() == 0) throw SetupError("the recording has no tick that is whole", path);
  RunOptions& options = recording.options;
  options.seconds = static_cast<double>(recording.ticks()) / options.rate_hz;
  options.fast = true;
  return recording;
}

}  // namespace repel::runs
