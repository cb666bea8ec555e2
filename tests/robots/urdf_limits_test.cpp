// SPDX-License-Identifier: BSD-3-Clause
// Files far larger than any robot: refused by number, at a cost linear in the file size, not
// quadratic. Regression: a chain of 16000 links overflowed the stack after half a minute.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <repel/base/setup_error.hpp>
#include <repel/robots/urdf.hpp>

namespace repel {
namespace urdf_limits_test {

std::string link(int i) {
  return "<link name='l" + std::to_string(i) + "'/>\n";
}

std::string fixed(int parent, int child) {
  const std::string name = "j" + std::to_string(child);
  return "<joint name='" + name + "' type='fixed'><parent link='l" + std::to_string(parent) +
         "'/><child link='l" + std::to_string(child) + "'/></joint>\n";
}

/// One moving joint on the root, which is link 0, to link 1.
std::string moving() {
  return "<joint name='j1' type='revolute'><parent link='l0'/><child link='l1'/><axis xyz='0 0 1'/>"
         "<limit lower='-1' upper='1' velocity='1' effort='1'/></joint>\n";
}

/// Links in series, each fixed to the previous one, except for the first, which moves.
std::string chain(int links) {
  std::string text = "<robot name='chain'>\n" + link(0) + link(1) + moving();
  for (int i = 2; i < links; ++i) text += link(i) + fixed(i - 1, i);
  return text + "</robot>\n";
}

/// Links that are all fixed to link 1.
std::string star(int links) {
  std::string text = "<robot name='star'>\n" + link(0) + link(1) + moving();
  for (int i = 2; i < links; ++i) text += link(i) + fixed(1, i);
  return text + "</robot>\n";
}

std::string refusal(const std::string& text) {
  try {
    (void)parse_arm(text, {}, "test.urdf");
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

std::string refusal_of_file(const std::string& path) {
  try {
    (void)load_arm(path);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(UrdfLimits, ChainOf512JointsIsReadAndOneMoreIsRefusedWithNumberAndLimit) {
  const Robot robot = parse_arm(chain(513));
  EXPECT_EQ(robot.links.size(), 513U);
  EXPECT_EQ(robot.arm.links.size(), 1U);
  EXPECT_EQ(robot.tips, std::vector<std::string>{"l512"});
  const std::string said = refusal(chain(514));
  EXPECT_NE(said.find("513 joints from the root"), std::string::npos) << said;
  EXPECT_NE(said.find("allowed: up to 512"), std::string::npos) << said;
}

TEST(UrdfLimits, AsManyLinksAsAreAllowedAreReadAndOneMoreIsRefused) {
  EXPECT_EQ(parse_arm(star(4096)).links.size(), 4096U);
  const std::string said = refusal(star(4097));
  EXPECT_NE(said.find("test.urdf:1: robot 'star' has 4097 links; allowed: up to 4096"),
            std::string::npos)
      << said;
}

// Regression: it took 31 s and then overflowed the stack.
TEST(UrdfLimits, ChainOfSixteenThousandLinksIsRefused) {
  EXPECT_NE(refusal(chain(16000)).find("has 16000 links; allowed: up to 4096"), std::string::npos);
  EXPECT_NE(refusal(chain(4096)).find("the farthest 4095; allowed: up to 512"), std::string::npos);
}

TEST(UrdfLimits, HundredThousandLinksAreRefused) {
  EXPECT_NE(refusal(chain(100000)).find("has 100000 links"), std::string::npos);
  EXPECT_NE(refusal(star(100000)).find("has 100000 links"), std::string::npos);
}

// Regression: each chain was traversed to its end from every link.
TEST(UrdfLimits, LoopOfFourThousandLinksIsRefused) {
  std::string text = "<robot name='loop'>\n";
  for (int i = 0; i < 4000; ++i) text += link(i) + fixed(i, (i + 1) % 4000);
  EXPECT_NE(refusal(text + "</robot>").find("hangs in a loop of joints"), std::string::npos);
  text += link(4000);  // and a root to which none of them is connected
  const std::string said = refusal(text + "</robot>");
  EXPECT_NE(said.find("link 'l0' hangs in a loop of joints"), std::string::npos) << said;
}

TEST(UrdfLimits, TwoRootsAreNamed) {
  const std::string said = refusal("<robot name='two'>\n" + link(0) + link(1) + "</robot>");
  EXPECT_NE(said.find("links 'l0' and 'l1' both hang on no joint; allowed: one root"),
            std::string::npos)
      << said;
}

// Its XML is what overflows the stack first, in any recursive parser.
TEST(UrdfLimits, ElementsInElementsAreRefused) {
  std::string text = "<robot name='deep'>\n";
  for (int i = 0; i < 200000; ++i) text += "<a>";
  EXPECT_NE(refusal(text).find("XML"), std::string::npos);
}

/// A folder that is removed with its files.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "repel_urdf_XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::string operator/(const char* name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

// The size is checked before anything is read; the sparse file uses no disk space.
TEST(UrdfLimits, FileOfAGigabyteIsRefusedBeforeItIsRead) {
  const Folder folder;
  const std::string path = folder / "large.urdf";
  std::ofstream(path) << "<robot name='large'>";
  std::filesystem::resize_file(path, std::uintmax_t{1} << 30);
  const std::string said = refusal_of_file(path);
  EXPECT_NE(said.find("large.urdf: has 1073741824 bytes; allowed: up to 16777216"),
            std::string::npos)
      << said;
}

TEST(UrdfLimits, PipeIsReadUpToTheLimitAndRefused) {
  const Folder folder;
  const std::string path = folder / "pipe.urdf";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  (void)std::signal(SIGPIPE, SIG_IGN);  // a closed pipe must not end the test
  std::jthread writer([&path] {
    std::ofstream pipe(path);
    const std::string some(1 << 20, ' ');
    for (int i = 0; i < 17 && pipe; ++i) pipe << some;
  });
  const std::string said = refusal_of_file(path);
  EXPECT_NE(said.find("has 16777217 bytes"), std::string::npos) << said;
}

TEST(UrdfLimits, TextThatIsTooLongIsRefused) {
  EXPECT_NE(refusal(std::string((16U << 20) + 1, ' ')).find("has 16777217 bytes"),
            std::string::npos);
}

}  // namespace urdf_limits_test
}  // namespace repel
