// SPDX-License-Identifier: BSD-3-Clause
#include <repel/record/mcap_writer.hpp>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <system_error>
#include <utility>

#include <repel/base/setup_error.hpp>

#include "crc32.hpp"
#include "mcap_format.hpp"
#include "packing.hpp"

namespace repel::record {
namespace {

using detail::Op;
using detail::put;
using detail::put_map;
using detail::put_record;
using detail::put_text;

constexpr std::size_t most_ids = 65535;

/// The operating system's message of the last failure.
std::string system_words() {
  return std::generic_category().message(errno);
}

void check_options(const McapOptions& options, const std::string& path) {
  if (options.chunk_bytes >= 1 && options.chunk_bytes <= detail::largest_chunk_limit) return;
  std::string what = "chunk_bytes is ";
  what += std::to_string(options.chunk_bytes) + "; allowed: 1 to ";
  what += std::to_string(detail::largest_chunk_limit);
  throw SetupError(what, path);
}

std::string header_record(const McapOptions& options) {
  std::string content;
  put_text(content, options.profile);
  put_text(content, options.library);
  std::string bytes(detail::magic);
  put_record(bytes, Op::header, content);
  return bytes;
}

/// "'NAME' has N bytes; allowed: up to M"
std::string too_large(std::string_view name, std::uint64_t bytes, std::uint64_t most) {
  std::string what(1, '\'');
  what += name;
  what += "' has " + std::to_string(bytes) + " bytes; allowed: up to " + std::to_string(most);
  return what;
}

/// @throws SetupError if there are `count` = 65535 others already, or the record is too large
void check_description(std::string_view name, std::size_t count, std::size_t bytes,
                       const std::string& path) {
  if (count >= most_ids) {
    std::string what(1, '\'');
    what += name;
    what += "' is one too many; allowed: up to " + std::to_string(most_ids);
    throw SetupError(what, path);
  }
  if (bytes > detail::largest_description) {
    throw SetupError(too_large(name, bytes, detail::largest_description), path);
  }
}

/// Records of one type in the summary, for the summary offset section.
struct SummaryGroup {
  Op op;
  std::string_view records;
};

}  // namespace

bool has_zstd() noexcept {
  return detail::how_to_have_zstd().empty();
}

McapWriter::McapWriter(const std::string& path, const McapOptions& options)
    : path_(path), options_(options) {
  check_options(options, path);
  file_.reset(std::fopen(path.c_str(), "wb"));
  if (!file_) throw SetupError("cannot be opened for writing: " + system_words(), path);
  // Chunks are buffered here; a second buffer would only delay them.
  (void)std::setvbuf(file_.get(), nullptr, _IONBF, 0);
  if (options.compression == McapCompression::zstd && has_zstd()) {
    packer_ = std::make_unique<detail::Packer>();
  }
  push(header_record(options));
  if (failed()) throw SetupError(std::exchange(error_, {}));
}

McapWriter::~McapWriter() {
  try {
    close();
  } catch (const std::exception&) {  // out of memory for the summary: the chunks are written
    file_.reset();
  }
}

void McapWriter::fail(std::string_view what) {
  if (failed()) return;  // later errors are consequences of the first
  error_ = path_;
  error_ += ": ";
  error_ += what;
}

void McapWriter::push(std::string_view bytes) {
  if (!file_) return fail("it is closed; nothing more can be written");
  errno = 0;
  const std::size_t written = std::fwrite(bytes.data(), 1, bytes.size(), file_.get());
  if (written != bytes.size() || std::fflush(file_.get()) != 0) {
    std::string what = "cannot write " + std::to_string(bytes.size()) + " bytes at byte ";
    what += std::to_string(offset_) + ": " + system_words();
    fail(what);
    file_.reset();  // nothing after an incomplete record could be read
    return;
  }
  offset_ += bytes.size();
  crc_ = detail::crc32(bytes, crc_);
}

std::uint16_t McapWriter::add_schema(std::string_view name, std::string_view encoding,
                                     std::string_view data) {
  check_description(name, schemas_.size(), name.size() + encoding.size() + data.size(), path_);
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
  std::string content;
  put(content, id);
  put_text(content, name);
  put_text(content, encoding);
  put_text(content, data);
  put_record(schemas_.emplace_back(), Op::schema, content);
  push(schemas_.back());
  return id;
}

std::uint16_t McapWriter::add_channel(std::string_view topic, std::uint16_t schema,
                                      std::string_view encoding,
                                      const std::map<std::string, std::string>& metadata) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  std::string content;
  put(content, id);
  put(content, schema);
  put_text(content, topic);
  put_text(content, encoding);
  put_map(content, metadata);
  check_description(topic, channels_.size(), content.size(), path_);
  const auto same_topic = [&](const Channel& c) { return c.topic == topic; };
  std::string what;
  if (topic.empty()) what = "a channel without a topic; allowed: any text";
  if (std::any_of(channels_.begin(), channels_.end(), same_topic)) {
    what = "a second channel with this topic; allowed: one";
  }
  if (schema > schemas_.size()) {
    what = "schema " + std::to_string(schema) + " does not exist; allowed: 0 to ";
    what += std::to_string(schemas_.size());
  }
  if (!what.empty()) throw SetupError("channel '" + std::string(topic) + "': " + what, path_);

  Channel& channel = channels_.emplace_back();
  channel.topic = topic;
  if (schema > 0) channel.records = schemas_[schema - 1U];
  std::string record;
  put_record(record, Op::channel, content);
  channel.records += record;
  channel_records_ += record;
  push(record);
  return id;
}

void McapWriter::attach(std::string_view name, std::string_view media_type, std::string_view bytes,
                        std::uint64_t time_ns) {
  const std::uint64_t size = name.size() + media_type.size() + bytes.size();
  if (size > detail::largest_attachment) {
    return fail(too_large(name, size, detail::largest_attachment));
  }
  std::string content;
  put(content, time_ns);
  put(content, std::uint64_t{0});  // creation time: unknown
  put_text(content, name);
  put_text(content, media_type);
  put(content, std::uint64_t{bytes.size()});
  content += bytes;
  put(content, detail::crc32(content));
  std::string record;
  put_record(record, Op::attachment, content);
  const std::uint64_t offset = offset_;
  push(record);
  if (!file_) return;

  std::string index;
  put(index, offset);
  put(index, std::uint64_t{record.size()});
  put(index, time_ns);
  put(index, std::uint64_t{0});
  put(index, std::uint64_t{bytes.size()});
  put_text(index, name);
  put_text(index, media_type);
  put_record(attachment_indices_, Op::attachment_index, index);
  ++attachments_;
}

void McapWriter::add_metadata(std::string_view name,
                              const std::map<std::string, std::string>& entries) {
  std::string content;
  put_text(content, name);
  put_map(content, entries);
  if (content.size() > detail::largest_description) {
    return fail(too_large(name, content.size(), detail::largest_description));
  }
  std::string record;
  put_record(record, Op::metadata, content);
  const std::uint64_t offset = offset_;
  push(record);
  if (!file_) return;

  std::string index;
  put(index, offset);
  put(index, std::uint64_t{record.size()});
  put_text(index, name);
  put_record(metadata_indices_, Op::metadata_index, index);
  ++metadata_;
}

void McapWriter::write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns,
                       std::string_view data) {
  if (!file_) return fail("it is closed; nothing more can be written");
  if (channel == 0 || channel > channels_.size()) {
    return fail("a message of channel " + std::to_string(channel) + ", which does not exist");
  }
  Channel& of = channels_[channel - 1U];
  if (data.size() > detail::largest_message) {
    return fail(too_large(of.topic, data.size(), detail::largest_message));
  }
  // Covers both directions, since times need not increase.
  const std::uint64_t span = std::max(chunk_last_ns_, time_ns) - std::min(chunk_first_ns_, time_ns);
  if (!chunk_.empty() && span >= options_.chunk_ns) finish_chunk();
  if (chunk_.empty()) chunk_first_ns_ = chunk_last_ns_ = time_ns;
  if (messages_ == 0) first_ns_ = last_ns_ = time_ns;
  chunk_first_ns_ = std::min(chunk_first_ns_, time_ns);
  chunk_last_ns_ = std::max(chunk_last_ns_, time_ns);
  first_ns_ = std::min(first_ns_, time_ns);
  last_ns_ = std::max(last_ns_, time_ns);

  chunk_ += of.records;
  of.records.clear();
  put(of.index, time_ns);
  put(of.index, std::uint64_t{chunk_.size()});
  chunk_.push_back(static_cast<char>(Op::message));
  put(chunk_, std::uint64_t{2 + 4 + 8 + 8 + data.size()});
  put(chunk_, channel);
  put(chunk_, sequence);
  put(chunk_, time_ns);
  put(chunk_, time_ns);
  chunk_ += data;
  ++of.messages;
  ++messages_;
  if (chunk_.size() >= options_.chunk_bytes) finish_chunk();
}

void McapWriter::finish_chunk() {
  if (chunk_.empty()) return;
  const bool is_packed = packer_ && packer_->pack(chunk_, packed_);
  const std::string& stored = is_packed ? packed_ : chunk_;
  const std::string_view compression = is_packed ? detail::zstd_name : std::string_view();
  buffer_.clear();
  buffer_.push_back(static_cast<char>(Op::chunk));
  put(buffer_, std::uint64_t{8 + 8 + 8 + 4 + 4 + compression.size() + 8 + stored.size()});
  put(buffer_, chunk_first_ns_);
  put(buffer_, chunk_last_ns_);
  put(buffer_, std::uint64_t{chunk_.size()});
  put(buffer_, detail::crc32(chunk_));
  put_text(buffer_, compression);
  put(buffer_, std::uint64_t{stored.size()});
  buffer_ += stored;
  const std::uint64_t chunk_length = buffer_.size();

  std::string places;  // positions of the message indices by channel
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    std::string& index = channels_[i].index;
    if (index.empty()) continue;
    const auto id = static_cast<std::uint16_t>(i + 1);
    put(places, id);
    put(places, std::uint64_t{offset_ + buffer_.size()});
    buffer_.push_back(static_cast<char>(Op::message_index));
    put(buffer_, std::uint64_t{2 + 4 + index.size()});
    put(buffer_, id);
    put_text(buffer_, index);
    index.clear();
  }

  std::string content;
  put(content, chunk_first_ns_);
  put(content, chunk_last_ns_);
  put(content, offset_);
  put(content, chunk_length);
  put_text(content, places);
  put(content, std::uint64_t{buffer_.size() - chunk_length});
  put_text(content, compression);
  put(content, std::uint64_t{stored.size()});
  put(content, std::uint64_t{chunk_.size()});
  put_record(chunk_indices_, Op::chunk_index, content);
  ++chunks_;
  chunk_.clear();
  push(buffer_);
}

void McapWriter::flush() {
  finish_chunk();
}

std::string McapWriter::statistics() const {
  std::string counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    put(counts, static_cast<std::uint16_t>(i + 1));
    put(counts, channels_[i].messages);
  }
  std::string content;
  put(content, messages_);
  put(content, static_cast<std::uint16_t>(schemas_.size()));
  put(content, static_cast<std::uint32_t>(channels_.size()));
  put(content, attachments_);
  put(content, metadata_);
  put(content, chunks_);
  put(content, first_ns_);
  put(content, last_ns_);
  put_text(content, counts);
  std::string record;
  put_record(record, Op::statistics, content);
  return record;
}

std::string McapWriter::summary() const {
  std::string schemas;
  for (const std::string& record : schemas_) schemas += record;
  const std::string counts = statistics();
  const std::uint64_t start = offset_;
  std::string bytes;
  std::string places;
  for (const auto& [op, records] : {SummaryGroup{Op::schema, schemas},
                                    {Op::channel, channel_records_},
                                    {Op::statistics, counts},
                                    {Op::chunk_index, chunk_indices_},
                                    {Op::attachment_index, attachment_indices_},
                                    {Op::metadata_index, metadata_indices_}}) {
    if (records.empty()) continue;
    std::string place;
    put(place, static_cast<std::uint8_t>(op));
    put(place, std::uint64_t{start + bytes.size()});
    put(place, std::uint64_t{records.size()});
    put_record(places, Op::summary_offset, place);
    bytes += records;
  }
  const std::uint64_t places_start = start + bytes.size();
  bytes += places;

  // The CRC also covers the footer up to the CRC field.
  bytes.push_back(static_cast<char>(Op::footer));
  put(bytes, std::uint64_t{detail::footer_bytes});
  put(bytes, start);
  put(bytes, places_start);
  put(bytes, detail::crc32(bytes));
  bytes += detail::magic;
  return bytes;
}

void McapWriter::close() {
  if (!file_) return;
  finish_chunk();
  std::string content;
  put(content, crc_);
  std::string data_end;
  put_record(data_end, Op::data_end, content);
  push(data_end);
  if (file_) push(summary());
  if (file_ && std::fclose(file_.release()) != 0) fail("cannot be closed: " + system_words());
}

}  // namespace repel::record
