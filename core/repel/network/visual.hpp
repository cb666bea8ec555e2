/// @file
/// VISUAL: shows what passes, and changes nothing.
#pragma once

#include <cstdint>
#include <memory>

#include <repel/base/mailbox.hpp>
#include <repel/network/one_ports.hpp>
#include <repel/network/two_port.hpp>

namespace repel::network {

/// What a display gets of one tick.
struct Picture {
  std::int64_t tick = 0;
  Pose X_WT = Pose::Identity();  ///< [m] tool
  Vec<any_size> joints;          ///< q [rad], [m]
  Wrench walls;                  ///< [N, N m] on the tool, about its origin, world axes
  PortState<any_size> port;      ///< effort and flow where the tap stands
};

/// A tap. It passes effort and flow on as they are and posts a picture of each tick into a mailbox,
/// from which a display takes the newest whenever it likes: no display can hold up a tick.
class Visual {
 public:
  static constexpr Traits traits{.keeps_flow = true};

  Visual() : box_(std::make_unique<Mailbox<Picture>>(Picture{})) {}
  /// A copy is a tap of its own: a mailbox has one writer.
  Visual(const Visual& other) : Visual() { tick_ = other.tick_; }
  Visual& operator=(const Visual& other) {
    if (this != &other) *this = Visual(other);
    return *this;
  }
  Visual(Visual&&) noexcept = default;
  Visual& operator=(Visual&&) noexcept = default;
  ~Visual() = default;

  void prepare(double period) { (void)detail::checked_period(period); }
  void face(Side /*root*/) noexcept {}
  void read(const Signals& signals) noexcept {
    Picture& picture = box_->draft();
    picture.tick = tick_++;
    picture.X_WT = signals.X_WT;
    picture.joints = signals.joints;
    picture.walls = signals.walls;
  }

  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept {
    shown = behind;
    return true;
  }
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) noexcept {
    at_leaf = at_root;
    box_->draft().port = at_root;
    box_->post();
  }

  /// One reader: `take` and `newest`.
  [[nodiscard]] Mailbox<Picture>& pictures() const noexcept { return *box_; }

 private:
  std::unique_ptr<Mailbox<Picture>> box_;
  std::int64_t tick_ = 0;
};

}  // namespace repel::network
