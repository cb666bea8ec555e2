// SPDX-License-Identifier: BSD-3-Clause
// The parts of the scene: solids on bodies that move, their edges, zones of influence, levels.

import {
  BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineDashedMaterial,
  LineSegments, Mesh, MeshBasicMaterial, Quaternion, Raycaster, Vector3,
} from "./vendor/three.min.js";
import { cornersOf, edges, levelFrames, shell, surface } from "./geometry.js";
import { Looks } from "./looks.js";
import { banner } from "./messages.js";
import { settings } from "./settings.js";
import { colour, onTheme } from "./theme.js";

const PASSABLE = 0.34;  // opacity, at most, of what may be passed

const MOST_CORNERS = 300000;  // more take seconds to build, and slow each picture

export function place(object, pose) {
  if (!pose) return;
  object.position.set(pose[0], pose[1], pose[2]);
  object.quaternion.set(pose[3], pose[4], pose[5], pose[6]).normalize();
}

export class Parts {
  #materials = {
    zone: new MeshBasicMaterial({ transparent: true, opacity: 0.07, depthWrite: false }),
    edge: new LineBasicMaterial({ transparent: true, opacity: 0.55 }),
    dashed: new LineDashedMaterial({ dashSize: 0.012, gapSize: 0.008 }),
    level: new LineBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }),
    ghost: new MeshBasicMaterial({ transparent: true, opacity: 0.22, depthTest: false }),
  };

  #corners = [];  // by part: those that are drawn, of all levels
  #drawn = 0;  // the sum of these
  #left = new Set();  // parts that are not drawn
  #hidden = new Set();  // parts that somebody has hidden
  #marked = { selected: new Set(), highlighted: new Set() };
  #ray = new Raycaster();
  #along = new Vector3();
  #hits = [];

  constructor(stage) {
    this.stage = stage;
    this.looks = new Looks(stage);
    this.faint = stage.surface({ transparent: true, opacity: 0.3, depthWrite: false });
    this.bodies = [];
    this.outlines = [];  // by body: the edges of its parts
    this.parts = [];
    this.dressed = new Set();  // the bodies of which it is drawn how they look
    onTheme(() => this.#paint());
  }

  // Everything of a scene, in place of what was there before.
  build(scene) {
    this.scene = scene;
    this.#hidden.clear();
    for (const set of Object.values(this.#marked)) set.clear();
    for (const body of this.bodies) this.#drop(body);
    this.bodies = scene.bodies.map(() => new Group());
    for (const body of this.bodies) this.stage.scene.add(body);
    this.#corners = scene.parts.map(() => 0);
    this.#drawn = 0;
    this.#left.clear();
    this.parts = scene.parts.map((part, k) => this.#part(this.#bounded(part, k)));
    this.outlines = this.bodies.map((body) => {
      const lines = new LineSegments(new BufferGeometry(), this.#materials.edge);
      body.add(lines);
      return lines;
    });
    this.bodies.forEach((_, k) => this.#outline(k));
    this.mostLevels = Math.max(1, ...this.parts.map((part) => part.groups.length));
    this.showLevels();
    this.showZones();
    this.#sayLeft();
  }

  // Gives parts other shapes.
  reshape(shapes) {
    for (const { part: k, levels } of shapes) {
      const { holder, body, group } = this.parts[k] ?? {};
      if (!holder) continue;
      holder.traverse((object) => object.geometry?.dispose());
      holder.removeFromParent();
      const pose = [...holder.position.toArray(), ...holder.quaternion.toArray()];
      const bounded = this.#bounded({ ...this.scene.parts[k], levels, group, body, pose }, k);
      this.parts[k] = this.#part(bounded);
      this.parts[k].holder.visible = !this.#hidden.has(k);
      this.#outline(body);
    }
    this.showLevels();
    this.showZones();
    this.#sayLeft();
  }

  // A part as it is, or without its shape where all together would be too much for a browser.
  #bounded(part, k) {
    const count = part.levels.reduce((sum, { vertices }) => sum + vertices.length / 3, 0);
    const others = this.#drawn - this.#corners[k];
    const fits = others + count <= MOST_CORNERS;
    this.#corners[k] = fits ? count : 0;
    this.#drawn = others + this.#corners[k];
    if (fits) this.#left.delete(k);
    else this.#left.add(k);
    return fits ? part : { ...part, levels: [] };
  }

  // Says what is left out.
  #sayLeft() {
    const { size } = this.#left;
    const parts = size === 1 ? "1 part is" : `${size} parts are`;
    banner("left", size > 0 ? `${parts} not drawn: with them there would be more than ` +
                              `${MOST_CORNERS} corners` : "", true);
  }

  #drop(body) {
    body.traverse((object) => object.geometry?.dispose());
    this.stage.scene.remove(body);
  }

  #part(part) {
    const group = ["tool", "link"].includes(part.group) ? part.group : "obstacle";
    const look = this.looks.of(part.passable ? "passable" : group, part.color,
                               Math.min(part.opacity, part.passable ? PASSABLE : 1));
    const { levels } = part;
    const holder = new Group();
    place(holder, part.pose);
    const solid = new Mesh(surface(levels[0] ?? {}), look.whole);
    solid.castShadow = solid.receiveShadow = !look.glass;
    const border = edges(levels[0] ?? {});
    if (part.passable) {
      holder.add(new LineSegments(border, this.#materials.dashed).computeLineDistances());
    }
    const { geometry, groups } = levelFrames(levels);
    const frames = new LineSegments(geometry, this.#materials.level);
    holder.add(solid, frames);
    let zone = null;
    if (part.group === "obstacle" && part.range_m > 0) {
      zone = new Mesh(shell(levels[0] ?? {}, part.range_m), this.#materials.zone);
      zone.renderOrder = 2;
      holder.add(zone);
    }
    (this.bodies[part.body] ?? this.stage.scene).add(holder);
    return { holder, solid, border: part.passable ? null : border, look, frames, groups, zone,
             group: part.group, body: part.body, hides: false, faint: false };
  }

  // The edges of all parts of a body that are seen, as one: where the processor draws, each call
  // counts.
  #outline(body) {
    const lines = this.outlines[body];
    if (!lines) return;
    const points = [];
    for (const { body: own, holder, border, solid } of this.parts) {
      if (own !== body || !border || !solid.visible || !holder.visible) continue;
      holder.updateMatrix();
      const { array } = border.attributes.position;
      for (let k = 0; k < array.length; k += 3) {
        points.push(...this.#along.fromArray(array, k).applyMatrix4(holder.matrix).toArray());
      }
    }
    lines.geometry.dispose();
    lines.geometry = new BufferGeometry();
    lines.geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
    lines.visible = points.length > 0;
  }

  // `absent`: the bodies that have not come yet, or have gone.
  move(poses, absent) {
    this.bodies.forEach((body, k) => {
      place(body, poses[k]);
      body.visible = !absent.includes(k);
    });
  }

  // Which zones are seen. `near`: parts of pairs near enough to be asked.
  showZones(near = new Set()) {
    this.parts.forEach((part, k) => {
      if (!part.zone) return;
      part.zone.visible = settings.zones === "all" || (settings.zones === "near" && near.has(k));
    });
  }

  // Under the looks of the robot its parts are not seen, but faintly where they are near something,
  // and as they are where they push. `looks`: whether these are shown.
  dress(looks, near, pushing) {
    const changed = new Set();
    this.parts.forEach((part, k) => {
      const under = looks && this.dressed.has(part.body) && part.group !== "obstacle";
      part.faint = under && !pushing.has(k);
      const seen = !under || near.has(k) || pushing.has(k);
      if (seen !== part.solid.visible) changed.add(part.body);
      part.solid.visible = seen;
      this.#give(part);
    });
    for (const body of changed) this.#outline(body);
  }

  #give({ solid, look, faint, hides }) {
    solid.material = faint ? this.faint : hides ? look.through : look.whole;
  }

  showLevels() {
    const mode = settings.levels;
    this.looks.fade(mode === "none" ? 1 : 0.25);
    for (const { frames, groups } of this.parts) {
      const one = groups[Math.min(settings.level, groups.length - 1)] ?? [0, 0];
      frames.visible = mode !== "none";
      frames.geometry.setDrawRange(...(mode === "one" ? one : [0, Infinity]));
    }
    this.stage.invalidate();
  }

  // Makes what hides one of these points from the eye see-through. Not the tool, and not glass and
  // what may be passed, which are so already. Returns the bodies that are.
  clear(eye, points) {
    const bodies = new Set();
    for (const part of this.parts) {
      if (part.look.kind === "tool" || part.look.glass) continue;
      part.hides = this.hides(part.solid, eye, points);
      if (part.hides && part.group !== "obstacle") bodies.add(part.body);
      this.#give(part);
    }
    return bodies;
  }

  // Whether it is between the eye and one of these points.
  hides(solid, eye, points) {
    return points.some((point) => this.#hides(solid, eye, point));
  }

  #hides(solid, eye, point) {
    const along = this.#along.subVectors(point, eye);
    this.#ray.far = along.length() - 0.002;  // what is touched hides nothing
    this.#ray.set(eye, along.normalize());
    this.#hits.length = 0;
    return this.#ray.intersectObject(solid, false, this.#hits).length > 0;
  }

  // Corners of boxes around all parts where they are now, or around those of one body.
  corners(body = null) {
    return this.#cornersOf(this.parts.filter((part) => [null, part.body].includes(body)));
  }

  #cornersOf(parts) {
    this.stage.scene.updateMatrixWorld();
    return parts.flatMap(({ solid: { geometry, matrixWorld } }) => {
      if (geometry.attributes.position.count === 0) return [];
      return cornersOf(geometry).map((corner) => corner.applyMatrix4(matrixWorld));
    });
  }

  // A pale copy of what moves with a body, to show where it is wanted.
  ghost(body) {
    const copy = new Group();
    for (const part of this.parts) {
      if (part.body !== body) continue;
      const solid = new Mesh(part.solid.geometry, this.#materials.ghost);
      solid.position.copy(part.holder.position);
      solid.quaternion.copy(part.holder.quaternion);
      copy.add(solid);
    }
    copy.visible = false;
    this.stage.scene.add(copy);
    return copy;
  }

  // Hides parts, or shows them again.
  hide(parts, yes) {
    for (const k of parts) {
      if (yes) this.#hidden.add(k);
      else this.#hidden.delete(k);
      this.parts[k].holder.visible = !yes;
    }
    for (const body of new Set(parts.map((k) => this.parts[k].body))) this.#outline(body);
    this.stage.invalidate();
  }

  // Not left out for want of room.
  isDrawn(k) {
    return !this.#left.has(k);
  }

  isHidden(k) {
    return this.#hidden.has(k);
  }

  // Whether all parts of a body are hidden.
  isBodyHidden(body) {
    const own = [...this.parts.keys()].filter((k) => this.parts[k].body === body);
    return own.length > 0 && own.every((k) => this.#hidden.has(k));
  }

  // Lays a light over parts: over those that are looked at, and over those that are pointed at.
  select(parts) {
    this.#mark("selected", parts);
  }

  highlight(parts) {
    this.#mark("highlighted", parts);
  }

  #mark(kind, parts) {
    for (const k of this.#marked[kind]) this.parts[k]?.[kind]?.removeFromParent();
    this.#marked[kind] = new Set(parts);
    for (const k of parts) {
      const { solid, holder } = this.parts[k];
      const light = new Mesh(solid.geometry, this.#materials.ghost);
      light.renderOrder = 3;
      this.parts[k][kind] = light;
      holder.add(light);
    }
    this.stage.invalidate();
  }

  // The lengths of the edges of a box around parts of one body, in its axes [m].
  sizeOf(parts) {
    let whole = null;
    for (const k of parts) {
      const { solid, holder } = this.parts[k];
      solid.geometry.computeBoundingBox();
      holder.updateMatrix();
      const box = solid.geometry.boundingBox.clone().applyMatrix4(holder.matrix);
      whole = whole?.union(box) ?? box;
    }
    return whole === null || whole.isEmpty() ? [0, 0, 0] : whole.getSize(new Vector3()).toArray();
  }

  // The middle of the corners of boxes around parts, in the world; null: none of them is drawn.
  centreOf(parts) {
    const corners = this.#cornersOf(parts.map((k) => this.parts[k]));
    if (corners.length === 0) return null;
    return corners.reduce((sum, corner) => sum.add(corner), new Vector3())
      .divideScalar(corners.length);
  }

  // Where a part is in the world, as a pose of the wire.
  poseOf(part) {
    const { holder } = this.parts[part] ?? {};
    if (!holder) return null;
    holder.updateWorldMatrix(true, false);
    const [position, turn] = [new Vector3(), new Quaternion()];
    holder.matrixWorld.decompose(position, turn, this.#along);
    return [...position.toArray(), ...turn.toArray()];
  }

  // By solid that is seen, and not through which something else is: its part.
  seenSolids() {
    const solids = new Map();
    this.parts.forEach(({ solid, holder, body, hides }, k) => {
      const seen = solid.visible && holder.visible && this.bodies[body]?.visible !== false;
      if (seen && !hides) solids.set(solid, k);
    });
    return solids;
  }

  // What a part hangs on, if its body is there.
  seen(part) {
    const { holder, body } = this.parts[part] ?? {};
    return this.bodies[body]?.visible === false ? null : holder;
  }

  solidsOf(body) {
    return this.parts.filter((part) => part.body === body).map((part) => part.solid);
  }

  counts() {
    const seen = (key) => this.parts.filter((part) => part.holder.visible && part[key]?.visible)
      .length;
    return { parts: seen("solid"), levels: seen("frames"), zones: seen("zone") };
  }

  #paint() {
    for (const name of ["edge", "level"]) this.#materials[name].color = new Color(colour(name));
    this.faint.color = new Color(colour("near"));
    this.#materials.zone.color = new Color(colour("near"));
    this.#materials.dashed.color = new Color(colour("passable"));
    this.#materials.ghost.color = new Color(colour("operator"));
    this.stage.invalidate();
  }
}
