// SPDX-License-Identifier: BSD-3-Clause
// From the vertices and triangles of a convex part to what is drawn: faces that are flat where the
// part is and smooth where it is round, its edges, its zone of influence, its reduction levels.

import { BufferAttribute, BufferGeometry, Vector3 } from "./vendor/three.min.js";

const CREASE = Math.cos((33 * Math.PI) / 180);  // faces that meet at less are one round surface
const FACET = Math.cos((20 * Math.PI) / 180);  // facets of a round part meet at less
const MERIDIAN = 4;  // of their edges each so many is drawn
const SAME = Math.cos((0.5 * Math.PI) / 180);

// A solid with its corners told apart by place: triangles, a normal for each, who meets whom.
function solid({ vertices = [], triangles = [] }) {
  const points = [];
  const byPlace = new Map();
  const index = [];
  for (let i = 0; i + 2 < vertices.length; i += 3) {
    const p = new Vector3(vertices[i], vertices[i + 1], vertices[i + 2]);
    const key = `${p.x.toFixed(7)} ${p.y.toFixed(7)} ${p.z.toFixed(7)}`;
    if (!byPlace.has(key)) byPlace.set(key, points.push(p) - 1);
    index.push(byPlace.get(key));
  }
  const middle = points.reduce((sum, p) => sum.add(p), new Vector3());
  middle.divideScalar(Math.max(1, points.length));
  const faces = [];
  const faceOf = new Map();  // the face on the left of an edge from one corner to another
  const around = points.map(() => []);
  for (let i = 0; i + 2 < triangles.length; i += 3) {
    const corners = [0, 1, 2].map((k) => index[triangles[i + k]]);
    if (corners.some((c) => c === undefined)) continue;
    const [a, b, c] = corners.map((corner) => points[corner]);
    const normal = new Vector3().subVectors(b, a).cross(new Vector3().subVectors(c, a));
    const area = normal.length() / 2;
    if (!(area > 1e-14)) continue;
    normal.divideScalar(2 * area);
    if (normal.dot(a) - normal.dot(middle) < -1e-9) {  // told clockwise
      normal.negate();
      corners.reverse();
    }
    const face = { corners, normal, area };
    faces.push(face);
    corners.forEach((corner, k) => {
      faceOf.set(`${corner}>${corners[(k + 1) % 3]}`, face);
      around[corner].push(face);
    });
  }
  return { points, faces, faceOf, around };
}

function geometryOf(positions, normals) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  if (normals) geometry.setAttribute("normal", new BufferAttribute(new Float32Array(normals), 3));
  return geometry;
}

// The corners of the box around it.
export function cornersOf(geometry) {
  geometry.computeBoundingBox();
  const { min, max } = geometry.boundingBox;
  return Array.from({ length: 8 }, (_, k) => new Vector3(
    k & 1 ? max.x : min.x, k & 2 ? max.y : min.y, k & 4 ? max.z : min.z));
}

// The surface, with a normal for each corner of each triangle: the mean over the faces around that
// meet it smoothly.
export function surface(level) {
  const { points, faces, around } = solid(level);
  const positions = [];
  const normals = [];
  const mean = new Vector3();
  for (const face of faces) {
    for (const corner of face.corners) {
      positions.push(...points[corner].toArray());
      mean.set(0, 0, 0);
      for (const other of around[corner]) {
        if (other.normal.dot(face.normal) > CREASE) mean.addScaledVector(other.normal, other.area);
      }
      normals.push(...mean.normalize().toArray());
    }
  }
  return geometryOf(positions, normals);
}

// The segments where faces meet at more than an angle, or where there is only one.
function segments({ points, faces, faceOf }, least, meridian = 0) {
  const out = [];
  let facets = 0;
  for (const face of faces) {
    face.corners.forEach((from, k) => {
      const to = face.corners[(k + 1) % 3];
      const other = faceOf.get(`${to}>${from}`);
      if (other && from > to) return;  // it is met again from the other side
      const bend = other ? other.normal.dot(face.normal) : -1;
      if (bend > SAME) return;
      if (bend > least && (meridian === 0 || facets++ % meridian > 0)) return;
      out.push(...points[from].toArray(), ...points[to].toArray());
    });
  }
  return out;
}

export const edges = (level) => geometryOf(segments(solid(level), CREASE));

// What is left of a part at a depth, as lines; a line where it is one, a small cross for a point.
function frame(level, inner) {
  const body = solid(level);
  if (body.faces.length > 0) return segments(body, FACET, inner ? MERIDIAN : 0);
  const points = body.points;
  if (points.length > 1) {
    return points.slice(1).flatMap((p, k) => [...points[k].toArray(), ...p.toArray()]);
  }
  if (points.length === 0) return [];
  const [x, y, z] = points[0].toArray();
  const s = 0.004;
  return [x - s, y, z, x + s, y, z, x, y - s, z, x, y + s, z, x, y, z - s, x, y, z + s];
}

// All levels in one geometry; `groups[k]` is [start, count] of level k.
// The deeper, the stronger they are drawn.
export function levelFrames(levels) {
  const positions = [];
  const colours = [];
  const groups = [];
  for (const level of levels) {
    const start = positions.length / 3;
    positions.push(...frame(level, groups.length > 0));
    const count = positions.length / 3 - start;
    const strength = 0.2 + (0.8 * groups.length) / Math.max(1, levels.length - 1);
    for (let k = 0; k < count; ++k) colours.push(1, 1, 1, strength);
    groups.push([start, count]);
  }
  const geometry = geometryOf(positions);
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(colours), 4));
  return { geometry, groups };
}

// The corners of a face or of what is put between faces, as triangles around the first.
function fan(corners, positions) {
  for (let k = 1; k + 1 < corners.length; ++k) {
    for (const c of [corners[0], corners[k], corners[k + 1]]) positions.push(...c.toArray());
  }
}

// The surface at a distance outside of the part: each face moved out, a strip along each edge, a
// patch at each corner.
export function shell(level, distance) {
  const body = solid(level);
  const { points, faces, faceOf, around } = body;
  const positions = [];
  const out = (corner, normal) => points[corner].clone().addScaledVector(normal, distance);
  for (const face of faces) {
    fan(face.corners.map((corner) => out(corner, face.normal)), positions);
    face.corners.forEach((from, k) => {
      const to = face.corners[(k + 1) % 3];
      const other = faceOf.get(`${to}>${from}`);
      if (!other || from > to) return;
      fan([out(from, face.normal), out(from, other.normal), out(to, other.normal),
           out(to, face.normal)], positions);
    });
  }
  points.forEach((_, corner) => {
    const normals = ordered(around[corner].map((face) => face.normal));
    fan(normals.map((normal) => out(corner, normal)), positions);
  });
  return geometryOf(positions);
}

// The normals around a corner in the order in which they go round it, each once.
function ordered(normals) {
  const own = normals.filter((n, k) => normals.findIndex((m) => m.dot(n) > SAME) === k);
  if (own.length < 3) return [];
  const mean = own.reduce((sum, n) => sum.add(n), new Vector3()).normalize();
  const x = own[0].clone().addScaledVector(mean, -own[0].dot(mean)).normalize();
  const y = new Vector3().crossVectors(mean, x);
  return own.sort((a, b) => Math.atan2(a.dot(y), a.dot(x)) - Math.atan2(b.dot(y), b.dot(x)));
}

// Corners told apart by place, to a micrometre: for each vertex the first one in the same place.
function places(vertices) {
  const count = vertices.length / 3;
  const first = new Int32Array(count);
  const seen = new Map();
  const grid = (i) => Math.round(1e6 * vertices[i]);
  for (let k = 0; k < count; ++k) {
    const [x, y, z] = [grid(3 * k), grid(3 * k + 1), grid(3 * k + 2)];
    const key = (x * 73856093) ^ (y * 19349663) ^ (z * 83492791);
    const others = seen.get(key) ?? [];
    const same = others.find((o) => grid(3 * o) === x && grid(3 * o + 1) === y &&
                                    grid(3 * o + 2) === z);
    first[k] = same ?? k;
    if (same !== undefined) continue;
    others.push(k);
    seen.set(key, others);
  }
  return first;
}

// Any surface, convex or not: { positions, normals } of the three corners of each triangle, smooth
// where it is round and sharp at its creases. The triangles are taken the way they are told.
export function creased({ vertices, triangles }) {
  const first = places(vertices);
  const faces = [];
  const around = new Map();
  const point = (k) => new Vector3().fromArray(vertices, 3 * k);
  for (let i = 0; i + 2 < triangles.length; i += 3) {
    const corners = [triangles[i], triangles[i + 1], triangles[i + 2]];
    if (corners.some((k) => first[k] === undefined)) continue;
    const [a, b, c] = corners.map(point);
    const normal = b.sub(a).cross(c.sub(a));
    const area = normal.length();
    if (!(area > 0)) continue;
    const face = { corners, normal: normal.divideScalar(area), area };
    faces.push(face);
    for (const k of corners) {
      if (!around.has(first[k])) around.set(first[k], []);
      around.get(first[k]).push(face);
    }
  }
  const positions = new Float32Array(9 * faces.length);
  const normals = new Float32Array(9 * faces.length);
  const mean = new Vector3();
  faces.forEach(({ corners, normal }, f) => corners.forEach((k, c) => {
    mean.set(0, 0, 0);
    for (const other of around.get(first[k])) {
      if (other.normal.dot(normal) > CREASE) mean.addScaledVector(other.normal, other.area);
    }
    mean.normalize().toArray(normals, 9 * f + 3 * c);
    positions.set(vertices.slice(3 * k, 3 * k + 3), 9 * f + 3 * c);
  }));
  return { positions, normals };
}
