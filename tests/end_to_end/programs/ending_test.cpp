// SPDX-License-Identifier: BSD-3-Clause
// How a run ends under external errors: a full disk, a reader that disconnects, a signal, a kill, a
// file name that is already used.
#include <sys/mount.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include <repel/host/command_line.hpp>

#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace ending_test {

/// The names in a folder, sorted.
std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

using Names = std::vector<std::string>;

/// Those of a run by the clock; a machine that stands still skips some.
int ticks_due(const nlohmann::json& report) {
  return report.at("ticks").get<int>() + report.at("skipped_ticks").get<int>();
}

/// Limits the file size in KiB; a longer file fails as on a full disk, but with "File too large".
std::string within(int kilobytes) {
  return "trap '' XFSZ; ulimit -f " + std::to_string(kilobytes) + "; ";
}

TEST(Ending, LogThatCannotBeWrittenOnIsSaidAndCostsNeitherRunNorReport) {
  for (const std::string name : {"run.csv", "run.mcap"}) {
    const Folder folder;
    const std::string log = folder.with(name, "what stood there before");
    const Ending ending = shell(within(400) + "$T anderson_4x8 --fast --seconds 3 --log " +
                                quoted(log) + " --report " + quoted(folder / "report.json"));
    EXPECT_EQ(ending.status, 4) << ending;
    EXPECT_NE(ending.err.find("the log is not whole"), std::string::npos) << ending;
    EXPECT_NE(ending.err.find(name + ".part"), std::string::npos) << ending;
    EXPECT_NE(ending.err.find("File too large"), std::string::npos) << ending;
    EXPECT_NE(ending.out.find("log is not whole"), std::string::npos) << ending;
    const auto report = report_of(folder / "report.json");
    EXPECT_EQ(report.at("ticks"), 1200) << "the run went on";
    EXPECT_NE(report.at("log_trouble").get<std::string>().find("File too large"),
              std::string::npos);
    EXPECT_EQ(text_of(log), "what stood there before");
    EXPECT_EQ(names_in(folder / ""), (Names{"report.json", name, name + ".part"}));
    if (name != "run.mcap") continue;
    const Ending replay = teleop("replay " + quoted(log + ".part"));
    EXPECT_EQ(replay.status, 0) << "what there is of it can be gone through\n" << replay;
    EXPECT_TRUE(replay.says("ends early")) << replay;
  }
}

/// A file system of 256 KiB, if it can be mounted here.
class SmallDisk {
 public:
  SmallDisk() { is_mounted_ = mount("none", path().c_str(), "tmpfs", 0, "size=256k") == 0; }
  ~SmallDisk() {
    if (is_mounted_) (void)umount(path().c_str());
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  [[nodiscard]] bool is_mounted() const { return is_mounted_; }
  [[nodiscard]] std::string path() const { return folder_ / ""; }
  [[nodiscard]] std::string operator/(const std::string& name) const { return folder_ / name; }

 private:
  Folder folder_;
  bool is_mounted_ = false;
};

TEST(Ending, FullDiskIsSaidWhileItRunsAndTheReportComesToAnotherDisk) {
  const SmallDisk disk;
  if (!disk.is_mounted()) GTEST_SKIP() << "no file system may be mounted here";
  const Folder folder;
  for (const std::string name : {"run.csv", "run.mcap"}) {
    // In real time: output must arrive before the run is over. Each has a file of its own: what the
    // run before it said would be read until the shell empties that.
    const std::string said = folder / (name + ".said");
    const Ending ending =
        shell("$T anderson_4x8 --seconds 600 --log " + quoted(disk / name) + " --report " +
              quoted(folder / "report.json") + " 2>" + quoted(said) + " & says " + quoted(said) +
              " 'No space left' && echo said; kill $!; wait $!");
    EXPECT_EQ(ending.status, 4) << ending;
    EXPECT_EQ(ending.out.substr(0, 5), "said\n") << ending << text_of(said);
    const auto report = report_of(folder / "report.json");
    EXPECT_EQ(report.at("interrupted"), true);
    EXPECT_NE(report.at("log_trouble").get<std::string>().find("No space left"), std::string::npos);
    fs::remove(disk / (name + ".part"));
  }
}

TEST(Ending, ReportThatFindsNoRoomIsSaidAndTheOthersAreWritten) {
  const SmallDisk disk;
  if (!disk.is_mounted()) GTEST_SKIP() << "no file system may be mounted here";
  const Folder folder;
  std::ofstream filling(disk / "filling");
  filling << std::string(1 << 20, 'x') << std::flush;
  for (const char* option : {"--report ", "--html "}) {
    const Ending ending = shell("$T plates --fast --seconds 0.5 " + (option + quoted(disk / "a")) +
                                " --log " + quoted(folder / "run.csv"));
    EXPECT_EQ(ending.status, 4) << ending;
    EXPECT_NE(ending.err.find("No space left"), std::string::npos) << ending;
    EXPECT_TRUE(ending.says("peak virtual force")) << ending;
    EXPECT_EQ(names_in(disk.path()), Names{"filling"}) << "what is not whole is no report";
    EXPECT_EQ(columns_of(folder / "run.csv").at("tick").size(), 200U);
  }
}

TEST(Ending, DeviceThatIsFullIsSaid) {
  for (const char* option : {"--report", "--html"}) {
    const Ending ending =
        teleop(std::string("plates --fast --seconds 0.1 ") + option + " /dev/full");
    EXPECT_EQ(ending.status, 4) << ending;
    EXPECT_TRUE(ending.says("/dev/full: cannot write")) << ending;
    EXPECT_TRUE(ending.says("No space left")) << ending;
  }
  EXPECT_EQ(teleop("plates --fast --seconds 0.1 --log /dev/full").status, 1) << "before it runs";
  EXPECT_EQ(shell("$T plates --fast --seconds 0.1 >/dev/full").status, 4);
}

TEST(Ending, ReaderThatLeavesEndsNothing) {
  const Folder folder;
  const std::string files =
      " --report " + quoted(folder / "report.json") + " --log " + quoted(folder / "run.csv");
  const Ending ending = shell("set -o pipefail\n$T plates --seconds 1.5" + files +
                              " 2> >(head -c 1 >/dev/null) | sleep 0.1\n");
  EXPECT_EQ(ending.status, 0) << ending;
  const auto report = report_of(folder / "report.json");
  EXPECT_GE(ticks_due(report), 600);
  EXPECT_EQ(columns_of(folder / "run.csv").at("tick").size(), report.at("ticks"));
}

/// Expects a log whose forces fade out at its end, within half a second and not abruptly.
void expect_faded(const std::string& path) {
  const std::vector<double> gain = columns_of(path).at("gain");
  ASSERT_GT(gain.size(), 25U);
  EXPECT_EQ(gain.back(), 0.0);
  const auto fading = std::count_if(gain.begin(), gain.end(), [](double g) { return g < 1.0; });
  EXPECT_GT(fading, 2);
  EXPECT_LE(fading, 200);
  for (std::size_t k = gain.size() - static_cast<std::size_t>(fading); k < gain.size(); ++k) {
    EXPECT_LT(gain[k], gain[k - 1]) << "tick " << k;
  }
}

TEST(Ending, EverySignalFadesTheForcesAndWritesTheReport) {
  for (const std::string signal : {"INT", "TERM", "HUP"}) {
    const Folder folder;
    const Ending ending =
        shell("$T anderson_4x8 --fast --seconds 6000 --log " + quoted(folder / "run.csv") +
              " --report " + quoted(folder / "report.json") + " & holds " +
              quoted(folder / "run.csv.part") + " 100000; kill -" + signal + " $!; wait $!");
    EXPECT_EQ(ending.status, 0) << signal << ending;
    EXPECT_TRUE(ending.says("interrupted")) << signal << ending;
    const auto report = report_of(folder / "report.json");
    EXPECT_EQ(report.at("interrupted"), true);
    EXPECT_LT(report.at("ticks"), 2400000);
    SCOPED_TRACE(signal);
    expect_faded(folder / "run.csv");
    EXPECT_EQ(names_in(folder / ""), (Names{"report.json", "run.csv"}));
  }
}

// The end is as in a run that is not in real time, and the recorded end is replayed as well.
TEST(Ending, RunThatFadedReplaysBitForBit) {
  for (const std::string clock : {"", " --fast"}) {
    const Folder folder;
    const Ending ending =
        shell("$T two_arms --seconds 100000" + clock + " --log " + quoted(folder / "run.mcap") +
              " & holds " + quoted(folder / "run.mcap.part") + " 400000; kill $!; wait $!");
    ASSERT_EQ(ending.status, 0) << ending;
    ASSERT_EQ(names_in(folder / ""), Names{"run.mcap"}) << ending;
    const Ending replay = teleop("replay " + quoted(folder / "run.mcap") + " --report " +
                                 quoted(folder / "report.json"));
    EXPECT_EQ(replay.status, 0) << replay;
    const auto report = report_of(folder / "report.json");
    EXPECT_GE(report.at("replay").at("ticks"), 100);
    EXPECT_EQ(report.at("replay").at("same"), report.at("replay").at("ticks"));
    if (clock.empty()) continue;  // a machine that stands still may have no tick of the end
    EXPECT_GE(report.at("status_ticks").at("silent_device"), 20) << "the hands had let go";
  }
}

// `timeout` sends its signal twice at once, as does a closing terminal.
TEST(Ending, SecondSignalEndsAtOnceUnlessItIsTheSameWish) {
  const std::atomic<bool>& asked = host::interruption();
  const std::atomic<bool>& asked_again = host::insistence();
  EXPECT_FALSE(asked);
  for (int i = 0; i < 3; ++i) {
    (void)std::raise(SIGTERM);
    EXPECT_TRUE(asked);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(110));
  (void)std::raise(SIGHUP);
  EXPECT_FALSE(asked_again);
  (void)std::raise(SIGINT);
  EXPECT_TRUE(asked_again);
  EXPECT_EQ(std::signal(SIGINT, SIG_DFL), SIG_DFL) << "the next kills";
}

TEST(Ending, HangUpThatIsIgnoredStaysSo) {
  const Folder folder;
  const Ending ending =
      shell("nohup $T plates --seconds 2 --report " + quoted(folder / "report.json") + " --log " +
            quoted(folder / "run.csv") + " & holds " + quoted(folder / "run.csv.part") +
            " 1; kill -HUP $!; wait $!");
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_GE(ticks_due(report_of(folder / "report.json")), 800);
}

TEST(Ending, KillLeavesWhatStoodThereAndAPartThatReplays) {
  const Folder folder;
  const std::string log = folder / "run.mcap";
  const auto kill_with = [&](const std::string& part) {
    return shell("$T plates --log " + quoted(log) + " & holds " + quoted(folder / part) +
                 " 100000; kill -KILL $!; wait $!");
  };
  ASSERT_EQ(kill_with("run.mcap.part").status, 137);
  EXPECT_EQ(names_in(folder / ""), Names{"run.mcap.part"});
  const Ending absent = teleop("replay " + quoted(log));
  EXPECT_EQ(absent.status, 1) << absent;
  EXPECT_TRUE(absent.says("run.mcap.part")) << "where it is\n" << absent;
  EXPECT_EQ(teleop("replay " + quoted(log + ".part")).status, 0);
  const std::string first = text_of(log + ".part");
  ASSERT_EQ(kill_with("run.mcap.2.part").status, 137);
  EXPECT_TRUE(text_of(log + ".part") == first) << "nor is an earlier one lost";
  EXPECT_EQ(names_in(folder / ""), (Names{"run.mcap.2.part", "run.mcap.part"}));
}

TEST(Ending, RefusedRunLeavesEveryFileAsItWas) {
  const Folder folder;
  const std::string scene =  // far stiffer than the arm can render
      folder.with("stiff.yaml", robot_text() +
                                    "laws:\n  default: {range: 1 mm, surface_force: 9000 N, "
                                    "damping: 1 N s/m}\nobstacles:\n  - {name: table, shape: box, "
                                    "size: 0.6 0.8 0.05 m, position: 0.6 -0.15 0.425 m}\n");
  const std::string arguments = " --fast --log " + quoted(folder.with("run.mcap", "log")) +
                                " --report " + quoted(folder.with("report.json", "report")) +
                                " --html " + quoted(folder.with("page.html", "page"));
  const Ending ending = teleop(quoted(scene) + arguments);
  ASSERT_EQ(ending.status, 1) << ending;
  EXPECT_EQ(text_of(folder / "run.mcap"), "log");
  EXPECT_EQ(text_of(folder / "report.json"), "report");
  EXPECT_EQ(text_of(folder / "page.html"), "page");
  EXPECT_EQ(names_in(folder / ""), (Names{"page.html", "report.json", "run.mcap", "stiff.yaml"}));
}

TEST(Ending, LinksStayAndTheirFilesKeepTheirRights) {
  const Folder folder;
  const std::string file = folder.with("file.json", "before");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("file.json", folder / "link.json");
  fs::create_symlink("new.json", folder / "dangling.json");
  for (const char* name : {"link.json", "dangling.json"}) {
    const Ending ending = teleop("plates --fast --seconds 0.1 --report " + quoted(folder / name));
    ASSERT_EQ(ending.status, 0) << ending;
    EXPECT_TRUE(fs::is_symlink(folder / name));
    EXPECT_EQ(report_of(folder / name).at("ticks"), 40);
  }
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_TRUE(fs::is_regular_file(folder / "new.json"));
}

TEST(Ending, DevicesAndPipesAreWrittenDirectly) {
  const Folder folder;
  const std::string run = "$T plates --fast --seconds 0.1 ";
  EXPECT_EQ(shell(run + "--report /dev/null --html /dev/null --log /dev/null").status, 0);
  const Ending printed = shell(run + "--report /dev/stdout | tail -1");
  EXPECT_EQ(printed.out, "}\n") << printed;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const Ending piped =
      shell("cat " + quoted(pipe) + " & " + run + "--report " + quoted(pipe) + " >/dev/null; wait");
  EXPECT_EQ(nlohmann::json::parse(piped.out).at("ticks"), 40) << piped;
  EXPECT_EQ(names_in(folder / ""), Names{"pipe"});
}

TEST(Ending, NoFileIsWrittenOverOneThatIsReadOrAnother) {
  const Folder folder;
  const std::string urdf = folder.with("arm.urdf", text_of(REPEL_SOURCE "/robots/puma560.urdf"));
  const std::string scene = folder.with("scene.yaml", robot_text(urdf) + table_text());
  const std::string run = quoted(scene) + " --fast --seconds 0.1 ";
  const std::string recording = folder / "run.mcap";
  ASSERT_EQ(teleop(run + "--log " + quoted(recording)).status, 0);
  fs::create_symlink("scene.yaml", folder / "link");
  fs::create_hard_link(scene, folder / "twin");
  fs::create_directory(folder / "sub");
  const std::string files[] = {text_of(scene), text_of(urdf), text_of(recording)};
  const struct {
    std::string arguments;
    const char* words;
  } refused[] = {
      {run + "--log " + quoted(scene), "--log would write over the scene file"},
      {run + "--report " + quoted(folder / "link"), "--report would write over the scene file"},
      {run + "--html " + quoted(folder / "twin"), "--html would write over the scene file"},
      {run + "--html " + quoted(folder / "sub/../scene.yaml"),
       "--html would write over the scene file"},
      {run + "--report " + quoted(urdf), "--report would write over the robot"},
      {run + "--report " + quoted(folder / "a") + " --html " + quoted(folder / "./a"),
       "--html would write over --report"},
      {run + "--log " + quoted(folder / "a") + " --report " + quoted(folder / "a.part"),
       "--report would write over --log"},
      {"replay " + quoted(recording) + " --log " + quoted(recording),
       "--log would write over the recording"}};
  for (const auto& each : refused) {
    const Ending ending = teleop(each.arguments);
    EXPECT_EQ(ending.status, 1) << each.arguments << ending;
    EXPECT_TRUE(ending.says(each.words)) << each.words << '\n' << ending;
  }
  EXPECT_TRUE(text_of(scene) == files[0] && text_of(urdf) == files[1]);
  EXPECT_TRUE(text_of(recording) == files[2]);
  EXPECT_EQ(names_in(folder / ""),
            (Names{"arm.urdf", "link", "run.mcap", "scene.yaml", "sub", "twin"}));
}

}  // namespace ending_test
}  // namespace repel::test
