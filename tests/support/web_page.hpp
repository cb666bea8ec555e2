// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A client of the live-view server that behaves like a browser or violates the protocol: HTTP and
/// WebSocket over plain sockets, so that arbitrary bytes can be sent.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace repel::test {

/// Timeout of every wait, against hangs.
inline constexpr std::chrono::seconds patience{60};

/// A connection to a local port.
class Line {
 public:
  /// @param room [byte] receive buffer for unread data; 0: the default of the system
  explicit Line(std::uint16_t port, int room = 0) {
    file_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (room > 0) (void)::setsockopt(file_, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(file_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("nobody listens on port " + std::to_string(port));
    }
  }
  /// Over IPv6; a closed connection if this machine has no IPv6.
  static Line over_ipv6(std::uint16_t port) {
    Line line;
    line.file_ = ::socket(AF_INET6, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in6 address{};
    address.sin6_family = AF_INET6;
    address.sin6_port = htons(port);
    address.sin6_addr = in6addr_loopback;
    line.ended_ =
        ::connect(line.file_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0;
    return line;
  }
  Line(Line&& other) noexcept : file_(std::exchange(other.file_, -1)), ended_(other.ended_) {}
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;
  ~Line() { close(); }

  /// False if the peer accepts no more data.
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      pollfd ready{file_, POLLOUT, 0};
      if (::poll(&ready, 1, in_ms(patience)) <= 0) return false;
      const ssize_t sent = ::send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }
  /// The received bytes; empty on timeout or at the end of the connection.
  std::string receive(std::chrono::milliseconds wait = patience) {
    std::string bytes(65536, '\0');
    pollfd ready{file_, POLLIN, 0};
    ssize_t count = 0;
    if (::poll(&ready, 1, in_ms(wait)) > 0) {
      count = ::recv(file_, bytes.data(), bytes.size(), 0);
      ended_ = count <= 0;
    }
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }
  /// All bytes until the peer closes the connection.
  std::string receive_all() {
    std::string all;
    for (std::string some = receive(); !some.empty(); some = receive()) all += some;
    return all;
  }

  /// The peer has closed the connection.
  [[nodiscard]] bool ended() const { return ended_; }
  /// Shuts down sending; receiving remains possible.
  void end_sending() const { (void)::shutdown(file_, SHUT_WR); }
  void close() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }
  /// Closes the connection with a TCP reset, which not even a killed program does.
  void reset() {
    const linger at_once{1, 0};
    (void)::setsockopt(file_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    close();
  }

 private:
  Line() = default;
  static int in_ms(std::chrono::milliseconds time) { return static_cast<int>(time.count()); }

  int file_ = -1;
  bool ended_ = false;
};

/// An HTTP request with the headers that a browser sends.
struct Ask {
  std::string method = "GET";
  std::string target = "/";
  std::string host{};  ///< empty: 127.0.0.1:PORT
  std::string more{};  ///< further header lines, each with its line end

  [[nodiscard]] std::string text(std::uint16_t port) const {
    std::string all = method;
    all += ' ';
    all += target;
    all += " HTTP/1.1\r\nHost: ";
    all += host.empty() ? "127.0.0.1:" + std::to_string(port) : host;
    all += "\r\n";
    all += more;
    all += "\r\n";
    return all;
  }
};

struct Answer {
  int status = 0;  ///< 0: no response
  std::string head;
  std::string body;

  explicit Answer(const std::string& text) {
    const std::size_t end = text.find("\r\n\r\n");
    if (!text.starts_with("HTTP/1.1 ") || end == std::string::npos) return;
    status = std::stoi(text.substr(9, 3));
    head = text.substr(0, end + 2);
    body = text.substr(end + 4);
  }
  [[nodiscard]] bool has(std::string_view line) const {
    return head.find(std::string("\r\n").append(line).append("\r\n")) != std::string::npos;
  }
};

/// Sends one request on a connection of its own.
inline Answer ask(std::uint16_t port, const Ask& request) {
  Line line(port);
  (void)line.send(request.text(port));
  return Answer(line.receive_all());
}

/// The header lines of a WebSocket upgrade request.
inline std::string upgrade_lines(const std::string& origin = "") {
  std::string lines = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n";
  lines += "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  if (!origin.empty()) lines += "Origin: " + origin + "\r\n";
  return lines;
}

/// A WebSocket frame, valid or invalid.
struct Frame {
  enum Kind : unsigned char { more = 0, text = 1, binary = 2, close = 8, ping = 9, pong = 10 };

  unsigned char kind = text;
  std::string payload{};
  bool last = true;
  bool masked = true;
  std::uint64_t announced = 0;  ///< length field, if different from the payload's

  [[nodiscard]] std::string bytes() const {
    static constexpr unsigned char key[4] = {0x12, 0xf4, 0x56, 0x78};
    std::string all;
    all += static_cast<char>((last ? 0x80 : 0) | kind);
    const std::uint64_t size = announced > 0 ? announced : payload.size();
    const int mask = masked ? 0x80 : 0;
    const int width = size < 126 ? 0 : size < 65536 ? 2 : 8;
    all += static_cast<char>(mask | (width == 0 ? static_cast<int>(size) : width == 2 ? 126 : 127));
    for (int i = width - 1; i >= 0; --i) all += static_cast<char>(size >> (8 * i) & 255U);
    if (masked) all.append(reinterpret_cast<const char*>(key), 4);
    for (std::size_t i = 0; i < payload.size(); ++i) {
      all += static_cast<char>(static_cast<unsigned char>(payload[i]) ^ (masked ? key[i % 4] : 0));
    }
    return all;
  }
};

/// An open WebSocket client. It reads only during calls that receive.
class WebPage {
 public:
  /// Opens it as a browser does, which sends the origin of the page.
  explicit WebPage(std::uint16_t port, const std::string& target = "/live", int room = 0)
      : WebPage(
            Line(port, room),
            Ask{"GET", target, "", upgrade_lines("http://127.0.0.1:" + std::to_string(port))}.text(
                port)) {}
  /// @param request the upgrade request
  WebPage(Line line, const std::string& request) : line_(std::move(line)) {
    (void)line_.send(request);
    std::size_t end = std::string::npos;
    while (end == std::string::npos && more()) end = come_.find("\r\n\r\n");
    const Answer answer(come_);
    status_ = answer.status;
    if (end != std::string::npos) come_.erase(0, end + 4);
  }

  /// Status of the handshake response; 101: open.
  [[nodiscard]] int status() const { return status_; }
  /// Close code from the server; 0: not closed by it.
  [[nodiscard]] int close_code() const { return close_code_; }
  /// No more data will arrive.
  [[nodiscard]] bool ended() const { return line_.ended(); }
  Line& line() { return line_; }

  bool say(const std::string& text) { return send({Frame::text, text}); }
  bool send(const Frame& frame) { return line_.send(frame.bytes()); }

  /// The next message, if one arrives in time; of one that has not come whole, the rest is awaited
  /// by the next call. Answers pings; ends with the connection.
  std::optional<std::string> next(std::chrono::milliseconds wait = patience) {
    const auto until = std::chrono::steady_clock::now() + wait;
    for (;;) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          until - std::chrono::steady_clock::now());
      std::optional<Frame> frame = cut();
      if (!frame && (left.count() < 0 || !more(left))) return std::nullopt;
      if (!frame) continue;
      if (frame->kind == Frame::ping) (void)send({Frame::pong, frame->payload});
      if (frame->kind == Frame::close) hear_close(frame->payload);
      if (frame->kind > Frame::binary) continue;
      message_ += frame->payload;
      if (frame->last) return std::exchange(message_, {});
    }
  }
  /// Reads all data until the server closes the connection. Returns the close code, 0 without one.
  int await_close() {
    while (next()) {
    }
    return close_code_;
  }
  /// Closes with a regular handshake.
  void close() {
    (void)send({Frame::close, std::string("\x03\xe8", 2)});
    (void)await_close();
  }

 private:
  bool more(std::chrono::milliseconds wait = patience) {
    const std::string bytes = line_.receive(wait);
    come_ += bytes;
    return !bytes.empty();
  }
  void hear_close(const std::string& payload) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(payload[i]); };
    close_code_ = payload.size() < 2 ? 1005 : byte(0) << 8 | byte(1);
    (void)send({Frame::close, payload});
    line_.end_sending();
  }
  /// The first frame of the received data, once it is complete.
  std::optional<Frame> cut() {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(come_[i]); };
    if (come_.size() < 2) return std::nullopt;
    std::size_t begin = 2;
    std::uint64_t size = byte(1) & 127U;
    if (size > 125) {
      begin = size == 126 ? 4 : 10;
      if (come_.size() < begin) return std::nullopt;
      size = 0;
      for (std::size_t i = 2; i < begin; ++i) size = size << 8 | byte(i);
    }
    if (come_.size() < begin + size) return std::nullopt;
    Frame frame;
    frame.kind = byte(0) & 15U;
    frame.last = (byte(0) & 128U) != 0U;
    frame.payload = come_.substr(begin, size);
    come_.erase(0, begin + size);
    return frame;
  }

  Line line_;
  std::string come_;
  std::string message_;  ///< the frames that have come of one that has more
  int status_ = 0;
  int close_code_ = 0;
};

/// The port of a URL such as "http://127.0.0.1:8448/".
inline std::uint16_t port_of(const std::string& url) {
  return static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
}

}  // namespace repel::test
