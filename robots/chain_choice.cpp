// SPDX-License-Identifier: BSD-3-Clause
#include "chain_choice.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string_view>

namespace repel::detail {
namespace {

std::string in_lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool has_any(const std::string& text, std::initializer_list<std::string_view> parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](std::string_view part) { return text.find(part) != std::string::npos; });
}

/// Whether a joint of this name belongs to a gripper.
bool is_called_like_a_finger(const std::string& joint) {
  return has_any(in_lower_case(joint), {"finger", "gripper", "jaw", "knuckle", "thumb", "claw"});
}

/// Whether a link of this name marks where a tool acts.
bool is_called_like_a_tool(const std::string& link) {
  std::string words = in_lower_case("_" + link + "_");
  for (char& c : words) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return has_any(words, {"tool", "tcp", "end_effector", "endeffector", "grasp", "_ee_", "_eef_"});
}

/// The links of the model, parents first.
std::vector<urdf::LinkConstSharedPtr> links_of(const urdf::ModelInterface& model) {
  std::vector<urdf::LinkConstSharedPtr> links{model.getRoot()};
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto link = links[i];  // a copy, since the list grows
    links.insert(links.end(), link->child_links.begin(), link->child_links.end());
  }
  return links;
}

}  // namespace

ChainChoice::ChainChoice(const UrdfDocument& document, const urdf::ModelInterface& model,
                         const UrdfOptions& options)
    : document_(document), model_(model), options_(options) {
  require_known();
  if (!options.tip.empty()) {
    end_ = {options.tip, "the chosen tip"};
  } else {
    find_gripper();
    walk();
  }
  for (const std::string& name : path_to(end_.link)) links_.insert(name);
}

void ChainChoice::require_known() const {
  const std::string& root = model_.getRoot()->name;
  for (const Hold& hold : options_.hold) {
    const auto joint = model_.getJoint(hold.joint);
    if (!joint) document_.fail_at_link(root, "has no joint '" + hold.joint + "' to hold");
    const auto same = [&](const Hold& other) { return other.joint == hold.joint; };
    if (std::ranges::count_if(options_.hold, same) == 1) continue;
    document_.fail_at_joint(hold.joint, "is to be held twice; allowed: once");
  }
  if (!options_.tip.empty() && !model_.getLink(options_.tip)) {
    document_.fail_at_link(root, "leads to no tip '" + options_.tip + "'");
  }
}

const Hold* ChainChoice::hold_of(const urdf::Joint& joint) const {
  const auto found = std::ranges::find(options_.hold, joint.name, &Hold::joint);
  return found == options_.hold.end() ? nullptr : &*found;
}

/// A joint that may be one of the arm. A floating or planar one says where a base stands.
bool ChainChoice::moves_alone(const urdf::Joint& joint) const {
  const bool has_one_direction = joint.type == urdf::Joint::REVOLUTE ||
                                 joint.type == urdf::Joint::CONTINUOUS ||
                                 joint.type == urdf::Joint::PRISMATIC;
  return has_one_direction && !joint.mimic && hold_of(joint) == nullptr;
}

/// The joints that move alone in one line from the parent of `child` outward, by this child.
int ChainChoice::reach_by(const Link& child) const {
  const urdf::Joint& joint = *child->parent_joint;
  if (gripper_.contains(joint.name)) return 0;
  return reach_.at(child->name) + (moves_alone(joint) ? 1 : 0);
}

/// Sets `reach_`, without counting the joints in `uncounted`.
void ChainChoice::measure(const std::set<std::string>& uncounted) {
  auto links = links_of(model_);
  std::reverse(links.begin(), links.end());  // leaves first
  for (const Link& link : links) {
    int most = 0;
    for (const auto& child : link->child_links) {
      const std::string& name = child->parent_joint->name;
      most = std::max(most, uncounted.contains(name) ? reach_.at(child->name) : reach_by(child));
    }
    reach_[link->name] = most;
  }
}

bool ChainChoice::is_behind(const urdf::Joint& joint, const urdf::Joint& other) const {
  for (auto link = model_.getLink(joint.parent_link_name); link; link = link->getParent()) {
    if (link->name == other.child_link_name) return true;
  }
  return false;
}

/// A gripper is what the name of a joint says, or joints beside each other of which one mimics the
/// other; unless a joint of the arm hangs on it, or nothing would be left of the arm.
void ChainChoice::find_gripper() {
  std::set<std::string> named;
  std::set<std::string> coupled;
  for (const auto& [name, joint] : model_.joints_) {
    if (joint->type == urdf::Joint::FIXED) continue;
    if (is_called_like_a_finger(name)) named.insert(name);
    if (!joint->mimic) continue;
    const auto leader = model_.getJoint(joint->mimic->joint_name);
    if (leader->type == urdf::Joint::FIXED) continue;
    if (is_behind(*joint, *leader) || is_behind(*leader, *joint)) continue;
    coupled.insert({name, leader->name});
  }
  measure(named);
  std::set<std::string> found;
  for (const std::set<std::string>& candidates : {named, coupled}) {
    for (const std::string& name : candidates) {
      if (reach_.at(model_.getJoint(name)->child_link_name) == 0) found.insert(name);
    }
  }
  gripper_ = found;
  measure({});
  if (reach_.at(model_.getRoot()->name) > 0) return;
  gripper_.clear();
  measure({});
}

/// Follows the longest branch from the root. Where equally long ones part, it ends if they are
/// shorter than what leads to them: the fingers of a hand.
void ChainChoice::walk() {
  Link at = model_.getRoot();
  int before = 0;
  for (;;) {
    const int most = reach_.at(at->name);
    if (most == 0) {
      end_ = {at->name, "the longest chain of joints that move on their own"};
      return;
    }
    std::vector<Link> longest;
    for (const auto& child : at->child_links) {
      if (reach_by(child) == most) longest.emplace_back(child);
    }
    if (longest.size() > 1) {
      if (before <= most) refuse_tie(at, longest);
      end_ = {at->name, "the longest chain before equally long branches, which are fingers"};
      return;
    }
    before += moves_alone(*longest.front()->parent_joint) ? 1 : 0;
    at = longest.front();
  }
}

void ChainChoice::refuse_tie(const Link& at, const std::vector<Link>& branches) const {
  std::string ends;
  for (Link link : branches) {
    while (reach_.at(link->name) > 0) {
      link = *std::ranges::find_if(link->child_links, [&](const auto& child) {
        return reach_by(child) == reach_.at(link->name);
      });
    }
    if (ends.size() > 500) {
      ends += ", and more";
      break;
    }
    ends += (ends.empty() ? "'" : ", '") + link->name + "'";
  }
  document_.fail_at_link(at->name, "carries " + std::to_string(branches.size()) + " branches of " +
                                       std::to_string(reach_.at(at->name)) +
                                       " moving joints each; allowed: one that is longest, or a "
                                       "chosen tip (`tip_link` of a scene, --tip), for example " +
                                       ends);
}

/// Whether `joint`, which is held, moves a finger. A joint of the arm may be held by choice.
bool ChainChoice::is_finger(const urdf::Joint& joint) const {
  if (joint.type == urdf::Joint::FIXED) return false;
  return gripper_.contains(joint.name) || hold_of(joint) == nullptr;
}

/// Whether a joint of a finger is between the link `first` and `link`.
bool ChainChoice::is_behind_finger(Link link, const std::string& first) const {
  for (; link->name != first; link = link->getParent()) {
    if (is_finger(*link->parent_joint)) return true;
  }
  return false;
}

std::vector<std::string> ChainChoice::path_to(const std::string& link) const {
  std::vector<std::string> path;
  for (Link at = model_.getLink(link); at; at = at->getParent()) path.push_back(at->name);
  std::ranges::reverse(path);
  return path;
}

/// The last link that all fingers have in common; empty without any.
std::string ChainChoice::where_fingers_part(const std::vector<std::string>& still) const {
  std::vector<std::string> common;
  for (const std::string& name : still) {
    const Link link = model_.getLink(name);
    const bool carries = std::ranges::any_of(
        link->child_links, [&](const auto& child) { return is_finger(*child->parent_joint); });
    if (!carries || is_behind_finger(link, still.front())) continue;
    const std::vector<std::string> path = path_to(name);
    if (common.empty()) common = path;
    common.erase(std::ranges::mismatch(common, path).in1, common.end());
  }
  return common.empty() ? std::string() : common.back();
}

ChosenLink ChainChoice::tool(const std::vector<std::string>& still) const {
  if (!options_.tip.empty()) return {options_.tip, "the chosen tip"};
  const std::string hand = where_fingers_part(still);
  std::vector<std::string> ends;
  for (const std::string& name : still) {
    const Link link = model_.getLink(name);
    if (!link->child_links.empty() || is_behind_finger(link, still.front())) continue;
    const std::vector<std::string> path = path_to(name);
    if (hand.empty() || std::ranges::count(path, hand) > 0) ends.push_back(name);
  }
  if (hand.empty() && ends.size() == 1) {
    return {ends.front(), "the only end of the last moving link"};
  }
  std::erase_if(ends, [](const std::string& name) { return !is_called_like_a_tool(name); });
  if (ends.size() == 1) {
    return {ends.front(), "the only end of the last moving link that is called like a tool"};
  }
  if (!hand.empty()) return {hand, "the link that carries the held fingers"};
  return {still.front(), "the last moving link"};
}

}  // namespace repel::detail
