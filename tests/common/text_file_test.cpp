// SPDX-License-Identifier: BSD-3-Clause
// A file is read completely or refused, and never beyond the allowed size.
#include <gtest/gtest.h>

#include <string>

#include <repel/common/text_file.hpp>

#include "end_to_end/folder.hpp"

namespace repel {
namespace text_file_test {

using test::Folder;

std::string refusal(const std::string& path, std::size_t most) {
  try {
    (void)text_of_file(path, "a list", most);
  } catch (const SetupError& error) {
    EXPECT_EQ(error.file(), path);
    return error.what();
  }
  return "accepted";
}

TEST(TextFile, OfUpToAsManyBytesIsRead) {
  const Folder folder;
  for (const std::size_t size : {0U, 1U, 65535U, 65536U, 65537U, 200000U}) {
    const std::string text(size, 'x');
    const std::string path = folder.with("a", text);
    EXPECT_EQ(text_of_file(path, "a list", size), text);
    EXPECT_EQ(text_of_file(path, "a list"), text);
    if (size == 0) continue;
    const std::string refused = refusal(path, size - 1);
    EXPECT_NE(refused.find(std::to_string(size) + " bytes"), std::string::npos) << refused;
    EXPECT_NE(refused.find("a list of up to " + std::to_string(size - 1)), std::string::npos);
  }
}

TEST(TextFile, WithoutAnEndIsRefused) {
  const std::string refused = refusal("/dev/zero", 100000);
  EXPECT_NE(refused.find("more than 100000 bytes"), std::string::npos) << refused;
}

TEST(TextFile, ThatIsNotThereOrAFolderIsRefused) {
  const Folder folder;
  EXPECT_NE(refusal(folder / "none", 10).find("cannot be opened"), std::string::npos);
  EXPECT_NE(refusal("", 10).find("the name of the file is empty"), std::string::npos);
  EXPECT_NE(refusal(folder / "", 10).find("a directory"), std::string::npos);
}

}  // namespace text_file_test
}  // namespace repel
