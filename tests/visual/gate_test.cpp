#include "gate.hpp"

#include <gtest/gtest.h>

namespace repel::visual {
namespace gate_test {

TEST(Gate, TheAddressAndLocalhostAreHosts) {
  const Gate gate("127.0.0.1", 8448);
  EXPECT_TRUE(gate.is_host("127.0.0.1:8448"));
  EXPECT_TRUE(gate.is_host("localhost:8448"));
}

// A page of another site whose name points here, or nearly the right one.
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
  const Gate gate("192.168.7.5", 80);
  EXPECT_TRUE(gate.is_host("192.168.7.5:80"));
  for (const char* host : {"localhost:80", "127.0.0.1:80", "192.168.7.6:80", "arm.example:80"}) {
    EXPECT_FALSE(gate.is_host(host)) << host;
  }
}

TEST(Gate, OnEveryInterfaceHostsAreNumbersOrLocalhost) {
  for (const char* address : {"0.0.0.0", "::"}) {
    const Gate gate(address, 8448);
    for (const char* host : {"127.0.0.1:8448", "10.0.0.7:8448", "[::1]:8448", "[fe80::a:1]:8448",
                             "[2001:DB8::1]:8448", "localhost:8448"}) {
      EXPECT_TRUE(gate.is_host(host)) << address << ' ' << host;
    }
    for (const char* host :
         {"evil.example:8448", "10.0.0.7.nip.io:8448", "10.0.0.7:8449", ":8448", "deadbeef:8448",
          "bad.cafe:8448", "[fe80::1:8448", "fe80::1]:8448", "[]:8448", "[evil]:8448",
          "[::1].evil.example:8448", "10.0.0.7 :8448", "1a:8448"}) {
      EXPECT_FALSE(gate.is_host(host)) << address << ' ' << host;
    }
  }
}

TEST(Gate, IPv6StandsInBrackets) {
  const Gate gate("::1", 8448);
  EXPECT_TRUE(gate.is_host("[::1]:8448"));
  EXPECT_TRUE(gate.is_host("localhost:8448"));
  for (const char* host : {"::1:8448", "[::1]", "[::2]:8448", "127.0.0.1:8448", "[::1]:8449"}) {
    EXPECT_FALSE(gate.is_host(host)) << host;
  }
}

TEST(Gate, OriginsAreThoseOfThePageItselfOrNone) {
  const Gate gate("127.0.0.1", 8448);
  for (const char* origin : {"", "http://127.0.0.1:8448", "http://localhost:8448"}) {
    EXPECT_TRUE(gate.is_origin(origin)) << origin;
  }
  for (const char* origin :
       {"null", "http://", "https://127.0.0.1:8448", "ws://127.0.0.1:8448", "file://",
        "http://127.0.0.1", "http://127.0.0.1:8449", "http://localhost:3000", "127.0.0.1:8448",
        "http://evil.example:8448", "http://evil.example", "HTTP://LOCALHOST:8448",
        "http://localhost:8448/", "http://localhost:8448 null", " http://localhost:8448",
        "http://user@localhost:8448", "http://[::1]:8448", "chrome-extension://localhost:8448"}) {
    EXPECT_FALSE(gate.is_origin(origin)) << origin;
  }
}

}  // namespace gate_test
}  // namespace repel::visual
