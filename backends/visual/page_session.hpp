// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The WebSocket connection of one open page.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "metered_stream.hpp"

namespace repel::visual {

using Request = boost::beast::http::request<boost::beast::http::empty_body>;

/// What a page may send, and how long it may take to open.
struct PageLimits {
  int messages_per_second = 0;    ///< pings and fragments included; beyond it the page is cut off
  std::size_t message_bytes = 0;  ///< of one message; beyond it the page is cut off
  std::chrono::milliseconds patience{0};  ///< timeout of the handshake
};

/// Keeps itself alive while operations are pending; runs entirely in the server's thread.
class PageSession : public std::enable_shared_from_this<PageSession> {
 public:
  struct Events {
    std::function<void()> opened;
    std::function<void(std::string_view)> heard;
    std::function<void()> closed;  ///< exactly once if it was opened, for any reason
    std::function<void()> failed;  ///< it could not be opened
  };

  PageSession(std::unique_ptr<Connection> connection, const PageLimits& limits, Events events);

  /// Accepts the WebSocket upgrade request.
  void open(const Request& request);
  /// Queues a message, or cuts the connection if too many are waiting.
  void send(std::shared_ptr<const std::string> text);
  /// Queues a picture, unless the last one is still queued.
  void show(const std::shared_ptr<const std::string>& text);
  /// Starts the closing handshake with a status code; further messages of the page are ignored.
  void close(boost::beast::websocket::close_code code);
  /// Closes the connection immediately.
  void cut();

 private:
  using Error = boost::beast::error_code;
  static constexpr std::size_t most_waiting = 100;

  void read();
  void hear(std::size_t bytes);
  void count(int frames);
  void write();
  void end();

  boost::beast::websocket::stream<MeteredStream> socket_;
  int messages_per_second_;
  Events events_;
  boost::beast::flat_buffer incoming_;
  std::deque<std::shared_ptr<const std::string>> waiting_;  ///< the first is being written
  const std::string* picture_ = nullptr;                    ///< the picture among those waiting
  std::chrono::steady_clock::time_point second_;
  int heard_in_second_ = 0;
  bool open_ = false;
  bool flooding_ = false;
  bool closing_ = false;
  bool closes_in_order_ = false;
};

}  // namespace repel::visual
