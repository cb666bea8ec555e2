/// @file
/// The connections that are not answered yet.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include <boost/asio/ip/address.hpp>

namespace repel::visual {

/// From where somebody comes, as far as one can tell people apart: an address of IPv4, or the upper
/// half of one of IPv6, of which everybody has the lower half to himself.
[[nodiscard]] std::string network_of(const boost::asio::ip::address& address);

/// Of one who waits. It is free again when the last reference to it is gone.
struct Seat {
  std::string from;             ///< network_of
  bool idle = true;             ///< has not said yet what is wanted
  std::function<void()> leave;  ///< ends the connection
};

/// So many may wait and no more, and yet a newcomer always gets a seat: the one who has said
/// nothing for longest leaves, of those from where most of them come.
class Lobby {
 public:
  /// @param most in all
  /// @param most_of_one from one network
  Lobby(std::size_t most, std::size_t most_of_one) : most_(most), most_of_one_(most_of_one) {}

  [[nodiscard]] std::shared_ptr<Seat> enter(const std::string& from);

 private:
  void send_away(const std::string& from);

  std::size_t most_, most_of_one_;
  std::deque<std::weak_ptr<Seat>> seats_;  ///< in the order of arrival
};

}  // namespace repel::visual
