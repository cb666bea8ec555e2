// SPDX-License-Identifier: BSD-3-Clause
#include "client.hpp"

#include <chrono>
#include <thread>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include <nlohmann/json.hpp>

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;

}  // namespace

class Client::Socket {
 public:
  explicit Socket(std::uint16_t port) {
    const tcp::endpoint place(asio::ip::make_address("127.0.0.1"), port);
    beast::error_code error;
    for (int tries = 0; tries < 100; ++tries) {
      socket_.next_layer().connect(place, error);
      if (!error) break;
      socket_.next_layer().close();
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    if (error) throw beast::system_error(error);
    std::string host = "127.0.0.1:";
    host += std::to_string(port);
    socket_.handshake(host, "/live");
  }

  [[nodiscard]] std::string read() {
    beast::flat_buffer buffer;
    socket_.read(buffer);
    return beast::buffers_to_string(buffer.data());
  }

 private:
  asio::io_context context_;
  beast::websocket::stream<tcp::socket> socket_{context_};
};

Client::Client(std::uint16_t port) : socket_(std::make_unique<Socket>(port)) {}
Client::~Client() = default;

std::int64_t Client::next() {
  for (;;) {
    const std::string text = socket_->read();
    bytes_ += static_cast<std::int64_t>(text.size());
    const nlohmann::json message = nlohmann::json::parse(text);
    if (message.at("type") == "frame") return message.at("tick").get<std::int64_t>();
  }
}
