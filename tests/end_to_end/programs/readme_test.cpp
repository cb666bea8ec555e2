// SPDX-License-Identifier: BSD-3-Clause
// The first program of README.md is the first example, byte for byte, and prints the output given
// there. Links of all pages are checked by tests/style/check.sh.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "end_to_end/folder.hpp"

namespace repel::test {
namespace readme_test {

/// The text between two marks, after position `from`.
std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const auto begin = text.find(from);
  if (begin == std::string::npos) return {};
  const auto first = begin + from.size();
  return text.substr(first, text.find(to, first) - first);
}

/// A code block of README.md without its indentation of four blanks.
std::string flush_left(const std::string& block) {
  std::istringstream lines(block);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    text += line.substr(std::min<std::size_t>(4, line.size())) + '\n';
  }
  return text;
}

TEST(Readme, FirstProgramIsTheFirstExampleByteForByte) {
  const std::string readme = text_of(REPEL_SOURCE "/README.md");
  std::string program = text_of(REPEL_SOURCE "/examples/01_two_boxes.cpp");
  ASSERT_FALSE(readme.empty()) << "README.md is missing";
  ASSERT_EQ(program.find("// SPDX-License-Identifier"), 0U);
  program.erase(0, program.find('\n') + 1);  // the licence, which README has at its end
  const std::string fence = "```cpp\n";
  const std::string first_line = program.substr(0, program.find('\n') + 1);
  const auto begin = readme.find(fence + first_line);
  ASSERT_NE(begin, std::string::npos) << "no ```cpp block begins with " << first_line;
  const auto code = begin + fence.size();
  const auto end = readme.find("```", code);
  ASSERT_NE(end, std::string::npos);
  EXPECT_EQ(readme.substr(code, end - code), program);
}

// Regression: it printed (-0 -0 1) as the extraction direction, with any compiler, where README has
// (0 0 1).
TEST(Readme, FirstProgramPrintsWhatStandsThere) {
  const Folder folder;
  const std::string readme = text_of(REPEL_SOURCE "/README.md");
  const std::string program = between(readme, "```cpp\n", "```");
  const std::string command = between(readme, "```\n\n    g++ ", "\n");
  const std::string said = flush_left(between(readme, "prints\n\n", "\n\nThe core"));
  ASSERT_NE(command.find(" -I core -I /usr/include/eigen3 examples/01_two_boxes.cpp "),
            std::string::npos);
  ASSERT_EQ(std::count(said.begin(), said.end(), '\n'), 5) << said;
  const std::string options = command.substr(0, command.find(" -I"));
  const std::string source = folder.with("main.cpp", program);
  const auto run = [](const std::string& line) { return std::system(line.c_str()); };
  ASSERT_EQ(run(REPEL_COMPILER " " + options + " -I '" REPEL_SOURCE "/core' -I '" REPEL_EIGEN "' " +
                source + " -o " + (folder / "two_boxes")),
            0);
  ASSERT_EQ(run((folder / "two_boxes") + " >" + (folder / "out")), 0);
  EXPECT_EQ(text_of(folder / "out"), said);
}

}  // namespace readme_test
}  // namespace repel::test
