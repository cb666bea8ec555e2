// SPDX-License-Identifier: BSD-3-Clause
#include "page_session.hpp"

#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>

namespace repel::visual {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

}  // namespace

PageSession::PageSession(std::unique_ptr<Connection> connection, const PageLimits& limits,
                         Events events)
    : socket_(MeteredStream(std::move(connection))),
      messages_per_second_(limits.messages_per_second),
      events_(std::move(events)) {
  beast::get_lowest_layer(socket_).expires_never();  // the WebSocket has its own timeouts
  websocket::stream_base::timeout timeouts =
      websocket::stream_base::timeout::suggested(beast::role_type::server);
  timeouts.idle_timeout = std::chrono::seconds(10);
  timeouts.keep_alive_pings = true;
  timeouts.handshake_timeout = limits.patience;
  socket_.set_option(timeouts);
  socket_.read_message_max(limits.message_bytes);
}

void PageSession::open(const Request& request) {
  socket_.next_layer().on_frames([this](int frames) { count(frames); });
  socket_.async_accept(request, [self = shared_from_this()](Error error) {
    if (error) return self->events_.failed();
    self->open_ = true;
    Error ignored;
    // Disable Nagle's algorithm: pictures are small, and late ones are useless.
    beast::get_lowest_layer(self->socket_)
        .socket()
        .set_option(boost::asio::ip::tcp::no_delay(true), ignored);
    self->socket_.text(true);
    self->events_.opened();
    self->read();
  });
}

// Each handler starts the next operation asynchronously, not on its own stack.
// NOLINTBEGIN(misc-no-recursion)
void PageSession::read() {
  socket_.async_read(incoming_, [self = shared_from_this()](Error error, std::size_t bytes) {
    if (error) return self->end();
    self->hear(bytes);
  });
}

void PageSession::hear(std::size_t bytes) {
  if (flooding_ || closes_in_order_) return;  // the connection is being closed
  const auto data = incoming_.cdata();
  events_.heard({static_cast<const char*>(data.data()), data.size()});
  incoming_.consume(bytes);
  if (closing_) return end();  // the answer exceeded the send queue
  read();
}
// NOLINTEND(misc-no-recursion)

void PageSession::count(int frames) {
  const auto now = std::chrono::steady_clock::now();
  if (now - second_ >= std::chrono::seconds(1)) {
    second_ = now;
    heard_in_second_ = 0;
  }
  heard_in_second_ += frames;
  if (flooding_ || heard_in_second_ <= messages_per_second_) return;
  flooding_ = true;
  // Posted, so as not to close from within the read that found it.
  boost::asio::post(socket_.get_executor(), [self = shared_from_this()] {
    self->close(websocket::close_code::policy_error);
  });
}

void PageSession::send(std::shared_ptr<const std::string> text) {
  if (!open_ || closing_) return;
  if (waiting_.size() >= most_waiting) return cut();
  waiting_.push_back(std::move(text));
  if (waiting_.size() == 1) write();
}

void PageSession::show(const std::shared_ptr<const std::string>& text) {
  if (picture_ != nullptr || !open_ || closing_) return;
  picture_ = text.get();
  send(text);
}

// NOLINTBEGIN(misc-no-recursion): as above.
void PageSession::write() {
  socket_.async_write(boost::asio::buffer(*waiting_.front()),
                      [self = shared_from_this()](Error error, std::size_t) {
                        if (self->waiting_.front().get() == self->picture_)
                          self->picture_ = nullptr;
                        self->waiting_.pop_front();
                        if (error) return self->cut();
                        if (!self->waiting_.empty() && !self->closing_) self->write();
                      });
}
// NOLINTEND(misc-no-recursion)

void PageSession::close(websocket::close_code code) {
  if (!open_) return cut();
  if (closing_) return;
  closing_ = closes_in_order_ = true;
  socket_.async_close(code, [self = shared_from_this()](Error) { self->end(); });
}

void PageSession::cut() {
  closing_ = true;
  Error ignored;
  beast::get_lowest_layer(socket_).socket().close(ignored);
}

void PageSession::end() {
  cut();  // a write may still be pending to a page that does not read
  if (!std::exchange(open_, false)) return;
  events_.closed();
}

}  // namespace repel::visual
