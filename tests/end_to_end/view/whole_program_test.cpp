// SPDX-License-Identifier: BSD-3-Clause
// All threads of the program at once: workers, view, log and progress. The thread sanitizer makes a
// data race an exit status of its own.
#include "end_to_end/live.hpp"

namespace repel::test {
namespace whole_program_test {

/// A page drives the hand until such a frame arrives.
void expect_sound(const std::string& log, const std::vector<std::string>& more,
                  const LivePage::Such& such) {
  SCOPED_TRACE(log);
  const Folder folder;
  std::vector<std::string> arguments = {"anderson_4x8", "--threads", "2", "--log", folder / log};
  arguments.insert(arguments.end(), more.begin(), more.end());
  LiveTeleop program(arguments);
  {
    LivePage page(program);
    ASSERT_FALSE(page.take().is_null());
    const Vec3 down(0, 0, -0.1);
    EXPECT_FALSE(page.drive(down, such).is_null());
    EXPECT_FALSE(page.await("timing").is_null());
    LivePage other(program);
    EXPECT_FALSE(other.await("frame").is_null());
  }
  const Ending ending = program.interrupt();
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_EQ(ending.err.find("ThreadSanitizer"), std::string::npos) << ending;
  EXPECT_GT(fs::file_size(folder / log), 1000U);
}

TEST(WholeProgram, WorksWithAllItsThreadsByTheClock) {
  const auto is_pressed = [](const Json& frame) { return force_of(frame) > 5.0; };
  expect_sound("run.mcap", {}, is_pressed);
  expect_sound("run.csv", {}, is_pressed);
}

// A hundred times faster than the clock, the hand of a page counts as silent between two messages:
// whether it ever presses is a matter of luck.
TEST(WholeProgram, WorksWithAllItsThreadsInLockStep) {
  expect_sound("run.mcap", {"--fast"}, [](const Json& frame) { return frame.at("tick") > 2000; });
}

}  // namespace whole_program_test
}  // namespace repel::test
