// SPDX-License-Identifier: BSD-3-Clause
#include "live_pages.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

#include <repel/common/json_fields.hpp>
#include <repel/visual/page_command.hpp>

namespace repel::visual {
namespace {

using Json = nlohmann::json;
using fields::number;
using fields::text;
using fields::vector;

const char* to_word(Driver driver, bool replay) {
  if (replay) return "recording";
  switch (driver) {
    case Driver::script:
      return "script";
    case Driver::page:
      return "page";
    case Driver::device:
      return "device";
    case Driver::nobody:
      break;
  }
  return "nobody";
}

}  // namespace

LivePages::LivePages(const SceneInfo& info, const World& world, Tap& tap, Controls& controls,
                     const std::string& device, bool pages_drive)
    : info_(info),
      world_(world),
      tap_(tap),
      controls_(controls),
      device_(device),
      pages_drive_(pages_drive),
      greeting_(scene_message(info, world)),
      period_(std::llround(1e9 / info.rate_hz)),
      input_(info_.arms.front()),
      driver_(device.empty() ? Driver::script : Driver::device) {}

void LivePages::opened(int page, Role role, Pages& pages) {
  open_pages_[page] = role;
  pages.send(page, greeting_);
  if (!reshaped_.empty()) pages.send(page, parts_message(reshaped_));
  say_who_drives(pages);
  pages.send(page, timing_message(timing_));
  if (!has_picture_) return;
  pages.send(page, frame_message(info_, world_, tap_.pictures().newest(), {}, !controls_.paused));
}

void LivePages::closed(int page, Pages& pages) {
  open_pages_.erase(page);
  say_who_drives(pages);  // if it was driving, watch_driver handles its silence
}

void LivePages::heard(int page, std::string_view said, Pages& pages) {
  const Json message = Json::parse(said, nullptr, false);
  if (message.is_discarded() || !message.is_object()) {
    return pages.send(page,
                      Json{{"type", "refused"}, {"what", ""}, {"why", "no JSON object"}}.dump());
  }
  const std::string type = text(message, "type");
  const Driver driver = driver_;
  const int driving = page_;
  const std::string why = obey(page, type, message, pages);
  if (!why.empty()) {
    // The page may have sent invalid UTF-8.
    pages.send(page, Json{{"type", "refused"}, {"what", type}, {"why", why}}.dump(
                         -1, ' ', true, Json::error_handler_t::replace));
  }
  if (driver != driver_ || driving != page_) say_who_drives(pages);
}

std::string LivePages::obey(int page, const std::string& type, const Json& message, Pages& pages) {
  std::string bar = bar_of(page);
  if (!bar.empty()) return bar;
  if (page_ != nobody && page_ != page) return "another page has the controls";
  if (type == "take" || type == "release" || PageInput::knows(type))
    return drive(page, type, message);
  if (type == "add_box" || type == "move_part" || type == "remove_part")
    return change(type, message, pages);
  return conduct(type, message);
}

std::string LivePages::bar_of(int page) const {
  if (!pages_drive_ && !device_.empty()) return device_ + " has the controls: pages look on only";
  if (!pages_drive_) return "pages look on only";
  const auto found = open_pages_.find(page);
  if (found == open_pages_.end() || found->second == Role::looks_on)
    return "a program without an Origin or a secret looks on only";
  return {};
}

std::string LivePages::drive(int page, const std::string& type, const Json& message) {
  if (info_.replay) return "this is a recording";
  if (!controls_.no_driving.empty()) return controls_.no_driving;
  if (type == "take") {
    hand_over(Driver::page, page);
    return {};
  }
  if (page_ != page) return "take the controls first";
  if (type == "release") {
    hand_over(device_.empty() ? Driver::nobody : Driver::device, nobody);
    return {};
  }
  std::string why = input_.take(type, message, Clock::now());
  if (!why.empty()) return why;
  post();
  heard_ = Clock::now();
  return {};
}

/// A box in one of the spare parts of the scene: it comes, moves or goes.
std::string LivePages::change(const std::string& type, const Json& message, Pages& pages) {
  if (info_.replay) return "this is a recording";
  if (!controls_.no_conduct.empty()) return controls_.no_conduct;
  if (!controls_.may_change) return "a recording is being written, which has no room for this";
  if (info_.spare.empty()) return "the scene has no spare parts";
  const auto position = vector(message, "position", 1e3);
  if (type == "add_box") {
    const auto size = vector(message, "size", 1e3);
    if (!position || !size || size->minCoeff() < 1e-3) return out_of_range;
    const Shape box = Shape::box(0.5 * *size, {.levels = 1});
    PartId id;
    const bool comes = controls_.changes.with([&](WorldChanges& changes) {
      id = changes.add(box, Pose(Eigen::Translation3d(*position)));
      return id.valid();
    });
    if (!comes) return "no spare part is free, or has room for it";
    reshaped_.insert_or_assign(id.index, box);
    pages.send_all(part_message(id, box));
    return {};
  }
  const auto named = number(message, "part", 1e6);
  const PartId id{named ? static_cast<std::int32_t>(*named) : -1};
  if (reshaped_.count(id.index) == 0) return "no such box";
  if (type == "move_part") {
    if (!position) return out_of_range;
    const bool moves = controls_.changes.with([&](WorldChanges& changes) {
      return changes.move(id, Pose(Eigen::Translation3d(*position)));
    });
    return moves ? std::string() : "too many changes at once";
  }
  const bool goes =
      controls_.changes.with([&](WorldChanges& changes) { return changes.remove(id); });
  if (!goes) return "too many changes at once";
  reshaped_.erase(id.index);
  return {};
}

std::string LivePages::conduct(const std::string& type, const Json& message) {
  const bool conducts = type == "pause" || type == "resume" || type == "step" || type == "restart";
  if (conducts && !controls_.no_conduct.empty()) return controls_.no_conduct;
  if (type == "pause" || type == "resume") {
    controls_.steps = 0;
    controls_.paused = type == "pause";
  } else if (type == "step") {
    const auto ticks = number(message, "ticks", 10000.0);
    if (!ticks || *ticks < 1.0 || *ticks != std::floor(*ticks)) return out_of_range;
    controls_.paused = true;
    controls_.steps += static_cast<std::int64_t>(*ticks);
  } else if (type == "restart" && !controls_.may_restart) {
    return controls_.no_driving.empty() ? "a log is being written, which begins once"
                                        : controls_.no_driving;
  } else if (type == "restart") {
    input_.forget();
    if (driver_ != Driver::device)
      hand_over(device_.empty() ? Driver::script : Driver::device, nobody);
    controls_.steps = 0;
    controls_.paused = false;
    controls_.restart = true;
    timing_ = {};
    reshaped_.clear();
  } else if (type == "seek" && info_.replay) {
    const auto time = number(message, "time_s", 1e9);
    if (!time || *time < 0.0) return out_of_range;
    // A time beyond the last tick would never be reached.
    controls_.seek = std::min(*time, info_.duration - 1.0 / info_.rate_hz);
  } else if (type == "speed" && info_.replay) {
    const auto factor = number(message, "factor", 100.0);
    if (!factor || *factor < 0.01) return out_of_range;
    controls_.speed = *factor;
  } else {
    return info_.replay ? "no such message" : "no such message for a live run";
  }
  return {};
}

void LivePages::hand_over(Driver driver, int page) {
  driver_ = driver;
  page_ = page;
  silent_ = false;
  heard_ = Clock::now();
  input_.rest(driver);
  post();
}

void LivePages::post() {
  controls_.input.draft() = input_.of(Clock::now());
  controls_.input.post();
}

void LivePages::say_who_drives(Pages& pages) const {
  for (const auto& [page, role] : open_pages_) {
    const std::string bar = bar_of(page);
    pages.send(page, Json{{"type", "operator"},
                          {"by", to_word(driver_, info_.replay)},
                          {"you", page == page_},
                          {"name", device_},
                          {"silent", silent_},
                          {"looks_on", !bar.empty()},
                          {"why_not", bar},
                          {"no_conduct", controls_.no_conduct},
                          {"pages", pages.count()}}
                         .dump(-1, ' ', false, Json::error_handler_t::replace));
  }
}

void LivePages::read_samples() {
  for (const TickSample* sample = tap_.samples().front(); sample != nullptr;
       sample = tap_.samples().front()) {
    timing_.add(sample->times, period_);
    // At most 1000 samples; a page that has just opened needs no history.
    if (recent_.size() < 1000) recent_.push_back(*sample);
    tap_.samples().pop();
  }
  timing_.dropped = tap_.samples().dropped();
}

void LivePages::watch_driver(Pages& pages) {
  const bool was_silent = silent_;
  if (driver_ == Driver::device) {
    const Status status = tap_.pictures().newest().arms.front().status;
    silent_ = (status & status::silent_device) != 0U;
  }
  if (page_ != nobody) {
    const double unheard = std::chrono::duration<double>(Clock::now() - heard_).count();
    silent_ = unheard > PageCommand::silent_after;
    if (unheard > PageCommand::silent_after + 2.0)
      hand_over(device_.empty() ? Driver::nobody : Driver::device, nobody);
  }
  if (silent_ != was_silent) say_who_drives(pages);
}

void LivePages::refresh(Pages& pages) {
  read_samples();
  watch_driver(pages);
  const std::map<std::int32_t, Shape> seen = controls_.shapes.take();
  for (const auto& [part, shape] : seen) reshaped_.insert_or_assign(part, shape);
  if (!seen.empty() && pages.count() > 0) pages.send_all(parts_message(seen));
  const bool running = !controls_.paused;
  const bool is_new = tap_.pictures().take();
  const auto now = Clock::now();
  has_picture_ = has_picture_ || is_new;
  // Repeated every 200 ms while nothing happens: a page that was busy may have missed the last.
  const bool is_due = running != was_running_ || now > shown_ + std::chrono::milliseconds(200);
  if (is_new || (has_picture_ && is_due)) {
    was_running_ = running;
    shown_ = now;
    if (pages.count() > 0) {
      pages.show(frame_message(info_, world_, tap_.pictures().newest(), recent_, running));
    }
    recent_.clear();
  }
  if (now < next_timing_) return;
  next_timing_ = now + std::chrono::milliseconds(500);
  const std::map<std::string, DepthView> depths = controls_.depths.take();
  if (pages.count() == 0) return;
  pages.send_all(timing_message(timing_));
  for (const auto& [camera, view] : depths) pages.send_all(depth_message(camera, view));
}

std::optional<LivePages::Clock::time_point> LivePages::next_refresh() const {
  using std::chrono::nanoseconds;
  // The tap takes a picture in the first tick that ends at least this long after the last picture.
  const nanoseconds spacing =
      (TapOptions{}.picture_period + period_ - nanoseconds(1)) / period_ * period_;
  const nanoseconds behind = std::min(nanoseconds(200000), period_ / 8);
  const Clock::time_point now = Clock::now();
  const Clock::time_point due = tap_.pictures().newest().made + spacing + behind;
  if (due > now) return due;
  const nanoseconds late = now - due;
  if (late > std::chrono::seconds(1)) return std::nullopt;  // no pictures: default rate
  return due + (late / period_ + 1) * period_;
}

}  // namespace repel::visual
