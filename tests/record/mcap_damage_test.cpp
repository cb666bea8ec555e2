// SPDX-License-Identifier: BSD-3-Clause
// A truncated file yields everything that is complete; damage is detected or harmless.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include <record/recording.hpp>
#include <repel/base/setup_error.hpp>

namespace repel::record {
namespace mcap_damage_test {

using testing::all_messages;
using testing::number_at;
using testing::RawRecord;
using testing::Recording;
using testing::records_between;
using testing::records_of;
using testing::small_recording;
using testing::Taken;
using testing::taken;

/// Number of complete messages in the first `length` bytes of a file, by the offsets of its
/// records.
std::size_t complete_messages(const std::vector<RawRecord>& records, std::size_t length) {
  std::size_t count = 0;
  for (const RawRecord& record : records) {
    if (record.op != 6) continue;
    const std::size_t begin = record.offset + 9 + 40;
    for (const RawRecord& m : records_between(record.content.substr(40), 0, record.number(32, 8))) {
      if (m.op == 5 && begin + m.offset + m.size() <= length) ++count;
    }
  }
  return count;
}

TEST(McapDamage, AFileCutAnywhereGivesEveryMessageThatIsComplete) {
  const Recording r = small_recording(11);
  const std::vector<RawRecord> records = records_of(r.bytes);
  for (std::size_t length = 0; length < r.bytes.size(); ++length) {
    SCOPED_TRACE("cut at " + std::to_string(length) + " of " + std::to_string(r.bytes.size()));
    McapReader reader = McapReader::from_bytes(r.bytes.substr(0, length));
    EXPECT_FALSE(reader.whole());
    EXPECT_NE(reader.why_not_whole().find("cut off at byte " + std::to_string(length)),
              std::string::npos);
    const std::vector<Taken> messages = all_messages(reader);
    ASSERT_EQ(messages.size(), complete_messages(records, length));
    EXPECT_TRUE(std::equal(messages.begin(), messages.end(), r.messages.begin()));
    for (const Taken& m : messages) EXPECT_TRUE(reader.channels().contains(m.channel));
    reader.rewind();
    EXPECT_EQ(all_messages(reader), messages);
  }
  McapReader reader = McapReader::from_bytes(r.bytes);
  EXPECT_TRUE(reader.whole()) << reader.why_not_whole();
  EXPECT_EQ(all_messages(reader), r.messages);
}

TEST(McapDamage, ZerosBehindAFileAreNoMessages) {
  const Recording r = small_recording(12);
  const std::vector<RawRecord> records = records_of(r.bytes);
  const auto chunk = std::find_if(records.begin(), records.end(),
                                  [](const RawRecord& record) { return record.op == 7; });
  ASSERT_NE(chunk, records.end());
  McapReader reader =
      McapReader::from_bytes(r.bytes.substr(0, chunk->offset) + std::string(100, '\0'));
  EXPECT_FALSE(reader.whole());
  EXPECT_NE(reader.why_not_whole().find("only zeros"), std::string::npos);
  EXPECT_FALSE(all_messages(reader).empty());
}

/// The result of reading a damaged file.
struct Outcome {
  bool noticed = false;  // an error, or reported as incomplete
  std::vector<Taken> messages;
};

/// Reads everything possible, continuing after every error.
Outcome read(const std::string& bytes) {
  Outcome outcome;
  try {
    McapReader reader = McapReader::from_bytes(bytes);
    outcome.noticed = !reader.whole();
    for (bool more = true; more;) {
      try {
        McapMessage message;
        more = reader.next(message);
        if (more) outcome.messages.push_back(taken(message));
      } catch (const SetupError&) {
        outcome.noticed = true;
      }
    }
  } catch (const SetupError&) {
    outcome.noticed = true;
  }
  return outcome;
}

TEST(McapDamage, EveryWrongByteIsNoticed) {
  const Recording r = small_recording(13);
  const auto seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 rng(seed);
  for (std::size_t at = 0; at < r.bytes.size(); ++at) {
    std::string bytes = r.bytes;
    bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1 + rng() % 255));
    EXPECT_TRUE(read(bytes).noticed) << "byte " << at;
  }
}

TEST(McapDamage, AChunkThatIsDamagedIsLeftOutAndTheRestIsThere) {
  const Recording r = small_recording(14);
  for (const RawRecord& record : records_of(r.bytes)) {
    if (record.op != 6) continue;
    std::string bytes = r.bytes;
    bytes[record.offset + record.size() - 1] ^= 1;
    McapReader reader = McapReader::from_bytes(bytes, "run.mcap");
    std::vector<Taken> messages;
    McapMessage message;
    std::string error;
    for (bool more = true; more;) {
      try {
        more = reader.next(message);
        if (more) messages.push_back(taken(message));
      } catch (const SetupError& found) {
        if (error.empty()) error = found.what();
      }
    }
    EXPECT_EQ(error.find("run.mcap: at byte " + std::to_string(record.offset) +
                         ": the CRC of the chunk is 0x"),
              0U)
        << error;
    std::size_t lost = 0;
    for (const RawRecord& m : records_between(record.content.substr(40), 0, record.number(32, 8))) {
      lost += m.op == 5 ? 1 : 0;
    }
    EXPECT_EQ(messages.size(), r.messages.size() - lost);
  }
}

TEST(McapDamage, ADamagedAttachmentCostsNoMessage) {
  const Recording r = small_recording(15);
  const std::size_t at = r.bytes.find("name: x\n");
  ASSERT_NE(at, std::string::npos);
  std::string bytes = r.bytes;
  bytes[at] = 'N';
  McapReader reader = McapReader::from_bytes(bytes);
  EXPECT_NE(reader.why_not_whole().find("the CRC of the attachment"), std::string::npos);
  EXPECT_TRUE(reader.attachments().empty());
  McapMessage message;
  for (const Taken& m : r.messages) {
    ASSERT_TRUE(reader.next(message));
    EXPECT_EQ(taken(message), m);
  }
  EXPECT_THROW(reader.next(message), SetupError);
  EXPECT_FALSE(reader.next(message));
}

TEST(McapDamage, RandomDamageDoesNoHarm) {
  const Recording r = small_recording(16);
  const auto seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 rng(seed);
  for (int i = 0; i < 3000; ++i) {
    std::string bytes = r.bytes;
    for (std::uint64_t k = rng() % 8; k > 0; --k) {
      const std::size_t at = rng() % bytes.size();
      switch (rng() % 3) {
        case 0:
          bytes[at] = static_cast<char>(rng());
          break;
        case 1:
          bytes.erase(at, rng() % 40);
          break;
        default:
          bytes.insert(at, r.bytes, rng() % r.bytes.size(), rng() % 40);
      }
    }
    const Outcome outcome = read(bytes);
    EXPECT_TRUE(outcome.noticed || outcome.messages == r.messages) << "round " << i;
    EXPECT_LE(outcome.messages.size(), 10 * r.messages.size());
  }
}

}  // namespace mcap_damage_test
}  // namespace repel::record
