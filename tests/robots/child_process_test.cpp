// SPDX-License-Identifier: BSD-3-Clause
// Work in a child process: its result is returned, its crash or endless loop is contained.
#include "../../robots/child_process.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel::detail {
namespace child_process_test {

std::string refusal(const std::function<std::string()>& work, const ChildLimits& limits = {}) {
  try {
    (void)result_of_child(work, limits);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ChildProcess, GivesItsResultByteByByte) {
  EXPECT_EQ(result_of_child([] { return std::string(); }, {}), "");
  std::string all(1'000'000, '\0');
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<char>(i * 7);
  EXPECT_EQ(result_of_child([&] { return all; }, {}), all);
}

TEST(ChildProcess, ChangesNothingHere) {
  int changed = 0;
  (void)result_of_child([&] { return std::to_string(++changed); }, {});
  EXPECT_EQ(changed, 0);
}

TEST(ChildProcess, HandsItsErrorOn) {
  EXPECT_EQ(refusal([]() -> std::string { throw SetupError("no corner"); }), "no corner");
  EXPECT_EQ(refusal([]() -> std::string { throw 7; }), "cannot be read");
}

TEST(ChildProcess, MayCrash) {
  for (const int number : {SIGSEGV, SIGABRT, SIGFPE}) {
    const std::string refused = refusal([&]() -> std::string {
      (void)raise(number);
      return "";
    });
    EXPECT_NE(refused.find("crashed"), std::string::npos) << refused;
  }
  EXPECT_NE(refusal([]() -> std::string { _Exit(0); }).find("crashed"), std::string::npos);
}

TEST(ChildProcess, MayNotGoOnForEver) {
  const std::string refused = refusal([]() -> std::string {
    for (volatile bool go = true; go;) continue;
    return "";
  });
  EXPECT_NE(refused.find("longer to read than allowed, 1 s"), std::string::npos) << refused;
}

TEST(ChildProcess, MayNotTakeAllMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__clang__)
  GTEST_SKIP() << "a sanitizer may reserve the address space";
#else
  const std::string refused = refusal(
      []() -> std::string {
        std::vector<std::string> all;
        while (true) all.emplace_back(10'000'000, 'x');
      },
      {.seconds = 10, .memory = 100'000'000});
  EXPECT_NE(refused.find("more memory than allowed, 100000000 bytes"), std::string::npos)
      << refused;
#endif
}

}  // namespace child_process_test
}  // namespace repel::detail
