# SPDX-License-Identifier: BSD-3-Clause
"""A Cell in the loop of a MuJoCo simulation: it drives an arm of the model among its geoms.

    sim = repel.mujoco.attach(model, data, site="tool")
    while True:
        sim.step(repel.Command(linear=[0.1, 0.0, 0.0]))

Needs the package mujoco: pip install 'repel-haptics[mujoco]'.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from ._errors import SetupError
from ._mujoco_arm import ModelArm, mujoco, name_of
from ._repel import Cell, Command, ForceLaw, Shape, Tick, _Followed, _Frozen
from .description import Arm, Capacities, Loose, Obstacle

__all__ = ["Simulation", "attach"]

#: Of the model, what a cell is made of: it must stay as it was.
_USED = ("body_pos", "body_quat", "body_mass", "body_ipos", "jnt_pos", "jnt_axis", "geom_pos",
         "geom_quat", "geom_size")

#: [m] corners of the box that stands for a plane; its upper face is in the plane.
_PLANE = np.array([[x, y, z] for x in (-100, 100) for y in (-100, 100) for z in (-2, 0)], float)

_REST = Command()


class Simulation:
    """A cell with an arm of a model; made by `attach`.

    `model` and `data` are what was attached, `cell` is made of `arm`, `obstacles` and `followed`,
    the geoms that move. `joints` has the ids of the joints of the arm, base outward. `left_out`
    names the geoms that the cell does not know: they may touch the arm.
    """

    def __init__(self, model: Any, data: Any, joints: list[int], cell: Cell, arm: Arm,
                 obstacles: list[Obstacle], followed: dict[int, Loose], left_out: list[str],
                 substeps: int):
        self.model, self.data, self.cell = model, data, cell
        self.arm, self.obstacles, self.joints, self.left_out = arm, obstacles, joints, left_out
        self.followed = list(followed.values())
        self._follower = _Followed(cell, data.geom_xpos, data.geom_xmat, list(followed),
                                   [part.name for part in self.followed]) if followed else None
        self._substeps = substeps
        self._q, self._dof = (_run(addresses[self.joints]) for addresses in
                              (model.jnt_qposadr, model.jnt_dofadr))
        self._qpos, self._qvel, self._torques = data.qpos, data.qvel, data.qfrc_applied
        self._used = _Frozen({name: getattr(model, name) for name in _USED})
        self._opt, self._timestep = model.opt, model.opt.timestep

    def tick(self, command: Command = _REST) -> Tick:
        """One tick of the cell, without moving the simulation.

        Reads data.qpos and data.qvel and writes the torques of the joints of the arm to
        data.qfrc_applied, for the mj_step calls of one period. Actuators keep their data.ctrl. If
        it follows geoms, it calls mj_kinematics for their poses. Raises SetupError if the model has
        changed since `attach`, or if the pose of a geom that it follows is not finite. Readings of
        the arm that are not finite are a fault of the tick.
        """
        if changed := self._used.changed():
            raise SetupError(f"{changed} of the model has changed; allowed: to attach again")
        if self._opt.timestep != self._timestep:
            raise SetupError("opt.timestep of the model has changed; allowed: to attach again")
        if self._follower:
            mujoco.mj_kinematics(self.model, self.data)  # after mj_step, poses are a step behind
            self._follower.update(self.data.time)
        tick = self.cell.step(self._qpos[self._q], self._qvel[self._dof], command)
        self._torques[self._dof] = tick.torques
        return tick

    def step(self, command: Command = _REST) -> Tick:
        """`tick`, and the mj_step calls of one period."""
        tick = self.tick(command)
        mujoco.mj_step(self.model, self.data, self._substeps)
        return tick


def _run(addresses: np.ndarray) -> slice | np.ndarray:
    """As a slice, which is faster, if they follow one another."""
    first, count = int(addresses[0]), len(addresses)
    is_run = np.array_equal(addresses, np.arange(first, first + count))
    return slice(first, first + count) if is_run else addresses.copy()


def attach(model: Any, data: Any, *, site: str, rate_hz: float | None = None,
           law: ForceLaw | None = None, leave_out: Sequence[str] = (),
           follow: Sequence[str] | bool = False, gain_check: str = "error",
           start_inside: str = "refuse", limits: Capacities | None = None,
           **arm: Any) -> Simulation:
    """A cell with the arm that moves a site of the model, and an obstacle for each geom around it.

    site: its name, or that of a body whose frame is the tool frame. data: of the model; the arm
    starts where data.qpos has it, and joints on it, as those of fingers, count as held there.
    rate_hz [Hz] of the tick; none: one for each timestep, else a whole number of timesteps must
    make a period. law: of all obstacles. leave_out: names of geoms that are not to count, on the
    arm and around it. follow: names of geoms that move without the arm, by mocap or by joints of
    their own, and are to be obstacles where they are at each tick; True: all of them. arm: further
    arguments of Arm; gain_check, start_inside, limits: of Cell.

    Geoms become obstacles if they stand still in the world and can touch anything. A plane becomes
    a large box. Not among them are the geoms of the body that carries the first joint, which the
    first link may touch, and those that move without the arm and are not followed: a warning names
    the latter. A finger that is coupled with the arm cannot be followed.
    Raises SetupError naming the site, joint, geom or actuator that cannot be used.
    """
    if not isinstance(data, mujoco.MjData):
        raise TypeError(f"data: expected a mujoco.MjData, got {type(data).__name__}")
    chain = ModelArm(model, site, data.qpos, leave_out, data.eq_active)
    if data.qvel.shape != (model.nv,):
        raise ValueError(f"data: expected that of the model, with {model.nv} degrees of freedom, "
                         f"got {data.qvel.size}")
    _require_no_servos(chain)
    obstacles = [Obstacle(name, _shape(chain, name, geom), chain.pose(geom), law)
                 for body, link in enumerate(chain.link)
                 if link == -1 and (body == 0 or body != chain.base)
                 for name, geom in chain.geoms(body)]
    followed, moving = _moving(chain, data, law, follow)
    if moving:
        warnings.warn(f"these geoms move without the arm, and are no obstacles: "
                      f"{', '.join(moving)}", stacklevel=2)
    period = model.opt.timestep if rate_hz is None else 1.0 / rate_hz
    substeps = round(period / model.opt.timestep)
    if substeps < 1 or abs(substeps * model.opt.timestep - period) > 1e-6 * period:
        raise SetupError(f"rate_hz is {rate_hz:g}, with a timestep of {model.opt.timestep:g} s; "
                         "allowed: whole timesteps in a period")
    described = chain.arm(**arm)
    cell = Cell(rate_hz=1.0 / period, arms=[described], obstacles=obstacles,
                loose=list(followed.values()), gain_check=gain_check, start_inside=start_inside,
                limits=limits)
    base = [name for name, _ in chain.geoms(chain.base)] if chain.base else []
    return Simulation(model, data, chain.joints, cell, described, obstacles, followed,
                      moving + base, substeps)


def _moving(chain: ModelArm, data: Any, law: ForceLaw | None,
            follow: Sequence[str] | bool) -> tuple[dict[int, Loose], list[str]]:
    """Of the geoms that move without the arm, those to be followed by their ids, and the names of
    the others."""
    bodies = [body for body, link in enumerate(chain.link) if link is None]
    coupled = [body for body in bodies if chain.between(0, body).intersection(chain.followers)]
    ids = {name: geom for body in bodies if body not in coupled for name, geom in chain.geoms(body)}
    chosen = (ids if follow else ()) if isinstance(follow, bool) else follow
    for name in chosen:
        if name not in ids:
            raise SetupError(f"follow: no geom that moves without the arm is called '{name}'; "
                             f"allowed: {', '.join(ids) or 'none, the model has no such geom'}")
    if chosen:
        mujoco.mj_kinematics(chain.model, data)
    followed = {}
    for name in chosen:
        X_WP = np.eye(4)
        X_WP[:3, :3] = data.geom_xmat[ids[name]].reshape(3, 3)
        X_WP[:3, 3] = data.geom_xpos[ids[name]]
        followed[ids[name]] = Loose(name, _shape(chain, name, ids[name]), X_WP, law, at_start=True)
    return followed, [name for body in bodies for name, _ in chain.geoms(body)
                      if name not in chosen]


def _shape(chain: ModelArm, name: str, geom: int) -> Shape:
    if chain.model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_PLANE:
        return Shape.hull(_PLANE, levels=1)
    return chain.shape(name, geom)


def _require_no_servos(chain: ModelArm) -> None:
    """Raises SetupError for an actuator that would pull against the torques of the cell."""
    model = chain.model
    if model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_ACTUATION:
        return
    for joint in chain.joints + chain.followers:
        for actuator in chain.actuators(joint) + chain.on_tendons(joint):
            pulls = model.actuator_biastype[actuator] != mujoco.mjtBias.mjBIAS_NONE
            if pulls and not model.opt.disableactuator >> int(model.actuator_group[actuator]) & 1:
                raise SetupError(
                    f"actuator '{name_of(model, 'actuator', actuator)}' pulls on joint "
                    f"'{name_of(model, 'joint', joint)}' by itself, against the torques of the "
                    "cell; allowed: motors, or its group in actuatorgroupdisable of the model")
