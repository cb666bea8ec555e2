// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary messages from three pages, valid and invalid: at most one page has control, all input
// to the loop is finite and in range, and every answer is JSON.
#include <live_pages.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>

#include <nlohmann/json.hpp>

#include <fuzz/bytes.hpp>

#include <repel/reduction/shape.hpp>

namespace repel::visual {
namespace {

using fuzz::Bytes;
using fuzz::require;
using Json = nlohmann::json;

constexpr int most_pages = 3;

/// The messages to the pages about the present operator.
class ToldPages final : public Pages {
 public:
  std::array<bool, most_pages + 1> open{};
  std::array<bool, most_pages + 1> drives{};
  std::array<bool, most_pages + 1> looks_on{};
  int refusals = 0;

  void send(int page, std::string text) override {
    require(page >= 1 && page <= most_pages && open[static_cast<std::size_t>(page)],
            "only open pages are spoken to");
    hear(text, page);
  }
  void send_all(std::string text) override { hear(text, 0); }
  void show(std::string text) override { hear(text, 0); }
  [[nodiscard]] int count() const override {
    return static_cast<int>(std::count(open.begin(), open.end(), true));
  }

 private:
  void hear(const std::string& text, int page) {
    if (text.size() > 600) return;  // scene, frames and times, which do not depend on the input
    const Json message = Json::parse(text, nullptr, false);
    require(message.is_object() && message.contains("type"), "what is said is JSON");
    if (message["type"] == "refused") {
      ++refusals;
      require(message["why"].is_string() && message["why"] != "", "a refusal has a reason");
    }
    if (message["type"] == "operator") drives[static_cast<std::size_t>(page)] = message["you"];
  }
};

std::string number_text(Bytes& bytes) {
  static constexpr std::array<const char*, 8> odd{"1e999", "-1e999", "NaN",      "null",
                                                  "\"1\"", "[]",     "99999999", "-0"};
  const auto kind = bytes.take<std::uint8_t>();
  if (kind < 16) return odd[kind % odd.size()];
  if (kind < 128) return std::to_string(static_cast<double>(bytes.take<std::int8_t>()) / 16.0);
  char text[40];
  (void)std::snprintf(text, sizeof text, "%.17g", bytes.number());
  return text;
}

std::string vector_text(Bytes& bytes) {
  std::string text = "[";
  for (int i = bytes.take<std::uint8_t>() < 240 ? 3 : 2; i > 0; --i) {
    text += number_text(bytes);
    text += i > 1 ? "," : "]";
  }
  return text;
}

/// A list with one of two words, both, or what is none of them.
std::string words_text(Bytes& bytes, const std::string& one, const std::string& other) {
  const auto kind = bytes.take<std::uint8_t>();
  if (kind < 16) return number_text(bytes);
  if (kind < 32) return "[\"none\"]";
  std::string text = "[";
  if (kind % 4 == 1 || kind % 4 == 3) text += '"' + one + '"';
  if (kind % 4 == 3) text += ',';
  if (kind % 4 >= 2) text += '"' + other + '"';
  return text + "]";
}

/// A message of a known type, possibly with a wrong number or a wrong byte; or arbitrary bytes.
std::string message_text(Bytes& bytes) {
  static constexpr std::array<const char*, 13> types{
      "take",  "release", "servo_cv", "servo_lever", "scale", "guides", "compliant",
      "pause", "resume",  "step",     "restart",     "seek",  "speed"};
  const auto kind = bytes.take<std::uint8_t>();
  std::string text;
  if (kind < 24) {
    text.resize(bytes.take<std::uint8_t>() % 64);
    for (char& c : text) c = static_cast<char>(bytes.take<std::uint8_t>());
    return text;
  }
  const auto type = bytes.take<std::uint8_t>();
  text = "{\"type\":\"";
  text += types[type % types.size()];
  text += "\",\"linear\":" + vector_text(bytes);
  text += ",\"angular\":" + vector_text(bytes);
  text += ",\"direction\":" + vector_text(bytes);
  text += bytes.take<std::uint8_t>() < 240 ? ",\"frame\":\"world\"" : ",\"frame\":\"tool\"";
  text += bytes.take<std::uint8_t>() < 200 ? ",\"clutch\":true" : "";
  text += bytes.take<std::uint8_t>() < 128 ? ",\"hand\":\"second\"" : "";
  text += ",\"on\":" + words_text(bytes, "seam", "way in");
  text += ",\"directions\":" + words_text(bytes, "z", "rx");
  for (const char* name : {"rate", "ticks", "time_s", "factor", "strength"}) {
    text += ",\"";
    text += name;
    text += "\":" + number_text(bytes);
  }
  text += '}';
  if (kind < 48) text[bytes.take<std::uint8_t>() % text.size()] = bytes.take<char>();
  return text;
}

/// A tool and a wall, and a show of them.
struct Stage {
  explicit Stage(Bytes& bytes)
      : replay(bytes.take<std::uint8_t>() % 8 == 0),
        device(bytes.take<std::uint8_t>() % 8 == 0),
        pages_drive(bytes.take<std::uint8_t>() % 8 != 0),
        can_switch(bytes.take<std::uint8_t>() % 4 != 0),
        tool(world.add_body("tool")),
        tap(build(world, tool), {.pairs = 1, .samples = 2}),
        show(info(), world, tap, controls, device ? "a device" : "", pages_drive) {
    controls.may_restart = bytes.take<std::uint8_t>() % 2 == 0;
  }

  static const World& build(World& world, BodyId tool) {
    // As small as possible: they are described for every input.
    const std::array<Vec3, 1> point{Vec3::Zero()};
    const PartId tip = world.add_part(tool, "tip", Shape::hull(point));
    const PartId wall = world.add_part(World::fixed, "wall", Shape::hull(point));
    world.add_pair(tip, wall, {.range = 0.01});
    return world;
  }
  [[nodiscard]] SceneInfo info() const {
    SceneInfo info;
    info.replay = replay;
    info.duration = 10.0;
    ArmInfo& arm = info.arms.emplace_back();
    arm.tool = tool;
    if (!can_switch) return info;
    arm.fixtures = {{.name = "seam"}, {.name = "way in"}};
    arm.relief = network::ReliefOptions{.angular_stiffness = 0.0, .angular_damping = 0.0};
    arm.has_scale = arm.has_second_handle = true;
    return info;
  }

  bool replay;
  bool device;
  bool pages_drive;
  bool can_switch;  ///< there are fixtures, RELIEF and a second hand
  World world;
  BodyId tool;
  Tap tap;
  Controls controls;
  ToldPages pages;
  LivePages show;
};

bool moves(const DriverInput& input) {
  return !input.rates.linear.isZero(0.0) || !input.rates.angular.isZero(0.0) ||
         !input.second.linear.isZero(0.0) || !input.second.angular.isZero(0.0) ||
         input.lever_rate != 0.0;
}

void check_switches(const Stage& stage, const DriverInput& input) {
  require(input.scale == 0.0 || (input.scale >= 1e-3 && input.scale <= 1e3), "scale in range");
  require(input.guides == network::as_before || (input.guides >= 0 && input.guides < 4),
          "fixtures that there are");
  require(input.guide_strength <= 1.0, "a share of their strength");
  require(input.compliant == network::as_before || (input.compliant & ~0b1000111) == 0,
          "directions with gains");
  const DriverInput as_before;
  require(
      stage.can_switch || (!(input.scale > 0.0) && input.guides == as_before.guides &&
                           input.guide_strength < 0.0 && input.compliant == as_before.compliant),
      "nothing is switched that is not there");
}

/// @param page the last sender; 0: none
void check(Stage& stage, int page) {
  const auto& drives = stage.pages.drives;
  require(std::count(drives.begin(), drives.end(), true) <= 1, "one page drives");
  const bool is_driver = page != 0 && drives[static_cast<std::size_t>(page)];
  if (stage.controls.input.take()) {
    const DriverInput& input = stage.controls.input.newest();
    require(is_finite(input.rates) && is_finite(input.second) && is_finite(input.direction_W) &&
                std::isfinite(input.lever_rate),
            "what is said to the loop is finite");
    const ArmInfo arm;
    constexpr double rounding = 1.0 + 1e-12;
    require(input.rates.linear.norm() <= arm.max_speed * rounding &&
                input.rates.angular.norm() <= arm.max_turn * rounding &&
                input.second.linear.norm() <= arm.max_speed * rounding &&
                input.second.angular.norm() <= arm.max_turn * rounding &&
                std::abs(input.lever_rate) <= arm.max_lever_rate,
            "and no faster than the master of the scene");
    check_switches(stage, input);
    require(std::abs(input.direction_W.norm() - 1.0) < 1e-9, "the direction is a unit");
    require((input.driver != Driver::page && !moves(input)) || is_driver, "whoever drives said it");
    require(input.driver != Driver::page || (!stage.replay && stage.pages_drive),
            "they can be driven");
    require(page == 0 || !stage.pages.looks_on[static_cast<std::size_t>(page)],
            "who looks on says nothing to the loop");
    require(input.driver != Driver::device || stage.device, "there is a device");
  }
  const Controls& controls = stage.controls;
  require(controls.steps >= 0 && controls.steps <= 1000000, "steps are counted");
  require(controls.seek < 0.0 || (stage.replay && controls.seek < 10.0), "a recording has an end");
  require(controls.speed >= 0.01 && controls.speed <= 100.0, "speed is in range");
  require(stage.replay || controls.speed == 1.0, "and of a recording");
  require(stage.pages_drive || (!controls.paused && !controls.restart && controls.steps == 0),
          "who looks on stops nothing");
  require(!controls.restart || controls.may_restart, "a log is begun once");
}

void run(Bytes& bytes) {
  Stage stage(bytes);
  ToldPages& pages = stage.pages;
  for (int i = 0; i < 40; ++i) {
    const auto what = bytes.take<std::uint8_t>();
    const int page = 1 + what % most_pages;
    auto& open = pages.open[static_cast<std::size_t>(page)];
    if (!open) {
      open = true;
      const bool looks_on = bytes.take<std::uint8_t>() % 8 == 0;
      pages.looks_on[static_cast<std::size_t>(page)] = looks_on;
      stage.show.opened(page, looks_on ? Role::looks_on : Role::drives, pages);
    } else if (what < 16) {
      open = false;
      pages.drives[static_cast<std::size_t>(page)] = false;
      stage.show.closed(page, pages);
    } else if (what < 32) {
      stage.show.refresh(pages);
    } else {
      const int refusals = pages.refusals;
      stage.show.heard(page, message_text(bytes), pages);
      require(pages.refusals <= refusals + 1, "one answer at most");
      check(stage, page);
      continue;
    }
    check(stage, 0);
  }
}

}  // namespace
}  // namespace repel::visual

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  repel::fuzz::Bytes bytes(data, size);
  repel::visual::run(bytes);
  return 0;
}
