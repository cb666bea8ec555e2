// SPDX-License-Identifier: BSD-3-Clause
#include "lobby.hpp"

#include <algorithm>
#include <map>

#include "gate.hpp"

namespace repel::visual {

std::string network_of(const boost::asio::ip::address& address) {
  const auto text = [](const auto& bytes, std::size_t size) {
    return std::string(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
  };
  const boost::asio::ip::address own = plain(address);
  return own.is_v4() ? text(own.to_v4().to_bytes(), 4) : text(own.to_v6().to_bytes(), 8);
}

std::shared_ptr<Seat> Lobby::enter(const std::string& from) {
  std::erase_if(seats_, [](const auto& seat) { return seat.expired(); });
  std::map<std::string, std::size_t> crowds;
  for (const auto& seat : seats_) ++crowds[seat.lock()->from];
  if (crowds[from] >= most_of_one_) {
    send_away(from);
  } else if (seats_.size() >= most_) {
    const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
    send_away(std::max_element(crowds.begin(), crowds.end(), fewer)->first);
  }
  auto seat = std::make_shared<Seat>();
  seat->from = from;
  seats_.push_back(seat);
  return seat;
}

void Lobby::send_away(const std::string& from) {
  const auto is_idle = [&](const auto& each) {
    const auto seat = each.lock();
    return seat->from == from && seat->idle;
  };
  auto found = std::find_if(seats_.begin(), seats_.end(), is_idle);
  if (found == seats_.end()) {
    found = std::find_if(seats_.begin(), seats_.end(),
                         [&](const auto& each) { return each.lock()->from == from; });
  }
  const std::shared_ptr<Seat> seat = found->lock();
  seats_.erase(found);
  if (seat->leave) seat->leave();
}

}  // namespace repel::visual
