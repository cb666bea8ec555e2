// SPDX-License-Identifier: BSD-3-Clause
#include <repel/devices/evdev_port.hpp>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/devices/descriptor.hpp>

namespace repel::devices {
namespace {

/// Returns -errno in place of -1.
template <class Result>
Result told(Result result) noexcept {
  return result < 0 ? static_cast<Result>(-errno) : result;
}

class OpenEvdev final : public EvdevPort {
 public:
  explicit OpenEvdev(detail::Descriptor fd) noexcept : fd_(std::move(fd)) {}

  int control(unsigned long request, void* argument) noexcept override {
    return told(::ioctl(fd_.get(), request, argument));
  }
  int control_number(unsigned long request, long argument) noexcept override {
    return told(::ioctl(fd_.get(), request, argument));
  }
  long read(std::span<std::byte> bytes) noexcept override {
    return told(::read(fd_.get(), bytes.data(), bytes.size()));
  }
  long write(std::span<const std::byte> bytes) noexcept override {
    return told(::write(fd_.get(), bytes.data(), bytes.size()));
  }
  void wait(std::chrono::milliseconds wait) noexcept override { fd_.wait(wait); }

 private:
  detail::Descriptor fd_;
};

}  // namespace

std::unique_ptr<EvdevPort> open_evdev(const std::string& path) {
  detail::Descriptor fd(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  if (fd.open()) return std::make_unique<OpenEvdev>(std::move(fd));
  std::string text = "the input device ";
  text += path;
  text += " cannot be opened to read and write: ";
  text += std::generic_category().message(errno);
  text +=
      "; /proc/bus/input/devices lists the devices, and members of the group input may open "
      "them";
  throw SetupError(text);
}

}  // namespace repel::devices
