// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/default_network.hpp>

#include <gtest/gtest.h>

#include "loop/slider.hpp"

namespace repel {
namespace default_network_test {

TEST(DefaultNetwork, EndsInTheArmAndBringsTheWallsToToolAndLinks) {
  const network::Network network = default_network(test::slider_model(1000.0)).build(0.0025);
  EXPECT_EQ(network.find<network::PumaJoints>()->size(), 3);
  int tool = 0;
  int links = 0;
  for (const network::Node& node : network.nodes()) {
    tool += node.traits.walls == network::Walls::tool ? 1 : 0;
    links += node.traits.walls == network::Walls::links ? 1 : 0;
  }
  EXPECT_EQ(tool, 1);
  EXPECT_EQ(links, 1);
}

}  // namespace default_network_test
}  // namespace repel
