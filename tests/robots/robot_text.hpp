// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Writes robot descriptions for tests, one element a line.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/robots/urdf.hpp>

namespace repel::test {

/// A robot description that grows from its root outward.
class RobotText {
 public:
  explicit RobotText(const std::string& root, const std::string& name = "r") {
    text_ = name.empty() ? "<robot>\n" : "<robot name='" + name + "'>\n";
    add_link(root);
  }

  /// A joint and its child, which is 1 m above the parent and weighs 1 kg in its origin.
  RobotText& joint(const std::string& type, const std::string& name, const std::string& parent,
                   const std::string& child, const std::string& content = "") {
    add_link(child);
    add("<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
        "'/><child link='" + child + "'/><origin xyz='0 0 1'/>" + content + "</joint>");
    return *this;
  }
  RobotText& fixed(const std::string& parent, const std::string& child) {
    return joint("fixed", parent + "_" + child, parent, child);
  }
  /// About x, from -1 to 2 rad.
  RobotText& turning(const std::string& name, const std::string& parent, const std::string& child,
                     const std::string& content = "") {
    return joint(
        "revolute", name, parent, child,
        "<axis xyz='1 0 0'/><limit lower='-1' upper='2' velocity='1' effort='1'/>" + content);
  }
  /// Along x, from 0 to 0.04 m.
  RobotText& sliding(const std::string& name, const std::string& parent, const std::string& child,
                     const std::string& content = "") {
    return joint(
        "prismatic", name, parent, child,
        "<axis xyz='2 0 0'/><limit lower='0' upper='0.04' velocity='1' effort='1'/>" + content);
  }
  /// `joints` turning joints from `parent` on, called `prefix`1, ...; links `prefix`link1, ...
  RobotText& line(const std::string& parent, const std::string& prefix, int joints) {
    std::string at = parent;
    for (int i = 1; i <= joints; ++i) {
      const std::string child = prefix + "link" + std::to_string(i);
      turning(prefix + std::to_string(i), at, child);
      at = child;
    }
    return *this;
  }

  [[nodiscard]] std::string urdf() const { return text_ + "</robot>\n"; }
  /// The line of a link or joint.
  [[nodiscard]] int line_of(const std::string& name) const {
    const auto at = text_.find(" name='" + name + "'");
    return 1 + static_cast<int>(std::count(text_.begin(), text_.begin() + long(at), '\n'));
  }

 private:
  void add(const std::string& element) { text_ += element + "\n"; }
  void add_link(const std::string& name) {
    add("<link name='" + name +
        "'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>"
        "</inertial><collision><geometry><sphere radius='0.1'/></geometry></collision></link>");
  }

  std::string text_;
};

inline Robot read(const RobotText& text, const UrdfOptions& options = {}) {
  return parse_arm(text.urdf(), options, "test.urdf");
}

/// Names of the joints of the arm, from the base outward.
inline std::vector<std::string> moving(const Robot& robot) {
  std::vector<std::string> names;
  for (const ArmLink& link : robot.arm.links) names.push_back(link.joint_name);
  return names;
}

inline std::set<std::string> held(const Robot& robot) {
  std::set<std::string> names;
  for (const HeldJoint& joint : robot.held) names.insert(joint.name);
  return names;
}

/// Where `joint` is held; fails without it.
inline HeldJoint held_joint(const Robot& robot, const std::string& joint) {
  for (const HeldJoint& each : robot.held) {
    if (each.name == joint) return each;
  }
  ADD_FAILURE() << joint << " is not held";
  return {};
}

/// Expects an error at the line of `name` whose message contains all of `words`.
inline void expect_refused(const RobotText& text, const std::string& name,
                           const std::vector<std::string>& words, const UrdfOptions& options = {}) {
  try {
    (void)read(text, options);
    FAIL() << "accepted:\n" << text.urdf();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.file(), "test.urdf");
    EXPECT_EQ(error.line(), text.line_of(name)) << error.what();
    for (const std::string& word : words) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
          << word << ": " << error.what();
    }
  }
}

}  // namespace repel::test
