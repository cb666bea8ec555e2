// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/depth_image_file.hpp>

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "percepts/png.hpp"

namespace repel::percepts {
namespace depth_image_file_test {

constexpr DepthCamera camera{.width = 33, .height = 17};

/// A file that is removed again.
struct File {
  explicit File(const std::string& name) : path(testing::TempDir() + "repel_depth_" + name) {}
  ~File() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  std::string path;
};

std::string complaint(const std::string& path) {
  std::vector<float> depth(camera.pixels());
  try {
    read_depth_image(path, camera, 0.001, depth);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DepthImageFile, HasInMillimetresWhatWasWritten) {
  constexpr unsigned seed = 50;
  std::mt19937 random(seed);
  std::vector<std::uint16_t> pixels(camera.pixels());
  for (std::uint16_t& pixel : pixels) pixel = static_cast<std::uint16_t>(random());
  pixels[5] = 0;
  const File file("whole.png");
  test::write_png(file.path, camera.width, camera.height, pixels);
  EXPECT_TRUE(reads_depth_images());
  check_depth_image(file.path, camera);
  for (const double unit : {0.001, 0.0002}) {
    std::vector<float> depth(camera.pixels(), -1.0F);
    read_depth_image(file.path, camera, unit, depth);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      ASSERT_EQ(depth[i], static_cast<float>(unit * pixels[i])) << "seed " << seed;
    }
  }
}

TEST(DepthImageFile, IsRefusedWithItsNameAndWhatIsWrong) {
  const std::vector<std::uint16_t> pixels(camera.pixels(), 1000);
  const auto says = [](const File& file, const std::string& what) {
    EXPECT_NE(complaint(file.path).find(file.path), std::string::npos) << complaint(file.path);
    EXPECT_NE(complaint(file.path).find(what), std::string::npos) << complaint(file.path);
  };
  const File none("none.png");
  says(none, "cannot be opened");
  const File small("small.png");
  test::write_png(small.path, 17, 33, pixels);
  says(small, "17 x 33 pixels of 1 x 16 bits; allowed: 33 x 17");
  EXPECT_THROW(check_depth_image(small.path, camera), SetupError);
  const File flat("flat.png");
  test::write_png(flat.path, camera.width, camera.height, pixels, 8);
  says(flat, "1 x 8 bits");
  const File text("text.png");
  std::ofstream(text.path) << "no image at all";
  says(text, "PNG");
}

TEST(DepthImageFile, ThatIsCutOffIsRefusedWhenItIsReadAndNeverCrashes) {
  constexpr unsigned seed = 51;
  std::mt19937 random(seed);
  std::vector<std::uint16_t> pixels(camera.pixels());
  for (std::uint16_t& pixel : pixels) pixel = static_cast<std::uint16_t>(random());
  const File whole("to_cut.png");
  test::write_png(whole.path, camera.width, camera.height, pixels);
  std::ifstream stream(whole.path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  const File cut("cut.png");
  const auto write = [&](const std::string& changed) {
    std::ofstream(cut.path, std::ios::binary | std::ios::trunc) << changed;
  };
  for (int i = 0; i < 50; ++i) {
    write(bytes.substr(0, random() % (bytes.size() - 12)));
    EXPECT_NE(complaint(cut.path), "accepted") << "seed " << seed;
  }
  write(bytes.substr(0, 200));
  EXPECT_NO_THROW(check_depth_image(cut.path, camera)) << "its head is there";
  int refused = 0;
  for (int i = 0; i < 50; ++i) {
    std::string changed = bytes;
    changed[random() % changed.size()] ^= static_cast<char>(1 + random() % 255);
    write(changed);
    refused += complaint(cut.path) == "accepted" ? 0 : 1;
  }
  EXPECT_GT(refused, 40) << "it has checksums";
}

// To open a pipe would wait for somebody who writes to it, and a device has no end.
TEST(DepthImageFile, ThatIsNoFileIsRefusedAtOnce) {
  const File pipe("pipe.png");
  ASSERT_EQ(mkfifo(pipe.path.c_str(), 0600), 0);
  for (const std::string& path : {pipe.path, testing::TempDir(), std::string("/dev/zero")}) {
    EXPECT_NE(complaint(path).find("cannot be opened"), std::string::npos) << complaint(path);
  }
}

TEST(DepthImageFile, ThatIsTooLargeIsRefusedUnread) {
  const File large("large.png");
  test::write_png(large.path, camera.width, camera.height,
                  std::vector<std::uint16_t>(camera.pixels()));
  std::filesystem::resize_file(large.path, std::uintmax_t{1} << 32U);
  EXPECT_NE(complaint(large.path).find("4294967296 bytes; allowed: up to 16777216"),
            std::string::npos)
      << complaint(large.path);
}

// A text of 2 kB that would be one of 2 MB is passed over.
TEST(DepthImageFile, IsReadWithoutItsTexts) {
  EXPECT_EQ(complaint("tests/fuzz/seeds/depth.png"), "accepted");
  EXPECT_EQ(complaint("tests/fuzz/seeds/texts.png"), "accepted");
}

}  // namespace depth_image_file_test
}  // namespace repel::percepts
