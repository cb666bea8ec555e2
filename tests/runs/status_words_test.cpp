// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/records/mcap_events.hpp>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include <repel/base/status.hpp>

namespace repel::runs {
namespace status_words_test {

// Who reads a recording reads what the page said, and every bit has words in both.
TEST(StatusWords, ThoseOfRecordingsAreThoseOfThePage) {
  std::ifstream file(REPEL_SOURCE "/backends/visual/page/words.js");
  const std::string page(std::istreambuf_iterator<char>(file), {});
  int bits = 0;
  for (unsigned k = 0; k < 32; ++k) {
    const Status bit = 1U << k;
    const std::string words = mcap::words_of(bit);
    if (words.empty()) continue;
    ++bits;
    const std::string name = to_text(bit);
    const std::size_t at = page.find("\n  " + name + ": [");
    ASSERT_NE(at, std::string::npos) << name;
    const std::string entry = page.substr(at, page.find(']', at) - at);
    EXPECT_NE(entry.find('"' + words + '"'), std::string::npos) << entry;
  }
  EXPECT_GT(bits, 20);
}

}  // namespace status_words_test
}  // namespace repel::runs
