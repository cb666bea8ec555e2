# SPDX-License-Identifier: BSD-3-Clause
"""The page of a run: what it shows, and how it is steered."""

import os
import re
import subprocess

import live
from cases import FromTheBeginning, OwnProgram, by_the_clock
from live import SCENE, Page, listening, stop_program
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By


class LiveView(FromTheBeginning):
    """Each test finds the run paused at its beginning."""

    def test_draws_the_scene(self):
        self.draw_pixels()
        state = self.open(self.url).draws()
        self.assertGreater(state["partsInScene"], 10)
        self.page.choose("show-robot", "parts")
        self.page.until(lambda s: s["drawn"]["parts"] == s["partsInScene"], "each part is drawn")
        pixels = self.browser.execute_script("return window.repel.pixels()")
        self.assertGreater(pixels["width"] * pixels["height"], 400 * 400)
        self.assertGreater(max(pixels["variance"][:3]), 100, "the canvas is blank")

    def test_it_is_found_out_that_the_processor_draws(self):
        smooth = self.browser.execute_script("""
            const gl = document.getElementById("canvas").getContext("webgl2");
            return gl.getContextAttributes().antialias;""")
        self.assertFalse(smooth, "smooth edges are for a graphics card")
        self.assertGreater(self.page.state()["quality"], 0)

    def test_where_the_processor_draws_light_at_corners_looks_the_same(self):
        self.draw_pixels()
        self.open(self.url).draws()
        self.page.stands()
        found = self.module("vendor/three.min.js", """
            const shadows = document.getElementById("show-shadows");
            shadows.click();
            const corners = repel.pixels();
            const hook = delete module.MeshLambertMaterial.prototype.onBeforeCompile;
            shadows.click();
            repel.pixels();  // a change of shadows compiles again
            shadows.click();
            return {corners, pixels: repel.pixels(), hook};""")
        self.assertTrue(found["hook"])
        for name, within in (("mean", 0.1), ("variance", 5)):
            for one, other in zip(found["corners"][name], found["pixels"][name]):
                self.assertAlmostEqual(one, other, delta=within)
        self.has_no_errors()

    def test_ticks_and_time_advance(self):
        before = self.page.state()
        self.page.run()
        after = self.page.until(lambda s: s["tick"] > before["tick"] + 100, "ticks pass")
        self.assertGreater(after["time_s"], before["time_s"])
        self.page.until(lambda s: s["historyLength"] > 100, "they are remembered")

    def test_the_script_shows_pushes_with_names(self):
        page = self.page
        page.stand_in("press on the table", 0.9)
        page.until(lambda s: s["drawn"]["forceArrows"] > 0 and s["drawn"]["threads"] > 0,
                   "something pushes")
        page.until_text("hardest", r"\w+ – \w+ [\d.]+ N")
        page.until_text("pushes", r"^(the tool is|the links are) pushed by \d+ bod")

    def test_what_pushes_links_is_counted_beside_what_pushes_the_tool(self):
        said = self.module("state.js", """
            const groups = ["obstacle", "obstacle", "tool", "link", "link", "obstacle"];
            const was = module.state.scene;
            module.state.scene = {
              parts: groups.map((group, k) => ({group, body: k < 2 ? 0 : k,
                                                arm: group === "obstacle" ? -1 : 0})),
              pairs: [[2, 0], [2, 1], [3, 0], [3, 5], [4, 5], [2, 4]]};
            const force = (...forces) => {
              const {tool, links, hardest} =
                module.pushes(forces.map((f, i) => ({i, f})));
              return [tool, links, hardest?.i ?? null];
            };
            const all = [force(0, 0, 0), force(3, 4, 0), force(0, 0, 5), force(0, 0, 1, 2, 3),
                         force(0, 0, 0, 0, 0, 7), force(9, 0, 1), force(0.01)];
            module.state.arm = 1;  // which nothing pushes
            all.push(force(9, 9, 9, 9, 9, 9));
            module.state.arm = 0;
            module.state.scene = was;
            return all;""")
        self.assertEqual(said, [[0, 0, None], [2, 0, 1], [0, 1, 2], [0, 2, 4], [1, 1, 5],
                                [1, 1, 0], [0, 0, None], [0, 0, None]])
        said = self.module("words.js", "return [[0, 0], [1, 0], [0, 2], [2, 1]].map("
                                       "(each) => module.pushesInWords(...each))")
        self.assertEqual(said, ["nothing pushes", "the tool is pushed by 1 body",
                                "the links are pushed by 2 bodies",
                                "the tool is pushed by 2 bodies, links by 1 body"])

    def test_every_module_that_a_scene_can_have_is_told_in_words(self):
        schema = subprocess.run([live.TELEOP, "check", "--schema"], check=True,
                                capture_output=True, text=True).stdout
        kinds = sorted(set(re.findall(r'"module":\s*\{\s*"const":\s*"(\w+)"', schema)))
        self.assertGreater(len(kinds), 15)
        told = self.module("module_words.js", "return module.kinds()")
        self.assertEqual(sorted(told), kinds)
        words = self.module("module_words.js", "return args[0].map(module.moduleWords)", kinds)
        for kind, each in zip(kinds, words):
            self.assertNotIn("_", each["name"], kind)
            self.assertRegex(each["what"], r"^[A-Z].*\.$", kind)
        self.assertEqual(len({each["name"] for each in words}), len(kinds))
        label = self.browser.find_element(By.CSS_SELECTOR, "#energy b")
        self.browser.execute_script("arguments[0].focus()", label)
        self.page.until_text("energy-what", r"^\w+: [A-Z].*\.$")

    def test_the_axis_of_the_distance_keeps_what_matters(self):
        self.page.steps(200)
        self.page.until(lambda s: s["historyLength"] > 100, "there is a curve")
        span = live.until(lambda: self.browser.execute_script("return repel.distanceSpan()"),
                          "it is drawn")
        self.assertGreaterEqual(span["high"], 20)
        self.assertLess(span["low"], 0)
        # With something 300 mm away the last 20 mm have more than half of the height.
        places = self.module("strips.js", "return [-0.7, 0, 20, 300].map(module.bent)")
        self.assertGreater((places[2] - places[0]) / (places[3] - places[0]), 0.5)
        self.assertEqual(places, sorted(places))
        strip = self.browser.find_element(By.ID, "distance-strip")
        ActionChains(self.browser).move_to_element(strip).perform()
        self.page.until_text("distance-at", r"^(nothing near|[−\d.]+ mm), \d+\.\d\d s ago$")

    def test_files_come_compressed_all_at_once_and_once_only(self):
        sizes = "return performance.getEntriesByType('resource').map((each) => " \
                "[each.name, each.transferSize, each.decodedBodySize, each.initiatorType])"
        self.browser.execute_cdp_cmd("Network.clearBrowserCache", {})
        self.open(self.url)
        first = self.browser.execute_script(sizes)
        sent, whole = (sum(each[k] for each in first) for k in (1, 2))
        self.assertLess(sent, whole / 3)
        names = {os.path.relpath(each[0], self.url) for each in first if each[0].endswith(".js")}
        with open(os.path.join(live.ROOT, "backends", "visual", "page", "index.html"),
                  encoding="utf-8") as file:
            text = file.read()
        linked = set(re.findall(r'modulepreload" href="([^"]+)"', text)) | {"main.js"}
        self.assertEqual({os.path.basename(each) for each in names},
                         {os.path.basename(each) for each in linked})
        self.browser.refresh()
        self.page.connects()
        again = self.browser.execute_script(sizes)
        self.assertEqual(len(again), len(first))
        self.assertLess(sum(each[1] for each in again), sent / 4)

    def test_pause_stops_and_step_goes_one_tick(self):
        page = self.page
        page.run()
        page.click("pause")
        tick = page.stands()["tick"]
        page.click("step-1")
        page.until(lambda s: s["tick"] == tick + 1, "one tick")
        page.press(".")
        page.until(lambda s: s["tick"] == tick + 2, "one tick by key")
        page.click("step-10")
        page.until(lambda s: s["tick"] == tick + 12, "ten ticks")
        self.assertEqual(page.stands()["tick"], tick + 12)
        page.press(" ")
        page.until(lambda s: s["running"] and s["tick"] > tick + 12, "it goes on")

    def test_restart_begins_again(self):
        page = self.page
        page.stand_in("slide on the table", 1.5)
        page.take()
        page.click("restart")
        page.until(lambda s: s["running"] and s["operator"]["by"] == "script", "it runs")
        # Seen at its beginning, however late one looks.
        page.stand_in("slide on the table", 1.5)
        self.browser.execute_script("document.getElementById('restart').click();"
                                    "repel.send({type: 'pause'}); repel.send({type: 'step', "
                                    "ticks: 1});")
        page.until(lambda s: not s["running"] and s["time_s"] < 0.1, "it restarts")

    @by_the_clock
    def test_keys_take_the_controls_and_move_the_tool(self):
        page = self.page
        before = page.hold("r", lambda s: s["operator"]["you"], "the controls are ours")
        self.assertEqual(before["operator"]["by"], "page")
        page.run()
        self.moves("r", 2, 0.03, "the tool goes up")
        page.click("view-front")  # looks towards -x: left is -y, away is -x
        self.moves("a", 1, -0.03, "it goes to the left")
        self.moves("w", 0, -0.02, "it goes away from us")

    def moves(self, key, axis, by, what):
        """Holds a key until the tool has moved so far from where it is."""
        before = self.page.state()["toolPosition"][axis]
        self.page.hold(key, lambda s: (s["toolPosition"][axis] - before) / by > 1, what)

    def test_driven_into_the_table_it_is_pushed(self):
        page = self.page
        page.take()
        state = page.hold("f", lambda s: s["drawn"]["forceArrows"] > 0 and s["force"][2] > 10,
                          "the table pushes up", page.steps_until)
        self.assertGreater(state["drawn"]["threads"], 0)
        page.until_text("hardest", r"\w+ – table [\d.]+ N")
        deepest = page.state()["toolPosition"][2]
        page.hold("r", lambda s: s["toolPosition"][2] > deepest + 0.05, "it comes off again",
                  page.steps_until)

    @by_the_clock
    def test_the_tool_is_dragged_by_its_handle(self):
        page = self.page
        page.take()
        page.click("view-top")
        page.click("follow")  # the tool is in the middle of the picture
        before = page.draws()["toolPosition"]
        canvas = self.browser.find_element(By.ID, "canvas")
        drag = ActionChains(self.browser, duration=50)
        drag.move_to_element(canvas).click_and_hold().move_by_offset(0, -120).perform()
        page.run()
        page.drives(lambda s: max(abs(s["toolPosition"][k] - before[k]) for k in (0, 1)) > 0.02,
                    "the tool follows")
        ActionChains(self.browser).release().perform()

    def drives(self, prepare, what):
        """Whether a made-up device that is pushed away from the user moves the tool along -x."""
        page = self.page
        self.browser.execute_script(prepare)
        page.click("view-front")  # looks towards -x
        before = page.state()["toolPosition"]
        page.take()
        page.run()
        page.drives(lambda s: s["toolPosition"][0] < before[0] - 0.02, what)

    @by_the_clock
    def test_a_gamepad_drives(self):
        self.drives("""navigator.getGamepads = () => [
            {connected: true, id: "Test pad (0)", axes: [0.05, -1, 0, 0], buttons: []}]""",
                    "the stick moves the tool")
        self.browser.execute_script("document.getElementById('devices').open = true")
        self.page.until_text("gamepad-name", "Test pad")

    @by_the_clock
    def test_a_space_mouse_drives_and_its_button_is_a_clutch(self):
        # In place of the browser's, before the page looks for it.
        self.before_pages("""
            const heard = [];
            const mouse = {vendorId: 0x256f, productName: "Test mouse", opened: true,
                           addEventListener: (_, listener) => heard.push(listener)};
            const hid = {getDevices: async () => [mouse], addEventListener: () => {}};
            Object.defineProperty(navigator, "hid", {value: hid});
            window.report = (reportId, ...values) => {
              const data = new DataView(new ArrayBuffer(2 * values.length));
              values.forEach((value, k) => data.setInt16(2 * k, value, true));
              for (const listener of heard) listener({reportId, data});
            };""")
        self.page = Page(self.browser, self.url)
        self.page.begin()
        self.drives("window.pushing = setInterval(() => report(1, 0, -350, 0), 20)",
                    "pushed away from the user it moves the tool")
        self.browser.execute_script("report(3, 1); report(3, 0);")
        self.page.pause()
        before = self.page.steps(400)["toolPosition"]  # it comes to rest
        after = self.page.steps(280)["toolPosition"]
        for k in range(3):
            self.assertAlmostEqual(before[k], after[k], delta=0.003, msg="the clutch is open")

    @by_the_clock
    def test_the_lever_pushes_the_tool(self):
        page = self.page
        page.click("view-front")
        before = page.hold("m", lambda s: s["operator"]["you"], "the controls are ours")
        page.run()
        page.hold("m", lambda s: s["toolPosition"][0] < before["toolPosition"][0] - 0.02,
                  "it pushes away from us")

    def test_a_hidden_page_falls_silent_and_loses_the_controls(self):
        page = self.page
        page.take()
        page.run()
        self.browser.execute_script("""
            const banners = document.getElementById("banners");
            window.silences = [];
            new MutationObserver(() =>
              silences.push([repel.state().operator.silent, banners.textContent]))
              .observe(banners, {childList: true});
            Object.defineProperty(document, 'hidden', {value: true, configurable: true});
            document.dispatchEvent(new Event('visibilitychange'));""")
        page.until(lambda s: not s["operator"]["you"], "the controls are free again")
        silences = self.browser.execute_script("return silences")
        self.assertTrue(any(silent and "silent" in text for silent, text in silences), silences)
        self.browser.execute_script(
            "delete document.hidden; document.dispatchEvent(new Event('visibilitychange'));")
        page.until_said("toasts", "hidden")

    @by_the_clock
    def test_a_second_page_is_refused_and_gets_them_when_the_first_closes(self):
        first = self.page
        first.take()
        self.browser.switch_to.new_window("window")
        self.save_time()
        second = Page(self.browser, self.url)
        try:
            # Two windows: that of the first is not hidden, or it would fall silent.
            second.click("take")
            live.until(lambda: second.said("toasts")[1:] or second.state()["operator"]["you"],
                       "it is answered")
            self.assertFalse(second.state()["operator"]["you"])
            second.until_said("toasts", "No controls: ")
            self.browser.switch_to.window(first.handle)
            self.browser.close()
            self.browser.switch_to.window(second.handle)
            second.until(lambda s: s["operator"]["by"] != "page", "they are free")
            second.take()
        finally:
            self.page = second

    def test_light_and_dark(self):
        page = self.page
        self.assertEqual(page.state()["theme"], "light")
        light = self.browser.execute_script("return getComputedStyle(document.body).color")
        page.click("theme")
        page.until(lambda s: s["theme"] == "dark", "it is dark")
        self.assertNotEqual(
            light, self.browser.execute_script("return getComputedStyle(document.body).color"))
        page.click("theme")
        page.until(lambda s: s["theme"] == "light", "it is light again")

    def test_levels_and_zones_are_shown_on_request(self):
        page = self.page
        self.assertEqual(page.state()["drawn"]["levels"], 0)
        page.choose("show-levels", "all")
        page.choose("show-zones", "all")
        drawn = page.until(lambda s: s["drawn"]["levels"] > 0, "levels are seen")["drawn"]
        self.assertEqual(drawn["levels"], drawn["parts"])
        self.assertGreaterEqual(drawn["zones"], 8)

    def test_help_opens_and_closes(self):
        self.page.press("?")
        dialog = self.browser.find_element(By.ID, "help")
        self.assertTrue(dialog.is_displayed())
        self.page.press("?")
        dialog.find_element(By.CSS_SELECTOR, "button").click()
        self.assertFalse(dialog.is_displayed())

    def test_nothing_comes_from_elsewhere(self):
        names = self.browser.execute_script(
            "return performance.getEntriesByType('resource').map((entry) => entry.name)")
        self.assertGreater(len(names), 10)
        for name in names:
            self.assertTrue(name.startswith(self.url), name)


class LostConnection(OwnProgram):
    def test_says_so_and_comes_back(self):
        program, url = listening(SCENE)
        try:
            page = self.open(url)
        finally:
            stop_program(program)
        page.until(lambda s: not s["connected"], "the connection is lost")
        page.until_text("banners", "No connection")
        program, _ = listening(SCENE, port=int(url.rstrip("/").rsplit(":", 1)[1]))
        self.addCleanup(stop_program, program)
        page.until(lambda s: s["connected"] and s["tick"] is not None, "it is back")
        # On a busy machine the new program may have a banner of its own.
        self.assertNotIn("No connection", page.text("banners"))
