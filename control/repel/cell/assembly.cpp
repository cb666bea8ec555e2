// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/assembly.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/cell/default_network.hpp>
#include <repel/cell/robot_end.hpp>
#include <repel/cell/settled_laws.hpp>
#include <repel/loop/gain_check.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>

namespace repel::detail {

CellAssembly::CellAssembly(CellDescription description)
    : description_(std::move(description)),
      period_(std::llround(1e9 / checked("rate", description_.rate_hz, 1.0, 1e5, "Hz"))),
      clock_(period_, std::chrono::nanoseconds::max()),
      world_(description_.limits, description_.measure) {
  if (description_.arms.empty()) throw SetupError("the cell has no arm; allowed: 1 or more");
  lay_out();
  add_controls();
  check();
  start_coprocessor();
}

void CellAssembly::sense(std::span<const ArmReadings> readings,
                         std::chrono::nanoseconds now) noexcept {
  // Moving obstacles follow the clock, so skipped ticks are counted.
  (void)clock_.step(now);
  if (ticks_ > 0) periods_ += clock_.elapsed();
  ++ticks_;
  const double time = 1e-9 * static_cast<double>(period_.count()) * static_cast<double>(periods_);
  changes_->apply(world_, *coprocessor_, changes_per_tick());
  world_.advance(1e-9 * static_cast<double>(period_.count() * clock_.elapsed()));
  for (const MovingBody& moving : moving_) (void)moving.place(world_, time);
  for (std::size_t i = 0; i < controls_.size(); ++i) {
    controls_[i].sense(i < readings.size() ? readings[i] : ArmReadings{}, now);
  }
  world_.carry();
  forces_ = &coprocessor_->exchange();
  contacts_->collect(*coprocessor_);
  hard_->collect(*coprocessor_, reaction());
}

std::span<const TickRecord* const> CellAssembly::act(
    std::span<const network::Command> hands) noexcept {
  for (std::size_t i = 0; i < controls_.size(); ++i) {
    records_[i] = &controls_[i].act(*forces_, coprocessor_->workers(),
                                    {contacts_->all(), hard_->all(), hard_->left_out()},
                                    i < hands.size() ? hands[i] : silent_);
  }
  return records_;
}

void CellAssembly::rehearse() noexcept {
  for (Teleoperator& control : controls_) control.rehearse();
  coprocessor_->rehearse();
}

const Teleoperator& CellAssembly::control(std::size_t arm) const noexcept {
  return controls_[arm];
}

double CellAssembly::leverage(PairId id) const {
  return repel::leverage(world_, layouts_, world_.pair(id).a, world_.pair(id).b);
}

double CellAssembly::withstood(PairId id) const noexcept {
  double most = 0.0;
  for (const Teleoperator& control : controls_) {
    most = std::max(most, control.barrier().withstood(id));
  }
  return most;
}

int CellAssembly::changes_per_tick() const noexcept {
  return static_cast<int>(std::clamp<std::int64_t>(period_.count() / 400'000, 1, 64));
}

double CellAssembly::reaction() const noexcept {
  double longest = 0.0;
  for (const auto& each : controls_) longest = std::max(longest, each.barrier().reaction());
  return longest;
}

void CellAssembly::lay_out() {
  raised_ = settle_laws(description_);
  reduce_shapes();
  for (ArmDescription& arm : description_.arms) {
    start(arm);
    layouts_.push_back(add_arm(world_, arm));
  }
  std::vector<PartId> obstacles;
  for (const ObstacleDescription& obstacle : description_.obstacles) {
    obstacles.push_back({static_cast<std::int32_t>(world_.parts().size())});
    const auto moving = add_obstacle(world_, obstacle, layouts_);
    if (moving) moving_.push_back(*moving);
  }
  for (const LooseDescription& loose : description_.loose) {
    loose_.push_back(add_loose(world_, description_, loose, layouts_, obstacles));
  }
  for (std::size_t second = 1; second < layouts_.size(); ++second) {
    for (const PartId b : layouts_[second].parts) {
      for (std::size_t first = 0; first < second; ++first) {
        for (const PartId a : layouts_[first].parts) {
          add_pair(world_, layouts_, a, b, description_.arms[second].law);
        }
      }
    }
  }
  for (std::size_t i = 0; i < layouts_.size(); ++i) {
    add_own_pairs(world_, description_.arms[i], layouts_[i]);
  }
}

void CellAssembly::reduce_shapes() {
  if (!description_.levels) return;
  checked("levels", *description_.levels, 1.0, ReductionOptions::most_levels, "");
  std::vector<Shape*> shapes;
  for (ArmDescription& arm : description_.arms) {
    for (ArmPart& part : arm.parts) shapes.push_back(&part.shape);
  }
  for (ObstacleDescription& each : description_.obstacles) shapes.push_back(&each.shape);
  for (LooseDescription& each : description_.loose) shapes.push_back(&each.shape);
  const bool needed = std::any_of(shapes.begin(), shapes.end(), [this](const Shape* shape) {
    return needs_levels(*shape, description_.measure);
  });
  if (!needed) return;
  for (Shape* shape : shapes) {
    ReductionOptions reduction = shape->reduction();
    if (reduction.levels == *description_.levels) continue;
    reduction.levels = *description_.levels;
    *shape = shape->reduced(reduction);
  }
}

void CellAssembly::add_controls() {
  for (std::size_t i = 0; i < layouts_.size(); ++i) {
    ArmDescription& arm = description_.arms[i];
    require_inertia(arm);
    arm.options.push_out = description_.start_inside == StartInside::push_out;
    controls_.emplace_back(TeleoperatorParts{arm.model, *arm.kinematics, world_, layouts_[i].tool,
                                             layouts_[i].links, built_network(arm)},
                           period_, arm.options);
    records_.push_back(nullptr);
    require_fitting_sensor(arm, controls_.back().network());
  }
}

network::Network CellAssembly::built_network(const ArmDescription& arm) const {
  const network::Plan plan = arm.network ? *arm.network : default_network(arm.model);
  const double period = 1.0 / description_.rate_hz;
  std::optional<network::PredictionOptions> prediction;
  if (arm.options.prediction) prediction.emplace().drive_delay = arm.options.drive_delay;
  try {
    return plan.build(period, prediction, robot_end(arm, period));
  } catch (const SetupError& error) {
    throw SetupError(std::string("network: ") + error.what());
  }
}

void CellAssembly::require_inertia(const ArmDescription& arm) {
  ArmInertia inertia(arm.model);
  const bool is_sound = inertia.update(*arm.kinematics);
  if (inertia.missing() < 0) {
    if (!is_sound) throw SetupError(named(arm) + ": " + unsound_mass);
    return;
  }
  throw SetupError("joint '" +
                   arm.model.links[static_cast<std::size_t>(inertia.missing())].joint_name +
                   "' moves no mass where the arm starts; allowed: links with mass and inertia, a "
                   "rotor_inertia, or kinematics with a mass_matrix");
}

void CellAssembly::check() {
  for (const ArmDescription& arm : description_.arms) {
    Jacobian J(6, static_cast<Eigen::Index>(arm.model.links.size()));
    arm.kinematics->tool_jacobian(J);
    if (!std::all_of(J.data(), J.data() + J.size(), [](double x) { return x - x == 0.0; })) {
      throw SetupError(named(arm) + ": its tool_jacobian is not finite at the start");
    }
    device_damping_ = std::min(device_damping_, repel::device_damping(arm.model, J));
  }
  check_stiffness();
  const std::vector<std::string> inside = overlaps(world_);
  if (description_.start_inside == StartInside::refuse) require_clear_start(inside);
  warnings_.insert(warnings_.end(), inside.begin(), inside.end());
}

void CellAssembly::check_stiffness() {
  try {
    warnings_ =
        check_gains(world_, 1.0 / description_.rate_hz, wall_delay(description_), device_damping_,
                    description_.gain_check, longest_response(description_));
    warnings_.insert(warnings_.end(), raised_.begin(), raised_.end());
  } catch (const SetupError& error) {
    throw SetupError(
        std::string("wall too stiff: ") + error.what() +
        " (to run all the same: 'gain_check: warning', in a scene at its obstacle module)");
  }
}

void CellAssembly::start_coprocessor() {
  CoprocessorOptions options = description_.coprocessor;
  options.period = period_;
  coprocessor_.emplace(world_, options);
  std::vector<BodyId> moved;
  for (const ArmLayout& layout : layouts_) {
    moved.push_back(layout.tool);
    for (const LinkBody& link : layout.links) moved.push_back(link.body);
  }
  changes_.emplace(world_, most_changes, description_.levels.value_or(ReductionOptions{}.levels));
  contacts_.emplace(world_, std::min<std::size_t>(world_.pairs().size(), 4096), moved);
  hard_.emplace(world_, moved);
}

}  // namespace repel::detail
