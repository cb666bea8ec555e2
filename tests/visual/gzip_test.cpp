// SPDX-License-Identifier: BSD-3-Clause
// What is compressed is a gzip file of the text, and only for those who accept it.
#include "gzip.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>

#include <boost/beast/core/error.hpp>
#include <boost/beast/zlib/inflate_stream.hpp>
#include <boost/crc.hpp>

namespace repel::visual::gzip_test {

std::uint32_t word_at(const std::string& bytes, std::size_t place) {
  std::uint32_t word = 0;
  for (std::size_t k = 4; k > 0; --k) {
    word = (word << 8U) | static_cast<unsigned char>(bytes.at(place + k - 1));
  }
  return word;
}

/// The text of a gzip file as gzipped() writes it, with its length and sum checked.
std::string unpacked(const std::string& file) {
  namespace zlib = boost::beast::zlib;
  EXPECT_EQ(file.substr(0, 4), std::string("\x1f\x8b\x08\x00", 4));
  std::string text(word_at(file, file.size() - 4), '\0');
  std::string room = text + std::string(64, '\0');
  zlib::inflate_stream stream;
  zlib::z_params z;
  z.next_in = file.data() + 10;
  z.avail_in = file.size() - 18;
  z.next_out = room.data();
  z.avail_out = room.size();
  boost::beast::error_code error;
  stream.write(z, zlib::Flush::sync, error);
  EXPECT_EQ(z.total_out, text.size());
  text = room.substr(0, z.total_out);
  boost::crc_32_type sum;
  sum.process_bytes(text.data(), text.size());
  EXPECT_EQ(sum.checksum(), word_at(file, file.size() - 8));
  return text;
}

TEST(Gzip, UnpackedItIsTheTextAgain) {
  constexpr unsigned seed = 7;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (const std::size_t size : {0U, 1U, 100U, 70000U, 600000U}) {
    for (const unsigned letters : {1U, 4U, 256U}) {
      std::string text(size, ' ');
      for (char& each : text) each = static_cast<char>(random() % letters);
      const std::string file = gzipped(text);
      EXPECT_EQ(unpacked(file), text) << size << " of " << letters;
      if (size > 1000 && letters <= 4) {
        EXPECT_LT(file.size(), size / 3);
      }
    }
  }
}

TEST(Gzip, TheSumIsThatOfTheStandard) {
  const std::string file = gzipped("123456789");
  EXPECT_EQ(word_at(file, file.size() - 8), 0xCBF43926U);
  EXPECT_EQ(word_at(file, file.size() - 4), 9U);
}

TEST(Gzip, OnlyWhoNamesItAcceptsIt) {
  for (const char* yes : {"gzip", "gzip, deflate, br, zstd", "br, GZIP", "deflate, gzip;q=0.5",
                          "gzip;q=1.0, *;q=0", "gzip;x=0"}) {
    EXPECT_TRUE(accepts_gzip(yes)) << yes;
  }
  for (const char* no : {"", "identity", "br", "gzip;q=0", "gzip; q=0.000", "gzipped", "x-gzip",
                         ";;;", "\"gzip", "*"}) {
    EXPECT_FALSE(accepts_gzip(no)) << no;
  }
}

}  // namespace repel::visual::gzip_test
