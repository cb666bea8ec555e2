// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Copies of recordings with something changed.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include <repel/record/mcap_reader.hpp>
#include <repel/record/mcap_writer.hpp>

namespace repel::test {

/// What is changed in a copy: the options of the run, the text of each attachment.
struct Rewriting {
  std::function<void(std::map<std::string, std::string>&)> options{};
  std::function<void(std::string&)> attachment{};
};

/// Copies the recording `from` to the file `to`.
inline void rewrite(const std::string& from, const std::string& to, const Rewriting& changes) {
  record::McapReader reader(from);
  record::McapWriter writer(to);
  for (record::McapMetadata metadata : reader.metadata()) {
    if (metadata.name == "repel run" && changes.options) changes.options(metadata.entries);
    writer.add_metadata(metadata.name, metadata.entries);
  }
  for (record::McapAttachment attachment : reader.attachments()) {
    if (changes.attachment) changes.attachment(attachment.data);
    writer.attach(attachment.name, attachment.media_type, attachment.data, attachment.log_time_ns);
  }
  std::map<std::uint16_t, std::uint16_t> channels;
  for (const auto& [id, channel] : reader.channels()) {
    channels[id] = writer.add_channel(channel.topic, 0, channel.encoding);
  }
  record::McapMessage message;
  while (reader.next(message)) {
    writer.write(channels.at(message.channel), message.sequence, message.log_time_ns, message.data);
  }
}

}  // namespace repel::test
