// SPDX-License-Identifier: BSD-3-Clause
#include <repel/distance/closed_surface.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace repel::detail {
namespace closed_surface_test {

struct Face {
  Triangle corners{};
};
using Words = std::vector<std::uint16_t>;

Words octahedron() {
  Words words;
  for (const Triangle& t : {Triangle{0, 1, 4},
                            {1, 2, 4},
                            {2, 3, 4},
                            {3, 0, 4},
                            {1, 0, 5},
                            {2, 1, 5},
                            {3, 2, 5},
                            {0, 3, 5}}) {
    words.push_back(packed(t));
  }
  return words;
}

bool is_closed(const Words& words, std::size_t corner_count) {
  std::vector<Face> faces(words.size());
  const bool closed = read_closed_surface<Face>(words, corner_count, faces.data());
  for (std::size_t f = 0; f < words.size(); ++f) EXPECT_EQ(packed(faces[f].corners), words[f]);
  return closed;
}

TEST(ClosedSurface, HasEveryEdgeInBothDirections) {
  EXPECT_TRUE(is_closed(octahedron(), 6));
  for (std::size_t f = 0; f < 8; ++f) {
    Words words = octahedron();
    words[f] = packed({6, 7, 8});
    EXPECT_FALSE(is_closed(words, 16)) << "another face in place of " << f;
    words[f] = words[(f + 1) % 8];
    EXPECT_FALSE(is_closed(words, 16)) << "one face twice in place of " << f;
    words = octahedron();
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(f));
    EXPECT_FALSE(is_closed(words, 16)) << "without " << f;
    words = octahedron();
    const auto turned = static_cast<std::uint8_t>(words[f] & 15U);
    words[f] = packed({static_cast<std::uint8_t>(words[f] >> 4U & 15U), turned,
                       static_cast<std::uint8_t>(words[f] >> 8U)});
    EXPECT_FALSE(is_closed(words, 16)) << f << " the other way round";
  }
}

TEST(ClosedSurface, HasNoEdgeTwice) {
  Words twice = octahedron();
  const Words once = twice;
  twice.insert(twice.end(), once.begin(), once.end());
  EXPECT_FALSE(is_closed(twice, 16));
}

TEST(ClosedSurface, HasOnlyCornersThatAreKnown) {
  EXPECT_FALSE(is_closed(octahedron(), 5));
  Words last = octahedron();
  for (std::uint16_t& word : last) {
    Triangle t{static_cast<std::uint8_t>(word & 15U), static_cast<std::uint8_t>(word >> 4U & 15U),
               static_cast<std::uint8_t>(word >> 8U)};
    std::replace(t.begin(), t.end(), std::uint8_t{5}, std::uint8_t{15});
    word = packed(t);
  }
  EXPECT_TRUE(is_closed(last, 16));
  EXPECT_FALSE(is_closed(last, 15));
}

}  // namespace closed_surface_test
}  // namespace repel::detail
