// The first program of README.md is the first example, byte for byte. Links of all pages are
// checked by tests/style/check.sh.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace repel {
namespace readme_test {

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Readme, FirstProgramIsTheFirstExampleByteForByte) {
  const std::string readme = text_of(REPEL_SOURCE "/README.md");
  const std::string program = text_of(REPEL_SOURCE "/examples/01_two_boxes.cpp");
  ASSERT_FALSE(readme.empty()) << "README.md is missing";
  ASSERT_FALSE(program.empty());
  const std::string fence = "```cpp\n";
  const std::string first_line = program.substr(0, program.find('\n') + 1);
  const auto begin = readme.find(fence + first_line);
  ASSERT_NE(begin, std::string::npos) << "no ```cpp block begins with " << first_line;
  const auto code = begin + fence.size();
  const auto end = readme.find("```", code);
  ASSERT_NE(end, std::string::npos);
  EXPECT_EQ(readme.substr(code, end - code), program);
}

}  // namespace readme_test
}  // namespace repel
