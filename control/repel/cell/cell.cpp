// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/cell.hpp>

#include <memory>
#include <utility>

#include <repel/cell/assembly.hpp>

namespace repel {

Cell::Cell(CellDescription description)
    : parts_(std::make_unique<detail::CellAssembly>(std::move(description))) {}
Cell::~Cell() = default;

const TickRecord& Cell::step(const ArmReadings& readings, const network::Command& hands,
                             std::chrono::nanoseconds now) noexcept {
  parts_->sense({&readings, 1}, now);
  return *parts_->act({&hands, 1}).front();
}

void Cell::sense(std::span<const ArmReadings> readings, std::chrono::nanoseconds now) noexcept {
  parts_->sense(readings, now);
}

std::span<const TickRecord* const> Cell::act(std::span<const network::Command> hands) noexcept {
  return parts_->act(hands);
}

void Cell::rehearse() noexcept {
  parts_->rehearse();
}

void Cell::stop() {
  parts_->stop();
}

const CellDescription& Cell::description() const noexcept {
  return parts_->description();
}

std::chrono::nanoseconds Cell::period() const noexcept {
  return parts_->period();
}

const World& Cell::world() const noexcept {
  return parts_->world();
}

World& Cell::world() noexcept {
  return parts_->world();
}

WorldChanges& Cell::changes() noexcept {
  return parts_->changes();
}

std::span<const PartId> Cell::loose() const noexcept {
  return parts_->loose();
}

const Coprocessor& Cell::coprocessor() const noexcept {
  return parts_->coprocessor();
}

std::size_t Cell::arms() const noexcept {
  return parts_->arms();
}

const ArmLayout& Cell::layout(std::size_t arm) const noexcept {
  return parts_->layout(arm);
}

const network::Network& Cell::network(std::size_t arm) const noexcept {
  return parts_->control(arm).network();
}

const Pose& Cell::X_WT(std::size_t arm) const noexcept {
  return parts_->control(arm).X_WT();
}

double Cell::elapsed() const noexcept {
  return parts_->control(0).elapsed();
}

const Teleoperator& Cell::control(std::size_t arm) const noexcept {
  return parts_->control(arm);
}

double Cell::leverage(PairId id) const {
  return parts_->leverage(id);
}

double Cell::withstood(PairId id) const noexcept {
  return parts_->withstood(id);
}

std::span<const MovingBody> Cell::moving() const noexcept {
  return parts_->moving();
}

double Cell::device_damping() const noexcept {
  return parts_->device_damping();
}

const std::vector<std::string>& Cell::warnings() const noexcept {
  return parts_->warnings();
}

}  // namespace repel
