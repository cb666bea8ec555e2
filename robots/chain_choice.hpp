// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Chooses the serial chain of a robot, and its tool, by the rules of docs/robots.md.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <urdf_model/model.h>

#include <repel/robots/robot.hpp>

#include "urdf_document.hpp"

namespace repel::detail {

/// A link and why it was chosen.
struct ChosenLink {
  std::string link;
  std::string reason;
};

/// The links of a model that form the arm.
class ChainChoice {
 public:
  /// All arguments must outlive it.
  /// @throws SetupError if two chains are equally long, or `options` name a link or joint that the
  ///   model does not have
  ChainChoice(const UrdfDocument& document, const urdf::ModelInterface& model,
              const UrdfOptions& options);

  /// The last link of the chain.
  [[nodiscard]] const ChosenLink& end() const { return end_; }
  /// Whether `link` is the root, the end, or between the two.
  [[nodiscard]] bool contains(const std::string& link) const { return links_.contains(link); }
  /// What the options say about `joint`; null: nothing.
  [[nodiscard]] const Hold* hold_of(const urdf::Joint& joint) const;
  /// The link whose frame is the tool frame.
  /// @param still names of the links that are fixed to the last moving link, itself first
  [[nodiscard]] ChosenLink tool(const std::vector<std::string>& still) const;

 private:
  using Link = urdf::LinkConstSharedPtr;

  void require_known() const;
  void measure(const std::set<std::string>& uncounted);
  void find_gripper();
  void walk();
  [[noreturn]] void refuse_tie(const Link& at, const std::vector<Link>& branches) const;
  [[nodiscard]] bool moves_alone(const urdf::Joint& joint) const;
  [[nodiscard]] bool is_behind(const urdf::Joint& joint, const urdf::Joint& other) const;
  [[nodiscard]] bool is_finger(const urdf::Joint& joint) const;
  [[nodiscard]] int reach_by(const Link& child) const;
  [[nodiscard]] bool is_behind_finger(Link link, const std::string& first) const;
  [[nodiscard]] std::string where_fingers_part(const std::vector<std::string>& still) const;
  [[nodiscard]] std::vector<std::string> path_to(const std::string& link) const;

  const UrdfDocument& document_;
  const urdf::ModelInterface& model_;
  const UrdfOptions& options_;
  std::set<std::string> gripper_;     // joints that are never chosen
  std::map<std::string, int> reach_;  // most joints that move alone in one line behind a link
  std::set<std::string> links_;       // of the chain
  ChosenLink end_;
};

}  // namespace repel::detail
