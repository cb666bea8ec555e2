// SPDX-License-Identifier: BSD-3-Clause
// The output conforms to the format: every index points to what it names, every CRC is that of its
// bytes, every count is right; and no failure is silent.
#include <repel/record/mcap_writer.hpp>

#include <sys/resource.h>

#include <csignal>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <record/recording.hpp>
#include <repel/base/setup_error.hpp>

namespace repel::record {
namespace mcap_writer_test {

using testing::all_messages;
using testing::number_at;
using testing::RawRecord;
using testing::record_at;
using testing::Recording;
using testing::records_between;
using testing::records_of;
using testing::Scratch;
using testing::slow_crc32;
using testing::small_recording;
using testing::Taken;
using testing::taken;
using testing::write_recording;

constexpr int op_footer = 2, op_schema = 3, op_channel = 4, op_message = 5, op_chunk = 6,
              op_message_index = 7, op_chunk_index = 8, op_attachment = 9, op_attachment_index = 10,
              op_statistics = 11, op_metadata = 12, op_metadata_index = 13, op_summary_offset = 14,
              op_data_end = 15;

constexpr std::uint64_t ms = 1'000'000;

std::vector<RawRecord> of_type(int op, const std::vector<RawRecord>& records) {
  std::vector<RawRecord> found;
  for (const RawRecord& r : records) {
    if (r.op == op) found.push_back(r);
  }
  return found;
}

/// The records in an uncompressed chunk begin after 40 bytes.
std::vector<RawRecord> records_in(const RawRecord& chunk) {
  return records_between(chunk.content.substr(40), 0, chunk.number(32, 8));
}

std::size_t chunks_in(const std::string& file) {
  return of_type(op_chunk, records_of(file)).size();
}

TEST(McapWriter, TheFileBeginsAndEndsWithTheMagicBytes) {
  const Recording r = small_recording(1);
  const std::string magic("\x89MCAP0\r\n", 8);
  EXPECT_EQ(r.bytes.substr(0, 8), magic);
  EXPECT_EQ(r.bytes.substr(r.bytes.size() - 8), magic);
  EXPECT_EQ(records_of(r.bytes).front().op, 1);
  EXPECT_EQ(records_of(r.bytes).back().op, op_footer);
}

TEST(McapWriter, EveryChunkIndexPointsAtItsChunkAndAtAllOfItsMessages) {
  const Recording r = small_recording(2);
  const auto records = records_of(r.bytes);
  const auto indices = of_type(op_chunk_index, records);
  const auto chunks = of_type(op_chunk, records);
  ASSERT_GT(chunks.size(), 2U);
  ASSERT_EQ(indices.size(), chunks.size());
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    const RawRecord& index = indices[i];
    const RawRecord& chunk = chunks[i];
    EXPECT_EQ(index.number(0, 8), chunk.number(0, 8));
    EXPECT_EQ(index.number(8, 8), chunk.number(8, 8));
    EXPECT_EQ(index.number(16, 8), chunk.offset);
    EXPECT_EQ(index.number(24, 8), chunk.size());
    const std::size_t places = index.number(32, 4);
    const std::size_t behind = 36 + places;
    EXPECT_EQ(index.number(behind + 8, 4), 0U) << "no compression";
    EXPECT_EQ(index.number(behind + 12, 8), chunk.number(32, 8));
    EXPECT_EQ(index.number(behind + 20, 8), chunk.number(16, 8));

    std::set<std::size_t> found;
    std::size_t bytes = 0;
    for (std::size_t k = 0; k < places; k += 10) {
      const RawRecord of_channel = record_at(r.bytes, index.number(36 + k + 2, 8));
      ASSERT_EQ(of_channel.op, op_message_index);
      EXPECT_EQ(of_channel.number(0, 2), index.number(36 + k, 2));
      bytes += of_channel.size();
      for (std::size_t m = 0; m < of_channel.number(2, 4); m += 16) {
        const std::size_t at = of_channel.number(6 + m + 8, 8);
        const RawRecord message = record_at(chunk.content.substr(40), at);
        ASSERT_EQ(message.op, op_message);
        EXPECT_EQ(message.number(0, 2), of_channel.number(0, 2));
        EXPECT_EQ(message.number(6, 8), of_channel.number(6 + m, 8));
        found.insert(at);
      }
    }
    EXPECT_EQ(index.number(behind, 8), bytes);
    EXPECT_EQ(found.size(), of_type(op_message, records_in(chunk)).size());
  }
}

TEST(McapWriter, AChunkSaysItsTimesItsSizeAndItsCrc) {
  const Recording r = small_recording(3);
  for (const RawRecord& chunk : of_type(op_chunk, records_of(r.bytes))) {
    std::uint64_t first = UINT64_MAX;
    std::uint64_t last = 0;
    for (const RawRecord& m : of_type(op_message, records_in(chunk))) {
      first = std::min(first, m.number(6, 8));
      last = std::max(last, m.number(6, 8));
    }
    EXPECT_EQ(chunk.number(0, 8), first);
    EXPECT_EQ(chunk.number(8, 8), last);
    EXPECT_EQ(chunk.number(16, 8), chunk.content.size() - 40);
    EXPECT_EQ(chunk.number(24, 4), slow_crc32(chunk.content.substr(40)));
  }
}

TEST(McapWriter, SchemasAndChannelsStandBeforeTheirFirstChunkAndInIt) {
  const Recording r = small_recording(4);
  std::set<std::uint64_t> outside;
  std::set<std::uint64_t> inside;
  bool schema_outside = false;
  for (const RawRecord& record : records_of(r.bytes)) {
    if (record.op == op_data_end) break;
    schema_outside = schema_outside || record.op == op_schema;
    if (record.op == op_channel) outside.insert(record.number(0, 2));
    if (record.op != op_chunk) continue;
    EXPECT_TRUE(schema_outside);
    for (const RawRecord& within : records_in(record)) {
      if (within.op == op_channel) inside.insert(within.number(0, 2));
      if (within.op != op_message) continue;
      EXPECT_TRUE(outside.contains(within.number(0, 2)));
      EXPECT_TRUE(inside.contains(within.number(0, 2)));
    }
  }
  EXPECT_EQ(inside.size(), 2U);
}

TEST(McapWriter, TheStatisticsCountWhatIsThere) {
  const Recording r = small_recording(5);
  const auto records = records_of(r.bytes);
  const auto found = of_type(op_statistics, records);
  ASSERT_EQ(found.size(), 1U);
  const RawRecord& s = found.front();
  std::map<std::uint64_t, std::uint64_t> counts;
  std::uint64_t first = UINT64_MAX;
  std::uint64_t last = 0;
  for (const Taken& m : r.messages) {
    ++counts[m.channel];
    first = std::min(first, m.time_ns);
    last = std::max(last, m.time_ns);
  }
  EXPECT_EQ(s.number(0, 8), r.messages.size());
  EXPECT_EQ(s.number(8, 2), 1U) << "schemas";
  EXPECT_EQ(s.number(10, 4), 2U) << "channels";
  EXPECT_EQ(s.number(14, 4), 1U) << "attachments";
  EXPECT_EQ(s.number(18, 4), 1U) << "metadata";
  EXPECT_EQ(s.number(22, 4), of_type(op_chunk, records).size());
  EXPECT_EQ(s.number(26, 8), first);
  EXPECT_EQ(s.number(34, 8), last);
  ASSERT_EQ(s.number(42, 4), 20U);
  for (std::size_t k = 0; k < 20; k += 10) {
    EXPECT_EQ(s.number(46 + k + 2, 8), counts[s.number(46 + k, 2)]);
  }
}

TEST(McapWriter, AttachmentsAndMetadataAreIndexedAndAttachmentsHaveTheirCrc) {
  const Recording r = small_recording(6);
  const auto records = records_of(r.bytes);
  const auto pairs = {std::pair{op_attachment, op_attachment_index},
                      std::pair{op_metadata, op_metadata_index}};
  for (const auto& [op, op_index] : pairs) {
    const auto things = of_type(op, records);
    const auto indices = of_type(op_index, records);
    ASSERT_EQ(things.size(), 1U);
    ASSERT_EQ(indices.size(), 1U);
    EXPECT_EQ(indices[0].number(0, 8), things[0].offset);
    EXPECT_EQ(indices[0].number(8, 8), things[0].size());
  }
  const RawRecord attachment = of_type(op_attachment, records).front();
  const std::size_t covered = attachment.content.size() - 4;
  EXPECT_EQ(attachment.number(covered, 4), slow_crc32(attachment.content.substr(0, covered)));
  EXPECT_EQ(of_type(op_attachment_index, records).front().number(32, 8), 8U) << "its bytes";
}

TEST(McapWriter, TheSummaryIsGroupedAndItsOffsetsCoverEveryGroup) {
  const Recording r = small_recording(7);
  const auto records = records_of(r.bytes);
  const RawRecord footer = records.back();
  const std::size_t start = footer.number(0, 8);
  const std::size_t offsets = footer.number(8, 8);
  std::set<int> groups;
  std::size_t at = start;
  for (const RawRecord& offset : records_between(r.bytes, offsets, footer.offset)) {
    ASSERT_EQ(offset.op, op_summary_offset);
    const int op = static_cast<int>(offset.number(0, 1));
    EXPECT_EQ(offset.number(1, 8), at);
    EXPECT_TRUE(groups.insert(op).second);
    const std::size_t length = offset.number(9, 8);
    for (const RawRecord& record : records_between(r.bytes, at, at + length)) {
      EXPECT_EQ(record.op, op);
    }
    at += length;
  }
  EXPECT_EQ(at, offsets);
  EXPECT_EQ(groups, (std::set<int>{op_schema, op_channel, op_statistics, op_chunk_index,
                                   op_attachment_index, op_metadata_index}));
}

TEST(McapWriter, DataAndSummaryHaveTheirCrc) {
  const Recording r = small_recording(8);
  const auto records = records_of(r.bytes);
  const RawRecord data_end = of_type(op_data_end, records).front();
  EXPECT_EQ(data_end.number(0, 4),
            slow_crc32(std::string_view(r.bytes).substr(0, data_end.offset)));
  const RawRecord footer = records.back();
  const std::size_t start = footer.number(0, 8);
  const std::size_t end = footer.offset + 9 + 16;
  EXPECT_EQ(footer.number(16, 4), slow_crc32(std::string_view(r.bytes).substr(start, end - start)));
}

TEST(McapWriter, AChunkEndsWhenTheTimeOfItsMessagesHasAdvanced) {
  const Scratch scratch;
  McapWriter writer(scratch.path());
  const auto channel = writer.add_channel("t", 0, "json");
  for (std::uint64_t i = 0; i < 100; ++i) writer.write(channel, 0, i * 20 * ms, "{}");
  writer.close();
  EXPECT_EQ(chunks_in(scratch.bytes()), 4U);  // 2 s in steps of 20 ms, half a second per chunk
}

TEST(McapWriter, AChunkEndsAlsoWhenTimeRunsBackwards) {
  const Scratch scratch;
  McapWriter writer(scratch.path());
  const auto channel = writer.add_channel("t", 0, "json");
  writer.write(channel, 0, 5000 * ms, "{}");
  writer.write(channel, 1, 4400 * ms, "{}");
  writer.close();
  EXPECT_EQ(chunks_in(scratch.bytes()), 2U);
}

TEST(McapWriter, WhatIsOlderThanHalfASecondCanBeReadWhileItIsWritten) {
  const Scratch scratch;
  McapWriter writer(scratch.path());
  const auto channel = writer.add_channel("t", 0, "json");
  for (std::uint32_t i = 0; i < 3000; ++i) {
    writer.write(channel, i, i * ms, "{}");
    if (i % 100 != 0) continue;
    McapReader reader(scratch.path());
    EXPECT_FALSE(reader.whole());
    EXPECT_GT(all_messages(reader).size() + 500, i);
  }
  writer.flush();
  McapReader reader(scratch.path());
  EXPECT_EQ(all_messages(reader).size(), 3000U);
}

TEST(McapWriter, TheFileIsWholeWhenTheWriterGoesOutOfScope) {
  const Scratch scratch;
  { write_recording(*std::make_unique<McapWriter>(scratch.path()), 10, 9); }
  McapReader reader(scratch.path());
  EXPECT_TRUE(reader.whole()) << reader.why_not_whole();
  EXPECT_EQ(all_messages(reader).size(), 10U);
}

TEST(McapWriter, ClosingTwiceDoesNothingAndWritingAfterwardsIsAFailure) {
  const Scratch scratch;
  McapWriter writer(scratch.path());
  const auto channel = writer.add_channel("t", 0, "json");
  writer.close();
  writer.close();
  EXPECT_FALSE(writer.failed()) << writer.error();
  const std::string before = scratch.bytes();
  writer.write(channel, 0, 0, "{}");
  EXPECT_TRUE(writer.failed());
  EXPECT_NE(writer.error().find("closed"), std::string::npos);
  EXPECT_EQ(scratch.bytes(), before);
}

TEST(McapWriter, AFileThatCannotBeOpenedIsRefusedWithItsNameAndTheReason) {
  try {
    const McapWriter writer("/nowhere/at/all.mcap");
    ADD_FAILURE() << "it was opened";
  } catch (const SetupError& error) {
    EXPECT_EQ(error.what(), std::string("/nowhere/at/all.mcap: cannot be opened for writing: "
                                        "No such file or directory"));
  }
}

TEST(McapWriter, AFullDiskIsRefusedWhenTheFileIsOpened) {
  try {
    const McapWriter writer("/dev/full");
    ADD_FAILURE() << "nothing was said";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
}

/// Limits the size of all files of this process.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    (void)std::signal(SIGXFSZ, signal_);
  }
  SizeLimit(const SizeLimit&) = delete;
  SizeLimit& operator=(const SizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*signal_)(int);
};

TEST(McapWriter, ADiskThatFillsUpIsSaidAndWhatWasWrittenStays) {
  const Scratch scratch;
  std::size_t count = 0;
  {
    const SizeLimit limit(20000);
    McapWriter writer(scratch.path(), {.chunk_bytes = 1000});
    const auto channel = writer.add_channel("t", 0, "x-bytes");
    while (!writer.failed() && count < 100000) {
      writer.write(channel, 0, count++, "0123456789");
    }
    const std::string error = writer.error();
    EXPECT_NE(error.find(scratch.path() + ": cannot write"), std::string::npos) << error;
    EXPECT_NE(error.find("File too large"), std::string::npos) << error;
    writer.write(channel, 0, count, "after");
    writer.attach("a", "b", "c", 0);
    writer.add_metadata("a", {});
    writer.flush();
    writer.close();
    EXPECT_EQ(writer.error(), error) << "the first error stays";
  }
  McapReader reader(scratch.path());
  EXPECT_FALSE(reader.whole());
  const std::size_t got = all_messages(reader).size();
  EXPECT_GT(got, 200U);
  EXPECT_LE(got, count);
}

TEST(McapWriter, WhatIsRefusedIsSaidAndLeavesTheRestWhole) {
  const Scratch scratch;
  McapWriter writer(scratch.path());
  const auto channel = writer.add_channel("t", 0, "json");
  writer.write(channel, 1, 1, "before");
  writer.write(channel, 2, 2, std::string(64 * 1024 * 1024 + 1, 'x'));
  EXPECT_NE(writer.error().find("'t' has 67108865 bytes; allowed: up to 67108864"),
            std::string::npos)
      << writer.error();
  writer.write(9, 3, 3, "no such channel");
  writer.write(0, 4, 4, "nor this");
  writer.write(channel, 5, 5, "after");
  writer.close();
  McapReader reader(scratch.path());
  EXPECT_TRUE(reader.whole()) << reader.why_not_whole();
  EXPECT_EQ(all_messages(reader).size(), 2U);
  EXPECT_TRUE(writer.failed());
}

TEST(McapWriter, AMessageAsLargeAsAllowedCanBeRead) {
  const Scratch scratch;
  McapWriter writer(scratch.path(), {.chunk_bytes = 64 * 1024 * 1024});
  const auto channel = writer.add_channel("t", 0, "json");
  writer.write(channel, 1, 1, std::string(60 * 1024 * 1024, 'a'));
  writer.write(channel, 2, 2, std::string(64 * 1024 * 1024, 'b'));
  writer.close();
  EXPECT_EQ(writer.error(), "");
  McapReader reader(scratch.path());
  McapMessage message;
  ASSERT_TRUE(reader.next(message));
  ASSERT_TRUE(reader.next(message));
  EXPECT_EQ(message.data.size(), 64U * 1024 * 1024);
  EXPECT_FALSE(reader.next(message));
}

template <class Action>
void expect_refused(Action&& action, const std::string& words) {
  try {
    action();
    ADD_FAILURE() << "accepted, without: " << words;
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(McapWriter, MistakesOfTheCallerAreRefusedInWords) {
  const Scratch scratch;
  McapWriter writer(scratch.path());
  const auto schema = writer.add_schema("s", "jsonschema", "{}");
  EXPECT_EQ(schema, 1);
  EXPECT_EQ(writer.add_channel("t", schema, "json"), 1);
  expect_refused([&] { writer.add_channel("u", 2, "json"); },
                 "channel 'u': schema 2 does not exist; allowed: 0 to 1");
  expect_refused([&] { writer.add_channel("", 0, "json"); }, "without a topic");
  expect_refused([&] { writer.add_channel("t", 0, "json"); }, "second channel");
  expect_refused([&] { writer.add_schema("big", "", std::string(17 << 20, ' ')); },
                 "'big' has 17825795 bytes; allowed: up to 16777216");
  expect_refused([&] { const McapWriter w(scratch.path(), {.chunk_bytes = 0}); },
                 "chunk_bytes is 0; allowed: 1 to 67108864");
  EXPECT_FALSE(writer.failed());
}

TEST(McapWriter, TheSixtyFiveThousandFiveHundredThirtySixthSchemaIsRefused) {
  const Scratch scratch;
  McapWriter writer(scratch.path());
  for (int i = 1; i <= 65535; ++i) ASSERT_EQ(writer.add_schema("s", "", ""), i);
  expect_refused([&] { writer.add_schema("s", "", ""); }, "one too many; allowed: up to 65535");
}

}  // namespace mcap_writer_test
}  // namespace repel::record
