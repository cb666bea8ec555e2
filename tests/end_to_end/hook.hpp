// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A link that is not convex: the Puma with a hook, an L, on its hand.
#pragma once

#include <array>
#include <sstream>
#include <string>

#include "end_to_end/folder.hpp"

namespace repel::test {

/// The triangles of an L in the plane of x and z, 40 mm wide, 60 mm high, 10 mm thick.
inline std::string hook_stl() {
  constexpr int n = 6;
  constexpr std::array<double, n> x{0, 0.04, 0.04, 0.01, 0.01, 0};
  constexpr std::array<double, n> z{0, 0, 0.01, 0.01, 0.06, 0.06};
  std::ostringstream text;
  const auto corner = [&](int i, bool back) {
    text << "vertex " << x.at(i % n) << (back ? " 0.005 " : " -0.005 ") << z.at(i % n) << "\n";
  };
  const auto add = [&](int a, bool a_back, int b, bool b_back, int c, bool c_back) {
    text << "facet normal 0 0 0\nouter loop\n";
    corner(a, a_back);
    corner(b, b_back);
    corner(c, c_back);
    text << "endloop\nendfacet\n";
  };
  text << "solid hook\n";
  for (int i = 0; i < n; ++i) {
    add(i, false, i + 1, false, i + 1, true);
    add(i, false, i + 1, true, i, true);
  }
  for (int i = 1; i + 1 < n; ++i) {
    add(0, false, i + 1, false, i, false);
    add(0, true, i, true, i + 1, true);
  }
  text << "endsolid hook\n";
  return text.str();
}

/// The list of its two parts, the upright first, for vertices multiplied by `scale`.
/// @param keys further lines
inline std::string hook_list(const std::string& keys = "", double scale = 1.0) {
  std::ostringstream text;
  text << keys << "scale: " << scale << " " << scale << " " << scale << "\nparts:\n";
  for (const auto& [width, height] : {std::array{0.01, 0.06}, std::array{0.04, 0.01}}) {
    text << "  - points:\n";
    for (const double x : {0.0, width}) {
      for (const double y : {-0.005, 0.005}) {
        for (const double z : {0.0, height}) {
          text << "      - " << scale * x << " " << scale * y << " " << scale * z << " m\n";
        }
      }
    }
  }
  return text.str();
}

/// Writes arm.urdf, the Puma with hook.stl on its hand, and hook.stl; returns the path of the
/// former.
inline std::string with_hook(const Folder& folder, const std::string& scale = "1 1 1") {
  std::string urdf = text_of(REPEL_SOURCE "/robots/puma560.urdf");
  const std::string link = "<link name=\"link_6\">";
  const std::string mesh = "<mesh filename=\"hook.stl\" scale=\"" + scale + "\"/>";
  urdf.insert(urdf.find(link) + link.size(),
              "<collision name=\"hook\"><geometry>" + mesh + "</geometry></collision>");
  (void)folder.with("hook.stl", hook_stl());
  return folder.with("arm.urdf", urdf);
}

}  // namespace repel::test
