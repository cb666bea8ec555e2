// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/machinery/planner.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>
#include <repel/network/modules.hpp>
#include <repel/network/plan.hpp>

namespace repel::network {
namespace planner_test {

constexpr double period = 0.0025;

Mass<any_size> mass(int size) {
  return Mass<any_size>(Mat<any_size>::Identity(size, size));
}
FlowSource<any_size> hand(int size) {
  return FlowSource<any_size>(Vec<any_size>::Zero(size));
}
Limits limits(int joints) {
  return Limits({}, std::vector<JointRange>(static_cast<std::size_t>(joints), {-1.0, 1.0}));
}

/// The error message of a plan; empty if it is valid.
std::string complaint(const Plan& plan) {
  try {
    (void)plan.build(period);
  } catch (const SetupError& error) {
    return error.what();
  }
  return {};
}
/// Each name in quotes, as in an error message.
void expect_names(const std::string& text, std::initializer_list<const char*> named,
                  std::initializer_list<const char*> unnamed = {}) {
  EXPECT_NE(text, "");
  for (const char* name : named) {
    EXPECT_NE(text.find("'" + std::string(name) + "'"), std::string::npos) << name << ": " << text;
  }
  for (const char* name : unnamed) {
    EXPECT_EQ(text.find("'" + std::string(name) + "'"), std::string::npos) << name << ": " << text;
  }
}
void expect_says(const std::string& text, const char* what) {
  EXPECT_NE(text.find(what), std::string::npos) << text;
}

TEST(Planner, EveryPortIsConnectedOnce) {
  std::string text = complaint(Plan().add("ball", Spaceball()).add("mass", mass(6)));
  expect_names(text, {"ball"}, {"mass"});
  expect_says(text, "nothing on its left");
  text = complaint(Plan().add("mass", mass(6)).add("ball", Spaceball()));
  expect_names(text, {"ball"}, {"mass"});
  expect_says(text, "nothing on its right");
  text = complaint(Plan().add("line", Line()).add("mass", mass(6)));
  expect_names(text, {"line"}, {"mass"});
  text = complaint(Plan()
                       .add("a", mass(6), "ball")
                       .add("b", mass(6))
                       .add("ball", Spaceball())
                       .add("c", mass(6)));
  expect_names(text, {"ball"}, {"a", "b"});
  expect_says(text, "use a junction");
  text = complaint(Plan().add("a", hand(6)).add("b", mass(6)).add("c", mass(6)));
  expect_names(text, {"b"}, {"a", "c"});
  expect_says(text, "one-port and has 2 connections");
  expect_names(complaint(Plan().add("alone", mass(6))), {"alone"});
  text = complaint(Plan().add("a", mass(6)).add("junction", Junction()));
  expect_names(text, {"junction"});
  expect_says(text, "fewer than two");
}

TEST(Planner, SpacesHaveToFit) {
  const std::string text =
      complaint(Plan().add("arm", TorqueArm()).add("ball", Spaceball()).add("mass", mass(6)));
  expect_names(text, {"arm", "ball"}, {"mass"});
  expect_says(text, "lever");
  expect_says(text, "tool");
  // Also through modules that adopt the space of their neighbour.
  const std::string through = complaint(Plan()
                                            .add("arm", TorqueArm())
                                            .add("kbb2", Kbb2())
                                            .add("visual", Visual())
                                            .add("line", Line())
                                            .add("kin", PumaKin())
                                            .add("robot", PumaJoints(6)));
  expect_says(through, "cannot be joined");
  expect_says(through, "lever");
  expect_says(through, "tool");
  const std::string nowhere =
      complaint(Plan().add("a", mass(6)).add("kbb2", Kbb2()).add("b", mass(6)));
  expect_says(nowhere, "nothing says what passes");
  expect_names(nowhere, {"a", "kbb2"});
}

TEST(Planner, SizesHaveToFit) {
  const std::string lever =
      complaint(Plan().add("mass", mass(2)).add("multiplex", Multiplex()).add("end", mass(6)));
  expect_names(lever, {"mass", "multiplex"}, {"end"});
  expect_says(lever, "size");
  const std::string tool =
      complaint(Plan().add("mass", mass(3)).add("ball", Spaceball()).add("e", mass(6)));
  expect_names(tool, {"mass", "ball"}, {"e"});
  const std::string joints = complaint(Plan()
                                           .add("mass", mass(6))
                                           .add("kin", PumaKin())
                                           .add("limits", limits(5))
                                           .add("robot", PumaJoints(6)));
  expect_names(joints, {"robot"}, {"kin"});
  expect_says(joints, "5");
  expect_says(joints, "6");
  const std::string unknown =
      complaint(Plan().add("mass", mass(6)).add("kin", PumaKin()).add("end", mass(6)));
  expect_says(unknown, "no module says how many");
  const std::string motors = complaint(Plan()
                                           .add("mass", mass(6))
                                           .add("kin", PumaKin(), "elbow")
                                           .add("brake", mass(4), "elbow")
                                           .add("elbow", Junction())
                                           .add("robot", PumaJoints(6)));
  expect_names(motors, {"brake", "elbow"}, {"kin", "robot"});
}

/// A ring of two junctions and `across`, with a hand and a tail that are not in it.
Plan ring(Module across) {
  Plan plan;
  plan.add("hand", hand(6)).add("soft", Kbb2(), "near").add("near", Junction());
  plan.add("ball", Spaceball(), "far").add("weight", mass(6), "near");
  plan.add("back", std::move(across), "near").add("far", Junction(), "tail");
  plan.add("split", Junction(), "back").add("load", mass(6), "split");
  plan.add("tail", Relief(), "split");
  return plan;
}

TEST(Planner, NamesTheModulesOfADelayFreeLoopAndNoOther) {
  const Plan plan = ring(Kbb2());
  const std::string text = complaint(plan);
  expect_says(text, "delay-free loop");
  expect_names(text, {"near", "ball", "far", "tail", "split", "back"},
               {"hand", "soft", "weight", "load"});
}

// The same loop is valid once a line is part of it.
TEST(Planner, LineCutsALoop) {
  EXPECT_EQ(complaint(ring(Line())), "");
}

TEST(Planner, RingOfTwoPortsIsALoopToo) {
  Plan plan;
  plan.add("there", Spaceball(), "back").add("back", Kbb2(), "there");
  const std::string text = complaint(plan);
  expect_says(text, "delay-free loop");
  expect_names(text, {"there", "back"});
}

TEST(Planner, TwoMeasuredArmsInOnePartAreNamed) {
  Plan plan;
  plan.add("first", PumaJoints(6), "meeting").add("weight", mass(6), "meeting");
  plan.add("meeting", Junction()).add("limits", limits(6)).add("second", PumaJoints(6));
  // It must not report that the limits lack the flow of 'first': without the other arm they would
  // have one.
  const std::string text = complaint(plan);
  expect_names(text, {"first", "second"}, {"weight", "meeting", "limits"});
  Plan parted;
  parted.add("first", PumaJoints(6)).add("line", Line()).add("second", PumaJoints(6));
  EXPECT_EQ(complaint(parted), "");
}

TEST(Planner, NonlinearModuleNeedsAMeasuredFlow) {
  const std::string text =
      complaint(Plan().add("a", mass(6)).add("obstacle", Obstacle()).add("b", mass(6)));
  expect_names(text, {"obstacle", "b"}, {"a"});
  expect_says(text, "measured");
  // A line in between would provide a flow of its own.
  Plan beyond;
  beyond.add("a", mass(6)).add("obstacle", Obstacle()).add("line", Line());
  beyond.add("kin", PumaKin()).add("robot", PumaJoints(6));
  expect_names(complaint(beyond), {"obstacle", "line"}, {"kin"});
}

TEST(Planner, NamesTheComplianceBeforeANonlinearModule) {
  const auto plan = [](const char* name, Module compliance) {
    Plan p;
    p.add("a", mass(6)).add("obstacle", Obstacle()).add("tap", Visual());
    p.add(name, std::move(compliance)).add("kin", PumaKin()).add("robot", PumaJoints(6));
    return p;
  };
  expect_names(complaint(plan("soft", Kbb2())), {"obstacle", "robot", "soft"}, {"tap", "kin"});
  expect_names(complaint(plan("yielding", Relief())), {"obstacle", "yielding"}, {"tap", "kin"});
  expect_names(complaint(plan("ball", Spaceball())), {"obstacle", "ball"}, {"tap", "kin"});
  EXPECT_EQ(complaint(plan("second", Obstacle())), "");
  Plan moved;
  moved.add("a", mass(6)).add("soft", Kbb2()).add("obstacle", Obstacle()).add("kin", PumaKin());
  moved.add("robot", PumaJoints(6));
  EXPECT_EQ(complaint(moved), "");
}

TEST(Planner, RootIsTheMeasuredArmWhereverItStands) {
  Plan plan;
  plan.add("robot", PumaJoints(6), "elbow").add("brake", mass(6), "elbow");
  plan.add("elbow", Junction()).add("end", mass(6));
  const Network network = plan.build(period);
  EXPECT_LT(network.find("robot")->toward_root, 0);
  for (const char* other : {"brake", "elbow", "end"}) {
    EXPECT_GE(network.find(other)->toward_root, 0) << other;
  }
  EXPECT_EQ(network.connection(0).left, "robot");
  EXPECT_FALSE(network.connection(0).root_on_right);
}

}  // namespace planner_test
}  // namespace repel::network
