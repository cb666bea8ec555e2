/// @file
/// Reads recordings: MCAP files (https://mcap.dev/spec) without compression, whole or cut off.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace repel::record {

/// What messages look like.
struct McapSchema {
  std::string name;
  std::string encoding;  ///< of `data`: "jsonschema", "ros2msg", ...
  std::string data;
  bool operator==(const McapSchema&) const = default;
};

/// A stream of messages.
struct McapChannel {
  std::string topic;
  std::uint16_t schema = 0;  ///< its id; 0: none
  std::string encoding;      ///< of the messages: "json", "cdr", ...
  std::map<std::string, std::string> metadata;
  bool operator==(const McapChannel&) const = default;
};

/// One message. Times are [ns] since an epoch that the writer chose.
struct McapMessage {
  std::uint16_t channel = 0;  ///< its id; channels() has it
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
  std::string_view data;  ///< stands until the next call of the reader
};

/// A file within the file.
struct McapAttachment {
  std::string name;
  std::string media_type;
  std::uint64_t log_time_ns = 0;
  std::uint64_t create_time_ns = 0;  ///< 0: not known
  std::string data;
};

/// Words about the recording.
struct McapMetadata {
  std::string name;
  std::map<std::string, std::string> entries;
};

/// One MCAP file, read from front to back, in memory one chunk at a time. Indices are not needed
/// and not looked at. At most 256 MiB for a record and 1 GiB for what is kept are taken.
///
/// A file that was cut off can be read: it gives every message that is complete, and says that it
/// is not whole. Damage is an error, which comes after everything that stands before it.
class McapReader {
 public:
  /// Opens the file at `path` and finds everything but the messages. Cost: reads the first nine
  /// bytes of every record, and all of attachments, metadata, schemas, channels and the summary.
  /// @throws SetupError, naming the byte, what was found and what is allowed, when the file cannot
  ///         be read or does not begin as MCAP files do
  explicit McapReader(const std::string& path);

  /// The same for a file in memory; `name` stands for its path in errors.
  [[nodiscard]] static McapReader from_bytes(std::string bytes, const std::string& name = "memory");

  ~McapReader();
  McapReader(McapReader&&) noexcept;
  McapReader& operator=(McapReader&&) noexcept;
  McapReader(const McapReader&) = delete;
  McapReader& operator=(const McapReader&) = delete;

  /// Of the header; empty: none, or the file is cut off before.
  [[nodiscard]] const std::string& profile() const noexcept;
  [[nodiscard]] const std::string& library() const noexcept;

  /// By id. Where they stand only in chunks and the file has no summary, next() finds them.
  [[nodiscard]] const std::map<std::uint16_t, McapSchema>& schemas() const noexcept;
  [[nodiscard]] const std::map<std::uint16_t, McapChannel>& channels() const noexcept;

  /// In the order of the file.
  [[nodiscard]] const std::vector<McapAttachment>& attachments() const noexcept;
  [[nodiscard]] const std::vector<McapMetadata>& metadata() const noexcept;

  /// The next message of the file, in the order it was written; false, and `message` as it was,
  /// when there is none. Cost: when it comes to a new chunk, reads and checks all of it.
  /// @throws SetupError, naming the byte, for a chunk that is compressed or damaged (it is left
  /// out,
  ///         and another call goes on behind it), and once at the end when anything else is damaged
  bool next(McapMessage& message);

  /// next() begins again. What it has learned of schemas and channels stays.
  void rewind();

  /// False when the file was cut off or is damaged, as far as opening it could tell: damage within
  /// chunks shows in next().
  [[nodiscard]] bool whole() const noexcept { return why_not_whole().empty(); }
  /// In words, with the path; empty: it is whole.
  [[nodiscard]] const std::string& why_not_whole() const noexcept;

 private:
  struct State;
  explicit McapReader(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace repel::record
