/// @file
/// What the pages of the live view see and may do: one show for a run, or for several in a row.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <repel/loop/tap.hpp>
#include <repel/visual/messages.hpp>
#include <repel/visual/server.hpp>

#include "controls.hpp"

namespace repel::teleop {

/// Reads the tap and passes on what the pages say to the controls. One page at a time drives.
class LiveShow final : public visual::Show {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param device name of the master that has the controls whenever no page has; empty: none
  /// @param pages_drive false: they look on, whatever they ask for
  LiveShow(const visual::Cast& cast, const World& world, Tap& tap, Controls& controls,
           const std::string& device, bool pages_drive);

  void opened(int page, visual::Role role, visual::Pages& pages) override;
  void heard(int page, std::string_view text, visual::Pages& pages) override;
  void closed(int page, visual::Pages& pages) override;
  void beat(visual::Pages& pages) override;
  /// Just after the tick that makes the next picture: a page that is served while a tick is made
  /// costs it cycles and cache, and one that is served between two costs it nothing.
  [[nodiscard]] std::optional<Clock::time_point> next_beat() const override;

 private:
  static constexpr int nobody = 0;

  /// Each does what the message asks; empty, or why not.
  [[nodiscard]] std::string obey(int page, const std::string& type, const nlohmann::json& message);
  [[nodiscard]] std::string drive(int page, const std::string& type, const nlohmann::json& message);
  [[nodiscard]] std::string conduct(const std::string& type, const nlohmann::json& message);
  /// Why the page may not drive, pause, step or begin anew; empty: it may.
  [[nodiscard]] std::string bar_of(int page) const;
  void hand_over(Driver driver, int page);
  void say_who_drives(visual::Pages& pages) const;
  void read_samples();
  void watch_driver(visual::Pages& pages);

  visual::Cast cast_;
  const World& world_;
  Tap& tap_;
  Controls& controls_;
  std::string device_;
  bool pages_drive_;
  std::string greeting_;
  std::chrono::nanoseconds period_;
  visual::Timing timing_;
  std::vector<TickSample> recent_;  ///< since the last picture
  std::map<int, visual::Role> open_pages_;
  Driver driver_;
  int page_ = nobody;  ///< that drives
  bool silent_ = false;
  bool was_running_ = true;
  bool has_picture_ = false;
  Clock::time_point heard_;
  Clock::time_point shown_;
  Clock::time_point next_timing_;
};

}  // namespace repel::teleop
