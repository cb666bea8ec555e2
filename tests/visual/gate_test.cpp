// SPDX-License-Identifier: BSD-3-Clause
#include "gate.hpp"

#include <gtest/gtest.h>

namespace repel::visual {
namespace gate_test {

TEST(Gate, TheAddressAndLocalhostAreHosts) {
  const Gate gate("127.0.0.1", 8448);
  EXPECT_TRUE(gate.is_host("127.0.0.1:8448"));
  EXPECT_TRUE(gate.is_host("localhost:8448"));
}

// A page of another site whose DNS name resolves to this machine, or a similar name.
TEST(Gate, OtherHostsAreNot) {
  const Gate gate("127.0.0.1", 8448);
  for (const char* host : {"",
                           ":",
                           ":8448",
                           "127.0.0.1",
                           "localhost",
                           "127.0.0.1:",
                           "127.0.0.1:8449",
                           "127.0.0.1:80",
                           "127.0.0.1:18448",
                           "127.0.0.1:084480",
                           "evil.example:8448",
                           "localhost.evil.example:8448",
                           "evil.localhost:8448",
                           "127.0.0.1.evil.example:8448",
                           "127.0.0.1.nip.io:8448",
                           "127.0.0.2:8448",
                           "0.0.0.0:8448",
                           "2130706433:8448",
                           "[::1]:8448",
                           "192.168.0.1:8448",
                           "LOCALHOST:8448",
                           " localhost:8448",
                           "localhost:8448 ",
                           "user@localhost:8448",
                           "localhost:8448/",
                           "localhost:8448:8448",
                           "localhost\t:8448",
                           "lo\ncalhost:8448"}) {
    EXPECT_FALSE(gate.is_host(host)) << host;
  }
  EXPECT_FALSE(gate.is_host(std::string_view("localhost:8448\0", 15)));
  EXPECT_FALSE(gate.is_host(std::string_view("\0localhost:8448", 15)));
}

TEST(Gate, OneAddressOfANetworkIsReachedByItAlone) {
  const Gate gate("192.168.7.5", 8448);
  EXPECT_TRUE(gate.is_host("192.168.7.5:8448"));
  for (const char* host : {"localhost:8448", "127.0.0.1:8448", "192.168.7.6:8448",
                           "arm.example:8448", "192.168.7.5", "[::ffff:192.168.7.5]:8448",
                           "[::1]:8448", "[]:8448", "192.168.7.5.nip.io:8448", "0.0.0.0:8448"}) {
    EXPECT_FALSE(gate.is_host(host)) << host;
  }
}

// Regression: a server on all interfaces accepted any address as its own, so that a page at another
// address with the same port could take control.
TEST(Gate, NoOtherAddressIsAHostForBeingInNumbers) {
  const Gate gate("10.0.0.7", 8448);
  for (const char* name : {"10.0.0.8", "8.8.8.8", "127.0.0.1", "[fe80::1]", "[2001:db8::1]"}) {
    const std::string host = std::string(name) + ":8448";
    EXPECT_FALSE(gate.is_host(host)) << host;
    EXPECT_FALSE(Gate::is_origin("http://" + host, "10.0.0.7:8448")) << host;
  }
}

TEST(Gate, IPv6StandsInBrackets) {
  const Gate gate("::1", 8448);
  EXPECT_TRUE(gate.is_host("[::1]:8448"));
  EXPECT_TRUE(gate.is_host("[0:0:0:0:0:0:0:1]:8448"));
  EXPECT_TRUE(gate.is_host("localhost:8448"));
  for (const char* host :
       {"::1:8448", "[::1]", "[::2]:8448", "127.0.0.1:8448", "[::1]:8449", "[::1:8448", "::1]:8448",
        "[]:8448", "[evil]:8448", "[::1].evil.example:8448", "[::1%lo]:8448", "deadbeef:8448"}) {
    EXPECT_FALSE(gate.is_host(host)) << host;
  }
  const Gate global("2001:db8::7", 8448);
  EXPECT_TRUE(global.is_host("[2001:DB8::7]:8448"));
  EXPECT_FALSE(global.is_host("localhost:8448"));
}

// A dual-stack socket gives IPv4 addresses as IPv4-mapped IPv6 addresses.
TEST(Gate, AnAddressOfIPv4ThatCameThroughIPv6IsStillItself) {
  const Gate gate("::ffff:127.0.0.1", 8448);
  EXPECT_TRUE(gate.is_host("127.0.0.1:8448"));
  EXPECT_TRUE(gate.is_host("localhost:8448"));
  EXPECT_FALSE(gate.is_host("127.0.0.2:8448"));
}

// For http://127.0.0.1:80 a browser sends 127.0.0.1.
TEST(Gate, BrowsersLeaveOutPort80) {
  const Gate gate("127.0.0.1", 80);
  for (const char* host : {"127.0.0.1", "127.0.0.1:80", "localhost", "localhost:80"}) {
    EXPECT_TRUE(gate.is_host(host)) << host;
  }
  EXPECT_TRUE(Gate("::1", 80).is_host("[::1]"));
  EXPECT_TRUE(Gate::is_origin("http://127.0.0.1", "127.0.0.1"));
  EXPECT_TRUE(Gate::is_origin("http://127.0.0.1", "127.0.0.1:80"));
  EXPECT_TRUE(Gate::is_origin("http://127.0.0.1:80", "127.0.0.1"));
  for (const char* host : {"127.0.0.1:", "127.0.0.1:8080", "127.0.0.1:80:80", "evil.example", ""}) {
    EXPECT_FALSE(gate.is_host(host)) << host;
  }
  EXPECT_FALSE(Gate::is_origin("http://127.0.0.1:8080", "127.0.0.1"));
  EXPECT_FALSE(Gate::is_origin("http://127.0.0.1", "127.0.0.1:8080"));
}

TEST(Gate, AnOriginIsThatOfThePageItselfToTheLetter) {
  EXPECT_TRUE(Gate::is_origin("http://127.0.0.1:8448", "127.0.0.1:8448"));
  EXPECT_TRUE(Gate::is_origin("http://localhost:8448", "localhost:8448"));
  EXPECT_TRUE(Gate::is_origin("http://[::1]:8448", "[::1]:8448"));
  for (const char* origin : {"",
                             "null",
                             "http://",
                             "https://localhost:8448",
                             "ws://localhost:8448",
                             "file://",
                             "http://localhost",
                             "http://127.0.0.1:8448",
                             "http://localhost:8449",
                             "http://localhost:80",
                             "http://localhost:3000",
                             "localhost:8448",
                             "http://evil.example:8448",
                             "http://evil.example",
                             "HTTP://LOCALHOST:8448",
                             "http://localhost:8448/",
                             "http://localhost:8448 null",
                             " http://localhost:8448",
                             "http://user@localhost:8448",
                             "http://[::1]:8448",
                             "chrome-extension://localhost:8448"}) {
    EXPECT_FALSE(Gate::is_origin(origin, "localhost:8448")) << origin;
  }
}

TEST(Gate, OverTlsThePageIsHttpsAndItsPortMayBeLeftOut) {
  const Gate gate("192.168.0.1", 443, true);
  EXPECT_TRUE(gate.is_host("192.168.0.1"));
  EXPECT_TRUE(gate.is_host("192.168.0.1:443"));
  EXPECT_FALSE(Gate("192.168.0.1", 80, true).is_host("192.168.0.1"));
  EXPECT_TRUE(Gate::is_origin("https://192.168.0.1", "192.168.0.1:443", true));
  EXPECT_FALSE(Gate::is_origin("http://192.168.0.1", "192.168.0.1", true));
  EXPECT_FALSE(Gate::is_origin("https://192.168.0.1:80", "192.168.0.1", true));
  EXPECT_FALSE(Gate::is_origin("https://192.168.0.1", "192.168.0.1"));
}

}  // namespace gate_test
}  // namespace repel::visual
