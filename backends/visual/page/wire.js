// SPDX-License-Identifier: BSD-3-Clause
// What comes over the wire, made whole: what is missing or no number becomes null or an empty list
// here, so that the rest of the page need not ask. See docs/live_view.md for the messages.

import { finite } from "./words.js";

const list = (x) => (Array.isArray(x) ? x : []);
const object = (x) => (x !== null && typeof x === "object" && !Array.isArray(x) ? x : {});
const number = (x) => (finite(x) ? x : null);
const text = (x) => (typeof x === "string" ? x : "");
const numbers = (x) => list(x).map(number);

// `count` numbers, all of them there, or null.
const vector = (x, count = 3) =>
  Array.isArray(x) && x.length >= count && x.slice(0, count).every(finite) ? x : null;
const pose = (x) => vector(x, 7);

function level(x) {
  const { vertices, triangles, depth_m } = object(x);
  const whole = list(vertices).every(finite) && list(triangles).every(Number.isInteger);
  return { depth_m: number(depth_m), vertices: whole ? list(vertices) : [],
           triangles: whole ? list(triangles) : [] };
}

function part(x) {
  const { name, of, body, group, arm, pose: at, passable, range_m, levels, gaps, gap_count, color,
          opacity } = object(x);
  return { name: text(name) || "?", of: text(of), body, group: text(group), arm: number(arm) ?? 0,
           pose: pose(at),
           passable: passable === true, range_m: number(range_m) ?? 0,
           color: vector(color), opacity: Math.min(1, Math.max(0, number(opacity) ?? 1)),
           levels: list(levels).map(level), gap_count: number(gap_count) ?? 0,
           gaps: list(gaps).map((gap) => vector(gap, 4)).filter((gap) => gap !== null) };
}

function fixture(x) {
  const { name, shape, pose: at, course, radius_m, half_angle_rad } = object(x);
  return { name: text(name), shape: text(shape), pose: pose(at),
           course: list(course).map((p) => vector(p)).filter((p) => p !== null),
           radius_m: number(radius_m) ?? 0, half_angle_rad: number(half_angle_rad) ?? 0.5 };
}

// A mesh to be looked at; one that is not whole is left out.
function visual(x) {
  const { body, arm: whose, link, pose: where, color, name, vertices, triangles } = object(x);
  const { vertices: points, triangles: corners } = level({ vertices, triangles });
  const moves = Number.isInteger(body) || Number.isInteger(link);
  if (!moves || points.length === 0 || corners.length === 0) return null;
  return { body: number(body), arm: number(whose), link: number(link), pose: pose(where),
           color: vector(color), name: text(name), vertices: points, triangles: corners };
}

function limits(x) {
  const { name, lower, upper, rate, effort } = object(x);
  return { name: text(name), lower: number(lower), upper: number(upper), rate: number(rate),
           effort: number(effort) };
}

function law(x) {
  const { range_m, surface_force_n, damping_ns_m, ceiling_n, passable, hard } = object(x);
  return { range_m: number(range_m), surface_force_n: number(surface_force_n),
           damping_ns_m: number(damping_ns_m), ceiling_n: number(ceiling_n),
           passable: passable === true, hard: hard === true };
}

function arm(x) {
  const { name, joints, limits: ends, signals, modules, tool_body, max_speed_m_s, max_turn_rad_s, max_lever_rad_s, fixtures,
          compliant, scale, hands, links } = object(x);
  return { name: text(name), joints: list(joints).map(text), limits: list(ends).map(limits),
           signals: list(signals).map(text), modules: list(modules).map(text), tool_body,
           max_speed_m_s: number(max_speed_m_s), max_turn_rad_s: number(max_turn_rad_s),
           max_lever_rad_s: number(max_lever_rad_s), fixtures: list(fixtures).map(fixture),
           compliant: list(compliant).map(text), scales: Array.isArray(scale),
           hands: number(hands) ?? 1, links: list(links).filter(Number.isInteger) };
}

export function scene(x) {
  return {
    name: text(x.name),
    rate_hz: number(x.rate_hz),
    period_us: number(x.period_us) ?? 1000,
    mode: x.mode === "replay" ? "replay" : "live",
    duration_s: number(x.duration_s) ?? 0,
    bodies: list(x.bodies).map(text),
    parts: list(x.parts).map(part),
    pairs: list(x.pairs).map((pair) => vector(pair) ?? vector(pair, 2)),
    laws: list(x.laws).map(law),
    arms: list(x.arms).map(arm),
    visuals: list(x.visuals).map(visual).filter((each) => each !== null),
    spare: list(x.spare).filter(Number.isInteger),
    scripted: x.scripted === true,
  };
}

// Another shape of one of the parts of the scene.
export function shape(x) {
  return { part: number(x.part), levels: list(x.levels).map(level) };
}

// Those of several.
export function shapes(x) {
  return list(x.parts).map(shape);
}

function pair(x) {
  const { i, d, a, b, n, level: deep, f, stale, age } = object(x);
  return { i, d: number(d), a: vector(a), b: vector(b), n: vector(n), level: number(deep),
           f: number(f) ?? 0, stale: stale === true, age: number(age) ?? 0 };
}

function armNow(x) {
  const { force, torque, coupling, lever_nm, gain, energy_j, guides, guide_strength, compliant,
          compliant_frame, scale, grip_n, grip_nm, second_grip_n, second_grip_nm, links, signals,
          hold } = object(x);
  return { force: vector(force), torque: vector(torque), coupling: vector(coupling),
           lever_nm: number(lever_nm), gain: number(gain), energy_j: numbers(energy_j),
           guides: list(guides).map(text), guide_strength: number(guide_strength),
           compliant: list(compliant).map(text), compliant_frame: text(compliant_frame),
           scale: number(scale), grip_n: vector(grip_n), grip_nm: vector(grip_nm),
           second_grip_n: vector(second_grip_n), second_grip_nm: vector(second_grip_nm),
           links: list(links).map(pose), signals: numbers(signals),
           hold: hold ? { pair: hold.pair, margin_m: number(hold.margin_m),
                          force_n: number(hold.force_n) } : null };
}

// [tick, the bits that are set from then on]
function change(x) {
  const [tick, bits] = list(x);
  return [tick, list(bits).map(text).filter(Boolean)];
}

export function frame(x) {
  const recent = object(x.recent);
  return {
    tick: number(x.tick),
    time_s: number(x.time_s),
    running: x.running !== false,
    phase: text(x.phase),
    scriptOver: x.script_over === true,
    status: list(x.status).map(text).filter(Boolean),
    bodies: list(x.bodies).map(pose),
    absent: list(x.absent).filter(Number.isInteger),
    pairs: list(x.pairs).map(pair),
    pairs_omitted: number(x.pairs_omitted) ?? 0,
    near: number(x.near),
    evaluated: number(x.evaluated),
    of: number(x.of),
    arms: list(x.arms).map(armNow),
    recent: { tick: numbers(recent.tick), nearest_m: numbers(recent.nearest_m),
              force_n: numbers(recent.force_n), compute_us: numbers(recent.compute_us),
              late_us: numbers(recent.late_us),
              status: list(recent.status).map(change).filter(([tick]) => finite(tick)) },
  };
}

// An image, or null where it is not whole.
export function depth({ camera, width, height, mm }) {
  const count = Number.isInteger(width) && Number.isInteger(height) ? width * height : -1;
  if (!(count > 0) || !Array.isArray(mm) || mm.length !== count) return null;
  return { camera: text(camera), width, height, mm: numbers(mm) };
}

function quantiles(x) {
  const { p50, p99, max } = object(x);
  return { p50: number(p50), p99: number(p99), max: number(max) };
}

export function timing(x) {
  return { edges_us: list(x.edges_us).filter(finite), compute: numbers(x.compute),
           late: numbers(x.late), ticks: number(x.ticks), misses: number(x.misses),
           dropped: number(x.dropped) ?? 0, compute_us: quantiles(x.compute_us),
           late_us: quantiles(x.late_us) };
}

export function operator(x) {
  return { by: text(x.by), you: x.you === true, name: text(x.name), silent: x.silent === true,
           pages: number(x.pages) ?? 0, looksOn: x.looks_on === true, whyNot: text(x.why_not),
           noConduct: text(x.no_conduct) };
}

export function refused(x) {
  return { what: text(x.what), why: text(x.why) };
}
