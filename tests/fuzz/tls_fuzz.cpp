// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes at the place where TLS is spoken, also behind the begin of a real handshake:
// nothing of the page comes back, and whoever speaks TLS is served as before.
#include <filesystem>
#include <memory>
#include <string>

#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/write.hpp>

#include <repel/visual/server.hpp>

#include "bytes.hpp"

namespace repel::visual {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using fuzz::require;
using Error = boost::system::error_code;

class NoPages final : public PageHandler {
 public:
  void opened(int /*page*/, Role /*role*/, Pages& /*pages*/) override {
    require(false, "no page opens");
  }
  void heard(int /*page*/, std::string_view /*text*/, Pages& /*pages*/) override {}
  void closed(int /*page*/, Pages& /*pages*/) override {}
  void refresh(Pages& /*pages*/) override {}
};

/// One for all inputs.
struct Stage {
  Stage() {
    const auto folder =
        std::filesystem::temp_directory_path() / ("repel_tls_fuzz." + std::to_string(::getpid()));
    ServerOptions options;
    options.port = 0;
    options.tls = own_certificate(folder.string());
    server = std::make_unique<Server>(options, std::vector<Asset>{{"/", "text/html", "the page"}},
                                      pages);
    std::filesystem::remove_all(folder);
    const std::string& url = server->url();
    host = url.substr(8, url.size() - 9);
    place = {asio::ip::address_v4::loopback(),
             static_cast<std::uint16_t>(std::stoi(host.substr(host.rfind(':') + 1)))};
  }

  /// What a client gets that sends these bytes and then no more.
  template <class Stream>
  std::string answer_of(Stream& stream, const std::string& bytes) const {
    Error ignored;
    asio::write(stream, asio::buffer(bytes), ignored);
    stream.lowest_layer().shutdown(tcp::socket::shutdown_send, ignored);
    std::string answer;
    asio::read(stream, asio::dynamic_buffer(answer), ignored);
    return answer;
  }

  /// Over TLS.
  std::string served() {
    asio::ssl::stream<tcp::socket> stream(context, client);
    stream.next_layer().connect(place);
    stream.handshake(asio::ssl::stream_base::client);
    return answer_of(stream, "GET / HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
  }

  NoPages pages;
  std::unique_ptr<Server> server;
  asio::io_context context;
  asio::ssl::context client{asio::ssl::context::tls_client};
  tcp::endpoint place;
  std::string host;
};

}  // namespace
}  // namespace repel::visual

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace repel::visual;
  static Stage stage;
  static int inputs = 0;
  std::string bytes(reinterpret_cast<const char*>(data), size);
  // Of a record that holds the hello of a client, so that more than its first byte is looked at.
  if (size > 0 && data[0] % 2 == 1)
    bytes.replace(0, 1, "\x16\x03\x01\x01\x00\x01\x00\x00\xfc\x03\x03", 11);
  tcp::socket socket(stage.context);
  socket.connect(stage.place);
  require(stage.answer_of(socket, bytes).find("the page") == std::string::npos,
          "who does not speak TLS gets nothing");
  if (inputs++ % 20 == 0) {
    require(stage.served().find("the page") != std::string::npos, "who speaks it is served");
  }
  return 0;
}
