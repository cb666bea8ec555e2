# SPDX-License-Identifier: BSD-3-Clause
"""What a Cell is made of: plain classes."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from . import _repel
from ._errors import SetupError, how_to_have
from ._repel import ForceLaw, Shape


class Kinematics(Protocol):
    """What the loop asks of an arm, in this order; all answers belong to the last `update`.

    An arm with parts on its links also needs `X_WL(link)`, (4, 4) [m], and `jacobian(link, p_WQ)`,
    (6, joints), of the point Q of the link that is now at p_WQ [m]. One without masses in its links
    needs `mass_matrix()`, (joints, joints) [kg m^2] or [kg].
    """

    def update(self, q: np.ndarray) -> None:
        """Joint positions (joints,) [rad] or [m]."""

    def X_WT(self) -> np.ndarray:
        """The tool frame in the world, (4, 4) [m]."""

    def tool_jacobian(self) -> np.ndarray:
        """Of the origin of the tool, (6, joints): linear rows first, world axes."""

    def gravity_torques(self) -> np.ndarray:
        """That hold the arm, (joints,) [N m] or [N]; zeros if its drive does that by itself."""


@dataclass
class Link:
    """A moving link and its joint. Angles [rad] and torques [N m]; of a prismatic one [m], [N]."""

    name: str
    type: str = "revolute"  #: or prismatic
    X_PJ: Any = None  #: pose at zero in the parent link [m]; none: the same
    axis_J: Any = (0.0, 0.0, 1.0)  #: unit
    lower: float = -math.inf
    upper: float = math.inf
    velocity_limit: float = 0.0  #: 0: unknown
    effort_limit: float = 0.0  #: 0: unknown
    mass: float = 0.0  #: [kg]
    p_LC: Any = (0.0, 0.0, 0.0)  #: centre of mass [m]
    I_C_L: Any = None  #: (3, 3) [kg m^2] about it; none: zeros
    viscous_friction: float = 0.0  #: [N m s/rad] or [N s/m]
    coulomb_friction: float = 0.0  #: [N m] or [N]
    rotor_inertia: float = 0.0  #: [kg m^2] or [kg], seen at the joint
    brake_torque: float = 0.0  #: that its brake holds; 0: unknown


@dataclass
class Part:
    """A convex part of an arm."""

    name: str
    shape: Shape
    X_FP: Any = None  #: pose [m] in the tool frame or in that of its link; none: the same
    link: int | None = None  #: index of its link; none: it is on the tool


@dataclass
class Capacities:
    """How much a World or a Cell can hold: it takes its memory once."""

    bodies: int = 64  #: with the fixed one, without loose parts
    loose: int = 256  #: parts, see Loose
    parts: int = 20000  #: of all bodies
    pairs: int = 1 << 20  #: of parts
    candidates: int = 1 << 14  #: pairs that can soon come within range, at one time


def _check_all(name: str, values: Any, kind: type, instead: str = "") -> None:
    """Refuses what is no sequence of that kind, before it is taken for one."""
    own = "repel." if kind.__module__.startswith("repel") else ""
    expected = "dict" if kind is Mapping else own + kind.__name__
    if isinstance(values, (str, bytes, os.PathLike)) or not isinstance(values, Sequence):
        raise TypeError(f"{name}: expected a sequence of {expected}, got {values!r}{instead}")
    for i, value in enumerate(values):
        if not isinstance(value, kind):
            raise TypeError(f"{name}[{i}]: expected a {expected}, got {type(value).__name__}")


@dataclass
class Admittance:
    """How an arm that takes joint positions or rates answers to the network (docs/admittance.md):
    each joint shows a virtual inertia M and friction B, and moves by v' = (torque - B v) / M."""

    response: float = 0.03  #: [s] from a commanded rate to the rate of the arm: dead time and lag
    inertia: Any = None  #: (joints,) [kg m^2] or [kg]; none: the arm's own at its start, by `scale`
    scale: float = 1.0
    rest_time: float = 0.3  #: [s] in which a joint without effort loses 63 % of its rate
    acceleration: float = 0.0  #: [rad/s^2] or [m/s^2] of the commands; 0: what the efforts allow


@dataclass
class Arm:
    """An arm, and the network between operator and joints."""

    links: Sequence[Link]
    kinematics: Kinematics | None = None  #: none: computed from the links
    parts: Sequence[Part] = field(default_factory=list)
    start: Any = None  #: (joints,) [rad] or [m]; none: zeros
    name: str = ""  #: before the names of its parts
    X_WB: Any = None  #: pose of the base [m]; none: the world
    X_LT: Any = None  #: pose of the tool frame in the last link [m]; none: the same
    gravity_W: Any = (0.0, 0.0, -9.81)  #: [m/s^2]
    self_law: ForceLaw | None = None  #: between parts that are two or more joints apart
    may_touch: Sequence[tuple[int, int]] = ()  #: indices of parts that `self_law` leaves out
    tool_speed: float = 0.25  #: [m/s] up to which the operator may drive the tool
    drive_delay: float = 0.0  #: [ticks] from a torque to its effect
    has_brakes: bool = False
    #: The modules from the operator to the joints, each as under `network:` of a scene:
    #: {"module": "kbb2", "stiffness": "3 N/mm"}. None: the default network.
    network: Sequence[Mapping[str, Any]] | None = None
    admittance: Admittance | None = None  #: it takes the positions or rates of a Tick, not torques

    def __post_init__(self) -> None:
        _check_all("links", self.links, Link,
                   "; the arm of a URDF file is repel.Arm.from_urdf(path)")
        _check_all("parts", self.parts, Part)
        if self.network is not None:
            _check_all("network", self.network, Mapping)

    @classmethod
    def from_urdf(cls, path: str | os.PathLike[str], *, tip: str = "",
                  packages: Sequence[str | os.PathLike[str]] = (),
                  parts: str | None = "collision", **change: Any) -> Arm:
        """The arm of a URDF file, as scenes have it: see docs/robots.md.

        tip: the link whose frame is the tool frame; empty: the end of the longest chain without its
        gripper. packages: folders where package:// is searched. parts: those of the moving links,
        each mesh as its hull: "collision", "visual" (what the arm looks like) or None. change:
        other arguments of Arm. Raises SetupError naming file, line and value.
        """
        if not hasattr(_repel, "_read_urdf"):
            raise SetupError(f"Arm.from_urdf is not in this build: {how_to_have('robots')}")
        read = _repel._read_urdf(os.fspath(path), tip, [os.fspath(each) for each in packages],
                                 "none" if parts is None else parts)
        for warning in read.pop("warnings"):
            warnings.warn(warning, stacklevel=2)
        read["links"] = [Link(**each) for each in read["links"]]
        read["parts"] = [Part(**each) for each in read["parts"]]
        return cls(**{**read, **change})

    @classmethod
    def from_mujoco(cls, model: Any, site: str, *, qpos: Any = None,
                    leave_out: Sequence[str] = (), **change: Any) -> Arm:
        """The arm between the world and a site of a mujoco.MjModel; the site is the tool frame.

        site: its name, or that of a body. The links have the hinge and slide joints there, the
        masses of all that they carry, and the geoms of these as parts. Other joints on the arm are
        held where qpos (nq,) has them; none: at the reference of the model. The arm starts there,
        too. Geoms are left out that no bit of contype or conaffinity lets touch, or that leave_out
        names. change: other arguments of Arm. Raises SetupError naming the joint or geom that an
        arm cannot have, or the equality constraint or tendon that acts on its joints.
        """
        from . import _mujoco_arm
        return _mujoco_arm.arm_of(model, site, qpos, leave_out, **change)

    @classmethod
    def from_mjcf(cls, path: str | os.PathLike[str], site: str, **options: Any) -> Arm:
        """The same of an MJCF file, as MuJoCo reads it. options: those of `from_mujoco`."""
        from . import _mujoco_arm
        return _mujoco_arm.arm_of_mjcf(path, site, **options)

    @classmethod
    def from_pinocchio(cls, model: Any, frame: str, *, q: Any = None, **change: Any) -> Arm:
        """The arm between the world and a frame of a pinocchio.Model; the frame is the tool frame.

        Joints beside that chain are held where q (nq,) has them; none: at neutral. It has no parts.
        change: other arguments of Arm. Raises SetupError naming the joint that an arm cannot have.
        """
        from . import _pinocchio_arm
        return _pinocchio_arm.arm_of(model, frame, q, **change)


@dataclass
class Obstacle:
    """A convex part of the environment."""

    name: str
    shape: Shape
    X_WP: Any = None  #: pose [m]; none: the world
    law: ForceLaw | None = None  #: none: ForceLaw()
    along_W: Any = None  #: (3,) [m] to the far end of its motion to and fro; none: it is fixed
    duration: float = 1.0  #: [s] of that motion, there and back


@dataclass
class Loose:
    """A convex part of the environment that comes and goes, is moved and is held by a tool while a
    Cell runs: see its `add`."""

    name: str
    shape: Shape
    X_WP: Any = None  #: pose [m] where it comes, unless it is said; none: the world
    law: ForceLaw | None = None  #: none: ForceLaw()
    at_start: bool = False  #: it is there from the start on
    room: float = 0.0  #: [m] largest reach of its later shapes; 0: it keeps `shape`
    mass: float = 0.0  #: [kg] at the origin of its shape: its weight on a tool
    is_mass_known: bool = True  #: to the controller, not only to a simulated arm
    can_be_held: bool = True  #: without, it has pairs with arms only: many are affordable
