// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/options/listening.hpp>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <vector>

namespace repel::runs {
namespace {

constexpr std::size_t least_secret = 16;
constexpr std::size_t most_secret = 256;

/// The address without a zone index such as %eth0 in fe80::1%eth0.
std::string bare(const std::string& address) {
  return address.substr(0, address.find('%'));
}

bool is_address(const std::string& address) {
  in6_addr any{};
  return inet_pton(AF_INET, address.c_str(), &any) == 1 ||
         inet_pton(AF_INET6, bare(address).c_str(), &any) == 1;
}

std::string without_end(std::string line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t'))
    line.pop_back();
  return line;
}

/// What is wrong with a secret; never shows the secret.
std::string secret_complaint(const std::string& secret) {
  const bool plain =
      std::all_of(secret.begin(), secret.end(), [](char c) { return c > ' ' && c <= '~'; });
  if (plain && secret.size() >= least_secret && secret.size() <= most_secret) return {};
  return " has no secret of " + std::to_string(least_secret) + " to " +
         std::to_string(most_secret) +
         " printable characters without spaces; to make one: openssl rand -hex 16";
}

std::string read_secret(SessionOptions& session) {
  if (!session.secret_env.empty()) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): at the start, before there is another thread
    const char* value = std::getenv(session.secret_env.c_str());
    if (value == nullptr) return "--secret-env: " + session.secret_env + " is not set";
    session.secret = value;
    const std::string complaint = secret_complaint(session.secret);
    return complaint.empty() ? complaint : "--secret-env: " + session.secret_env + complaint;
  }
  const std::string& path = session.secret_file;
  std::ifstream file(path);
  // No more than can be one, with what may end its line: a device has no end.
  std::array<char, most_secret + 16> line{};
  file.get(line.data(), line.size());
  if (file.gcount() == 0) return "--secret: " + path + " cannot be read, or is empty";
  session.secret = without_end({line.data(), static_cast<std::size_t>(file.gcount())});
  const std::string complaint = secret_complaint(session.secret);
  if (!complaint.empty()) return "--secret: the first line of " + path + complaint;
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
      (status.st_mode & (S_IRGRP | S_IROTH)) != 0U) {
    std::fprintf(stderr, "Others on this machine can read the secret: chmod 600 %s\n",
                 path.c_str());
  }
  return {};
}

/// Addresses of this machine that others can reach, as written in a URL.
std::vector<std::string> names_of(bool v6_too) {
  std::vector<std::string> names;
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return names;
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> all(first, freeifaddrs);
  for (const ifaddrs* each = all.get(); each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || (each->ifa_flags & IFF_LOOPBACK) != 0U) continue;
    char text[INET6_ADDRSTRLEN] = {};
    if (each->ifa_addr->sa_family == AF_INET) {
      const auto* v4 = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
      names.emplace_back(inet_ntop(AF_INET, &v4->sin_addr, text, sizeof text));
    } else if (v6_too && each->ifa_addr->sa_family == AF_INET6) {
      const auto* v6 = reinterpret_cast<const sockaddr_in6*>(each->ifa_addr);
      if (IN6_IS_ADDR_LINKLOCAL(&v6->sin6_addr)) continue;  // browsers refuse such ones
      const std::string name = inet_ntop(AF_INET6, &v6->sin6_addr, text, sizeof text);
      names.push_back(std::string("[").append(name).append("]"));
    }
  }
  return names;
}

}  // namespace

std::optional<Place> place_of(const std::string& listen) {
  const std::size_t colon = listen.rfind(':');
  if (colon == std::string::npos || colon == 0) return std::nullopt;
  Place place{listen.substr(0, colon), 0};
  if (place.address.front() == '[' && place.address.back() == ']') {
    place.address = place.address.substr(1, place.address.size() - 2);
  }
  const char* begin = listen.data() + colon + 1;
  const char* end = listen.data() + listen.size();
  const auto [last, error] = std::from_chars(begin, end, place.port);
  if (error != std::errc() || last != end || begin == end) return std::nullopt;
  return is_address(place.address) ? std::optional(place) : std::nullopt;
}

bool is_loopback(const Place& place) {
  in_addr v4{};
  if (inet_pton(AF_INET, place.address.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24U == 127U;
  in6_addr v6{};
  if (inet_pton(AF_INET6, bare(place.address).c_str(), &v6) != 1) return false;
  return IN6_IS_ADDR_LOOPBACK(&v6) || (IN6_IS_ADDR_V4MAPPED(&v6) && v6.s6_addr[12] == 127U);
}

std::string listen_complaint(const std::string& listen) {
  return place_of(listen) ? ""
                          : "'" + listen +
                                "'; allowed: ADDRESS:PORT in numbers, as 127.0.0.1:8448 or "
                                "[::1]:8448";
}

std::string settle_secret(SessionOptions& session) {
  const bool has_secret = !session.secret_file.empty() || !session.secret_env.empty();
  if (has_secret) {
    if (const std::string complaint = read_secret(session); !complaint.empty()) return complaint;
  }
  const std::optional<Place> place = place_of(session.listen);
  std::string missing;
  if (session.view && place && !is_loopback(*place)) {
    if (!has_secret) {
      missing = "--secret FILE (the secret of the pages is its first line) or --secret-env NAME, ";
    }
    if (session.tls.empty() && !session.plain) {
      missing += "--tls self, --tls CERTIFICATE,KEY or, where all may read and drive, --plain, ";
    }
  }
  if (missing.empty()) return {};
  return "--listen: other machines reach " + session.listen + "; add " + missing +
         "or listen on 127.0.0.1 and come through ssh -L";
}

std::string tls_complaint(const std::string& tls) {
  const std::size_t comma = tls.find(',');
  const bool two = comma != std::string::npos && comma > 0 && comma + 1 < tls.size();
  return two || tls == "self" ? ""
                              : "'" + tls + "'; allowed: self, or CERTIFICATE,KEY as PEM files";
}

void announce(const SessionOptions& session, const std::string& url,
              const std::string& fingerprint) {
  std::fprintf(stderr, "Live view: %s\n", url.c_str());
  const Place place = place_of(session.listen).value_or(Place{});
  if (place.address == "0.0.0.0" || place.address == "::") {
    const std::string port = url.substr(url.rfind(':'));
    for (const std::string& name : names_of(place.address == "::")) {
      std::fprintf(stderr, "From other machines: %s://%s%s\n",
                   session.tls.empty() ? "http" : "https", name.c_str(), port.c_str());
    }
  }
  if (!session.secret.empty()) {
    const std::string where = session.secret_file.empty()
                                  ? "the environment variable " + session.secret_env
                                  : "the first line of " + session.secret_file;
    std::fprintf(stderr, "Behind the address: #secret=SECRET, which is %s.\n", where.c_str());
  }
  if (!fingerprint.empty()) {
    std::fprintf(stderr,
                 "The browser does not know the certificate: accept it if its SHA-256 fingerprint "
                 "is\n  %s\n",
                 fingerprint.c_str());
  }
  if (!is_loopback(place) && session.tls.empty()) {
    std::fputs(
        "Nothing is encrypted: through networks you do not trust use ssh -L, see "
        "docs/live_view.md.\n",
        stderr);
  }
}

}  // namespace repel::runs
