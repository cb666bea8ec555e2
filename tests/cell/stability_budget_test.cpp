// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/stability_budget.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "cell/sliders.hpp"

namespace repel {
namespace stability_budget_test {

constexpr double T = 0.0025;
constexpr double mass = 5.0;

StabilityShare share_of(const Cell& cell, const std::string& source) {
  const std::vector<StabilityShare> all = stability_budget(cell, 0);
  const auto it = std::find_if(all.begin(), all.end(),
                               [&](const StabilityShare& share) { return share.source == source; });
  EXPECT_NE(it, all.end()) << source;
  return it == all.end() ? StabilityShare{} : *it;
}

TEST(StabilityBudget, HasEverySpringAndDamperByTheMassThatItMoves) {
  CellDescription description = test::sliders();
  description.arms[0].network =
      test::sliders_network({.stiffness = 3000.0, .damping = 150.0, .angular_stiffness = 60.0});
  const Cell cell(std::move(description));
  const ForceLaw& law = cell.world().pairs().front().law;
  const StabilityShare walls = share_of(cell, "walls");
  EXPECT_NEAR(walls.spring, law.stiffness() * T * T / mass, 1e-12);
  EXPECT_NEAR(walls.damper, law.damping * T / mass, 1e-12);
  EXPECT_NEAR(walls.needed_damping, 0.5 * law.stiffness() * T / law.damping, 1e-12);
  const StabilityShare coupling = share_of(cell, "coupling");
  EXPECT_NEAR(coupling.spring, 3000.0 * T * T / mass, 1e-12);
  EXPECT_NEAR(coupling.damper, 150.0 * T / mass, 1e-12);
  EXPECT_EQ(share_of(cell, "coupling, turning").spring, 0.0) << "rails do not turn";
  for (const char* joint : {"x", "y", "z"}) {
    const StabilityShare limits = share_of(cell, std::string("limits of ") + joint);
    EXPECT_NEAR(limits.spring, network::JointLimits{}.stiffness * T * T / mass, 1e-12);
    EXPECT_GT(limits.needed_damping, 0.0);
    EXPECT_LE(limits.needed_damping, 1.0) << "their damping is raised";
  }
}

TEST(StabilityBudget, ALateDriveNeedsMoreDamping) {
  const auto needed = [](double delay) {
    CellDescription description = test::sliders();
    description.gain_check = network::GainCheck::warning;
    description.arms[0].options.drive_delay = delay;
    description.arms[0].network = test::sliders_network();
    return share_of(Cell(std::move(description)), "coupling").needed_damping;
  };
  EXPECT_NEAR(needed(2.0) / needed(0.0), 9.0, 1e-9) << "(0.5 + 2 d) / 0.5";
}

}  // namespace stability_budget_test
}  // namespace repel
