// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Small recordings, their contents, and a parser of their records that is independent of the
/// library.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <repel/record/mcap_reader.hpp>
#include <repel/record/mcap_writer.hpp>

namespace repel::record::testing {

/// A temporary file path; the file is removed by the destructor.
class Scratch {
 public:
  Scratch() : path_(std::filesystem::temp_directory_path() / name()) {}
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] std::string path() const { return path_.string(); }
  [[nodiscard]] std::string bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  static std::string name() {
    static int count = 0;
    return "repel_record_" + std::to_string(::getpid()) + "_" + std::to_string(count++) + ".mcap";
  }
  std::filesystem::path path_;
};

/// A message with its own copy of the bytes.
struct Taken {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t time_ns = 0;
  std::string data{};
  bool operator==(const Taken&) const = default;
};

inline Taken taken(const McapMessage& m) {
  return {m.channel, m.sequence, m.log_time_ns, std::string(m.data)};
}

inline std::vector<Taken> all_messages(McapReader& reader) {
  std::vector<Taken> messages;
  McapMessage message;
  while (reader.next(message)) messages.push_back(taken(message));
  return messages;
}

/// Writes that many random messages in two channels, one of them without a schema and used from the
/// third message on, with an attachment and metadata in between. Returns the messages.
inline std::vector<Taken> write_recording(McapWriter& writer, int count, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  const auto schema = writer.add_schema("Tick", "jsonschema", R"({"type": "object"})");
  const auto ticks = writer.add_channel("tick", schema, "json", {{"unit", "m"}, {"", ""}});
  writer.add_metadata("run", {{"scene", "anderson_4x8"}, {"seed", std::to_string(seed)}});
  const auto raw = writer.add_channel("raw", 0, "x-bytes");
  std::vector<Taken> messages;
  for (int i = 0; i < count; ++i) {
    Taken m{.channel = i > 2 && rng() % 3 == 0 ? raw : ticks, .sequence = std::uint32_t(i)};
    m.time_ns = 1'000'000'000 + std::uint64_t(i) * 2'500'000 + rng() % 1000;
    for (std::size_t size = rng() % 24; size > 0; --size) m.data.push_back(char(rng()));
    if (i == count / 2) writer.attach("scene.yaml", "application/yaml", "name: x\n", m.time_ns);
    writer.write(m.channel, m.sequence, m.time_ns, m.data);
    messages.push_back(m);
  }
  return messages;
}

/// A recording of 40 messages in several chunks, as bytes.
struct Recording {
  std::string bytes;
  std::vector<Taken> messages;
};

inline Recording small_recording(std::uint64_t seed, int count = 40,
                                 McapCompression compression = McapCompression::none) {
  const Scratch scratch;
  Recording result;
  McapWriter writer(scratch.path(),
                    {.profile = "x-repel", .chunk_bytes = 400, .compression = compression});
  result.messages = write_recording(writer, count, seed);
  writer.close();
  result.bytes = scratch.bytes();
  return result;
}

/// The little-endian number of `width` bytes at `at`.
inline std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t width) {
  std::uint64_t value = 0;
  for (std::size_t i = width; i > 0; --i) {
    value = value << 8 | static_cast<std::uint8_t>(bytes.at(at + i - 1));
  }
  return value;
}

inline void put_number(std::string& bytes, std::uint64_t value, std::size_t width) {
  for (std::size_t i = 0; i < width; ++i) {
    bytes.push_back(i < 8 ? static_cast<char>(value >> (8 * i)) : '\0');
  }
}

/// One record of a file.
struct RawRecord {
  int op = 0;
  std::size_t offset = 0;  ///< of its first byte
  std::string_view content;
  [[nodiscard]] std::size_t size() const { return 9 + content.size(); }
  [[nodiscard]] std::uint64_t number(std::size_t at, std::size_t width) const {
    return number_at(content, at, width);
  }
};

inline RawRecord record_at(std::string_view bytes, std::size_t offset) {
  return {static_cast<std::uint8_t>(bytes.at(offset)), offset,
          bytes.substr(offset + 9, number_at(bytes, offset + 1, 8))};
}

/// All records between `from` and `to`.
inline std::vector<RawRecord> records_between(std::string_view bytes, std::size_t from,
                                              std::size_t to) {
  std::vector<RawRecord> records;
  while (from < to) {
    records.push_back(record_at(bytes, from));
    from += records.back().size();
  }
  return records;
}

inline std::vector<RawRecord> records_of(std::string_view file) {
  return records_between(file, 8, file.size() - 8);
}

/// CRC computed bit by bit from its definition.
inline std::uint32_t slow_crc32(std::string_view bytes) {
  std::uint32_t crc = ~0U;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc % 2 != 0 ? crc / 2 ^ 0xedb88320U : crc / 2;
  }
  return ~crc;
}

}  // namespace repel::record::testing
