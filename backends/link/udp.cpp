// SPDX-License-Identifier: BSD-3-Clause
// By hand: a link needs no library, and what it does with memory can be seen.
#include <repel/link/udp.hpp>

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

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

/// The address of a socket.
struct Peer {
  sockaddr_storage address{};
  socklen_t size = 0;

  friend bool operator==(const Peer& a, const Peer& b) noexcept {
    return a.size == b.size && std::memcmp(&a.address, &b.address, a.size) == 0;
  }
};

Peer resolved(const UdpOptions& options) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(options.port);
  if (getaddrinfo(options.address.c_str(), port.c_str(), &hints, &found) != 0) {
    throw SetupError("'" + options.address +
                     "' is no address; allowed: numbers, such as 127.0.0.1 or ::1");
  }
  Peer peer;
  std::memcpy(&peer.address, found->ai_addr, found->ai_addrlen);
  peer.size = found->ai_addrlen;
  freeaddrinfo(found);
  return peer;
}

class Udp final : public Transport {
 public:
  explicit Udp(const UdpOptions& options) : options_(options) {
    const Peer site = resolved(options);
    socket_ = ::socket(site.address.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const auto* address = reinterpret_cast<const sockaddr*>(&site.address);  // NOLINT(*-cast)
    if (socket_ >= 0 && options.side == Side::site && ::bind(socket_, address, site.size) != 0) {
      const std::string why = std::generic_category().message(errno);
      ::close(std::exchange(socket_, -1));
      throw SetupError("the site cannot listen on " + place() + ": " + why);
    }
    if (socket_ < 0) throw SetupError("no UDP socket: " + std::generic_category().message(errno));
    if (options.side == Side::station) partner_ = site;
  }
  Udp(const Udp&) = delete;
  Udp& operator=(const Udp&) = delete;
  ~Udp() override { ::close(socket_); }

  bool send(const network::RemotePacket& packet) noexcept override {
    if (partner_.size == 0) return false;
    WireBytes bytes;
    encode(packet, bytes);
    const auto* to = reinterpret_cast<const sockaddr*>(&partner_.address);  // NOLINT(*-cast)
    return ::sendto(socket_, bytes.data(), bytes.size(), 0, to, partner_.size) ==
           static_cast<ssize_t>(bytes.size());
  }

  bool receive(network::RemotePacket& packet) noexcept override {
    // A bound for a flood of what is not a packet.
    for (int tries = 0; tries < 64; ++tries) {
      std::array<std::byte, wire_size + 1> bytes;
      Peer from;
      from.size = sizeof from.address;
      auto* address = reinterpret_cast<sockaddr*>(&from.address);  // NOLINT(*-cast)
      const ssize_t size = ::recvfrom(socket_, bytes.data(), bytes.size(), 0, address, &from.size);
      // Where nobody listens, the station is told so by an error: there is nothing yet.
      if (size < 0 && errno == ECONNREFUSED) continue;
      if (size < 0) return false;
      if (decode({bytes.data(), static_cast<std::size_t>(size)}, packet) && listens_to(from)) {
        return true;
      }
      count_foreign();
    }
    return false;
  }

  void wait(std::chrono::microseconds longest) noexcept override {
    pollfd wanted{socket_, POLLIN, 0};
    const timespec time{0, static_cast<long>(longest.count()) * 1000};
    (void)::ppoll(&wanted, 1, &time, nullptr);
  }

  [[nodiscard]] std::string name() const override { return "UDP " + place(); }

 private:
  [[nodiscard]] std::string place() const {
    const bool six = options_.address.find(':') != std::string::npos;
    return (six ? "[" + options_.address + "]" : options_.address) + ":" +
           std::to_string(options_.port);
  }
  [[nodiscard]] bool listens_to(const Peer& from) noexcept {
    const auto now = steady_clock::now();
    if (!(from == partner_)) {
      const bool is_silent =
          now - heard_ > std::chrono::duration<double>(network::WavePlayer::silence);
      if (options_.side == Side::station || (partner_.size > 0 && !is_silent)) return false;
      partner_ = from;
    }
    heard_ = now;
    return true;
  }

  UdpOptions options_;
  int socket_ = -1;
  Peer partner_;
  steady_clock::time_point heard_{};
};

}  // namespace

std::unique_ptr<Transport> open_udp(const UdpOptions& options) {
  return std::make_unique<Udp>(options);
}

}  // namespace repel::link
