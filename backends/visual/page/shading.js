// SPDX-License-Identifier: BSD-3-Clause
// Where the processor draws, a pixel costs what its shader computes: then light, and the step from
// linear colour to that of the screen, are computed at corners. Faces that are flat look the same,
// and others hardly differ. Shadows are seen between corners, so with them it stays as three.js has
// it.

import { LineBasicMaterial, MeshBasicMaterial, MeshLambertMaterial } from "./vendor/three.min.js";

const DECLARED = `
  uniform vec3 diffuse;
  uniform float opacity;
  varying vec4 vPaint;
  vec4 paint(vec3 light) {
    vec4 linear = vec4(diffuse * light, opacity);
    #if defined(USE_COLOR) || defined(USE_COLOR_ALPHA) || defined(USE_INSTANCING_COLOR)
      linear *= vColor;
    #endif
    vec3 c = linear.rgb;
    vec3 shown = mix(1.055 * pow(c, vec3(0.41666)) - 0.055, 12.92 * c,
                     vec3(lessThanEqual(c, vec3(0.0031308))));
    return vec4(shown, linear.a);
  }`;
// Where three.js says so, what a corner tells of opacity does not count.
const OPAQUE = `
    #ifdef OPAQUE
      gl_FragColor.a = 1.0;
    #endif`;
const PAINTED = `
  varying vec4 vPaint;
  void main() {
    gl_FragColor = vPaint;${OPAQUE}
  }`;

const LIT = `
  #include <lights_pars_begin>
  varying vec4 vBack;
  vec3 lightAt(vec3 normal) {
    vec3 sum = getHemisphereLightIrradiance(hemisphereLights[0], normal);
    DirectionalLight sun = directionalLights[0];
    return RECIPROCAL_PI * (sum + saturate(dot(normal, sun.direction)) * sun.color);
  }`;
const LIT_PAINTED = `
  varying vec4 vPaint;
  varying vec4 vBack;
  void main() {
    #ifdef DOUBLE_SIDED
      gl_FragColor = gl_FrontFacing ? vPaint : vBack;
    #else
      gl_FragColor = vPaint;
    #endif
  }`;
const UNSHADED = "#if NUM_DIR_LIGHT_SHADOWS == 0\n";

const into = (vertexShader, declared, computed) =>
  vertexShader.replace("void main() {", `${declared}\nvoid main() {`)
    .replace(/}\s*$/, `${computed}\n}`);

// As three.js asks each material before it compiles it.
function atCorners(shader) {
  if (this.map || this.isLineDashedMaterial) return;
  if (!this.isMeshLambertMaterial) {
    shader.vertexShader = into(shader.vertexShader, DECLARED, "vPaint = paint(vec3(1.0));");
    shader.fragmentShader = PAINTED;
    return;
  }
  shader.vertexShader = into(
    shader.vertexShader, `\n${UNSHADED}${DECLARED}${LIT}\n#endif`,
    `\n${UNSHADED}
      vec3 normalHere = normalize(transformedNormal);
      vPaint = paint(lightAt(normalHere));
      vBack = paint(lightAt(-normalHere));
    #endif`);
  shader.fragmentShader = `${UNSHADED}${LIT_PAINTED}\n#else\n${shader.fragmentShader}\n#endif`;
}

// Of all materials that are made from now on.
export function shadeAtCorners() {
  for (const { prototype } of [LineBasicMaterial, MeshBasicMaterial, MeshLambertMaterial]) {
    prototype.onBeforeCompile = atCorners;
  }
}
