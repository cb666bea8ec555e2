// SPDX-License-Identifier: BSD-3-Clause
// Site and station as two programs, by the clock, as a user runs them.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "end_to_end/teleop.hpp"
#include "end_to_end/undisturbed.hpp"

namespace repel::test {
namespace two_programs_test {

using nlohmann::json;

std::string own_port() {
  return std::to_string(20000 + getpid() % 20000);
}

#ifdef REPEL_RUNS_DDS
constexpr bool has_dds = true;
#else
constexpr bool has_dds = false;
#endif
#ifdef REPEL_RUNS_SEALED
constexpr bool can_seal = true;
#else
constexpr bool can_seal = false;
#endif

/// A new key in the folder.
std::string key_in(const Folder& folder, const std::string& name = "key") {
  const Ending ending = teleop("key " + quoted(folder / name));
  EXPECT_EQ(ending.status, 0) << ending;
  return folder / name;
}

/// Options of a link that others could reach.
std::string guarded(const Folder& folder) {
  return can_seal ? "--key " + quoted(key_in(folder)) : "--no-key";
}

/// The links that this build has, and the options of their guard.
std::vector<std::string> links(const Folder& folder) {
  const std::string guard = " " + guarded(folder);
  std::vector<std::string> all{"udp:127.0.0.1:" + own_port(), "'udp:[::1]:" + own_port() + "'"};
  if (can_seal) all.push_back("udp:127.0.0.1:" + own_port() + guard);
  if (has_dds) all.emplace_back("dds");
  if (has_dds && can_seal) all.push_back("dds" + guard);
  return all;
}

TEST(TwoPrograms, ShareASceneOverEachLink) {
  const Folder keys;
  for (const std::string& link : links(keys)) {
    SCOPED_TRACE(link);
    const bool is_sealed = link.find("--key") != std::string::npos;
    bool has_address = true;
    const std::vector<json> reports = undisturbed([&]() -> std::vector<json> {
      const Folder folder;
      Ending of_site;
      std::thread site([&] {
        of_site = teleop("site delayed --seconds 6 --link " + link + " --report " +
                         quoted(folder / "site.json"));
      });
      const Ending of_station = teleop("station delayed --seconds 5 --link " + link + " --report " +
                                       quoted(folder / "station.json"));
      site.join();
      has_address = !of_site.says("Cannot assign requested address");
      if (!has_address) return {};
      EXPECT_EQ(of_site.status, 0) << of_site;
      EXPECT_EQ(of_station.status, 0) << of_station;
      EXPECT_TRUE(of_station.says("round trip"));
      EXPECT_TRUE(of_site.says("energy over the link"));
      const json there = report_of(folder / "site.json");
      const json here = report_of(folder / "station.json");
      // What one side has output, the other has sent.
      const json& at_site = there.at("link");
      const json& at_station = here.at("link");
      EXPECT_LE(at_site.at("energy_played_j").get<double>(),
                at_station.at("energy_sent_j").get<double>() * (1.0 + 1e-9));
      EXPECT_LE(at_station.at("energy_played_j").get<double>(),
                at_site.at("energy_sent_j").get<double>() * (1.0 + 1e-9));
      EXPECT_GT(there.at("nearest_wall_m"), 0.0);
      for (const json& report : {there, here}) {
        EXPECT_EQ(report.at("link").at("sealed"), is_sealed);
        for (const char* count : {"packets_beyond_bounds", "packets_refused", "partners_closed"}) {
          EXPECT_EQ(report.at("link").at(count), 0) << count;
        }
        for (const char* count : {"allocations_in_tick", "system_calls_in_tick"}) {
          const json& counted = report.at(count);
          EXPECT_TRUE(counted.is_null() || counted == 0) << count << ' ' << counted;
        }
      }
      return {there, here};
    });
    if (!has_address) continue;  // a machine without IPv6
    if (reports.empty()) GTEST_SKIP() << stood_still;
    for (const json& report : reports) {
      EXPECT_EQ(report.at("link").at("partner_sessions"), 1);
      EXPECT_EQ(report.at("link").at("refused_packets"), 0);
      EXPECT_GT(report.at("link").at("packets_received"), 500);
    }
    EXPECT_GT(reports[1].at("site_heard_s"), 1.0);
    // Over DDS two programs on a busy machine hear of each other late: then there is no time to
    // come near the table, and neither side has anything near.
    EXPECT_EQ(reports[1].at("nearest_m").is_null(), reports[0].at("nearest_m").is_null());
    EXPECT_GT(reports[0].at("link").at("energy_played_j"), 0.0);
  }
}

TEST(TwoPrograms, ASiteThatOthersCanReachSaysSoAtTheStartAndInTheReport) {
  for (const bool is_open : {true, false}) {
    const Folder folder;
    const std::string address = is_open ? "0.0.0.0:" : "127.0.0.1:";
    const Ending ending = teleop("site delayed --no-key --seconds 0.2 --link udp:" + address +
                                 own_port() + " --report " + quoted(folder / "site.json"));
    ASSERT_EQ(ending.status, 0) << ending;
    const json report = report_of(folder / "site.json");
    const std::string exposure = report.at("link").at("exposure");
    EXPECT_EQ(ending.says("can drive the robot"), is_open) << ending;
    EXPECT_EQ(exposure.find("any network of this machine") != std::string::npos, is_open);
    EXPECT_EQ(report.at("warnings").dump().find("can drive the robot") != std::string::npos,
              is_open);
  }
}

TEST(TwoPrograms, AnotherKeyIsNotHeardAndTheReportSaysSo) {
  if (!can_seal) GTEST_SKIP() << "needs libsodium";
  const Folder folder;
  const std::string link = "--link udp:127.0.0.1:" + own_port();
  Ending of_site;
  std::thread site([&] {
    of_site = teleop("site delayed --seconds 3 " + link + " --key " +
                     quoted(key_in(folder, "one")) + " --report " + quoted(folder / "site.json"));
  });
  const Ending of_station =
      teleop("station delayed --seconds 2 " + link + " --key " + quoted(key_in(folder, "other")));
  site.join();
  EXPECT_TRUE(of_station.says("NOT heard")) << of_station;
  const json at_site = report_of(folder / "site.json").at("link");
  EXPECT_EQ(at_site.at("sealed"), true);
  EXPECT_GT(at_site.at("refused_packets"), 0);
  EXPECT_EQ(at_site.at("packets_received"), 0);
  EXPECT_EQ(at_site.at("partner_sessions"), 0);
}

TEST(TwoPrograms, ALinkThatOthersReachNeedsAKey) {
  for (const std::string& link : {"udp:0.0.0.0:" + own_port(), "udp:192.0.2.1:" + own_port()}) {
    for (const std::string side : {"site", "station"}) {
      const Ending ending = teleop(side + " delayed --seconds 0.2 --link " + link);
      EXPECT_EQ(ending.status, 1) << ending;
      EXPECT_TRUE(ending.says("needs a key")) << ending;
      EXPECT_TRUE(ending.says("teleop key FILE")) << ending;
      EXPECT_TRUE(ending.says("--no-key")) << ending;
    }
  }
  if (has_dds) {
    EXPECT_TRUE(teleop("site delayed --seconds 0.2 --link dds:eth0").says("needs a key"));
    const Ending local = teleop("site delayed --seconds 0.2 --link dds");
    EXPECT_EQ(local.status, 0) << local;
    EXPECT_TRUE(local.says("every network interface")) << local;
  }
  const Folder folder;
  const std::string own = "site delayed --seconds 0.2 --link udp:127.0.0.1:" + own_port();
  if (!can_seal) {
    EXPECT_TRUE(teleop(own + " --key any").says("apt-get install libsodium-dev"));
    EXPECT_TRUE(teleop("key " + quoted(folder / "key")).says("apt-get install libsodium-dev"));
    return;
  }
  const Ending missing = teleop(own + " --key " + quoted(folder / "none"));
  EXPECT_EQ(missing.status, 1) << missing;
  EXPECT_TRUE(missing.says("none: the key cannot be read")) << missing;
  const std::string key = key_in(folder);
  EXPECT_EQ(teleop("key " + quoted(key)).status, 1) << "a key is overwritten";
  // The environment names a key for all that have no other.
  ASSERT_EQ(setenv("REPEL_KEY", key.c_str(), 1), 0);
  EXPECT_TRUE(teleop(own).says("sealed"));
  EXPECT_FALSE(teleop(own + " --no-key").says("sealed"));
  EXPECT_EQ(teleop("delayed --fast --seconds 0.1").status, 0);
  ASSERT_EQ(unsetenv("REPEL_KEY"), 0);
}

TEST(TwoPrograms, RunInOneCommand) {
  // The hand goes down into a corner 50 ms away, one packet in fifty lost: walls hold, and it feels
  // them.
  const std::vector<json> reports = undisturbed([&]() -> std::vector<json> {
    const Folder folder;
    const Ending ending =
        teleop("remote --link udp:127.0.0.1:" + std::to_string(21000 + getpid() % 20000) +
               " --programs two --seconds 10 --report " + quoted(folder / "report.json"));
    EXPECT_EQ(ending.status, 0) << ending;
    EXPECT_TRUE(ending.says("delayed by 50 to 55 ms, 2 % lost")) << ending;
    EXPECT_TRUE(ending.says("felt at the handle")) << ending;
    const json report = report_of(folder / "report.json");
    const json& station = report.at("station");
    EXPECT_EQ(station.at("side"), "station");
    EXPECT_GT(report.at("nearest_wall_m"), 0.002);
    EXPECT_LE(report.at("link").at("energy_played_j").get<double>(),
              station.at("link").at("energy_sent_j").get<double>() * (1.0 + 1e-9));
    for (const json& side : {report, station}) {
      for (const json& module : side.at("modules")) {
        EXPECT_EQ(module.at("passive"), module.at("claims_passive")) << module;
      }
    }
    return {report, station};
  });
  if (reports.empty()) GTEST_SKIP() << stood_still;
  for (const json& side : reports) {
    const json& link = side.at("link");
    const double received = link.at("packets_received");
    const double lost = link.at("packets_lost");
    EXPECT_GT(received, 1000.0);
    EXPECT_NEAR(lost / (received + lost), 0.02, 0.015);
    EXPECT_GT(link.at("round_trip_p50_us").get<double>(), 100e3);
  }
  EXPECT_GT(reports[0].at("peak_force_n"), 10.0);
  EXPECT_GT(reports[1].at("peak_hand_force_n"), 5.0);
}

TEST(TwoPrograms, WhatTheOtherProgramCannotDoEndsBoth) {
  const Ending ending =
      teleop("remote --programs two --device evdev:/dev/null --link udp:127.0.0.1:" + own_port());
  EXPECT_EQ(ending.status, 1) << ending;
  EXPECT_TRUE(ending.says("/dev/null")) << ending;
}

/// Two network namespaces with a cable between them: two machines, as far as programs can tell.
class TwoMachines {
 public:
  TwoMachines() {
    const std::string commands[] = {"ip netns add " + name_ + "a", "ip netns add " + name_ + "b",
                                    "ip link add " + name_ + "a type veth peer name " + name_ + "b",
                                    "ip link set " + name_ + "a netns " + name_ + "a",
                                    "ip link set " + name_ + "b netns " + name_ + "b",
                                    on("a", "ip address add 10.77.9.1/24 dev " + name_ + "a"),
                                    on("b", "ip address add 10.77.9.2/24 dev " + name_ + "b"),
                                    // DDS ends by a message to itself.
                                    on("a", "ip link set lo up"), on("b", "ip link set lo up"),
                                    on("a", "ip link set " + name_ + "a up"),
                                    on("b", "ip link set " + name_ + "b up")};
    for (const std::string& command : commands) {
      if (std::system((command + " >/dev/null 2>&1").c_str()) != 0) return;
    }
    are_there_ = true;
  }
  ~TwoMachines() {
    for (const char* which : {"a", "b"}) {
      (void)std::system(("ip netns del " + name_ + which + " >/dev/null 2>&1").c_str());
    }
  }
  TwoMachines(const TwoMachines&) = delete;
  TwoMachines& operator=(const TwoMachines&) = delete;

  [[nodiscard]] bool are_there() const { return are_there_; }
  /// The name of the network interface of "a" or "b".
  [[nodiscard]] std::string interface(const std::string& which) const { return name_ + which; }
  /// Runs teleop there. @param before words that run it, such as timeout
  [[nodiscard]] Ending teleop_on(const std::string& which, const std::string& arguments,
                                 const std::string& before = "") const {
    return run_program("ip", "netns exec " + name_ + which + " " + before + quoted(REPEL_TELEOP) +
                                 " " + arguments);
  }

 private:
  [[nodiscard]] std::string on(const std::string& which, const std::string& command) const {
    return "ip netns exec " + name_ + which + " " + command;
  }

  std::string name_ = "rpl" + std::to_string(getpid());
  bool are_there_ = false;
};

/// The scene `delayed`, whose wall is one of 50 kN/m, with another delay [ms].
std::string delayed_by(int delay_ms, const Folder& folder) {
  std::string text = text_of(REPEL_SOURCE "/scenes/delayed.yaml");
  const auto replace = [&text](const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    if (at == std::string::npos) throw std::runtime_error("no " + what + " in delayed.yaml");
    text.replace(at, what.size(), by);
  };
  replace("delay: 100 ms", "delay: " + std::to_string(delay_ms) + " ms");
  replace("../robots", REPEL_SOURCE "/robots");
  return folder.with("delayed_" + std::to_string(delay_ms) + ".yaml", text);
}

/// The times without an operator's force: how far the tool moves [m] along an axis, at most, from
/// one second after the beginning of each.
struct Silences {
  int count = 0;
  double most_moved = 0.0;
};
Silences silences_in(const Columns& log) {
  Silences silences;
  double since = -1.0;
  std::size_t from = 0;
  const std::vector<double>& time = log.at("time_s");
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (log.at("gain")[i] != 0.0) {
      since = -1.0;
      continue;
    }
    if (since < 0.0) since = time[i];
    if (time[i] < since + 1.0) {
      from = i + 1;
      continue;
    }
    if (from == i) ++silences.count;
    for (const char* axis : {"x_m", "y_m", "z_m"}) {
      const double moved = std::abs(log.at(axis)[i] - log.at(axis)[from]);
      silences.most_moved = std::max(silences.most_moved, moved);
    }
  }
  return silences;
}

/// What must be true of both sides after any of this, on any machine.
void expect_kept(const json& site, const json& station) {
  EXPECT_GT(site.at("nearest_wall_m"), 0.002);
  for (const json& side : {site, station}) {
    for (const json& module : side.at("modules")) {
      EXPECT_EQ(module.at("passive"), module.at("claims_passive")) << module;
    }
  }
  EXPECT_LE(station.at("link").at("energy_played_j").get<double>(),
            site.at("link").at("energy_sent_j").get<double>() * (1.0 + 1e-9));
}

/// The reports of both sides, that of the site first.
std::vector<json> reports_in(const Folder& folder) {
  return {report_of(folder / "site.json"), report_of(folder / "station.json")};
}

/// What is true of both sides where they ran undisturbed.
void expect_linked(const json& site, const json& station, int delay_ms) {
  EXPECT_GT(station.at("site_heard_s"), 1.0);
  for (const json& side : {site, station}) {
    EXPECT_GT(side.at("link").at("round_trip_p50_us").get<double>(), 2e3 * delay_ms);
    EXPECT_GT(side.at("link").at("packets_lost"), 50);
  }
}

/// Links of the two machines, as each of them names it, with the options of their guard.
std::vector<std::pair<std::string, std::string>> links_of(const TwoMachines& machines,
                                                          const Folder& keys) {
  const std::string guard = " " + guarded(keys);
  std::vector<std::pair<std::string, std::string>> both{
      {"udp:10.77.9.1:7411" + guard, "udp:10.77.9.1:7411" + guard}};
  if (has_dds) {
    both.emplace_back("dds:" + machines.interface("a") + guard,
                      "dds:" + machines.interface("b") + guard);
  }
  return both;
}

// Up to 10 ms of jitter, 5 % lost. The station is killed while it leans on the table, and another
// one comes.
TEST(TwoPrograms, BetweenTwoMachinesAStationMayBeKilledAndAnotherMayCome) {
  const TwoMachines machines;
  if (!machines.are_there()) GTEST_SKIP() << "needs iproute2, and root for network namespaces";
  int delay_ms = 0;
  const Folder keys;
  for (const auto& [at_a, at_b] : links_of(machines, keys)) {
    SCOPED_TRACE(at_a + ", ms: " + std::to_string(delay_ms));
    Silences silences;
    const std::vector<json> sides = undisturbed([&]() -> std::vector<json> {
      const Folder folder;
      const std::string scene = " " + quoted(delayed_by(delay_ms, folder));
      Ending of_site;
      std::thread site([&, at = at_a] {
        of_site = machines.teleop_on("a", "site --impaired --seconds 12 --link " + at + scene +
                                              " --report " + quoted(folder / "site.json") +
                                              " --log " + quoted(folder / "site.csv"));
      });
      const Ending killed = machines.teleop_on("b", "station --impaired --link " + at_b + scene,
                                               "timeout --signal=KILL 4 ");
      // As long as it takes to see the robot at rest.
      std::this_thread::sleep_for(std::chrono::seconds(2));
      const Ending another =
          machines.teleop_on("b", "station --impaired --seconds 4 --link " + at_b + scene +
                                      " --report " + quoted(folder / "station.json"));
      site.join();
      EXPECT_EQ(of_site.status, 0) << of_site;
      EXPECT_NE(killed.status, 0) << killed;
      EXPECT_EQ(another.status, 0) << another;
      EXPECT_TRUE(of_site.says("silent_device")) << of_site;
      silences = silences_in(columns_of(folder / "site.csv"));
      std::vector<json> reports = reports_in(folder);
      expect_kept(reports[0], reports[1]);
      return reports;
    });
    if (sides.empty()) GTEST_SKIP() << stood_still;
    EXPECT_EQ(sides[0].at("link").at("partner_sessions"), 2);
    EXPECT_GT(sides[0].at("peak_force_n"), 10.0);
    expect_linked(sides[0], sides[1], delay_ms);
    EXPECT_GE(silences.count, 1);
    EXPECT_LT(silences.most_moved, 1e-3);
    delay_ms = 100;
  }
}

// The same the other way round, over 200 ms: the station goes on, and its hand meets a damper until
// another site is there.
TEST(TwoPrograms, BetweenTwoMachinesASiteMayBeKilledAndAnotherMayCome) {
  const TwoMachines machines;
  if (!machines.are_there()) GTEST_SKIP() << "needs iproute2, and root for network namespaces";
  const Folder keys;
  const std::string link = links_of(machines, keys).front().first;
  const std::vector<json> sides = undisturbed([&]() -> std::vector<json> {
    const Folder folder;
    const std::string scene = " " + quoted(delayed_by(200, folder));
    Ending of_station;
    std::thread station([&] {
      of_station =
          machines.teleop_on("b", "station --impaired --seconds 11 --link " + link + scene +
                                      " --report " + quoted(folder / "station.json"));
    });
    const Ending killed = machines.teleop_on("a", "site --impaired --link " + link + scene,
                                             "timeout --signal=KILL 5 ");
    const Ending another =
        machines.teleop_on("a", "site --impaired --seconds 6 --link " + link + scene +
                                    " --report " + quoted(folder / "site.json"));
    station.join();
    EXPECT_NE(killed.status, 0) << killed;
    EXPECT_EQ(another.status, 0) << another;
    EXPECT_EQ(of_station.status, 0) << of_station;
    std::vector<json> reports = reports_in(folder);
    expect_kept(reports[0], reports[1]);
    return reports;
  });
  if (sides.empty()) GTEST_SKIP() << stood_still;
  EXPECT_EQ(sides[1].at("link").at("partner_sessions"), 2);
  // The lever was pushed back over 200 ms, and no harder than its motor can.
  EXPECT_GT(sides[1].at("peak_lever_torque_n_m"), 1.0);
  expect_linked(sides[0], sides[1], 200);
}

TEST(TwoPrograms, AStationAloneSaysThatNobodyWasThere) {
  const Ending ending = teleop("station delayed --seconds 0.5 --link udp:127.0.0.1:" + own_port());
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("NOT heard")) << ending;
}

TEST(TwoPrograms, WhatCannotBeDividedIsRefused) {
  const struct {
    const char* arguments;
    int status;
    const char* words;
  } cases[] = {
      {"site plates", 1, "'line'"},
      {"station plates", 1, "'line'"},
      {"site two_arms", 1, "partners"},
      {"site delayed --fast", 2, "--fast belongs to: teleop run"},
      {"site delayed --device spacenav", 2, "--device belongs to: teleop run, teleop station"},
      {"station delayed --view --log x.csv", 2,
       "--log belongs to: teleop run, teleop replay, teleop site"},
      {"station plates --view", 1, "'line'"},
      {"delayed --link udp", 2, "--link belongs to: teleop site, teleop station"},
      {"delayed --domain 3", 2, "--domain belongs to: teleop site, teleop station"},
      {"delayed --programs one --domain 3", 2, "--programs two"},
      {"site delayed --link smoke", 2, "dds:INTERFACE"},
      {"site delayed --link udp:127.0.0.1:0", 2, "udp:ADDRESS:PORT"},
      {"site delayed --link udp:127.0.0.1:1e3", 2, "udp:ADDRESS:PORT"},
      {"site delayed --seconds 1 --link udp:no.such.name:7411", 1, "no.such.name"},
      {"site delayed --log x.mcap", 1, "--programs one"},
      {"plates --programs two", 1, "'line'"},
      {"delayed --programs two --fast", 2, "--fast"},
      {"delayed --programs two --programs one", 2, "--programs"},
      {"delayed --impaired", 2, "--impaired belongs to: teleop site, teleop station"},
      {"delayed --programs two --impaired", 2, "--impaired belongs to"},
      {"site delayed --domain 231", 2, "--domain"},
      {"site delayed --key a --no-key", 2, "--no-key"},
      {"delayed --key a", 2, "--key belongs to: teleop site, teleop station"},
      {"key", 2, "file is required"},
      {"key /", 1, "is there already"},
  };
  for (const auto& each : cases) {
    const Ending ending = teleop(each.arguments);
    EXPECT_EQ(ending.status, each.status) << each.arguments << '\n' << ending;
    EXPECT_TRUE(ending.says(each.words)) << each.arguments << '\n' << ending;
  }
}

}  // namespace two_programs_test
}  // namespace repel::test
