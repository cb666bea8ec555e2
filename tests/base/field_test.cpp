// SPDX-License-Identifier: BSD-3-Clause
#include <repel/base/field.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace repel {
namespace field_test {

enum class Colour { red, green };

struct Paint {
  double drying_time = 1.0;  // [s]
  double share = 0.5;
  int coats = 2;
  Colour colour = Colour::red;

  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Field{"drying_time", "s", 0.0, 10.0, true}, o.drying_time);
    visit(Field{"share", "", 0.0, 1.0}, o.share);
    visit(Field{"coats", "", 1.0, 3.0}, o.coats);
    visit(Choice{"colour", {"red", "green"}}, o.colour);
  }
};

std::string complaint_of(const Paint& paint) {
  try {
    checked_fields(paint);
  } catch (const SetupError& error) {
    return error.what();
  }
  return {};
}

TEST(Field, ReturnsWhatIsInRange) {
  const Paint paint;
  EXPECT_EQ(&checked_fields(paint), &paint);
}

TEST(Field, NamesTheFirstNumberOutOfRange) {
  EXPECT_EQ(complaint_of({.drying_time = 11.0, .coats = 4}),
            "drying time is 11 s; allowed: 0 to 10 s");
  EXPECT_EQ(complaint_of({.share = -0.5}), "share is -0.5; allowed: 0 to 1");
  EXPECT_EQ(complaint_of({.coats = 4}), "coats is 4; allowed: 1 to 3");
}

TEST(Field, RefusesWhatIsNoNumber) {
  EXPECT_NE(complaint_of({.share = std::numeric_limits<double>::quiet_NaN()}), "");
}

TEST(Field, LeavesOnlyAGainToTheArm) {
  const double automatic = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(complaint_of({.drying_time = automatic}), "");
  EXPECT_NE(complaint_of({.share = automatic}), "");
}

}  // namespace field_test
}  // namespace repel
