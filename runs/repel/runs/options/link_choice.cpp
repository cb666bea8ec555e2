// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/options/link_choice.hpp>

#include <algorithm>
#include <any>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string_view>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/link/impaired.hpp>
#include <repel/link/udp.hpp>
#include <repel/network/elements/line.hpp>
#ifdef REPEL_RUNS_DDS
#include <repel/dds/dds.hpp>
#endif
#ifdef REPEL_RUNS_SEALED
#include <repel/sealed/sealed.hpp>
#endif

namespace repel::runs {
namespace {

constexpr const char* forms =
    "dds, dds:INTERFACE, dds:INTERFACE,PEER, udp, udp:ADDRESS:PORT or udp:[ADDRESS]:PORT";

#ifndef REPEL_RUNS_SEALED
constexpr const char* no_sodium =
    "a key needs libsodium, which is not built in; to have it: apt-get install libsodium-dev, and "
    "build again";
#endif

/// The text behind "NAME:"; empty for NAME alone, none for another name.
std::optional<std::string> behind(const std::string& text, std::string_view name) {
  if (text == name) return "";
  if (!text.starts_with(std::string(name) + ":")) return std::nullopt;
  return text.substr(name.size() + 1);
}

/// Address and port of a site; none if it is neither empty nor that.
std::optional<link::UdpOptions> udp_place(const std::string& text) {
  link::UdpOptions options;
  if (text.empty()) return options;
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return std::nullopt;
  options.address = text.substr(0, colon);
  if (options.address.starts_with('[') && options.address.ends_with(']')) {
    options.address = options.address.substr(1, options.address.size() - 2);
  }
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data() + colon + 1, end, options.port);
  if (error != std::errc() || last != end || options.port == 0) return std::nullopt;
  return options;
}

}  // namespace

std::string default_link() {
#ifdef REPEL_RUNS_DDS
  return "dds";
#else
  return "udp";
#endif
}

#ifdef REPEL_RUNS_SEALED
void make_link_key(const std::string& file) {
  sealed::make_key(file);
}
#else
void make_link_key(const std::string& /*file*/) {
  throw SetupError(no_sodium);
}
#endif

std::string link_complaint(const std::string& where) {
  std::string allowed = "'" + where + "' names no link; allowed: " + forms;
  if (const auto place = behind(where, "udp")) return udp_place(*place) ? "" : allowed;
  const auto place = behind(where, "dds");
  if (!place || (where != "dds" && (place->empty() || place->starts_with(',')))) return allowed;
#ifdef REPEL_RUNS_DDS
  return "";
#else
  return "DDS is not built in; to have it: apt-get install cyclonedds-dev cyclonedds-tools, and "
         "build again; or use udp";
#endif
}

namespace {

/// The file of the key; empty: none.
std::string key_file_of(const LinkChoice& choice) {
  if (choice.no_key || !choice.key_file.empty()) return choice.key_file;
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing changes the environment
  const char* const file = std::getenv("REPEL_KEY");
  return file == nullptr ? "" : file;
}

/// @throws SetupError for a place beyond the loopback interface
void require_on_this_machine(const std::string& where) {
  const auto place = behind(where, "udp");
  if (place ? link::is_on_this_machine(*udp_place(*place)) : where == "dds" || where == "dds:lo") {
    return;
  }
  throw SetupError("--link " + where +
                   " needs a key, for other machines reach it; allowed: --key FILE on both sides, "
                   "with the same key, which teleop key FILE makes; --no-key, for whoever reaches "
                   "it to drive the robot; or --link udp");
}

/// @param agreement of both sides
std::unique_ptr<link::Transport> open_place(const LinkChoice& choice, std::uint64_t agreement) {
  const std::string where = choice.where.empty() ? default_link() : choice.where;
  if (const std::string complaint = link_complaint(where); !complaint.empty()) {
    throw SetupError(complaint);
  }
  const std::string key_file = key_file_of(choice);
  if (key_file.empty() && !choice.no_key) require_on_this_machine(where);
#ifdef REPEL_RUNS_SEALED
  std::optional<sealed::Key> key;
  if (!key_file.empty()) key = sealed::load_key(key_file);
  const auto under_key = [&](std::unique_ptr<link::Datagrams> datagrams) {
    return sealed::seal(std::move(datagrams), *choice.side, *key);
  };
#else
  if (!key_file.empty()) throw SetupError(no_sodium, key_file);
#endif
  if (const auto place = behind(where, "udp")) {
    link::UdpOptions options = *udp_place(*place);
    options.side = *choice.side;
    options.agreement = agreement;
#ifdef REPEL_RUNS_SEALED
    if (key) return under_key(link::open_udp_datagrams(options));
#endif
    return link::open_udp(options);
  }
#ifdef REPEL_RUNS_DDS
  const std::string place = *behind(where, "dds");
  dds::DdsOptions options;
  options.side = *choice.side;
  options.domain = choice.domain;
  const std::size_t comma = place.find(',');
  if (!place.empty()) options.interface = place.substr(0, comma);
  if (comma != std::string::npos) options.peer = place.substr(comma + 1);
#ifdef REPEL_RUNS_SEALED
  if (key) return under_key(dds::open_dds_datagrams(options));
#endif
  return dds::open_dds(options);
#else
  return nullptr;
#endif
}

/// FNV-1a of the text of the scene and its changes: to tell scenes apart, not to keep anybody out.
std::uint64_t agreement_of(const scene::Scene& scene) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto add = [&hash](char c) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  };
  std::ifstream file(scene.file, std::ios::binary);
  std::for_each(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), add);
  for (const scene::Change& change : scene.changes) {
    for (const char c : change.path + "=" + change.value + "\n") add(c);
  }
  return hash;
}

/// Of the scene's line; none if it has none.
const network::LineOptions* line_of(const scene::Scene& scene) {
  const network::LineOptions* line = nullptr;
  for (const scene::Module& module : scene.network.modules) {
    if (const auto* found = std::any_cast<network::LineOptions>(&module.options)) line = found;
  }
  return line;
}

}  // namespace

bool has_line(const scene::Scene& scene) {
  return line_of(scene) != nullptr;
}

std::unique_ptr<link::Transport> open_link(const LinkChoice& choice, const scene::Scene& scene) {
  std::unique_ptr<link::Transport> transport = open_place(choice, agreement_of(scene));
  const network::LineOptions* const line = line_of(scene);
  if (!choice.is_impaired || line == nullptr) return transport;
  network::ChannelOptions channel = line->channel;
  if (choice.side == link::Side::site) channel.seed = ~channel.seed;
  return link::impaired(std::move(transport), channel);
}

network::RemoteOptions remote_options(const scene::Scene& scene) {
  if (!scene.partners.empty()) {
    throw SetupError(
        "a scene with partners cannot be divided between two programs; allowed: one "
        "arm",
        scene.file);
  }
  network::RemoteOptions options;
  std::random_device random;
  do {
    options.session = static_cast<std::uint64_t>(random()) << 32U | random();
  } while (options.session == 0);
  options.agreement = agreement_of(scene);
  if (const network::LineOptions* line = line_of(scene)) options.playout.buffer = line->buffer;
  return options;
}

}  // namespace repel::runs
