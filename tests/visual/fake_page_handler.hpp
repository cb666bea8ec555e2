// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A page handler that records its events, and a server that uses it.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <repel/visual/server.hpp>

#include "support/web_page.hpp"

namespace repel::visual {

class FakePageHandler final : public PageHandler {
 public:
  std::atomic<bool> shows{true};     ///< sends a frame at every refresh
  std::atomic<int> picture_size{8};  ///< [byte]
  std::atomic<int> answer_size{0};   ///< [byte] size of the answer to "ask"
  std::atomic<bool> throws{false};   ///< throws in every call
  std::atomic<bool> tells{false};    ///< sends a message to all at every refresh

  void opened(int page, Role role, Pages& pages) override {
    note(role == Role::drives ? "opened" : "looks on", page);
    pages.send(page, "welcome");
  }
  void heard(int page, std::string_view text, Pages& pages) override {
    note(std::string(text.substr(0, 100)), page);
    if (throws) throw std::runtime_error("the show fails");
    if (text == "ask") pages.send(page, std::string(static_cast<std::size_t>(answer_size), 'a'));
  }
  void closed(int page, Pages& /*pages*/) override { note("closed", page); }
  void refresh(Pages& pages) override {
    ++refreshes_;
    if (throws) throw std::runtime_error("the show fails");
    open_ = pages.count();
    if (tells) pages.send_all(std::string(static_cast<std::size_t>(picture_size), 't'));
    if (shows) pages.show(std::string(static_cast<std::size_t>(picture_size), 'p'));
  }

  /// Number of times any page has sent that message, or has opened or closed.
  [[nodiscard]] int count(const std::string& what) const {
    const std::lock_guard lock(mutex_);
    int sum = 0;
    for (const auto& [said, page] : heard_) sum += said == what ? 1 : 0;
    return sum;
  }
  /// The events of the page with that number, in order.
  [[nodiscard]] std::vector<std::string> of_page(int number) const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> all;
    for (const auto& [said, page] : heard_) {
      if (page == number) all.push_back(said);
    }
    return all;
  }
  [[nodiscard]] std::int64_t refreshes() const { return refreshes_; }
  [[nodiscard]] int open() const { return open_; }

 private:
  void note(const std::string& what, int page) {
    const std::lock_guard lock(mutex_);
    heard_.emplace_back(what, page);
  }

  mutable std::mutex mutex_;
  std::vector<std::pair<std::string, int>> heard_;
  std::atomic<std::int64_t> refreshes_{0};
  std::atomic<int> open_{0};
};

/// Waits until it holds; false on timeout.
inline bool eventually(const std::function<bool()>& holds) {
  const auto until = std::chrono::steady_clock::now() + test::patience;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// A server on a free local port.
struct Stage {
  explicit Stage(const ServerOptions& changed = {}) {
    ServerOptions options = changed;
    options.port = 0;
    server = std::make_unique<Server>(
        options,
        std::vector<Asset>{{"/", "text/html; charset=utf-8", "<p>page</p>"},
                           {"/index.html", "text/html; charset=utf-8", "<p>page</p>"},
                           {"/page.css", "text/css; charset=utf-8", "p {}"}},
        show);
    port = test::port_of(server->url());
  }

  /// Checks that the server is still working: another page opens and receives frames.
  void expect_alive() {
    test::WebPage page(port);
    ASSERT_EQ(page.status(), 101);
    expect_pictures(page, 3);
    page.close();
  }
  void expect_pictures(test::WebPage& page, int pictures) const {
    while (pictures > 0) {
      const auto message = page.next();
      ASSERT_TRUE(message.has_value()) << "closed with " << page.close_code();
      pictures -= message->starts_with('p') ? 1 : 0;
    }
  }

  FakePageHandler show;
  std::unique_ptr<Server> server;
  std::uint16_t port = 0;
};

}  // namespace repel::visual
