# SPDX-License-Identifier: BSD-3-Clause
"""What is drawn: robots as they look, and gaps in meshes."""

import os
import re

import live
from cases import OwnProgram


class Gaps(OwnProgram):
    def test_what_is_not_covered_of_a_mesh_is_marked_and_counted(self):
        folder = self.folder()
        text = live.scene_text("anderson_4x8")
        block = "  - {name: block, shape: mesh, file: block.stl, position: 1 0 0 m}\n"
        corners = "".join(f"      - {x} {y} {z} m\n"
                          for x in (0, 0.1) for y in (0, 0.1) for z in (0, 0.1))
        for name, content in (
                ("scene.yaml", text.replace("obstacles:\n", "obstacles:\n" + block)),
                ("block.stl", "solid block\nendsolid block\n"),
                ("block.stl.parts.yaml",
                 "gap_count: 3\ngaps:\n  - {at: 0 0 0.2 m, depth: 40 mm}\n"
                 "  - {at: 0.2 0 0 m, depth: 5 mm}\nparts:\n  - points:\n" + corners)):
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(content)
        self.draw_pixels()
        page = self.open(self.start(os.path.join(folder, "scene.yaml")))
        page.until(lambda s: s["drawn"]["gaps"] == 2, "two places are marked")
        self.assertTrue(page.shown("gap-row"))
        page.until_text("gap-text", r"^not covered: 3 places, up to 40\.00 mm deep, .* 2 deepest")
        page.pause()
        self.browser.execute_script("repel.look([1.3, -0.6, 0.6], [1, 0, 0.2])")
        page.draws()
        yellow = self.browser.execute_script("return window.repel.tinted([255, 212, 0], 12)")
        self.assertGreater(yellow, 30, "pixels in the colour of the legend")

    def test_without_gaps_nothing_is_said_of_them(self):
        page = self.open(self.start())
        page.draws()
        self.assertEqual(page.state()["drawn"]["gaps"], 0)
        self.assertFalse(page.shown("gap-row"))


class OwnColours(OwnProgram):
    """Parts with a colour and an opacity of their own, from a message made here."""

    # The table is pink, what stands on it is glass.
    COLOURS = """
        const parse = JSON.parse;
        JSON.parse = (text) => {
          const message = parse(text);
          for (const part of message?.type === "scene" ? message.parts : []) {
            if (part.name === "table") part.color = [1, 0, 0.7];
            else if (part.group === "obstacle") Object.assign(part, {color: [0, 1, 1], opacity: 0});
          }
          return message;
        };"""

    def test_a_part_is_drawn_in_its_colour_and_glass_hides_nothing(self):
        self.draw_pixels()
        url = self.start()
        pink = "repel.adapt(false); return repel.tinted([230, 0, 165], 40)"
        page = self.open(url)
        page.begin()
        page.draws()
        self.assertEqual(self.browser.execute_script(pink), 0)
        self.before_pages(self.COLOURS)
        page = self.open(url)
        page.begin()
        page.draws()
        table = self.browser.execute_script(pink)
        self.assertGreater(table, 10000)
        looks = self.module("wire.js", """
            const parts = [{color: [0.1, 0.2, 0.3], opacity: 0.4}, {}, {color: [1, "x", 0]},
                           {opacity: 7}].map((part) => ({...part, name: "p"}));
            return module.scene({parts}).parts.map(({color, opacity}) => [color, opacity]);""")
        self.assertEqual(looks, [[[0.1, 0.2, 0.3], 0.4], [None, 1], [None, 1], [None, 1]])

    def test_parts_that_look_the_same_share_a_material(self):
        self.open(self.start())
        shared = self.module("looks.js", """
            const made = [];
            const surface = () => {
              const color = {setRGB: (...values) => (color.values = values),
                             copy: ({values}) => (color.values = values)};
              made.push(color);
              return {color};
            };
            const looks = new module.Looks({surface, invalidate: () => {}});
            const one = looks.of("obstacle", [0.5, 0, 0], 1);
            const same = looks.of("obstacle", [0.5, 0, 0], 1) === one;
            const glass = looks.of("obstacle", [0.5, 0, 0], 0.3);
            looks.fade(0.25);
            const faded = [one.whole.opacity, glass.whole.opacity, one.whole.depthWrite];
            looks.fade(1);
            return [same, glass === one, one.glass, glass.glass, made.length, ...faded,
                    one.whole.transparent, glass.whole.transparent, glass.whole.opacity];""")
        self.assertEqual(shared, [True, False, False, True, 4, 0.25, 0.25, False, False, True, 0.3])


class Many(OwnProgram):
    def test_of_a_million_points_it_says_what_it_leaves_out(self):
        # The table of the scene, with a million corners.
        self.before_pages("""
            const parse = JSON.parse;
            JSON.parse = (text) => {
              const message = parse(text);
              if (message?.type !== "scene") return message;
              const table = message.parts.find((part) => part.name === "table");
              table.levels[0].vertices = Array.from({length: 3000000}, (_, k) => (k % 1009) / 1009);
              return message;
            };""")
        page = self.open(self.start())
        page.until_said("banners", "^1 part is not drawn: .* more than 300000 corners$")
        page.begin()
        before = page.draws()["drawn"]["parts"]
        self.assertGreater(before, 10, "the others are drawn")
        page.take()
        page.steps(40)


def placed(pose, p):
    """A point of a frame, in the world. pose: [x, y, z, qx, qy, qz, qw]"""
    q, w = pose[3:6], pose[6]
    cross = lambda a, b: [a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3)]
    once = [2 * x for x in cross(q, p)]
    twice = cross(q, once)
    return [pose[k] + p[k] + w * once[k] + twice[k] for k in range(3)]


class Looks(OwnProgram):
    """The robot as it looks, from a message made here."""

    # A pyramid on the tool, whose collision parts it covers, a block on the world that reaches far
    # out, and one that is not whole.
    VISUALS = """
        const pyramid = {vertices: [0.1, 0, 0, 0, 0.1, 0, -0.1, 0, 0, 0, -0.1, 0, 0, 0, 0.2],
                         triangles: [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4]};
        const parse = JSON.parse;
        JSON.parse = (text) => {
          const message = parse(text);
          if (message?.type === "scene") {
            const tool = message.arms[0].tool_body;
            message.visuals = [
              {body: tool, arm: 0, pose: [0, 0, 0, 0, 0, 0, 1], color: [0, 1, 0.2, 1], name: "hat",
               ...pyramid},
              {body: tool, arm: 0, pose: [0.1, 0, 0, 0, 0, 0, 1], name: "plain", ...pyramid},
              {body: 0, arm: 0, pose: [9, 9, 0, 0, 0, 0, 1], name: "base", ...pyramid},
              {body: tool, arm: 0, pose: [0, 0, 0], name: "broken", vertices: [0, "x"]}];
          }
          return message;
        };"""

    def open_looks(self):
        self.before_pages(self.VISUALS)
        return self.open(self.start())

    def test_the_robot_is_drawn_as_it_looks_or_by_its_parts(self):
        self.draw_pixels()
        page = self.open_looks()
        page.begin()
        page.draws()
        state = page.until(lambda s: s["drawn"]["visuals"] == 2, "both bodies are drawn")
        parts = state["partsInScene"]
        page.until(lambda s: s["drawn"]["parts"] < parts, "what is under it is not seen")
        green = "return repel.tinted([0, 200, 40], 55)"
        self.assertGreater(self.browser.execute_script(green), 100)
        reach = self.browser.execute_script("return repel.reach().flat()")
        self.assertLess(max(map(abs, reach)), 1.05, "the camera fits the parts alone")
        page.click("show-menu")
        self.assertTrue(page.shown("show-robot"))
        page.choose("show-robot", "parts")
        page.until(lambda s: s["drawn"]["parts"] == parts and s["drawn"]["visuals"] == 1,
                   "the parts, and the base")
        self.assertEqual(self.browser.execute_script(green), 0)
        page.choose("show-robot", "looks")
        page.until(lambda s: s["drawn"]["visuals"] == 2, "as it looks again")
        page.choose("show-levels", "all")
        drawn = page.until(lambda s: s["drawn"]["levels"] > 0, "levels are seen")["drawn"]
        self.assertEqual((drawn["parts"], drawn["visuals"]), (parts, 1))

    def test_a_link_without_a_body_is_drawn_and_moves(self):
        folder = self.folder()
        with open(os.path.join(live.ROOT, "robots", "puma560.urdf"), encoding="utf-8") as file:
            begin, link, end = re.split('(<link name="link_2">.*?</link>)', file.read(),
                                        flags=re.DOTALL)
        paint = '<material name="pink"><color rgba="1 0 0.7 1"/></material></visual>'
        link = link.replace("collision", "visual").replace("</visual>", paint)
        robot = os.path.join(folder, "robot.urdf")
        with open(robot, "w", encoding="utf-8") as file:
            file.write(begin + link + end)
        text = live.scene_text("empty").replace(
            os.path.join(live.ROOT, "robots", "puma560.urdf"), robot)
        scene = os.path.join(folder, "scene.yaml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(text.replace("40 40 0 mm/s", "0 60 0 mm/s"))
        self.draw_pixels()
        page = self.open(self.start(scene))
        page.begin()
        page.draws()
        page.until(lambda s: s["drawn"]["visuals"] == 2, "base and link")
        before = page.state()["linkPoses"]
        self.assertEqual(len(before), 1)
        pink = "return repel.tinted([220, 0, 150], 40)"
        self.assertGreater(self.browser.execute_script(pink), 1000)
        page.stand_in("move by the lever", 2.5)
        page.until(lambda s: max(abs(a - b) for a, b in
                                 zip(s["linkPoses"][0], before[0])) > 0.02, "it moves")
        page.click("show-menu")
        page.choose("show-robot", "parts")
        page.until(lambda s: s["drawn"]["visuals"] == 1, "the base alone")
        self.assertEqual(self.browser.execute_script(pink), 0)
        page.choose("show-robot", "looks")
        page.until(lambda s: s["drawn"]["visuals"] == 2, "it is seen again")
        state = page.until(lambda s: self.browser.execute_script(pink) > 1000, "it is in view")
        # From behind the upper arm, which would hide the tool.
        tool = state["toolPosition"]
        middle = placed(state["linkPoses"][0], [0.2, 0, 0.2435])
        eye = [t + 2 * (m - t) for t, m in zip(tool, middle)]
        self.browser.execute_script(f"repel.look({eye}, {tool})")
        page.until(lambda s: self.browser.execute_script(pink) == 0, "it is seen through")
        self.assertEqual(page.state()["drawn"]["visuals"], 2)

    def test_what_is_near_is_seen_through_it(self):
        page = self.open_looks()
        page.begin()
        page.draws()
        before = page.until(lambda s: s["drawn"]["visuals"] == 2 and s["pairs"] == 0 and
                            s["drawn"]["parts"] < s["partsInScene"],
                            "nothing is near, and the tool is under its looks")["drawn"]["parts"]
        page.stand_in("press on the table", 0.9)
        page.until(lambda s: s["pairs"] > 0 and s["drawn"]["parts"] > before, "a part comes near")

    def test_creases_are_sharp_and_round_things_smooth(self):
        self.open(self.start())
        sharp, smooth = self.browser.execute_async_script("""
            const done = arguments[0];
            import("./geometry.js").then(({creased}) => {
              const roof = (z) => creased({vertices: [0, 0, 0, 1, 0, 0, 0, 1, z, 1, 0, 0, 0, 0, 0,
                                                      0, -1, z], triangles: [0, 1, 2, 3, 4, 5]});
              const meet = ({normals}) => normals[1] * normals[10] + normals[0] * normals[9] +
                                          normals[2] * normals[11];
              done([meet(roof(-1)), meet(roof(-0.1))]);
            });""")
        self.assertLess(sharp, 0.1)
        self.assertGreater(smooth, 0.999)
