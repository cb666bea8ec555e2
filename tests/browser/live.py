# SPDX-License-Identifier: BSD-3-Clause
"""The program, the browser, and the page of the live view in it."""

import os
import re
import subprocess
import time

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TELEOP = os.path.join(ROOT, "build", "release", "bin", "teleop")
URL = None  # of a server that is running already
# For what should happen at once, on a machine that draws in software and is shared [s].
PATIENCE = 60
BURST = 40  # ticks in 0.1 s: until then a page that drives may be unheard

# What the page said, which may be gone before somebody looks.
RECORD = """
    if (window.said) return;
    window.said = {};
    for (const name of ["banners", "toasts"]) {
      const place = document.getElementById(name);
      const texts = window.said[name] = [place.textContent];
      new MutationObserver(() => texts.push(place.textContent))
        .observe(place, {childList: true, subtree: true, characterData: true});
    }"""
DISTURBED = """
    const done = arguments[0];
    import("./state.js").then(({state}) => done(
      (state.timing?.late_us.max ?? 0) > 45000 ||
      window.said.banners.some((text) => /silent|let go/.test(text)) ||
      window.said.toasts.some((text) => /poses stopped/.test(text))));"""


def scene(name):
    return os.path.join(ROOT, "scenes", f"{name}.yaml")


SCENE = scene("anderson_4x8")


def scene_text(name):
    """The text of a scene, for a file in another folder."""
    with open(scene(name), encoding="utf-8") as file:
        return file.read().replace("../robots", os.path.join(ROOT, "robots"))


def start_browser():
    options = webdriver.ChromeOptions()
    # As on a machine without a graphics card. --use-gl=swiftshader would silently give no WebGL,
    # --use-angle=swiftshader would draw all of the page as only the scene is drawn there.
    for flag in ("--headless=new", "--no-sandbox", "--disable-gpu",
                 "--enable-unsafe-swiftshader", "--window-size=1280,800"):
        options.add_argument(flag)
    options.accept_insecure_certs = True  # that of `--tls self`
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    service = Service("/usr/bin/chromedriver")
    browser = webdriver.Chrome(service=service, options=options)
    browser.set_script_timeout(PATIENCE)
    set_theme(browser, "light")
    return browser


def set_theme(browser, theme):
    """What the system is said to prefer, in this tab."""
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [
        {"name": "prefers-color-scheme", "value": theme}]})


def listening(*arguments, port=0, address="127.0.0.1"):
    """The program and the address it says that it listens on."""
    program = subprocess.Popen(
        [TELEOP, *arguments, "--view", "--listen", f"{address}:{port}"],
        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    for line in program.stderr:
        found = re.search(r"Live view: (https?://\S+)", line)
        if found:
            return program, found.group(1)
    raise RuntimeError(f"{TELEOP} ended with {program.wait()} before it listened")


def run(*arguments):
    """Runs the program to its end, as fast as it goes."""
    subprocess.run([TELEOP, *arguments, "--fast"], stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL, check=True)


def stop_program(program):
    program.terminate()
    program.wait(PATIENCE)
    program.stderr.close()


def until(holds, what, shown=lambda: ""):
    """Waits until something holds, and gives it back."""
    end = time.monotonic() + PATIENCE
    while not (found := holds()):
        if time.monotonic() > end:
            raise AssertionError(f"not within {PATIENCE} s: {what}; {shown()}")
        time.sleep(0.05)
    return found


class Page:
    """The live view in one window."""

    def __init__(self, browser, url, connects=True):
        self.browser = browser
        browser.get(url)
        self.handle = browser.current_window_handle
        browser.execute_script(RECORD)
        if connects:
            self.connects()

    def connects(self):
        self.until(lambda s: s["connected"] and s["tick"] is not None, "it connects")
        self.browser.execute_script(RECORD)

    def state(self):
        return self.browser.execute_script("return window.repel?.state() ?? {connected: false}")

    def until(self, holds, what):
        """The first state that has a property."""
        state = None

        def look():
            nonlocal state
            state = self.state()
            return holds(state)

        until(look, what, lambda: state)
        return state

    def click(self, name):
        self.browser.find_element(By.ID, name).click()

    def shown(self, name):
        return self.browser.find_element(By.ID, name).is_displayed()

    def text(self, name):
        return self.browser.find_element(By.ID, name).text

    def until_text(self, name, pattern):
        """Waits for a text: it is written later than the state changes."""
        until(lambda: re.search(pattern, self.text(name)), f"{name} says {pattern!r}",
              lambda: self.text(name))

    def said(self, name):
        """All that the banners or the toasts have said."""
        return self.browser.execute_script("return window.said[arguments[0]]", name)

    def until_said(self, name, pattern):
        until(lambda: any(re.search(pattern, each) for each in self.said(name)),
              f"{name} say {pattern!r}", lambda: self.said(name))

    def choose(self, name, value, event="input"):
        """Sets an input, as who uses it does."""
        self.browser.execute_script(
            "const [name, value, event] = arguments;"
            "const input = document.getElementById(name);"
            "input[input.type === 'checkbox' ? 'checked' : 'value'] = value;"
            "input.dispatchEvent(new Event(event));", name, value, event)

    def saved(self, buttons, text, k=0):
        """The text of the file that the k-th of these buttons with that text saves."""
        return self.browser.execute_async_script(
            "const [buttons, text, k, done] = arguments;"
            "URL.createObjectURL = (blob) => (blob.text().then(done), '#');"
            "[...document.querySelectorAll(buttons)].filter((each) => each.textContent === text)[k]"
            ".click();", buttons, text, k)

    def draws(self, count=2):
        """Waits for so many more pictures: the last one shows what has been done before."""
        before = self.state()["framesRendered"]
        return self.until(lambda s: s["framesRendered"] >= before + count, "it draws")

    def press(self, key):
        ActionChains(self.browser).send_keys(key).perform()

    def say(self, kind, **more):
        """Tells the program something, whatever the buttons are."""
        until(lambda: self.browser.execute_script("return window.repel.send(arguments[0])",
                                                  {"type": kind, **more}), f"'{kind}' is sent")

    def begin(self):
        """From the beginning, steered by the script, and paused after a tick or two."""
        last = asked = None

        def begins(state):
            nonlocal last, asked
            if last is not None and not state["running"] and state["tick"] == last and \
                    state["operator"]["by"] == "script":
                return True
            # Again, where the run went on before the pause arrived.
            if last is None or time.monotonic() - asked > 5:
                last = 1 if state["tick"] == 0 else 0  # another tick than the one that is seen
                asked = time.monotonic()
                self.browser.execute_script(
                    "for (const each of arguments[0]) repel.send(each)",
                    [{"type": "restart"}, {"type": "pause"}, {"type": "step", "ticks": last + 1}])
            return False

        return self.until(begins, "it begins again")

    def run(self):
        self.say("resume")
        self.until(lambda s: s["running"], "it runs")

    def pause(self):
        self.say("pause")
        return self.stands()

    def stands(self):
        """Waits until it is paused and the last tick, which may be on its way, is seen: that one is
        shown again and again, five times a second."""
        first = None

        def same(state):
            nonlocal first
            if first is None or state["running"] or state["tick"] != first["tick"]:
                first = None if state["running"] else state
                return False
            return state["framesRendered"] >= first["framesRendered"] + 4

        return self.until(same, "it pauses")

    def step_to(self, seconds):
        """From the beginning, of a scene of 400 Hz: a slow machine would be too late to see it."""
        self.say("step", ticks=round(400 * seconds) - self.begin()["tick"])
        return self.until(lambda s: not s["running"] and abs(s["time_s"] - seconds) < 0.01,
                          f"it is at {seconds} s")

    def stand_in(self, phase, seconds):
        """Steps the script to a time in that phase."""
        for _ in range(3):
            state = self.step_to(seconds)
            if state["phase"] == phase:
                return state
            # The loop stood still among the steps, and the script went on by the clock.
        raise AssertionError(f"not in '{phase}', but in '{state['phase']}'")

    def steps(self, ticks):
        """Makes ticks, a few at a time: a page that drives is heard between them."""
        for _ in range(0, ticks, BURST):
            before = self.state()["tick"]
            self.say("step", ticks=BURST)
            state = self.until(lambda s: s["tick"] >= before + BURST, "it makes ticks")
        return state

    def steps_until(self, holds, what):
        """As until(), of a run that is paused. It makes up to 30 s of ticks meanwhile."""
        state = self.state()
        for _ in range(30 * 400 // BURST):
            if holds(state):
                return state
            state = self.steps(BURST)
        raise AssertionError(f"not within 30 s of ticks: {what}; {state}")

    def take(self):
        """Takes the controls; again, where a page that got no time has lost them meanwhile."""
        silences = 0
        self.click("take")

        def ours(state):
            nonlocal silences
            if state["operator"]["you"]:
                return True
            count = sum("silent" in each for each in self.said("banners"))
            if count > silences and state["operator"]["by"] != "page":
                silences = count
                self.click("take")
            return False

        return self.until(ours, "the controls are ours")

    def take_at_the_beginning(self):
        """The controls are ours where the script would begin, and it runs."""
        self.begin()
        self.take()
        self.run()

    def drives(self, holds, what):
        """As until(), while this page drives. Once it does not any more, there is no hope."""
        ours = False

        def look(state):
            nonlocal ours
            lost = ours and not state["operator"]["you"]
            ours = state["operator"]["you"]
            if lost:
                raise AssertionError(f"the controls are lost before {what}")
            return holds(state)

        return self.until(look, what)

    def hold(self, key, holds, what, wait=None):
        """Holds a key down until a property holds."""
        ActionChains(self.browser).key_down(key).perform()
        try:
            return (wait or self.drives)(holds, what)
        finally:
            ActionChains(self.browser).key_up(key).perform()

    def release(self):
        if (self.state()["operator"] or {}).get("you"):
            self.say("release")
            self.until(lambda s: not s["operator"]["you"], "the controls are released")

    def disturbed(self):
        """Whether the machine has made the loop skip ticks, or kept a page that drives from being
        heard, since the run began: then the operator's force was taken away."""
        time.sleep(0.6)  # what the ticks took is told twice a second
        return self.browser.execute_async_script(DISTURBED)
