// SPDX-License-Identifier: BSD-3-Clause
// By hand: libspnav keeps one connection for all of a process; here each device has its own.
#include <repel/devices/spacenav.hpp>

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include <repel/base/setup_error.hpp>

namespace repel::devices {
namespace {

/// A socket connected to `path`; on failure none, and `error` is set. Never blocks: a local socket
/// connects at once or not at all.
detail::Descriptor connected_to(const std::string& path, int& error) noexcept {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  detail::Descriptor fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const auto* generic = static_cast<const sockaddr*>(static_cast<const void*>(&address));
  error = 0;
  if (!fd.open() || ::connect(fd.get(), generic, sizeof address) != 0) {
    error = errno;
    fd.close();
  }
  return fd;
}

std::vector<std::string> paths_to_try(const std::string& wanted) {
  if (!wanted.empty()) return {wanted};
  // NOLINTNEXTLINE(concurrency-mt-unsafe): read at set-up
  const char* from_environment = std::getenv("SPNAV_SOCKET");
  if (from_environment != nullptr && *from_environment != '\0') return {from_environment};
  return {"/run/spnav.sock", "/var/run/spnav.sock"};
}

void check_path(const std::string& path) {
  constexpr std::size_t most = sizeof(sockaddr_un::sun_path) - 1;
  if (path.size() <= most) return;
  std::string text = "the path of the socket of spacenavd has ";
  text += std::to_string(path.size());
  text += " characters, ";
  text += path;
  text += "; allowed: 1 to ";
  text += std::to_string(most);
  throw SetupError(text);
}

[[noreturn]] void fail_to_connect(const std::string& what_happened) {
  std::string text = "no spacenavd answers:";
  text += what_happened;
  text += "; start it (apt-get install spacenavd; systemctl start spacenavd), or name its socket ";
  text += "in the environment variable SPNAV_SOCKET";
  throw SetupError(text);
}

}  // namespace

Spacenav::Spacenav(const SpacenavOptions& options)
    : options_(options),
      shaping_(options.shaping),
      paths_(paths_to_try(options.path)),
      clutch_(options.clutch) {
  checked("stale after", options.stale_after, 0.01, 60.0, "s");
  checked("retry after", options.retry_after, 0.01, 60.0, "s");
  checked("number of the clutch button", options.clutch_button, 0.0,
          SpacenavParser::most_buttons - 1, "from 0");
  std::string what_happened;
  for (const std::string& path : paths_) {
    check_path(path);
    int error = 0;
    socket_ = connected_to(path, error);
    if (socket_.open()) {
      name_ = "Spacenav on ";
      name_ += path;
      return;
    }
    what_happened += what_happened.empty() ? " " : ", ";
    what_happened += path;
    what_happened += ": ";
    what_happened += std::generic_category().message(error);
  }
  fail_to_connect(what_happened);
}

Measured Spacenav::read(std::chrono::milliseconds wait) noexcept {
  if (!socket_.open()) connect_anew();
  socket_.wait(wait);
  if (socket_.open()) take_bytes();
  return measured();
}

void Spacenav::connect_anew() noexcept {
  const std::chrono::nanoseconds now = options_.now();
  if (in_seconds(now - tried_at_) < options_.retry_after) return;
  tried_at_ = now;
  for (const std::string& path : paths_) {
    int error = 0;
    socket_ = connected_to(path, error);
    if (socket_.open()) return;
  }
}

void Spacenav::take_bytes() noexcept {
  constexpr int most_pieces = 16;  // 512 events: bounds the time when a daemon floods
  std::array<std::byte, 1024> bytes;
  for (int piece = 0; piece < most_pieces; ++piece) {
    const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (count == 0) return lose("spacenavd has closed the connection");
    if (count < 0) {
      const bool nothing_now = errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
      return nothing_now ? void() : lose("the connection to spacenavd is broken");
    }
    const auto came = std::span(bytes).first(static_cast<std::size_t>(count));
    const bool sound = parser_.feed(came, [this](const SpacenavEvent& event) { take(event); });
    if (!sound) return lose("spacenavd sent what is no event");
  }
}

void Spacenav::take(const SpacenavEvent& event) noexcept {
  using Kind = SpacenavEvent::Kind;
  if (event.kind == Kind::motion) {
    std::array<double, 6> counts{};
    std::copy(event.axes.begin(), event.axes.end(), counts.begin());
    held_ = shaping_.twist(counts);
    heard_at_ = options_.now();
  } else if (event.kind != Kind::other && event.button == options_.clutch_button) {
    clutch_.set(event.kind == Kind::press);
  }
}

void Spacenav::lose(const char* why) noexcept {
  why_lost_ = why;
  socket_.close();
  parser_.reset();
  clutch_.reset();
  held_ = {};
  tried_at_ = options_.now();
}

Measured Spacenav::measured() const noexcept {
  if (!socket_.open()) return Measured::of_lost(why_lost_);
  Measured result = Measured::of_sound(clutch_.engaged());
  const bool moves = result.clutch && !(held_.linear.isZero(0.0) && held_.angular.isZero(0.0));
  if (!moves) return result;
  // A hand that holds still is not silent if spacenavd repeats events, as docs/devices.md requires.
  result.silent = in_seconds(options_.now() - heard_at_) > options_.stale_after;
  if (result.silent) {
    result.why = "spacenavd does not renew the motion";
  } else {
    result.measured_cv = held_;
  }
  return result;
}

}  // namespace repel::devices
