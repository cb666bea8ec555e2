# SPDX-License-Identifier: BSD-3-Clause
"""A headset as a master: that of the Immersive Web Emulation Runtime (vendor/iwer.min.js), which
puts its own in the place of the browser's WebXR."""

import hashlib
import math
import os

import live
from cases import FromTheBeginning, InBrowser, OwnProgram, SharedProgram, by_the_clock
from fingers import PHONE, SMALLEST

VENDOR = os.path.join(live.ROOT, "tests", "browser", "vendor")
with open(os.path.join(VENDOR, "iwer.min.js"), encoding="utf-8") as runtime:
    RUNTIME = runtime.read()

# A Quest 3. The runtime calls every position emulated; here `lost` says of which hand it is
# "guessed" or "gone". `calls` has what the page says and where a frame begins, `felt` what the hands
# feel.
EMULATED = RUNTIME + """;
    window.emulated = new IWER.XRDevice(IWER.metaQuest3);
    emulated.installRuntime({forceInstall: true});
    window.lost = {};
    window.calls = [];
    window.felt = [];
    const {getPose, getViewerPose} = XRFrame.prototype;
    let viewed = false;
    XRFrame.prototype.getViewerPose = function (space) {
      viewed = true;
      const {transform, views} = getViewerPose.call(this, space);
      viewed = false;
      calls.push("frame");
      return lost.viewer ? null : {transform, views, emulatedPosition: false};
    };
    XRFrame.prototype.getPose = function (space, base) {
      const pose = getPose.call(this, space, base);
      if (viewed) return pose;
      const source = Object.values(emulated.controllers).map((each) => each.inputSource)
        .find((each) => each.gripSpace === space || each.targetRaySpace === space);
      const how = lost[source?.handedness];
      return how === "gone" ? null
        : {transform: pose.transform, emulatedPosition: how === "guessed"};
    };
    const Line = window.WebSocket;
    window.WebSocket = class extends Line {
      send(text) {
        const {type, linear, angular} = JSON.parse(text);
        if (type === "servo_cv") calls.push(Math.hypot(...linear, ...angular));
        super.send(text);
      }
    };
    for (const {inputSource} of Object.values(emulated.controllers)) {
      const [actuator] = inputSource.gamepad.hapticActuators;
      actuator.pulse = async (strength, ms) => {
        felt.push([strength, ms, Math.hypot(...repel.state().force)]);
      };
    }"""
# Moves something of the room by so much in each 20 ms, in all `count` times.
LEAD = """
    const [what, step, count] = arguments;
    const thing = what === "viewer" ? emulated : emulated.controllers[what];
    let left = count;
    clearInterval(window.leading);
    window.leading = setInterval(() => {
      if (left-- <= 0) return clearInterval(window.leading);
      for (const [k, axis] of ["x", "y", "z"].entries()) thing.position[axis] += step[k];
    }, 20);"""
DOWN, UP, STILL = (0, -0.002, 0), (0, 0.002, 0), (0, 0, 0)


class WithHeadset(InBrowser):
    TURN_MS = 20

    def save_time(self):
        super().save_time()
        self.before_pages(EMULATED)

    def do(self, script, *arguments):
        return self.browser.execute_script(script, *arguments)

    def enter(self, mode="vr"):
        """The state once both hands are seen, and what the first frames have to prepare is."""
        page = self.page
        self.do("document.getElementById(arguments[0]).click()", f"enter-{mode}")
        page.until(lambda s: s["xr"]["mode"] == mode, "it is entered")
        page.draws(20)
        return page.until(lambda s: s["xr"]["mode"] == mode and
                          sorted(s["xr"]["hands"]) == [["left", True], ["right", True]],
                          "both hands are seen")["xr"]

    def button(self, hand, name, value):
        self.do("emulated.controllers[arguments[0]].updateButtonValue(arguments[1], arguments[2])",
                hand, name, value)

    def squeeze(self, hand="right", k=0):
        """Closes the clutch, and takes the controls by it."""
        def holds(state):
            if "stopped" in state["xr"]["why"][k]:  # the machine stood still: again
                self.button(hand, "squeeze", 0)
                self.frames()
                self.button(hand, "squeeze", 1)
            return state["xr"]["held"][k] and state["operator"]["you"]

        self.button(hand, "squeeze", 0)
        self.frames()
        self.button(hand, "squeeze", 1)
        self.page.until(holds, "it is held")

    def let_go(self, hand="right", k=0):
        self.button(hand, "squeeze", 0)
        self.page.until(lambda s: not s["xr"]["held"][k], "it is let go")

    def lead(self, what, step, count=10 ** 6):
        self.do(LEAD, what, step, count)

    def point(self, hand, text):
        """Points at a key of the panel, from 0.2 m in front of it."""
        def points():
            return self.do("""
                const key = repel.keyInRoom(arguments[1]);
                if (!key) return false;
                const {position, quaternion} = emulated.controllers[arguments[0]];
                const {x, y, z} = emulated.position;
                const away = [x - key[0], 0, z - key[2]];
                const far = Math.hypot(...away);
                position.set(key[0] + 0.2 * away[0] / far, key[1], key[2] + 0.2 * away[2] / far);
                const yaw = Math.atan2(away[0], away[2]);
                quaternion.set(0, Math.sin(yaw / 2), 0, Math.cos(yaw / 2));
                return true;""", hand, text)

        live.until(points, f"the panel has a key '{text}'")

    def frames(self, count=2):
        """Waits for so many more, unless the headset is left."""
        first = self.do("return calls.length")
        live.until(lambda: self.do(
            "return repel.state().xr.mode === null || calls.slice(arguments[0])"
            ".filter((each) => each === 'frame').length > arguments[1]", first, count),
            "frames pass")

    def press(self, hand, text):
        """Presses a key of the panel."""
        self.point(hand, text)
        self.frames()
        self.button(hand, "trigger", 1)
        self.frames()
        self.button(hand, "trigger", 0)
        self.frames()

    def drives(self, holds, what, k=0):
        """As the page's, while the hand holds the tool. Once it does not, there is no hope."""
        def look(state):
            if not state["xr"]["held"][k]:
                raise AssertionError(f"{state['xr']['why']} before {what}")
            return holds(state)

        return self.page.drives(look, what)


class Headset(WithHeadset, FromTheBeginning):
    """Each test finds the run paused at its beginning, and nobody in the headset."""

    def test_one_enters_and_leaves(self):
        page = self.page
        camera = page.state()["camera"]["position"]
        for mode in ("vr", "ar"):
            page.until(lambda s: page.shown(f"enter-{mode}"), "it is offered")
            self.assertEqual(self.enter(mode)["scale"], 1)
            for size, scaled in (("Table", True), ("Its size", False)):
                self.press("left", size)
                page.until(lambda s, scaled=scaled: (s["xr"]["scale"] != 1) == scaled, size)
            self.press("left", "Leave")
            page.until(lambda s: s["xr"]["mode"] is None and not s["xr"]["hands"], "it is left")
            after = page.draws()
            for was, now in zip(camera, after["camera"]["position"]):
                self.assertAlmostEqual(was, now, places=3)
            self.assertFalse(after["operator"]["you"])

    @by_the_clock
    def test_the_tool_follows_a_hand_that_squeezes(self):
        page = self.page
        before = self.begin_holding()
        for turn in (1, 2):  # however far the arm reaches: the hand goes back, the tool stays
            self.lead("right", UP, 20)
            # Nearly: it gives way along this axis.
            height = before[2] + turn * 0.03
            after = self.drives(lambda s: s["toolPosition"][2] > height, "the tool goes up")
            self.let_go()
            self.lead("right", DOWN, 20)
            live.until(lambda: self.do("return emulated.controllers.right.position.y < 1.501"),
                       "the hand goes back")
            self.squeeze()
        self.assertLess(page.state()["toolPosition"][2], before[2] + 0.09)
        for k in (0, 1):
            self.assertAlmostEqual(after["toolPosition"][k], before[k], delta=0.01)
        told = page.until(lambda s: s["xr_latency_ms"], "the latency is measured")["xr_latency_ms"]
        self.assertTrue(0 <= told["p50"] <= told["p99"] <= told["max"])
        live.until(lambda: "pose to command" in self.do(
            "return document.getElementById('headset-name').textContent"), "it is shown")
        # Ahead, from where the fixed view looks.
        before = after["toolPosition"]
        self.lead("right", (0, 0, -0.002), 20)
        after = self.drives(lambda s: math.dist(s["toolPosition"][:2], before[:2]) > 0.03,
                            "it goes ahead")["toolPosition"]
        ahead = math.atan2(after[1] - before[1], after[0] - before[0])
        self.assertAlmostEqual(ahead, math.atan2(0.86, -0.62), delta=0.2)

    def begin_holding(self):
        """The place of the tool that the right hand holds, of a run that runs."""
        self.enter()
        self.squeeze()
        self.page.run()
        return self.page.state()["toolPosition"]

    @by_the_clock
    def test_a_turn_of_the_hand_turns_the_tool(self):
        self.begin_holding()
        self.do("""
            let angle = 0;
            clearInterval(window.leading);
            window.leading = setInterval(() => {
              angle = Math.min(angle + 0.01, 0.3);
              emulated.controllers.right.quaternion.set(0, Math.sin(angle / 2), 0,
                                                        Math.cos(angle / 2));
            }, 20);
            window.first = repel.pose();""")

        def turned():
            q, p = self.do("return [repel.pose(), window.first].map((pose) => pose.slice(3))")
            return 2 * math.acos(min(1, abs(sum(a * b for a, b in zip(q, p)))))

        self.drives(lambda s: abs(turned() - 0.3) < 0.03, "the tool turns as far")

    @by_the_clock
    def test_a_wall_is_felt_the_more_the_harder(self):
        self.begin_holding()
        self.lead("right", DOWN)
        self.drives(lambda s: s["force"][2] > 15, "the table pushes up")
        self.lead("right", UP)
        self.drives(lambda s: math.hypot(*s["force"]) < 0.4, "it comes off again")
        felt = self.do("return felt")
        self.assertEqual(felt[0][:2], [0.8, 15], "a tick at the first touch")
        pulses = [each for each in felt if each[1] > 15]
        self.assertGreater(len(pulses), 5)
        for strength, _, force in pulses:
            self.assertAlmostEqual(strength, min(1, force / 60), places=6)
        self.assertGreater(max(pulses)[0], 2 * min(pulses)[0])

    def let_go_by(self, cause, sudden=False):
        """How the hand is let go, and that from the next frame on, or at once, nothing moves."""
        page = self.page
        self.let_go()
        self.squeeze()
        self.lead("right", UP)
        moves = "return (calls.filter((each) => each !== 'frame').at(-1) ?? 0) > 0.01"
        self.drives(lambda s: self.do(moves), "it moves")
        self.do(f"calls.length = 0; {cause}")
        why = page.until(lambda s: not s["xr"]["held"][0], "it is let go")["xr"]["why"][0]
        # What a timer says before the frame that finds out still moves.
        calls = live.until(lambda: self.rested(sudden), "the rates are zero",
                           lambda: self.do("return calls"))
        self.assertTrue(calls)
        self.lead("right", STILL, 0)
        return why

    def rested(self, sudden):
        calls = self.do("return calls")
        frames = [k for k, each in enumerate(calls) if each == "frame"]
        begin = 0 if sudden else frames[1] if len(frames) > 1 else len(calls)
        rates = [each for each in calls[begin:] if each != "frame"]
        self.assertEqual([each for each in rates if each], [], calls)
        return rates

    @by_the_clock
    def test_a_hand_that_is_not_seen_is_let_go(self):
        self.begin_holding()
        for how in ("gone", "guessed"):
            self.assertIn("not tracked", self.let_go_by(f"lost.right = '{how}'"))
            self.do("lost = {}")
            self.page.until(lambda s: ["right", True] in s["xr"]["hands"], "it is seen again")
            self.assertFalse(self.page.state()["xr"]["held"][0], "until it squeezes again")

    @by_the_clock
    def test_a_controller_that_is_switched_off_is_let_go(self):
        self.begin_holding()
        self.assertIn("not seen", self.let_go_by("emulated.controllers.right.connected = false"))

    @by_the_clock
    def test_a_pose_that_jumps_is_no_hand(self):
        self.begin_holding()
        why = self.let_go_by("emulated.controllers.right.position.x += 0.6")
        self.assertIn("faster than a hand", why)
        why = self.let_go_by("emulated.controllers.right.quaternion.set(0, 1, 0, 0)")
        self.assertIn("faster than a hand", why)

    @by_the_clock
    def test_a_hidden_page_lets_go_at_once(self):
        self.begin_holding()
        why = self.let_go_by("""
            Object.defineProperty(document, 'hidden', {value: true, configurable: true});
            document.dispatchEvent(new Event('visibilitychange'));""", sudden=True)
        self.assertIn("hidden", why)
        self.do("delete document.hidden; document.dispatchEvent(new Event('visibilitychange'));")

    @by_the_clock
    def test_who_leaves_or_opens_a_menu_lets_go_at_once(self):
        self.begin_holding()
        why = self.let_go_by("emulated.updateVisibilityState('visible-blurred')")
        self.assertIn("something else", why)
        self.do("emulated.updateVisibilityState('visible')")
        self.page.until(lambda s: ["right", True] in s["xr"]["hands"], "it is seen again")
        self.assertIn("left", self.let_go_by("emulated.activeSession.end()", sudden=True))
        self.page.until(lambda s: s["xr"]["mode"] is None, "it is left")

    def test_two_hands_draw_the_scene(self):
        page = self.page
        self.enter()
        for hand in ("left", "right"):
            self.button(hand, "trigger", 1)
        live.until(lambda: self.do("return emulated.controllers.left.inputSource.gamepad.buttons[0]"
                                   ".pressed"), "both pinch")
        self.page.draws()
        self.lead("right", (0.01, 0, 0), 50)  # from 0.5 m apart to 1 m
        page.until(lambda s: abs(s["xr"]["scale"] - 0.5) < 0.01, "it is twice as large")
        for hand in ("left", "right"):
            self.button(hand, "trigger", 0)
        self.lead("right", (-0.01, 0, 0), 20)
        page.draws()
        self.assertAlmostEqual(page.state()["xr"]["scale"], 0.5, delta=0.01)
        self.assertFalse(page.state()["operator"]["you"], "that drives nothing")

    @by_the_clock
    def test_while_one_hand_holds_the_other_presses(self):
        page = self.page
        before = self.begin_holding()
        for _ in range(3):
            self.press("left", "\u2212")
        live.until(lambda: self.do("return document.getElementById('xr-scale-out').textContent")
                   == "\u00d7 0.501", "the scale is finer")
        self.assertTrue(page.state()["xr"]["held"][0])
        self.lead("right", UP, 40)
        self.drives(lambda s: s["toolPosition"][2] > before[2] + 0.03, "the tool goes half as far")
        self.assertLess(page.state()["toolPosition"][2], before[2] + 0.05)
        self.press("left", "Release")
        page.until(lambda s: not s["operator"]["you"], "the controls are released")

    def test_somebody_else_looks_on(self):
        self.enter()
        self.squeeze()
        other = live.Page(self.second_window(), self.url)
        other.until(lambda s: s["operator"]["by"] == "page" and not s["operator"]["you"],
                    "another page drives")

    def second_window(self):
        first = self.browser.current_window_handle
        self.browser.switch_to.new_window("window")
        super(WithHeadset, self).save_time()
        second = self.browser.current_window_handle

        def close():
            self.browser.switch_to.window(second)
            self.browser.close()
            self.browser.switch_to.window(first)

        self.addCleanup(close)
        return self.browser


class Clutch(SharedProgram):
    """Its law, without a clock."""

    def law(self, script):
        self.open(self.url)
        return self.module("xr_clutch.js", """
            const let_go = [];
            const clutch = new module.Clutch((why) => let_go.push(why));
            const most = {fastest: 0.1, turning: 1};
            const {Vector3, Quaternion} = globalThis.three;
            const at = (x, angle = 0) => ({
              room: new Vector3(x, 0, 0), scene: new Vector3(10 * x, 0, 0),
              turn: new Quaternion(0, 0, Math.sin(angle / 2), Math.cos(angle / 2))});
            """ + script)

    def module(self, name, script, *arguments):
        self.browser.execute_async_script(
            "const done = arguments[0]; import('./vendor/three.min.js').then((three) => "
            "done(void (globalThis.three = three)));")
        return super().module(name, script, *arguments)

    def test_it_leads_the_tool_as_far_and_no_faster_than_it_may(self):
        along, round_, fastest = self.law("""
            clutch.close({});
            let [along, round, fastest] = [0, 0, 0];
            for (let k = 0; k <= 200; ++k) {
              const now = 10 * k;
              const s = Math.min(1, k / 20);
              clutch.move(at(0.01 * s, 0.2 * s), now, 0.5, true);
              const {world, round: spin} = clutch.poll(now, most);
              along += 0.01 * world[0];
              round += 0.01 * spin[2];
              fastest = Math.max(fastest, world[0]);
            }
            return [along, round, fastest];""")
        self.assertAlmostEqual(along, 0.05, places=4)  # 0.01 m of the room are 0.1 of the scene
        self.assertAlmostEqual(round_, 0.2, places=4)
        self.assertAlmostEqual(fastest, 0.1, places=6)

    def test_it_begins_where_the_hand_is_once_the_tool_is_ours(self):
        self.assertEqual(self.law("""
            clutch.close({});
            clutch.move(at(0), 0, 1, false);
            clutch.move(at(0.02), 10, 1, false);
            clutch.move(at(0.02), 20, 1, true);
            return clutch.poll(20, most).world;"""), [0, 0, 0])

    def test_what_no_hand_does_opens_it(self):
        said = self.law("""
            const tries = [[0.03, 0, 10], [0.05, 0, 10], [0, 0.2, 10], [0, 0.3, 10], [0, 0, 240],
                           [0, 0, 260]];
            return tries.map(([x, angle, ms]) => {
              clutch.close({});
              clutch.move(at(0), 0, 1, true);
              clutch.move(at(x, angle), ms, 1, true);
              return [clutch.held, clutch.poll(ms, most) === null];
            });""")
        self.assertEqual(said, [[True, False], [False, True]] * 3)
        self.assertEqual(self.law("""
            clutch.close({});
            clutch.move(at(0), 0, 1, true);
            clutch.move(at(0.001), 10, 1, true);
            const rates = [60, 111, 261].map((now) => clutch.poll(now, most)?.world[0] > 0);
            return [...rates, clutch.held, let_go.length];"""),
            [True, False, False, False, 1])


class HeadsetSwitches(WithHeadset, OwnProgram):
    @by_the_clock
    def test_the_panel_switches_what_the_network_has(self):
        page = self.open(self.start(live.scene("follow_a_seam")))
        page.begin()
        self.enter()
        self.press("left", "Take the controls")
        page.until(lambda s: s["operator"]["you"], "the controls are ours")
        page.run()
        for _ in range(2):
            before = page.state()["hand"]["guides"]
            self.press("left", "seam")
            page.until(lambda s: ("seam" in s["hand"]["guides"]) != ("seam" in before),
                       "the fixture is switched")
        self.press("left", "z")
        page.until(lambda s: s["hand"]["compliant"] == ["z"], "it gives way along z")

    def test_a_ray_drags_a_box(self):
        page = self.open(self.start(live.scene("bin_picking")))
        self.enter()
        self.press("left", "Box")
        before = page.until(lambda s: len(s["boxes"]) == 1, "a box has come")["boxes"][0]
        # At it, from above.
        self.do("""
            const {position, quaternion} = emulated.controllers.left;
            const [x, y, z] = repel.toRoom(arguments[0]);
            position.set(x, y + 0.5, z);
            quaternion.set(-Math.SQRT1_2, 0, 0, Math.SQRT1_2);""", before)
        page.draws()
        self.button("left", "trigger", 1)
        page.draws()
        self.lead("left", (0, 0.002, 0), 50)
        page.until(lambda s: s["boxes"][0][2] > before[2] + 0.05, "the box moves up")
        self.button("left", "trigger", 0)
        self.press("left", "Remove box")
        page.until(lambda s: s["boxes"] == [], "the box has gone")

    @by_the_clock
    def test_each_hand_moves_its_own_where_there_are_two(self):
        page = self.open(self.start_with_two_hands())
        page.begin()
        self.enter()
        self.squeeze("left", 1)
        before = page.state()["toolPosition"]
        page.run()
        self.lead("left", UP, 25)
        self.drives(lambda s: s["toolPosition"][2] > before[2] + 0.01 and
                    abs(s["hand"]["second_grip_n"][2]) > 0.5, "the left hand draws the tool up", 1)
        self.squeeze("right")
        self.assertEqual(page.state()["xr"]["held"], [True, True])
        self.let_go("left", 1)
        self.assertEqual(page.state()["xr"]["held"], [True, False])
        self.press("left", "\u2212")
        page.until(lambda s: s["hand"]["scale"] < 1, "the scale of both is finer")

    @by_the_clock
    def test_a_phone_is_a_master_with_one_hand(self):
        self.before_pages("""
            const {inputSource} = emulated.controllers.right;
            Object.defineProperty(inputSource, "targetRayMode", {value: "screen"});
            Object.defineProperty(inputSource.gamepad, "hapticActuators", {value: []});
            navigator.vibrate = (ms) => felt.push(ms);""")
        self.resize(*PHONE)
        page = self.open(self.start())
        page.until(lambda s: page.shown("enter-ar"), "it is offered")
        self.assertEqual(self.do(SMALLEST), [])
        page.begin()
        self.enter("ar")
        before = page.state()["toolPosition"]
        self.button("right", "trigger", 1)  # a finger on the screen
        page.until(lambda s: s["xr"]["held"][0] and s["operator"]["you"], "it is held")
        page.run()
        self.lead("viewer", UP, 20)
        self.drives(lambda s: s["toolPosition"][2] > before[2] + 0.03,
                    "the tool goes up with the phone")
        self.lead("viewer", DOWN)
        self.drives(lambda s: s["force"][2] > 15 and self.do("return Math.max(...felt)") > 10,
                    "the phone vibrates")
        self.button("right", "trigger", 0)
        page.until(lambda s: not s["xr"]["held"][0], "it is let go")


class NoHeadset(SharedProgram):
    def test_the_emulated_one_is_the_file_that_was_chosen(self):
        with open(os.path.join(VENDOR, "VERSIONS"), encoding="utf-8") as file:
            self.assertIn(hashlib.sha256(RUNTIME.encode()).hexdigest(), file.read())

    def test_without_one_none_is_offered(self):
        page = self.open(self.url)
        page.draws()
        for name in ("enter-vr", "enter-ar", "headset-name"):
            self.assertFalse(page.shown(name), name)
