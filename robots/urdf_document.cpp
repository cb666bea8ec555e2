// SPDX-License-Identifier: BSD-3-Clause
#include "urdf_document.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>

#include <repel/base/setup_error.hpp>
#include <repel/common/input_limits.hpp>

namespace repel::detail {
namespace {

using Element = tinyxml2::XMLElement;

/// Number of values and their range in a numeric attribute.
struct NumberRule {
  std::string_view element, attribute;
  std::size_t count;
  double low, high;
  bool required;
  std::string_view unit;
};

constexpr NumberRule number_rules[] = {
    {"origin", "xyz", 3, -1e4, 1e4, false, "m"},
    {"origin", "rpy", 3, -1e3, 1e3, false, "rad"},
    {"box", "size", 3, 1e-6, 1e4, true, "m"},
    {"sphere", "radius", 1, 1e-6, 1e4, true, "m"},
    {"cylinder", "radius", 1, 1e-6, 1e4, true, "m"},
    {"cylinder", "length", 1, 1e-6, 1e4, true, "m"},
    {"capsule", "radius", 1, 1e-6, 1e4, true, "m"},
    {"capsule", "length", 1, 1e-6, 1e4, true, "m"},
    {"mesh", "scale", 3, -1e6, 1e6, false, ""},
    {"mass", "value", 1, 0.0, 1e6, true, "kg"},
    {"inertia", "ixx", 1, -1e9, 1e9, true, "kg m^2"},
    {"inertia", "iyy", 1, -1e9, 1e9, true, "kg m^2"},
    {"inertia", "izz", 1, -1e9, 1e9, true, "kg m^2"},
    {"inertia", "ixy", 1, -1e9, 1e9, true, "kg m^2"},
    {"inertia", "ixz", 1, -1e9, 1e9, true, "kg m^2"},
    {"inertia", "iyz", 1, -1e9, 1e9, true, "kg m^2"},
    {"axis", "xyz", 3, -1e3, 1e3, true, ""},
    {"limit", "lower", 1, -1e18, 1e18, false, "rad or m"},
    {"limit", "upper", 1, -1e18, 1e18, false, "rad or m"},
    {"limit", "velocity", 1, 0.0, 1e6, true, "rad/s or m/s"},
    {"limit", "effort", 1, 0.0, 1e9, true, "N m or N"},
    {"dynamics", "damping", 1, 0.0, 1e9, false, "N m s/rad or N s/m"},
    {"dynamics", "friction", 1, 0.0, 1e9, false, "N m or N"},
    {"mimic", "multiplier", 1, -1e6, 1e6, false, ""},
    {"mimic", "offset", 1, -1e4, 1e4, false, "rad or m"},
    {"drake:rotor_inertia", "value", 1, 0.0, 1e6, true, "kg m^2"},
    {"drake:gear_ratio", "value", 1, -1e6, 1e6, true, ""},
};

/// The numbers of a white-space separated list; none if any of it is not a number.
std::optional<std::vector<double>> numbers_in(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  std::vector<double> numbers;
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    if (text.empty()) return numbers;
    std::string_view word = text.substr(0, text.find_first_of(blanks));
    text.remove_prefix(word.size());
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    numbers.push_back(number);
  }
}

bool obeys(const NumberRule& rule, std::string_view text) {
  const auto numbers = numbers_in(text);
  if (!numbers || numbers->size() != rule.count) return false;
  for (const double x : *numbers) {
    if (!(x >= rule.low && x <= rule.high)) return false;  // NaN fails both
  }
  return true;
}

std::string allowed(const NumberRule& rule) {
  std::string text = rule.count == 1 ? "a number" : std::to_string(rule.count) + " numbers";
  text += " from " + to_text(rule.low) + " to " + to_text(rule.high);
  return rule.unit.empty() ? text : text + " " + std::string(rule.unit);
}

std::string text_of(const Element* element, const char* attribute) {
  const char* text = element ? element->Attribute(attribute) : nullptr;
  return text ? text : "";
}

std::string quoted(std::string_view text) {
  std::string result(1, '\'');
  return result.append(text).append(1, '\'');
}

std::string label(const Element& element) {
  return std::string(element.Name()) + " '" + text_of(&element, "name") + "'";
}

const char* kind_in_urdf(const urdf::Geometry& geometry) {
  switch (geometry.type) {
    case urdf::Geometry::SPHERE:
      return "sphere";
    case urdf::Geometry::BOX:
      return "box";
    case urdf::Geometry::CYLINDER:
      return "cylinder";
    case urdf::Geometry::MESH:
      return "mesh";
  }
  return "";
}

/// The `value` attribute of an element that has passed its rule; `otherwise` without an element.
double number_of(const Element* element, double otherwise) {
  return element ? numbers_in(text_of(element, "value"))->front() : otherwise;
}

/// Removes the children of that name.
void remove_all(Element& element, const char* name) {
  for (auto* e = element.FirstChildElement(name); e; e = element.FirstChildElement(name)) {
    element.DeleteChild(e);
  }
}

[[noreturn]] void refuse_size(std::uintmax_t bytes, const std::string& file) {
  throw SetupError("has " + std::to_string(bytes) + " bytes; allowed: up to " +
                       std::to_string(most_description_bytes),
                   file);
}

/// The format that begins with <`root`>, behind an error; empty if it is unknown.
std::string format_hint(std::string_view root) {
  if (root == "robot") return "; this is URDF";
  if (root == "mujoco") return "; this is MJCF";
  if (root == "sdf") return "; this is SDF";
  return {};
}

}  // namespace

std::string text_of_description(const std::string& path) {
  if (path.empty()) throw SetupError("the name of the file is empty; allowed: a robot description");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw SetupError("cannot be opened", path);
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (!error && bytes > most_description_bytes) refuse_size(bytes, path);
  std::string text(most_description_bytes + 1, '\0');  // the size of a pipe is not known in advance
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) throw SetupError("cannot be read", path);
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > most_description_bytes) refuse_size(text.size(), path);
  return text;
}

void require_root(const std::string& path, std::string_view root) {
  tinyxml2::XMLDocument document;
  const std::string text = text_of_description(path);
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw SetupError(document.ErrorStr(), path, document.ErrorLineNum());
  }
  const tinyxml2::XMLElement* const found = document.RootElement();
  const std::string allowed = "; allowed: <" + std::string(root) + ">";
  if (found == nullptr) throw SetupError("the file has no element" + allowed, path);
  if (root == found->Name()) return;
  throw SetupError("the file begins with <" + std::string(found->Name()) + ">" + allowed +
                       format_hint(found->Name()),
                   path, found->GetLineNum());
}

UrdfDocument::UrdfDocument(std::string_view text, std::string file) : file_(std::move(file)) {
  if (text.size() > most_description_bytes) refuse_size(text.size(), file_);
  if (xml_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw SetupError(std::string("not well-formed XML: ") + xml_.ErrorStr(), file_,
                     xml_.ErrorLineNum());
  }
  robot_ = xml_.FirstChildElement("robot");
  if (!robot_) {
    const tinyxml2::XMLElement* const root = xml_.RootElement();
    throw SetupError(
        "no <robot> element; allowed: one" + (root ? format_hint(root->Name()) : std::string()),
        file_, 1);
  }
  Counts counts;
  require_modest(*robot_, counts);
  require_plain_urdf();
  require_bounded();
  index_names();
  for (const auto* child = robot_->FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    const std::string_view name = child->Name();
    if (name == "link" || name == "joint" || name == "transmission") {
      check_numbers(*child, label(*child));
    }
    if (name == "joint") check_joint(*child);
  }
  require_tree();
  require_leaders();
}

void UrdfDocument::require_plain_urdf() const {
  for (const auto* e = robot_->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string_view name = e->Name();
    if (name.substr(0, 6) != "xacro:") continue;
    fail(e, "a <" + std::string(name) + "> has not been expanded; allowed: plain URDF, as " +
                "`xacro FILE` prints it");
  }
}

void UrdfDocument::require_bounded() const {
  std::size_t links = 0;
  for (const auto* e = robot_->FirstChildElement("link"); e; e = e->NextSiblingElement("link")) {
    ++links;
  }
  if (links <= most_urdf_links) return;
  fail(robot_, label(*robot_) + " has " + std::to_string(links) + " links; allowed: up to " +
                   std::to_string(most_urdf_links));
}

void UrdfDocument::require_tree() const {
  std::map<std::string, const Element*> joint_above;
  Tree children;
  for (const auto& [name, joint] : joints_) {
    const std::string above = text_of(joint->FirstChildElement("parent"), "link");
    const std::string below = text_of(joint->FirstChildElement("child"), "link");
    for (const std::string& link : {above, below}) {
      if (links_.count(link) == 0) {
        fail(joint, label(*joint) + ": link '" + link + "' is not in the file; allowed: a link");
      }
    }
    if (!joint_above.emplace(below, joint).second) {
      fail(joint, "link '" + below + "' hangs on two joints; allowed: one");
    }
    children[above].push_back(below);
  }
  const Element* root = nullptr;
  for (const auto& [name, link] : links_) {
    if (joint_above.count(name) != 0) continue;
    if (root) {
      fail(link, "links '" + text_of(root, "name") + "' and '" + name +
                     "' both hang on no joint; allowed: one root");
    }
    root = link;
  }
  require_reached(text_of(root, "name"), children);
}

/// Checks by traversal from the root that every link is reachable from it and not too deep.
void UrdfDocument::require_reached(const std::string& root, const Tree& children) const {
  std::map<std::string, std::size_t> depth;  // of the links reached
  std::vector<std::string> open;
  if (links_.contains(root)) {
    depth[root] = 0;
    open.push_back(root);
  }
  while (!open.empty()) {
    const std::string at = std::move(open.back());
    open.pop_back();
    const auto below = children.find(at);
    if (below == children.end()) continue;
    for (const std::string& child : below->second) {
      depth[child] = depth[at] + 1;
      open.push_back(child);
    }
  }
  for (const auto& [name, link] : links_) {
    const auto found = depth.find(name);
    if (found == depth.end()) fail(link, "link '" + name + "' hangs in a loop of joints");
    if (found->second <= most_urdf_depth) continue;
    const std::size_t deepest =
        std::max_element(depth.begin(), depth.end(), [](const auto& a, const auto& b) {
          return a.second < b.second;
        })->second;
    fail(link, "link '" + name + "' is " + std::to_string(found->second) +
                   " joints from the root, the farthest " + std::to_string(deepest) +
                   "; allowed: up to " + std::to_string(most_urdf_depth));
  }
}

void UrdfDocument::index_names() {
  const auto index = [this](const char* tag, auto& elements) {
    for (auto* e = robot_->FirstChildElement(tag); e; e = e->NextSiblingElement(tag)) {
      const std::string name = text_of(e, "name");
      if (name.empty()) fail(e, "a <" + std::string(tag) + "> has no name; allowed: a unique one");
      if (!elements.emplace(name, e).second) fail(e, "a second " + label(*e) + "; allowed: one");
    }
  };
  index("link", links_);
  index("joint", joints_);
  for (auto* e = robot_->FirstChildElement("transmission"); e;
       e = e->NextSiblingElement("transmission")) {
    const auto* actuator = e->FirstChildElement("actuator");
    if (actuator) actuators_.emplace(text_of(e->FirstChildElement("joint"), "name"), actuator);
  }
  for (const auto& [name, link] : links_) {
    for (auto* e = link->FirstChildElement("collision"); e;
         e = e->NextSiblingElement("collision")) {
      shapes_[name].push_back(shape_of(*e, label(*link)));
    }
  }
}

const Element* UrdfDocument::shape_of(const Element& collision, const std::string& owner) const {
  const Element* geometry = collision.FirstChildElement("geometry");
  const Element* shape = geometry ? geometry->FirstChildElement() : nullptr;
  if (!shape || shape->NextSiblingElement() || geometry->NextSiblingElement("geometry")) {
    fail(&collision, owner + ": a <collision> holds no shape or more than one; allowed: one of " +
                         "box, sphere, cylinder, capsule, mesh");
  }
  return shape;
}

// NOLINTNEXTLINE(misc-no-recursion): a file is a tree, read once at set-up
void UrdfDocument::check_numbers(const Element& element, const std::string& owner) const {
  const std::string_view name = element.Name();
  if (name == "visual") return;  // only looked at: see require_numbers()
  for (const NumberRule& rule : number_rules) {
    if (rule.element != name) continue;
    const std::string attribute(rule.attribute);
    const char* text = element.Attribute(attribute.c_str());
    if (!text && !rule.required) continue;
    if (text && obeys(rule, text)) continue;
    std::string wrong = owner + ": ";
    wrong += attribute + " of <" + std::string(name) + "> is ";
    wrong += (text ? quoted(text) : "missing") + "; allowed: " + allowed(rule);
    fail(&element, wrong);
  }
  for (const auto* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    check_numbers(*child, owner);
  }
}

const Element* UrdfDocument::link(const std::string& name) const {
  const auto found = links_.find(name);
  return found == links_.end() ? nullptr : found->second;
}

void UrdfDocument::require_numbers(const Element& element, const std::string& owner) const {
  for (const auto* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    check_numbers(*child, owner);
  }
}

std::vector<double> UrdfDocument::numbers(const Element& element, const char* attribute) {
  return numbers_in(text_of(&element, attribute)).value_or(std::vector<double>());
}

// Limits the number of attributes, because urdfdom compares each one with all before it.
// NOLINTNEXTLINE(misc-no-recursion): tinyxml2 reads no more than 500 elements in each other
void UrdfDocument::require_modest(const Element& element, Counts& counts) const {
  const auto require_at_most = [&](std::size_t count, std::size_t most, const std::string& what) {
    if (count <= most) return;
    fail(&element, "more than " + std::to_string(most) + " " + what + "; allowed: up to " +
                       std::to_string(most));
  };
  require_at_most(++counts.elements, input_limits.values, "elements");
  const bool is_collision = std::string_view(element.Name()) == "collision";
  counts.collisions += is_collision ? 1 : 0;
  require_at_most(counts.collisions, input_limits.entries, "collisions");
  std::size_t attributes = 0;
  for (const auto* a = element.FirstAttribute(); a; a = a->Next()) {
    require_at_most(++attributes, input_limits.attributes, "attributes of one element");
    const std::size_t bytes = std::string_view(a->Value()).size();
    if (bytes <= input_limits.text_bytes) continue;
    fail(&element, "the attribute '" + std::string(a->Name()).substr(0, 100) + "' has " +
                       std::to_string(bytes) + " bytes; allowed: up to " +
                       std::to_string(input_limits.text_bytes));
  }
  for (const auto* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
    require_modest(*e, counts);
  }
}

void UrdfDocument::check_joint(const Element& joint) const {
  const std::string type = text_of(&joint, "type");
  if (type == "fixed") return;
  if (type == "continuous" || type == "planar" || type == "floating") return;
  if (type != "revolute" && type != "prismatic") {
    fail(&joint, label(joint) + ": type is '" + type +
                     "'; allowed: revolute, continuous, prismatic, fixed; beside the arm also "
                     "planar, floating");
  }
  if (!joint.FirstChildElement("limit")) {
    fail(&joint, label(joint) + ": <limit> is missing; allowed: one");
  }
}

/// The <mimic> of a joint that can move; null without one.
const Element* UrdfDocument::mimic_of(const Element& joint) const {
  return text_of(&joint, "type") == "fixed" ? nullptr : joint.FirstChildElement("mimic");
}

/// The joint that `joint`, which has a <mimic>, mimics.
const Element& UrdfDocument::leader_of(const Element& joint) const {
  const Element* mimic = mimic_of(joint);
  const std::string name = text_of(mimic, "joint");
  const auto found = joints_.find(name);
  if (found == joints_.end()) {
    fail(mimic,
         label(joint) + " mimics '" + name + "', which is not in the file; allowed: another joint");
  }
  const std::string type = text_of(found->second, "type");
  if (type == "planar" || type == "floating") {
    fail(mimic, label(joint) + " mimics '" + name + "', which is " + type +
                    "; allowed: a joint with one coordinate");
  }
  return *found->second;
}

/// Checks that every joint that mimics leads, in a few steps, to one that does not.
void UrdfDocument::require_leaders() const {
  constexpr std::size_t most_steps = 64;
  for (const auto& [name, joint] : joints_) {
    std::vector<const Element*> line{joint};
    while (mimic_of(*line.back())) {
      const Element* leader = &leader_of(*line.back());
      const Element* mimic = mimic_of(*line.back());
      if (std::find(line.begin(), line.end(), leader) != line.end()) {
        fail(mimic, label(*line.back()) + " mimics '" + text_of(leader, "name") +
                        "', which in the end mimics this one; allowed: no circle");
      }
      line.push_back(leader);
      if (line.size() <= most_steps) continue;
      fail(mimic, label(*joint) + " mimics through more than " + std::to_string(most_steps) +
                      " joints; allowed: up to " + std::to_string(most_steps));
    }
  }
}

std::string UrdfDocument::type_of(const std::string& joint) const {
  return text_of(joints_.at(joint), "type");
}

void UrdfDocument::require_range(const std::string& name) const {
  const Element& joint = *joints_.at(name);
  const auto* limit = joint.FirstChildElement("limit");
  if (!limit || text_of(&joint, "type") == "continuous") return;
  const auto lower = numbers_in(text_of(limit, "lower"));
  const auto upper = numbers_in(text_of(limit, "upper"));
  if (lower->empty() || upper->empty() || !(lower->front() < upper->front())) {
    fail(limit, label(joint) + ": limits are '" + text_of(limit, "lower") + "' to '" +
                    text_of(limit, "upper") + "'; allowed: lower below upper");
  }
}

std::string UrdfDocument::text_for_urdfdom() const {
  tinyxml2::XMLDocument copy;
  xml_.DeepCopy(&copy);
  auto* robot = copy.FirstChildElement("robot");
  if (text_of(robot, "name").empty()) {
    const std::string stem = std::filesystem::path(file_).stem().string();
    robot->SetAttribute("name", stem.empty() ? "robot" : stem.c_str());
  }
  remove_all(*robot, "material");
  for (auto* link = robot->FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    remove_all(*link, "visual");
    for (auto* e = link->FirstChildElement("collision"); e;
         e = e->NextSiblingElement("collision")) {
      if (auto* capsule = e->FirstChildElement("geometry")->FirstChildElement("capsule")) {
        capsule->SetName("cylinder");
      }
    }
  }
  tinyxml2::XMLPrinter printer;
  copy.Print(&printer);
  return printer.CStr();
}

void UrdfDocument::require_all_collisions(const urdf::ModelInterface& model) const {
  for (const auto& [name, shapes] : shapes_) {
    const auto link = model.getLink(name);
    const std::size_t parsed = link ? link->collision_array.size() : 0;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const Element* shape = shapes[i];
      const std::string_view in_file = is_capsule(name, i) ? "cylinder" : shape->Name();
      const bool kept = i < parsed && kind_in_urdf(*link->collision_array[i]->geometry) == in_file;
      if (kept) continue;
      fail(shape, "link '" + name + "': collision " + std::to_string(i + 1) + " of " +
                      std::to_string(shapes.size()) + " is a <" + shape->Name() +
                      ">, which would be lost; allowed: box, sphere, cylinder, capsule, mesh");
    }
  }
}

bool UrdfDocument::is_capsule(const std::string& link, std::size_t index) const {
  return std::string_view(shapes_.at(link)[index]->Name()) == "capsule";
}

double UrdfDocument::rotor_inertia(const std::string& joint) const {
  const auto found = actuators_.find(joint);
  if (found == actuators_.end()) return 0.0;
  const Element* actuator = found->second;
  const double ratio = number_of(actuator->FirstChildElement("drake:gear_ratio"), 1.0);
  return number_of(actuator->FirstChildElement("drake:rotor_inertia"), 0.0) * ratio * ratio;
}

void UrdfDocument::fail_at_link(const std::string& name, const std::string& what) const {
  fail(links_.at(name), "link '" + name + "' " + what);
}

void UrdfDocument::fail_at_joint(const std::string& name, const std::string& what) const {
  fail(joints_.at(name), "joint '" + name + "' " + what);
}

void UrdfDocument::fail_at_collision(const std::string& link, std::size_t index,
                                     const std::string& what) const {
  fail(shapes_.at(link)[index], "link '" + link + "': " + what);
}

void UrdfDocument::fail(const Element* at, const std::string& what) const {
  throw SetupError(what, file_, at->GetLineNum());
}

}  // namespace repel::detail
