// SPDX-License-Identifier: BSD-3-Clause
#include "small.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include <repel/reduction/shape.hpp>
#include <repel/schedule/coprocessor.hpp>

#include "../distance/measurement.hpp"
#include "../distance/program.hpp"

namespace repel::scale {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int tool_parts = 4;
constexpr int pairs = 32;

/// A method that executes a tick of the task.
class Contender {
 public:
  explicit Contender(std::string who) { run_.who = std::move(who); }
  virtual ~Contender() = default;
  virtual void tick(std::size_t tick) = 0;
  /// Number of wrong distances of the last tick.
  [[nodiscard]] virtual int wrong(std::size_t tick) = 0;
  [[nodiscard]] virtual int evaluated() const { return pairs; }
  [[nodiscard]] virtual double range() const { return std::numeric_limits<double>::infinity(); }

  void time(std::size_t at) {
    const Clock::time_point start = Clock::now();
    tick(at);
    ns_.push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count());
    run_.evaluated += evaluated();
  }
  void check(const bench::CheckedTask& task, std::size_t at) {
    tick(at);
    run_.wrong += wrong(at);
    for (std::size_t pair = 0; pair < pairs; ++pair) {
      run_.near += task.truth({pair, at}).distance < range() ? 1.0 : 0.0;
    }
    ++checked_;
  }
  [[nodiscard]] SmallRun result() {
    std::sort(ns_.begin(), ns_.end());
    run_.p50 = ns_[ns_.size() / 2];
    run_.p99 = ns_[ns_.size() * 99 / 100];
    run_.evaluated /= static_cast<double>(ns_.size());
    run_.near /= checked_;
    return run_;
  }

 private:
  SmallRun run_;
  std::vector<double> ns_;
  int checked_ = 0;
};

bool is_off(double distance, double truth) {
  return !(std::abs(distance - truth) <= 1e-6 * std::abs(truth));
}

class Ours final : public Contender {
 public:
  Ours(const std::string& who, const bench::CheckedTask& task, double range)
      : Contender(who),
        task_(task),
        range_(range),
        world_(world_of(task.task, range)),
        coprocessor_(world_, {}) {}

  void tick(std::size_t tick) override {
    ++world_.motion().tick;
    world_.place({1}, task_.task.X_W[tick][0], {});
    forces_ = &coprocessor_.exchange();
  }
  int wrong(std::size_t tick) override {
    int count = 0;
    for (std::int32_t pair = 0; pair < pairs; ++pair) {
      const double truth = task_.truth({static_cast<std::size_t>(pair), tick}).distance;
      if (truth < range_ && is_off(coprocessor_.separation_of({pair}).distance, truth)) ++count;
    }
    return count;
  }
  [[nodiscard]] int evaluated() const override { return forces_->totals.evaluated; }
  [[nodiscard]] double range() const override { return range_; }

 private:
  static World world_of(const bench::Task& task, double range) {
    World world;
    const std::vector<Pose>& X_W = task.X_W.front();
    const BodyId tool = world.add_body("tool", X_W[0]);
    for (std::size_t i = 0; i < task.solids.size(); ++i) {
      const bench::Solid& s = task.solids[i];
      const Shape shape = s.box ? Shape::box(s.half_extents) : Shape::hull(s.vertices);
      const bool is_tool = i < tool_parts;
      world.add_part(is_tool ? tool : World::fixed, "part", shape,
                     is_tool ? Pose(X_W[0].inverse() * X_W[i]) : X_W[i]);
    }
    for (const bench::Pair& pair : task.pairs) {
      world.add_pair({static_cast<std::int32_t>(pair.a)}, {static_cast<std::int32_t>(pair.b)},
                     {.range = range});
    }
    return world;
  }

  const bench::CheckedTask& task_;
  double range_;
  World world_;
  Coprocessor coprocessor_;
  const PairForces* forces_ = nullptr;
};

class Theirs final : public Contender {
 public:
  Theirs(const bench::Library& library, const bench::CheckedTask& task)
      : Contender(library.name), task_(task), rival_(library.load(task.task, library.tolerance)) {}

  void tick(std::size_t tick) override {
    rival_->run(std::span(task_.asks).subspan(pairs * tick, pairs), bench::Start::warm);
  }
  int wrong(std::size_t tick) override {
    int count = 0;
    for (std::size_t pair = 0; pair < pairs; ++pair) {
      const bench::Ask ask{pair, tick};
      const double distance = rival_->answer(ask, bench::Start::warm).distance;
      count += is_off(distance, task_.truth(ask).distance) ? 1 : 0;
    }
    return count;
  }

 private:
  const bench::CheckedTask& task_;
  std::unique_ptr<bench::Rival> rival_;
};

/// [m] Distance below which, on average, `near` of the distances of a tick lie.
double range_for(const bench::CheckedTask& task, double near) {
  std::vector<double> distances;
  for (const bench::Truth& truth : task.truths) distances.push_back(truth.distance);
  std::sort(distances.begin(), distances.end());
  return distances[static_cast<std::size_t>(near * static_cast<double>(task.task.ticks()))];
}

}  // namespace

std::vector<SmallRun> small_runs(int rounds, const std::vector<std::string>& rivals) {
  const bench::CheckedTask task(bench::make_task("tick", rounds < 10));
  std::vector<std::unique_ptr<Contender>> contenders;
  contenders.push_back(std::make_unique<Ours>("repel, every pair near", task, 100.0));
  contenders.push_back(std::make_unique<Ours>("repel, 3 near", task, range_for(task, 3.0)));
  for (const bench::Library& library : bench::libraries()) {
    if (!library.gaps || !bench::is_chosen(rivals, library.name)) continue;
    contenders.push_back(std::make_unique<Theirs>(library, task));
  }
  for (std::size_t tick = 0; tick < task.task.ticks(); ++tick) {
    for (const auto& contender : contenders) contender->check(task, tick);
  }
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = task.task.ticks() - 1; i-- > 0;) {
      for (const auto& contender : contenders) contender->time(i);
    }
    for (std::size_t i = 1; i < task.task.ticks(); ++i) {
      for (const auto& contender : contenders) contender->time(i);
    }
  }
  std::vector<SmallRun> runs;
  for (const auto& contender : contenders) runs.push_back(contender->result());
  return runs;
}

}  // namespace repel::scale
