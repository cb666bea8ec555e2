// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A connection that counts the incoming WebSocket frames.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <utility>

#include <boost/asio/compose.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include "connection.hpp"

namespace repel::visual {

/// Counts the WebSocket frames in a byte stream, including pings, pongs and empty fragments, all
/// hidden from a reader of messages.
class FrameCounter {
 public:
  /// The number of frames starting in these bytes, the continuation of the last call.
  [[nodiscard]] int count(std::string_view bytes) noexcept;

 private:
  [[nodiscard]] std::size_t header_size() const noexcept;
  [[nodiscard]] std::uint64_t payload_size() const noexcept;

  std::array<unsigned char, 10> header_{};
  std::size_t known_ = 0;   ///< bytes of the header received
  std::uint64_t skip_ = 0;  ///< remaining bytes of mask and payload
};

/// A stream layer between a WebSocket and its connection.
class MeteredStream {
 public:
  using executor_type = Connection::executor_type;
  using Error = boost::beast::error_code;

  explicit MeteredStream(std::unique_ptr<Connection> connection)
      : connection_(std::move(connection)) {}

  /// Sets a callback for the number of incoming frames, called before they are read.
  void on_frames(std::function<void(int)> heard) { heard_ = std::move(heard); }

  [[nodiscard]] executor_type get_executor() noexcept { return connection_->get_executor(); }
  [[nodiscard]] boost::beast::tcp_stream& next_layer() noexcept { return connection_->tcp(); }
  [[nodiscard]] const boost::beast::tcp_stream& next_layer() const noexcept {
    return connection_->tcp();
  }

  template <class Buffers, class Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    auto read = [this, buffers, begun = false](auto& self, Error error = {},
                                               std::size_t bytes = 0) mutable {
      if (!std::exchange(begun, true)) {
        return connection_->async_read_some(buffers, std::move(self));
      }
      if (bytes > 0) meter(buffers, bytes);
      self.complete(error, bytes);
    };
    return boost::asio::async_compose<Handler, void(Error, std::size_t)>(std::move(read), handler,
                                                                         *connection_);
  }
  template <class Buffers, class Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    return connection_->async_write_some(buffers, std::forward<Handler>(handler));
  }

  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, MeteredStream& stream,
                             Handler&& handler) {
    stream.connection_->async_end(role, std::forward<Handler>(handler));
  }

 private:
  template <class Buffers>
  void meter(const Buffers& buffers, std::size_t bytes) {
    int frames = 0;
    const auto come = boost::beast::buffers_prefix(bytes, buffers);
    for (const auto buffer : boost::beast::buffers_range_ref(come)) {
      frames += counter_.count({static_cast<const char*>(buffer.data()), buffer.size()});
    }
    if (frames > 0 && heard_) heard_(frames);
  }

  std::unique_ptr<Connection> connection_;
  FrameCounter counter_;
  std::function<void(int)> heard_;
};

}  // namespace repel::visual
