// SPDX-License-Identifier: BSD-3-Clause
// Input that would exhaust memory or time is refused by SetupError with its size, the limit and its
// line.
#include <algorithm>
#include <ctime>
#include <string>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>
#include <repel/common/input_limits.hpp>
#include <scene/yaml_text.hpp>

namespace repel::scene {
namespace scene_limits_test {

using testing::base_scene;
using testing::changed;
using testing::parsed;

/// The error message for `text`; it must give `line`.
std::string refusal(const std::string& text, int line) {
  try {
    (void)parsed(text);
    ADD_FAILURE() << "accepted: " << text.substr(0, 200);
  } catch (const SetupError& error) {
    EXPECT_EQ(error.line(), line) << error.what();
    EXPECT_LT(std::string(error.what()).size(), 2000U) << "an error is to be read";
    return error.what();
  }
  return "accepted";
}

void expect_refused(const std::string& text, int line, std::initializer_list<std::string> words) {
  const std::string refused = refusal(text, line);
  for (const std::string& word : words) {
    EXPECT_NE(refused.find(word), std::string::npos) << "no \"" << word << "\" in: " << refused;
  }
}

/// "text text text"
std::string repeated(const std::string& text, std::size_t count) {
  std::string result;
  result.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i) result += text;
  return result;
}

std::string with_laws(std::size_t count) {
  std::string text = base_scene + "laws:\n";
  for (std::size_t i = 0; i < count; ++i) text += "  law" + std::to_string(i) + ": {}\n";
  return text;
}

std::string with_obstacles(std::size_t count) {
  std::string text = base_scene;
  for (std::size_t i = 0; i < count; ++i) {
    text += "  - {name: n" + std::to_string(i) + ", shape: sphere, radius: 1 m}\n";
  }
  return text;
}

// yaml-cpp 0.7 allocated 300 MB a second without end.
TEST(SceneLimits, ATextThatBeginsWithACommaIsNoYaml) {
  for (const std::string begin : {",", ",a", ", ", "]", "}", "?,", "- ,", "[,", "{,", ": ,"}) {
    SCOPED_TRACE(begin);
    EXPECT_NE(refusal(begin + "\n", 1), "accepted");
    EXPECT_THROW((void)parsed(begin + base_scene), SetupError);
  }
}

TEST(SceneLimits, EveryStartOfATextEnds) {
  const std::string signs = ",[]{}:-?&*!|>'\"%@`# \n\ta.0~";
  for (const char a : signs) {
    for (const char b : signs) {
      for (const char c : signs) EXPECT_THROW((void)parsed(std::string{a, b, c}), SetupError);
    }
  }
}

TEST(SceneLimits, AFileOfTooManyBytesIsRefused) {
  std::string text = base_scene + "#";
  text.resize(input_limits.file_bytes, ' ');
  EXPECT_NO_THROW((void)parsed(text));
  expect_refused(text + " ", 0, {"16777217 bytes", "up to 16777216"});
}

TEST(SceneLimits, ATextOfTooManyBytesIsRefusedAtItsLine) {
  const auto named = [](std::size_t bytes) {
    return changed("name: wall", "name: " + std::string(bytes, 'n'));
  };
  EXPECT_NO_THROW((void)parsed(named(input_limits.text_bytes)));
  expect_refused(named(input_limits.text_bytes + 1), 7, {"4097 bytes", "up to 4096"});
  expect_refused(base_scene + std::string(5'000'000, 'k') + ": 1\n", 8, {"not YAML"});
  expect_refused(base_scene + "? " + std::string(5'000'000, 'k') + "\n", 8, {"5000000 bytes"});
  expect_refused(base_scene + "name: &" + std::string(5000, 'a') + " b\n", 8, {"5000 bytes"});
}

TEST(SceneLimits, ALongTextIsNotRepeatedInTheError) {
  expect_refused(changed("shape: box", "shape: " + std::string(4000, 'b')), 7, {"(4000 bytes)"});
  expect_refused(with_laws(5000) + "name: x\n" + "rate: 1\n", 5010, {"'rate'"});
  const std::string law = "size: 1 2 3 m, law: none";
  std::string text = with_laws(5000);
  text.replace(text.find("size: 1 2 3 m"), 13, law);
  expect_refused(text, 7, {"'law' is 'none'", "and more"});
}

TEST(SceneLimits, ListsInListsAreRefusedAtTheirDepth) {
  const std::size_t inner = input_limits.depth - 1;  // the scene itself is a map
  expect_refused(base_scene + "name: " + std::string(inner, '[') + std::string(inner, ']') + "\n",
                 8, {"'name' is a list"});
  expect_refused(base_scene + "name: " + std::string(inner + 1, '[') + "\n", 8,
                 {"more than 32 deep", "up to 32"});
  EXPECT_THROW((void)parsed(base_scene + "name: " + repeated("- ", 1'000'000)), SetupError);
  EXPECT_THROW((void)parsed(repeated("? ", 1'000'000)), SetupError);
  EXPECT_THROW((void)parsed(repeated("[a: ", 1'000'000)), SetupError);
}

TEST(SceneLimits, AliasesThatMultiplyAreRefused) {
  std::string text = base_scene + "laws:\n  a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 30; ++i) {
    const std::string one = "*a" + std::to_string(i - 1);
    text += "  a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + one +
            repeated(", " + one, 9) + "]\n";
  }
  expect_refused(text, 14, {"more than 500000 values", "up to 500000"});
}

TEST(SceneLimits, AnAliasWithinItselfIsRefused) {
  expect_refused(base_scene + "laws: &a\n  b: *a\n", 9, {"within what it stands for"});
  EXPECT_THROW((void)parsed("&a [*a]"), SetupError);
}

TEST(SceneLimits, AnAliasStandsForWhatItNames) {
  const Scene scene =
      parsed(base_scene + "  - {name: a, shape: box, size: &s 2 4 6 m}\n" +
             "  - {name: b, shape: box, size: *s}\nlaws: {k: &k {range: 1 m}, l: *k}\n");
  EXPECT_EQ(scene.obstacles[1].shape.reach(), scene.obstacles[2].shape.reach());
}

TEST(SceneLimits, TooManyValuesAreRefused) {
  expect_refused(base_scene + "laws:\n" + repeated("- \n", 600'000), 499'982,
                 {"more than 500000 values"});
}

TEST(SceneLimits, TooManyLawsObstaclesModulesAndPartnersAreRefused) {
  EXPECT_NO_THROW((void)parsed(with_laws(input_limits.entries)));
  expect_refused(with_laws(input_limits.entries + 1), 9,
                 {"'laws' has 10001 entries", "up to 10000"});
  EXPECT_EQ(parsed(with_obstacles(9'999)).obstacles.size(), input_limits.entries);
  expect_refused(with_obstacles(10'000), 7, {"'obstacles' has 10001 entries", "up to 10000"});
  expect_refused(base_scene + "network:\n" + repeated("  - {module: kbb2}\n", 257), 9,
                 {"'network' has 257 entries", "up to 256"});
  expect_refused(base_scene + "partners:\n" + repeated("  - {name: a}\n", 65), 9,
                 {"'partners' has 65 entries", "up to 64"});
}

TEST(SceneLimits, TheHullsTogetherAreLimited) {
  std::string text =
      changed("shape: box, size: 1 2 3 m",
              "shape: hull, points: &p [" + repeated("0 0 0 m, ", 9'998) + "1 0 0 m, 0 1 0 m]");
  for (int i = 0; i < 10; ++i) {
    text += "  - {name: h" + std::to_string(i) + ", shape: hull, points: *p}\n";
  }
  expect_refused(text, 7, {"have 110000 points", "up to 100000 in all"});
}

TEST(SceneLimits, ManyDirectivesAreRefused) {
  std::string text;
  for (int i = 0; i < 17; ++i) text += "%TAG !" + std::to_string(i) + "! x\n";
  expect_refused(text + "---\n" + base_scene, 17, {"begin with '%'", "up to 16"});
  EXPECT_NO_THROW((void)parsed("%YAML 1.1\n---\n" + base_scene));
}

TEST(SceneLimits, WhatIsNotUtf8IsRefusedAtItsLine) {
  expect_refused(base_scene + "name: \xff\n", 8, {"not YAML"});
  expect_refused(base_scene + "name: " + std::string(1, '\1') + "\n", 8, {"not YAML"});
}

TEST(SceneLimits, HugeAndOddNumbersAreRefusedWithTheirRange) {
  const std::string digits(140, '9');
  for (const std::string& number :
       {std::string("1e308"), std::string("-1e308"), std::string("1e309"), std::string("nan"),
        std::string(".inf"), std::string("-.inf"), std::string(".nan"), digits}) {
    const auto expect = [&](const std::string& text, int line, const std::string& range) {
      SCOPED_TRACE(number);
      expect_refused(text, line, {number, range});
    };
    expect(changed("20 mm", number + " mm"), 5, "0 to 1e+06 m");
    expect(changed("1 2 3 m", "1 " + number + " 3 m"), 7, "0 to 1e+06 m");
    expect(changed("1 2 3 m", "1 2 3 m, position: 0 0 " + number + " m"), 7, "-1e+06 to 1e+06 m");
    expect(changed("0 45 180", "0 " + number + " 180"), 3, "-1000 to 1000 rad");
    expect(base_scene + "rate: " + number + " Hz\n", 8, "1 to 1e+05 Hz");
    expect(base_scene + "laws: {a: {ceiling: " + number + " N}}\n", 8, "0 to 1e+06 N");
    expect(base_scene + "budget: {work: " + number + "}\n", 8, "0 to 1000000000");
    expect(base_scene + "network: [{module: kbb2, damping: " + number + " N s/m}]\n", 8,
           "0 to 1e+06 N s/m");
  }
}

/// Of the processor: on a busy machine a long parse is interrupted more often than a short one.
double seconds_to_parse(const std::string& text) {
  double least = 1e9;
  for (int i = 0; i < 3; ++i) {
    const std::clock_t begin = std::clock();
    (void)parsed(text);
    least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

// Regression: 100 000 laws took more than two minutes, since each was compared with all before it.
TEST(SceneLimits, EightTimesTheLawsOrObstaclesTakeAboutEightTimesAsLong) {
  EXPECT_LT(seconds_to_parse(with_laws(9'600)), 32.0 * seconds_to_parse(with_laws(1'200)));
  EXPECT_LT(seconds_to_parse(with_obstacles(9'600)),
            32.0 * seconds_to_parse(with_obstacles(1'200)));
}

}  // namespace scene_limits_test
}  // namespace repel::scene
