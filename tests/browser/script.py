# SPDX-License-Identifier: BSD-3-Clause
"""What the page says of the script."""

import os

import live
from cases import OwnProgram
from live import Page


class Script(OwnProgram):
    def test_it_says_when_it_is_over(self):
        url = self.start(live.scene("empty"))
        page = self.open(url)
        page.begin()
        page.until_text("who", "The script drives")
        page.step_to(4.2)
        page.until_text("phase", "^The script is over$")
        page.until_text("who", "^The script is over$")
        # A page that is opened now has seen nothing of it.
        late = Page(self.browser, url)
        late.until_text("phase", "^The script is over$")
        late.until_text("who", "^The script is over$")
        late.take()
        late.run()
        late.until_text("who", "You drive")
        late.until_text("phase", "^$")
        late.begin()
        late.until_text("who", "^The script drives$")

    def test_a_phase_without_a_name_is_not_the_end(self):
        self.before_pages("""
            const parse = JSON.parse;
            JSON.parse = (text) => {
              const message = parse(text);
              return message?.type === "frame" ? {...message, phase: ""} : message;
            };""")
        page = self.open(self.start(live.scene("empty")))
        page.step_to(1)
        page.until_text("time", r"^(1\.0|0\.99)\d* s$")  # and what else is written with it
        self.assertEqual(page.text("phase"), "")
        self.assertEqual(page.text("who"), "The script drives")
        page.run()
        page.until_text("phase", "^The script is over$")

    def test_a_replay_says_when_it_is_over(self):
        recording = os.path.join(self.folder(), "run.mcap")
        live.run(live.scene("empty"), "--seconds", "6", "--log", recording)
        page = self.open(self.start("replay", recording))
        for seconds, words in ((5, "^The script is over$"), (1, "^move freely$")):
            page.say("pause")
            page.say("seek", time_s=seconds)
            page.until_text("phase", words)

    def test_without_one_it_does_not_say_that_it_is_over(self):
        text = live.scene_text("empty")
        scene = os.path.join(self.folder(), "scene.yaml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(text[:text.index("script:")])
        page = self.open(self.start(scene))
        page.until_text("phase", "^No script plays$")
        page.until_text("who", "^No script plays$")
