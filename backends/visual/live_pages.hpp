// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Sends the state of a run, or of several in a row, to the pages of the live view, and receives
/// their commands.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <repel/loop/tap.hpp>
#include <repel/visual/controls.hpp>
#include <repel/visual/messages.hpp>
#include <repel/visual/server.hpp>

#include "page_input.hpp"

namespace repel::visual {

/// Reads the tap and forwards the commands of the pages to the controls. One page at a time drives.
class LivePages final : public PageHandler {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param device name of the master that drives whenever no page does; empty: none
  /// @param pages_drive false: pages may only watch
  LivePages(const SceneInfo& info, const World& world, Tap& tap, Controls& controls,
            const std::string& device, bool pages_drive);

  void opened(int page, Role role, Pages& pages) override;
  void heard(int page, std::string_view text, Pages& pages) override;
  void closed(int page, Pages& pages) override;
  void refresh(Pages& pages) override;
  /// Just after the tick taking the next picture: serving a page during a tick would cost that tick
  /// cycles and cache; between two ticks it costs nothing.
  [[nodiscard]] std::optional<Clock::time_point> next_refresh() const override;

 private:
  static constexpr int nobody = 0;

  /// Each executes the message; empty, or why it is refused.
  [[nodiscard]] std::string obey(int page, const std::string& type, const nlohmann::json& message,
                                 Pages& pages);
  [[nodiscard]] std::string drive(int page, const std::string& type, const nlohmann::json& message);
  [[nodiscard]] std::string change(const std::string& type, const nlohmann::json& message,
                                   Pages& pages);
  [[nodiscard]] std::string conduct(const std::string& type, const nlohmann::json& message);
  /// Why the page may not drive, pause, step or restart; empty: it may.
  [[nodiscard]] std::string bar_of(int page) const;
  void hand_over(Driver driver, int page);
  void post();
  void say_who_drives(Pages& pages) const;
  void read_samples();
  void watch_driver(Pages& pages);

  SceneInfo info_;
  World world_;  ///< the initial world: names and shapes
  Tap& tap_;
  Controls& controls_;
  std::string device_;
  bool pages_drive_;
  std::string greeting_;
  std::chrono::nanoseconds period_;
  Timing timing_;
  std::vector<TickSample> recent_;  ///< since the last picture was sent
  std::map<int, Role> open_pages_;
  /// Of the parts with another shape: boxes from pages, and parts seen by a camera.
  std::map<std::int32_t, Shape> reshaped_;
  PageInput input_;
  Driver driver_;
  int page_ = nobody;  ///< the page that drives
  bool silent_ = false;
  bool was_running_ = true;
  bool has_picture_ = false;
  Clock::time_point heard_;
  Clock::time_point shown_;
  Clock::time_point next_timing_;
};

}  // namespace repel::visual
