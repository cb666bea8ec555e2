/// @file
/// Serves one page and talks to it: HTTP and WebSocket on one port, from a thread of its own.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace repel::visual {

/// A file of the page.
struct Asset {
  std::string target;      ///< of the request: "/page.css"
  std::string media_type;  ///< "text/css"
  std::string body;
};

/// The files below `folder`, index.html as "/" as well.
/// @throws SetupError naming the folder if it has no index.html
[[nodiscard]] std::vector<Asset> load_assets(const std::string& folder);

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< of the interface to listen on
  std::uint16_t port = 8448;          ///< 0: any that is free
  int pages = 8;                      ///< that may be open at a time
  int messages_per_second = 400;      ///< of one page, pings and parts too, before it is cut off
  std::size_t message_bytes = 4096;   ///< of one message, before the page is cut off
  double beats_per_second = 60.0;     ///< [Hz] of Show::beat, unless it says when
  std::string secret;                 ///< that a page must present; empty: none
  int visitors = 64;                  ///< connections that wait for an answer; the oldest makes way
  int visitors_of_one = 32;           ///< of them from one address
  std::chrono::milliseconds patience{2000};  ///< with one that has not said what it wants
};

/// What a page may do at most: one of another program, which is no browser and presents no secret,
/// looks on.
enum class Role { looks_on, drives };

/// The pages that are open, for Show to speak to.
class Pages {
 public:
  /// Sends a message to one page; each page that is open gets a number when it opens. A page that
  /// has let a hundred of them wait is cut off.
  virtual void send(int page, std::string text) = 0;
  /// Sends a message to all.
  virtual void send_all(std::string text) = 0;
  /// Sends a picture to every page that has got its last one; the others go without.
  virtual void show(std::string text) = 0;
  [[nodiscard]] virtual int count() const = 0;

  Pages() = default;
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;
  virtual ~Pages() = default;
};

/// What is shown. The thread of the server calls these, one at a time. What they throw is said on
/// stderr, and the server goes on.
class Show {
 public:
  virtual void opened(int page, Role role, Pages& pages) = 0;
  virtual void heard(int page, std::string_view text, Pages& pages) = 0;
  virtual void closed(int page, Pages& pages) = 0;
  virtual void beat(Pages& pages) = 0;
  /// After a beat: when the next is wanted, if not at the pace of the server.
  [[nodiscard]] virtual std::optional<std::chrono::steady_clock::time_point> next_beat() const {
    return std::nullopt;
  }

  Show() = default;
  Show(const Show&) = delete;
  Show& operator=(const Show&) = delete;
  virtual ~Show() = default;
};

/// Listens from construction on. Only a page that it has served itself may talk to it: a request
/// for another host than the end of its own connection and a WebSocket of another origin get 403.
/// Neither a page that is slow nor one that sends too much or too long messages holds up anyone but
/// itself, nor do those who connect and say nothing. With a secret nothing is shown or heard before
/// a page has presented it.
class Server {
 public:
  /// @param show must live as long as the server
  /// @throws SetupError naming address and port if they cannot be had
  Server(const ServerOptions& options, std::vector<Asset> assets, Show& show);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server();

  /// Where the page is for a browser on this machine: "http://127.0.0.1:8448/".
  [[nodiscard]] const std::string& url() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace repel::visual
