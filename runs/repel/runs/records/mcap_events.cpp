// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/records/mcap_events.hpp>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/runs/records/mcap_time.hpp>

namespace repel::runs::mcap {
namespace {

/// [s] A bit that is off for so long is over.
constexpr double longest_gap = 0.1;

// As the page of the live view says it.
constexpr std::pair<Status, const char*> words[] = {
    {status::bad_pose, "a pose was not a number: the arm brakes"},
    {status::bad_command, "the operator's input was not a number: the operator is let go"},
    {status::bad_joints, "the arm reported no proper joints: it brakes"},
    {status::clock_fault, "the clock stood still or ran back: the operator is let go"},
    {status::stale_pairs, "some pairs kept an old answer"},
    {status::late_result, "a worker did not answer in time"},
    {status::torque_limit, "a joint torque is at its limit"},
    {status::crowded_pairs, "more pairs are near than there is memory for"},
    {status::expired_pairs, "answers are too old: the operator is let go"},
    {status::silent_device, "the device is silent: the operator is let go"},
    {status::saturated, "the operator asks for more than the coupling gives"},
    {status::joint_limit, "a joint is at the end of its range"},
    {status::network_fault, "the network could not be solved: the operator is let go"},
    {status::speed_limit, "a joint is as fast as it may be"},
    {status::implausible_joints, "the joints reported cannot be true: the arm brakes"},
    {status::frozen_joints, "a joint reports the same although it moves: the arm brakes"},
    {status::clock_gap, "the loop stood still: the operator is let go"},
    {status::bad_torque, "a torque was not a number: gravity is held"},
    {status::torque_rate, "a torque changed as fast as it may"},
    {status::tool_speed, "the tool is as fast as it may be"},
    {status::arm_stopped, "the arm is stopped"},
    {status::pushed_out, "the arm is pushed out of what it started in"},
    {status::energy_gain, "the arm gains energy from its own control"},
    {status::bad_wrench, "the force sensor cannot be believed"},
    {status::hold_lost, "a hard wall cannot be held"},
    {status::silent_site, "the site is silent: this is what it told last"},
};

Level level_of(Status bit) {
  constexpr Status errors = status::unsound | status::hold_lost | status::silent_site;
  return (bit & errors) != 0U ? Level::error : Level::warning;
}

/// By Stop.
constexpr std::pair<Level, const char*> stops[] = {
    {Level::info, "running: the operator guides the arm"},
    {Level::warning, "holding: the operator is let go, walls remain"},
    {Level::error, "braking: the joint readings are not trusted"},
    {Level::error, "released: gravity is held, and no more"},
};

}  // namespace

nlohmann::json log_json(std::uint64_t now_ns, Level level, const std::string& name,
                        const std::string& message) {
  return {{"timestamp", time_json(now_ns)},
          {"level", static_cast<int>(level)},
          {"message", message},
          {"name", name},
          {"file", ""},
          {"line", 0}};
}

std::string words_of(Status bit) {
  const auto* const found = std::find_if(std::begin(words), std::end(words),
                                         [bit](const auto& each) { return each.first == bit; });
  return found == std::end(words) ? "" : found->second;
}

Events::Events(const Heading& heading) {
  for (const ArmHeading& arm : heading.arms) {
    arms_.push_back({.name = arm.name.empty() ? "arm" : arm.name, .phases = arm.phases});
  }
}

std::vector<nlohmann::json> Events::follow(const Snapshot& tick, std::uint64_t now_ns) {
  std::vector<nlohmann::json> events;
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    Arm& arm = arms_[i];
    const TickRecord& now = tick.arms[i];
    const auto add = [&](Level level, const std::string& message) {
      events.push_back(log_json(now_ns, level, arm.name, message));
    };
    if (now.phase != arm.phase) {
      const auto phase = static_cast<std::size_t>(now.phase);
      if (phase < arm.phases.size()) {
        add(Level::info, "phase: " + arm.phases[phase]);
      } else if (arm.phase >= 0) {
        add(Level::info, "no script plays any more");
      }
      arm.phase = now.phase;
    }
    for (unsigned place = 0; place < arm.bits.size(); ++place) {
      Bit& bit = arm.bits[place];
      const Status status = 1U << place;
      if ((now.status & status) != 0U) {
        if (!bit.is_on) {
          add(level_of(status), to_text(status) + ": " + words_of(status));
          bit = {.is_on = true, .since = now.time};
        }
        bit.last = now.time;
      } else if (bit.is_on && now.time - bit.last >= longest_gap) {
        add(Level::info,
            to_text(status) + " is over, after " + to_text(bit.last - bit.since, 3) + " s");
        bit.is_on = false;
      }
    }
    if (now.stop != arm.stop) {
      const auto& [level, message] = stops[static_cast<std::size_t>(now.stop)];
      add(level, message);
      arm.stop = now.stop;
    }
  }
  return events;
}

}  // namespace repel::runs::mcap
