// SPDX-License-Identifier: BSD-3-Clause
// Compressed recordings hold the same messages in less room, survive what others survive, and a
// hostile one costs neither memory nor time beyond its limits.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include <packing.hpp>
#include <record/recording.hpp>
#include <repel/base/setup_error.hpp>

namespace repel::record {
namespace mcap_compression_test {

using testing::all_messages;
using testing::put_number;
using testing::RawRecord;
using testing::Recording;
using testing::records_of;
using testing::Scratch;
using testing::slow_crc32;
using testing::small_recording;
using testing::Taken;
using testing::taken;
using testing::write_recording;

/// Skips what needs zstd where it was not built in.
class Compressed : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_zstd()) GTEST_SKIP() << "built without zstd";
  }
};

Recording compressed(std::uint64_t seed) {
  return small_recording(seed, 40, McapCompression::zstd);
}

std::string packed(const std::string& bytes) {
  std::string out;
  detail::Packer packer;
  EXPECT_TRUE(packer.pack(bytes, out));
  return out;
}

/// A file with one compressed chunk that claims to have `size` bytes of this CRC.
std::string file_of(const std::string& stored, std::uint64_t size, std::uint32_t crc) {
  std::string chunk;
  put_number(chunk, 0, 16);
  put_number(chunk, size, 8);
  put_number(chunk, crc, 4);
  put_number(chunk, 4, 4);
  chunk += "zstd";
  put_number(chunk, stored.size(), 8);
  chunk += stored;
  std::string bytes("\x89MCAP0\r\n", 8);
  const auto put_record = [&](int op, const std::string& content) {
    bytes.push_back(static_cast<char>(op));
    put_number(bytes, content.size(), 8);
    bytes += content;
  };
  put_record(1, std::string(8, '\0'));
  put_record(6, chunk);
  put_record(15, std::string(4, '\0'));
  put_record(2, std::string(20, '\0'));
  return bytes + bytes.substr(0, 8);
}

/// The error of reading this file; empty: none.
std::string error_of(const std::string& bytes) {
  McapReader reader = McapReader::from_bytes(bytes, "run.mcap");
  try {
    (void)all_messages(reader);
  } catch (const SetupError& error) {
    return error.what();
  }
  return {};
}

TEST_F(Compressed, EveryMessageComesBackInLessRoom) {
  const auto seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  const auto write = [&](const Scratch& scratch, McapCompression compression) {
    McapWriter writer(scratch.path(), {.compression = compression});
    auto messages = write_recording(writer, 2000, seed);
    const std::string text(200, 'x');
    for (std::uint32_t i = 0; i < 1000; ++i) {
      messages.push_back({.channel = 1, .sequence = i, .time_ns = i, .data = text});
      writer.write(1, i, i, text);
    }
    writer.close();
    EXPECT_EQ(writer.error(), "");
    return messages;
  };
  const Scratch plain;
  const Scratch small;
  const std::vector<Taken> messages = write(plain, McapCompression::none);
  EXPECT_EQ(write(small, McapCompression::zstd), messages);
  McapReader reader(small.path());
  EXPECT_TRUE(reader.whole()) << reader.why_not_whole();
  EXPECT_EQ(all_messages(reader), messages);
  reader.rewind();
  EXPECT_EQ(all_messages(reader), messages) << "again";
  EXPECT_LT(3 * small.bytes().size(), plain.bytes().size());
}

TEST_F(Compressed, ChunksAndTheirIndexSayIt) {
  const Recording r = compressed(2);
  std::vector<RawRecord> chunks;
  std::vector<RawRecord> indices;
  for (const RawRecord& record : records_of(r.bytes)) {
    if (record.op == 6) chunks.push_back(record);
    if (record.op == 8) indices.push_back(record);
  }
  ASSERT_GT(chunks.size(), 2U);
  ASSERT_EQ(indices.size(), chunks.size());
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    EXPECT_EQ(chunks[i].content.substr(32, 4), "zstd");
    const std::size_t behind = 36 + indices[i].number(32, 4);
    EXPECT_EQ(indices[i].content.substr(behind + 12, 4), "zstd");
    EXPECT_EQ(indices[i].number(behind + 16, 8), chunks[i].number(36, 8)) << "as stored";
    EXPECT_EQ(indices[i].number(behind + 24, 8), chunks[i].number(16, 8)) << "decompressed";
  }
}

TEST_F(Compressed, AFileCutAnywhereGivesTheMessagesOfAllWholeChunks) {
  const Recording r = compressed(11);
  std::vector<std::size_t> ends;
  for (const RawRecord& record : records_of(r.bytes)) {
    if (record.op == 6) ends.push_back(record.offset + record.size());
  }
  McapReader whole = McapReader::from_bytes(r.bytes);
  ASSERT_EQ(all_messages(whole), r.messages);
  std::size_t before = 0;
  for (std::size_t length = 0; length < r.bytes.size(); ++length) {
    SCOPED_TRACE("cut at " + std::to_string(length) + " of " + std::to_string(r.bytes.size()));
    McapReader reader = McapReader::from_bytes(r.bytes.substr(0, length));
    EXPECT_FALSE(reader.whole());
    const std::vector<Taken> messages = all_messages(reader);
    ASSERT_LE(messages.size(), r.messages.size());
    EXPECT_TRUE(std::equal(messages.begin(), messages.end(), r.messages.begin()));
    EXPECT_GE(messages.size(), before) << "a longer file has no fewer";
    before = messages.size();
    if (length == ends.front()) {
      EXPECT_GT(before, 0U);
    }
  }
  EXPECT_EQ(before, r.messages.size());
}

// The last chunk of a run that was killed: what its blocks give, although its end is missing.
TEST_F(Compressed, ALargeChunkThatIsCutOffGivesItsFirstBlocks) {
  const Scratch scratch;
  std::mt19937_64 rng(5);
  McapWriter writer(scratch.path(), {.chunk_bytes = 1 << 20, .compression = McapCompression::zstd});
  const auto channel = writer.add_channel("t", 0, "");
  for (std::uint32_t i = 0; i < 8000; ++i) {
    std::string data(100, ' ');
    for (char& c : data) c = static_cast<char>(rng());
    writer.write(channel, i, 0, data);
  }
  writer.flush();
  const std::string bytes = scratch.bytes();
  McapReader reader = McapReader::from_bytes(bytes.substr(0, bytes.size() / 2));
  const std::size_t found = all_messages(reader).size();
  EXPECT_GT(found, 2000U);
  EXPECT_LT(found, 4100U);
}

TEST_F(Compressed, EveryWrongByteIsNoticed) {
  const Recording r = compressed(13);
  const auto seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 rng(seed);
  for (std::size_t at = 0; at < r.bytes.size(); ++at) {
    std::string bytes = r.bytes;
    bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1 + rng() % 255));
    bool noticed = false;
    std::size_t messages = 0;
    try {
      McapReader reader = McapReader::from_bytes(bytes);
      noticed = !reader.whole();
      McapMessage message;
      for (bool more = true; more;) {
        try {
          more = reader.next(message);
          messages += more ? 1 : 0;
        } catch (const SetupError&) {
          noticed = true;
        }
      }
    } catch (const SetupError&) {
      noticed = true;
    }
    EXPECT_TRUE(noticed) << "byte " << at;
    // A byte may make a message of one other record.
    EXPECT_LE(messages, r.messages.size() + 1);
  }
}

TEST_F(Compressed, AChunkThatLiesAboutItsSizeIsRefused) {
  const std::string bytes(100000, 'r');
  const std::string stored = packed(bytes);
  ASSERT_LT(stored.size(), 100U);
  const std::uint32_t crc = slow_crc32(bytes);
  for (const std::uint64_t size : {0U, 1U, 99999U, 100001U}) {
    EXPECT_EQ(error_of(file_of(stored, size, crc)),
              "run.mcap: at byte 25: a compressed chunk that does not decompress to the " +
                  std::to_string(size) + " bytes it is said to have");
  }
  for (const std::uint64_t size : {std::uint64_t{1} << 28, ~std::uint64_t{0}}) {
    EXPECT_NE(error_of(file_of(stored, size, crc))
                  .find(" bytes that is said to have " + std::to_string(size) +
                        "; allowed: up to " + std::to_string(detail::most_unpacked(stored.size()))),
              std::string::npos);
  }
  EXPECT_NE(error_of(file_of(stored, bytes.size(), crc ^ 1)).find("the CRC of the chunk"),
            std::string::npos);
  EXPECT_NE(error_of(file_of("no zstd", 9, 0)).find("does not decompress"), std::string::npos);
  EXPECT_NE(error_of(file_of(stored, bytes.size(), crc)).find("decompressed: "), std::string::npos)
      << "the content is no record";
}

// 300 MB of zeros in some kilobytes: refused by what it claims, or after as much as it claims.
TEST_F(Compressed, ABombIsRefused) {
  const std::string stored = packed(std::string(300 << 20, '\0'));
  ASSERT_LT(stored.size(), 100000U);
  EXPECT_NE(error_of(file_of(stored, 300U << 20, 0)).find("allowed: up to 268435456"),
            std::string::npos);
  EXPECT_NE(error_of(file_of(stored, 1000, 0)).find("does not decompress to the 1000 bytes"),
            std::string::npos);
}

TEST(CompressedLimits, TheMostAChunkCanHoldIsKnownBeforeItIsDecompressed) {
  EXPECT_EQ(detail::most_unpacked(0), 131072U);
  EXPECT_EQ(detail::most_unpacked(4000), 1001U * 131072U);
}

TEST(CompressedLimits, WithoutZstdChunksAreWrittenUncompressed) {
  if (has_zstd()) GTEST_SKIP() << "built with zstd";
  EXPECT_EQ(compressed(3).bytes, small_recording(3).bytes);
}

}  // namespace mcap_compression_test
}  // namespace repel::record
