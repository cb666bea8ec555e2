// SPDX-License-Identifier: BSD-3-Clause
#include <repel/dds/dds.hpp>

#include <dds/dds.h>
#include <ifaddrs.h>
#include <remote_packet.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <set>
#include <string_view>

#include <repel/base/setup_error.hpp>

namespace repel::dds {
namespace {

using Sample = repel_dds_RemotePacket;
static_assert(sizeof(Sample) == sizeof(network::RemotePacket),
              "remote_packet.idl has the members of RemotePacket, in their order");

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

class Dds final : public link::Transport {
 public:
  explicit Dds(const DdsOptions& options) : name_("DDS, interface " + options.interface) {
    if (options.interface != "lo" && options.side == link::Side::site) {
      exposure_ = "the site listens on the interface " + options.interface + ": " +
                  link::exposed_to("its network", "--link dds:wg0,10.9.0.1");
    }
    if (options.domain != 0) name_ += ", domain " + std::to_string(options.domain);
    if (!options.peer.empty()) name_ += ", peer " + options.peer;
    // A program with both sides has the domain already.
    const dds_entity_t domain = dds_create_domain(options.domain, configuration(options).c_str());
    if (domain >= 0) domain_ = domain;
    participant_ = made("a participant", dds_create_participant(options.domain, nullptr, nullptr));
    const bool at_site = options.side == link::Side::site;
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 8);
    const dds_entity_t in = topic(at_site ? "repel/to_site" : "repel/to_station", qos);
    const dds_entity_t out = topic(at_site ? "repel/to_station" : "repel/to_site", qos);
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
  Dds(const Dds&) = delete;
  Dds& operator=(const Dds&) = delete;
  ~Dds() override { close(); }

  bool send(const network::RemotePacket& packet) noexcept override {
    const auto sample = std::bit_cast<Sample>(packet);
    return dds_write(writer_, &sample) >= 0;
  }
  bool receive(network::RemotePacket& packet) noexcept override {
    Sample sample;
    void* samples[1] = {&sample};
    dds_sample_info_t info[1];
    // What comes without data says that a writer has gone.
    while (dds_take(reader_, samples, info, 1, 1) == 1) {
      if (!info[0].valid_data) continue;
      packet = std::bit_cast<network::RemotePacket>(sample);
      return true;
    }
    return false;
  }
  void wait(std::chrono::microseconds longest) noexcept override {
    dds_attach_t arrived[1];
    (void)dds_waitset_wait(waitset_, arrived, 1, DDS_USECS(longest.count()));
  }
  [[nodiscard]] std::string name() const override { return name_; }
  [[nodiscard]] std::string exposure() const override { return exposure_; }

 private:
  dds_entity_t made(const char* what, dds_return_t entity) {
    if (entity >= 0) return entity;
    close();
    throw SetupError("DDS does not make " + std::string(what) + " (" + name_ +
                     "): " + dds_strretcode(entity));
  }
  [[nodiscard]] dds_entity_t topic(const char* name, const dds_qos_t* qos) {
    return made("a topic",
                dds_create_topic(participant_, &repel_dds_RemotePacket_desc, name, qos, nullptr));
  }
  void close() noexcept {
    if (participant_ > 0) dds_delete(participant_);
    if (domain_ > 0) dds_delete(domain_);
    participant_ = domain_ = 0;
  }

  std::string name_, exposure_;
  dds_entity_t domain_ = 0;  ///< 0: there was one
  dds_entity_t participant_ = 0, reader_ = 0, writer_ = 0, waitset_ = 0;
};

}  // namespace

std::unique_ptr<link::Transport> open_dds(const DdsOptions& options) {
  require_known(options);
  return std::make_unique<Dds>(options);
}

}  // namespace repel::dds
