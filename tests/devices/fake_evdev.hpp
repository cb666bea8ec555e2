// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A fake evdev device: answers the ioctls of the lever and records what is written to it.
#pragma once

#include <linux/input.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include <devices/fake_clock.hpp>
#include <repel/devices/evdev_port.hpp>

namespace repel::devices {

/// The fake device; must outlive the port that the lever owns.
struct FakeWheel {
  input_absinfo axis{
      .value = 0, .minimum = -1000, .maximum = 1000, .fuzz = 0, .flat = 0, .resolution = 0};
  bool has_axis = true;
  bool has_force = true;
  bool has_gain = true;
  bool has_button = true;
  bool button_down = false;
  bool gone = false;

  std::vector<std::byte> waiting;  // unread input
  std::vector<int> levels;         // one for each EVIOCSFF
  std::vector<input_event> told;   // written by the lever
  int clock = -1;
  int erased = -1;  // id of the erased effect

  [[nodiscard]] int level() const { return levels.empty() ? 0 : levels.back(); }

  void say(std::uint16_t type, std::uint16_t code, std::int32_t value) {
    const auto microseconds =
        std::chrono::duration_cast<std::chrono::microseconds>(FakeClock::now()).count();
    input_event event{};
    event.input_event_sec = microseconds / 1000000;
    event.input_event_usec = microseconds % 1000000;
    event.type = type;
    event.code = code;
    event.value = value;
    const auto bytes = std::as_bytes(std::span(&event, 1));
    waiting.insert(waiting.end(), bytes.begin(), bytes.end());
  }
  void turn(std::int32_t counts) {
    axis.value = counts;
    say(EV_ABS, ABS_X, counts);
    say(EV_SYN, SYN_REPORT, 0);
  }
  void push(bool down) {
    button_down = down;
    say(EV_KEY, BTN_TRIGGER, down ? 1 : 0);
    say(EV_SYN, SYN_REPORT, 0);
  }
};

class FakePort final : public EvdevPort {
 public:
  explicit FakePort(std::shared_ptr<FakeWheel> wheel) : wheel_(std::move(wheel)) {}

  int control(unsigned long request, void* argument) noexcept override {
    if (wheel_->gone) return -ENODEV;
    if (_IOC_NR(request) == _IOC_NR(EVIOCSFF) && _IOC_DIR(request) == _IOC_WRITE) {
      return take_effect(*static_cast<ff_effect*>(argument));
    }
    if (request == EVIOCSCLOCKID) {
      wheel_->clock = *static_cast<int*>(argument);
    } else if (request == EVIOCGABS(ABS_X)) {
      *static_cast<input_absinfo*>(argument) = wheel_->axis;
    } else {
      return answer_bits(request,
                         std::span(static_cast<unsigned char*>(argument), _IOC_SIZE(request)));
    }
    return 0;
  }
  int control_number(unsigned long request, long argument) noexcept override {
    if (wheel_->gone) return -ENODEV;
    if (request != EVIOCRMFF) return -EINVAL;
    wheel_->erased = static_cast<int>(argument);
    return 0;
  }
  long read(std::span<std::byte> bytes) noexcept override {
    if (wheel_->gone) return -ENODEV;
    if (wheel_->waiting.empty()) return -EAGAIN;
    const std::size_t count = std::min(bytes.size(), wheel_->waiting.size());
    const auto end = wheel_->waiting.begin() + static_cast<std::ptrdiff_t>(count);
    std::copy(wheel_->waiting.begin(), end, bytes.begin());
    wheel_->waiting.erase(wheel_->waiting.begin(), end);
    return static_cast<long>(count);
  }
  long write(std::span<const std::byte> bytes) noexcept override {
    if (wheel_->gone) return -ENODEV;
    input_event event{};
    std::memcpy(&event, bytes.data(), std::min(bytes.size(), sizeof event));
    wheel_->told.push_back(event);
    return static_cast<long>(bytes.size());
  }
  void wait(std::chrono::milliseconds /*wait*/) noexcept override {}

 private:
  static constexpr std::int16_t effect_id = 3;

  int take_effect(ff_effect& effect) noexcept {
    if (effect.type != FF_CONSTANT || (effect.id != -1 && effect.id != effect_id)) return -EINVAL;
    effect.id = effect_id;
    wheel_->levels.push_back(effect.u.constant.level);
    return 0;
  }

  int answer_bits(unsigned long request, std::span<unsigned char> bytes) noexcept {
    const auto set = [&](int bit, bool on) {
      if (on) bytes[static_cast<std::size_t>(bit / 8)] |= static_cast<unsigned char>(1 << bit % 8);
    };
    if (_IOC_NR(request) == _IOC_NR(EVIOCGBIT(0, 0))) {
      for (const int type : {EV_SYN, EV_KEY, EV_ABS, EV_FF}) set(type, true);
    } else if (_IOC_NR(request) == _IOC_NR(EVIOCGBIT(EV_ABS, 0))) {
      set(ABS_X, wheel_->has_axis);
    } else if (_IOC_NR(request) == _IOC_NR(EVIOCGBIT(EV_FF, 0))) {
      set(FF_CONSTANT, wheel_->has_force);
      set(FF_GAIN, wheel_->has_gain);
      set(FF_AUTOCENTER, true);
    } else if (_IOC_NR(request) == _IOC_NR(EVIOCGBIT(EV_KEY, 0))) {
      set(BTN_TRIGGER, wheel_->has_button);
    } else if (_IOC_NR(request) == _IOC_NR(EVIOCGKEY(0))) {
      set(BTN_TRIGGER, wheel_->button_down);
    } else {
      return -EINVAL;
    }
    return static_cast<int>(bytes.size());
  }

  std::shared_ptr<FakeWheel> wheel_;
};

}  // namespace repel::devices
