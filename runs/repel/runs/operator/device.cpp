// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/operator/device.hpp>

#include <cmath>

#include <repel/base/setup_error.hpp>
#include <repel/network/modules/six_axes.hpp>
#include <repel/network/network.hpp>
#ifdef REPEL_RUNS_DEVICES
#include <repel/devices/device_thread.hpp>
#include <repel/devices/evdev_lever.hpp>
#include <repel/devices/haply_inverse.hpp>
#include <repel/devices/spacenav.hpp>
#endif

namespace repel::runs {
namespace {

constexpr const char* lever = "evdev:";
constexpr const char* haply = "haply:";

#ifdef REPEL_RUNS_DEVICES
template <class Master>
Device started(std::unique_ptr<Master> master) {
  const auto thread = std::make_shared<devices::DeviceThread<Master>>(std::move(master));
  return {std::string(thread->name()), thread, 0.0, 0.0};
}

Device open_haply(const std::string& url) {
  devices::HaplyInverseOptions options;
  if (!url.empty()) options.url = url;
  Device device = started(std::make_unique<devices::HaplyInverse>(options));
  device.most_damping = options.guard.most_damping;
  // Its state waits for the tick, the force for the next command, and that for its effect.
  device.late = 3.0 * options.period;
  return device;
}
#endif

}  // namespace

std::string device_complaint(const std::string& text) {
  const bool known = text == "spacenav" || text == "haply" ||
                     (text.starts_with(lever) && text != lever) ||
                     text.starts_with(std::string(haply) + "ws://");
  return known ? "" : "'" + text + "'; allowed: spacenav, evdev:PATH, haply, haply:ws://HOST:PORT";
}

Device open_device(const std::string& text) {
  if (text.empty()) return {};
#ifdef REPEL_RUNS_DEVICES
  if (text == "spacenav") return started(std::make_unique<devices::Spacenav>());
  if (text == "haply") return open_haply("");
  if (text.starts_with(haply)) return open_haply(text.substr(std::string_view(haply).size()));
  return started(
      std::make_unique<devices::EvdevLever>(text.substr(std::string_view(lever).size())));
#else
  throw SetupError("devices are not built in; to have them: apt-get install linux-libc-dev", text);
#endif
}

void require_passive_grip(const Device& device, const network::Network& network) {
  const auto* handle = network.find<network::SixAxes>();
  if (handle == nullptr || !(device.most_damping > 0.0)) return;
  const double needed = handle->device_damping(device.late)(0);
  if (needed <= device.most_damping) return;
  const double best = handle->best_grip_damping(device.late)(0);
  const auto shown = [](double damping) {
    return to_text(std::round(1e3 * damping) / 1e3) + " N s/m";
  };
  throw SetupError("network: the grip of six_axes needs a damping of " + shown(needed) +
                   " at the handle of " + device.name + "; allowed: 0 to " +
                   shown(device.most_damping) + ". It needs the least, " + shown(2.0 * best) +
                   ", with hand_damping: " + shown(best));
}

}  // namespace repel::runs
