// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// JUNCTION: connects more than two ports.
#pragma once

#include <repel/network/elements/equivalent.hpp>

namespace repel::network {

/// The variable that all ports of a junction share.
enum class Common {
  flow,    ///< same flow at all ports; the efforts into them sum to zero
  effort,  ///< same effort at all ports; the flow towards the root is the sum of the others
};

/// A lossless junction of any number of ports of one space (the series and parallel adaptors of
/// wave digital filters). The port towards the root is matched: its resistance follows from the
/// others.
class Junction {
 public:
  /// With this quantity common to all its ports.
  explicit Junction(Common common = Common::flow) noexcept : common_(common) {}
  /// It keeps the flow where the flow is common.
  [[nodiscard]] Traits traits() const noexcept { return {.keeps_flow = common_ == Common::flow}; }
  /// What is the same at all ports.
  [[nodiscard]] Common common() const noexcept { return common_; }

  /// Starts `sum` with the first branch.
  void begin(Equivalent<any_size>& branch, Equivalent<any_size>& sum) const noexcept;
  /// Adds another branch to `sum`. False when both impose their flow on a common-flow junction, or
  /// their effort on a common-effort junction.
  [[nodiscard]] bool add(Equivalent<any_size>& branch, Equivalent<any_size>& sum) const noexcept;

 private:
  void join(const Equivalent<any_size>& branch, Equivalent<any_size>& sum) const noexcept;

  Common common_;
};

}  // namespace repel::network
