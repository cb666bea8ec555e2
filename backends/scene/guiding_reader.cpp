// SPDX-License-Identifier: BSD-3-Clause
#include "guiding_reader.hpp"

#include <algorithm>
#include <any>
#include <string>

#include <repel/network/modules/guide.hpp>
#include <repel/network/modules/relief.hpp>

#include "guide_reader.hpp"

namespace repel::scene {
namespace {

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

void read_guides(const Value& names, const Network& network, network::Phase& out) {
  const auto* guide = options_of<network::GuideOptions>(network, "guide");
  if (guide == nullptr) names.fail("'guides' without a module 'guide' in the network");
  out.guides = 0;
  for (const Value& name : names.list(network::Guide::most_fixtures)) {
    const std::string wanted = name.text();
    const auto found = std::find_if(guide->fixtures.begin(), guide->fixtures.end(),
                                    [&](const auto& each) { return each.name == wanted; });
    if (found == guide->fixtures.end()) name.fail_with_value("the name of a fixture");
    out.guides |= 1 << (found - guide->fixtures.begin());
  }
}

}  // namespace

void detail::read_guiding(const Map& phase, const Network& network, network::Phase& out) {
  if (const Value* names = phase.find("guides")) read_guides(*names, network, out);
  phase.read("guide_strength", {unit::share, 0.0, 1.0}, out.guide_strength);
  const Value* directions = phase.find("compliant");
  const Value* frame = phase.find("compliant_frame");
  if (directions == nullptr && frame == nullptr) return;
  const auto* relief = options_of<network::ReliefOptions>(network, "relief");
  if (relief == nullptr) {
    (directions != nullptr ? directions : frame)
        ->fail("'compliant' without a module 'relief' in the network");
  }
  if (directions == nullptr) frame->fail("'compliant_frame' without 'compliant'; allowed: both");
  out.compliant = bits_of(directions_of(*directions));
  const bool is_world = frame != nullptr ? frame->word_of({"tool", "world"}) == "world"
                                         : relief->frame == network::ReliefFrame::world;
  if (is_world) out.compliant |= network::Relief::world_bit;
}

}  // namespace repel::scene
