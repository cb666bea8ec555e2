// SPDX-License-Identifier: BSD-3-Clause
#include <repel/record/mcap_reader.hpp>

#include <cstdint>
#include <string>

#include <nanobind/nanobind.h>

#include "bindings.hpp"

namespace repel::python {
namespace {

nb::dict entries_of(const record::McapMetadata& metadata) {
  nb::dict entries;
  for (const auto& [key, value] : metadata.entries) entries[key.c_str()] = value;
  return entries;
}

/// All of a file at once: messages by topic, attachments, metadata, and why it is not whole.
nb::dict contents_of(const std::string& path) {
  record::McapReader reader(path);
  nb::dict messages;
  record::McapMessage message;
  while (reader.next(message)) {
    const std::string& topic = reader.channels().at(message.channel).topic;
    if (!messages.contains(topic.c_str())) messages[topic.c_str()] = nb::list();
    nb::list of_topic = nb::borrow<nb::list>(messages[topic.c_str()]);
    of_topic.append(
        nb::make_tuple(message.log_time_ns, nb::bytes(message.data.data(), message.data.size())));
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
  m.def("_read_mcap", &contents_of, nb::arg("path"),
        nb::sig("def _read_mcap(path: str) -> dict[str, typing.Any]"));
}

}  // namespace repel::python
