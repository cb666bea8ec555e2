/// @file
/// Opens the input device of the operator, by its name on the command line.
#pragma once

#include <memory>
#include <string>

namespace repel::devices {
class DeviceLink;
}

namespace repel::teleop {

struct Device {
  std::string name;  ///< display name; empty: none
  std::shared_ptr<devices::DeviceLink> link;
};

/// What is wrong with a device name; empty: nothing.
[[nodiscard]] std::string device_complaint(const std::string& text);

/// "spacenav", the six-axis mouse behind spacenavd, or "evdev:PATH", a motorised lever.
/// @throws SetupError if it is not available, saying what to do
[[nodiscard]] Device open_device(const std::string& text);

}  // namespace repel::teleop
