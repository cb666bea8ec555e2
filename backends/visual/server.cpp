#include <chrono>
#include <cstdio>
#include <map>
#include <optional>
#include <thread>
#include <utility>

#include <pthread.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include <repel/base/complaint.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/visual/server.hpp>

#include "gate.hpp"
#include "page_session.hpp"

namespace repel::visual {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using Error = beast::error_code;
using Response = http::response<http::string_body>;

/// Nothing is loaded from elsewhere, nothing is shown inside another page.
constexpr const char* policy =
    "default-src 'self'; connect-src 'self' ws:; img-src 'self' data: blob:; frame-ancestors "
    "'none'; base-uri 'none'; form-action 'none'";

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}

}  // namespace

class Server::Impl final : public Pages {
 public:
  Impl(const ServerOptions& options, std::vector<Asset> assets, Show& show)
      : options_(options),
        acceptor_(listening(context_, options)),
        gate_(options.address, acceptor_.local_endpoint().port()),
        show_(show),
        beats_(context_) {
    for (Asset& asset : assets) {
      std::string target = asset.target;
      assets_.emplace(std::move(target), std::move(asset));
    }
    const bool is_v6 = options.address.find(':') != std::string::npos;
    url_ = is_v6 ? "http://[" : "http://";
    url_ += options.address;
    url_ += is_v6 ? "]:" : ":";
    url_ += std::to_string(acceptor_.local_endpoint().port());
    url_ += '/';
    accept();
    beat();
    thread_ = std::jthread([this] {
      (void)pthread_setname_np(pthread_self(), "repel view");
      while (!context_.stopped()) attempt([this] { context_.run(); });
    });
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() override { context_.stop(); }

  void send(int page, std::string text) override {
    const auto found = pages_.find(page);
    if (found == pages_.end()) return;
    found->second->send(std::make_shared<const std::string>(std::move(text)));
  }
  void send_all(std::string text) override {
    const auto shared = std::make_shared<const std::string>(std::move(text));
    for (const auto& [number, page] : pages_) page->send(shared);
  }
  void show(std::string text) override {
    const auto shared = std::make_shared<const std::string>(std::move(text));
    for (const auto& [number, page] : pages_) page->show(shared);
  }
  [[nodiscard]] int count() const override { return static_cast<int>(pages_.size()); }
  [[nodiscard]] const std::string& url() const noexcept { return url_; }

 private:
  static constexpr int most_connections = 64;

  /// A connection until it is answered or has become a page.
  struct Visitor {
    explicit Visitor(tcp::socket&& socket) : stream(std::move(socket)) {
      parser.emplace();
      parser->header_limit(8192);
      parser->body_limit(0);
    }
    beast::tcp_stream stream;
    beast::flat_buffer buffer{16384};
    std::optional<http::request_parser<http::empty_body>> parser;
    Response response;
  };
  using Guest = std::shared_ptr<Visitor>;

  static tcp::acceptor listening(asio::io_context& context, const ServerOptions& options) {
    std::string place = options.address;
    place += ":" + std::to_string(options.port);
    try {
      const tcp::endpoint endpoint(asio::ip::make_address(options.address), options.port);
      return tcp::acceptor(context, endpoint, true);
    } catch (const boost::system::system_error& error) {
      std::string text = "cannot listen there (";
      text += error.code().message() + "); another port: --listen 127.0.0.1:0 takes a free one";
      throw SetupError(text, place);
    }
  }

  void accept() {
    acceptor_.async_accept([this](Error error, tcp::socket socket) {
      if (!error && visitors_ < most_connections)
        attempt([&] { receive(std::make_shared<Visitor>(std::move(socket))); });
      if (error == asio::error::operation_aborted) return;
      if (!error) return accept();
      // Out of descriptors: not at once again.
      retry_.expires_after(std::chrono::milliseconds(100));
      retry_.async_wait([this](Error aborted) {
        if (!aborted) accept();
      });
    });
  }

  void receive(const Guest& guest) {
    ++visitors_;
    // Leaves when it is answered, has become a page or takes too long.
    const std::shared_ptr<void> seat(nullptr, [this](void*) { --visitors_; });
    guest->stream.expires_after(std::chrono::seconds(10));
    http::async_read_header(guest->stream, guest->buffer, *guest->parser,
                            [this, guest, seat](Error error, std::size_t) {
                              if (error) return;
                              answer(guest, seat);
                            });
  }

  void answer(const Guest& guest, const std::shared_ptr<void>& seat) {
    const Request request = guest->parser->release();
    const bool is_page = beast::websocket::is_upgrade(request);
    guest->response = response_to(request, is_page);
    if (is_page && guest->response.result() == http::status::ok) return open(guest, request);
    guest->response.keep_alive(false);
    guest->response.prepare_payload();
    if (request.method() == http::verb::head) guest->response.body().clear();
    http::async_write(guest->stream, guest->response, [guest, seat](Error, std::size_t) {
      Error ignored;
      guest->stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  /// Of an upgrade: ok if it may go on.
  [[nodiscard]] Response response_to(const Request& request, bool is_page) const {
    const auto refuse = [&](http::status status, const char* why) {
      Response response{status, request.version()};
      response.set(http::field::content_type, "text/plain; charset=utf-8");
      response.body() = why;
      return response;
    };
    if (!gate_.is_host(view(request[http::field::host])))
      return refuse(http::status::forbidden, "This host is not served here.\n");
    if (!gate_.is_origin(view(request[http::field::origin])))
      return refuse(http::status::forbidden, "Pages of other origins may not ask here.\n");
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return refuse(http::status::method_not_allowed, "Only GET and HEAD are answered.\n");
    if (is_page) {
      if (view(request.target()) != "/live") return refuse(http::status::not_found, "Not here.\n");
      if (count() >= options_.pages)
        return refuse(http::status::service_unavailable, "Too many pages are open.\n");
      return {http::status::ok, request.version()};
    }
    const std::string_view target = view(request.target());
    const auto found = assets_.find(std::string(target.substr(0, target.find('?'))));
    if (found == assets_.end()) return refuse(http::status::not_found, "No such file.\n");
    Response response{http::status::ok, request.version()};
    response.set(http::field::content_type, found->second.media_type);
    response.set("Content-Security-Policy", policy);
    response.set("X-Content-Type-Options", "nosniff");
    response.set(http::field::cache_control, "no-cache");
    response.body() = found->second.body;
    return response;
  }

  void open(const Guest& guest, const Request& request) {
    const int number = next_page_++;
    PageSession::Events events;
    events.opened = [this, number] { attempt([&] { show_.opened(number, *this); }); };
    events.heard = [this, number](std::string_view text) {
      attempt([&] { show_.heard(number, text, *this); });
    };
    events.closed = [this, number] {
      pages_.erase(number);
      attempt([&] { show_.closed(number, *this); });
    };
    events.failed = [this, number] { pages_.erase(number); };
    const auto page =
        std::make_shared<PageSession>(std::move(guest->stream), options_, std::move(events));
    pages_.emplace(number, page);
    page->open(request);
  }

  void beat() {
    using Clock = std::chrono::steady_clock;
    const auto pace = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(1.0 / options_.beats_per_second));
    std::optional<Clock::time_point> next;
    attempt([&] { next = show_.next_beat(); });
    beats_.expires_at(next.value_or(Clock::now() + pace));
    beats_.async_wait([this](Error error) {
      if (error) return;
      attempt([this] { show_.beat(*this); });
      beat();
    });
  }

  /// The server goes on whatever is thrown, and says so once for as long as it is the same.
  template <class Work>
  void attempt(const Work& work) noexcept {
    const std::string why = complaint_of(work);
    if (why.empty() || why == complaint_) return;
    std::fprintf(stderr, "The live view has failed and goes on: %s\n", why.c_str());
    (void)complaint_of([&] { complaint_ = why; });
  }

  ServerOptions options_;
  asio::io_context context_{1};
  tcp::acceptor acceptor_;
  Gate gate_;
  Show& show_;
  std::string url_;
  std::map<std::string, Asset> assets_;
  std::map<int, std::shared_ptr<PageSession>> pages_;
  int next_page_ = 1;
  int visitors_ = 0;
  std::string complaint_;  // the last that was said
  asio::steady_timer beats_;
  asio::steady_timer retry_{context_};
  std::jthread thread_;
};

Server::Server(const ServerOptions& options, std::vector<Asset> assets, Show& show)
    : impl_(std::make_unique<Impl>(options, std::move(assets), show)) {}
Server::~Server() = default;

const std::string& Server::url() const noexcept {
  return impl_->url();
}

}  // namespace repel::visual
