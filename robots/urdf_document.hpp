// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The XML behind a URDF file. Checks, with line numbers, what urdfdom drops, accepts unchecked or
/// does not support.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <tinyxml2.h>
#include <urdf_model/model.h>

namespace repel::detail {

/// Limits of a robot description: several times the size of any real robot, yet small enough for
/// urdfdom, which destroys a chain recursively on the stack.
inline constexpr std::size_t most_description_bytes = std::size_t{16} << 20;
inline constexpr std::size_t most_urdf_links = 4096;
inline constexpr std::size_t most_urdf_depth = 512;  ///< joints between the root and a link

/// The text of the URDF or SRDF file at `path`. Reads at most one byte beyond the limit.
/// @throws SetupError if it cannot be read or has more than `most_description_bytes`
[[nodiscard]] std::string text_of_description(const std::string& path);

/// Checks that the XML file at `path` begins with <`root`>, and says which format begins otherwise.
/// @throws SetupError as text_of_description(), and if it does not
void require_root(const std::string& path, std::string_view root);

/// A URDF text that has passed all checks of the text alone.
class UrdfDocument {
 public:
  using Element = tinyxml2::XMLElement;

  /// @throws SetupError if the text is not XML, exceeds the limits above on bytes, links or depth,
  ///   a number is malformed, not finite or out of range, a joint is of an unknown type, lacks a
  ///   limit or mimics itself or none, or two links or joints share a name
  UrdfDocument(std::string_view text, std::string file);

  /// The text for urdfdom, which does not support capsules: each is replaced by a cylinder. A robot
  /// without a name gets that of its file. Without <visual> and <material>, for which it would
  /// refuse the file though they are only looked at.
  [[nodiscard]] std::string text_for_urdfdom() const;

  /// @throws SetupError naming the first collision element that is missing in `model`
  void require_all_collisions(const urdf::ModelInterface& model) const;

  /// Whether collision element `index` of `link` is a capsule in the file.
  [[nodiscard]] bool is_capsule(const std::string& link, std::size_t index) const;

  /// The type of `joint`, as in the file.
  [[nodiscard]] std::string type_of(const std::string& joint) const;

  /// @throws SetupError unless `joint`, if it has limits, can move between them
  void require_range(const std::string& joint) const;

  /// Motor and gear inertia reflected to `joint` [kg m^2] or [kg]: the Drake elements rotor_inertia
  /// * gear_ratio^2 of its transmission; 0 without any.
  [[nodiscard]] double rotor_inertia(const std::string& joint) const;

  /// The <robot> of the file, and the link of that name; null: there is none.
  [[nodiscard]] const Element& robot() const noexcept { return *robot_; }
  [[nodiscard]] const Element* link(const std::string& name) const;

  /// Checks the content of a <visual>; not done on reading.
  /// @throws SetupError naming line and `owner`
  void require_numbers(const Element& element, const std::string& owner) const;

  /// The numbers of an attribute that has passed require_numbers(); empty without it.
  [[nodiscard]] static std::vector<double> numbers(const Element& element, const char* attribute);

  /// @throws SetupError at the line of the link or joint called `name`, or of its collision `index`
  [[noreturn]] void fail_at_link(const std::string& name, const std::string& what) const;
  [[noreturn]] void fail_at_joint(const std::string& name, const std::string& what) const;
  [[noreturn]] void fail_at_collision(const std::string& link, std::size_t index,
                                      const std::string& what) const;

 private:
  /// Running counts, in the order of the file.
  struct Counts {
    std::size_t elements = 0;
    std::size_t collisions = 0;
  };
  using Tree = std::map<std::string, std::vector<std::string>>;  // from a link to its children

  [[noreturn]] void fail(const Element* at, const std::string& what) const;
  void index_names();
  void require_plain_urdf() const;
  void require_bounded() const;
  void require_tree() const;
  void require_reached(const std::string& root, const Tree& children) const;
  void check_numbers(const Element& element, const std::string& owner) const;
  void check_joint(const Element& joint) const;
  void require_leaders() const;
  [[nodiscard]] const Element* mimic_of(const Element& joint) const;
  [[nodiscard]] const Element& leader_of(const Element& joint) const;
  void require_modest(const Element& element, Counts& counts) const;
  [[nodiscard]] const Element* shape_of(const Element& collision, const std::string& owner) const;

  std::string file_;
  tinyxml2::XMLDocument xml_;
  const Element* robot_ = nullptr;
  std::map<std::string, const Element*> links_;
  std::map<std::string, const Element*> joints_;
  std::map<std::string, std::vector<const Element*>> shapes_;  // of collisions, by link
  std::map<std::string, const Element*> actuators_;  // by joint: its first transmission with one
};

}  // namespace repel::detail
