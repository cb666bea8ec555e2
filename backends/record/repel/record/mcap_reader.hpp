// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads recordings: MCAP files (https://mcap.dev/spec), uncompressed or, if the library was built
/// with zstd, compressed by it; complete or truncated.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace repel::record {

/// A description of the messages of a channel.
struct McapSchema {
  std::string name;      ///< of the type of the messages
  std::string encoding;  ///< of `data`: "jsonschema", "ros2msg", ...
  std::string data;      ///< the description itself
  /// Equal in all members.
  bool operator==(const McapSchema&) const = default;
};

/// A stream of messages.
struct McapChannel {
  std::string topic;                            ///< of the messages
  std::uint16_t schema = 0;                     ///< its id; 0: none
  std::string encoding;                         ///< of the messages: "json", "cdr", ...
  std::map<std::string, std::string> metadata;  ///< of the channel, for whoever knows its keys
  /// Equal in all members.
  bool operator==(const McapChannel&) const = default;
};

/// One message. Times are [ns] since an epoch that the writer chose.
struct McapMessage {
  std::uint16_t channel = 0;          ///< its id, see channels()
  std::uint32_t sequence = 0;         ///< as the writer counts
  std::uint64_t log_time_ns = 0;      ///< when it was recorded
  std::uint64_t publish_time_ns = 0;  ///< when it was sent
  std::string_view data;              ///< valid until the next call of the reader
};

/// A file embedded in the MCAP file.
struct McapAttachment {
  std::string name;                  ///< name of the file
  std::string media_type;            ///< as "text/plain"
  std::uint64_t log_time_ns = 0;     ///< when it was recorded
  std::uint64_t create_time_ns = 0;  ///< 0: unknown
  std::string data;                  ///< its content
};

/// Key-value data about the recording.
struct McapMetadata {
  std::string name;                            ///< of these data
  std::map<std::string, std::string> entries;  ///< by their keys
};

/// One MCAP file, read sequentially, with one chunk at a time in memory. Indices are not used.
/// Limits: 256 MiB for a record, 1 GiB for what is kept in memory.
///
/// A truncated file can be read: the reader returns every complete message and reports that the
/// file is incomplete. Damage is an error, reported after everything that precedes it.
class McapReader {
 public:
  /// Opens the file at `path` and reads everything except the messages. Cost: reads the first nine
  /// bytes of every record, and all of attachments, metadata, schemas, channels and the summary.
  /// @throws SetupError naming the byte, its value and the allowed one, if the file cannot be read
  ///   or does not start as an MCAP file
  explicit McapReader(const std::string& path);

  /// The same for a file in memory; `name` replaces its path in errors.
  [[nodiscard]] static McapReader from_bytes(std::string bytes, const std::string& name = "memory");

  ~McapReader();
  /// Moves; the other may then only be assigned to or destroyed.
  McapReader(McapReader&&) noexcept;
  /// Moves; the other may then only be assigned to or destroyed.
  McapReader& operator=(McapReader&&) noexcept;
  McapReader(const McapReader&) = delete;
  McapReader& operator=(const McapReader&) = delete;

  /// From the header; empty: none, or the file is truncated before it.
  [[nodiscard]] const std::string& profile() const noexcept;
  /// The software that wrote it, from the header.
  [[nodiscard]] const std::string& library() const noexcept;

  /// By id. Those that are only in chunks, in a file without summary, are found by next().
  [[nodiscard]] const std::map<std::uint16_t, McapSchema>& schemas() const noexcept;
  /// Channels by id, likewise.
  [[nodiscard]] const std::map<std::uint16_t, McapChannel>& channels() const noexcept;

  /// In file order.
  [[nodiscard]] const std::vector<McapAttachment>& attachments() const noexcept;
  /// Likewise in file order.
  [[nodiscard]] const std::vector<McapMetadata>& metadata() const noexcept;

  /// Reads the next message in file order. At the end returns false and leaves `message` unchanged.
  /// Cost: at the start of a chunk, reads and checks all of it.
  /// @throws SetupError naming the byte, for a damaged chunk or one whose compression was not built
  /// in
  ///   (it is skipped, and the next call continues after it), and once at the end if anything else
  ///   is damaged
  bool next(McapMessage& message);

  /// Restarts next() from the beginning. Keeps the schemas and channels found.
  void rewind();

  /// False if the file is truncated or damaged, as far as known at opening: damage within chunks is
  /// found by next().
  [[nodiscard]] bool whole() const noexcept { return why_not_whole().empty(); }
  /// Description with the path; empty: the file is complete.
  [[nodiscard]] const std::string& why_not_whole() const noexcept;

 private:
  struct State;
  explicit McapReader(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace repel::record
