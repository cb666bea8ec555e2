// SPDX-License-Identifier: BSD-3-Clause
#include <repel/devices/haply_inverse.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <thread>
#include <utility>

#include <repel/base/setup_error.hpp>

#include "haply_link.hpp"

namespace repel::devices {
namespace {

using std::chrono::steady_clock;

constexpr double greeting_within = 1.0;  // [s] from the attempt to connect to the first message
constexpr double look_for_device = 0.1;  // [s] between two questions whether there is a device
constexpr int most_messages = 16;        // in one reading: bounds its time when a service floods
constexpr std::chrono::milliseconds farewell{2};  // to send that the force is zero

std::chrono::nanoseconds to_time(double seconds) noexcept {
  return std::chrono::nanoseconds(static_cast<std::chrono::nanoseconds::rep>(1e9 * seconds));
}

/// The vector, shortened to the length.
Vec3 within(const Vec3& v, double most) noexcept {
  const double length = v.norm();
  return length > most ? Vec3(most / length * v) : v;
}

/// A handle that only moves along the axes, as a port of the tool space.
network::Vec<6> along(const Vec3& v) noexcept {
  network::Vec<6> six = network::Vec<6>::Zero();
  six.head<3>() = v;
  return six;
}

HaplyInverseOptions checked_options(const HaplyInverseOptions& options) {
  checked("force limit", options.force_limit, 0.0, 10.0, "N");
  checked("slew of the force", options.force_slew, 1.0, 1e5, "N/s");
  checked("most energy of the guard", options.guard.most_energy, 0.0, 10.0, "J");
  checked("most damping of the guard", options.guard.most_damping, 0.0, 100.0, "N s/m");
  checked("number of the clutch button", options.clutch_button, 0.0, 2.0, "for a, b, c");
  checked("period", options.period, 1e-4, 0.02, "s");
  checked("silent after", options.silent_after, 0.01, 10.0, "s");
  checked("retry after", options.retry_after, 0.01, 60.0, "s");
  checked("retry at most", options.retry_at_most, options.retry_after, 3600.0, "s");
  checked("most speed", options.most_speed, 0.1, HaplyBounds::velocity, "m/s");
  const Mat3& R = options.R_WD;
  const double wrong = (R * R.transpose() - Mat3::Identity()).norm();
  if (!(wrong < 1e-6) || R.determinant() < 0.0) {
    throw SetupError(
        "the axes of the device in W are no rotation; allowed: an orthogonal matrix "
        "of determinant 1");
  }
  return options;
}

HaplyAddress checked_address(const std::string& url) {
  const std::optional<HaplyAddress> address = haply_address(url);
  if (address) return *address;
  throw SetupError("the address of the Haply Inverse Service is '" + url +
                   "'; allowed: ws://HOST or ws://HOST:PORT");
}

}  // namespace

HaplyInverse::HaplyInverse(const HaplyInverseOptions& options)
    : options_(checked_options(options)),
      link_(std::make_unique<HaplyLink>(checked_address(options.url))),
      clutch_(options.clutch),
      retry_after_(options.retry_after),
      guard_(options.guard, along(Vec3::Ones())) {
  connect();
  name_ = "Inverse3 " + state_.device_id + " on " + options_.url;
}

HaplyInverse::~HaplyInverse() {
  if (has_state_) lose("");
}

/// At set-up: waits for the first state.
void HaplyInverse::connect() {
  why_lost_ = "";
  open();
  const SteadyTime end = steady_clock::now() + std::chrono::seconds(1);
  while (!has_state_ && link_->state() != HaplyLink::State::closed && steady_clock::now() < end) {
    run_until(std::min(end, steady_clock::now() + std::chrono::milliseconds(10)));
  }
  if (has_state_) return;
  std::string text = "no Inverse3 answers on " + options_.url + ": ";
  if (link_->state() == HaplyLink::State::closed && !is_greeted_) {
    text += link_->error().empty() ? why_lost_ : link_->error();
    text +=
        "; start the Haply Inverse Service (the Haply Hub, or systemctl start "
        "haply-inverse-service), or give its address, ws://HOST:PORT";
  } else {
    text += std::string_view(why_lost_).empty() ? "the service says nothing" : why_lost_;
  }
  throw SetupError(text);
}

Measured HaplyInverse::read(std::chrono::milliseconds wait) noexcept {
  const SteadyTime end = steady_clock::now() + std::clamp(wait, std::chrono::milliseconds(0),
                                                          std::chrono::milliseconds(1000));
  try {
    run_until(end);
  } catch (const std::exception&) {
    lose("there is no memory for a message");
  }
  return measured();
}

void HaplyInverse::servo_cf(double /*lever_torque*/, const Wrench& tool_force) noexcept {
  target_ = is_finite(tool_force.force)
                ? within(options_.R_WD.transpose() * tool_force.force, options_.force_limit)
                : Vec3::Zero();
  // None at all is not waited for: nobody may read any more.
  if (target_.isZero(0.0) && !sent_.isZero(0.0)) take_back();
}

void HaplyInverse::run_until(SteadyTime end) {
  if (link_->state() == HaplyLink::State::closed) connect_anew();
  if (link_->state() == HaplyLink::State::closed) {
    std::this_thread::sleep_until(end);
    return;
  }
  if (link_->state() == HaplyLink::State::open && is_answered_) {
    // Finer than the waiting of the connection, and nothing should come now.
    std::this_thread::sleep_until(std::min(due(), end));
    if (steady_clock::now() < due()) return;
    ask();
  }
  take_until(end);
}

void HaplyInverse::connect_anew() {
  if (in_seconds(options_.now() - lost_at_) < retry_after_) return;
  retry_after_ = std::min(2.0 * retry_after_, options_.retry_at_most);
  open();
}

void HaplyInverse::open() {
  is_greeted_ = is_answered_ = is_known_ = was_up_ = false;
  asked_ = steady_clock::now();
  asked_at_ = options_.now();
  link_->open();
}

HaplyInverse::SteadyTime HaplyInverse::due() const noexcept {
  const bool soon = has_state_ || !sent_.isZero(0.0);
  return asked_ + to_time(soon ? options_.period : look_for_device);
}

void HaplyInverse::ask() {
  const HaplyTurn turn = is_known_ ? HaplyTurn::later : HaplyTurn::first;
  if (!link_->send(haply_command(id_, force_, turn))) return;  // the last is still on its way
  is_known_ = is_known_ || !id_.empty();
  is_answered_ = false;
  asked_ = steady_clock::now();
  asked_at_ = options_.now();
  acted_ = sent_;
  sent_ = force_;
}

/// Takes a message as soon as it comes, and what else is there by then.
void HaplyInverse::take_until(SteadyTime end) {
  int taken = 0;
  while (link_->run_until(taken == 0 ? end : steady_clock::now())) {
    if (++taken > most_messages) return lose("the service floods");
    take(link_->message());
    link_->drop();
  }
  if (link_->state() == HaplyLink::State::closed) {
    // A message that was wrong has closed it, and was the reason.
    if (taken == 0) lose("the service has closed the connection");
  } else if (is_overdue()) {
    lose("the service does not answer");
  }
}

bool HaplyInverse::is_overdue() const noexcept {
  const double most = is_greeted_ ? options_.silent_after : greeting_within;
  return !is_answered_ && in_seconds(options_.now() - asked_at_) > most;
}

void HaplyInverse::take(const std::string& message) {
  is_answered_ = is_greeted_ = true;
  const char* wrong = read_haply(message, read_);
  if (wrong != nullptr) return lose(wrong);
  if (read_.device_id.empty() || !read_.calibrated) {
    why_lost_ = read_.calibrated ? "the service has no device" : "the handle is not calibrated";
    has_state_ = was_up_ = false;
    clutch_.reset();
    let_go();
    id_ = read_.device_id;
    if (id_.empty()) sent_ = acted_ = Vec3::Zero();  // nobody is left to be told
    return;
  }
  const std::chrono::nanoseconds now = options_.now();
  const double passed = in_seconds(now - heard_at_);
  if (!has_state_) moved_ = told_ = Vec3::Zero();
  wrong = complaint(passed);
  if (wrong != nullptr) return lose(wrong);
  std::swap(state_, read_);
  id_ = state_.device_id;
  heard_at_ = now;
  retry_after_ = options_.retry_after;
  press();
  if (has_state_ && clutch_.engaged()) {
    update_force(read_, passed);
  } else {
    let_go();
  }
  has_state_ = true;
}

/// What is wrong with the state just read, after the last one if there is one; nullptr: nothing.
const char* HaplyInverse::complaint(double passed) noexcept {
  if (read_.velocity.norm() > options_.most_speed) return "the handle is faster than a hand";
  if (!has_state_) return nullptr;
  if (read_.device_id != state_.device_id) return "the device was changed for another";
  const double moved = (read_.position - state_.position).norm();
  if (moved > jump + options_.most_speed * passed) return "the handle jumps";
  return contradicts(passed) ? "the velocity of the handle contradicts its position" : nullptr;
}

/// A network follows the velocity, and the position corrects it only later.
bool HaplyInverse::contradicts(double passed) noexcept {
  if (!(passed > 0.0)) return false;
  const double share = passed / (compared_over + passed);
  const Vec3 mean = (read_.position - state_.position) / passed;
  moved_ += share * (mean - moved_);
  told_ += share * (0.5 * (read_.velocity + state_.velocity) - told_);
  return (told_ - moved_).norm() > most_difference + most_share * moved_.norm();
}

/// A button that is down from the start does not count as a press.
void HaplyInverse::press() noexcept {
  const bool is_down =
      state_.has_grip && state_.buttons[static_cast<std::size_t>(options_.clutch_button)];
  was_up_ = was_up_ || (state_.has_grip && !is_down);
  clutch_.set(is_down && was_up_);
  if (!state_.has_grip) {
    clutch_.reset();
    was_up_ = false;
  }
}

/// The force of the next command. What the device exchanged between the last two states is the
/// force of the command before the last: the account takes the force of the last reading for it,
/// and is told the difference.
void HaplyInverse::update_force(const HaplyState& before, double passed) noexcept {
  if (!(passed > 0.0)) return;
  const double step = std::min(passed, 0.02);
  slewed_ += within(target_ - slewed_, options_.force_slew * step);
  const Vec3 mean = (state_.position - before.position) / passed;
  const double difference = (damped_ - acted_).dot(mean);
  const double damping =
      guard_.step(along(-slewed_), along(state_.velocity), along(mean), step, difference, passed);
  damped_ = slewed_ - damping * state_.velocity;
  force_ = within(damped_, options_.force_limit);
}

void HaplyInverse::let_go() noexcept {
  slewed_ = damped_ = force_ = Vec3::Zero();
  guard_.reset();
}

/// Tells the device at once that there is no force.
void HaplyInverse::take_back() noexcept {
  let_go();
  try {
    const SteadyTime end = steady_clock::now() + farewell;
    link_->flush_until(end);
    if (!id_.empty()) ask();
    link_->flush_until(end);
  } catch (const std::exception&) {
    link_->close();  // it cannot be told, and the end of the connection must do
  }
}

void HaplyInverse::lose(const char* why) noexcept {
  if (!sent_.isZero(0.0)) take_back();
  let_go();
  target_ = acted_ = sent_ = Vec3::Zero();
  link_->close();
  id_.clear();
  has_state_ = false;
  clutch_.reset();
  why_lost_ = why;
  lost_at_ = options_.now();
}

Measured HaplyInverse::measured() const noexcept {
  if (!has_state_) return Measured::of_lost(why_lost_);
  Measured result = Measured::of_sound(clutch_.engaged());
  result.position_W = options_.R_WD * state_.position;
  result.has_position = true;
  if (state_.has_grip) {
    result.R_WH = Eigen::Quaterniond(options_.R_WD) * state_.R_DG;
    result.has_orientation = true;
  }
  if (result.clutch) result.measured_cv.linear = options_.R_WD * state_.velocity;
  return result;
}

}  // namespace repel::devices
