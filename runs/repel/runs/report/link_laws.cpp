// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/report/link_laws.hpp>

#include <algorithm>
#include <any>
#include <optional>

#include <repel/cell/layout.hpp>
#include <repel/host/figure.hpp>
#include <repel/network/modules/kbb2.hpp>

namespace repel::runs {
namespace {

using host::figure;

const char* word(GivenAt given_at) {
  return given_at == GivenAt::tool ? "tool" : "part";
}

/// The index of the arm of which this body is a link.
std::optional<std::size_t> arm_of_link(const Cell& cell, BodyId body) {
  for (std::size_t arm = 0; arm < cell.arms(); ++arm) {
    for (const LinkBody& link : cell.layout(arm).links) {
      if (link.body == body) return arm;
    }
  }
  return {};
}

/// The greatest force [N] with which the operator can push the tool for long: the limit of the one
/// coupling between the two. None if there is no coupling or more than one.
std::optional<double> operators_push(const scene::ArmSetup& setup) {
  std::optional<double> push;
  for (const scene::Module& module : setup.network.modules) {
    const auto* coupling = std::any_cast<network::Kbb2Options>(&module.options);
    if (coupling == nullptr) continue;
    if (push) return {};
    push = coupling->force_limit;
  }
  return push;
}

void note_pair(const LinkLaw& pushed, ObstacleResult& obstacle) {
  const auto same = std::find_if(obstacle.link_laws.begin(), obstacle.link_laws.end(),
                                 [&](const LinkLaw& law) { return law.body == pushed.body; });
  if (same == obstacle.link_laws.end()) {
    obstacle.link_laws.push_back(pushed);
    return;
  }
  const double peak = std::max(same->peak_force, pushed.peak_force);
  const double peak_at_tool = std::max(same->peak_at_tool, pushed.peak_at_tool);
  if (pushed.at_tool() < same->at_tool()) *same = pushed;
  same->peak_force = peak;
  same->peak_at_tool = peak_at_tool;
}

/// The one of the links for which the law is the weakest beside the operator, in a sentence.
struct Outweighed {
  std::size_t count = 0;
  double share = 1.0;  ///< of the push of the operator
  std::string sentence;

  void add(const std::string& obstacle, const LinkLaw& law, double push) {
    const bool is_levered = law.given_at == GivenAt::part && law.leverage > 1.0;
    if (!is_levered || law.passable || law.at_tool() >= push) return;
    ++count;
    if (law.at_tool() >= share * push) return;
    share = law.at_tool() / push;
    sentence = "the law of '" + obstacle + "' is given at the part: its " + figure(law.at_part, 0) +
               " N on " + law.body + " hold " + figure(law.at_tool(), 0) +
               " N at the tool, where the operator pushes with up to " + figure(push, 0) +
               " N; with 'given_at: tool' they hold " + figure(law.at_part, 0) + " N there";
  }
};

}  // namespace

void note_link_laws(const Cell& cell, RunResult& result) {
  const World& world = cell.world();
  Outweighed outweighed;
  const std::vector<std::size_t> places = obstacles_of_pairs(world);
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(world.pairs().size()); ++i) {
    const Pair& pair = world.pair({i});
    const std::size_t index = places[static_cast<std::size_t>(i)];
    const double peak = cell.coprocessor().extremes_of({i}).peak_force;
    if (!(peak > 0.0)) continue;
    const double leverage = cell.leverage({i});
    for (const PartId id : {pair.a, pair.b}) {
      const BodyId body = world.part(id).body;
      const auto arm = arm_of_link(cell, body);
      if (!arm) continue;
      const LinkLaw law{world.body_name(body),  pair.law.given_at,
                        pair.law.passable,      leverage,
                        pair.law.surface_force, peak,
                        peak / leverage};
      note_pair(law, result.obstacles[index]);
      if (const auto push = operators_push(result.scene.arm_setup(*arm))) {
        outweighed.add(result.obstacles[index].name, law, *push);
      }
    }
  }
  if (outweighed.count == 0) return;
  if (outweighed.count > 1) {
    outweighed.sentence += " (the weakest of " + std::to_string(outweighed.count) + " such pairs)";
  }
  result.warnings.push_back(outweighed.sentence);
}

void print_link_laws(const ObstacleResult& obstacle, std::FILE* out) {
  for (const LinkLaw& law : obstacle.link_laws) {
    std::fprintf(out,
                 "      %-18s law given at the %s: %s N at the part, %s N at the tool   peak there "
                 "%s N\n",
                 law.body.c_str(), word(law.given_at), figure(law.at_part, 0).c_str(),
                 figure(law.at_tool(), 0).c_str(), figure(law.peak_at_tool, 0).c_str());
  }
}

nlohmann::ordered_json link_laws_to_json(const ObstacleResult& obstacle) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LinkLaw& law : obstacle.link_laws) {
    list.push_back({{"body", law.body},
                    {"given_at", word(law.given_at)},
                    {"leverage", law.leverage},
                    {"surface_force_at_part_n", law.at_part},
                    {"surface_force_at_tool_n", law.at_tool()},
                    {"peak_force_n", law.peak_force},
                    {"peak_force_at_tool_n", law.peak_at_tool}});
  }
  return list;
}

}  // namespace repel::runs
