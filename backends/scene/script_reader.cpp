// SPDX-License-Identifier: BSD-3-Clause
#include "script_reader.hpp"

#include <algorithm>
#include <any>
#include <array>
#include <set>
#include <string>
#include <string_view>

#include <repel/network/elements/changing_scale.hpp>
#include <repel/network/modules/guide.hpp>
#include <repel/network/modules/relief.hpp>

#include "grammar.hpp"
#include "guide_reader.hpp"

namespace repel::scene {
namespace {

Vec3 direction_of(const Map& map) {
  const Vec3 direction = map.vector("direction");
  if (direction.norm() < 1e-6) {
    map.at("direction").fail_with_value("a direction, longer than 1e-6");
  }
  return direction.normalized();
}

/// In the order of PartStep::What.
constexpr std::array<std::string_view, 4> step_words{"spawn", "grip", "release", "remove"};

/// What a second hand does in a phase: with six axes, or with a lever.
void read_second(const Map& map, network::Phase& phase) {
  map.read("linear", phase.second.linear);
  map.read("angular", phase.second.angular);
  if (map.find("direction") == nullptr && map.find("lever") == nullptr) return;
  phase.second_lever = {direction_of(map), map.number("lever")};
}

network::Phase phase_of(const Map& map) {
  network::Phase phase;
  phase.name = map.at("name").text();
  phase.duration = map.number("duration");
  map.read("frame", phase.frame);
  map.read("silent", phase.silent);
  map.read("scale", phase.scale);
  if (const Value* second = map.find("second")) {
    read_second(Map(*second, grammar::second_hand()), phase);
  }
  (void)map.at("device");
  map.read("device", phase.master);
  if (phase.master != network::Master::torque_arm) {
    map.refuse({"direction", "lever", "pitch", "axis"});
    map.read("linear", phase.rates.linear);
    map.read("angular", phase.rates.angular);
  } else {
    map.refuse({"linear", "angular"});
    phase.direction = direction_of(map);
    phase.lever_rate = map.number("lever");
    if (map.find("pitch") != nullptr || map.find("axis") != nullptr) {
      phase.screw.emplace();
      map.read("pitch", phase.screw->pitch);
      map.read("axis", phase.screw->axis);
    }
  }
  return phase;
}

/// The options of the only module of a kind in the network; null if there is none.
template <class Options>
const Options* options_of(const Network& network, std::string_view kind) {
  const Options* found = nullptr;
  for (const Module& module : network.modules) {
    if (module.kind == kind && found == nullptr) found = std::any_cast<Options>(&module.options);
  }
  return found;
}

std::int32_t bits_of(const std::array<bool, 6>& directions) {
  std::int32_t bits = 0;
  for (int i = 0; i < 6; ++i) {
    if (directions[static_cast<std::size_t>(i)]) bits |= 1 << i;
  }
  return bits;
}

/// Where the entry of that name is in the list. @param allowed for the error that there is none
template <class Entry>
std::size_t index_of(const Value& name, const std::vector<Entry>& list, const char* allowed) {
  const std::string wanted = name.text();
  const auto found = std::find_if(list.begin(), list.end(),
                                  [&](const Entry& each) { return each.name == wanted; });
  if (found == list.end()) name.fail_with_value(allowed);
  return static_cast<std::size_t>(found - list.begin());
}

void read_guides(const Value& names, const Network& network, network::Phase& out) {
  const auto* guide = options_of<network::GuideOptions>(network, "guide");
  if (guide == nullptr) names.fail("'guides' without a module 'guide' in the network");
  out.guides = 0;
  for (const Value& name : names.list(network::Guide::most_fixtures)) {
    out.guides |= 1 << index_of(name, guide->fixtures, "the name of a fixture");
  }
}

/// Reads what a phase changes in the modules `guide` and `relief`. @param network of the arm of the
/// script
void read_guiding(const Map& phase, const Network& network, network::Phase& out) {
  if (const Value* names = phase.find("guides")) read_guides(*names, network, out);
  phase.read("guide_strength", out.guide_strength);
  const Value* directions = phase.find("compliant");
  const Value* frame = phase.find("compliant_frame");
  if (directions == nullptr && frame == nullptr) return;
  const auto* relief = options_of<network::ReliefOptions>(network, "relief");
  if (relief == nullptr) {
    (directions != nullptr ? directions : frame)
        ->fail("'compliant' without a module 'relief' in the network");
  }
  if (directions == nullptr) frame->fail("'compliant_frame' without 'compliant'; allowed: both");
  out.compliant = bits_of(detail::directions_of(*directions));
  const bool is_world = frame != nullptr ? phase.word("compliant_frame") == "world"
                                         : relief->frame == network::ReliefFrame::world;
  if (is_world) out.compliant |= network::Relief::world_bit;
}

/// What happens to parts at the beginning of a phase.
void read_steps(const Map& phase, std::size_t index, const std::vector<LoosePart>& loose,
                std::vector<PartStep>& steps) {
  double over = PartStep{}.over;
  phase.read("over", over);
  for (std::size_t i = 0; i < step_words.size(); ++i) {
    const Value* names = phase.find(step_words[i]);
    if (!names) continue;
    for (const Value& name : names->one_or_list()) {
      const std::size_t part = index_of(name, loose, "the name of a part under 'loose'");
      steps.push_back({static_cast<PartStep::What>(i), index, part, over});
    }
  }
}

/// Which cameras are silent in a phase.
std::vector<bool> blind_in(const Map& phase, const std::vector<CameraChoice>& cameras) {
  std::vector<bool> blind;
  const Value* const value = phase.find("blind");
  if (value == nullptr) return blind;
  if (!value->is_list()) {
    const std::string word = value->text();
    if (word == "no") return blind;
    if (word == "yes") return std::vector<bool>(cameras.size(), true);
  }
  blind.resize(cameras.size());
  for (const Value& name : value->one_or_list()) {
    blind[index_of(name, cameras, "yes, no, or the name of a camera")] = true;
  }
  return blind;
}

}  // namespace

std::string_view word_for(PartStep::What what) noexcept {
  return step_words[static_cast<std::size_t>(what)];
}

void detail::read_script(const Map& of_arm, const std::vector<LoosePart>& loose,
                         const std::vector<CameraChoice>& cameras, ArmSetup& setup) {
  const Value* value = of_arm.find("script");
  if (!value) return;
  std::set<std::string> names;
  for (const Value& entry : value->list()) {
    const Map map(entry, grammar::phase());
    read_steps(map, setup.script.size(), loose, setup.steps);
    setup.blind.push_back(blind_in(map, cameras));
    setup.script.push_back(phase_of(map));
    read_guiding(map, setup.network, setup.script.back());
    require_new(names, map);
  }
}

}  // namespace repel::scene
