# SPDX-License-Identifier: BSD-3-Clause
"""What a program calls, for the type checker alone: `mypy --strict` must pass it."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np

import repel
import repel.mujoco


def loose(arm: repel.Arm, X_WP: np.ndarray) -> repel.Tick:
    bottle = repel.Loose("bottle", repel.Shape.sphere(0.05), X_WP, mass=0.5, room=0.3)
    cell = repel.Cell(rate_hz=1000.0, arms=[arm], loose=[bottle],
                      limits=repel.Capacities(loose=10))
    cell.add("bottle", over=0.1)
    name: str = cell.add(repel.Shape.box([0.1, 0.1, 0.1]), X_WP)
    cell.move(name, X_WP, speed=0.1)
    cell.attach(name, arm=0)
    cell.release(name)
    cell.place(name, (np.zeros(3), [1, 0, 0, 0]), np.zeros(6))
    cell.remove(name)
    share: float = cell.loose[name]["there"]
    refused: int = cell.changes["refused"]
    print(share, refused)
    camera = repel.DepthCamera(cell, width=4, height=3, fx=3.0, fy=3.0, cx=1.5, cy=1.0,
                               share=(0, 1))
    counts: dict[str, int] = camera.see(np.zeros((3, 4), np.float32), X_WP, 0.0)
    camera.clear()
    with repel.LiveView(cell, "my cell", port=0, pages_drive=True) as view:
        print(counts, view.url)
        command: repel.Command | None = view.command()
        tick = cell.step(np.zeros(3), np.zeros(3), command or repel.Command())
        view.publish(late=0.0, compute=1e-4)
    return tick


def shown(cell: repel.Cell, file: str) -> None:
    repel.rerun(repel.read_recording(file), save="run.rrd")
    with repel.rerun(cell, spawn=True) as log:
        log.log(compute=1e-4)


def simulated(model: Any, data: Any) -> float:
    sim = repel.mujoco.attach(model, data, site="tool", follow=["ball"])
    names: list[str] = [part.name for part in sim.followed] + sim.left_out
    print(names)
    force: float = sim.step(repel.Command(linear=[0.1, 0, 0])).peak_force
    return force


def run() -> dict[str, Any]:
    def drive(ticks: list[repel.Tick]) -> repel.Command | None:
        return repel.Command(linear=-0.1 * ticks[0].p_WT) if ticks[0].time > 1.0 else None

    return repel.run("empty", on_tick=drive, every=10, stop=threading.Event())


def shapes(vertices: np.ndarray, triangles: np.ndarray) -> list[repel.Shape]:
    cover = repel.cover(vertices, triangles, parts=4)
    corners, faces = repel.Shape.hull(vertices).mesh()
    print(corners.shape, faces.shape)
    return [repel.Shape.hull(part) for part in cover.parts]
