// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>
#include <thread>
#include <utility>

#include <pthread.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include <nlohmann/json.hpp>

#include <repel/base/setup_error.hpp>
#include <repel/common/complaint.hpp>
#include <repel/common/json_fields.hpp>
#include <repel/visual/server.hpp>

#include "gate.hpp"
#include "gzip.hpp"
#include "lobby.hpp"
#include "page_session.hpp"
#include "secret.hpp"
#include "tls_context.hpp"

namespace repel::visual {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using Error = beast::error_code;
using Response = http::response<http::string_body>;
using Clock = std::chrono::steady_clock;
using beast::websocket::close_code;

/// Only resources of this server, and no embedding in other pages.
constexpr const char* policy =
    "default-src 'self'; connect-src 'self' ws: wss:; img-src 'self' data: blob:; frame-ancestors "
    "'none'; base-uri 'none'; form-action 'none'";

/// Close codes for a missing or wrong secret, and for too many attempts.
constexpr auto no_secret = static_cast<close_code>(4401);
constexpr auto too_many_secrets = static_cast<close_code>(4429);
constexpr const char* question = R"({"type":"secret"})";

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}

/// The secret in a message {"type": "secret", "secret": TEXT}.
std::optional<std::string> secret_in(std::string_view text) {
  const auto message = nlohmann::json::parse(text, nullptr, false);
  if (fields::text(message, "type") != "secret") return std::nullopt;
  return fields::value_of<std::string>(fields::member(message, "secret"));
}

/// The URL by which a browser on this machine reaches the endpoint.
std::string url_of(const tcp::endpoint& place, bool tls) {
  const asio::ip::address address = place.address();
  std::string name = address.is_v6() ? "[" + address.to_string() + "]" : address.to_string();
  if (address.is_unspecified()) name = "localhost";
  return (tls ? "https://" : "http://") + name + ":" + std::to_string(place.port()) + "/";
}

}  // namespace

class Server::Impl final : public Pages {
 public:
  Impl(const ServerOptions& options, std::vector<Asset> assets, PageHandler& show)
      : options_(options),
        lobby_(static_cast<std::size_t>(options.visitors),
               static_cast<std::size_t>(options.visitors_of_one)),
        secret_(options.secret),
        tls_(options.tls ? std::optional(tls_context(*options.tls)) : std::nullopt),
        acceptor_(listening(context_, options)),
        url_(url_of(acceptor_.local_endpoint(), tls_.has_value())),
        show_(show),
        refreshes_(context_) {
    for (Asset& asset : assets) {
      std::string target = asset.target;
      assets_.emplace(std::move(target), Served(std::move(asset)));
    }
    accept();
    refresh();
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
  /// A connection until it has been answered or upgraded to a page.
  struct Visitor {
    Visitor(tcp::socket&& socket, asio::ssl::context* tls)
        : connection(std::make_unique<Connection>(std::move(socket), tls)) {
      parser.emplace();
      parser->header_limit(8192);
      parser->body_limit(0);
    }
    void leave() {
      Error ignored;
      if (connection) connection->tcp().socket().close(ignored);
    }
    std::unique_ptr<Connection> connection;  ///< null: a page has it
    beast::flat_buffer buffer{16384};
    std::optional<http::request_parser<http::empty_body>> parser;
    Response response;
    std::optional<Gate> gate;
    std::shared_ptr<Seat> seat;
  };
  using Guest = std::shared_ptr<Visitor>;

  /// A page that has not presented the secret yet.
  struct Newcomer {
    std::shared_ptr<PageSession> page;
    std::shared_ptr<Seat> seat;
    Clock::time_point until;
  };

  /// A file of the page as it is sent, plain and compressed.
  struct Served {
    explicit Served(Asset&& file)
        : asset(std::move(file)), packed(gzipped(asset.body)), tag(tag_of(asset.body)) {}

    /// A hash of the content (FNV-1a): another version of a file has another tag.
    static std::string tag_of(std::string_view text) {
      std::uint64_t hash = 0xCBF29CE484222325U;
      for (const char each : text)
        hash = (hash ^ static_cast<unsigned char>(each)) * 0x100000001B3U;
      char digits[17];
      std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
      return digits;
    }

    Asset asset;
    std::string packed;  ///< the body, gzip
    std::string tag;
  };

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

  [[nodiscard]] asio::ssl::context* tls() { return tls_ ? &*tls_ : nullptr; }

  void accept() {
    acceptor_.async_accept([this](Error error, tcp::socket socket) {
      if (!error) attempt([&] { receive(std::make_shared<Visitor>(std::move(socket), tls())); });
      if (error == asio::error::operation_aborted) return;
      if (!error) return accept();
      // Out of file descriptors: retry after a pause.
      retry_.expires_after(std::chrono::milliseconds(100));
      retry_.async_wait([this](Error aborted) {
        if (!aborted) accept();
      });
    });
  }

  void receive(const Guest& guest) {
    Error error;
    beast::tcp_stream& tcp = guest->connection->tcp();
    const tcp::endpoint there = tcp.socket().remote_endpoint(error);
    if (error) return;  // already closed
    const tcp::endpoint here = tcp.socket().local_endpoint(error);
    if (error) return;
    guest->gate.emplace(here.address().to_string(), here.port(), tls_.has_value());
    guest->seat = lobby_.enter(network_of(there.address()));
    guest->seat->leave = [who = std::weak_ptr(guest)] {
      if (const Guest still = who.lock()) still->leave();
    };
    tcp.expires_after(options_.patience);
    guest->connection->begin([this, guest](Error unsealed) {
      if (!unsealed) attempt([&] { listen_to(guest); });
    });
  }

  void listen_to(const Guest& guest) {
    http::async_read_header(*guest->connection, guest->buffer, *guest->parser,
                            [this, guest](Error failed, std::size_t) {
                              if (!failed) answer(guest);
                            });
  }

  void answer(const Guest& guest) {
    const Request request = guest->parser->release();
    const bool is_page = beast::websocket::is_upgrade(request);
    guest->response = response_to(request, *guest->gate, is_page);
    if (is_page && guest->response.result() == http::status::ok) return open(guest, request);
    guest->seat->idle = false;
    guest->connection->tcp().expires_after(std::chrono::seconds(10));
    guest->response.keep_alive(false);
    guest->response.prepare_payload();
    if (request.method() == http::verb::head) guest->response.body().clear();
    http::async_write(*guest->connection, guest->response, [guest](Error, std::size_t) {
      Error ignored;
      guest->connection->tcp().socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  /// The response to a request; for a WebSocket upgrade, ok means that it may proceed.
  [[nodiscard]] Response response_to(const Request& request, const Gate& gate, bool is_page) const {
    const auto refuse = [&](http::status status, const char* why) {
      Response response{status, request.version()};
      response.set(http::field::content_type, "text/plain; charset=utf-8");
      response.body() = why;
      return response;
    };
    const std::string_view host = view(request[http::field::host]);
    if (request.count(http::field::host) != 1 || !gate.is_host(host))
      return refuse(http::status::forbidden, "This host is not served here.\n");
    const std::size_t origins = request.count(http::field::origin);
    if (origins > 1 || (origins == 1 && !Gate::is_origin(view(request[http::field::origin]), host,
                                                         tls_.has_value())))
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
    return file_response(request, found->second);
  }

  /// The file, compressed for whoever accepts it; only that it is the same for whoever has it. The
  /// browser asks for each file again at each load (no-cache), so that a page is of one version.
  static Response file_response(const Request& request, const Served& file) {
    const bool packs = accepts_gzip(view(request[http::field::accept_encoding]));
    const std::string tag = '"' + file.tag + (packs ? "-gzip\"" : "\"");
    const std::string_view known = view(request[http::field::if_none_match]);
    const bool same = known.find(tag) != std::string_view::npos;
    Response response{same ? http::status::not_modified : http::status::ok, request.version()};
    response.set(http::field::etag, tag);
    response.set(http::field::cache_control, "no-cache");
    response.set(http::field::vary, "Accept-Encoding");
    response.set("Content-Security-Policy", policy);
    response.set("X-Content-Type-Options", "nosniff");
    if (same) return response;
    response.set(http::field::content_type, file.asset.media_type);
    if (packs) response.set(http::field::content_encoding, "gzip");
    response.body() = packs ? file.packed : file.asset.body;
    return response;
  }

  void open(const Guest& guest, const Request& request) {
    const int number = next_page_++;
    // Browsers always send the Origin with a WebSocket request.
    const Role role = request.count(http::field::origin) > 0 ? Role::drives : Role::looks_on;
    PageSession::Events events;
    events.opened = [this, number, role] {
      if (pages_.contains(number)) return attempt([&] { show_.opened(number, role, *this); });
      const auto found = newcomers_.find(number);
      if (found != newcomers_.end())
        found->second.page->send(std::make_shared<const std::string>(question));
    };
    events.heard = [this, number](std::string_view text) {
      if (pages_.contains(number)) return attempt([&] { show_.heard(number, text, *this); });
      attempt([&] { present(number, text); });
    };
    events.closed = [this, number] {
      newcomers_.erase(number);
      if (pages_.erase(number) > 0) attempt([&] { show_.closed(number, *this); });
    };
    events.failed = [this, number] {
      newcomers_.erase(number);
      pages_.erase(number);
    };
    const PageLimits limits{options_.messages_per_second, options_.message_bytes,
                            options_.patience};
    const auto page =
        std::make_shared<PageSession>(std::move(guest->connection), limits, std::move(events));
    if (secret_.is_wanted()) {
      guest->seat->leave = [who = std::weak_ptr(page)] {
        if (const auto still = who.lock()) still->cut();
      };
      newcomers_.emplace(number, Newcomer{page, guest->seat, Clock::now() + options_.patience});
    } else {
      pages_.emplace(number, page);
    }
    page->open(request);
  }

  /// Handles the first message of a page that must present the secret.
  void present(int number, std::string_view text) {
    const auto found = newcomers_.find(number);
    if (found == newcomers_.end()) return;
    const std::shared_ptr<PageSession> page = found->second.page;
    const std::optional<std::string> given = secret_in(text);
    if (!given) return page->close(no_secret);
    using Verdict = SecretKeeper::Verdict;
    const Verdict verdict = secret_.judge(*given, found->second.seat->from, Clock::now());
    if (verdict == Verdict::wrong) return page->close(no_secret);
    if (verdict == Verdict::too_many) return page->close(too_many_secrets);
    if (count() >= options_.pages) return page->close(close_code::try_again_later);
    newcomers_.erase(found);
    pages_.emplace(number, page);
    show_.opened(number, Role::drives, *this);
  }

  void refresh() {
    const auto pace = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(1.0 / options_.refresh_rate));
    std::optional<Clock::time_point> next;
    attempt([&] { next = show_.next_refresh(); });
    refreshes_.expires_at(next.value_or(Clock::now() + pace));
    refreshes_.async_wait([this](Error error) {
      if (error) return;
      send_away_the_late();
      attempt([this] { show_.refresh(*this); });
      refresh();
    });
  }

  void send_away_the_late() {
    for (const auto& [number, newcomer] : newcomers_) {
      if (newcomer.until < Clock::now()) newcomer.page->close(no_secret);
    }
  }

  /// Runs `work`; prints an exception, unless it repeats the last one, and continues.
  template <class Work>
  void attempt(const Work& work) noexcept {
    const std::string why = complaint_of(work);
    if (why.empty() || why == complaint_) return;
    std::fprintf(stderr, "The live view has failed and goes on: %s\n", why.c_str());
    (void)complaint_of([&] { complaint_ = why; });
  }

  ServerOptions options_;
  asio::io_context context_{1};
  Lobby lobby_;
  SecretKeeper secret_;
  std::optional<asio::ssl::context> tls_;
  tcp::acceptor acceptor_;
  std::string url_;
  PageHandler& show_;
  std::map<std::string, Served> assets_;
  std::map<int, std::shared_ptr<PageSession>> pages_;
  std::map<int, Newcomer> newcomers_;
  int next_page_ = 1;
  std::string complaint_;  // the last one printed
  asio::steady_timer refreshes_;
  asio::steady_timer retry_{context_};
  std::jthread thread_;
};

Server::Server(const ServerOptions& options, std::vector<Asset> assets, PageHandler& show)
    : impl_(std::make_unique<Impl>(options, std::move(assets), show)) {}
Server::~Server() = default;

const std::string& Server::url() const noexcept {
  return impl_->url();
}

}  // namespace repel::visual
