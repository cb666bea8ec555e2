// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A carrier of datagrams within the program, for tests: what is on the way can be taken, changed
/// and put there.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include <repel/link/datagrams.hpp>

namespace repel::test {

using Bytes = std::vector<std::byte>;

class DatagramsWithin final : public link::Datagrams {
 public:
  DatagramsWithin(std::deque<Bytes>& out, std::deque<Bytes>& in) : out_(out), in_(in) {}
  bool send(std::span<const std::byte, link::sealed_size> bytes,
            const link::Origin& /*to*/) noexcept override {
    out_.emplace_back(bytes.begin(), bytes.end());
    return true;
  }
  std::ptrdiff_t receive(std::span<std::byte> bytes, link::Origin& /*from*/) noexcept override {
    if (in_.empty()) return -1;
    const std::size_t size = std::min(bytes.size(), in_.front().size());
    std::copy_n(in_.front().begin(), size, bytes.begin());
    in_.pop_front();
    return static_cast<std::ptrdiff_t>(size);
  }
  void wait(std::chrono::microseconds /*longest*/) noexcept override {}
  [[nodiscard]] std::string name() const override { return "within"; }

 private:
  std::deque<Bytes>& out_;
  std::deque<Bytes>& in_;
};

}  // namespace repel::test
