// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The words of the page of a run. Each stands for one thing, and the page says for which.
#pragma once

#include <array>
#include <string_view>

namespace repel::runs {

struct Word {
  std::string_view word;
  std::string_view meaning;
};

/// In the order of the page.
inline constexpr auto html_words = std::to_array<Word>({
    // Time of a tick.
    {"compute time, p99", "Work of a tick, from when it began: 99 % of the ticks took no longer."},
    {"compute time, longest", "The longest work of any tick, from when it began."},
    {"deadline misses",
     "Ticks not finished one period after they were due, and ticks that never ran. A tick can "
     "begin late without a miss."},
    {"response time, longest",
     "From when a tick was due until it was finished: lateness and "
     "compute time together."},
    {"lateness, p99", "How long after it was due a tick began: 99 % of the ticks began no later."},
    {"compute [µs]", "Compute time of that tick: its work, from when it began."},
    {"late [µs]", "Lateness of that tick: how long after it was due it began. No miss by itself."},
    {"allocations in a tick", "Requests for memory while a tick worked, of all ticks."},
    {"system calls in a tick", "Calls of the operating system while a tick worked, of all ticks."},
    // Distances.
    {"nearest of all pairs",
     "Least signed distance of the run, passable bodies included; below zero it is an overlap by "
     "the measure of the scene."},
    {"nearest of walls", "The same, of the pairs that must not overlap only."},
    {"deepest of all pairs",
     "Proven upper bound of the penetration depth in the run, passable "
     "bodies included: none was deeper when it was evaluated."},
    {"deepest in a wall", "The same, of the pairs that must not overlap only."},
    {"nearest [mm]", "Least signed distance of the run of the pairs with that obstacle only."},
    {"deepest [mm]", "Proven upper bound of the penetration depth of these pairs."},
    // Forces.
    {"largest virtual force",
     "Largest sum in the run of the forces of all pairs on the tool: "
     "surfaces that are simulated, not touched."},
    {"pair of the largest force", "Of all pairs at that tick the one with the largest force."},
    {"largest on", "The part with the largest force of a pair with that obstacle."},
    {"body of it", "The tool or the link that this part belongs to."},
    {"largest of a pair [N]",
     "Largest force in the run of one pair with that obstacle: not the "
     "sum on the tool."},
    {"hard wall held [N]",
     "Hardest push of the arm withstood by this wall; soft: it is no hard wall."},
    {"root mean square", "Of the part above 30 Hz, felt as roughness, over the run."},
    {"largest jump", "Largest change from one tick to the next."},
    {"virtual force, of all pairs", "Sum at that tick of the forces of all pairs on the tool."},
    {"coupling force, of the operator", "Force of the operator's side on the tool."},
    {"largest of a pair", "The largest force of one pair at that tick, not a sum."},
    {"by which hard walls held", "Force of hard walls on the arm, beside the virtual force."},
    // Work.
    {"near", "Pairs possibly within the range of their law at that tick."},
    {"evaluated", "Those of them with a distance computed in that tick."},
    {"stale", "Those evaluated in an earlier tick only; that answer was used."},
    {"compute time", "From when a tick began until it was finished."},
    {"lateness", "From when a tick was due until it began; it need not miss its deadline."},
    {"evaluated pairs", "Pairs of parts with a distance computed in that tick."},
    {"support steps", "Steps of these computations: two support points each. Not pairs of parts."},
    {"phase", "Phase of the operator's script at that tick."},
    {"at [s]", "Time of that tick since the first."},
    {"obstacle", "A part that the arm is pushed away from."},
    {"chatter of", "Place of the force; walls: the virtual force on the tool, of all pairs."},
    {"status", "What a tick reported beside its forces."},
    {"arm", "The partner that reported it; empty for the arm of the scene itself."},
    {"ticks", "In how many ticks."},
    // Energy.
    {"module", "A part of the network between operator and arm."},
    {"energy [J]", "Ledger at the end: energy into the module less energy out of it."},
    {"lowest [J]", "Least of that ledger in the run; a passive module never falls below zero."},
    {"passed [J]", "Energy that went through, in either direction."},
    {"supplied [J]", "Energy from its own supply."},
    {"controller took [J]", "Energy dissipated by its passivity controller."},
    {"passive",
     "It claims never to give out more energy than it took in, and kept to it. Not to be confused "
     "with passable, for obstacles that may be entered."},
});

/// Empty if there is none.
[[nodiscard]] constexpr std::string_view meaning_of(std::string_view word) {
  for (const Word& each : html_words) {
    if (each.word == word) return each.meaning;
  }
  return {};
}

}  // namespace repel::runs
