/// @file
/// One page that is open: a WebSocket with its messages.
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

#include <repel/visual/server.hpp>

#include "metered_stream.hpp"

namespace repel::visual {

using Request = boost::beast::http::request<boost::beast::http::empty_body>;

/// Reads and writes by itself as long as it is referred to; all in the thread of the server.
class PageSession : public std::enable_shared_from_this<PageSession> {
 public:
  struct Events {
    std::function<void()> opened;
    std::function<void(std::string_view)> heard;
    std::function<void()> closed;  ///< once, whatever has happened, if it has opened
    std::function<void()> failed;  ///< it has not
  };

  PageSession(boost::beast::tcp_stream&& stream, const ServerOptions& options, Events events);

  /// Answers the request that asked for a WebSocket.
  void open(const Request& request);
  /// Queues a message, or closes when too many wait already.
  void send(std::shared_ptr<const std::string> text);
  /// Queues a picture, unless the last one is still on its way.
  void show(const std::shared_ptr<const std::string>& text);
  /// Closes it in order, with a code that says why; nothing of it is heard any more.
  void close(boost::beast::websocket::close_code code);
  /// Ends it at once.
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
  const std::string* picture_ = nullptr;                    ///< among those that wait
  std::chrono::steady_clock::time_point second_;
  int heard_in_second_ = 0;
  bool open_ = false;
  bool flooding_ = false;
  bool closing_ = false;
  bool closes_in_order_ = false;
};

}  // namespace repel::visual
