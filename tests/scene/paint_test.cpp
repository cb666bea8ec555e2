// SPDX-License-Identifier: BSD-3-Clause
// How parts are drawn: their colours and how opaque they are.
#include <array>
#include <string>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>
#include <repel/scene/scene.hpp>

#include "scene/yaml_text.hpp"

namespace repel::scene {
namespace paint_test {

using testing::base_scene;
using testing::changed;
using testing::parsed;
using Color = std::array<double, 3>;

/// Of the obstacle, with these keys.
Paint paint_with(const std::string& keys) {
  return parsed(changed("size: 1 2 3 m", "size: 1 2 3 m, " + keys)).obstacles[0].shown.paint;
}

std::string complaint(const std::string& text) {
  try {
    (void)parsed(text);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Paint, IsAColourByNameOrByItsBytes) {
  EXPECT_EQ(paint_with("color: white").color, (Color{1, 1, 1}));
  EXPECT_EQ(paint_with("color: orange").color, (Color{1, 165 / 255.0, 0}));
  EXPECT_EQ(paint_with("color: \"#3380fF\"").color, (Color{0.2, 128 / 255.0, 1}));
  EXPECT_FALSE(paint_with("color: white").opacity);
}

TEST(Paint, IsAnOpacityAsANumberOrAShare) {
  EXPECT_EQ(paint_with("opacity: 0.25").opacity, 0.25);
  EXPECT_EQ(paint_with("opacity: 25 %").opacity, 0.25);
  EXPECT_EQ(paint_with("opacity: 1").opacity, 1.0);
  EXPECT_FALSE(paint_with("opacity: 1").color);
}

TEST(Paint, IsNotGivenByDefault) {
  const Scene scene = parsed(base_scene);
  for (const Shown& each : {scene.tool[0].shown, scene.obstacles[0].shown}) {
    EXPECT_FALSE(each.paint.color);
    EXPECT_FALSE(each.paint.opacity);
  }
}

TEST(Paint, IsOfPartsOfToolsAndOfWhatComesAndGoesToo) {
  const Color teal{0, 128 / 255.0, 128 / 255.0};
  EXPECT_EQ(parsed(changed("20 mm", "20 mm, color: teal")).tool[0].shown.paint.color, teal);
  const std::string loose = "loose: [{name: can, shape: sphere, radius: 2 cm, color: teal}]\n";
  EXPECT_EQ(parsed(base_scene + loose).loose[0].shown.paint.color, teal);
}

TEST(Paint, IsOfAllPartsOfAMeshOrModel) {
  const Scene scene = load("scenes/glove_box_mesh.yaml");
  int panes = 0;
  for (const Obstacle& each : scene.obstacles) {
    if (each.shown.of != "glass") continue;
    ++panes;
    EXPECT_TRUE(each.shown.paint.color) << each.name;
    EXPECT_EQ(each.shown.paint.opacity, 0.25) << each.name;
  }
  EXPECT_EQ(panes, 4);
  const std::string model = "shape: urdf, file: ../robots/puma560.urdf, opacity: 50 %";
  EXPECT_EQ(parsed(changed("shape: box, size: 1 2 3 m", model)).models[0].paint.opacity, 0.5);
}

TEST(Paint, ThatIsNoneIsRefusedWithItsLineAndWhatIsAllowed) {
  for (const char* const wrong :
       {"grey", "White", "\"#12345\"", "\"#1234567\"", "\"#12345g\"", "\"#-12345\"", "'#+12345'",
        "\"3380ff\"", "[1, 1, 1]", "{r: 1}", "\"\"", "~"}) {
    const std::string said =
        complaint(changed("size: 1 2 3 m", std::string("size: 1 2 3 m, color: ") + wrong));
    for (const char* const word :
         {"scenes/test.yaml:7: 'color'", "\"#rrggbb\"", "aqua", "yellow"}) {
      EXPECT_NE(said.find(word), std::string::npos) << wrong << ": " << said;
    }
  }
  for (const char* const wrong : {"0", "1.01", "-1", "nan", "half", "101 %"}) {
    const std::string said =
        complaint(changed("size: 1 2 3 m", std::string("size: 1 2 3 m, opacity: ") + wrong));
    EXPECT_NE(said.find("scenes/test.yaml:7: 'opacity'"), std::string::npos) << said;
    EXPECT_NE(said.find("0.01 to 1"), std::string::npos) << said;
  }
  EXPECT_NE(
      complaint(changed("size: 1 2 3 m", "size: 1 2 3 m, opacity: x")).find(", no unit or %;"),
      std::string::npos);
}

TEST(Paint, AColourWithoutItsQuotesIsSaidToBeAComment) {
  const std::string said =
      complaint(changed("size: 1 2 3 m", "size: 1 2 3 m, color: #ff0000") + "rate: 400 Hz\n");
  EXPECT_NE(said.find("from line 7, where a # begins a comment"), std::string::npos) << said;
}

TEST(Paint, IsInTheSchema) {
  const std::string text = schema();
  const auto at = text.find("\"color\":{\"anyOf\":[");
  ASSERT_NE(at, std::string::npos);
  EXPECT_NE(text.find("\"aqua\"", at), std::string::npos);
}

}  // namespace paint_test
}  // namespace repel::scene
