# SPDX-License-Identifier: BSD-3-Clause
"""The page as an instrument: bodies, joints, charts, events, the tape, links, the tour."""

import live
from cases import FromTheBeginning, OwnProgram, SharedReplay
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By

# A point of the world, as an offset from the middle of the canvas [px].
WHERE = """
    const [x, y] = window.repel.project(arguments[0]);
    const {clientWidth: width, clientHeight: height} = document.getElementById("canvas");
    return [Math.round(x * width / 2), Math.round(-y * height / 2)];"""


class Instrument(FromTheBeginning):
    def tab(self, name):
        self.page.click(f"tab-{name}")
        self.assertTrue(self.page.shown(f"pane-{name}"))

    def click_at(self, point):
        """Clicks in the scene where a point of the world is seen."""
        x, y = self.browser.execute_script(WHERE, point)
        ActionChains(self.browser).move_to_element_with_offset(
            self.element("canvas"), x, y).click().perform()

    def rows(self, name, tag):
        return self.element(name).find_elements(By.TAG_NAME, tag)

    def test_a_click_on_the_tool_shows_it_closely(self):
        self.page.step_to(1)
        self.page.click("follow")
        self.page.draws()
        x, y, z = self.page.state()["toolPosition"]
        self.click_at([x, y, z + 0.1])  # between the fingers there is nothing
        state = self.page.until(lambda s: s["inspected"], "a body is chosen")
        self.assertIn("tool", self.page.text("inspect-what"), state["inspected"])
        self.page.until_text("inspect-pose", r"^−?\d+\.\d, −?\d+\.\d, −?\d+\.\d mm$")
        self.assertRegex(self.page.text("inspect-law"), r"wall: from \d+ mm on, \d+ N at the surface")
        self.page.click("inspect-close")
        self.assertFalse(self.page.shown("inspect"))

    def test_bodies_are_found_by_name_hidden_and_shown(self):
        self.page.step_to(0.1)
        drawn = self.page.draws()["drawn"]["parts"]
        self.tab("bodies")
        everything = len(self.rows("tree", "li"))
        self.element("tree-find").send_keys("table")  # of which a, b and t are keys of the page
        self.assertEqual(self.element("tree-find").get_property("value"), "table")
        state = self.page.state()
        self.assertFalse(state["running"])
        self.assertFalse(state["operator"]["you"], "what is written drives nothing")
        (row,) = self.rows("tree", "li")
        row.find_element(By.TAG_NAME, "input").click()
        self.page.until(lambda s: s["drawn"]["parts"] == drawn - 1, "the table is not drawn")
        row.find_element(By.TAG_NAME, "button").click()
        self.page.until(lambda s: s["inspected"] == "table", "it is chosen")
        self.page.choose("tree-find", "no such thing")
        self.assertEqual(self.rows("tree", "li"), [])
        self.assertEqual(self.page.text("tree-left"), "none of that name")
        self.page.choose("tree-find", "")
        self.assertEqual(len(self.rows("tree", "li")), everything)
        self.page.click("tree-all")
        self.page.until(lambda s: s["drawn"]["parts"] == drawn, "and is drawn again")

    def test_a_link_is_hidden_with_its_looks(self):
        self.page.step_to(0.1)
        drawn = self.page.draws()["drawn"]["visuals"]
        self.tab("bodies")
        self.page.choose("tree-find", "link_2")
        (row,) = self.rows("tree", "li")
        row.find_element(By.TAG_NAME, "input").click()
        self.page.until(lambda s: s["drawn"]["visuals"] == drawn - 1, "it is not drawn")
        self.page.click("tree-all")
        self.page.until(lambda s: s["drawn"]["visuals"] == drawn, "and is drawn again")

    def test_joints_are_shown_between_their_ends(self):
        self.page.step_to(1)
        self.tab("joints")
        rows = self.rows("joint-rows", "tr")
        self.assertEqual(len(rows), 6)
        live.until(lambda: "°" in rows[0].text, "the first one turns", lambda: rows[0].text)
        share = self.browser.execute_script("return parseFloat(arguments[0].style.left)",
                                            rows[1].find_element(By.CSS_SELECTOR, ".mark"))
        self.assertTrue(0 < share < 100, share)

    def test_signals_are_drawn_held_and_taken_away(self):
        self.tab("charts")
        self.page.until(lambda s: s["charts"]["names"] == [["force_n"], ["nearest_m"]],
                        "two charts at first")
        self.page.click("chart-add")
        choices = self.browser.find_elements(By.CSS_SELECTOR, "#charts select")
        self.browser.execute_script(
            "arguments[0].value = 'tau2_nm'; arguments[0].dispatchEvent(new Event('change'))",
            choices[2])
        self.page.steps(200)
        self.page.until(lambda s: s["charts"]["names"][2:] == [["tau2_nm"]] and
                        s["charts"]["points"] > 2, "a third one has values")
        self.page.click("chart-pause")
        held = self.page.until(lambda s: s["charts"]["paused"], "it is held")["charts"]["points"]
        self.page.steps(200)
        self.assertEqual(self.page.state()["charts"]["points"], held)
        self.page.click("chart-add")
        self.assertTrue(self.page.state()["charts"]["paused"], "one that comes is held, too")
        saved = self.page.saved("#charts button", "CSV", 2)
        head, *rows = saved.splitlines()
        self.assertEqual(head, "time_s,tau2_nm")
        self.assertGreater(len(rows), 2)
        self.assertRegex(rows[-1], r"^[\d.]+,-?[\d.]+$")

    def test_what_happens_is_listed_with_its_time(self):
        self.page.stand_in("press on the floor plate", 5)
        self.tab("events")
        self.page.until(lambda s: s["events"] > 0, "phases of the script are events")
        self.assertIn("press on the floor plate", self.page.text("events"))
        self.page.click("events-clear")
        self.assertTrue(self.page.shown("events-none"))

    def test_the_tape_measures_between_two_clicks(self):
        self.page.step_to(0.1)
        self.page.click("view-top")
        self.page.click("measure")
        self.page.draws()
        tool = self.page.state()["toolPosition"]
        self.click_at(tool)
        self.page.until(lambda s: len(s["measured"]) == 1, "one end")
        self.click_at([tool[0] + 0.1, tool[1] + 0.15, tool[2]])  # the table, beside it
        ends = self.page.until(lambda s: len(s["measured"]) == 2, "two ends")["measured"]
        self.assertAlmostEqual(ends[0][0], tool[0], delta=0.1)
        self.page.until_text("labels", r"mm \(x")
        self.page.press("\ue00c")  # Escape
        self.page.until(lambda s: s["measured"] == [], "none is left")

    def test_arrow_keys_go_through_the_pages(self):
        self.element("tab-now").send_keys("\ue014")  # right
        self.assertTrue(self.page.shown("pane-bodies"))
        self.element("tab-bodies").send_keys("\ue012\ue012")
        self.assertTrue(self.page.shown("pane-now") or self.page.shown("pane-events"))

    def test_a_link_has_camera_page_and_charts(self):
        self.browser.execute_script("repel.look([2, -1, 1], [0.2, 0, 0.4])")
        self.tab("charts")
        self.page.until(lambda s: s["charts"]["names"], "charts are there")
        self.tab("bodies")
        table, box = (next(row for row in self.rows("tree", "li") if row.text == name)
                      for name in ("table", "box"))
        table.find_element(By.TAG_NAME, "button").click()
        box.find_element(By.TAG_NAME, "input").click()
        self.tab("charts")
        self.page.click("share")
        live.until(lambda: "camera" in self.browser.current_url, "it is in the address",
                   lambda: self.browser.current_url)
        link = self.browser.current_url
        self.browser.get("about:blank")
        page = self.open(link)
        state = page.until(lambda s: abs(s["camera"]["position"][0] - 2) < 0.01, "the same camera")
        self.assertAlmostEqual(state["camera"]["position"][1], -1, delta=0.01)
        self.assertTrue(page.shown("pane-charts"))
        self.assertEqual(state["inspected"], "table")
        page.click("tab-bodies")
        (box,) = (row for row in self.rows("tree", "li") if row.text == "box")
        self.assertFalse(box.find_element(By.TAG_NAME, "input").is_selected())

    def test_late_ticks_are_not_called_ok(self):
        self.browser.execute_async_script("""
            const done = arguments[0];
            import("./state.js").then(({state}) => {
              Object.defineProperty(state, "timing", {get: () => ({misses: 3, ticks: 9,
                edges_us: [], compute_us: {}, late_us: {max: 0}}), set: () => {}});
              done();
            });""")
        self.page.steps(40)
        self.page.until_text("status", "^3 ticks were late")

    def test_the_tour_can_be_taken_and_skipped(self):
        self.assertFalse(self.page.shown("tour"), "one has been here")
        self.forget(self.been_here)
        page = self.open(self.url)
        page.until(lambda _: page.shown("tour"), "it is offered at the first visit")
        page.click("tour-next")
        page.until_text("tour-text", "^1 of ")
        page.click("tour-next")
        page.until_text("tour-text", "^2 of .* controls")
        page.take()
        page.steps(40)
        page.until_text("tour-text", "^3 of ")  # what it asked for was done
        page.click("tour-skip")
        self.assertFalse(page.shown("tour"))
        self.browser.refresh()
        page.connects()
        self.assertFalse(page.shown("tour"), "it is offered once")


class Meshes(OwnProgram):
    def test_the_pieces_of_a_mesh_are_one_body(self):
        page = self.open(self.start(live.scene("glove_box_mesh")))
        page.click("tab-bodies")
        rows = self.element("tree").find_elements(By.TAG_NAME, "small")
        self.assertTrue(any(int(row.text) > 1 for row in rows), "one body of several parts")


class ReplayedEvents(SharedReplay):
    def test_a_click_on_an_event_goes_there(self):
        page = self.open(self.url)
        if page.state()["mode"] != "replay":
            self.skipTest("this server runs a scene")
        page.click("tab-events")
        page.run()
        page.until(lambda s: s["time_s"] > 3 and s["events"] > 1, "something has happened")
        first = self.element("events").find_elements(By.TAG_NAME, "button")[-1]
        time = float(first.text.split(" s")[0])
        events = page.state()["events"]
        self.browser.execute_script("arguments[0].click()", first)
        page.until(lambda s: not s["running"] and abs(s["time_s"] - time) < 0.02, "it is there")
        self.assertEqual(page.state()["events"], events, "one can go to another")

    def test_a_jump_ahead_leaves_a_gap_in_the_charts(self):
        """What every tick told on the way there is of its own time, not of where one arrives."""
        page = self.open(self.url)
        if page.state()["mode"] != "replay":
            self.skipTest("this server runs a scene")
        page.click("tab-charts")
        for time in (0.1, 4.2):
            page.say("pause")
            page.say("seek", time_s=time)
            page.until(lambda s, at=time: abs(s["time_s"] - at) < 0.02, f"it is at {time} s")
        force = page.until(lambda s: s["force"], "there is one")["force"]
        saved = page.saved("#charts button", "CSV")
        rows = [line.split(",") for line in saved.splitlines()[1:]]
        self.assertAlmostEqual(float(rows[-1][0]), 4.2, delta=0.02)
        self.assertAlmostEqual(float(rows[-1][1]), sum(x * x for x in force) ** 0.5, delta=20.0)


class Camera(OwnProgram):
    def test_the_image_of_a_depth_camera_is_shown(self):
        page = self.open(self.start(live.scene("seen")))
        page.until(lambda _: page.shown("depth-card"), "there is an image")
        self.assertRegex(page.text("depth-text"), r"^camera: \d\.\d\d to \d+\.\d\d m$")
        several = self.browser.execute_script("""
            const canvas = document.getElementById("depth");
            const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            return new Set(data.filter((_, k) => k % 4 === 0)).size;""")
        self.assertGreater(several, 5, "near and far")
