// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as an MCAP file, and records with a valid beginning: read to the end safely, or
// refused by SetupError. Reading terminates, uses no byte twice, and loses nothing when repeated.
#include <repel/record/mcap_reader.hpp>

#include <string>

#include <fuzz/bytes.hpp>
#include <repel/base/setup_error.hpp>

namespace repel::record {
namespace {

using fuzz::Bytes;
using fuzz::require;

const std::string magic("\x89MCAP0\r\n", 8);

struct Summed {
  std::size_t messages = 0;
  std::size_t bytes = 0;
  std::size_t errors = 0;
  bool operator==(const Summed&) const = default;
};

/// [bytes] The most messages that a file can hold: more than its own size only if it is compressed.
std::size_t most_in(const std::string& file) {
  return file.find("zstd") == std::string::npos ? file.size() : (file.size() / 4 + 1) * 131072;
}

/// @param most [bytes] as of most_in
Summed read_all(McapReader& reader, std::size_t most) {
  Summed sum;
  McapMessage message;
  for (bool more = true; more;) {
    try {
      more = reader.next(message);
      if (!more) break;
      ++sum.messages;
      sum.bytes += message.data.size();
      require(reader.channels().contains(message.channel), "a message has a channel");
    } catch (const SetupError& error) {
      require(error.file() == "memory", "an error names the file");
      ++sum.errors;
    }
    require(sum.messages + sum.errors <= most, "reading comes to an end");
  }
  require(sum.bytes <= most, "no byte is read twice");
  return sum;
}

void check_file(const std::string& bytes) {
  try {
    McapReader reader = McapReader::from_bytes(bytes);
    require(reader.whole() == reader.why_not_whole().empty(), "what is not whole says why");
    const Summed first = read_all(reader, most_in(bytes));
    require(reader.whole() || first.errors > 0 ||
                reader.why_not_whole().find("byte") != std::string::npos,
            "what is not whole says where");
    std::size_t attached = 0;
    for (const McapAttachment& attachment : reader.attachments())
      attached += attachment.data.size();
    require(attached <= bytes.size(), "no attachment is read twice");
    reader.rewind();
    const Summed again = read_all(reader, most_in(bytes));
    require(again.messages >= first.messages && again.errors <= first.errors,
            "reading again loses nothing");
    // A damaged file may describe a channel after its messages: it is known only in the second
    // pass.
    if (reader.whole() && first.errors == 0) require(again == first, "and gives the same");
  } catch (const SetupError& error) {
    require(error.file() == "memory", "an error names the file");
  }
}

/// A record whose length is usually right, so that its contents are parsed.
void put_record(std::string& file, Bytes& bytes, int depth) {
  const auto op = bytes.take<std::uint8_t>();
  std::string content;
  if (depth == 0 && op % 4 == 0) {
    std::string records;
    for (int i = op % 5; i >= 0; --i) put_record(records, bytes, 1);
    content = std::string(16, '\0');
    for (int i = 0; i < 8; ++i) content += static_cast<char>(records.size() >> (8 * i));
    content += std::string(8, '\0');  // no CRC, no compression
    for (int i = 0; i < 8; ++i) content += static_cast<char>(records.size() >> (8 * i));
    content += records;
    file += '\x06';
  } else {
    for (int i = bytes.take<std::uint8_t>() % 48; i > 0; --i) {
      const auto b = bytes.take<std::uint8_t>();
      content += static_cast<char>(b < 128 ? b % 4 : b);
    }
    file += static_cast<char>(op % 17);
  }
  std::uint64_t length = content.size();
  if (bytes.take<std::uint8_t>() == 255) length = bytes.take<std::uint64_t>();
  for (int i = 0; i < 8; ++i) file += static_cast<char>(length >> (8 * i));
  file += content;
}

void check_one(const std::uint8_t* data, std::size_t size) {
  const std::string raw(data, data + size);
  check_file(raw);
  check_file(magic + std::string("\x01\x08\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 17) + raw);

  std::string built = magic + std::string("\x01\x08\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 17);
  Bytes bytes(data, size);
  for (int i = bytes.take<std::uint8_t>() % 16; i > 0; --i) put_record(built, bytes, 0);
  check_file(built);
}

}  // namespace
}  // namespace repel::record

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  repel::record::check_one(data, size);
  return 0;
}
