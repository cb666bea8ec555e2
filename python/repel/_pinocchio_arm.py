# SPDX-License-Identifier: BSD-3-Clause
"""The arm of a Pinocchio model."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ._errors import SetupError, needed
from .description import Arm, Link

pinocchio = needed("pinocchio", "pin", extra="pinocchio")


def _numbers(model: Any, name: str) -> np.ndarray:
    """One for each joint of an arm; zeros if this version of Pinocchio has no such numbers."""
    return np.asarray(getattr(model, name, np.zeros(model.nv)), float)


def _limits(model: Any, joint: Any) -> tuple[float, float]:
    """[rad] or [m]; a joint without end has a cosine and a sine in their place."""
    if joint.nq != 1:
        return -math.inf, math.inf
    return (float(model.lowerPositionLimit[joint.idx_q]),
            float(model.upperPositionLimit[joint.idx_q]))


def _link(model: Any, index: int) -> Link:
    joint, name, inertia = model.joints[index], model.names[index], model.inertias[index]
    data = joint.createData()
    joint.calc(data, pinocchio.neutral(model))
    along = np.asarray(data.S, float).reshape(6, -1)
    if joint.nv != 1 or np.count_nonzero(np.linalg.norm(along.reshape(2, 3), axis=1)) != 1:
        raise SetupError(f"joint '{name}' is of type {joint.shortname()}; allowed: revolute, "
                         "prismatic")
    is_prismatic = bool(along[:3].any())
    lower, upper = _limits(model, joint)
    v = joint.idx_v
    effort, speed = (float(_numbers(model, each)[v]) for each in ("effortLimit", "velocityLimit"))
    return Link(name, type="prismatic" if is_prismatic else "revolute",
                X_PJ=model.jointPlacements[index].homogeneous,
                axis_J=along[:3, 0] if is_prismatic else along[3:, 0], lower=lower, upper=upper,
                velocity_limit=speed if math.isfinite(speed) else 0.0,
                effort_limit=effort if math.isfinite(effort) else 0.0,
                mass=float(inertia.mass), p_LC=np.array(inertia.lever),
                I_C_L=np.array(inertia.inertia), viscous_friction=float(model.damping[v]),
                coulomb_friction=float(model.friction[v]),
                rotor_inertia=float(model.armature[v]))


def arm_of(model: Any, frame: str, q: Any = None, **change: Any) -> Arm:
    """See Arm.from_pinocchio."""
    if not isinstance(model, pinocchio.Model):
        raise TypeError(f"model: expected a pinocchio.Model, got {type(model).__name__}")
    if not model.existFrame(frame):
        raise SetupError(f"frame is '{frame}'; allowed: {', '.join(f.name for f in model.frames)}")
    where = np.array(pinocchio.neutral(model) if q is None else q, float)
    if where.shape != (model.nq,):
        raise ValueError(f"q: expected {model.nq} numbers, got shape {where.shape}")
    carrier = model.frames[model.getFrameId(frame)].parentJoint
    if carrier == 0:
        raise SetupError(f"frame '{frame}' stands still in the world; allowed: one that joints move")
    beside = sorted(set(range(1, model.njoints)) - set(model.supports[carrier]))
    if beside:
        model = pinocchio.buildReducedModel(model, beside, where)
    X_LT = model.frames[model.getFrameId(frame)].placement.homogeneous
    links = [_link(model, index) for index in range(1, model.njoints)]
    return Arm(links, **{"X_LT": X_LT, "gravity_W": np.array(model.gravity.linear), **change})
