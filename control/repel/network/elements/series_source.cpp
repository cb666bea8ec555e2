// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/series_source.hpp>

#include <repel/base/setup_error.hpp>

namespace repel::network {

bool SeriesSource::reflected(const Equivalent<any_size>& behind,
                             Equivalent<any_size>& shown) const noexcept {
  shown = behind;
  shown.add_effort(effort_);
  return true;
}

void SeriesSource::incident(const PortState<any_size>& at_root,
                            const Equivalent<any_size>& /*behind*/,
                            PortState<any_size>& at_leaf) const noexcept {
  at_leaf.flow = at_root.flow;
  at_leaf.effort = at_root.effort - effort_;
}

void JointSource::add_walls(const Jacobian& /*of_tool*/, Vec<any_size>& torques) const noexcept {
  torques -= effort_;
}

void ToolSource::add_walls(const Jacobian& jacobian, Vec<any_size>& torques) const noexcept {
  Vec<any_size> at_joints;
  dense::transposed_product(jacobian, effort_, at_joints);
  torques -= at_joints;
}

const PassivityOptions& ToolSource::checked_passivity(const PassivityOptions& options) {
  checked_fields(options);
  checked("lever", options.lever, 1e-6, 100.0, "m");
  return options;
}

ToolSource::ToolSource(const PassivityOptions& options)
    : controller_(options, to_vec(Vec3(1, 1, 1), options.lever * options.lever * Vec3(1, 1, 1))) {
  effort_.setZero(6);
}

void ToolSource::keep_passive(const Signals& signals, const Vec<any_size>& flow) noexcept {
  damping_ = controller_.step(effort_, flow, signals.mean_tool_flow(), signals.period, supplied_,
                              signals.since_last());
  if (damping_ > 0.0) effort_ += damping_ * product(Vec<any_size>(controller_.weight()), flow);
}

}  // namespace repel::network
