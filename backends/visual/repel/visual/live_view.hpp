// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The live view as a part of a program: its pages, and their commands.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include <repel/cell/cell.hpp>
#include <repel/cell/layout.hpp>
#include <repel/loop/tap.hpp>
#include <repel/visual/controls.hpp>
#include <repel/visual/messages.hpp>
#include <repel/visual/page_command.hpp>
#include <repel/visual/run_view.hpp>

namespace repel::visual {

/// The description of a cell for pages: names, bodies and joints of its arms. To be added by the
/// program: `visuals`, the speeds of the masters, and the switches of a hand.
[[nodiscard]] inline SceneInfo scene_info_of(const Cell& cell, std::string name) {
  SceneInfo info;
  info.scene = std::move(name);
  info.rate_hz = cell.description().rate_hz;
  for (std::size_t i = 0; i < cell.arms(); ++i) {
    const ArmDescription& described = cell.description().arms[i];
    ArmInfo& arm = info.arms.emplace_back();
    arm.name = described.name;
    arm.tool = cell.layout(i).tool;
    for (const LinkBody& link : cell.layout(i).links) arm.links.push_back(link.body);
    arm.links_of_model = described.model.links;
    for (const ArmLink& link : described.model.links) {
      arm.joints.emplace_back(link.type == JointType::revolute ? "revolute" : "prismatic");
    }
    for (const network::Node& node : cell.network(i).nodes()) {
      // A prediction is not one of those that were asked for, and the last.
      if (node.module.as<network::Prediction>() == nullptr) arm.modules.push_back(node.name);
    }
  }
  return info;
}

/// The live view of a cell ticked by your program:
///
///     visual::LiveView view(cell, visual::scene_info_of(cell, "my cell"), {.pages_drive = true});
///     for (;;) {                                    // your thread, your clock
///       const network::Command* page = view.command();
///       const TickRecord& tick = cell.step({q, v}, page != nullptr ? *page : hands, now);
///       view.show(tick, {late, compute});
///     }
///
/// Pages drive the first arm. They cannot pause, step or restart it, nor change its parts. `show`
/// and `command` are for the thread of the tick: they do not allocate, wait, make system calls or
/// throw.
class LiveView {
 public:
  /// @param cell must outlive this object
  /// @throws SetupError as RunView
  LiveView(const Cell& cell, const SceneInfo& info, const ViewOptions& options = {})
      : cell_(&cell),
        tap_(cell.world(), {.arms = static_cast<int>(cell.arms())}),
        page_(controls_),
        served_(info, cell.world(), tap_, controls_, options) {}
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;
  ~LiveView() = default;

  /// After a tick. Cost: four numbers, and 60 times a second a copy of poses, records and near
  /// pairs.
  /// @param arms what Cell::act returned @param times of the tick, for the histograms of the page
  void show(std::span<const TickRecord* const> arms, const TickTimes& times) noexcept {
    tap_.note(cell_->coprocessor(), arms, times);
  }
  /// The same of a cell with one arm. @param tick what Cell::step returned
  void show(const TickRecord& tick, const TickTimes& times) noexcept {
    const TickRecord* const arm = &tick;
    show({&arm, 1}, times);
  }

  /// Before a tick, or between its two halves: the command of the driving page, for the first arm;
  /// null: none drives, and your own operator counts. The rates of a silent page are zero after
  /// PageCommand::rest_after. From PageCommand::silent_after on it is reported silent, so the cell
  /// removes its force. Two seconds later it loses the controls.
  [[nodiscard]] const network::Command* command() noexcept {
    page_.hear(cell_->elapsed());
    if (page_.driver() != Driver::page) return nullptr;
    page_.write(cell_->X_WT(0).linear(), command_);
    return &command_;
  }

  /// A part has another shape from now on, for the pages. Takes a lock: not for the tick.
  void reshape(PartId part, const Shape& shape) { controls_.shapes.note(part.index, shape); }

  /// Where the page is: "http://127.0.0.1:8448/".
  [[nodiscard]] const std::string& url() const noexcept { return served_.url(); }

 private:
  /// Pages drive, and nothing else.
  struct DrivenOnly : Controls {
    DrivenOnly() {
      may_restart = may_change = false;
      no_conduct = "the program is not paused from here: it can be driven only";
    }
  };

  const Cell* cell_;
  Tap tap_;
  DrivenOnly controls_;
  PageCommand page_;
  network::Command command_;
  RunView served_;  // last member: its thread ends before what it uses is destroyed
};

}  // namespace repel::visual
