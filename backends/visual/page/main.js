// SPDX-License-Identifier: BSD-3-Clause
// Joins everything: messages come in, become state, and are drawn when the browser draws.

import { Sphere, Vector3 } from "./vendor/three.min.js";
import { Boxes } from "./boxes.js";
import { bodiesOf } from "./bodies.js";
import { Cameras } from "./cameras.js";
import { follow, startCapture } from "./capture.js";
import { Charts } from "./charts.js";
import { Connection } from "./connection.js";
import { Controls } from "./controls.js";
import { Depth } from "./depth.js";
import { Drag } from "./drag.js";
import { showReadings, startDrawer } from "./drawer.js";
import { Events } from "./events.js";
import { Gamepad } from "./gamepad.js";
import { Gaps } from "./gaps.js";
import { Fixtures } from "./fixtures.js";
import { startHelp, toggleHelp } from "./help.js";
import { Hand } from "./hand.js";
import { Histogram } from "./histogram.js";
import { Inspector } from "./inspector.js";
import { Joints } from "./joints.js";
import { Keyboard } from "./keyboard.js";
import { Labels } from "./labels.js";
import { Lever } from "./lever.js";
import { Marks } from "./marks.js";
import { Measure } from "./measure.js";
import { banner } from "./messages.js";
import { Parts } from "./parts.js";
import { startPicking } from "./pick.js";
import { startProbe } from "./probe.js";
import { faded, Readouts } from "./readouts.js";
import { Stage } from "./scene3d.js";
import { askForSecret, secret, startSecret } from "./secret.js";
import { settings } from "./settings.js";
import { startShowMenu } from "./show_menu.js";
import { SignalHistory } from "./signals.js";
import { SpaceMouse } from "./spacemouse.js";
import { Sticks } from "./sticks.js";
import { state, thisArmNow, toolPose } from "./state.js";
import { Strip } from "./strips.js";
import { showTab, startTabs } from "./tabs.js";
import { startTheme } from "./theme.js";
import { Tour } from "./tour.js";
import { Trail } from "./trail.js";
import { Transport } from "./transport.js";
import { Tree } from "./tree.js";
import { Triad } from "./triad.js";
import { Visuals } from "./visuals.js";
import { at, norm, write } from "./words.js";
import { Headset } from "./xr.js";

const CLEAR_MS = 120;  // between two looks at what hides the tool
const REST_MS = 5000;  // from when the page is hidden to when it lets its line go
const PANELS_MS = 100;  // between two drawings of numbers and charts: faster cannot be read

startTheme();
startHelp();
startDrawer();
let stage;
try {
  stage = new Stage(at("canvas"));
} catch (error) {
  banner("webgl", "This browser gives no WebGL: the scene cannot be drawn");
  throw error;
}
const parts = new Parts(stage);
const visuals = new Visuals(stage, parts);
const cameras = new Cameras(stage);
const labels = new Labels(at("labels"), stage);
const marks = new Marks(stage, labels);
const gaps = new Gaps(stage, parts);
const fixtures = new Fixtures(stage);
const triad = new Triad(at("triad"), cameras);
const trail = new Trail(stage);
const signals = new SignalHistory();
const charts = new Charts(signals);
const joints = new Joints();
const depth = new Depth();
const inspector = new Inspector(parts, () => inspect(null));
const tree = new Tree({
  choose: (body) => (measure.on ? measure.put(parts.centreOf(body.parts)) : inspect(body)),
  highlight: (body) => parts.highlight(body?.parts ?? []),
  isHidden,
  hide,
});
const measure = new Measure(stage, labels);
const readouts = new Readouts((pair, range) => marks.colourOf(pair, range), () => {
  hand.arm();
  armShown();
});
const histogram = new Histogram(at("histogram"));
const { history } = state;
const strips = [
  new Strip({ canvas: at("force-strip"), value: at("force-at"), history, series: "force",
              scale: 1, unit: "N", tint: "force", least: 10 }),
  new Strip({ canvas: at("distance-strip"), value: at("distance-at"), history,
              series: "nearest", scale: 1000, unit: "mm", tint: "far", bends: true }),
];

const connection = new Connection(connected);
const transport = new Transport(connection);
const keyboard = new Keyboard();
const gamepad = new Gamepad();
const heading = () => cameras.heading();
const lever = new Lever(keyboard, heading);
const hand = new Hand(connection);
const boxes = new Boxes(connection, stage, parts);
const drag = new Drag(stage, parts,
                      { mayDrive: () => controls.ours, take: () => controls.take() });
const sticks = new Sticks();
const headset = new Headset(stage, { boxes, heading, paint, changed: showOrHide });
const controls = new Controls(connection, [keyboard, gamepad, new SpaceMouse(), drag, sticks,
                                           ...headset.clutches], lever, hand, heading);
headset.drives(controls);
const events = new Events((time) => transport.go(time));
const tour = new Tour(() => state.scene?.mode === "live" && state.operator?.looksOn === false,
                      () => cameras.refit());
startProbe({ connection, stage, parts, marks, gaps, fixtures, cameras, strips, visuals, headset,
             inspector, measure, charts, events });

const toolAt = new Vector3();
const near = new Set();
const pushing = new Set();
const dress = () => parts.dress(visuals.shown, near, pushing);
let fresh = false;  // a frame came since the last drawing
let framed = "";  // the scene that the camera was set up for
let clearedAt = 0;
let panelsAt = 0;
let panelsDue = true;
let bodies = [];  // of the scene, as people call them
let turn = 0;  // of the browser, at which it is drawn next
let rest = 0;

const MISSING = { "": "No connection to the program. Trying again.",
                  secret: "",
                  patience: "Too many wrong secrets came from here. Trying again." };

function connected(yes, missing = "") {
  state.connected = yes;
  at("view").classList.toggle("lost", !yes);
  banner("lost", yes ? "" : MISSING[missing]);
  askForSecret(missing === "secret", secret() ? "The secret is another one." : "");
  if (!yes) {
    state.operator = null;
    controls.operator({ by: "nobody", you: false, silent: false });
    sticks.operator({ you: false });
    write(at("status"), "not connected");
    at("status").className = "status bad";
  }
  stage.invalidate();
}

// Looks at a body, or at none.
function inspect(body) {
  inspector.choose(body);
  tree.mark(body);
  if (body) showTab("bodies");
  panelsDue = true;
}

// What a link asks for.
function show({ arm, body, hidden }) {
  if (arm !== undefined) readouts.choose(arm);
  hide(bodies.filter(({ name }) => hidden.includes(name)), true);
  tree.scene(bodies);
  inspect(bodies.find(({ name }) => name === body) ?? null);
}

function isHidden(body) {
  return body.parts.every((k) => parts.isHidden(k));
}

// Hides bodies, or shows them again.
function hide(some, yes) {
  parts.hide(some.flatMap((body) => body.parts), yes);
  visuals.show();
}

// What is of the arm whose numbers are shown.
function armShown() {
  signals.clear();
  history.clear();
  joints.arm();
  charts.arm();
}

connection.on("scene", (scene) => {
  state.scene = scene;
  state.frame = null;
  history.reset(scene.rate_hz);
  parts.build(scene);
  visuals.build(scene);
  at("show-robot-row").hidden = !visuals.any;
  at("level").max = parts.mostLevels - 1;
  at("level").value = settings.level;
  readouts.scene(scene);
  bodies = bodiesOf(scene);
  inspect(null);
  tree.scene(bodies);
  events.clear();
  depth.scene();
  armShown();
  strips[1].zone = 1000 * Math.max(0, ...scene.parts.map((part) => part.range_m));
  gaps.scene(scene);
  fixtures.scene(scene);
  hand.scene();
  transport.scene(scene);
  controls.scene(scene);
  drag.scene(scene.arms[0]?.tool_body);
  boxes.scene(scene);
  trail.clear();
});

connection.on("frame", (frame) => {
  if (frame.tick !== null && frame.tick < state.frame?.tick) {
    trail.clear();
    history.clear();
  }
  state.frame = frame;
  signals.add(frame);
  events.add(frame);
  controls.frame();
  history.add(frame);
  fresh = true;
});

connection.on("part", (shape) => parts.reshape([shape]));
connection.on("parts", (shapes) => parts.reshape(shapes));
connection.on("depth", (image) => depth.show(image));
connection.on("timing", (timing) => (state.timing = timing));
connection.on("operator", (operator) => {
  state.operator = operator;
  controls.operator(operator);
  sticks.operator(operator);
  transport.operator(operator);
  events.driver(at("who").textContent);
  tour.offer();
  stage.invalidate();
});
connection.on("refused", (refused) => {
  controls.refused(refused);
  transport.refused(refused);
});

// Where the bodies are now; the first frame of a scene also sets up floor and camera.
function move(frame) {
  parts.move(frame.bodies, frame.absent);
  visuals.move(frame.arms);
  const pose = toolPose(frame);
  if (pose) {
    toolAt.fromArray(pose);
    cameras.track(toolAt);
    trail.add(toolAt);
  }
  if (framed !== state.scene?.name) {
    framed = state.scene?.name;
    const corners = parts.corners();
    const { center, radius } = new Sphere().setFromPoints(corners);
    state.radius = radius;
    stage.fit(center, radius, Math.min(0, ...corners.map((corner) => corner.z)), state.scene);
    const tool = parts.corners(state.scene?.arms[0]?.tool_body);
    cameras.frame(() => [...parts.corners(), ...visuals.corners()],
                  new Sphere().setFromPoints(tool).radius || radius / 4);
    showMenu.scale();
    follow({ cameras, charts, show });
  }
  near.clear();
  pushing.clear();
  for (const pair of frame.pairs) {
    for (const part of state.scene?.pairs[pair.i]?.slice(0, 2) ?? []) {
      near.add(part);
      if (pair.f > 0) pushing.add(part);
    }
  }
  parts.showZones(near);
  dress();
  transport.frame(frame);
  lever.frame(frame.arms[0]);
  tour.frame();
  banner("faded", faded(thisArmNow()), true);
  gamepad.rumble(controls.ours ? norm(frame.arms[0]?.force) : 0, performance.now());
  panelsDue = true;
  stage.invalidate();
}

// The tool, and where it is nearest to something, must be seen.
function clearView(now) {
  if (now - clearedAt < CLEAR_MS) return;
  clearedAt = now;
  const points = [toolAt.clone()];
  for (const { a } of state.frame.pairs.slice(0, 2)) {
    if (a) points.push(new Vector3().fromArray(a));
  }
  const { eye } = stage;
  visuals.clear(parts.clear(eye, points), eye, points);
}

// A headset has turns of its own.
function draw(now) {
  turn = document.hidden || headset.mode ? 0 : requestAnimationFrame(draw);
  if (headset.mode) return;
  cameras.update();
  stage.quality.frame(now, paint(now));
}

// Draws what is due, and says whether that was the scene.
function paint(now) {
  if (fresh && state.frame) move(state.frame);
  fresh = false;
  if (stage.pending && state.frame) {
    clearView(now);
    labels.clear();
    marks.update(state.frame);
    if (stage.immersive) labels.clear();  // there they would lie on nothing
    gaps.update(marks.unit);
    fixtures.update(state.frame);
    measure.draw(marks.unit);
    labels.show(now);
    drag.draw();
    triad.draw();
  }
  const drawn = stage.render();
  if (now - panelsAt > PANELS_MS) {
    panelsAt = now;
    if (panelsDue && state.frame) {
      readouts.frame(state.frame, now);
      hand.frame();
      joints.frame();
      inspector.frame();
      charts.frame();
    }
    panelsDue = false;
    if (!at("pane-now").hidden) {
      for (const strip of strips) strip.draw();
      histogram.draw();
    }
  }
  return drawn;
}

// A hidden page draws nothing, and when it stays hidden it gets nothing either, unless it drives:
// then it is for the program to find it silent.
function showOrHide() {
  clearTimeout(rest);
  if (document.hidden) {
    rest = setTimeout(() => (controls.ours ? showOrHide() : connection.rest()), REST_MS);
    return;
  }
  if (connection.resting) connection.open();
  if (turn === 0 && !headset.mode) turn = requestAnimationFrame(draw);
}

function onKey(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || at("help").open) return;
  const { tagName, type } = event.target;
  const writes = tagName === "INPUT" && !["checkbox", "range"].includes(type);
  if (tagName === "SELECT" || writes) return;
  const presses = tagName === "BUTTON" || tagName === "SUMMARY" || type === "checkbox";
  if (event.key === " " && presses) return;  // it presses what has the focus
  if (event.key === "Home" && type === "range") return;
  if (handle(event)) event.preventDefault();
}

function handle(event) {
  if (keyboard.down(event)) {
    if (!event.repeat) controls.take();
  } else if (event.repeat && event.key !== ".") return false;
  else if (event.key === "?") toggleHelp();
  else if (event.code === "KeyC") at("take").click();
  else if (event.code === "KeyH") hand.swap();
  else if (event.code === "KeyT") at("theme").click();
  else if (event.key === "Delete") boxes.remove();
  else return transport.key(event) || cameras.key(event);
  return true;
}

startTabs(() => (panelsDue = true));
startCapture({ stage, cameras, charts, looked: () => ({
  body: inspector.body?.name, hidden: bodies.filter(isHidden).map(({ name }) => name),
}) });
startPicking(stage, parts, visuals, ({ part, body, point }) => {
  if (measure.on) return measure.put(point);
  const met = bodies.find((each) => (part === null ? each.body === body && each.kind !== "obstacle"
                                                   : each.parts.includes(part)));
  inspect(met ?? null);
  if (met) showReadings();
});
const showMenu = startShowMenu({ stage, parts, visuals, near, dress,
                                 changed: () => (panelsDue = true) });
addEventListener("keydown", onKey);
addEventListener("keyup", (event) => keyboard.up(event));
// What was clicked must not take the next press of the space bar.
addEventListener("click", (event) => {
  if (event.detail > 0) event.target.closest?.("button, summary, [type=checkbox]")?.blur();
});
startSecret(() => connection.reopen());
document.addEventListener("visibilitychange", showOrHide);
connection.open();
showOrHide();
