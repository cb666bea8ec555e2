/// @file
/// What the page is told, as JSON text; docs/live_view.md states the format.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <repel/base/layout.hpp>
#include <repel/loop/tap.hpp>
#include <repel/schedule/deadline.hpp>

namespace repel::visual {

/// Defined for the flags this part was built with: a program with others does not link.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

/// One arm of a world, for those who look on.
struct ArmCast {
  std::string name;  ///< empty if there is only one
  BodyId tool;
  std::vector<BodyId> links;         ///< that have parts
  std::vector<std::string> joints;   ///< "revolute" or "prismatic", base outward
  std::vector<std::string> modules;  ///< of its network, in its order
  std::vector<std::string> phases;   ///< names of those of its script
  double max_speed = 0.25;           ///< [m/s] that its master can command
  double max_turn = 1.0;             ///< [rad/s]
  double max_lever_rate = 1.5;       ///< [rad/s] at which a hand leads the lever
};

/// What stays as it is while a scene runs.
struct Cast {
  std::string scene;
  double rate_hz = 400.0;  ///< [Hz]
  bool replay = false;     ///< of a recording
  double duration = 0.0;   ///< [s] 0: until it is stopped
  std::vector<ArmCast> arms;
};

/// `scene`: bodies, parts with their levels as meshes, pairs, arms. Takes milliseconds.
[[nodiscard]] std::string scene_message(const Cast& cast, const World& world);

/// `frame`: one picture, and a few numbers of every tick since the last.
[[nodiscard]] std::string frame_message(const Cast& cast, const World& world, const Snapshot& shot,
                                        std::span<const TickSample> recent, bool running);

/// What is counted of every tick for the histograms.
struct Timing {
  DurationHistogram compute;
  DurationHistogram late;
  std::vector<std::int64_t> compute_bins;  ///< between the edges
  std::vector<std::int64_t> late_bins;
  std::int64_t ticks = 0;
  std::int64_t misses = 0;   ///< not over one period after they were due
  std::int64_t dropped = 0;  ///< ticks of which nothing is known

  /// Edges [us] of the bins: ten to each decade, from 0.1 us to 0.1 s.
  [[nodiscard]] static const std::vector<double>& edges();

  Timing();
  void add(const TickTimes& times, std::chrono::nanoseconds period);
};

/// `timing`.
[[nodiscard]] std::string timing_message(const Timing& timing);

}  // namespace repel::visual
