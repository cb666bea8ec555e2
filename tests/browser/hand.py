# SPDX-License-Identifier: BSD-3-Clause
"""What the hand feels and switches, and boxes that it brings."""


import live
from cases import OwnProgram, by_the_clock
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys


class Boxes(OwnProgram):
    def test_a_box_is_dragged_in_moved_and_taken_away(self):
        page = self.open(self.start(live.scene("bin_picking")))
        self.assertEqual(page.state()["boxes"], [])
        page.click("view-top")
        page.draws()
        canvas = self.element("canvas")
        button = self.element("add-box")
        bring = ActionChains(self.browser, duration=50)
        bring.move_to_element(button).click_and_hold()
        bring.move_to_element_with_offset(canvas, 90, 90).release().perform()
        page.until(lambda s: len(s["boxes"]) == 1, "the box has come")
        page.press(Keys.DELETE)
        page.until(lambda s: s["boxes"] == [], "the box has gone")
        # One that the camera looks at is dragged from the middle of the picture.
        self.browser.execute_script(
            "repel.send({type: 'add_box', size: [0.1, 0.1, 0.1], position: [0.75, 0.25, 0.4]});"
            "repel.look([0.75, 0.24, 1.4], [0.75, 0.25, 0.4]);")
        before = page.until(lambda s: len(s["boxes"]) == 1, "another has come")["boxes"][0]
        page.draws()
        drag = ActionChains(self.browser, duration=50)
        drag.move_to_element(canvas).click_and_hold().move_by_offset(60, 0).release().perform()
        page.until(lambda s: max(abs(s["boxes"][0][k] - before[k]) for k in (0, 1)) > 0.02,
                   "the box moves")
        page.click("remove-box")
        page.until(lambda s: s["boxes"] == [], "the box has gone")


class Hand(OwnProgram):
    """What the hand feels and can switch."""

    def box(self, where, value):
        return self.browser.find_element(By.CSS_SELECTOR, f"#{where} input[value='{value}']")

    def ticked(self, where):
        """The values of the boxes that are ticked, in their order."""
        boxes = self.browser.find_elements(By.CSS_SELECTOR, f"#{where} input")
        return [box.get_attribute("value") for box in boxes if box.is_selected()]

    def take(self, page):
        page.take()
        page.until(lambda s: not self.element("switches").get_property("disabled"),
                   "its switches can be used")

    @by_the_clock
    def test_fixtures_and_directions_are_switched_by_mouse_and_keyboard(self):
        page = self.open(self.start(live.scene("follow_a_seam")))
        self.assertTrue(page.shown("hand"))
        self.assertTrue(page.shown("fixture-key"))
        self.assertFalse(self.box("fixture-boxes", "seam").is_enabled(), "the script drives")
        page.until(lambda s: s["drawn"]["fixtures"] == 2, "both are drawn")
        page.stand_in("down the cone", 2.5)
        page.until(lambda s: s["hand"]["guides"] == ["way in"] and s["drawn"]["on"] == 1,
                   "the script switches one on")
        page.until(lambda s: self.ticked("fixture-boxes") == ["way in"], "its box says so")
        self.take(page)  # while it stands: the script would go on to switch others
        page.run()
        self.box("fixture-boxes", "seam").click()
        page.until(lambda s: s["hand"]["guides"] == ["way in", "seam"] and s["drawn"]["on"] == 2,
                   "both are on")
        page.press(" ")
        page.until(lambda s: not s["running"], "after a click the space bar pauses")
        page.press(" ")
        page.until(lambda s: s["running"], "it goes on")
        box = self.box("compliant-boxes", "z")
        box.send_keys(Keys.SPACE)
        page.until(lambda s: s["hand"]["compliant"] == ["z"], "it gives way along z")
        self.assertTrue(page.state()["running"], "the space bar was for the box")
        box.send_keys(Keys.SPACE)
        page.until(lambda s: s["hand"]["compliant"] == [], "it is rigid again")
        scale = self.element("hand-scale")
        scale.send_keys(Keys.ARROW_LEFT * 6)
        page.until(lambda s: 0.4 < s["hand"]["scale"] < 0.6, "the scale is finer")
        page.until_text("hand-scale-out", "0\\.5")
        self.assertFalse(page.shown("hand-row"))
        page.release()
        page.until(lambda s: not self.box("fixture-boxes", "seam").is_enabled(), "not any more")
        self.assertEqual(page.state()["hand"]["guides"], ["way in", "seam"], "it stays")

    def test_fixtures_can_be_hidden(self):
        page = self.open(self.start(live.scene("follow_a_seam")))
        page.until(lambda s: s["drawn"]["fixtures"] == 2, "both are drawn")
        page.choose("show-fixtures", False)
        page.until(lambda s: s["drawn"]["fixtures"] == 0, "none is drawn")

    def test_without_anything_to_switch_there_is_no_such_section(self):
        page = self.open(self.start())
        page.draws()
        self.assertTrue(page.shown("felt-lever"))
        for name in ("fixture-box", "hand-row", "felt-force", "fixture-key"):
            self.assertFalse(page.shown(name), name)

    def test_a_master_with_six_axes_shows_its_force_and_torque(self):
        page = self.open(self.start(live.scene("six_axes")))
        page.stand_in("feel it", 7.5)
        page.until(lambda s: page.shown("felt-force"), "there is a force")
        self.assertFalse(page.shown("felt-lever"))
        page.until_text("felt-force", r"[1-9]\d*\.\d\d of \d+ N\n")
        page.until_text("felt-torque", r"\d\.\d\d of [\d.]+ N m\n")

    @by_the_clock
    def test_the_keys_move_the_hand_that_is_chosen(self):
        page = self.open(self.start_with_two_hands())
        page.begin()
        self.take(page)
        self.assertTrue(page.shown("hand-row"))
        # A hand that moves feels its own grip.
        before = page.until(lambda s: s["hand"]["second_grip_n"], "it feels")["toolPosition"]
        page.press("h")
        page.until_text("hand-row", "hand 2")
        self.assertEqual(self.browser.execute_script(
            "return document.getElementById('hand-choice').value"), "second")
        page.run()
        page.hold("r", lambda s: s["toolPosition"][2] > before[2] + 0.01 and
                  abs(s["hand"]["second_grip_n"][2]) > 0.5, "the second hand draws the tool up")
