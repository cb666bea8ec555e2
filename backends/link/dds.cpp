// SPDX-License-Identifier: BSD-3-Clause
#include <repel/dds/dds.hpp>

#include <dds/dds.h>
#include <ifaddrs.h>
#include <remote_packet.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <set>
#include <string_view>

#include <repel/base/setup_error.hpp>

namespace repel::dds {
namespace {

using Sample = repel_dds_RemotePacket;
static_assert(sizeof(Sample) == sizeof(network::RemotePacket),
              "remote_packet.idl has the members of RemotePacket, in their order");
using SealedSample = repel_dds_SealedPacket;
static_assert(sizeof(SealedSample) == link::sealed_size);

/// The network interfaces of this machine, by name.
std::set<std::string> interfaces() {
  std::set<std::string> names;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return names;
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr != nullptr) names.insert(each->ifa_name);
  }
  freeifaddrs(all);
  return names;
}

void require_known(const DdsOptions& options) {
  checked("DDS domain", options.domain, 0.0, 230.0, "");
  const std::set<std::string> known = interfaces();
  if (!known.contains(options.interface)) {
    std::string names;
    for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
    throw SetupError("no network interface '" + options.interface + "'; allowed: " + names);
  }
  const bool is_plain = std::all_of(options.peer.begin(), options.peer.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view(".:-_%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (!is_plain) {
    throw SetupError("peer '" + options.peer + "' is no address; allowed: a host name or numbers");
  }
}

/// Of the domain, in the XML of Cyclone DDS. The loopback interface has no multicast: there the
/// sides search each other by their ports.
std::string configuration(const DdsOptions& options) {
  const bool loopback = options.interface == "lo";
  const std::string peer = options.peer.empty() && loopback ? "127.0.0.1" : options.peer;
  std::string xml = "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"" +
                    options.interface + "\"/></Interfaces>";
  if (loopback) xml += "<AllowMulticast>false</AllowMulticast>";
  xml += "</General><Discovery><ParticipantIndex>auto</ParticipantIndex>";
  if (!peer.empty()) xml += "<Peers><Peer address=\"" + peer + "\"/></Peers>";
  return xml + "</Discovery></Domain></CycloneDDS>";
}

/// What a side reads, and what it writes.
struct Topics {
  const dds_topic_descriptor_t* type;
  std::string folder;  ///< of the names
  int kept;            ///< samples that wait to be read
};

/// A reader and a writer, in the domain.
class Ends {
 public:
  Ends(const DdsOptions& options, const Topics& topics)
      : name_("DDS, interface " + options.interface) {
    if (options.domain != 0) name_ += ", domain " + std::to_string(options.domain);
    if (!options.peer.empty()) name_ += ", peer " + options.peer;
    // A program with both sides has the domain already.
    const dds_entity_t domain = dds_create_domain(options.domain, configuration(options).c_str());
    if (domain >= 0) domain_ = domain;
    participant_ = made("a participant", dds_create_participant(options.domain, nullptr, nullptr));
    const bool at_site = options.side == link::Side::site;
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, topics.kept);
    const auto topic = [&](const char* name) {
      return made("a topic", dds_create_topic(participant_, topics.type,
                                              (topics.folder + name).c_str(), qos, nullptr));
    };
    const dds_entity_t in = topic(at_site ? "to_site" : "to_station");
    const dds_entity_t out = topic(at_site ? "to_station" : "to_site");
    reader_ = dds_create_reader(participant_, in, qos, nullptr);
    writer_ = dds_create_writer(participant_, out, qos, nullptr);
    dds_delete_qos(qos);
    made("a reader", reader_);
    made("a writer", writer_);
    waitset_ = made("a wait set", dds_create_waitset(participant_));
    const dds_entity_t arrived =
        made("a condition", dds_create_readcondition(reader_, DDS_ANY_STATE));
    made("a condition", dds_waitset_attach(waitset_, arrived, 0));
  }
  Ends(const Ends&) = delete;
  Ends& operator=(const Ends&) = delete;
  ~Ends() { close(); }

  bool write(const void* sample) noexcept { return dds_write(writer_, sample) >= 0; }
  /// Into `sample`, of the type of the topics; false: nothing has arrived.
  bool take(void* sample) noexcept {
    void* samples[1] = {sample};
    dds_sample_info_t info[1];
    // What comes without data says that a writer has gone.
    while (dds_take(reader_, samples, info, 1, 1) == 1) {
      if (info[0].valid_data) return true;
    }
    return false;
  }
  void wait(std::chrono::microseconds longest) noexcept {
    dds_attach_t arrived[1];
    (void)dds_waitset_wait(waitset_, arrived, 1, DDS_USECS(longest.count()));
  }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

 private:
  dds_entity_t made(const char* what, dds_return_t entity) {
    if (entity >= 0) return entity;
    close();
    throw SetupError("DDS does not make " + std::string(what) + " (" + name_ +
                     "): " + dds_strretcode(entity));
  }
  void close() noexcept {
    if (participant_ > 0) dds_delete(participant_);
    if (domain_ > 0) dds_delete(domain_);
    participant_ = domain_ = 0;
  }

  std::string name_;
  dds_entity_t domain_ = 0;  ///< 0: there was one
  dds_entity_t participant_ = 0, reader_ = 0, writer_ = 0, waitset_ = 0;
};

class Dds final : public link::Transport {
 public:
  explicit Dds(const DdsOptions& options)
      : ends_(options, {&repel_dds_RemotePacket_desc, "repel/", 8}) {
    if (options.side == link::Side::site) {
      // Cyclone DDS binds its sockets to every interface; the chosen one is for sending.
      exposure_ = "the site listens by DDS, on every network interface: " +
                  link::exposed_to("any network of this machine");
    }
  }

  bool send(const network::RemotePacket& packet) noexcept override {
    const auto sample = std::bit_cast<Sample>(packet);
    return ends_.write(&sample);
  }
  bool receive(network::RemotePacket& packet) noexcept override {
    Sample sample;
    if (!ends_.take(&sample)) return false;
    packet = std::bit_cast<network::RemotePacket>(sample);
    return true;
  }
  void wait(std::chrono::microseconds longest) noexcept override { ends_.wait(longest); }
  [[nodiscard]] std::string name() const override { return ends_.name(); }
  [[nodiscard]] std::string exposure() const override { return exposure_; }

 private:
  Ends ends_;
  std::string exposure_;
};

/// Sealed packets wait in so large a number that those of others push none out.
class DdsDatagrams final : public link::Datagrams {
 public:
  explicit DdsDatagrams(const DdsOptions& options)
      : ends_(options, {&repel_dds_SealedPacket_desc, "repel/sealed/", 1024}) {}

  bool send(std::span<const std::byte, link::sealed_size> bytes,
            const link::Origin& /*to*/) noexcept override {
    return ends_.write(bytes.data());
  }
  std::ptrdiff_t receive(std::span<std::byte> bytes, link::Origin& /*from*/) noexcept override {
    SealedSample sample;
    if (!ends_.take(&sample)) return -1;
    const std::size_t size = std::min(bytes.size(), sizeof sample);
    std::memcpy(bytes.data(), &sample, size);
    return static_cast<std::ptrdiff_t>(size);
  }
  void wait(std::chrono::microseconds longest) noexcept override { ends_.wait(longest); }
  [[nodiscard]] std::string name() const override { return ends_.name(); }

 private:
  Ends ends_;
};

}  // namespace

std::unique_ptr<link::Transport> open_dds(const DdsOptions& options) {
  require_known(options);
  return std::make_unique<Dds>(options);
}

std::unique_ptr<link::Datagrams> open_dds_datagrams(const DdsOptions& options) {
  require_known(options);
  return std::make_unique<DdsDatagrams>(options);
}

}  // namespace repel::dds
