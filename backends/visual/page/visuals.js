// SPDX-License-Identifier: BSD-3-Clause
// The robot as it looks: meshes that move with the bodies and exert no force. Those of one body are
// drawn in one call, and so are those of one link without a body, of which a frame says where it is.

import { BufferAttribute, BufferGeometry, Color, DoubleSide, Mesh } from "./vendor/three.min.js";
import { matrixOf } from "./floor.js";
import { cornersOf, creased } from "./geometry.js";
import { place } from "./parts.js";
import { settings } from "./settings.js";
import { colour, onTheme } from "./theme.js";

const BASE = 0;  // the body that stands still
const NEAR = 1.3;  // of the radius of the scene

export class Visuals {
  #bodies = new Map();  // by body: its mesh
  #links = [];  // of those without a body: { mesh, arm, k }, the k-th that a frame tells of that arm
  #base = [];  // corners of boxes around each that stands still
  #plain = [];  // [mesh, first corner, number of corners] of what has no colour of its own

  constructor(stage, parts) {
    this.stage = stage;
    this.parts = parts;
    const painted = { vertexColors: true, side: DoubleSide };
    this.whole = stage.surface(painted);
    this.seeThrough = stage.surface({ ...painted, transparent: true, opacity: 0.22,
                                      depthWrite: false });
    onTheme(() => this.#paint());
  }

  get any() {
    return this.#links.length > 0 || [...this.#bodies.keys()].some((body) => body !== BASE);
  }

  // After the parts of the scene, on whose bodies it hangs.
  build(scene) {
    for (const mesh of this.#meshes()) {
      mesh.geometry.dispose();
      mesh.removeFromParent();
    }
    this.#bodies.clear();
    this.#links.length = 0;
    this.#plain.length = 0;
    this.#base.length = 0;
    this.parts.bodies.forEach((group, body) => {
      const mesh = this.#build(scene.visuals.filter((visual) => visual.body === body), group);
      if (mesh) this.#bodies.set(body, mesh);
    });
    scene.arms.forEach(({ links }, arm) => links.forEach((link, k) => {
      const own = scene.visuals.filter((visual) => visual.arm === arm && visual.link === link);
      const mesh = this.#build(own, this.stage.scene);
      if (mesh) this.#links.push({ mesh, arm, k });
    }));
    this.parts.dressed = new Set(this.#bodies.keys());
    this.#paint();
  }

  #meshes() {
    return [...this.#bodies.values(), ...this.#links.map(({ mesh }) => mesh)];
  }

  // One mesh of them all, on what they move with; null: there is nothing to be seen.
  #build(visuals, holder) {
    const surfaces = visuals.map((visual) => creased(visual));
    const count = surfaces.reduce((sum, { positions }) => sum + positions.length / 3, 0);
    if (count === 0) return null;
    const attribute = () => new BufferAttribute(new Float32Array(3 * count), 3);
    const geometry = new BufferGeometry();
    for (const name of ["position", "normal", "color"]) geometry.setAttribute(name, attribute());
    const mesh = new Mesh(geometry, this.whole);
    let first = 0;
    visuals.forEach(({ body, pose, color }, k) => {
      const { positions, normals } = surfaces[k];
      const corners = positions.length / 3;
      const placed = new BufferGeometry();
      placed.setAttribute("position", new BufferAttribute(positions, 3));
      placed.setAttribute("normal", new BufferAttribute(normals, 3));
      placed.applyMatrix4(matrixOf(pose));
      if (body === BASE) this.#base.push(...cornersOf(placed));
      geometry.attributes.position.array.set(placed.attributes.position.array, 3 * first);
      geometry.attributes.normal.array.set(placed.attributes.normal.array, 3 * first);
      const range = [mesh, first, corners];
      if (color) fill(range, new Color().setRGB(color[0], color[1], color[2], "srgb"));
      else this.#plain.push(range);
      first += corners;
    });
    mesh.castShadow = mesh.receiveShadow = true;
    holder.add(mesh);
    return mesh;
  }

  // Where the links are that have no body. `arms`: of a frame.
  move(arms) {
    for (const { mesh, arm, k } of this.#links) place(mesh, arms[arm]?.links[k]);
  }

  // Whether the robot is drawn as it looks. With the reduction levels its parts are seen, which
  // have them.
  get shown() {
    return settings.robot === "looks" && settings.levels === "none";
  }

  // By mesh that is seen: the body that it shows.
  seenMeshes() {
    return new Map([...this.#bodies].filter(([, mesh]) => mesh.visible && mesh.parent?.visible)
      .map(([body, mesh]) => [mesh, body]));
  }

  // The base has no parts of its own, and stands there either way.
  show() {
    for (const mesh of this.#meshes()) {
      mesh.visible = this.shown || mesh === this.#bodies.get(BASE);
    }
    for (const [body, mesh] of this.#bodies) {
      if (body !== BASE && this.parts.isBodyHidden(body)) mesh.visible = false;
    }
    this.stage.invalidate();
  }

  // Corners of boxes around what stands still near the parts: the foot of a robot belongs into the
  // picture, a hall does not.
  corners() {
    const { center, radius } = this.stage.sphere;
    return this.#base.filter((corner) => corner.distanceTo(center) < NEAR * radius)
      .map((corner) => corner.clone());
  }

  // Makes what hides the tool see-through. `hiding`: the bodies of which a part does; a link without
  // a body has no parts that would tell, so its looks are asked whether they hide these points.
  clear(hiding, eye, points) {
    const { whole, seeThrough } = this;
    for (const [body, mesh] of this.#bodies) {
      mesh.material = hiding.has(body) ? seeThrough : whole;
    }
    for (const { mesh } of this.#links) {
      mesh.material = this.shown && this.parts.hides(mesh, eye, points) ? seeThrough : whole;
    }
  }

  get count() {
    return this.#meshes().filter((mesh) => mesh.visible).length;
  }

  get linkPoses() {
    return this.#links.map(({ mesh }) => [...mesh.position.toArray(),
                                          ...mesh.quaternion.toArray()]);
  }

  #paint() {
    const link = new Color(colour("link"));
    for (const range of this.#plain) fill(range, link);
    this.show();
  }
}

function fill([mesh, first, count], { r, g, b }) {
  const { color } = mesh.geometry.attributes;
  for (let k = first; k < first + count; ++k) color.setXYZ(k, r, g, b);
  color.needsUpdate = true;
}
