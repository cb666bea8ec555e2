// SPDX-License-Identifier: BSD-3-Clause
// The floor under the scene: a disc that fades into what is behind it, its grid, the shadows on it,
// and darker rims where things stand on it, which need no shadows.

import {
  BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  MeshBasicMaterial, PlaneGeometry, Quaternion, ShadowMaterial, Vector3,
} from "./vendor/three.min.js";
import { colour } from "./theme.js";

// In parts of the radius of the scene.
const DISC = [[0, 1], [0.9, 1], [1.5, 0.6], [2.2, 0.15], [2.8, 0]];  // radius, share of its colour
const RIM = [[0, 0.34], [0.02, 0.18], [0.05, 0.06], [0.1, 0]];  // distance, opacity
const STANDS = 0.02;  // height up to which something stands on the floor
const GRID = 1.9;
const AROUND = 48;  // corners of the disc
const WORLD = 0;  // the body that stands still
const ONE = new Vector3(1, 1, 1);

const faded = { transparent: true, depthWrite: false, vertexColors: true };

export class Floor extends Group {
  constructor() {
    super();
    // Not seen through: where the processor draws, mixing so many pixels would take long.
    this.disc = new Mesh(new BufferGeometry(),
                         new MeshBasicMaterial({ vertexColors: true, depthWrite: false }));
    this.disc.renderOrder = 1;  // after what hides it
    this.rims = new Mesh(new BufferGeometry(), new MeshBasicMaterial(faded));
    this.grid = new LineSegments(new BufferGeometry(), new LineBasicMaterial(faded));
    this.shade = new Mesh(new PlaneGeometry(1, 1),
                          new ShadowMaterial({ transparent: true, depthWrite: false }));
    this.shade.receiveShadow = true;
    [this.rims, this.shade, this.grid].forEach((layer, k) => (layer.renderOrder = k - 3));
    this.add(this.disc, this.rims, this.shade, this.grid);
  }

  // Under a scene in a sphere of that radius, above a point of the floor. Returns the spacing of
  // the grid [m].
  lay(scene, middle, radius) {
    const spacing = 10 ** Math.floor(Math.log10(radius / 2.5));
    this.position.copy(middle);
    this.position.z -= 0.002;
    this.shade.scale.setScalar(8 * radius);
    const grid = gridOf(middle, GRID * radius, spacing);
    const away = DISC.map(([far, opacity]) => [far * radius, opacity]);
    const disc = new Fade();
    disc.around([[0, 0]], away, AROUND);
    const rims = new Fade();
    const near = RIM.map(([far, opacity]) => [far * radius, opacity]);
    for (const outline of standing(scene, middle.z + STANDS * radius)) {
      rims.around(outline.map(([x, y]) => [x - middle.x, y - middle.y]), near, 4);
    }
    for (const [layer, { positions, shades }] of [[this.disc, disc], [this.rims, rims],
                                                  [this.grid, grid]]) {
      layer.geometry.dispose();
      layer.geometry = new BufferGeometry();
      layer.geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
      layer.geometry.setAttribute("color", new BufferAttribute(new Float32Array(shades), 4));
    }
    this.#mix();
    return spacing;
  }

  // The disc, with what is behind it.
  #mix() {
    const { color } = this.disc.geometry.attributes;
    const [floor, sky, mixed] = [new Color(colour("floor")), new Color(colour("sky")), new Color()];
    for (let k = 0; k < (color?.count ?? 0); ++k) {
      mixed.lerpColors(sky, floor, color.getW(k));
      color.setXYZ(k, mixed.r, mixed.g, mixed.b);
    }
    if (color) color.needsUpdate = true;
  }

  paint() {
    this.#mix();
    this.grid.material.color.set(colour("grid"));
    for (const { material } of [this.rims, this.shade]) material.color.set(colour("shadow"));
    this.shade.material.opacity = Number(colour("shade"));
  }
}

// Triangles on the floor that fade outwards.
class Fade {
  positions = [];
  shades = [];

  #corner([x, y], opacity) {
    this.positions.push(x, y, 0);
    this.shades.push(1, 1, 1, opacity);
  }

  // A convex outline, counterclockwise, that is filled, and bands around it: `bands` are pairs of a
  // distance and the opacity there, from 0 on. `corners`: steps in which they turn round a corner.
  around(outline, bands, corners) {
    const spokes = outline.flatMap((p, k) => {
      const before = outline.at(k - 1);
      const after = outline[(k + 1) % outline.length];
      const from = Math.atan2(before[0] - p[0], p[1] - before[1]);  // of the edges' normals
      let turn = Math.atan2(p[0] - after[0], after[1] - p[1]) - from;
      if (turn <= 0) turn += 2 * Math.PI;
      return Array.from({ length: corners + 1 }, (_, i) => {
        const angle = from + (turn * i) / corners;
        return (far) => [p[0] + far * Math.cos(angle), p[1] + far * Math.sin(angle)];
      });
    });
    for (let k = 2; k < outline.length; ++k) {
      for (const p of [outline[0], outline[k - 1], outline[k]]) this.#corner(p, bands[0][1]);
    }
    spokes.forEach((spoke, k) => {
      const next = spokes[(k + 1) % spokes.length];
      for (let b = 1; b < bands.length; ++b) {
        const [inner, outer] = [bands[b - 1], bands[b]];
        const quad = [[spoke, inner], [spoke, outer], [next, outer], [next, inner]];
        for (const i of [0, 1, 2, 0, 2, 3]) {
          const [side, [far, opacity]] = quad[i];
          this.#corner(side(far), opacity);
        }
      }
    });
  }
}

// The outlines, from above, of what stands still below a height.
function standing({ parts, visuals }, height) {
  const still = [...parts.map((part) => ({ ...part, vertices: part.levels[0]?.vertices ?? [] })),
                 ...visuals].filter(({ body }) => body === WORLD);
  return still.map(({ pose, vertices }) => {
    const matrix = matrixOf(pose);
    const points = [];
    const point = new Vector3();
    for (let k = 0; k + 2 < vertices.length; k += 3) {
      point.fromArray(vertices, k).applyMatrix4(matrix);
      if (point.z < height) points.push([point.x, point.y]);
    }
    return hull(points);
  }).filter((outline) => outline.length > 2);
}

export function matrixOf(pose) {
  if (!pose) return new Matrix4();
  const turn = new Quaternion().fromArray(pose, 3).normalize();
  return new Matrix4().compose(new Vector3().fromArray(pose), turn, ONE);
}

// The convex hull, counterclockwise.
function hull(points) {
  const half = (sorted) => {
    const chain = [];
    for (const p of sorted) {
      while (chain.length > 1) {
        const [a, b] = chain.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 1e-9) break;
        chain.pop();
      }
      chain.push(p);
    }
    return chain.slice(0, -1);
  };
  const sorted = points.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  return [...half(sorted), ...half(sorted.toReversed())];
}

// Lines that fade towards the rim; each tenth is stronger.
function gridOf(center, radius, spacing) {
  const positions = [];
  const shades = [];
  const pieces = 16;
  const shade = (x, y, strong) =>
    Math.max(0, 1 - Math.hypot(x, y) / radius) * (strong ? 0.75 : 0.3);
  const line = (value, axis, strong) => {
    for (let k = 0; k < pieces; ++k) {
      for (const end of [k, k + 1]) {
        const other = radius * ((2 * end) / pieces - 1);
        const [x, y] = axis === 0 ? [value, other] : [other, value];
        positions.push(x, y, 0);
        shades.push(1, 1, 1, shade(x, y, strong));
      }
    }
  };
  for (const [axis, middle] of [[0, center.x], [1, center.y]]) {
    const first = Math.ceil((middle - radius) / spacing);
    const last = Math.floor((middle + radius) / spacing);
    for (let k = first; k <= last; ++k) line(k * spacing - middle, axis, k % 10 === 0);
  }
  return { positions, shades };
}
