# SPDX-License-Identifier: BSD-3-Clause
"""Who reaches the page, and from where."""

import os
import tempfile
from unittest import mock

import live
from cases import OwnProgram, by_the_clock


class Secret(OwnProgram):
    SECRET = "correct+horse/battery=staple"

    def setUp(self):
        super().setUp()
        # How long the page took from when it called until it presented what it knew [ms].
        self.before_pages("""
            const Line = window.WebSocket;
            window.WebSocket = class extends Line {
              #called = performance.now();
              send(text) {
                if (text.includes('"secret"')) window.presented = performance.now() - this.#called;
                super.send(text);
              }
            };""")

    def start_with_secret(self, *where):
        with tempfile.NamedTemporaryFile("w", suffix=".secret") as file:
            file.write(self.SECRET + "\n")
            file.flush()
            return self.start(live.SCENE, "--secret", file.name, *where, address="0.0.0.0")

    def asks(self, page):
        page.until(lambda s: page.shown("secret-form"), "it asks for the secret")

    def gets_in(self, page):
        """It connects: at once, unless the machine let it present the secret after the 2 s that the
        program waits."""
        for _ in range(3):
            page.until(lambda s: s["connected"] or self.took() > 1500, "it presents the secret")
            if self.took() < 1500:
                return page.connects()
            self.browser.refresh()
        return self.skipTest("the machine kept the page waiting in three runs of three")

    def took(self):
        return self.browser.execute_script("return window.presented ?? 0")

    def present(self, page, text):
        self.element("secret").send_keys(text + "\n")

    def test_behind_the_address_it_opens_the_page_and_is_taken_out_of_it(self):
        state = self.enterContext(tempfile.TemporaryDirectory())
        self.enterContext(mock.patch.dict(os.environ, XDG_STATE_HOME=state))
        url = self.start_with_secret("--tls", "self")
        self.assertTrue(url.startswith("https://"))
        page = self.open(f"{url}#secret={self.SECRET}", connects=False)
        self.gets_in(page)
        self.assertEqual(self.browser.current_url, url)
        self.assertFalse(page.shown("secret-form"))
        page.take()
        self.browser.refresh()
        self.gets_in(page)  # this tab still knows it

    def test_without_it_the_page_shows_nothing_and_asks(self):
        page = self.open(self.start_with_secret("--plain"), connects=False)
        self.asks(page)
        self.present(page, "this is the wrong one")
        page.until_text("secret-why", "another")
        self.assertEqual(page.state()["partsInScene"], 0)
        self.asks(page)
        self.present(page, self.SECRET)
        self.gets_in(page)

    def test_a_wrong_one_behind_the_address_can_be_put_right_there(self):
        url = self.start_with_secret("--plain")
        page = self.open(f"{url}#secret=this-is-the-wrong-one", connects=False)
        self.asks(page)
        self.browser.execute_script(f"location.hash = '#secret={self.SECRET}'")
        self.gets_in(page)


class Station(OwnProgram):
    def begin(self, side):
        link = f"udp:127.0.0.1:{20000 + os.getpid() % 20000}"
        scene = live.scene("remote")
        program, url = live.listening(side, scene, "--impaired", "--link", link)
        self.addCleanup(live.stop_program, program)
        return program, url

    @by_the_clock
    def test_it_shows_the_site_and_drives_it_and_says_when_it_is_gone(self):
        page = self.open(self.begin("station")[1])
        page.until_text("status", "the site is silent")
        site, _ = self.begin("site")
        page.until_text("status", "^ok")
        self.assertEqual(page.state()["operator"]["by"], "script")
        before = page.state()["toolPosition"]
        page.hold("r", lambda s: s["operator"]["you"] and
                  s["toolPosition"][2] > before[2] + 0.03, "the tool goes up")
        page.press(" ")
        page.until_said("toasts", "the robot is elsewhere")
        for name in ("restart", "pause", "step-1", "step-10"):
            button = self.element(name)
            self.assertFalse(button.is_enabled(), name)
            self.assertIn("the robot is elsewhere", button.get_attribute("title"))
        site.kill()
        page.until_text("status", "the site is silent")
        here = page.state()
        self.assertTrue(here["connected"] and here["running"])


class LookingOn(OwnProgram):
    def test_a_page_that_may_only_look_on_says_so(self):
        page = self.open(self.start(live.SCENE, "--view-only"))
        self.assertTrue(page.shown("onlooker"))
        self.assertFalse(page.shown("take"))
        for name in ("restart", "pause", "step-1", "step-10"):
            self.assertFalse(self.element(name).is_enabled(), name)
        page.press("w")
        page.until_said("toasts", "You look on")
        page.press(" ")
        before = page.state()["tick"]
        page.until(lambda s: s["running"] and s["tick"] > before + 200, "it goes on")
        self.assertEqual(page.state()["operator"]["by"], "script")


class OtherPlaces(OwnProgram):
    def test_over_ipv6(self):
        page = self.open(self.start(address="[::1]"))
        page.take()

    def test_by_the_name_localhost(self):
        page = self.open(self.start().replace("127.0.0.1", "localhost"))
        page.take()

    def test_on_port_80_which_browsers_leave_out(self):
        try:
            url = self.start(port=80)
        except RuntimeError:
            self.skipTest("port 80 is not free for us")
        page = self.open(url)
        page.take()

    def test_a_page_of_elsewhere_gets_no_line(self):
        own = self.start()
        self.browser.get(self.start())
        code = self.browser.execute_async_script("""
            const done = arguments[1];
            const socket = new WebSocket(arguments[0].replace("http", "ws") + "live");
            socket.onopen = () => done("open");
            socket.onclose = () => done("refused");""", own)
        self.assertEqual(code, "refused")
