// SPDX-License-Identifier: BSD-3-Clause
#include "secret.hpp"

#include <gtest/gtest.h>

namespace repel::visual {
namespace secret_test {

using Verdict = SecretKeeper::Verdict;
using std::chrono::seconds;

const std::string secret = "0123456789abcdef";
const SecretKeeper::Clock::time_point start{};

TEST(Secret, OnlyTheWholeOfItIsIt) {
  EXPECT_TRUE(is_same(secret, secret));
  for (const std::string& given :
       {std::string(), secret.substr(1), secret.substr(0, 15), secret + "0", secret + secret,
        std::string("0123456789abcdeF"), std::string("1123456789abcdef"), secret + '\0'}) {
    EXPECT_FALSE(is_same(given, secret)) << given;
  }
  EXPECT_FALSE(is_same("x", ""));
}

TEST(Secret, AfterFiveWrongOnesNothingIsComparedForAWhile) {
  SecretKeeper keeper(secret);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(keeper.judge("guess", "a", start), Verdict::wrong);
  EXPECT_EQ(keeper.judge("guess", "a", start), Verdict::too_many);
  EXPECT_EQ(keeper.judge(secret, "a", start), Verdict::too_many) << "or guessing would go on";
  EXPECT_EQ(keeper.judge(secret, "b", start), Verdict::right) << "another is not kept out";
  EXPECT_EQ(keeper.judge("guess", "a", start + seconds(2)), Verdict::wrong);
  EXPECT_EQ(keeper.judge(secret, "a", start + seconds(2)), Verdict::too_many);
  EXPECT_EQ(keeper.judge(secret, "a", start + seconds(4)), Verdict::right);
}

TEST(Secret, AnHourOfGuessingIsSomeThousandGuesses) {
  SecretKeeper keeper(secret);
  int compared = 0;
  for (int i = 0; i < 3600 * 10; ++i) {
    const auto now = start + i * std::chrono::milliseconds(100);
    compared += keeper.judge("guess", "a", now) == Verdict::wrong ? 1 : 0;
  }
  EXPECT_GT(compared, 1700);
  EXPECT_LT(compared, 1900);
}

TEST(Secret, WhoKnowsItIsNeverKeptOut) {
  SecretKeeper keeper(secret);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(keeper.judge(secret, "a", start), Verdict::right);
}

TEST(Secret, NetworksWithoutNumberDoNotLetTheLastGuessGoOn) {
  SecretKeeper keeper(secret);
  for (int i = 0; i < 10000; ++i) {
    (void)keeper.judge("guess", std::to_string(i), start + seconds(i));
  }
  const auto end = start + seconds(10000);
  for (int i = 0; i < 5; ++i) (void)keeper.judge("guess", "a", end);
  EXPECT_EQ(keeper.judge(secret, "a", end), Verdict::too_many);
}

TEST(Secret, WithoutOneNoneIsWanted) {
  EXPECT_FALSE(SecretKeeper("").is_wanted());
  EXPECT_TRUE(SecretKeeper(secret).is_wanted());
}

}  // namespace secret_test
}  // namespace repel::visual
