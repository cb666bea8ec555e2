#include "device.hpp"

#include <repel/base/setup_error.hpp>
#ifdef REPEL_TELEOP_DEVICES
#include <repel/devices/device_thread.hpp>
#include <repel/devices/evdev_lever.hpp>
#include <repel/devices/spacenav.hpp>
#endif

namespace repel::teleop {
namespace {

constexpr const char* lever = "evdev:";

#ifdef REPEL_TELEOP_DEVICES
template <class Master>
Device started(std::unique_ptr<Master> master) {
  const auto thread = std::make_shared<devices::DeviceThread<Master>>(std::move(master));
  return {std::string(thread->name()), thread};
}
#endif

}  // namespace

std::string device_complaint(const std::string& text) {
  const bool known = text == "spacenav" || (text.starts_with(lever) && text != lever);
  return known ? "" : "'" + text + "'; allowed: spacenav, evdev:PATH";
}

Device open_device(const std::string& text) {
  if (text.empty()) return {};
#ifdef REPEL_TELEOP_DEVICES
  if (text == "spacenav") return started(std::make_unique<devices::Spacenav>());
  return started(
      std::make_unique<devices::EvdevLever>(text.substr(std::string_view(lever).size())));
#else
  throw SetupError("devices are not built in; to have them: apt-get install linux-libc-dev", text);
#endif
}

}  // namespace repel::teleop
