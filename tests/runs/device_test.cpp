// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>
#include <repel/network/elements/one_ports.hpp>
#include <repel/network/modules/six_axes.hpp>
#include <repel/network/plan.hpp>
#include <repel/runs/operator/device.hpp>

namespace repel::runs {
namespace device_test {

TEST(Device, IsNamedByItsKindAndWhereItIs) {
  for (const char* known : {"spacenav", "evdev:/dev/input/event3", "haply", "haply:ws://a:1"}) {
    EXPECT_EQ(device_complaint(known), "") << known;
  }
  for (const char* wrong : {"", "mouse", "evdev:", "haply:", "haply:localhost"}) {
    EXPECT_NE(device_complaint(wrong).find("allowed: spacenav"), std::string::npos) << wrong;
  }
}

network::Network held_with(double damping) {
  using network::any_size;
  return network::Plan()
      .add("six_axes", network::SixAxes({.hand_stiffness = 300.0, .hand_damping = damping}))
      .add("spring", network::Spring<any_size>(network::Mat<any_size>::Identity(6, 6)))
      .build(0.0025);
}

TEST(Device, LeadsNoGripThatItCannotKeepPassive) {
  Device device;
  EXPECT_NO_THROW(require_passive_grip(device, held_with(100.0))) << "it shows no force";
  device.name = "Inverse3";
  device.most_damping = 15.0;
  device.late = 0.003;
  EXPECT_NO_THROW(require_passive_grip(device, held_with(0.8)));
  EXPECT_NO_THROW(require_passive_grip(device, held_with(10.0)));
  for (const double damping : {0.0, 0.01, 20.0}) {
    try {
      require_passive_grip(device, held_with(damping));
      FAIL() << damping;
    } catch (const SetupError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("allowed: 0 to 15 N s/m"), std::string::npos) << text;
      EXPECT_NE(text.find("hand_damping: 0.825 N s/m"), std::string::npos) << text;
    }
  }
}

}  // namespace device_test
}  // namespace repel::runs
