/// @file
/// Writes recordings as MCAP files (https://mcap.dev/spec), which survive a crash of the program.
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

struct McapOptions {
  std::string profile{};             ///< of the header; empty: none
  std::string library = "repel";     ///< of the header: who wrote the file
  std::size_t chunk_bytes = 262144;  ///< a chunk of so many bytes is finished; 1 to 64 MiB
  /// [ns] a chunk is finished before a message that lies so far from its first; 0: each message has
  /// its own. What a crash can lose.
  std::uint64_t chunk_ns = 500'000'000;
};

/// One MCAP file that is being written: chunks without compression, each with its index and handed
/// to the operating system when it is finished; attachments and metadata at once; the summary at
/// the end. A file that is cut off is whole up to its last finished chunk. What reaches the disk
/// when the power fails is up to the operating system.
///
/// Not for the tick: it takes heap and makes system calls. One thread at a time.
///
/// Trouble while writing does not throw: it stays in failed() and error(). After an error of the
/// file nothing more is written; what was refused (a channel that does not exist, something too
/// large) is left out, and the rest goes on.
class McapWriter {
 public:
  /// Opens the file at `path`, which it empties, and writes its header.
  /// @throws SetupError when that cannot be done or an option is out of range
  explicit McapWriter(const std::string& path, const McapOptions& options = {});

  /// Closes the file, if that is not done.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// A description of messages: `data` in the language `encoding` ("jsonschema", "ros2msg", ...).
  /// Returns its id, from 1. Written at once, and again in the first chunk that needs it.
  /// @throws SetupError for the 65536th or one of more than 16 MiB
  std::uint16_t add_schema(std::string_view name, std::string_view encoding, std::string_view data);

  /// A stream of messages in `encoding` ("json", "cdr", ...). `schema` is what add_schema()
  /// returned; 0: none. Returns its id, from 1. Written at once, and again in the first chunk that
  /// needs it.
  /// @throws SetupError for a schema that does not exist, an empty topic or one that another
  ///         channel has, the 65536th channel or one of more than 16 MiB
  std::uint16_t add_channel(std::string_view topic, std::uint16_t schema, std::string_view encoding,
                            const std::map<std::string, std::string>& metadata = {});

  /// A file within the file, at most 255 MiB, written at once. Time: [ns] since the epoch that the
  /// messages use.
  void attach(std::string_view name, std::string_view media_type, std::string_view bytes,
              std::uint64_t time_ns);

  /// Words about the recording, at most 16 MiB, written at once. Names may repeat.
  void add_metadata(std::string_view name, const std::map<std::string, std::string>& entries);

  /// One message of at most 64 MiB. Time: [ns] since an epoch of the caller's, as log time and as
  /// publish time; need not grow. Cost: a copy of `data`; a system call when it finishes a chunk.
  void write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns,
             std::string_view data);

  /// Finishes the chunk in progress, so that a crash cannot lose what was written so far.
  void flush();

  /// Finishes the chunk in progress, writes the summary and closes the file. Again: does nothing.
  void close();

  /// True when something that was handed over is not in the file, or not for certain.
  [[nodiscard]] bool failed() const noexcept { return !error_.empty(); }
  /// What failed first, with the path and the words of the operating system; empty: nothing.
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  /// Messages taken so far, those of the chunk in progress among them.
  [[nodiscard]] std::uint64_t messages() const noexcept { return messages_; }
  /// [bytes] handed to the operating system so far.
  [[nodiscard]] std::uint64_t bytes() const noexcept { return offset_; }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const noexcept { (void)std::fclose(file); }
  };
  struct Channel {
    std::string topic;
    std::string records;  // schema and channel, until a chunk has them
    std::string index;    // time and place of its messages in the chunk in progress
    std::uint64_t messages = 0;
  };

  void push(std::string_view bytes);
  void fail(std::string_view what);
  void finish_chunk();
  [[nodiscard]] std::string statistics() const;
  [[nodiscard]] std::string summary() const;

  std::string path_;
  McapOptions options_;
  std::unique_ptr<std::FILE, CloseFile> file_;  // none once it is closed or has failed
  std::string error_;
  std::uint64_t offset_ = 0;
  std::uint32_t crc_ = 0;  // of everything so far

  std::vector<std::string> schemas_;  // records
  std::vector<Channel> channels_;
  std::string channel_records_;
  std::string attachment_indices_;  // records of the summary, ready to be written
  std::string metadata_indices_;
  std::string chunk_indices_;
  std::uint32_t attachments_ = 0;
  std::uint32_t metadata_ = 0;
  std::uint32_t chunks_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t first_ns_ = 0;  // earliest and latest message of the file
  std::uint64_t last_ns_ = 0;

  std::string chunk_;  // the records of the chunk in progress
  std::uint64_t chunk_first_ns_ = 0;
  std::uint64_t chunk_last_ns_ = 0;
  std::string buffer_;  // keeps its memory from chunk to chunk
};

}  // namespace repel::record
