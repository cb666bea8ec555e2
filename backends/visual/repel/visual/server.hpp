// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Serves the live view: HTTP and WebSocket on one port, in its own thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <repel/visual/tls.hpp>

namespace repel::visual {

/// A file of the page.
struct Asset {
  std::string target;      ///< path of the request: "/page.css"
  std::string media_type;  ///< "text/css"
  std::string body;        ///< its content
};

/// All files below `folder`; index.html also as "/".
/// @throws SetupError naming the folder if it has no index.html
[[nodiscard]] std::vector<Asset> load_assets(const std::string& folder);

/// Where the server listens, and its limits.
struct ServerOptions {
  std::string address = "127.0.0.1";  ///< of the interface to listen on
  std::uint16_t port = 8448;          ///< 0: any free port
  int pages = 8;                      ///< maximum number of open pages
  int messages_per_second = 400;     ///< limit per page, pings and fragments included; else cut off
  std::size_t message_bytes = 4096;  ///< limit per message; beyond it the page is cut off
  double refresh_rate = 60.0;  ///< [Hz] of PageHandler::refresh, unless next_refresh gives a time
  std::string secret;          ///< that a page must present; empty: none
  std::optional<TlsFiles> tls{};  ///< pages are https; none: http, which anyone on the way can read
  int visitors = 64;              ///< limit of unanswered connections; the oldest is closed
  int visitors_of_one = 32;       ///< limit per IPv4 address or IPv6 /64 network
  std::chrono::milliseconds patience{2000};  ///< timeout for a connection without a request
};

/// Permissions of a page. A client without Origin (not a browser) that presents no secret only
/// watches.
enum class Role { looks_on, drives };

/// The open pages, for use by PageHandler.
class Pages {
 public:
  /// Sends a message to one page; each page gets a number when it opens. A page with a hundred
  /// unsent messages is cut off.
  virtual void send(int page, std::string text) = 0;
  /// Sends a message to all pages.
  virtual void send_all(std::string text) = 0;
  /// Sends a picture to every page that has received its last one; the others skip it.
  virtual void show(std::string text) = 0;
  /// Number of open pages.
  [[nodiscard]] virtual int count() const = 0;

  Pages() = default;
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;
  virtual ~Pages() = default;
};

/// The content of the pages. Called by the server's thread, one call at a time. Exceptions are
/// printed on stderr, and the server continues.
class PageHandler {
 public:
  /// A page has opened.
  virtual void opened(int page, Role role, Pages& pages) = 0;
  /// A page has sent a message.
  virtual void heard(int page, std::string_view text, Pages& pages) = 0;
  /// A page has closed.
  virtual void closed(int page, Pages& pages) = 0;
  /// It is time for a picture.
  virtual void refresh(Pages& pages) = 0;
  /// Called after a refresh: the time of the next one; none: at the server's rate.
  [[nodiscard]] virtual std::optional<std::chrono::steady_clock::time_point> next_refresh() const {
    return std::nullopt;
  }

  PageHandler() = default;
  PageHandler(const PageHandler&) = delete;
  PageHandler& operator=(const PageHandler&) = delete;
  virtual ~PageHandler() = default;
};

/// Listens from construction on. Only pages served by this server may use it: a request for a host
/// other than the local address of its connection, and a WebSocket of another origin, get 403. A
/// slow page, one sending too many or too long messages, or a client sending nothing delays only
/// itself. With a secret, nothing is sent to or accepted from a page before it has presented it.
class Server {
 public:
  /// @param show must outlive the server
  /// @throws SetupError naming address and port if it cannot listen there, or what is wrong with
  /// the
  ///   certificate
  Server(const ServerOptions& options, std::vector<Asset> assets, PageHandler& show);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server();

  /// The URL of the page for a browser on this machine: "http://127.0.0.1:8448/".
  [[nodiscard]] const std::string& url() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace repel::visual
