// SPDX-License-Identifier: BSD-3-Clause
#include <repel/base/setup_error.hpp>

#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <limits>
#include <locale>
#include <string>

namespace repel {
namespace setup_error_test {

std::string text_of_check(double value, double low, double high) {
  try {
    checked("radius", value, low, high, "m");
  } catch (const SetupError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(SetupError, NamesFileAndLineBeforeWhatIsWrong) {
  const SetupError error("half extent is -1 m", "cell.yaml", 12);
  EXPECT_STREQ(error.what(), "cell.yaml:12: half extent is -1 m");
  EXPECT_EQ(error.file(), "cell.yaml");
  EXPECT_EQ(error.line(), 12);
}

TEST(SetupError, LeavesOutThePlaceItDoesNotKnow) {
  EXPECT_STREQ(SetupError("no body", "cell.yaml").what(), "cell.yaml: no body");
  EXPECT_STREQ(SetupError("no body").what(), "no body");
  EXPECT_EQ(SetupError("no body").line(), 0);
}

TEST(SetupError, IsCaughtAsARuntimeError) {
  EXPECT_THROW(throw SetupError("no body"), std::runtime_error);
}

// A number without a unit had two spaces behind it.
TEST(SetupError, AUnitThatIsNoneLeavesNoSpace) {
  try {
    checked("levels", 99.0, 0.0, 8.0, "");
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_STREQ(error.what(), "levels is 99; allowed: 0 to 8");
  }
}

TEST(Checked, ReturnsWhatIsInTheRangeBoundsIncluded) {
  EXPECT_EQ(checked("radius", 0.0, 0.0, 2.0, "m"), 0.0);
  EXPECT_EQ(checked("radius", 0.5, 0.0, 2.0, "m"), 0.5);
  EXPECT_EQ(checked("radius", 2.0, 0.0, 2.0, "m"), 2.0);
}

TEST(Checked, NamesValueUnitAndRange) {
  EXPECT_EQ(text_of_check(2.5, 0.0, 2.0), "radius is 2.5 m; allowed: 0 to 2 m");
  EXPECT_EQ(text_of_check(-0.125, 0.0, 1e6), "radius is -0.125 m; allowed: 0 to 1e+06 m");
}

TEST(Checked, RefusesWhatIsNotFinite) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(text_of_check(std::numeric_limits<double>::quiet_NaN(), 0.0, 2.0),
            "radius is nan m; allowed: 0 to 2 m");
  EXPECT_EQ(text_of_check(inf, 0.0, 2.0), "radius is inf m; allowed: 0 to 2 m");
  EXPECT_EQ(text_of_check(-inf, 0.0, 2.0), "radius is -inf m; allowed: 0 to 2 m");
}

TEST(ToText, ReadsBackExactly) {
  for (const double value : {0.1, 1.0 / 3.0, 5e-324, -1.7976931348623157e308, 1e6}) {
    EXPECT_EQ(std::strtod(to_text(value).c_str(), nullptr), value) << to_text(value);
  }
  EXPECT_EQ(to_text(0.1), "0.1");
}

struct Commas : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(ToText, IsTheSameInEveryLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale(), new Commas));
  const std::string c_locale = std::setlocale(LC_NUMERIC, nullptr);
  std::setlocale(LC_NUMERIC, "de_DE.UTF-8");  // no effect if not installed
  EXPECT_EQ(to_text(1234.5), "1234.5");
  EXPECT_EQ(to_text(6.4425033420486075, 4), "6.443");
  EXPECT_EQ(to_text(123456.0, 4), "123500");
  EXPECT_EQ(to_text(50000.0, 4), "50000");
  EXPECT_EQ(text_of_check(2.5, 0.0, 2000.0) + text_of_check(2500.5, 0.0, 2000.0),
            "nothing was thrownradius is 2500.5 m; allowed: 0 to 2000 m");
  EXPECT_STREQ(SetupError("no body", "cell.yaml", 1200).what(), "cell.yaml:1200: no body");
  std::setlocale(LC_NUMERIC, c_locale.c_str());
  std::locale::global(before);
}

}  // namespace setup_error_test
}  // namespace repel
