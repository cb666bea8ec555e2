// SPDX-License-Identifier: BSD-3-Clause
// The pages over TLS: who can read them, and which certificates are refused.
#include <algorithm>
#include <filesystem>

#include <sys/stat.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>

#include <repel/base/setup_error.hpp>
#include <repel/visual/tls.hpp>

#include "end_to_end/folder.hpp"
#include "visual/fake_page_handler.hpp"

namespace repel::visual {
namespace server_tls_test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace ssl = asio::ssl;
using asio::ip::tcp;
using test::Folder;

ServerOptions with(const TlsFiles& files) {
  ServerOptions options;
  options.tls = files;
  return options;
}

/// A browser that trusts the certificate of the server alone.
struct Browser {
  Browser(std::uint16_t port, const TlsFiles& files) : socket(context, client) {
    client.load_verify_file(files.certificate);
    client.set_verify_callback(ssl::host_name_verification("localhost"));
    socket.set_verify_mode(ssl::verify_peer);
    socket.next_layer().connect({asio::ip::address_v4::loopback(), port});
    socket.handshake(ssl::stream_base::client);
    host += std::to_string(port);
  }

  int status_of(const std::string& target) {
    namespace http = beast::http;
    http::request<http::empty_body> request{http::verb::get, target, 11};
    request.set(http::field::host, host);
    http::write(socket, request);
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(socket, buffer, response);
    return static_cast<int>(response.result_int());
  }

  asio::io_context context;
  ssl::context client{ssl::context::tls_client};
  ssl::stream<tcp::socket> socket;
  std::string host = "localhost:";
};

std::string complaint(const TlsFiles& files) {
  try {
    const Stage stage(with(files));
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

bool says(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(ServerTls, FilesAndPicturesComeOverIt) {
  const Folder folder;
  const TlsFiles files = own_certificate(folder / "");
  Stage stage(with(files));
  EXPECT_EQ(Browser(stage.port, files).status_of("/page.css"), 200);
  Browser browser(stage.port, files);
  beast::websocket::stream<ssl::stream<tcp::socket>&> page(browser.socket);
  page.set_option(beast::websocket::stream_base::decorator(
      [&](auto& request) { request.set(beast::http::field::origin, "https://" + browser.host); }));
  page.handshake(browser.host, "/live");
  page.write(asio::buffer(std::string("hello")));
  for (const char* expected : {"welcome", "pppppppp", "pppppppp"}) {
    beast::flat_buffer buffer;
    page.read(buffer);
    EXPECT_EQ(beast::buffers_to_string(buffer.data()), expected);
  }
  page.close(beast::websocket::close_code::normal);
  EXPECT_EQ(stage.show.of_page(1).at(1), "hello");
}

TEST(ServerTls, APlainPageOfItsAddressIsOfAnotherOrigin) {
  const Folder folder;
  const TlsFiles files = own_certificate(folder / "");
  Stage stage(with(files));
  Browser browser(stage.port, files);
  beast::websocket::stream<ssl::stream<tcp::socket>&> page(browser.socket);
  page.set_option(beast::websocket::stream_base::decorator(
      [&](auto& request) { request.set(beast::http::field::origin, "http://" + browser.host); }));
  EXPECT_THROW(page.handshake(browser.host, "/live"), beast::system_error);
  EXPECT_EQ(stage.show.open(), 0);
}

// Also whoever begins a handshake and stays silent holds nobody else up.
TEST(ServerTls, WhoDoesNotSpeakItGetsNothing) {
  const Folder folder;
  const TlsFiles files = own_certificate(folder / "");
  ServerOptions options = with(files);
  options.patience = std::chrono::milliseconds(300);
  const Stage stage(options);
  test::Line silent(stage.port);
  ASSERT_TRUE(silent.send("\x16\x03\x01"));
  test::Line plain(stage.port);
  ASSERT_TRUE(plain.send(test::Ask{}.text(stage.port)));
  EXPECT_EQ(plain.receive_all().find("HTTP"), std::string::npos);
  EXPECT_EQ(Browser(stage.port, files).status_of("/"), 200);
  EXPECT_EQ(silent.receive_all(), "");
  EXPECT_TRUE(silent.ended());
}

TEST(ServerTls, ACertificateOfItsOwnIsKeptForItsOwnerAlone) {
  const Folder folder;
  const TlsFiles files = own_certificate(folder / "deep/er");
  struct stat status {};
  ASSERT_EQ(::stat(files.key.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  const std::string print = fingerprint_of(files);
  EXPECT_EQ(print.size(), 95U) << print;
  EXPECT_EQ(std::count(print.begin(), print.end(), ':'), 31) << print;
  EXPECT_EQ(fingerprint_of(own_certificate(folder / "deep/er")), print);
  EXPECT_NE(fingerprint_of(own_certificate(folder / "other")), print);
  EXPECT_THROW((void)own_certificate("/proc/none"), SetupError);
}

// Valid in the year 2020 alone.
constexpr const char* expired = R"(-----BEGIN CERTIFICATE-----
MIIBBjCBrgIBATAKBggqhkjOPQQDAjAQMQ4wDAYDVQQDDAVyZXBlbDAeFw0yMDAx
MDEwMDAwMDBaFw0yMTAxMDEwMDAwMDBaMBAxDjAMBgNVBAMMBXJlcGVsMFkwEwYH
KoZIzj0CAQYIKoZIzj0DAQcDQgAEDBDPOWDUFaqVPFt83nsLbpvLQj2mIBFAZxHT
1N7F7sOexdqppln5Wv6RlGvwFS45YADnAHMO59TuxhMOiqF6ODAKBggqhkjOPQQD
AgNHADBEAiBCcuj1oKecLvqcKpgR9knULl/7xAwsIhzglqZhJazJaQIgGdhTwmkC
nd6qTIvSgvtLljAKpOt19Qf0+TX/cgN5FkA=
-----END CERTIFICATE-----
)";

TEST(ServerTls, ACertificateThatCannotCountIsRefusedBeforeAnybodyIsServed) {
  const Folder folder;
  const TlsFiles one = own_certificate(folder / "one"), other = own_certificate(folder / "other");
  const std::string old = folder.with("old.pem", expired), none = folder.with("none.pem", "none");
  EXPECT_TRUE(says(complaint({old, one.key}), "has expired on Jan  1 00:00:00 2021 GMT"));
  EXPECT_TRUE(says(complaint({one.certificate, other.key}), "the key does not fit"));
  EXPECT_TRUE(says(complaint({none, one.key}), none + ": has no certificate in PEM"));
  EXPECT_TRUE(says(complaint({one.certificate, none}), none + ": has no private key"));
  EXPECT_TRUE(says(complaint({folder / "missing", one.key}), "missing"));
  EXPECT_EQ(complaint(one), "accepted");
}

}  // namespace server_tls_test
}  // namespace repel::visual
