// SPDX-License-Identifier: BSD-3-Clause
#include "haply_link.hpp"

#include <stdexcept>
#include <utility>

#include <repel/base/setup_error.hpp>

#ifdef REPEL_HAS_HAPLY
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#endif

namespace repel::devices {

#ifdef REPEL_HAS_HAPLY

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;

struct HaplyLink::Endpoints {
  std::string host;
  tcp::resolver::results_type found;
};

/// What belongs to one connection, from the attempt to its end. All handlers run in run_until,
/// flush_until or close, and none after the destructor has begun: the context, which owns those
/// that are left, is destroyed last and calls none.
class HaplyLink::Connection {
 public:
  explicit Connection(const Endpoints& endpoints) : socket_(context_), host_(endpoints.host) {
    asio::async_connect(socket_.next_layer(), endpoints.found,
                        [this](const Error& error, const tcp::endpoint&) { connected(error); });
  }

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  [[nodiscard]] bool heard() const noexcept { return heard_; }
  [[nodiscard]] bool sends() const noexcept { return sends_; }
  [[nodiscard]] const std::string& message() const noexcept { return message_; }

  /// Runs one handler; false when the time is over, or nothing is left to wait for.
  bool run_one_until(std::chrono::steady_clock::time_point end) {
    if (context_.stopped()) context_.restart();
    // Past its end, run_one_until does not even look.
    const bool looks_only = end <= std::chrono::steady_clock::now();
    return (looks_only ? context_.poll_one() : context_.run_one_until(end)) > 0;
  }

  void drop() {
    heard_ = false;
    message_.clear();
    if (state_ == State::open) read();
  }

  bool send(std::string text) {
    if (state_ != State::open || sends_) return false;
    outgoing_ = std::move(text);
    sends_ = true;
    socket_.async_write(asio::buffer(outgoing_), [this](const Error& error, std::size_t) {
      sends_ = false;
      if (error) fail(error);
    });
    return true;
  }

 private:
  using Error = beast::error_code;

  void connected(const Error& error) {
    if (error) return fail(error);
    Error ignored;
    // Disable Nagle's algorithm: commands are small, and late ones are useless.
    socket_.next_layer().set_option(tcp::no_delay(true), ignored);
    socket_.read_message_max(HaplyBounds::text);
    socket_.async_handshake(host_, "/", [this](const Error& refused) {
      if (refused) return fail(refused);
      state_ = State::open;
      socket_.text(true);
      read();
    });
  }

  void read() {
    socket_.async_read(incoming_, [this](const Error& error, std::size_t bytes) {
      if (error) return fail(error);
      const auto data = incoming_.cdata();
      message_.assign(static_cast<const char*>(data.data()), bytes);
      incoming_.consume(bytes);
      heard_ = true;
    });
  }

  void fail(const Error& error) {
    error_ = error.message();
    state_ = State::closed;
  }

  asio::io_context context_{1};
  websocket::stream<tcp::socket> socket_;
  std::string host_;
  State state_ = State::opening;
  std::string error_;
  beast::flat_buffer incoming_;
  std::string message_, outgoing_;
  bool heard_ = false;
  bool sends_ = false;
};

HaplyLink::HaplyLink(const HaplyAddress& address) : endpoints_(std::make_unique<Endpoints>()) {
  asio::io_context context;
  tcp::resolver resolver(context);
  beast::error_code error;
  endpoints_->host = address.host + ":" + address.port;
  endpoints_->found = resolver.resolve(address.host, address.port, error);
  if (error) {
    throw SetupError("the host of the Haply Inverse Service, " + endpoints_->host +
                     ", is not known: " + error.message());
  }
}

HaplyLink::~HaplyLink() = default;

void HaplyLink::open() {
  connection_.reset();
  connection_ = std::make_unique<Connection>(*endpoints_);
}

bool HaplyLink::run_until(std::chrono::steady_clock::time_point end) {
  while (connection_ && !connection_->heard() && connection_->state() != State::closed) {
    if (!connection_->run_one_until(end)) break;
  }
  note_end();
  return connection_ && connection_->heard();
}

void HaplyLink::flush_until(std::chrono::steady_clock::time_point end) {
  while (connection_ && connection_->sends() && connection_->state() == State::open) {
    if (!connection_->run_one_until(end)) break;
  }
  note_end();
}

void HaplyLink::note_end() {
  if (!connection_ || connection_->state() != State::closed || connection_->heard()) return;
  error_ = connection_->error();
  connection_.reset();
}

const std::string& HaplyLink::message() const noexcept {
  static const std::string none;
  return connection_ ? connection_->message() : none;
}

void HaplyLink::drop() {
  if (connection_) connection_->drop();
}

bool HaplyLink::send(std::string text) {
  return connection_ && connection_->send(std::move(text));
}

void HaplyLink::close() noexcept {
  connection_.reset();
}

HaplyLink::State HaplyLink::state() const noexcept {
  return connection_ ? connection_->state() : State::closed;
}

#else

struct HaplyLink::Endpoints {};
class HaplyLink::Connection {};

HaplyLink::HaplyLink(const HaplyAddress& /*address*/) {
  throw SetupError(
      "the driver of Haply is not built in; to have it: apt-get install libboost-dev "
      "nlohmann-json3-dev");
}
HaplyLink::~HaplyLink() = default;
void HaplyLink::open() {}
bool HaplyLink::run_until(std::chrono::steady_clock::time_point /*end*/) {
  return false;
}
const std::string& HaplyLink::message() const noexcept {
  return error_;
}
void HaplyLink::drop() {}
bool HaplyLink::send(std::string /*text*/) {
  return false;
}
void HaplyLink::flush_until(std::chrono::steady_clock::time_point /*end*/) {}
void HaplyLink::note_end() {}
void HaplyLink::close() noexcept {}
HaplyLink::State HaplyLink::state() const noexcept {
  return State::closed;
}

#endif

const std::string& HaplyLink::error() const noexcept {
  return error_;
}

}  // namespace repel::devices
