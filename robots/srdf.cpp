// SPDX-License-Identifier: BSD-3-Clause
#include <set>

#include <tinyxml2.h>

#include <repel/base/setup_error.hpp>
#include <repel/robots/urdf.hpp>

#include "urdf_document.hpp"

namespace repel {

std::vector<DisabledCollision> load_disabled_collisions(const std::string& path,
                                                        const Robot& robot) {
  tinyxml2::XMLDocument xml;
  const std::string content = detail::text_of_description(path);
  if (xml.Parse(content.data(), content.size()) != tinyxml2::XML_SUCCESS) {
    throw SetupError(std::string("cannot be read: ") + xml.ErrorStr(), path, xml.ErrorLineNum());
  }
  const tinyxml2::XMLElement* root = xml.FirstChildElement("robot");
  if (!root) throw SetupError("no <robot> element; allowed: one", path, 1);
  std::set<std::string> links;
  for (const RobotLink& link : robot.links) links.insert(link.name);
  const auto link_of = [&](const tinyxml2::XMLElement& element, const char* attribute) {
    const char* text = element.Attribute(attribute);
    std::string name = text ? text : "";
    if (links.contains(name)) return name;
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
