// SPDX-License-Identifier: BSD-3-Clause
#include <repel/record/mcap_reader.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <utility>

#include <repel/base/setup_error.hpp>

#include "crc32.hpp"
#include "mcap_fields.hpp"
#include "mcap_format.hpp"
#include "mcap_source.hpp"
#include "packing.hpp"

namespace repel::record {

using detail::Fields;
using detail::Op;
using detail::Record;
using detail::Source;

namespace {

/// The fields before the records of a chunk.
struct ChunkHead {
  std::uint64_t size = 0;  // [bytes] of the uncompressed records
  std::uint32_t crc = 0;   // of these records; 0: none
  std::string_view compression;
  std::uint64_t length = 0;  // [bytes] of the records as stored in the file
};

std::string name_of(Op op) {
  static constexpr std::array<const char*, 16> names{
      "empty",      "header",           "footer",
      "schema",     "channel",          "message",
      "chunk",      "message index",    "chunk index",
      "attachment", "attachment index", "statistics",
      "metadata",   "metadata index",   "summary offset",
      "end of data"};
  const auto i = static_cast<std::size_t>(op);
  return i < names.size() ? names[i] : "unknown (" + std::to_string(i) + ")";
}

std::string hex(std::uint32_t value) {
  std::array<char, 8> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, 16).ptr;
  std::string text = "0x";
  text.append(digits.data(), end);
  return text;
}

/// A CRC of 0 means that the writer omitted it.
void check_crc(const Source& source, std::uint64_t offset, const char* what, std::uint32_t found,
               std::uint32_t computed) {
  if (found == 0 || found == computed) return;
  std::string text = "the CRC of ";
  text += what;
  text += " is " + hex(found) + ", but its bytes have " + hex(computed);
  source.fail(offset, text);
}

ChunkHead chunk_head(Fields& fields) {
  (void)fields.take(16);  // the times of its first and last message
  ChunkHead head;
  head.size = fields.number<std::uint64_t>();
  head.crc = fields.number<std::uint32_t>();
  head.compression = fields.text();
  head.length = fields.number<std::uint64_t>();
  return head;
}

}  // namespace

struct McapReader::State {
  explicit State(Source&& from) : source(std::move(from)) {}

  void read_all_but_messages();
  bool next(McapMessage& message);

  // Opening.
  bool begins_as_mcap();
  void survey();
  std::optional<Record> record_at(std::uint64_t offset);
  void cut(const std::string& what);
  void load(const Record& record);
  void keep(std::uint64_t bytes, std::uint64_t offset);
  void note_damage(const SetupError& error);
  void take(const Record& record);
  void take_header(Fields content);
  void take_schema(Fields content);
  void take_channel(Fields content);
  void take_attachment(Fields content);
  void take_metadata(Fields content);
  void take_footer(const Record& footer, Fields content);
  void check_ending(std::uint64_t offset);
  std::uint32_t crc_of(std::uint64_t from, std::uint64_t to, std::uint32_t before);

  // Reading messages.
  bool take_record(McapMessage& message);
  void open_chunk(const Record& record);
  void open_cut_chunk();
  void check_compression(const ChunkHead& head, std::uint64_t offset) const;
  [[nodiscard]] std::string_view unpacked_chunk(const ChunkHead& head, std::string_view stored,
                                                const Record& record);
  bool next_of_chunk(McapMessage& message);
  void take_message(Fields content, McapMessage& message) const;
  void finish();

  Source source;
  std::string buffer;    // the current record
  std::string unpacked;  // the records of the current chunk, if it is compressed
  detail::Unpacker unpacker;

  std::string profile;
  std::string library;
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;
  std::vector<McapAttachment> attachments;
  std::vector<McapMetadata> metadata;
  std::uint64_t kept = 0;            // [bytes] estimate of the memory used by the above
  std::uint64_t end_of_data = 0;     // end of the last record that can contain messages
  std::optional<Record> cut_chunk;   // truncated chunk; begins at end_of_data
  std::uint64_t summary_from = 0;    // end of the data-end record
  std::uint32_t data_crc = 0;        // of everything before the data-end record; 0: none
  std::string why;                   // why the file is incomplete
  std::optional<SetupError> damage;  // found when opening, after everything that was read

  std::uint64_t at = detail::magic.size();  // position of the next record
  std::uint32_t crc = 0;                    // of everything before it
  std::string_view chunk;                   // remaining records of the current chunk
  std::uint64_t chunk_at = 0;               // their position in the file, or in `unpacked`
  std::optional<std::uint64_t> packed_at;   // of the current chunk in the file, if compressed
  bool chunk_is_cut = false;
  bool finished = false;
};

void McapReader::State::read_all_but_messages() {
  end_of_data = detail::magic.size();
  if (!begins_as_mcap()) return;
  try {
    survey();
  } catch (const SetupError& error) {
    note_damage(error);
  }
}

/// False if the file is truncated before the end of its first record.
bool McapReader::State::begins_as_mcap() {
  buffer.resize(std::min<std::uint64_t>(source.size(), detail::magic.size()));
  source.read(0, buffer);
  if (buffer != detail::magic.substr(0, buffer.size())) {
    source.fail(0,
                "no MCAP file, version 0; allowed: one that begins with the bytes "
                "89 4d 43 41 50 30 0d 0a");
  }
  if (buffer.size() < detail::magic.size()) {
    end_of_data = 0;
    at = 0;
    cut("within the first 8 bytes");
    return false;
  }
  const std::optional<Record> first = record_at(detail::magic.size());
  if (!first) return false;
  if (first->op != Op::header) {
    source.fail(first->offset, "the first record is " + name_of(first->op) + "; allowed: header");
  }
  load(*first);
  take_header(Fields(source, buffer, first->content()));
  end_of_data = first->end();
  return true;
}

void McapReader::State::cut(const std::string& what) {
  why = source.name() + ": cut off at byte " + std::to_string(source.size()) + ", ";
  why += what;
}

/// The record at `offset`; none, and `why` set, if the file ends before the record does.
std::optional<Record> McapReader::State::record_at(std::uint64_t offset) {
  const std::uint64_t left = source.size() - offset;
  if (left < detail::prefix_bytes) {
    cut("before the closing records");
    return std::nullopt;
  }
  buffer.resize(detail::prefix_bytes);
  source.read(offset, buffer);
  Fields prefix(source, buffer, offset);
  Record record{.op = static_cast<Op>(prefix.number<std::uint8_t>()), .offset = offset};
  record.length = prefix.number<std::uint64_t>();
  if (record.op == Op{}) {  // as file systems may leave after a power failure
    why = source.name() + ": no record at byte " + std::to_string(offset);
    why += ", only zeros";
    return std::nullopt;
  }
  if (record.length > detail::largest_record) {
    source.fail(offset, "a record (" + name_of(record.op) + ") of " +
                            std::to_string(record.length) + " bytes; allowed: up to " +
                            std::to_string(detail::largest_record));
  }
  if (record.length > left - detail::prefix_bytes) {
    if (record.op == Op::chunk) cut_chunk = record;
    cut("within the record (" + name_of(record.op) + ") at byte " + std::to_string(offset));
    return std::nullopt;
  }
  return record;
}

void McapReader::State::load(const Record& record) {
  buffer.resize(record.length);
  source.read(record.content(), buffer);
}

/// Visits all records after the header. Sets `why` if the file is truncated.
void McapReader::State::survey() {
  bool in_data = true;
  std::uint64_t offset = end_of_data;
  while (const std::optional<Record> record = record_at(offset)) {
    if (record->op == Op::footer && in_data) {
      source.fail(offset, "a footer; allowed: the end of data first");
    }
    try {
      take(*record);
    } catch (const SetupError& error) {
      note_damage(error);  // what follows can still be read
    }
    if (record->op == Op::footer) return;
    in_data = in_data && record->op != Op::data_end;
    offset = record->end();
    if (in_data) end_of_data = offset;
  }
}

/// Reads a record of any type except messages.
void McapReader::State::take(const Record& record) {
  const bool wanted = record.op == Op::schema || record.op == Op::channel ||
                      record.op == Op::attachment || record.op == Op::metadata ||
                      record.op == Op::data_end || record.op == Op::footer;
  if (!wanted) return;
  if (record.op == Op::attachment) keep(record.length, record.offset);
  load(record);
  Fields content(source, buffer, record.content());
  if (record.op == Op::schema) take_schema(content);
  if (record.op == Op::channel) take_channel(content);
  if (record.op == Op::attachment) take_attachment(content);
  if (record.op == Op::metadata) take_metadata(content);
  if (record.op == Op::data_end) {
    data_crc = content.number<std::uint32_t>();
    summary_from = record.end();
  }
  if (record.op == Op::footer) take_footer(record, content);
}

/// Keeps the first error.
void McapReader::State::note_damage(const SetupError& error) {
  if (damage) return;
  damage = error;
  why = error.what();
}

/// Accounts for memory that stays in use.
void McapReader::State::keep(std::uint64_t bytes, std::uint64_t offset) {
  kept += bytes + 256;  // overhead of the smallest entry
  if (kept <= detail::largest_kept) return;
  source.fail(offset,
              "schemas, channels, attachments and metadata need more memory than allowed, " +
                  std::to_string(detail::largest_kept) + " bytes");
}

void McapReader::State::take_header(Fields content) {
  profile = content.text();
  library = content.text();
}

void McapReader::State::take_schema(Fields content) {
  const std::uint64_t offset = content.offset();
  const auto id = content.number<std::uint16_t>();
  McapSchema schema;
  schema.name = content.text();
  schema.encoding = content.text();
  schema.data = content.text();
  if (id == 0) return;  // invalid id: to be ignored by the specification
  const auto known = schemas.find(id);
  if (known == schemas.end()) {
    keep(content.offset() - offset, offset);
    schemas.emplace(id, std::move(schema));
  } else if (known->second != schema) {
    source.fail(offset, "a second schema " + std::to_string(id) + "; allowed: only the same again");
  }
}

void McapReader::State::take_channel(Fields content) {
  const std::uint64_t offset = content.offset();
  const auto id = content.number<std::uint16_t>();
  McapChannel channel;
  channel.schema = content.number<std::uint16_t>();
  channel.topic = content.text();
  channel.encoding = content.text();
  channel.metadata = content.map();
  if (channel.schema != 0 && !schemas.contains(channel.schema)) {
    source.fail(offset, "channel '" + channel.topic + "' has schema " +
                            std::to_string(channel.schema) + "; allowed: 0 or one before it");
  }
  const auto known = channels.find(id);
  if (known == channels.end()) {
    keep((content.offset() - offset) * 16, offset);  // estimated overhead of small map entries
    channels.emplace(id, std::move(channel));
  } else if (known->second != channel) {
    source.fail(offset,
                "a second channel " + std::to_string(id) + "; allowed: only the same again");
  }
}

void McapReader::State::take_attachment(Fields content) {
  const std::uint64_t offset = content.offset();
  const std::string_view bytes = content.left();
  McapAttachment attachment;
  attachment.log_time_ns = content.number<std::uint64_t>();
  attachment.create_time_ns = content.number<std::uint64_t>();
  attachment.name = content.text();
  attachment.media_type = content.text();
  attachment.data = content.long_text();
  const std::string_view covered = bytes.substr(0, content.offset() - offset);
  const auto found = content.number<std::uint32_t>();
  check_crc(source, offset, "the attachment", found, detail::crc32(covered));
  attachments.push_back(std::move(attachment));
}

void McapReader::State::take_metadata(Fields content) {
  keep(content.left().size() * 16, content.offset());
  McapMetadata words;
  words.name = content.text();
  words.entries = content.map();
  metadata.push_back(std::move(words));
}

void McapReader::State::take_footer(const Record& footer, Fields content) {
  check_ending(footer.end());
  if (footer.length != detail::footer_bytes) {
    source.fail(footer.offset, "a footer of " + std::to_string(footer.length) +
                                   " bytes; allowed: " + std::to_string(detail::footer_bytes));
  }
  const auto start = content.number<std::uint64_t>();
  (void)content.take(8);  // position of the summary offset section
  const std::uint64_t covered_end = content.offset();
  const auto found = content.number<std::uint32_t>();
  const std::uint64_t summary = start == 0 ? footer.offset : start;  // 0: no summary
  if (summary < summary_from || summary > footer.offset) {
    source.fail(footer.content(), "the summary is said to begin at byte " + std::to_string(start) +
                                      "; allowed: " + std::to_string(summary_from) + " to " +
                                      std::to_string(footer.offset));
  }
  if (found == 0) return;
  check_crc(source, summary, "the summary", found, crc_of(summary, covered_end, 0));
}

/// Checks the bytes after the footer.
void McapReader::State::check_ending(std::uint64_t offset) {
  std::string ending(std::min<std::uint64_t>(source.size() - offset, detail::magic.size()), ' ');
  source.read(offset, ending);
  if (ending != detail::magic.substr(0, ending.size())) {
    source.fail(offset, "the file does not end with the bytes it begins with");
  }
  if (ending.size() < detail::magic.size()) return cut("within the last 8 bytes");
  const std::uint64_t behind = source.size() - offset - ending.size();
  if (behind == 0) return;
  source.fail(offset + ending.size(),
              std::to_string(behind) + " bytes behind the end; allowed: none");
}

/// CRC of the bytes [from, to) of the file, continuing from `before`.
std::uint32_t McapReader::State::crc_of(std::uint64_t from, std::uint64_t to,
                                        std::uint32_t before) {
  constexpr std::uint64_t block = 65536;
  while (from < to) {
    buffer.resize(std::min(block, to - from));
    source.read(from, buffer);
    before = detail::crc32(buffer, before);
    from += buffer.size();
  }
  return before;
}

bool McapReader::State::next(McapMessage& message) {
  while (true) {
    if (!chunk.empty()) {
      if (next_of_chunk(message)) return true;
    } else if (at < end_of_data) {
      if (take_record(message)) return true;
    } else if (cut_chunk && at == cut_chunk->offset) {
      at = source.size();
      open_cut_chunk();
    } else if (!finished) {
      finish();
    } else {
      return false;
    }
  }
}

/// Processes the next record of the file; true if it is a message.
bool McapReader::State::take_record(McapMessage& message) {
  const std::uint64_t offset = at;
  if (offset == detail::magic.size()) crc = detail::crc32(detail::magic);
  const std::optional<Record> record = record_at(offset);
  if (!record) source.fail(offset, "the file has changed since it was opened");
  at = record->end();
  if (record->op != Op::chunk && record->op != Op::message) {
    if (data_crc != 0) crc = crc_of(offset, at, crc);
    return false;
  }
  if (data_crc != 0) crc = detail::crc32(buffer, crc);  // type and length
  load(*record);
  if (data_crc != 0) crc = detail::crc32(buffer, crc);
  if (record->op == Op::chunk) {
    open_chunk(*record);
    return false;
  }
  take_message(Fields(source, buffer, record->content()), message);
  return true;
}

void McapReader::State::check_compression(const ChunkHead& head, std::uint64_t offset) const {
  if (head.compression.empty()) return;
  std::string what = "a chunk compressed with '";
  what += head.compression;
  if (head.compression != detail::zstd_name) {
    source.fail(offset, what + "'; allowed: 'zstd', or chunks without compression");
  }
  const std::string_view remedy = detail::how_to_have_zstd();
  if (remedy.empty()) return;
  what += "', which was not built in; to have it: ";
  what += remedy;
  source.fail(offset, what);
}

/// The records of a compressed chunk; of a truncated one those that can be decompressed.
std::string_view McapReader::State::unpacked_chunk(const ChunkHead& head, std::string_view stored,
                                                   const Record& record) {
  // A short chunk cannot make it decompress for long, whatever size it claims.
  const std::uint64_t most = std::min(detail::largest_record, detail::most_unpacked(head.length));
  if (head.size > most) {
    source.fail(record.offset, "a compressed chunk of " + std::to_string(head.length) +
                                   " bytes that is said to have " + std::to_string(head.size) +
                                   "; allowed: up to " + std::to_string(most));
  }
  using Outcome = detail::Unpacker::Outcome;
  const Outcome outcome = unpacker.unpack(stored, head.size, unpacked);
  if (outcome == Outcome::whole || chunk_is_cut) return unpacked;
  source.fail(record.offset, "a compressed chunk that does not decompress to the " +
                                 std::to_string(head.size) + " bytes it is said to have");
}

void McapReader::State::open_chunk(const Record& record) {
  Fields content(source, buffer, record.content());
  const ChunkHead head = chunk_head(content);
  check_compression(head, record.offset);
  const std::uint64_t stored_at = content.offset();
  const std::string_view stored = content.take(head.length);
  const bool is_packed = !head.compression.empty();
  chunk_is_cut = false;
  if (!is_packed && head.size != head.length) {
    source.fail(record.offset, "a chunk of " + std::to_string(head.length) +
                                   " bytes that is said to have " + std::to_string(head.size));
  }
  const std::string_view records = is_packed ? unpacked_chunk(head, stored, record) : stored;
  check_crc(source, record.offset, "the chunk", head.crc, detail::crc32(records));
  chunk = records;
  packed_at = is_packed ? std::optional(record.offset) : std::nullopt;
  chunk_at = is_packed ? 0 : stored_at;
}

/// Opens what is left of the truncated last chunk.
void McapReader::State::open_cut_chunk() {
  const Record record = *cut_chunk;
  buffer.resize(source.size() - record.content());
  source.read(record.content(), buffer);
  Fields content(source, buffer, record.content());
  ChunkHead head;
  try {
    head = chunk_head(content);
  } catch (const SetupError&) {
    return;  // even the chunk header is truncated
  }
  check_compression(head, record.offset);
  const bool is_packed = !head.compression.empty();
  chunk_is_cut = true;
  chunk = is_packed ? unpacked_chunk(head, content.left(), record) : content.left();
  packed_at = is_packed ? std::optional(record.offset) : std::nullopt;
  chunk_at = is_packed ? 0 : content.offset();
}

/// Advances in the chunk; true if it reaches a message.
bool McapReader::State::next_of_chunk(McapMessage& message) {
  try {
    while (!chunk.empty()) {
      Fields record(source, chunk, chunk_at);
      const auto op = static_cast<Op>(record.number<std::uint8_t>());
      const auto length = record.number<std::uint64_t>();
      const std::uint64_t content_at = record.offset();
      const Fields content(source, record.take(length), content_at);
      chunk = record.left();
      chunk_at = record.offset();
      if (op == Op::schema) take_schema(content);
      if (op == Op::channel) take_channel(content);
      if (op == Op::message) {
        take_message(content, message);
        return true;
      }
    }
  } catch (const SetupError& error) {
    chunk = {};
    if (chunk_is_cut) return false;  // expected at the end of a truncated chunk
    if (!packed_at) throw;
    // The file has no byte to name but that of the chunk.
    source.fail(*packed_at, std::string("in the compressed chunk, decompressed: ") + error.what());
  }
  return false;
}

void McapReader::State::take_message(Fields content, McapMessage& message) const {
  McapMessage taken;
  const std::uint64_t offset = content.offset();
  taken.channel = content.number<std::uint16_t>();
  taken.sequence = content.number<std::uint32_t>();
  taken.log_time_ns = content.number<std::uint64_t>();
  taken.publish_time_ns = content.number<std::uint64_t>();
  taken.data = content.left();
  if (!channels.contains(taken.channel)) {
    source.fail(offset, "a message of channel " + std::to_string(taken.channel) +
                            "; allowed: the channels of the file");
  }
  message = taken;
}

/// Throws if the file is damaged.
void McapReader::State::finish() {
  finished = true;
  check_crc(source, end_of_data, "everything before", data_crc, crc);
  if (damage) throw SetupError(*damage);
}

McapReader::McapReader(std::unique_ptr<State> state) : state_(std::move(state)) {
  state_->read_all_but_messages();
}

McapReader::McapReader(const std::string& path)
    : McapReader(std::make_unique<State>(Source::file(path))) {}

McapReader McapReader::from_bytes(std::string bytes, const std::string& name) {
  return McapReader(std::make_unique<State>(Source::memory(std::move(bytes), name)));
}

McapReader::~McapReader() = default;
McapReader::McapReader(McapReader&&) noexcept = default;
McapReader& McapReader::operator=(McapReader&&) noexcept = default;

const std::string& McapReader::profile() const noexcept {
  return state_->profile;
}

const std::string& McapReader::library() const noexcept {
  return state_->library;
}

const std::map<std::uint16_t, McapSchema>& McapReader::schemas() const noexcept {
  return state_->schemas;
}

const std::map<std::uint16_t, McapChannel>& McapReader::channels() const noexcept {
  return state_->channels;
}

const std::vector<McapAttachment>& McapReader::attachments() const noexcept {
  return state_->attachments;
}

const std::vector<McapMetadata>& McapReader::metadata() const noexcept {
  return state_->metadata;
}

bool McapReader::next(McapMessage& message) {
  return state_->next(message);
}

void McapReader::rewind() {
  state_->at = detail::magic.size();
  state_->chunk = {};
  state_->finished = false;
}

const std::string& McapReader::why_not_whole() const noexcept {
  return state_->why;
}

}  // namespace repel::record
