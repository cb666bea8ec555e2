// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Writes recordings as MCAP files (https://mcap.dev/spec) that stay readable after a crash.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace repel::record {

namespace detail {
class Packer;
}

/// How the content of chunks is stored.
enum class McapCompression : std::uint8_t {
  none,  ///< as they are
  zstd,  ///< as `none` where the library was built without zstd
};

/// Whether this library was built with zstd.
[[nodiscard]] bool has_zstd() noexcept;

/// Header and chunks of a file.
struct McapOptions {
  std::string profile{};             ///< of the header; empty: none
  std::string library = "repel";     ///< of the header: name of the writing software
  std::size_t chunk_bytes = 262144;  ///< a chunk of this size is finished; 1 to 64 MiB
  /// [ns] a chunk is finished before a message whose time differs this much from its first; 0: one
  /// chunk per message. Bounds what a crash can lose.
  std::uint64_t chunk_ns = 500'000'000;
  McapCompression compression = McapCompression::none;  ///< of the chunks
};

/// Writes one MCAP file: chunks, each with its index and passed to the operating system when it is
/// finished; attachments and metadata immediately; the summary at the end. A
/// truncated file is readable up to its last finished chunk. What reaches the disk in a power
/// failure depends on the operating system.
///
/// Not for use in the tick: it allocates and makes system calls. One thread at a time.
///
/// Write errors do not throw: failed() and error() report them. After an I/O error nothing more is
/// written; a refused item (a channel that does not exist, something too large) is omitted, and
/// writing continues.
class McapWriter {
 public:
  /// Creates or truncates the file at `path` and writes its header.
  /// @throws SetupError if that fails or an option is out of range
  explicit McapWriter(const std::string& path, const McapOptions& options = {});

  /// Closes the file, if still open.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Adds a description of messages: `data` in the language `encoding` ("jsonschema", "ros2msg",
  /// ...). Returns its id, from 1. Written immediately, and again in the first chunk that needs it.
  /// @throws SetupError above 65535 schemas or for one above 16 MiB
  std::uint16_t add_schema(std::string_view name, std::string_view encoding, std::string_view data);

  /// Adds a stream of messages in `encoding` ("json", "cdr", ...). `schema` is an id from
  /// add_schema(); 0: none. Returns its id, from 1. Written immediately, and again in the first
  /// chunk that needs it.
  /// @throws SetupError for an unknown schema, a topic empty or already used, above 65535 channels
  ///   or for one above 16 MiB
  std::uint16_t add_channel(std::string_view topic, std::uint16_t schema, std::string_view encoding,
                            const std::map<std::string, std::string>& metadata = {});

  /// Embeds a file of at most 255 MiB, written immediately. Time: [ns] since the epoch of the
  /// messages.
  void attach(std::string_view name, std::string_view media_type, std::string_view bytes,
              std::uint64_t time_ns);

  /// Adds key-value data about the recording, at most 16 MiB, written immediately. Names may
  /// repeat.
  void add_metadata(std::string_view name, const std::map<std::string, std::string>& entries);

  /// Adds one message of at most 64 MiB. Time: [ns] since an epoch chosen by the caller, used as
  /// log time and publish time; need not increase. Cost: a copy of `data`; a system call if it
  /// finishes a chunk.
  void write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns,
             std::string_view data);

  /// Finishes the current chunk, so a crash cannot lose it.
  void flush();

  /// Finishes the current chunk, writes the summary and closes the file. Further calls do nothing.
  void close();

  /// True if anything passed in is missing in the file, or may be.
  [[nodiscard]] bool failed() const noexcept { return !error_.empty(); }
  /// The first failure, with path and message of the operating system; empty: none.
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  /// Messages accepted so far, including those of the current chunk.
  [[nodiscard]] std::uint64_t messages() const noexcept { return messages_; }
  /// [bytes] passed to the operating system so far.
  [[nodiscard]] std::uint64_t bytes() const noexcept { return offset_; }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const noexcept { (void)std::fclose(file); }
  };
  struct Channel {
    std::string topic;
    std::string records;  // schema and channel, until written to a chunk
    std::string index;    // time and position of its messages in the current chunk
    std::uint64_t messages = 0;
  };

  void push(std::string_view bytes);
  void fail(std::string_view what);
  void finish_chunk();
  [[nodiscard]] std::string statistics() const;
  [[nodiscard]] std::string summary() const;

  std::string path_;
  McapOptions options_;
  std::unique_ptr<std::FILE, CloseFile> file_;  // null once it is closed or has failed
  std::string error_;
  std::uint64_t offset_ = 0;
  std::uint32_t crc_ = 0;  // of everything written so far

  std::vector<std::string> schemas_;  // records
  std::vector<Channel> channels_;
  std::string channel_records_;
  std::string attachment_indices_;  // serialised records of the summary
  std::string metadata_indices_;
  std::string chunk_indices_;
  std::uint32_t attachments_ = 0;
  std::uint32_t metadata_ = 0;
  std::uint32_t chunks_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t first_ns_ = 0;  // earliest and latest message of the file
  std::uint64_t last_ns_ = 0;

  std::string chunk_;  // the records of the current chunk
  std::uint64_t chunk_first_ns_ = 0;
  std::uint64_t chunk_last_ns_ = 0;
  std::string buffer_;                      // member, to reuse its memory
  std::string packed_;                      // likewise
  std::unique_ptr<detail::Packer> packer_;  // null: chunks are not compressed
};

}  // namespace repel::record
