# SPDX-License-Identifier: BSD-3-Clause
"""A recording that is played."""

import time

from cases import SharedReplay


class Replay(SharedReplay):
    def setUp(self):
        super().setUp()
        if self.open(self.url).state()["mode"] != "replay":
            self.skipTest("this server runs a scene")

    def seek(self, seconds):
        self.page.choose("seek", seconds, "input")
        self.page.choose("seek", seconds, "change")
        return self.page.until(lambda s: abs(s["time_s"] - seconds) < 0.05, f"it is at {seconds} s")

    def test_nobody_can_drive_it(self):
        self.assertFalse(self.page.shown("take"))
        self.page.press("w")
        time.sleep(0.5)
        self.assertFalse(self.page.state()["operator"]["you"])

    def test_it_goes_to_a_time(self):
        self.page.pause()
        self.seek(4.5)
        early = self.seek(1.0)["toolPosition"]
        self.seek(4.0)
        again = self.seek(1.0)["toolPosition"]
        for k in range(3):
            self.assertAlmostEqual(early[k], again[k], delta=1e-3, msg="another place than before")

    def test_a_link_of_a_report_opens_its_moment(self):
        self.page.browser.execute_script("location.hash = '#t=2.5'")
        state = self.page.until(lambda s: not s["running"] and abs(s["time_s"] - 2.5) < 0.01,
                                "it is at the moment of the link")
        self.assertTrue(state["connected"])

    def test_it_has_a_speed(self):
        self.page.pause()
        self.seek(1.0)
        self.page.choose("speed", "0.1", "change")
        self.page.run()
        # A page that gets no time for a while then sees more pass at once.
        shares = []
        while not shares or (len(shares) < 3 and not 0.02 < shares[-1] < 0.3):
            before, started = self.page.state()["time_s"], time.monotonic()
            time.sleep(1.5)
            after = self.page.state()["time_s"]
            shares.append((after - before) / (time.monotonic() - started))
        self.assertTrue(0.02 < shares[-1] < 0.3, f"{shares} seconds a second")
