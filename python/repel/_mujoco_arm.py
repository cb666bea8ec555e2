# SPDX-License-Identifier: BSD-3-Clause
"""The arm of a MuJoCo model: links and convex parts from its bodies, joints and geoms."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ._errors import SetupError, needed
from ._repel import Shape
from .description import Arm, Link, Part

mujoco = needed("mujoco", extra="mujoco")

#: What a constructor of Shape of that name takes of the sizes of a geom.
_SIZES: dict[str, Callable[[Any], tuple[Any, ...]]] = {
    "sphere": lambda size: (size[0],), "capsule": lambda size: (size[0], size[1]),
    "cylinder": lambda size: (size[0], size[1]), "box": lambda size: (size,),
    "ellipsoid": lambda size: (size,)}

#: What makes a tendon act by itself, and the fields of a model that say so.
_OF_TENDONS = {"a spring": ("stiffness", "stiffnesspoly"), "damping": ("damping", "dampingpoly"),
               "dry friction": ("frictionloss",), "an armature": ("armature",),
               "limits": ("limited",)}


def name_of(model: Any, kind: str, index: int) -> str:
    """Of a joint, a body and so on; what has no name is told by its index."""
    return getattr(model, kind)(int(index)).name or f"{kind} {int(index)}"


def _pose(p: Any, quat: Any = (1.0, 0.0, 0.0, 0.0)) -> np.ndarray:
    """(4, 4) [m] of a position and a unit quaternion w x y z."""
    R = np.empty(9)
    mujoco.mju_quat2Mat(R, np.asarray(quat, float))
    X = np.eye(4)
    X[:3, :3] = R.reshape(3, 3)
    X[:3, 3] = p
    return X


def _about(axis: Any, angle: float) -> np.ndarray:
    quat = np.empty(4)
    mujoco.mju_axisAngle2Quat(quat, np.asarray(axis, float), angle)
    return _pose(np.zeros(3), quat)


class ModelArm:
    """The joints of a model between the world and a site, and where every body is on their links.

    site: its name, or that of a body whose frame is the tool frame. active: which of the equality
    constraints are; none: as the model starts. link: of each body, the index of the link that
    carries it, -1 if it stands still in the world, or None if it moves by other joints. X_LB:
    (4, 4) [m] its pose there. base: the body that carries the first joint. joints: their ids, base
    outward. followers: those beside them that a constraint couples with the last one alone.
    """

    def __init__(self, model: Any, site: str, qpos: Any = None, leave_out: Sequence[str] = (),
                 active: Any = None):
        if not isinstance(model, mujoco.MjModel):
            raise TypeError(f"model: expected a mujoco.MjModel, got {type(model).__name__}")
        self.model = model
        self.qpos = np.array(model.qpos0 if qpos is None else qpos, float)
        if self.qpos.shape != (model.nq,):
            raise ValueError(f"qpos: expected {model.nq} numbers, got shape {self.qpos.shape}")
        self.leave_out = set(leave_out)
        self.tip, self.X_BT = self._tip_named(site)
        self.link: list[int | None] = [-1]
        self.X_LB = [np.eye(4)]
        self.joints: list[int] = []
        self.followers: list[int] = []
        self.links: list[Link] = []
        self.base = 0
        self.X_WB = np.eye(4)
        self._path = {0}
        body = self.tip
        while body:
            self._path.add(body)
            body = int(model.body_parentid[body])
        for body in range(1, model.nbody):
            self._place(body)
        if not self.links:
            raise SetupError(f"site '{site}' stands still in the world; allowed: one that hinge or "
                             "slide joints move")
        self._require_no_ties(model.eq_active0 if active is None else active)
        self._give_masses()
        unknown = self.leave_out.difference(name for body in range(model.nbody)
                                            for name, _ in self._named_geoms(body))
        if unknown:
            raise SetupError(f"leave_out: no geom is called '{min(unknown)}'")

    def _tip_named(self, name: str) -> tuple[int, np.ndarray]:
        """The body of a site, or that body itself, and the pose (4, 4) [m] of the tool in it."""
        model = self.model
        site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name)
        if site >= 0:
            return int(model.site_bodyid[site]), _pose(model.site_pos[site], model.site_quat[site])
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
        if body >= 0:
            return body, np.eye(4)
        there = [repr(name_of(model, "site", i)) for i in range(model.nsite)]
        raise SetupError(f"site is '{name}'; allowed: {', '.join(there + ['the name of a body'])}")

    def between(self, a: int, b: int) -> set[int]:
        """The joints that move one body against the other."""
        joints: set[int] = set()
        while a != b:
            b, a = sorted((a, b))  # a parent has the smaller index
            first = int(self.model.body_jntadr[a])
            joints.update(range(first, first + int(self.model.body_jntnum[a])))
            a = int(self.model.body_parentid[a])
        return joints

    def _of_tendon(self, tendon: int) -> set[int]:
        """The joints that change its length."""
        model, wrap = self.model, mujoco.mjtWrap
        joints: set[int] = set()
        before = None  # the body that it comes from
        first = int(model.tendon_adr[tendon])
        for i in range(first, first + int(model.tendon_num[tendon])):
            kind, index, body = wrap(model.wrap_type[i]), int(model.wrap_objid[i]), None
            if kind == wrap.mjWRAP_JOINT:
                joints.add(index)
            elif kind == wrap.mjWRAP_SITE:
                body = int(model.site_bodyid[index])
            elif kind in (wrap.mjWRAP_SPHERE, wrap.mjWRAP_CYLINDER):
                body = int(model.geom_bodyid[index])
            if before is not None and body is not None:
                joints |= self.between(before, body)
            before = body  # none behind a pulley, where it begins anew
        return joints

    def _constrained(self, i: int) -> set[int]:
        """The joints that an equality constraint acts on."""
        model, types = self.model, mujoco.mjtEq
        kind, ends = types(model.eq_type[i]), [int(model.eq_obj1id[i]), int(model.eq_obj2id[i])]
        if kind == types.mjEQ_JOINT:
            return {end for end in ends if end >= 0}
        if kind == types.mjEQ_TENDON:
            return set[int]().union(*(self._of_tendon(end) for end in ends if end >= 0))
        if kind not in (types.mjEQ_CONNECT, types.mjEQ_WELD):
            return set()  # of a flex, which is no body of an arm
        if model.eq_objtype[i] == mujoco.mjtObj.mjOBJ_SITE:
            ends = [int(model.site_bodyid[end]) for end in ends]
        return self.between(*ends)

    def _require_no_ties(self, active: Any) -> None:
        """Raises SetupError for a constraint or tendon that acts on the joints of the arm.

        A joint that is coupled with the last one alone follows that: it is the other finger where
        one is the arm.
        """
        model, ties = self.model, []
        for i in map(int, np.flatnonzero(active)):
            joints = self._constrained(i)
            in_arm = joints.intersection(self.joints)
            if (model.eq_type[i] == mujoco.mjtEq.mjEQ_JOINT and len(joints) == 2
                    and in_arm == {self.joints[-1]}):
                self.followers += joints - in_arm
            else:
                name = name_of(model, "equality", i)
                ties.append((f"'{name}' is an equality constraint", joints))
        for i in range(model.ntendon):
            name = f"'{name_of(model, 'tendon', i)}' is a tendon with "
            ties += [(name + what, self._of_tendon(i)) for what, fields in _OF_TENDONS.items()
                     if any(np.any(getattr(model, f"tendon_{field}", {i: 0})[i])
                            for field in fields)]
        for what, joints in ties:
            for joint in self.joints:
                if joint in joints:
                    raise SetupError(f"{what}, which acts on joint "
                                     f"'{name_of(model, 'joint', joint)}' of the arm; allowed: one "
                                     "of held joints alone")

    def _place(self, body: int) -> None:
        """Continues from its parent, which has the smaller index."""
        model = self.model
        parent = int(model.body_parentid[body])
        link: int | None = self.link[parent]
        X = self.X_LB[parent] @ _pose(model.body_pos[body], model.body_quat[body])
        first = int(model.body_jntadr[body])
        joints = range(first, first + int(model.body_jntnum[body]))
        if body in self._path:
            if model.body_mocapid[body] >= 0:
                raise SetupError(f"body '{name_of(model, 'body', body)}' is a mocap body, which "
                                 "carries the arm; allowed: an arm whose base stands still")
            for joint in joints:
                X = self._add_link(joint, X, body)
                link = len(self.links) - 1
        elif link is not None and link >= 0:
            for joint in joints:
                X = X @ self._motion(joint, self.qpos[model.jnt_qposadr[joint]])
        elif len(joints) or model.body_mocapid[body] >= 0:
            link = None
        self.link.append(link)
        self.X_LB.append(X)

    def _type(self, joint: int) -> str:
        """The type of a link. Raises SetupError for joints that no link can have."""
        model = self.model
        kind = mujoco.mjtJoint(model.jnt_type[joint]).name.removeprefix("mjJNT_").lower()
        name = name_of(model, "joint", joint)
        if kind not in ("hinge", "slide"):
            raise SetupError(f"joint '{name}' is of type {kind}; allowed: hinge, slide")
        return "revolute" if kind == "hinge" else "prismatic"

    def _motion(self, joint: int, q: float) -> np.ndarray:
        """(4, 4) in the body, from where its joints do nothing: at the reference of the model."""
        model = self.model
        by = q - model.qpos0[model.jnt_qposadr[joint]]
        if self._type(joint) == "prismatic":
            return _pose(by * model.jnt_axis[joint])
        anchor = model.jnt_pos[joint]
        return _pose(anchor) @ _about(model.jnt_axis[joint], by) @ _pose(-anchor)

    def _add_link(self, joint: int, X_LB: np.ndarray, body: int) -> np.ndarray:
        """Returns the pose of the body in the new link, whose origin is the anchor of the joint."""
        model = self.model
        if not self.links:
            self.base, self.X_WB = int(model.body_parentid[body]), X_LB
            X_LB = np.eye(4)
        stiffness = model.jnt_stiffness[joint]
        if stiffness or np.any(getattr(model, "jnt_stiffnesspoly", {joint: 0})[joint]):
            raise SetupError(f"joint '{name_of(model, 'joint', joint)}' has a spring of stiffness "
                             f"{stiffness:g}; allowed: 0, or a joint that is held")
        dof, anchor = int(model.jnt_dofadr[joint]), model.jnt_pos[joint]
        limited = bool(model.jnt_limited[joint])
        self.joints.append(joint)
        self.links.append(Link(
            name_of(model, "joint", joint), type=self._type(joint),
            X_PJ=X_LB @ self._motion(joint, 0.0) @ _pose(anchor),
            axis_J=model.jnt_axis[joint].copy(),
            lower=float(model.jnt_range[joint][0]) if limited else -math.inf,
            upper=float(model.jnt_range[joint][1]) if limited else math.inf,
            effort_limit=self._effort_limit(joint),
            viscous_friction=float(model.dof_damping[dof]) + self._seen(joint, "damping"),
            coulomb_friction=float(model.dof_frictionloss[dof]),
            rotor_inertia=float(model.dof_armature[dof]) + self._seen(joint, "armature")))
        return _pose(-anchor)

    def actuators(self, joint: int) -> list[int]:
        """Those that act on the joint alone."""
        model = self.model
        on_joints = [int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT)]
        return [i for i, kind in enumerate(model.actuator_trntype)
                if int(kind) in on_joints and model.actuator_trnid[i, 0] == joint]

    def on_tendons(self, joint: int) -> list[int]:
        """The actuators that pull a tendon of the joint."""
        model = self.model
        return [i for i, kind in enumerate(model.actuator_trntype)
                if kind == mujoco.mjtTrn.mjTRN_TENDON
                and joint in self._of_tendon(int(model.actuator_trnid[i, 0]))]

    def _seen(self, joint: int, name: str) -> float:
        """The armature or damping of actuators, seen at the joint; MuJoCo 3 has none there."""
        own = getattr(self.model, f"actuator_{name}", None)
        return 0.0 if own is None else sum(float(self.model.actuator_gear[i, 0]) ** 2 * float(own[i])
                                           for i in self.actuators(joint))

    def _effort_limit(self, joint: int) -> float:
        """[N m] or [N] of the joint and of its actuators together; 0: without a limit."""
        model = self.model
        strengths = [self._strength(actuator) for actuator in self.actuators(joint)]
        limit = sum(strengths) if strengths and not self.on_tendons(joint) else math.inf
        if model.jnt_actfrclimited[joint]:
            limit = min(limit, float(np.abs(model.jnt_actfrcrange[joint]).min()))
        return limit if math.isfinite(limit) else 0.0

    def _strength(self, actuator: int) -> float:
        """[N m] or [N] that an actuator has at its joint in both directions."""
        model = self.model
        gear = abs(float(model.actuator_gear[actuator, 0]))
        limit = math.inf
        if model.actuator_forcelimited[actuator]:
            limit = float(np.abs(model.actuator_forcerange[actuator]).min())
        control = int(getattr(model, "actuator_ctrladr", range(model.nu))[actuator])
        is_motor = (model.actuator_gaintype[actuator] == mujoco.mjtGain.mjGAIN_FIXED
                    and model.actuator_biastype[actuator] == mujoco.mjtBias.mjBIAS_NONE)
        if is_motor and model.actuator_ctrllimited[control]:
            limit = min(limit, abs(float(model.actuator_gainprm[actuator, 0]))
                        * float(np.abs(model.actuator_ctrlrange[control]).min()))
        return gear * limit

    def _give_masses(self) -> None:
        """The bodies of each link become one, by the parallel-axis theorem."""
        model = self.model
        for index, link in enumerate(self.links):
            bodies = [body for body, on in enumerate(self.link)
                      if on == index and model.body_mass[body] > 0.0]
            if not bodies:
                continue
            masses = model.body_mass[bodies]
            X_LI = [self.X_LB[body] @ _pose(model.body_ipos[body], model.body_iquat[body])
                    for body in bodies]
            centre = sum(m * X[:3, 3] for m, X in zip(masses, X_LI)) / masses.sum()
            link.mass, link.p_LC, link.I_C_L = float(masses.sum()), centre, np.zeros((3, 3))
            for body, m, X in zip(bodies, masses, X_LI):
                R, d = X[:3, :3], X[:3, 3] - centre
                link.I_C_L += R @ np.diag(model.body_inertia[body]) @ R.T
                link.I_C_L += m * (d @ d * np.eye(3) - np.outer(d, d))

    def gravity(self) -> np.ndarray:
        """(3,) [m/s^2] on the links: less what the model compensates on all of them alike."""
        model = self.model
        if model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_GRAVITY:
            return np.zeros(3)
        shares = {float(model.body_gravcomp[body]) for body, on in enumerate(self.link)
                  if on is not None and on >= 0 and model.body_mass[body] > 0.0} or {0.0}
        if len(shares) > 1:
            raise SetupError("gravcomp of the bodies of the arm is "
                             f"{', '.join(f'{each:g}' for each in sorted(shares))}; allowed: the "
                             "same for all of them")
        return (1.0 - shares.pop()) * model.opt.gravity

    def _named_geoms(self, body: int) -> list[tuple[str, int]]:
        first = int(self.model.body_geomadr[body])
        return [(self.model.geom(i).name or f"{name_of(self.model, 'body', body)}/geom {i}", i)
                for i in range(first, first + int(self.model.body_geomnum[body]))]

    def geoms(self, body: int) -> list[tuple[str, int]]:
        """(name, id) of those of a body that can touch anything and are not to be left out."""
        model = self.model
        return [(name, i) for name, i in self._named_geoms(body) if name not in self.leave_out
                and (model.geom_contype[i] or model.geom_conaffinity[i])]

    def pose(self, geom: int) -> np.ndarray:
        """(4, 4) [m] of a geom, in the link that carries its body or in the world."""
        model = self.model
        return self.X_LB[model.geom_bodyid[geom]] @ _pose(model.geom_pos[geom],
                                                          model.geom_quat[geom])

    def shape(self, name: str, geom: int) -> Shape:
        """Raises SetupError for a geom that is not convex, or whose sizes no shape has."""
        model = self.model
        kind = mujoco.mjtGeom(model.geom_type[geom]).name.removeprefix("mjGEOM_").lower()
        try:
            if kind == "mesh":
                return Shape.hull(_corners(model, int(model.geom_dataid[geom])), levels=1)
            if kind in _SIZES:
                return getattr(Shape, kind)(*_SIZES[kind](model.geom_size[geom]), levels=1)
        except SetupError as error:
            raise SetupError(f"geom '{name}': {error}") from error
        raise SetupError(f"geom '{name}' is of type {kind}; allowed: {', '.join(_SIZES)}, mesh, or "
                         "contype=\"0\" conaffinity=\"0\" for what is only looked at")

    def arm(self, **change: Any) -> Arm:
        """The plain description, changed as said."""
        parts = [Part(name, self.shape(name, geom), self.pose(geom), link)
                 for body, link in enumerate(self.link) if link is not None and link >= 0
                 for name, geom in self.geoms(body)]
        X_LT = self.X_LB[self.tip] @ self.X_BT
        given = {"parts": parts, "start": self.qpos[self.model.jnt_qposadr[self.joints]],
                 "X_WB": self.X_WB, "X_LT": X_LT, "gravity_W": self.gravity()}
        return Arm(self.links, **{**given, **change})


def _corners(model: Any, mesh: int) -> np.ndarray:
    """(N, 3) [m] those of the hull that the compiler of MuJoCo has found, or else all vertices."""
    first = int(model.mesh_vertadr[mesh])
    vertices = model.mesh_vert[first:first + int(model.mesh_vertnum[mesh])].astype(float)
    graph = int(model.mesh_graphadr[mesh])
    if graph < 0:
        return vertices
    count = int(model.mesh_graph[graph])  # then the number of faces, and two lists by corners
    return vertices[model.mesh_graph[graph + 2 + count:graph + 2 + 2 * count]]


def arm_of(model: Any, site: str, qpos: Any = None, leave_out: Sequence[str] = (),
           **change: Any) -> Arm:
    """See Arm.from_mujoco."""
    return ModelArm(model, site, qpos, leave_out).arm(**change)


def arm_of_mjcf(path: str | os.PathLike[str], site: str, **options: Any) -> Arm:
    """See Arm.from_mjcf."""
    file = os.fspath(path)
    try:
        model = mujoco.MjModel.from_xml_path(file)
    except ValueError as error:
        raise SetupError(f"{file}: {error}", file) from error
    try:
        return arm_of(model, site, **options)
    except SetupError as error:
        raise SetupError(f"{file}: {error}", file) from error
