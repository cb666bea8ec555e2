// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/station/site_twin.hpp>

#include <algorithm>
#include <limits>
#include <span>

#include <repel/cell/layout.hpp>

namespace repel::runs {
namespace {

/// What the site has started must not be refused here, and nothing here is in a hurry.
std::unique_ptr<PreparedRun> prepared_twin(scene::Scene scene, RunOptions options) {
  scene.network.gain_check = network::GainCheck::warning;
  scene.start_inside = StartInside::allow;
  options.threads = 0;
  return prepare(scene, options);
}

}  // namespace

void note(const StationSide& station, std::int64_t tick, const TickTimes& times,
          StationShot& shot) noexcept {
  const SiteState& site = station.site();
  shot.is_told = site.is_told;
  shot.times = times;
  TickRecord& record = shot.record;
  record.tick = tick;
  record.time = site.time;
  record.phase = station.phase();
  record.status = station.status();
  record.q = site.q;
  record.command = station.command();
  record.p_WT = site.X_WT.translation();
  record.v_WT = site.v_WT;
  record.virtual_force = site.virtual_force;
  record.coupling = site.coupling;
  // As for the device: the hand has let go of a robot that it does not hear.
  record.gain = station.is_heard() ? site.gain : 0.0;
  const bool is_near = site.is_told && site.nearest < 1e9;
  record.pairs.nearest = is_near ? site.nearest : std::numeric_limits<double>::infinity();
  note_masters(station.network(), record);
  std::size_t module = 0;
  for (const network::Node& node : station.network().nodes()) {
    record.energy[module++] = static_cast<float>(node.ledger.energy);
  }
  const auto part = static_cast<std::size_t>(site.part.part);
  if (site.part.part >= 0 && part < shot.parts.size()) shot.parts[part] = site.part;
}

SiteTwin::SiteTwin(const scene::Scene& scene, const RunOptions& options)
    : prepared_(prepared_twin(scene, options)), coprocessor_(prepared_->cell.world(), {}) {
  const std::vector<double>& start = prepared_->cell.description().arms.front().start;
  std::copy(start.begin(), start.end(), record_.q.begin());
}

StationShot SiteTwin::room() const {
  StationShot shot;
  shot.parts.resize(prepared_->scene.loose.size());
  return shot;
}

void SiteTwin::show(const StationShot& shot, Tap& tap) noexcept {
  const auto q = record_.q;
  record_ = shot.record;
  World& world = prepared_->cell.world();
  if (shot.is_told) {
    place_arm(shot.record);
    for (const MovingBody& moving : prepared_->cell.moving()) {
      (void)moving.place(world, shot.record.time);
    }
    for (const PartState& part : shot.parts) place_part(part);
  } else {
    record_.q = q;
  }
  ++world.motion().tick;
  const double nearest = record_.pairs.nearest;
  record_.pairs = coprocessor_.exchange().totals;
  record_.pairs.nearest = nearest;
  const TickRecord* const records[] = {&record_};
  tap.show(coprocessor_, records, shot.times);
}

void SiteTwin::place_arm(const TickRecord& told) noexcept {
  Cell& cell = prepared_->cell;
  const ArmDescription& arm = cell.description().arms.front();
  ArmKinematics& kinematics = *arm.kinematics;
  kinematics.update(std::span(told.q).first(arm.model.links.size()));
  (void)cell.world().place(cell.layout(0).tool, kinematics.X_WT(), {});
  for (const LinkBody& link : cell.layout(0).links) {
    (void)cell.world().place(link.body, kinematics.X_WL(link.link), {});
  }
}

void SiteTwin::place_part(const PartState& told) noexcept {
  if (told.part < 0) return;  // nothing was told of it yet
  Cell& cell = prepared_->cell;
  Motion& motion = cell.world().motion();
  const BodyId tool = cell.layout(0).tool;
  const BodyId id = cell.world().part(cell.loose()[static_cast<std::size_t>(told.part)]).body;
  BodyState& body = motion.bodies[static_cast<std::size_t>(id.index)];
  const bool is_there = told.where != PartState::Where::absent;
  const bool is_held = told.where == PartState::Where::is_held;
  if (is_there != body.presence.is_there() || is_held != body.arm.valid()) {
    // At once: the fading of its forces is the site's affair.
    const double there = is_there ? 1.0 : 0.0;
    const double grip = is_held ? 1.0 : -1.0;
    const std::int32_t came = is_there && !body.presence.is_there() ? 1 : 0;
    body.presence.generation += came;
    body.presence.there = {there, there, 0.0};
    body.presence.grip = {grip, grip, 0.0};
    body.presence.holder = body.arm = is_held ? tool : BodyId{};
    ++motion.changes;
  }
  if (!is_there) return;
  const Pose& X_WT = motion.bodies[static_cast<std::size_t>(tool.index)].X_WB;
  (void)cell.world().place(id, is_held ? X_WT * told.X : told.X, {});
}

}  // namespace repel::runs
