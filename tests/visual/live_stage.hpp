// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A live view without a server: the test sends and receives its messages directly.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "live_pages.hpp"
#include "pairs/boxes.hpp"
#include "support/web_page.hpp"

namespace repel::visual {

using Json = nlohmann::json;

/// Records the messages sent to each page.
class FakePages final : public Pages {
 public:
  void send(int page, std::string text) override { said_.emplace_back(page, Json::parse(text)); }
  void send_all(std::string text) override { said_.emplace_back(0, Json::parse(text)); }
  void show(std::string text) override { said_.emplace_back(0, Json::parse(text)); }
  [[nodiscard]] int count() const override { return open; }

  int open = 0;
  /// The messages sent to a page, or to all, since the last call.
  std::vector<Json> heard_by(int page) {
    std::vector<Json> all;
    std::vector<std::pair<int, Json>> rest;
    for (auto& [to, message] : said_) {
      if (to == page || to == 0) all.push_back(message);
      if (to != page) rest.emplace_back(to, std::move(message));
    }
    said_ = std::move(rest);
    return all;
  }

 private:
  std::vector<std::pair<int, Json>> said_;
};

inline const Json* last_of(const std::vector<Json>& messages, const char* type) {
  const Json* last = nullptr;
  for (const Json& message : messages) {
    if (message.at("type") == type) last = &message;
  }
  return last;
}

inline SceneInfo scene_info_of(BodyId tool, bool replay, std::vector<PartId> spare = {}) {
  SceneInfo info;
  info.scene = "stage";
  info.replay = replay;
  info.spare = std::move(spare);
  info.duration = replay ? 10.0 : 0.0;
  ArmInfo& arm = info.arms.emplace_back();
  arm.tool = tool;
  arm.joints = {"revolute"};
  return info;
}

/// A show with pages 1 to 3 open.
struct LiveStage {
  explicit LiveStage(bool replay = false, const std::string& device = "")
      : LiveStage(replay, device, device.empty()) {}
  LiveStage(bool replay, const std::string& device, bool pages_drive,
            std::vector<PartId> spare = {})
      : boxes(2, 3, {.range = 0.02}, 7),
        tap(boxes.world),
        show(scene_info_of(boxes.tool, replay, std::move(spare)), boxes.world, tap, controls,
             device, pages_drive) {
    for (int page = 1; page <= 3; ++page) {
      ++pages.open;
      show.opened(page, Role::drives, pages);
    }
    (void)pages.heard_by(1);
  }

  /// The reason for which the message was refused; empty if it was accepted.
  std::string say(int page, const std::string& text) {
    (void)pages.heard_by(page);
    show.heard(page, text, pages);
    const std::vector<Json> answers = pages.heard_by(page);
    for (const Json& answer : answers) {
      if (answer.at("type") == "refused") return answer.at("why").get<std::string>();
    }
    return {};
  }
  std::string say(int page, const Json& message) { return say(page, message.dump()); }

  /// A message was passed to the control loop.
  bool posted() { return controls.input.take(); }
  [[nodiscard]] const DriverInput& input() const { return controls.input.newest(); }

  /// Refreshes until the pages are told of such an operator; false on timeout.
  bool until_told(const std::function<bool(const Json&)>& such) {
    const auto until = std::chrono::steady_clock::now() + test::patience;
    while (std::chrono::steady_clock::now() < until) {
      show.refresh(pages);
      for (const Json& message : pages.heard_by(3)) {
        if (message.at("type") == "operator" && such(message)) return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }

  test::Boxes boxes;
  Tap tap;
  Controls controls;
  FakePages pages;
  LivePages show;
};

inline Json servo(double x, double y, double z, bool clutch = true) {
  return {{"type", "servo_cv"},
          {"linear", {x, y, z}},
          {"angular", {0, 0, 0}},
          {"frame", "world"},
          {"clutch", clutch}};
}

}  // namespace repel::visual
