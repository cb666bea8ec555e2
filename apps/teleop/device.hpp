/// @file
/// The master that a person holds, by its name on the command line.
#pragma once

#include <memory>
#include <string>

namespace repel::devices {
class DeviceLink;
}

namespace repel::teleop {

struct Device {
  std::string name;  ///< for people; empty: none
  std::shared_ptr<devices::DeviceLink> link;
};

/// What is wrong with the name of a device; empty: nothing.
[[nodiscard]] std::string device_complaint(const std::string& text);

/// "spacenav", the mouse behind spacenavd, or "evdev:PATH", a motorised lever of the kernel.
/// @throws SetupError when it is not there, naming what to do
[[nodiscard]] Device open_device(const std::string& text);

}  // namespace repel::teleop
