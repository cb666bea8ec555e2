// SPDX-License-Identifier: BSD-3-Clause
#include <repel/record/mcap_reader.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"

namespace repel::python {
namespace {

nb::dict entries_of(const record::McapMetadata& metadata) {
  nb::dict entries;
  for (const auto& [key, value] : metadata.entries) entries[key.c_str()] = value;
  return entries;
}

/// All of a file at once: messages by topic, attachments, metadata, and why it is not whole.
/// @param topics of the messages that are wanted; one that ends in '/' is the beginning of several
nb::dict contents_of(const std::string& path, const std::vector<std::string>& topics) {
  record::McapReader reader(path);
  nb::dict messages;
  record::McapMessage message;
  while (reader.next(message)) {
    const std::string& topic = reader.channels().at(message.channel).topic;
    const bool is_wanted = std::any_of(topics.begin(), topics.end(), [&](const std::string& each) {
      return topic == each || (each.ends_with('/') && topic.starts_with(each));
    });
    if (!is_wanted) continue;
    if (!messages.contains(topic.c_str())) messages[topic.c_str()] = nb::list();
    nb::list of_topic = nb::borrow<nb::list>(messages[topic.c_str()]);
    of_topic.append(nb::make_tuple(message.log_time_ns, message.sequence,
                                   nb::bytes(message.data.data(), message.data.size())));
  }
  nb::dict attachments;
  for (const record::McapAttachment& each : reader.attachments()) {
    attachments[each.name.c_str()] = nb::bytes(each.data.data(), each.data.size());
  }
  nb::dict metadata;
  for (const record::McapMetadata& each : reader.metadata()) {
    metadata[each.name.c_str()] = entries_of(each);
  }
  nb::dict all;
  all["messages"] = messages;
  all["attachments"] = attachments;
  all["metadata"] = metadata;
  all["trouble"] = reader.why_not_whole();
  return all;
}

}  // namespace

void bind_recordings(nb::module_& m) {
  m.def("_read_mcap", &contents_of, nb::arg("path"), nb::arg("topics"),
        nb::sig("def _read_mcap(path: str, topics: list[str]) -> dict[str, typing.Any]"));
}

}  // namespace repel::python
