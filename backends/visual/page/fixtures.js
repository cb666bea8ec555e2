// SPDX-License-Identifier: BSD-3-Clause
// Virtual fixtures, which attract the tool: thin marks that one sees through, fainter while off.

import {
  BufferAttribute, BufferGeometry, ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial,
  PlaneGeometry, SphereGeometry, Vector3,
} from "./vendor/three.min.js";
import { settings } from "./settings.js";
import { state } from "./state.js";
import { colour, onTheme } from "./theme.js";
import { at } from "./words.js";

const BOTH_SIDES = 2;  // as three.js counts them
const AROUND = 16;  // corners of a section
// Parts of the radius of the scene: how thick a mark is, and how far what has no end is drawn.
const THIN = 0.0035;
const FAR = 0.3;
const OPACITY = { mark: [0.22, 0.75], area: [0.06, 0.2] };  // off, on

const material = () => new MeshBasicMaterial({ transparent: true, depthWrite: false,
                                               side: BOTH_SIDES });

export class Fixtures {
  count = { fixtures: 0, on: 0 };
  #drawn = [];  // of each: its arm, its name, what is drawn
  #due = null;  // the scene that is to be built: only with a frame is it known how large it is
  #materials = { mark: [material(), material()], area: [material(), material()] };

  constructor(stage) {
    this.stage = stage;
    onTheme(() => {
      for (const [kind, pair] of Object.entries(this.#materials)) {
        pair.forEach((each, on) => {
          each.color.set(colour("fixture"));
          each.opacity = OPACITY[kind][on];
        });
      }
      stage.invalidate();
    });
  }

  scene(scene) {
    this.#due = scene;
    const any = scene.arms.some((arm) => arm.fixtures.length > 0);
    at("fixture-key").hidden = !any;
    at("show-fixtures-row").hidden = !any;
  }

  update(frame) {
    if (this.#due) this.#build(this.#due);
    this.#due = null;
    this.count = { fixtures: 0, on: 0 };
    for (const { arm, name, group } of this.#drawn) {
      const on = frame.arms[arm]?.guides?.includes(name) === true;
      group.visible = settings.fixtures;
      for (const mesh of group.children) mesh.material = this.#materials[mesh.name][Number(on)];
      this.count.fixtures += group.visible ? 1 : 0;
      this.count.on += group.visible && on ? 1 : 0;
    }
  }

  #build(scene) {
    for (const { group } of this.#drawn) {
      for (const mesh of group.children) mesh.geometry.dispose();
      group.removeFromParent();
    }
    this.#drawn = scene.arms.flatMap((arm, k) => arm.fixtures.map((fixture) => {
      const group = new Group();
      for (const [kind, geometry] of shapesOf(fixture, state.radius)) {
        const mesh = new Mesh(geometry, this.#materials[kind][0]);
        mesh.name = kind;
        mesh.renderOrder = 5;
        group.add(mesh);
      }
      const { pose } = fixture;
      if (pose) {
        group.position.set(pose[0], pose[1], pose[2]);
        group.quaternion.set(pose[3], pose[4], pose[5], pose[6]).normalize();
      }
      this.stage.scene.add(group);
      return { arm: k, name: fixture.name, group };
    }));
  }
}

// Pairs of the kind of a surface and its geometry, in the frame of the fixture.
function shapesOf({ shape, radius_m, half_angle_rad, course }, size) {
  const thin = THIN * size;
  const far = FAR * size;
  const rod = (radius) =>
    new CylinderGeometry(radius, radius, 2 * far, AROUND, 1, true).rotateX(Math.PI / 2);
  switch (shape) {
    case "point":
      return [["mark", new SphereGeometry(2 * thin, 12, 8)],
              ...(radius_m > 0 ? [["area", new SphereGeometry(radius_m, 24, 16)]] : [])];
    case "axis":
      return [["mark", rod(thin)],
              ["mark", new ConeGeometry(3 * thin, 8 * thin, 12).rotateX(Math.PI / 2)]];
    case "line":
      return [["mark", rod(thin)]];
    case "plane":
      return (radius_m > 0 ? [-radius_m, radius_m] : [0])
        .map((z) => ["area", new PlaneGeometry(2 * far, 2 * far).translate(0, 0, z)]);
    case "cone": {
      const height = far / 2;
      const wide = height * Math.tan(half_angle_rad);
      const cone = new ConeGeometry(wide, height, 32, 1, true).rotateX(-Math.PI / 2);
      return [["mark", new SphereGeometry(1.5 * thin, 10, 8)],
              ["area", cone.translate(0, 0, height / 2)]];
    }
    case "path":
      return [["mark", sweep(course, thin)]];
    case "tube":
      return course.length > 0 ? [["mark", sweep(course, thin)], ["area", sweep(course, radius_m)]]
                               : [["mark", rod(thin)], ["area", rod(radius_m)]];
    default:
      return [];
  }
}

// A tube of a radius around a course. Its section is carried on without turning about it.
function sweep(course, radius) {
  const points = course.map((p) => new Vector3().fromArray(p));
  const positions = [];
  const across = new Vector3();
  let ring = null;
  points.forEach((p, k) => {
    const along = new Vector3()
      .subVectors(points[Math.min(k + 1, points.length - 1)], points[Math.max(k - 1, 0)]);
    along.normalize();
    if (k === 0) across.set(Math.abs(along.x) < 0.6 ? 1 : 0, Math.abs(along.x) < 0.6 ? 0 : 1, 0);
    across.addScaledVector(along, -across.dot(along)).normalize();
    const side = new Vector3().crossVectors(along, across);
    const next = [];
    for (let i = 0; i <= AROUND; ++i) {
      const turn = (2 * Math.PI * i) / AROUND;
      next.push(p.clone().addScaledVector(across, radius * Math.cos(turn))
        .addScaledVector(side, radius * Math.sin(turn)));
    }
    for (let i = 0; ring && i < AROUND; ++i) {
      const corners = [ring[i], ring[i + 1], next[i + 1], ring[i], next[i + 1], next[i]];
      for (const corner of corners) positions.push(...corner.toArray());
    }
    ring = next;
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  return geometry;
}
