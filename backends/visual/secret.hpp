/// @file
/// What whoever opens the page must know.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>

namespace repel::visual {

/// Judges what is presented as the secret, in a time that does not tell how much of it was right,
/// and not as often as somebody who guesses would like: from one network five wrong ones, then one
/// more every two seconds.
class SecretKeeper {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Verdict { right, wrong, too_many };

  /// @param secret empty: none is wanted
  explicit SecretKeeper(std::string secret) : secret_(std::move(secret)) {}

  [[nodiscard]] bool is_wanted() const { return !secret_.empty(); }
  /// @param from network_of the one who presents it. After too many nothing is compared.
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
  std::map<std::string, Tries> tries_;  ///< of those who were wrong
};

/// Whether both are the same; how long it takes depends on the length of `given` alone.
[[nodiscard]] bool is_same(std::string_view given, std::string_view secret);

}  // namespace repel::visual
