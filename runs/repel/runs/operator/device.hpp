// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Opens the input device of the operator, by its name on the command line.
#pragma once

#include <memory>
#include <string>

namespace repel::devices {
class DeviceLink;
}

namespace repel::network {
class Network;
}

namespace repel::runs {

struct Device {
  std::string name;  ///< display name; empty: none
  std::shared_ptr<devices::DeviceLink> link;
  /// [N s/m] most damping it adds against energy from the network into its handle; not above zero:
  /// no force feedback at a handle.
  double most_damping = 0.0;
  double late = 0.0;  ///< [s] from a motion of its handle to the force against it
};

/// What is wrong with a device name; empty: nothing.
[[nodiscard]] std::string device_complaint(const std::string& text);

/// "spacenav", the six-axis mouse behind spacenavd, "evdev:PATH", a motorised lever, or
/// "haply[:URL]", the Inverse3 behind its service.
/// @throws SetupError if it is not available, saying what to do
[[nodiscard]] Device open_device(const std::string& text);

/// Checks that a device leading the hand of SIX AXES can keep it passive
/// (docs/network/six_axes.md).
/// @throws SetupError, saying what the grip needs
void require_passive_grip(const Device& device, const network::Network& network);

}  // namespace repel::runs
