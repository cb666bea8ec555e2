// SPDX-License-Identifier: BSD-3-Clause
// What shiny surfaces mirror, where a graphics card draws: a dim room, brighter above, with strips
// of light on its walls, of which round parts show streaks. It is made here, once; z is up.

import {
  BufferAttribute, Mesh, MeshBasicMaterial, PlaneGeometry, PMREMGenerator, Scene, SphereGeometry,
} from "./vendor/three.min.js";

const INSIDE = 1;  // of a surface, as three.js counts them
const FLOOR = 0.1;  // radiance, of a white surface in full light 1
const CEILING = 0.5;
const STRIP = 7;
const BLUR = 0.03;  // [rad]
// Where each strip is, and its width and height, in a room of radius 10.
const STRIPS = [
  [[-5, -7, 3.5], 1.6, 6],
  [[7, -3, 3], 1.2, 7],
  [[2, 8, 4], 2.4, 4],
  [[-2, 0, 8.5], 4, 1],
];

function walls() {
  const geometry = new SphereGeometry(10, 32, 16);
  const { position } = geometry.attributes;
  const shades = new Float32Array(3 * position.count);
  for (let k = 0; k < position.count; ++k) {
    const height = position.getZ(k) / 20 + 0.5;
    shades.fill(FLOOR + (CEILING - FLOOR) * height, 3 * k, 3 * k + 3);
  }
  geometry.setAttribute("color", new BufferAttribute(shades, 3));
  return new Mesh(geometry, new MeshBasicMaterial({ vertexColors: true, side: INSIDE }));
}

function strip([place, width, height]) {
  const material = new MeshBasicMaterial();
  material.color.setScalar(STRIP);
  const mesh = new Mesh(new PlaneGeometry(width, height), material);
  mesh.up.set(0, 0, 1);
  mesh.position.fromArray(place);
  mesh.lookAt(0, 0, 0);
  return mesh;
}

// The texture for a scene that the renderer draws.
export function environment(renderer) {
  const room = new Scene().add(walls(), ...STRIPS.map(strip));
  const generator = new PMREMGenerator(renderer);
  const { texture } = generator.fromScene(room, BLUR);
  generator.dispose();
  room.traverse((object) => {
    object.geometry?.dispose();
    object.material?.dispose();
  });
  return texture;
}
