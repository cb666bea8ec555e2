#include <algorithm>

#include <tinyxml2.h>

#include <repel/base/setup_error.hpp>
#include <repel/robots/urdf.hpp>

namespace repel {

std::vector<DisabledCollision> load_disabled_collisions(const std::string& path,
                                                        const Robot& robot) {
  tinyxml2::XMLDocument xml;
  if (xml.LoadFile(path.c_str()) != tinyxml2::XML_SUCCESS) {
    throw SetupError(std::string("cannot be read: ") + xml.ErrorStr(), path, xml.ErrorLineNum());
  }
  const tinyxml2::XMLElement* root = xml.FirstChildElement("robot");
  if (!root) throw SetupError("no <robot> element; allowed: one", path, 1);
  const auto link_of = [&](const tinyxml2::XMLElement& element, const char* attribute) {
    const char* text = element.Attribute(attribute);
    std::string name = text ? text : "";
    const bool known = std::any_of(robot.links.begin(), robot.links.end(),
                                   [&](const RobotLink& link) { return link.name == name; });
    if (known) return name;
    throw SetupError(std::string(attribute) + " of <disable_collisions> is '" + name +
                         "'; allowed: a link of robot '" + robot.arm.name + "'",
                     path, element.GetLineNum());
  };
  std::vector<DisabledCollision> pairs;
  for (const auto* e = root->FirstChildElement("disable_collisions"); e;
       e = e->NextSiblingElement("disable_collisions")) {
    const char* reason = e->Attribute("reason");
    pairs.push_back({link_of(*e, "link1"), link_of(*e, "link2"), reason ? reason : ""});
  }
  return pairs;
}

}  // namespace repel
