// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Common base of the modules adding an effort in series.
#pragma once

#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/passivity.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// An effort in series, at the same flow of both ports: f_left = f_right + effort. The base of a
/// module; the module sets the effort as it reads the signals of a tick.
class SeriesSource {
 public:
  /// What is behind, and the effort in series. Always true.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept;
  /// The same flow, less the effort.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) const noexcept;

 protected:
  Vec<any_size> effort_;  ///< [N, N m] into the module
};

/// Torques on the joints, or forces on those that slide.
class JointSource : public SeriesSource {
 public:
  /// The torques on the joints, after the passivity controller [N m].
  [[nodiscard]] Vec<any_size> torques() const noexcept { return -effort_; }
  /// Adds the same [N m].
  void add_walls(const Jacobian& /*of_tool*/, Vec<any_size>& torques) const noexcept;
};

/// A wrench on the tool, with one passivity controller for all six directions together.
class ToolSource : public SeriesSource {
 public:
  /// The wrench on the tool, after the passivity controller [N, N m].
  [[nodiscard]] Wrench on_tool() const noexcept { return to_wrench(-effort_); }
  /// Adds the same as joint torques [N m].
  void add_walls(const Jacobian& jacobian, Vec<any_size>& torques) const noexcept;
  /// Energy balance of all six directions together.
  [[nodiscard]] const PassivityReport& passivity() const noexcept { return controller_.report(); }
  /// [W] to the effort other than through its port.
  [[nodiscard]] double supplied() const noexcept { return supplied_; }

 protected:
  /// @throws SetupError for a number out of range
  static const PassivityOptions& checked_passivity(const PassivityOptions& options);
  /// Without an effort. @param options of the passivity controller, checked
  explicit ToolSource(const PassivityOptions& options);
  /// Adds the damping of the passivity controller to the effort. @param flow of the tool
  void keep_passive(const Signals& signals, const Vec<any_size>& flow) noexcept;

  PassivityController<6> controller_;  ///< of all six directions
  double supplied_ = 0.0;              ///< [W] to the effort other than through its port
  double damping_ = 0.0;               ///< [N s/m] of the passivity controller in this tick
};

}  // namespace repel::network
