// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The thread sending and receiving the packets of a link, in place of the tick.
#pragma once

#include <pthread.h>

#include <chrono>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include <repel/link/transport.hpp>
#include <repel/network/remote/link.hpp>

namespace repel::link {

/// Times of the thread of a link, and what it does first.
struct LinkThreadOptions {
  std::chrono::microseconds wait{200};     ///< longest time that a packet of the tick waits
  const char* thread_name = "repel link";  ///< as shown by `ps -L`, up to 15 characters
  void (*begin)() noexcept = nullptr;      ///< called first in the thread, to set its priority
};

/// Owns a transport and the only thread that uses it. A tick is not woken and wakes nobody: the
/// thread looks for its packets every `wait`, and at once when something arrives.
class LinkThread {
 public:
  /// @param link must outlive this object
  LinkThread(network::RemoteLink& link, std::unique_ptr<Transport> transport,
             const LinkThreadOptions& options = {})
      : link_(link),
        transport_(std::move(transport)),
        options_(options),
        name_(transport_->name()),
        exposure_(transport_->exposure()) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  /// Of the transport, for people.
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

  /// Transport::exposure.
  [[nodiscard]] const std::string& exposure() const noexcept { return exposure_; }

  /// Ends the thread; after that the link is silent.
  void stop() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
  }
  /// After `stop`: invalid messages received, and packets that could not be sent.
  [[nodiscard]] std::int64_t foreign() const noexcept { return transport_->foreign(); }
  /// Transport::is_sealed.
  [[nodiscard]] bool is_sealed() const noexcept { return transport_->is_sealed(); }
  /// After `stop`: Transport::refused.
  [[nodiscard]] std::int64_t refused() const noexcept { return transport_->refused(); }
  /// Packets that the transport did not take.
  [[nodiscard]] std::int64_t unsent() const noexcept { return unsent_; }

 private:
  void run(const std::stop_token& stop) noexcept {
    (void)pthread_setname_np(pthread_self(), options_.thread_name);
    if (options_.begin != nullptr) options_.begin();
    while (!stop.stop_requested()) {
      while (const network::RemotePacket* packet = link_.outgoing().front()) {
        unsent_ += transport_->send(*packet) ? 0 : 1;
        link_.outgoing().pop();
      }
      // What finds no room is lost, as it may be on the way.
      for (std::size_t i = 0; i < network::RemoteLink::room; ++i) {
        if (!transport_->receive(link_.incoming().draft())) break;
        (void)link_.incoming().post();
      }
      transport_->wait(options_.wait);
    }
  }

  network::RemoteLink& link_;
  std::unique_ptr<Transport> transport_;
  LinkThreadOptions options_;
  std::string name_;
  std::string exposure_;
  std::int64_t unsent_ = 0;
  std::jthread thread_;
};

}  // namespace repel::link
