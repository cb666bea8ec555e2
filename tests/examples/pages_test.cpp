// SPDX-License-Identifier: BSD-3-Clause
// Code that the pages of adapters and examples show is theirs.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace repel::test {
namespace pages_test {

/// The lines of a text, each without its indentation.
std::string flush_left(std::istream& text) {
  std::string out;
  for (std::string line; std::getline(text, line);) {
    const auto first = line.find_first_not_of(' ');
    out += (first == std::string::npos ? "" : line.substr(first)) + '\n';
  }
  return out;
}

/// The fenced blocks of C++ in a page.
std::vector<std::string> blocks_of(const std::string& page) {
  std::vector<std::string> blocks;
  std::size_t at = 0;
  while ((at = page.find("```cpp\n", at)) != std::string::npos) {
    at += 7;
    const std::size_t end = page.find("```", at);
    blocks.push_back(page.substr(at, end - at));
    at = end + 3;
  }
  return blocks;
}

class PagesOfAdapters : public testing::TestWithParam<std::string> {};

TEST_P(PagesOfAdapters, ShowTheCompiledCode) {
  std::string sources;
  for (const auto& file : std::filesystem::directory_iterator("examples/adapters/" + GetParam())) {
    std::ifstream source(file.path());
    sources += flush_left(source);
  }
  std::ifstream page("docs/own_controller/" + GetParam() + ".md");
  const std::vector<std::string> blocks = blocks_of(flush_left(page));
  EXPECT_GE(blocks.size(), 3U);
  for (const std::string& block : blocks) {
    EXPECT_NE(sources.find(block), std::string::npos) << block;
  }
}

TEST(Pages, ShowTheExampleWithTheLiveView) {
  std::ifstream source("examples/05_own_view.cpp");
  const std::string code = flush_left(source);
  std::ifstream page("docs/own_view.md");
  const std::vector<std::string> blocks = blocks_of(flush_left(page));
  EXPECT_EQ(blocks.size(), 3U);
  for (const std::string& block : blocks) {
    EXPECT_NE(code.find(block), std::string::npos) << block;
  }
}

INSTANTIATE_TEST_SUITE_P(Adapters, PagesOfAdapters,
                         testing::Values("torque_callback", "update_loop", "position_servo"));

}  // namespace pages_test
}  // namespace repel::test
