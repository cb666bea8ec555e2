// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/columns.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace repel {
namespace columns_test {

struct Columns {
  std::vector<JointType> joints{JointType::revolute, JointType::prismatic};
  std::vector<std::string> modules{"kbb2"};

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    const TickRecord none;
    for_each_field(
        [&]<class Value>(const TickField& field, const Value& /*x*/) {
          for (std::string& name : ColumnNames{joints, modules}.of<Value>(field))
            all.push_back(std::move(name));
        },
        none);
    return all;
  }
  [[nodiscard]] std::vector<double> values(const TickRecord& record) const {
    std::vector<double> all;
    for_each_value(record, joints.size(), modules.size(),
                   [&all](const auto& x) { all.push_back(static_cast<double>(x)); });
    return all;
  }
};

// A column that lacked its value would shift all behind it.
TEST(Columns, EachNameHasTheValueOfItsPlace) {
  const Columns columns;
  TickRecord record;
  record.v_WT = Vec3(1, 2, 3);
  record.q = {4.0, 5.0};
  record.energy = {6.0F};
  record.torques = {7.0, 8.0};
  record.hold.margin = 9.0;
  const std::vector<std::string> names = columns.names();
  const std::vector<double> values = columns.values(record);
  ASSERT_EQ(values.size(), names.size());
  const auto value_of = [&](const char* name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1.0 : values[static_cast<std::size_t>(found - names.begin())];
  };
  EXPECT_EQ(value_of("vz_m_s"), 3.0);
  EXPECT_EQ(value_of("q1_rad"), 4.0);
  EXPECT_EQ(value_of("q2_m"), 5.0) << "one that slides";
  EXPECT_EQ(value_of("energy_kbb2_j"), 6.0);
  EXPECT_EQ(value_of("tau2_n"), 8.0);
  EXPECT_EQ(value_of("hold_margin_m"), 9.0) << "the last";
}

TEST(Columns, NoNameStandsTwice) {
  std::vector<std::string> names = Columns{}.names();
  const std::size_t count = names.size();
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  EXPECT_EQ(names.size(), count);
  EXPECT_GT(count, 20U);
}

}  // namespace columns_test
}  // namespace repel
