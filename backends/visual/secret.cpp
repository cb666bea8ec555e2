// SPDX-License-Identifier: BSD-3-Clause
#include "secret.hpp"

#include <algorithm>

#include <openssl/crypto.h>

namespace repel::visual {

bool is_same(std::string_view given, std::string_view secret) {
  return given.size() == secret.size() &&
         CRYPTO_memcmp(given.data(), secret.data(), given.size()) == 0;
}

SecretKeeper::Verdict SecretKeeper::judge(std::string_view given, const std::string& from,
                                          Clock::time_point now) {
  Tries& tries = tries_of(from, now);
  if (tries.left < 1.0) return Verdict::too_many;
  if (is_same(given, secret_)) {
    tries_.erase(from);
    return Verdict::right;
  }
  tries.left -= 1.0;
  return Verdict::wrong;
}

SecretKeeper::Tries& SecretKeeper::tries_of(const std::string& from, Clock::time_point now) {
  if (!tries_.contains(from) && tries_.size() >= most_networks) forget_the_longest_unheard();
  Tries& tries = tries_.try_emplace(from, Tries{most_tries, now}).first->second;
  const double passed = std::chrono::duration<double>(now - tries.at).count();
  tries.left = std::min(most_tries, tries.left + tries_per_second * passed);
  tries.at = now;
  return tries;
}

void SecretKeeper::forget_the_longest_unheard() {
  const auto earlier = [](const auto& a, const auto& b) { return a.second.at < b.second.at; };
  tries_.erase(std::min_element(tries_.begin(), tries_.end(), earlier));
}

}  // namespace repel::visual
