// SPDX-License-Identifier: BSD-3-Clause
// What was written is read back, field by field; files of other writers can be read if their
// compression is known; what is not an MCAP file is refused with a message.
#include <repel/record/mcap_reader.hpp>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include <record/recording.hpp>
#include <repel/base/setup_error.hpp>

namespace repel::record {
namespace mcap_reader_test {

using testing::all_messages;
using testing::put_number;
using testing::Recording;
using testing::Scratch;
using testing::slow_crc32;
using testing::small_recording;
using testing::Taken;
using testing::write_recording;

TEST(McapReader, EveryMessageComesBackInOrder) {
  const auto seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  for (const std::size_t chunk_bytes : {1U, 300U, 262144U}) {
    const Scratch scratch;
    McapWriter writer(scratch.path(), {.chunk_bytes = chunk_bytes});
    const auto messages = write_recording(writer, 2000, seed);
    EXPECT_EQ(writer.messages(), 2000U);
    writer.close();
    ASSERT_EQ(writer.error(), "");
    EXPECT_EQ(writer.bytes(), std::filesystem::file_size(scratch.path()));
    McapReader reader(scratch.path());
    EXPECT_TRUE(reader.whole()) << reader.why_not_whole();
    EXPECT_EQ(all_messages(reader), messages);
    reader.rewind();
    EXPECT_EQ(all_messages(reader), messages) << "again";
  }
}

TEST(McapReader, EveryFieldComesBack) {
  const Scratch scratch;
  const std::string bytes("a\0b\xff", 4);
  McapWriter writer(scratch.path(), {.profile = "x-repel", .library = "repel 0.1"});
  const auto schema = writer.add_schema("Tick", "jsonschema", bytes);
  const auto channel = writer.add_channel("arm/tick", schema, "json", {{"k", bytes}, {"", ""}});
  writer.write(channel, 4294967295U, UINT64_MAX, bytes);
  writer.attach("scene", "text/yaml", bytes, 42);
  writer.attach("", "", "", 0);
  writer.add_metadata("run", {{"a", "1"}, {"b", ""}});
  writer.add_metadata("", {});
  writer.close();
  ASSERT_EQ(writer.error(), "");

  McapReader reader(scratch.path());
  EXPECT_EQ(reader.profile(), "x-repel");
  EXPECT_EQ(reader.library(), "repel 0.1");
  ASSERT_EQ(reader.schemas().size(), 1U);
  EXPECT_EQ(reader.schemas().at(schema), (McapSchema{"Tick", "jsonschema", bytes}));
  ASSERT_EQ(reader.channels().size(), 1U);
  EXPECT_EQ(reader.channels().at(channel),
            (McapChannel{"arm/tick", schema, "json", {{"k", bytes}, {"", ""}}}));
  ASSERT_EQ(reader.attachments().size(), 2U);
  const McapAttachment& attachment = reader.attachments().front();
  EXPECT_EQ(attachment.name, "scene");
  EXPECT_EQ(attachment.media_type, "text/yaml");
  EXPECT_EQ(attachment.log_time_ns, 42U);
  EXPECT_EQ(attachment.create_time_ns, 0U);
  EXPECT_EQ(attachment.data, bytes);
  ASSERT_EQ(reader.metadata().size(), 2U);
  EXPECT_EQ(reader.metadata().front().name, "run");
  EXPECT_EQ(reader.metadata().front().entries,
            (std::map<std::string, std::string>{{"a", "1"}, {"b", ""}}));
  McapMessage message;
  ASSERT_TRUE(reader.next(message));
  EXPECT_EQ(message.channel, channel);
  EXPECT_EQ(message.sequence, 4294967295U);
  EXPECT_EQ(message.log_time_ns, UINT64_MAX);
  EXPECT_EQ(message.publish_time_ns, UINT64_MAX);
  EXPECT_EQ(message.data, bytes);
  EXPECT_FALSE(reader.next(message));
  EXPECT_FALSE(reader.next(message));
}

TEST(McapReader, ARecordingWithoutMessagesIsWhole) {
  const Scratch scratch;
  { const McapWriter writer(scratch.path()); }
  McapReader reader(scratch.path());
  EXPECT_TRUE(reader.whole()) << reader.why_not_whole();
  EXPECT_TRUE(all_messages(reader).empty());
}

TEST(McapReader, AMessageMayBeEmpty) {
  const Scratch scratch;
  {
    McapWriter writer(scratch.path());
    const auto channel = writer.add_channel("t", 0, "");
    writer.write(channel, 0, 0, "");
    writer.write(channel, 1, 0, "");
  }
  McapReader reader(scratch.path());
  EXPECT_EQ(all_messages(reader), (std::vector<Taken>{{1, 0, 0, ""}, {1, 1, 0, ""}}));
}

/// Files as other writers make them.
class Maker {
 public:
  Maker() { record(1, text("") + text("other")); }
  Maker& record(int op, const std::string& content) {
    bytes_.push_back(static_cast<char>(op));
    put_number(bytes_, content.size(), 8);
    bytes_ += content;
    return *this;
  }
  Maker& chunk(const std::string& compression, const std::string& records) {
    return record(6, number(0, 16) + number(records.size(), 8) + number(slow_crc32(records), 4) +
                         text(compression) + number(records.size(), 8) + records);
  }
  /// Without summary and CRC.
  [[nodiscard]] std::string finished() {
    record(15, number(0, 4)).record(2, number(0, 20));
    return bytes_ + magic;
  }
  [[nodiscard]] std::string records() const { return bytes_.substr(magic.size()); }

  static std::string number(std::uint64_t value, std::size_t width) {
    std::string bytes;
    put_number(bytes, value, width);
    return bytes;
  }
  static std::string text(const std::string& text) { return number(text.size(), 4) + text; }
  static std::string channel(int id, int schema, const std::string& topic) {
    return number(id, 2) + number(schema, 2) + text(topic) + text("json") + number(0, 4);
  }
  static std::string message(int channel, const std::string& data) {
    return number(channel, 2) + number(7, 4) + number(1, 8) + number(2, 8) + data;
  }
  static std::string as_record(int op, const std::string& content) {
    std::string bytes(1, static_cast<char>(op));
    return bytes + number(content.size(), 8) + content;
  }

 private:
  static inline const std::string magic{"\x89MCAP0\r\n", 8};
  std::string bytes_ = magic;
};

McapReader opened(const std::string& bytes) {
  return McapReader::from_bytes(bytes, "test.mcap");
}

void expect_refused(const std::string& bytes, std::initializer_list<std::string> words) {
  try {
    McapReader reader = opened(bytes);
    all_messages(reader);
    ADD_FAILURE() << "accepted, without: " << *words.begin();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.file(), "test.mcap");
    for (const std::string& word : words) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
          << "no \"" << word << "\" in: " << error.what();
    }
  }
}

TEST(McapReader, MessagesOutsideOfChunksAreRead) {
  McapReader reader = opened(Maker()
                                 .record(4, Maker::channel(0, 0, "zero"))
                                 .record(5, Maker::message(0, "one"))
                                 .record(0x90, "of an extension")
                                 .record(5, Maker::message(0, "two"))
                                 .finished());
  EXPECT_TRUE(reader.whole()) << reader.why_not_whole();
  EXPECT_EQ(all_messages(reader), (std::vector<Taken>{{0, 7, 1, "one"}, {0, 7, 1, "two"}}));
}

TEST(McapReader, ChannelsThatAreOnlyInChunksAreFound) {
  McapReader reader = opened(Maker()
                                 .chunk("", Maker::as_record(4, Maker::channel(3, 0, "t")) +
                                                Maker::as_record(0x90, "x") +
                                                Maker::as_record(5, Maker::message(3, "one")))
                                 .finished());
  EXPECT_TRUE(reader.channels().empty());
  EXPECT_EQ(all_messages(reader).size(), 1U);
  EXPECT_EQ(reader.channels().at(3).topic, "t");
}

TEST(McapReader, FieldsThatAreAddedToARecordAreNotLookedAt) {
  McapReader reader = opened(
      Maker()
          .record(4, Maker::channel(1, 0, "t") + "more")
          .record(3, Maker::number(0, 2) + Maker::text("") + Maker::text("") + Maker::text(""))
          .finished());
  EXPECT_TRUE(reader.whole()) << reader.why_not_whole();
  EXPECT_EQ(reader.channels().at(1).topic, "t");
  EXPECT_TRUE(reader.schemas().empty()) << "schema 0 is to be ignored";
}

TEST(McapReader, ACompressedChunkIsRefusedByTheNameOfItsCompression) {
  expect_refused(Maker().chunk("lz4", "abc").finished(),
                 {"at byte 30: a chunk compressed with 'lz4'; allowed: 'zstd', or chunks without"});
  if (has_zstd()) return;
  expect_refused(Maker().chunk("zstd", "abc").finished(),
                 {"at byte 30: a chunk compressed with 'zstd', which was not built in; to have it: "
                  "apt-get install libzstd-dev"});
}

TEST(McapReader, WhatCannotBeIsRefused) {
  const std::string lone = Maker::as_record(5, Maker::message(1, "x"));
  expect_refused(Maker().chunk("", lone).finished(), {"channel 1; allowed: the channels"});
  expect_refused(Maker().record(5, Maker::message(1, "x")).finished(), {"channel 1"});
  expect_refused(Maker().record(4, Maker::channel(1, 5, "t")).finished(), {"'t' has schema 5"});
  expect_refused(
      Maker().record(4, Maker::channel(1, 0, "t")).record(4, Maker::channel(1, 0, "u")).finished(),
      {"a second channel 1"});
  expect_refused(Maker().record(4, "short").finished(), {"a field of 4 bytes", "its record, 1"});
  expect_refused(Maker().chunk("", "torn").finished(), {"a field of 8 bytes"});
  expect_refused(Maker().finished() + "more", {"4 bytes behind the end"});
}

TEST(McapReader, WhatIsNoMcapFileIsRefused) {
  expect_refused("PK\x03\x04 or anything else", {"at byte 0", "no MCAP file", "89 4d 43 41"});
  expect_refused("x", {"at byte 0"});
  std::string newer = Maker().finished();
  newer[5] = '1';
  expect_refused(newer, {"version 0"});
  const std::string magic = newer.substr(newer.size() - 8);
  expect_refused(magic + Maker::as_record(15, "1234"), {"end of data; allowed: header"});
}

TEST(McapReader, WhatIsNoFileIsRefused) {
  EXPECT_THROW(McapReader("/nowhere.mcap"), SetupError);
  EXPECT_THROW(McapReader("/dev/zero"), SetupError);
  EXPECT_THROW(McapReader(std::filesystem::temp_directory_path().string()), SetupError);
}

TEST(McapReader, AnEmptyFileHasNoMessagesAndIsNotWhole) {
  McapReader reader = opened("");
  EXPECT_FALSE(reader.whole());
  EXPECT_EQ(reader.why_not_whole(), "test.mcap: cut off at byte 0, within the first 8 bytes");
  EXPECT_TRUE(all_messages(reader).empty());
}

TEST(McapReader, ARecordBeyondTheLimitIsRefusedBeforeMemoryIsTakenForIt) {
  const Scratch scratch;
  const std::uint64_t size = (256ULL << 20) + 1;
  std::string bytes = "\x89MCAP0\r\n" + Maker().records();
  bytes.push_back(6);
  put_number(bytes, size, 8);
  std::ofstream(scratch.path(), std::ios::binary) << bytes;
  std::filesystem::resize_file(scratch.path(), size + 1000);  // a sparse file: no disk space used
  try {
    McapReader reader(scratch.path());
    EXPECT_FALSE(reader.whole());
    all_messages(reader);
    ADD_FAILURE() << "accepted";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("a record (chunk) of 268435457 bytes; allowed: up to "
                        "268435456"),
              std::string::npos)
        << error.what();
  }
}

TEST(McapReader, ALengthBeyondTheEndTakesNoMemory) {
  const std::string start = "\x89MCAP0\r\n" + Maker().records();
  for (const int op : {3, 4, 5, 6, 9, 12}) {
    std::string bytes = start;
    bytes.push_back(static_cast<char>(op));
    put_number(bytes, 200 << 20, 8);
    bytes += "abc";
    McapReader reader = opened(bytes);
    EXPECT_FALSE(reader.whole());
    EXPECT_TRUE(all_messages(reader).empty());
  }
}

}  // namespace mcap_reader_test
}  // namespace repel::record
