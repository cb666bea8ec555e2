// SPDX-License-Identifier: BSD-3-Clause
// What of the scene is shown: the menu above it, and what the legend says of the scale.

import { bind, set, settings } from "./settings.js";
import { forceScale } from "./state.js";
import { onTheme } from "./theme.js";
import { at, finite, write } from "./words.js";

// `near`: the parts of pairs near enough to be asked. `changed` hears of every change.
export function startShowMenu({ stage, parts, visuals, near, dress, changed }) {
  const redraw = () => {
    stage.invalidate();
    changed();
  };
  const scale = () => {
    const size = stage.spacing >= 1 ? `${stage.spacing} m` : `${1000 * stage.spacing} mm`;
    const grid = finite(stage.spacing) ? `, grid ${size}` : "";
    const arrows = Number((1000 * forceScale()).toPrecision(3));
    write(at("scale-text"), `arrows ${arrows} mm per N${grid}`);
  };
  for (const key of ["threads", "forces", "labels", "directions", "trail", "fixtures"]) {
    bind(`show-${key}`, key, redraw);
  }
  bind("show-shadows", "shadows", (on) => stage.setShadows(on));
  const robot = () => {
    visuals.show();
    dress();
    redraw();
  };
  bind("show-robot", "robot", robot);
  bind("show-zones", "zones", () => {
    parts.showZones(near);
    redraw();
  });
  bind("show-levels", "levels", (mode) => {
    at("level-row").hidden = mode !== "one";
    parts.showLevels();
    robot();
  });
  bind("level", "level", (level) => {
    write(at("level-out"), String(level));
    parts.showLevels();
  });
  bind("force-scale", "forceScale", () => {
    scale();
    redraw();
  });
  at("legend").open = settings.legend;
  at("legend").addEventListener("toggle", () => set("legend", at("legend").open));
  onTheme(redraw);
  return { scale };
}
