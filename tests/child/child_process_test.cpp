// SPDX-License-Identifier: BSD-3-Clause
// Work in a child process: its result is returned, its crash or endless loop is contained.
#include "../../backends/child/child_process.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>

#include "../../backends/child/parcel.hpp"
#include "end_to_end/folder.hpp"

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

TEST(ChildProcess, HandsOnFileAndLineOfAnError) {
  const struct {
    const char* file;
    int line;
    const char* what;
  } cases[] = {
      {"a.sdf", 8, "a.sdf:8: no corner"}, {"a.sdf", 0, "a.sdf: no corner"}, {"", 0, "no corner"}};
  for (const auto& [file, line, what] : cases) {
    try {
      (void)result_of_child([&]() -> std::string { throw SetupError("no corner", file, line); },
                            {});
      FAIL() << "accepted";
    } catch (const SetupError& error) {
      EXPECT_EQ(error.file(), file);
      EXPECT_EQ(error.line(), line);
      EXPECT_STREQ(error.what(), what);
    }
  }
}

std::string refusal_of_file(const std::string& path) {
  try {
    return result_of_file(path, "mesh", 1, [] { return std::string("accepted"); });
  } catch (const SetupError& error) {
    return error.what();
  }
}

// A file that is not there once had 18446744073709551615 bytes.
TEST(ChildProcess, ReadsNothingButAFile) {
  const test::Folder folder;
  EXPECT_EQ(refusal_of_file(folder.with("a.stl", "solid")), "accepted");
  EXPECT_EQ(refusal_of_file(folder / "no.stl"),
            "mesh '" + folder / "no.stl" + "' is not there; allowed: an existing file");
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {folder / ".", pipe, std::string("/dev/zero")}) {
    EXPECT_EQ(refusal_of_file(path), "mesh '" + path + "' is no file; allowed: an existing file");
  }
}

TEST(Parcel, ComesAsItWasPacked) {
  Parcel parcel;
  parcel.put(7);
  parcel.put_list(std::string("words"));
  parcel.put_list(std::vector<double>{0.5, -0.25});
  parcel.put_list(std::string());
  const std::string bytes = parcel.take();
  Unpacking unpacking(bytes);
  EXPECT_EQ(unpacking.take<int>(), 7);
  EXPECT_EQ(unpacking.take_list<std::string>(), "words");
  EXPECT_EQ(unpacking.take_list<std::vector<double>>(), (std::vector<double>{0.5, -0.25}));
  EXPECT_EQ(unpacking.take_list<std::string>(), "");
  EXPECT_THROW((void)unpacking.take<char>(), SetupError);
}

TEST(Parcel, WhoseLengthsAreWrongIsRefused) {
  for (const std::size_t count : {std::size_t{3}, std::size_t{1} << 61U, ~std::size_t{0}}) {
    Parcel parcel;
    parcel.put(count);
    parcel.put(0.5);
    parcel.put(0.25);
    const std::string bytes = parcel.take();
    EXPECT_THROW((void)Unpacking(bytes).take_list<std::vector<double>>(), SetupError) << count;
  }
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
