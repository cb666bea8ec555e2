// SPDX-License-Identifier: BSD-3-Clause
// By hand: it takes a few calls of linux/input.h, for which libevdev would be one package more.
#include <repel/devices/evdev_lever.hpp>

#include <time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <system_error>
#include <thread>
#include <utility>

#include <repel/base/setup_error.hpp>

namespace repel::devices {
namespace {

constexpr int most_level = 32767;  // of ff_constant_effect::level

/// A bit set in the layout of the kernel.
template <int count>
class Bits {
 public:
  [[nodiscard]] void* data() noexcept { return bytes_.data(); }
  static constexpr int size = (count + 7) / 8;
  [[nodiscard]] bool has(int i) const noexcept {
    return i >= 0 && i < count && (bytes_[static_cast<std::size_t>(i / 8)] >> (i % 8) & 1) != 0;
  }

 private:
  std::array<std::uint8_t, size> bytes_{};
};

[[noreturn]] void fail(const std::string& name, std::initializer_list<std::string_view> what) {
  std::string text = name;
  text += ": ";
  for (const std::string_view part : what) text += part;
  throw SetupError(text);
}

/// An ioctl; throws SetupError if it fails.
void demand(EvdevPort& port, unsigned long request, void* argument, const std::string& name,
            std::string_view what) {
  const int result = port.control(request, argument);
  if (result >= 0) return;
  fail(name, {what, " is refused: ", std::generic_category().message(-result)});
}

/// Which events of a type the device has; none if it has not the type.
template <int count>
Bits<count> events_of(EvdevPort& port, int type, const std::string& name, std::string_view what) {
  Bits<EV_CNT> types;
  Bits<count> events;
  demand(port, EVIOCGBIT(0, Bits<EV_CNT>::size), types.data(), name, "the list of its events");
  if (types.has(type)) demand(port, EVIOCGBIT(type, Bits<count>::size), events.data(), name, what);
  return events;
}

/// The force effects that the device supports.
Bits<FF_CNT> forces_of(EvdevPort& port, const std::string& name) {
  return events_of<FF_CNT>(port, EV_FF, name, "the list of its forces");
}

void check_abilities(EvdevPort& port, const EvdevLeverOptions& options, const std::string& name) {
  const auto axes = events_of<ABS_CNT>(port, EV_ABS, name, "the list of its axes");
  const auto keys = events_of<KEY_CNT>(port, EV_KEY, name, "the list of its buttons");
  if (!axes.has(options.axis)) {
    fail(name, {"it has no absolute axis ", std::to_string(options.axis)});
  }
  const Bits<FF_CNT> forces = forces_of(port, name);
  if (!forces.has(FF_CONSTANT)) {
    fail(name, {"it cannot show a constant force (FF_CONSTANT): nothing could be felt by it"});
  }
  if (options.gain < 1.0 && !forces.has(FF_GAIN)) {
    fail(name, {"it has no gain (FF_GAIN); allowed: a gain of 1, the rest by a larger torque at "
                "full level"});
  }
  if (options.clutch != ClutchPolicy::always && !keys.has(options.clutch_button)) {
    fail(name, {"it has no button ", std::to_string(options.clutch_button), " for the clutch"});
  }
}

void check(const EvdevLeverOptions& options) {
  checked("full range", options.full_range, 0.01, 100.0, "rad");
  checked("time constant of the rate", options.rate_time_constant, 0.0, 1.0, "s");
  checked("largest rate", options.max_rate, 0.1, 1000.0, "rad/s");
  checked("torque at full level", options.torque_at_full_level, 0.001, 1000.0, "N m");
  checked("gain", options.gain, 0.0, 1.0, "of the strength of the device");
  checked("length of the direction", options.direction_W.norm(), 1e-6, 1e6, "m");
}

/// The scale of the axis, from the kernel and the options.
LeverScale scale_of(EvdevPort* port, const EvdevLeverOptions& options, const std::string& name) {
  if (port == nullptr) throw SetupError("an EvdevLever needs an open device");
  check(options);
  check_abilities(*port, options, name);
  input_absinfo info{};
  demand(*port, EVIOCGABS(static_cast<unsigned>(options.axis)), &info, name,
         "the range of its axis");
  if (info.minimum >= info.maximum) {
    fail(name, {"its axis ranges from ", std::to_string(info.minimum), " to ",
                std::to_string(info.maximum), "; the first must be smaller"});
  }
  return {.low = info.minimum,
          .high = info.maximum,
          .fuzz = info.fuzz,
          .full_range = options.full_range,
          .time_constant = options.rate_time_constant,
          .max_rate = options.max_rate};
}

std::string named(const std::string& path) {
  std::string name = "Lever on ";
  name += path;
  return name;
}

}  // namespace

EvdevLever::EvdevLever(const std::string& path, const EvdevLeverOptions& options)
    : EvdevLever(open_evdev(path), named(path), options) {}

EvdevLever::EvdevLever(std::unique_ptr<EvdevPort> port, const std::string& name,
                       const EvdevLeverOptions& options)
    : options_(options),
      port_(std::move(port)),
      name_(name),
      motion_(scale_of(port_.get(), options, name)),
      clutch_(options.clutch) {
  options_.direction_W.normalize();
  effect_.id = -1;  // none yet; the kernel assigns one
  int clock = CLOCK_MONOTONIC;
  demand(*port_, EVIOCSCLOCKID, &clock, name_, "the monotonic clock for its time stamps");
  read_state();
  if (lost_) fail(name_, {why_lost_});
  // A button that is already down does not count as a press: the clutch starts released.
  clutch_.reset();
  clutch_down_ = false;
  const Bits<FF_CNT> forces = forces_of(*port_, name_);
  if (forces.has(FF_GAIN)) tell(FF_GAIN, static_cast<int>(std::lround(0xFFFF * options.gain)));
  // A built-in centering spring would feel like a wall.
  if (forces.has(FF_AUTOCENTER)) tell(FF_AUTOCENTER, 0);
  effect_.type = FF_CONSTANT;
  effect_.direction = options.reverse_torque ? 0xC000 : 0x4000;
  demand(*port_, EVIOCSFF, &effect_, name_, "the constant force");
  tell(effect_.id, 1);
  if (lost_) fail(name_, {why_lost_});
}

EvdevLever::~EvdevLever() {
  set_level(0);
  if (lost_) return;
  tell(effect_.id, 0);
  (void)port_->control_number(EVIOCRMFF, effect_.id);
}

Measured EvdevLever::read(std::chrono::milliseconds wait) noexcept {
  if (lost_) {
    std::this_thread::sleep_for(
        std::clamp(wait, std::chrono::milliseconds(0), std::chrono::milliseconds(1000)));
  } else {
    port_->wait(wait);
    take_bytes();
  }
  Measured result = lost_ ? Measured::of_lost(why_lost_) : Measured::of_sound(clutch_.engaged());
  result.lever_direction_W = options_.direction_W;
  if (lost_) return result;
  if (result.clutch) {
    result.lever_rate = motion_.rate(options_.now());
  } else {
    set_level(0);  // no torque on a lever that the operator does not control
  }
  return result;
}

void EvdevLever::servo_cf(double lever_torque, const Wrench& /*tool_force*/) noexcept {
  const bool shows = clutch_.engaged() && std::isfinite(lever_torque);
  const double share = shows ? lever_torque / options_.torque_at_full_level : 0.0;
  set_level(static_cast<int>(std::lround(most_level * std::clamp(share, -1.0, 1.0))));
}

void EvdevLever::take_bytes() noexcept {
  constexpr int most_pieces = 16;  // 1024 events: bounds the time when a device floods
  std::array<std::byte, 64 * EvdevParser::event_size> bytes;
  for (int piece = 0; piece < most_pieces && !lost_; ++piece) {
    const long count = port_->read(bytes);
    if (count == -EAGAIN || count == -EINTR) return;
    if (count <= 0) return lose("the device is gone");
    const auto came = std::span(bytes).first(static_cast<std::size_t>(count));
    const bool sound = parser_.feed(came, [this](const EvdevEvent& event) { take(event); });
    if (!sound) return lose("the device sent what is no event");
  }
}

void EvdevLever::take(const EvdevEvent& event) noexcept {
  if (event.type == EV_SYN && event.code == SYN_DROPPED) {
    dropped_ = true;
  } else if (event.type == EV_SYN && event.code == SYN_REPORT) {
    if (dropped_) {
      dropped_ = false;
      return read_state();
    }
    clutch_.set(clutch_down_);
    motion_.move(counts_, event.time);
  } else if (event.type == EV_ABS && event.code == options_.axis) {
    counts_ = event.value;
  } else if (event.type == EV_KEY && event.code == options_.clutch_button) {
    clutch_down_ = event.value != 0;
  }
}

/// Reads the position of the lever and of the button, at the start and after events were lost.
void EvdevLever::read_state() noexcept {
  input_absinfo info{};
  Bits<KEY_CNT> keys;
  const unsigned axis = static_cast<unsigned>(options_.axis);
  if (port_->control(EVIOCGABS(axis), &info) < 0)
    return lose("the device does not say where it is");
  counts_ = info.value;
  motion_.place(counts_, options_.now());
  if (options_.clutch == ClutchPolicy::always) return;
  if (port_->control(EVIOCGKEY(Bits<KEY_CNT>::size), keys.data()) < 0) {
    return lose("the device does not say whether its button is down");
  }
  clutch_down_ = keys.has(options_.clutch_button);
  clutch_.set(clutch_down_);
}

void EvdevLever::set_level(int level) noexcept {
  if (lost_ || level == effect_.u.constant.level) return;
  effect_.u.constant.level = static_cast<std::int16_t>(level);
  if (port_->control(EVIOCSFF, &effect_) < 0) lose("the device does not take a force any more");
}

/// Writes one event to the device: starts or stops an effect, sets gain or auto-centering.
void EvdevLever::tell(int code, int value) noexcept {
  input_event event{};
  event.type = EV_FF;
  event.code = static_cast<std::uint16_t>(code);
  event.value = value;
  const long count = port_->write(std::as_bytes(std::span(&event, 1)));
  if (count < 0) lose("the device does not take a force");
}

void EvdevLever::lose(const char* why) noexcept {
  if (lost_) return;
  if (effect_.id >= 0) {  // in case it still works, it must not push
    effect_.u.constant.level = 0;
    (void)port_->control(EVIOCSFF, &effect_);
    (void)port_->control_number(EVIOCRMFF, effect_.id);
  }
  clutch_.reset();
  why_lost_ = why;
  lost_ = true;
}

}  // namespace repel::devices
