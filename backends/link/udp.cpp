// SPDX-License-Identifier: BSD-3-Clause
// By hand: a link needs no library, and what it does with memory can be seen.
#include <repel/link/udp.hpp>

#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/link/wire.hpp>
#include <repel/network/remote/wave_player.hpp>

namespace repel::link {
namespace {

using std::chrono::steady_clock;

Origin resolved(const UdpOptions& options) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(options.port);
  if (getaddrinfo(options.address.c_str(), port.c_str(), &hints, &found) != 0) {
    throw SetupError("'" + options.address +
                     "' is no address; allowed: numbers, such as 127.0.0.1 or ::1");
  }
  Origin place;
  std::memcpy(&place.address, found->ai_addr, found->ai_addrlen);
  place.size = found->ai_addrlen;
  freeaddrinfo(found);
  return place;
}

/// Who can send to an address.
enum class Reach { this_machine, its_network, all_networks };

Reach reach_of(const Origin& place) {
  in_addr four{};
  if (place.address.ss_family == AF_INET6) {
    sockaddr_in6 six{};
    std::memcpy(&six, &place.address, sizeof six);
    if (IN6_IS_ADDR_LOOPBACK(&six.sin6_addr)) return Reach::this_machine;
    if (IN6_IS_ADDR_UNSPECIFIED(&six.sin6_addr)) return Reach::all_networks;
    if (!IN6_IS_ADDR_V4MAPPED(&six.sin6_addr)) return Reach::its_network;
    std::memcpy(&four, six.sin6_addr.s6_addr + 12, sizeof four);
  } else {
    sockaddr_in all{};
    std::memcpy(&all, &place.address, sizeof all);
    four = all.sin_addr;
  }
  const std::uint32_t number = ntohl(four.s_addr);
  if (number == INADDR_ANY) return Reach::all_networks;
  return number >> 24U == IN_LOOPBACKNET ? Reach::this_machine : Reach::its_network;
}

/// The socket of a side.
class UdpSocket final : public Datagrams {
 public:
  explicit UdpSocket(const UdpOptions& options) : options_(options), site_(resolved(options)) {
    socket_ = ::socket(site_.address.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const auto* address = reinterpret_cast<const sockaddr*>(&site_.address);  // NOLINT(*-cast)
    if (socket_ >= 0 && options.side == Side::site && ::bind(socket_, address, site_.size) != 0) {
      const std::string why = std::generic_category().message(errno);
      ::close(std::exchange(socket_, -1));
      throw SetupError("the site cannot listen on " + place() + ": " + why);
    }
    if (socket_ < 0) throw SetupError("no UDP socket: " + std::generic_category().message(errno));
  }
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  ~UdpSocket() override { ::close(socket_); }

  bool send_bytes(std::span<const std::byte> bytes, const Origin& to) noexcept {
    const Origin& whom = options_.side == Side::station ? site_ : to;
    const auto* address = reinterpret_cast<const sockaddr*>(&whom.address);  // NOLINT(*-cast)
    return ::sendto(socket_, bytes.data(), bytes.size(), 0, address, whom.size) ==
           static_cast<ssize_t>(bytes.size());
  }
  bool send(std::span<const std::byte, sealed_size> bytes, const Origin& to) noexcept override {
    return send_bytes(bytes, to);
  }
  std::ptrdiff_t receive(std::span<std::byte> bytes, Origin& from) noexcept override {
    ssize_t size = -1;
    do {
      from.size = sizeof from.address;
      auto* address = reinterpret_cast<sockaddr*>(&from.address);  // NOLINT(*-cast)
      size = ::recvfrom(socket_, bytes.data(), bytes.size(), 0, address, &from.size);
      // Where nobody listens, the station is told so by an error: there is nothing yet.
    } while (size < 0 && errno == ECONNREFUSED);
    return size;
  }
  void wait(std::chrono::microseconds longest) noexcept override {
    pollfd wanted{socket_, POLLIN, 0};
    const timespec time{0, static_cast<long>(longest.count()) * 1000};
    (void)::ppoll(&wanted, 1, &time, nullptr);
  }
  [[nodiscard]] std::string name() const override { return "UDP " + place(); }

  [[nodiscard]] const Origin& site() const noexcept { return site_; }
  [[nodiscard]] std::string place() const {
    const bool six = options_.address.find(':') != std::string::npos;
    return (six ? "[" + options_.address + "]" : options_.address) + ":" +
           std::to_string(options_.port);
  }

 private:
  UdpOptions options_;
  Origin site_;
  int socket_ = -1;
};

class Udp final : public Transport {
 public:
  explicit Udp(const UdpOptions& options) : options_(options), socket_(options) {}

  bool send(const network::RemotePacket& packet) noexcept override {
    const Origin* partner =
        options_.side == Side::station ? &socket_.site() : peer_of(packet.heard);
    if (partner == nullptr) return false;
    WireBytes bytes;
    encode(packet, bytes);
    return socket_.send_bytes(bytes, *partner);
  }

  bool receive(network::RemotePacket& packet) noexcept override {
    // A bound for a flood of what is not a packet.
    for (int tries = 0; tries < 64; ++tries) {
      std::array<std::byte, wire_size + 1> bytes;
      Origin from;
      const std::ptrdiff_t size = socket_.receive(bytes, from);
      if (size < 0) return false;
      if (decode({bytes.data(), static_cast<std::size_t>(size)}, packet) &&
          listens_to(from, packet)) {
        return true;
      }
      count_foreign();
    }
    return false;
  }

  void wait(std::chrono::microseconds longest) noexcept override { socket_.wait(longest); }
  [[nodiscard]] std::string name() const override { return socket_.name(); }
  [[nodiscard]] std::string exposure() const override {
    const Reach reach = reach_of(socket_.site());
    if (options_.side == Side::station || reach == Reach::this_machine) return {};
    return "the site listens on " + socket_.place() + ": " +
           exposed_to(reach == Reach::all_networks ? "any network of this machine"
                                                   : "the network of this address");
  }

 private:
  /// A station that shares the agreement, and where it sent from.
  struct Caller {
    std::uint64_t session = 0;  // 0: none
    Origin peer;
    steady_clock::time_point heard{};
  };

  [[nodiscard]] const Origin* peer_of(std::uint64_t session) const noexcept {
    const auto same = [&](const Caller& caller) { return caller.session == session; };
    const auto* const caller = std::find_if(callers_.begin(), callers_.end(), same);
    return session == 0 || caller == callers_.end() ? nullptr : &caller->peer;
  }
  [[nodiscard]] bool listens_to(const Origin& from, const network::RemotePacket& packet) noexcept {
    if (options_.side == Side::station) return from == socket_.site();
    // Counted as a stranger's by the link, and never answered.
    if (packet.session == 0) return true;
    if (options_.agreement != 0 && packet.agreement != options_.agreement) return true;
    const auto now = steady_clock::now();
    const auto is_free = [&](const Caller& caller) {
      return caller.session == 0 ||
             now - caller.heard > std::chrono::duration<double>(network::WavePlayer::silence);
    };
    auto* place = std::find_if(callers_.begin(), callers_.end(), [&](const Caller& caller) {
      return caller.session == packet.session;
    });
    if (place == callers_.end()) {
      place = std::find_if(callers_.begin(), callers_.end(), is_free);
      if (place == callers_.end()) return false;
    } else if (!(place->peer == from) && !is_free(*place)) {
      return false;
    }
    *place = {packet.session, from, now};
    return true;
  }

  UdpOptions options_;
  UdpSocket socket_;
  std::array<Caller, 16> callers_;  // of a site
};

}  // namespace

bool is_on_this_machine(const UdpOptions& options) {
  return reach_of(resolved(options)) == Reach::this_machine;
}

std::unique_ptr<Transport> open_udp(const UdpOptions& options) {
  return std::make_unique<Udp>(options);
}

std::unique_ptr<Datagrams> open_udp_datagrams(const UdpOptions& options) {
  return std::make_unique<UdpSocket>(options);
}

}  // namespace repel::link
