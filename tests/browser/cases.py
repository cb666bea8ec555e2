# SPDX-License-Identifier: BSD-3-Clause
"""What the tests have in common: one browser, of which each has a tab of its own."""

import functools
import os
import tempfile
import time
import unittest

import live
from selenium.webdriver.common.by import By

# Where the processor draws, that takes nearly all of the time. A page does all that it does, ten
# times a second, but the scene stays white, unless a test counts its pixels.
SELDOM = """
    window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), %d);
    window.cancelAnimationFrame = clearTimeout;"""
WHITE = """
    for (const each of ["clear", "drawArrays", "drawArraysInstanced", "drawElements",
                        "drawElementsInstanced"]) {
      WebGL2RenderingContext.prototype[each] = () => {};
    }"""


# As who has been here before sees it: no tour is offered.
BEEN_HERE = """
    try {
      if (!localStorage.getItem("repel.settings")) {
        localStorage.setItem("repel.settings", '{"toured": true}');
      }
    } catch {
      // A page that is none of ours.
    }"""


class TheBrowser:
    """Started for the first test that wants it, and again after a test that failed in it."""

    def __init__(self):
        self.running = None
        self.spoilt = False

    def get(self):
        if self.spoilt:
            self.quit()
        if self.running is None:
            self.running = live.start_browser()
        return self.running

    def quit(self):
        if self.running is not None:
            self.running.quit()
        self.running = None
        self.spoilt = False


the_browser = TheBrowser()


class Result(unittest.TextTestResult):
    """Says of each test how long it took."""

    began = None  # of the test that runs; none does while a group is set up

    def startTest(self, test):
        super().startTest(test)
        self.began = time.monotonic()

    def stopTest(self, test):
        super().stopTest(test)
        self.began = None

    def say_time(self):
        if self.showAll and self.began is not None:
            self.stream.write(f"{time.monotonic() - self.began:.1f} s, ")

    def addSuccess(self, test):
        self.say_time()
        super().addSuccess(test)

    def addSkip(self, test, reason):
        self.say_time()
        super().addSkip(test, reason)

    def addFailure(self, test, err):
        the_browser.spoilt = True
        self.say_time()
        super().addFailure(test, err)

    def addError(self, test, err):
        the_browser.spoilt = True
        self.say_time()
        super().addError(test, err)

    def addSubTest(self, test, subtest, err):
        the_browser.spoilt = the_browser.spoilt or err is not None
        super().addSubTest(test, subtest, err)


def by_the_clock(test):
    """For a test of what only a machine that keeps time shows. Where it fails, and the loop had to
    skip ticks or a page that drives was not heard, it is repeated, twice at most."""
    @functools.wraps(test)
    def trial(self):
        for _ in range(3):
            try:
                return test(self)
            except AssertionError:
                if not self.page.disturbed():
                    raise
            self.doCleanups()
            self.setUp()
        return self.skipTest("the machine stood still in three runs of three")
    return trial


class InBrowser(unittest.TestCase):
    TURN_MS = 100  # between two turns at which a page draws

    def setUp(self):
        self.browser = browser = the_browser.get()
        old = browser.window_handles
        browser.switch_to.new_window("tab")
        new = browser.current_window_handle
        for each in old:
            browser.switch_to.window(each)
            browser.close()
        browser.switch_to.window(new)
        browser.execute_cdp_cmd("Emulation.setFocusEmulationEnabled", {"enabled": True})
        live.set_theme(browser, "light")
        self.save_time()
        self.been_here = self.before_pages(BEEN_HERE)
        browser.get_log("browser")  # what was said before

    def save_time(self):
        """In the pages of this tab that are opened from now on."""
        self.before_pages(SELDOM % self.TURN_MS)
        self.white = self.before_pages(WHITE)

    def draw_pixels(self):
        """In the pages of this tab that are opened from now on."""
        self.forget(self.white)

    def forget(self, script):
        """One of before_pages()."""
        self.browser.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument",
                                     {"identifier": script})

    def resize(self, width, height, touch=False):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": touch})

    def before_pages(self, script):
        """Runs in each page of this tab that is opened from now on, before its own scripts."""
        return self.browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument",
                                            {"source": script})["identifier"]

    def open(self, url, connects=True):
        """A page with the settings of a new one."""
        self.browser.execute_cdp_cmd("Storage.clearDataForOrigin", {
            "origin": url.split("#")[0].rstrip("/"), "storageTypes": "local_storage"})
        self.page = live.Page(self.browser, url, connects)
        return self.page

    def module(self, name, script, *arguments):
        """What a script returns that has a module of the page as `module`."""
        return self.browser.execute_async_script(
            "const [file, ...args] = arguments; const done = args.pop();"
            f"import(`./${{file}}`).then((module) => done((() => {{ {script} }})()))"
            ".catch((error) => done(String(error)));", name, *arguments)

    def element(self, name):
        return self.browser.find_element(By.ID, name)

    def folder(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        return folder.name

    def has_no_errors(self):
        loud = [line["message"] for line in self.browser.get_log("browser")
                if line["level"] == "SEVERE"]
        self.assertEqual(loud, [], "the browser's console has errors")


class OwnProgram(InBrowser):
    """A program for each test."""

    def setUp(self):
        if live.URL:
            self.skipTest("needs a program of its own")
        super().setUp()

    def start(self, *arguments, **where):
        program, url = live.listening(*(arguments or [live.SCENE]), **where)
        self.addCleanup(live.stop_program, program)
        return url

    def start_with_two_hands(self):
        text = live.scene_text("six_axes")
        one = next(line for line in text.splitlines() if "{module: six_axes" in line)
        two = ("  - {module: six_axes, name: left, to: both}\n"
               "  - {module: six_axes, name: right, hand: second, to: both}\n"
               "  - {module: junction, name: both}")
        scene = os.path.join(self.folder(), "scene.yaml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(text.replace(one, two))
        return self.start(scene)


class SharedProgram(InBrowser):
    """One program for the tests of a group."""

    @classmethod
    def setUpClass(cls):
        cls.program, cls.url = (None, live.URL) if live.URL else cls.start()

    @classmethod
    def start(cls):
        return live.listening(live.SCENE)

    @classmethod
    def tearDownClass(cls):
        if cls.program:
            live.stop_program(cls.program)


class SharedReplay(SharedProgram):
    """The recording of six seconds of the default scene."""

    @classmethod
    def start(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        recording = os.path.join(folder.name, "recording.mcap")
        live.run(live.SCENE, "--seconds", "6", "--log", recording)
        return live.listening("replay", recording)


class FromTheBeginning(SharedProgram):
    """Each test finds the run paused at its beginning."""

    def setUp(self):
        super().setUp()
        if self.open(self.url).state()["mode"] == "replay":
            self.skipTest("this server plays a recording")
        self.page.begin()

    def tearDown(self):
        self.page.release()
        self.has_no_errors()
