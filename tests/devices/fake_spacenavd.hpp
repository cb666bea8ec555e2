// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A fake spacenavd whose messages the test controls.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace repel::devices {

/// A temporary directory, removed by the destructor.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "repel_XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no scratch folder");
    path_ = pattern;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() { std::filesystem::remove_all(path_); }

  [[nodiscard]] std::string socket() const { return path_ + "/spnav.sock"; }

 private:
  std::string path_;
};

using Packet = std::array<std::int32_t, 8>;

inline Packet motion(std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t rx = 0,
                     std::int32_t ry = 0, std::int32_t rz = 0) {
  return {0, x, y, z, rx, ry, rz, 16};
}
inline Packet rest() {
  return motion(0, 0, 0);
}
inline Packet press(std::int32_t button) {
  return {1, button, 0, 0, 0, 0, 0, 0};
}
inline Packet release(std::int32_t button) {
  return {2, button, 0, 0, 0, 0, 0, 0};
}

/// Listens from construction; connections wait in the backlog until `accept`.
class FakeSpacenavd {
 public:
  explicit FakeSpacenavd(const std::string& path) : path_(path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    listener_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const auto* generic = reinterpret_cast<const sockaddr*>(&address);
    if (::bind(listener_, generic, sizeof address) != 0 || ::listen(listener_, 8) != 0) {
      throw std::runtime_error("cannot listen on " + path);
    }
  }
  FakeSpacenavd(const FakeSpacenavd&) = delete;
  FakeSpacenavd& operator=(const FakeSpacenavd&) = delete;
  ~FakeSpacenavd() { die(); }

  void accept() { client_ = ::accept(listener_, nullptr, nullptr); }
  void send(const Packet& packet) { send(std::as_bytes(std::span(packet))); }
  void send(std::span<const std::byte> bytes) {
    const ssize_t sent = ::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent != static_cast<ssize_t>(bytes.size())) throw std::runtime_error("nobody listens");
  }

  /// The bytes sent by the client, if any.
  [[nodiscard]] std::vector<std::byte> heard() const {
    std::vector<std::byte> bytes(256);
    const ssize_t count = ::recv(client_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }

  /// Simulates a kill; removes the socket so that the next instance can listen.
  void die() {
    if (client_ >= 0) ::close(client_);
    if (listener_ >= 0) ::close(listener_);
    client_ = listener_ = -1;
    ::unlink(path_.c_str());
  }

 private:
  std::string path_;
  int listener_ = -1;
  int client_ = -1;
};

}  // namespace repel::devices
