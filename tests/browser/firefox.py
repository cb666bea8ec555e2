# SPDX-License-Identifier: BSD-3-Clause
"""The page in Firefox."""

import shutil
import unittest

import live
from bidi import Firefox


class InFirefox(unittest.TestCase):
    def setUp(self):
        program = shutil.which("firefox-esr") or shutil.which("firefox")
        if live.URL or not program:
            self.skipTest("left out: Debian's package firefox-esr is not installed")
        self.firefox = Firefox(program)
        self.addCleanup(self.firefox.close)

    def test_it_draws_and_is_driven(self):
        firefox = self.firefox
        program, url = live.listening(live.SCENE)
        self.addCleanup(live.stop_program, program)
        firefox.open(url)
        if not firefox.ask("Boolean(document.createElement('canvas').getContext('webgl2'))"):
            self.skipTest("left out: this Firefox gives no WebGL")
        state = "window.repel?.state() ?? null"
        first = firefox.until(state, lambda s: s and s["framesRendered"] > 2 and s["toolPosition"],
                              "it draws", live.PATIENCE)
        self.assertEqual(first["drawn"]["parts"] > 0, True)
        variance = firefox.ask("window.repel.pixels().variance")
        self.assertGreater(max(variance[:3]), 100, "the canvas is blank")
        firefox.keys({"type": "keyDown", "value": "r"})
        taken = firefox.until(state, lambda s: s["operator"]["you"], "the controls are ours",
                              live.PATIENCE)
        firefox.until(state, lambda s: s["toolPosition"][2] > taken["toolPosition"][2] + 0.03,
                      "the tool goes up", live.PATIENCE)
        firefox.keys({"type": "keyUp", "value": "r"})
        self.assertEqual(firefox.errors, [], "the browser's console has errors")
