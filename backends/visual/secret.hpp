// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Checks the secret that a page must present.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>

namespace repel::visual {

/// Compares a presented secret in constant time and limits the rate of attempts: five wrong ones
/// from one network, then one more every two seconds.
class SecretKeeper {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Verdict { right, wrong, too_many };

  /// @param secret empty: none is required
  explicit SecretKeeper(std::string secret) : secret_(std::move(secret)) {}

  [[nodiscard]] bool is_wanted() const { return !secret_.empty(); }
  /// @param from network_of the client. If it has no attempts left, nothing is compared.
  [[nodiscard]] Verdict judge(std::string_view given, const std::string& from,
                              Clock::time_point now);

 private:
  static constexpr double most_tries = 5.0;
  static constexpr double tries_per_second = 0.5;
  static constexpr std::size_t most_networks = 1024;

  struct Tries {
    double left = most_tries;
    Clock::time_point at;
  };

  [[nodiscard]] Tries& tries_of(const std::string& from, Clock::time_point now);
  void forget_the_longest_unheard();

  std::string secret_;
  std::map<std::string, Tries> tries_;  ///< of networks with wrong attempts
};

/// Whether both are equal; the time depends on their lengths alone.
[[nodiscard]] bool is_same(std::string_view given, std::string_view secret);

}  // namespace repel::visual
