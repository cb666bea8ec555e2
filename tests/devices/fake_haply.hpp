// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A fake Haply Inverse Service whose handle and messages the test controls.
#pragma once

#include <sys/socket.h>

#include <array>
#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include <repel/base/types.hpp>

namespace repel::devices {

/// What the service says of its devices, in their axes.
struct FakeHandle {
  std::string id = "049D";
  Vec3 position{0.01, -0.12, 0.15};
  Vec3 velocity{0, 0, 0};
  bool is_there = true;
  bool calibrated = true;
  bool has_grip = true;
  bool is_wired = false;
  Eigen::Quaterniond R_DG = Eigen::Quaterniond::Identity();
  std::array<bool, 3> buttons{};
};

[[nodiscard]] inline nlohmann::json as_json(const Vec3& v) {
  return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}};
}

/// A state update as the service makes it.
[[nodiscard]] inline nlohmann::json state_update(const FakeHandle& h) {
  nlohmann::json text;
  text["inverse3"] = nlohmann::json::array();
  if (h.is_there) {
    text["inverse3"].push_back(
        {{"device_id", h.id},
         {"status", {{"calibrated", h.calibrated}, {"in_use", true}, {"power_supply", true}}},
         {"state",
          {{"cursor_position", as_json(h.position)},
           {"cursor_velocity", as_json(h.velocity)},
           {"body_orientation", {{"w", 1.0}, {"x", 0.0}, {"y", 0.0}, {"z", 0.0}}},
           {"control_mode", "idle"}}}});
  }
  if (!h.has_grip) return text;
  nlohmann::json state{
      {"orientation",
       {{"w", h.R_DG.w()}, {"x", h.R_DG.x()}, {"y", h.R_DG.y()}, {"z", h.R_DG.z()}}}};
  if (h.is_wired) {
    state["button"] = h.buttons[0];
  } else {
    state["buttons"] = {{"a", h.buttons[0]}, {"b", h.buttons[1]}, {"c", h.buttons[2]}};
  }
  text[h.is_wired ? "verse_grip" : "wireless_verse_grip"] = {
      {{"device_id", "61576"}, {"state", state}}};
  return text;
}

/// Listens on the loopback from construction, for one client after the other, and answers every
/// message once, as the service does.
class FakeHaply {
 public:
  using Answer = std::function<std::string(const FakeHandle&)>;

  explicit FakeHaply(unsigned short port = 0)
      : acceptor_(context_, Tcp::endpoint(boost::asio::ip::make_address("127.0.0.1"), port)) {
    thread_ = std::thread([this] { serve(); });
  }
  FakeHaply(const FakeHaply&) = delete;
  FakeHaply& operator=(const FakeHaply&) = delete;
  ~FakeHaply() { die(); }

  [[nodiscard]] unsigned short port() const { return port_; }
  [[nodiscard]] std::string url() const { return "ws://127.0.0.1:" + std::to_string(port_); }

  /// Changes what it says from the next answer on.
  template <class Change>
  void set(const Change& change) {
    const std::lock_guard lock(mutex_);
    change(handle_);
  }
  /// From now on this makes the answers; an empty one is none. Null: state updates.
  void answer_by(Answer answer) {
    const std::lock_guard lock(mutex_);
    answer_ = std::move(answer);
  }
  /// Called with each force [N] that comes, before the answer.
  void feel_by(std::function<void(const Vec3&, FakeHandle&)> feel) {
    const std::lock_guard lock(mutex_);
    feel_ = std::move(feel);
  }
  /// These bytes are sent in place of the next answer, without a frame.
  void send_bytes(std::string bytes) {
    const std::lock_guard lock(mutex_);
    bytes_ = std::move(bytes);
  }
  /// Each answer is sent so many times.
  void repeat(int times) { repeats_ = times; }

  [[nodiscard]] Vec3 force() const {  ///< [N] of the last command
    const std::lock_guard lock(mutex_);
    return force_;
  }
  [[nodiscard]] nlohmann::json heard(std::size_t i) const {
    const std::lock_guard lock(mutex_);
    return heard_.at(i);
  }
  [[nodiscard]] std::size_t messages() const {
    const std::lock_guard lock(mutex_);
    return count_;
  }
  [[nodiscard]] int clients() const { return clients_; }

  /// Simulates a kill.
  void die() {
    stops_ = true;
    ::shutdown(acceptor_.native_handle(), SHUT_RDWR);
    {
      const std::lock_guard lock(mutex_);
      if (client_ >= 0) ::shutdown(client_, SHUT_RDWR);
    }
    if (thread_.joinable()) thread_.join();
    boost::beast::error_code ignored;
    acceptor_.close(ignored);
  }

 private:
  using Tcp = boost::asio::ip::tcp;
  using Socket = boost::beast::websocket::stream<Tcp::socket>;

  void serve() {
    while (!stops_) {
      boost::beast::error_code error;
      Tcp::socket connection(context_);
      acceptor_.accept(connection, error);
      if (error) return;
      {
        const std::lock_guard lock(mutex_);
        client_ = connection.native_handle();
      }
      ++clients_;
      Socket socket(std::move(connection));
      attend(socket);
      const std::lock_guard lock(mutex_);
      client_ = -1;
    }
  }

  void attend(Socket& socket) {
    boost::beast::error_code error;
    socket.next_layer().set_option(Tcp::no_delay(true), error);
    socket.accept(error);
    if (error) return;
    socket.text(true);
    boost::beast::flat_buffer buffer;
    bool greets = true;
    while (!stops_) {
      if (!greets) {
        buffer.clear();
        socket.read(buffer, error);
        if (error) return;
        hear(boost::beast::buffers_to_string(buffer.data()));
      }
      greets = false;
      if (!reply(socket)) return;
    }
  }

  bool reply(Socket& socket) {
    std::string text;
    std::string bytes;
    {
      const std::lock_guard lock(mutex_);
      text = answer_ ? answer_(handle_) : state_update(handle_).dump();
      std::swap(bytes, bytes_);
    }
    boost::beast::error_code error;
    if (!bytes.empty()) {
      boost::asio::write(socket.next_layer(), boost::asio::buffer(bytes), error);
      return !error;
    }
    for (int i = 0; i < repeats_ && !text.empty() && !error; ++i) {
      socket.write(boost::asio::buffer(text), error);
    }
    return !error;
  }

  void hear(const std::string& text) {
    const std::lock_guard lock(mutex_);
    ++count_;
    nlohmann::json message = nlohmann::json::parse(text);
    const auto devices = message.find("inverse3");
    if (devices != message.end()) {
      const nlohmann::json& values =
          devices->at(0).at("commands").at("set_cursor_force").at("values");
      force_ = Vec3(values.at("x"), values.at("y"), values.at("z"));
      if (feel_) feel_(force_, handle_);
    }
    if (heard_.size() < 10) heard_.push_back(std::move(message));
  }

  boost::asio::io_context context_;
  Tcp::acceptor acceptor_;
  unsigned short port_ = acceptor_.local_endpoint().port();
  std::atomic<bool> stops_{false};
  std::atomic<int> repeats_{1};
  std::atomic<int> clients_{0};
  mutable std::mutex mutex_;
  FakeHandle handle_;
  Answer answer_;
  std::function<void(const Vec3&, FakeHandle&)> feel_;
  std::string bytes_;
  Vec3 force_{0, 0, 0};
  std::vector<nlohmann::json> heard_;
  std::size_t count_ = 0;
  int client_ = -1;
  std::thread thread_;
};

}  // namespace repel::devices
