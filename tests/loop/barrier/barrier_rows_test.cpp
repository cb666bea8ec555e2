// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/barrier_rows.hpp>

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <vector>

#include "loop/slider.hpp"

namespace repel {
namespace barrier_rows_test {

constexpr BodyId tool{1};

HardContact against_x(double gap, double rate) {
  HardContact contact;
  contact.pair = {0};
  contact.a = tool;
  contact.b = World::fixed;
  contact.on_a.force = Vec3(-1, 0, 0);
  contact.on_b.force = Vec3(1, 0, 0);
  contact.gap = gap;
  contact.rate = rate;
  return contact;
}

struct Rails {
  Rails() {
    model = test::slider_model(1000.0);
    for (ArmLink& link : model.links) link.velocity_limit = 0.5;
    jacobian.topRows<3>().setIdentity();
  }
  std::vector<BarrierRow> gather(std::span<const HardContact> contacts, std::array<double, 3> q,
                                 std::array<double, 3> v, std::array<double, 3> untold = {}) {
    BarrierRows rows(model, 1e-3);
    rows.gather(contacts, tool, jacobian, ArmBodies({}, 3), q, v, untold, 0.02);
    return {rows.all().begin(), rows.all().end()};
  }
  ArmModel model;
  Jacobian jacobian = Jacobian::Zero(6, 3);
};

TEST(BarrierRows, HaveTheTorquesThatOpenAGapAndWhatOthersDoToIt) {
  Rails rails;
  const auto rows = rails.gather(std::array{against_x(0.01, -0.3)}, {}, {0.2, 0.1, 0.0});
  ASSERT_EQ(rows.size(), 1U) << "the rails are far from their ends, and slow";
  EXPECT_EQ(rows[0].h.coeff(0), -1.0);
  EXPECT_EQ(rows[0].h.coeff(1), 0.0);
  EXPECT_NEAR(rows[0].gap, 0.009, 1e-12) << "less the margin";
  EXPECT_NEAR(rows[0].others, -0.1, 1e-12) << "the wall comes at 0.1 m/s";
}

TEST(BarrierRows, LeaveOutWhatIsOfAnotherArm) {
  Rails rails;
  HardContact contact = against_x(0.01, -0.3);
  contact.a = {7};
  EXPECT_TRUE(rails.gather(std::array{contact}, {}, {}).empty());
}

TEST(BarrierRows, HaveTheEndsOfTheJointsAndTheirGreatestSpeeds) {
  Rails rails;
  const std::array<double, 3> q{9.5, 0.0, -9.7};
  EXPECT_TRUE(rails.gather({}, q, {0.0, -0.6, 0.0}).empty()) << "no wall is near";
  const auto all = rails.gather(std::array{against_x(0.01, 0.0)}, q, {0.0, -0.6, 0.0});
  ASSERT_EQ(all.size(), 4U);
  const auto rows = std::span(all).subspan(1);
  EXPECT_NEAR(rows[0].gap, 0.5, 2e-3);
  EXPECT_EQ(rows[0].h.coeff(0), -1.0);
  EXPECT_NEAR(rows[1].top_speed, 0.65, 1e-12);
  EXPECT_EQ(rows[1].h.coeff(1), 1.0);
  EXPECT_NEAR(rows[2].gap, 0.3, 2e-3);
  EXPECT_EQ(rows[2].h.coeff(2), 1.0);
  for (const BarrierRow& row : rows) EXPECT_FALSE(row.pair.valid());
}

TEST(BarrierRows, AreThoseThatCloseFirstWhereThereAreTooMany) {
  Rails rails;
  std::vector<HardContact> contacts;
  for (int i = 0; i < 100; ++i) contacts.push_back(against_x(1e-3 * (100 - i), 0.0));
  const auto rows = rails.gather(contacts, {}, {});
  ASSERT_EQ(rows.size(), BarrierRows::most);
  for (const BarrierRow& row : rows) EXPECT_LT(row.gap, 0.064);
}

}  // namespace barrier_rows_test
}  // namespace repel
