// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a simulated arm tells of its contacts.
#pragma once

#include <algorithm>

#include <repel/base/spatial.hpp>
#include <repel/simulated/built_alike.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// Contacts of a simulated arm: the depths and forces of its sub-steps, added up.
class ContactTally {
 public:
  /// A contact point of this sub-step, `depth` [m] deep.
  void touch(double depth) noexcept {
    report_.deepest = std::max(report_.deepest, depth);
    touching_ = true;
  }

  /// The contact forces of a sub-step on the last link, about the origin of the tool and in its
  /// axes [N, N m].
  void push(const Wrench& F_T) noexcept { sum_ += F_T; }

  /// Ends a step of so many sub-steps: counts it if any of them had a contact.
  void end_step(int substeps) noexcept {
    report_.steps += touching_ ? 1 : 0;
    touching_ = false;
    on_tool_ = (1.0 / substeps) * sum_;
    sum_ = {};
  }

  /// Since the last `forget`.
  [[nodiscard]] ContactReport report() const noexcept { return report_; }

  /// The sum of the contact forces on the last link, mean of the sub-steps of the last step.
  [[nodiscard]] const Wrench& on_tool() const noexcept { return on_tool_; }

  /// As after construction.
  void forget() noexcept { *this = {}; }

 private:
  ContactReport report_;
  bool touching_ = false;  // in this step
  Wrench sum_;             // in this step
  Wrench on_tool_;
};

}  // namespace repel
