// SPDX-License-Identifier: BSD-3-Clause
#include "metered_stream.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/web_page.hpp"

namespace repel::visual {
namespace metered_stream_test {

using test::Frame;

TEST(FrameCounter, CountsWhatAReaderOfMessagesDoesNotSee) {
  FrameCounter counter;
  EXPECT_EQ(counter.count(""), 0);
  EXPECT_EQ(counter.count(Frame{Frame::text, "hello"}.bytes()), 1);
  EXPECT_EQ(counter.count(Frame{Frame::ping, "x"}.bytes() + Frame{Frame::pong}.bytes()), 2);
  EXPECT_EQ(counter.count(Frame{Frame::text, "", false}.bytes()), 1);
  EXPECT_EQ(counter.count(Frame{Frame::more, "", false}.bytes()), 1);
  EXPECT_EQ(counter.count(Frame{Frame::more, "bare", true, false}.bytes()), 1);
}

// Independent of fragmentation.
TEST(FrameCounter, FramesOfAllSizesAreCountedOnceInWhateverPieces) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const std::size_t sizes[] = {0, 1, 125, 126, 127, 4096, 65535, 65536, 70000};
  for (int round = 0; round < 20; ++round) {
    std::string all;
    for (int i = 0; i < 100; ++i) {
      const bool masked = random() % 2 == 0;
      all += Frame{Frame::text, std::string(sizes[random() % 9], 'x'), true, masked}.bytes();
    }
    FrameCounter counter;
    int frames = 0;
    for (std::size_t at = 0; at < all.size();) {
      const std::size_t size = 1 + random() % 3000;
      frames += counter.count(std::string_view(all).substr(at, size));
      at += size;
    }
    EXPECT_EQ(frames, 100);
  }
}

TEST(FrameCounter, AFrameThatNeverEndsIsOne) {
  FrameCounter counter;
  Frame frame{Frame::text, "x"};
  frame.announced = ~std::uint64_t{0};
  EXPECT_EQ(counter.count(frame.bytes()), 1);
  EXPECT_EQ(counter.count(std::string(100000, '\x81')), 0);
}

}  // namespace metered_stream_test
}  // namespace repel::visual
