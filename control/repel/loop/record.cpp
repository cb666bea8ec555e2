// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/record.hpp>

#include <algorithm>
#include <cstddef>

#include <repel/network/modules/six_axes.hpp>
#include <repel/network/modules/torque_arm.hpp>

namespace repel {

void note_masters(const network::Network& network, TickRecord& record) noexcept {
  record.lever_torque = 0.0;
  record.grip = record.second_grip = {};
  for (const network::Node& node : network.nodes()) {
    const auto* lever = node.module.as<network::TorqueArm>();
    if (lever != nullptr && lever->hand() == network::Hand::first) {
      record.lever_torque = lever->felt();
    }
    const auto* handle = node.module.as<network::SixAxes>();
    if (handle == nullptr) continue;
    const bool is_first = handle->hand() == network::Hand::first;
    (is_first ? record.grip : record.second_grip) = network::to_wrench(handle->grip());
  }
}

Recorder::Recorder(std::size_t capacity) {
  records_.reserve(capacity);
}

void Recorder::add(const TickRecord& record) noexcept {
  if (records_.size() < records_.capacity()) {
    records_.push_back(record);
  } else {
    ++dropped_;
  }
}

void RunTotals::add(const TickRecord& r) noexcept {
  ++ticks;
  near += r.pairs.near;
  evaluated += r.pairs.evaluated;
  iterations += r.pairs.iterations;
  stale += r.pairs.stale;
  most_stale = std::max(most_stale, r.pairs.stale);
  oldest_age = std::max(oldest_age, r.pairs.oldest_age);
  refresh_energy += r.pairs.refresh_energy;
  if (r.pairs.nearest < nearest) {
    nearest = r.pairs.nearest;
    nearest_pair = r.pairs.nearest_pair;
  }
  deepest = std::max(deepest, r.pairs.deepest);
  peak_force = std::max(peak_force, r.virtual_force.force.norm());
  hold_margin = std::min(hold_margin, r.hold.margin);
  gaps_left_out += r.hold.left_out;
  for (unsigned bit = 0; bit < 32; ++bit) status_ticks[bit] += (r.status >> bit) & 1U;
  ++stop_ticks[static_cast<std::size_t>(r.stop)];
  brake_ticks += r.brakes ? 1 : 0;
  unsound += (r.status & status::unsound) != 0U ? 1 : 0;
  missing += r.elapsed - 1;
  workers = r.workers;
}

}  // namespace repel
