// SPDX-License-Identifier: BSD-3-Clause
// What the page shows, for tests, for pictures of it and for the console: window.repel.state(),
// distanceSpan(), firstPicture(), pixels(), tinted(), reach(), project(), look(), adapt(), send(),
// keyInRoom(), toRoom(), pose().

import { Vector3 } from "./vendor/three.min.js";
import { settings } from "./settings.js";
import { state, toolPose } from "./state.js";
import { theme } from "./theme.js";

export function startProbe({ connection, stage, parts, marks, gaps, fixtures, cameras, strips,
                             visuals, headset, inspector, measure, charts, events }) {
  window.repel = {
    state() {
      const { frame, scene, operator } = state;
      const body = scene?.arms?.[0]?.tool_body;
      return {
        connected: state.connected,
        scene: scene?.name ?? null,
        mode: scene?.mode ?? null,
        tick: frame?.tick ?? null,
        time_s: frame?.time_s ?? null,
        running: frame?.running ?? null,
        phase: frame?.phase ?? null,
        operator: operator ?? null,
        pairs: frame?.pairs?.length ?? 0,
        partsInScene: scene?.parts?.length ?? 0,
        drawn: { ...parts.counts(), ...marks.counts, gaps: gaps.count, ...fixtures.count,
                 visuals: visuals.count },
        // By body: where each box from the page is, if it is there.
        boxes: (scene?.spare ?? []).map((part) => scene.parts[part].body)
          .filter((each) => !frame?.absent?.includes(each))
          .map((each) => frame?.bodies?.[each]?.slice(0, 3)),
        linkPoses: visuals.linkPoses,  // where the looks of links without a body are drawn
        toolPosition: frame?.bodies?.[body]?.slice(0, 3) ?? null,
        force: frame?.arms?.[0]?.force ?? null,
        hand: frame?.arms?.[0] ? { ...frame.arms[0], energy_j: undefined } : null,
        camera: { mode: cameras.mode, following: cameras.following,
                  position: stage.camera.position.toArray(),
                  target: cameras.controls.target.toArray() },
        inspected: inspector.body?.name ?? null,
        measured: measure.ends,
        charts: { names: charts.names, points: charts.points, paused: charts.paused },
        events: events.count,
        xr: headset.told,
        xr_latency_ms: headset.latency,  // from the frame of a pose to the command: p50, p99, max
        theme: theme(),
        quality: stage.quality.level,
        aspect: stage.camera.aspect,
        resting: connection.resting,
        settings: { ...settings },
        framesRendered: stage.rendered,
        historyLength: state.history.length,
      };
    },
    // Of the distance strip: what its axis spans [mm].
    distanceSpan: () => strips[1].span ?? null,
    firstPicture: () => stage.first,
    pixels: () => stage.pixels(),
    tinted: (colour, within) => stage.tinted(colour, within),
    reach: () => cameras.reach(),
    // Where a point of the world is seen: -1 to 1 to the right and up.
    project: (point) => new Vector3().fromArray(point).project(stage.camera).toArray(),
    // Whether the scene may be drawn coarser on a slow machine.
    adapt: (yes) => stage.quality.adapt(yes),
    send: (message) => connection.send(message),
    // Of a headset: where the key with that text is, and a point of the scene, in the room.
    keyInRoom: (text) => headset.panel.whereIs(text),
    toRoom: (point) => stage.rig.worldToLocal(new Vector3().fromArray(point)).toArray(),
    pose: () => toolPose(state.frame),
    // From elsewhere than the fixed views: where the camera is, and what it looks at.
    look(position, target) {
      cameras.look(position, target);
    },
  };
}
