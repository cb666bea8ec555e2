# SPDX-License-Identifier: BSD-3-Clause
"""Small screens, fingers on them, and who cannot see."""

import os
import shutil
import subprocess
import tarfile
import time
import unittest

import live
from cases import OwnProgram, SharedProgram, by_the_clock
from selenium.webdriver.common.keys import Keys


AXE_VERSION = "4.14.1"


def axe_core():
    """The text of axe.min.js, or None where it cannot be had."""
    named = os.environ.get("REPEL_AXE", "")
    folder = os.path.join(live.ROOT, "build", "axe", AXE_VERSION)
    path = named or os.path.join(folder, "axe.min.js")
    if not os.path.exists(path) and shutil.which("npm"):
        os.makedirs(folder, exist_ok=True)
        packed = subprocess.run(
            ["npm", "pack", "--silent", f"axe-core@{AXE_VERSION}"], cwd=folder, timeout=120,
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
        archive = os.path.join(folder, packed.stdout.strip() or "-")
        if packed.returncode == 0 and os.path.exists(archive):
            with tarfile.open(archive) as files, open(path, "wb") as out:
                out.write(files.extractfile("package/axe.min.js").read())
    if not os.path.exists(path):
        return None
    with open(path, encoding="utf-8") as file:
        return file.read()


PHONE, TABLET, DESK = (390, 844, True), (820, 1180, True), (1440, 900, False)


SMALLEST = """
    const small = [];
    for (const each of document.querySelectorAll("button, select, summary, input, .stick")) {
      if (!each.checkVisibility()) continue;
      const boxes = [each, each.closest("label") ?? each].map((e) => e.getBoundingClientRect());
      const wide = Math.max(...boxes.map((box) => box.width));
      const tall = Math.max(...boxes.map((box) => box.height));
      const { left, right } = boxes[0];
      const out = left < -0.5 || right > innerWidth + 0.5;
      if (out || wide < 43.5 || tall < 43.5) small.push([each.id || each.textContent, wide, tall]);
    }
    return small;"""


# What lies on the rectangle that the views show.
COVERED = """
    const view = document.getElementById("view").getBoundingClientRect();
    const [[left, right], [low, high]] = repel.reach();
    const x = (at) => view.left + ((at + 1) / 2) * view.width;
    const y = (at) => view.top + ((1 - at) / 2) * view.height;
    return [...document.querySelectorAll(".view .card, .triad, .stick, .view .numbers")]
      .filter((card) => {
        const box = card.getBoundingClientRect();
        return card.checkVisibility() && box.left < x(right) && box.right > x(left) &&
               box.top < y(low) && box.bottom > y(high);
      }).map((card) => card.className);"""


class Fingers(SharedProgram):
    """Small screens, and fingers on them."""

    @classmethod
    def setUpClass(cls):
        if live.URL:
            raise unittest.SkipTest("needs a program of its own")
        super().setUpClass()

    def tearDown(self):
        self.has_no_errors()

    def turn(self, width, height, touch):
        self.resize(width, height, touch)
        self.browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {
            "enabled": touch, "maxTouchPoints": 5 if touch else 1})

    def open_on(self, size):
        """The page on such a screen; the run is paused at its beginning."""
        self.turn(*size)
        page = self.open(self.url)
        page.begin()
        self.addCleanup(page.release)
        return page

    def middle(self, name):
        return self.browser.execute_script(
            "const b = document.getElementById(arguments[0]).getBoundingClientRect();"
            "return [b.x + b.width / 2, b.y + b.height / 2];", name)

    def touch(self, kind, *points):
        self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {
            "type": kind, "touchPoints": [{"x": x, "y": y, "id": k}
                                          for k, (x, y) in enumerate(points)]})

    def push(self, name, dx, dy, holds, what):
        """Pushes a stick until a property holds, and lets it spring back."""
        x, y = self.middle(name)
        self.touch("touchStart", (x, y))
        self.touch("touchMove", (x + dx, y + dy))
        try:
            return self.page.drives(holds, what)
        finally:
            self.touch("touchEnd")

    def fits(self, width, height):
        self.assertEqual(self.browser.execute_script(
            "return [document.documentElement.scrollWidth, document.documentElement.scrollHeight]"),
            [width, height], "nothing sticks out")

    def test_everything_fits_and_the_readings_fold_away(self):
        for size in (PHONE, TABLET):
            for width, height in (size[:2], size[1::-1]):
                with self.subTest(width=width, height=height):
                    page = self.open_on((width, height, True))
                    self.assertFalse(page.shown("panel"))
                    for name in ("canvas", "nearest", "pause"):
                        self.assertTrue(page.shown(name), name)
                    sticks = ("stick-along", "stick-round")
                    self.assertFalse(any(map(page.shown, sticks)), "nobody drives")
                    page.take()
                    self.assertTrue(all(map(page.shown, sticks)))
                    self.assertGreater(self.element("view").rect["height"],
                                       0.75 * height)
                    for opened in (False, True):
                        self.fits(width, height)
                        self.assertEqual(self.browser.execute_script(SMALLEST), [])
                        page.click("panel-open")
                        self.assertEqual(page.shown("panel"), not opened)
                        self.assertEqual(page.shown("force-strip"), not opened)

    def test_a_desk_has_the_readings_beside_the_scene(self):
        page = self.open_on(DESK)
        self.fits(*DESK[:2])
        self.assertTrue(page.shown("panel") and page.shown("legend"))
        for name in ("panel-open", "stick-along", "tilt"):
            self.assertFalse(page.shown(name), name)

    @by_the_clock
    def test_the_sticks_drive(self):
        page = self.open_on(PHONE)
        page.click("view-front")  # looks towards -x: left is -y
        page.take()
        before = page.state()["toolPosition"]
        page.run()
        self.push("stick-round", 0, -50, lambda s: s["toolPosition"][2] > before[2] + 0.03,
                  "the tool goes up")
        before = page.state()["toolPosition"]
        self.push("stick-along", 0, -50, lambda s: s["toolPosition"][0] < before[0] - 0.02,
                  "it goes away from us")
        before = page.state()["toolPosition"]
        self.push("stick-along", -50, 0, lambda s: s["toolPosition"][1] < before[1] - 0.02,
                  "it goes to the left")
        self.assertTrue(page.shown("take"))
        page.pause()
        before = page.steps(400)["toolPosition"]  # it comes to rest
        for before, after in zip(before, page.steps(200)["toolPosition"]):
            self.assertAlmostEqual(before, after, delta=0.003, msg="let go it stands")
        page.click("panel-open")
        self.assertTrue(page.shown("drive-speed"), "the speed can be set")

    @by_the_clock
    def test_one_finger_turns_the_camera_while_another_drives(self):
        page = self.open_on(PHONE)
        page.take()
        before = page.state()
        page.run()
        stick, canvas = self.middle("stick-round"), self.middle("canvas")
        canvas[1] -= 150  # beside the tool
        self.touch("touchStart", stick)
        self.touch("touchMove", (stick[0], stick[1] - 50))
        self.touch("touchStart", (stick[0], stick[1] - 50), canvas)
        for k in range(1, 6):
            self.touch("touchMove", (stick[0], stick[1] - 50), (canvas[0] + 20 * k, canvas[1]))
        try:
            page.drives(lambda s: s["camera"]["mode"] == "free" and
                        s["toolPosition"][2] > before["toolPosition"][2] + 0.03, "it does both")
        finally:
            self.touch("touchEnd")

    def test_two_fingers_come_closer_and_a_turned_screen_is_fitted(self):
        page = self.open_on(PHONE)

        def span():
            return self.browser.execute_script(
                "return Math.max(...(repel.reach() ?? [[9]]).flat().map(Math.abs))")
        page.until(lambda s: span() < 1, "all is seen")
        width, height, _ = PHONE
        self.turn(height, width, True)
        page.until(lambda s: s["aspect"] > 1.5 and span() < 1, "all is seen when it is turned")
        self.assertEqual(page.state()["camera"]["mode"], "home")
        self.turn(width, height, True)
        page.until(lambda s: s["aspect"] < 0.7 and span() < 1, "and when it is turned back")
        before = span()
        x, y = self.middle("canvas")
        self.touch("touchStart", (x - 30, y), (x + 30, y))
        for k in range(1, 6):
            self.touch("touchMove", (x - 30 - 10 * k, y), (x + 30 + 10 * k, y))
        self.touch("touchEnd")
        page.until(lambda s: span() > 1.2 * before, "it is closer")
        self.assertFalse(page.state()["operator"]["you"])

    def test_home_shows_all_beside_what_lies_on_the_scene(self):
        for size in (PHONE, TABLET, DESK, (1920, 1080, False)):
            with self.subTest(size=size):
                page = self.open_on(size)
                page.draws()
                page.click("view-home")
                self.assertEqual(self.browser.execute_script(COVERED), [])

    def test_the_ends_of_the_axes_turn_the_camera(self):
        page = self.open_on(DESK)
        page.draws()

        def ends(name):
            return self.browser.find_element("css selector", f"#triad [title='Look from {name}']")

        def away():
            return self.browser.execute_script("""
                const {position, target} = repel.state().camera;
                const by = position.map((p, k) => p - target[k]);
                return by.map((b) => Math.round(100 * b / Math.hypot(...by)) / 100);""")
        before = page.state()["camera"]["position"]
        ends("+x").click()
        self.assertEqual(away(), [1, 0, 0])
        page.until(lambda s: s["camera"]["position"] != before, "it is elsewhere")
        ends("+z").send_keys(Keys.ENTER)
        self.assertEqual(away(), [0, 0, 1])
        self.assertEqual(page.state()["camera"]["mode"], "free")
        page.press("1")
        self.assertEqual(page.state()["camera"]["mode"], "home")

    def test_a_hidden_page_draws_nothing_and_lets_its_line_go(self):
        page = self.open_on(DESK)
        page.run()
        self.browser.execute_script(
            "Object.defineProperty(document, 'hidden', {value: true, configurable: true});"
            "document.dispatchEvent(new Event('visibilitychange'));")
        before = None

        def nothing_more(state):
            nonlocal before
            last, before = before, state["framesRendered"]
            time.sleep(0.3)
            return before == last

        page.until(nothing_more, "nothing is on its way")
        page.until(lambda s: s["resting"], "it lets its line go")
        self.assertEqual(page.state()["framesRendered"], before)
        tick = page.state()["tick"]
        self.browser.execute_script(
            "delete document.hidden; document.dispatchEvent(new Event('visibilitychange'));")
        page.until(lambda s: s["framesRendered"] > before + 2 and s["tick"] > tick, "it goes on")

    def test_the_quality_follows_the_time_of_a_frame(self):
        self.open_on(DESK)
        levels, coarsest, waits = self.browser.execute_async_script("""
            const done = arguments[0];
            import("./quality.js").then(({ decide, finest, LEVELS }) => {
              const levels = (now, times) => times.map((ms) => (now = decide(now, ms)).level);
              let now = finest();
              // Quick means until it gets finer, each time after it was too much.
              const waits = [0, 0, 0].map(() => {
                now = decide(now, 60);
                let count = 0;
                for (; now.level > 0; ++count) now = decide(now, 10);
                return count;
              });
              done([levels(finest(), [30, 46, 30, 80, 10, 10, 10, 30, 10, NaN, 10, 10, 10]),
                    levels(finest(), Array(9).fill(99)).at(-1) === LEVELS.length - 1, waits]);
            });""")
        # Slow: coarser at once. Quick: finer after four in a row; else it stays.
        self.assertEqual(levels, [0, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2])
        self.assertTrue(coarsest)
        self.assertEqual(waits, [4, 8, 16])

    def test_the_quality_follows_what_the_processor_takes_where_it_draws(self):
        self.open_on(DESK)
        levels = self.module("quality.js", """
            return [[true, 60], [true, 12], [false, 60]].map(([software, cost]) => {
              const quality = new module.Quality(() => {}, software);
              const levels = [quality.level];
              let now = 0;
              for (const frame of [17, 17, 60]) {
                for (let k = 0; k < 16; ++k) {
                  if (quality.asks()) quality.cost(cost);
                  quality.frame((now += frame), true);
                }
                levels.push(quality.level);
              }
              return levels;
            });""")
        # No coarser than saves the processor something, unless frames are slow as well.
        self.assertEqual(levels, [[2, 3, 3, 4], [2, 2, 2, 3], [0, 0, 0, 1]])

    def fold(self):
        self.browser.execute_script(
            "for (const each of document.querySelectorAll('details')) each.open = false;")

    def test_all_controls_have_names(self):
        page = self.open_on(PHONE)
        page.take()
        page.click("panel-open")
        self.browser.execute_script(
            "for (const each of document.querySelectorAll('details')) each.open = true")

        def controls():
            nodes = self.browser.execute_cdp_cmd("Accessibility.getFullAXTree", {})["nodes"]
            return [node for node in nodes if not node["ignored"] and node["role"]["value"] in
                    ("button", "slider", "combobox", "checkbox", "textbox", "image")]

        live.until(lambda: len(controls()) > 25, "all are there")
        for node in controls():
            self.assertTrue(node.get("name", {}).get("value", "").strip(), node)

    def violations(self, axe):
        """What axe-core finds, of any severity: [impact, rule, elements] each."""
        self.browser.execute_script(f"if (!window.axe) {{ {axe} }}")
        return self.browser.execute_async_script(
            "const done = arguments[0]; axe.run(document).then(({violations}) => done("
            "violations.map((v) => [v.impact, v.id, v.nodes.map((n) => [n.target, "
            "n.failureSummary])])))")

    def test_axe_finds_nothing(self):
        axe = axe_core()
        if axe is None:
            self.skipTest("left out: no axe-core; npm does not reach its registry")
        for size in (PHONE, TABLET, DESK):
            page = self.open_on(size)
            page.stand_in("press on the table", 0.9)
            page.until(lambda s: s["drawn"]["forceArrows"] > 0, "something pushes")
            for dark in (False, True):
                if (page.state()["theme"] == "dark") != dark:
                    page.click("theme")
                with self.subTest("closed", size=size, dark=dark):
                    self.assertEqual(self.violations(axe), [])
                page.take()
                if page.shown("panel-open"):
                    page.click("panel-open")
                self.browser.execute_script(
                    "for (const each of document.querySelectorAll('details')) each.open = true")
                with self.subTest("all open", size=size, dark=dark):
                    self.assertEqual(self.violations(axe), [])
                for name in ("bodies", "joints", "charts", "events", "now"):
                    with self.subTest(name, size=size, dark=dark):
                        page.click(f"tab-{name}")
                        page.draws()
                        self.assertEqual(self.violations(axe), [])
                        if size[2]:
                            self.assertEqual(self.browser.execute_script(SMALLEST), [])
                self.fold()
                page.press("?")
                with self.subTest("help", size=size, dark=dark):
                    self.assertTrue(page.shown("help"))
                    self.assertEqual(self.violations(axe), [])
                page.press(Keys.ESCAPE)
                if page.shown("panel-open"):
                    page.click("panel-open")
                page.release()
            page.click("theme")
        self.browser.execute_script("document.body.append(new Image())")
        self.assertIn("image-alt", [rule for _, rule, _ in self.violations(axe)], "it looks")


class Buttons(OwnProgram):
    def test_the_scene_with_the_most_of_them_fits(self):
        self.resize(*PHONE)
        page = self.open(self.start(live.scene("bin_picking")))
        page.until(lambda s: page.shown("add-box"), "boxes")
        self.assertEqual(self.browser.execute_script(SMALLEST), [])
        page.click("show-menu")
        self.assertTrue(page.shown("force-scale"))
        self.assertEqual(self.browser.execute_script(SMALLEST), [])
