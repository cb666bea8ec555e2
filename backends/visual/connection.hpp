// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A connection with a browser, over TLS or plain.
#pragma once

#include <optional>
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/teardown.hpp>

namespace repel::visual {

/// An asynchronous stream of bytes. Timeouts are those of tcp().
class Connection {
 public:
  using executor_type = boost::beast::tcp_stream::executor_type;

  /// @param tls null: plain
  Connection(boost::asio::ip::tcp::socket&& socket, boost::asio::ssl::context* tls)
      : tcp_(std::move(socket)) {
    if (tls != nullptr) tls_.emplace(tcp_, *tls);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() = default;

  [[nodiscard]] executor_type get_executor() noexcept { return tcp_.get_executor(); }
  [[nodiscard]] boost::beast::tcp_stream& tcp() noexcept { return tcp_; }
  [[nodiscard]] const boost::beast::tcp_stream& tcp() const noexcept { return tcp_; }

  /// Calls `ready(error)` once bytes can be exchanged: of a plain one at once.
  template <class Ready>
  void begin(Ready&& ready) {
    if (!tls_) return ready(boost::beast::error_code());
    tls_->async_handshake(boost::asio::ssl::stream_base::server, std::forward<Ready>(ready));
  }

  template <class Buffers, class Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    return tls_ ? tls_->async_read_some(buffers, std::forward<Handler>(handler))
                : tcp_.async_read_some(buffers, std::forward<Handler>(handler));
  }
  template <class Buffers, class Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    return tls_ ? tls_->async_write_some(buffers, std::forward<Handler>(handler))
                : tcp_.async_write_some(buffers, std::forward<Handler>(handler));
  }
  /// Ends it in order, as a WebSocket does.
  template <class Handler>
  void async_end(boost::beast::role_type role, Handler&& handler) {
    using boost::beast::websocket::async_teardown;
    if (tls_) return async_teardown(role, *tls_, std::forward<Handler>(handler));
    async_teardown(role, tcp_.socket(), std::forward<Handler>(handler));
  }

 private:
  boost::beast::tcp_stream tcp_;
  std::optional<boost::asio::ssl::stream<boost::beast::tcp_stream&>> tls_;
};

}  // namespace repel::visual
